//! The stress tensor and its invariants.

use super::kernel::{NormalKernels, TangentialKernels};

/// A symmetric stress tensor, Pa, tension positive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stress {
    /// Normal stress along x.
    pub xx: f64,
    /// Normal stress along y.
    pub yy: f64,
    /// Normal stress along z.
    pub zz: f64,
    /// Shear stress in the plane of x and y.
    pub xy: f64,
    /// Shear stress in the plane of y and z.
    pub yz: f64,
    /// Shear stress in the plane of x and z.
    pub xz: f64,
}

impl Stress {
    /// From the ten functions at (x, y), lengths over the contact radius.
    pub(super) fn of(x: f64, y: f64, p: &NormalKernels, q: &TangentialKernels) -> Stress {
        Stress {
            xx: p[0] + x * x * p[1] + x * (q[0] + 2.0 * q[1] + x * x * q[2]),
            yy: p[0] + y * y * p[1] + x * (q[0] + y * y * q[2]),
            zz: p[2] + x * q[3],
            xy: x * y * p[1] + y * (q[1] + x * x * q[2]),
            yz: y * p[3] + x * y * q[4],
            xz: x * p[3] + q[5] + x * x * q[4],
        }
    }

    /// The components xx, yy, zz, xy, yz, xz, Pa.
    #[must_use]
    pub fn components(&self) -> [f64; 6] {
        [self.xx, self.yy, self.zz, self.xy, self.yz, self.xz]
    }

    /// From xx, yy, zz, xy, yz, xz, Pa.
    #[must_use]
    pub fn from_components([xx, yy, zz, xy, yz, xz]: [f64; 6]) -> Stress {
        Stress { xx, yy, zz, xy, yz, xz }
    }

    /// Whether all components are finite: they are not under a sharp edge or at the tip of a cone.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.components().iter().all(|component| component.is_finite())
    }

    /// The root of the sum of the squares of all nine components, Pa.
    pub(crate) fn norm(&self) -> f64 {
        let Stress { xx, yy, zz, xy, yz, xz } = *self;
        (xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + xz * xz)).sqrt()
    }

    /// Mean of the normal stresses, Pa.
    #[must_use]
    pub fn hydrostatic(&self) -> f64 {
        (self.xx + self.yy + self.zz) / 3.0
    }

    /// Von Mises's equivalent stress sqrt(3 J2), Pa.
    #[must_use]
    pub fn von_mises(&self) -> f64 {
        let [xx, yy, zz] = [self.xx, self.yy, self.zz];
        let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
        let shear = self.xy * self.xy + self.yz * self.yz + self.xz * self.xz;
        (0.5 * normal + 3.0 * shear).sqrt()
    }

    /// The principal stresses, Pa, the largest tension first.
    ///
    /// Jacobi's rotations keep the digits of each where two of them nearly agree.
    ///
    /// ```
    /// use stickslip_mechanics::Stress;
    ///
    /// let shear = Stress { xy: 2.0, ..Stress::default() };
    /// assert_eq!(shear.principal(), [2.0, 0.0, -2.0]);
    /// assert_eq!((shear.max_shear(), shear.von_mises()), (2.0, 12f64.sqrt()));
    /// ```
    #[must_use]
    pub fn principal(&self) -> [f64; 3] {
        let mut m = [[self.xx, self.xy, self.xz], [self.xy, self.yy, self.yz], [self.xz, self.yz, self.zz]];
        // Convergence is quadratic: five sweeps reach round-off.
        for _ in 0..6 {
            for (i, j, k) in [(0, 1, 2), (0, 2, 1), (1, 2, 0)] {
                let off = m[i][j];
                if off == 0.0 {
                    continue;
                }
                let cotangent = 0.5 * (m[j][j] - m[i][i]) / off;
                let tangent = cotangent.signum() / (cotangent.abs() + cotangent.hypot(1.0));
                let cosine = 1.0 / tangent.hypot(1.0);
                let sine = tangent * cosine;
                m[i][i] -= tangent * off;
                m[j][j] += tangent * off;
                m[i][j] = 0.0;
                m[j][i] = 0.0;
                let (first, second) = (m[i][k], m[j][k]);
                m[i][k] = cosine * first - sine * second;
                m[j][k] = sine * first + cosine * second;
                (m[k][i], m[k][j]) = (m[i][k], m[j][k]);
            }
        }
        let mut principal = [m[0][0], m[1][1], m[2][2]];
        principal.sort_by(|a, b| b.total_cmp(a));
        principal
    }

    /// Largest shear stress on any plane, half the difference of the outer principal stresses, Pa.
    #[must_use]
    pub fn max_shear(&self) -> f64 {
        let [first, _, third] = self.principal();
        0.5 * (first - third)
    }
}

impl std::ops::Add for Stress {
    type Output = Stress;

    fn add(self, other: Stress) -> Stress {
        let (one, two) = (self.components(), other.components());
        Stress::from_components(std::array::from_fn(|i| one[i] + two[i]))
    }
}

impl std::ops::Mul<f64> for Stress {
    type Output = Stress;

    fn mul(self, factor: f64) -> Stress {
        Stress::from_components(self.components().map(|component| factor * component))
    }
}
