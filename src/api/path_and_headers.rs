//! Path and header parameters. Each type is both what a handler takes and what the OpenAPI document says of it.

use std::convert::Infallible;
use std::sync::Arc;

use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use axum::http::{HeaderMap, HeaderName, HeaderValue, header};
use percent_encoding::percent_decode_str;
use utoipa::IntoParams;
use uuid::Uuid;

use super::accept::{NAMED, admission, list_members};
use super::problem::{Code, Problem};
use super::request_context::{Context, RequestContext};
use super::state::{App, TenantApp};
use crate::sessions::Expected;

/// The headers that have no name in the library.
const IDEMPOTENCY_KEY: HeaderName = HeaderName::from_static("idempotency-key");
const LAST_EVENT_ID: HeaderName = HeaderName::from_static("last-event-id");

/// Characters of an idempotency key.
const KEY_LENGTH: usize = 255;

/// Declares a parameter of the path that identifies something of the tenant.
macro_rules! identifier {
    ($name:ident, $description:literal, $missing:ident, $noun:literal) => {
        /// The state that the tenant of a request sees, and the identifier in its path.
        #[derive(IntoParams)]
        #[into_params(parameter_in = Path)]
        pub struct $name {
            #[param(ignore)]
            pub app: Arc<App>,
            #[param(ignore)]
            pub context: Arc<RequestContext>,
            #[doc = $description]
            pub id: Uuid,
        }

        impl FromRequestParts<Arc<App>> for $name {
            type Rejection = Problem;

            async fn from_request_parts(parts: &mut Parts, app: &Arc<App>) -> Result<Self, Problem> {
                let (app, id) = identified(parts, app, Code::$missing, $noun).await?;
                let Context(context) = Context::from_request_parts(parts, &app).await?;
                Ok($name { app, context, id })
            }
        }
    };
}
identifier!(ContactPath, "The identifier of the contact.", ContactNotFound, "contact");
identifier!(JobPath, "The identifier of the job.", JobNotFound, "job");

/// The condition under which a contact is changed; `None` if the client sets none, or `*`.
#[derive(IntoParams)]
#[into_params(parameter_in = Header)]
pub struct IfMatch {
    /// The sequence that the contact must have, in quotes: its `ETag`. If the contact has another sequence, nothing
    /// changes and the answer is 412. With the checksum of the label after a dot, as `GET /contacts/{id}` gives it, the
    /// label must be the same too; `.00000000` stands for no label. The prefix `W/` of some proxies is allowed.
    #[param(rename = "If-Match", value_type = Option<String>, nullable = false,
        pattern = r#"^((W/)?"[0-9]{1,19}(\.[0-9a-f]{8})?"|\*)$"#)]
    pub expected: Option<Expected>,
}

/// The name of a request that may have to be repeated.
#[derive(IntoParams)]
#[into_params(parameter_in = Header)]
pub struct IdempotencyKey {
    /// A name of your choice for this request. A repetition with the same name and body within 24 hours changes nothing
    /// and gets the first reply again; with another body it is refused. A server with the store `memory:` drops the
    /// oldest replies earlier, once the replies take more than 256 MiB.
    #[param(rename = "Idempotency-Key", nullable = false, min_length = 1, max_length = 255, pattern = "^[!-~]+$")]
    pub key: Option<String>,
}

/// Where a stream of events continues.
#[derive(IntoParams)]
#[into_params(parameter_in = Header)]
pub struct LastEventId {
    /// The sequence of the last event that the client has received. The stream continues with the next one, without a
    /// gap; if the header is left out, it begins with the present state.
    #[param(rename = "Last-Event-ID", nullable = false, minimum = 0, maximum = 18_446_744_073_709_551_615_usize)]
    pub sequence: Option<u64>,
}

/// How the client wants to be answered (RFC 7240).
#[derive(IntoParams)]
#[into_params(parameter_in = Header)]
pub struct Prefer {
    /// `respond-async` runs the sweep as a job even if it is small (RFC 7240).
    #[param(rename = "Prefer", value_type = Option<String>, nullable = false)]
    pub respond_async: bool,
}

/// The state that the tenant of a request sees, and the identifier in the path. A text that is not a UUID cannot name
/// anything, so it is "not found" rather than invalid.
async fn identified(parts: &mut Parts, app: &Arc<App>, kind: Code, noun: &str) -> Result<(Arc<App>, Uuid), Problem> {
    let missing = |id: &str| {
        let shown: String = id.chars().take(40).collect();
        Problem::new(kind, format!("the {noun} {shown} was not found"))
    };
    let named = parts.uri.path().split('/').nth(2).unwrap_or_default();
    let id = match Uuid::parse_str(named) {
        Ok(id) => id,
        // Percent signs may not decode.
        Err(_) => {
            let decoded = percent_decode_str(named).decode_utf8().map_err(|_| missing("of this name"))?;
            Uuid::parse_str(&decoded).map_err(|_| missing(&decoded))?
        }
    };
    let Ok(TenantApp(app)) = TenantApp::from_request_parts(parts, app).await;
    Ok((app, id))
}

/// The value of a header as `parse` reads it, if the client sends one, which is refused if it cannot be read.
fn header<T>(
    headers: &HeaderMap,
    name: HeaderName,
    parse: impl FnOnce(&str) -> Option<T>,
    refused: impl FnOnce() -> Problem,
) -> Result<Option<T>, Problem> {
    let read = |value: &HeaderValue| value.to_str().ok().and_then(|text| parse(text.trim())).ok_or_else(refused);
    headers.get(name).map(read).transpose()
}

impl FromRequestParts<Arc<App>> for IfMatch {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &Arc<App>) -> Result<Self, Problem> {
        let parse = |text: &str| {
            // A proxy that compresses a reply makes its version a weak one.
            let tag = text.strip_prefix("W/").unwrap_or(text);
            let tag = tag.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
            if text == "*" { Some(None) } else { tag.and_then(expected).map(Some) }
        };
        let refusal = "If-Match must be a sequence in quotes, such as \"3\", or *";
        let expected = header(&parts.headers, header::IF_MATCH, parse, || Problem::new(Code::InvalidInput, refusal))?;
        Ok(IfMatch { expected: expected.flatten() })
    }
}

/// The version that a tag names: a sequence, and the checksum of a label behind a dot if it has one.
fn expected(tag: &str) -> Option<Expected> {
    let checksum = |label: &str| const_hex::decode_to_array(label).ok().filter(|_| label.len() == 8);
    let (sequence, label) = match tag.split_once('.') {
        Some((sequence, label)) => (sequence, Some(u32::from_be_bytes(checksum(label)?))),
        None => (tag, None),
    };
    Some(Expected { sequence: sequence.parse().ok()?, label })
}

impl IdempotencyKey {
    /// Reads the header.
    ///
    /// # Errors
    /// A [`Problem`] if it is empty, too long, or not visible ASCII.
    pub fn read(headers: &HeaderMap) -> Result<IdempotencyKey, Problem> {
        let is_sound =
            |key: &&str| (1..=KEY_LENGTH).contains(&key.len()) && key.bytes().all(|byte| byte.is_ascii_graphic());
        let parse = |key: &str| Some(key).filter(is_sound).map(str::to_owned);
        let refusal = || format!("Idempotency-Key must be 1 to {KEY_LENGTH} visible ASCII characters");
        let refused = || Problem::new(Code::InvalidInput, refusal());
        Ok(IdempotencyKey { key: header(headers, IDEMPOTENCY_KEY, parse, refused)? })
    }
}

impl FromRequestParts<Arc<App>> for LastEventId {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &Arc<App>) -> Result<Self, Problem> {
        let refusal = "Last-Event-ID must be the number of a move, such as 3";
        let refused = || Problem::at(Code::InvalidInput, "/Last-Event-ID", refusal);
        Ok(LastEventId { sequence: header(&parts.headers, LAST_EVENT_ID, |text| text.parse().ok(), refused)? })
    }
}

impl FromRequestParts<Arc<App>> for Prefer {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, _: &Arc<App>) -> Result<Self, Infallible> {
        let is_async = |preference: &str| {
            let name = preference.split(';').next().unwrap_or_default();
            name.trim().eq_ignore_ascii_case("respond-async")
        };
        Ok(Prefer { respond_async: list_members(&parts.headers, "prefer").any(is_async) })
    }
}

/// Whether the client asks for server-sent events.
pub fn accepts_events(headers: &HeaderMap) -> bool {
    let admission = admission(headers, "accept", "text/event-stream");
    admission.is_some_and(|admission| admission.rank == NAMED && admission.quality > 0.0)
}
