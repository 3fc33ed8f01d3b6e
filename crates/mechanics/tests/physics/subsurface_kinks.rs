//! The stress in depth beside the radii at which a profile or a slip history has a kink, against quadrature of its own:
//! some thousand places, from a unit in the last place beside the kink to a tenth of the contact radius, at depths from
//! 1e-10 to one of it.
//!
//! The functions of a line source are those of `a_pressed_and_a_sliding_sphere_have_the_closed_forms_of_hamilton` and
//! `every_profile_has_the_sum_of_its_point_forces`, which hold them against closed forms; what is under test here is
//! the sum over the radii. The reference sums over intervals that shrink towards each singular point by half, and has
//! dg/dx of each part in closed form (Popov & Heß 2015), given the distance from its kink.

use std::f64::consts::PI;
use std::ops::{Add, Mul, Sub};

use stickslip_mechanics::fatigue::{Criterion, Cycle, Measure, Study};
use stickslip_mechanics::profile::{
    Cone, PowerLaw, RoundedCone, RoundedPunch, Sphere, Sum, Tabulated, TruncatedCone, TruncatedSphere,
};
use stickslip_mechanics::subsurface::Side;
use stickslip_mechanics::{Contact, Elasticity, Preload, Profile, Setup};

use crate::support::{Random, cases, displace, follow};

const NU: f64 = 0.3;
const FRICTION: f64 = 0.5;

#[derive(Clone, Copy)]
struct Complex(f64, f64);

impl Add for Complex {
    type Output = Complex;
    fn add(self, other: Complex) -> Complex {
        Complex(self.0 + other.0, self.1 + other.1)
    }
}

impl Sub for Complex {
    type Output = Complex;
    fn sub(self, other: Complex) -> Complex {
        Complex(self.0 - other.0, self.1 - other.1)
    }
}

impl Mul for Complex {
    type Output = Complex;
    fn mul(self, other: Complex) -> Complex {
        Complex(self.0 * other.0 - self.1 * other.1, self.0 * other.1 + self.1 * other.0)
    }
}

impl Mul<Complex> for f64 {
    type Output = Complex;
    fn mul(self, other: Complex) -> Complex {
        Complex(self * other.0, self * other.1)
    }
}

impl Complex {
    fn inverse(self) -> Complex {
        (1.0 / (self.0 * self.0 + self.1 * self.1)) * Complex(self.0, -self.1)
    }

    /// By polar coordinates.
    fn root(self) -> Complex {
        let (size, angle) = (self.0.hypot(self.1).sqrt(), 0.5 * self.1.atan2(self.0));
        Complex(size * angle.cos(), size * angle.sin())
    }
}

/// xx, yy, zz, xz at (r, 0, z) under a unit of slope at t = r + offset: of the pressure, of the shear stress.
fn line_source(r: f64, z: f64, offset: f64) -> [[f64; 4]; 2] {
    let t = r + offset;
    let (zeta, square) = (Complex(z, t), Complex(z * z - offset * (r + t), 2.0 * z * t));
    let rho = square.root();
    let (one, s) = (rho.inverse(), (rho + zeta).inverse());
    let cube = one * one * one;
    // (1/r) d/dr of the potentials ln sigma, zeta ln sigma - rho and the integral of that, once and again.
    let (d1, dd1) = (one * s, -1.0 * (cube * s + one * one * s * s));
    let (d2, dd2, ddd2) = (-1.0 * s, one * s * s, -1.0 * (cube * s * s + 2.0 * one * one * s * s * s));
    let (dd3, ddd3) = (-0.5 * s * s, one * s * s * s);
    let k = 1.0 - 2.0 * NU;
    let along = |d: Complex, dd: Complex| d + r * r * dd;
    let pressed = [
        2.0 * NU * one.1 - k * along(d2, dd2).1 - z * along(d1, dd1).1,
        2.0 * NU * one.1 - k * d2.1 - z * d1.1,
        (one + z * zeta * cube).1,
        r * z * cube.1,
    ];
    // x times the third derivatives in x, and in x and y twice.
    let thrice = |dd: Complex, ddd: Complex| 3.0 * dd + r * r * ddd;
    let dragged = [
        r * (2.0 * NU * d1 + 2.0 * d1 + 2.0 * NU * thrice(dd3, ddd3) - z * thrice(dd2, ddd2)).1,
        r * (2.0 * NU * d1 + 2.0 * NU * dd3 - z * dd2).1,
        r * z * cube.1,
        (one - z * along(d1, dd1)).1,
    ];
    [pressed, dragged]
}

/// The parts of a profile, for a reference of its own.
#[derive(Clone, Copy)]
enum Part {
    Power(f64, f64),
    TruncatedCone(f64, f64),
    TruncatedSphere(f64, f64),
    RoundedPunch(f64, f64),
    RoundedCone(f64, f64),
}

impl Part {
    fn profile(self) -> Profile {
        match self {
            Part::Power(n, c) if n.to_bits() == 2f64.to_bits() => Profile::Sphere(Sphere::new(0.5 / c).unwrap()),
            Part::Power(n, c) if n.to_bits() == 1f64.to_bits() => Profile::Cone(Cone::new(c).unwrap()),
            Part::Power(n, c) => Profile::PowerLaw(PowerLaw::new(n, c).unwrap()),
            Part::TruncatedCone(slope, b) => Profile::TruncatedCone(TruncatedCone::new(slope, b).unwrap()),
            Part::TruncatedSphere(radius, b) => Profile::TruncatedSphere(TruncatedSphere::new(radius, b).unwrap()),
            Part::RoundedPunch(b, radius) => Profile::RoundedPunch(RoundedPunch::new(b, radius).unwrap()),
            Part::RoundedCone(slope, b) => Profile::RoundedCone(RoundedCone::new(slope, b).unwrap()),
        }
    }

    fn kink(self) -> f64 {
        match self {
            Part::Power(..) => 0.0,
            Part::TruncatedCone(_, b)
            | Part::TruncatedSphere(_, b)
            | Part::RoundedPunch(b, _)
            | Part::RoundedCone(_, b) => b,
        }
    }

    /// g'(x) at x = base + above, base being its kink or another one.
    fn slope(self, base: f64, above: f64) -> f64 {
        let (b, x) = (self.kink(), base + above);
        let over = (base - b) + above;
        let t = (over * (x + b)).max(0.0).sqrt();
        let phi = t.atan2(b);
        match self {
            Part::RoundedCone(slope, b) if over <= 0.0 => 2.0 * slope * x / b,
            Part::Power(n, c) => self.profile().indenter().level(1.0) / c * c * n * x.powf(n - 1.0),
            _ if over <= 0.0 => 0.0,
            Part::TruncatedCone(slope, b) => slope * (phi + b / t),
            Part::TruncatedSphere(radius, b) => (b * b + 2.0 * t * t) / (radius * t),
            Part::RoundedPunch(b, radius) => (t + (t - b * phi)) / radius,
            Part::RoundedCone(slope, b) => slope * (2.0 * b / (x + t) + phi),
        }
    }
}

/// Gauss's rule of so many points over 0 to 1, by Newton's method.
pub fn gauss(points: i32) -> Vec<(f64, f64)> {
    let node = |index: i32| {
        let mut x = (PI * (f64::from(index) + 0.75) / (f64::from(points) + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..20 {
            let (mut last, mut value) = (1.0, x);
            for k in 2..=points {
                let k = f64::from(k);
                (last, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * last) / k);
            }
            slope = f64::from(points) * (last - x * value) / (1.0 - x * x);
            x -= value / slope;
        }
        (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..points).map(node).collect()
}

/// A scene: its contact, its kinks, and g' beyond a kink.
struct Scene {
    name: String,
    contact: Contact,
    /// Radii at which g is not analytic, from the centre, zero first.
    knots: Vec<f64>,
    /// Radii between which the shear stress has one slope, with that slope, -dw/dy.
    rings: Vec<(f64, f64, f64)>,
    slope: Box<dyn Fn(f64, f64) -> f64>,
}

impl Scene {
    fn new(name: String, profile: Profile, depth: f64, slope: Box<dyn Fn(f64, f64) -> f64>) -> Scene {
        let elasticity = Elasticity::effective(0.5 * PI, 0.5 * PI).unwrap();
        let setup =
            Setup { profile: profile.clone(), elasticity, friction: FRICTION, preload: Preload::Indentation(depth) };
        let mut contact = Contact::new(setup).unwrap();
        let full = contact.gross_slip_displacement();
        follow(&mut contact, &[0.8, -0.5, 0.1].map(|share| share * full));
        let a = contact.contact_radius();
        // Where the three moves have begun to slip.
        let [one, two, three] = [0.2, 0.35, 0.7].map(|level| profile.indenter().radius(level * depth));
        let rings = vec![(0.0, one, 0.0), (one, two, 1.0), (two, three, -1.0), (three, a, 1.0)];
        let knots = [0.0].into_iter().chain(profile.indenter().knots_below(a)).collect();
        Scene { name, contact, knots, rings, slope }
    }

    fn of_parts(parts: Vec<Part>, depth: f64) -> Scene {
        let names: Vec<_> = parts.iter().map(|part| format!("{:?}", part.profile())).collect();
        let mut profiles: Vec<_> = parts.iter().map(|part| part.profile()).collect();
        let profile =
            if profiles.len() > 1 { Profile::Sum(Sum::new(profiles).unwrap()) } else { profiles.swap_remove(0) };
        let slope = move |base: f64, above: f64| parts.iter().map(|part| part.slope(base, above)).sum::<f64>();
        Scene::new(names.join(" + "), profile, depth, Box::new(slope))
    }

    /// xx, yy, zz, xz at (r, 0, z), m, in the second body.
    fn reference(&self, rule: &[(f64, f64)], r: f64, z: f64) -> [f64; 4] {
        let a = self.contact.contact_radius();
        let mut sum = [0.0; 4];
        for &(from, to, share) in &self.rings {
            let mut ends: Vec<f64> = self.knots.iter().copied().filter(|knot| from < *knot && *knot < to).collect();
            ends.extend([from, to]);
            ends.extend((from < r && r < to).then_some(r));
            ends.sort_by(f64::total_cmp);
            for pair in ends.windows(2) {
                let base = *self.knots.iter().rev().find(|knot| **knot <= pair[0]).unwrap();
                // Offsets from r.
                let mut parts = vec![(pair[0] - r, pair[1] - r)];
                while let Some((low, high)) = parts.pop() {
                    let length = high - low;
                    let beyond_kink = low - (base - r);
                    let beside = low.max(-high).max(0.0).hypot(z);
                    if beside < length || (beyond_kink > 0.0 && beyond_kink < length) {
                        let middle = 0.5 * (low + high);
                        assert!(low < middle && middle < high, "{}: no end at {r:e} {z:e}", self.name);
                        parts.extend([(low, middle), (middle, high)]);
                        continue;
                    }
                    for &(u, weight) in rule {
                        // Over the root of the distance from the kink where it is the end.
                        let at_kink = beyond_kink <= 0.0;
                        let (step, weight) = if at_kink {
                            (length * u.powi(4), 4.0 * length * u.powi(3) * weight)
                        } else {
                            (length * u, length * weight)
                        };
                        let dg = weight * (self.slope)(base, beyond_kink.max(0.0) + step);
                        let [p, q] = line_source(r / a, z / a, (low + step) / a);
                        for index in 0..4 {
                            sum[index] += dg * (p[index] + FRICTION * share * q[index]) / (2.0 * a);
                        }
                    }
                }
            }
        }
        sum
    }
}

fn scenes() -> Vec<Scene> {
    let (a, half) = (1.0, 0.5);
    let single = [
        (Part::TruncatedSphere(20.0, half), 0.04),
        (Part::TruncatedCone(0.05, half), 0.05),
        (Part::TruncatedCone(0.05, 0.97 * a), 0.005),
        (Part::RoundedPunch(half, 20.0), 0.02),
        (Part::RoundedCone(0.05, half), 0.1),
        (Part::Power(1.5, 0.05), 0.08),
        (Part::Power(2.7, 0.05), 0.1),
        (Part::Power(1.0, 0.05), 0.08),
    ];
    let mut scenes: Vec<Scene> = single.into_iter().map(|(part, depth)| Scene::of_parts(vec![part], depth)).collect();
    scenes.push(Scene::of_parts(vec![Part::Power(2.0, 0.03), Part::TruncatedCone(0.05, half)], 0.1));
    scenes.push(Scene::of_parts(vec![Part::TruncatedSphere(20.0, half), Part::RoundedPunch(0.53, 10.0)], 0.1));
    scenes.push(Scene::of_parts(vec![Part::Power(4.0, 0.05), Part::RoundedCone(0.03, 0.4)], 0.15));
    let radii: Vec<f64> = [0.0, 0.1, 0.13, 0.5, 0.51, 0.9, 1.4].to_vec();
    let heights: Vec<f64> = radii.iter().map(|r| 0.02 * r * r * (1.0 + r)).collect();
    let table = Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap());
    let own = table.indenter();
    scenes.push(Scene::new("table".into(), table, 0.06, Box::new(move |base, above| own.slope(base + above))));
    scenes
}

/// xx, yy, zz, xz at (r, 0, z), and the largest error of a place over the unit pressure.
fn compared(scene: &Scene, rule: &[(f64, f64)], r: f64, z: f64) -> ([f64; 4], f64) {
    let ours = scene.contact.subsurface(Side::Second, NU).unwrap().at([r, 0.0, z]).unwrap();
    let ours = [ours.xx, ours.yy, ours.zz, ours.xz];
    let pairs = ours.into_iter().zip(scene.reference(rule, r, z));
    // What is not finite is wrong.
    let off =
        pairs.map(|(one, two)| (one - two).abs()).fold(0.0, |worst: f64, off| if off <= worst { worst } else { off });
    (ours, off / scene.contact.summary().unit_pressure())
}

#[test]
fn the_stress_just_outside_the_rim_of_a_worn_sphere_is_finite_and_continuous() {
    let scene = Scene::of_parts(vec![Part::TruncatedSphere(0.004, 1e-4)], 8.660_254_037_844_386e-6);
    let (unit, rule) = (scene.contact.summary().unit_pressure(), gauss(24));
    let radii = [1e-4, 1.000_000_000_000_1e-4, 1.000_000_001e-4, 1.000_01e-4, 1.000_1e-4, 1.001e-4];
    let [first, rest @ ..] = radii.map(|r| compared(&scene, &rule, r, 1e-5));
    assert!(first.1 < 4e-12, "{first:?}");
    for (r, (values, off)) in radii[1..].iter().zip(rest) {
        // The stress changes with the distance over the depth.
        let step = values.iter().zip(first.0).map(|(here, there)| (here - there).abs()).fold(0.0, f64::max) / unit;
        let allowed = 10.0 * (r - 1e-4) / 1e-5 + 1e-12;
        assert!(off < 4e-12 && step < allowed, "{r:e}: off by {off:e}, {step:e} from the rim");
    }
}

#[test]
fn criteria_of_a_cycle_are_continuous_across_a_rim() {
    let scene = Scene::of_parts(vec![Part::TruncatedCone(0.05, 0.5)], 0.05);
    let full = scene.contact.gross_slip_displacement();
    let moves = [0.6, -0.6].map(|share| displace(share * full));
    let cycle = Cycle::new(&scene.contact, &moves, &|| true).unwrap();
    let measures = [Criterion::Crossland { alpha: 0.3 }, Criterion::DangVan { alpha: 0.3 }].map(Measure::Stress);
    let mut study = Study::new(&cycle, (Side::Second, NU), None, measures.to_vec(), 1e-4, &|| true).unwrap();
    let z = 0.05 * scene.contact.contact_radius();
    let beside = [0.0, 1e-14, 1e-10, 1e-7, 1e-5];
    let places = beside.map(|beside| [0.5 * (1.0 + beside), 0.0, z]);
    for values in study.rate_all(&places).unwrap().values {
        for (beside, value) in beside.iter().zip(&values) {
            let jump = (value / values[0] - 1.0).abs();
            assert!(jump < 2e-4 + 20.0 * beside, "{jump:e} at r/b - 1 = {beside:e}");
        }
    }
}

#[test]
fn the_stress_beside_every_kink_is_that_of_graded_quadrature() {
    let (mut random, rule) = (Random(17), gauss(24));
    let (mut worst, mut places) = (0.0_f64, 0);
    let mut wrong = Vec::new();
    for scene in scenes() {
        let a = scene.contact.contact_radius();
        let kinks: Vec<f64> = scene
            .knots
            .iter()
            .copied()
            .chain(scene.rings.iter().map(|ring| ring.1))
            .filter(|r| *r < 1.01 * a)
            .collect();
        for kink in &kinks {
            for case in 0..cases(100) / kinks.len() as u32 {
                let beside = a * 10_f64.powf(random.within(-16.0, -1.0));
                let beside = [beside, -beside, 0.0][(case % 3) as usize];
                let r = (kink + beside).abs();
                let z = a * 10_f64.powf(random.within(-10.0, 0.0));
                let (_, error) = compared(&scene, &rule, r, z);
                // A radius at which slip has stopped is known to a unit in its last place.
                let rounded = 3e-16 / (z / a).sqrt();
                places += 1;
                worst = worst.max(error);
                let held = error <= 4e-12 + rounded;
                if !held {
                    wrong.push(format!(
                        "{}: {error:.1e} at r/b - 1 = {:e}, z = {:e} a",
                        scene.name,
                        r / kink - 1.0,
                        z / a
                    ));
                }
            }
        }
    }
    println!("stress beside kinks: {places} places, largest error {worst:.1e} of the unit pressure");
    assert!(wrong.is_empty(), "{} places are wrong:\n{}", wrong.len(), wrong.join("\n"));
}
