//! `stickslip healthcheck`: is a running service well?

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::time::Duration;

use clap::Args;
use stickslip_wire::client::Client;

use super::settings::ConfigFile;

/// How long a service may take to say that it is well.
const LONGEST_ANSWER: Duration = Duration::from_secs(2);

/// Whom to ask. The settings are those of the service, so that a container needs no second set of them.
#[derive(Args)]
pub struct Healthcheck {
    #[command(flatten)]
    _file: ConfigFile,
    /// Where it listens.
    #[arg(long, env = "STICKSLIP_LISTEN", default_value = "127.0.0.1:8080")]
    listen: SocketAddr,
}

/// Asks, and fails unless the answer is good.
pub fn healthcheck(options: &Healthcheck) -> Result<(), String> {
    let mut address = options.listen;
    if address.ip().is_unspecified() {
        // A service that listens everywhere is reached at home.
        let home: IpAddr = if address.is_ipv4() { Ipv4Addr::LOCALHOST.into() } else { Ipv6Addr::LOCALHOST.into() };
        address.set_ip(home);
    }
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    let runtime = runtime.map_err(|error| format!("cannot start: {error}"))?;
    let client = Client::new(format!("http://{address}"));
    let answer = runtime.block_on(async { tokio::time::timeout(LONGEST_ANSWER, client.healthz()).await });
    match answer {
        Ok(Ok(())) => Ok(()),
        Ok(Err(error)) => Err(format!("{address} is not well: {error}")),
        Err(_) => Err(format!("{address} does not answer")),
    }
}
