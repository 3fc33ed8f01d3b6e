//! Error estimates of sums with tables, against the sum of the bodies that the tables were taken from. The g of
//! a table may fall in a sum, as long as that of the sum does not.

use crate::support::{Random, displace};
use stickslip_mechanics::profile::{Cone, ExactSphere, PowerLaw, Sum, Tabulated};
use stickslip_mechanics::{Contact, Elasticity, Error, Preload, Profile, Setup, Sphere};

/// A body of about unit size, and the table of its heights at random radii up to one.
fn measured(random: &mut Random) -> (Profile, Profile) {
    let blunt = random.within(1.2, 4.0);
    let count = 5 + random.bits() % 120;
    let uneven = random.within(0.0, 0.4);
    let mut radii: Vec<f64> = (0..=count).map(|i| (i as f64 + random.within(-uneven, uneven)) / count as f64).collect();
    (radii[0], radii[count as usize]) = (0.0, 1.0);
    let (body, heights): (_, Vec<f64>) = if random.bits().is_multiple_of(2) {
        let height = |r: &f64| r * r / (blunt + ((blunt - r) * (blunt + r)).sqrt());
        (Profile::ExactSphere(ExactSphere::new(blunt).unwrap()), radii.iter().map(height).collect())
    } else {
        let exponent = random.within(2.0, 5.0);
        let height = |r: &f64| r.powf(exponent) / blunt;
        (Profile::PowerLaw(PowerLaw::new(exponent, 1.0 / blunt).unwrap()), radii.iter().map(height).collect())
    };
    (body, Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap()))
}

#[test]
fn estimates_of_sums_with_tables_are_honest() {
    let mut random = Random(23);
    let (mut compared, mut worst, mut liars) = (0, [0.0_f64; 2], Vec::new());
    for scene in 0..200 {
        let (first, table) = measured(&mut random);
        let (mut bodies, mut tables) = (vec![first], vec![table]);
        match random.bits() % 4 {
            0 => {
                let (body, table) = measured(&mut random);
                bodies.push(body);
                tables.push(table);
            }
            1 => {
                let cone = Profile::Cone(Cone::new(random.within(0.02, 0.3)).unwrap());
                bodies.push(cone.clone());
                tables.push(cone);
            }
            _ => {
                let ball = Profile::Sphere(Sphere::new(random.within(0.5, 5.0)).unwrap());
                bodies.push(ball.clone());
                tables.push(ball);
            }
        }
        let (elasticity, friction) = (Elasticity::effective(1e6, random.within(5e5, 1.2e6)).unwrap(), 0.4);
        let (body, table) = (Profile::Sum(Sum::new(bodies).unwrap()), Profile::Sum(Sum::new(tables).unwrap()));
        let share = random.within(0.4, 0.85);
        let preload = match random.bits() % 2 {
            0 => Preload::ContactRadius(share),
            _ => Preload::Indentation(body.indenter().level(share)),
        };
        let contact = |profile| Contact::new(Setup { profile, elasticity, friction, preload });
        let (Ok(mut exact), Ok(mut found)) = (contact(body), contact(table)) else { continue };
        let figures = exact.summary();
        for _ in 0..1 + random.bits() % 4 {
            let step = displace(figures.gross_slip_displacement * random.within(-0.9, 0.9));
            exact.apply(&step).unwrap();
            found.apply(&step).unwrap();
        }
        compared += 1;
        let (estimate, edge) = (found.accuracy(), figures.contact_radius);
        let mut hold = |index: usize, error: f64, estimate: f64| {
            worst[index] = worst[index].max(error / estimate);
            if error > 3.0 * estimate {
                liars.push(format!("scene {scene}, {}: {error:.1e}, {estimate:.1e}", ["force", "stress"][index]));
            }
        };
        hold(0, (found.force() - exact.force()).abs() / figures.gross_slip_force, estimate.force_error);
        let mean = figures.normal_force / (std::f64::consts::PI * edge * edge);
        let unit = friction * figures.max_pressure.unwrap_or(mean);
        for _ in 0..4 {
            let radius = random.within(0.05, 1.0) * edge;
            // A kink lies where the level of the table does.
            let moved = estimate.force_error.min(0.1) * edge;
            let near = [radius, (radius - moved).max(0.0), radius + moved].map(|r| exact.shear(r));
            let (low, high) =
                (near.iter().copied().fold(f64::MAX, f64::min), near.iter().copied().fold(f64::MIN, f64::max));
            let value = found.shear(radius);
            hold(1, (value - value.clamp(low, high)).abs() / unit, estimate.stress_error);
        }
    }
    println!("{compared} sums: worst error over estimate {worst:.2?}");
    assert!(compared >= 150, "only {compared} sums were followed");
    assert!(liars.is_empty(), "{} of {compared}:\n{}", liars.len(), liars.join("\n"));
}

/// A part by its heights at even radii up to one.
fn part(count: u32, height: impl Fn(f64) -> f64) -> Profile {
    let radii: Vec<f64> = (0..=count).map(|index| f64::from(index) / f64::from(count)).collect();
    let heights: Vec<f64> = radii.iter().copied().map(height).collect();
    Profile::Tabulated(Tabulated::part(&radii, &heights).unwrap())
}

fn ball(radius: f64) -> Profile {
    Profile::Sphere(Sphere::new(radius).unwrap())
}

fn made_of(parts: Vec<Profile>, preload: Preload) -> Result<Contact, Error> {
    let elasticity = Elasticity::effective(1e6, 8e5).unwrap();
    Contact::new(Setup { profile: Profile::Sum(Sum::new(parts)?), elasticity, friction: 0.3, preload })
}

#[test]
fn a_ball_less_a_paraboloid_is_a_blunter_ball() {
    for (taken, preload) in [
        (0.4, Preload::ContactRadius(0.3)),
        (0.9, Preload::NormalForce(1e3)),
        (0.99, Preload::Indentation(1e-9)),
        (0.999_9, Preload::Indentation(1e-6)),
    ] {
        let mut found = made_of(vec![ball(1.0), part(30, |r| -0.5 * taken * r * r)], preload).unwrap();
        let mut exact = made_of(vec![ball(1.0 / (1.0 - taken))], preload).unwrap();
        let (estimate, figures) = (found.accuracy(), exact.summary());
        for share in [0.7, -0.5, 0.2] {
            let step = displace(share * figures.gross_slip_displacement);
            found.apply(&step).unwrap();
            exact.apply(&step).unwrap();
            let error = (found.force() - exact.force()).abs() / figures.gross_slip_force;
            assert!(error < 1e-9 && error <= 3.0 * estimate.force_error, "{taken}: {error:e} {estimate:?}");
        }
        let edge = figures.contact_radius;
        assert!((found.contact_radius() / edge - 1.0).abs() < 1e-10 / (1.0 - taken), "{taken}");
        for share in [0.0, 0.31, 0.9] {
            let unit = 0.3 * figures.max_pressure.unwrap();
            let error = (found.shear(share * edge) - exact.shear(share * edge)).abs() / unit;
            assert!(error < 1e-8 && error <= 3.0 * found.accuracy().stress_error, "{taken} at {share}: {error:e}");
        }
    }
}

#[test]
fn a_sum_ends_where_its_own_slope_falls() {
    // g = x^2 - (8/3) x^4 / c^2 with f = r^2/2 - r^4/c^2, so that g' = 0 at x = c sqrt(3/16).
    for crest in [0.5, 1.0, 2.0] {
        let parts = || vec![ball(1.0), part(400, |r| -r.powi(4) / (crest * crest))];
        let turn = crest * (3.0_f64 / 16.0).sqrt();
        let below = made_of(parts(), Preload::ContactRadius(0.99 * turn)).unwrap();
        let level = |x: f64| x * x - 8.0 / 3.0 * x.powi(4) / (crest * crest);
        assert!((below.indentation() / level(0.99 * turn) - 1.0).abs() < 1e-4);
        assert!(below.pressure(0.9 * turn) > 0.0);
        match made_of(parts(), Preload::ContactRadius(1.01 * turn)) {
            Err(Error::NotConvexEnough { radius }) => assert!((radius / turn - 1.0).abs() < 1e-3, "{radius} {turn}"),
            other => panic!("{:?}", other.map(|contact| contact.contact_radius())),
        }
        let pressed = made_of(parts(), Preload::Indentation(1.01 * level(turn)));
        assert!(
            matches!(pressed, Err(Error::NotConvexEnough { .. })),
            "{:?}",
            pressed.map(|contact| contact.summary())
        );
    }
    let hollow = Sum::new(vec![ball(1.0), part(50, |r| -r * r)]);
    assert!(matches!(hollow, Err(Error::NotConvexEnough { radius }) if radius < 1e-2), "{hollow:?}");
    let alone = Profile::Sum(Sum::new(vec![part(50, |r| r * r - r.powi(4))]).unwrap());
    assert!(alone.indenter().limit_radius().is_some_and(|limit| (limit - (3.0_f64 / 8.0).sqrt()).abs() < 1e-2));
}

#[test]
fn two_tables_may_make_up_for_each_other() {
    let wave = |r: f64| 0.02 * (1.0 - (9.0 * r).cos());
    let parts = vec![ball(1.0), part(600, wave), part(600, |r| -wave(r))];
    let mut found = made_of(parts, Preload::ContactRadius(0.7)).unwrap();
    let mut exact = made_of(vec![ball(1.0)], Preload::ContactRadius(0.7)).unwrap();
    let full = exact.summary().gross_slip_displacement;
    for share in [0.6, -0.1] {
        found.apply(&displace(share * full)).unwrap();
        exact.apply(&displace(share * full)).unwrap();
        assert!((found.force() - exact.force()).abs() < 1e-10 * exact.summary().gross_slip_force);
    }
}
