//! Plots for people who look at a contact: panels of curves over one axis, with shaded bands, as SVG or PNG. Plain charts of
//! whatever two quantities, for figures and reports, are in [`chart`].
//!
//! Each axis is labelled with its quantity and unit; values come in SI and are shown in the thousandfold that suits them.

pub(crate) mod chart;
mod draw;
mod font;
mod png;

pub(crate) use font::ready;

/// Panels one above the other, over the same axis.
pub(crate) struct Plot {
    pub(crate) title: String,
    pub(crate) x: Axis,
    pub(crate) panels: Vec<Panel>,
    pub(crate) bands: Vec<Band>,
}

/// A quantity and its unit; what is counted has none.
pub(crate) struct Axis {
    pub(crate) name: &'static str,
    pub(crate) unit: Option<&'static str>,
}

/// Curves over one ordinate.
pub(crate) struct Panel {
    pub(crate) y: Axis,
    pub(crate) curves: Vec<Curve>,
}

/// A named line through points, in SI; at what is not finite it is broken.
pub(crate) struct Curve {
    pub(crate) name: &'static str,
    pub(crate) points: Vec<(f64, f64)>,
    pub(crate) colour: Colour,
    /// Without a mark of its own in the legend.
    pub(crate) silent: bool,
}

/// A part of the abscissa with a shade behind it.
pub(crate) struct Band {
    pub(crate) name: &'static str,
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) colour: Colour,
}

/// Colours that stay apart for colour-blind readers and in print.
#[derive(Clone, Copy)]
pub(crate) enum Colour {
    Blue,
    Red,
    Grey,
}

impl Plot {
    /// The plot as an SVG document.
    ///
    /// # Errors
    /// A sentence for the log, if the drawing fails.
    pub(crate) fn svg(&self) -> Result<Vec<u8>, String> {
        draw::svg(self).map_err(|fault| fault.to_string())
    }

    /// The plot as a PNG file.
    ///
    /// # Errors
    /// A sentence for the log, if the drawing fails.
    pub(crate) fn png(&self) -> Result<Vec<u8>, String> {
        draw::pixels(self).and_then(|pixels| png::written(&pixels, draw::SIZE)).map_err(|fault| fault.to_string())
    }
}

/// What values are divided by to be shown, and the prefix of the unit then.
fn thousandfold(largest: f64) -> (f64, &'static str) {
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
    use super::thousandfold;

    #[test]
    fn a_unit_is_that_of_the_largest_value() {
        for (largest, prefix) in
            [(2.5e-5, "µ"), (1.0, ""), (0.999, "m"), (3.2e8, "M"), (1e3, "k"), (1e-15, "p"), (1e30, "T"), (0.0, "")]
        {
            assert_eq!(thousandfold(largest).1, prefix, "{largest}");
        }
    }
}
