//! The limits of the service, as settings.

use std::time::Duration;

use bytesize::ByteSize;
use clap::Args;
use ipnet::IpNet;

use crate::admission;
use crate::admission::{BODY_SHARE, Capacity, QuotaLimits};
use crate::api::request_limits::BODY_LIMIT;
use crate::server::connections::DEFAULT_CONNECTIONS;
use crate::server::fd_limit::room_for;
use crate::server::{ConnectionLimits, network};

/// The range of the times that can be set.
const SHORTEST_TIME: Duration = Duration::from_millis(10);
const LONGEST_TIME: Duration = Duration::from_secs(24 * 60 * 60);

/// Limits against overload; see docs/overload.md.
#[derive(Args)]
pub struct Limits {
    /// Maximum number of connections at a time.
    #[arg(long, env = "STICKSLIP_MAX_CONNECTIONS", default_value_t = DEFAULT_CONNECTIONS, value_parser = at_least_one)]
    max_connections: usize,
    /// Maximum number of connections of one client address [default: half of all]; not applied to --trusted-proxies.
    #[arg(long, env = "STICKSLIP_MAX_CONNECTIONS_PER_CLIENT", value_parser = at_least_one)]
    max_connections_per_client: Option<usize>,
    /// Proxies whose X-Forwarded-For is trusted, as addresses or networks such as 10.0.0.0/8, separated by commas.
    #[arg(long, env = "STICKSLIP_TRUSTED_PROXIES", value_delimiter = ',', value_parser = network)]
    pub trusted_proxies: Vec<IpNet>,
    /// Maximum number of requests processed at a time; more wait.
    #[arg(long, env = "STICKSLIP_MAX_REQUESTS", default_value_t = admission::REQUESTS, value_parser = at_least_one)]
    max_requests: usize,
    /// Maximum number of requests that wait; more are refused.
    #[arg(long, env = "STICKSLIP_MAX_QUEUE", default_value_t = admission::QUEUE, value_parser = at_least_one)]
    max_queue: usize,
    /// Maximum number of requests of one client processed or waiting at a time [default: half of --max-requests]. A
    /// client is a tenant if the service has keys, otherwise an address. Behind a proxy without keys all clients have
    /// one address.
    #[arg(long, env = "STICKSLIP_MAX_REQUESTS_PER_CLIENT", value_parser = at_least_one)]
    max_requests_per_client: Option<usize>,
    /// Maximum number of streams of events that one client follows.
    #[arg(long, env = "STICKSLIP_MAX_STREAMS_PER_CLIENT", default_value_t = admission::STREAMS_PER_CLIENT,
        value_parser = at_least_one)]
    max_streams_per_client: usize,
    /// Maximum number of contacts of one tenant.
    #[arg(long, env = "STICKSLIP_MAX_CONTACTS_PER_TENANT", default_value_t = admission::CONTACTS_PER_TENANT,
        value_parser = at_least_one)]
    max_contacts_per_tenant: usize,
    /// Maximum bytes of the contacts of one tenant in the store, with their moves and the replies kept for retries.
    #[arg(long, env = "STICKSLIP_MAX_STORE_BYTES_PER_TENANT",
        default_value_t = ByteSize::b(admission::STORE_BYTES_PER_TENANT as u64))]
    max_store_bytes_per_tenant: ByteSize,
    /// Maximum bytes of memory for bodies that are arriving from one client [default: a quarter of --work-bytes].
    #[arg(long, env = "STICKSLIP_MAX_BODY_BYTES_PER_CLIENT", value_parser = at_least(BODY_LIMIT, "one body"))]
    max_body_bytes_per_client: Option<ByteSize>,
    /// How long a request waits before it is refused.
    #[arg(long, env = "STICKSLIP_MAX_WAIT", default_value = "10s", value_parser = duration)]
    max_wait: Duration,
    /// Bytes of memory for all large requests together: bodies, work and replies.
    #[arg(
        long,
        env = "STICKSLIP_WORK_BYTES",
        default_value_t = ByteSize::b(admission::BYTES as u64),
        value_parser = at_least(admission::LARGEST, "one request")
    )]
    work_bytes: ByteSize,
    /// Longest time that the solver works for one request.
    #[arg(long, env = "STICKSLIP_DEADLINE", default_value = "60s", value_parser = duration)]
    deadline: Duration,
    /// How long a client may take to send the head of a request.
    #[arg(long, env = "STICKSLIP_HEAD_TIME", default_value = "10s", value_parser = duration)]
    head_time: Duration,
    /// How long a client may take to send a body.
    #[arg(long, env = "STICKSLIP_BODY_TIME", default_value = "30s", value_parser = duration)]
    body_time: Duration,
    /// How long a connection may be idle between requests.
    #[arg(long, env = "STICKSLIP_IDLE_TIME", default_value = "60s", value_parser = duration)]
    idle_time: Duration,
    /// How long a client may read nothing of a reply or of events.
    #[arg(long, env = "STICKSLIP_STALL_TIME", default_value = "30s", value_parser = duration)]
    stall_time: Duration,
    /// How long requests may take to finish once the server stops; the rest are refused then.
    #[arg(long, env = "STICKSLIP_DRAIN_TIME", default_value = "8s", value_parser = duration)]
    drain_time: Duration,
}

impl Limits {
    pub fn capacity(&self) -> Capacity {
        Capacity {
            requests: self.max_requests,
            queue: self.max_queue,
            wait: self.max_wait,
            deadline: self.deadline,
            bytes: bytes(self.work_bytes),
            quotas: QuotaLimits {
                requests: self.max_requests_per_client.unwrap_or(self.max_requests.div_ceil(2)),
                streams: self.max_streams_per_client,
                contacts: self.max_contacts_per_tenant,
                store_bytes: bytes(self.max_store_bytes_per_tenant),
                body_bytes: self.max_body_bytes_per_client.map_or(bytes(self.work_bytes) / BODY_SHARE, bytes),
            },
            ..Capacity::default()
        }
    }

    /// How long requests may take to finish once the server stops.
    pub fn drain_time(&self) -> Duration {
        self.drain_time
    }

    /// The limits of connections, lowered to what the limit of open files allows.
    pub fn connections(&self) -> ConnectionLimits {
        let most = room_for(self.max_connections);
        if most < self.max_connections {
            let asked = self.max_connections;
            tracing::warn!(asked, most, "fewer connections than asked for: raise the limit of open files (ulimit -n)");
        }
        let per_client = self.max_connections_per_client.unwrap_or(most.div_ceil(2));
        let (head, body, idle, stall) = (self.head_time, self.body_time, self.idle_time, self.stall_time);
        ConnectionLimits { most, per_client, head, body, idle, stall, drain: self.drain_time }
    }
}

fn bytes(size: ByteSize) -> usize {
    usize::try_from(size.as_u64()).unwrap_or(usize::MAX)
}

fn duration(text: &str) -> Result<Duration, String> {
    let time = humantime::parse_duration(text).map_err(|error| error.to_string())?;
    let (least, most) = (SHORTEST_TIME, LONGEST_TIME);
    if (least..=most).contains(&time) { Ok(time) } else { Err(format!("{least:?} to {most:?} are allowed")) }
}

/// Parses a number of bytes that is not below this; the text says what can take as much.
fn at_least(bytes: usize, one: &'static str) -> impl Fn(&str) -> Result<ByteSize, String> + Clone {
    let least = ByteSize::b(bytes as u64);
    move |text| {
        let size = text.parse::<ByteSize>()?;
        if size < least { Err(format!("at least {least}: {one} can take as much")) } else { Ok(size) }
    }
}

fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) => Err("at least 1".to_owned()),
        Ok(number) => Ok(number),
        Err(_) => Err("not a whole number".to_owned()),
    }
}
