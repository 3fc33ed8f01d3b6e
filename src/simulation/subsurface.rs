//! Stress below the surface of a contact in its present state.

use stickslip_mechanics::{Contact, Stress};
use stickslip_wire::reply::finite;
use stickslip_wire::subsurface::SubsurfaceTask;
use stickslip_wire::{Accuracy, Subsurface, SubsurfaceField, SubsurfaceReply};

use super::stated_accuracy::{Timer, accuracy};
use super::warnings::{bulk_warning, present_warnings};
use super::{Failure, needs_stress_field};
use crate::admission::Stop;

const REASON: &str = "the stress below the surface follows from the slip history without a mesh";

/// Places between two checks of the flag.
const PLACES_PER_CHECK: usize = 64;

/// The fields that are asked for, and their estimated error relative to the largest pressure.
///
/// # Errors
/// [`Failure`] if the work was ended.
pub fn subsurface(contact: &Contact, task: &SubsurfaceTask, stop: &Stop) -> Result<(Subsurface, f64), Failure> {
    let field = contact
        .subsurface(task.side, task.poisson_ratio)
        .map_err(|error| Failure::Refused { pointer: "/subsurface/poisson_ratio".to_owned(), error })?;
    let mut columns = Columns::new(task);
    for index in 0..task.places.count() {
        if index % PLACES_PER_CHECK == 0 {
            stop.check()?;
        }
        let place = task.places.at(index);
        let stress = field.at(place);
        columns.push(place, task.bulk.map_or(stress, |bulk| stress + bulk));
    }
    Ok((columns.reply, field.error()))
}

/// The same of a contact on its own, with its errors and warnings.
///
/// # Errors
/// As [`subsurface`].
pub fn subsurface_reply(contact: &Contact, task: &SubsurfaceTask, stop: &Stop) -> Result<SubsurfaceReply, Failure> {
    let timer = Timer::start(stop);
    needs_stress_field(contact, "")?;
    let (stress, error) = subsurface(contact, task, stop)?;
    let accuracy = Accuracy { subsurface_error: Some(error), ..accuracy(contact, timer, REASON) };
    let warnings = present_warnings(contact).into_iter().chain(bulk_warning(task.bulk.is_some())).collect();
    Ok(SubsurfaceReply { stress, accuracy, warnings })
}

/// A reply with a column for each quantity that is asked for.
struct Columns {
    reply: Subsurface,
}

impl Columns {
    fn new(task: &SubsurfaceTask) -> Columns {
        let count = task.places.count();
        let numbers = || Vec::with_capacity(count);
        let column = |field| task.wants(field).then(|| Vec::with_capacity(count));
        let tensor = || column(SubsurfaceField::Tensor);
        let principal = || column(SubsurfaceField::Principal);
        let (x, y, z) = (numbers(), numbers(), numbers());
        Columns {
            reply: Subsurface {
                x,
                y,
                z,
                xx: tensor(),
                yy: tensor(),
                zz: tensor(),
                xy: tensor(),
                yz: tensor(),
                xz: tensor(),
                principal_1: principal(),
                principal_2: principal(),
                principal_3: principal(),
                von_mises: column(SubsurfaceField::VonMises),
                max_shear: column(SubsurfaceField::MaxShear),
                hydrostatic: column(SubsurfaceField::Hydrostatic),
            },
        }
    }

    fn push(&mut self, [x, y, z]: [f64; 3], stress: Stress) {
        let Subsurface { xx, yy, zz, xy, yz, xz, principal_1, principal_2, principal_3, .. } = &mut self.reply;
        for (column, value) in [xx, yy, zz, xy, yz, xz].into_iter().zip(stress.components()) {
            put(column, || value);
        }
        if principal_1.is_some() {
            let infinite = [f64::INFINITY; 3];
            let principal = if stress.is_finite() { stress.principal() } else { infinite };
            for (column, value) in [principal_1, principal_2, principal_3].into_iter().zip(principal) {
                put(column, || value);
            }
        }
        put(&mut self.reply.von_mises, || stress.von_mises());
        put(&mut self.reply.max_shear, || if stress.is_finite() { stress.max_shear() } else { f64::INFINITY });
        put(&mut self.reply.hydrostatic, || stress.hydrostatic());
        self.reply.x.push(x);
        self.reply.y.push(y);
        self.reply.z.push(z);
    }
}

/// Appends a value to a column that is asked for; one that is not finite is none.
fn put(column: &mut Option<Vec<Option<f64>>>, value: impl FnOnce() -> f64) {
    if let Some(column) = column {
        column.push(finite(value()));
    }
}
