//! Parameters of queries. Each is declared once, in `parameters!`: its name, its type, its limits and its description
//! are what the handler reads and what the OpenAPI document says.

use std::ops::RangeInclusive;
use std::str::FromStr;

use axum::http::HeaderMap;
use serde_json::{Value, json};
use utoipa::openapi::Required;
use utoipa::openapi::path::{Parameter, ParameterBuilder, ParameterIn};
use uuid::Uuid;

use stickslip_mechanics::range::Range;
use stickslip_wire::limits::{Array, Characters, Limit};
use stickslip_wire::{ContactOrder, Faults, Field, JobState, JsonPath};

use super::formats::Format;
use super::problem::Problem;

/// The parameters of a request that have not been taken yet, and the faults of those that have.
pub struct QueryReader {
    given: Vec<(String, String)>,
    known: Vec<&'static str>,
    /// What is wrong with the parameters so far.
    pub faults: Faults,
}

impl QueryReader {
    /// The parameters as the client gives them.
    pub fn new(given: Vec<(String, String)>) -> QueryReader {
        QueryReader { given, known: Vec::new(), faults: Faults::default() }
    }

    /// The parameter of this name, read by `parse`; `expected` says what it must be.
    pub fn take<T>(&mut self, name: &'static str, expected: &str, parse: impl Fn(&str) -> Option<T>) -> Option<T> {
        self.known.push(name);
        let position = self.given.iter().position(|(key, _)| key == name)?;
        let (_, text) = self.given.remove(position);
        let value = parse(&text);
        if value.is_none() {
            let shown: String = text.chars().take(40).collect();
            self.faults.add(JsonPath::Root.member(name), format_args!("`{shown}` is not {expected}"));
        }
        value
    }

    /// A list, whose members are separated by commas or given one by one under the same name.
    pub fn list<T>(&mut self, name: &'static str, expected: &str, parse: impl Fn(&str) -> Option<T>) -> Option<Vec<T>> {
        let members: Vec<String> =
            self.given.iter().filter(|(key, _)| key == name).map(|(_, text)| text.clone()).collect();
        if members.len() > 1 {
            self.given.retain(|(key, _)| key != name);
            self.given.push((name.to_owned(), members.join(",")));
        }
        self.take(name, expected, |text| text.split(',').map(|member| parse(member.trim())).collect())
    }

    /// The value, if nothing is wrong and every parameter has been taken.
    ///
    /// # Errors
    /// A [`Problem`] with every fault.
    pub fn finish<T>(mut self, value: Option<T>) -> Result<T, Problem> {
        let known = self.known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let known = if known.is_empty() { "none".to_owned() } else { known };
        for (name, _) in self.given {
            let again = self.known.iter().any(|known| *known == name);
            let detail = if again { "given twice".to_owned() } else { format!("unknown parameter, expected {known}") };
            let shown: String = name.chars().take(40).collect();
            self.faults.add(JsonPath::Root.member(&shown), detail);
        }
        Ok(self.faults.done(value)?)
    }
}

/// The parameters of an operation.
pub trait QueryParams: Sized {
    /// Takes its parameters out of the query; `None` if it has noted a fault without which there would be a value.
    fn take(query: &mut QueryReader, headers: &HeaderMap) -> Option<Self>;
}

/// For operations without parameters.
impl QueryParams for () {
    fn take(_: &mut QueryReader, _: &HeaderMap) -> Option<()> {
        Some(())
    }
}

/// A kind of parameter, with values of the type `V`.
pub trait Kind<V> {
    /// The value, if the client gives one that can be read.
    fn read(&self, name: &'static str, query: &mut QueryReader) -> Option<V>;

    fn schema(&self) -> Value;

    /// An example of its values, where a request needs one.
    fn example(&self) -> Option<Value> {
        None
    }
}

/// Declares the parameters of a query, `parameters! { pub struct NAME { member: TYPE = KIND, .. } }`. A member has
/// the type `Option<V>` of its kind or, with `or DEFAULT`, `V`.
macro_rules! parameters {
    (
        $(#[doc = $about:literal])*
        pub struct $name:ident {
            $($(#[doc = $doc:literal])* $member:ident: $type:ty = $kind:expr $(, or $default:expr)?;)*
        }
    ) => {
        $(#[doc = $about])*
        pub struct $name {
            $($(#[doc = $doc])* pub $member: $type,)*
        }

        impl $crate::api::query_parameters::QueryParams for $name {
            fn take(
                query: &mut $crate::api::query_parameters::QueryReader,
                _: &axum::http::HeaderMap,
            ) -> Option<$name> {
                Some($name {
                    $($member: $crate::api::query_parameters::Kind::read(&$kind, stringify!($member), query)
                        $(.unwrap_or($default))?,)*
                })
            }
        }

        impl utoipa::IntoParams for $name {
            fn into_params(
                _: impl Fn() -> Option<utoipa::openapi::path::ParameterIn>,
            ) -> Vec<utoipa::openapi::path::Parameter> {
                vec![$({
                    let default: Option<serde_json::Value> = None$(.or(Some(serde_json::json!($default))))?;
                    let description = [$($doc),*].map(str::trim).join(" ");
                    $crate::api::query_parameters::described(stringify!($member), description, &$kind, default)
                }),*]
            }
        }
    };
}
pub(super) use parameters;

/// A parameter as the OpenAPI document has it.
pub fn described<V>(name: &'static str, description: String, kind: &impl Kind<V>, default: Option<Value>) -> Parameter {
    let mut schema = kind.schema();
    if let Some(default) = default {
        schema["default"] = default;
    }
    let is_list = schema["type"] == "array";
    let mut members = vec![("schema", schema)];
    if is_list {
        members.extend([("style", json!("form")), ("explode", json!(false))]);
    }
    members.extend(kind.example().map(|example| ("example", example)));
    ParameterBuilder::new()
        .name(name)
        .parameter_in(ParameterIn::Query)
        .required(Required::False)
        .description(Some(description))
        // The library would drop keywords that it does not know.
        .extensions(Some(members.into_iter().collect()))
        .build()
}

/// A number within limits.
pub struct Number<V: 'static> {
    /// What it is, for the text of a refusal.
    pub expected: &'static str,
    /// Its limit.
    pub limit: &'static dyn Limit<V>,
    /// Whether the limits are checked when the parameter is read, and not by the check of the request.
    pub is_checked: bool,
    /// The value that is taken if the client gives none.
    pub suggestion: Option<V>,
    /// An example for the document.
    pub example: Option<V>,
}

/// A count within limits.
pub fn count(limit: &'static RangeInclusive<usize>) -> Number<usize> {
    let expected = "a whole number, not negative";
    Number { expected, limit, is_checked: true, suggestion: None, example: None }
}

/// A number within the range of a quantity, which the check of the request looks at.
pub fn number(range: &'static Range) -> Number<f64> {
    Number { expected: "a number", limit: range, is_checked: false, suggestion: None, example: None }
}

impl<V: FromStr + serde::Serialize> Kind<V> for Number<V> {
    fn read(&self, name: &'static str, query: &mut QueryReader) -> Option<V> {
        let value = query.take(name, self.expected, |text| text.parse().ok());
        if let Some(value) = value.as_ref().filter(|_| self.is_checked) {
            self.limit.check(value, JsonPath::Root.member(name), &mut query.faults);
        }
        value
    }

    fn schema(&self) -> Value {
        let mut schema = self.limit.keywords();
        let is_whole = schema["maximum"].is_u64();
        schema["type"] = json!(if is_whole { "integer" } else { "number" });
        if !is_whole {
            schema["format"] = json!("double");
        }
        if let Some(suggestion) = &self.suggestion {
            schema["default"] = json!(suggestion);
        }
        schema
    }

    fn example(&self) -> Option<Value> {
        self.example.as_ref().map(|example| json!(example))
    }
}

/// Numbers with commas between them, or given one by one; the check of the request looks at their range.
pub struct List(pub Array<Range>);

impl Kind<Vec<f64>> for List {
    fn read(&self, name: &'static str, query: &mut QueryReader) -> Option<Vec<f64>> {
        let found = query.list(name, "numbers with commas between them", |text| text.parse().ok());
        if let Some(found) = &found {
            query.faults.length(JsonPath::Root.member(name), found.len(), &self.0.0);
        }
        found
    }

    fn schema(&self) -> Value {
        let mut schema = Limit::<Vec<f64>>::keywords(&self.0);
        (schema["type"], schema["items"]["type"]) = (json!("array"), json!("number"));
        schema
    }
}

/// Fields of stresses, with commas between them, or given one by one.
pub struct Fields;

impl Kind<Vec<Field>> for Fields {
    fn read(&self, name: &'static str, query: &mut QueryReader) -> Option<Vec<Field>> {
        query.list(
            name,
            "a list of fields, with commas between them, out of `pressure`, `shear`, `slip`, `displacement`",
            |text| Field::ALL.into_iter().find(|field| field.name() == text),
        )
    }

    fn schema(&self) -> Value {
        json!({"type": "array", "items": {"$ref": "#/components/schemas/Field"}, "minItems": 1})
    }
}

/// One of some values, by their names.
pub struct Choice<V: 'static> {
    values: &'static [V],
    name: fn(V) -> &'static str,
    schema: fn(Vec<&'static str>) -> Value,
}

/// One of some formats.
pub const fn formats(values: &'static [Format]) -> Choice<Format> {
    let schema = |names| json!({"type": "string", "enum": names, "default": Format::Columns.name()});
    Choice { values, name: Format::name, schema }
}

/// One of some values that are known by words.
pub const fn words<V>(values: &'static [V], name: fn(V) -> &'static str) -> Choice<V> {
    let schema = |words: Vec<_>| json!({"type": "string", "pattern": format!("^({})$", words.join("|"))});
    Choice { values, name, schema }
}

/// One of these words, of which there will be no others.
const fn closed<V>(values: &'static [V], name: fn(V) -> &'static str) -> Choice<V> {
    Choice { values, name, schema: |names| json!({"type": "string", "enum": names}) }
}

pub const JOB_STATE: Choice<JobState> = closed(&JobState::ALL, JobState::name);

pub const CONTACT_ORDER: Choice<ContactOrder> = closed(&ContactOrder::ALL, ContactOrder::name);

impl<V: Copy> Choice<V> {
    fn names(&self) -> Vec<&'static str> {
        self.values.iter().map(|value| (self.name)(*value)).collect()
    }
}

impl<V: Copy> Kind<V> for Choice<V> {
    fn read(&self, name: &'static str, query: &mut QueryReader) -> Option<V> {
        let expected = format!("one of `{}`", self.names().join("`, `"));
        query.take(name, &expected, |text| self.values.iter().copied().find(|value| (self.name)(*value) == text))
    }

    fn schema(&self) -> Value {
        (self.schema)(self.names())
    }
}

/// A text within limits.
pub struct Text(pub Characters);

impl Kind<String> for Text {
    fn read(&self, name: &'static str, query: &mut QueryReader) -> Option<String> {
        let text = query.take(name, "a text", |text| Some(text.to_owned()));
        self.0.check(&text, JsonPath::Root.member(name), &mut query.faults);
        text
    }

    fn schema(&self) -> Value {
        let mut schema = Limit::<String>::keywords(&self.0);
        schema["type"] = json!("string");
        schema
    }
}

/// A value with a parser of its own.
pub struct Plain<V> {
    /// What it is, for the text of a refusal.
    pub expected: &'static str,
    /// Its schema in the document.
    pub schema: fn() -> Value,
    /// Its value; none if the text is not one.
    pub parse: fn(&str) -> Option<V>,
}

/// The number of a move.
pub const MOVE_NUMBER: Plain<u64> = Plain {
    expected: "the number of a move",
    schema: || json!({"type": "integer", "format": "int64", "minimum": 0, "maximum": u64::MAX}),
    parse: |text| text.parse().ok(),
};

/// Yes or no.
pub const FLAG: Plain<bool> =
    Plain { expected: "true or false", schema: || json!({"type": "boolean"}), parse: |text| text.parse().ok() };

/// The identifier of a contact.
pub const IDENTIFIER: Plain<Uuid> = Plain {
    expected: "the identifier of a contact",
    schema: || json!({"type": "string", "format": "uuid"}),
    parse: |text| text.parse().ok(),
};

impl<V> Kind<V> for Plain<V> {
    fn read(&self, name: &'static str, query: &mut QueryReader) -> Option<V> {
        query.take(name, self.expected, self.parse)
    }

    fn schema(&self) -> Value {
        (self.schema)()
    }
}
