//! Hertz's parabola f = r^2/(2R): g(x) = x^2/R, K(r, c) = (2/R) sqrt(c^2 - r^2).
//!
//! Moves and stresses follow from one difference, x_outer^2 - x_inner^2 = R (y_outer - y_inner), which is never taken
//! between rounded radii (Hertz 1881; Popov & Heß 2015): closed forms, for speed alone.

#[cfg(test)]
use super::call_count;
use super::field::SumAndSize;
use super::ring::{Moments, Point, Ring, StressRadius};
use super::span::Span;
use crate::numerics::double_double::DoubleDouble;

/// Radii that are summed for side by side.
const LANES: usize = 8;
/// Squares of radii that differ by less, over that of the outer one, have lost digits that the depth of their ring has.
const THIN: f64 = 1e-3;

/// A paraboloid of revolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Parabola {
    /// R, m, at its tip.
    pub(crate) curvature_radius: f64,
}

impl Parabola {
    /// A level with its radius.
    #[inline]
    pub(crate) fn point(&self, level: DoubleDouble) -> Point {
        let square = level * self.curvature_radius;
        Point { level, radius: square.value().sqrt(), square }
    }

    /// The level at which int X dy is this load, m^2.
    pub(crate) fn indentation_for(&self, load: f64) -> f64 {
        let radius = (1.5 * load * self.curvature_radius).cbrt();
        radius * radius / self.curvature_radius
    }

    /// The difference of the squares of the radii of a ring, m^2.
    #[inline]
    pub(crate) fn gap(&self, ring: &Ring) -> f64 {
        if ring.depth > 0.0 { self.curvature_radius * ring.depth } else { 0.0 }
    }

    /// The moments of a ring, which follow from its depth and its two radii.
    #[inline]
    pub(crate) fn moments(&self, ring: &Ring) -> Moments {
        let (gap, outer) = (self.gap(ring), ring.outer.radius);
        let width = if gap > 0.0 { gap / (ring.inner.radius + outer) } else { 0.0 };
        let area = width * width / self.curvature_radius;
        Moments {
            width,
            first: area * (outer - width / 3.0),
            second: area
                * (width / self.curvature_radius)
                * ((4.0 / 3.0 * outer - width) * outer + width * width / 5.0),
        }
    }

    /// The kernel of a ring.
    pub(crate) fn kernel(&self, at: &StressRadius, ring: &Ring) -> f64 {
        self.share::<false>(&Span::of(ring, self.gap(ring), 0.0), at)
    }

    /// Its derivative with respect to r^2, 1/m^2, from the right.
    pub(crate) fn kernel_slope(&self, at: &StressRadius, ring: &Ring) -> f64 {
        self.share::<true>(&Span::of(ring, self.gap(ring), 0.0), at)
    }

    fn share<const SLOPE: bool>(&self, span: &Span, at: &StressRadius) -> f64 {
        let (inner, outer) = span.excess(at.square);
        if outer <= 0.0 {
            return 0.0;
        }
        let (low, high) = (inner.max(0.0).sqrt(), outer.sqrt());
        difference::<SLOPE>(low, high, if inner > 0.0 { span.gap } else { outer }) * 2.0 / self.curvature_radius
    }

    /// The sums of the kernels, or of their derivatives with respect to r^2, of weighted rings from the centre outward,
    /// at radii in rising order.
    pub(crate) fn sums<const SLOPE: bool>(&self, rings: &[(Ring, f64)], radii: &[StressRadius]) -> Vec<SumAndSize> {
        let mut sums = vec![(0.0, 0.0); radii.len()];
        let Some((outermost, _)) = rings.last() else { return sums };
        let ends = rings.iter().rev().map(|(ring, weight)| self.ball_ring(ring, *weight)).collect();
        let inward = InwardRings { edge: outermost.outer.square, rings: ends };
        inward.add::<SLOPE>(radii, &mut sums);
        let unit = 2.0 / self.curvature_radius;
        sums.into_iter().map(|(sum, size)| (unit * sum, unit * size)).collect()
    }

    fn ball_ring(&self, ring: &Ring, weight: f64) -> BallRing {
        let plain = (ring.outer.square - ring.inner.square).value();
        let thin = plain <= THIN * ring.outer.square.value();
        BallRing { end: ring.inner.square, gap: if thin { self.gap(ring) } else { plain }, thin, weight }
    }
}

/// A ring by the square of its inner end, m^2.
struct BallRing {
    end: DoubleDouble,
    /// Difference of the squares, m^2.
    gap: f64,
    /// Whether that has digits that the squares have lost.
    thin: bool,
    weight: f64,
}

/// Rings from the edge, whose square is given, m^2, inward.
struct InwardRings {
    edge: DoubleDouble,
    rings: Vec<BallRing>,
}

impl InwardRings {
    /// Adds R/2 times what they do at radii in rising order.
    fn add<const SLOPE: bool>(&self, radii: &[StressRadius], sums: &mut [SumAndSize]) {
        let edge = self.edge.parts();
        for (radii, sums) in radii.chunks(LANES).zip(sums.chunks_mut(LANES)) {
            // Lanes left over repeat the last.
            let square: [_; LANES] = std::array::from_fn(|lane| radii[lane.min(radii.len() - 1)].square.parts());
            let excess = |end: (f64, f64)| square.map(|(high, low)| (end.0 - high) + (end.1 - low));
            let (mut sum, mut size) = ([0.0; LANES], [0.0; LANES]);
            let mut v_high = excess(edge).map(root_of);
            for ring in &self.rings {
                #[cfg(test)]
                call_count::add(|calls| if SLOPE { &mut calls.kernel_slope } else { &mut calls.kernel });
                let end = ring.end.parts();
                let below = excess(end);
                let v_low = below.map(root_of);
                if ring.thin {
                    for lane in 0..LANES {
                        if below[lane] > -0.5 * ring.gap {
                            v_high[lane] = root_of(below[lane] + ring.gap);
                        }
                    }
                }
                for lane in 0..LANES {
                    let gap = if below[lane] > 0.0 { ring.gap } else { v_high[lane] * v_high[lane] };
                    let kernel = difference::<SLOPE>(v_low[lane], v_high[lane], gap);
                    let term = if v_high[lane] > 0.0 { ring.weight * kernel } else { 0.0 };
                    sum[lane] += term;
                    if SLOPE {
                        size[lane] += term.abs();
                    }
                }
                v_high = v_low;
                if end.0 < square[0].0 {
                    break;
                }
            }
            for (lane, total) in sums.iter_mut().enumerate() {
                *total = (total.0 + sum[lane], total.1 + size[lane]);
            }
        }
    }
}

/// The difference of two roots, given that of their squares; or its derivative with respect to r^2, from the right
/// where the lower one is zero.
#[inline]
fn difference<const SLOPE: bool>(low: f64, high: f64, gap: f64) -> f64 {
    if !SLOPE {
        gap / (high + low)
    } else if low > 0.0 {
        0.5 * gap / (high * low * (high + low))
    } else {
        -0.5 / high
    }
}

/// The root of a positive number, and zero of all else.
fn root_of(square: f64) -> f64 {
    (if square > 0.0 { square } else { 0.0 }).sqrt()
}
