//! `profile`: a scan becomes a profile.

use stickslip_measured::scan::{self, DRAWN_POINTS, Error, Options, Orientation, Scan, ScanFit};
use stickslip_plot::in_unit;
use stickslip_wire::curve_profiles::{EllipsoidProfile, MotionAxis};
use stickslip_wire::line_profiles::CylinderProfile;
use stickslip_wire::profile::TabulatedProfile;
use stickslip_wire::profile_fit::{
    Axis2, Axisymmetry, ColumnPair, ContactEstimate, Estimate, ProfileFitTask, ScanOrientation, ScanResidual,
    Smoothing, SuggestedProfile,
};
use stickslip_wire::{Profile, ProfileFitReply, ProfileFitRequest};

use super::loop_fit::{Points, clamped};
use crate::computations::prelude::*;
use crate::simulation::HUGE_TABLE_RADIUS;
use crate::simulation::bytes::WORKSPACE;

/// Time of a fit, and for each of its points.
const SCAN_COST: Nanoseconds = 100_000_000;
const SCAN_POINT_COST: Nanoseconds = 4_000;
/// How far the strokes of outliers reach at most, in standard deviations of the residual.
const LARGEST_RESIDUAL: f64 = 10.0;
/// Rows of the table, at most.
const ROWS: usize = 3 * DRAWN_POINTS;
/// Radius of curvature, m, below which the units are probably wrong.
const TINY_RADIUS: f64 = 1e-9;
/// The share of outliers beyond which a scan is called doubtful.
const MANY_OUTLIERS: f64 = 0.05;
/// How far a scan reaches to both sides of its axis, over half its extent, without the warning that it has one side.
const ONE_SIDED: f64 = 0.25;
/// The share of the scan beyond which a contact is near its edge.
const NEAR_EDGE: f64 = 0.9;

/// A profile from a scan.
pub struct FitProfile;

impl Computation for FitProfile {
    const ABOUT: About = About {
        name: "profile",
        route: Some(Route { path: "/profiles/fit", operation: "fit_profile", tag: "simulation" }),
        title: "Fit a profile to a scan",
        description: "Finds the axis of a scan of heights, subtracts its tilt, leaves out its outliers and fits the \
                      smoothest profile that its noise allows and whose contact is a full circle; with `load`, it also \
                      computes the contact, with standard errors. Nothing is stored.",
        reply: "The profile, and the residual of the scan",
        shows: "The table has the points, each `fitted`, `left_out` or of the `profile`; a picture shows them.",
        ..About::TABLE
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
                    "material": {"bodies": [
                        {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3},
                        {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}
                    ]},
                    "friction": 0.3, "preload": {"normal_force": 1.0}
                }
            }),
        )]
    }

    fn bytes(task: &ProfileFitTask) -> usize {
        WORKSPACE + ROW * task.points.len()
    }

    fn rows(_: &ProfileFitTask) -> (usize, usize) {
        (ROWS, ROW)
    }

    fn cost(task: &ProfileFitTask) -> Nanoseconds {
        SCAN_COST + SCAN_POINT_COST * task.points.len() as u64
    }

    fn run(task: ProfileFitTask, stop: &dyn Stop) -> Result<ProfileFitReply, Failure> {
        let ProfileFitTask { points, line, pointer, orientation, centre, level, smoothing, load } = task;
        let scan = if line { Scan::line(points.into_iter().map(|[x, _, z]| [x, z])) } else { Scan::area(points) };
        let orientation = match orientation {
            ScanOrientation::Auto => None,
            ScanOrientation::PeakUp => Some(Orientation::PeakUp),
            ScanOrientation::PeakDown => Some(Orientation::PeakDown),
        };
        let smoothing = match smoothing {
            Smoothing::Auto => scan::Smoothing::Auto,
            Smoothing::Noise(noise) => scan::Smoothing::Noise(noise),
            Smoothing::Knots(knots) => scan::Smoothing::Knots(knots),
        };
        let failed = |error: Error| match (&error, stop.check()) {
            (Error::Interrupted, Err(interrupted)) => Failure::interrupted(interrupted, "/scan"),
            (Error::AxisOutside { .. }, _) => Failure::at("/centre", error),
            (Error::Rough, _) => Failure::at("/smoothing", error),
            (Error::TooShort { .. }, _) => Failure::at("/load/preload", error),
            _ => Failure::at(pointer, error),
        };
        let options = Options { orientation, centre, level, smoothing };
        let fit = ScanFit::new(&scan, &options, &|| stop.check().is_ok()).map_err(failed)?;
        let under_load = |(elasticity, friction, preload)| {
            fit.contact(elasticity, friction, preload).map_err(|error| match error {
                Error::Refused(error) => {
                    let place =
                        quantity(&error).map_or("/preload", |quantity| ContactDefinition::place_of(quantity, &preload));
                    Failure::at(format!("/load{place}"), error)
                }
                error => failed(error),
            })
        };
        let contact = load.map(under_load).transpose()?;
        Ok(reply(fit, contact, line))
    }
}

impl Outcome for ProfileFitReply {
    type Reply = ProfileFitReply;

    /// The points of a scan and of the profile that was fitted to it.
    fn table(&self, _: &DisplayOptions) -> Option<Table<'_>> {
        let parts = [("fitted", &self.raw), ("left_out", &self.left_out), ("profile", &self.used)];
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
            Column::words("part", move |row| of(row).0),
            Column::floats("radius", "m", move |row| of(row).1),
            Column::floats("height", "m", move |row| of(row).2),
        ];
        Some(Table::flat(parts.iter().map(|(_, columns)| columns.radius.len()).sum(), columns))
    }

    /// A scan and the profile that was fitted to it, over the difference of both.
    fn picture(&self, _: &DisplayOptions) -> Option<Drawing> {
        let used = &self.used;
        let fitted = |radius: f64| {
            let above = used.radius.partition_point(|&r| r < radius).clamp(1, used.radius.len() - 1);
            let (low, high) = (used.radius[above - 1], used.radius[above]);
            let share = (radius - low) / (high - low);
            used.height[above - 1] + share * (used.height[above] - used.height[above - 1])
        };
        let pairs = |columns: &ColumnPair| -> Points {
            columns.radius.iter().copied().zip(columns.height.iter().copied()).collect()
        };
        let residual =
            |columns: &ColumnPair| -> Points { pairs(columns).into_iter().map(|(r, z)| (r, z - fitted(r))).collect() };
        // A point that was left out has no neighbours to be joined with: a short stroke to the profile marks it.
        let strokes = |to: fn(f64, f64) -> [f64; 2]| -> Points {
            let each = pairs(&self.left_out).into_iter();
            each.flat_map(|(r, z)| to(z, fitted(r)).map(|end| (r, end)).into_iter().chain([(r, f64::NAN)])).collect()
        };
        let most = self.residual.rms * LARGEST_RESIDUAL;
        let beyond = clamped(residual(&self.left_out), most).1;
        let named = if beyond.is_empty() { "" } else { "beyond the frame" };
        let off = strokes(|z, f| [0.0, z - f]).into_iter().map(|(r, e)| (r, e.clamp(-most, most)));
        // An outlier may be far off: strokes end half the height of the profile beyond it.
        let top = used.height.last().copied().unwrap_or(0.0);
        let left = strokes(|z, f| [f, z]).into_iter().map(|(r, z)| (r, z.clamp(-0.5 * top, 1.5 * top)));
        let plot = Plot::new(
            format!("Profile from a scan: residual {:.3e} m rms", self.residual.rms),
            Axis::of("radius r", "m"),
            vec![
                Panel {
                    y: Axis::of("height of the gap", "m"),
                    curves: vec![
                        Curve::dots("scan", Colour::Grey, pairs(&self.raw)),
                        Curve::line("left out", Colour::Red, left),
                        Curve::line("profile", Colour::Blue, pairs(used)),
                    ],
                },
                Panel {
                    y: Axis::of("scan less profile", "m"),
                    curves: vec![
                        Curve::dots("scan", Colour::Grey, residual(&self.raw)),
                        Curve::line("left out", Colour::Red, off),
                        Curve::line(named, Colour::Red, beyond),
                    ],
                },
            ],
        );
        Some(Drawing::Plot(plot))
    }
}

fn reply(fit: ScanFit, contact: Option<scan::ContactEstimate>, line: bool) -> ProfileFitReply {
    let estimate = |of: scan::Estimate| Estimate { value: finite(of.value), standard_error: finite(of.standard_error) };
    let pair = |[x, y]: [f64; 2]| Axis2 { x, y: (!line).then_some(y) };
    let columns = |of: &scan::Column| ColumnPair { radius: of.radius.clone(), height: of.height.clone() };
    let unknown = Estimate { value: None, standard_error: None };
    ProfileFitReply {
        profile: Profile::Tabulated(TabulatedProfile {
            r: fit.table.radius.clone(),
            z: fit.table.height.clone(),
            indentation_error: Some(fit.standard_errors.indentation.clone()),
            pressure_error: Some(fit.standard_errors.pressure.clone()),
        }),
        radius_of_curvature: fit.radius_of_curvature.map_or(unknown, estimate),
        centre: pair(fit.centre),
        tilt: pair(fit.tilt),
        orientation: match fit.orientation {
            Orientation::PeakUp => ScanOrientation::PeakUp,
            Orientation::PeakDown => ScanOrientation::PeakDown,
        },
        residual: ScanResidual {
            rms: fit.rms,
            correlation_length: fit.correlation_length,
            outliers: fit.outliers + fit.fill_values,
            random: fit.diagnosis.random,
        },
        raw: columns(&fit.raw),
        left_out: columns(&fit.left_out),
        used: columns(&fit.table),
        g_margin: fit.g_margin,
        axisymmetry: match fit.diagnosis.second_harmonic {
            Some(_) => Axisymmetry::Tested,
            None => Axisymmetry::Assumed,
        },
        suggested: fit.diagnosis.paraboloid.map(|body| SuggestedProfile {
            profile: suggested(&body),
            angle: body.angle,
            radii: [estimate(body.short), body.long.map_or(unknown, estimate)],
        }),
        contact: contact.map(|contact| ContactEstimate {
            indentation: estimate(contact.indentation),
            contact_radius: estimate(contact.contact_radius),
            normal_force: estimate(contact.normal_force),
            max_pressure: estimate(contact.max_pressure),
        }),
        warnings: warnings(&fit, contact.as_ref(), line),
    }
}

/// The profile of a body by its principal radii, the larger along x.
fn suggested(body: &scan::Paraboloid) -> Profile {
    match body.long {
        Some(long) => {
            let radii = vec![long.value, body.short.value];
            Profile::Ellipsoid(EllipsoidProfile { radii, direction: MotionAxis::X })
        }
        None => {
            Profile::Cylinder(CylinderProfile { radius: body.short.value, length: body.extent, reference_length: None })
        }
    }
}

fn warnings(fit: &ScanFit, contact: Option<&scan::ContactEstimate>, line: bool) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let mut warn = |code: &str, message: String| warnings.push(Warning::new(code, message));
    let reach = fit.table.radius[fit.table.radius.len() - 1];
    let rise = fit.table.height[fit.table.height.len() - 1];
    let radius = 0.5 * reach * reach / rise;
    if !(TINY_RADIUS..HUGE_TABLE_RADIUS).contains(&radius) {
        warn("units", format!("a radius of curvature of about {radius:.3} m: are `units` those of the scan?"));
    }
    let share = fit.outliers as f64 / fit.used as f64;
    if share > MANY_OUTLIERS {
        let message = format!("{:.1} % of the points were left out as outliers: check the residual", 100.0 * share);
        warn("many_outliers", message);
    }
    if fit.fill_values > 0 {
        let (count, verb) = (fit.fill_values, if fit.fill_values == 1 { " was" } else { "s were" });
        warn("fill_values", format!("{count} height{verb} read as missing: a fill value of the instrument"));
    }
    if fit.overlap < ONE_SIDED {
        let part = 100.0 * (1.0 - fit.overlap);
        let message = format!(
            "the axis is {part:.0} % of the way from the middle of the scan to its edge: a tilt would fit other axes \
             as well; scan across the peak, or give `centre`"
        );
        warn("one_sided_scan", message);
    }
    let diagnosis = &fit.diagnosis;
    if diagnosis.second_harmonic == Some(true) {
        let body = match &diagnosis.paraboloid {
            Some(scan::Paraboloid { short, long: Some(long), angle, .. }) => format!(
                "an ellipsoid with radii of curvature of {} and {}, the larger at {angle:.1} degrees from x: see \
                 `suggested`",
                in_unit(long.value, "m"),
                in_unit(short.value, "m")
            ),
            Some(scan::Paraboloid { short, angle, .. }) => format!(
                "a cylinder with a radius of {}, its axis at {angle:.1} degrees from x: see `suggested`",
                in_unit(short.value, "m")
            ),
            None => "a saddle, or another surface without a profile here".to_owned(),
        };
        let message = format!(
            "the body is not one of revolution, as the residual changes with twice the angle about the axis: it looks \
             like {body}. The profile and its errors are those of no contact"
        );
        warn("not_axisymmetric", message);
    }
    if diagnosis.structure.is_some() || diagnosis.edge.is_some() {
        let found = match (diagnosis.edge, diagnosis.structure) {
            (Some(edge), _) => format!("neighbouring heights differ by a step of {edge:.0} times their noise"),
            (_, ratio) => format!(
                "the residual is {:.1} times the noise between neighbours, or outliers lie side by side, or rows \
                 drift",
                ratio.unwrap_or(1.0)
            ),
        };
        let message = format!(
            "{found}: there may be steps, dust, scratches or a drift. The standard errors leave this out: look at the \
             residual, and remove what is not the surface"
        );
        warn("not_one_surface", message);
    }
    if let Some([x, y]) = fit.other_axis {
        let place = if line { in_unit(x, "m") } else { format!("{}, {}", in_unit(x, "m"), in_unit(y, "m")) };
        let message = format!(
            "another axis, at {place}, fits the scan as well with another tilt and another profile: the standard \
             errors hold both. Scan farther on the short side, or give `centre` or `level`"
        );
        warn("axis_ambiguous", message);
    }
    if let Some(step) = fit.height_step {
        let message = format!(
            "the heights come in steps of {}, which are not small beside the noise: their rounding does not average \
             out, and the standard errors leave this out",
            in_unit(step, "m")
        );
        warn("quantised", message);
    }
    if let Some(contact) = contact.filter(|contact| contact.contact_radius.value > NEAR_EDGE * reach) {
        let part = 100.0 * contact.contact_radius.value / reach;
        warn("short_scan", format!("the contact takes {part:.0} % of the scan's radius, whose edge is poorly known"));
    }
    warnings
}
