//! A typed client for the service.
//!
//! ```no_run
//! # async fn example() -> Result<(), stickslip::client::Error> {
//! use stickslip::client::{Client, Options};
//! use stickslip::wire::{Move, MoveRequest};
//!
//! let client = Client::new("http://127.0.0.1:8080");
//! let page = client.contacts(None, None).await?;
//! for contact in page.items {
//!     let reply = client.apply(contact.id, &Move::displacement(1e-7).into(), &Options::default()).await?;
//!     println!("{} N", reply.state.force);
//! }
//! # Ok(())
//! # }
//! ```

use reqwest::{Method, RequestBuilder, StatusCode};
use serde::Serialize;
use serde::de::DeserializeOwned;
use uuid::Uuid;

use crate::wire::{
    CreateRequest, ForkRequest, HistoryPage, MoveReply, MoveRequest, NewSession, PathReply, PathRequest,
    ProblemDocument, SessionPage, SessionReply, SimulateReply, SimulateRequest, StressReply, StressRequest,
};

/// A handle on a service; clones share its connections.
#[derive(Clone, Debug)]
pub struct Client {
    base: String,
    http: reqwest::Client,
}

/// What makes a change safe to repeat.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Change only a contact that is at this sequence.
    pub if_match: Option<u64>,
    /// A name for the request: a repetition with the same name gets the first reply again.
    pub idempotency_key: Option<String>,
}

/// Why a call came to nothing.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The service refused, and says why.
    #[error("{} ({}): {}", .0.title, .0.code, .0.detail)]
    Problem(Box<ProblemDocument>),
    /// The service could not be reached, or its reply not be read.
    #[error(transparent)]
    Transport(#[from] reqwest::Error),
    /// What answered is not this service.
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
    #[must_use]
    pub fn problem(&self) -> Option<&ProblemDocument> {
        match self {
            Error::Problem(problem) => Some(problem),
            Error::Transport(_) | Error::Unexpected { .. } => None,
        }
    }
}

impl Client {
    /// A client for the service at `base`, such as `http://127.0.0.1:8080`.
    #[must_use]
    pub fn new(base: impl Into<String>) -> Client {
        let base: String = base.into();
        Client { base: base.trim_end_matches('/').to_owned(), http: reqwest::Client::new() }
    }

    /// `POST /simulate`.
    ///
    /// # Errors
    /// [`Error`], as for every call.
    pub async fn simulate(&self, request: &SimulateRequest) -> Result<SimulateReply, Error> {
        json(self.call(Method::POST, "/simulate").json(request)).await
    }

    /// `POST /contacts`.
    ///
    /// # Errors
    /// [`Error`], as for every call.
    pub async fn create(&self, request: &CreateRequest, options: &Options) -> Result<NewSession, Error> {
        self.post("/contacts", request, options).await
    }

    /// `GET /contacts`: a page, beyond the `next` of the page before.
    ///
    /// # Errors
    /// [`Error`], as for every call.
    pub async fn contacts(&self, after: Option<Uuid>, limit: Option<usize>) -> Result<SessionPage, Error> {
        json(self.call(Method::GET, "/contacts").query(&[("after", after)]).query(&[("limit", limit)])).await
    }

    /// `GET /contacts/{id}`.
    ///
    /// # Errors
    /// [`Error`], as for every call.
    pub async fn contact(&self, id: Uuid) -> Result<SessionReply, Error> {
        json(self.call(Method::GET, &format!("/contacts/{id}"))).await
    }

    /// `POST /contacts/{id}/move`.
    ///
    /// # Errors
    /// [`Error`], as for every call.
    pub async fn apply(&self, id: Uuid, request: &MoveRequest, options: &Options) -> Result<MoveReply, Error> {
        self.post(&format!("/contacts/{id}/move"), request, options).await
    }

    /// `POST /contacts/{id}/path`.
    ///
    /// # Errors
    /// [`Error`], as for every call.
    pub async fn path(&self, id: Uuid, request: &PathRequest, options: &Options) -> Result<PathReply, Error> {
        self.post(&format!("/contacts/{id}/path"), request, options).await
    }

    /// `GET /contacts/{id}/stress`.
    ///
    /// # Errors
    /// [`Error`], as for every call.
    pub async fn stress(&self, id: Uuid, request: &StressRequest, residual: bool) -> Result<StressReply, Error> {
        let radii = request.radii.as_ref().map(|radii| listed(radii.iter().map(|radius| format!("{radius:e}"))));
        let fields = request.fields.as_ref().map(|fields| listed(fields.iter().map(|field| field.name().to_owned())));
        let call = self.call(Method::GET, &format!("/contacts/{id}/stress"));
        let call = call.query(&[("points", request.points)]).query(&[("radii", radii), ("fields", fields)]);
        json(call.query(&[("residual", residual)])).await
    }

    /// `GET /contacts/{id}/history`: a page, beyond the `next` of the page before.
    ///
    /// # Errors
    /// [`Error`], as for every call.
    pub async fn history(&self, id: Uuid, after: Option<u64>, limit: Option<usize>) -> Result<HistoryPage, Error> {
        let call = self.call(Method::GET, &format!("/contacts/{id}/history"));
        json(call.query(&[("after", after)]).query(&[("limit", limit)])).await
    }

    /// `POST /contacts/{id}/fork`.
    ///
    /// # Errors
    /// [`Error`], as for every call.
    pub async fn fork(&self, id: Uuid, request: &ForkRequest, options: &Options) -> Result<NewSession, Error> {
        self.post(&format!("/contacts/{id}/fork"), request, options).await
    }

    /// `DELETE /contacts/{id}`.
    ///
    /// # Errors
    /// [`Error`], as for every call.
    pub async fn delete(&self, id: Uuid, options: &Options) -> Result<(), Error> {
        sent(with(self.call(Method::DELETE, &format!("/contacts/{id}")), options)).await.map(drop)
    }

    /// `GET /openapi.json`.
    ///
    /// # Errors
    /// [`Error`], as for every call.
    pub async fn openapi(&self) -> Result<serde_json::Value, Error> {
        json(self.call(Method::GET, "/openapi.json")).await
    }

    /// `GET /healthz`: whether the process is alive.
    ///
    /// # Errors
    /// [`Error`], as for every call.
    pub async fn healthz(&self) -> Result<(), Error> {
        sent(self.call(Method::GET, "/healthz")).await.map(drop)
    }

    /// `GET /readyz`: whether it can serve.
    ///
    /// # Errors
    /// [`Error`], as for every call.
    pub async fn readyz(&self) -> Result<(), Error> {
        sent(self.call(Method::GET, "/readyz")).await.map(drop)
    }

    fn call(&self, method: Method, path: &str) -> RequestBuilder {
        self.http.request(method, format!("{}{path}", self.base))
    }

    async fn post<T: DeserializeOwned>(
        &self,
        path: &str,
        body: &impl Serialize,
        options: &Options,
    ) -> Result<T, Error> {
        json(with(self.call(Method::POST, path).json(body), options)).await
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
    if status.is_success() {
        return Ok((status, body));
    }
    Err(match serde_json::from_slice(&body) {
        Ok(problem) => Error::Problem(Box::new(problem)),
        Err(error) => Error::Unexpected { status, detail: error.to_string() },
    })
}

async fn json<T: DeserializeOwned>(call: RequestBuilder) -> Result<T, Error> {
    let (status, body) = sent(call).await?;
    serde_json::from_slice(&body).map_err(|error| Error::Unexpected { status, detail: error.to_string() })
}
