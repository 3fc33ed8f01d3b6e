//! Studies besides steady cycles: the load that damps most, and the response of a mass.

use stickslip_mechanics::cycle::{Drive, Resonator, best_load as best_of, work_under_load};
use stickslip_wire::{BestLoad, BestLoadStudy, FrequencyResponse, LoadCurve, Resonance, ResonancePoint};

use crate::computations::prelude::*;

/// Frequencies where none are named, and the first and the last of them over that of small oscillations.
pub(super) const FREQUENCIES: usize = 200;
const SWEPT: [f64; 2] = [0.3, 1.5];
/// The largest load of a curve over the best.
const CURVE_END: f64 = 3.0;

/// The load under which a drive, through a machine of this compliance, m/N, does the most friction work; `None` if no
/// load does any, or the profile does not allow the loads that could.
pub fn best_load(
    contact: &Contact,
    (drive, compliance): (Drive, f64),
    study: BestLoadStudy,
    stop: &dyn Stop,
) -> Result<Option<BestLoad>, Failure> {
    let best = match best_of(contact, drive, compliance, &|| stop.check().is_ok()) {
        Ok(Some(best)) => best,
        Ok(None) | Err(_) => {
            stop.check()?;
            return Ok(None);
        }
    };
    let mut curve = None;
    if let Some(points) = study.points {
        let load = |index: usize| CURVE_END * best.normal_force * index as f64 / points as f64;
        let normal_force: Vec<f64> = (1..=points).map(load).collect();
        let mut dissipated_energy = Vec::with_capacity(points);
        for &load in &normal_force {
            stop.check()?;
            dissipated_energy.push(work_under_load(contact, load, drive, compliance).ok());
        }
        curve = Some(LoadCurve { normal_force, dissipated_energy });
    }
    Ok(Some(BestLoad { normal_force: best.normal_force, dissipated_energy: best.dissipated_energy, curve }))
}

/// The oscillations of a mass on the contact to a tolerance, of the amplitude, and the warning if it is not met.
pub fn resonance(
    contact: &Contact,
    asked: &FrequencyResponse,
    tolerance: f64,
    stop: &dyn Stop,
) -> Result<(Resonance, Option<Warning>), Failure> {
    let body = Resonator { mass: asked.mass, drive_force: asked.drive_force };
    let natural_frequency = body.natural_frequency(contact);
    let frequencies = asked.frequencies.clone().unwrap_or_else(|| {
        let [from, to] = SWEPT.map(|share| share * natural_frequency);
        let at = |index: usize| from + (to - from) * index as f64 / (FREQUENCIES - 1) as f64;
        (0..FREQUENCIES).map(at).filter(|frequency| *frequency > 0.0).collect()
    });
    let found = body.respond(contact, &frequencies, tolerance, &|| stop.check().is_ok());
    let found = found.ok_or_else(|| Failure::from(Interrupted::Abandoned).unless_interrupted(stop, ""))?;
    let point = |found: stickslip_mechanics::cycle::Response| ResonancePoint {
        frequency: found.frequency,
        amplitude: found.amplitude,
        amplitude_error: finite(found.amplitude_error),
        phase: found.phase.to_degrees(),
        peak: found.peak,
        peak_error: finite(found.peak_error),
        third_harmonic: found.third_harmonic,
    };
    let error =
        found.iter().map(|found| found.amplitude_error.max(found.peak_error) / found.amplitude).fold(0.0, f64::max);
    let warning = excess_error(error, tolerance, 1).map(tolerance_not_met);
    Ok((Resonance { natural_frequency, points: found.into_iter().map(point).collect() }, warning))
}

/// The warning for oscillations of which the largest error, of the amplitude, is beyond the tolerance.
fn tolerance_not_met(error: f64) -> Warning {
    let message = if error.is_finite() {
        format!(
            "an oscillation of the mass may be off by {error:.1e} of its amplitude, more than the tolerance asked for"
        )
    } else {
        "at some frequencies the steady oscillation was not found: `amplitude_error` is null there, and the other \
         numbers follow from the first harmonic of the force alone"
            .to_owned()
    };
    Warning::new("tolerance_not_met", message)
}
