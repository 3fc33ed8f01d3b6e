//! Warnings about the largest value of a fatigue criterion, and about a cycle.

use stickslip_mechanics::fatigue::{Criterion, Measure, Ratings, Worst};
use stickslip_mechanics::{Move, in_unit};
use stickslip_wire::FrettingReply;
use stickslip_wire::fretting::{AskedMeasure, FrettingTask};
use stickslip_wire::subsurface::Places;

use super::picture::NAMES;
use crate::computations::prelude::*;
use crate::simulation::MAX_SLOPE;

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
            warnings.push(Warning::new(code, format!("{}{why}", found.join(", "))));
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
            ": the largest stresses are near the contact; are the places in m?",
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
        "life_scatter",
        of_each(&|index, name, _| reply.ratings().nth(index)?.2.life.map(|_| format!("life by {name}"))),
        ": tested lives scatter about such a curve by a factor of three and more, and a small error of the friction or \
         the load changes them by as much; `shortest` and `longest` cover only the stated error of the value",
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

/// Displacement of a cycle from end to end, in contact radii, beyond which it slides rather than frets.
const MAX_TRAVEL: f64 = 20.0;
/// Stress over the reduced modulus beyond which strains are not small.
const MAX_STRAIN: f64 = 0.1;
/// The largest pressure over the reduced modulus, which for a parabola is 2/pi of the slope at the edge.
const MAX_PRESSURE: f64 = 0.2;
/// A stress below this, Pa, was probably given in MPa.
const LEAST_STRESS: f64 = 1e3;

/// The warnings for a cycle that is beyond the model of fretting fatigue, by the contact at its preload and the moves
/// of the cycle, which are made once more, roughly, while `keep_going` returns true.
pub(super) fn beyond_model(
    contact: &Contact,
    moves: &[Move],
    task: &FrettingTask,
    keep_going: &dyn Fn() -> bool,
) -> Vec<Warning> {
    const TOLERANCE: f64 = 1e-2;
    let mut moving = contact.clone();
    let (mut radius, mut pressure) = (contact.contact_radius(), contact.summary().max_pressure);
    let (mut low, mut high) = (0.0_f64, 0.0_f64);
    for step in moves {
        // A cycle without an answer is refused elsewhere.
        if moving.apply_while(step, TOLERANCE, keep_going).is_err() {
            break;
        }
        let displacement = moving.displacement();
        (low, high) = (low.min(displacement), high.max(displacement));
        if moving.contact_radius() > radius {
            (radius, pressure) = (moving.contact_radius(), moving.summary().max_pressure);
        }
    }
    let e_star = contact.elasticity().e_star();
    let mut messages = Vec::new();
    let slope = contact.profile().surface_slope(radius);
    if radius > 0.0 && slope > MAX_SLOPE {
        messages.push(format!(
            "the surface has a slope of {slope:.3} at the edge of the contact, {} from its axis: beyond {MAX_SLOPE} a \
             body is no longer a half-space",
            in_unit(radius, "m")
        ));
    }
    if high - low > MAX_TRAVEL * radius {
        messages.push(format!(
            "the cycle is {} long, over {MAX_TRAVEL} contact radii of {}: that is sliding rather than fretting, and no \
             place stays under the contact",
            in_unit(high - low, "m"),
            in_unit(radius, "m")
        ));
    }
    let e_star_shown = in_unit(e_star, "Pa");
    if let Some(pressure) = pressure.filter(|pressure| *pressure > MAX_PRESSURE * e_star) {
        let pressure = in_unit(pressure, "Pa");
        messages.push(format!("the largest pressure is {pressure} with E* = {e_star_shown}: strains are not small"));
    }
    let bulk = task.bulk.map_or(0.0, |bulk| bulk.mean.abs() + bulk.amplitude.abs());
    if bulk > MAX_STRAIN * e_star {
        let bulk = in_unit(bulk, "Pa");
        messages.push(format!("the bulk stress reaches {bulk} with E* = {e_star_shown}: is it in Pa?"));
    }
    if bulk > 0.0 && bulk < LEAST_STRESS {
        messages.push(format!("the bulk stress reaches {} alone: is it in Pa, rather than MPa?", in_unit(bulk, "Pa")));
    }
    for (name, asked) in NAMES.into_iter().zip(task.measures) {
        let Some(AskedMeasure { measure: Measure::Stress(criterion), limit: Some(limit), .. }) = asked else {
            continue;
        };
        if matches!(criterion, Criterion::FatemiSocie { .. }) {
            // A strain.
            continue;
        }
        if limit < LEAST_STRESS {
            messages.push(format!("the limit of {name} is {}: is it in Pa, rather than MPa?", in_unit(limit, "Pa")));
        } else if limit > MAX_STRAIN * e_star {
            let limit = in_unit(limit, "Pa");
            messages.push(format!("the limit of {name} is {limit} with E* = {e_star_shown}: is it in Pa?"));
        }
    }
    messages.into_iter().map(|message| Warning::new("beyond_model", message)).collect()
}
