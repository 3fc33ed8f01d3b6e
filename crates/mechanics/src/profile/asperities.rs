//! Many Hertzian asperities on one rigid motion, which do not interact elastically: X(y) = sum sqrt(R_i (y - h_i)) over the gaps
//! h_i < y (Greenwood & Williamson 1966; with friction by Ciavarella 1998 and Jaeger 1998).
//!
//! Each asperity that is touched adds the moments of a parabola from its own tip on, so that a thin ring keeps its digits. Those
//! whose gaps lie far below the level are summed as the few that [`FarField`] replaces them by: a sum costs the logarithm of
//! their number.

use std::ops::Range;
use std::sync::Arc;

use super::curve_family::CurveFamily;
use super::far_field::FarField;
use super::roots::increasing;
use super::{DoubleDouble, Error, Moments, Ring, range};
use crate::error::CurveFault;

/// Asperities in the smallest cluster: fewer are summed one by one sooner than as the twenty points of a cluster.
const LEAF: usize = 32;

/// Asperities that are summed side by side.
const LANES: usize = 4;

/// A set of asperities; copies share it.
#[derive(Clone, Debug, PartialEq)]
pub struct Asperities(Arc<Set>);

#[derive(Debug, PartialEq)]
struct Set {
    /// Gaps above the smallest, m, rising, and sqrt(R), m^(1/2), of each.
    gaps: Vec<f64>,
    roots: Vec<f64>,
    clusters: FarField,
    /// The sum of all sqrt(R), m^(1/2).
    total: f64,
}

impl Asperities {
    /// Parabolas of these radii of curvature, m, one for all or one each, whose tips are this far, m, from the flat. An offset of
    /// the gaps does not matter: indentations count from the first touch.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::ASPERITIES`], [`range::RADIUS`] and [`range::GAP`], [`Error::Curve`] for radii and gaps
    /// that differ in number.
    ///
    /// ```
    /// use stickslip_mechanics::profile::{Asperities, Profile};
    ///
    /// let three = Profile::Asperities(Asperities::new(&[1e-4], &[0.0, 0.0, 2e-6])?);
    /// // At 1 um two of them carry, each like a ball: X = 2 sqrt(R d).
    /// assert!((three.radius(1e-6) - 2e-5).abs() < 1e-19);
    /// # Ok::<(), stickslip_mechanics::Error>(())
    /// ```
    pub fn new(radii: &[f64], gaps: &[f64]) -> Result<Asperities, Error> {
        range::ASPERITIES.check(gaps.len() as f64)?;
        if radii.len() != 1 && radii.len() != gaps.len() {
            return Err(Error::Curve { fault: CurveFault::LengthsDiffer, index: radii.len().min(gaps.len()) });
        }
        for (radii, range) in [(radii, range::RADIUS), (gaps, range::GAP)] {
            radii.iter().try_for_each(|&number| range.check(number).map(drop))?;
        }
        let mut set: Vec<(f64, f64)> =
            gaps.iter().zip(radii.iter().cycle()).map(|(&gap, radius)| (gap, radius.sqrt())).collect();
        set.sort_by(|a, b| a.0.total_cmp(&b.0));
        let first = set[0].0;
        let (gaps, roots): (Vec<f64>, Vec<f64>) = set.into_iter().map(|(gap, root)| (gap - first, root)).unzip();
        let bounds: Vec<f64> = gaps.iter().chain(gaps.last()).copied().collect();
        let clusters = FarField::new(&bounds, LEAF, |index, add| add(gaps[index], roots[index]));
        let total = roots.iter().sum();
        Ok(Asperities(Arc::new(Set { gaps, roots, clusters, total })))
    }

    /// How many.
    #[must_use]
    pub fn count(&self) -> usize {
        self.0.gaps.len()
    }

    /// How many are touched at a level.
    fn touched(&self, level: DoubleDouble) -> usize {
        self.0.gaps.partition_point(|&gap| above(level, gap) > 0.0)
    }

    /// The sums over some asperities of what one gives by sqrt(R) and its gap, which is smooth in the gap up to `level` alone.
    fn sum<const N: usize>(
        &self,
        some: Range<usize>,
        level: DoubleDouble,
        term: impl Fn(f64, f64) -> [f64; N],
    ) -> [f64; N] {
        let set = &*self.0;
        let (mut far, mut near) = ([[0.0; LANES]; N], [[0.0; LANES]; N]);
        let here = level.value();
        set.clusters.visit_clusters(
            some,
            (here, here),
            &mut |gaps, roots| add(&mut far, gaps, roots, &term),
            &mut |items| add(&mut near, &set.gaps[items.clone()], &set.roots[items], &term),
        );
        std::array::from_fn(|index| far[index].iter().sum::<f64>() + near[index].iter().sum::<f64>())
    }

    /// The same over all that are touched.
    fn sum_below<const N: usize>(&self, level: DoubleDouble, term: impl Fn(f64, f64) -> [f64; N]) -> [f64; N] {
        self.sum(0..self.touched(level), level, term)
    }

    /// X and its slope.
    fn radius_and_rate(&self, level: DoubleDouble) -> [f64; 2] {
        self.sum_below(level, |root, gap| {
            let depth = above(level, gap).sqrt();
            [root * depth, 0.5 * root / depth]
        })
    }

    /// int_0^y X dy, and X.
    fn load_and_radius(&self, level: DoubleDouble) -> [f64; 2] {
        self.sum_below(level, |root, gap| {
            let depth = above(level, gap);
            let radius = root * depth.sqrt();
            [radius * depth / 1.5, radius]
        })
    }

    /// The level at which a function that rises from zero, given with its slope, has this value; `least` is no larger.
    fn invert(&self, target: f64, least: f64, value: impl Fn(&Asperities, DoubleDouble) -> [f64; 2]) -> f64 {
        if target <= 0.0 {
            return 0.0;
        }
        // Between two gaps it is smooth.
        let gaps = &self.0.gaps;
        let index = gaps.partition_point(|&gap| value(self, gap.into())[0] < target);
        let base = gaps[index.saturating_sub(1)];
        let room = gaps.get(index).map_or(f64::INFINITY, |next| next - base);
        let guess = if least > base { least - base } else { room.min(least) };
        let step = increasing(guess, |step| {
            let [here, slope] = value(self, DoubleDouble::sum(base, step));
            (here - target, slope)
        });
        base + step.min(room)
    }
}

/// Adds the terms side by side, because roots and divisions take long and one need not wait for another's.
fn add<const N: usize>(
    sums: &mut [[f64; LANES]; N],
    gaps: &[f64],
    roots: &[f64],
    term: &impl Fn(f64, f64) -> [f64; N],
) {
    let (gaps, roots) = (gaps.chunks(LANES), roots.chunks(LANES));
    for (gaps, roots) in gaps.zip(roots) {
        // Lanes left over weigh nothing.
        let (mut gap, mut root) = ([gaps[0]; LANES], [0.0; LANES]);
        gap[..gaps.len()].copy_from_slice(gaps);
        root[..roots.len()].copy_from_slice(roots);
        for lane in 0..LANES {
            for (sum, one) in sums.iter_mut().zip(term(root[lane], gap[lane])) {
                sum[lane] += one;
            }
        }
    }
}

/// How far a level lies above a gap, m: to round-off of itself, however near.
fn above(level: DoubleDouble, gap: f64) -> f64 {
    let (whole, rest) = level.parts();
    (whole - gap) + rest
}

impl CurveFamily for Asperities {
    fn radius_at(&self, level: DoubleDouble) -> f64 {
        self.sum_below(level, |root, gap| [root * above(level, gap).sqrt()])[0]
    }

    fn rate(&self, level: f64) -> f64 {
        self.radius_and_rate(level.into())[1]
    }

    fn level_of(&self, radius: f64) -> f64 {
        let least = radius / self.0.total;
        self.invert(radius, least * least, Asperities::radius_and_rate)
    }

    fn moments_of(&self, ring: &Ring) -> Moments {
        let (inner, outer) = (ring.inner.level, ring.outer.level);
        let moments = |root: f64, gap: f64| {
            // The ring of a parabola x^2 = R (y - h), over sqrt(R): see `sphere.rs`.
            let depth = above(outer, gap);
            let edge = depth.sqrt();
            let width = ring.depth.min(depth) / (edge + above(inner, gap).max(0.0).sqrt());
            let area = root * width * width;
            let lever = (4.0 / 3.0 * edge - width) * edge + 0.2 * width * width;
            [root * width, area * (edge - 1.0 / 3.0 * width), area * width * lever]
        };
        // Of those touched within the ring, only the outer level is seen.
        let (before, after) = (self.touched(inner), self.touched(outer));
        let (old, new) = (self.sum(0..before, inner, moments), self.sum(before..after, outer, moments));
        let [width, first, second] = std::array::from_fn(|index| old[index] + new[index]);
        Moments { width, first, second }
    }

    fn indentation_of(&self, load: f64) -> f64 {
        let least = (1.5 * load / self.0.total).cbrt();
        self.invert(load, least * least, Asperities::load_and_radius)
    }
}
