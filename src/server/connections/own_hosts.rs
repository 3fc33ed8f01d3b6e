//! What pages of other sites may send to a service without keys: nothing by a name that is not its own (DNS rebinding),
//! and no changes (cross-site request forgery).

use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;

use axum::http::uri::Authority;
use axum::http::{HeaderName, HeaderValue, Method, Request, header};

/// Paths that show nothing but the health of the server: probes call them by any name.
const HEALTH: [&str; 2] = ["/healthz", "/readyz"];

/// From where a page sends a request, as its browser says.
const FETCH_SITE: HeaderName = HeaderName::from_static("sec-fetch-site");

/// The names by which a service without keys is called, and the origins whose pages may change something.
#[derive(Clone, Debug)]
pub struct OwnHosts {
    /// Where it listens. If that is all addresses, it may be called by any address: only a name can be pointed
    /// elsewhere.
    pub listen: SocketAddr,
    /// Names and addresses besides that and loopback ones.
    pub names: Arc<[Authority]>,
    /// Origins of pages besides its own.
    pub origins: Arc<[HeaderValue]>,
}

impl OwnHosts {
    /// Why a request must not be served, if so.
    #[must_use]
    pub fn refuse<B>(&self, request: &Request<B>) -> Option<&'static str> {
        if HEALTH.contains(&request.uri().path()) {
            return None;
        }
        let (headers, target) = (request.headers(), request.uri().authority());
        let named = headers.get(header::HOST).map(HeaderValue::as_bytes);
        // Most clients call this machine by its usual names, and are no page whose origin is to be compared with them.
        let is_usual = target.is_none() && named.is_some_and(is_usual) && !headers.contains_key(header::ORIGIN);
        let named_authority = || named.and_then(|host| Authority::try_from(host).ok());
        let host = if is_usual { None } else { target.cloned().or_else(named_authority) };
        // Without a host the request has the version before that of all browsers.
        if !is_usual && named.is_some() && !host.as_ref().is_some_and(|host| self.is_own(host)) {
            return Some(
                "the service has no keys, and the host of this request is not one of its own: --allowed-hosts adds it",
            );
        }
        if matches!(*request.method(), Method::GET | Method::HEAD | Method::OPTIONS) {
            return None;
        }
        let own = |origin: &HeaderValue| {
            let authority = origin.to_str().ok().and_then(|origin| origin.split_once("://"));
            let same = authority.zip(host.as_ref()).is_some_and(|((_, authority), host)| host == authority);
            same || self.origins.contains(origin)
        };
        let foreign = match headers.get(header::ORIGIN) {
            Some(origin) => !own(origin),
            None => headers.get(FETCH_SITE).is_some_and(|site| site == "cross-site"),
        };
        foreign.then_some("a page of another site sent this: --cors-origins admits its origin")
    }

    fn is_own(&self, host: &Authority) -> bool {
        let name = host.host();
        // What stands before the name, or after it without being a port, is no part of a host.
        let port = host
            .as_str()
            .strip_prefix(name)
            .and_then(|rest| rest.strip_prefix(':').or(rest.is_empty().then_some(rest)));
        if port.is_none_or(|port| !port.is_empty() && (host.port_u16().is_none() || port.starts_with('+'))) {
            return false;
        }
        let known = |known: &Authority| {
            known.host().eq_ignore_ascii_case(name) && known.port_u16().is_none_or(|port| host.port_u16() == Some(port))
        };
        if name.eq_ignore_ascii_case("localhost") || self.names.iter().any(known) {
            return true;
        }
        let address = name.trim_start_matches('[').trim_end_matches(']').parse::<IpAddr>();
        let here = self.listen.ip();
        address.is_ok_and(|address| address.is_loopback() || here.is_unspecified() || address == here)
    }
}

/// Whether this is one of the usual names of the machine itself, with a port or without.
fn is_usual(host: &[u8]) -> bool {
    let (name, port) = host.split_at(host.iter().position(|byte| *byte == b':').unwrap_or(host.len()));
    let is_port = |port: &[u8]| {
        port.iter().all(u8::is_ascii_digit) && str::from_utf8(port).is_ok_and(|port| port.parse::<u16>().is_ok())
    };
    [&b"127.0.0.1"[..], b"localhost"].contains(&name) && port.get(1..).is_none_or(is_port)
}

#[cfg(test)]
mod tests {
    use axum::http::Request;

    use super::OwnHosts;

    fn refused(listen: &str, host: &str, headers: &[(&str, &str)]) -> bool {
        let own = OwnHosts {
            listen: format!("{listen}:8080").parse().unwrap(),
            names: ["lab.example".parse().unwrap(), "stickslip:8080".parse().unwrap()].into(),
            origins: ["https://page.example".parse().unwrap()].into(),
        };
        let mut request = Request::post("/contacts").header("host", host);
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        own.refuse(&request.body(()).unwrap()).is_some()
    }

    #[test]
    fn only_its_own_names_and_addresses_are_served() {
        for (refuse, listen, host) in [
            (false, "127.0.0.1", "127.0.0.1:8080"),
            (false, "127.0.0.1", "LocalHost:1234"),
            (false, "127.0.0.1", "[::1]:8080"),
            (false, "127.0.0.1", "127.9.8.7"),
            (false, "127.0.0.1", "Lab.example:99"),
            (false, "127.0.0.1", "stickslip:8080"),
            (true, "127.0.0.1", "stickslip:80"),
            (true, "127.0.0.1", "stickslip"),
            (true, "127.0.0.1", "evil.example"),
            (true, "127.0.0.1", "localhost.evil.example"),
            (true, "127.0.0.1", "127.0.0.1.evil.example"),
            (true, "127.0.0.1", "192.0.2.1"),
            (true, "127.0.0.1", ""),
            (true, "127.0.0.1", "a b"),
            (true, "127.0.0.1", "evil@localhost"),
            (true, "127.0.0.1", "evil@lab.example"),
            (true, "127.0.0.1", "lab.example:evil"),
            (true, "127.0.0.1", "lab.example:99999"),
            (true, "127.0.0.1", "stickslip:+8080"),
            (true, "127.0.0.1", "evil@[::1]:8080"),
            (false, "127.0.0.1", "localhost:"),
            (false, "192.0.2.1", "192.0.2.1:8080"),
            (true, "192.0.2.1", "192.0.2.2:8080"),
            (false, "0.0.0.0", "192.0.2.2:8080"),
            (false, "[::]", "[2001:db8::1]:8080"),
            (true, "0.0.0.0", "evil.example"),
        ] {
            assert_eq!(refused(listen, host, &[]), refuse, "{listen} {host}");
        }
    }

    #[test]
    fn only_its_own_pages_and_named_ones_change_anything() {
        for (refuse, headers) in [
            (false, &[("origin", "http://localhost:8080")][..]),
            (false, &[("origin", "https://page.example"), ("sec-fetch-site", "cross-site")]),
            (false, &[("sec-fetch-site", "same-origin")]),
            (true, &[("origin", "http://localhost:3000")]),
            (true, &[("origin", "https://evil.example")]),
            (true, &[("origin", "null")]),
            (true, &[("sec-fetch-site", "cross-site")]),
        ] {
            assert_eq!(refused("127.0.0.1", "localhost:8080", headers), refuse, "{headers:?}");
        }
    }
}
