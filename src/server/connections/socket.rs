//! The stream of a connection: records what the client sends and reads, inspects the head of each request from its
//! first byte, and hands on nothing beyond a request until its reply is done.

use std::io::{self, IoSlice};
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, Waker, ready};

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};

use super::ConnectionActivity;
use super::smuggling::{BodyLength, RequestSmugglingGuard};

/// The stream of a connection.
#[derive(Debug)]
pub struct Socket<S> {
    stream: S,
    activity: Arc<ConnectionActivity>,
    expected: Expected,
    /// Received beyond the present request, at most one read.
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
    /// A later request, which must wait for the reply.
    Next,
    /// The last request of the connection.
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
                        // The reply closes the connection, so that the end of the chunks need not be found twice.
                        BodyLength::Chunked => Expected::Last,
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

impl<S: AsyncRead + Unpin> AsyncRead for Socket<S> {
    fn poll_read(self: Pin<&mut Self>, cx: &mut Context<'_>, buffer: &mut ReadBuf<'_>) -> Poll<io::Result<()>> {
        let this = self.get_mut();
        if matches!(this.expected, Expected::Next) && this.activity.is_idle() {
            this.expected = Expected::Head(RequestSmugglingGuard::default());
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
        if taken == 0 && received > 0 {
            this.waiting = Some(cx.waker().clone());
            return Poll::Pending;
        }
        Poll::Ready(Ok(()))
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
