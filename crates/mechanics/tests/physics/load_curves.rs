//! Contacts that are known by their load curve alone: asperities, measured curves, Hertz's ellipse.

use crate::support::quadrature::integral;
use crate::support::{Random, Worst, displace, forall, oblique, power, press, push, sphere};
use proptest::prelude::*;
use stickslip_mechanics::cycle::SteadyCycle;
use stickslip_mechanics::profile::{Asperities, Direction, Ellipsoid, LoadCurve, PowerLaw, Ring, Sum};
use stickslip_mechanics::{
    Body, Contact, DoubleDouble, Elasticity, Error, Move, Normal, Preload, Profile, Setup, Tangential,
};

const E_STAR: f64 = 1.13e11;

fn elasticity() -> Elasticity {
    Elasticity::effective(E_STAR, 8.9e10).unwrap()
}

fn setup(profile: Profile, preload: Preload) -> Setup {
    Setup { profile, elasticity: elasticity(), friction: 0.31, preload }
}

fn contact(profile: Profile, indentation: f64) -> Contact {
    Contact::new(setup(profile, Preload::Indentation(indentation))).unwrap()
}

fn asperities(radii: &[f64], gaps: &[f64]) -> Profile {
    Profile::Asperities(Asperities::new(radii, gaps).unwrap())
}

fn ring(profile: &Profile, low: f64, high: f64) -> Ring {
    Ring::between(profile.indenter().point(low.into()), profile.indenter().point(high.into()))
}

/// Random radii, m, and gaps, m.
fn rough(count: usize, random: &mut Random) -> (Vec<f64>, Vec<f64>) {
    (0..count).map(|_| (random.within(2e-5, 2e-4), random.within(3e-6, 5e-6))).unzip()
}

#[test]
fn one_asperity_is_a_ball() {
    let (radius, offset) = (0.0127, -3e-3);
    let moves = [
        displace(4e-7),
        push(0.6),
        oblique(3e-6, -2e-7),
        displace(-7e-7),
        press(1.5e-6),
        oblique(-1e-7, 3e-7),
        oblique(2e-6, 9e-7),
        Move {
            normal: Some(Normal::NormalForce(9.0)),
            tangential: Some(Tangential::Displacement(-1e-7)),
            ..Move::default()
        },
    ];
    for preload in [Preload::NormalForce(10.0), Preload::Indentation(2e-6), Preload::ContactRadius(1.6e-4)] {
        let mut pair =
            [sphere(radius), asperities(&[radius], &[offset])].map(|p| Contact::new(setup(p, preload)).unwrap());
        for step in &moves {
            pair.iter_mut().for_each(|contact| contact.apply(step).unwrap());
            let [ball, one] = [&pair[0], &pair[1]].map(Contact::state);
            assert_eq!(one, ball);
        }
    }
}

#[test]
fn asperities_are_as_many_separate_contacts() {
    let mut random = Random(7);
    let (radii, gaps) = rough(300, &mut random);
    let first = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    let mut together = contact(asperities(&radii, &gaps), 0.0);
    let mut apart: Vec<(f64, Contact)> =
        radii.iter().zip(&gaps).map(|(&radius, gap)| (gap - first, contact(sphere(radius), 0.0))).collect();
    apart.iter_mut().for_each(|(gap, one)| one.apply(&press(-*gap)).unwrap());
    let worst = Worst::new("a stack against 300 / (mu F_N)", 1e-13);
    let energy = Worst::new("their friction work and elastic energy / (mu F_N u_max)", 1e-13);
    for step in 0..60 {
        let depth = if step == 30 { -1e-7 } else { random.within(1e-7, 3e-6) };
        let slide = random.within(-6e-7, 6e-7);
        together.apply(&oblique(depth, slide)).unwrap();
        apart.iter_mut().for_each(|(gap, one)| one.apply(&oblique(depth - *gap, slide)).unwrap());
        let sum = |of: fn(&Contact) -> f64| apart.iter().map(|(_, one)| of(one)).sum::<f64>();
        let unit = 0.31 * contact(asperities(&radii, &gaps), 3e-6).normal_force();
        let length = 0.31 * 3e-6;
        worst.close(together.force(), sum(Contact::force), unit);
        worst.close(together.normal_force(), sum(Contact::normal_force), unit);
        worst.close(together.contact_radius(), sum(Contact::contact_radius), 1e-3);
        energy.close(together.state().dissipated_energy, sum(|one| one.state().dissipated_energy), unit * length);
        energy.close(together.state().elastic_energy, sum(|one| one.state().elastic_energy), unit * length);
    }
}

/// Clustered, even and repeated gaps, and levels just above and far above them.
#[test]
fn sums_over_asperities_keep_their_digits() {
    let worst = Worst::new("moments of many asperities, relative", 1e-14);
    let gap = prop_oneof![0.0..1.0_f64, (-12.0..0.0_f64).prop_map(|power| 10_f64.powf(power)), Just(0.25)];
    let gaps = prop::collection::vec(gap, 1..2000);
    forall(60, (gaps, 0.0..1.5_f64, -14.0..0.0_f64, any::<prop::sample::Index>()), |(gaps, level, thin, touched)| {
        let first = gaps.iter().copied().fold(f64::INFINITY, f64::min);
        let gaps: Vec<f64> = gaps.iter().map(|gap| gap - first).collect();
        let many = asperities(&[0.37], &gaps);
        let ball = sphere(0.37);
        // Beginning at one of the gaps, or anywhere.
        for low in [level, gaps[touched.index(gaps.len())]] {
            let depth = 10_f64.powf(thin);
            let outer = DoubleDouble::sum(low, depth);
            let between = Ring::between(many.indenter().point(low.into()), many.indenter().point(outer));
            let found = many.indenter().moments(&between);
            let mut sums = [DoubleDouble::ZERO; 3];
            for &gap in gaps.iter().filter(|&&gap| outer.value() > gap) {
                let [inner, outer] = [low.into(), outer].map(|level| {
                    let above = level - DoubleDouble::from(gap);
                    ball.indenter().point(if above.value() > 0.0 { above } else { 0.0.into() })
                });
                let one = ball.indenter().moments(&Ring::between(inner, outer));
                for (sum, part) in sums.iter_mut().zip([one.width, one.first, one.second]) {
                    *sum = *sum + DoubleDouble::from(part);
                }
            }
            for (found, sum) in [found.width, found.first, found.second].into_iter().zip(sums) {
                worst.relative(found, sum.value());
            }
        }
    });
}

#[test]
fn loads_and_radii_of_asperities_are_inverted() {
    let mut random = Random(3);
    let (radii, gaps) = rough(5000, &mut random);
    let profile = asperities(&radii, &gaps);
    let worst = Worst::new("indentation from load and from radius, relative", 1e-14);
    for power in -12..1 {
        let level = 3e-6 * 10_f64.powi(power) * random.within(0.3, 1.0);
        let load = profile.indenter().moments(&ring(&profile, 0.0, level)).first;
        worst.relative(profile.indenter().indentation_for(load), level);
        worst.relative(profile.indenter().level(profile.indenter().radius(level)), level);
    }
}

#[test]
fn exponential_heights_creep_towards_gross_slip_exponentially() {
    // Counts that grow as exp(h/s): F_N ~ exp(d/s), and F = mu (F_N(d) - F_N(d - U/m)).
    let (scale, count) = (1e-7, 1_000_000);
    let gaps: Vec<f64> = (0..count).map(|index| scale * (f64::from(index) + 0.5).ln()).collect();
    let profile = asperities(&[1e-4], &gaps);
    let depth = scale * (f64::from(count) / 0.5).ln();
    let mut rough = contact(profile, depth);
    let (limit, m) = (0.31 * rough.normal_force(), rough.gross_slip_displacement() / depth);
    let worst = Worst::new("Greenwood and Williamson's limit / (mu F_N)", 1e-4);
    for part in [0.1, 0.5, 1.0, 2.0, 4.0] {
        let moved = part * m * scale;
        rough.apply(&displace(moved)).unwrap();
        // The asperities end at the depth of the contact, where those of the limit go on: both touch the same.
        worst.close(rough.force(), limit * (1.0 - (-part).exp()), limit);
    }
}

/// The points of int X dy of a profile at these levels, as forces.
fn sampled(profile: &Profile, levels: &[f64]) -> LoadCurve {
    let force = |&level: &f64| {
        let ring = ring(profile, 0.0, level);
        2.0 * E_STAR * (ring.inner.radius * ring.depth + profile.indenter().moments(&ring).first)
    };
    let forces: Vec<f64> = levels.iter().map(force).collect();
    LoadCurve::new(levels, &forces, &elasticity()).unwrap()
}

fn even(count: u32, depth: f64) -> Vec<f64> {
    (0..=count).map(|index| depth * f64::from(index) / f64::from(count)).collect()
}

#[test]
fn a_sampled_curve_begins_as_a_power_and_converges() {
    let worst = Worst::new("the start of a power law, relative", 1e-13);
    let exponent = 2.7;
    let law = power(exponent);
    let errors = [10, 20, 40, 80].map(|count| {
        let curve = Profile::LoadCurve(sampled(&law, &even(count, 1e-3)));
        let start = 0.7e-3 / f64::from(count);
        worst.relative(curve.indenter().radius(start), law.indenter().radius(start));
        let (curved, exact) = (contact(curve, 0.93e-3), contact(law.clone(), 0.93e-3));
        let moved = 0.4 * exact.gross_slip_displacement();
        let force = |mut contact: Contact| {
            contact.apply(&displace(moved)).unwrap();
            contact.force() / 0.31 / exact.normal_force()
        };
        (force(curved) - force(exact.clone())).abs()
    });
    // Of second order: twenty points and more gain a factor of four, or more by chance.
    assert!(errors.windows(2).all(|pair| pair[1] < 0.5 * pair[0]) && errors[3] < 3e-5, "{errors:?}");
}

#[test]
fn the_stated_error_of_a_curve_covers_a_third_of_the_true_one() {
    let laws = (1.1..6.0_f64, 0.0..1.0_f64, 5..60_u32, 0.3..1.0_f64, 0.05..1.2_f64, 0.0..0.9_f64);
    forall(150, laws, |(exponent, other, count, depth, slide, uneven)| {
        let parts = [exponent, 1.0 + 5.0 * other].map(|n| Profile::PowerLaw(PowerLaw::new(n, 0.1).unwrap()));
        let law = Profile::Sum(Sum::new(parts.to_vec()).unwrap());
        let levels: Vec<f64> =
            even(count, 1.0).iter().map(|share| 1e-3 * share * (1.0 - uneven + uneven * share)).collect();
        let force = 2.0 * E_STAR * law.indenter().moments(&ring(&law, 0.0, depth * 1e-3)).first;
        let preload = Preload::NormalForce(force);
        let mut exact = Contact::new(setup(law.clone(), preload)).unwrap();
        let mut curved = Contact::new(setup(Profile::LoadCurve(sampled(&law, &levels)), preload)).unwrap();
        let moved = displace(slide * exact.gross_slip_displacement());
        exact.apply(&moved).unwrap();
        curved.apply(&moved).unwrap();
        let error = (curved.force() - exact.force()).abs() / (0.31 * force);
        let stated = curved.accuracy().force_error;
        assert!(3.0 * stated > error, "{error:e} against {stated:e}");
    });
}

#[test]
fn curves_that_are_none_are_refused_with_their_place() {
    let of = |d: &[f64], force: &[f64]| LoadCurve::new(d, force, &elasticity()).unwrap_err().to_string();
    assert!(of(&[0.0, 1.0, 2.0], &[0.0, 1.0]).contains("differ in length at index 2"));
    assert!(of(&[0.0, 1.0, 2.0], &[0.1, 1.0, 3.0]).contains("does not begin"));
    assert!(of(&[0.0, 1.0, 1.0], &[0.0, 1.0, 3.0]).contains("does not rise by 1e-15 m at index 2"));
    assert!(of(&[0.0, 1.0, 2.0], &[0.0, 0.0, 3.0]).contains("force does not rise"));
    assert!(of(&[0.0, 1.0, 2.0, 3.0], &[0.0, 1.0, 3.0, 4.9]).contains("falls before the point at index 3"));
    let beyond = |d| {
        Contact::new(setup(
            Profile::LoadCurve(LoadCurve::new(&[0.0, 1e-6, 2e-6], &[0.0, 1.0, 3.0], &elasticity()).unwrap()),
            d,
        ))
    };
    assert!(beyond(Preload::NormalForce(3.0)).is_ok() && beyond(Preload::Indentation(2e-6)).is_ok());
    assert!(matches!(beyond(Preload::NormalForce(3.001)), Err(Error::BeyondProfile { .. })));
    assert!(matches!(beyond(Preload::Indentation(2.001e-6)), Err(Error::BeyondProfile { .. })));
    let part = asperities(&[1.0], &[0.0]);
    assert_eq!(Sum::new(vec![sphere(1.0), part]), Err(Error::NoSurface { part: 1 }));
    assert!(Asperities::new(&[1.0, 2.0], &[0.0; 3]).is_err() && Asperities::new(&[1.0], &[]).is_err());
    assert!(Asperities::new(&[1.0], &[f64::NAN]).is_err());
}

/// A flat stretch at either end of X, where a radius belongs to many levels.
#[test]
fn straight_curves_are_springs_up_to_their_end() {
    let curve = LoadCurve::new(&[0.0, 1e-6, 2e-6, 3e-6], &[0.0, 1.0, 2.0, 3.0], &elasticity()).unwrap();
    let mut spring = contact(Profile::LoadCurve(curve), 3e-6);
    let worst = Worst::new("a linear load curve, relative", 1e-14);
    worst.relative(spring.normal_force(), 3.0);
    let m = spring.gross_slip_displacement() / 3e-6;
    spring.apply(&displace(1.5e-6 * m)).unwrap();
    // Nothing slips under a flat punch: F = 2 G* b U.
    worst.relative(spring.force(), 0.31 * 1.5);
    spring.apply(&displace(4e-6 * m)).unwrap();
    worst.relative(spring.force(), 0.31 * 3.0);
    assert!(spring.accuracy().force_error < 1e-12);
}

/// The complete elliptic integrals of the parameter m, by quadrature.
fn elliptic(m: f64) -> (f64, f64) {
    let root = |angle: f64| (1.0 - m * angle.sin() * angle.sin()).sqrt();
    let quarter = std::f64::consts::FRAC_PI_2;
    (integral(&|angle| root(angle).recip(), 0.0, quarter, 1e-14), integral(&root, 0.0, quarter, 1e-14))
}

#[test]
fn ellipses_are_those_of_hertz() {
    let worst = Worst::new("Hertz's ellipse, relative", 1e-12);
    for ratio in [0.05, 0.3, 0.5, 0.9, 0.999] {
        let square = 1.0 - ratio * ratio;
        let (k, e) = elliptic(square);
        // Johnson (1985), eqs 4.26: semi-axes a = 1 and b, pressure p0 = E*.
        let major = 0.5 / (ratio / square * (k - e));
        let minor = 0.5 / (ratio / square * (e / (ratio * ratio) - k));
        let (depth, force) = (ratio * k, 2.0 / 3.0 * std::f64::consts::PI * ratio * E_STAR);
        for direction in [Direction::X, Direction::Y] {
            let long = Ellipsoid::new([major, minor], direction).unwrap();
            let [a, b] = long.semi_axes(depth);
            worst.relative(a, 1.0);
            worst.relative(b, ratio);
            let [a, b] = Ellipsoid::new([minor, major], direction).unwrap().semi_axes(depth);
            worst.relative(a, ratio);
            worst.relative(b, 1.0);
            let elasticity = Elasticity::against_rigid(Body::new(E_STAR * 0.91, 0.3).unwrap());
            let profile = Profile::Ellipsoid(long);
            let setup = Setup { profile, elasticity, friction: 0.3, preload: Preload::Indentation(depth) };
            worst.relative(Contact::new(setup).unwrap().normal_force(), force);
        }
    }
}

#[test]
fn stuck_ellipses_are_stiffer_along_their_minor_axis() {
    let compliance = |profile: Profile| {
        let elasticity = Elasticity::against_rigid(Body::new(2e11, 0.3).unwrap());
        let setup = Setup { profile, elasticity, friction: 0.3, preload: Preload::NormalForce(10.0) };
        let elasticity = Contact::new(setup).unwrap().elasticity();
        elasticity.e_star() / elasticity.g_star()
    };
    let square = 0.75;
    let (k, e) = elliptic(square);
    let ratio = (k - e) / (e / 0.25 - k);
    let along = |direction| compliance(Profile::Ellipsoid(Ellipsoid::new([0.01, 0.01 * ratio], direction).unwrap()));
    let worst = Worst::new("compliances at b/a = 1/2, nu = 0.3, relative", 1e-11);
    worst.relative(along(Direction::X), 1.25052572217);
    worst.relative(along(Direction::Y), 1.178045706401);
    let circle = Worst::new("an ellipse that is a circle", 1e-14);
    let round = Profile::Ellipsoid(Ellipsoid::new([0.01, 0.01], Direction::Y).unwrap());
    circle.relative(compliance(round), 1.7 / 1.4);
    circle.relative(compliance(sphere(0.01)), 1.7 / 1.4);
    let nearly = Ellipsoid::new([0.01, 0.01 * (1.0 + 1e-9)], Direction::X).unwrap();
    let next = Worst::new("an ellipse that is nearly a circle", 1e-9);
    next.relative(Profile::Ellipsoid(nearly.clone()).indenter().radius(1e-6), sphere(0.01).indenter().radius(1e-6));
    next.relative(compliance(Profile::Ellipsoid(nearly)), 1.7 / 1.4);
    let unknown = setup(round_profile(), Preload::NormalForce(1.0));
    assert_eq!(Contact::new(unknown).map(|_| ()), Err(Error::BodiesNeeded));
}

fn round_profile() -> Profile {
    Profile::Ellipsoid(Ellipsoid::new([0.01, 0.02], Direction::X).unwrap())
}

#[test]
fn cycles_of_load_curves_dissipate_what_their_paths_do() {
    let mut random = Random(11);
    let (radii, gaps) = rough(400, &mut random);
    let law = power(2.0);
    let profiles = [asperities(&radii, &gaps), Profile::LoadCurve(sampled(&law, &even(60, 4e-6)))];
    let work = Worst::new("work of a cycle against its path, relative", 1e-11);
    for profile in profiles {
        let mut contact = contact(profile, 2.3e-6);
        let amplitude = 0.6 * contact.gross_slip_displacement();
        let cycle = SteadyCycle::of(&contact, amplitude);
        let (dissipated, force, harmonics) = (cycle.dissipated_energy(), cycle.force_amplitude(), cycle.harmonics(3));
        [amplitude, -amplitude, amplitude].iter().for_each(|&target| contact.apply(&displace(target)).unwrap());
        work.relative(contact.force(), force);
        let before = contact.state().dissipated_energy;
        [-amplitude, amplitude].iter().for_each(|&target| contact.apply(&displace(target)).unwrap());
        work.relative(contact.state().dissipated_energy - before, dissipated);
        // D = pi U0 times the fundamental out of phase.
        let fundamental = -std::f64::consts::PI * amplitude * harmonics.harmonics[0].quadrature;
        let error = (fundamental / dissipated - 1.0).abs();
        assert!(error < 1e-5 + 20.0 * harmonics.error, "{error:e} against {:e}", harmonics.error);
    }
}

#[test]
fn curved_moves_of_asperities_meet_their_tolerance() {
    let mut random = Random(5);
    let (radii, gaps) = rough(200, &mut random);
    let profile = asperities(&radii, &gaps);
    let mut rough = contact(profile.clone(), 2e-6);
    let limit = rough.normal_force();
    let step = Move {
        normal: Some(Normal::NormalForce(1.4 * limit)),
        tangential: Some(Tangential::Displacement(1.5e-7)),
        ..Move::default()
    };
    let mut fine = rough.clone();
    rough.apply(&step).unwrap();
    for index in 1..=2000 {
        fine.apply(&fine.partial_move(&step, 1.0 / f64::from(2001 - index))).unwrap();
    }
    assert!(rough.path_error() < 1e-9, "{:e}", rough.path_error());
    let off = (rough.force() - fine.force()).abs() / (0.31 * limit);
    assert!(off < 1e-8, "{off:e}");
}

/// Below 1e-154 m the square of a radius has fewer digits than the radius, or none.
#[test]
fn contacts_of_any_radius_slip_as_their_load_tells() {
    let mut random = Random(11);
    let worst = Worst::new("the force of a contact narrower than 1e-154 m / (mu F_N)", 1e-13);
    for _ in 0..200 {
        let exponent = random.within(10.0, 30.0);
        let levels: Vec<f64> = (0..8).map(|index| 2e-8 * f64::from(index)).collect();
        let forces: Vec<f64> = levels.iter().map(|level| (level / 1e-7).powf(exponent)).collect();
        let profile = Profile::LoadCurve(LoadCurve::new(&levels, &forces, &elasticity()).unwrap());
        // X at the first point, and the level at which it is as small as wanted.
        let first = exponent * forces[1] / (2.0 * E_STAR * levels[1]);
        let radius = 10_f64.powf(random.within(-166.0, -150.0));
        let depth = levels[1] * (radius / first).powf((exponent - 1.0).recip());
        let virgin = contact(profile.clone(), depth);
        assert!((virgin.contact_radius().log10() - radius.log10()).abs() < 0.1);
        let limit = virgin.summary().gross_slip_force;
        let mut pushed = virgin.clone();
        pushed.apply(&push(random.within(0.05, 0.95) * limit)).unwrap();
        // Ciavarella and Jäger: the load of the contact less that of one as deep as the stick zone, times mu.
        let stuck = depth * (1.0 - pushed.displacement() / virgin.gross_slip_displacement());
        let held = contact(profile, stuck).summary().gross_slip_force;
        worst.close(pushed.force(), limit - held, limit);
    }
}
