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

/// An axis with less of the scan on its other side, in half the extent, is not taken for one without a tilt.
const ONE_SIDED: f64 = 0.25;
/// Axes farther from each other than this, in half the extent, are two.
const OTHER_AXIS: f64 = 0.1;
/// Heights of two curves that differ by this share are two shapes.
const OTHER_SHAPE: f64 = 0.1;
/// Squares that are larger by this factor may be those of a tip that the intervals round.
const NEARLY: f64 = 25.0;
/// Axes along a line from which further fits start, in half the extent.
const FURTHER: [f64; 5] = [-0.6, -0.3, 0.0, 0.3, 0.6];
/// Degrees of freedom that differ by less are as many.
const AS_FREE: f64 = 0.5;

/// Fits the scan; with the fit about another axis that the scan does not exclude, if there is one.
pub(super) fn fit(
    scan: &Scaled,
    sought: &Sought,
    keep_going: &dyn Fn() -> bool,
) -> Result<(Fitted, Option<Fitted>), Error> {
    let starts = match sought.axis {
        Some(axis) => Starts { level: Some(axis), tilted: vec![axis] },
        None => start::axes(scan, keep_going).ok_or(Error::Interrupted)?,
    };
    let from = |axis, tilt| Turns::new(scan, sought, tilt, keep_going).run(axis);
    let level = starts.level.ok_or(Error::Hollow).and_then(|axis| from(axis, false));
    if !sought.tilt || matches!(level, Err(Error::Interrupted)) {
        return level.map(|level| (level, None));
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
    let best = (0..tilted.len()).min_by(|a, b| score(&tilted[*a]).total_cmp(&score(&tilted[*b])));
    let Some(best) = best else { return level.map(|level| (level, None)) };
    let best = tilted.swap_remove(best);
    // The noise that a gain in squares is compared with is that of the better fit: what a tilt that was left in makes
    // of the other's residual looks like correlated noise.
    let gain = |better: &Fitted| TILT_GAIN * if scan.plane { 2.0 } else { 1.0 } * of_noise(better) * better.inflation;
    // A tilt is believed only where the scan shows it. Near the edge the axis without a tilt could be that of a flank.
    let is_level = |level: &Fitted| {
        let overlap = start::overlap(level.axis);
        let simple = overlap >= 0.0 && level.solution.freedom <= best.solution.freedom;
        let better = if score(&best) < score(level) { &best } else { level };
        (sought.axis.is_some() || overlap >= ONE_SIDED || simple) && squares(level) <= squares(better) + gain(better)
    };
    let (chosen, is_level) = match level {
        Ok(level) if is_level(&level) => {
            tilted.push(best);
            (level, true)
        }
        Ok(level) => {
            tilted.push(level);
            (best, false)
        }
        Err(_) => (best, false),
    };
    if sought.axis.is_some() {
        return Ok((chosen, None));
    }
    // Of a parabola any axis fits with a tilt, and the shape is the same; a flank fits with more freedom.
    let fits = |other: &Fitted| {
        let apart = (0..2).any(|index| (other.axis[index] - chosen.axis[index]).abs() > OTHER_AXIS);
        let tested = start::overlap(other.axis) >= ONE_SIDED;
        let as_free = other.solution.freedom <= chosen.solution.freedom + AS_FREE;
        let as_well = as_free && squares(other) <= squares(&chosen) + gain(&chosen);
        // Without a tilt a tip that is sharper than the intervals leaves more than noise, and is the likelier shape.
        let is_untilted = other.tilt.iter().all(|slope| slope.abs() <= 0.0);
        apart && tested && (as_well || is_untilted && squares(other) <= NEARLY * squares(&chosen))
    };
    let is_doubtful = !is_level || start::overlap(chosen.axis) < TESTED;
    if !is_doubtful {
        return Ok((chosen, None));
    }
    // Along a line nothing but both flanks tests an axis, and the coarse curves may have missed one that fits.
    for place in if scan.plane { &[][..] } else { &FURTHER } {
        match from([*place, 0.0], true) {
            Err(Error::Interrupted) => return Err(Error::Interrupted),
            Ok(fitted) => tilted.push(fitted),
            Err(_) => {}
        }
    }
    let other = tilted.into_iter().filter(|other| fits(other) && difference(&chosen, other) > OTHER_SHAPE);
    // Errors that hold the one that is most different hold the others as a rule.
    let other = other.max_by(|a, b| difference(&chosen, a).total_cmp(&difference(&chosen, b)));
    Ok((chosen, other))
}

/// By which share of their heights two curves differ, halfway to where the shorter ends.
fn difference(one: &Fitted, other: &Fitted) -> f64 {
    let half = 0.5 * one.curve.end().min(other.curve.end());
    let [a, b] = [one, other].map(|fitted| fitted.curve.height(half) - fitted.curve.offset);
    (a - b).abs() / a.abs().max(b.abs()).max(f64::MIN_POSITIVE)
}
