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
use stickslip::api::descriptors::room_for;
use stickslip::api::door::MOST;
use stickslip::api::{self, App, Connections, Door, Problem, bound};
use stickslip::client::Client;
use stickslip::sessions::{self, Sessions};
use stickslip::simulation::{self, Capacity, Pool, Stop};
use stickslip::store::{self, Store};
use stickslip::wire::{self, SimulateRequest};
use tokio::net::TcpListener;
use tokio::signal::unix::{SignalKind, signal};
use tracing_subscriber::EnvFilter;

/// How long work that does not look at its flag may hold up the end of the process.
const LAST_WORK: Duration = Duration::from_millis(500);

/// How long a service may take to say that it is well.
const LONGEST_ANSWER: Duration = Duration::from_secs(2);

/// The times that clients can be given.
const SHORTEST_TIME: Duration = Duration::from_millis(10);
const LONGEST_TIME: Duration = Duration::from_secs(24 * 60 * 60);

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
    Serve(Box<Serve>),
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
    #[command(flatten)]
    overload: Overload,
    /// What to log, as a filter: `info`, `warn`, `stickslip=debug`.
    #[arg(long, env = "STICKSLIP_LOG", default_value = "info")]
    log: String,
    /// How to log it.
    #[arg(long, env = "STICKSLIP_LOG_FORMAT", value_enum, default_value_t = LogFormat::Text)]
    log_format: LogFormat,
}

/// How much the service takes on at a time, and how long it waits: docs/overload.md says what follows from it.
#[derive(Args)]
struct Overload {
    /// Connections at a time.
    #[arg(long, env = "STICKSLIP_MAX_CONNECTIONS", default_value_t = MOST, value_parser = at_least_one)]
    max_connections: usize,
    /// Connections of one client address at a time; left out, half of all. Behind a proxy all clients have one address.
    #[arg(long, env = "STICKSLIP_MAX_CONNECTIONS_PER_CLIENT", value_parser = at_least_one)]
    max_connections_per_client: Option<usize>,
    /// Requests worked on at a time; more wait.
    #[arg(long, env = "STICKSLIP_MAX_REQUESTS", default_value_t = simulation::REQUESTS, value_parser = at_least_one)]
    max_requests: usize,
    /// Requests that wait at a time; more are refused.
    #[arg(long, env = "STICKSLIP_MAX_QUEUE", default_value_t = simulation::QUEUE, value_parser = at_least_one)]
    max_queue: usize,
    /// How long a request waits before it is refused.
    #[arg(long, env = "STICKSLIP_MAX_WAIT", default_value = "10s", value_parser = duration)]
    max_wait: Duration,
    /// Bytes of memory for large bodies, their work and their replies, all together.
    #[arg(long, env = "STICKSLIP_WORK_BYTES", default_value_t = ByteSize::b(simulation::BYTES as u64), value_parser = work_bytes)]
    work_bytes: ByteSize,
    /// How long the solver works for one request before it is stopped.
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
    /// How long a client may take nothing of a reply or of events.
    #[arg(long, env = "STICKSLIP_STALL_TIME", default_value = "30s", value_parser = duration)]
    stall_time: Duration,
}

impl Overload {
    fn capacity(&self) -> Capacity {
        Capacity {
            requests: self.max_requests,
            queue: self.max_queue,
            wait: self.max_wait,
            deadline: self.deadline,
            bytes: usize::try_from(self.work_bytes.as_u64()).unwrap_or(usize::MAX),
            ..Capacity::default()
        }
    }

    /// The connections, as far as the process may have so many files open.
    fn connections(&self) -> Connections {
        let most = room_for(self.max_connections);
        if most < self.max_connections {
            let asked = self.max_connections;
            tracing::warn!(asked, most, "fewer connections than asked for: raise the limit of open files (ulimit -n)");
        }
        let per_client = self.max_connections_per_client.unwrap_or(most.div_ceil(2));
        let (head, body, idle, stall) = (self.head_time, self.body_time, self.idle_time, self.stall_time);
        Connections { most, per_client, head, body, idle, stall }
    }
}

#[derive(Clone, Copy, ValueEnum)]
enum LogFormat {
    Text,
    Json,
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let outcome = match cli.command.unwrap_or(Command::Serve(Box::new(cli.serve))) {
        Command::Serve(options) => serve(&options),
        Command::Simulate { file } => simulate(&file),
        Command::Openapi => print(api::document().trim_end()),
        Command::Healthcheck { listen } => healthcheck(listen),
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

fn serve(options: &Serve) -> Result<(), String> {
    let filter = EnvFilter::try_new(&options.log).map_err(|error| format!("--log {}: {error}", options.log))?;
    let log = tracing_subscriber::fmt().with_env_filter(filter).with_writer(io::stderr);
    match options.log_format {
        LogFormat::Text => log.with_ansi(false).init(),
        LogFormat::Json => log.json().flatten_event(true).init(),
    }
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build();
    let runtime = runtime.map_err(|error| format!("cannot start: {error}"))?;
    let store = runtime.block_on(store::open(&options.store)).map_err(|error| error.to_string())?;
    let served = runtime.block_on(listen(options, Arc::clone(&store)));
    runtime.shutdown_timeout(LAST_WORK);
    // The last handle, now that no request holds one: the store is closed before the process ends.
    drop(store);
    served
}

fn duration(text: &str) -> Result<Duration, String> {
    let time = humantime::parse_duration(text).map_err(|error| error.to_string())?;
    let (least, most) = (SHORTEST_TIME, LONGEST_TIME);
    if (least..=most).contains(&time) { Ok(time) } else { Err(format!("{least:?} to {most:?} are allowed")) }
}

fn work_bytes(text: &str) -> Result<ByteSize, String> {
    let (size, least) = (text.parse::<ByteSize>()?, ByteSize::b(simulation::LARGEST as u64));
    if size < least { Err(format!("at least {least}: one request can take as much")) } else { Ok(size) }
}

fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) => Err("at least 1".to_owned()),
        Ok(number) => Ok(number),
        Err(_) => Err("not a whole number".to_owned()),
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
    let pool = Pool::new(options.overload.capacity());
    let door = Door::new(options.overload.connections());
    let bytes = bound::memory(door.limits(), pool.capacity(), options.cache_bytes.as_u64());
    tracing::info!(bytes, "memory stays below this bound");
    let capacity = usize::try_from(options.cache_bytes.as_u64()).unwrap_or(usize::MAX);
    let sessions = Sessions::new(store, pool.clone(), capacity);
    tokio::spawn(sessions.clone().keep_house(options.expire_after));
    print(format_args!("stickslip listens on http://{address}, try /docs"))?;
    api::serve_through(door, listener, App { sessions, pool }, stop).await.map_err(|error| format!("stopped: {error}"))
}
