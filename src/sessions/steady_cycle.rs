//! A steady cycle at constant load, by three exact moves.

use stickslip_mechanics::{Contact, Move, State, Tangential};

/// A steady cycle.
pub(super) struct SteadyCycle {
    ends: [State; 2],
    zero: f64,
    amplitude: f64,
}

impl SteadyCycle {
    /// The cycle of a displacement amplitude, m, at the load of a virgin contact.
    pub(super) fn of(contact: &Contact, amplitude: f64) -> SteadyCycle {
        let mut contact = contact.clone();
        let mut to = |target| {
            let _ = contact.apply(&Move { tangential: Some(target), ..Move::default() });
            contact.state()
        };
        let first = to(Tangential::Displacement(amplitude));
        to(Tangential::Displacement(-amplitude));
        let last = to(Tangential::Displacement(amplitude));
        let zero = to(Tangential::Force(0.0)).displacement;
        SteadyCycle { ends: [first, last], zero, amplitude }
    }

    pub(super) fn force_amplitude(&self) -> f64 {
        self.ends[1].force
    }

    pub(super) fn dissipated_energy(&self) -> f64 {
        self.ends[1].dissipated_energy - self.ends[0].dissipated_energy
    }

    pub(super) fn sliding_ratio(&self) -> Option<f64> {
        (self.ends[1].force > 0.0).then_some(self.zero / self.amplitude)
    }
}
