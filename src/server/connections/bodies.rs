//! Bodies of requests, whose rest is discarded, and bodies of replies that hold the resources of their request until
//! they are sent.

use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};

use axum::body::{Body, Bytes};
use http_body::{Body as _, Frame, SizeHint};
use http_body_util::BodyExt as _;
use hyper::body::Incoming;
use parking_lot::Mutex;
use tokio::time::timeout;

use super::ConnectionActivity;
use crate::admission::UnderWay;
use crate::server::connection_limits::{DISCARD_TIME, DISCARDED, PIECE};

/// The body of a request, which a handler reads and the service after it.
#[derive(Clone)]
pub struct SharedBody(pub(super) Arc<Mutex<Incoming>>);

impl http_body::Body for SharedBody {
    type Data = Bytes;
    type Error = hyper::Error;

    fn poll_frame(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Result<Frame<Bytes>, hyper::Error>>> {
        Pin::new(&mut *self.0.lock()).poll_frame(cx)
    }

    fn is_end_stream(&self) -> bool {
        self.0.lock().is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.0.lock().size_hint()
    }
}

/// Reads what is left of a body and discards it; returns whether that was all of it, in time.
pub async fn discard(mut body: SharedBody) -> bool {
    let read = async {
        let mut length = 0;
        while !body.is_end_stream()
            && let Some(frame) = body.frame().await
        {
            let Ok(frame) = frame else { return false };
            length += frame.data_ref().map_or(0, Bytes::len);
            if length > DISCARDED {
                return false;
            }
        }
        true
    };
    timeout(DISCARD_TIME, read).await.unwrap_or(false)
}

/// Marks the connection as serving a request until dropped.
pub struct RequestInProgress(pub Arc<ConnectionActivity>);

impl Drop for RequestInProgress {
    fn drop(&mut self) {
        self.0.end_request();
    }
}

/// The body of a reply, sent in pieces that own their memory: when the last piece has been handed to the socket, the
/// resources of the request are free, and no more than that piece is still in flight.
pub struct TrackedBody {
    pub(super) body: Body,
    /// For which request what it streams is computed, and what that holds until the body is dropped.
    pub(super) under_way: UnderWay,
    /// What is left of a piece.
    pub(super) rest: Bytes,
    pub(super) _in_progress: RequestInProgress,
}

impl TrackedBody {
    fn next_piece(&mut self) -> Bytes {
        let piece = self.rest.split_to(self.rest.len().min(PIECE));
        Bytes::copy_from_slice(&piece)
    }
}

impl http_body::Body for TrackedBody {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        if !self.rest.is_empty() {
            return Poll::Ready(Some(Ok(Frame::data(self.next_piece()))));
        }
        let TrackedBody { body, under_way, .. } = &mut *self;
        let polled = under_way.admission().within(|| Pin::new(&mut *body).poll_frame(cx));
        let Poll::Ready(frame) = polled else { return Poll::Pending };
        let Some(Ok(frame)) = frame else { return Poll::Ready(frame) };
        match frame.into_data() {
            Ok(data) if data.len() > PIECE => {
                self.rest = data;
                Poll::Ready(Some(Ok(Frame::data(self.next_piece()))))
            }
            Ok(data) => Poll::Ready(Some(Ok(Frame::data(data)))),
            Err(frame) => Poll::Ready(Some(Ok(frame))),
        }
    }

    fn is_end_stream(&self) -> bool {
        self.rest.is_empty() && self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        // It is read before the first piece.
        if self.rest.is_empty() { self.body.size_hint() } else { SizeHint::new() }
    }
}
