//! `stickslip healthcheck`: checks that a running service is healthy.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::path::PathBuf;
use std::time::Duration;

use clap::Args;

use crate::server::tls;

/// How long a service may take to reply.
const REPLY_TIMEOUT: Duration = Duration::from_secs(2);

/// The service to check. The settings are those of `serve`, so that a container needs no others.
#[derive(Args)]
pub struct Healthcheck {
    /// Address and port of the service.
    #[arg(long, env = "STICKSLIP_LISTEN", default_value = "127.0.0.1:8080")]
    listen: SocketAddr,
    /// File with the certificate of a service with TLS. It is not verified: the service is on this machine.
    #[arg(long, env = "STICKSLIP_TLS_CERT")]
    tls_cert: Option<PathBuf>,
    /// Private key of the certificate; it is not read.
    #[arg(long, env = "STICKSLIP_TLS_KEY")]
    tls_key: Option<PathBuf>,
}

/// Fails unless the service replies that it is healthy.
pub fn healthcheck(options: &Healthcheck) -> Result<(), String> {
    let mut address = options.listen;
    if address.ip().is_unspecified() {
        // A service that listens on all addresses can be reached at the loopback address.
        let loopback: IpAddr = if address.is_ipv4() { Ipv4Addr::LOCALHOST.into() } else { Ipv6Addr::LOCALHOST.into() };
        address.set_ip(loopback);
    }
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    let runtime = runtime.map_err(|error| format!("cannot start: {error}"))?;
    let with_tls = options.tls_cert.is_some() || options.tls_key.is_some();
    let answer = runtime.block_on(async { tokio::time::timeout(REPLY_TIMEOUT, tls::healthz(address, with_tls)).await });
    match answer {
        Ok(Ok(())) => Ok(()),
        Ok(Err(error)) => Err(format!("{address} is not healthy: {error}")),
        Err(_) => Err(format!("{address} does not answer")),
    }
}
