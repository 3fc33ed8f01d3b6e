//! The command line.

use std::fmt::Display;
use std::io::{self, Read as _, Write as _};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use bytesize::ByteSize;
use clap::{Args, Parser, Subcommand, ValueEnum};
use stickslip::api::{self, App, Problem};
use stickslip::client::Client;
use stickslip::sessions::{self, Sessions};
use stickslip::simulation::{self, Pool, Stop};
use stickslip::store::{self, Store};
use stickslip::wire::{self, SimulateRequest};
use tokio::net::TcpListener;
use tokio::signal::unix::{SignalKind, signal};
use tracing_subscriber::layer::SubscriberExt as _;
use tracing_subscriber::util::SubscriberInitExt as _;
use tracing_subscriber::{EnvFilter, Layer as _, fmt};

#[cfg(target_env = "musl")]
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// How long work that does not look at its flag may hold up the end of the process.
const LAST_WORK: Duration = Duration::from_millis(500);

/// How long a service may take to say that it is well.
const LONGEST_ANSWER: Duration = Duration::from_secs(2);

/// The shortest time after which an idle contact may expire.
const SHORTEST_IDLE_TIME: Duration = Duration::from_secs(1);

/// Frictional contact with memory, exactly: a service, and the same on the command line.
#[derive(Parser)]
#[command(version, about, args_conflicts_with_subcommands = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    serve: Serve,
}

#[derive(Subcommand)]
enum Command {
    /// Serve HTTP; the same as no command at all.
    Serve(Serve),
    /// Run the body of POST /simulate from a file and print the reply.
    Simulate {
        /// The file, or - for standard input.
        file: PathBuf,
    },
    /// Print the OpenAPI document.
    Openapi,
    /// Ask a running service whether it is well; for container health checks.
    Healthcheck {
        /// Where it listens.
        #[arg(long, env = "STICKSLIP_LISTEN", default_value = "127.0.0.1:8080")]
        listen: SocketAddr,
    },
    /// Copy the store to a file, while the service runs or not.
    Backup {
        /// The file to make; one that is there is left as it is.
        file: PathBuf,
        /// The store, `sqlite:PATH`.
        #[arg(long, env = "STICKSLIP_STORE", default_value = "sqlite:stickslip.db")]
        store: String,
    },
    /// Look whether a store is sound: make every contact again from its moves, and compare. Nothing is written.
    Check {
        /// The store, `sqlite:PATH` or `postgres://…`; the service may be running.
        #[arg(long, env = "STICKSLIP_STORE", default_value = "sqlite:stickslip.db")]
        store: String,
        /// How far recorded states may differ from replayed ones, relatively; nought means not in a single bit. Moves made
        /// by another version of the engine may differ by 1e-12.
        #[arg(long, env = "STICKSLIP_CHECK_TOLERANCE", default_value_t = 0.0)]
        tolerance: f64,
    },
    /// Draw the figures of the paper, as SVG and CSV.
    Figures {
        /// The folder to write them to.
        #[arg(long)]
        out: PathBuf,
    },
}

#[derive(Args)]
struct Serve {
    /// Address and port to listen on; port 0 takes a free one.
    #[arg(long, env = "STICKSLIP_LISTEN", default_value = "127.0.0.1:8080")]
    listen: SocketAddr,
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
    /// What to log, as a filter: `info`, `warn`, `stickslip=debug`.
    #[arg(long, env = "STICKSLIP_LOG", default_value = "info")]
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

fn main() -> ExitCode {
    let cli = Cli::parse();
    let outcome = match cli.command.unwrap_or(Command::Serve(cli.serve)) {
        Command::Serve(options) => serve(options),
        Command::Simulate { file } => simulate(&file),
        Command::Openapi => print(api::document().trim_end()),
        Command::Healthcheck { listen } => healthcheck(listen),
        Command::Backup { file, store } => backup(&store, &file),
        Command::Check { store, tolerance } => check(&store, tolerance),
        Command::Figures { out } => stickslip::figures::write(&out)
            .map_err(|error| format!("cannot write figures to {}: {error}", out.display())),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn print(text: impl Display) -> Result<(), String> {
    match writeln!(io::stdout(), "{text}") {
        // A reader that has seen enough, such as `head`, is no failure.
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(format!("cannot write: {error}")),
        _ => Ok(()),
    }
}

fn simulate(file: &std::path::Path) -> Result<(), String> {
    let mut body = Vec::new();
    let read = if file.as_os_str() == "-" {
        io::stdin().lock().read_to_end(&mut body)
    } else {
        std::fs::File::open(file).and_then(|mut file| file.read_to_end(&mut body))
    };
    read.map_err(|error| format!("cannot read {}: {error}", file.display()))?;
    let reply = wire::read::<SimulateRequest>(&body)
        .map_err(Problem::from)
        .and_then(|simulation| Ok(simulation::simulate(&simulation, &Stop::default())?))
        .map_err(|problem| json(&problem.document("command line")))?;
    print(json(&reply))
}

fn json(value: &impl serde::Serialize) -> String {
    serde_json::to_string_pretty(value).unwrap_or_else(|error| error.to_string())
}

fn healthcheck(mut address: SocketAddr) -> Result<(), String> {
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

fn backup(store: &str, file: &std::path::Path) -> Result<(), String> {
    let bytes = store::backup(store, file).map_err(|error| error.to_string())?;
    print(format_args!("{} holds the store, {bytes} bytes", file.display()))
}

fn check(store: &str, tolerance: f64) -> Result<(), String> {
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build();
    let runtime = runtime.map_err(|error| format!("cannot start: {error}"))?;
    let checked = runtime.block_on(async {
        let store = store::open_to_read(store).await.map_err(|error| error.to_string())?;
        // A finding that cannot be printed counts all the same.
        let mut report = |finding: &sessions::Finding| drop(print(finding));
        sessions::check(&*store, tolerance, &mut report).await.map_err(|error| error.to_string())
    })?;
    print(checked)?;
    if checked.findings == 0 { Ok(()) } else { Err("the store is not sound".to_owned()) }
}

fn serve(options: Serve) -> Result<(), String> {
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
    let expire_after_s = options.expire_after.map(|idle| idle.as_secs());
    tracing::info!(
        version = env!("CARGO_PKG_VERSION"),
        commit = option_env!("STICKSLIP_COMMIT"),
        pid = std::process::id(),
        cache_bytes = options.cache_bytes.as_u64(),
        expire_after_s,
        "starting"
    );
    let store = runtime.block_on(store::open(&options.store)).map_err(|error| error.to_string())?;
    let served = runtime.block_on(listen(&options, Arc::clone(&store)));
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

fn idle_time(text: &str) -> Result<Duration, String> {
    let time = humantime::parse_duration(text).map_err(|error| error.to_string())?;
    if time < SHORTEST_IDLE_TIME { Err(format!("at least {SHORTEST_IDLE_TIME:?}")) } else { Ok(time) }
}

async fn listen(options: &Serve, store: Arc<dyn Store>) -> Result<(), String> {
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
    let pool = Pool::of_the_machine();
    let capacity = usize::try_from(options.cache_bytes.as_u64()).unwrap_or(usize::MAX);
    let sessions = Sessions::new(store, pool.clone(), capacity);
    tokio::spawn(sessions.clone().keep_house(options.expire_after));
    tracing::info!(%address, threads = pool.meters().threads, "listening");
    print(format_args!("stickslip listens on http://{address}, try /docs"))?;
    api::serve(listener, App { sessions, pool }, stop).await.map_err(|error| format!("stopped: {error}"))
}
