//! The plots of a contact's stress, history, loop and cycles.

use uuid::Uuid;

use stickslip_mechanics::{Contact, Regime};
use stickslip_report::plot::{Axis, Band, Colour, Curve, Panel, Plot};
use stickslip_wire::{Cycle, CyclePage, HistoryPage, LoopPage, State, StressReply};

/// Shear stress between the bounds of friction, with the regions that stuck and slipped in the last move.
#[must_use]
pub fn stress(id: Uuid, sequence: u64, contact: &Contact, reply: &StressReply) -> Plot {
    let over = |values: &Option<Vec<Option<f64>>>, factor: f64| {
        let values = values.iter().flatten().map(|value| factor * value.unwrap_or(f64::NAN));
        reply.radius.iter().copied().zip(values).collect::<Vec<_>>()
    };
    let state = contact.state();
    let friction = contact.friction();
    let (stick, edge) = (state.stick_radius, state.contact_radius);
    let mut bands = Vec::new();
    if state.regime != Regime::Separated {
        if stick > 0.0 {
            bands.push(Band { name: "stick", from: 0.0, to: stick, colour: Colour::Blue });
        }
        if stick < edge {
            bands.push(Band { name: "slip", from: stick, to: edge, colour: Colour::Red });
        }
    }
    let curve = |name, points, colour, silent| Curve { name, points, colour, silent };
    Plot {
        title: format!("Contact {id} after move {sequence}: shear stress"),
        x: Axis { name: "radius r", unit: Some("m") },
        panels: vec![Panel {
            y: Axis { name: "stress", unit: Some("Pa") },
            curves: vec![
                curve("friction bound ±μp", over(&reply.pressure, friction), Colour::Grey, false),
                curve("", over(&reply.pressure, -friction), Colour::Grey, true),
                curve("shear stress τ", over(&reply.shear, 1.0), Colour::Blue, false),
            ],
        }],
        bands,
    }
}

/// Displacement, force and friction work over the moves.
#[must_use]
pub fn history(id: Uuid, page: &HistoryPage) -> Plot {
    let panel = |name, unit, colour, of: fn(&State) -> f64| Panel {
        y: Axis { name, unit: Some(unit) },
        curves: vec![Curve {
            name: "",
            points: page.items.iter().map(|item| (item.sequence as f64, of(&item.state))).collect(),
            colour,
            silent: true,
        }],
    };
    Plot {
        title: format!("Contact {id}: history"),
        x: Axis { name: "move", unit: None },
        panels: vec![
            panel("displacement", "m", Colour::Blue, |state| state.displacement),
            panel("force", "N", Colour::Blue, |state| state.force),
            panel("friction work", "J", Colour::Red, |state| state.dissipated_energy),
        ],
        bands: Vec::new(),
    }
}

/// Force over displacement.
#[must_use]
pub fn hysteresis_loop(id: Uuid, page: &LoopPage) -> Plot {
    let points = page.displacement.iter().copied().zip(page.force.iter().copied()).collect();
    Plot {
        title: format!("Contact {id}: hysteresis loop"),
        x: Axis { name: "displacement U", unit: Some("m") },
        panels: vec![Panel {
            y: Axis { name: "tangential force F", unit: Some("N") },
            curves: vec![Curve { name: "", points, colour: Colour::Blue, silent: true }],
        }],
        bands: Vec::new(),
    }
}

/// Amplitudes, friction work and stiffness of the cycles over the moves that closed them.
#[must_use]
pub fn cycles(id: Uuid, page: &CyclePage) -> Plot {
    let panel = |name, unit, colour, of: fn(&Cycle) -> f64| Panel {
        y: Axis { name, unit: Some(unit) },
        curves: vec![Curve {
            name: "",
            points: page.items.iter().map(|cycle| (cycle.to as f64, of(cycle))).collect(),
            colour,
            silent: true,
        }],
    };
    Plot {
        title: format!("Contact {id}: closed cycles"),
        x: Axis { name: "move", unit: None },
        panels: vec![
            panel("displacement amplitude", "m", Colour::Blue, |cycle| cycle.displacement_amplitude),
            panel("force amplitude", "N", Colour::Blue, |cycle| cycle.force_amplitude),
            panel("friction work", "J", Colour::Red, |cycle| cycle.dissipated_energy),
            panel("secant stiffness", "N/m", Colour::Blue, |cycle| cycle.secant_stiffness.unwrap_or(f64::NAN)),
        ],
        bands: Vec::new(),
    }
}
