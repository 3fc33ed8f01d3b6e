//! Bodies on their way: those of requests are timed, those of replies keep what their request holds until they are sent.

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

/// The body of a request, all of which must arrive within a time.
pub struct DeadlineBody {
    body: Incoming,
    time: Duration,
    // Most bodies are there with the head, and never need it.
    alarm: Option<Pin<Box<Sleep>>>,
}

impl DeadlineBody {
    /// The time runs from the first wait.
    pub fn new(body: Incoming, time: Duration) -> DeadlineBody {
        DeadlineBody { body, time, alarm: None }
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
        let alarm = self.alarm.get_or_insert_with(|| Box::pin(sleep(time)));
        alarm.as_mut().poll(cx).map(|()| Some(Err(SlowBody.into())))
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

/// Says that the connection is busy, until dropped.
pub struct Busy(pub Arc<ConnectionActivity>);

impl Drop for Busy {
    fn drop(&mut self) {
        self.0.end();
    }
}

/// The body of a reply, in pieces of which each has memory of its own: what the request holds is free when the last of
/// them has been handed on, and no more than that is still on its way then.
pub struct TrackedBody {
    body: Body,
    rest: Bytes,
    _busy: Busy,
    _place: Option<Place>,
    _memory: Option<Arc<Reservation>>,
}

impl TrackedBody {
    /// With what goes when it does.
    pub fn new(body: Body, busy: Busy, place: Option<Place>, memory: Option<Arc<Reservation>>) -> TrackedBody {
        TrackedBody { body, rest: Bytes::new(), _busy: busy, _place: place, _memory: memory }
    }

    fn piece(&mut self) -> Bytes {
        let piece = self.rest.split_to(self.rest.len().min(PIECE));
        Bytes::copy_from_slice(&piece)
    }
}

impl http_body::Body for TrackedBody {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        if !self.rest.is_empty() {
            return Poll::Ready(Some(Ok(Frame::data(self.piece()))));
        }
        let Poll::Ready(frame) = Pin::new(&mut self.body).poll_frame(cx) else { return Poll::Pending };
        let Some(Ok(frame)) = frame else { return Poll::Ready(frame) };
        match frame.into_data() {
            Ok(data) if data.len() > PIECE => {
                self.rest = data;
                Poll::Ready(Some(Ok(Frame::data(self.piece()))))
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
