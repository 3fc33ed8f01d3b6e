//! The normal force under which a given drive does most friction work.
//!
//! Without a load there is no friction, and under a large one little slip. At a given displacement the contact slides
//! for a part of the way where the most work is done, or no further than that; a given force needs a load that holds
//! it. The work may have several maxima, so that loads of some decades are compared before the best of them is refined.

use std::cell::Cell;

use super::{Drive, SteadyCycle};
use crate::contact::Contact;
use crate::numerics::roots::largest;
use crate::range::error::Error;

/// Loads that are compared first, evenly spaced in their logarithm, and how far below the onset of gross slip and above
/// it they reach.
const LOADS: usize = 256;
const DECADES: f64 = 3.0;
/// The part of the bracket about the best of them that the refinement leaves.
const BRACKET: f64 = 1e-12;

/// A load and the work of a cycle under it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BestLoad {
    /// Normal force, N.
    pub normal_force: f64,
    /// Friction work of a cycle, J.
    pub dissipated_energy: f64,
}

/// The load under which a drive does most work on the bodies of `contact`, through a machine of this compliance, m/N,
/// while `keep_going` returns true, which is asked at each load; `None` where no load does any.
///
/// # Errors
/// [`Error::BeyondProfile`] and [`Error::OutOfRange`] where the profile has no contact for the least of the loads, and
/// [`Error::Interrupted`] once `keep_going` has returned false.
///
/// ```
#[doc = include_str!("../example.txt")]
/// use stickslip_mechanics::cycle::{Drive, SteadyCycle, best_load};
///
/// let best = best_load(&contact, Drive::Displacement(0.00375), 0.0, &|| true)?.unwrap();
/// let heavier = contact.pressed(1.01 * best.normal_force)?;
/// assert!(SteadyCycle::of(&heavier, 0.00375).dissipated_energy() < best.dissipated_energy);
/// # Ok::<(), Error>(())
/// ```
pub fn best_load(
    contact: &Contact,
    drive: Drive,
    compliance: f64,
    keep_going: &dyn Fn() -> bool,
) -> Result<Option<BestLoad>, Error> {
    contact.check_coulomb("the best load")?;
    if contact.friction <= 0.0 {
        return Ok(None);
    }
    let stopped = Cell::new(false);
    let work = |normal_force: f64| {
        if stopped.get() || !keep_going() {
            stopped.set(true);
            return Err(Error::Interrupted);
        }
        let pressed = contact.pressed(normal_force)?;
        // A force that the load just holds is that of gross slip.
        let cycle = SteadyCycle::driven(&pressed, drive, compliance)
            .unwrap_or_else(|_| SteadyCycle::of(&pressed, pressed.gross_slip_displacement()));
        Ok(cycle.dissipated_energy())
    };
    let (onset, least) = match drive {
        Drive::Force(amplitude) => (amplitude.abs() / contact.friction, 0.0),
        Drive::Displacement(amplitude) => (contact.normal_force_at(contact.scaled(amplitude.abs().into())), DECADES),
    };
    let load = |index: f64| onset * 10_f64.powf((least + DECADES) * index / LOADS as f64 - least);
    let mut best = (0, 0.0);
    for index in 0..=LOADS {
        // Larger loads than the profile has a contact for are skipped.
        match work(load(index as f64)) {
            Ok(found) if found > best.1 => best = (index, found),
            Ok(_) => {}
            Err(error) if index == 0 => return Err(error),
            Err(_) => break,
        }
    }
    let beside = [best.0.saturating_sub(1) as f64, (best.0 + 1).min(LOADS) as f64];
    let refined = largest(beside, BRACKET, |index| work(load(index)).unwrap_or(0.0));
    if stopped.get() {
        return Err(Error::Interrupted);
    }
    let (index, dissipated_energy) = if refined.1 > best.1 { refined } else { (best.0 as f64, best.1) };
    Ok((dissipated_energy > 0.0).then(|| BestLoad { normal_force: load(index), dissipated_energy }))
}

/// The friction work, J, that a drive does in a steady cycle on the bodies of `contact` under a normal force, N,
/// through a machine of this compliance, m/N.
///
/// # Errors
/// As [`SteadyCycle::driven`], and those of [`Contact::pressed`].
///
/// ```
#[doc = include_str!("../example.txt")]
/// use stickslip_mechanics::cycle::{Drive, SteadyCycle, work_under_load};
///
/// let work = work_under_load(&contact, 2e4, Drive::Displacement(0.00375), 0.0)?;
/// assert_eq!(work, SteadyCycle::of(&contact.pressed(2e4)?, 0.00375).dissipated_energy());
/// # Ok::<(), Error>(())
/// ```
pub fn work_under_load(contact: &Contact, normal_force: f64, drive: Drive, compliance: f64) -> Result<f64, Error> {
    let pressed = contact.pressed(normal_force)?;
    Ok(SteadyCycle::driven(&pressed, drive, compliance)?.dissipated_energy())
}
