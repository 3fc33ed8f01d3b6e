//! The picture of one fatigue criterion: a map over a grid of places, or a curve over a line.

use stickslip_plot::{Band, ContactEdge, Peak, Section, on_axis};
use stickslip_wire::fretting::{CRITERIA, FrettingTask};
use stickslip_wire::subsurface::{Places, SubsurfaceLine};
use stickslip_wire::{BodyName, FrettingReply, Largest};

use crate::computations::prelude::*;
use crate::computations::subsurface::{COORDINATES, over_plane, shown_axes};

/// The criteria by their names in the reply, in its order.
pub const NAMES: [&str; CRITERIA.len()] = {
    let mut names = [""; CRITERIA.len()];
    let mut index = 0;
    while index < names.len() {
        names[index] = CRITERIA[index].0;
        index += 1;
    }
    names
};
const EDGE: &str = "edge of the contact at the preload";
/// A place is in a plane to this part of its distance from the origin.
const SAME_PLANE: f64 = 1e-9;

/// Why some places have no picture.
const NO_PICTURE: &str = "a list of points has no picture: ask for a `plane`, the `surface` or a `line`";

/// The name of the criterion that a picture shows: the one that the query names, or the only one that the request asks
/// for. `None` in a format that shows all.
///
/// # Errors
/// The [`Fault`] of one that is not asked for, for several without a name, and for places that have no picture.
pub fn criterion(task: &FrettingTask, shown: &DisplayOptions) -> Result<Option<&'static str>, Fault> {
    let is_plot = shown.format.is_plot();
    let asked = NAMES.into_iter().zip(task.measures).filter_map(|(name, asked)| asked.map(|_| name));
    let asked: Vec<&'static str> = asked.collect();
    let refused = |problem: &str| {
        let names = asked.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        Fault::new("/criterion", format!("{problem}: choose one of {names}"))
    };
    // Ruiz's second parameter comes with the first.
    let mut named = asked.iter().copied().filter(|name| *name != "ruiz_tension");
    let chosen = match (shown.choice, named.next(), named.next()) {
        (Some(name), ..) if asked.contains(&name) => name,
        (Some(name), ..) => return Err(refused(&format!("`{name}` is not asked for in `criteria`"))),
        (None, ..) if !is_plot => return Ok(None),
        (None, Some(only), None) => only,
        (None, ..) => return Err(refused("a picture shows one criterion")),
    };
    match &task.places {
        Places::Points(_) if is_plot => Err(Fault::new("/points", NO_PICTURE.to_owned())),
        _ => Ok(Some(chosen).filter(|_| is_plot)),
    }
}

/// The picture of the criterion that [`criterion`] has found.
pub fn plot(reply: &FrettingReply, task: &FrettingTask, criterion: &str) -> Drawing {
    let found = reply.ratings().find(|(name, ..)| *name == criterion);
    let (unit, values, largest) = match &found {
        Some((_, unit, rating)) => (*unit, &rating.values[..], rating.largest.as_ref()),
        None => Default::default(),
    };
    let body = BodyName::from(task.body.0).name();
    let name = CRITERIA.into_iter().find(|(name, ..)| *name == criterion).map_or("", |(.., title)| title);
    let title = format!("{name}, {body} body");
    let radius = reply.contact.contact_radius;
    if let Places::Line(line) = &task.places {
        return Drawing::Plot(over_line(title, Axis::of(name, unit), values, largest, (line, radius)));
    }
    let section = over_plane(title, Axis::of(name, unit), values, &task.places);
    let axes = task.places.axes().unwrap_or_default();
    let [first, second, constant] = shown_axes(&axes);
    let offset = axes[constant].first().copied().unwrap_or_default();
    let is_shown = |point: &[f64; 3]| {
        let within = |values: &[f64], value: f64| {
            values.first().is_some_and(|low| value >= *low) && values.last().is_some_and(|high| value <= *high)
        };
        let size = point.iter().fold(offset.abs(), |size, part| size.max(part.abs()));
        (point[constant] - offset).abs() <= SAME_PLANE * size
            && within(&axes[first], point[first])
            && within(&axes[second], point[second])
    };
    let largest = largest.map(|largest| {
        let shown = Some(largest.point).filter(is_shown);
        Peak { value: largest.value, places: shown.map(|point| (point[first], point[second])).into_iter().collect() }
    });
    let edge = ContactEdge { radius, offset: (constant != 2).then_some(offset), name: EDGE };
    Drawing::Section(Section { largest, edge: Some(edge), ..section })
}

/// One criterion over a line, with the part of it that lies on the contact.
fn over_line(
    mut title: String,
    y: Axis,
    values: &[Option<f64>],
    largest: Option<&Largest>,
    (line, radius): (&SubsurfaceLine, f64),
) -> Plot {
    let change: [f64; 3] = std::array::from_fn(|axis| line.to[axis] - line.from[axis]);
    let length = change.iter().fold(0.0, |length: f64, part| length.hypot(*part));
    // Along one axis the coordinate itself says where, else the distance from the beginning.
    let moving: Vec<usize> = (0..3).filter(|axis| change[*axis].abs() > 0.0).collect();
    let (x, from, scale) = match moving[..] {
        [axis] => (COORDINATES[axis], line.from[axis], change[axis]),
        _ => ("distance along the line", 0.0, length),
    };
    let at = |point: [f64; 3]| {
        let along: f64 = (0..3).map(|axis| (point[axis] - line.from[axis]) * change[axis]).sum();
        from + scale * along / (length * length)
    };
    let part = |index: usize| index as f64 / values.len().saturating_sub(1).max(1) as f64;
    let curve = values.iter().enumerate().map(|(index, value)| (from + scale * part(index), value.unwrap_or(f64::NAN)));
    let mut curves = vec![Curve::line("", Colour::Blue, curve)];
    if let Some(Largest { value, point, .. }) = largest {
        title = format!("{title}: largest {}", on_axis(*value, &y, values.iter().flatten().copied()));
        curves.push(Curve::line("largest value", Colour::Red, [(at(*point), *value)]));
    }
    let band = on_contact(line, change, radius).map(|ends| {
        let [one, other] = ends.map(|end| from + scale * end);
        let name = "on the contact at the preload";
        Band { name, from: one.min(other), to: one.max(other), colour: Colour::Grey }
    });
    Plot { bands: band.into_iter().collect(), ..Plot::new(title, Axis::of(x, "m"), vec![Panel { y, curves }]) }
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
    use super::{SubsurfaceLine, on_contact};

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
    }
}
