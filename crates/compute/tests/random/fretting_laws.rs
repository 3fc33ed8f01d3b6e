//! What must hold for any body of `POST /fretting`.

use stickslip_compute::Nanoseconds;
use stickslip_compute::computations::Fretting;
use stickslip_mechanics::fatigue::MAX_INSTANTS;
use stickslip_wire::FrettingReply;
use stickslip_wire::fretting::{FrettingTask, Life};

use super::answered::answered;
use super::harness::Outcome;

/// The largest estimated cost of a body that is run.
const MAX_COST: Nanoseconds = 300_000_000;

/// # Panics
/// If a law does not hold for the answer to a body.
pub fn examine(body: &[u8]) -> Outcome {
    answered::<Fretting>(body, MAX_COST, |(_, setup, task), reply| {
        let spiked =
            setup.profile.indenter().rim_radius().is_some() || !setup.profile.indenter().singular_radii().is_empty();
        laws(&task, reply, spiked);
    })
}

fn laws(task: &FrettingTask, reply: &FrettingReply, spiked: bool) {
    // A search has a place for each criterion.
    let count = if task.searches() { reply.ratings().count() } else { task.places.count() };
    assert!([&reply.x, &reply.y, &reply.z].iter().all(|column| column.len() == count));
    assert!((1..=MAX_INSTANTS).contains(&reply.instants) && reply.change.is_finite(), "{reply:?}");
    for (name, _, rating) in reply.ratings() {
        assert_eq!(rating.values.len(), count, "{name}");
        let of_surface = matches!(name, "ruiz" | "ruiz_tension" | "friction_work");
        for (value, z) in rating.values.iter().zip(&reply.z) {
            assert!(
                value.is_some() || (spiked && *z <= 0.0) || (of_surface && task.searches() && *z > 0.0),
                "{name} is null at the depth {z}: {reply:?}"
            );
        }
        let found = rating.values.iter().copied().flatten();
        let never_negative = !matches!(name, "crossland" | "dang_van" | "findley");
        assert!(!never_negative || found.clone().all(|value| value >= 0.0), "{name}: {rating:?}");
        let most = found.reduce(f64::max);
        let unbounded = task.searches() && rating.values.contains(&None);
        assert!(unbounded || rating.largest.as_ref().map(|largest| largest.value) == most, "{name}: {rating:?}");
        assert!(rating.margin.is_none_or(|margin| margin > 0.0), "{name}: {rating:?}");
        assert_eq!(rating.cycles.is_some(), rating.life.is_some(), "{name}: {rating:?}");
        assert!(rating.cycles.as_ref().is_none_or(|cycles| cycles.len() == count), "{name}: {rating:?}");
        if let Some(below) = &rating.critical_distance {
            assert!(below.value.is_finite() && below.error >= 0.0 && below.error.is_finite(), "{name}: {below:?}");
            assert!(below.point[2] == 0.0 && below.life.is_some() == rating.life.is_some(), "{name}: {below:?}");
        }
        // Where the stress is infinite at the surface it has a value below.
        assert_eq!(rating.critical_distance.is_some(), task.critical_distance.is_some(), "{name}: {rating:?}");
        for life in rating.life.iter().chain(rating.critical_distance.iter().flat_map(|below| &below.life)) {
            let Life { cycles, shortest, longest, no_life } = life;
            assert_eq!(cycles.is_some(), no_life.is_none(), "{name}: {life:?}");
            let within = |cycles: f64| *shortest <= cycles && longest.is_none_or(|longest| cycles <= longest);
            assert!(
                cycles.is_none_or(within) && longest.is_none_or(|longest| *shortest <= longest),
                "{name}: {life:?}"
            );
        }
        if let Some(largest) = &rating.largest {
            let place = (0..count).find(|index| {
                let place = [reply.x[*index], reply.y[*index], reply.z[*index]];
                place.map(f64::to_bits) == largest.point.map(f64::to_bits)
            });
            assert_eq!(place.and_then(|index| rating.values[index]), Some(largest.value), "{name}: {largest:?}");
            assert!(largest.error >= 0.0 && largest.error.is_finite(), "{name}: {largest:?}");
            let length = largest.plane.map(|normal| normal.iter().map(|part| part * part).sum::<f64>());
            assert!(length.is_none_or(|length| (length - 1.0).abs() < 1e-12), "{name}: {largest:?}");
            assert!(largest.at.is_none_or(|at| at.part > 0.0 && at.part <= 1.0), "{name}: {largest:?}");
        }
    }
    for path in reply.stress_paths.iter().flatten() {
        let columns = [&path.xx, &path.yy, &path.zz, &path.xy, &path.yz, &path.xz];
        assert!(columns.iter().all(|column| column.len() == path.step.len()), "{path:?}");
        let outside = |stress: &&Option<f64>| stress.is_none() && !(spiked && reply.z[path.place] <= 0.0);
        assert_eq!(columns.into_iter().flatten().filter(outside).count(), 0, "{path:?}");
    }
}
