//! `profile`: a scan becomes a profile.

use serde_json::json;

use stickslip_measured::scan::DRAWN_POINTS;
use stickslip_report::plot::{Axis, Colour, Curve, Drawing, Panel, Plot};
use stickslip_wire::profile_fit::{ColumnPair, ProfileFitTask};
use stickslip_wire::{ProfileFitReply, ProfileFitRequest};

use super::loop_fit::clamped;
use super::{About, Computation, Example, Outcome, Route, Shown, example};
use crate::admission::{Nanoseconds, Stop};
use crate::formats::{Cells, Column, Format, STRESS_ROW, Table};
use crate::simulation::{self, Failure};

/// Time of a fit, and for each of its points.
const SCAN_COST: Nanoseconds = 100_000_000;
const SCAN_POINT_COST: Nanoseconds = 4_000;
/// Bytes of a fit with its reply, and for each of its points.
const SCAN_BYTES: usize = 4 * 1024 * 1024;
const SCAN_POINT_BYTES: usize = 256;
/// How far the strokes of outliers reach at most, in standard deviations of the residual.
const LARGEST_RESIDUAL: f64 = 10.0;

/// A profile from a scan.
pub struct FitProfile;

impl Computation for FitProfile {
    const ABOUT: About = About {
        name: "profile",
        route: Some(Route { path: "/profiles/fit", operation: "fit_profile", tag: "simulation" }),
        title: "Fit a profile to a scan",
        description: "Finds the axis of a scan of heights, takes off its tilt, leaves out its outliers and fits the \
                      smoothest profile that its noise allows and whose contact is a full circle; with `load`, says \
                      what the scan means for the contact, with standard errors. Nothing is stored.",
        reply: "The profile, and what is left of the scan",
        formats: &Format::ALL,
        printed: Format::Columns,
        shows: "The table has the points, each `fitted`, `left_out` or of the `profile`; a picture shows them.",
        choice: None,
    };

    type Request = ProfileFitRequest;
    type Outcome = ProfileFitReply;

    fn examples() -> Vec<Example> {
        vec![example(
            "line",
            "A line over a ball, in micrometres and nanometres",
            json!({
                "scan": {"line": {
                    "x": [-70.0, -60.0, -50.0, -40.0, -30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0, 40.0, 50.0,
                            60.0, 70.0],
                    "z": [-245.2, -179.7, -125.3, -79.6, -45.3, -20.4, -4.6, 0.3, -5.1, -19.8, -44.7, -80.2, -124.9,
                        -180.4, null]
                }},
                "units": {"lateral": "um", "height": "nm"},
                "load": {
                    "material": {"bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]},
                    "friction": 0.3, "preload": {"normal_force": 1.0}
                }
            }),
        )]
    }

    fn bytes(task: &ProfileFitTask) -> usize {
        SCAN_BYTES + SCAN_POINT_BYTES * task.points.len()
    }

    fn rows(_: &ProfileFitTask) -> (usize, usize) {
        (SCAN_ROWS, STRESS_ROW)
    }

    fn cost(task: &ProfileFitTask) -> Nanoseconds {
        SCAN_COST + SCAN_POINT_COST * task.points.len() as u64
    }

    fn run(task: ProfileFitTask, stop: &Stop) -> Result<ProfileFitReply, Failure> {
        simulation::fit_profile(task, stop)
    }
}

impl Outcome for ProfileFitReply {
    type Reply = ProfileFitReply;

    fn reply(&self) -> &ProfileFitReply {
        self
    }

    fn table(&self, _: &Shown) -> Option<Table<'_>> {
        Some(table(self))
    }

    fn picture(&self, _: &Shown) -> Option<Drawing> {
        Some(Drawing::Plot(plot(self)))
    }
}

/// Rows of a fitted scan, at most.
const SCAN_ROWS: usize = 3 * DRAWN_POINTS;

/// The points of a scan and of the profile that was fitted to it.
fn table(reply: &ProfileFitReply) -> Table<'_> {
    let parts = [("fitted", &reply.raw), ("left_out", &reply.left_out), ("profile", &reply.used)];
    let of = move |mut row: usize| {
        for (name, columns) in parts {
            if row < columns.radius.len() {
                return (name, columns.radius[row], columns.height[row]);
            }
            row -= columns.radius.len();
        }
        ("", f64::NAN, f64::NAN)
    };
    let columns = vec![
        Column::new("part", Some(""), Cells::Words(Box::new(move |row| of(row).0))),
        Column::floats("radius", "m", move |row| of(row).1),
        Column::floats("height", "m", move |row| of(row).2),
    ];
    Table::flat(parts.iter().map(|(_, columns)| columns.radius.len()).sum(), columns)
}

/// A scan and the profile that was fitted to it, over the difference of both.
fn plot(reply: &ProfileFitReply) -> Plot {
    let used = &reply.used;
    let fitted = |radius: f64| {
        let above = used.radius.partition_point(|&r| r < radius).clamp(1, used.radius.len() - 1);
        let (low, high) = (used.radius[above - 1], used.radius[above]);
        let share = (radius - low) / (high - low);
        used.height[above - 1] + share * (used.height[above] - used.height[above - 1])
    };
    let pairs = |columns: &ColumnPair| -> Vec<(f64, f64)> {
        columns.radius.iter().copied().zip(columns.height.iter().copied()).collect()
    };
    let residual = |columns: &ColumnPair| pairs(columns).into_iter().map(|(r, z)| (r, z - fitted(r))).collect();
    // A point that was left out has no neighbours to be joined with: a short stroke to the profile marks it.
    let strokes = |to: fn(f64, f64) -> [f64; 2]| -> Vec<(f64, f64)> {
        let each = pairs(&reply.left_out).into_iter();
        each.flat_map(|(r, z)| to(z, fitted(r)).map(|end| (r, end)).into_iter().chain([(r, f64::NAN)])).collect()
    };
    let curve = |name, points, colour| Curve { name, points, colour, silent: false, dots: false };
    let measured = |points| Curve { dots: true, ..curve("scan", points, Colour::Grey) };
    let most = reply.residual.rms * LARGEST_RESIDUAL;
    let beyond = clamped(residual(&reply.left_out), most).1;
    Plot {
        title: format!("Profile from a scan: residual {:.3e} m rms", reply.residual.rms),
        x: Axis { name: "radius r", unit: Some("m") },
        panels: vec![
            Panel {
                y: Axis { name: "height of the gap", unit: Some("m") },
                curves: vec![
                    measured(pairs(&reply.raw)),
                    curve("left out", clipped(strokes(|z, f| [f, z]), used), Colour::Red),
                    curve("profile", pairs(used), Colour::Blue),
                ],
            },
            Panel {
                y: Axis { name: "scan less profile", unit: Some("m") },
                curves: vec![
                    measured(residual(&reply.raw)),
                    curve(
                        "left out",
                        strokes(|z, f| [0.0, z - f]).into_iter().map(|(r, e)| (r, e.clamp(-most, most))).collect(),
                        Colour::Red,
                    ),
                    Curve { silent: beyond.is_empty(), ..curve("beyond the frame", beyond, Colour::Red) },
                ],
            },
        ],
        bands: Vec::new(),
    }
}

/// Strokes within half the height of a profile about it: an outlier may be far off.
fn clipped(strokes: Vec<(f64, f64)>, used: &ColumnPair) -> Vec<(f64, f64)> {
    let top = used.height.last().copied().unwrap_or(0.0);
    strokes.into_iter().map(|(r, z)| (r, z.clamp(-0.5 * top, 1.5 * top))).collect()
}
