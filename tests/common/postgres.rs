//! A real PostgreSQL in a temporary directory, removed when the process that started it ends in any way.

use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

use tokio::net::TcpSocket;
use tokio_postgres::NoTls;

const MISSING: &str = "this test needs PostgreSQL: `./check` installs it, or on Debian `apt-get install postgresql`";

/// A server with its data.
pub struct Cluster {
    folder: PathBuf,
    programs: PathBuf,
    owner: Option<(u32, u32)>,
    port: u16,
    // Keeps the port while the server is not yet there, or away.
    _reserved: TcpSocket,
    // Its standard input ends when this process does, and then it clears up.
    _janitor: Child,
}

impl Cluster {
    /// The server that the tests of one binary share.
    pub fn shared() -> &'static Cluster {
        static SHARED: OnceLock<Cluster> = OnceLock::new();
        SHARED.get_or_init(Cluster::start)
    }

    /// A server of its own, for a test that stops it.
    pub fn start() -> Cluster {
        let programs = programs();
        let owner = owner();
        let (port, reserved) = super::port::reserve();
        let folder = std::env::temp_dir().join(format!("stickslip-postgres-{}-{port}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        if let Some((user, group)) = owner {
            std::os::unix::fs::chown(&folder, Some(user), Some(group)).unwrap();
        }
        let janitor = format!(
            "read line; '{}' -D '{}' -m immediate -s stop; rm -rf '{}'",
            programs.join("pg_ctl").display(),
            folder.join("data").display(),
            folder.display(),
        );
        let janitor = as_owner(Command::new("sh").args(["-c", &janitor]), owner)
            .process_group(0)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let cluster = Cluster { folder, programs, owner, port, _reserved: reserved, _janitor: janitor };
        let data = cluster.data();
        cluster.run("initdb", &["-D", &data, "-U", "stickslip", "-A", "trust", "-E", "UTF8", "--locale=C", "-N"]);
        cluster.resume();
        cluster
    }

    /// Starts the server, and waits until it takes connections.
    pub fn resume(&self) {
        let options = format!(
            "-p {} -h 127.0.0.1 -k '{}' -c fsync=on -c synchronous_commit=on -c shared_buffers=32MB",
            self.port,
            self.folder.display()
        );
        let log = self.folder.join("log");
        self.run("pg_ctl", &["-D", &self.data(), "-l", log.to_str().unwrap(), "-o", &options, "-w", "-s", "start"]);
    }

    /// Stops the server as a power failure would: nothing more is written.
    pub fn crash(&self) {
        self.run("pg_ctl", &["-D", &self.data(), "-m", "immediate", "-w", "-s", "stop"]);
    }

    /// Stops the processes of the server where they are, until the result is dropped.
    pub fn freeze(&self) -> Frozen {
        let file = std::fs::read_to_string(self.folder.join("data/postmaster.pid")).unwrap();
        let main = file.lines().next().unwrap().trim().to_owned();
        // It makes no more processes once it is stopped.
        signal("-STOP", std::slice::from_ref(&main));
        let children = std::fs::read_to_string(format!("/proc/{main}/task/{main}/children")).unwrap();
        let children: Vec<String> = children.split_whitespace().map(str::to_owned).collect();
        signal("-STOP", &children);
        Frozen(children.into_iter().chain([main]).collect())
    }

    /// Starts the server again with TLS, and with nothing else for connections over TCP. Returns the path of its
    /// certificate, which is for `localhost` and signed by itself.
    pub fn encrypt(&self) -> PathBuf {
        let (key, certificate) = (self.folder.join("data/server.key"), self.folder.join("data/server.crt"));
        let mut openssl = Command::new("openssl");
        openssl.args("req -x509 -nodes -newkey rsa:2048 -days 2 -subj /CN=localhost".split(' '));
        openssl.args(["-addext", "subjectAltName=DNS:localhost", "-addext", "basicConstraints=critical,CA:FALSE"]);
        openssl.arg("-keyout").arg(&key).arg("-out").arg(&certificate).stderr(Stdio::null());
        assert!(as_owner(&mut openssl, self.owner).status().unwrap().success(), "openssl failed");
        self.crash();
        let rules = "local all all trust\nhostssl all all all trust\n";
        std::fs::write(self.folder.join("data/pg_hba.conf"), rules).unwrap();
        let settings = self.folder.join("data/postgresql.auto.conf");
        std::fs::write(settings, "ssl = on\n").unwrap();
        self.resume();
        certificate
    }

    /// The URL of a new, empty database.
    pub async fn database(&self) -> String {
        self.made_of("template1").await
    }

    /// The URL of a copy of a database, whose connections are ended.
    pub async fn copy(&self, url: &str) -> String {
        let name = url.rsplit('/').next().unwrap();
        let client = connected(&self.url("postgres")).await;
        let end = "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = $1";
        client.execute(end, &[&name]).await.unwrap();
        self.made_of(name).await
    }

    async fn made_of(&self, template: &str) -> String {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("test_{}", COUNT.fetch_add(1, Ordering::Relaxed));
        self.execute("postgres", &format!("CREATE DATABASE {name} TEMPLATE {template}")).await;
        self.url(&name)
    }

    /// Runs statements on a database as its owner.
    pub async fn execute(&self, database: &str, statements: &str) {
        let (client, connection) = tokio_postgres::connect(&self.url(database), NoTls).await.unwrap();
        let connection = tokio::spawn(connection);
        client.batch_execute(statements).await.unwrap();
        drop(client);
        connection.await.unwrap().unwrap();
    }

    fn url(&self, database: &str) -> String {
        format!("postgres://stickslip@127.0.0.1:{}/{database}", self.port)
    }

    fn data(&self) -> String {
        self.folder.join("data").to_str().unwrap().to_owned()
    }

    fn run(&self, program: &str, arguments: &[&str]) {
        let mut command = Command::new(self.programs.join(program));
        // Not a pipe: the server inherits it and would hold it open.
        let errors = std::fs::OpenOptions::new().create(true).append(true).open(self.folder.join("errors")).unwrap();
        command.args(arguments).current_dir(&self.folder).stdin(Stdio::null()).stdout(Stdio::null()).stderr(errors);
        let status = as_owner(&mut command, self.owner).status().unwrap();
        let errors = std::fs::read_to_string(self.folder.join("errors")).unwrap_or_default();
        assert!(status.success(), "{program} failed: {errors}");
    }
}

/// Processes that are stopped, and run on when this is dropped.
pub struct Frozen(Vec<String>);

impl Drop for Frozen {
    fn drop(&mut self) {
        signal("-CONT", &self.0);
    }
}

fn signal(name: &str, processes: &[String]) {
    // One of them may have ended meanwhile.
    let _ = Command::new("kill").arg(name).args(processes).stderr(Stdio::null()).status();
}

/// Where the server's programs are: on Debian, not on the path.
fn programs() -> PathBuf {
    let mut versions: Vec<PathBuf> = std::fs::read_dir("/usr/lib/postgresql")
        .map(|versions| versions.flatten().map(|version| version.path().join("bin")).collect())
        .unwrap_or_default();
    versions.extend(std::env::var_os("PATH").iter().flat_map(std::env::split_paths));
    versions.sort();
    versions.into_iter().rev().find(|folder| folder.join("initdb").exists()).expect(MISSING)
}

/// The server refuses to run as root: then it runs as the user that its package has made.
fn owner() -> Option<(u32, u32)> {
    let id = |arguments: &[&str]| {
        let output = Command::new("id").args(arguments).output().unwrap();
        String::from_utf8(output.stdout).unwrap().trim().parse::<u32>().expect(MISSING)
    };
    (id(&["-u"]) == 0).then(|| (id(&["-u", "postgres"]), id(&["-g", "postgres"])))
}

fn as_owner(command: &mut Command, owner: Option<(u32, u32)>) -> &mut Command {
    if let Some((user, group)) = owner {
        command.uid(user).gid(group).current_dir(Path::new("/"));
    }
    command
}

/// A connection to a database.
pub async fn connected(url: &str) -> tokio_postgres::Client {
    let (client, connection) = tokio_postgres::connect(url, NoTls).await.unwrap();
    tokio::spawn(connection);
    client
}
