//! What to know about the largest value of a fatigue criterion before it is trusted.

use stickslip_mechanics::fatigue::{Ratings, Worst};
use stickslip_report::plot::in_unit;
use stickslip_wire::fretting::FrettingTask;
use stickslip_wire::subsurface::Places;
use stickslip_wire::{FrettingReply, Warning};

/// Places farther than this from the centre of the contact, in contact radii, miss it.
const REACH: f64 = 2.0;

/// What a reply was made of.
pub(super) struct Rated<'a> {
    pub(super) task: &'a FrettingTask,
    pub(super) ratings: &'a Ratings,
    pub(super) places: &'a [[f64; 3]],
    /// For each criterion a place off the grid where it is larger.
    pub(super) off_grid: Vec<Option<Worst>>,
    /// The largest contact radius, m.
    pub(super) radius: f64,
}

/// The warnings about where the largest values lie, or do not.
pub(super) fn fretting_warnings(reply: &FrettingReply, rated: &Rated<'_>) -> Vec<Warning> {
    let named: Vec<(&str, &str)> = reply.ratings().map(|(name, unit, _)| (name, unit)).collect();
    let largest = &rated.ratings.largest;
    let mut warnings = Vec::new();
    let mut warn = |code: &str, found: Vec<String>, why: &str| {
        if !found.is_empty() {
            let message = format!("{}{why}", found.join(", "));
            warnings.push(Warning { code: code.to_owned(), message });
        }
    };
    let of_each = |text: &dyn Fn(usize, &str, &str) -> Option<String>| -> Vec<String> {
        named.iter().enumerate().filter_map(|(index, (name, unit))| text(index, name, unit)).collect()
    };
    warn(
        "unbounded_stress",
        of_each(&|index, name, _| {
            let column = rated.ratings.values[index].iter();
            let (place, _) = column.enumerate().find(|(_, value)| **value == f64::INFINITY)?;
            Some(format!("{name} is infinite at {}", shown(rated.places[place])))
        }),
        ": under a tip or an edge the stress of the model has no bound; there is no largest value and no margin",
    );
    warn(
        "no_positive_value",
        of_each(&|index, name, unit| {
            let value = largest[index].map(|most| most.rated.value).filter(|value| *value <= 0.0)?;
            Some(format!("{name} is nowhere above zero (its largest value is {})", in_unit(value, unit)))
        }),
        ": compression outweighs the shear stress, or nothing slips; there is no margin to a limit",
    );
    let outside = |place: &[f64; 3]| place[0].hypot(place[1]).hypot(place[2]) > REACH * rated.radius;
    if !rated.places.is_empty() && rated.radius > 0.0 && rated.places.iter().all(outside) {
        let radius = in_unit(rated.radius, "m");
        warn(
            "grid_outside_contact",
            vec![format!(
                "all places are farther than {REACH} contact radii ({radius}) from the centre of the contact"
            )],
            ": the largest stresses are near it; are the places in m?",
        );
    }
    warn(
        "grid_rim",
        of_each(&|index, name, _| {
            let place = largest[index].filter(|most| most.rated.value > 0.0)?.place;
            let on_rim = !rated.task.searches() && on_rim(&rated.task.places, place);
            on_rim.then(|| format!("{name} at {}", shown(rated.places[place])))
        }),
        ": the largest value lies on the rim of the places asked for, and may be larger beyond it",
    );
    warn(
        "grid_misses_largest",
        of_each(&|index, name, unit| {
            let worst = rated.off_grid.get(index).copied().flatten()?;
            let value =
                if worst.rated.value.is_finite() { in_unit(worst.rated.value, unit) } else { "infinite".into() };
            Some(format!("{name} is {value} at {}", shown(worst.place)))
        }),
        ": larger than at all places asked for; leave the places out to search the body",
    );
    warnings
}

fn shown(place: [f64; 3]) -> String {
    let [x, y, z] = place.map(|part| in_unit(part, "m"));
    format!("({x}, {y}, {z})")
}

/// Whether a place is on the rim of a grid or at an end of a line: the surface of the body and the plane of symmetry
/// are none.
fn on_rim(places: &Places, place: usize) -> bool {
    let at = places.at(place);
    match places {
        Places::Points(_) => false,
        Places::Line(line) => (place == 0 || place + 1 == line.count) && at[2] > 0.0,
        Places::Grid(steps) => steps.iter().enumerate().any(|(axis, steps)| {
            let is_end = |index| (at[axis] - steps.at(index)).abs() <= 0.0;
            steps.count > 1 && (is_end(0) || is_end(steps.count - 1)) && (axis == 0 || at[axis] != 0.0)
        }),
    }
}
