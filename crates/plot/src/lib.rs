//! Plots: panels of curves over one axis, with shaded bands, as SVG or PNG.
//!
//! Each axis is labelled with its quantity and unit; values are given in SI units and shown with a unit prefix that
//! fits.

mod contour;
mod draw;
mod png;
mod round_joins;
mod section;

pub use section::{ContactEdge, Peak, Section};
pub use stickslip_mechanics::in_unit;

use std::borrow::Cow;

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
    /// Whether the axes are logarithmic, from decade to decade; points that are not above zero are left out.
    pub over_decades: bool,
}

impl Plot {
    /// A plot without bands.
    pub fn new(title: impl Into<String>, x: Axis, panels: Vec<Panel>) -> Plot {
        Plot { title: title.into(), x, panels, bands: Vec::new(), over_decades: false }
    }

    /// One panel over pure numbers, with the names of both axes.
    pub fn of_numbers(title: impl Into<String>, x: &'static str, y: &'static str, curves: Vec<Curve>) -> Plot {
        let number = |name| Axis { name, unit: None };
        Plot::new(title, number(x), vec![Panel { y: number(y), curves }])
    }
}

/// A quantity and its unit; a count has none.
#[derive(Clone, Copy)]
pub struct Axis {
    /// The quantity.
    pub name: &'static str,
    /// SI unit.
    pub unit: Option<&'static str>,
}

impl Axis {
    /// A quantity in an SI unit; a pure number has the unit 1.
    pub fn of(name: &'static str, unit: &'static str) -> Axis {
        Axis { name, unit: Some(unit).filter(|unit| *unit != "1") }
    }
}

/// Curves over one ordinate.
pub struct Panel {
    /// The ordinate.
    pub y: Axis,
    /// What is drawn.
    pub curves: Vec<Curve>,
}

/// Points in SI units, joined or alone; a line is interrupted where a value is not finite.
pub struct Curve {
    /// Its name in the legend; one without a name is not there.
    pub name: Cow<'static, str>,
    /// Abscissa and ordinate.
    pub points: Vec<(f64, f64)>,
    /// Its colour; none for that of its place among the curves, of which the seventh has that of the first again.
    pub colour: Option<Colour>,
    /// Points alone, as they were measured: between them nothing is known.
    pub dots: bool,
    /// The points are the outline of an area, which is filled.
    pub filled: bool,
}

impl Curve {
    /// Joined points.
    pub fn line(
        name: impl Into<Cow<'static, str>>,
        colour: impl Into<Option<Colour>>,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Curve {
        let points = points.into_iter().collect();
        Curve { name: name.into(), points, colour: colour.into(), dots: false, filled: false }
    }

    /// Points alone.
    pub fn dots(
        name: impl Into<Cow<'static, str>>,
        colour: impl Into<Option<Colour>>,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Curve {
        Curve { dots: true, ..Curve::line(name, colour, points) }
    }

    /// An area within an outline.
    pub fn area(
        name: impl Into<Cow<'static, str>>,
        colour: impl Into<Option<Colour>>,
        outline: impl IntoIterator<Item = (f64, f64)>,
    ) -> Curve {
        Curve { filled: true, ..Curve::line(name, colour, outline) }
    }
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

/// Distinct in hue and in lightness, so that colour-blind readers can distinguish them, in print too.
#[derive(Clone, Copy)]
pub enum Colour {
    /// Of the first curve.
    Blue,
    /// Of the second.
    Red,
    /// Of the third, and for secondary curves.
    Grey,
    /// Of the fourth.
    Sky,
    /// Of the fifth.
    Orange,
    /// Of the sixth.
    Green,
}

/// One of the two kinds of pictures.
pub enum Drawing {
    /// Curves over one axis.
    Plot(Plot),
    /// A quantity over two coordinates.
    Section(Section),
}

impl Drawing {
    /// It as an SVG document.
    ///
    /// # Errors
    /// A sentence for the log, if the drawing fails.
    pub fn svg(&self) -> Result<Vec<u8>, String> {
        draw::svg(self).map_err(|fault| fault.to_string())
    }

    /// It as a PNG file, while `keep_going` returns true, which is asked at each piece of a line.
    ///
    /// # Errors
    /// A sentence for the log, if the drawing fails or was ended.
    pub fn png(&self, keep_going: &dyn Fn() -> bool) -> Result<Vec<u8>, String> {
        draw::pixels(self, keep_going)
            .and_then(|pixels| png::encode(&pixels, draw::size(self)))
            .map_err(|fault| fault.to_string())
    }
}

/// A value, in SI units, of an axis that shows these `values`, with four digits and the unit of that axis.
pub fn on_axis(value: f64, axis: &Axis, values: impl Iterator<Item = f64>) -> String {
    draw::scale(axis, &draw::extent(values)).shown(value)
}
