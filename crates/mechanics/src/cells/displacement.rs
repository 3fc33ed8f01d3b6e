//! The displacement of the surface over weighted rings of cells, at many radii.
//!
//! u = (2/pi) int v dx/sqrt(r^2 - x^2), v straight in g over each ring, becomes by parts a sum over the same sources dg
//! as that of the stress, each with the weight dv/dg of its ring and an angle as kernel, which is smooth below r:
//!
//! u = v(0) + (2/pi) int arccos(x/r) dv inside the contact, u = (2/pi) (v(a) arcsin(a/r) - int arcsin(x/r) dv) outside.

use std::f64::consts::FRAC_2_PI;

use super::field::SumAndSize;
use super::kernel::Kernel;
use super::ring::{Point, StressRadius};

/// u, m, at each radius, by the weighted sums of an angle over the rings up to `edge`, and v at the centre and at the
/// edge, m.
pub(crate) fn displacements(
    edge: &Point,
    (centre, end): (f64, f64),
    radii: &[StressRadius],
    sums: impl Fn(Kernel, &[StressRadius]) -> Vec<SumAndSize>,
) -> Vec<f64> {
    let (inside, outside): (Vec<_>, Vec<_>) = radii.iter().copied().partition(|at| at.square <= edge.square);
    let of = |angle, radii: &[StressRadius]| sums(angle, radii).into_iter().map(|(sum, _)| sum);
    let (mut inside, mut outside) = (of(Kernel::Arccos, &inside), of(Kernel::Arcsin, &outside));
    let displacement = |at: &StressRadius| {
        if at.square <= edge.square {
            inside.next().map(|sum| centre + FRAC_2_PI * sum)
        } else {
            let angle = edge.radius.atan2((at.square - edge.square).value().sqrt());
            outside.next().map(|sum| FRAC_2_PI * (end * angle - sum))
        }
    };
    radii.iter().filter_map(displacement).collect()
}
