//! Figures 6 to 9: the shear stress that remains after the three kinds of protocol, on the sphere and on other shapes.

use super::contact::{ball, shear_curve, small_contact};
use stickslip_mechanics::profile::PowerLaw;
use stickslip_mechanics::protocol::{AmplitudeLaw, Design, ExecutionErrors, PathEnd, PathStart, design, trials};
use stickslip_mechanics::{Contact, Error, Profile};
use stickslip_plot::{Curve, Plot};

const KINDS: [(AmplitudeLaw, &str); 3] =
    [(AmplitudeLaw::Linear, "linear"), (AmplitudeLaw::EqualPeaks, "equal peaks"), (AmplitudeLaw::Minimax, "minimax")];
/// Numbers of reversals, where several are shown.
const REVERSAL_COUNTS: [usize; 9] = [1, 2, 3, 4, 6, 8, 11, 15, 20];
/// Number of reversals, where one is shown.
const REVERSALS: usize = 20;
/// Trials of each point of figure 9, and the seed of their errors.
const SAMPLES: usize = 100;
const SEED: u64 = 2016;

pub(super) fn charts() -> Result<[Plot; 4], Error> {
    let contact = small_contact(power_law(4.0)?, 0.3)?;
    let unit = contact.summary().unit_shear();
    let [mut reduction, mut over_radius, mut robustness] = [const { Vec::new() }; 3];
    for (kind, name) in KINDS {
        reduction.push(over_reversals(name, |reversals| Ok(designed(&contact, kind, reversals)?.largest / unit))?);
        let Design { contact: after, displacements: path, .. } = designed(&contact, kind, REVERSALS)?;
        over_radius.push(Curve::line(name, None, shear_curve(&after)));
        let with_errors = |step: u32| {
            let amplitude = 0.01 * f64::from(step);
            let errors = ExecutionErrors { amplitude, friction: 0.0, seed: SEED };
            let tried = trials(&|_| Ok(contact.clone()), &path, &errors, SAMPLES, &|| true)?;
            Ok((100.0 * amplitude, tried.iter().sum::<f64>() / SAMPLES as f64 / unit))
        };
        let points = (0..=8).map(with_errors).collect::<Result<Vec<_>, Error>>()?;
        robustness.push(Curve::line(name, None, points));
    }
    let mut gains = Vec::new();
    for (name, shape) in [
        ("z ~ r^1.5", power_law(1.5)?),
        ("sphere", ball()?),
        ("z ~ r^3", power_law(3.0)?),
        ("z ~ r^4", power_law(4.0)?),
    ] {
        let contact = small_contact(shape, 0.3)?;
        gains.push(over_reversals(name, |reversals| {
            let linear = designed(&contact, AmplitudeLaw::Linear, reversals)?.largest;
            Ok(designed(&contact, AmplitudeLaw::Minimax, reversals)?.largest / linear)
        })?);
    }
    let [count, largest] = ["number of reversals", "max |tau| / (mu p_max)"];
    let title = "Figure 6: largest remaining stress, profile z ~ r^4";
    let reduction = Plot::of_numbers(title, count, largest, reduction);
    let title = "Figure 7: stress after 20 reversals, profile z ~ r^4";
    let over_radius = Plot::of_numbers(title, "r / a", "tau / (mu p_max)", over_radius);
    let title = "Figure 8: remaining stress of minimax over that of linear";
    let gains = Plot::of_numbers(title, count, "max |tau|, minimax / linear", gains);
    let title = "Figure 9: mean of the largest stress, 20 reversals with errors, z ~ r^4";
    let robustness = Plot::of_numbers(title, "standard deviation of each amplitude, %", largest, robustness);
    Ok([reduction, over_radius, gains, robustness])
}

fn power_law(exponent: f64) -> Result<Profile, Error> {
    // As high at the edge as the sphere.
    Ok(Profile::PowerLaw(PowerLaw::new(exponent, 5e-7 / 1e-4_f64.powf(exponent))?))
}

fn designed(contact: &Contact, kind: AmplitudeLaw, reversals: usize) -> Result<Design, Error> {
    let start = PathStart::Displacement(contact.gross_slip_displacement());
    design(contact, start, kind, reversals, PathEnd::DisplacementZero, &|| true)
}

fn over_reversals(name: &'static str, value: impl Fn(usize) -> Result<f64, Error>) -> Result<Curve, Error> {
    let points = REVERSAL_COUNTS.into_iter().map(|reversals| Ok((reversals as f64, value(reversals)?)));
    Ok(Curve::dots(name, None, points.collect::<Result<Vec<_>, Error>>()?))
}
