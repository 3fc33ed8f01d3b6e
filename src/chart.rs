//! A plain line or dot chart as SVG.

use plotters::prelude::*;

/// Curves or dots over one pair of axes.
pub(crate) struct Chart {
    pub(crate) title: String,
    pub(crate) x: String,
    pub(crate) y: String,
    pub(crate) series: Vec<Series>,
}

/// One named set of points.
pub(crate) struct Series {
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
    joined: bool,
}

/// Distinct in hue and in lightness, so that they stay apart for colour-blind readers and in print.
const COLOURS: [RGBColor; 4] =
    [RGBColor(0, 90, 181), RGBColor(220, 50, 32), RGBColor(110, 110, 110), RGBColor(160, 160, 160)];
/// Twice what is shown on a page: the backend draws in whole pixels, which would make smooth curves waver.
const SIZE: (u32, u32) = (1520, 920);
/// The part of the height kept free for the legend.
const HEADROOM: f64 = 0.22;

impl Series {
    pub(crate) fn line(name: impl Into<String>, points: Vec<(f64, f64)>) -> Series {
        Series { name: name.into(), points, joined: true }
    }

    pub(crate) fn dots(name: impl Into<String>, points: Vec<(f64, f64)>) -> Series {
        Series { name: name.into(), points, joined: false }
    }
}

impl Chart {
    /// The chart as an SVG document.
    pub(crate) fn svg(&self) -> Result<String, String> {
        crate::plot::ready();
        let mut text = String::new();
        self.draw(&mut text).map_err(|fault| fault.to_string())?;
        Ok(text)
    }

    fn draw(&self, text: &mut String) -> Result<(), Box<dyn std::error::Error>> {
        let area = SVGBackend::with_string(text, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let (left, right) = self.extent(|point| point.0);
        let (low, high) = self.extent(|point| point.1);
        let margin = 0.05 * (high - low);
        let mut axes = ChartBuilder::on(&area)
            .caption(&self.title, ("sans-serif", 36))
            .margin(28)
            .x_label_area_size(88)
            .y_label_area_size(128)
            .build_cartesian_2d(left..right, (low - margin)..(high + HEADROOM * (high - low)))?;
        axes.configure_mesh()
            .x_desc(&self.x)
            .y_desc(&self.y)
            .x_label_formatter(&tick)
            .y_label_formatter(&tick)
            .label_style(("sans-serif", 26))
            .axis_desc_style(("sans-serif", 30))
            .light_line_style(TRANSPARENT)
            .draw()?;
        // The last first, so that a chart's main curve lies on top.
        for (series, colour) in self.series.iter().zip(COLOURS.iter()).rev() {
            let style = colour.stroke_width(4);
            let drawn = if series.joined {
                axes.draw_series(LineSeries::new(series.points.iter().copied(), style))?
            } else {
                let dot = |&point| Circle::new(point, 8, colour.filled());
                axes.draw_series(series.points.iter().map(dot))?
            };
            drawn
                .label(&series.name)
                .legend(move |(x, y)| Rectangle::new([(x, y - 6), (x + 28, y + 6)], colour.filled()));
        }
        axes.configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .legend_area_size(40)
            .background_style(WHITE.mix(0.85))
            .border_style(RGBColor(200, 200, 200))
            .label_font(("sans-serif", 26))
            .draw()?;
        area.present()?;
        Ok(())
    }

    fn extent(&self, coordinate: impl Fn(&(f64, f64)) -> f64) -> (f64, f64) {
        let values = || self.series.iter().flat_map(|series| &series.points).map(&coordinate);
        (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max))
    }
}

/// A tick's label, without a sign on nought.
fn tick(value: &f64) -> String {
    let rounded = (value * 100.0).round() / 100.0;
    if rounded.abs() > 0.0 { rounded.to_string() } else { "0".to_owned() }
}
