//! The units in which requests take lengths and forces.

use super::Unit;

macro_rules! request_units {
    ($(#[$about:meta])* $name:ident { $($variant:ident $symbol:literal,)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name {
            $(#[doc = $symbol] $variant,)*
        }

        impl $name {
            /// All of them, the smallest first.
            pub const ALL: [$name; 4] = [$($name::$variant,)*];

            /// Its symbol, in ASCII.
            #[must_use]
            pub fn symbol(self) -> &'static str {
                match self { $($name::$variant => $symbol,)* }
            }

            /// The unit of the table.
            ///
            /// # Panics
            /// If the table lacks it, which a test excludes.
            #[must_use]
            pub fn unit(self) -> Unit {
                Unit::parse(self.symbol()).expect("a unit of the table")
            }

            /// The unit itself, or the largest below it: values in other units are converted to this one.
            #[must_use]
            pub fn nearest(unit: Unit) -> $name {
                let is_below = |one: &&$name| one.unit().to_si(1.0) <= unit.to_si(1.0);
                *$name::ALL.iter().rev().find(is_below).unwrap_or(&$name::ALL[0])
            }
        }
    };
}

request_units! {
    /// Units of length.
    Length {
        Nanometre "nm",
        Micrometre "um",
        Millimetre "mm",
        Metre "m",
    }
}

request_units! {
    /// Units of force.
    Force {
        Micronewton "uN",
        Millinewton "mN",
        Newton "N",
        Kilonewton "kN",
    }
}

#[cfg(test)]
mod tests {
    use super::{Force, Length, Unit};

    #[test]
    fn each_unit_is_its_own_nearest_and_others_have_one_below() {
        assert_eq!(Length::ALL.map(|unit| Length::nearest(unit.unit())), Length::ALL);
        assert_eq!(Force::ALL.map(|unit| Force::nearest(unit.unit())), Force::ALL);
        let nearest = |text: &str| Length::nearest(Unit::parse(text).unwrap());
        assert_eq!(["cm", "mil", "angstrom", "km"].map(nearest).map(Length::symbol), ["mm", "um", "nm", "m"]);
    }
}
