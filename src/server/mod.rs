//! The listener and its connections: who is admitted, how long a client may take, and how the server stops.

pub mod available_memory;
pub mod connection_limits;
pub mod connections;
pub mod fd_limit;
pub mod memory_budget;
pub mod tls;

use std::future::Future;
use std::io;
use std::net::{IpAddr, SocketAddr};
use std::pin::pin;
use std::sync::Arc;
use std::time::Duration;

use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::TokioIo;
#[cfg(target_os = "linux")]
use socket2::SockRef;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::watch;
use tokio::time::{Instant, sleep, sleep_until, timeout};

use connection_limits::{BUFFER, GRACE, HEAD, LAST_HEAD, PIECE, SPARE_TIME, UNSENT};
use connections::{ConnectionCounts, ConnectionPermit, Late, Socket};
use tls::Tls;

pub use connections::{ConnectionLimiter, ConnectionLimits, OwnHosts, Service, network};

/// How long to wait after a failure to accept a connection, most often because too many files are open.
const ACCEPT_RETRY_DELAY: Duration = Duration::from_millis(50);
/// The least time between two log lines about refused connections.
const LOG_INTERVAL: Duration = Duration::from_secs(1);

/// Serves on `listener`, by TLS if it is given, the connections that `limiter` admits, until `stop` is done. Then
/// `end_streams` is called, and other requests may be done within the time that the limits give; what is left then is
/// refused. Connections that are still open [`GRACE`] later are closed. A failure to accept a connection is waited out.
pub async fn serve(
    limiter: ConnectionLimiter,
    listener: TcpListener,
    tls: Option<Tls>,
    service: Service,
    stop: impl Future<Output = ()> + Send + 'static,
    end_streams: impl FnOnce(),
) {
    let service = Arc::new(service);
    // Every connection holds a receiver: it is notified by it, and counted.
    let (closing, _) = watch::channel(());
    let mut stop = pin!(stop);
    let (mut logged, mut logged_at) = (ConnectionCounts::default(), None::<Instant>);
    loop {
        let accepted = tokio::select! {
            accepted = listener.accept() => accepted,
            () = &mut stop => break,
        };
        match accepted {
            Ok((stream, address)) => accept(&limiter, stream, address, tls.as_ref(), &service, &closing),
            Err(error) if is_client_fault(&error) => {}
            Err(error) => {
                tracing::warn!(%error, "no connection can be accepted; the server tries again");
                sleep(ACCEPT_RETRY_DELAY).await;
            }
        }
        let counts = limiter.counts();
        if (counts.refused, counts.closed) != (logged.refused, logged.closed)
            && logged_at.is_none_or(|last| last.elapsed() >= LOG_INTERVAL)
        {
            let ConnectionCounts { open, spare, refused, closed } = counts;
            tracing::warn!(open, spare, refused, closed, "all connections are taken: some are refused or closed");
            (logged, logged_at) = (counts, Some(Instant::now()));
        }
    }
    let drain = limiter.limits.drain;
    tracing::info!(drain_ms = drain.as_millis() as u64, "stopping");
    drop(listener);
    end_streams();
    // Fails if there is no connection.
    let _ = closing.send(());
    if timeout(drain, closing.closed()).await.is_err() {
        tracing::warn!("the server stops: requests that have not finished are refused");
        service.stopping.send_replace(true);
    }
    if timeout(GRACE, closing.closed()).await.is_err() {
        tracing::warn!("connections were still open and have been closed");
        limiter.close_all();
    }
}

/// Whether the client closed the connection before it was accepted.
fn is_client_fault(error: &io::Error) -> bool {
    use io::ErrorKind::{ConnectionAborted, ConnectionRefused, ConnectionReset};
    matches!(error.kind(), ConnectionAborted | ConnectionRefused | ConnectionReset)
}

fn accept(
    limiter: &ConnectionLimiter,
    stream: TcpStream,
    address: SocketAddr,
    tls: Option<&Tls>,
    service: &Arc<Service>,
    closing: &watch::Sender<()>,
) {
    let Some(permit) = limiter.admit(address.ip()) else { return };
    // Replies are short and written at once: waiting to fill a packet would only delay them.
    if let Err(error) = stream.set_nodelay(true) {
        tracing::debug!(%error, "TCP_NODELAY was refused");
    }
    // Otherwise the socket's buffer takes megabytes at once, then nothing for as long as a slow client reads of them.
    #[cfg(target_os = "linux")]
    if let Err(error) = SockRef::from(&stream).set_tcp_notsent_lowat(UNSENT) {
        tracing::debug!(%error, "TCP_NOTSENT_LOWAT was refused");
    }
    let limits = limiter.limits;
    let limits = if permit.is_spare() { ConnectionLimits { head: SPARE_TIME, ..limits } } else { limits };
    let number = permit.number;
    let (service, mut closing, peer) = (Arc::clone(service), closing.subscribe(), address.ip());
    let task = match tls.map(Tls::acceptor) {
        None => tokio::spawn(serve_connection(stream, peer, permit, limits, service, closing)),
        Some(acceptor) => tokio::spawn(async move {
            let accept = acceptor.accept_with(stream, |tls| tls.set_buffer_limit(Some(PIECE)));
            let accepted = tokio::select! {
                accepted = timeout(limits.head, accept) => accepted,
                _ = closing.changed() => return,
            };
            match accepted {
                Ok(Ok(stream)) => serve_connection(stream, peer, permit, limits, service, closing).await,
                Ok(Err(error)) => tracing::debug!(%error, "a TLS handshake has failed"),
                Err(_) => tracing::debug!("a client has taken too long for the TLS handshake"),
            }
        }),
    };
    limiter.started(number, task.abort_handle());
}

async fn serve_connection<S: AsyncRead + AsyncWrite + Unpin>(
    stream: S,
    peer: IpAddr,
    permit: ConnectionPermit,
    mut limits: ConnectionLimits,
    service: Arc<Service>,
    mut closing: watch::Receiver<()>,
) {
    let (activity, spare) = (Arc::clone(&permit.activity), permit.is_spare());
    let stream = TokioIo::new(Socket::new(stream, Arc::clone(&activity)));
    let answer = service_fn(|request| Arc::clone(&service).serve(Arc::clone(&activity), spare, peer, request));
    let mut http = http1::Builder::new();
    http.header_read_timeout(None).keep_alive(!spare).max_header_size(HEAD).max_buf_size(BUFFER);
    let mut connection = pin!(http.serve_connection(stream, answer));
    let mut check = pin!(sleep(limits.shortest()));
    let mut shutting_down = false;
    loop {
        tokio::select! {
            biased;
            ended = connection.as_mut() => {
                if let Err(error) = ended {
                    tracing::debug!(%error, "a connection has failed");
                }
                break;
            }
            _ = closing.changed(), if !shutting_down => {
                shutting_down = true;
                // The library waits for the rest of a head. A spare connection is for health checks, which are over.
                if spare && activity.try_close() {
                    break;
                }
                connection.as_mut().graceful_shutdown();
                limits.head = limits.head.min(LAST_HEAD);
                activity.restart_head();
                check.set(sleep(limits.head));
            }
            () = check.as_mut() => match activity.next_check(&limits) {
                Ok(then) => check.set(sleep_until(then)),
                Err(Late::Head) => {
                    tracing::debug!(client = %peer, "a client has taken too long for the head of a request");
                    break;
                }
                Err(Late::Reply) => {
                    tracing::info!(client = %peer, "a client has taken too long to read a reply: it is cut off");
                    break;
                }
            },
        }
    }
}
