//! `fit`: measured loops become the friction and the stiffness of their contact.

use serde_json::json;

use stickslip_report::plot::{Axis, Colour, Curve, Drawing, Panel, Plot, in_unit};
use stickslip_wire::fit::{FitTask, FittedLoop};
use stickslip_wire::{FitReply, FitRequest};

use super::{About, Computation, Example, Outcome, Route, Shown, example};
use crate::admission::{Nanoseconds, Stop};
use crate::formats::{Column, Format, STRESS_ROW, Table};
use crate::simulation::bytes::of_shape;
use crate::simulation::{self, Failure};

/// Time of a fit to loops, and for each of their points.
const FIT_COST: Nanoseconds = 100_000_000;
const FIT_POINT_COST: Nanoseconds = 100_000;
/// Bytes of a fit to loops with its reply, and for each of their points.
const FIT_BYTES: usize = 4 * 1024 * 1024;
const FIT_POINT_BYTES: usize = 256;

/// Friction and stiffness from measured loops.
pub struct FitLoops;

impl Computation for FitLoops {
    const ABOUT: About = About {
        name: "fit",
        route: Some(Route { path: "/fit", operation: "fit_loops", tag: "simulation" }),
        title: "Fit friction and stiffness to measured loops",
        description: "Finds the turning points of force over displacement as a bench has measured them, and the \
                      coefficient of friction, the moduli, the compliance of the machine, the offsets and the drift \
                      that fit best. Says what the loops determine, what only in combination, and within which \
                      intervals. Nothing is stored.",
        reply: "What the loops say, and what they leave open",
        formats: &Format::ALL,
        printed: Format::Columns,
        shows: "The table has the points of the loops, measured and fitted; a picture shows them and the residual.",
        choice: None,
    };

    type Request = FitRequest;
    type Outcome = FitReply;

    fn examples() -> Vec<Example> {
        vec![example(
            "steady",
            "A steady loop that reaches gross slip, in micrometres",
            json!({
                "contact": {
                    "profile": {"type": "sphere", "radius": 0.01},
                    "material": {"bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]},
                    "friction": 0.2, "preload": {"normal_force": 10.0}
                },
                "loops": [{
                    "displacement": [0.2583, 0.2152, 0.1722, 0.1291, 0.0861, 0.043, 0.0, -0.043, -0.0861, -0.1291,
                    -0.1722, -0.2152, -0.2583, -0.2152, -0.1722, -0.1291, -0.0861, -0.043, 0.0, 0.043, 0.0861, 0.1291,
                    0.1722, 0.2152, 0.2583], "force": [3.001, 1.923, 0.888, -0.025, -0.881, -1.625, -2.231, -2.733,
                    -3.0, -2.993, -2.989, -3.0, -2.994, -1.921, -0.901, 0.031, 0.865, 1.607, 2.234, 2.732, 2.998, 2.997,
                    3.001, 2.987, 2.999], "start": "steady"
                }],
                "units": {"displacement": "um", "force": "N"},
                "free": ["friction", "g_star"],
                "known": {"machine_compliance": {"value": 0.0}}
            }),
        )]
    }

    fn bytes(task: &FitTask) -> usize {
        FIT_BYTES + FIT_POINT_BYTES * task.points() + of_shape(&task.definition.profile)
    }

    fn rows(task: &FitTask) -> (usize, usize) {
        (task.points(), STRESS_ROW)
    }

    fn cost(task: &FitTask) -> Nanoseconds {
        FIT_COST + FIT_POINT_COST * task.points() as u64
    }

    fn run(task: FitTask, stop: &Stop) -> Result<FitReply, Failure> {
        simulation::fit_loops(task, stop)
    }
}

impl Outcome for FitReply {
    type Reply = FitReply;

    fn reply(&self) -> &FitReply {
        self
    }

    fn table(&self, _: &Shown) -> Option<Table<'_>> {
        Some(table(self))
    }

    fn picture(&self, _: &Shown) -> Option<Drawing> {
        Some(Drawing::Plot(plot(self)))
    }
}

/// The points of measured loops, with what was fitted to them.
fn table(reply: &FitReply) -> Table<'_> {
    let at = |mut row: usize| {
        let mut loops = reply.curve.iter().enumerate();
        loops.find_map(|(index, curve)| match row.checked_sub(curve.force.len()) {
            None => Some((index, curve, row)),
            Some(rest) => {
                row = rest;
                None
            }
        })
    };
    let value = |name, unit, of: fn(&FittedLoop, usize) -> f64| {
        Column::floats(name, unit, move |row| at(row).map_or(f64::NAN, |(_, curve, point)| of(curve, point)))
    };
    let columns = vec![
        Column::counts("loop", move |row| at(row).map_or(0, |(index, ..)| index as u64)),
        value("displacement", "m", |curve, point| curve.displacement[point]),
        value("measured", "N", |curve, point| curve.measured[point]),
        value("fitted", "N", |curve, point| curve.force[point]),
        value("residual", "N", |curve, point| curve.measured[point] - curve.force[point]),
        Column::counts("used", move |row| at(row).map_or(0, |(_, curve, point)| u64::from(curve.used[point]))),
    ];
    Table::flat(reply.curve.iter().map(|curve| curve.force.len()).sum(), columns)
}

/// Points of a plot.
pub(super) type Points = Vec<(f64, f64)>;

/// Values up to `most` on both sides as they are and, apart, those beyond at `most`: short strokes along the frame.
pub(super) fn clamped(points: Points, most: f64) -> (Points, Points) {
    if most <= 0.0 {
        return (points, Vec::new());
    }
    let (beyond, inside): (Vec<_>, Vec<_>) = points.into_iter().partition(|(_, value)| value.abs() > most);
    let at_frame = |(x, value): (f64, f64)| [(x, most.copysign(value)), (f64::NAN, f64::NAN)];
    (inside, beyond.into_iter().flat_map(at_frame).collect())
}

/// Measured loops and what was fitted to them, over the difference of both.
fn plot(reply: &FitReply) -> Plot {
    // Loops are not joined with each other.
    let over = |of: fn(&FittedLoop, usize) -> f64| -> Vec<(f64, f64)> {
        let each = |curve: &FittedLoop| -> Vec<(f64, f64)> {
            let points = curve.displacement.iter().enumerate().map(|(point, u)| (*u, of(curve, point)));
            points.chain([(f64::NAN, f64::NAN)]).collect()
        };
        reply.curve.iter().flat_map(each).collect()
    };
    // A point that was left out is drawn alone.
    let outliers = |of: fn(&FittedLoop, usize) -> f64| -> Vec<(f64, f64)> {
        let each = |curve: &FittedLoop| -> Vec<(f64, f64)> {
            let left = curve.used.iter().enumerate().filter(|(_, used)| !**used);
            left.flat_map(|(point, _)| [(curve.displacement[point], of(curve, point)), (f64::NAN, f64::NAN)]).collect()
        };
        reply.curve.iter().flat_map(each).collect()
    };
    let curve = |name, points, colour, silent, dots| Curve { name, points, colour, silent, dots };
    let measured: fn(&FittedLoop, usize) -> f64 = |curve, point| curve.measured[point];
    let residual: fn(&FittedLoop, usize) -> f64 = |curve, point| curve.measured[point] - curve.force[point];
    let left = outliers(measured);
    let silent = left.is_empty();
    // A point that was left out may be so far off that nothing else could be seen.
    let used = |curve: &FittedLoop| {
        (0..curve.used.len()).filter(|point| curve.used[*point]).map(|at| residual(curve, at)).collect()
    };
    let most = reply
        .curve
        .iter()
        .flat_map(|curve: &FittedLoop| -> Vec<f64> { used(curve) })
        .fold(0.0, |most: f64, value| most.max(value.abs()));
    let (off, beyond) = clamped(outliers(residual), 1.5 * most);
    let all = clamped(over(residual), 1.5 * most).0;
    Plot {
        title: format!("Measured loop: residual {} rms", in_unit(reply.residual.rms, "N")),
        x: Axis { name: "measured displacement", unit: Some("m") },
        panels: vec![
            Panel {
                y: Axis { name: "tangential force F", unit: Some("N") },
                curves: vec![
                    curve("measured", over(measured), Colour::Grey, false, true),
                    curve("outliers", left, Colour::Red, silent, true),
                    curve("fitted", over(|curve, point| curve.force[point]), Colour::Blue, false, false),
                ],
            },
            Panel {
                y: Axis { name: "measured less fitted", unit: Some("N") },
                curves: vec![
                    curve("", all, Colour::Grey, true, true),
                    curve("", off, Colour::Red, true, true),
                    curve("beyond the frame", beyond.clone(), Colour::Red, beyond.is_empty(), false),
                ],
            },
        ],
        bands: Vec::new(),
    }
}
