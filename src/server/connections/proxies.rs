//! The address of the client behind proxies, as those that are trusted state it.

use std::net::{IpAddr, SocketAddr};

use axum::http::HeaderMap;
use ipnet::IpNet;

/// The addresses of proxies: one, or all of a network such as `10.0.0.0/8`.
///
/// # Errors
/// What is expected, if the text is neither.
pub fn network(text: &str) -> Result<IpNet, &'static str> {
    let one = text.parse::<IpAddr>().map(IpNet::from);
    one.or_else(|_| text.parse()).map_err(|_| "expected an address, or a network such as 10.0.0.0/8")
}

/// Whether the address is one of these.
pub fn is_trusted(trusted: &[IpNet], address: IpAddr) -> bool {
    trusted.iter().any(|network| network.contains(&address))
}

/// The client of a request that came from `peer`. A proxy appends to `X-Forwarded-For` the address that called it; the
/// last address that is not one of `trusted` is the client. What stands before it could be made up.
pub fn client(peer: IpAddr, headers: &HeaderMap, trusted: &[IpNet]) -> IpAddr {
    let mut client = peer.to_canonical();
    if !is_trusted(trusted, client) {
        return client;
    }
    let lines = headers.get_all("x-forwarded-for").iter().rev();
    for stated in lines.flat_map(|line| line.to_str().unwrap_or_default().rsplit(',')) {
        let Some(stated) = address(stated.trim()) else { break };
        client = stated.to_canonical();
        if !is_trusted(trusted, client) {
            break;
        }
    }
    client
}

/// An address as proxies state it: some with the port, and with it or without it an IPv6 address in brackets.
fn address(stated: &str) -> Option<IpAddr> {
    let bare = stated.strip_prefix('[').and_then(|stated| stated.strip_suffix(']')).unwrap_or(stated);
    let with_port = || stated.parse::<SocketAddr>().ok().map(|stated| stated.ip());
    bare.parse().ok().or_else(with_port)
}

#[cfg(test)]
mod tests {
    use axum::http::{HeaderMap, HeaderValue};

    use super::{client, network};

    #[test]
    fn only_what_trusted_proxies_say_is_believed() {
        let trusted = ["127.0.0.1", "10.0.0.0/8", "fd00::/64"].map(|text| network(text).unwrap());
        for (peer, lines, expected) in [
            ("192.0.2.1", &["198.51.100.7"][..], "192.0.2.1"),
            ("127.0.0.1", &[], "127.0.0.1"),
            ("127.0.0.1", &["198.51.100.7"], "198.51.100.7"),
            ("::ffff:127.0.0.1", &["198.51.100.7"], "198.51.100.7"),
            ("127.0.0.1", &["1.1.1.1, 198.51.100.7, 10.1.2.3"], "198.51.100.7"),
            ("127.0.0.1", &["1.1.1.1", "198.51.100.7, 10.1.2.3"], "198.51.100.7"),
            ("fd00::1", &["2001:db8::1,fd00::2"], "2001:db8::1"),
            ("fd00:0:0:1::1", &["2001:db8::1"], "fd00:0:0:1::1"),
            ("127.0.0.1", &["10.1.2.3"], "10.1.2.3"),
            ("127.0.0.1", &["198.51.100.7, nonsense"], "127.0.0.1"),
            ("127.0.0.1", &["1.2.3.4:5678"], "1.2.3.4"),
            ("127.0.0.1", &["1.1.1.1, 1.2.3.4:5678, 10.1.2.3:80"], "1.2.3.4"),
            ("127.0.0.1", &["[2001:db8::1]:443"], "2001:db8::1"),
            ("127.0.0.1", &["[2001:db8::1]"], "2001:db8::1"),
            ("127.0.0.1", &["1.2.3.4:99999"], "127.0.0.1"),
        ] {
            let mut headers = HeaderMap::new();
            for line in lines {
                headers.append("x-forwarded-for", HeaderValue::from_static(line));
            }
            assert_eq!(client(peer.parse().unwrap(), &headers, &trusted).to_string(), expected, "{peer} {lines:?}");
        }
    }

    #[test]
    fn a_network_is_an_address_with_the_bits_that_count() {
        for bad in ["", "10.0.0.0/33", "10.0.0/8", "fd00::/129", "10.0.0.0/", "10.0.0.0/-1", "proxy"] {
            assert!(network(bad).is_err(), "{bad}");
        }
    }
}
