//! Parameters of queries. Each is declared once, in `parameters!`: its name, its type, its limits and its description
//! are what the handler and the command line read and what the OpenAPI document says. A parameter that an operation
//! does not have is refused by name.

use std::ops::RangeInclusive;
use std::sync::Arc;

use axum::extract::{FromRequestParts, Query};
use axum::http::HeaderMap;
use axum::http::request::Parts;
use serde_json::{Value, json};
use utoipa::openapi::Required;
use utoipa::openapi::path::{Parameter, ParameterBuilder, ParameterIn};
use uuid::Uuid;

use stickslip_mechanics::range::Range;
use stickslip_wire::limits::{Array, Characters, Limit};
use stickslip_wire::{Fault, Faults, Field, JsonPath, Rejection};

use super::formats::{self, Format};
use super::openapi::write_keywords;
use super::problem::Problem;
use super::state::App;

/// The parameters of a request that have not been taken yet, and the faults of those that have.
pub struct QueryReader<'h> {
    given: Vec<(String, String)>,
    headers: &'h HeaderMap,
    known: Vec<&'static str>,
    /// What is wrong with the parameters so far.
    pub faults: Faults,
}

impl QueryReader<'_> {
    /// Reads the parameters as the client gives them, with the headers beside them.
    ///
    /// # Errors
    /// A [`Problem`] with every fault.
    pub fn read<T: QueryParams>(given: Vec<(String, String)>, headers: &HeaderMap) -> Result<T, Problem> {
        GivenQuery(given).read_by(headers, T::take)
    }

    /// Notes the parameters that were given and not taken.
    fn refuse_others(&mut self) {
        let query = self;
        let known = query.known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let known = if known.is_empty() { "none".to_owned() } else { known };
        for (name, _) in std::mem::take(&mut query.given) {
            let again = query.known.iter().any(|known| *known == name);
            let detail = if again { "given twice".to_owned() } else { format!("unknown parameter, expected {known}") };
            query.faults.add(JsonPath::Root.member(&shown(&name)), detail);
        }
    }

    /// The format of the reply, out of these: the one that the parameter `format` names, or that `Accept` prefers.
    ///
    /// # Errors
    /// As [`formats::chosen`].
    pub fn format(&mut self, formats: &'static [Format]) -> Result<Format, Problem> {
        let named = closed(formats, Format::name).read("format", self);
        formats::chosen(named, self.headers, formats)
    }
}

/// The parameters of a request as the client gives them.
pub struct GivenQuery(Vec<(String, String)>);

impl GivenQuery {
    /// Those of a request.
    ///
    /// # Errors
    /// A [`Problem`] if it has no such query.
    pub fn of(parts: &Parts) -> Result<GivenQuery, Problem> {
        let given = Query::try_from_uri(&parts.uri);
        let Query(given) = given.map_err(|error| Rejection::Invalid(vec![Fault::new("", error.body_text())]))?;
        Ok(GivenQuery(given))
    }

    /// Reads the parameters that `take` takes, and refuses all others.
    ///
    /// # Errors
    /// A [`Problem`] with every fault.
    pub fn read_by<T>(
        self,
        headers: &HeaderMap,
        take: impl FnOnce(&mut QueryReader<'_>) -> Option<T>,
    ) -> Result<T, Problem> {
        let mut query = QueryReader { given: self.0, headers, known: Vec::new(), faults: Faults::default() };
        let value = take(&mut query);
        query.refuse_others();
        Ok(query.faults.done(value)?)
    }
}

/// The beginning of a text of the client, for a refusal.
fn shown(text: &str) -> String {
    text.chars().take(40).collect()
}

/// The parameters of an operation.
pub trait QueryParams: Sized {
    /// Takes its parameters out of the query; `None` if it has noted a fault without which there would be a value.
    fn take(query: &mut QueryReader<'_>) -> Option<Self>;
}

/// For operations without parameters.
impl QueryParams for () {
    fn take(_: &mut QueryReader<'_>) -> Option<()> {
        Some(())
    }
}

/// The checked parameters of a request.
pub struct CheckedQuery<T>(pub T);

impl<T: QueryParams> FromRequestParts<Arc<App>> for CheckedQuery<T> {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &Arc<App>) -> Result<Self, Problem> {
        GivenQuery::of(parts)?.read_by(&parts.headers, T::take).map(CheckedQuery)
    }
}

/// Declares the parameters of a query, `parameters! { pub struct NAME { member: V = KIND, .. } }`. A member has the
/// type `Option<V>` of its kind or, with `or DEFAULT`, `V`. With `..formats(FORMATS, WHAT THEY SHOW)` at the end it
/// also has the `format` of the reply, or why there is none that `Accept` admits.
macro_rules! parameters {
    (@type $type:ty) => { Option<$type> };
    (@type $type:ty, $default:expr) => { $type };
    (
        $(#[doc = $about:literal])*
        pub struct $name:ident {
            $($(#[doc = $doc:literal])* $member:ident: $type:ty = $kind:expr $(, or $default:expr)?;)*
            $(..formats($formats:expr, $shows:expr))?
        }
    ) => {
        $(#[doc = $about])*
        pub struct $name {
            $($(#[doc = $doc])*
            pub $member: $crate::api::query_parameters::parameters!(@type $type $(, $default)?),)*
            $(#[doc = concat!("The format of the reply, or why there is none. ", $shows)]
            pub format: Result<$crate::api::formats::Format, $crate::api::problem::Problem>,)?
        }

        impl $crate::api::query_parameters::QueryParams for $name {
            fn take(query: &mut $crate::api::query_parameters::QueryReader<'_>) -> Option<$name> {
                Some($name {
                    $($member: $kind.read(stringify!($member), query)$(.unwrap_or($default))?,)*
                    $(format: query.format($formats),)?
                })
            }
        }

        impl utoipa::IntoParams for $name {
            fn into_params(
                _: impl Fn() -> Option<utoipa::openapi::path::ParameterIn>,
            ) -> Vec<utoipa::openapi::path::Parameter> {
                vec![
                    $({
                        let kind = $kind$(.with_default(serde_json::json!($default)))?;
                        kind.described(stringify!($member), &[$($doc),*].map(str::trim).join(" "))
                    },)*
                    $($crate::api::query_parameters::described_format($formats, $shows),)?
                ]
            }
        }
    };
}
pub(super) use parameters;

/// The parameter of the formats, as the OpenAPI document has it, and what they show.
pub fn described_format(values: &'static [Format], shows: &str) -> Parameter {
    let others = match (values.contains(&Format::Arrow), values.contains(&Format::Svg)) {
        (true, true) => "`ndjson`, `arrow` (an Arrow IPC stream), or a picture as `svg` or `png`",
        (true, false) => "`ndjson` or `arrow` (an Arrow IPC stream)",
        (false, true) => "`ndjson`, or a picture as `svg` or `png`",
        (false, false) => "`ndjson`",
    };
    let shows = if shows.is_empty() { String::new() } else { format!(" {}", shows.trim()) };
    let description = format!(
        "`columns` (this document), `rows` (a JSON array of flat objects), `csv`, {others}.{shows} If it is left out, \
         `Accept` decides."
    );
    closed(values, Format::name).with_default(json!(Format::Columns.name())).described("format", &description)
}

/// A kind of parameter, with values of the type `V`.
pub struct Kind<V> {
    /// The value of a text, or what is expected in its place.
    parse: Parse<V>,
    /// Notes what is wrong with a value that could be read.
    check: Option<Check<V>>,
    /// Whether it is a list, whose members are separated by commas or given one by one under the same name.
    is_list: bool,
    schema: Box<dyn Fn() -> Value>,
    /// The value that is taken if the client gives none.
    default: Option<Value>,
    /// An example for the document.
    example: Option<Value>,
}

type Parse<V> = Box<dyn Fn(&str) -> Result<V, String>>;
type Check<V> = Box<dyn Fn(&V, JsonPath<'_>, &mut Faults)>;

impl<V: 'static> Kind<V> {
    /// Values that `parse` reads, which `expected` describes for the text of a refusal.
    pub fn new(expected: &'static str, parse: fn(&str) -> Option<V>, schema: fn() -> Value) -> Kind<V> {
        Kind::of(move |text| parse(text).ok_or_else(|| expected.to_owned()), schema)
    }

    /// As [`Kind::new`], for texts of which `parse` itself says what is expected.
    pub fn of(parse: impl Fn(&str) -> Result<V, String> + 'static, schema: impl Fn() -> Value + 'static) -> Kind<V> {
        let (parse, schema) = (Box::new(parse), Box::new(schema));
        Kind { parse, check: None, is_list: false, schema, default: None, example: None }
    }

    /// The same with a default.
    pub fn with_default(self, default: Value) -> Kind<V> {
        Kind { default: Some(default), ..self }
    }

    /// The same with an example.
    pub fn with_example(self, example: Value) -> Kind<V> {
        Kind { example: Some(example), ..self }
    }

    /// The value, if the client gives one that can be read.
    pub fn read(&self, name: &'static str, query: &mut QueryReader<'_>) -> Option<V> {
        query.known.push(name);
        let position = query.given.iter().position(|(key, _)| key == name)?;
        let (_, mut text) = query.given.remove(position);
        if self.is_list {
            for (_, more) in query.given.extract_if(.., |(key, _)| key == name) {
                text = format!("{text},{more}");
            }
        }
        match (self.parse)(&text) {
            Ok(value) => {
                if let Some(check) = &self.check {
                    check(&value, JsonPath::Root.member(name), &mut query.faults);
                }
                Some(value)
            }
            Err(expected) => {
                let detail = format_args!("`{}` is not {expected}", shown(&text));
                query.faults.add(JsonPath::Root.member(name), detail);
                None
            }
        }
    }

    /// The parameter as the OpenAPI document has it.
    pub fn described(self, name: &str, description: &str) -> Parameter {
        let mut schema = (self.schema)();
        if let Some(default) = self.default {
            schema["default"] = default;
        }
        let mut members = vec![("schema", schema)];
        if self.is_list {
            members.extend([("style", json!("form")), ("explode", json!(false))]);
        }
        members.extend(self.example.map(|example| ("example", example)));
        ParameterBuilder::new()
            .name(name)
            .parameter_in(ParameterIn::Query)
            .required(Required::False)
            .description(Some(description))
            // The library would drop keywords that it does not know.
            .extensions(Some(members.into_iter().collect()))
            .build()
    }
}

/// A count within limits.
pub fn count(limit: &'static RangeInclusive<usize>) -> Kind<usize> {
    let parse = |text: &str| text.parse().ok();
    limited("a whole number, not negative", parse, limit, || json!({"type": "integer"}))
}

/// A number within the range of a quantity.
pub fn number(range: &'static Range) -> Kind<f64> {
    limited("a number", |text| text.parse().ok(), range, || json!({"type": "number", "format": "double"}))
}

/// A text within limits.
pub fn text(limit: &'static Characters) -> Kind<String> {
    limited("a text", |text| Some(text.to_owned()), limit, || json!({"type": "string"}))
}

/// Numbers with commas between them, or given one by one; the check of the request looks at their range.
pub fn numbers(limit: &'static Array<Range>) -> Kind<Vec<f64>> {
    let parse = |text: &str| text.split(',').map(|member| member.trim().parse().ok()).collect();
    let schema = || json!({"type": "array", "items": {"type": "number"}});
    Kind {
        check: Some(Box::new(|found, at, faults| _ = faults.length(at, found.len(), &limit.0))),
        is_list: true,
        ..limited("numbers with commas between them", parse, limit, schema)
    }
}

/// Values within limits, whose schema has more keywords than those of the limit.
fn limited<V: 'static>(
    expected: &'static str,
    parse: fn(&str) -> Option<V>,
    limit: &'static dyn Limit<V>,
    schema: fn() -> Value,
) -> Kind<V> {
    let schema = move || {
        let mut schema = schema();
        schema.as_object_mut().into_iter().for_each(|members| write_keywords(members, &limit.keywords()));
        schema
    };
    let check = |value: &V, at: JsonPath<'_>, faults: &mut Faults| limit.check(value, at, faults);
    let parse = move |text: &str| parse(text).ok_or_else(|| expected.to_owned());
    Kind { check: Some(Box::new(check)), ..Kind::of(parse, schema) }
}

/// Fields of stresses, with commas between them, or given one by one.
pub fn fields() -> Kind<Vec<Field>> {
    let expected = "a list of fields, with commas between them, out of `pressure`, `shear`, `slip`, `displacement`";
    let field = |name: &str| Field::ALL.into_iter().find(|field| field.name() == name.trim());
    let parse = move |text: &str| text.split(',').map(field).collect::<Option<_>>();
    let schema = || json!({"type": "array", "items": {"$ref": "#/components/schemas/Field"}, "minItems": 1});
    Kind { is_list: true, ..Kind::of(move |text| parse(text).ok_or_else(|| expected.to_owned()), schema) }
}

/// One of some values that are known by words.
pub fn words<V: Copy + 'static>(values: &'static [V], name: fn(V) -> &'static str) -> Kind<V> {
    choice(values, name, |words| json!({"type": "string", "pattern": format!("^({})$", words.join("|"))}))
}

/// One of these words, of which there will be no others.
pub fn closed<V: Copy + 'static>(values: &'static [V], name: fn(V) -> &'static str) -> Kind<V> {
    choice(values, name, |words| json!({"type": "string", "enum": words}))
}

fn choice<V: Copy + 'static>(
    values: &'static [V],
    name: fn(V) -> &'static str,
    schema: fn(Vec<&'static str>) -> Value,
) -> Kind<V> {
    let names = move || values.iter().copied().map(name).collect::<Vec<_>>();
    let parse = move |text: &str| values.iter().copied().find(|value| name(*value) == text);
    let expected = move || format!("one of `{}`", names().join("`, `"));
    Kind::of(move |text| parse(text).ok_or_else(expected), move || schema(names()))
}

/// The number of a move.
pub fn move_number() -> Kind<u64> {
    let schema = || json!({"type": "integer", "format": "int64", "minimum": 0, "maximum": u64::MAX});
    Kind::new("the number of a move", |text| text.parse().ok(), schema)
}

/// Yes or no.
pub fn flag() -> Kind<bool> {
    Kind::new("true or false", |text| text.parse().ok(), || json!({"type": "boolean"}))
}

/// The identifier of a contact.
pub fn identifier() -> Kind<Uuid> {
    let schema = || json!({"type": "string", "format": "uuid"});
    Kind::new("the identifier of a contact", |text| text.parse().ok(), schema)
}
