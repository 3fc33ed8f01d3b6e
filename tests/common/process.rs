//! The real binary as a process of its own.

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

use stickslip_wire::client::Client;

/// A server that can be killed. What still runs at the end of a test is killed too.
pub struct Process {
    // None once it has ended.
    child: Option<Child>,
    pub base: String,
    pub client: Client,
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

    /// Starts a server with these arguments, and its log in a file.
    pub async fn start_with(arguments: &[&str], log: &Path) -> Process {
        let mut command = super::binary(&["serve", "--listen", "127.0.0.1:0"]);
        command.args(arguments).stderr(std::fs::File::create(log).unwrap());
        Process::of(command).await
    }

    /// Starts a server by a command, and waits until it listens.
    pub async fn of(command: Command) -> Process {
        tokio::task::spawn_blocking(move || Process::at_once(command)).await.unwrap()
    }

    /// The same, for which it blocks the thread.
    pub fn at_once(command: Command) -> Process {
        let (child, base) = listening(command);
        Process::running(child, &base)
    }

    /// A server that runs already, by its address.
    pub fn running(child: Child, base: &str) -> Process {
        Process { child: Some(child), base: base.to_owned(), client: Client::new(base) }
    }

    /// Its number.
    pub fn id(&self) -> u32 {
        self.child.as_ref().unwrap().id()
    }

    /// The most memory that the process has had so far, bytes.
    pub fn peak(&self) -> u64 {
        self.memory("VmHWM:")
    }

    /// A line of the status of the process, bytes.
    pub fn memory(&self, name: &str) -> u64 {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.id())).unwrap();
        let line = status.lines().find_map(|line| line.strip_prefix(name)).unwrap();
        line.split_whitespace().next().unwrap().parse::<u64>().unwrap() * 1024
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

    /// SIGTERM, and a graceful end awaited.
    pub async fn stop(mut self) {
        self.signal("TERM");
        let mut child = self.child.take().unwrap();
        let status = tokio::task::spawn_blocking(move || child.wait().unwrap()).await.unwrap();
        assert!(status.success(), "{status}");
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
