//! Figures 6 to 9: the shear stress that remains after the three kinds of protocol, on the sphere and on other shapes.

use super::contact::{ball, small_contact};
use super::shear_curve;
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
    Ok([reduction()?, over_radius()?, shapes()?, robustness()?])
}

fn power_law(exponent: f64) -> Result<Profile, Error> {
    // As high at the edge as the sphere.
    Ok(Profile::PowerLaw(PowerLaw::new(exponent, 5e-7 / 1e-4_f64.powf(exponent))?))
}

/// mu p_max, Pa.
fn unit(contact: &Contact) -> f64 {
    contact.summary().unit_shear()
}

fn designed(contact: &Contact, kind: AmplitudeLaw, reversals: usize) -> Result<Design, Error> {
    let start = PathStart::Displacement(contact.gross_slip_displacement());
    design(contact, start, kind, reversals, PathEnd::DisplacementZero, &|| true)
}

/// A chart with its title and the names of its axes, and a series of each of some things.
fn chart<T>(
    [title, x, y]: [&'static str; 3],
    of: impl IntoIterator<Item = T>,
    series: impl Fn(T) -> Result<Curve, Error>,
) -> Result<Plot, Error> {
    Ok(Plot::of_numbers(title, x, y, of.into_iter().map(series).collect::<Result<_, _>>()?))
}

fn reduction() -> Result<Plot, Error> {
    let contact = small_contact(power_law(4.0)?, 0.3)?;
    let names =
        ["Figure 6: largest remaining stress, profile z ~ r^4", "number of reversals", "max |tau| / (mu p_max)"];
    chart(names, KINDS, |(kind, name)| {
        let point = |reversals| Ok((reversals as f64, designed(&contact, kind, reversals)?.largest / unit(&contact)));
        Ok(Curve::dots(name, None, REVERSAL_COUNTS.into_iter().map(point).collect::<Result<Vec<_>, Error>>()?))
    })
}

fn over_radius() -> Result<Plot, Error> {
    let contact = small_contact(power_law(4.0)?, 0.3)?;
    let names = ["Figure 7: stress after 20 reversals, profile z ~ r^4", "r / a", "tau / (mu p_max)"];
    chart(names, KINDS, |(kind, name)| {
        let left = designed(&contact, kind, REVERSALS)?;
        Ok(Curve::line(name, None, shear_curve(&left.contact, &left.residual, unit(&contact))))
    })
}

fn shapes() -> Result<Plot, Error> {
    let shapes = [
        ("z ~ r^1.5", power_law(1.5)?),
        ("sphere", ball()?),
        ("z ~ r^3", power_law(3.0)?),
        ("z ~ r^4", power_law(4.0)?),
    ];
    let names = [
        "Figure 8: remaining stress of minimax over that of linear",
        "number of reversals",
        "max |tau|, minimax / linear",
    ];
    chart(names, shapes, |(name, shape)| {
        let contact = small_contact(shape, 0.3)?;
        let point = |reversals| {
            let linear = designed(&contact, AmplitudeLaw::Linear, reversals)?.largest;
            Ok((reversals as f64, designed(&contact, AmplitudeLaw::Minimax, reversals)?.largest / linear))
        };
        Ok(Curve::dots(name, None, REVERSAL_COUNTS.into_iter().map(point).collect::<Result<Vec<_>, Error>>()?))
    })
}

fn robustness() -> Result<Plot, Error> {
    let contact = small_contact(power_law(4.0)?, 0.3)?;
    let names = [
        "Figure 9: mean of the largest stress, 20 reversals with errors, z ~ r^4",
        "standard deviation of each amplitude, %",
        "max |tau| / (mu p_max)",
    ];
    chart(names, KINDS, |(kind, name)| {
        let path = designed(&contact, kind, REVERSALS)?.displacements;
        let point = |step: u32| {
            let amplitude = 0.01 * f64::from(step);
            let errors = ExecutionErrors { amplitude, friction: 0.0, seed: SEED };
            let tried = trials(&|_| Ok(contact.clone()), &path, &errors, SAMPLES, &|| true)?;
            Ok((100.0 * amplitude, tried.iter().sum::<f64>() / SAMPLES as f64 / unit(&contact)))
        };
        Ok(Curve::line(name, None, (0..=8).map(point).collect::<Result<Vec<_>, Error>>()?))
    })
}
