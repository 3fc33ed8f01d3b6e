//! Fatigue criteria over the steady cycle of a contact: at given places, or at the worst of the body.

use stickslip_mechanics::fatigue::{self, Cycle, Largest, Ratings, Study};
use stickslip_mechanics::{Error, Stress};
use stickslip_wire::definition::SharedSetup;
use stickslip_wire::fretting::{self as wire, FrettingTask};
use stickslip_wire::reply::finite;
use stickslip_wire::{Accuracy, FrettingReply, Rating, StressPath};

use super::warnings::{Rated, beyond_model, fretting_warnings};
use crate::Stop;
use crate::simulation::{Cause, Failure, Timer, accuracy, bulk_warning, contact, cycle_moves, present_warnings};

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
    let asked: Vec<_> = task.measures.iter().flatten().map(|(measure, _)| *measure).collect();
    let study = Study::new(&cycle, task.body, task.bulk, asked, task.tolerance, &go_on);
    let mut study = study.map_err(refused)?;

    let mut places: Vec<[f64; 3]> = (0..task.places.count()).map(|index| task.places.at(index)).collect();
    let (ratings, off_grid) = if task.searches() {
        let worst = study.worst().map_err(refused)?;
        places = worst.iter().map(|worst| worst.place).collect();
        let mut ratings = study.rate_all(&places).map_err(refused)?;
        for (largest, worst) in ratings.largest.iter_mut().zip(&worst) {
            *largest = largest.filter(|_| worst.rated.value.is_finite());
            if let Some(Largest { rated, .. }) = largest {
                rated.error = rated.error.max(worst.rated.error);
            }
        }
        (ratings, Vec::new())
    } else {
        let ratings = study.rate_all(&places).map_err(refused)?;
        let known: Vec<f64> =
            ratings.largest.iter().map(|most| most.map_or(f64::NEG_INFINITY, |most| most.rated.value)).collect();
        let larger = study.larger(&known).map_err(refused)?;
        (ratings, larger)
    };
    let Ratings { values, largest, instants } = &ratings;
    let change = largest.iter().flatten().map(|most| relative(most.rated.error, most.rated.value)).fold(0.0, f64::max);

    let mut found = values.iter().zip(largest);
    let rating = |asked: Option<(_, Option<f64>)>| {
        let ((_, limit), (values, most)) = (asked?, found.next()?);
        // What nowhere rises above zero, or has no bound, has no distance to its limit.
        let bounded = values.iter().all(|value| *value < f64::INFINITY || value.is_nan());
        let rated = most.map(|most| most.rated.value).filter(|value| *value > 0.0 && bounded);
        let margin = limit.zip(rated).and_then(|(limit, value)| finite(limit / value));
        let largest = most.map(|Largest { place, rated }| wire::Largest {
            value: rated.value,
            error: rated.error,
            point: places[place],
            plane: rated.plane,
            at: rated.at.map(|at| wire::Instant { step: at.step, part: at.part }),
        });
        Some(Rating { values: values.iter().map(|value| finite(*value)).collect(), largest, margin })
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
    let rated = Rated { task, ratings: &ratings, places: &places, off_grid, radius: study.contact_radius() };
    let warnings = fretting_warnings(&reply, &rated);
    reply.warnings.extend(warnings);
    Ok(reply)
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
