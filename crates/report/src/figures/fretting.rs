//! Figures 12 and 13: Crossland's criterion below a ball that is moved back and forth, in partial slip and in gross
//! slip.

use super::contact::{ball, small_contact, to};
use stickslip_mechanics::Error;
use stickslip_mechanics::fatigue::{Criterion, Cycle};
use stickslip_mechanics::subsurface::Side;
use stickslip_plot::{Axis, ContactEdge, Peak, Section};

/// Amplitudes over that of gross slip.
const AMPLITUDES: [(&str, f64); 2] = [
    ("Figure 12: Crossland, alpha = 0.3, at 0.6 of gross slip", 0.6),
    ("Figure 13: Crossland, alpha = 0.3, at 1.2 of gross slip", 1.2),
];
const FRICTION: f64 = 0.5;
const POISSON: f64 = 0.3;
/// Half the width and the depth of the section, in contact radii, and its points.
const HALF: f64 = 1.5;
const DEPTH: f64 = 1.0;
const COLUMNS: usize = 121;
const ROWS: usize = 41;
/// Instants of each stroke.
const INSTANTS: usize = 16;
/// Values are the same to this.
const ROUNDED: f64 = 1e-9;

pub(super) fn sections() -> Result<[Section; 2], Error> {
    let [first, second] = AMPLITUDES.map(|(title, share)| section(title, share));
    Ok([first?, second?])
}

fn section(title: &str, share: f64) -> Result<Section, Error> {
    let contact = small_contact(ball()?, FRICTION)?;
    let amplitude = share * contact.gross_slip_displacement();
    let cycle = Cycle::new(&contact, &[to(amplitude), to(-amplitude)], &|| true)?;
    let x: Vec<f64> = (0..COLUMNS).map(|index| HALF * (2.0 * index as f64 / (COLUMNS - 1) as f64 - 1.0)).collect();
    let z: Vec<f64> = (0..ROWS).map(|index| DEPTH * index as f64 / (ROWS - 1) as f64).collect();
    let a = contact.contact_radius();
    let places: Vec<[f64; 3]> = x.iter().flat_map(|x| z.iter().map(move |z| [a * x, 0.0, a * z])).collect();
    let states = cycle.states(INSTANTS, &|| true)?;
    let fields = states.iter().map(|state| state.subsurface(Side::Second, POISSON)).collect::<Result<Vec<_>, _>>()?;
    let path = |place: &[f64; 3]| {
        fields.iter().map(|field| field.at(*place).expect("a place near the contact")).collect::<Vec<_>>()
    };
    let unit = contact.summary().unit_pressure();
    let value = |place| Criterion::Crossland { alpha: 0.3 }.of(&path(place)).value / unit;
    let values: Vec<f64> = places.iter().map(value).collect();
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // The cycle is symmetric, so that two places have the largest value, to round-off.
    let worst = places.iter().zip(&values).filter(|(_, value)| **value > largest * (1.0 - ROUNDED));
    let axis = |name| Axis { name, unit: None };
    Ok(Section {
        title: title.to_owned(),
        x: (axis("x / a"), x),
        y: (axis("z / a"), z),
        downwards: true,
        largest: Some(Peak { value: largest, places: worst.map(|(place, _)| (place[0] / a, place[2] / a)).collect() }),
        edge: Some(ContactEdge { radius: 1.0, offset: Some(0.0), name: "edge of the contact" }),
        values: (axis("criterion / p_max"), values),
    })
}
