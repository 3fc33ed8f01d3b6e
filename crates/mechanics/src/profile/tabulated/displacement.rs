//! The displacement of the surface over the rings of a table, at many radii.
//!
//! u = (2/pi) int v dx/sqrt(r^2 - x^2), v straight in g over each ring, becomes by parts a sum over the same sources dg
//! as that of the stress, each with the weight dv/dg of its ring and an angle as kernel, which is smooth below r:
//!
//! u = v(0) + (2/pi) int arccos(x/r) dv inside the contact, u = (2/pi) (v(a) arcsin(a/r) - int arcsin(x/r) dv) outside.

use std::f64::consts::FRAC_2_PI;

use super::kernel::Kernel;
use super::{Ring, StressRadius, WeightedPanels};

/// u, m, at each radius, for rings from the centre to the edge with their dv/dg, and v at the centre and at the edge,
/// m; `None` with levels at a vertical edge.
pub(super) fn displacements(
    panels: WeightedPanels<'_>,
    rings: &[(Ring, f64)],
    (centre, end): (f64, f64),
    radii: &[StressRadius],
) -> Option<Vec<f64>> {
    let edge = rings.last()?.0.outer;
    let (inside, outside): (Vec<_>, Vec<_>) = radii.iter().copied().partition(|at| at.square <= edge.square);
    let sums = |angle, radii: &[StressRadius]| panels.sums(angle, radii).into_iter().map(|(sum, _)| sum);
    let (mut inside, mut outside) = (sums(Kernel::Arccos, &inside), sums(Kernel::Arcsin, &outside));
    let displacement = |at: &StressRadius| {
        if at.square <= edge.square {
            Some(centre + FRAC_2_PI * inside.next()?)
        } else {
            Some(FRAC_2_PI * (end * edge.radius.atan2((at.square - edge.square).value().sqrt()) - outside.next()?))
        }
    };
    radii.iter().map(displacement).collect()
}
