//! Every computation over HTTP: its route with admission and limits, its part of the OpenAPI document, and its reply on
//! a stored contact.

use std::marker::PhantomData;
use std::sync::Arc;

use axum::http::{HeaderMap, header};
use axum::response::Response;
use axum::routing::{MethodRouter, post};
use serde_json::json;
use utoipa::openapi::RefOr;
use utoipa::openapi::path::{HttpMethod, Operation, PathItem, PathsBuilder};
use utoipa::{PartialSchema, ToSchema};
use uuid::Uuid;

use crate::admission::Deadline;
use crate::otlp;
use stickslip_compute::computations::{
    Computation, DisplayOptions, Example, FromStored, OnContact, Outcome, Route, Task, Visitor,
};

use super::extract::CheckedBody;
use super::facts::{Facts, Routes};
use super::formats::{self, Format};
use super::problem::Problem;
use super::query_parameters::{CheckedQuery, QueryParams, QueryReader, described_format, words};
use super::reply;
use super::request_context::RequestContext;
use super::state::{App, TenantApp};

impl Routes {
    fn add_computation<C: Computation>(&mut self, facts: Facts, handler: MethodRouter<Arc<App>>) {
        let Some(route) = C::ABOUT.route else { return };
        let mut schemas = Vec::new();
        add_schemas::<C::Request>(&mut schemas);
        add_schemas::<<C::Outcome as Outcome>::Reply>(&mut schemas);
        let described = PathItem::new(HttpMethod::Post, operation::<C>(route));
        let paths = PathsBuilder::new().path(route.path, described).build();
        self.add(facts, (schemas, paths, handler));
    }
}

/// Adds the route of every computation, and the schemas of its documents.
impl Visitor for Routes {
    fn visit<C: Computation>(&mut self) {
        self.add_computation::<C>(Facts::READS, post(answer::<C>));
    }

    fn visit_stored<C: FromStored>(&mut self) {
        self.add_computation::<C>(Facts::READS_STORED, post(answer_stored::<C>));
    }
}

type Schemas = Vec<(String, RefOr<utoipa::openapi::schema::Schema>)>;

fn add_schemas<T: ToSchema>(schemas: &mut Schemas) {
    schemas.push((T::name().into_owned(), <T as PartialSchema>::schema()));
    T::schemas(schemas);
}

/// The operation of a computation.
fn operation<C: Computation>(route: Route) -> Operation {
    let about = C::ABOUT;
    let document = |name: &str| json!({"schema": {"$ref": format!("#/components/schemas/{name}")}});
    let example = |Example { name, summary, value }| (name, json!({"summary": summary, "value": value}));
    let mut request = document(&C::Request::name());
    request["examples"] = C::examples().into_iter().map(example).collect();
    let reply = document(&<C::Outcome as Outcome>::Reply::name());
    let operation = json!({
        "tags": [route.tag],
        "summary": about.title,
        "description": about.description,
        "operationId": route.operation,
        "requestBody": {"required": true, "content": {"application/json": request}},
        "responses": {"200": {"description": about.reply, "content": {"application/json": reply}}},
    });
    let mut operation: Operation = serde_json::from_value(operation).unwrap_or_default();
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
struct Shown<C>(Result<DisplayOptions, Problem>, PhantomData<fn() -> C>);

impl<C: Computation> QueryParams for Shown<C> {
    fn take(query: &mut QueryReader<'_>) -> Option<Shown<C>> {
        let format = query.format(C::ABOUT.formats);
        let choice = C::ABOUT.choice.and_then(|choice| words(choice.words, |word| word).read(choice.name, query));
        let shown = format.map(|format| DisplayOptions { choice, ..DisplayOptions::in_format(format) });
        Some(Shown(shown, PhantomData))
    }
}

type AskedFor<C> = Result<CheckedQuery<Shown<C>>, Problem>;

fn shown<C: Computation>(query: AskedFor<C>) -> Result<DisplayOptions, Problem> {
    // One with a single format has no parameters, and never refused those that it does not have.
    if C::ABOUT.formats.len() == 1 { Ok(DisplayOptions::in_format(Format::Columns)) } else { query?.0.0 }
}

fn written<C: Computation>(body: Vec<u8>, shown: &DisplayOptions) -> Response {
    if C::ABOUT.formats.len() == 1 { reply::json(body) } else { formats::reply(shown.format, body) }
}

/// Answers a request that defines its contact.
async fn answer<C: Computation>(query: AskedFor<C>, request: CheckedBody<C::Request>) -> Result<Response, Problem> {
    let shown = shown::<C>(query)?;
    run::<C>(&request.context, request.body, shown).await
}

/// Answers a request that may name a stored contact.
async fn answer_stored<C: FromStored>(
    TenantApp(app): TenantApp,
    query: AskedFor<C>,
    request: CheckedBody<C::Request>,
) -> Result<Response, Problem> {
    let shown = shown::<C>(query)?;
    let CheckedBody { body, context, .. } = request;
    match C::stored(body) {
        Ok((id, expected, task)) => {
            let memory = &mut context.admission.memory.clone();
            let (_, body) = app.sessions.compute_on(id, expected, task, shown, memory).await?;
            Ok(written::<C>(body, &shown))
        }
        Err(task) => run::<C>(&context, task, shown).await,
    }
}

async fn run<C: Computation>(
    context: &RequestContext,
    task: Task<C>,
    shown: DisplayOptions,
) -> Result<Response, Problem> {
    C::check_shown(&task, &shown)?;
    context.reserve(C::bytes(&task) + shown.bytes(C::rows(&task))).await?;
    let cost = C::cost(&task).saturating_add(shown.format.cost());
    let work = move |stop: &Deadline| {
        let outcome = otlp::part!("solve").in_scope(|| C::run(task, stop))?;
        Ok::<_, Problem>(otlp::part!("write").in_scope(|| shown.write(&outcome, stop))??)
    };
    Ok(written::<C>(context.run(cost, work).await??, &shown))
}

/// The reply of a computation on a stored contact, with the sequence of the contact as its version, or 304.
pub async fn get_of_contact<T: OnContact>(
    app: &App,
    id: Uuid,
    headers: &HeaderMap,
    format: Format,
    task: T,
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
pub async fn of_contact<T: OnContact>(
    app: &App,
    id: Uuid,
    format: Format,
    task: T,
    context: &RequestContext,
) -> Result<Response, Problem> {
    let shown = DisplayOptions::in_format(format);
    task.check_shown(&shown)?;
    let (sequence, body) =
        app.sessions.compute_on(id, None, task, shown, &mut context.admission.memory.clone()).await?;
    let tag = formats::tag(format, &sequence.to_string());
    Ok(reply::tagged(formats::reply(format, body), &tag))
}
