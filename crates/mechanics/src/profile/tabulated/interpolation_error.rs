//! The error of the curve through a table, by what each of its gaps leaves open of f'.
//!
//! An error e of f' with a mean of zero over a gap a..b of the width h moves g(x) = x int f' dr/sqrt(x^2 - r^2) by up
//! to some e sqrt(2 x h) at the end of the gap, and beyond it less and less, like (h/(h + x - b))^(3/2); and the load,
//! int e sqrt(c^2 - r^2) dr of a contact of the radius c, by up to some h times that, and beyond it like (h/(h + c -
//! b))^(1/2). Of many gaps the squares add up. A step T of f' adds (pi/2) T arcosh to the kernel of the pressure. The
//! factors are fitted to random tables (`tests/physics/open_gaps.rs`).

use crate::profile::open_gaps::open_slopes;

/// The factors of the errors of g and of the load.
const OF_LEVEL: f64 = 0.05;
const OF_LOAD: f64 = 0.15;
/// The share of the error of the load that is left just beyond a gap.
const BEYOND: f64 = 0.5;

/// The interpolation error in a contact of one radius.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InterpolationError {
    /// Error of int X dy up to the level of the contact, m^2: a force over 2 E*.
    pub load: f64,
    /// Error of the level g of the radius, m.
    pub level: f64,
    /// Largest error of the kernel, pure number.
    pub kernel: f64,
}

impl InterpolationError {
    /// Of two profiles added up.
    #[must_use]
    pub fn and(self, other: InterpolationError) -> InterpolationError {
        let InterpolationError { load, level, kernel } = other;
        InterpolationError { load: self.load + load, level: self.level + level, kernel: self.kernel + kernel }
    }
}

/// An error by the gaps below a radius, and how far that is from the lower end of the one that counts most, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct GapError {
    size: f64,
    distance: f64,
}

impl GapError {
    /// The same further out by `width`, m, less by the function `fall` of the distance, with the error `own`
    /// of the gap between.
    fn and(self, own: f64, width: f64, fall: fn(f64) -> f64) -> GapError {
        let distance = self.distance + width;
        let rest = self.size * fall(self.distance / distance);
        GapError { size: (rest * rest + own * own).sqrt(), distance: if own > rest { width } else { distance } }
    }
}

/// A gap of a table: where it begins, m, the error of f' in it, and the errors there by those below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TableGap {
    start: f64,
    slope: f64,
    load: GapError,
    level: GapError,
    steepest: f64,
}

impl TableGap {
    /// The errors of the level and of the load that the part of the gap up to a radius leaves there.
    fn own(&self, radius: f64) -> (f64, f64) {
        let width = radius - self.start;
        let level = self.slope * (2.0 * radius * width).sqrt();
        (OF_LEVEL * level, OF_LOAD * level * width)
    }

    /// The gap that follows, which begins at `end`, m.
    fn next(&self, end: f64, slope: f64) -> TableGap {
        let ((level, load), width) = (self.own(end), end - self.start);
        TableGap {
            start: end,
            slope,
            load: self.load.and(BEYOND * load, width, f64::sqrt),
            level: self.level.and(level, width, |share| share * share.sqrt()),
            steepest: self.steepest.max(slope),
        }
    }
}

/// The gaps of a table.
pub(super) fn gaps(radii: &[f64], heights: &[f64]) -> Vec<TableGap> {
    // f is even.
    let points = radii.iter().zip(heights).map(|(&r, &z)| (r, z));
    let mirrored: Vec<(f64, f64)> = points.clone().skip(1).map(|(r, z)| (-r, z)).rev().chain(points).collect();
    let slopes = open_slopes(&mirrored, radii.len() - 1);
    let (load, level) = (GapError::default(), GapError::default());
    let mut gaps = vec![TableGap { start: 0.0, slope: slopes[0], load, level, steepest: slopes[0] }];
    for (&end, &slope) in radii[1..].iter().zip(&slopes[1..]) {
        gaps.push(gaps[gaps.len() - 1].next(end, slope));
    }
    gaps
}

/// The error in a contact of this radius, m.
pub(super) fn at(gaps: &[TableGap], radius: f64) -> InterpolationError {
    let Some(gap) = gaps.get(gaps.partition_point(|gap| gap.start < radius).saturating_sub(1)) else {
        return InterpolationError::default();
    };
    let ((level, load), width) = (gap.own(radius), (radius - gap.start).max(f64::MIN_POSITIVE));
    InterpolationError {
        load: gap.load.and(load, width, f64::sqrt).size,
        level: gap.level.and(level, width, |share| share * share.sqrt()).size,
        kernel: std::f64::consts::FRAC_PI_2 * gap.steepest,
    }
}
