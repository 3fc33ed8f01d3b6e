//! Shared by the benchmarks of the service: a server process, and a client that needs little processor time.

#![allow(dead_code, reason = "each benchmark uses a part of it")]

use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Stdio};

use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::task::JoinHandle;
use uuid::Uuid;

/// A ball under load, as the body of `POST /contacts`.
pub const CONTACT: &str = concat!(
    r#"{"profile":{"type":"sphere","radius":0.01},"friction":0.3,"preload":{"normal_force":10},"#,
    r#""material":{"effective":{"e_star":1.15e11,"g_star":8.5e10}}}"#,
);

/// Ticks of the processor time a second, on Linux.
const TICKS_PER_SECOND: f64 = 100.0;

/// A server process, ended when dropped.
pub struct Process {
    process: Child,
    /// Its address.
    pub address: String,
}

impl Process {
    /// Starts it and reads its address from its first line.
    pub fn start(mut command: Command) -> Process {
        let mut process =
            command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("the service should start");
        let output = process.stdout.take().expect("its output is piped");
        let mut line = String::new();
        BufReader::new(output).read_line(&mut line).expect("it should say where it listens");
        let address = line.split("http://").nth(1).expect("it names an address").split([',', '\n']).next();
        Process { process, address: address.expect("an address").to_owned() }
    }

    /// Memory that the process holds, in bytes.
    pub fn resident(&self) -> i64 {
        resident(&self.process.id().to_string())
    }

    /// Processor time that the process has used, in seconds.
    pub fn processor_seconds(&self) -> f64 {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.process.id())).expect("a process that runs");
        // The name of the program is in parentheses, and may contain spaces.
        let fields = stat.rsplit_once(')').expect("a name in brackets").1.split_ascii_whitespace();
        let ticks: f64 = fields.skip(11).take(2).map(|ticks| ticks.parse::<f64>().expect("a number")).sum();
        ticks / TICKS_PER_SECOND
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// Memory that a process of this name in `/proc` holds, in bytes.
pub fn resident(process: &str) -> i64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).expect("a process that runs, on Linux");
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).expect("a line of its own");
    line.trim().trim_end_matches(" kB").parse::<i64>().expect("a number") * 1024
}

/// The command that serves with a store and logs warnings alone.
pub fn serve(store: &str) -> Command {
    served_by(env!("CARGO_BIN_EXE_stickslip").as_ref(), store)
}

/// The same with the build of the service that the variable `OTHER_BUILD` names, to be measured in the same run.
pub fn serve_other(store: &str) -> Option<Command> {
    Some(served_by(&std::env::var_os("OTHER_BUILD")?, store))
}

fn served_by(program: &std::ffi::OsStr, store: &str) -> Command {
    let mut command = Command::new(program);
    command.args(["serve", "--listen", "127.0.0.1:0", "--log", "warn", "--store", store]);
    command
}

/// The command that runs this benchmark as its baseline server.
pub fn baseline() -> Command {
    let mut command = Command::new(std::env::current_exe().expect("the path of this program"));
    command.arg("baseline");
    command
}

/// Waits for all tasks.
pub async fn join<T>(tasks: impl Iterator<Item = JoinHandle<T>>) -> Vec<T> {
    // Collected first, so that all of them run.
    let ended = futures::future::join_all(tasks.collect::<Vec<_>>()).await;
    ended.into_iter().map(|result| result.expect("a task that does not panic")).collect()
}

/// The median of some values.
pub fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// A minimal HTTP client.
pub struct Connection {
    stream: TcpStream,
    buffer: Vec<u8>,
}

impl Connection {
    /// Opens a connection.
    pub async fn open(address: &str) -> Connection {
        let stream = TcpStream::connect(address).await.expect("the service should accept");
        stream.set_nodelay(true).expect("TCP_NODELAY");
        Connection { stream, buffer: Vec::new() }
    }

    /// Creates a contact of [`CONTACT`].
    pub async fn create(&mut self) -> Uuid {
        let reply: serde_json::Value =
            serde_json::from_slice(self.post("/contacts", CONTACT.as_bytes()).await).expect("a contact");
        serde_json::from_value(reply["id"].clone()).expect("an identifier")
    }

    /// The body of the reply to a `POST`.
    pub async fn post(&mut self, path: &str, body: &[u8]) -> &[u8] {
        self.send("POST", path, body).await
    }

    /// The body of the reply to a `GET`.
    pub async fn get(&mut self, path: &str) -> &[u8] {
        self.send("GET", path, b"").await
    }

    async fn send(&mut self, method: &str, path: &str, body: &[u8]) -> &[u8] {
        self.buffer.clear();
        let head = format!(
            "{method} {path} HTTP/1.1\r\nhost: localhost\r\ncontent-type: application/json\r\ncontent-length: \
                {}\r\n\r\n",
            body.len()
        );
        self.buffer.extend_from_slice(head.as_bytes());
        self.buffer.extend_from_slice(body);
        self.stream.write_all(&self.buffer).await.expect("a request sent");
        self.buffer.clear();
        loop {
            assert!(self.stream.read_buf(&mut self.buffer).await.expect("a reply") > 0, "the service hung up");
            let Some(end) = self.buffer.windows(4).position(|four| four == b"\r\n\r\n") else { continue };
            let head = std::str::from_utf8(&self.buffer[..end]).expect("a head in ASCII");
            assert!(head.starts_with("HTTP/1.1 2"), "{head}");
            let length = head.lines().find_map(|line| line.strip_prefix("content-length: ")).expect("a length");
            let length: usize = length.parse().expect("a number");
            if self.buffer.len() >= end + 4 + length {
                return &self.buffer[end + 4..end + 4 + length];
            }
        }
    }
}
