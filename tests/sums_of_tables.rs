//! A sum with tables in it says how far they may put it off: against the sum of the bodies that they were taken from.

mod physics;

use physics::{Random, displace};
use stickslip::mechanics::profile::{Cone, ExactSphere, PowerLaw, Sum, Tabulated};
use stickslip::mechanics::{Contact, Elasticity, Preload, Profile, Setup, Sphere};

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
            _ => Preload::Indentation(body.level(share)),
        };
        let contact = |profile| Contact::new(Setup { profile, elasticity, friction, preload });
        let (Ok(mut exact), Ok(mut found)) = (contact(body), contact(table)) else { continue };
        let figures = exact.figures();
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
