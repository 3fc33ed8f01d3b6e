//! `stickslip healthcheck`: checks that a running service is healthy.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::time::Duration;

use clap::Args;
use stickslip_wire::client::Client;

use super::settings::ConfigFile;

/// How long a service may take to reply.
const REPLY_TIMEOUT: Duration = Duration::from_secs(2);

/// The service to check. The settings are those of `serve`, so that a container needs no others.
#[derive(Args)]
pub struct Healthcheck {
    #[command(flatten)]
    _file: ConfigFile,
    /// Address and port of the service.
    #[arg(long, env = "STICKSLIP_LISTEN", default_value = "127.0.0.1:8080")]
    listen: SocketAddr,
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
    let client = Client::new(format!("http://{address}"));
    let answer = runtime.block_on(async { tokio::time::timeout(REPLY_TIMEOUT, client.healthz()).await });
    match answer {
        Ok(Ok(())) => Ok(()),
        Ok(Err(error)) => Err(format!("{address} is not healthy: {error}")),
        Err(_) => Err(format!("{address} does not answer")),
    }
}
