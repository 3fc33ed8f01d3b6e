//! The engine: moves with the length of the path, stresses with radii and pieces of slip history, tables with their
//! points, and sweeps with theirs.

use std::hint::black_box;

use serde_json::json;
use stickslip_compute::Flag;
use stickslip_compute::simulation::{Sweep, SweepResult};
use stickslip_mechanics::Contact;
use stickslip_wire::{self as wire, PrepareAnew, SweepRequest};

use crate::law::{fit, seconds};
use crate::scenes::{contact, radii, reversed, shapes, slide, sphere, table};

const LENGTHS: [usize; 4] = [100, 1_000, 10_000, 100_000];
const RADII: [usize; 3] = [50, 200, 800];
const REVERSALS: [usize; 4] = [3, 10, 30, 100];
/// Those of a history that is summed by clusters.
const MANY_REVERSALS: [usize; 3] = [300, 1_000, 3_000];
const TABLE_POINTS: [u32; 6] = [100, 300, 1_000, 2_000, 5_000, 10_000];
const SWEEP_POINTS: [usize; 4] = [10, 100, 1_000, 10_000];

/// Prints all of it, with the memory of a contact.
pub fn all() {
    println!("Stress at R radii after N pieces: s + R (b + c log2 N + d N) + e N. Moves: a each. Times in ns.\n");
    println!("| shape | s | b | c | d | e | off by | a | off by |\n|---|---|---|---|---|---|---|---|---|");
    for (name, profile) in shapes() {
        let virgin = contact(profile);
        let ([a_move], error) = fit(&LENGTHS.map(|length| path(&virgin, length)));
        println!("| {name} | {} | {:.0} | {:.0} % |", stresses(&virgin, &REVERSALS), 1e9 * a_move, 100.0 * error);
    }
    println!("| sphere, from 300 pieces on | {} | | |", stresses(&contact(sphere()), &MANY_REVERSALS));
    tables();
    sweeps();
    let virgin = contact(sphere());
    let thousand = reversed(&virgin, 1_000);
    let pieces = thousand.memory_depth() - virgin.memory_depth();
    let bytes = (thousand.memory_bytes() - virgin.memory_bytes()) as f64 / pieces as f64;
    println!("\nA contact takes {} bytes, and {bytes:.0} for each piece more.", virgin.memory_bytes());
}

/// The coefficients of the law of the shear stress, and how far it is off.
fn stresses(virgin: &Contact, reversals: &[usize]) -> String {
    let samples: Vec<_> = reversals.iter().flat_map(|&reversals| stress(virgin, reversals)).collect();
    let ([start, radius, doubling, term, piece], error) = fit(&samples);
    let [start, radius, doubling, term, piece] = [start, radius, doubling, term, piece].map(|time| 1e9 * time);
    format!("{start:.0} | {radius:.0} | {doubling:.1} | {term:.2} | {piece:.0} | {:.0} %", 100.0 * error)
}

/// Random moves: their number, and the time of all of them.
fn path(virgin: &Contact, length: usize) -> ([f64; 1], f64) {
    let (mut random, unit) = (fastrand::Rng::with_seed(1), virgin.gross_slip_displacement());
    let path: Vec<f64> = (0..length).map(|_| (2.0 * random.f64() - 1.0) * unit).collect();
    let time = seconds(|| {
        let mut contact = black_box(virgin.clone());
        path.iter().for_each(|target| slide(&mut contact, *target));
    });
    ([length as f64], time)
}

/// The shear stress: the terms of its law, and the time.
fn stress(virgin: &Contact, reversals: usize) -> [([f64; 5], f64); 3] {
    let contact = reversed(virgin, reversals);
    let pieces = contact.memory_depth() as f64;
    RADII.map(|count| {
        let radii = radii(&contact, count);
        let time = seconds(|| drop(black_box(contact.shears(&radii))));
        let radii = count as f64;
        ([1.0, radii, radii * pieces.log2(), radii * pieces, pieces], time)
    })
}

/// Tables with their points P: the law is a + b log2 P + c P for a move and for the stress at 200 radii after 20
/// reversals. A move looks up levels and radii; a stress weights every point once, and looks up clusters at every
/// radius.
fn tables() {
    println!("\n| work on a table | of no points, us | for each doubling, us | each point, ns | off by |");
    println!("|---|---|---|---|---|");
    let contacts =
        TABLE_POINTS.map(|points| ([1.0, f64::from(points).log2(), f64::from(points)], contact(table(points))));
    let moves = contacts.each_ref().map(|(terms, virgin)| (*terms, path(virgin, 1_000).1 / 1e3));
    let stresses = contacts.each_ref().map(|(terms, virgin)| {
        let contact = reversed(virgin, 20);
        let radii = radii(&contact, 200);
        (*terms, seconds(|| drop(black_box(contact.shears(&radii)))))
    });
    for (name, samples) in [("a move", moves), ("stress at 200 radii", stresses)] {
        let ([fixed, doubling, point], error) = fit(&samples);
        let [fixed, doubling, point] = [1e6 * fixed, 1e6 * doubling, 1e9 * point];
        println!("| {name} | {fixed:.2} | {doubling:.2} | {point:.2} | {:.0} % |", 100.0 * error);
    }
}

/// Sweeps on one thread with their points: of a sphere, and of a table of 1000 points under other friction.
fn sweeps() {
    println!("\n| sweep of | once, us | each point, us | off by |\n|---|---|---|---|");
    let radii: Vec<f64> = (0..1_000).map(|index| 2e-7 * f64::from(index)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| 50.0 * r * r).collect();
    let profiles = [
        ("a sphere", json!({"type": "sphere", "radius": 0.01})),
        ("a table of 1000 points", json!({"type": "tabulated", "r": radii, "z": heights})),
    ];
    for (name, profile) in profiles {
        let samples = SWEEP_POINTS.map(|points| {
            let request = json!({
                "base": {
                    "contact": {"profile": profile, "material": {"effective": {"e_star": 1.15e11, "g_star": 8.5e10}},
                        "friction": 0.3, "preload": {"normal_force": 10}},
                    "path": {"falling_amplitude": {"reversals": 20}}, "steps": "last"
                },
                "axes": [{"pointer": "/contact/friction", "linear": {"from": 0.1, "to": 0.6, "count": points}}],
                "outputs": ["/steps/0/force"]
            })
            .to_string();
            ([1.0, points as f64], seconds(|| drop(black_box(sweep(&request, points)))))
        });
        let ([once, each], error) = fit(&samples);
        println!("| {name} | {:.0} | {:.1} | {:.0} % |", 1e6 * once, 1e6 * each, 100.0 * error);
    }
}

fn sweep(request: &str, points: usize) -> SweepResult {
    let draft = wire::read::<SweepRequest>(request.as_bytes()).expect("a valid sweep");
    let sweep = Sweep::plan(draft, &PrepareAnew).expect("a sweep with outputs");
    sweep.compute(0..points, 1, &Flag::default()).expect("it is not stopped")
}
