//! Every computation over HTTP: its route with admission and limits, its part of the OpenAPI document, and its reply on
//! a stored contact.

use std::sync::Arc;

use axum::extract::{FromRequestParts as _, Request};
use axum::http::{HeaderMap, header};
use axum::response::{IntoResponse, Response};
use axum::routing::MethodRouter;
use futures::FutureExt as _;
use utoipa::openapi::example::ExampleBuilder;
use utoipa::openapi::path::{HttpMethod, Operation, OperationBuilder, PathItem, PathsBuilder};
use utoipa::openapi::request_body::RequestBodyBuilder;
use utoipa::openapi::{ContentBuilder, Ref, RefOr, Required, ResponseBuilder};
use uuid::Uuid;

use crate::admission::Deadline;
use crate::otlp;
use stickslip_compute::computations::{
    About, CheckedTask, ContactTask, DisplayOptions, Entry, Example, Route, Schemas,
};

use super::extract::checked_document;
use super::facts::{Facts, Handler, Routes};
use super::formats::{self, Format};
use super::problem::Problem;
use super::query_parameters::{GivenQuery, described_format, words};
use super::reply;
use super::request_context::RequestContext;
use super::state::{App, TenantApp};

const JSON: &str = "application/json";

impl Routes {
    /// Adds the route of a computation, and the schemas of its documents.
    pub fn add_computation(&mut self, entry: Entry) {
        let Some(route) = entry.about.route else { return };
        let schemas = (entry.schemas)();
        let described = PathItem::new(HttpMethod::Post, operation(&entry, route, &schemas));
        let paths = PathsBuilder::new().path(route.path, described).build();
        let facts = if entry.takes_stored { Facts::READS_STORED } else { Facts::READS };
        let handler: Handler =
            Arc::new(move |request, app| Box::pin(answer(entry, app, request).map(IntoResponse::into_response)));
        self.add(facts, (schemas.all, paths, MethodRouter::new()), &handler);
    }
}

/// The operation of a computation.
fn operation(Entry { about, examples, .. }: &Entry, route: Route, schemas: &Schemas) -> Operation {
    let document = |name: &str| ContentBuilder::new().schema(Some(Ref::from_schema_name(name)));
    let example =
        |Example { name, summary, value }| (name, ExampleBuilder::new().summary(summary).value(Some(value)).build());
    let request = document(&schemas.request).examples_from_iter(examples().into_iter().map(example)).build();
    let body = RequestBodyBuilder::new().required(Some(Required::True)).content(JSON, request);
    let response = ResponseBuilder::new().description(about.reply).content(JSON, document(&schemas.reply).build());
    let mut operation = OperationBuilder::new()
        .tag(route.tag)
        .summary(Some(about.title))
        .description(Some(about.description))
        .operation_id(Some(route.operation))
        .request_body(Some(body.build()))
        .response("200", response.build())
        .build();
    if about.formats.len() > 1 {
        let mut parameters = vec![described_format(about.formats, about.shows)];
        parameters.extend(
            about.choice.map(|choice| words(choice.words, |word| word).described(choice.name, choice.description)),
        );
        operation.parameters = Some(parameters.into_iter().map(RefOr::T).collect());
    }
    operation
}

/// How a client wants the reply of a computation, as its query says.
fn shown(about: &About, query: GivenQuery, headers: &HeaderMap) -> Result<DisplayOptions, Problem> {
    query.read_by(headers, |query| {
        let format = query.format(about.formats);
        let choice = about.choice.and_then(|choice| words(choice.words, |word| word).read(choice.name, query));
        Some(format.map(|format| DisplayOptions { choice, ..DisplayOptions::in_format(format) }))
    })?
}

fn written(about: &About, body: Vec<u8>, shown: &DisplayOptions) -> Response {
    if about.formats.len() == 1 { reply::json(body) } else { formats::reply(shown.format, body) }
}

/// Answers a request, which may name a stored contact if the computation takes one.
async fn answer(
    Entry { about, request: kind, .. }: Entry,
    app: Arc<App>,
    request: Request,
) -> Result<Response, Problem> {
    let (mut parts, body) = request.into_parts();
    // Those of a computation with a single format have no parameters, and never refused those that they do not have.
    let shown = match GivenQuery::of(&parts) {
        _ if about.formats.len() == 1 => Ok(DisplayOptions::in_format(Format::Columns)),
        Ok(query) => shown(&about, query, &parts.headers),
        Err(problem) => Err(problem),
    };
    let Ok(TenantApp(of_tenant)) = TenantApp::from_request_parts(&mut parts, &app).await;
    let document = checked_document(Request::from_parts(parts, body), &app, kind, false).await?;
    let (task, _, context) = document.of::<Box<dyn CheckedTask>>()?;
    let shown = shown?;
    match task.stored() {
        Err(task) => run(&context, &about, task, shown).await,
        Ok((id, expected, task)) => {
            let memory = &mut context.admission.memory.clone();
            let (_, body) = of_tenant.sessions.compute_on(id, expected, task, shown, memory).await?;
            Ok(written(&about, body, &shown))
        }
    }
}

async fn run(
    context: &RequestContext,
    about: &About,
    task: Box<dyn CheckedTask>,
    shown: DisplayOptions,
) -> Result<Response, Problem> {
    task.check_shown(&shown)?;
    context.reserve(task.bytes(&shown)).await?;
    let cost = task.cost(&shown);
    let work = move |stop: &Deadline| {
        let outcome = otlp::part!("solve").in_scope(|| task.run(stop))?;
        Ok::<_, Problem>(otlp::part!("write").in_scope(|| outcome.write(&shown, stop))??)
    };
    Ok(written(about, context.run(cost, work).await??, &shown))
}

/// The reply of a computation on a stored contact, with the sequence of the contact as its version, or 304.
pub async fn get_of_contact(
    app: &App,
    id: Uuid,
    headers: &HeaderMap,
    format: Format,
    task: Box<dyn ContactTask>,
    context: &RequestContext,
) -> Result<Response, Problem> {
    match unchanged(app, id, headers, format).await? {
        Some(unchanged) => Ok(unchanged),
        None => of_contact(app, id, format, task, context).await,
    }
}

/// 304 if the client has the present version of what is derived from a contact, before anything is computed.
pub async fn unchanged(app: &App, id: Uuid, headers: &HeaderMap, format: Format) -> Result<Option<Response>, Problem> {
    if !headers.contains_key(header::IF_NONE_MATCH) {
        return Ok(None);
    }
    let tag = formats::tag(format, &app.sessions.get(id).await?.sequence.to_string());
    Ok(reply::is_current(headers, &tag).then(|| reply::not_modified(&tag)))
}

/// The reply of a computation on a stored contact, with the sequence of the contact as its version.
pub async fn of_contact(
    app: &App,
    id: Uuid,
    format: Format,
    task: Box<dyn ContactTask>,
    context: &RequestContext,
) -> Result<Response, Problem> {
    let shown = DisplayOptions::in_format(format);
    task.check_shown(&shown)?;
    let (sequence, body) =
        app.sessions.compute_on(id, None, task, shown, &mut context.admission.memory.clone()).await?;
    let tag = formats::tag(format, &sequence.to_string());
    Ok(reply::tagged(formats::reply(format, body), &tag))
}
