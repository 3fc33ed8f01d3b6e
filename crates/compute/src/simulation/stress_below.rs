//! Stress below the surface of a contact in its present state.

use stickslip_mechanics::Stress;
use stickslip_wire::subsurface::SubsurfaceTask;
use stickslip_wire::{Subsurface, SubsurfaceField};

use crate::prelude::*;

/// Places between two checks of the flag.
const PLACES_PER_CHECK: usize = 64;

/// The fields that are asked for, and their estimated error relative to the largest pressure.
///
/// # Errors
/// [`Failure`] for a place too far from the contact, or if the work was ended.
pub fn subsurface(contact: &Contact, task: &SubsurfaceTask, stop: &dyn Stop) -> Result<(Subsurface, f64), Failure> {
    let field = contact.subsurface(task.side, task.poisson_ratio);
    let field = field.map_err(|error| Failure::at("/subsurface/poisson_ratio", error))?;
    let along = |axis: usize| (0..task.places.count()).map(|index| task.places.at(index)[axis]).collect();
    let mut reply = Subsurface { x: along(0), y: along(1), z: along(2), ..Subsurface::default() };
    for index in 0..task.places.count() {
        if index % PLACES_PER_CHECK == 0 {
            stop.check()?;
        }
        let stress = field.at(task.places.at(index)).map_err(|error| Failure::at("/subsurface", error))?;
        push(&mut reply, task, task.bulk.map_or(stress, |bulk| stress + bulk));
    }
    Ok((reply, field.error()))
}

/// Appends the values at a place to the columns of what is asked for; `None` for one that is not finite.
fn push(reply: &mut Subsurface, task: &SubsurfaceTask, stress: Stress) {
    let put = |column: &mut Option<Vec<Option<f64>>>, value: f64| {
        let count = task.places.count();
        column.get_or_insert_with(|| Vec::with_capacity(count)).push(finite(value));
    };
    let Subsurface { xx, yy, zz, xy, yz, xz, principal_1, principal_2, principal_3, .. } = reply;
    if task.wants(SubsurfaceField::Tensor) {
        [xx, yy, zz, xy, yz, xz].into_iter().zip(stress.components()).for_each(|(column, value)| put(column, value));
    }
    if task.wants(SubsurfaceField::Principal) {
        let principal = if stress.is_finite() { stress.principal() } else { [f64::INFINITY; 3] };
        [principal_1, principal_2, principal_3]
            .into_iter()
            .zip(principal)
            .for_each(|(column, value)| put(column, value));
    }
    if task.wants(SubsurfaceField::VonMises) {
        put(&mut reply.von_mises, stress.von_mises());
    }
    if task.wants(SubsurfaceField::MaxShear) {
        put(&mut reply.max_shear, if stress.is_finite() { stress.max_shear() } else { f64::INFINITY });
    }
    if task.wants(SubsurfaceField::Hydrostatic) {
        put(&mut reply.hydrostatic, stress.hydrostatic());
    }
}
