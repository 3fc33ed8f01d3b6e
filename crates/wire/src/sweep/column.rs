//! The columns of the table of a sweep, and their names.

use super::{Axis, SweepRequest};
use crate::prelude::*;

/// The name of a column: a letter, then letters, digits and `_`. It is a name in SQL, Python and a header of a CSV, and
/// differs from every JSON pointer.
pub(super) struct ColumnName;

/// The longest name, characters.
const NAME_LENGTH: usize = 64;

/// A number of the reply to `POST /simulate`: a JSON pointer, or an object that names its column too.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
#[serde(untagged)]
pub enum Output {
    /// A JSON pointer, which is the name of the column too.
    Pointer(String),
    /// A JSON pointer and the name of the column.
    Named(NamedOutput),
}

requests! {
/// A number of the reply to `POST /simulate`, and the name of its column.
pub struct NamedOutput {
    /// JSON pointer to the number in the reply.
    #[schema(example = "/residual/max")]
    pub pointer: String,
    /// The name of the column.
    #[schema(example = "largest_shear")]
    pub name: String = ColumnName,
}
}

impl Output {
    /// JSON pointer to the number.
    pub fn pointer(&self) -> &str {
        match self {
            Output::Pointer(pointer) => pointer,
            Output::Named(output) => &output.pointer,
        }
    }

    /// The name of the column: its own, else the pointer.
    pub fn column(&self) -> &str {
        self.name().map_or(self.pointer(), String::as_str)
    }

    fn name(&self) -> Option<&String> {
        match self {
            Output::Pointer(_) => None,
            Output::Named(output) => Some(&output.name),
        }
    }

    /// The place of the pointer of an output at this place.
    pub fn place_of_pointer<'a>(&self, at: &'a JsonPath<'a>) -> JsonPath<'a> {
        match self {
            Output::Pointer(_) => *at,
            Output::Named(_) => at.member("pointer"),
        }
    }
}

impl Axis {
    /// The name of the column: its own, else the pointer.
    pub fn column(&self) -> &str {
        self.name.as_ref().unwrap_or(&self.pointer)
    }
}

impl SweepRequest {
    /// Notes names that an earlier column has.
    pub(super) fn check_names(&self, faults: &mut Faults) {
        let (axes, outputs) = (JsonPath::Root.member("axes"), JsonPath::Root.member("outputs"));
        let of_axes = self.axes().iter().enumerate().map(|(index, axis)| (axes.index(index), axis.name.as_ref()));
        let of_outputs = self.outputs.iter().enumerate().map(|(index, output)| (outputs.index(index), output.name()));
        let mut seen: Vec<&String> = Vec::new();
        for (at, name) in of_axes.chain(of_outputs).filter_map(|(at, name)| Some((at, name?))) {
            if seen.contains(&name) {
                faults.add(at.member("name"), "another column has the same name");
            }
            seen.push(name);
        }
    }
}

impl Limit<String> for ColumnName {
    fn keywords(&self) -> Value {
        json!({"pattern": format!("^[A-Za-z][A-Za-z0-9_]{{0,{}}}$", NAME_LENGTH - 1)})
    }

    fn check(&self, value: &String, at: JsonPath<'_>, faults: &mut Faults) {
        let begins = value.starts_with(|first: char| first.is_ascii_alphabetic());
        let fits = value.len() <= NAME_LENGTH && value.chars().all(|next| next.is_ascii_alphanumeric() || next == '_');
        if !(begins && fits) {
            let most = NAME_LENGTH;
            faults.add(
                at,
                format_args!("not a valid column name: a letter, then letters, digits and `_`, at most {most} in all"),
            );
        }
    }
}

object_or_string!(
    Output: "a JSON pointer, or an object with `pointer` and `name`",
    NamedOutput => Named,
    pointer => Output::Pointer(pointer.to_owned())
);
