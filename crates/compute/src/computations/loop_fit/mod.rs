//! `fit`: measured loops become the friction and the stiffness of their contact.

mod fit;

use stickslip_plot::in_unit;
use stickslip_wire::fit::FittedLoop;
use stickslip_wire::{FitReply, FitRequest};

use crate::computations::prelude::*;
use crate::simulation::bytes::WORKSPACE;

/// Time of a fit to loops, and for each of their points.
const FIT_COST: Nanoseconds = 100_000_000;
const FIT_POINT_COST: Nanoseconds = 100_000;

/// Friction and stiffness from measured loops.
pub struct FitLoops;

impl Computation for FitLoops {
    const ABOUT: About = About {
        name: "fit",
        route: Some(Route { path: "/fit", operation: "fit_loops", tag: "simulation" }),
        title: "Fit friction and stiffness to measured loops",
        description: "Finds the turning points of measured loops of force over displacement, and the coefficient of \
                      friction, the moduli, the compliance of the machine, the offsets and the drift that fit best. \
                      States what the loops determine, what they determine only in combination, and within which \
                      intervals. Nothing is stored.",
        reply: "The quantities that the loops determine, and the curves of the fit",
        shows: "The table has the points of the loops, measured and fitted; a picture shows them and the residual.",
        ..About::TABLE
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
                    "material": {"bodies": [
                        {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3},
                        {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}
                    ]},
                    "friction": 0.2, "preload": {"normal_force": 10.0}
                },
                "loops": [{
                    "displacement": [0.41, 0.3416, 0.2734, 0.2049, 0.1367, 0.0683, 0.0, -0.0683, -0.1367, -0.2049,
                    -0.2734, -0.3416, -0.41, -0.3416, -0.2734, -0.2049, -0.1367, -0.0683, 0.0, 0.0683, 0.1367, 0.2049,
                    0.2734, 0.3416, 0.41], "force": [3.001, 1.923, 0.888, -0.025, -0.881, -1.625, -2.231, -2.733,
                    -3.0, -2.993, -2.989, -3.0, -2.994, -1.921, -0.901, 0.031, 0.865, 1.607, 2.234, 2.732, 2.998, 2.997,
                    3.001, 2.987, 2.999], "start": "steady"
                }],
                "units": {"displacement": "um", "force": "N"},
                "free": ["friction", "g_star"],
                "known": {"machine_compliance": {"value": 0.0}}
            }),
        )]
    }

    fn bytes((request, _): &Task<Self>) -> usize {
        WORKSPACE + ROW * request.points() + of_shape(&request.contact.profile)
    }

    fn rows((request, _): &Task<Self>) -> (usize, usize) {
        (request.points(), ROW)
    }

    fn cost((request, _): &Task<Self>) -> Nanoseconds {
        FIT_COST + FIT_POINT_COST * request.points() as u64
    }

    fn run((request, setup): Task<Self>, stop: &dyn Stop) -> Result<FitReply, Failure> {
        fit::fit_loops(request, setup, stop)
    }
}

impl Outcome for FitReply {
    type Reply = FitReply;

    /// The points of measured loops, with what was fitted to them.
    fn table(&self, _: &DisplayOptions) -> Option<Table<'_>> {
        let at = |mut row: usize| {
            let mut loops = self.curve.iter().enumerate();
            loops.find_map(|(index, curve)| match row.checked_sub(curve.force.len()) {
                None => Some((index, curve, row)),
                Some(rest) => {
                    row = rest;
                    None
                }
            })
        };
        let value = |name, unit, of: OfPoint| {
            Column::floats(name, unit, move |row| at(row).map(|(_, curve, point)| of(curve, point)))
        };
        let columns = vec![
            Column::counts("loop", move |row| at(row).map_or(0, |(index, ..)| index as u64)),
            value("displacement", "m", |curve, point| curve.displacement[point]),
            value("measured", "N", MEASURED),
            value("fitted", "N", FITTED),
            value("residual", "N", RESIDUAL),
            Column::counts("used", move |row| at(row).map_or(0, |(_, curve, point)| u64::from(curve.used[point]))),
        ];
        Some(Table::flat(self.curve.iter().map(|curve| curve.force.len()).sum(), columns))
    }

    /// Measured loops and what was fitted to them, over the difference of both.
    fn picture(&self, _: &DisplayOptions) -> Option<Drawing> {
        // Loops are not joined with each other.
        let over = |of: OfPoint| -> Points {
            let of_loop = |curve: &FittedLoop| -> Points {
                let points = (0..curve.force.len()).map(|point| (curve.displacement[point], of(curve, point)));
                points.chain([GAP]).collect()
            };
            self.curve.iter().flat_map(of_loop).collect()
        };
        // A point that was left out is drawn alone.
        let outliers = |of: OfPoint| -> Points {
            let of_loop = |curve: &FittedLoop| -> Points {
                let left = (0..curve.used.len()).filter(|point| !curve.used[*point]);
                left.flat_map(|point| [(curve.displacement[point], of(curve, point)), GAP]).collect()
            };
            self.curve.iter().flat_map(of_loop).collect()
        };
        // A point that was left out may be so far off that nothing else could be seen.
        let used = |curve: &FittedLoop| -> Vec<f64> {
            (0..curve.used.len()).filter(|point| curve.used[*point]).map(|point| RESIDUAL(curve, point).abs()).collect()
        };
        let most = 1.5 * self.curve.iter().flat_map(used).fold(0.0, f64::max);
        let (off, beyond) = clamped(outliers(RESIDUAL), most);
        let left = outliers(MEASURED);
        let named = |name, points: &Points| if points.is_empty() { "" } else { name };
        let plot = Plot::new(
            format!("Measured loop: residual {} rms", in_unit(self.residual.rms, "N")),
            Axis::of("measured displacement", "m"),
            vec![
                Panel {
                    y: Axis::of("tangential force F", "N"),
                    curves: vec![
                        Curve::dots("measured", Colour::Grey, over(MEASURED)),
                        Curve::dots(named("outliers", &left), Colour::Red, left),
                        Curve::line("fitted", Colour::Blue, over(FITTED)),
                    ],
                },
                Panel {
                    y: Axis::of("measured less fitted", "N"),
                    curves: vec![
                        Curve::dots("", Colour::Grey, clamped(over(RESIDUAL), most).0),
                        Curve::dots("", Colour::Red, off),
                        Curve::line(named("beyond the frame", &beyond), Colour::Red, beyond),
                    ],
                },
            ],
        );
        Some(Drawing::Plot(plot))
    }
}

/// A number at a point of a loop.
type OfPoint = fn(&FittedLoop, usize) -> f64;

const MEASURED: OfPoint = |curve, point| curve.measured[point];
const FITTED: OfPoint = |curve, point| curve.force[point];
const RESIDUAL: OfPoint = |curve, point| curve.measured[point] - curve.force[point];

/// Points of a plot.
pub(super) type Points = Vec<(f64, f64)>;
/// Where a curve is interrupted.
const GAP: (f64, f64) = (f64::NAN, f64::NAN);

/// Values up to `most` on both sides as they are and, apart, those beyond at `most`: short strokes along the frame.
pub(super) fn clamped(points: Points, most: f64) -> (Points, Points) {
    if most <= 0.0 {
        return (points, Vec::new());
    }
    let (beyond, inside): (Vec<_>, Vec<_>) = points.into_iter().partition(|(_, value)| value.abs() > most);
    let at_frame = |(x, value): (f64, f64)| [(x, most.copysign(value)), GAP];
    (inside, beyond.into_iter().flat_map(at_frame).collect())
}
