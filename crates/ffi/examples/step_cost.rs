//! What a step costs through the library, over one of the crate: `crate` or `library` and a number of steps, for a tool
//! that counts instructions.

use std::ptr::null_mut;

use stickslip_ffi::exports::{SS_INDENTATION, SS_OK, ss_contact_new, ss_step};
use stickslip_mechanics::{Contact, Move, Normal, Tangential};
use stickslip_wire::{CreateRequest, read};

const BALL: &std::ffi::CStr = c"{\"profile\": {\"type\": \"sphere\", \"radius\": 0.01}, \"friction\": 0.3,
    \"material\": {\"effective\": {\"e_star\": 1.15e11, \"g_star\": 8.5e10}}, \"preload\": {\"normal_force\": 10.0}}";

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let count: u32 = arguments.get(2).and_then(|count| count.parse().ok()).unwrap_or(100_000);
    let mut own = Contact::new(read::<CreateRequest>(BALL.to_bytes()).expect("a definition").setup).expect("a contact");
    let mut contact = null_mut();
    // SAFETY: a text, and a place for a handle.
    assert_eq!(unsafe { ss_contact_new(BALL.as_ptr(), &raw mut contact) }, SS_OK);
    let by_library = arguments.get(1).is_some_and(|which| which == "library");
    let start = std::time::Instant::now();
    let mut sum = 0.0;
    for index in 0..count {
        let phase = 0.1 * f64::from(index);
        let (displacement, depth) = (4e-8 * phase.sin(), 1e-7 * (1.0 + 0.2 * (0.37 * phase).cos()));
        if by_library {
            let mut forces = [0.0; 2];
            // SAFETY: one displacement, two forces.
            let code = unsafe { ss_step(contact, SS_INDENTATION, depth, &raw const displacement, forces.as_mut_ptr()) };
            assert_eq!(code, SS_OK);
            sum += forces[1];
        } else {
            let (tangential, normal) = (Some(Tangential::Displacement(displacement)), Some(Normal::Indentation(depth)));
            own.apply(&Move { tangential, normal, ..Move::default() }).expect("a move");
            sum += own.force() + 0.0 * own.normal_force();
        }
    }
    println!("{sum:e} N, {:.0} ns a step", start.elapsed().as_nanos() as f64 / f64::from(count));
}
