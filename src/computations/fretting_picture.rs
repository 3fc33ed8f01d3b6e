//! The picture of one fatigue criterion: a map over a grid of places, or a curve over a line.

use stickslip_mechanics::subsurface::Side;
use stickslip_report::plot::{Axis, Band, Colour, ContactEdge, Curve, Drawing, Panel, Peak, Plot, Section, on_axis};
use stickslip_wire::fretting::FrettingTask;
use stickslip_wire::subsurface::{Places, SubsurfaceLine};
use stickslip_wire::{Fault, FrettingReply, Largest};

use super::Shown;
use super::subsurface::over_plane;

/// The criteria by their names in the reply, in its order.
pub const NAMES: [&str; 8] =
    ["crossland", "dang_van", "findley", "swt", "fatemi_socie", "ruiz", "ruiz_tension", "friction_work"];
/// What a picture calls them.
const TITLES: [&str; 8] = [
    "Crossland",
    "Dang Van",
    "Findley",
    "Smith-Watson-Topper",
    "Fatemi-Socie",
    "Ruiz, shear stress times slip",
    "Ruiz, with tension",
    "Friction work per cycle",
];
const EDGE: &str = "edge of the contact at the preload";
/// A place is in a plane to this part of its distance from the origin.
const SAME_PLANE: f64 = 1e-9;

/// Why some places have no picture.
const NO_PICTURE: &str = "places without an order have no picture: ask for a `plane`, the `surface` or a `line`";

/// The criterion that a picture shows: the one that the query names, or the only one that the request asks for. `None`
/// in a format that shows all.
///
/// # Errors
/// The [`Fault`] of one that is not asked for, for several without a name, and for places that have no picture.
pub fn criterion(task: &FrettingTask, shown: &Shown) -> Result<Option<usize>, Fault> {
    let (named, format) = (shown.choice, shown.format);
    let [ruiz, work] = [task.ruiz.is_some(), task.friction_work.is_some()];
    let asked: Vec<bool> = task.criteria.iter().map(Option::is_some).chain([ruiz, ruiz, work]).collect();
    let names = || (0..NAMES.len()).filter(|index| asked[*index]);
    let list = || names().map(|index| format!("`{}`", NAMES[index])).collect::<Vec<_>>().join(", ");
    let fault = |pointer: &str, detail: String| Err(Fault { pointer: pointer.to_owned(), detail });
    let refused = |detail: String| fault("/criterion", detail);
    let chosen = match named {
        Some(name) => match names().find(|index| NAMES[*index] == name) {
            Some(index) => index,
            None => return refused(format!("`{name}` is not asked for in `criteria`: choose one of {}", list())),
        },
        None if !format.is_plot() => return Ok(None),
        // Ruiz's second parameter comes with the first.
        None => match (names().filter(|index| NAMES[*index] != "ruiz_tension").collect::<Vec<_>>())[..] {
            [only] => only,
            _ => return refused(format!("a picture is of one criterion: choose one of {}", list())),
        },
    };
    match &task.places {
        _ if !format.is_plot() => Ok(None),
        Places::Grid(_) | Places::Line(_) => Ok(Some(chosen)),
        Places::Points(_) => fault("/points", NO_PICTURE.to_owned()),
    }
}

/// The picture of the criterion that [`criterion`] has found.
#[must_use]
pub fn plot(reply: &FrettingReply, task: &FrettingTask, index: usize) -> Drawing {
    let found = reply.ratings().find(|(name, ..)| *name == NAMES[index]);
    let (unit, values, largest) = match &found {
        Some((_, unit, rating)) => (*unit, &rating.values[..], rating.largest.as_ref()),
        None => Default::default(),
    };
    let body = match task.body.0 {
        Side::First => "first",
        Side::Second => "second",
    };
    let name = TITLES[index];
    let title = format!("{name}, {body} body");
    let radius = reply.contact.contact_radius;
    match &task.places {
        Places::Line(line) => Drawing::Plot(over_line(title, (name, unit), values, largest, (line, radius))),
        places => {
            let section = over_plane(title, (name, unit), values, places);
            let [x, y, z] = places.axes().unwrap_or_default();
            // The two coordinates of the picture and the one that is constant.
            let [first, second, constant] = if y.len() == 1 {
                [0, 2, 1]
            } else if z.len() == 1 {
                [0, 1, 2]
            } else {
                [1, 2, 0]
            };
            let offset = [&x, &y, &z][constant].first().copied().unwrap_or_default();
            let is_shown = |point: &[f64; 3]| {
                let within = |values: &[f64], value: f64| {
                    values.first().is_some_and(|low| value >= *low) && values.last().is_some_and(|high| value <= *high)
                };
                let size = point.iter().fold(offset.abs(), |size, part| size.max(part.abs()));
                (point[constant] - offset).abs() <= SAME_PLANE * size
                    && within(&section.x.1, point[first])
                    && within(&section.y.1, point[second])
            };
            let peak = |largest: &Largest| {
                let shown = Some(largest.point).filter(is_shown);
                Peak {
                    value: largest.value,
                    places: shown.map(|point| (point[first], point[second])).into_iter().collect(),
                }
            };
            let largest = largest.map(peak);
            let edge = ContactEdge { radius, offset: (constant != 2).then_some(offset), name: EDGE };
            Drawing::Section(Section { largest, edge: Some(edge), ..section })
        }
    }
}

/// One criterion over a line, with the part of it that lies on the contact.
fn over_line(
    title: String,
    (name, unit): (&'static str, &'static str),
    values: &[Option<f64>],
    largest: Option<&Largest>,
    (line, radius): (&SubsurfaceLine, f64),
) -> Plot {
    let change: [f64; 3] = std::array::from_fn(|axis| line.to[axis] - line.from[axis]);
    let length = change.iter().fold(0.0, |length: f64, part| length.hypot(*part));
    // Along one axis the coordinate itself says where, else the distance from the beginning.
    let moving: Vec<usize> = (0..3).filter(|axis| change[*axis].abs() > 0.0).collect();
    let (x, from, scale) = match moving[..] {
        [axis] => {
            (["x, along the motion", "y, across the motion", "z, the depth"][axis], line.from[axis], change[axis])
        }
        _ => ("distance along the line", 0.0, length),
    };
    let at = |point: [f64; 3]| {
        let along: f64 = (0..3).map(|axis| (point[axis] - line.from[axis]) * change[axis]).sum();
        from + scale * along / (length * length)
    };
    let part = |index: usize| index as f64 / values.len().saturating_sub(1).max(1) as f64;
    let finite = || values.iter().flatten().copied();
    let curve = values.iter().enumerate().map(|(index, value)| (from + scale * part(index), value.unwrap_or(f64::NAN)));
    let mut curves = vec![Curve { name: "", points: curve.collect(), colour: Colour::Blue, silent: true, dots: false }];
    let axis = || Axis { name, unit: Some(unit).filter(|unit| *unit != "1") };
    let mut heading = title;
    if let Some(Largest { value, point, .. }) = largest {
        heading = format!("{heading}: largest {}", on_axis(*value, &axis(), finite()));
        let points = vec![(at(*point), *value)];
        curves.push(Curve { name: "largest value", points, colour: Colour::Red, silent: false, dots: false });
    }
    Plot {
        title: heading,
        x: Axis { name: x, unit: Some("m") },
        panels: vec![Panel { y: axis(), curves }],
        bands: on_contact(line, change, radius)
            .map(|[one, other]| [from + scale * one, from + scale * other])
            .map(|ends| Band {
                name: "on the contact at the preload",
                from: ends[0].min(ends[1]),
                to: ends[0].max(ends[1]),
                colour: Colour::Grey,
            })
            .into_iter()
            .collect(),
    }
}

/// Between which parts of a line in the surface, 0 to 1, it lies on a contact of this radius, m.
fn on_contact(line: &SubsurfaceLine, change: [f64; 3], radius: f64) -> Option<[f64; 2]> {
    if line.from[2] > 0.0 || line.to[2] > 0.0 {
        return None;
    }
    // |from + part · change|² = a², over the length of the change squared.
    let square = change[0] * change[0] + change[1] * change[1];
    let middle = -(line.from[0] * change[0] + line.from[1] * change[1]) / square;
    let distance = (line.from[0] * line.from[0] + line.from[1] * line.from[1] - radius * radius) / square;
    let half = (middle * middle - distance).max(0.0).sqrt();
    let [from, to] = [middle - half, middle + half].map(|part| part.clamp(0.0, 1.0));
    (from < to).then_some([from, to])
}

#[cfg(test)]
mod tests {
    use super::{NAMES, SubsurfaceLine, on_contact};

    #[test]
    fn a_line_lies_on_the_contact_within_its_radius() {
        let line = |from: [f64; 3], to: [f64; 3]| {
            let change = std::array::from_fn(|axis| to[axis] - from[axis]);
            on_contact(&SubsurfaceLine { from, to, count: 2 }, change, 1.0)
        };
        let close = |found: Option<[f64; 2]>, expected: [f64; 2]| {
            let found = found.unwrap();
            assert!((found[0] - expected[0]).abs() < 1e-12 && (found[1] - expected[1]).abs() < 1e-12, "{found:?}");
        };
        close(line([-2.0, 0.0, 0.0], [2.0, 0.0, 0.0]), [0.25, 0.75]);
        close(line([0.6, 0.0, 0.0], [0.6, 1.0, 0.0]), [0.0, 0.8]);
        assert_eq!(line([-2.0, 2.0, 0.0], [2.0, 2.0, 0.0]), None);
        assert_eq!(line([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]), None);
        assert_eq!(NAMES.len(), super::TITLES.len());
    }
}
