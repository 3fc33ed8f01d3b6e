//! The body of a request: read within limits, checked, and counted against the memory of the server.

use std::any::Any;
use std::sync::Arc;
use std::task::Poll;
use std::time::Duration;

use axum::body::{BodyDataStream, Bytes};
use axum::extract::{FromRequest, FromRequestParts as _, Request};
use axum::http::request::Parts;
use axum::http::{HeaderMap, header};
use futures::{StreamExt as _, poll};
use http_body::Body as _;
use sha2::{Digest as _, Sha256};
use tokio::time::{Instant, timeout};

use crate::admission::{FREE, INLINE, Pool, PoolError, Quota, UNCOUNTED};
use crate::otlp;
use crate::server::connection_limits::DISCARDED;
use crate::store::RequestKey;
use stickslip_compute::computations::files;
use stickslip_compute::documents::{Kind, Parse};
use stickslip_compute::simulation::{bytes, cost};

use super::path_and_headers::IdempotencyKey;
use super::problem::{Code, Problem};
use super::request_context::{Context, RequestContext};
use super::request_limits::{BODY_LIMIT, FILE_LIMIT};
use super::state::App;

/// A checked body, and the headers that make the request safe to repeat. If it is `OPTIONAL`, no body at all counts as
/// `{}`.
pub struct CheckedBody<T: Parse, const OPTIONAL: bool = false> {
    pub body: T::Checked,
    /// The idempotency key, with a fingerprint of the request.
    pub key: Option<RequestKey>,
    pub context: Arc<RequestContext>,
}

impl<T: Parse, const OPTIONAL: bool> FromRequest<Arc<App>> for CheckedBody<T, OPTIONAL> {
    type Rejection = Problem;

    async fn from_request(request: Request, app: &Arc<App>) -> Result<Self, Problem> {
        let document = checked_document(request, app, Kind::of::<T>(), OPTIONAL).await?;
        let (body, key, context) = document.of::<T::Checked>()?;
        Ok(CheckedBody { body, key, context })
    }
}

/// A checked body without its type.
pub struct CheckedDocument {
    body: Box<dyn Any + Send>,
    key: Option<RequestKey>,
    context: Arc<RequestContext>,
}

impl CheckedDocument {
    /// The parts of a checked body.
    ///
    /// # Errors
    /// A [`Problem`] if it has another type, which is a fault of the service.
    pub fn of<T: 'static>(self) -> Result<(T, Option<RequestKey>, Arc<RequestContext>), Problem> {
        let body = self.body.downcast().map_err(|_| Problem::internal("a document has the type of another"))?;
        Ok((*body, self.key, self.context))
    }
}

/// Receives, parses and checks the body of a request; `optional` is as in [`CheckedBody`].
///
/// # Errors
/// A [`Problem`] that says what is wrong with the body, or what it could not get.
pub async fn checked_document(
    request: Request,
    app: &Arc<App>,
    kind: Kind,
    optional: bool,
) -> Result<CheckedDocument, Problem> {
    let unsupported = || Problem::new(Code::UnsupportedMediaType, "Content-Type must be application/json");
    // With or without a charset.
    let declared = essence(request.headers()).map(|essence| essence.eq_ignore_ascii_case(b"application/json"));
    if !declared.unwrap_or(optional) {
        return Err(unsupported());
    }
    let (parts, mut bytes, context) = receive(request, BODY_LIMIT, app).await?;
    if optional && bytes.is_empty() {
        bytes.extend_from_slice(b"{}");
    } else if declared.is_none() {
        return Err(unsupported());
    }
    let IdempotencyKey { key } = IdempotencyKey::read(&parts.headers)?;
    let length = bytes.len();
    let cost = if length > cost::INLINE_BODY { INLINE } else { 0 };
    if cost > 0 {
        context.reserve(length.saturating_mul(kind.parsed)).await?;
    }
    let profiles = app.sessions.profiles(context.deadline());
    let check = profiles.clone();
    let work = move |_: &_| {
        let _parsing = otlp::part!("parse").entered();
        let key = key.map(|key| RequestKey { key, fingerprint: fingerprint(&parts, &bytes) });
        let document = (kind.parse)(&bytes)?;
        let cost = check.cost(&*document)?;
        // A check that prepares a profile is work of its own, at this cost.
        let read = if cost < INLINE { Ok(check.check(document)??) } else { Err((document, cost)) };
        Ok::<_, Problem>((read, key))
    };
    let (read, key) = context.run(cost, work).await??;
    let body = match read {
        Ok(body) => body,
        Err((document, cost)) => {
            let shape = document.profile().map_or(0, |defined| bytes::of_shape(defined.profile));
            context.reserve(shape + length.saturating_mul(kind.parsed)).await?;
            let work = move |_: &_| otlp::part!("prepare").in_scope(|| profiles.check(document));
            context.run(cost, work).await???
        }
    };
    Ok(CheckedDocument { body, key, context })
}

/// The bytes of a file, with memory for what they become.
pub struct FileBody {
    pub bytes: Vec<u8>,
    pub context: Arc<RequestContext>,
}

/// The media types of a file.
const FILE_TYPES: [&str; 3] = ["text/csv", "text/plain", "application/octet-stream"];

impl FromRequest<Arc<App>> for FileBody {
    type Rejection = Problem;

    async fn from_request(request: Request, app: &Arc<App>) -> Result<Self, Problem> {
        let declared = essence(request.headers());
        if !declared.is_some_and(|is| FILE_TYPES.iter().any(|known| is.eq_ignore_ascii_case(known.as_bytes()))) {
            let detail = format!("Content-Type must be one of {}", FILE_TYPES.join(", "));
            return Err(Problem::new(Code::UnsupportedMediaType, detail));
        }
        let (_, bytes, context) = receive(request, FILE_LIMIT, app).await?;
        context.reserve(files::memory(&bytes)).await?;
        Ok(FileBody { bytes, context })
    }
}

/// The declared media type without its parameters.
fn essence(headers: &HeaderMap) -> Option<&[u8]> {
    let declared = headers.get(header::CONTENT_TYPE)?.as_bytes();
    Some(declared.split(|byte| *byte == b';').next().unwrap_or_default().trim_ascii())
}

/// Refuses a body that is compressed.
fn check_encoding(headers: &HeaderMap) -> Result<(), Problem> {
    let coding = headers.get(header::CONTENT_ENCODING).map_or(&b""[..], |coding| coding.as_bytes().trim_ascii());
    if coding.is_empty() || coding.eq_ignore_ascii_case(b"identity") {
        return Ok(());
    }
    let coding: String = String::from_utf8_lossy(coding).chars().take(40).collect();
    let detail = format!("Content-Encoding `{coding}` is not supported: send the body unencoded");
    Err(Problem::new(Code::UnsupportedMediaType, detail))
}

/// Reads a body of at most so many bytes, and then acquires a permit for its request: a slow client keeps no others
/// waiting.
async fn receive(
    request: Request,
    limit: usize,
    app: &Arc<App>,
) -> Result<(Parts, Vec<u8>, Arc<RequestContext>), Problem> {
    let (mut parts, body) = request.into_parts();
    let Context(context) = Context::from_request_parts(&mut parts, app).await?;
    check_encoding(&parts.headers)?;
    let too_large = || {
        let detail = format!("the body has more than the {limit} bytes that are allowed");
        Problem::new(Code::TooLarge, detail)
    };
    if body.size_hint().lower() > limit as u64 {
        return Err(too_large());
    }
    let declared = body.size_hint().upper().and_then(|length| usize::try_from(length).ok()).unwrap_or(usize::MAX);
    let pool: &Pool = &app.pool;
    let mut arriving = ArrivingBody { stream: body.into_data_stream(), left: context.body_time };
    let (mut bytes, mut length) = (Vec::new(), 0_usize);
    // Until the body has arrived: however slowly it does, others have room for theirs.
    let (mut small, mut share) = (None, None);
    while let Some(chunk) = arriving.next().await? {
        length = length.saturating_add(chunk.len());
        if length <= limit {
            // Reserved as it arrives: a length that is declared but not sent takes no memory from others.
            if length > bytes.capacity() {
                let room = (2 * length).min(declared).min(limit).max(length);
                if room > UNCOUNTED {
                    let client = || context.admission.client.clone();
                    let share = share.get_or_insert_with(|| pool.quotas().no_share(Quota::BodyBytes, client()));
                    share.resize(room).map_err(PoolError::Quota)?;
                    if room > FREE {
                        context.reserve(room).await?;
                        small = None;
                    } else if small.is_none() {
                        small = Some(pool.reserve_arriving(declared.min(FREE)).await?);
                    }
                }
                bytes.reserve_exact(room - bytes.len());
            }
            bytes.extend_from_slice(&chunk);
        } else if length > DISCARDED {
            break;
        }
    }
    if length > limit {
        return Err(too_large());
    }
    context.admission.admit(pool).await?;
    drop((small, share));
    Ok((parts, bytes, context))
}

/// The body of a request while it arrives.
struct ArrivingBody {
    stream: BodyDataStream,
    /// What is left of the time in which all of it must arrive. Only waits for the client count, and not what the
    /// server itself does between them.
    left: Duration,
}

impl ArrivingBody {
    async fn next(&mut self) -> Result<Option<Bytes>, Problem> {
        let arrived = match poll!(self.stream.next()) {
            // Most bodies come with their head, and are not timed.
            Poll::Ready(arrived) => arrived,
            Poll::Pending => {
                let since = Instant::now();
                let next = timeout(self.left, self.stream.next()).await;
                self.left = self.left.saturating_sub(since.elapsed());
                next.map_err(|_| Problem::new(Code::RequestTimeout, "the body did not arrive in time"))?
            }
        };
        let broken = |_| Problem::new(Code::NotJson, "the connection ended before the body was complete");
        arrived.transpose().map_err(broken)
    }
}

/// A hash of method, path and body. They are separated by a byte that the first two cannot contain.
fn fingerprint(parts: &Parts, body: &[u8]) -> [u8; 32] {
    let mut hash = Sha256::new();
    for part in [parts.method.as_str().as_bytes(), parts.uri.path().as_bytes()] {
        hash.update(part);
        hash.update([0]);
    }
    hash.update(body);
    hash.finalize().into()
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;
    use std::time::Duration;

    use axum::body::Body;
    use futures::{StreamExt as _, stream};
    use tokio::task::yield_now;
    use tokio::time::sleep;

    use super::ArrivingBody;

    #[tokio::test]
    async fn what_the_server_holds_up_itself_is_no_fault_of_the_client() {
        // Every byte has arrived as soon as it has been waited for once.
        let chunks = stream::repeat("a").then(|chunk| async move {
            yield_now().await;
            Ok::<_, Infallible>(chunk)
        });
        let time = Duration::from_millis(500);
        let mut body = ArrivingBody { stream: Body::from_stream(chunks).into_data_stream(), left: time };
        assert!(body.next().await.unwrap().is_some());
        sleep(2 * time).await;
        assert!(body.next().await.unwrap().is_some());
    }
}
