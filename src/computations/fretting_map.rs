//! The plot of a fretting map: where gross slip begins, and lines of equal friction work, over the load.

use stickslip_report::plot::{Axis, Colour, Curve, Panel, Plot};
use stickslip_wire::SteadyCycle;

/// The plot of cycles load by load, with so many amplitudes under each.
#[must_use]
pub fn plot(cycles: &[SteadyCycle], amplitudes: usize) -> Plot {
    let columns: Vec<Column> = cycles.chunks(amplitudes.max(1)).map(Column::of).collect();
    let most = columns.iter().flat_map(|column| &column.cycles).map(|cycle| cycle.0).fold(0.0, f64::max);
    let over = |amplitude: &dyn Fn(&Column) -> f64| {
        columns.iter().map(|column| (column.load.log10(), amplitude(column).log10())).collect()
    };
    let slip = over(&|column| if column.gross_slip <= most { column.gross_slip } else { f64::NAN });
    let mut curves =
        vec![Curve { name: "gross slip above", points: slip, colour: Colour::Red, silent: false, dots: false }];
    for (index, level) in decades(&columns).into_iter().enumerate() {
        curves.push(Curve {
            name: "equal friction work, a factor of 10 from line to line",
            points: over(&|column| column.amplitude_of(level)),
            colour: Colour::Grey,
            silent: index > 0,
            dots: false,
        });
    }
    Plot {
        title: "Fretting map".to_owned(),
        x: Axis { name: "log₁₀(normal force / N)", unit: None },
        panels: vec![Panel { y: Axis { name: "log₁₀(displacement amplitude U₀ / m)", unit: None }, curves }],
        bands: Vec::new(),
    }
}

/// The cycles under one load.
struct Column {
    load: f64,
    gross_slip: f64,
    /// Amplitude, m, and friction work, J, of those with any, the smallest first.
    cycles: Vec<(f64, f64)>,
}

impl Column {
    fn of(cycles: &[SteadyCycle]) -> Column {
        let own = |of: fn(&SteadyCycle) -> Option<f64>| cycles.first().and_then(of).unwrap_or(f64::NAN);
        let pairs = cycles.iter().map(|cycle| (cycle.displacement_amplitude, cycle.dissipated_energy));
        let mut pairs: Vec<_> = pairs.filter(|(amplitude, work)| *amplitude > 0.0 && *work > 0.0).collect();
        pairs.sort_by(|one, other| one.0.total_cmp(&other.0));
        let load = own(|cycle| cycle.normal_force);
        Column { load, gross_slip: own(|cycle| cycle.gross_slip_displacement), cycles: pairs }
    }

    /// The amplitude that does this work, by powers between the amplitudes of the map: work grows with the amplitude.
    fn amplitude_of(&self, work: f64) -> f64 {
        let pair = self.cycles.windows(2).find(|pair| pair[0].1 <= work && work <= pair[1].1 && pair[0].1 < pair[1].1);
        pair.map_or(f64::NAN, |pair| {
            let share = (work / pair[0].1).ln() / (pair[1].1 / pair[0].1).ln();
            pair[0].0 * (pair[1].0 / pair[0].0).powf(share)
        })
    }
}

/// The powers of ten within the work of the map.
fn decades(columns: &[Column]) -> Vec<f64> {
    let works = || columns.iter().flat_map(|column| &column.cycles).map(|cycle| cycle.1.log10());
    let (least, most) = (works().fold(f64::INFINITY, f64::min), works().fold(f64::NEG_INFINITY, f64::max));
    if least.is_finite() {
        (least.ceil() as i32..=most.floor() as i32).map(|power| 10_f64.powi(power)).collect()
    } else {
        Vec::new()
    }
}
