//! The units that headers name.

macro_rules! unit {
    ($(#[$about:meta])* $name:ident { $($variant:ident $symbol:literal $power:literal $spelt:pat,)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name {
            $(#[doc = $symbol] $variant,)*
        }

        impl $name {
            /// All of them.
            pub const ALL: [$name; 4] = [$($name::$variant,)*];

            /// Its symbol, in ASCII.
            #[must_use]
            pub fn symbol(self) -> &'static str {
                match self { $($name::$variant => $symbol,)* }
            }

            /// The factor to the SI unit.
            #[must_use]
            pub fn factor(self) -> f64 {
                10_f64.powi(match self { $($name::$variant => $power,)* })
            }

            fn spelt(word: &str) -> Option<$name> {
                match word { $($spelt => Some($name::$variant),)* _ => None }
            }

            /// The unit that a cell of a header names, as in `X [um]`, `Displacement (um)`, `Force / mN` or `um`.
            pub(super) fn named(cell: &str) -> Option<$name> {
                // Two letters for micro, and units in words.
                let cell = cell.replace(['µ', 'μ'], "u");
                let words = cell.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty());
                words.rev().find_map($name::spelt)
            }
        }
    };
}

unit! {
    /// Units of length.
    Length {
        Metre "m" 0 "m",
        Millimetre "mm" -3 "mm",
        Micrometre "um" -6 "um" | "micron" | "microns" | "Micron" | "Microns",
        Nanometre "nm" -9 "nm",
    }
}

unit! {
    /// Units of force.
    Force {
        Newton "N" 0 "N",
        Kilonewton "kN" 3 "kN",
        Millinewton "mN" -3 "mN",
        Micronewton "uN" -6 "uN",
    }
}

unit! {
    /// Units of time.
    Time {
        Second "s" 0 "s" | "sec" | "seconds",
        Millisecond "ms" -3 "ms" | "msec" | "milliseconds",
        Microsecond "us" -6 "us",
        Nanosecond "ns" -9 "ns",
    }
}

/// Whether a cell is the symbol of a unit and nothing else.
pub(super) fn is_symbol(cell: &str) -> bool {
    let cell = cell.replace(['µ', 'μ'], "u");
    Length::ALL.iter().any(|unit| unit.symbol() == cell)
        || Force::ALL.iter().any(|unit| unit.symbol() == cell)
        || Time::ALL.iter().any(|unit| unit.symbol() == cell)
}

#[cfg(test)]
mod tests {
    use super::{Force, Length};

    #[test]
    fn units_are_found_however_a_header_writes_them() {
        for cell in ["X [um]", "Displacement (µm)", "lateral / μm", "x_um", "um", "Z in microns"] {
            assert_eq!(Length::named(cell), Some(Length::Micrometre), "{cell}");
        }
        assert_eq!((Force::named("Force (mN)"), Force::named("Number")), (Some(Force::Millinewton), None));
        assert_eq!((Length::named("x"), Length::named("momentum")), (None, None));
    }
}
