//! The ten functions for a parabola in closed form: two roots and one angle for each kink of the slip history.
//!
//! With g = x^2/R the slope between two kinks is 2 t/R, and int_0^a 2 t Im H dt = -2 a Re H' + 2 Im H'' where H' and
//! H'' are the first and second integrals of H with respect to zeta, taken at z + i a. In sigma they are Laurent
//! polynomials and a logarithm, since d zeta = (1 + r^2/sigma^2)/2 d sigma. Of the logarithm only the angle of sigma is
//! left. So each function is linear in a few numbers of a kink, and the kinks of a history are summed before the
//! functions are formed.

use super::kernel::{DeepPlace, NormalKernels, TangentialKernels};
use super::mesh::Source;

/// Kinks taken at once: the compiler turns loops over so many into instructions on vectors.
const LANES: usize = 4;
/// Numbers of a kink.
const TERMS: usize = 13;

/// The kinks of a history, from the edge inward.
#[derive(Clone, Debug)]
pub(super) struct Kinks {
    /// The slope of the pressure, whose one kink is the edge.
    normal: f64,
    /// Radii, and the changes of the slope of the shear stress there. Zeros fill the last ones up.
    tangential: Vec<([f64; LANES], [f64; LANES])>,
}

impl Kinks {
    /// From sources at the kinks, of which the first alone has a slope of the pressure.
    pub(super) fn new(kinks: &[Source]) -> Kinks {
        let chunk = |chunk: &[Source]| {
            let lane = |value: fn(&Source) -> f64| std::array::from_fn(|lane| chunk.get(lane).map_or(0.0, value));
            (lane(|kink| kink.t), lane(|kink| kink.tangential))
        };
        let normal = kinks.first().map_or(0.0, |edge| edge.normal);
        Kinks { normal, tangential: kinks.chunks(LANES).map(chunk).collect() }
    }

    /// The functions for the parabola g = t^2, lengths over the contact radius.
    pub(super) fn functions(&self, place: &DeepPlace) -> (NormalKernels, TangentialKernels) {
        let mut edge = [0.0; TERMS];
        let mut sums = [[0.0; LANES]; TERMS];
        for (index, (radii, weights)) in self.tangential.iter().enumerate() {
            let terms = terms(place, radii);
            if index == 0 {
                edge = terms.map(|term| self.normal * term[0]);
            }
            for (sum, term) in sums.iter_mut().zip(&terms) {
                for lane in 0..LANES {
                    sum[lane] += weights[lane] * term[lane];
                }
            }
        }
        let sums = sums.map(|sum| sum.iter().sum());
        (functions(place, &edge).0, functions(place, &sums).1)
    }
}

/// Of each kink at a radius a: the angle of sigma, Im rho, powers of s = 1/sigma as they are and times a, and those
/// times z/rho.
fn terms(place: &DeepPlace, radii: &[f64; LANES]) -> [[f64; LANES]; TERMS] {
    let DeepPlace { r, z, .. } = *place;
    let mut all = [[0.0; LANES]; TERMS];
    let mut sigma = [[0.0; LANES]; 2];
    for lane in 0..LANES {
        let a = radii[lane];
        let square = [z * z - (a - r) * (r + a), 2.0 * z * a];
        let size = (square[0] * square[0] + square[1] * square[1]).sqrt();
        // The root of a number in the upper half-plane, by selections, which need no branch.
        let larger = (0.5 * (size + square[0].abs())).sqrt();
        let smaller = if larger > 0.0 { 0.5 * square[1] / larger } else { 0.0 };
        let rho = if square[0] >= 0.0 { [larger, smaller] } else { [smaller, larger] };
        let [re, im] = [rho[0] + z, rho[1] + a];
        let norm = re * re + im * im;
        let inverse = if norm > 0.0 { 1.0 / norm } else { 0.0 };
        let s = [re * inverse, -im * inverse];
        let s2 = [s[0] * s[0] - s[1] * s[1], 2.0 * s[0] * s[1]];
        let s3 = [s2[0] * s[0] - s2[1] * s[1], s2[0] * s[1] + s2[1] * s[0]];
        // a z/rho has the factor z, and is zero at the surface even on the circle where rho is.
        let over = if z > 0.0 { a * z / size } else { 0.0 };
        let over = [rho[0] * over, -rho[1] * over];
        let with_over = |power: [f64; 2]| over[0] * power[0] - over[1] * power[1];
        let numbers = [
            0.0,
            rho[1],
            a * s[0],
            s[1],
            a * s2[0],
            s2[1],
            a * s3[0],
            s3[1],
            2.0 * s2[0] * s2[1],
            over[0],
            with_over(s),
            with_over(s2),
            with_over(s3),
        ];
        for (column, number) in all.iter_mut().zip(numbers) {
            column[lane] = number;
        }
        (sigma[0][lane], sigma[1][lane]) = (re, im);
    }
    all[0] = std::array::from_fn(|lane| sigma[1][lane].atan2(sigma[0][lane]));
    all
}

/// The ten functions from the sums of the terms.
fn functions(place: &DeepPlace, terms: &[f64; TERMS]) -> (NormalKernels, TangentialKernels) {
    let DeepPlace { r, z, poisson: nu } = *place;
    let [angle, rho, a_s, s, a_s2, s2, a_s3, s3, s4, over, over_s, over_s2, over_s3] = *terms;
    let square = r * r;
    let l0 = 2.0 * (z * angle - rho);
    let depth = 2.0 * (over - z * angle);
    let d1 = 2.0 * a_s + 0.5 * square * s2 - angle;
    let [a_dd4, dd4] = [(a_s, a_s3), (s, s3)].map(|(s, s3)| 0.25 * (s + square / 3.0 * s3));
    let d2 = rho - 0.5 * square * a_s2 - square * dd4 - z * angle;
    let dd2 = a_s2 + 2.0 * dd4;
    let dd1 = -2.0 * over_s2 - z * s2;
    let slope = 2.0 * (over_s + z * s);
    let dd3 = 0.25 * angle - 2.0 * a_dd4 - square / 6.0 * (s2 + 0.125 * square * s4);
    let ddd3 = a_s3 / 1.5 + s2 / 6.0 + square / 12.0 * s4;
    let ddd2 = -2.0 * over_s3 - z / 1.5 * s3;
    let normal = [2.0 * nu * l0 - (1.0 - 2.0 * nu) * d2 - z * d1, -(1.0 - 2.0 * nu) * dd2 - dd1, l0 + depth, slope];
    let even = 2.0 * nu * dd3 - z * dd2;
    (normal, [2.0 * nu * d1 + even, d1 + even, 2.0 * nu * ddd3 - ddd2, slope, -dd1, l0 - z * d1])
}
