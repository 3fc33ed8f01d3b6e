//! Figures 1 to 5 of Kraft & Pohrt (2016): a ball on the path of eq. 20.

use super::POINTS;
use super::contact::{ball_under_load, shear_curve, to};
use stickslip_mechanics::protocol::falling_amplitude;
use stickslip_mechanics::{Contact, Error, State};
use stickslip_plot::{Colour, Curve, Plot};

const REVERSALS: usize = 20;
/// The last number of reversals in figure 5.
const MAX_REVERSALS: usize = 40;
/// Points between two reversal points of figure 1.
const STEPS: i32 = 20;

pub(super) fn charts() -> Result<[Plot; 5], Error> {
    let (contact, states) = follow(REVERSALS, REVERSALS + 1)?;
    let summary = contact.summary();
    let numbered = |value: &dyn Fn(&State) -> f64| -> Vec<(f64, f64)> {
        (1..).zip(&states).map(|(index, state)| (f64::from(index), value(state))).collect()
    };
    let turns = numbered(&|state| state.displacement / summary.gross_slip_displacement);
    let sizes = numbered(&|state| state.force.abs() / summary.gross_slip_force);
    Ok([
        positions(turns),
        Plot::of_numbers(
            "Figure 2: tangential force at the reversal points",
            "reversal point k",
            "|F| / (mu F_N)",
            vec![Curve::dots("|F| / (mu F_N)", None, sizes)],
        ),
        shear_partway()?,
        Plot::of_numbers(
            "Figure 4: shear stress that remains after 20 reversals",
            "r / a",
            "tau / (mu p_max)",
            vec![Curve::line("tau / (mu p_max)", None, shear_curve(&contact))],
        ),
        remaining_peaks()?,
    ])
}

/// The contact after so many moves of a path with so many reversals, and the states on the way.
fn follow(reversals: usize, moves: usize) -> Result<(Contact, Vec<State>), Error> {
    let mut contact = ball_under_load()?;
    let amplitude = contact.summary().gross_slip_displacement;
    let state = |target| {
        contact.apply(&to(target))?;
        Ok(contact.state())
    };
    let states = falling_amplitude(reversals, amplitude).take(moves).map(state).collect::<Result<_, Error>>()?;
    Ok((contact, states))
}

fn positions(turns: Vec<(f64, f64)>) -> Plot {
    // Only the reversal points matter; half a cosine is drawn between them, as in the paper.
    let between = turns.windows(2).flat_map(|pair| {
        let ((x0, u0), (_, u1)) = (pair[0], pair[1]);
        (0..STEPS).map(move |step| {
            let part = f64::from(step) / f64::from(STEPS);
            (x0 + part, u0 + (u1 - u0) * 0.5 * (1.0 - (std::f64::consts::PI * part).cos()))
        })
    });
    let position: Vec<_> = between.chain(turns.last().copied()).collect();
    let at_reversal = [turns[5]];
    Plot::of_numbers(
        "Figure 1: position of the indenter, 20 reversals",
        "reversal point k",
        "u / u_max",
        vec![
            Curve::line("position", Colour::Grey, position),
            Curve::dots("reversal points", Colour::Orange, turns),
            // In the colours of their curves in figure 3.
            Curve::dots("A: reversal 6", Colour::Blue, at_reversal),
            Curve::dots("B: back at u = 0", Colour::Red, [(6.5, 0.0)]),
        ],
    )
}

fn shear_partway() -> Result<Plot, Error> {
    let (mut contact, _) = follow(REVERSALS, 6)?;
    let at_reversal = shear_curve(&contact);
    contact.apply(&to(0.0))?;
    let part = |index: usize| index as f64 / POINTS as f64;
    let pressure = |r: f64| contact.pressure(r * contact.contact_radius()) / contact.pressure(0.0);
    let bound = |sign: f64| (0..=POINTS).map(move |index| (part(index), sign * pressure(part(index))));
    Ok(Plot::of_numbers(
        "Figure 3: shear stress after 6 and 6.5 of 20 reversals",
        "r / a",
        "tau / (mu p_max)",
        // The friction bound lies behind the curves that it bounds.
        vec![
            Curve::line("mu p and -mu p", Colour::Grey, bound(1.0)),
            Curve::line("", Colour::Grey, bound(-1.0)),
            Curve::line("B: back at u = 0", Colour::Red, shear_curve(&contact)),
            Curve::line("A: reversal 6", Colour::Blue, at_reversal),
        ],
    ))
}

fn remaining_peaks() -> Result<Plot, Error> {
    let mut curves = ["maximum", "mean", "minimum"].map(|name| Curve::dots(name, None, []));
    for reversals in 1..=MAX_REVERSALS {
        let (contact, _) = follow(reversals, reversals + 1)?;
        let (residual, unit) = (contact.residual(), contact.summary().unit_shear());
        for (curve, value) in curves.iter_mut().zip([residual.max, residual.mean, residual.min]) {
            curve.points.extend(value.map(|value| (reversals as f64, value / unit)));
        }
    }
    Ok(Plot::of_numbers(
        "Figure 5: peaks of the remaining shear stress",
        "number of reversals",
        "|tau| / (mu p_max)",
        curves.into(),
    ))
}
