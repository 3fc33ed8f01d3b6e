//! Which axis, and whether there is a tilt: fits from several starts, of which one is chosen.
//!
//! A tilt moves the axis of a parabola and changes nothing else. So where one flank is a parabola (a punch with a
//! rounded edge, a worn ball), any axis on it fits with a tilt: the part of the scan on both sides of such an axis is
//! symmetric, and the rest, on one side, fits any curve. What tests an axis is how far the scan reaches to both sides
//! of it, and a scan is not symmetric about a wrong axis by chance.

use super::Error;
use super::fit::{Fitted, Scaled, Sought, Turns};
use super::start::{self, Starts};

/// What a point that is left out counts in the comparison of fits, in standard deviations.
const LEFT_OUT: f64 = 10.0;
/// An axis without a tilt is tested if so much of the scan, in half its extent, lies on either side.
const TESTED: f64 = 0.6;
/// Axes nearer than this to each other, in half the extent, are one to start from.
const SAME_AXIS: f64 = 0.02;
/// The least gain in squares, over the variance of the noise and for each number, with which a tilt is believed.
const TILT_GAIN: f64 = 9.0;
/// The least standard deviation of a height, in the range of all.
const EXACT: f64 = 1e-9;

/// Fits the scan.
pub(super) fn fit(scan: &Scaled, sought: &Sought, keep_going: &dyn Fn() -> bool) -> Result<Fitted, Error> {
    let starts = match sought.axis {
        Some(axis) => Starts { level: Some(axis), tilted: vec![axis] },
        None => start::axes(scan, keep_going).ok_or(Error::Interrupted)?,
    };
    let from = |axis, tilt| Turns::new(scan, sought, tilt, keep_going).run(axis);
    let level = starts.level.ok_or(Error::Hollow).and_then(|axis| from(axis, false));
    if !sought.tilt || matches!(level, Err(Error::Interrupted)) {
        return level;
    }
    let mut tilted: Vec<Fitted> = Vec::new();
    for axis in starts.tilted {
        // A start near the axis that another one has led to would lead there too.
        if tilted.iter().any(|other| (0..2).all(|index| (other.axis[index] - axis[index]).abs() < SAME_AXIS)) {
            continue;
        }
        match from(axis, true) {
            Err(Error::Interrupted) => return Err(Error::Interrupted),
            Ok(fitted) => tilted.push(fitted),
            Err(_) => {}
        }
    }
    let of_noise = |fitted: &Fitted| fitted.variance.max(EXACT * EXACT);
    let least = level.iter().chain(&tilted).map(of_noise).fold(f64::INFINITY, f64::min);
    let most = LEFT_OUT * LEFT_OUT * least;
    let squares = |fitted: &Fitted| fitted.residuals.iter().map(|e| (e * e).min(most)).sum::<f64>();
    // What a degree of freedom costs is Schwarz's criterion (1978): a curve of one flank follows correlated noise.
    let count = scan.points.len() as f64;
    let freedom = |fitted: &Fitted| fitted.solution.freedom * count.ln() / count;
    let score = |fitted: &Fitted| start::score(squares(fitted), fitted.axis) + freedom(fitted);
    let Some(tilted) = tilted.into_iter().min_by(|a, b| score(a).total_cmp(&score(b))) else { return level };
    // A tilt is believed only where the scan shows it. The noise that this is compared with is that of the better fit:
    // what a tilt that was left in makes of the other's residual looks like correlated noise. Near the edge, or with a
    // curve of more freedom, the axis without a tilt could be that of a flank.
    let Ok(level) = level else { return Ok(tilted) };
    let overlap = start::overlap(level.axis);
    let simple = overlap >= 0.0 && level.solution.freedom <= tilted.solution.freedom;
    if sought.axis.is_none() && overlap < TESTED && !simple {
        return Ok(tilted);
    }
    let best = if score(&tilted) < score(&level) { &tilted } else { &level };
    let gain = TILT_GAIN * if scan.plane { 2.0 } else { 1.0 } * of_noise(best) * best.inflation;
    Ok(if squares(&level) <= squares(best) + gain { level } else { tilted })
}
