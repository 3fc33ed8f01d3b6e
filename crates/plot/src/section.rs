//! A quantity over two coordinates: shades between lines of equal value, with a scale beside them and marks on them.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::Axis;
use super::contour::{Grid, Outline};
use super::draw::{DrawResult, SIZE, Scale, extent, scale, tick};

/// Lines of equal value at most, and shades between two of them: so many that their steps are hardly seen.
const LINES: f64 = 9.0;
const SHADES: usize = 4;
/// Pixels: above the picture for title and legend, below it and left of it for the axes, right of it for the scale.
const ABOVE: u32 = 124;
const BELOW: u32 = 82;
const LEFT: u32 = 152;
const SCALE: u32 = 230;
/// Pixels left of the labels and right of the scale.
const MARGIN: u32 = 16;
/// The least height of the picture, pixels: below it the coordinates have scales of their own.
const LEAST_HEIGHT: f64 = 240.0;
/// Corners of the edge of a contact.
const CORNERS: usize = 720;

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
    /// The largest value, which the title ends with.
    pub largest: Option<Peak>,
    /// The edge of the contact.
    pub edge: Option<ContactEdge>,
}

/// The largest value of a section.
pub struct Peak {
    /// The value, in SI units.
    pub value: f64,
    /// Where it is met, if that is in the picture; as symmetry has it, in several places.
    pub places: Vec<(f64, f64)>,
}

/// Where a section meets the edge of the contact.
pub struct ContactEdge {
    /// The contact radius, in the unit of the coordinates.
    pub radius: f64,
    /// How far the plane of a section through the depth is from the axis of the contact, in that unit; of a plane along
    /// the surface nothing.
    pub offset: Option<f64>,
    /// What the legend calls it.
    pub name: &'static str,
}

/// Dark where a value is small, light where it is large, in lightness alone as good as in hue; `part` is 0 to 1.
fn shade(part: f64) -> RGBColor {
    const ENDS: [(f64, f64, f64); 4] =
        [(24.0, 28.0, 92.0), (38.0, 116.0, 152.0), (120.0, 196.0, 132.0), (252.0, 236.0, 120.0)];
    let along = part.clamp(0.0, 1.0) * (ENDS.len() - 1) as f64;
    let low = (along as usize).min(ENDS.len() - 2);
    let (one, two, share) = (ENDS[low], ENDS[low + 1], along - low as f64);
    let mix = |a: f64, b: f64| (a + (b - a) * share).round() as u8;
    RGBColor(mix(one.0, two.0), mix(one.1, two.1), mix(one.2, two.2))
}

/// The shades between the smallest value and the largest, in the unit of the scale: they change at round values, and
/// every [`SHADES`]th of these has a line.
struct Levels {
    range: Range<f64>,
    /// Between two lines.
    step: f64,
}

impl Levels {
    fn of(range: Range<f64>) -> Levels {
        let wanted = (range.end - range.start) / LINES;
        let decade = 10_f64.powf(wanted.log10().floor());
        let step = [1.0, 2.0, 2.5, 5.0].into_iter().find(|step| step * decade >= wanted).unwrap_or(10.0);
        Levels { range, step: step * decade }
    }

    /// Where each shade begins, and whether a line is there; the first takes in the smallest value.
    fn begins(&self) -> impl Iterator<Item = (f64, bool)> {
        let fine = self.step / SHADES as f64;
        let first = (self.range.start / fine).floor() as i64;
        let last = (self.range.end / fine).ceil() as i64;
        (first..last).map(move |index| (index as f64 * fine, index.rem_euclid(SHADES as i64) == 0))
    }

    /// The values that have a line.
    fn lined(&self) -> impl Iterator<Item = f64> {
        self.begins().filter(|(from, lined)| *lined && self.range.contains(from)).map(|(from, _)| from)
    }

    /// The colour of the shade that begins at a value.
    fn colour(&self, from: f64) -> RGBColor {
        let [from, to] =
            [from, from + self.step / SHADES as f64].map(|end| end.clamp(self.range.start, self.range.end));
        shade((0.5 * (from + to) - self.range.start) / (self.range.end - self.range.start))
    }

    /// What to fill of a grid, one on top of the other, with its colour: regions from a level on, and holes in them, of
    /// which the larger one is always further down. `unit` is that of the scale, and areas from `least` on are seen.
    fn fills(&self, grid: &Grid, unit: f64, least: f64) -> Vec<(Outline, RGBColor)> {
        let mut fills = Vec::new();
        let mut below = WHITE;
        for (level, (from, _)) in self.begins().enumerate() {
            let colour = self.colour(from);
            let from = if level == 0 { f64::NEG_INFINITY } else { from * unit };
            let seen = grid.outlines(from).into_iter().filter(|outline| outline.area.abs() >= least);
            fills.extend(seen.map(|outline| {
                let is_hole = outline.area < 0.0;
                (level as f64 * if is_hole { -1.0 } else { 1.0 }, if is_hole { below } else { colour }, outline)
            }));
            below = colour;
        }
        // Of two that are the same, the region of a higher level and the hole in a lower one lie on top.
        fills.sort_by(|(one_level, _, one), (other_level, _, other)| {
            other.area.abs().total_cmp(&one.area.abs()).then(one_level.total_cmp(other_level))
        });
        fills.into_iter().map(|(_, colour, outline)| (outline, colour)).collect()
    }
}

impl Section {
    /// The title with the largest value, in the unit of the scale, and where it is.
    fn heading(&self, x: &Scale, y: &Scale, unit: &Scale) -> String {
        let Some(peak) = &self.largest else { return self.title.clone() };
        let place = |(at_x, at_y): &(f64, f64)| {
            let one =
                |name: &'static str, value: String| format!("{} = {value}", name.split(',').next().unwrap_or(name));
            format!("{}, {}", one(self.x.0.name, x.shown(*at_x)), one(self.y.0.name, y.shown(*at_y)))
        };
        let places: Vec<String> = peak.places.iter().map(place).collect();
        let places =
            if places.is_empty() { "off this picture".to_owned() } else { format!("at {}", places.join(" and ")) };
        format!("{}: largest {} {places}", self.title, unit.shown(peak.value))
    }

    /// Pixels of the picture between its axes: with equal scales where both coordinates have the same unit and neither
    /// is too thin.
    fn extent_in_pixels(&self) -> (u32, u32) {
        let (most_x, most_y) = (f64::from(SIZE.0 - LEFT - SCALE - 2 * MARGIN), f64::from(SIZE.1 - ABOVE - BELOW));
        let [x, y] = [&self.x.1, &self.y.1].map(|values| extent(values.iter().copied()));
        let ratio = (y.end - y.start) / (x.end - x.start);
        let (width, height) = (most_x.min(most_y / ratio), most_y.min(most_x * ratio));
        if self.x.0.unit == self.y.0.unit && height >= LEAST_HEIGHT && width >= LEAST_HEIGHT {
            (width as u32, height as u32)
        } else {
            (most_x as u32, (0.6 * most_y) as u32)
        }
    }

    /// The edge of the contact: lines in the unit of the coordinates, each within the picture.
    fn edge_lines(&self, x: &Range<f64>, y: &Range<f64>) -> Vec<Vec<(f64, f64)>> {
        let Some(edge) = &self.edge else { return Vec::new() };
        let whole: Vec<Vec<(f64, f64)>> = match edge.offset {
            None => {
                let angle = |index: usize| std::f64::consts::TAU * index as f64 / CORNERS as f64;
                let corner = |index| (edge.radius * angle(index).cos(), edge.radius * angle(index).sin());
                vec![(0..=CORNERS).map(corner).collect()]
            }
            Some(offset) if offset.abs() < edge.radius => {
                let half = (edge.radius * edge.radius - offset * offset).sqrt();
                [-half, half].map(|x| vec![(x, y.start), (x, y.end)]).into()
            }
            Some(_) => Vec::new(),
        };
        let is_outside =
            |(at_x, at_y): &(f64, f64)| *at_x < x.start || *at_x > x.end || *at_y < y.start || *at_y > y.end;
        let parts = whole.iter().flat_map(|line| line.split(is_outside));
        parts.filter(|part| part.len() > 1).map(<[_]>::to_vec).collect()
    }

    /// Names the marks, in a row below the title, from the left edge of the picture on.
    fn draw_legend<DB: DrawingBackend<ErrorType: 'static>>(
        &self,
        area: &DrawingArea<DB, Shift>,
        mut left: i32,
    ) -> DrawResult {
        const ROW: i32 = 88;
        // The middle of letters is above that of their line.
        const MARK: i32 = ROW - 2;
        const SAMPLE: i32 = 56;
        let style = ("sans-serif", 24).into_text_style(area).pos(Pos::new(HPos::Left, VPos::Center));
        if self.largest.as_ref().is_some_and(|peak| !peak.places.is_empty()) {
            area.draw(&Circle::new((left + 32, MARK), 11, BLACK.stroke_width(3)))?;
            area.draw(&Text::new("largest value", (left + SAMPLE, ROW), style.clone()))?;
            left += 240;
        }
        if let Some(edge) = &self.edge {
            let ends = [(left, MARK), (left + 44, MARK)];
            area.draw(&DashedPathElement::new(ends, 12, 8, BLACK.stroke_width(3)))?;
            area.draw(&Text::new(edge.name, (left + SAMPLE, ROW), style))?;
        }
        Ok(())
    }
}

/// The scale of the colours, with its quantity and the values that have lines.
fn draw_scale<DB: DrawingBackend<ErrorType: 'static>>(
    area: &DrawingArea<DB, Shift>,
    (left, height): (i32, i32),
    levels: &Levels,
    label: &str,
) -> DrawResult {
    const WIDTH: i32 = 44;
    let (top, Range { start, end }) = (ABOVE as i32, levels.range.clone());
    let row = |value: f64| top + (f64::from(height) * (end - value) / (end - start)).round() as i32;
    for (from, _) in levels.begins() {
        let to = (from + levels.step / SHADES as f64).min(end);
        let corners = [(left, row(to)), (left + WIDTH, row(from.max(start)))];
        area.draw(&Rectangle::new(corners, levels.colour(from).filled()))?;
    }
    let style = ("sans-serif", 24).into_text_style(area).pos(Pos::new(HPos::Left, VPos::Center));
    for value in levels.lined() {
        area.draw(&PathElement::new(vec![(left, row(value)), (left + WIDTH + 6, row(value))], BLACK.mix(0.5)))?;
        area.draw(&Text::new(tick(&value), (left + WIDTH + 12, row(value)), style.clone()))?;
    }
    let style = ("sans-serif", 28).into_font().transform(FontTransform::Rotate90).into_text_style(area);
    let style = style.pos(Pos::new(HPos::Center, VPos::Center));
    area.draw(&Text::new(label.to_owned(), (left + WIDTH + 126, top + height / 2), style))?;
    Ok(())
}

impl Section {
    /// Width and height, pixels.
    pub(super) fn size(&self) -> (u32, u32) {
        (SIZE.0, ABOVE + self.extent_in_pixels().1 + BELOW)
    }

    pub(super) fn draw<DB: DrawingBackend<ErrorType: 'static>>(&self, area: &DrawingArea<DB, Shift>) -> DrawResult {
        let grid = Grid::refined(&self.x.1, &self.y.1, &self.values.1);
        let [x_range, y_range, range] =
            [&self.x.1, &self.y.1, &self.values.1].map(|values| extent(values.iter().copied()));
        let (x, y, unit) = (scale(&self.x.0, &x_range), scale(&self.y.0, &y_range), scale(&self.values.0, &range));
        let levels = Levels::of(range.start / unit.unit..range.end / unit.unit);
        let (width, height) = self.extent_in_pixels();
        let left = (SIZE.0 - LEFT - width - SCALE) / 2;

        let style = ("sans-serif", 30).into_text_style(area).pos(Pos::new(HPos::Center, VPos::Center));
        area.draw(&Text::new(self.heading(&x, &y, &unit), (SIZE.0 as i32 / 2, 40), style))?;
        self.draw_legend(area, (left + LEFT) as i32)?;
        draw_scale(area, ((left + LEFT + width + 40) as i32, height as i32), &levels, &unit.label)?;

        let frame = area.clone().shrink((left, ABOVE), (LEFT + width, height + BELOW));
        let (low, high) = (y_range.start / y.unit, y_range.end / y.unit);
        let mut axes = ChartBuilder::on(&frame).x_label_area_size(BELOW).y_label_area_size(LEFT).build_cartesian_2d(
            x_range.start / x.unit..x_range.end / x.unit,
            if self.downwards { high..low } else { low..high },
        )?;
        let at = |point: (f64, f64)| (point.0 / x.unit, point.1 / y.unit);
        let path = |line: Vec<(f64, f64)>| line.into_iter().map(at).collect::<Vec<_>>();
        let pixel = (x_range.end - x_range.start) * (y_range.end - y_range.start) / f64::from(width * height);
        for (outline, colour) in levels.fills(&grid, unit.unit, 0.5 * pixel) {
            axes.draw_series([Polygon::new(outline.points().map(at).collect::<Vec<_>>(), colour.filled())])?;
        }
        for outline in levels.lined().flat_map(|value| grid.outlines(value * unit.unit)) {
            for line in outline.lines() {
                axes.draw_series([PathElement::new(path(line), BLACK.mix(0.4))])?;
            }
        }
        for line in self.edge_lines(&x_range, &y_range) {
            let line = path(line);
            axes.draw_series([PathElement::new(line.clone(), WHITE.mix(0.6).stroke_width(5))])?;
            axes.draw_series([DashedPathElement::new(line, 12, 8, BLACK.stroke_width(3))])?;
        }
        axes.configure_mesh()
            .disable_mesh()
            .x_desc(&x.label)
            .y_desc(&y.label)
            .x_label_formatter(&tick)
            .y_label_formatter(&tick)
            .label_style(("sans-serif", 24))
            .axis_desc_style(("sans-serif", 28))
            .draw()?;
        for place in self.largest.iter().flat_map(|peak| &peak.places).map(|place| at(*place)) {
            axes.draw_series([Circle::new(place, 11, WHITE.stroke_width(7))])?;
            axes.draw_series([Circle::new(place, 11, BLACK.stroke_width(3))])?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::Drawing;
    use super::super::draw::pixels;
    use super::*;

    const COUNT: usize = 31;

    /// A section of a function over [-1.5, 1.5] x [0, 1.5] µm, in MPa.
    fn section(of: impl Fn(f64, f64) -> f64) -> Section {
        let axis = |from: f64, to: f64| -> Vec<f64> {
            (0..COUNT).map(|index| 1e-6 * (from + (to - from) * index as f64 / (COUNT - 1) as f64)).collect()
        };
        let (x, y) = (axis(-1.5, 1.5), axis(0.0, 1.5));
        let of = &of;
        let values = x.iter().flat_map(|x| y.iter().map(move |y| 1e6 * of(1e6 * x, 1e6 * y))).collect();
        let metres = |name| Axis { name, unit: Some("m") };
        Section {
            title: "Crossland".to_owned(),
            x: (metres("x, along the motion"), x),
            y: (metres("z, the depth"), y),
            downwards: true,
            values: (Axis { name: "crossland", unit: Some("Pa") }, values),
            largest: None,
            edge: None,
        }
    }

    /// Two hills with a saddle between them, a hollow, and a place without a value.
    fn landscape(x: f64, y: f64) -> f64 {
        let hill = |at: f64, height: f64| height * (-6.0 * ((x - at).powi(2) + (y - 0.3).powi(2))).exp();
        let hollow = -1.5 * (-9.0 * (x.powi(2) + (y - 1.0).powi(2))).exp();
        if (x - 1.0).abs() < 0.01 && (y - 1.0).abs() < 0.01 {
            f64::NAN
        } else {
            hill(-0.7, 3.0) + hill(0.7, 2.0) + hollow
        }
    }

    /// The landscape with changes, as SVG.
    fn svg_of(change: impl FnOnce(&mut Section)) -> String {
        let mut section = section(landscape);
        change(&mut section);
        String::from_utf8(Drawing::Section(section).svg().unwrap()).unwrap()
    }

    #[test]
    fn each_pixel_has_the_colour_of_the_value_there() {
        let section = section(landscape);
        let (width, height) = section.extent_in_pixels();
        let left = (SIZE.0 - LEFT - width - SCALE) / 2 + LEFT;
        let range = extent(section.values.1.iter().map(|value| value / 1e6));
        let drawn = pixels(&Drawing::Section(section), &|| true).unwrap();
        let levels = Levels::of(range);
        let fine = levels.step / SHADES as f64;
        let (mut blank, mut wrong, mut looked) = (0, 0, 0);
        for column in (3..width - 3).step_by(7) {
            for row in (3..height - 3).step_by(5) {
                let at = 3 * ((ABOVE + row) * SIZE.0 + left + column) as usize;
                let colour = (drawn[at], drawn[at + 1], drawn[at + 2]);
                let x = -1.5 + 3.0 * f64::from(column) / f64::from(width);
                let y = 1.5 * f64::from(row) / f64::from(height);
                let missing = (x - 1.0).abs() < 0.095 && (y - 1.0).abs() < 0.045;
                let beside = (x - 1.0).abs() < 0.105 && (y - 1.0).abs() < 0.055;
                if missing {
                    assert_eq!(colour, (255, 255, 255), "{x} {y}");
                    blank += 1;
                } else if !beside {
                    looked += 1;
                    // Within two shades, or on a line, which is half as bright at most.
                    let index = (landscape(x, y) / fine).floor();
                    let near = (-2..=2).map(|off| levels.colour((index + f64::from(off)) * fine));
                    let is_near = |one: RGBColor| {
                        [(colour.0, one.0), (colour.1, one.1), (colour.2, one.2)]
                            .iter()
                            .all(|(a, b)| a.abs_diff(*b) <= 6)
                    };
                    let dark = near.clone().any(|one| {
                        [(colour.0, one.0), (colour.1, one.1), (colour.2, one.2)].iter().all(|(a, b)| a <= b)
                    });
                    assert!(near.clone().any(is_near) || dark, "{x} {y}: {colour:?}");
                    wrong += usize::from(!near.clone().any(is_near));
                }
            }
        }
        assert!(blank > 5 && looked > 5000, "{blank} {looked}");
        assert!(wrong * 20 < looked, "{wrong} of {looked} are on lines");
    }

    #[test]
    fn the_largest_value_and_the_edge_of_the_contact_are_where_they_belong() {
        let (width, height) = section(landscape).extent_in_pixels();
        assert!(width.abs_diff(2 * height) < 3, "both coordinates have the same scale");
        let left = (SIZE.0 - LEFT - width - SCALE) / 2 + LEFT;
        let svg = svg_of(|section| {
            section.largest = Some(Peak { value: 3.0e6, places: vec![(-0.75e-6, 0.375e-6)] });
            section.edge = Some(ContactEdge { radius: 1e-6, offset: Some(0.0), name: "edge" });
        });
        assert!(svg.contains("Crossland: largest 3 MPa at x = -0.75 µm, z = 0.375 µm"), "{svg:.900}");
        assert!(svg.contains("crossland / MPa"));
        let number = |text: &str, name: &str| -> u32 {
            let from = text.split(&format!(" {name}=\"")).nth(1).unwrap();
            from.split('"').next().unwrap().parse().unwrap()
        };
        let is_mark = |circle: &&str| {
            number(circle, "cx").abs_diff(left + width / 4) < 2 && number(circle, "cy").abs_diff(ABOVE + height / 4) < 2
        };
        assert_eq!(svg.split("<circle").skip(1).filter(is_mark).count(), 2, "a ring on a halo");
        for x in [left + width / 6, left + width * 5 / 6] {
            let beside = |x: u32| svg.contains(&format!("points=\"{x},{ABOVE} {x},"));
            assert!((x - 2..=x + 2).any(beside), "{x}");
        }
        // Beyond the picture there is nothing to mark.
        let svg = svg_of(|section| {
            section.largest = Some(Peak { value: 3.0e6, places: Vec::new() });
            section.edge = Some(ContactEdge { radius: 1e-6, offset: Some(1.1e-6), name: "edge" });
        });
        assert!(svg.contains("largest 3 MPa off this picture") && !svg.contains("<circle"));
    }

    #[test]
    fn a_squared_unit_has_a_power_of_ten_for_a_prefix() {
        let svg = svg_of(|section| {
            section.values.0.unit = Some("N²/m³");
            section.largest = Some(Peak { value: 3.0e6, places: Vec::new() });
        });
        for text in ["crossland / (10⁶ N²/m³)", "largest 3 · 10⁶ N²/m³"] {
            assert!(svg.contains(text), "{svg:.900}");
        }
    }
}
