//! The stresses in the present state of a contact.

use stickslip_mechanics::Regime;
use stickslip_plot::Band;
use stickslip_wire::StressReply;

use crate::computations::prelude::*;

/// Which stresses of which contact.
pub struct StressTask {
    /// Where, and which fields.
    pub sampling: StressRequest,
    /// Whether the extrema of the shear stress are asked for.
    pub residual: bool,
}

/// Stresses, and the contact that has them.
pub struct Stresses {
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

    fn takes_shear_strength(&self) -> bool {
        true
    }

    fn run(self, contact: Contact, sequence: u64, stop: &dyn Stop) -> Result<Stresses, Failure> {
        let stress = simulation::stresses(&contact, &self.sampling, stop)?;
        let residual = self.residual.then(|| simulation::residual(&contact, stop)).transpose()?;
        Ok(Stresses { sequence, contact, reply: StressReply { stress, residual } })
    }
}

impl Borrow<StressReply> for Stresses {
    fn borrow(&self) -> &StressReply {
        &self.reply
    }
}

impl Outcome for Stresses {
    type Reply = StressReply;

    fn table(&self, _: &DisplayOptions) -> Option<Table<'_>> {
        let stress = &self.reply.stress;
        Some(table(place_column(stress), &fields(stress)))
    }

    /// Shear stress between the bounds of friction, with the regions that stuck and slipped in the last move.
    fn picture(&self, _: &DisplayOptions) -> Option<Drawing> {
        let Stresses { sequence, contact, reply: StressReply { stress, .. } } = self;
        let over = |values: &Values, factor: f64| {
            points(stress.places(), values).into_iter().map(move |(place, value)| (place, factor * value))
        };
        let state = contact.state();
        let (friction, strength) = (contact.friction(), contact.shear_strength());
        let name = if strength > 0.0 { "friction bound ±(τ₀ + μp)" } else { "friction bound ±μp" };
        let (stick, edge) = (state.stick_radius, state.contact_radius);
        let bound = |sign: f64| {
            let cohesion = move |place: f64| if place.abs() <= edge { sign * strength } else { 0.0 };
            over(&stress.pressure, sign * friction).map(move |(place, limit)| (place, limit + cohesion(place)))
        };
        let mut bands = Vec::new();
        if !matches!(state.regime, Regime::Separated | Regime::PulledOff) {
            let line = contact.profile().line().is_some();
            let middle = state.stick_centre.unwrap_or(0.0);
            let (from, least) = if line { (middle - stick, -edge) } else { (0.0, 0.0) };
            if stick > 0.0 {
                bands.push(Band { name: "stick", from, to: middle + stick, colour: Colour::Blue });
            }
            if line && stick < edge {
                bands.push(Band { name: "", from: least, to: from, colour: Colour::Red });
            }
            if stick < edge {
                bands.push(Band { name: "slip", from: middle + stick, to: edge, colour: Colour::Red });
            }
        }
        let curves = vec![
            Curve::line(name, Colour::Grey, bound(1.0)),
            Curve::line("", Colour::Grey, bound(-1.0)),
            Curve::line("shear stress τ", Colour::Blue, over(&stress.shear, 1.0)),
        ];
        let title = format!("Shear stress after move {sequence}");
        let panels = vec![Panel { y: Axis::of("stress", "Pa"), curves }];
        Some(Drawing::Plot(Plot { bands, ..Plot::new(title, place_axis(stress.x.is_some()), panels) }))
    }
}

/// A field at some radii, if it was asked for.
pub(super) type Values = Option<Vec<Option<f64>>>;

/// The column of places: radii or, of a line contact, x, m.
pub(super) fn place_column(stress: &Stress) -> (&'static str, &[f64]) {
    (if stress.x.is_some() { "x" } else { "radius" }, stress.places())
}

/// The axis of a picture over these places.
pub(super) fn place_axis(line: bool) -> Axis {
    Axis::of(if line { "x" } else { "radius r" }, "m")
}

/// The name of a field, its unit, and its values.
pub(super) type NamedField<'a> = (&'static str, &'static str, &'a Values);

/// All fields, whether they were asked for or not.
pub(super) fn fields(stress: &Stress) -> [NamedField<'_>; 5] {
    [
        (Field::Pressure.name(), "Pa", &stress.pressure),
        (Field::Shear.name(), "Pa", &stress.shear),
        (Field::Slip.name(), "m", &stress.slip),
        (Field::Displacement.name(), "m", &stress.displacement),
        (Field::Hoop.name(), "Pa", &stress.hoop),
    ]
}

/// A row for each place, with the fields that were asked for.
pub(super) fn table<'a>((name, places): (&'static str, &'a [f64]), fields: &[NamedField<'a>]) -> Table<'a> {
    let mut columns = vec![Column::floats(name, "m", |row| places[row])];
    for &(name, unit, values) in fields {
        columns.extend(values.as_ref().map(|values| Column::floats(name, unit, |row| values[row])));
    }
    Table::flat(places.len(), columns)
}

/// A field over the places; empty if it was not asked for.
pub(super) fn points(places: &[f64], values: &Values) -> Vec<(f64, f64)> {
    let values = values.iter().flatten().map(|value| value.unwrap_or(f64::NAN));
    places.iter().copied().zip(values).collect()
}

/// A panel for each of these names with its unit, unless no field of that unit was asked for.
pub(super) fn panels(
    places: &[f64],
    fields: &[(NamedField<'_>, Colour)],
    names: &[(&'static str, &'static str)],
) -> Vec<Panel> {
    let panel = |&(name, wanted): &(&'static str, &'static str)| {
        let of_unit = fields.iter().filter(|((_, unit, values), _)| *unit == wanted && values.is_some());
        let curves: Vec<_> =
            of_unit.map(|((name, _, values), colour)| Curve::line(*name, *colour, points(places, values))).collect();
        (!curves.is_empty()).then_some(Panel { y: Axis::of(name, wanted), curves })
    };
    names.iter().filter_map(panel).collect()
}
