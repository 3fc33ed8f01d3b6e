//! `stickslip serve`: its settings, and the process from start to end.

use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use bytesize::ByteSize;
use clap::{ArgAction, Args, ValueEnum};
use stickslip::admission::Pool;
use stickslip::api::headers::Origin;
use stickslip::api::{self, Access, App, Door, bound};
use stickslip::jobs::{self, Jobs};
use stickslip::sessions::{self, Sessions};
use stickslip::store::{self, Store};
use tokio::net::TcpListener;
use tokio::signal::unix::{SignalKind, signal};
use tracing_subscriber::layer::SubscriberExt as _;
use tracing_subscriber::util::SubscriberInitExt as _;
use tracing_subscriber::{EnvFilter, Layer as _, fmt};

use super::overload::Overload;
use super::settings::ConfigFile;
use super::{key, print};

/// How long work that does not look at its flag may hold up the end of the process.
const LAST_WORK: Duration = Duration::from_millis(500);

/// How long the parts of jobs under way may take to be given back at the end.
const GIVE_BACK: Duration = Duration::from_secs(2);

/// The shortest time after which an idle contact may expire.
const SHORTEST_IDLE_TIME: Duration = Duration::from_secs(1);

/// The shortest lease on a part of a job: a renewal must come in time.
const SHORTEST_LEASE: Duration = Duration::from_secs(1);

/// The settings. Each comes as a flag, from the environment or from the file, whatever it is: `settings` sees to that.
#[derive(Args)]
pub struct Serve {
    #[command(flatten)]
    _file: ConfigFile,
    /// Address and port to listen on; port 0 takes a free one.
    #[arg(long, env = "STICKSLIP_LISTEN", default_value = "127.0.0.1:8080")]
    listen: SocketAddr,
    /// Keys of those who may use the service: the path of a file with entries as `stickslip key new` prints them, or such entries
    /// themselves, with commas between them.
    #[arg(long, env = "STICKSLIP_KEYS", value_delimiter = ',')]
    keys: Vec<String>,
    /// Listen on an address that others can reach although everybody who reaches it may do everything: true or false.
    #[arg(long, env = "STICKSLIP_INSECURE", num_args = 0..=1, require_equals = true, action = ArgAction::Set,
        default_value_t = false, default_missing_value = "true")]
    insecure: bool,
    /// Origins whose pages a browser may let in, such as https://lab.example, with commas between them.
    #[arg(long, env = "STICKSLIP_CORS_ORIGINS", value_delimiter = ',')]
    cors_origins: Vec<Origin>,
    /// Where contacts are kept: `sqlite:PATH` in a file, `postgres://…` in a database that several processes share,
    /// `memory:` in this process until it ends.
    #[arg(long, env = "STICKSLIP_STORE", default_value = "sqlite:stickslip.db")]
    store: String,
    /// Bytes of memory for the states of contacts, such as 64MiB. A state that is not at hand is replayed when needed.
    #[arg(long, env = "STICKSLIP_CACHE_BYTES", default_value_t = ByteSize::b(sessions::CAPACITY as u64))]
    cache_bytes: ByteSize,
    /// Delete contacts that have not moved for so long, such as 30d or 12h; left out, they stay.
    #[arg(long, env = "STICKSLIP_EXPIRE_AFTER", value_parser = idle_time)]
    expire_after: Option<Duration>,
    /// How long a process may be silent before others on the same database take the parts of jobs that it works on.
    #[arg(long, env = "STICKSLIP_JOB_LEASE", default_value_t = humantime::Duration::from(jobs::LEASE), value_parser = lease)]
    job_lease: humantime::Duration,
    #[command(flatten)]
    overload: Overload,
    /// What to log, as a filter: `info`, `warn`, `stickslip=debug`.
    #[arg(long, env = "STICKSLIP_LOG", default_value = "info", value_parser = filter)]
    log: String,
    /// How to log it.
    #[arg(long, env = "STICKSLIP_LOG_FORMAT", value_enum, default_value_t = LogFormat::Text)]
    log_format: LogFormat,
    /// Send a trace of each request to an OpenTelemetry collector, such as `http://localhost:4318` (OTLP over HTTP).
    #[arg(long, env = "STICKSLIP_OTLP_ENDPOINT", value_parser = collector)]
    otlp_endpoint: Option<String>,
}

#[derive(Clone, Copy, ValueEnum)]
enum LogFormat {
    Text,
    Json,
}

/// Serves until it is told to stop.
pub fn serve(options: Serve) -> Result<(), String> {
    let filter = EnvFilter::try_new(&options.log).map_err(|error| format!("--log {}: {error}", options.log))?;
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build();
    let runtime = runtime.map_err(|error| format!("cannot start: {error}"))?;
    let traces = options.otlp_endpoint.as_deref().map(|endpoint| {
        let _inside = runtime.enter();
        stickslip::otlp::layer(endpoint)
    });
    let (spans, exporter) = traces.unzip();
    let log = fmt::layer().with_writer(io::stderr);
    let lines = match options.log_format {
        LogFormat::Text => log.with_ansi(false).boxed(),
        LogFormat::Json => log.json().flatten_event(true).boxed(),
    };
    tracing_subscriber::registry().with(spans).with(lines.with_filter(filter)).init();
    log_panics();
    let access = access(&options)?;
    let store = runtime.block_on(store::open(&options.store)).map_err(|error| error.to_string())?;
    let expire_after_s = options.expire_after.map(|idle| idle.as_secs());
    tracing::info!(
        version = env!("CARGO_PKG_VERSION"),
        commit = option_env!("BUILD_COMMIT"),
        pid = std::process::id(),
        cache_bytes = options.cache_bytes.as_u64(),
        expire_after_s,
        "starting"
    );
    let served = runtime.block_on(listen(&options, access, Arc::clone(&store)));
    if let Some(exporter) = exporter {
        runtime.block_on(exporter.finish());
    }
    runtime.shutdown_timeout(LAST_WORK);
    // The last handle, now that no request holds one: the store is closed before the process ends.
    drop(store);
    if served.is_ok() {
        tracing::info!("stopped");
    }
    served
}

/// Sends panics to the log, with their place. The request that one of them ends is told by the line of that request.
fn log_panics() {
    std::panic::set_hook(Box::new(|panic| {
        let place = panic.location().map(ToString::to_string);
        tracing::error!(place, what = panic.payload_as_str(), "panicked");
    }));
}

fn collector(text: &str) -> Result<String, String> {
    match text.strip_prefix("http://") {
        Some(place) if !place.is_empty() => Ok(text.to_owned()),
        _ => Err("expected http:// and the place of a collector".to_owned()),
    }
}

/// Who may use the service. Without keys nobody else may reach it, unless that is wanted.
fn access(options: &Serve) -> Result<Access, String> {
    let keys = key::known(&options.keys)?;
    let listen = options.listen;
    if keys.is_none() && !listen.ip().to_canonical().is_loopback() {
        if !options.insecure {
            return Err(format!(
                "refusing to listen on {listen} without keys: give --keys, or a loopback address such as 127.0.0.1:{}, or \
                 --insecure to let in everybody who can reach it",
                listen.port()
            ));
        }
        tracing::warn!(%listen, "there are no keys: everybody who can reach this address may do everything");
    }
    if let Some(keys) = &keys {
        tracing::info!(keys = keys.count(), "a key is needed");
    }
    let origins = options.cors_origins.iter().map(|Origin(origin)| origin.clone());
    Ok(Access { keys: keys.map(Arc::new), origins: origins.collect() })
}

fn idle_time(text: &str) -> Result<Duration, String> {
    let time = humantime::parse_duration(text).map_err(|error| error.to_string())?;
    if time < SHORTEST_IDLE_TIME { Err(format!("at least {SHORTEST_IDLE_TIME:?}")) } else { Ok(time) }
}

fn lease(text: &str) -> Result<humantime::Duration, String> {
    let time = humantime::parse_duration(text).map_err(|error| error.to_string())?;
    if time < SHORTEST_LEASE { Err(format!("at least {SHORTEST_LEASE:?}")) } else { Ok(time.into()) }
}

fn filter(text: &str) -> Result<String, String> {
    EnvFilter::try_new(text).map(|_| text.to_owned()).map_err(|error| error.to_string())
}

async fn listen(options: &Serve, access: Access, store: Arc<dyn Store>) -> Result<(), String> {
    let address = options.listen;
    let listener = TcpListener::bind(address).await.map_err(|error| format!("cannot listen on {address}: {error}"))?;
    let address = listener.local_addr().map_err(|error| format!("cannot listen on {address}: {error}"))?;
    let signals = (signal(SignalKind::terminate()), signal(SignalKind::interrupt()));
    let (Ok(mut terminate), Ok(mut interrupt)) = signals else {
        return Err("cannot listen for signals".to_owned());
    };
    let stop = async move {
        tokio::select! {
            _ = terminate.recv() => {}
            _ = interrupt.recv() => {}
        }
    };
    let pool = Pool::new(options.overload.capacity());
    let door = Door::new(options.overload.connections());
    let memory_bound = bound::memory(door.limits(), pool.capacity(), options.cache_bytes.as_u64());
    let capacity = usize::try_from(options.cache_bytes.as_u64()).unwrap_or(usize::MAX);
    let jobs = Jobs::new(Arc::clone(&store), pool.clone());
    let sessions = Sessions::new(store, pool.clone(), capacity);
    let working = tokio::spawn(jobs.clone().work(options.job_lease.into()));
    tokio::spawn(sessions.clone().run_expiry_loop(options.expire_after));
    tracing::info!(%address, threads = pool.meters().threads, memory_bound, "listening");
    print(format_args!("stickslip listens on http://{address}, try /docs"))?;
    let app = App { sessions, jobs, pool, access };
    api::serve_through(door, listener, app, stop).await.map_err(|error| format!("stopped: {error}"))?;
    // Others wait for a lease where a store out of reach takes nothing back.
    let _ = tokio::time::timeout(GIVE_BACK, working).await;
    Ok(())
}
