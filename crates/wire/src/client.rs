//! A typed client for the service.
#![doc = include_str!("../README.md")]

use eventsource_stream::{EventStreamError, Eventsource as _};
use futures::{Stream, StreamExt as _};
use reqwest::header::{AUTHORIZATION, CONTENT_TYPE, HeaderValue};
use reqwest::{Method, RequestBuilder, StatusCode};
use serde::de::DeserializeOwned;
use uuid::Uuid;

use crate::files::{LoopFileHints, ScanFileHints};
use crate::{
    AccuracyReply, AccuracyRequest, ContactDefinition, ContactOrder, CreateRequest, CycleDrive, CyclePage, CycleReply,
    CycleRequest, EndEvent, EndReason, FitReply, FitRequest, ForkRequest, FrettingReply, FrettingRequest,
    FrictionReply, HistoryPage, JobList, JobReply, JobState, LoopFileReply, LoopPage, Machine, MoveReply, MoveRequest,
    NewSession, ObservationsReply, ObservationsRequest, PathReply, PathRequest, ProblemDocument, ProfileFitReply,
    ProfileFitRequest, ProtocolReply, ProtocolRequest, RelaxReply, RelaxRequest, RenameRequest, Residual, RollingReply,
    RollingRequest, ScanFileReply, SessionPage, SessionReply, SimulateReply, SimulateRequest, SlidersReply,
    SlidersRequest, StateEvent, StressReply, StressRequest, SubsurfaceReply, SubsurfaceRequest, SweepReply,
    SweepRequest, WearReply, WearRequest, WorkDensity,
};

/// A handle on a service; clones share its connections. Every call fails with an [`Error`], and so may a stream of
/// events.
#[derive(Clone, Debug)]
pub struct Client {
    base: String,
    // Marked as sensitive: it is not printed.
    authorization: Option<HeaderValue>,
    http: reqwest::Client,
}

/// Headers that make a change safe to repeat.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Change only a contact that is at this sequence.
    pub if_match: Option<u64>,
    /// A name for the request: a repetition with the same name gets the first reply again.
    pub idempotency_key: Option<String>,
}

/// An event of the event stream of a contact.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// The contact is in this state.
    State(Box<StateEvent>),
    /// There are no more events.
    End(EndReason),
}

/// The answer to a sweep.
#[derive(Clone, Debug, PartialEq)]
pub enum Swept {
    /// Its table.
    Table(SweepReply),
    /// A job that computes it.
    Job(JobReply),
}

/// Why a call failed.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The service refused, and says why.
    #[error("{} ({}): {}", .0.title, .0.code, .0.detail)]
    Problem(Box<ProblemDocument>),
    /// The service could not be reached, or its reply could not be read.
    #[error(transparent)]
    Transport(#[from] reqwest::Error),
    /// The reply does not come from this service.
    #[error("unexpected reply with status {status}: {detail}")]
    Unexpected {
        /// Its status code.
        status: StatusCode,
        /// What is wrong with it.
        detail: String,
    },
}

impl Error {
    /// The problem document, if the service gave one.
    pub fn problem(&self) -> Option<&ProblemDocument> {
        match self {
            Error::Problem(problem) => Some(problem),
            Error::Transport(_) | Error::Unexpected { .. } => None,
        }
    }
}

/// Declares the methods of calls that reply with a document, with a body,
/// `name: METHOD "path" [id] Request + options => Reply;`, or with optional parameters,
/// `name: METHOD "path" [id] ? parameter: Type, .. => Reply;`.
macro_rules! calls {
    ($(
        $(#[doc = $about:literal])*
        $name:ident: $method:ident $path:literal $([$id:ident])?
            $($Request:ident)? $(+ $options:ident)? $(? $($query:ident: $Type:ty),+)? => $Reply:ty;
    )+) => {$(
        #[doc = concat!("`", stringify!($method), " ", $path, "`.")]
        $(#[doc = $about])*
        pub async fn $name(
            &self,
            $($id: Uuid,)?
            $(request: &$Request,)?
            $($options: &Options,)?
            $($($query: Option<$Type>),+)?
        ) -> Result<$Reply, Error> {
            let call = self.call(Method::$method, &format!($path $(, $id = $id)?));
            $(let call = call.json::<$Request>(request);)?
            $(let call = with(call, $options);)?
            $($(let call = call.query(&[(stringify!($query), $query)]);)+)?
            json(call).await
        }
    )+};
}

impl Client {
    /// A client for the service at `base`, such as `http://127.0.0.1:8080`.
    pub fn new(base: impl Into<String>) -> Client {
        let base: String = base.into();
        Client { base: base.trim_end_matches('/').to_owned(), authorization: None, http: reqwest::Client::new() }
    }

    /// The same client with a key, which every call presents. A key that no header can hold is not one of any service,
    /// and left out.
    #[must_use]
    pub fn with_key(mut self, key: &str) -> Client {
        self.authorization = HeaderValue::from_str(&format!("Bearer {key}")).ok();
        if let Some(value) = &mut self.authorization {
            value.set_sensitive(true);
        }
        self
    }

    calls! {
        simulate: POST "/simulate" SimulateRequest => SimulateReply;
        accuracy: POST "/accuracy" AccuracyRequest => AccuracyReply;
        cycle: POST "/cycle" CycleRequest => CycleReply;
        protocol: POST "/protocols" ProtocolRequest => ProtocolReply;
        fretting: POST "/fretting" FrettingRequest => FrettingReply;
        wear: POST "/wear" WearRequest => WearReply;
        sliders: POST "/sliders" SlidersRequest => SlidersReply;
        rolling: POST "/rolling" RollingRequest => RollingReply;
        fit_profile: POST "/profiles/fit" ProfileFitRequest => ProfileFitReply;
        fit_loops: POST "/fit" FitRequest => FitReply;
        create: POST "/contacts" CreateRequest + options => NewSession;
        contact: GET "/contacts/{id}" [id] => SessionReply;
        definition: GET "/contacts/{id}/definition" [id] => ContactDefinition;
        apply: POST "/contacts/{id}/move" [id] MoveRequest + options => MoveReply;
        path: POST "/contacts/{id}/path" [id] PathRequest + options => PathReply;
        observe: POST "/contacts/{id}/observations" [id] ObservationsRequest + options => ObservationsReply;
        friction: GET "/contacts/{id}/friction" [id] => FrictionReply;
        relax: POST "/contacts/{id}/relax" [id] RelaxRequest + options => RelaxReply;
        residual: GET "/contacts/{id}/residual" [id] => Residual;
        subsurface: POST "/contacts/{id}/subsurface" [id] SubsurfaceRequest => SubsurfaceReply;
        fork: POST "/contacts/{id}/fork" [id] ForkRequest + options => NewSession;
        job: GET "/jobs/{id}" [id] => JobReply;
        job_result: GET "/jobs/{id}/result" [id] => SweepReply;
        /// A page, beyond the `next` of the page before.
        contacts: GET "/contacts" ? after: Uuid, limit: usize => SessionPage;
        /// A page, beyond the `next` of the page before.
        history: GET "/contacts/{id}/history" [id] ? after: u64, limit: usize => HistoryPage;
        /// A page of moves with `points_per_move` points for each, by default the recorded states alone.
        hysteresis_loop:
            GET "/contacts/{id}/loop" [id] ? after: u64, limit: usize, points_per_move: usize => LoopPage;
        /// The newest `last` closed cycles, oldest first.
        cycles: GET "/contacts/{id}/cycles" [id] ? last: usize => CyclePage;
        /// Those in one state, or all.
        jobs: GET "/jobs" ? state: JobState => JobList;
        openapi: GET "/openapi.json" => serde_json::Value;
    }

    /// `GET /contacts?label=`: a page of those whose label contains the text, whatever the case of its ASCII letters.
    pub async fn contacts_labelled(
        &self,
        label: &str,
        after: Option<Uuid>,
        limit: Option<usize>,
    ) -> Result<SessionPage, Error> {
        let call = self.call(Method::GET, "/contacts").query(&[("label", label)]);
        json(call.query(&[("after", after)]).query(&[("limit", limit)])).await
    }

    /// `GET /contacts?order=newest`: a page of the newest, beyond the `next` of the page before.
    pub async fn newest_contacts(&self, after: Option<Uuid>, limit: Option<usize>) -> Result<SessionPage, Error> {
        let call = self.call(Method::GET, "/contacts").query(&[("order", ContactOrder::Newest.name())]);
        json(call.query(&[("after", after)]).query(&[("limit", limit)])).await
    }

    /// `GET /contacts/{id}/stress`.
    pub async fn stress(&self, id: Uuid, request: &StressRequest, residual: bool) -> Result<StressReply, Error> {
        let radii = request.radii.as_ref().map(|radii| listed(radii.iter().map(|radius| format!("{radius:e}"))));
        let fields = request.fields.as_ref().map(|fields| listed(fields.iter().map(|field| field.name().to_owned())));
        let call = self.call(Method::GET, &format!("/contacts/{id}/stress"));
        let call = call.query(&[("points", request.points)]).query(&[("radii", radii), ("fields", fields)]);
        json(call.query(&[("residual", residual)])).await
    }

    /// `POST /files/scan`.
    pub async fn read_scan(&self, file: Vec<u8>, hints: &ScanFileHints) -> Result<ScanFileReply, Error> {
        let call = self.call(Method::POST, "/files/scan").query(hints);
        json(call.header(CONTENT_TYPE, "application/octet-stream").body(file)).await
    }

    /// `POST /files/loop`.
    pub async fn read_loop(&self, file: Vec<u8>, hints: &LoopFileHints) -> Result<LoopFileReply, Error> {
        let call = self.call(Method::POST, "/files/loop").query(hints);
        json(call.header(CONTENT_TYPE, "application/octet-stream").body(file)).await
    }

    /// `GET /contacts/{id}/cycle`: the steady cycles of the contact at its present load.
    pub async fn contact_cycle(
        &self,
        id: Uuid,
        drive: &CycleDrive,
        machine: Option<Machine>,
        harmonics: Option<usize>,
        density: &WorkDensity,
    ) -> Result<CycleReply, Error> {
        let exact = |values: &[f64]| listed(values.iter().map(|value| format!("{value:e}")));
        let stiffness = machine.map(|machine| format!("{:e}", machine.stiffness));
        let call = self.call(Method::GET, &format!("/contacts/{id}/cycle"));
        let call = call.query(&[(drive.name(), exact(drive.amplitudes().all()))]);
        let call = call.query(&[("machine_stiffness", stiffness), ("radii", density.radii.as_deref().map(exact))]);
        json(call.query(&[("harmonics", harmonics), ("points", density.points)])).await
    }

    /// `GET /contacts/{id}/events`: the states beyond the move `after`, or the present one and then each new one. The
    /// stream ends when the service or the connection does; continue from the sequence of the last state then.
    pub async fn events(
        &self,
        id: Uuid,
        after: Option<u64>,
    ) -> Result<impl Stream<Item = Result<Event, Error>> + Send + use<>, Error> {
        let mut call = self.call(Method::GET, &format!("/contacts/{id}/events"));
        if let Some(after) = after {
            call = call.header("last-event-id", after);
        }
        let response = call.send().await?;
        let status = response.status();
        if !status.is_success() {
            return Err(refusal(status, &response.bytes().await?));
        }
        let events = response.bytes_stream().eventsource();
        Ok(events.filter_map(move |event| std::future::ready(event_of(status, event))))
    }

    /// `PATCH /contacts/{id}`: another label, or none.
    pub async fn rename(&self, id: Uuid, label: Option<&str>, options: &Options) -> Result<SessionReply, Error> {
        let request = RenameRequest { label: label.map(str::to_owned) };
        let call = self.call(Method::PATCH, &format!("/contacts/{id}")).json(&request);
        json(with(call, options)).await
    }

    /// `DELETE /contacts/{id}`.
    pub async fn delete(&self, id: Uuid, options: &Options) -> Result<(), Error> {
        sent(with(self.call(Method::DELETE, &format!("/contacts/{id}")), options)).await.map(drop)
    }

    /// `POST /sweep`.
    pub async fn sweep(&self, request: &SweepRequest, options: &Options) -> Result<Swept, Error> {
        let (status, body) = sent(with(self.call(Method::POST, "/sweep").json(request), options)).await?;
        if status == StatusCode::ACCEPTED {
            read(status, &body).map(Swept::Job)
        } else {
            read(status, &body).map(Swept::Table)
        }
    }

    /// `DELETE /jobs/{id}`.
    pub async fn delete_job(&self, id: Uuid) -> Result<(), Error> {
        sent(self.call(Method::DELETE, &format!("/jobs/{id}"))).await.map(drop)
    }

    /// `GET /healthz`: whether the process is alive.
    pub async fn healthz(&self) -> Result<(), Error> {
        sent(self.call(Method::GET, "/healthz")).await.map(drop)
    }

    /// `GET /readyz`: whether it can serve.
    pub async fn readyz(&self) -> Result<(), Error> {
        sent(self.call(Method::GET, "/readyz")).await.map(drop)
    }

    fn call(&self, method: Method, path: &str) -> RequestBuilder {
        let call = self.http.request(method, format!("{}{path}", self.base));
        match &self.authorization {
            Some(key) => call.header(AUTHORIZATION, key.clone()),
            None => call,
        }
    }
}

fn with(mut call: RequestBuilder, options: &Options) -> RequestBuilder {
    if let Some(sequence) = options.if_match {
        call = call.header("if-match", format!("\"{sequence}\""));
    }
    if let Some(key) = &options.idempotency_key {
        call = call.header("idempotency-key", key);
    }
    call
}

fn listed(items: impl Iterator<Item = String>) -> String {
    items.collect::<Vec<_>>().join(",")
}

async fn sent(call: RequestBuilder) -> Result<(StatusCode, Vec<u8>), Error> {
    let response = call.send().await?;
    let status = response.status();
    let body = response.bytes().await?.to_vec();
    if status.is_success() { Ok((status, body)) } else { Err(refusal(status, &body)) }
}

fn refusal(status: StatusCode, body: &[u8]) -> Error {
    match serde_json::from_slice(body) {
        Ok(problem) => Error::Problem(Box::new(problem)),
        Err(error) => Error::Unexpected { status, detail: error.to_string() },
    }
}

/// An event as received, unless its kind is that of a later version of the service.
fn event_of(
    status: StatusCode,
    event: Result<eventsource_stream::Event, EventStreamError<reqwest::Error>>,
) -> Option<Result<Event, Error>> {
    let unexpected = |error: &dyn std::fmt::Display| Error::Unexpected { status, detail: error.to_string() };
    let event = match event {
        Ok(event) => event,
        Err(EventStreamError::Transport(error)) => return Some(Err(error.into())),
        Err(other) => return Some(Err(unexpected(&other))),
    };
    let read = match event.event.as_str() {
        "state" => serde_json::from_str(&event.data).map(|state| Event::State(Box::new(state))),
        "end" => serde_json::from_str(&event.data).map(|EndEvent { reason }| Event::End(reason)),
        _ => return None,
    };
    Some(read.map_err(|error| unexpected(&error)))
}

async fn json<T: DeserializeOwned>(call: RequestBuilder) -> Result<T, Error> {
    let (status, body) = sent(call).await?;
    read(status, &body)
}

fn read<T: DeserializeOwned>(status: StatusCode, body: &[u8]) -> Result<T, Error> {
    serde_json::from_slice(body).map_err(|error| Error::Unexpected { status, detail: error.to_string() })
}
