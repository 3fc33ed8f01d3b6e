//! Every computation over HTTP: its route with admission and limits, its part of the OpenAPI document, and its reply on
//! a stored contact.

use std::marker::PhantomData;
use std::sync::Arc;

use axum::extract::State;
use axum::http::{HeaderMap, header};
use axum::response::Response;
use axum::routing::{MethodRouter, post};
use utoipa::openapi::example::ExampleBuilder;
use utoipa::openapi::path::{HttpMethod, OperationBuilder, PathItem, PathsBuilder};
use utoipa::openapi::request_body::RequestBodyBuilder;
use utoipa::openapi::{ContentBuilder, Ref, Required, ResponseBuilder};
use utoipa::{PartialSchema, ToSchema};
use uuid::Uuid;

use crate::admission::Reservation;
use crate::otlp;
use stickslip_compute::computations::{
    Computation, DisplayOptions, FromStored, OnContact, Outcome, Route, Task, Visitor,
};

use super::checked_query::CheckedQuery;
use super::extract::{CheckedBody, HeldResources};
use super::facts::{Facts, Routes};
use super::formats::{Format, Negotiated as _};
use super::problem::Problem;
use super::query_parameters::{Kind as _, QueryParams, QueryReader, described, formats, words};
use super::reply;
use super::state::{App, TenantApp};

impl Routes {
    fn add_computation<C: Computation>(&mut self, facts: Facts, handler: MethodRouter<Arc<App>>) {
        let Some(route) = C::ABOUT.route else { return };
        let mut schemas = Vec::new();
        add_schemas::<C::Request>(&mut schemas);
        add_schemas::<<C::Outcome as Outcome>::Reply>(&mut schemas);
        let formats = if C::ABOUT.formats.len() > 1 { C::ABOUT.formats } else { &[] };
        let described = PathItem::new(HttpMethod::Post, operation::<C>(route));
        let paths = PathsBuilder::new().path(route.path, described).build();
        self.add(Facts { formats, ..facts }, (schemas, paths, handler));
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

type Schemas = Vec<(String, utoipa::openapi::RefOr<utoipa::openapi::schema::Schema>)>;

fn add_schemas<T: ToSchema>(schemas: &mut Schemas) {
    schemas.push((T::name().into_owned(), <T as PartialSchema>::schema()));
    T::schemas(schemas);
}

/// The operation of a computation.
fn operation<C: Computation>(route: Route) -> OperationBuilder {
    let about = C::ABOUT;
    let json = |name: &str| ContentBuilder::new().schema(Some(Ref::from_schema_name(name)));
    let examples = C::examples().into_iter().map(|example| {
        let shown = ExampleBuilder::new().summary(example.summary).value(Some(example.value));
        (example.name, shown)
    });
    let request = json(&C::Request::name()).examples_from_iter(examples).build();
    let reply = json(&<C::Outcome as Outcome>::Reply::name()).build();
    let mut operation = OperationBuilder::new()
        .tag(route.tag)
        .summary(Some(about.title))
        .description(Some(about.description))
        .operation_id(Some(route.operation))
        .request_body(Some(
            RequestBodyBuilder::new().content("application/json", request).required(Some(Required::True)).build(),
        ))
        .response("200", ResponseBuilder::new().description(about.reply).content("application/json", reply));
    if about.formats.len() > 1 {
        let format = format!(
            "`columns` (this document), `rows` (a JSON array of flat objects), `csv`, `ndjson`, `arrow` (an Arrow IPC \
             stream), or a picture as `svg` or `png`. {} If it is left out, `Accept` decides.",
            about.shows
        );
        operation = operation.parameter(described("format", format, &formats(about.formats), None));
        if let Some(choice) = about.choice {
            let kind = words(choice.words, |word| word);
            operation = operation.parameter(described(choice.name, choice.description.to_owned(), &kind, None));
        }
    }
    operation
}

/// How a client wants the reply of a computation, as its query says.
struct ShownQuery<C> {
    format: Option<Format>,
    choice: Option<&'static str>,
    of: PhantomData<fn() -> C>,
}

impl<C: Computation> QueryParams for ShownQuery<C> {
    fn take(query: &mut QueryReader, _: &HeaderMap) -> Option<ShownQuery<C>> {
        let format = formats(C::ABOUT.formats).read("format", query);
        let choice = C::ABOUT.choice.and_then(|choice| words(choice.words, |word| word).read(choice.name, query));
        Some(ShownQuery { format, choice, of: PhantomData })
    }
}

type AskedFor<C> = Result<CheckedQuery<ShownQuery<C>>, Problem>;

fn shown<C: Computation>(query: AskedFor<C>, headers: &HeaderMap) -> Result<DisplayOptions, Problem> {
    if C::ABOUT.formats.len() == 1 {
        // It has no parameters, and never refused those that it does not have.
        return Ok(DisplayOptions::in_format(Format::Columns));
    }
    let CheckedQuery(ShownQuery { format, choice, .. }) = query?;
    Ok(DisplayOptions { choice, ..DisplayOptions::in_format(Format::chosen(format, headers, C::ABOUT.formats)?) })
}

fn written<C: Computation>(body: Vec<u8>, shown: &DisplayOptions) -> Response {
    if C::ABOUT.formats.len() == 1 { reply::json(body) } else { shown.format.reply(body) }
}

/// Answers a request that defines its contact.
async fn answer<C: Computation>(
    State(app): State<Arc<App>>,
    headers: HeaderMap,
    query: AskedFor<C>,
    request: CheckedBody<C::Request>,
) -> Result<Response, Problem> {
    let shown = shown::<C>(query, &headers)?;
    run::<C>(&app, request.body, shown, request.held).await
}

/// Answers a request that may name a stored contact.
async fn answer_stored<C: FromStored>(
    TenantApp(app): TenantApp,
    headers: HeaderMap,
    query: AskedFor<C>,
    request: CheckedBody<C::Request>,
) -> Result<Response, Problem> {
    let shown = shown::<C>(query, &headers)?;
    let CheckedBody { body, mut held, .. } = request;
    match C::stored(body) {
        Ok((id, expected, task)) => {
            let (_, body) = app.sessions.compute_on(id, expected, task, shown, &mut held.memory).await?;
            Ok(held.on(written::<C>(body, &shown)))
        }
        Err(task) => run::<C>(&app, task, shown, held).await,
    }
}

async fn run<C: Computation>(
    app: &App,
    task: Task<C>,
    shown: DisplayOptions,
    mut held: HeldResources,
) -> Result<Response, Problem> {
    C::check_shown(&task, &shown)?;
    let (stop, _guard) = held.deadline(&app.pool);
    held.resize(&app.pool, C::bytes(&task) + shown.bytes(C::rows(&task))).await?;
    let cost = C::cost(&task).saturating_add(shown.format.cost());
    let work = move || {
        let outcome = otlp::part!("solve").in_scope(|| C::run(task, &stop))?;
        Ok::<_, Problem>(otlp::part!("write").in_scope(|| shown.write(&outcome, &stop))??)
    };
    Ok(held.on(written::<C>(app.pool.run(cost, work).await??, &shown)))
}

/// The reply of a computation on a stored contact, in the format that the query names or `Accept` prefers, with the
/// sequence of the contact as its version.
pub async fn get_of_contact<T: OnContact>(
    app: &App,
    id: Uuid,
    headers: &HeaderMap,
    format: Option<Format>,
    task: T,
) -> Result<Response, Problem> {
    let format = Format::chosen(format, headers, &Format::ALL)?;
    match unchanged(app, id, headers, format).await? {
        Some(unchanged) => Ok(unchanged),
        None => of_contact(app, id, format, task, Reservation::default()).await,
    }
}

/// 304 if the client has the present version of what is derived from a contact, before anything is computed.
pub async fn unchanged(app: &App, id: Uuid, headers: &HeaderMap, format: Format) -> Result<Option<Response>, Problem> {
    if !headers.contains_key(header::IF_NONE_MATCH) {
        return Ok(None);
    }
    let tag = format.tag(&app.sessions.get(id).await?.sequence.to_string());
    Ok(reply::is_current(headers, &tag).then(|| reply::not_modified(&tag)))
}

/// The reply of a computation on a stored contact, with the sequence of the contact as its version, for a request that
/// has reserved this memory so far.
pub async fn of_contact<T: OnContact>(
    app: &App,
    id: Uuid,
    format: Format,
    task: T,
    mut memory: Reservation,
) -> Result<Response, Problem> {
    let shown = DisplayOptions::in_format(format);
    task.check_shown(&shown)?;
    let (sequence, body) = app.sessions.compute_on(id, None, task, shown, &mut memory).await?;
    Ok(reply::holding(reply::tagged(format.reply(body), &format.tag(&sequence.to_string())), memory))
}
