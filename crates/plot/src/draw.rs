//! Draws a plot on any backend of plotters.

use std::error::Error;
use std::ops::Range;
use std::sync::Once;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::register_font;

use stickslip_mechanics::unit_prefix;

use super::round_joins::RoundJoins;
use super::{Axis, Band, Colour, Curve, Drawing, Panel, Plot};

/// Pixels of a plot. Twice the size shown on a page, so that curves and text are smooth.
pub(super) const SIZE: (u32, u32) = (1520, 1000);
/// Height that a panel has at least, pixels, so that the name of its ordinate fits beside it.
const PANEL: u32 = 333;
/// Width of the margin left of the axes, pixels: the same in all panels, so that the axes align.
const LEFT: u32 = 132;
/// The part of the height that is kept free above and below the curves.
const MARGIN: f64 = 0.05;
/// The part kept free above where there is a legend.
const HEADROOM: f64 = 0.24;

/// How much of its colour an area has.
const AREA_SHADE: f64 = 0.3;
/// Radius of a point, pixels; of one that stands alone, or is one of so few that none hides another.
const DOT: u32 = 4;
const LARGE_DOT: u32 = 7;
const FEW: usize = 50;
/// Smaller extents are treated as zero.
const SMALLEST: f64 = 1e-200;

/// The divisor of the values of an axis, its unit with the prefix of that, and its label.
pub(super) struct Scale {
    pub(super) unit: f64,
    pub(super) symbol: String,
    pub(super) label: String,
}

impl Colour {
    const ALL: [Colour; 6] = [Colour::Blue, Colour::Red, Colour::Grey, Colour::Sky, Colour::Orange, Colour::Green];

    fn rgb(self) -> RGBColor {
        match self {
            Colour::Blue => RGBColor(0, 90, 181),
            Colour::Red => RGBColor(220, 50, 32),
            Colour::Grey => RGBColor(110, 110, 110),
            Colour::Sky => RGBColor(86, 180, 233),
            Colour::Orange => RGBColor(230, 159, 0),
            Colour::Green => RGBColor(0, 130, 90),
        }
    }
}

/// Whether the backend could draw it all.
pub(super) type DrawResult = Result<(), Box<dyn Error>>;

/// A picture as an SVG document.
pub(super) fn svg(picture: &Drawing) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut text = String::new();
    draw(picture, SVGBackend::with_string(&mut text, size(picture)))?;
    // Else lines have mitres, which at a sharp corner are spikes.
    Ok(text.replace("<polyline ", "<polyline stroke-linejoin=\"round\" ").into_bytes())
}

/// A picture as rows of pixels of three bytes, while `keep_going` returns true.
pub(super) fn pixels(picture: &Drawing, keep_going: &dyn Fn() -> bool) -> Result<Vec<u8>, Box<dyn Error>> {
    let (width, height) = size(picture);
    let mut pixels = vec![0; 3 * width as usize * height as usize];
    let backend = BitMapBackend::with_buffer(&mut pixels, (width, height));
    draw(picture, RoundJoins { pixels: backend, keep_going })?;
    Ok(pixels)
}

/// Width and height of a picture, pixels.
pub(super) fn size(picture: &Drawing) -> (u32, u32) {
    match picture {
        Drawing::Plot(plot) => (SIZE.0, SIZE.1.max(PANEL * u32::try_from(plot.panels.len()).unwrap_or(1))),
        Drawing::Section(section) => section.size(),
    }
}

/// Draws on white, in a font that is a part of the program, because a server may have none.
fn draw<DB: DrawingBackend<ErrorType: 'static>>(picture: &Drawing, backend: DB) -> DrawResult {
    static FONT: Once = Once::new();
    FONT.call_once(|| {
        // The only error is that of an invalid font.
        let _ = register_font("sans-serif", FontStyle::Normal, dejavu::sans::regular());
    });
    let area = backend.into_drawing_area();
    area.fill(&WHITE)?;
    match picture {
        Drawing::Plot(plot) => plot.draw(&area)?,
        Drawing::Section(section) => section.draw(&area)?,
    }
    area.present()?;
    Ok(())
}

impl Plot {
    fn draw<DB: DrawingBackend<ErrorType: 'static>>(&self, area: &DrawingArea<DB, Shift>) -> DrawResult {
        let titled = area.margin(16, 0, 0, 0).titled(&self.title, ("sans-serif", 30))?;
        let ends = self.bands.iter().flat_map(|band| [band.from, band.to]);
        let curves = self.panels.iter().flat_map(|panel| &panel.curves);
        let x_range = curves.flat_map(|curve| self.points(curve)).map(|point| point.0);
        let extent = self.whole(extent(x_range.chain(ends)));
        let scale = scale(&self.x, &extent);
        let last = self.panels.len().saturating_sub(1);
        for (index, (part, panel)) in
            titled.split_evenly((self.panels.len().max(1), 1)).iter().zip(&self.panels).enumerate()
        {
            let bands: &[Band] = if index == 0 { &self.bands } else { &[] };
            self.draw_panel(part, panel, bands, (&extent, &scale), index == last)?;
        }
        Ok(())
    }

    /// The points of a curve as they are drawn: over decades their logarithms, without those that have none.
    fn points(&self, curve: &Curve) -> Vec<(f64, f64)> {
        if !self.over_decades {
            return curve.points.clone();
        }
        let above_zero = curve.points.iter().filter(|(x, y)| *x > 0.0 && *y > 0.0);
        above_zero.map(|(x, y)| (x.log10(), y.log10())).collect()
    }

    /// A range, or the decades that it lies in.
    fn whole(&self, range: Range<f64>) -> Range<f64> {
        if self.over_decades { range.start.floor()..range.end.ceil() } else { range }
    }

    fn draw_panel<DB: DrawingBackend<ErrorType: 'static>>(
        &self,
        area: &DrawingArea<DB, Shift>,
        panel: &Panel,
        bands: &[Band],
        (x_range, x): (&Range<f64>, &Scale),
        lowest: bool,
    ) -> DrawResult {
        let decades = self.over_decades;
        let values = panel.curves.iter().flat_map(|curve| self.points(curve)).map(|point| point.1);
        let y_range = self.whole(extent(values));
        let y = scale(&panel.y, &y_range);
        let span = (y_range.end - y_range.start) / y.unit;
        let legend = !bands.is_empty() || panel.curves.iter().any(|curve| !curve.name.is_empty());
        // Curves that fall over decades leave room for the legend at the middle of the left.
        let (below, above, place) = match (decades, legend) {
            (true, _) => (0.0, 0.0, SeriesLabelPosition::MiddleLeft),
            (_, true) => (MARGIN, HEADROOM, SeriesLabelPosition::UpperRight),
            _ => (MARGIN, MARGIN, SeriesLabelPosition::UpperRight),
        };
        let (low, high) = (y_range.start / y.unit - below * span, y_range.end / y.unit + above * span);
        let mut axes = ChartBuilder::on(area)
            .margin_left(20)
            .margin_right(36)
            .margin_top(12)
            .x_label_area_size(if lowest { 84 } else { 20 })
            .y_label_area_size(LEFT)
            .build_cartesian_2d(x_range.start / x.unit..x_range.end / x.unit, low..high)?;
        for band in bands {
            let corners = [(band.from / x.unit, low), (band.to / x.unit, high)];
            let shade = band.colour.rgb().mix(0.10);
            axes.draw_series([Rectangle::new(corners, shade.filled())])?.label(band.name).legend(key(12, shade));
        }
        let ticks = |range: &Range<f64>| if decades { (range.end - range.start) as usize + 1 } else { 10 };
        let label = if decades { |value: &f64| format!("1e{}", value.round()) } else { tick };
        let mut mesh = axes.configure_mesh();
        mesh.y_desc(&y.label)
            .x_labels(if lowest { ticks(x_range) } else { 0 })
            .x_label_formatter(&label)
            .y_label_formatter(&label)
            .label_style(("sans-serif", 24))
            .axis_desc_style(("sans-serif", 28))
            .light_line_style(TRANSPARENT);
        if lowest {
            mesh.x_desc(&x.label);
        }
        if decades {
            mesh.y_labels(ticks(&y_range));
        }
        mesh.draw()?;
        for (curve, own) in panel.curves.iter().zip(Colour::ALL.iter().cycle()) {
            let colour = curve.colour.unwrap_or(*own).rgb();
            let style = colour.stroke_width(4);
            let points = self.points(curve);
            let stretches = points.split(|point| !is_drawable(&point.0) || !is_drawable(&point.1));
            let mut named = curve.name.is_empty();
            for stretch in stretches.filter(|stretch| !stretch.is_empty()) {
                let points = || stretch.iter().map(|point| (point.0 / x.unit, point.1 / y.unit));
                if curve.filled {
                    let shade = colour.mix(AREA_SHADE);
                    let area = Polygon::new(points().collect::<Vec<_>>(), shade.filled());
                    axes.draw_series([area])?.label(curve.name.as_ref()).legend(key(12, shade));
                    continue;
                }
                let joined = stretch.len() > 1 && !curve.dots;
                let dot = if stretch.len() == 1 || curve.points.len() < FEW { LARGE_DOT } else { DOT };
                if !joined || decades {
                    axes.draw_series(points().map(|point| Circle::new(point, dot, colour.filled())))?;
                }
                let line = axes.draw_series(joined.then(|| PathElement::new(points().collect::<Vec<_>>(), style)))?;
                if !std::mem::replace(&mut named, true) {
                    let label = line.label(curve.name.as_ref());
                    if curve.dots {
                        label.legend(move |(x, y)| Circle::new((x + 14, y), LARGE_DOT, style.filled()));
                    } else {
                        label.legend(key(3, colour.to_rgba()));
                    }
                }
            }
        }
        if !legend {
            return Ok(());
        }
        axes.configure_series_labels()
            .position(place)
            .legend_area_size(40)
            .background_style(WHITE.mix(0.85))
            .border_style(RGBColor(200, 200, 200))
            .label_font(("sans-serif", 24))
            .draw()?;
        Ok(())
    }
}

/// A rectangle of this colour in the legend, up to so many pixels above and below the middle of its line.
fn key(half: i32, colour: RGBAColor) -> impl Fn((i32, i32)) -> Rectangle<(i32, i32)> {
    move |(x, y)| Rectangle::new([(x, y - half), (x + 28, y + half)], colour.filled())
}

/// The range of the values, widened if they are all the same.
pub(super) fn extent(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in values.filter(is_drawable) {
        (low, high) = (low.min(value), high.max(value));
    }
    if low > high {
        return 0.0..1.0;
    }
    // Values that differ in their last digits alone would have labels that are all the same.
    let largest = low.abs().max(high.abs());
    let pad = if largest > SMALLEST { 0.1 * largest } else { 1.0 };
    if high - low > SMALLEST.max(1e-9 * largest) { low..high } else { low - pad..high + pad }
}

/// Whether a value can be drawn: the sum of two larger ones may overflow.
fn is_drawable(value: &f64) -> bool {
    value.abs() < 1e250
}

pub(super) fn scale(axis: &Axis, extent: &Range<f64>) -> Scale {
    let largest = extent.start.abs().max(extent.end.abs());
    let (divisor, symbol) = match axis.unit {
        None => (1.0, String::new()),
        // A prefix would be squared with its unit.
        Some(unit) if unit.chars().nth(1) == Some('²') => {
            let decade = if largest > SMALLEST { 3 * (largest.log10() / 3.0).floor() as i32 } else { 0 };
            (
                10_f64.powi(decade),
                if decade == 0 { unit.to_owned() } else { format!("10{} {unit}", superscript(decade)) },
            )
        }
        Some(unit) => {
            let (divisor, prefix) = unit_prefix(largest);
            (divisor, format!("{prefix}{unit}"))
        }
    };
    let label = match axis.unit {
        None => axis.name.to_owned(),
        Some(_) if symbol.contains(' ') => format!("{} / ({symbol})", axis.name),
        Some(_) => format!("{} / {symbol}", axis.name),
    };
    Scale { unit: divisor, symbol, label }
}

impl Scale {
    /// A value in SI units with four digits and the unit.
    pub(super) fn shown(&self, value: f64) -> String {
        let digits = format!("{:.3e}", value / self.unit).parse().unwrap_or(value);
        match &self.symbol[..] {
            "" => tick(&digits),
            symbol if symbol.contains(' ') => format!("{} · {symbol}", tick(&digits)),
            symbol => format!("{} {symbol}", tick(&digits)),
        }
    }
}

/// An exponent in raised digits.
fn superscript(exponent: i32) -> String {
    let raised = |digit: char| match digit.to_digit(10) {
        Some(digit) => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit as usize],
        None => '⁻',
    };
    exponent.to_string().chars().map(raised).collect()
}

/// A tick's label: a few digits, without a sign on zero.
pub(super) fn tick(value: &f64) -> String {
    let size = value.abs();
    if size < 1e-12 {
        "0".to_owned()
    } else if (1e-3..1e7).contains(&size) {
        let rounded = format!("{value:.6}");
        rounded.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{value:.2e}")
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Colour, Curve, Drawing, Plot};
    use super::SIZE;

    /// Every second of many points is high, so that each corner is sharp.
    fn comb() -> Drawing {
        let points = (0..400).map(|index| (f64::from(index), if index % 2 == 0 { -1.0 } else { 1.0 }));
        Drawing::Plot(Plot::of_numbers("t", "x", "x", vec![Curve::line("", Colour::Red, points)]))
    }

    #[test]
    fn nothing_is_drawn_beyond_the_data_at_a_sharp_corner() {
        let file = comb().png(&|| true).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let red = |pixel: &[u8]| pixel[0] > 150 && pixel[1] < 120 && pixel[2] < 120;
        let rows: Vec<usize> = pixels
            .chunks(3 * SIZE.0 as usize)
            .enumerate()
            .filter(|(_, row)| row.chunks(3).any(red))
            .map(|(row, _)| row)
            .collect();
        let svg = String::from_utf8(comb().svg().unwrap()).unwrap();
        let data = svg.split("<polyline").filter(|line| line.contains("#DC3220")).collect::<Vec<_>>();
        assert!(data.len() == 1 && data[0].contains("stroke-linejoin=\"round\""), "{}", data.len());
        let points = data[0].split("points=\"").nth(1).unwrap().split('"').next().unwrap();
        let heights = points.split_whitespace().map(|point| point.split(',').nth(1).unwrap().parse::<usize>().unwrap());
        let (top, bottom) = (heights.clone().min().unwrap(), heights.max().unwrap());
        // Half the width of the line on both sides.
        assert!(rows[0] + 3 >= top && *rows.last().unwrap() <= bottom + 3, "{} {top} {bottom}", rows[0]);
    }

    #[test]
    fn decades_are_labelled_and_what_has_no_logarithm_is_left_out() {
        let curve = Curve::line("a", None, [(1e-5, 1e-3), (0.0, 1.0), (1e-3, 1e-9)]);
        let plot = Plot { over_decades: true, ..Plot::of_numbers("t", "x", "y", vec![curve]) };
        let svg = String::from_utf8(Drawing::Plot(plot).svg().unwrap()).unwrap();
        for label in ["1e-5", "1e-4", "1e-3", "1e-9", "1e-6"] {
            assert!(svg.contains(label), "{label}");
        }
        // Two dots, and none for the point without a logarithm.
        assert_eq!(svg.matches("<circle").count(), 2);
        // Nor do the axes reach to it.
        assert!(!svg.contains("NaN") && !svg.contains("inf") && !svg.contains("1e0") && !svg.contains("1e-2"));
    }
}
