//! The stresses in the present state of a contact.

use uuid::Uuid;

use stickslip_mechanics::{Contact, Profile, Regime};
use stickslip_plot::{Axis, Band, Colour, Curve, Drawing, Panel, Plot};
use stickslip_wire::{Field, Sampling, StressReply};

use super::{DisplayOptions, OnContact, Outcome};
use crate::formats::{Column, Table};
use crate::simulation::cost::Work;
use crate::simulation::{self, Failure, bytes};
use crate::{Nanoseconds, Stop};

/// Which stresses of which contact.
pub struct StressTask {
    /// The contact, for the title of a plot.
    pub id: Uuid,
    /// Where, and which fields.
    pub sampling: Sampling,
    /// Whether the extrema of the shear stress are asked for.
    pub residual: bool,
}

/// Stresses, and the contact that has them.
pub struct Stresses {
    id: Uuid,
    sequence: u64,
    contact: Contact,
    reply: StressReply,
}

impl OnContact for StressTask {
    type Outcome = Stresses;

    fn bytes(&self) -> usize {
        bytes::of_stress(self.sampling.length())
    }

    fn rows(&self) -> (usize, usize) {
        (self.sampling.length(), bytes::ROW)
    }

    fn cost(&self, profile: &Profile, depth: usize) -> Nanoseconds {
        let radii = self.sampling.length();
        Work { depth, radii, residual: self.residual, ..Work::default() }.cost(profile)
    }

    fn run(self, contact: Contact, sequence: u64, stop: &dyn Stop) -> Result<Stresses, Failure> {
        let stress = simulation::stresses(&contact, &self.sampling, stop)?;
        let reply = StressReply {
            radius: stress.radius,
            pressure: stress.pressure,
            shear: stress.shear,
            slip: stress.slip,
            displacement: stress.displacement,
            residual: self.residual.then(|| simulation::residual(&contact, stop)).transpose()?,
        };
        Ok(Stresses { id: self.id, sequence, contact, reply })
    }
}

impl Outcome for Stresses {
    type Reply = StressReply;

    fn reply(&self) -> &StressReply {
        &self.reply
    }

    fn table(&self, _: &DisplayOptions) -> Option<Table<'_>> {
        let StressReply { pressure, shear, slip, displacement, .. } = &self.reply;
        Some(table(&self.reply.radius, [pressure, shear, slip, displacement]))
    }

    /// Shear stress between the bounds of friction, with the regions that stuck and slipped in the last move.
    fn picture(&self, _: &DisplayOptions) -> Option<Drawing> {
        let Stresses { id, sequence, contact, reply } = self;
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
        let curves = vec![
            Curve::line("friction bound ±μp", Colour::Grey, over(&reply.pressure, friction)),
            Curve::line("", Colour::Grey, over(&reply.pressure, -friction)),
            Curve::line("shear stress τ", Colour::Blue, over(&reply.shear, 1.0)),
        ];
        let title = format!("Contact {id} after move {sequence}: shear stress");
        let panels = vec![Panel { y: Axis::of("stress", "Pa"), curves }];
        Some(Drawing::Plot(Plot { bands, ..Plot::new(title, Axis::of("radius r", "m"), panels) }))
    }
}

/// A field at some radii, if it was asked for.
pub(super) type Values = Option<Vec<Option<f64>>>;

/// The fields over the radius, in the order of [`Field::ALL`].
pub(super) fn table<'a>(radius: &'a [f64], fields: [&'a Values; 4]) -> Table<'a> {
    let mut columns = vec![Column::floats("radius", "m", |row| radius[row])];
    for (field, values) in Field::ALL.into_iter().zip(fields) {
        if let Some(values) = values {
            columns.push(Column::floats(field.name(), unit(field), |row| values[row]));
        }
    }
    Table::flat(radius.len(), columns)
}

/// The SI unit of a field.
pub(super) fn unit(field: Field) -> &'static str {
    match field {
        Field::Pressure | Field::Shear => "Pa",
        Field::Slip | Field::Displacement => "m",
    }
}
