//! What the physics tests share: references that are independent of the solver, random paths, and bookkeeping of
//! errors.

pub mod masing;
pub mod paths;
pub mod points;
pub mod power_sums;
pub mod quadrature;
pub mod reference;

use std::cell::Cell;

use proptest::test_runner::{Config, RngAlgorithm, RngSeed, TestCaseError, TestRng, TestRunner};
use stickslip_mechanics::profile::{Parameter, PowerLaw, Sum, Tabulated, families};
use stickslip_mechanics::{Contact, Elasticity, Move, Normal, Preload, Profile, Setup, Sphere, Tangential};

/// A sphere pressed against a plane, by the numbers that define it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    pub curvature: f64,
    pub e_star: f64,
    pub g_star: f64,
    pub friction: f64,
    pub radius: f64,
}

/// Every number a power of two: m = 1, d = 1, so that targets in units of d are exact.
pub const UNIT: Ball = Ball { curvature: 1.0, e_star: 1.0, g_star: 1.0, friction: 1.0, radius: 1.0 };

/// A contact of ordinary numbers, of which none is round.
pub const PLAIN: Ball = Ball { curvature: 0.0127, e_star: 1.13e11, g_star: 8.9e10, friction: 0.31, radius: 1.7e-4 };

impl Ball {
    pub fn setup(&self) -> Setup {
        self.loaded(Preload::ContactRadius(self.radius))
    }

    pub fn loaded(&self, preload: Preload) -> Setup {
        Setup {
            profile: Profile::Sphere(Sphere::new(self.curvature).unwrap()),
            elasticity: Elasticity::effective(self.e_star, self.g_star).unwrap(),
            friction: self.friction,
            preload,
        }
    }

    pub fn contact(&self) -> Contact {
        Contact::new(self.setup()).unwrap()
    }

    /// Hertz: d = a^2/R.
    pub fn indentation(&self) -> f64 {
        self.radius * self.radius / self.curvature
    }

    /// m = mu E*/G*.
    pub fn scale(&self) -> f64 {
        self.friction * self.e_star / self.g_star
    }

    /// u_max = m d.
    pub fn full_slip(&self) -> f64 {
        self.scale() * self.indentation()
    }

    /// mu F_N = mu 4 E* a^3/(3 R) at the contact radius `a`.
    pub fn force_limit(&self, a: f64) -> f64 {
        self.friction * 4.0 / 3.0 * self.e_star * a * (a / self.curvature) * a
    }

    /// mu p_max = mu 2 E* a/(pi R) at the contact radius `a`.
    pub fn stress_limit(&self, a: f64) -> f64 {
        self.friction * 2.0 / std::f64::consts::PI * self.e_star * (a / self.curvature)
    }

    /// Elastic energy of the fully slipped contact without slip, G* m^2 d^2 a: what energies are measured by.
    pub fn energy_unit(&self) -> f64 {
        self.g_star * self.full_slip() * self.full_slip() * self.radius
    }

    /// A move to indentation and displacement in units of the initial d and u_max.
    pub fn towards(&self, (depth, slide): (f64, f64)) -> Move {
        oblique(depth * self.indentation(), slide * self.full_slip())
    }
}

/// A contact of this shape, pressed in by a fortieth of a metre: in the tests of protocols all shapes are.
pub fn pressed(profile: Profile) -> Contact {
    let elasticity = Elasticity::effective(1000.0, 800.0).unwrap();
    Contact::new(Setup { profile, elasticity, friction: 0.3, preload: Preload::Indentation(0.025) }).unwrap()
}

/// A parabola of this curvature radius, m.
pub fn sphere(radius: f64) -> Profile {
    Profile::Sphere(Sphere::new(radius).unwrap())
}

/// 0.1 r^exponent.
pub fn power(exponent: f64) -> Profile {
    Profile::PowerLaw(PowerLaw::new(exponent, 0.1).unwrap())
}

/// The profile of a family, by its name, of these parameters.
pub fn of_family(name: &str, parameters: &[f64]) -> Profile {
    let family = families().iter().find(|family| family.name == name).unwrap_or_else(|| panic!("no family {name}"));
    (family.make)(parameters).unwrap()
}

/// Powers, a sum, a table, and the example of each family, with an ordinary indentation, m.
pub fn shapes() -> Vec<(Profile, f64)> {
    scaled_shapes(1.0)
}

/// The same with all lengths multiplied by a power of two, of which r^2.7 comes first.
pub fn scaled_shapes(scale: f64) -> Vec<(Profile, f64)> {
    let radii: Vec<f64> = (0..=40).map(|index| f64::from(index) * 3e-5).collect();
    let heights: Vec<f64> = radii.iter().map(|r| r * r / 0.02 * (1.0 + 500.0 * r) * scale).collect();
    let radii: Vec<f64> = radii.iter().map(|r| r * scale).collect();
    // 2^(k (1 - n)) by a whole exponent.
    let power_of_scale = |power: f64| 2.0_f64.powi((scale.log2() * power).round() as i32);
    let scaled = |name: &str, numbers: &[f64]| {
        let family = families().iter().find(|family| family.name == name).unwrap();
        let number = |(parameter, number): (&Parameter, &f64)| match parameter.range.unit {
            "m" => number * scale,
            "m^(1-n)" => number * power_of_scale(1.0 - numbers[0]),
            _ => *number,
        };
        of_family(name, &family.parameters.iter().zip(numbers).map(number).collect::<Vec<_>>())
    };
    let power = |n, c| scaled("power_law", &[n, c]);
    let sum = Sum::new(vec![scaled("sphere", &[0.01]), power(4.0, 1e6)]).unwrap();
    let others = [
        power(2.7, 1e3),
        power(1.5, 1.0),
        Profile::Sum(sum),
        Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap()),
    ];
    let of_families = families().iter().map(|family| (scaled(family.name, &family.example()), family.indentation));
    let all = others.into_iter().map(|profile| (profile, 3e-6)).chain(of_families);
    all.map(|(profile, depth)| (profile, depth * scale)).collect()
}

/// Moves a contact to one displacement, m, after the other.
pub fn follow(contact: &mut Contact, displacements: &[f64]) {
    displacements.iter().for_each(|target| contact.apply(&displace(*target)).unwrap());
}

pub fn displace(target: f64) -> Move {
    Move { tangential: Some(Tangential::Displacement(target)), ..Move::default() }
}

pub fn push(target: f64) -> Move {
    Move { tangential: Some(Tangential::Force(target)), ..Move::default() }
}

pub fn press(depth: f64) -> Move {
    Move { normal: Some(Normal::Indentation(depth)), ..Move::default() }
}

pub fn oblique(depth: f64, target: f64) -> Move {
    Move { normal: Some(Normal::Indentation(depth)), ..displace(target) }
}

/// The largest error of a quantity: fails at once beyond the tolerance, and prints what it has seen in the end.
pub struct Worst {
    what: &'static str,
    tolerance: f64,
    seen: Cell<f64>,
}

impl Worst {
    pub fn new(what: &'static str, tolerance: f64) -> Worst {
        Worst { what, tolerance, seen: Cell::new(0.0) }
    }

    /// `found` against `expected`, as a multiple of `unit`.
    pub fn close(&self, found: f64, expected: f64, unit: f64) {
        let error = ((found - expected) / unit).abs();
        // A NaN fails as well.
        let held = error <= self.tolerance;
        assert!(
            held,
            "{}: {found:e} is not {expected:e}: off by {error:e} of {unit:e}, allowed {:e}",
            self.what, self.tolerance
        );
        self.seen.set(self.seen.get().max(error));
    }

    /// `found` against `expected`, relative to the latter.
    pub fn relative(&self, found: f64, expected: f64) {
        self.close(found, expected, expected);
    }
}

impl Drop for Worst {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            println!("{}: largest error {:.1e}, allowed {:.0e}", self.what, self.seen.get(), self.tolerance);
        }
    }
}

/// The number of random cases: `usual`, unless `STICKSLIP_TEST_CASES` asks for another.
pub fn cases(usual: u32) -> u32 {
    std::env::var("STICKSLIP_TEST_CASES")
        .map_or(usual, |cases| cases.parse().expect("STICKSLIP_TEST_CASES is a number"))
}

/// So many cases, the same at every run.
pub fn config(usual: u32) -> Config {
    Config { cases: cases(usual), failure_persistence: None, rng_seed: RngSeed::Fixed(0), ..Config::default() }
}

/// Runs `test` on so many random values, the same at every run, and shrinks what fails.
pub fn forall<S: proptest::strategy::Strategy>(usual: u32, strategy: S, test: impl Fn(S::Value)) {
    let mut runner = TestRunner::new_with_rng(config(usual), TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let outcome = runner.run(&strategy, |value| {
        test(value);
        Ok::<(), TestCaseError>(())
    });
    if let Err(failure) = outcome {
        panic!("{failure}");
    }
}

/// Splitmix64 (Steele et al. 2014): a seeded source for the long runs.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Even over [low, high).
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.bits() >> 11) as f64 / (1_u64 << 53) as f64)
    }
}

/// Extrema of samples that stand out by more than `height` from those on either side, with the samples that bracket
/// each.
pub fn standing_out(samples: &[f64], height: f64) -> Vec<usize> {
    let mut found = Vec::new();
    let (mut low, mut high, mut rising) = (0, 0, None);
    for (index, &value) in samples.iter().enumerate() {
        if value > samples[high] {
            high = index;
        }
        if value < samples[low] {
            low = index;
        }
        if rising != Some(false) && value < samples[high] - height {
            found.extend(rising.map(|_| high));
            (rising, low) = (Some(false), index);
        } else if rising != Some(true) && value > samples[low] + height {
            found.extend(rising.map(|_| low));
            (rising, high) = (Some(true), index);
        }
    }
    found
}
