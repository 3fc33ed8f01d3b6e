//! Query strings. Each operation reads its own into a struct; a parameter that the operation does not have is refused
//! by name.

use std::ops::RangeInclusive;
use std::str::FromStr;
use std::sync::Arc;

use axum::extract::{FromRequestParts, Query};
use axum::http::HeaderMap;
use axum::http::request::Parts;

use utoipa::IntoParams;
use uuid::Uuid;

use stickslip_wire::limits::{Characters, Limit as _};
use stickslip_wire::{Fault, Faults, JobState, JsonPath, Rejection};

use super::formats::Format;
use super::problem::Problem;
use super::state::App;

/// Items of a page.
pub const PAGE: RangeInclusive<usize> = 1..=1_000;
/// Items of a page if the client does not say.
pub const DEFAULT_PAGE: usize = 100;

/// What [`QueryReader::number`] expects of a count.
pub const COUNT: &str = "a whole number, not negative";
/// The parameters of an operation.
pub trait QueryParams: Sized {
    /// Takes its parameters out of the query; `None` if it has noted a fault without which there would be a value.
    fn take(query: &mut QueryReader, headers: &HeaderMap) -> Option<Self>;
}

/// Which moves of a contact a reply is of, as the query has it.
#[derive(Clone, Copy, IntoParams)]
#[into_params(parameter_in = Query)]
pub struct MovesQuery {
    /// The `next` of the previous page.
    #[param(nullable = false)]
    after: Option<u64>,
    /// How many moves at most. Without `after`, `limit` and `last`, `csv`, `ndjson` and `arrow` are of all moves.
    #[param(nullable = false)]
    limit: Option<usize>,
    /// The newest moves, so many; in place of `after` and `limit`. A plot shows the newest unless `after` is given.
    #[param(nullable = false)]
    last: Option<usize>,
}

/// Which moves of a contact a reply is of.
#[derive(Clone, Copy)]
pub enum Moves {
    /// At most so many after this one.
    Page(u64, usize),
    /// So many, up to the last one.
    Newest(usize),
    /// All of them, piece by piece.
    All,
}

impl MovesQuery {
    /// The moves for a reply in a format. If the query does not say, a plot shows the newest moves, and a table that programs
    /// read row by row has all of them.
    #[must_use]
    pub fn of(&self, format: Format) -> Moves {
        match *self {
            MovesQuery { last: Some(last), .. } => Moves::Newest(last),
            MovesQuery { after: None, limit, .. } if format.is_plot() => Moves::Newest(limit.unwrap_or(DEFAULT_PAGE)),
            MovesQuery { after: None, limit: None, .. } if format.is_stream() => Moves::All,
            MovesQuery { after, limit, .. } => Moves::Page(after.unwrap_or(0), limit.unwrap_or(DEFAULT_PAGE)),
        }
    }
}

/// For operations without parameters.
impl QueryParams for () {
    fn take(_: &mut QueryReader, _: &HeaderMap) -> Option<()> {
        Some(())
    }
}

/// The checked parameters of a request.
pub struct CheckedQuery<T>(pub T);

impl<T: QueryParams> FromRequestParts<Arc<App>> for CheckedQuery<T> {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, app: &Arc<App>) -> Result<Self, Problem> {
        let given = match Query::<Vec<(String, String)>>::from_request_parts(parts, app).await {
            Ok(Query(given)) => given,
            Err(error) => {
                let fault = Fault { pointer: String::new(), detail: error.body_text() };
                return Err(Rejection::Invalid(vec![fault]).into());
            }
        };
        let mut query = QueryReader { given, known: Vec::new(), faults: Faults::default() };
        let value = T::take(&mut query, &parts.headers);
        query.finish(value).map(CheckedQuery)
    }
}

/// The parameters of a request that have not been taken yet, and the faults of those that have.
pub struct QueryReader {
    given: Vec<(String, String)>,
    known: Vec<&'static str>,
    /// What is wrong with the parameters so far.
    pub faults: Faults,
}

impl QueryReader {
    /// The parameter of this name, read by `parse`; `expected` says what it must be.
    fn take<T>(&mut self, name: &'static str, expected: &str, parse: impl Fn(&str) -> Option<T>) -> Option<T> {
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

    /// A value of a type that reads itself, such as a number.
    pub fn number<T: FromStr>(&mut self, name: &'static str, expected: &str) -> Option<T> {
        self.take(name, expected, |text| text.parse().ok())
    }

    /// A text within its limits.
    pub fn text(&mut self, name: &'static str, limit: &Characters) -> Option<String> {
        let text = self.take(name, "a text", |text| Some(text.to_owned()));
        limit.check(&text, JsonPath::Root.member(name), &mut self.faults);
        text
    }

    /// The parameters `after` and `limit` of a page of contacts.
    pub fn contacts(&mut self) -> (Option<Uuid>, usize) {
        let after = self.number("after", "the identifier of a contact");
        let limit = self.number("limit", COUNT).unwrap_or(DEFAULT_PAGE);
        self.faults.count(JsonPath::Root.member("limit"), limit, &PAGE);
        (after, limit)
    }

    /// The parameters `after`, `limit` and `last`: which moves of a contact.
    pub fn moves(&mut self) -> MovesQuery {
        let after = self.number("after", "the number of a move");
        let [limit, last] = ["limit", "last"].map(|name| {
            let count = self.number(name, COUNT);
            count.inspect(|count| self.faults.count(JsonPath::Root.member(name), *count, &PAGE))
        });
        if last.is_some() && (after.is_some() || limit.is_some()) {
            self.faults.add(JsonPath::Root.member("last"), "the newest moves need no `after` and no `limit`");
        }
        MovesQuery { after, limit, last }
    }

    /// The parameter `format`, one of `formats`.
    pub fn format(&mut self, formats: &[Format]) -> Option<Format> {
        let names: Vec<_> = formats.iter().map(|format| format.name()).collect();
        let expected = format!("one of `{}`", names.join("`, `"));
        self.take("format", &expected, |text| Format::named(text, formats))
    }

    /// The parameter `state` of a job.
    pub fn state(&mut self) -> Option<JobState> {
        let named = |text: &str| JobState::ALL.into_iter().find(|state| state.name() == text);
        self.take("state", "one of `running`, `done`, `failed`", named)
    }

    /// The value, if nothing is wrong and every parameter has been taken.
    fn finish<T>(mut self, value: Option<T>) -> Result<T, Problem> {
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
