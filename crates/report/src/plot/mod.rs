//! Plots of a contact: panels of curves over one axis, with shaded bands, as SVG or PNG. The charts of figures and reports
//! are in [`chart`].
//!
//! Each axis is labelled with its quantity and unit; values are given in SI units and shown with a unit prefix that fits.

pub mod chart;
mod draw;
mod font;
mod png;
mod section;

pub use section::Section;

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::{DrawingArea, DrawingBackend};

/// Panels one above the other, over the same axis.
pub struct Plot {
    /// Above all panels.
    pub title: String,
    /// The axis that the panels share.
    pub x: Axis,
    /// From top to bottom.
    pub panels: Vec<Panel>,
    /// Shaded behind the curves of every panel.
    pub bands: Vec<Band>,
}

/// A quantity and its unit; a count has none.
pub struct Axis {
    /// The quantity.
    pub name: &'static str,
    /// SI unit.
    pub unit: Option<&'static str>,
}

/// Curves over one ordinate.
pub struct Panel {
    /// The ordinate.
    pub y: Axis,
    /// What is drawn.
    pub curves: Vec<Curve>,
}

/// A named line through points, in SI units; it is interrupted where a value is not finite.
pub struct Curve {
    /// Its name in the legend.
    pub name: &'static str,
    /// Abscissa and ordinate.
    pub points: Vec<(f64, f64)>,
    /// Its colour.
    pub colour: Colour,
    /// Not in the legend.
    pub silent: bool,
}

/// A part of the abscissa with a shade behind it.
pub struct Band {
    /// Its name in the legend.
    pub name: &'static str,
    /// Where it begins on the abscissa.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// Its colour.
    pub colour: Colour,
}

/// Colours that colour-blind readers can distinguish, in print too.
#[derive(Clone, Copy)]
pub enum Colour {
    /// The first.
    Blue,
    /// The second.
    Red,
    /// For secondary curves.
    Grey,
}

/// Something that can be drawn.
pub trait Picture {
    /// Draws it on an empty area.
    ///
    /// # Errors
    /// What the backend cannot do.
    fn draw<DB: DrawingBackend>(&self, area: &DrawingArea<DB, Shift>) -> Result<(), Box<dyn Error>>
    where
        DB::ErrorType: 'static;

    /// It as an SVG document.
    ///
    /// # Errors
    /// A sentence for the log, if the drawing fails.
    fn svg(&self) -> Result<Vec<u8>, String> {
        draw::svg(self).map_err(|fault| fault.to_string())
    }

    /// It as a PNG file.
    ///
    /// # Errors
    /// A sentence for the log, if the drawing fails.
    fn png(&self) -> Result<Vec<u8>, String> {
        draw::pixels(self).and_then(|pixels| png::encode(&pixels, draw::SIZE)).map_err(|fault| fault.to_string())
    }
}

/// A value in SI units as a reader would write it: at most six significant digits and a unit prefix that fits.
///
/// ```
/// use stickslip_report::plot::in_unit;
///
/// assert_eq!(in_unit(1.6822578812860719e-9, "m"), "1.68226 nm");
/// assert_eq!(in_unit(1.15e11, "Pa"), "115 GPa");
/// assert_eq!(in_unit(0.0, "N"), "0 N");
/// ```
#[must_use]
pub fn in_unit(value: f64, unit: &str) -> String {
    let (factor, prefix) = unit_prefix(value.abs());
    let digits: f64 = format!("{:.5e}", value / factor).parse().unwrap_or(value);
    format!("{digits} {prefix}{unit}")
}

/// The power of a thousand to divide values by, and the prefix of the unit.
fn unit_prefix(largest: f64) -> (f64, &'static str) {
    const PREFIXES: [(i32, &str); 9] =
        [(-12, "p"), (-9, "n"), (-6, "µ"), (-3, "m"), (0, ""), (3, "k"), (6, "M"), (9, "G"), (12, "T")];
    let fits = |(exponent, _): &&(i32, &str)| largest >= 0.999_999 * 10_f64.powi(*exponent);
    let (exponent, prefix) = if largest > 0.0 && largest.is_finite() {
        PREFIXES.iter().rev().find(fits).copied().unwrap_or(PREFIXES[0])
    } else {
        (0, "")
    };
    (10_f64.powi(exponent), prefix)
}

#[cfg(test)]
mod tests {
    use super::unit_prefix;

    #[test]
    fn a_unit_is_that_of_the_largest_value() {
        for (largest, prefix) in
            [(2.5e-5, "µ"), (1.0, ""), (0.999, "m"), (3.2e8, "M"), (1e3, "k"), (1e-15, "p"), (1e30, "T"), (0.0, "")]
        {
            assert_eq!(unit_prefix(largest).1, prefix, "{largest}");
        }
    }
}
