//! What the shape costs, over the same on a sphere: 20 reversals with the shear stress at 200 radii, a move with its force, all
//! extrema of the shear stress after 20 reversals, the displacement of the surface at a radius, one of 200, in the same state, and
//! the search for the protocol of 50 reversals that leaves the least.
//!
//! `cargo bench -p stickslip-mechanics --bench shapes` prints a table. Each run of a shape follows one of the sphere, and the ratio is
//! the median over such pairs, so that other work on the machine counts on both sides.

mod scenes;

use std::hint::black_box;
use std::time::{Duration, Instant};

use scenes::{contact, radii, reversed, shapes, slide, sphere};
use stickslip_mechanics::Contact;
use stickslip_mechanics::protocol::minimax;

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

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    let sphere = contact(sphere());
    println!("Times in us, and over the sphere's.\n");
    println!("| shape | stress at 200 radii | | a move | | extrema | | displacement at a radius | | minimax | |");
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for (name, profile) in shapes() {
        let shape = contact(profile);
        let scenes: [(Scene, usize, usize); 5] = [
            (stresses, 1, PAIRS),
            (moves, MOVES, PAIRS),
            (extrema, 1, PAIRS),
            (displacements, RADII, PAIRS),
            (protocol, 1, PAIRS_OF_SEARCHES),
        ];
        let figures = scenes.map(|(scene, count, pairs)| {
            let (mut times, mut ratios) = (Vec::new(), Vec::new());
            for _ in 0..pairs {
                let unit = scene(&sphere).as_secs_f64();
                let time = scene(&shape).as_secs_f64();
                times.push(1e6 * time / count as f64);
                ratios.push(time / unit);
            }
            format!("{:.3} | {:.1}", median(times), median(ratios))
        });
        println!("| {name} | {} |", figures.join(" | "));
    }
}
