//! Figures 1 to 5 of Kraft & Pohrt (2016), drawn from the exact solver, figures 6 to 9 about protocols, and figures 10
//! and 11 about steady cycles, figures 12 and 13 about fretting fatigue, figure 14 about rough contacts, figure 15
//! about measured loops, figures 16 and 17 about line contacts, and figure 18 about motion in the plane: SVG, and CSV
//! with the data.
//!
//! All are normalised — displacement by that of gross slip, force by mu F_N, stress by mu p_max, radius by a — so
//! that they hold for every sphere, whatever the reference contact below is made of.

mod contact;
mod cycles;
mod fretting;
mod identifiability;
mod line;
mod plane;
mod protocols;
mod rough;

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

use stickslip_mechanics::protocol::falling_amplitude;
use stickslip_mechanics::{Contact, Error, Residual, State};
use stickslip_plot::{Colour, Curve, Drawing, Picture as _, Plot, Section};

const REVERSALS: usize = 20;
/// Radii of a curve, beside its kinks.
const POINTS: usize = 400;
/// The last number of reversals in figure 5.
const MAX_REVERSALS: usize = 40;

/// Writes `figure1.svg` to `figure18.svg` and the CSV file of each into `dir`, which is created if it does not exist.
///
/// # Errors
/// An error of the file system; a figure that cannot be drawn is [`io::ErrorKind::Other`].
pub fn write(dir: &Path) -> io::Result<()> {
    fs::create_dir_all(dir)?;
    for (number, figure) in (1..).zip(all().map_err(io::Error::other)?) {
        fs::write(dir.join(format!("figure{number}.csv")), csv(&figure))?;
        fs::write(dir.join(format!("figure{number}.svg")), figure.svg().map_err(io::Error::other)?)?;
    }
    Ok(())
}

/// Why there is no figure.
type Failure = Box<dyn std::error::Error + Send + Sync>;

/// The figures in the order of their numbers.
fn all() -> Result<impl Iterator<Item = Drawing>, Failure> {
    let until_fretting = paper()?.into_iter().chain(protocols::charts()?).chain(cycles::charts()?);
    let after_fretting = [rough::chart()?, identifiability::chart()?].into_iter().chain(line::charts()?);
    let after_fretting = after_fretting.chain([plane::chart()?]).map(Drawing::Plot);
    let fretting = fretting::sections()?.map(Drawing::Section);
    Ok(until_fretting.map(Drawing::Plot).chain(fretting).chain(after_fretting))
}

fn paper() -> Result<[Plot; 5], Error> {
    let path = NormalisedPath::follow(REVERSALS, REVERSALS + 1)?;
    Ok([positions(&path), forces(&path), shear_partway()?, remaining_shear(&path), remaining_peaks()?])
}

/// A reference sphere on the path of eq. 20; its methods give dimensionless values.
struct NormalisedPath {
    contact: Contact,
    states: Vec<State>,
}

impl NormalisedPath {
    fn follow(reversals: usize, moves: usize) -> Result<NormalisedPath, Error> {
        let mut path = NormalisedPath { contact: contact::ball_under_load()?, states: Vec::new() };
        let amplitude = path.contact.summary().gross_slip_displacement;
        for target in falling_amplitude(reversals, amplitude).take(moves) {
            path.move_to(target)?;
        }
        Ok(path)
    }

    fn move_to(&mut self, target: f64) -> Result<(), Error> {
        self.contact.apply(&contact::to(target))?;
        self.states.push(self.contact.state());
        Ok(())
    }

    /// A value of each state over a unit, at the numbers of the reversal points.
    fn numbered(&self, value: impl Fn(&State) -> f64, unit: f64) -> Vec<(f64, f64)> {
        self.states.iter().enumerate().map(|(index, state)| ((index + 1) as f64, value(state) / unit)).collect()
    }

    fn stress_unit(&self) -> f64 {
        let summary = self.contact.summary();
        // mu p_max with the largest pressure, that at the centre.
        summary.gross_slip_force / summary.normal_force * self.contact.pressure(0.0)
    }

    /// tau/(mu p_max) over r/a.
    fn shear(&self) -> Vec<(f64, f64)> {
        shear_curve(&self.contact, &self.contact.residual(), self.stress_unit())
    }

    /// The friction bound mu p/(mu p_max) over r/a.
    fn bound(&self) -> Vec<(f64, f64)> {
        let summary = self.contact.summary();
        (0..=POINTS)
            .map(|index| index as f64 / POINTS as f64)
            .map(|r| (r, self.contact.pressure(r * summary.contact_radius) / self.contact.pressure(0.0)))
            .collect()
    }
}

/// tau over a unit, Pa, over r/a, through every extremum.
fn shear_curve(contact: &Contact, residual: &Residual, unit: f64) -> Vec<(f64, f64)> {
    let edge = contact.contact_radius();
    let mut radii: Vec<f64> = (0..=POINTS).map(|index| edge * index as f64 / POINTS as f64).collect();
    radii.extend(residual.peaks.iter().map(|peak| peak.radius));
    radii.sort_by(f64::total_cmp);
    radii.iter().map(|&r| (r / edge, contact.shear(r) / unit)).collect()
}

fn positions(path: &NormalisedPath) -> Plot {
    let turns = path.numbered(|state| state.displacement, path.contact.summary().gross_slip_displacement);
    // Only the reversal points matter; half a cosine is drawn between them, as in the paper.
    let position = turns.windows(2).flat_map(|pair| {
        let ((x0, u0), (_, u1)) = (pair[0], pair[1]);
        (0..20).map(move |step| {
            let part = f64::from(step) / 20.0;
            (x0 + part, u0 + (u1 - u0) * 0.5 * (1.0 - (std::f64::consts::PI * part).cos()))
        })
    });
    let position: Vec<_> = position.chain(turns.last().copied()).collect();
    let at_reversal = vec![turns[5]];
    Plot::of_numbers(
        "Figure 1: position of the indenter, 20 reversals",
        "reversal point k",
        "u / u_max",
        vec![
            Curve::line("position", Colour::Grey, position),
            Curve::dots("reversal points", Colour::Orange, turns),
            // In the colours of their curves in figure 3.
            Curve::dots("A: reversal 6", Colour::Blue, at_reversal),
            Curve::dots("B: back at u = 0", Colour::Red, vec![(6.5, 0.0)]),
        ],
    )
}

fn forces(path: &NormalisedPath) -> Plot {
    let sizes = path.numbered(|state| state.force.abs(), path.contact.summary().gross_slip_force);
    Plot::of_numbers(
        "Figure 2: tangential force at the reversal points",
        "reversal point k",
        "|F| / (mu F_N)",
        vec![Curve::dots("|F| / (mu F_N)", None, sizes)],
    )
}

fn shear_partway() -> Result<Plot, Error> {
    let mut path = NormalisedPath::follow(REVERSALS, 6)?;
    let at_reversal = path.shear();
    path.move_to(0.0)?;
    let bound = path.bound();
    let mirrored: Vec<_> = bound.iter().map(|&(r, p)| (r, -p)).collect();
    Ok(Plot::of_numbers(
        "Figure 3: shear stress after 6 and 6.5 of 20 reversals",
        "r / a",
        "tau / (mu p_max)",
        // The friction bound lies behind the curves that it bounds.
        vec![
            Curve::line("mu p and -mu p", Colour::Grey, bound),
            Curve::line("", Colour::Grey, mirrored),
            Curve::line("B: back at u = 0", Colour::Red, path.shear()),
            Curve::line("A: reversal 6", Colour::Blue, at_reversal),
        ],
    ))
}

fn remaining_shear(path: &NormalisedPath) -> Plot {
    Plot::of_numbers(
        "Figure 4: shear stress that remains after 20 reversals",
        "r / a",
        "tau / (mu p_max)",
        vec![Curve::line("tau / (mu p_max)", None, path.shear())],
    )
}

fn remaining_peaks() -> Result<Plot, Error> {
    let mut largest = Vec::new();
    let mut smallest = Vec::new();
    let mut mean = Vec::new();
    for reversals in 1..=MAX_REVERSALS {
        let path = NormalisedPath::follow(reversals, reversals + 1)?;
        let unit = path.stress_unit();
        let residual = path.contact.residual();
        let x = reversals as f64;
        largest.extend(residual.max.map(|value| (x, value / unit)));
        smallest.extend(residual.min.map(|value| (x, value / unit)));
        mean.extend(residual.mean.map(|value| (x, value / unit)));
    }
    Ok(Plot::of_numbers(
        "Figure 5: peaks of the remaining shear stress",
        "number of reversals",
        "|tau| / (mu p_max)",
        vec![
            Curve::dots("maximum", None, largest),
            Curve::dots("mean", None, mean),
            Curve::dots("minimum", None, smallest),
        ],
    ))
}

/// One row a point: series, x, y, or one row a place; each number as short as it can be and exact.
fn csv(figure: &Drawing) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    match figure {
        Drawing::Plot(plot) => {
            for panel in &plot.panels {
                let _ = writeln!(text, "series,{},{}", plot.x.name, panel.y.name);
                for (curve, (x, y)) in panel.curves.iter().flat_map(|c| c.points.iter().map(move |point| (c, point))) {
                    let _ = writeln!(text, "{},{x},{y}", curve.name);
                }
            }
        }
        Drawing::Section(Section { x: (x, columns), y: (y, rows), values: (value, values), .. }) => {
            let _ = writeln!(text, "{},{},{}", x.name, y.name, value.name);
            for (index, value) in values.iter().enumerate() {
                let _ = writeln!(text, "{},{},{value}", columns[index / rows.len()], rows[index % rows.len()]);
            }
        }
    }
    text
}
