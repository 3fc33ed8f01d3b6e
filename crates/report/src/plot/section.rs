//! A quantity over two coordinates: shades between contours, with a scale beside them.

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::*;

use super::draw::{extent, scale, tick};
use super::{Axis, Picture};

/// Shades from the smallest value to the largest.
const SHADES: usize = 12;
/// Cells along a side at most: a finer grid is drawn at so many of its places.
const CELLS: usize = 160;
/// Pixels of the scale with its labels.
const SCALE: u32 = 250;

/// Values over a grid, in SI units; where one is not finite the picture is left white.
pub struct Section {
    /// Above the picture.
    pub title: String,
    /// The coordinate to the right, and its values, rising.
    pub x: (Axis, Vec<f64>),
    /// The coordinate upwards or, if it is a depth, downwards, and its values, rising.
    pub y: (Axis, Vec<f64>),
    /// Whether `y` points downwards.
    pub downwards: bool,
    /// The quantity, and its values: all along `y` at the first of `x`, then at the next.
    pub values: (Axis, Vec<f64>),
}

impl Section {
    fn value(&self, column: usize, row: usize) -> f64 {
        self.values.1[column * self.y.1.len() + row]
    }
}

/// Dark where a value is small, light where it is large, in lightness alone as good as in hue.
fn shade(index: usize) -> RGBColor {
    const ENDS: [(f64, f64, f64); 4] =
        [(24.0, 28.0, 92.0), (38.0, 116.0, 152.0), (120.0, 196.0, 132.0), (252.0, 236.0, 120.0)];
    let along = index as f64 / (SHADES - 1) as f64 * (ENDS.len() - 1) as f64;
    let low = (along as usize).min(ENDS.len() - 2);
    let (one, two, share) = (ENDS[low], ENDS[low + 1], along - low as f64);
    let mix = |a: f64, b: f64| (a + (b - a) * share).round() as u8;
    RGBColor(mix(one.0, two.0), mix(one.1, two.1), mix(one.2, two.2))
}

/// The indices of at most so many of `count` values, both ends among them.
fn sampled(count: usize) -> Vec<usize> {
    let kept = count.min(CELLS);
    (0..kept).map(|index| index * (count - 1) / (kept - 1).max(1)).collect()
}

/// Where the cells about these values begin and end.
fn borders(values: &[f64], kept: &[usize]) -> Vec<f64> {
    let at = |index: usize| values[kept[index]];
    let between = (1..kept.len()).map(|index| 0.5 * (at(index - 1) + at(index)));
    std::iter::once(at(0)).chain(between).chain([at(kept.len() - 1)]).collect()
}

impl Picture for Section {
    fn draw<DB: DrawingBackend>(&self, area: &DrawingArea<DB, Shift>) -> Result<(), Box<dyn Error>>
    where
        DB::ErrorType: 'static,
    {
        let titled = area.margin(16, 0, 0, 0).titled(&self.title, ("sans-serif", 30))?;
        let (left, right) = titled.split_horizontally(titled.dim_in_pixel().0 - SCALE);
        let range = extent(self.values.1.iter().copied());
        let (x_range, y_range) = (extent(self.x.1.iter().copied()), extent(self.y.1.iter().copied()));
        let (x, y, unit) = (scale(&self.x.0, &x_range), scale(&self.y.0, &y_range), scale(&self.values.0, &range));
        let (low, high) = (y_range.start / y.unit, y_range.end / y.unit);
        let upwards = if self.downwards { high..low } else { low..high };
        let mut axes = ChartBuilder::on(&left)
            .margin_left(20)
            .margin_top(12)
            .x_label_area_size(84)
            .y_label_area_size(132)
            .build_cartesian_2d(x_range.start / x.unit..x_range.end / x.unit, upwards)?;
        axes.configure_mesh()
            .disable_mesh()
            .x_desc(&x.label)
            .y_desc(&y.label)
            .x_label_formatter(&tick)
            .y_label_formatter(&tick)
            .label_style(("sans-serif", 24))
            .axis_desc_style(("sans-serif", 28))
            .draw()?;
        let (columns, rows) = (sampled(self.x.1.len()), sampled(self.y.1.len()));
        let (across, along) = (borders(&self.x.1, &columns), borders(&self.y.1, &rows));
        let step = (range.end - range.start) / SHADES as f64;
        let index = |value: f64| value.is_finite().then(|| (((value - range.start) / step) as usize).min(SHADES - 1));
        for (i, column) in columns.iter().enumerate() {
            let mut from = 0;
            // Neighbours of one shade are one rectangle.
            for j in 1..=rows.len() {
                let here = index(self.value(*column, rows[from]));
                if j < rows.len() && index(self.value(*column, rows[j])) == here {
                    continue;
                }
                if let Some(index) = here {
                    let corner = |x_at: f64, y_at: f64| (x_at / x.unit, y_at / y.unit);
                    let corners = [corner(across[i], along[from]), corner(across[i + 1], along[j])];
                    axes.draw_series([Rectangle::new(corners, shade(index).filled())])?;
                }
                from = j;
            }
        }
        let mut legend = ChartBuilder::on(&right)
            .margin_top(12)
            .margin_bottom(84)
            .margin_left(40)
            .margin_right(20)
            .y_label_area_size(110)
            .build_cartesian_2d(0.0..1.0, range.start / unit.unit..range.end / unit.unit)?;
        legend
            .configure_mesh()
            .disable_mesh()
            .disable_x_axis()
            .y_desc(&unit.label)
            .y_label_formatter(&tick)
            .label_style(("sans-serif", 24))
            .axis_desc_style(("sans-serif", 28))
            .draw()?;
        legend.draw_series((0..SHADES).map(|index| {
            let at = |index: usize| (range.start + index as f64 * step) / unit.unit;
            Rectangle::new([(0.0, at(index)), (1.0, at(index + 1))], shade(index).filled())
        }))?;
        Ok(())
    }
}
