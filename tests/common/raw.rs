//! The real binary under hostile clients: raw sockets, and the memory and processor time of the process.

use std::net::SocketAddr;
use std::ops::Deref;

use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpSocket, TcpStream};
use tokio::time::timeout;

use super::PATIENCE;
use super::process::Process;

/// A server in a process of its own, killed when dropped.
pub struct Service {
    process: Process,
    pub address: SocketAddr,
}

impl Deref for Service {
    type Target = Process;

    fn deref(&self) -> &Process {
        &self.process
    }
}

/// The bytes received on a connection until it was closed.
pub struct Answer {
    pub text: String,
    /// The status of each reply.
    pub statuses: Vec<u16>,
}

impl Service {
    /// Starts it in memory and with these arguments, and waits until it listens. The log goes to a file.
    pub fn start(arguments: &[&str]) -> Service {
        Service::start_on("memory:", arguments)
    }

    /// The same with the arguments in one text.
    pub fn with(arguments: &str) -> Service {
        Service::start(&arguments.split_whitespace().collect::<Vec<_>>())
    }

    /// The same with a store.
    pub fn start_on(store: &str, arguments: &[&str]) -> Service {
        let process = Process::with(store, arguments);
        let address = process.base.trim_start_matches("http://").parse().unwrap();
        Service { process, address }
    }

    /// The memory that the process has now, bytes.
    pub fn resident(&self) -> usize {
        self.process.memory("VmRSS:")
    }

    /// Files that the process has open; a connection is one of them.
    pub fn open_files(&self) -> usize {
        std::fs::read_dir(format!("/proc/{}/fd", self.process.id())).unwrap().count()
    }

    /// Processor time that the process has had so far, ticks of the clock.
    pub fn processor_ticks(&self) -> u64 {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.process.id())).unwrap();
        let fields: Vec<&str> = stat.rsplit_once(')').unwrap().1.split_whitespace().collect();
        fields[11].parse::<u64>().unwrap() + fields[12].parse::<u64>().unwrap()
    }

    /// Opens a connection from an address of this machine.
    pub async fn connect_from(&self, source: &str) -> std::io::Result<TcpStream> {
        let socket = TcpSocket::new_v4()?;
        socket.bind(format!("{source}:0").parse().unwrap())?;
        socket.connect(self.address).await
    }

    /// Sends bytes and reads until the server closes the connection, which it must.
    pub async fn exchange(&self, bytes: &[u8]) -> Answer {
        let stream = TcpStream::connect(self.address).await.unwrap();
        talk(stream, bytes, false).await
    }

    /// The same, but says that nothing more will come.
    pub async fn send_all(&self, bytes: &[u8]) -> Answer {
        let stream = TcpStream::connect(self.address).await.unwrap();
        talk(stream, bytes, true).await
    }

    /// The status of a request on a connection of its own; none if it was closed without a reply.
    pub async fn ask(&self, source: &str, request: &str) -> Option<Answer> {
        let stream = self.connect_from(source).await.ok()?;
        let answer = talk(stream, request.as_bytes(), false).await;
        (!answer.statuses.is_empty()).then_some(answer)
    }
}

async fn talk(stream: TcpStream, bytes: &[u8], end: bool) -> Answer {
    let (mut reader, mut writer) = stream.into_split();
    let write = async {
        // The server may close the connection before it has taken everything.
        let _ = writer.write_all(bytes).await;
        if end {
            let _ = writer.shutdown().await;
        }
        writer
    };
    let read = async {
        let mut all = Vec::new();
        // A reset is an end like any other.
        let _ = reader.read_to_end(&mut all).await;
        all
    };
    let (all, _writer) =
        timeout(PATIENCE, futures::future::join(read, write)).await.expect("the connection stays open");
    let text = String::from_utf8_lossy(&all).into_owned();
    let statuses = text.split("HTTP/1.").skip(1).filter_map(|reply| reply.get(2..5)?.parse().ok()).collect();
    Answer { text, statuses }
}

/// A request with a JSON body, after which the connection is closed.
pub fn post(path: &str, body: &str) -> String {
    format!(
        "POST {path} HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\ncontent-type: application/json\r\n\
         content-length: {}\r\n\r\n{body}",
        body.len()
    )
}

/// A request without a body, after which the connection is closed.
pub fn get(path: &str) -> String {
    format!("GET {path} HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\n\r\n")
}

/// Raises the limit of open files of this process for this many connections.
pub fn room_for(connections: usize) {
    let room = stickslip::server::fd_limit::room_for(connections);
    assert!(room >= connections, "this test needs {connections} connections: ulimit -Hn 8192");
}
