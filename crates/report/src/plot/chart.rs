//! A line or dot chart as SVG, over plain or logarithmic axes.

use plotters::prelude::*;

/// Curves or dots over one pair of axes.
pub struct Chart {
    /// Above the chart.
    pub title: String,
    /// Label of the abscissa.
    pub x: String,
    /// Label of the ordinate.
    pub y: String,
    /// What is drawn.
    pub series: Vec<Series>,
    /// Whether the axes are logarithmic, from decade to decade; points that are not above zero are left out.
    pub over_decades: bool,
}

/// One named set of points.
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// Abscissa and ordinate.
    pub points: Vec<(f64, f64)>,
    joined: bool,
}

/// Distinct in hue and in lightness, so that colour-blind readers can distinguish them, in print too.
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 90, 181),
    RGBColor(220, 50, 32),
    RGBColor(110, 110, 110),
    RGBColor(160, 160, 160),
    RGBColor(230, 159, 0),
    RGBColor(0, 130, 90),
];
/// Twice the size shown on a page: the backend draws in whole pixels, which would make smooth curves jagged.
const SIZE: (u32, u32) = (1520, 920);
/// The part of the height kept free for the legend.
const HEADROOM: f64 = 0.22;

impl Series {
    /// Points joined by a line.
    pub fn line(name: impl Into<String>, points: Vec<(f64, f64)>) -> Series {
        Series { name: name.into(), points, joined: true }
    }

    /// Points alone.
    pub fn dots(name: impl Into<String>, points: Vec<(f64, f64)>) -> Series {
        Series { name: name.into(), points, joined: false }
    }
}

impl Chart {
    /// A chart with its title, the labels of abscissa and ordinate, and its series.
    pub fn new(title: &str, x: &str, y: &str, series: Vec<Series>) -> Chart {
        Chart { title: title.to_owned(), x: x.to_owned(), y: y.to_owned(), series, over_decades: false }
    }

    /// The chart as an SVG document.
    pub fn svg(&self) -> Result<String, String> {
        let mut text = String::new();
        self.draw(&mut text).map_err(|fault| fault.to_string())?;
        Ok(text)
    }

    /// The points of a series as they lie on the axes.
    fn placed<'a>(&self, series: &'a Series) -> impl Iterator<Item = (f64, f64)> + use<'a> {
        let decades = self.over_decades;
        series
            .points
            .iter()
            .filter(move |point| !decades || (point.0 > 0.0 && point.1 > 0.0))
            .map(move |&(x, y)| if decades { (x.log10(), y.log10()) } else { (x, y) })
    }

    fn draw(&self, text: &mut String) -> Result<(), Box<dyn std::error::Error>> {
        let decades = self.over_decades;
        super::font::register();
        let area = SVGBackend::with_string(text, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let (mut left, mut right) = self.extent(|point| point.0);
        let (mut low, mut high) = self.extent(|point| point.1);
        let (mut label, mut ticks): (fn(&f64) -> String, _) = (tick, (11, 11));
        if decades {
            (left, right, low, high) = (left.floor(), right.ceil(), low.floor(), high.ceil());
            // One tick a decade.
            (label, ticks) = (decade, ((right - left) as usize + 1, (high - low) as usize + 1));
        }
        // Falling curves leave room for the legend at the middle of the left.
        let (margin, headroom, place) = if decades {
            (0.0, 0.0, SeriesLabelPosition::MiddleLeft)
        } else {
            (0.05 * (high - low), HEADROOM * (high - low), SeriesLabelPosition::UpperRight)
        };
        let mut axes = ChartBuilder::on(&area)
            .caption(&self.title, ("sans-serif", 36))
            .margin(28)
            .x_label_area_size(88)
            .y_label_area_size(128)
            .build_cartesian_2d(left..right, (low - margin)..(high + headroom))?;
        axes.configure_mesh()
            .x_desc(&self.x)
            .y_desc(&self.y)
            .x_labels(ticks.0)
            .y_labels(ticks.1)
            .x_label_formatter(&label)
            .y_label_formatter(&label)
            .label_style(("sans-serif", 26))
            .axis_desc_style(("sans-serif", 30))
            .light_line_style(TRANSPARENT)
            .draw()?;
        // The first series is drawn last, so that it lies on top.
        for (series, colour) in self.series.iter().zip(COLOURS.iter()).rev() {
            let style = colour.stroke_width(4);
            if series.joined && decades {
                axes.draw_series(self.placed(series).map(|point| Circle::new(point, 7, colour.filled())))?;
            }
            let drawn = if series.joined {
                axes.draw_series(LineSeries::new(self.placed(series), style))?
            } else {
                axes.draw_series(self.placed(series).map(|point| Circle::new(point, 8, colour.filled())))?
            };
            drawn
                .label(&series.name)
                .legend(move |(x, y)| Rectangle::new([(x, y - 6), (x + 28, y + 6)], colour.filled()));
        }
        axes.configure_series_labels()
            .position(place)
            .legend_area_size(40)
            .background_style(WHITE.mix(0.85))
            .border_style(RGBColor(200, 200, 200))
            .label_font(("sans-serif", 26))
            .draw()?;
        area.present()?;
        Ok(())
    }

    fn extent(&self, coordinate: impl Fn((f64, f64)) -> f64) -> (f64, f64) {
        let values = || self.series.iter().flat_map(|series| self.placed(series)).map(&coordinate);
        (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max))
    }
}

/// A tick's label, without a sign on zero.
fn tick(value: &f64) -> String {
    let rounded = (value * 100.0).round() / 100.0;
    if rounded.abs() > 0.0 { rounded.to_string() } else { "0".to_owned() }
}

/// A tick's label over logarithmic axes.
fn decade(value: &f64) -> String {
    format!("1e{}", value.round())
}

#[cfg(test)]
mod tests {
    use super::{Chart, Series};

    #[test]
    fn decades_are_labelled_and_what_has_no_logarithm_is_left_out() {
        let points = vec![(1e-5, 1e-3), (0.0, 1.0), (1e-3, 1e-9)];
        let chart = Chart { over_decades: true, ..Chart::new("t", "x", "y", vec![Series::line("a", points)]) };
        let svg = chart.svg().unwrap();
        for label in ["1e-5", "1e-4", "1e-3", "1e-9", "1e-6"] {
            assert!(svg.contains(label), "{label}");
        }
        // Two dots, and none for the point without a logarithm.
        assert_eq!(svg.matches("<circle").count(), 2);
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }
}
