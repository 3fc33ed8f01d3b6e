//! Serving until told to stop.

use std::future::Future;
use std::io;
use std::net::SocketAddr;
use std::pin::pin;
use std::sync::Arc;
use std::time::Duration;

use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::TokioIo;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::watch;
use tokio::time::{Instant, sleep, sleep_until, timeout};

use super::door::{Connections, Door, Entry, Figures, Seat, Service, Socket};
use super::limits::{BUFFER, GRACE, HEAD, SPARE_TIME};
use super::{App, refusals, router, traffic};

/// How long accepting rests after a failure: most often there are too many open files.
const REST: Duration = Duration::from_millis(50);
/// How often the log may say that connections are refused.
const QUIET: Duration = Duration::from_secs(1);

/// As [`serve_through`] a door with the usual limits.
///
/// # Errors
/// As there.
pub async fn serve(listener: TcpListener, app: App, stop: impl Future<Output = ()> + Send + 'static) -> io::Result<()> {
    serve_through(Door::new(Connections::default()), listener, app, stop).await
}

/// Serves on `listener` those whom `door` lets in, until `stop` is done. Then events end, and other requests under way may
/// finish within [`GRACE`]; what is still open after that is closed, and its work stopped.
///
/// # Errors
/// None at present: a failure to accept a connection is waited out.
pub async fn serve_through(
    door: Door,
    listener: TcpListener,
    app: App,
    stop: impl Future<Output = ()> + Send + 'static,
) -> io::Result<()> {
    let (sessions, jobs) = (app.sessions.clone(), app.jobs.clone());
    let body_time = door.limits().body;
    let (pool, traffic) = (app.pool.clone(), traffic());
    let (router, refusals) = (router(app, Arc::clone(&traffic)), refusals(traffic));
    let service = Arc::new(Service { pool, router, refusals, body_time });
    // Every connection holds a receiver, and is told by it, and counted.
    let (closing, _) = watch::channel(());
    let mut stop = pin!(stop);
    let (mut told, mut told_at) = (Figures::default(), None::<Instant>);
    loop {
        let accepted = tokio::select! {
            accepted = listener.accept() => accepted,
            () = &mut stop => break,
        };
        match accepted {
            Ok((stream, address)) => receive(&door, stream, address, &service, &closing),
            Err(error) if is_of_the_client(&error) => {}
            Err(error) => {
                tracing::warn!(%error, "no connection can be accepted; another attempt follows");
                sleep(REST).await;
            }
        }
        let figures = door.figures();
        if (figures.refused, figures.closed) != (told.refused, told.closed)
            && told_at.is_none_or(|last| last.elapsed() >= QUIET)
        {
            let Figures { open, spare, refused, closed } = figures;
            tracing::warn!(open, spare, refused, closed, "more clients than connections: some are refused or closed");
            (told, told_at) = (figures, Some(Instant::now()));
        }
    }
    tracing::info!(grace_ms = GRACE.as_millis() as u64, "stopping");
    drop(listener);
    // A client that follows a contact would never be done.
    sessions.end_events();
    jobs.end();
    // Fails if nobody is connected.
    let _ = closing.send(());
    if timeout(GRACE, closing.closed()).await.is_err() {
        tracing::warn!("connections were still open and have been closed");
        door.close_all();
    }
    Ok(())
}

/// Whether a client has gone before it was let in, which is no fault of the server.
fn is_of_the_client(error: &io::Error) -> bool {
    use io::ErrorKind::{ConnectionAborted, ConnectionRefused, ConnectionReset};
    matches!(error.kind(), ConnectionAborted | ConnectionRefused | ConnectionReset)
}

fn receive(door: &Door, stream: TcpStream, address: SocketAddr, service: &Arc<Service>, closing: &watch::Sender<()>) {
    let seat = match door.knock(address.ip()) {
        Entry::Seat(seat) | Entry::Spare(seat) => seat,
        // Closed at once.
        Entry::Refused => return,
    };
    // Replies are short and whole: waiting to fill a packet would only delay them.
    if let Err(error) = stream.set_nodelay(true) {
        tracing::debug!(%error, "TCP_NODELAY was refused");
    }
    let limits = *door.limits();
    let limits = if seat.is_spare() { Connections { head: SPARE_TIME, ..limits } } else { limits };
    let number = seat.number();
    let task = tokio::spawn(attend(stream, seat, limits, Arc::clone(service), closing.subscribe()));
    door.started(number, task.abort_handle());
}

/// Serves a connection to its end.
async fn attend(
    stream: TcpStream,
    seat: Seat,
    limits: Connections,
    service: Arc<Service>,
    mut closing: watch::Receiver<()>,
) {
    let (activity, spare) = (Arc::clone(&seat.activity), seat.is_spare());
    let stream = TokioIo::new(Socket::new(stream, Arc::clone(&activity)));
    let answer = service_fn(|request| Arc::clone(&service).serve(Arc::clone(&activity), spare, request));
    let mut http = http1::Builder::new();
    http.keep_alive(!spare).max_header_size(HEAD).max_buf_size(BUFFER);
    let mut connection = pin!(http.serve_connection(stream, answer));
    let mut alarm = pin!(sleep(limits.shortest()));
    let mut told = false;
    loop {
        tokio::select! {
            biased;
            ended = connection.as_mut() => {
                if let Err(error) = ended {
                    tracing::debug!(%error, "a connection has failed");
                }
                break;
            }
            _ = closing.changed(), if !told => {
                told = true;
                connection.as_mut().graceful_shutdown();
            }
            () = alarm.as_mut() => match activity.next_look(&limits) {
                Some(then) => alarm.set(sleep_until(then)),
                None => {
                    tracing::debug!("a client has taken too long, and its connection is closed");
                    break;
                }
            },
        }
    }
}
