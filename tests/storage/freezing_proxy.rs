//! A proxy between a replica and PostgreSQL that falls silent in the middle of a certain statement, as the replica does
//! when its process is stopped or its network is gone: the server has executed the statement, and waits for what comes
//! after it.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::tcp::{OwnedReadHalf, OwnedWriteHalf};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::watch;

use super::fixtures::soon;

/// The message that ends a request (`Sync`): without it, or with it and without any answer.
const SYNC: u8 = b'S';
/// The code of a request for TLS, in place of the version of the protocol.
const TLS_REQUEST: u32 = 80_877_103;

/// Where a proxy falls silent.
#[derive(Clone, Copy)]
pub enum Silence {
    /// Before the end of the statement, which would commit it.
    Inside,
    /// After the statement, in the middle of its transaction.
    After,
}

/// The proxy. Its connections are closed when it is dropped.
pub struct FreezingProxy {
    /// The URL of the database behind it.
    pub url: String,
    shared: Arc<Shared>,
    /// While it is set, connections are closed, and new ones wait.
    cut: watch::Sender<bool>,
}

struct Shared {
    /// A part of the statement in which it falls silent next.
    armed: Mutex<Option<(&'static str, Silence)>>,
    silent: watch::Sender<bool>,
}

impl FreezingProxy {
    /// A proxy of the database of a URL.
    pub async fn start(url: &str) -> FreezingProxy {
        let (head, database) = url.rsplit_once('/').unwrap();
        let (user, server) = head.rsplit_once('@').unwrap();
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let url = format!("{user}@{}/{database}", listener.local_addr().unwrap());
        let shared = Arc::new(Shared { armed: Mutex::default(), silent: watch::Sender::new(false) });
        let (cut, is_cut) = watch::channel(false);
        let (server, of_proxy) = (server.to_owned(), Arc::clone(&shared));
        tokio::spawn(async move {
            while let Ok((client, _)) = listener.accept().await {
                let (server, shared, mut is_cut) = (server.clone(), Arc::clone(&of_proxy), is_cut.clone());
                tokio::spawn(async move {
                    let _ = is_cut.wait_for(|cut| !cut).await;
                    let server = TcpStream::connect(&server).await.unwrap();
                    let ((from_client, to_client), (from_server, to_server)) =
                        (client.into_split(), server.into_split());
                    tokio::select! {
                        _ = requests(&shared, from_client, to_server) => {}
                        _ = answers(&shared, from_server, to_client) => {}
                        () = set(&mut is_cut) => {}
                    }
                });
            }
        });
        FreezingProxy { url, shared, cut }
    }

    /// Falls silent at the next execution of a statement with this part, on all connections.
    pub fn arm(&self, statement: &'static str, silence: Silence) {
        *self.shared.armed.lock().unwrap() = Some((statement, silence));
    }

    /// Closes all connections, and lets new ones wait until [`FreezingProxy::restore`].
    pub fn cut(&self) {
        self.cut.send_replace(true);
        self.shared.silent.send_replace(false);
    }

    /// Lets connections through again.
    pub fn restore(&self) {
        self.cut.send_replace(false);
    }

    /// Waits until it is silent.
    pub async fn silent(&self) {
        soon(self.shared.silent.subscribe().wait_for(|silent| *silent)).await.unwrap();
    }
}

impl Drop for FreezingProxy {
    fn drop(&mut self) {
        self.cut.send_replace(true);
    }
}

/// Waits until it is set.
async fn set(watched: &mut watch::Receiver<bool>) {
    let _ = watched.wait_for(|set| *set).await;
}

/// Passes answers on until it is silent.
async fn answers(shared: &Shared, mut server: OwnedReadHalf, mut client: OwnedWriteHalf) -> std::io::Result<()> {
    let (mut silent, mut bytes) = (shared.silent.subscribe(), vec![0; 65_536]);
    loop {
        let length = tokio::select! {
            biased;
            () = set(&mut silent) => return std::future::pending().await,
            read = server.read(&mut bytes) => read?,
        };
        if length == 0 {
            return Ok(());
        }
        client.write_all(&bytes[..length]).await?;
    }
}

/// Passes requests on, a message at a time, until it is silent.
async fn requests(shared: &Shared, mut client: OwnedReadHalf, mut server: OwnedWriteHalf) -> std::io::Result<()> {
    let (silent, mut statements) = (shared.silent.subscribe(), HashMap::<Vec<u8>, Vec<u8>>::new());
    let (mut started, mut armed) = (false, None);
    loop {
        let mut message = Vec::new();
        if started {
            message.push(client.read_u8().await?);
        }
        let length = client.read_u32().await?;
        message.extend(length.to_be_bytes());
        let begin = message.len();
        message.resize(begin + length as usize - 4, 0);
        client.read_exact(&mut message[begin..]).await?;
        let is_silent = *silent.borrow();
        if is_silent {
            return std::future::pending().await;
        }
        let mut texts = message[begin..].split(|byte| *byte == 0).map(<[u8]>::to_vec);
        match message[0] {
            _ if !started => started = message[begin..begin + 4] != TLS_REQUEST.to_be_bytes(),
            // Its name and its text; a binding names its portal and its statement.
            b'P' => drop(statements.insert(texts.next().unwrap(), texts.next().unwrap())),
            b'B' => {
                let text =
                    texts.nth(1).and_then(|name| statements.get(&name)).map(|text| String::from_utf8_lossy(text));
                let mut waiting = shared.armed.lock().unwrap();
                if waiting.is_some_and(|(part, _)| text.is_some_and(|text| text.contains(part))) {
                    armed = waiting.take();
                }
            }
            SYNC if let Some((_, silence)) = armed => {
                if let Silence::After = silence {
                    server.write_all(&message).await?;
                }
                shared.silent.send_replace(true);
                return std::future::pending().await;
            }
            _ => {}
        }
        server.write_all(&message).await?;
    }
}
