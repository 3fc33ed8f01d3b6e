//! Bodies of requests with a deadline, and bodies of replies that hold the resources of their request until they are sent.

use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;

use axum::body::{Body, Bytes};
use http_body::{Frame, SizeHint};
use hyper::body::Incoming;
use tokio::time::{Sleep, sleep};

use super::ConnectionActivity;
use crate::admission::{Place, Reservation};
use crate::server::limits::PIECE;

/// The body of a request did not arrive in time.
#[derive(Debug, thiserror::Error)]
#[error("the body did not arrive in time")]
pub struct SlowBody;

/// The body of a request, which must arrive completely within a time limit.
pub struct DeadlineBody {
    body: Incoming,
    time: Duration,
    // Created on the first wait: most bodies arrive together with the head.
    deadline: Option<Pin<Box<Sleep>>>,
}

impl DeadlineBody {
    /// The time limit runs from the first wait for data.
    pub fn new(body: Incoming, time: Duration) -> DeadlineBody {
        DeadlineBody { body, time, deadline: None }
    }
}

impl http_body::Body for DeadlineBody {
    type Data = Bytes;
    type Error = axum::BoxError;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::BoxError>>> {
        if let Poll::Ready(frame) = Pin::new(&mut self.body).poll_frame(cx) {
            return Poll::Ready(frame.map(|frame| frame.map_err(Into::into)));
        }
        let time = self.time;
        let deadline = self.deadline.get_or_insert_with(|| Box::pin(sleep(time)));
        deadline.as_mut().poll(cx).map(|()| Some(Err(SlowBody.into())))
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

/// Marks the connection as serving a request until dropped.
pub struct RequestInProgress(pub Arc<ConnectionActivity>);

impl Drop for RequestInProgress {
    fn drop(&mut self) {
        self.0.end_request();
    }
}

/// The body of a reply, sent in pieces that own their memory: when the last piece has been handed to the socket, the resources
/// of the request are free, and no more than that piece is still in flight.
pub struct TrackedBody {
    body: Body,
    rest: Bytes,
    _request: RequestInProgress,
    _place: Option<Place>,
    _memory: Option<Arc<Reservation>>,
}

impl TrackedBody {
    /// A body that releases `request`, `place` and `memory` when it is dropped.
    pub fn new(
        body: Body,
        request: RequestInProgress,
        place: Option<Place>,
        memory: Option<Arc<Reservation>>,
    ) -> TrackedBody {
        TrackedBody { body, rest: Bytes::new(), _request: request, _place: place, _memory: memory }
    }

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
        let Poll::Ready(frame) = Pin::new(&mut self.body).poll_frame(cx) else { return Poll::Pending };
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
        let (mut hint, rest) = (self.body.size_hint(), self.rest.len() as u64);
        if rest > 0 {
            let upper = hint.upper();
            hint = SizeHint::new();
            if let Some(upper) = upper {
                hint.set_upper(upper + rest);
            }
        }
        hint
    }
}
