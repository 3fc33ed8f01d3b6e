//! The real binary as a process of its own.

use std::fs::File;
use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Output, Stdio};

use stickslip_wire::client::Client;
use tempfile::TempDir;

/// A server that can be killed. What still runs at the end of a test is killed too.
pub struct Process {
    // None once it has ended.
    child: Option<Child>,
    pub base: String,
    pub client: Client,
    /// Where its log is, if it is kept.
    folder: Option<TempDir>,
}

fn command(prefix: &[String], store: &str) -> Command {
    let binary = [env!("CARGO_BIN_EXE_stickslip").to_owned()];
    let mut words = prefix.iter().chain(&binary);
    let mut command = super::clean(Command::new(words.next().unwrap()));
    command.args(words);
    command.args(["serve", "--listen", "127.0.0.1:0", "--log", "warn", "--store", store]);
    command
}

impl Process {
    /// Starts a server over a store and waits until it listens.
    pub async fn start(store: &str) -> Process {
        Process::start_by(&[], store).await
    }

    /// The same by way of a program that becomes it, such as `nsenter` with its arguments.
    pub async fn start_by(prefix: &[String], store: &str) -> Process {
        Process::of(command(prefix, store)).await
    }

    /// Starts a server over a store with these arguments, keeps its log, and waits until it listens.
    pub fn with(store: &str, arguments: &[&str]) -> Process {
        Process::at("127.0.0.1:0", store, arguments)
    }

    /// The same at an address.
    pub fn at(address: &str, store: &str, arguments: &[&str]) -> Process {
        let folder = tempfile::tempdir().unwrap();
        let mut command = super::binary(&["serve", "--listen", address, "--store", store]);
        command.args(arguments).stderr(File::create(folder.path().join("log")).unwrap());
        let (child, base) = listening(command);
        let mut process = Process::running(child, &base);
        process.folder = Some(folder);
        process
    }

    /// Everything in its log so far.
    pub fn log(&self) -> String {
        let folder = self.folder.as_ref().expect("its log is not kept");
        if self.child.is_some() {
            // Lines gather for some milliseconds before they are written together.
            std::thread::sleep(std::time::Duration::from_millis(100));
        }
        std::fs::read_to_string(folder.path().join("log")).unwrap()
    }

    /// Starts a server by a command, and waits until it listens.
    pub async fn of(command: Command) -> Process {
        let (child, base) = tokio::task::spawn_blocking(move || listening(command)).await.unwrap();
        Process::running(child, &base)
    }

    /// A server that runs already, by its address.
    pub fn running(child: Child, base: &str) -> Process {
        Process { child: Some(child), base: base.to_owned(), client: Client::new(base), folder: None }
    }

    /// Its number.
    pub fn id(&self) -> u32 {
        self.child.as_ref().unwrap().id()
    }

    /// The most memory that the process has had so far, bytes.
    pub fn peak(&self) -> usize {
        self.memory("VmHWM:")
    }

    /// A line of the status of the process, bytes.
    pub fn memory(&self, name: &str) -> usize {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.id())).unwrap();
        let line = status.lines().find_map(|line| line.strip_prefix(name)).unwrap();
        line.split_whitespace().next().unwrap().parse::<usize>().unwrap() * 1024
    }

    /// Sends a signal, such as `HUP`.
    pub fn signal(&self, name: &str) {
        assert!(Command::new("kill").args([&format!("-{name}"), &self.id().to_string()]).status().unwrap().success());
    }

    /// SIGKILL, and the end awaited.
    pub async fn kill(mut self) {
        let mut child = self.child.take().unwrap();
        child.kill().unwrap();
        tokio::task::spawn_blocking(move || child.wait().unwrap()).await.unwrap();
    }

    /// SIGTERM, and a graceful end awaited; the log, if it is kept.
    pub async fn stop(self) -> String {
        self.signal("TERM");
        self.ended().await
    }

    /// Waits until it ends gracefully; the log, if it is kept.
    pub async fn ended(mut self) -> String {
        let mut child = self.child.take().unwrap();
        let end = tokio::task::spawn_blocking(move || child.wait().unwrap());
        let status = tokio::time::timeout(super::PATIENCE, end).await.expect("it does not stop").unwrap();
        assert!(status.success(), "{status}");
        self.folder.as_ref().map(|_| self.log()).unwrap_or_default()
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        if let Some(child) = &mut self.child {
            // It may have ended by itself.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// Starts a server by a command, and waits until it says where it listens.
pub fn listening(mut command: Command) -> (Child, String) {
    let mut child = command.stdout(Stdio::piped()).spawn().unwrap();
    let Some(Ok(line)) = BufReader::new(child.stdout.take().unwrap()).lines().next() else {
        panic!("the server ended at once: {:?}", child.wait());
    };
    let base = line.split_whitespace().find(|word| word.starts_with("http")).unwrap().trim_end_matches(',');
    (child, base.to_owned())
}

/// The output of a server that cannot start, after it has exited by itself.
pub fn refused(store: &str) -> Output {
    ended(&mut command(&[], store))
}

/// The output of a process that must end by itself.
pub fn ended(command: &mut Command) -> Output {
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    for _ in 0..1000 {
        if child.try_wait().unwrap().is_some() {
            return child.wait_with_output().unwrap();
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    child.kill().unwrap();
    panic!("it runs on: {command:?} {:?}", child.wait_with_output().unwrap());
}
