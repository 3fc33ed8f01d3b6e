//! How a family of profiles whose parameters are plain numbers declares itself.

use super::{Error, Profile};
use crate::range::{Quantity, Range};

/// A family of profiles, as its file declares it. Its JSON document, the form of the page, the tests, the benchmarks
/// and the reference values go through [`families`](super::families).
#[derive(Debug)]
pub struct Family {
    /// The `type` in JSON.
    pub name: &'static str,
    /// What a form calls it.
    pub title: &'static str,
    /// The description of its JSON document.
    pub about: &'static str,
    /// Its parameters, in the order of [`Family::make`].
    pub parameters: &'static [Parameter],
    /// An ordinary indentation of the example, m.
    pub indentation: f64,
    /// The profile of these parameters.
    pub make: fn(&[f64]) -> Result<Profile, Error>,
}

/// A parameter of a family.
#[derive(Debug)]
pub struct Parameter {
    /// Its name in JSON and in messages.
    pub name: &'static str,
    /// What a form calls it.
    pub label: &'static str,
    /// Its description, with the unit.
    pub about: &'static str,
    /// What it may be, under its own name.
    pub range: Range,
    /// Its value in the example.
    pub example: f64,
}

impl Parameter {
    /// Name, label, description, range and example.
    pub(super) const fn new(
        name: &'static str,
        label: &'static str,
        about: &'static str,
        range: Range,
        example: f64,
    ) -> Parameter {
        Parameter { name, label, about, range: Range { quantity: Quantity::Parameter(name), ..range }, example }
    }
}

impl Family {
    /// The parameters of the example.
    #[must_use]
    pub fn example(&self) -> Vec<f64> {
        self.parameters.iter().map(|parameter| parameter.example).collect()
    }

    /// Gives the parameters back.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] with the name of the first that is out of its range.
    pub(super) fn check<const N: usize>(&self, numbers: [f64; N]) -> Result<[f64; N], Error> {
        for (parameter, number) in self.parameters.iter().zip(numbers) {
            parameter.range.check(number)?;
        }
        Ok(numbers)
    }
}

/// The struct of a family whose fields are its parameters, with its checked constructor.
macro_rules! family {
    ($(#[$about:meta])+ $Shape:ident { $($parameter:ident),+ } $(#[$new:meta])+) => {
        $(#[$about])+
        #[derive(Clone, Debug, PartialEq)]
        pub struct $Shape {
            $($parameter: f64,)+
            stages: $crate::cells::stages::Stages,
        }

        impl $Shape {
            $(#[$new])+
            ///
            /// # Errors
            /// [`Error::OutOfRange`](crate::Error::OutOfRange) with the name of the parameter.
            pub fn new($($parameter: f64),+) -> Result<$Shape, $crate::Error> {
                let [$($parameter),+] = FAMILY.check([$($parameter),+])?;
                Ok($Shape { $($parameter,)+ stages: $crate::cells::stages::Stages::new() })
            }
        }
    };
}
pub(super) use family;

/// The cells of a shape, and that contacts end nowhere on it.
macro_rules! endless {
    () => {
        fn stages(&self) -> &$crate::cells::stages::Stages {
            &self.stages
        }

        fn end(&self) -> Option<$crate::cells::shape::End> {
            None
        }
    };
}
pub(super) use endless;
