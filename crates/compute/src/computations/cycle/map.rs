//! A fretting map: steady cycles under many loads; its plot has where gross slip begins, and lines of equal friction
//! work, over the load.

use stickslip_wire::cycle::{CycleTask, FrettingMap};
use stickslip_wire::{CycleReply, SteadyCycle};

use super::steady::steady_cycles;
use crate::computations::prelude::*;

/// The steady cycles of a contact under each load of a map, the loads one after the other; the rows say which.
///
/// # Errors
/// As [`steady_cycles`], and [`Failure`] for a load that the profile does not reach.
pub fn cycles(
    contact: &Contact,
    task: &CycleTask,
    map: FrettingMap,
    timer: Timer<'_>,
    stop: &dyn Stop,
) -> Result<CycleReply, Failure> {
    let under = |load: f64| {
        let pressed = contact.pressed(load).map_err(|error| Failure::at("/map/normal_force", error))?;
        let mut reply = steady_cycles(&pressed, task, timer, stop)?;
        for row in &mut reply.cycles {
            row.normal_force = Some(load);
            row.gross_slip_displacement = Some(reply.contact.gross_slip_displacement);
        }
        Ok::<_, Failure>(reply)
    };
    let mut loads = map.loads();
    let mut whole = under(loads.next().unwrap_or(map.normal_force.from))?;
    for load in loads {
        let CycleReply { cycles, accuracy, warnings, .. } = under(load)?;
        whole.cycles.extend(cycles);
        // The time is that of all, the warnings are those of the largest load.
        let force_error = accuracy.force_error.max(whole.accuracy.force_error);
        (whole.accuracy, whole.warnings) = (Accuracy { force_error, ..accuracy }, warnings);
    }
    Ok(CycleReply { contact: contact.summary().into(), ..whole })
}

/// The plot of cycles load by load, with so many amplitudes under each.
pub fn plot(cycles: &[SteadyCycle], amplitudes: usize) -> Plot {
    let columns: Vec<Column> = cycles.chunks(amplitudes.max(1)).map(Column::of).collect();
    let most = columns.iter().flat_map(|column| &column.cycles).map(|cycle| cycle.0).fold(0.0, f64::max);
    let over = |amplitude: &dyn Fn(&Column) -> f64| -> Vec<_> {
        columns.iter().map(|column| (column.load.log10(), amplitude(column).log10())).collect()
    };
    let slip = over(&|column| if column.gross_slip <= most { column.gross_slip } else { f64::NAN });
    let mut curves = vec![Curve::line("gross slip above", Colour::Red, slip)];
    for (index, level) in decades(&columns).into_iter().enumerate() {
        let name = if index == 0 { "equal friction work, a factor of 10 from line to line" } else { "" };
        curves.push(Curve::line(name, Colour::Grey, over(&|column| column.amplitude_of(level))));
    }
    let y = Axis { name: "log₁₀(displacement amplitude U₀ / m)", unit: None };
    Plot::new("Fretting map", Axis { name: "log₁₀(normal force / N)", unit: None }, vec![Panel { y, curves }])
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
        let pairs = cycles.iter().map(|cycle| (cycle.amplitude(), cycle.dissipated_energy));
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
