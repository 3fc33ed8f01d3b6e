//! Query parameters, taken one by one; what nobody takes is refused by name.

use std::str::FromStr;

use axum::extract::{FromRequestParts, Query};
use axum::http::HeaderMap;
use axum::http::request::Parts;

use stickslip_wire::limits as wire_limits;
use stickslip_wire::{Fault, Faults, Field, JsonPath, Rejection, Sampling, StressRequest};

use crate::api::App;
use crate::api::formats::Format;
use crate::api::limits;
use crate::api::problem::Problem;

/// Radii of a plot whose client does not say.
const PLOTTED: usize = 1_000;

/// The parameters of a request, and what is wrong with them so far.
pub struct Params {
    given: Vec<(String, String)>,
    known: Vec<&'static str>,
    faults: Faults,
}

impl FromRequestParts<App> for Params {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, Problem> {
        let given = match Query::<Vec<(String, String)>>::from_request_parts(parts, app).await {
            Ok(Query(given)) => given,
            Err(error) => {
                let fault = Fault { pointer: String::new(), detail: error.body_text() };
                return Err(Rejection::Invalid(vec![fault]).into());
            }
        };
        Ok(Params { given, known: Vec::new(), faults: Faults::default() })
    }
}

impl Params {
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

    /// A list, whether its members have commas between them or come one by one under the same name.
    fn list<T>(&mut self, name: &'static str, expected: &str, parse: impl Fn(&str) -> Option<T>) -> Option<Vec<T>> {
        let members: Vec<String> =
            self.given.iter().filter(|(key, _)| key == name).map(|(_, text)| text.clone()).collect();
        if members.len() > 1 {
            self.given.retain(|(key, _)| key != name);
            self.given.push((name.to_owned(), members.join(",")));
        }
        self.take(name, expected, |text| text.split(',').map(|member| parse(member.trim())).collect())
    }

    fn number<T: FromStr>(&mut self, name: &'static str, expected: &str) -> Option<T> {
        self.take(name, expected, |text| text.parse().ok())
    }

    /// What has been taken, if nothing is wrong and nothing is left.
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

    /// For calls that take no parameters.
    ///
    /// # Errors
    /// A [`Problem`] if there is one all the same.
    pub fn none(self) -> Result<(), Problem> {
        self.finish(Some(()))
    }

    /// Where a page begins and how long it is.
    ///
    /// # Errors
    /// A [`Problem`] with every fault of the parameters.
    pub fn page<T: FromStr>(mut self, expected: &str) -> Result<(Option<T>, usize), Problem> {
        let page = self.bounds(expected);
        self.finish(Some(page))
    }

    /// The same, and the format if it is named.
    ///
    /// # Errors
    /// A [`Problem`] with every fault of the parameters.
    pub fn history(mut self) -> Result<(Option<u64>, usize, Option<Format>), Problem> {
        let (after, limit) = self.bounds("the number of a move");
        let format = self.format();
        self.finish(Some((after, limit, format)))
    }

    /// The format of a table if it is named.
    ///
    /// # Errors
    /// A [`Problem`] with every fault of the parameters.
    pub fn table(mut self) -> Result<Option<Format>, Problem> {
        let format = self.format_of(&Format::TABLES);
        self.finish(Some(format))
    }

    /// As [`Params::history`], and how many points of a loop a move is given.
    ///
    /// # Errors
    /// A [`Problem`] with every fault of the parameters.
    pub fn hysteresis(mut self) -> Result<(Option<u64>, usize, usize, Option<Format>), Problem> {
        let (after, limit) = self.bounds("the number of a move");
        let points = self.number("points_per_move", "a whole number, not negative").unwrap_or(1);
        self.faults.count(JsonPath::Root.member("points_per_move"), points, &wire_limits::LOOP_POINTS);
        let format = self.format();
        self.finish(Some((after, limit, points, format)))
    }

    fn format(&mut self) -> Option<Format> {
        self.format_of(&Format::ALL)
    }

    fn format_of(&mut self, formats: &[Format]) -> Option<Format> {
        let named = |text: &str| formats.iter().copied().find(|format| format.name() == text);
        let names: Vec<_> = formats.iter().map(|format| format.name()).collect();
        let expected = format!("one of `{}`", names.join("`, `"));
        self.take("format", &expected, named)
    }

    fn bounds<T: FromStr>(&mut self, expected: &str) -> (Option<T>, usize) {
        let after = self.number("after", expected);
        let limit = self.number("limit", "a whole number, not negative").unwrap_or(limits::DEFAULT_PAGE);
        self.faults.count(JsonPath::Root.member("limit"), limit, &limits::PAGE);
        (after, limit)
    }

    /// Which stresses are asked for, whether their extrema are, and the format if it is named. A plot needs no radii.
    ///
    /// # Errors
    /// A [`Problem`] with every fault of the parameters.
    pub fn stress(mut self, headers: &HeaderMap) -> Result<(Sampling, bool, Option<Format>), Problem> {
        let field = |name: &str| Field::ALL.into_iter().find(|field| field.name() == name);
        let mut points = self.number("points", "a whole number, not negative");
        let radii = self.list("radii", "numbers with commas between them", |text| text.parse().ok());
        if let Some(radii) = &radii {
            self.faults.length(JsonPath::Root.member("radii"), radii.len(), &limits::QUERY_RADII);
        }
        let fields = self.list(
            "fields",
            "a list of fields, with commas between them, out of `pressure`, `shear`, `slip`, `displacement`",
            field,
        );
        let residual = self.number("residual", "true or false").unwrap_or(false);
        let format = self.format();
        if Format::chosen(format, headers).is_ok_and(Format::is_plot) {
            if fields.is_some() {
                self.faults
                    .add(JsonPath::Root.member("fields"), "a plot always shows pressure and shear: leave this out");
            }
            if radii.is_none() {
                points = points.or(Some(PLOTTED));
            }
        }
        if !self.faults.is_empty() {
            return self.finish(None);
        }
        let sampling = StressRequest { points, radii, fields }.check(JsonPath::Root, &mut self.faults);
        self.finish(sampling.map(|sampling| (sampling, residual, format)))
    }
}
