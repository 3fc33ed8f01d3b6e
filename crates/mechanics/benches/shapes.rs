//! What the shape costs, over the same on a sphere: 20 reversals with the shear stress at 200 radii, a move with its
//! force, all extrema of the shear stress after 20 reversals, the displacement of the surface at a radius, one of 200,
//! in the same state, and the search for the protocol of 50 reversals that leaves the least. Below it, what twist
//! costs over shift of the sphere, and what a table costs before its first move.
//!
//! `cargo bench -p stickslip-mechanics --bench shapes` prints a table. Each run of a shape follows one of the sphere,
//! and the ratio is the median over such pairs, so that other work on the machine counts on both sides.

mod scenes;

use std::hint::black_box;
use std::time::{Duration, Instant};

use scenes::{BALL, VALID, contact, elasticity, points, radii, reversed, shapes, slide, sphere, table};
use stickslip_mechanics::profile::{Asperities, Direction, Ellipsoid, LineContact, LoadCurve, Sum, Tabulated};
use stickslip_mechanics::protocol::{falling_amplitude, minimax};
use stickslip_mechanics::{Contact, Move, Profile, Tangential};

const REVERSALS: usize = 20;
const RADII: usize = 200;
const MOVES: usize = 1000;
const PAIRS: usize = 25;
/// The same of the search for a protocol, which takes a thousand times as long as a stress.
const PAIRS_OF_SEARCHES: usize = 5;
/// Reversals of the protocol.
const PROTOCOL: usize = 50;

/// The time of a piece of work on a new contact.
type Scene = fn(&Contact) -> Duration;

/// Every profile without a stress field, with its name.
fn curves() -> Vec<(&'static str, Profile)> {
    let asperities = |count: u32| {
        let mut random = fastrand::Rng::with_seed(2);
        let gaps: Vec<f64> = (0..count).map(|_| 1e-6 * random.f64()).collect();
        Profile::Asperities(Asperities::new(&[1e-4], &gaps).expect(VALID))
    };
    let levels: Vec<f64> = (0..100).map(|index| 2e-8 * f64::from(index)).collect();
    let forces: Vec<f64> = levels.iter().map(|level| 1e10 * level.powf(1.5)).collect();
    vec![
        ("100 asperities", asperities(100)),
        ("10 000 asperities", asperities(10_000)),
        ("load curve of 100 points", Profile::LoadCurve(LoadCurve::new(&levels, &forces, &elasticity()).expect(VALID))),
        ("ellipsoid", Profile::Ellipsoid(Ellipsoid::new([BALL, 2.0 * BALL], Direction::X).expect(VALID))),
    ]
}

/// The line contacts, with their names.
fn lines() -> Vec<(&'static str, Profile)> {
    let cylinder = LineContact::cylinder(BALL, 1e-3, None).expect(VALID);
    let pad = LineContact::rounded_pad(1e-5, BALL, 1e-3, None).expect(VALID);
    vec![("cylinder", Profile::Line(cylinder)), ("rounded pad", Profile::Line(pad))]
}

/// The time of the reversals and the shear stress.
fn stresses(virgin: &Contact) -> Duration {
    let radii = radii(virgin, RADII);
    let start = Instant::now();
    black_box(reversed(virgin, REVERSALS).shears(&radii));
    start.elapsed()
}

/// The time of moves to and fro, each with its force.
fn moves(virgin: &Contact) -> Duration {
    let (mut contact, full) = (virgin.clone(), virgin.gross_slip_displacement());
    let mut random = fastrand::Rng::with_seed(1);
    let start = Instant::now();
    for _ in 0..MOVES {
        slide(&mut contact, (2.0 * random.f64() - 1.0) * full);
        black_box(contact.force());
    }
    start.elapsed()
}

/// The twist of a contact to so many parts of its first slip through nearly all of the disc.
fn twist(contact: &mut Contact, part: f64, full: f64) {
    let step = Move { tangential: Some(Tangential::Twist(part * full)), ..Move::default() };
    contact.apply(&step).expect("an angle has no limit");
}

fn can_be_twisted(virgin: &Contact) -> bool {
    let step = Move { tangential: Some(Tangential::Twist(0.0)), ..Move::default() };
    virgin.clone().apply(&step).is_ok()
}

/// The angle, rad, at which a virgin contact carries nearly all of its torque.
fn full_twist(virgin: &Contact) -> f64 {
    let mut twisted = virgin.clone();
    let limit = virgin.gross_slip_torque().expect(VALID);
    let step = Move { tangential: Some(Tangential::Torque(0.99 * limit)), ..Move::default() };
    twisted.apply(&step).expect("below the limit");
    twisted.state().twist.expect("it is twisted")
}

/// The time of shifts to and fro, each with its state.
fn shifts(virgin: &Contact) -> Duration {
    let (mut contact, full) = (virgin.clone(), virgin.gross_slip_displacement());
    let mut random = fastrand::Rng::with_seed(1);
    let start = Instant::now();
    for _ in 0..MOVES {
        slide(&mut contact, (2.0 * random.f64() - 1.0) * full);
        black_box(contact.state());
    }
    start.elapsed()
}

/// The time of one of them.
fn a_shift(virgin: &Contact) -> Duration {
    shifts(virgin) / MOVES as u32
}

/// The time of twists to and fro, each with its state.
fn twists(virgin: &Contact) -> Duration {
    let (mut contact, full) = (virgin.clone(), full_twist(virgin));
    twist(&mut contact, 0.0, full);
    let mut random = fastrand::Rng::with_seed(1);
    let start = Instant::now();
    for _ in 0..MOVES {
        twist(&mut contact, 2.0 * random.f64() - 1.0, full);
        black_box(contact.state());
    }
    start.elapsed()
}

/// The time of reversals of twist, and the hoop stress.
fn hoops(virgin: &Contact) -> Duration {
    let (radii, full) = (radii(virgin, RADII), full_twist(virgin));
    let mut contact = virgin.clone();
    twist(&mut contact, 0.0, full);
    let start = Instant::now();
    falling_amplitude(REVERSALS, 1.0).for_each(|part| twist(&mut contact, part, full));
    black_box(contact.hoops(&radii));
    start.elapsed()
}

/// The time of the first twist, which makes the limit of the angle.
fn first_twist(virgin: &Contact) -> Duration {
    let mut contact = virgin.clone();
    let start = Instant::now();
    twist(&mut contact, 0.0, 0.0);
    start.elapsed()
}

/// The time of the displacement of the surface.
fn displacements(virgin: &Contact) -> Duration {
    let (contact, radii) = (reversed(virgin, REVERSALS), radii(virgin, RADII));
    let start = Instant::now();
    black_box(contact.surface_displacements(&radii));
    start.elapsed()
}

/// The time of the extrema.
fn extrema(virgin: &Contact) -> Duration {
    let contact = reversed(virgin, REVERSALS);
    let start = Instant::now();
    black_box(contact.residual());
    start.elapsed()
}

/// The time of the search for the best protocol.
fn protocol(virgin: &Contact) -> Duration {
    let start = Instant::now();
    black_box(minimax(virgin, PROTOCOL, &|| true));
    start.elapsed()
}

/// The time of a contact of a new profile with one move, its force and its errors.
fn request(profile: impl FnOnce() -> Profile) -> Duration {
    let start = Instant::now();
    let mut contact = contact(profile());
    let full = contact.gross_slip_displacement();
    slide(&mut contact, 0.5 * full);
    black_box((contact.force(), contact.accuracy()));
    start.elapsed()
}

/// Prints what tables cost with the contact that first needs them, and with its first move.
fn new_tables(rows: &[(bool, u32)]) {
    println!(
        "\nTables made ready for a contact, the least time in us, and with one move, over the same of the sphere.\n"
    );
    println!("| points | heights | made ready | with one move | |");
    println!("|---|---|---|---|---|");
    for &(parabola, count) in rows {
        let (radii, z) = points(count, parabola);
        let table = || Tabulated::new(&radii, &z).expect("a valid table");
        let (mut ready, mut times, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..PAIRS {
            let unit = request(sphere).as_secs_f64();
            let start = Instant::now();
            black_box(contact(Profile::Tabulated(table())));
            ready.push(1e6 * start.elapsed().as_secs_f64());
            let time = request(|| Profile::Tabulated(table())).as_secs_f64();
            times.push(1e6 * time);
            ratios.push(time / unit);
        }
        let heights = if parabola { "parabola" } else { "sphere" };
        let least = ready.into_iter().fold(f64::INFINITY, f64::min);
        println!("| {count} | {heights} | {least:.1} | {:.1} | {:.0} |", median(times), median(ratios));
    }
}

/// The median time of a scene in us for each of `count` parts of it, and over that of the sphere.
fn compared(scene: Scene, contacts: (&Contact, &Contact), count: usize, pairs: usize) -> String {
    compared_with([scene; 2], contacts, count, pairs)
}

/// The same of a scene of the sphere and another one of the shape.
fn compared_with(scenes: [Scene; 2], (sphere, shape): (&Contact, &Contact), count: usize, pairs: usize) -> String {
    let (mut times, mut ratios) = (Vec::new(), Vec::new());
    for _ in 0..pairs {
        let unit = scenes[0](sphere).as_secs_f64();
        let time = scenes[1](shape).as_secs_f64();
        times.push(1e6 * time / count as f64);
        ratios.push(time / unit);
    }
    format!("{:.3} | {:.1}", median(times), median(ratios))
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    let filter = std::env::args().skip(1).find(|argument| !argument.starts_with("--")).unwrap_or_default();
    let wanted = |name: &str| name.contains(&filter);
    let unit = contact(sphere());
    println!("Times in us, and over the sphere's.\n");
    println!("| shape | stress at 200 radii | | a move | | extrema | | displacement at a radius | | minimax | |");
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for (name, profile) in shapes().into_iter().chain(lines()).filter(|(name, _)| wanted(name)) {
        let shape = contact(profile);
        let scenes: [(Scene, usize, usize); 5] = [
            (stresses, 1, PAIRS),
            (moves, MOVES, PAIRS),
            (extrema, 1, PAIRS),
            (displacements, RADII, PAIRS),
            (protocol, 1, PAIRS_OF_SEARCHES),
        ];
        let figures = scenes.map(|(scene, count, pairs)| compared(scene, (&unit, &shape), count, pairs));
        println!("| {name} | {} |", figures.join(" | "));
    }
    println!("\nTwist, over the shift of the sphere; the first twist in moves of it.\n");
    println!("| shape | a move with its state | | hoop stress at 200 radii | | first twist | |");
    println!("|---|---|---|---|---|---|---|");
    for (name, profile) in shapes().into_iter().filter(|(name, _)| wanted(name)) {
        let (shape, pairs) = (contact(profile), PAIRS);
        // Twist refuses tables of more than some hundred points.
        if !can_be_twisted(&shape) {
            continue;
        }
        let virgin = (&unit, &shape);
        let figures = [
            compared_with([shifts, twists], virgin, MOVES, pairs),
            compared_with([stresses, hoops], virgin, 1, pairs),
            compared_with([a_shift, first_twist], virgin, 1, pairs),
        ];
        println!("| {name} | {} |", figures.join(" | "));
    }
    println!("\nWhat has no stress field, a move in us, and over the sphere's.\n");
    println!("| profile | a move | |");
    println!("|---|---|---|");
    for (name, profile) in curves().into_iter().filter(|(name, _)| wanted(name)) {
        println!("| {name} | {} |", compared(moves, (&unit, &contact(profile)), MOVES, PAIRS));
    }
    if wanted("sum made ready") {
        for count in [100, 1_000, 10_000] {
            let table = table(count);
            let made = || Sum::new(vec![sphere(), table.clone()]).expect(VALID);
            made();
            let times = (0..PAIRS).map(|_| {
                let start = Instant::now();
                black_box(made());
                1e6 * start.elapsed().as_secs_f64()
            });
            println!(
                "\nA sum of a sphere and a table of {count} points that is ready: {:.0} us",
                median(times.collect())
            );
        }
    }
    if wanted("table made ready") {
        new_tables(&[true, false].map(|parabola| [100, 1_000, 10_000].map(|count| (parabola, count))).concat());
    }
}
