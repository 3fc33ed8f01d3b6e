//! What handlers take out of a request. Whatever does not fit leaves as a [`Problem`].

use std::error::Error as _;

use axum::body::Body;
use axum::extract::{FromRequest, FromRequestParts, Path, Request};
use axum::http::request::Parts;
use axum::http::{HeaderMap, header};
use axum::response::Response;
use futures::StreamExt as _;
use http_body::Body as _;
use sha2::{Digest as _, Sha256};
use uuid::Uuid;

use crate::admission::{Place, Pool, Reservation};
use crate::otlp;
use crate::simulation::cost;
use crate::store::RequestKey;
use stickslip_wire::{self as wire, Document};

use crate::api::App;
use crate::api::limits;
use crate::api::problem::{Kind, Problem};
use crate::api::reply;
use crate::server::connections::SlowBody;

/// A checked body, and the headers that make it safe to repeat.
pub struct Command<T: Document> {
    /// The body.
    pub body: T::Checked,
    /// The idempotency key, with what it stands for.
    pub key: Option<RequestKey>,
    /// What the request takes of the server.
    pub held: Held,
}

/// What a request takes of the server: a place until it is answered, and memory until the client has the reply.
pub struct Held {
    memory: Reservation,
    _place: Place,
}

impl Held {
    /// Takes so much memory, from now on.
    ///
    /// # Errors
    /// A [`Problem`] if there is not so much at present.
    pub async fn resize(&mut self, pool: &Pool, bytes: usize) -> Result<(), Problem> {
        Ok(pool.resize(&mut self.memory, bytes).await?)
    }

    /// Hands the memory on to the reply.
    pub fn on(self, response: Response) -> Response {
        reply::holding(response, self.memory)
    }
}

/// As [`Command`], but no body at all counts as `{}`.
pub struct OptionalCommand<T: Document>(pub Command<T>);

/// The session named in the path. What is not an identifier names no session.
pub struct ContactId(pub Uuid);

/// The job named in the path. What is not an identifier names no job.
pub struct JobId(pub Uuid);

/// The sequence that the client expects by `If-Match`; none if it does not say, or says `*`.
pub struct Expected(pub Option<u64>);

/// The last event that the client has seen by `Last-Event-ID`; none if it does not say.
pub struct LastEventId(pub Option<u64>);

impl<T: Document + 'static> FromRequest<App> for Command<T> {
    type Rejection = Problem;

    async fn from_request(request: Request, app: &App) -> Result<Self, Problem> {
        command(request, app, false).await
    }
}

impl<T: Document + 'static> FromRequest<App> for OptionalCommand<T> {
    type Rejection = Problem;

    async fn from_request(request: Request, app: &App) -> Result<Self, Problem> {
        command(request, app, true).await.map(OptionalCommand)
    }
}

async fn command<T: Document + 'static>(request: Request, app: &App, optional: bool) -> Result<Command<T>, Problem> {
    let (parts, body) = request.into_parts();
    let declared = parts.headers.get(header::CONTENT_TYPE).map(|value| is_json(value.as_bytes()));
    if declared == Some(false) || (declared.is_none() && !optional) {
        return Err(Problem::new(Kind::UnsupportedMediaType, "Content-Type must be application/json"));
    }
    if let Some(coding) = parts.headers.get(header::CONTENT_ENCODING).filter(|coding| !is_identity(coding.as_bytes())) {
        let coding: String = String::from_utf8_lossy(coding.as_bytes()).chars().take(40).collect();
        let detail = format!("Content-Encoding `{coding}` is not taken: send the body as it is");
        return Err(Problem::new(Kind::UnsupportedMediaType, detail));
    }
    let (mut bytes, mut memory) = read(body, &app.pool).await?;
    // Not before the body is there: a slow client takes no place from others.
    let place = app.pool.enter().await?;
    if optional && bytes.is_empty() {
        bytes.extend_from_slice(b"{}");
    } else if declared.is_none() {
        return Err(Problem::new(Kind::UnsupportedMediaType, "Content-Type must be application/json"));
    }
    let key = idempotency_key(&parts.headers)?;
    let length = bytes.len();
    let price = if length > cost::INLINE_BODY { crate::admission::INLINE } else { 0 };
    if price > 0 {
        app.pool.resize(&mut memory, length.saturating_mul(limits::EXPANSION)).await?;
    }
    let work = move || {
        let key = key.map(|key| RequestKey { key, fingerprint: fingerprint(&parts, &bytes) });
        let read = || wire::read::<T>(&bytes);
        otlp::part!("parse").in_scope(read).map(|body| (body, key))
    };
    let (body, key) = app.pool.run(price, work).await??;
    Ok(Command { body, key, held: Held { memory, _place: place } })
}

/// No coding at all, as it may be said too.
fn is_identity(coding: &[u8]) -> bool {
    coding.trim_ascii().is_empty() || coding.trim_ascii().eq_ignore_ascii_case(b"identity")
}

/// `application/json`, with or without a charset.
fn is_json(content_type: &[u8]) -> bool {
    let essence = content_type.split(|byte| *byte == b';').next().unwrap_or_default();
    essence.trim_ascii().eq_ignore_ascii_case(b"application/json")
}

async fn read(body: Body, pool: &Pool) -> Result<(Vec<u8>, Reservation), Problem> {
    let declared = body.size_hint().upper().and_then(|length| usize::try_from(length).ok()).unwrap_or(usize::MAX);
    let mut stream = body.into_data_stream();
    let (mut bytes, mut length) = (Vec::new(), 0_usize);
    let mut memory = Reservation::default();
    while let Some(chunk) = stream.next().await {
        let chunk = chunk.map_err(broken)?;
        length = length.saturating_add(chunk.len());
        if length <= limits::BODY {
            // As it comes: what a client declares and does not send takes nothing from others.
            if length > bytes.capacity() {
                let room = (2 * length).min(declared).max(length);
                pool.resize(&mut memory, room).await?;
                bytes.reserve_exact(room - bytes.len());
            }
            bytes.extend_from_slice(&chunk);
        } else if length > limits::DRAIN {
            break;
        }
    }
    if length > limits::BODY {
        let detail = format!("the body has more than the {} bytes that are allowed", limits::BODY);
        return Err(Problem::new(Kind::TooLarge, detail));
    }
    Ok((bytes, memory))
}

fn broken(error: axum::Error) -> Problem {
    if error.source().is_some_and(|source| source.is::<SlowBody>()) {
        Problem::new(Kind::RequestTimeout, "the body did not arrive in time")
    } else {
        Problem::new(Kind::NotJson, "the body broke off")
    }
}

fn idempotency_key(headers: &HeaderMap) -> Result<Option<String>, Problem> {
    let Some(value) = headers.get("idempotency-key") else {
        return Ok(None);
    };
    let key = value.to_str().ok().filter(|key| (1..=limits::KEY_LENGTH).contains(&key.len()));
    let key = key.filter(|key| key.bytes().all(|byte| byte.is_ascii_graphic()));
    let refusal = || format!("Idempotency-Key must be 1 to {} visible ASCII characters", limits::KEY_LENGTH);
    key.map(|key| Some(key.to_owned())).ok_or_else(|| Problem::new(Kind::InvalidInput, refusal()))
}

/// What a key stands for. The parts are set apart by a byte that none of the first two can hold.
fn fingerprint(parts: &Parts, body: &[u8]) -> [u8; 32] {
    let mut hash = Sha256::new();
    for part in [parts.method.as_str().as_bytes(), parts.uri.path().as_bytes()] {
        hash.update(part);
        hash.update([0]);
    }
    hash.update(body);
    hash.finalize().into()
}

impl FromRequestParts<App> for ContactId {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, Problem> {
        identifier(parts, app, Kind::ContactNotFound, "contact").await.map(ContactId)
    }
}

impl FromRequestParts<App> for JobId {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, Problem> {
        identifier(parts, app, Kind::JobNotFound, "job").await.map(JobId)
    }
}

/// The identifier in the path. What is none names nothing that there is.
async fn identifier(parts: &mut Parts, app: &App, kind: Kind, noun: &str) -> Result<Uuid, Problem> {
    let missing = |id: &str| Problem::new(kind, format!("there is no {noun} {id}"));
    match Path::<String>::from_request_parts(parts, app).await {
        Ok(Path(id)) => Uuid::parse_str(&id).map_err(|_| missing(&id)),
        // Percent signs that do not decode.
        Err(_) => Err(missing("of this name")),
    }
}

impl FromRequestParts<App> for Expected {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &App) -> Result<Self, Problem> {
        let Some(value) = parts.headers.get(header::IF_MATCH) else {
            return Ok(Expected(None));
        };
        let text = value.to_str().unwrap_or_default().trim();
        let sequence = text.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).map(str::parse::<u64>);
        match (text, sequence) {
            ("*", _) => Ok(Expected(None)),
            (_, Some(Ok(sequence))) => Ok(Expected(Some(sequence))),
            _ => Err(Problem::new(Kind::InvalidInput, "If-Match must be a sequence in quotes, such as \"3\", or *")),
        }
    }
}

impl FromRequestParts<App> for LastEventId {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &App) -> Result<Self, Problem> {
        let Some(value) = parts.headers.get("last-event-id") else {
            return Ok(LastEventId(None));
        };
        let sequence = value.to_str().ok().and_then(|text| text.trim().parse().ok());
        let refusal = "Last-Event-ID must be the number of a move, such as 3";
        let refused = || Problem::at(Kind::InvalidInput, "/Last-Event-ID", refusal);
        sequence.map(|sequence| LastEventId(Some(sequence))).ok_or_else(refused)
    }
}
