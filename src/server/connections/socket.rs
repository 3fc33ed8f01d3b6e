//! The stream of a connection: records what the client sends and reads, inspects the head of each request from its
//! first byte, and hands on nothing beyond a request until its reply is done.

use std::io::{self, IoSlice};
use std::mem::MaybeUninit;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, Waker, ready};

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};

use super::ConnectionActivity;
use super::chunks::ChunkEnd;
use super::smuggling::{BodyLength, RequestSmugglingGuard};

/// Bytes beyond a request that are read while it is served. They wait in [`Socket`], so that they are a part of what a
/// connection may take.
const AHEAD: usize = 16 * 1024;
/// Bytes of them that are read at a time.
const PART: usize = 1024;

/// The stream of a connection.
#[derive(Debug)]
pub struct Socket<S> {
    stream: S,
    activity: Arc<ConnectionActivity>,
    expected: Expected,
    /// Received beyond the present request: up to one read while it arrived, and up to [`AHEAD`] while it waits.
    held: Vec<u8>,
    /// Waits for the end of the reply.
    waiting: Option<Waker>,
}

/// What the next bytes belong to.
#[derive(Debug)]
enum Expected {
    Head(RequestSmugglingGuard),
    /// A body with this many bytes to come.
    Body(u64),
    /// A body in chunks, after which the reply closes the connection.
    Chunks(ChunkEnd),
    /// What follows the request, which must wait for the reply.
    Next,
    /// A request that is refused by its head, the last of the connection.
    Last,
}

impl<S> Socket<S> {
    /// The stream of a connection with this activity.
    pub fn new(stream: S, activity: Arc<ConnectionActivity>) -> Socket<S> {
        let expected = Expected::Head(RequestSmugglingGuard::default());
        Socket { stream, activity, expected, held: Vec::new(), waiting: None }
    }

    fn record(&self, written: Poll<io::Result<usize>>) -> Poll<io::Result<usize>> {
        match &written {
            Poll::Pending => self.activity.write_blocked(),
            Poll::Ready(Ok(bytes)) => self.activity.wrote(*bytes),
            Poll::Ready(Err(_)) => {}
        }
        written
    }

    /// How many of these bytes belong to the present request.
    fn of_request(&mut self, bytes: &[u8]) -> usize {
        let mut taken = 0;
        if let Expected::Head(guard) = &mut self.expected {
            self.activity.received_head();
            match guard.inspect(bytes) {
                Ok(None) => return bytes.len(),
                Ok(Some((end, body))) => {
                    taken = end;
                    self.expected = match body {
                        BodyLength::Bytes(0) => Expected::Next,
                        BodyLength::Bytes(length) => Expected::Body(length),
                        BodyLength::Chunked => Expected::Chunks(ChunkEnd::default()),
                    };
                }
                Err(fault) => {
                    self.activity.reject_head(fault);
                    self.expected = Expected::Last;
                }
            }
        }
        let rest = bytes.len() - taken;
        match &mut self.expected {
            Expected::Head(_) | Expected::Last => bytes.len(),
            Expected::Next => taken,
            Expected::Chunks(chunks) => {
                let part = chunks.find(&bytes[taken..]);
                if part.is_some() {
                    self.expected = Expected::Next;
                }
                taken + part.unwrap_or(rest)
            }
            Expected::Body(left) => {
                let part = usize::try_from(*left).unwrap_or(usize::MAX).min(rest);
                *left -= part as u64;
                if *left == 0 {
                    self.expected = Expected::Next;
                }
                taken + part
            }
        }
    }
}

impl<S: AsyncRead + Unpin> Socket<S> {
    /// Reads on while what follows the request waits for the reply, so that a client that hangs up is noticed: it is
    /// ready then, without bytes, whereupon the HTTP library drops the request. Of a client that sends more than
    /// [`AHEAD`] it is not noticed.
    fn poll_hung_up(&mut self, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        self.waiting = Some(cx.waker().clone());
        let mut bytes = [MaybeUninit::uninit(); PART];
        while self.held.len() < AHEAD {
            let room = bytes.len().min(AHEAD - self.held.len());
            let mut part = ReadBuf::uninit(&mut bytes[..room]);
            ready!(Pin::new(&mut self.stream).poll_read(cx, &mut part))?;
            if part.filled().is_empty() {
                return Poll::Ready(Ok(()));
            }
            self.held.extend_from_slice(part.filled());
        }
        Poll::Pending
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for Socket<S> {
    fn poll_read(self: Pin<&mut Self>, cx: &mut Context<'_>, buffer: &mut ReadBuf<'_>) -> Poll<io::Result<()>> {
        let this = self.get_mut();
        if matches!(this.expected, Expected::Next) && this.activity.is_idle() {
            this.expected = Expected::Head(RequestSmugglingGuard::default());
        }
        if matches!(this.expected, Expected::Next) && !this.held.is_empty() {
            return this.poll_hung_up(cx);
        }
        let before = buffer.filled().len();
        let mut held = std::mem::take(&mut this.held);
        if held.is_empty() {
            ready!(Pin::new(&mut this.stream).poll_read(cx, buffer))?;
        } else {
            buffer.put_slice(&held[..held.len().min(buffer.remaining())]);
        }
        let received = buffer.filled().len() - before;
        let taken = this.of_request(&buffer.filled()[before..]);
        if held.is_empty() {
            held.extend_from_slice(&buffer.filled()[before + taken..]);
        } else {
            held.drain(..taken);
        }
        this.held = held;
        buffer.set_filled(before + taken);
        if taken == 0 && received > 0 { this.poll_hung_up(cx) } else { Poll::Ready(Ok(())) }
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for Socket<S> {
    fn poll_write(mut self: Pin<&mut Self>, cx: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.stream).poll_write(cx, bytes);
        self.record(written)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        slices: &[IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.stream).poll_write_vectored(cx, slices);
        self.record(written)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        // The HTTP library flushes once nothing is left to write.
        self.activity.flushed();
        if self.activity.is_idle()
            && let Some(waiting) = self.waiting.take()
        {
            waiting.wake();
        }
        Pin::new(&mut self.stream).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(cx)
    }
}
