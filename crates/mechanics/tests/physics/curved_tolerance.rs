//! The tolerance of moves that are straight in a force, against closed forms for power laws and the sphere.
//!
//! For g = b x^n the load grows like x^(n+1). On a path straight in (U, F_N), from the contact radius x0 to a, a level
//! is touched at the scaled position W(x) = W1 (x^(n+1) - x0^(n+1))/(a^(n+1) - x0^(n+1)), zero in the old contact, and
//! has gained W1 - W(x) in the end unless that is more than its bound d - g(x).

use proptest::prelude::*;
use stickslip_mechanics::profile::{ExactSphere, PowerLaw, RoundedCone, RoundedPunch, TruncatedCone, TruncatedSphere};
use stickslip_mechanics::{Contact, Elasticity, Move, Normal, Preload, Profile, Setup, Sphere, Tangential};

use crate::support::quadrature::integral;
use crate::support::{config, displace};

const E_STAR: f64 = 1e11;
const G_STAR: f64 = 8e10;
const FRICTION: f64 = 0.3;

fn contact(profile: Profile, normal_force: f64) -> Contact {
    let elasticity = Elasticity::effective(E_STAR, G_STAR).unwrap();
    Contact::new(Setup { profile, elasticity, friction: FRICTION, preload: Preload::NormalForce(normal_force) })
        .unwrap()
}

fn ball(normal_force: f64) -> Contact {
    contact(Profile::Sphere(Sphere::new(0.01).unwrap()), normal_force)
}

fn slide_and_press(displacement: f64, normal_force: f64) -> Move {
    Move { normal: Some(Normal::NormalForce(normal_force)), ..displace(displacement) }
}

/// F_x/(mu F_N) after a path from the contact radius `from`, as a part of the final one, by which the indenter has
/// moved `moved` gross slip displacements: 1/(mu F_N) is (n + 1)/(2 n G* m a d).
fn share_of_friction(exponent: f64, from: f64, moved: f64) -> f64 {
    let power = exponent + 1.0;
    let touched_at = |s: f64| {
        if s <= from { 0.0 } else { moved * (s.powf(power) - from.powf(power)) / (1.0 - from.powf(power)) }
    };
    // Slip reaches inward to where the gain is the bound, the innermost place of that kind.
    let room = |s: f64| (1.0 - s.powf(exponent)) - (moved - touched_at(s));
    let steepest = moved * power / (1.0 - from.powf(power));
    let mut stuck = 1.0;
    if steepest > exponent {
        // g - W is highest where its slope changes sign, in the ring: innermost of the roots lies inside that.
        // The room falls up to here, from there on it rises to zero at the edge.
        let (mut low, mut high) = (0.0, (exponent / steepest).max(from));
        if room(low) <= 0.0 {
            return 1.0;
        }
        for _ in 0..200 {
            let half = 0.5 * (low + high);
            if room(half) > 0.0 { low = half } else { high = half }
        }
        stuck = low;
    }
    let ring = |s: f64| (s.powf(power + 1.0) - from.powf(power + 1.0)) / (power + 1.0) - (s - from) * from.powf(power);
    let lag = if stuck > from { moved * ring(stuck) / (1.0 - from.powf(power)) } else { 0.0 };
    let slipped = (1.0 - stuck) - (1.0 - stuck.powf(power)) / power;
    (moved * stuck - lag + slipped) * power / exponent
}

#[test]
fn a_load_from_zero_meets_each_tolerance() {
    // By 60-digit arithmetic.
    let expected = 7.014_805_770_653_952;
    let mut pieces = Vec::new();
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
        let mut contact = ball(0.0);
        contact.apply_within(&slide_and_press(3.375e-7, 69.282_032_302_755_1), tolerance).unwrap();
        let error = (contact.force() - expected).abs() / (FRICTION * contact.normal_force());
        let stated = contact.accuracy();
        println!("{tolerance:e}: {error:e}, stated {:e}, {} pieces", stated.path_error, contact.memory_depth());
        assert!(error <= tolerance && error <= stated.force_error, "{error:e} within {tolerance:e}");
        assert!(stated.path_error <= tolerance, "{:e} stated within {tolerance:e}", stated.path_error);
        pieces.push(contact.memory_depth());
    }
    assert!(pieces[3] < 4_000 && pieces[4] < 20_000, "{pieces:?}");
}

/// F_N/E* at a contact radius.
type Load = Box<dyn Fn(f64) -> f64>;

/// A shape, the radius of its flat core or tip, and F_N/E* beyond that: from int x g' dx by hand.
fn shapes() -> [(Profile, f64, Load); 5] {
    let (core, blunt, slope) = (1e-4, 0.02_f64, 0.01);
    // The angle arccos(b/x), its sine and its cosine.
    let angle = move |x: f64| (f64::acos(core / x), (1.0 - core / x * (core / x)).sqrt(), core / x);
    [
        (
            Profile::ExactSphere(ExactSphere::new(blunt).unwrap()),
            0.0,
            // (R^2 + a^2) artanh(a/R) - a R, as its series.
            Box::new(move |x| {
                let ratio = x / blunt;
                let term = |k: i32| f64::from(4 * k) / f64::from(4 * k * k - 1) * ratio.powi(2 * k + 1);
                blunt * blunt * (1..12).rev().map(term).sum::<f64>()
            }),
        ),
        (
            Profile::TruncatedCone(TruncatedCone::new(slope, core).unwrap()),
            core,
            Box::new(move |x| slope * x * x * (angle(x).0 + angle(x).1 * angle(x).2)),
        ),
        (
            Profile::TruncatedSphere(TruncatedSphere::new(blunt, core).unwrap()),
            core,
            Box::new(move |x| 2.0 / (3.0 * blunt) * (2.0 * x * x + core * core) * x * angle(x).1),
        ),
        (
            Profile::RoundedPunch(RoundedPunch::new(core, blunt).unwrap()),
            core,
            Box::new(move |x| {
                let (phi, sin, cos) = angle(x);
                x.powi(3) / (3.0 * blunt) * (sin * (4.0 - cos * cos) - 3.0 * phi * cos)
            }),
        ),
        (
            Profile::RoundedCone(RoundedCone::new(slope, core).unwrap()),
            0.0,
            Box::new(move |x| {
                if x <= core {
                    return 4.0 * slope / (3.0 * core) * x.powi(3);
                }
                let (phi, sin, cos) = angle(x);
                x * x * slope * (phi + 4.0 / 3.0 * cos / (1.0 + sin) + sin * cos / 3.0)
            }),
        ),
    ]
}

#[test]
fn all_shapes_meet_the_default_tolerance_from_zero_load_and_from_little() {
    for (profile, flat, load) in shapes() {
        let radius = 3e-4;
        let full = load(radius);
        // Without slip as long as dW/dd = 2 a dW/d(F_N/E*) is less than one.
        let rate = 0.9 / (2.0 * radius);
        for (start, end) in [(0.0, 1.0), (0.0, 1e-3), (1e-3, 1.0), (0.5, 1.0)] {
            let radius_of = |share: f64| {
                let (mut low, mut high) = (flat, radius);
                for _ in 0..200 {
                    let half = 0.5 * (low + high);
                    if load(half) < share * full { low = half } else { high = half }
                }
                if share > 0.0 { low } else { flat }
            };
            let (from, to) = (radius_of(start), radius_of(end));
            // The same rate dW/dF_N on all paths; W1 - W is proportional to F_N(a) - F_N(x).
            let moved = rate * (end - start) * full;
            let ring = |x: f64| rate * (end * full - load(x));
            // F_N rises like a root of the distance from the rim: over that root it is smooth.
            let rim = 1e-4_f64.min(to);
            let root = |x: f64| (x - rim).max(0.0).sqrt();
            let gained = integral(&ring, from.min(rim), rim, 1e-16)
                + integral(&|u: f64| 2.0 * u * ring(rim + u * u), root(from), root(to), 1e-16);
            // F_x/(mu F_N) = 2 E* int w dx/F_N.
            let expected = 2.0 * (moved * from + gained) / (end * full);
            let mut contact = contact(profile.clone(), start * full * E_STAR);
            contact.apply(&slide_and_press(moved * FRICTION * E_STAR / G_STAR, end * full * E_STAR)).unwrap();
            let error = (contact.force() / (FRICTION * contact.normal_force()) - expected).abs();
            let stated = contact.accuracy();
            let path = format!("{profile:?} from {start:e} to {end:e}");
            assert!(error <= 1e-10 && error <= stated.force_error, "{path}: {error:e}, stated {stated:?}");
            assert!(stated.path_error <= 1e-10, "{path}: stated {stated:?}");
            assert!(contact.memory_depth() < 4_000, "{path}: {} pieces", contact.memory_depth());
        }
    }
}

proptest! {
    #![proptest_config(config(200))]

    #[test]
    fn moves_of_power_laws_under_a_rising_load_meet_their_tolerance(
        exponent in prop_oneof![Just(1.0), Just(2.0), 1.2_f64..6.0, 6.0_f64..40.0],
        load in 1e-3_f64..1e2,
        start in prop_oneof![Just(0.0), 0.0_f64..0.9, (-9.0_f64..-1.0).prop_map(|power| 10_f64.powf(power))],
        moved in prop_oneof![Just(1e-3), 0.0_f64..1.0, -1.0_f64..0.0],
        digits in 3.0_f64..12.0,
    ) {
        let shape = || Profile::PowerLaw(PowerLaw::new(exponent, 0.1).unwrap());
        let full = contact(shape(), load).gross_slip_displacement();
        let from = start.powf(1.0 / (exponent + 1.0));
        let expected = share_of_friction(exponent, from, moved.abs()) * moved.signum();
        let tolerance = 10_f64.powf(-digits);
        let mut contact = contact(shape(), start * load);
        contact.apply_within(&slide_and_press(moved * full, load), tolerance).unwrap();
        let error = (contact.force() / (FRICTION * load) - expected).abs();
        let stated = contact.accuracy();
        prop_assert!(stated.path_error <= tolerance, "{:e} stated within {tolerance:e}", stated.path_error);
        prop_assert!(error <= stated.force_error + 1e-13, "{error:e}, stated {:e}", stated.force_error);
        prop_assert!(contact.memory_depth() < 30_000, "{} pieces", contact.memory_depth());
    }

    #[test]
    fn moves_of_power_laws_that_are_pulled_while_they_sink_meet_their_tolerance(
        exponent in prop_oneof![Just(2.0), 1.2_f64..6.0, 6.0_f64..40.0],
        indentation in 1e-9_f64..1e-3,
        start in prop_oneof![0.0_f64..0.9, (-24.0_f64..-1.0).prop_map(|power| 10_f64.powf(power)), 0.9_f64..0.999],
        share in prop_oneof![Just(1.0), 1e-6_f64..1.0],
        digits in 3.0_f64..12.0,
    ) {
        let profile = Profile::PowerLaw(PowerLaw::new(exponent, 0.1).unwrap());
        let elasticity = Elasticity::effective(E_STAR, G_STAR).unwrap();
        let preload = Preload::Indentation(start * indentation);
        let mut contact = Contact::new(Setup { profile, elasticity, friction: FRICTION, preload }).unwrap();
        // Without slip as long as dW/dd < 1 where the contact is smallest.
        let rise = indentation - start * indentation;
        let force = 0.9 * share * 2.0 * FRICTION * E_STAR * rise * contact.contact_radius();
        let tolerance = 10_f64.powf(-digits);
        let step = Move { tangential: Some(Tangential::Force(force)), normal: Some(Normal::Indentation(indentation)),
            ..Move::default() };
        contact.apply_within(&step, tolerance).unwrap();
        // dU = dF/(2 G* a), F is straight in d, and a goes with d^(1/n).
        let power = 1.0 - exponent.recip();
        let grown = (1.0 - start.powf(power)) / power;
        let expected = force / (2.0 * G_STAR * (1.0 - start)) / contact.contact_radius() * grown;
        let error = (contact.state().displacement - expected).abs() / contact.gross_slip_displacement();
        prop_assert!(error <= tolerance + 1e-13, "{error:e} within {tolerance:e}");
        let missed = (contact.force() - force).abs() / (FRICTION * contact.normal_force());
        prop_assert!(missed <= contact.accuracy().force_error, "{missed:e}, stated {:?}", contact.accuracy());
        prop_assert!(contact.memory_depth() < 30_000, "{} pieces", contact.memory_depth());
    }

    #[test]
    fn stated_stress_errors_of_a_ball_under_a_rising_load_are_near_the_true_ones(
        start in prop_oneof![Just(0.0), 0.0_f64..0.9],
        moved in 1e-3_f64..0.6,
        digits in 4.0_f64..12.0,
    ) {
        let load: f64 = 50.0;
        let full = ball(load).gross_slip_displacement();
        let from = start.cbrt();
        // Without slip, else the share of friction is not that of growth alone.
        let moved = moved * (1.0 - start);
        let mut contact = ball(start * load);
        contact.apply_within(&slide_and_press(moved * full, load), 10_f64.powf(-digits)).unwrap();
        prop_assert!(contact.state().dissipated_energy <= 0.0);
        let (radius, figures) = (contact.contact_radius(), contact.summary());
        let unit = FRICTION * figures.max_pressure.unwrap();
        // (G*/pi) int dU/dx dx/sqrt(x^2 - r^2) over the ring, with dU/dx = 3 U x^2/(a^3 - x0^3).
        let shear = |r: f64| {
            let whole = |x: f64| {
                let root = ((x - r) * (x + r)).max(0.0).sqrt();
                0.5 * (x * root + r * r * (x + root).ln())
            };
            let inner = r.max(from);
            let scale = G_STAR / std::f64::consts::PI * 3.0 * moved * full / (1.0 - start) / radius;
            scale * if r > 0.0 { whole(1.0) - whole(inner) } else { 0.5 * (1.0 - inner * inner) }
        };
        let error = (0..400)
            .map(|index| f64::from(index) / 400.0)
            .map(|r| (contact.shear(r * radius) - shear(r)).abs() / unit)
            .fold(0.0, f64::max);
        let stated = contact.accuracy().stress_error;
        prop_assert!(error <= stated + 1e-13, "{error:e} is more than the stated {stated:e}");
        prop_assert!(stated <= 100.0 * error + 1e-13, "{stated:e} is stated for {error:e}");
    }
}

#[test]
fn stated_stress_errors_of_a_ball_that_slips_in_the_end_are_near_the_true_ones() {
    let load: f64 = 50.0;
    let full = ball(load).gross_slip_displacement();
    for (start, moved) in [(0.0, 0.7), (0.0, 0.8), (0.0, 0.95), (0.3, 0.6), (0.3, 0.7)] {
        let [coarse, fine] = [1e-8, 1e-12].map(|tolerance| {
            let mut contact = ball(start * load);
            contact.apply_within(&slide_and_press(moved * full, load), tolerance).unwrap();
            contact
        });
        assert!(coarse.state().dissipated_energy > 0.0);
        let unit = FRICTION * fine.summary().max_pressure.unwrap();
        let error = (0..400)
            .map(|index| f64::from(index) / 400.0 * fine.contact_radius())
            .map(|r| (coarse.shear(r) - fine.shear(r)).abs() / unit)
            .fold(0.0, f64::max);
        let (stated, rest) = (coarse.accuracy().stress_error, fine.accuracy().stress_error);
        assert!(error <= stated + rest, "{moved} from {start}: {error:e} is more than the stated {stated:e}");
        assert!(stated <= 100.0 * error + 1e-13, "{moved} from {start}: {stated:e} is stated for {error:e}");
    }
}
