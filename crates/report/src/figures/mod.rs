//! The figures of the documentation: 1 to 5 of Kraft & Pohrt (2016), drawn from the exact solver, 6 to 9 about
//! protocols, 10 and 11 about steady cycles, 12 and 13 about fretting fatigue, 14 about rough contacts, 15 about
//! measured loops, 16 and 17 about line contacts, and 18 about motion in the plane.
//!
//! All are normalised — displacement by that of gross slip, force by mu F_N, stress by mu p_max, radius by a — so
//! that they hold for every sphere, whatever the reference contact below is made of.

mod contact;
mod cycles;
mod fretting;
mod identifiability;
mod line;
mod paper;
mod plane;
mod protocols;
mod rough;

use std::fs;
use std::path::Path;

use stickslip_plot::Drawing;

use crate::report::Failure;

/// Points of a curve, beside its kinks.
const POINTS: usize = 400;

/// Writes `figure1.svg` to `figure18.svg` into `dir`, which is created if it does not exist.
pub fn write(dir: &Path) -> Result<(), Failure> {
    let mut figures: Vec<Drawing> = paper::charts()?.map(Drawing::Plot).into();
    figures.extend(protocols::charts()?.map(Drawing::Plot));
    figures.extend(cycles::charts()?.map(Drawing::Plot));
    figures.extend(fretting::sections()?.map(Drawing::Section));
    figures.extend([rough::chart()?, identifiability::chart()?].map(Drawing::Plot));
    figures.extend(line::charts()?.map(Drawing::Plot));
    figures.push(Drawing::Plot(plane::chart()?));
    fs::create_dir_all(dir)?;
    for (number, figure) in (1..).zip(figures) {
        fs::write(dir.join(format!("figure{number}.svg")), figure.svg()?)?;
    }
    Ok(())
}
