//! Multiaxial fatigue criteria over the stresses of one closed cycle, tension positive.
//!
//! | criterion | value | unit |
//! |---|---|---|
//! | Crossland (1956) | sqrt(J2a) + alpha max hydrostatic stress | Pa |
//! | Dang Van (1973) | max over instants of \[Tresca shear of (deviator - centre) + alpha hydrostatic stress\] | Pa |
//! | Findley (1959) | max over planes of \[tau_a + k max sigma_n\] | Pa |
//! | Smith, Watson & Topper (1970) | max over planes of max sigma_n (range of eps_n)/2; zero without tension | Pa |
//! | Fatemi & Socie (1988) | max over planes of gamma_a max(0, 1 + k max sigma_n/sigma_y), gamma_a = tau_a/G | – |
//!
//! sqrt(J2a) is the radius of the smallest ball around the deviators over sqrt(2), and the centre is that of this ball.
//! Tresca shear is half the difference of the outer principal stresses; sigma_n and eps_n are the normal stress and
//! strain of a plane; tau_a is the radius of the smallest circle around the path of the shear stress in the plane.
//! Strains are elastic (Hooke). Planes are searched for on a grid of five degrees and refined from its peaks to about
//! 1e-9 of the value. Of random paths, one in ten thousand has a narrow peak between the planes of the grid that the
//! search misses; the value is then too low, by 0.4 % at most of those seen. [`Cycle`] gives the stresses, [`Study`]
//! each [`Measure`] of them at the instants that matter, [`CriticalDistance`] the same below the surface, [`LifeCurve`]
//! the cycles that a value leaves.

mod ball;
mod critical_distance;
mod curve;
mod cycle;
mod life;
mod planes;
mod rating;
mod search;
mod study;

use std::f64::consts::SQRT_2;

use crate::range;
use crate::range::error::Error;
use crate::subsurface::Stress;
use ball::dot;
pub use ball::{Ball, enclosing_ball};
pub use critical_distance::CriticalDistance;
use curve::StressCurve;
pub use curve::{Instant, MAX_INSTANTS};
pub use cycle::{Cycle, MOST_BYTES};
pub use life::{LIVES, Life, LifeCurve, NoLife, StrainLife};
use planes::{Vector, axes, coarse_grid, unit};
pub use rating::{Measure, Rated};
pub use search::Worst;
pub use study::{Bulk, FIELD_BYTES, Largest, Ratings, Study};

/// sqrt(6).
const SQRT_6: f64 = 2.449_489_742_783_178;
/// Cosine of three degrees: planes of largest tension closer to the one before are not searched from.
const SAME_PLANE: f64 = 0.998_629_534_754_573_8;

/// A criterion with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Criterion {
    /// Amplitude of the deviator and largest hydrostatic stress.
    Crossland {
        /// Weight of the hydrostatic stress.
        alpha: f64,
    },
    /// Shear stress and hydrostatic stress at the same instant.
    DangVan {
        /// Weight of the hydrostatic stress.
        alpha: f64,
    },
    /// Shear amplitude and largest normal stress of the same plane.
    Findley {
        /// Weight of the normal stress.
        k: f64,
    },
    /// Largest normal stress times amplitude of the normal strain of the same plane.
    SmithWatsonTopper {
        /// Young's modulus, Pa.
        youngs_modulus: f64,
        /// Poisson's ratio.
        poisson: f64,
    },
    /// Amplitude of the engineering shear strain, raised by the normal stress of the same plane.
    FatemiSocie {
        /// Weight of the normal stress.
        k: f64,
        /// Yield stress, Pa.
        yield_stress: f64,
        /// Young's modulus, Pa.
        youngs_modulus: f64,
        /// Poisson's ratio.
        poisson: f64,
    },
}

impl Criterion {
    /// The criterion, if its parameters are in their ranges.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::FATIGUE_WEIGHT`], [`range::YIELD_STRESS`], [`range::YOUNGS_MODULUS`] and
    /// [`range::POISSON_RATIO`].
    pub fn checked(self) -> Result<Criterion, Error> {
        match self {
            Criterion::Crossland { alpha: weight }
            | Criterion::DangVan { alpha: weight }
            | Criterion::Findley { k: weight } => {
                range::FATIGUE_WEIGHT.check(weight)?;
            }
            Criterion::SmithWatsonTopper { youngs_modulus, poisson } => {
                range::YOUNGS_MODULUS.check(youngs_modulus)?;
                range::POISSON_RATIO.check(poisson)?;
            }
            Criterion::FatemiSocie { k, yield_stress, youngs_modulus, poisson } => {
                range::FATIGUE_WEIGHT.check(k)?;
                range::YIELD_STRESS.check(yield_stress)?;
                range::YOUNGS_MODULUS.check(youngs_modulus)?;
                range::POISSON_RATIO.check(poisson)?;
            }
        }
        Ok(self)
    }

    /// Its value over the stresses at the ends of the moves of a closed cycle. Zero for none; infinite where a stress
    /// is, with the first such instant.
    ///
    /// ```
    /// use stickslip_mechanics::Stress;
    /// use stickslip_mechanics::fatigue::Criterion;
    ///
    /// let cycle = [Stress { xx: 200e6, ..Stress::default() }, Stress { xx: -200e6, ..Stress::default() }];
    /// let crossland = Criterion::Crossland { alpha: 0.3 }.of(&cycle);
    /// assert!((crossland.value - (200e6 / 3f64.sqrt() + 0.3 * 200e6 / 3.0)).abs() < 1e-6);
    /// assert_eq!((crossland.plane, crossland.at.unwrap().step), (None, 0));
    /// ```
    #[must_use]
    pub fn of(&self, path: &[Stress]) -> Rated {
        if path.is_empty() {
            return Rated { value: 0.0, error: 0.0, plane: None, at: None };
        }
        if let Some(step) = path.iter().position(|stress| !stress.is_finite()) {
            return Rated { value: f64::INFINITY, error: 0.0, plane: None, at: Some(Instant { step, part: 1.0 }) };
        }
        Measure::Stress(*self).over(&StressCurve::of_list(path), 0.0, None)
    }

    /// Its value over finite stresses as [`Criterion::of`], but on the planes of a coarse grid alone: lower by some per
    /// cent. Where no plane reaches `least`, which is above zero, something between both.
    fn roughly(&self, path: &[Stress], least: f64) -> f64 {
        if matches!(self, Criterion::Crossland { .. } | Criterion::DangVan { .. }) {
            return self.of(path).value;
        }
        if least > 0.0 {
            let bound = self.bound(path);
            if bound < least {
                return bound;
            }
        }
        most(coarse_grid(&self.starts(path)).map(|normal| self.on_plane(path, normal).0)).1
    }

    /// What its value on any plane is not above: by the largest principal stress, and by the largest shear stress and
    /// strain about the middle of the path on any plane.
    fn bound(&self, path: &[Stress]) -> f64 {
        let most_of = |of: &dyn Fn(&Stress) -> f64| path.iter().map(of).fold(0.0, f64::max);
        let middle = path.iter().fold(Stress::default(), |sum, stress| sum + *stress) * (-1.0 / path.len() as f64);
        let tension = most_of(&|stress| stress.principal()[0]);
        let sheared = || most_of(&|stress| (*stress + middle).max_shear());
        match *self {
            Criterion::Crossland { .. } | Criterion::DangVan { .. } => f64::INFINITY,
            Criterion::Findley { k } => sheared() + k * tension,
            Criterion::SmithWatsonTopper { youngs_modulus, poisson } => {
                let strain = |stress: &Stress| {
                    let off = *stress + middle;
                    let [first, _, last] = off.principal().map(|along| (1.0 + poisson) * along);
                    let rest = 3.0 * poisson * off.hydrostatic();
                    (first - rest).abs().max((last - rest).abs())
                };
                tension * most_of(&strain) / youngs_modulus
            }
            Criterion::FatemiSocie { k, yield_stress, youngs_modulus, poisson } => {
                let shear_modulus = 0.5 * youngs_modulus / (1.0 + poisson);
                sheared() / shear_modulus * (1.0 + k * tension / yield_stress)
            }
        }
    }

    /// The planes that a search must not miss: of largest tension, where a criterion is cut off without.
    fn starts(&self, path: &[Stress]) -> Vec<Vector> {
        let mut tension: Vec<Vector> = match self {
            Criterion::SmithWatsonTopper { .. } | Criterion::FatemiSocie { .. } => {
                path.iter().map(tension_axis).collect()
            }
            _ => Vec::new(),
        };
        tension.dedup_by(|one, other| dot(one, other).abs() > SAME_PLANE);
        tension
    }

    /// The value on one plane, and the instant of the largest normal stress.
    fn on_plane(&self, path: &[Stress], normal: &Vector) -> (f64, usize) {
        let along = weights(normal, normal);
        let (instant, tension) = most(path.iter().map(|stress| resolved(stress, &along)));
        let value = match *self {
            Criterion::Crossland { .. } | Criterion::DangVan { .. } => 0.0,
            Criterion::Findley { k } => shear_amplitude(path, normal) + k * tension,
            Criterion::SmithWatsonTopper { .. } if tension <= 0.0 => 0.0,
            Criterion::SmithWatsonTopper { youngs_modulus, poisson } => {
                let strain = |stress: &Stress| strained(stress, &along, poisson);
                let (_, longest) = most(path.iter().map(strain));
                let (_, shortest) = most(path.iter().map(|stress| -strain(stress)));
                tension * 0.5 * (longest + shortest) / youngs_modulus
            }
            Criterion::FatemiSocie { k, yield_stress, youngs_modulus, poisson } => {
                let factor = 1.0 + k * tension / yield_stress;
                if factor <= 0.0 {
                    0.0
                } else {
                    let shear_modulus = 0.5 * youngs_modulus / (1.0 + poisson);
                    shear_amplitude(path, normal) / shear_modulus * factor
                }
            }
        };
        (value, instant)
    }
}

/// The normal strain on a plane times Young's modulus, Pa.
fn strained(stress: &Stress, along: &[f64; 6], poisson: f64) -> f64 {
    (1.0 + poisson) * resolved(stress, along) - 3.0 * poisson * stress.hydrostatic()
}

/// The normal of a plane that points downwards, into the body.
fn upward(normal: Vector) -> Vector {
    if normal[2] < 0.0 { normal.map(|part| -part) } else { normal }
}

/// The largest of some values, at least one, and its index, the first of equal ones.
fn most(values: impl Iterator<Item = f64>) -> (usize, f64) {
    values.enumerate().fold((0, f64::NEG_INFINITY), |most, next| if next.1 > most.1 { next } else { most })
}

/// The stress of a deviator in that basis.
fn from_deviator(&[first, second, xy, yz, xz]: &[f64; 5]) -> Stress {
    let (equal, rest) = (first / SQRT_2, second / SQRT_6);
    let components = [equal - rest, -equal - rest, 2.0 * rest, xy / SQRT_2, yz / SQRT_2, xz / SQRT_2];
    Stress::from_components(components)
}

/// The deviator in an orthonormal basis: its length is sqrt(s : s).
fn deviator(stress: &Stress) -> [f64; 5] {
    let Stress { xx, yy, zz, xy, yz, xz } = *stress;
    [(xx - yy) / SQRT_2, ((zz - xx) + (zz - yy)) / SQRT_6, SQRT_2 * xy, SQRT_2 * yz, SQRT_2 * xz]
}

/// The weights of the components of a stress in its part along `one` on the plane of `other`.
fn weights([a, b, c]: &Vector, [x, y, z]: &Vector) -> [f64; 6] {
    [a * x, b * y, c * z, a * y + b * x, b * z + c * y, a * z + c * x]
}

/// The weights of the components in two shear stresses on a plane, at right angles to each other.
fn shear_axes(normal: &Vector) -> [[f64; 6]; 2] {
    axes(normal).map(|axis| weights(&axis, normal))
}

fn resolved(stress: &Stress, [xx, yy, zz, xy, yz, xz]: &[f64; 6]) -> f64 {
    (xx * stress.xx + yy * stress.yy + zz * stress.zz) + (xy * stress.xy + yz * stress.yz + xz * stress.xz)
}

/// The radius of the smallest circle around the shear stresses of a path in a plane.
fn shear_amplitude(path: &[Stress], normal: &Vector) -> f64 {
    let [one, two] = shear_axes(normal);
    let shears: Vec<[f64; 2]> = path.iter().map(|stress| [resolved(stress, &one), resolved(stress, &two)]).collect();
    enclosing_ball(&shears).radius
}

/// The normal of a plane on which a stress has the largest tension.
fn tension_axis(stress: &Stress) -> Vector {
    let first = stress.principal()[0];
    let Stress { xx, yy, zz, xy, yz, xz } = *stress;
    let rows = [[xx - first, xy, xz], [xy, yy - first, yz], [xz, yz, zz - first]];
    // At right angles to all three rows; two equal principal stresses leave it to chance.
    let crossed = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| cross(&rows[i], &rows[j]));
    let (longest, square) = most(crossed.iter().map(|axis| dot(axis, axis)));
    if square > 0.0 { unit(&crossed[longest]) } else { [0.0, 0.0, 1.0] }
}

fn cross([a, b, c]: &Vector, [x, y, z]: &Vector) -> Vector {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

#[cfg(test)]
mod tests {
    use super::Criterion;
    use crate::Stress;

    #[test]
    fn no_plane_exceeds_the_bound_and_no_start_is_passed_over() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let (youngs_modulus, poisson) = (2.1e11, 0.3);
        let criteria = [
            Criterion::Findley { k: 0.3 },
            Criterion::SmithWatsonTopper { youngs_modulus, poisson },
            Criterion::FatemiSocie { k: 0.5, yield_stress: 5e8, youngs_modulus, poisson },
        ];
        for _ in 0..30 {
            let path: Vec<Stress> = (0..9).map(|_| Stress::from_components([0; 6].map(|_| 1e9 * random()))).collect();
            for criterion in criteria {
                let (value, rough) = (criterion.of(&path).value, criterion.roughly(&path, 0.0));
                assert!(rough <= value && rough >= 0.9 * value, "{criterion:?}: {rough} of {value}");
                assert!(value <= criterion.bound(&path) * (1.0 + 1e-12), "{criterion:?}");
                let above = criterion.roughly(&path, 2.0 * value);
                assert!(rough <= above && above <= 1.0001 * criterion.bound(&path), "{criterion:?}");
            }
        }
    }
}
