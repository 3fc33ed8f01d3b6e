//! `stickslip serve`: its settings, and the process from start to end.

use std::io;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use axum::http::uri::Authority;
use axum::http::{HeaderValue, Uri};
use bytesize::ByteSize;
use clap::{ArgAction, Args, FromArgMatches as _, ValueEnum};
use tokio::net::TcpListener;
use tokio::signal::unix::Signal;
use tokio::sync::watch;
use tracing_subscriber::filter::{LevelFilter, ParseError, Targets};
use tracing_subscriber::layer::SubscriberExt as _;
use tracing_subscriber::util::SubscriberInitExt as _;
use tracing_subscriber::{Layer as _, fmt};

use super::demo::Demo;
use super::io::print;
use super::key;
use super::limits::Limits;
use super::log_queue::LogQueue;
use super::reload::reload_on_change;
use super::settings::Settings;
use super::stopping::{StopSignals, Stopping};
use crate::access::Keys;
use crate::admission::Pool;
use crate::api::middleware::security_headers::origin;
use crate::api::{self, Access, App};
use crate::jobs::{self, Jobs};
use crate::otlp;
use crate::server::connection_limits::LAST;
use crate::server::tls::{Tls, TlsFiles};
use crate::server::{ConnectionLimiter, OwnHosts, available_memory, memory_budget};
use crate::sessions::{self, Sessions};
use crate::store::{self, Store};

/// Threads for the store and for work that begins, beside those of work that has begun, which are at most as many as
/// requests.
const SPARE_THREADS: usize = 512;
const MOST_THREADS: usize = 10_000;

/// The shortest time after which an idle contact may expire, and the shortest lease on a chunk of a job: it must be
/// renewed in time.
const SHORTEST_TIME: Duration = Duration::from_secs(1);

/// The store in the present folder that is served if no other one is named.
const DEFAULT_STORE: &str = "sqlite:stickslip.db";

/// The settings. Each can be a flag or a variable of the environment (`settings`).
#[derive(Args)]
pub struct Serve {
    /// Address and port to listen on; port 0 takes any free port.
    #[arg(long, env = "STICKSLIP_LISTEN", default_value = "127.0.0.1:8080")]
    listen: SocketAddr,
    /// API keys: entries as `stickslip key new` prints them, or files with such entries, separated by commas.
    #[arg(long, env = "STICKSLIP_KEYS", value_delimiter = ',')]
    keys: Vec<String>,
    /// File of keys for a service without --keys and without --insecure. If it does not exist, it is created with one
    /// key of the roles write and metrics, which is printed only this once.
    #[arg(long, env = "STICKSLIP_FIRST_KEY", value_name = "FILE")]
    first_key: Option<PathBuf>,
    /// File with the certificate of the service and the certificates of its authorities (PEM), for TLS; needs
    /// --tls-key.
    #[arg(long, env = "STICKSLIP_TLS_CERT")]
    tls_cert: Option<PathBuf>,
    /// File with the private key of --tls-cert (PEM).
    #[arg(long, env = "STICKSLIP_TLS_KEY")]
    tls_key: Option<PathBuf>,
    /// Allow a service without keys on an address that others can reach: true or false.
    #[arg(long, env = "STICKSLIP_INSECURE", num_args = 0..=1, require_equals = true, action = ArgAction::Set,
        default_value_t = false, default_missing_value = "true")]
    insecure: bool,
    /// Hosts by which a service without keys may be called besides loopback and its own address, such as lab.example,
    /// separated by commas.
    #[arg(long, env = "STICKSLIP_ALLOWED_HOSTS", value_delimiter = ',')]
    allowed_hosts: Vec<Authority>,
    /// Origins of web pages that may call the service (CORS), such as https://lab.example, separated by commas.
    #[arg(long, env = "STICKSLIP_CORS_ORIGINS", value_delimiter = ',', value_parser = origin)]
    cors_origins: Vec<HeaderValue>,
    /// Store of the contacts: `sqlite:PATH` for a file, `postgres://…` for a database that several processes can
    /// share, `memory:` for this process until it ends.
    #[arg(long, env = "STICKSLIP_STORE", default_value = DEFAULT_STORE)]
    store: String,
    /// Bytes of memory to cache the states of contacts, such as 64MiB. Other states are replayed when needed.
    #[arg(long, env = "STICKSLIP_CACHE_BYTES", default_value_t = ByteSize::b(sessions::CAPACITY as u64))]
    cache_bytes: ByteSize,
    /// Delete contacts that have not moved for this time, such as 30d or 12h [default: never].
    #[arg(long, env = "STICKSLIP_EXPIRE_AFTER", value_parser = time)]
    expire_after: Option<Duration>,
    /// How long a process may be silent before other processes on the same database take over its chunks of jobs.
    #[arg(long, env = "STICKSLIP_JOB_LEASE", default_value = humantime::format_duration(jobs::LEASE).to_string(),
        value_parser = time)]
    job_lease: Duration,
    #[command(flatten)]
    limits: Limits,
    /// Filter of the log, with levels from `error` to `trace`, such as `info`, `warn` or `stickslip=debug`.
    #[arg(long, env = "STICKSLIP_LOG", default_value = "info", value_parser = filter)]
    log: Targets,
    /// Format of the log.
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

impl Serve {
    /// The settings of a service that listens here and keeps its contacts in memory; the others are the defaults or
    /// those of the environment.
    ///
    /// # Errors
    /// A line about a variable of the environment that is wrong.
    pub fn in_memory(listen: SocketAddr) -> Result<Serve, String> {
        let arguments = ["serve", "--store", "memory:", "--listen", &listen.to_string()];
        let read = Serve::augment_args(clap::Command::new("serve")).try_get_matches_from(arguments);
        read.and_then(|matches| Serve::from_arg_matches(&matches)).map_err(|error| error.to_string())
    }

    /// Without a command, checks that a store is named or exists: otherwise a file would be created wherever somebody
    /// tries the program.
    ///
    /// # Errors
    /// A line that says what to do.
    pub fn check_implied(&self, settings: &Settings) -> Result<(), String> {
        let path = DEFAULT_STORE.trim_start_matches("sqlite:");
        if !settings.is_default("store") || Path::new(path).exists() {
            return Ok(());
        }
        Err(format!(
            "there is no store {path} in this folder: `stickslip serve` makes one, --store names another, and \
             `stickslip --help` shows the commands"
        ))
    }
}

/// Serves until a signal stops it; with the contacts of a demonstration, if there is one, and its page opened.
pub fn serve(mut options: Serve, demo: Option<Demo>) -> Result<(), String> {
    // Work that yields to other work keeps its thread, and must leave some to the work that it yields to.
    let threads = SPARE_THREADS + options.limits.capacity().requests.min(MOST_THREADS);
    let runtime = tokio::runtime::Builder::new_multi_thread().max_blocking_threads(threads).enable_all().build();
    let runtime = runtime.map_err(|error| format!("cannot start: {error}"))?;
    // Before anything else: what a signal does without a handler is not what it is meant to do.
    let (mut signals, hangup) = runtime.block_on(async { StopSignals::listen() })?;
    // Spans go to a collector alone, and are not even made where there is none.
    let filter = options.log.clone().with_target(otlp::SPANS, LevelFilter::OFF);
    let endpoint = options.otlp_endpoint.as_deref();
    let traces = endpoint.map(|endpoint| otlp::layer(endpoint, runtime.handle().clone())).transpose();
    let (spans, exporter) = traces.map_err(|error| format!("--otlp-endpoint: {error}"))?.unzip();
    let queue = LogQueue::to(io::stderr()).map_err(|error| format!("cannot start: {error}"))?;
    let log = fmt::layer().with_writer(queue.clone());
    let lines = match options.log_format {
        LogFormat::Text => log.with_ansi(false).boxed(),
        LogFormat::Json => log.json().flatten_event(true).boxed(),
    };
    tracing_subscriber::registry().with(spans).with(lines.with_filter(filter)).init();
    log_panics();
    let stop = Stopping::new(options.limits.drain_time(), queue.clone());
    let served = (|| {
        options.take_first_key()?;
        let (access, keys) = access(&options)?;
        let tls = tls(&options)?;
        let opened = runtime.block_on(async {
            tokio::select! {
                opened = store::open(&options.store) => Some(opened),
                // A database may be waited for.
                () = signals.wait() => None,
            }
        });
        let Some(store) = opened.transpose().map_err(|error| error.to_string())? else { return Ok(None) };
        tracing::info!(
            version = env!("CARGO_PKG_VERSION"),
            commit = env!("BUILD_COMMIT"),
            pid = std::process::id(),
            cache_bytes = options.cache_bytes.as_u64(),
            expire_after_s = options.expire_after.map(|idle| idle.as_secs()),
            "starting"
        );
        let reload = reload(&options, keys, tls.clone());
        let stopping = (signals, stop.clone());
        let listening = listen(&options, demo, access, tls, (reload, hangup), Arc::clone(&store), stopping);
        runtime.block_on(listening).map(|()| Some(store))
    })();
    let end = stop.begin();
    if let Some(exporter) = exporter {
        exporter.finish(end.saturating_duration_since(Instant::now()) / 2);
    }
    runtime.shutdown_timeout(end.saturating_duration_since(Instant::now()) / 2);
    // The last handle of the store: dropping it closes the store before the process ends.
    let served = served.map(drop);
    if served.is_ok() {
        tracing::info!("stopped");
    }
    queue.finish(end.min(Instant::now() + LAST));
    served
}

impl Serve {
    /// Sets `--keys` to the file of `--first-key`, which is made if there is none, unless there are keys or none are
    /// wanted.
    fn take_first_key(&mut self) -> Result<(), String> {
        let Some(file) = self.first_key.take().filter(|_| self.keys.is_empty() && !self.insecure) else {
            return Ok(());
        };
        key::make_first_key(&file)?;
        self.keys.push(file.to_string_lossy().into_owned());
        Ok(())
    }
}

/// Logs panics with their location. The line of the failed request is logged separately.
fn log_panics() {
    std::panic::set_hook(Box::new(|panic| {
        let place = panic.location().map(ToString::to_string);
        tracing::error!(place, what = panic.payload_as_str(), "panicked");
    }));
}

fn collector(text: &str) -> Result<String, String> {
    let is_sound = |uri: &Uri| matches!(uri.scheme_str(), Some("http" | "https")) && uri.authority().is_some();
    let sound = text.parse().ok().filter(is_sound).map(|_| text.to_owned());
    sound.ok_or_else(|| "expected http:// or https:// and the address of a collector".to_owned())
}

type KeysInForce = watch::Sender<Arc<Keys>>;

/// Who may use the service, and where its keys are replaced. Without keys it listens on loopback addresses only, unless
/// --insecure is given.
fn access(options: &Serve) -> Result<(Access, Option<KeysInForce>), String> {
    let keys = key::read_keys(&options.keys)?;
    let listen = options.listen;
    if keys.is_none() && !listen.ip().to_canonical().is_loopback() {
        if !options.insecure {
            return Err(format!(
                "refusing to listen on {listen} without keys: give --keys, or --first-key to have one made, or a \
                 loopback address such as 127.0.0.1:{}, or --insecure to admit everybody who can reach the address",
                listen.port()
            ));
        }
        tracing::warn!(%listen, "no keys are set: everybody who can reach this address has full access");
    }
    if let Some(keys) = &keys {
        tracing::info!(keys = keys.count(), "access requires a key");
        if !listen.ip().to_canonical().is_loopback() && options.tls_cert.is_none() {
            tracing::warn!(%listen, "keys are sent unencrypted: give --tls-cert and --tls-key, or let only a \
                proxy reach this address");
        }
    }
    let origins: Arc<[_]> = options.cors_origins.as_slice().into();
    // A page that has no key can do nothing where there are keys.
    let own_hosts =
        || OwnHosts { listen, names: options.allowed_hosts.as_slice().into(), origins: Arc::clone(&origins) };
    let hosts = keys.is_none().then(own_hosts);
    let (sender, keys) = keys.map(|keys| watch::channel(Arc::new(keys))).unzip();
    Ok((Access { keys, hosts, origins }, sender))
}

fn tls(options: &Serve) -> Result<Option<Tls>, String> {
    let tls = match (options.tls_cert.clone(), options.tls_key.clone()) {
        (None, None) => return Ok(None),
        (Some(certificate), Some(key)) => Tls::open(TlsFiles { certificate, key }),
        _ => Err("one is given without the other: give both or neither".to_owned()),
    };
    tls.map(Some).map_err(|error| format!("--tls-cert, --tls-key: {error}"))
}

/// The files that may change while the service runs, and the function that reads them again. A faulty file changes
/// nothing.
fn reload(options: &Serve, keys: Option<KeysInForce>, tls: Option<Tls>) -> (Vec<PathBuf>, impl Fn() + Send + use<>) {
    let certificate = [&options.tls_cert, &options.tls_key].into_iter().flatten().cloned();
    let files = key::key_files(&options.keys).chain(certificate).collect();
    let setting = options.keys.clone();
    let read = move || {
        if let Some(keys) = &keys {
            match key::read_keys(&setting) {
                Ok(read) => {
                    let read = read.unwrap_or_default();
                    tracing::info!(keys = read.count(), "keys read again");
                    keys.send_replace(Arc::new(read));
                }
                Err(error) => tracing::error!(error, "keys unchanged"),
            }
        }
        if let Some(tls) = &tls {
            match tls.reload() {
                Ok(()) => tracing::info!("certificate read again"),
                Err(error) => tracing::error!(error, "certificate unchanged"),
            }
        }
    };
    (files, read)
}

fn time(text: &str) -> Result<Duration, String> {
    let time = humantime::parse_duration(text).map_err(|error| error.to_string())?;
    if time < SHORTEST_TIME { Err(format!("at least {SHORTEST_TIME:?}")) } else { Ok(time) }
}

/// A filter of the log. The library takes an empty part as everything.
fn filter(text: &str) -> Result<Targets, String> {
    let parts: Vec<&str> = text.split(',').map(str::trim).filter(|part| !part.is_empty()).collect();
    if let Some(part) = parts.iter().find(|part| part.contains(['[', '{'])) {
        return Err(format!("{part}: give a level or target=level; spans and fields do not filter"));
    }
    let text = if parts.is_empty() { "error".to_owned() } else { parts.join(",") };
    text.parse().map_err(|error: ParseError| error.to_string())
}

/// Why an address cannot be used, with a remedy if one is known.
fn cannot_listen(address: SocketAddr, error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::AddrInUse => format!(
            "cannot listen on {address}: another program already does. Stop it, or choose another address, such as \
             --listen {}:0 for any free port",
            if address.is_ipv6() { format!("[{}]", address.ip()) } else { address.ip().to_string() }
        ),
        _ => format!("cannot listen on {address}: {error}"),
    }
}

async fn listen(
    options: &Serve,
    demo: Option<Demo>,
    access: Access,
    tls: Option<Tls>,
    ((files, reload), hangup): ((Vec<PathBuf>, impl Fn() + Send + 'static), Signal),
    store: Arc<dyn Store>,
    (mut signals, stopping): (StopSignals, Stopping),
) -> Result<(), String> {
    let address = options.listen;
    let listener = TcpListener::bind(address).await.map_err(|error| cannot_listen(address, &error))?;
    let address = listener.local_addr().map_err(|error| format!("cannot listen on {address}: {error}"))?;
    let stop = {
        let stopping = stopping.clone();
        async move {
            signals.wait().await;
            stopping.begin();
        }
    };
    let pool = Pool::new(options.limits.capacity());
    let limiter =
        ConnectionLimiter::new(options.limits.connections(), options.limits.trusted_proxies.as_slice().into());
    let cache_bytes = options.cache_bytes.as_u64();
    let memory_bound = memory_budget::memory(&limiter.limits, pool.capacity(), cache_bytes, tls.is_some());
    if let Some(memory) = available_memory::available().filter(|memory| memory_bound > *memory) {
        tracing::warn!(
            memory_bound = %ByteSize::b(memory_bound),
            memory = %ByteSize::b(memory),
            "the memory bound is above the memory of this machine or of its control group: lower --work-bytes, \
             --cache-bytes or --max-connections"
        );
    }
    let capacity = usize::try_from(cache_bytes).unwrap_or(usize::MAX);
    let jobs = Jobs::new(Arc::clone(&store), pool.clone());
    let sessions = Sessions::new(Arc::clone(&store), pool.clone(), capacity);
    if let Some(demo) = &demo {
        demo.create_contacts(&sessions).await?;
    }
    let working = tokio::spawn(jobs.clone().work(options.job_lease));
    tokio::spawn(sessions::run_expiry_loop(store, options.expire_after));
    tokio::spawn(reload_on_change(files, hangup, reload));
    let scheme = if tls.is_some() { "https" } else { "http" };
    tracing::info!(%address, threads = pool.capacity().threads.max(1), memory_bound, "listening");
    // What was said before is there when this is.
    stopping.log.finish(Instant::now() + LAST);
    print(format_args!("stickslip listens on {scheme}://{address}, the page at /, the API at /docs"))?;
    if let Some(demo) = demo {
        demo.open_page(&format!("{scheme}://{address}/"))?;
    }
    let app = App { sessions, jobs, pool, access };
    api::serve_within(limiter, listener, tls, app, stop).await;
    // If the store is unreachable, other processes take over when the leases expire.
    let _ = tokio::time::timeout_at((stopping.begin() - LAST / 2).into(), working).await;
    Ok(())
}
