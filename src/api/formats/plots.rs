//! The plots of the pages of a contact: its history, loop and closed cycles.

use uuid::Uuid;

use stickslip_report::plot::{Axis, Colour, Curve, Panel, Plot};
use stickslip_wire::{Cycle, CyclePage, HistoryPage, LoopPage, State};

/// Displacement, force and friction work over the moves.
#[must_use]
pub fn history(id: Uuid, page: &HistoryPage) -> Plot {
    let panel = |name, unit, colour, of: fn(&State) -> f64| {
        curve(name, unit, colour, page.items.iter().map(|item| (item.sequence as f64, of(&item.state))))
    };
    Plot::new(
        format!("Contact {id}: history{}", shown(page.items.iter().map(|item| item.sequence))),
        Axis { name: "move", unit: None },
        vec![
            panel("displacement", "m", Colour::Blue, |state| state.displacement),
            panel("force", "N", Colour::Blue, |state| state.force),
            panel("friction work", "J", Colour::Red, |state| state.dissipated_energy),
        ],
    )
}

/// Force over displacement.
#[must_use]
pub fn hysteresis_loop(id: Uuid, page: &LoopPage) -> Plot {
    let points = page.displacement.iter().copied().zip(page.force.iter().copied());
    let moves = shown(page.sequence.iter().copied().filter(|number| *number > 0));
    Plot::new(
        format!("Contact {id}: hysteresis loop{moves}"),
        Axis::of("displacement U", "m"),
        vec![curve("tangential force F", "N", Colour::Blue, points)],
    )
}

/// A panel with one curve.
fn curve(name: &'static str, unit: &'static str, colour: Colour, points: impl Iterator<Item = (f64, f64)>) -> Panel {
    Panel { y: Axis::of(name, unit), curves: vec![Curve::line("", colour, points)] }
}

/// Which moves a plot shows, for its title.
fn shown(mut moves: impl DoubleEndedIterator<Item = u64>) -> String {
    let Some(last) = moves.next_back() else { return String::new() };
    match moves.next() {
        Some(first) if first < last => format!(", moves {first} to {last}"),
        _ => format!(", move {last}"),
    }
}

/// Amplitudes, friction work and stiffness of the cycles over the moves that closed them.
#[must_use]
pub fn cycles(id: Uuid, page: &CyclePage) -> Plot {
    let panel = |name, unit, colour, of: fn(&Cycle) -> f64| {
        curve(name, unit, colour, page.items.iter().map(|cycle| (cycle.to as f64, of(cycle))))
    };
    Plot::new(
        format!("Contact {id}: {}closed cycles", if page.items.is_empty() { "no " } else { "" }),
        Axis { name: "move", unit: None },
        vec![
            panel("amplitude U₀", "m", Colour::Blue, |cycle| cycle.displacement_amplitude),
            panel("amplitude F₀", "N", Colour::Blue, |cycle| cycle.force_amplitude),
            panel("friction work", "J", Colour::Red, |cycle| cycle.dissipated_energy),
            panel("secant stiffness", "N/m", Colour::Blue, |cycle| cycle.secant_stiffness.unwrap_or(f64::NAN)),
        ],
    )
}
