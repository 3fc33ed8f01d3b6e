//! Fatigue criteria over the steady cycle of a contact: at given places, or at the worst of the body.

use stickslip_mechanics::fatigue::{self, Cycle, Largest, Rated, Ratings, Study};
use stickslip_mechanics::{Error, Stress};
use stickslip_wire::fretting::{self as wire, AskedMeasure, FrettingTask};
use stickslip_wire::{BelowSurface, FrettingReply, Rating, StressPath};

use super::warnings::{self, beyond_model, fretting_warnings};
use crate::computations::prelude::*;
use crate::simulation::{bulk_warning, cycle_moves};

/// Places of infinite stress below which a criterion is evaluated.
const MOST_INFINITE: usize = 16;
const REASON: &str = "the cycle follows from the exact slip history, and the stress from that without a mesh";

/// The criteria over the steady cycle of a contact.
///
/// # Errors
/// [`Failure`] for a preload that cannot be reached, a move without an answer, a path that does not close or a cycle
/// that is too large, or if the work was ended.
pub fn rate(setup: SharedSetup, task: &FrettingTask, stop: &dyn Stop) -> Result<FrettingReply, Failure> {
    let timer = Timer::start(stop);
    let contact = contact(setup, "/contact")?;
    let moves = cycle_moves(&task.plan, &contact)?;
    let refused = |error| refused(error, stop);
    let go_on = || stop.check().is_ok();
    let cycle = Cycle::new(&contact, &moves, &go_on).map_err(refused)?;
    let asked: Vec<_> = task.measures.iter().flatten().map(|asked| asked.measure).collect();
    let study = Study::new(&cycle, task.body, task.bulk, asked, task.tolerance, &go_on);
    let mut study = study.map_err(refused)?;

    let mut places: Vec<[f64; 3]> = (0..task.places.count()).map(|index| task.places.at(index)).collect();
    let (ratings, off_grid, worst) = if task.searches() {
        let worst = study.worst().map_err(refused)?;
        places = worst.iter().map(|worst| worst.place).collect();
        let mut ratings = study.rate_all(&places).map_err(refused)?;
        for (largest, worst) in ratings.largest.iter_mut().zip(&worst) {
            *largest = largest.filter(|_| worst.rated.value.is_finite());
            if let Some(Largest { rated, .. }) = largest {
                rated.error = rated.error.max(worst.rated.error);
            }
        }
        (ratings, Vec::new(), worst)
    } else {
        let ratings = study.rate_all(&places).map_err(refused)?;
        let known: Vec<f64> =
            ratings.largest.iter().map(|most| most.map_or(f64::NEG_INFINITY, |most| most.rated.value)).collect();
        let larger = study.larger(&known).map_err(refused)?;
        (ratings, larger, Vec::new())
    };
    let Ratings { values, largest, instants } = &ratings;
    let change = largest.iter().flatten().map(|most| relative(most.rated.error, most.rated.value)).fold(0.0, f64::max);

    let mut below_surface = |index: usize| {
        let Some(distance) = task.critical_distance else { return Ok(None) };
        let points = match worst.get(index) {
            Some(worst) if worst.place[2] <= 0.0 && worst.rated.value.is_finite() => vec![worst.place],
            Some(_) => study.worst_of_surface(index)?,
            None => worst_on_surface(&places, &values[index]),
        };
        let mut most: Option<([f64; 3], Rated)> = None;
        for point in points {
            let rated = study.rate_below(index, point, distance)?;
            if rated.value.is_finite() && most.is_none_or(|most| rated.value > most.1.value) {
                most = Some((point, rated));
            }
        }
        Ok(most)
    };
    let below: Vec<_> = (0..values.len()).map(&mut below_surface).collect::<Result<_, _>>().map_err(refused)?;

    let mut found = values.iter().zip(largest).zip(below);
    let rating = |asked: Option<AskedMeasure>| {
        let (AskedMeasure { limit, life, .. }, ((values, most), below)) = (asked?, found.next()?);
        // What nowhere rises above zero, or has no bound, has no distance to its limit.
        let bounded = values.iter().all(|value| *value < f64::INFINITY || value.is_nan());
        let rated = most.map(|most| most.rated.value).filter(|value| *value > 0.0 && bounded);
        let margin = limit.zip(rated).and_then(|(limit, value)| finite(limit / value));
        let largest = most.map(|Largest { place, rated }| wire::Largest {
            value: rated.value,
            error: rated.error,
            point: places[place],
            plane: rated.plane,
            at: rated.at.map(wire::Instant::from),
        });
        let of_largest =
            most.filter(|_| bounded).map_or([f64::INFINITY, 0.0], |most| [most.rated.value, most.rated.error]);
        let life_of = |[value, error]: [f64; 2]| life.map(|curve| curve.life(value, error).into());
        Some(Rating {
            values: values.iter().map(|value| finite(*value)).collect(),
            largest,
            margin,
            life: life_of(of_largest),
            cycles: life.map(|curve| values.iter().map(|value| curve.cycles(*value).ok()).collect()),
            critical_distance: below.map(|(point, rated)| BelowSurface {
                value: rated.value,
                error: rated.error,
                point,
                plane: rated.plane,
                at: rated.at.map(wire::Instant::from),
                margin: limit.filter(|_| rated.value > 0.0).and_then(|limit| finite(limit / rated.value)),
                life: life_of([rated.value, rated.error]),
            }),
        })
    };
    let [crossland, dang_van, findley, swt, fatemi_socie, ruiz, ruiz_tension, friction_work] =
        task.measures.map(rating);
    let path = |place: &usize| study.path(&places[*place]).map(|path| stress_path(*place, &path)).map_err(refused);
    let stress_paths: Vec<StressPath> = task.stress_paths.iter().map(path).collect::<Result<_, _>>()?;
    let field = cycle.start().subsurface(task.body.0, task.body.1).map_err(refused)?;
    let mut reply = FrettingReply {
        x: places.iter().map(|place| place[0]).collect(),
        y: places.iter().map(|place| place[1]).collect(),
        z: places.iter().map(|place| place[2]).collect(),
        crossland,
        dang_van,
        findley,
        swt,
        fatemi_socie,
        ruiz,
        ruiz_tension,
        friction_work,
        stress_paths: (!stress_paths.is_empty()).then_some(stress_paths),
        instants: *instants,
        change,
        warnings: present_warnings(&contact)
            .into_iter()
            .chain(bulk_warning(task.bulk.is_some()))
            .chain(beyond_model(&contact, &moves, task, &go_on))
            .collect(),
        accuracy: Accuracy { subsurface_error: Some(field.error()), ..accuracy(&contact, timer, REASON) },
        contact: contact.summary().into(),
    };
    let rated = warnings::Rated { task, ratings: &ratings, places: &places, off_grid, radius: study.contact_radius() };
    let warnings = fretting_warnings(&reply, &rated);
    reply.warnings.extend(warnings);
    Ok(reply)
}

/// The place of the surface at which a criterion is largest, and the first ones where it is infinite.
fn worst_on_surface(places: &[[f64; 3]], values: &[f64]) -> Vec<[f64; 3]> {
    let on_surface = || places.iter().zip(values).filter(|(place, _)| place[2] <= 0.0);
    let finite = on_surface().filter(|(_, value)| value.is_finite());
    let worst = finite.reduce(|worst, next| if next.1 > worst.1 { next } else { worst });
    let infinite = on_surface().filter(|(_, value)| **value == f64::INFINITY).take(MOST_INFINITE);
    worst.into_iter().chain(infinite).map(|(place, _)| *place).collect()
}

/// An error over a value, the largest number where that is not known; a value of zero has no share that it errs by.
fn relative(error: f64, value: f64) -> f64 {
    if value.abs() > 0.0 { (error / value.abs()).min(f64::MAX) } else { 0.0 }
}

fn refused(error: Error, stop: &dyn Stop) -> Failure {
    let cause = if error == Error::CycleTooLarge { Cause::CycleTooLarge } else { error.into() };
    Failure::at("/path", cause).unless_interrupted(stop, "/path")
}

/// The stresses of a place over the cycle, as columns.
fn stress_path(place: usize, path: &[(fatigue::Instant, Stress)]) -> StressPath {
    let column = |of: fn(&Stress) -> f64| path.iter().map(|(_, stress)| finite(of(stress))).collect();
    StressPath {
        place,
        step: path.iter().map(|(at, _)| at.step).collect(),
        part: path.iter().map(|(at, _)| at.part).collect(),
        xx: column(|stress| stress.xx),
        yy: column(|stress| stress.yy),
        zz: column(|stress| stress.zz),
        xy: column(|stress| stress.xy),
        yz: column(|stress| stress.yz),
        xz: column(|stress| stress.xz),
    }
}
