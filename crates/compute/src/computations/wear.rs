//! `wear`: the limiting shape that fretting wear leaves at a constant indentation.

use std::sync::Arc;

use stickslip_mechanics::wear::{WornContact, WornTable};
use stickslip_mechanics::{Error, Indenter, Move, Tangential, in_unit};
use stickslip_wire::profile::TabulatedProfile;
use stickslip_wire::{Profile, WearReply, WearRequest, WornForce, WornPressure, WornProfileError, WornShape};

use crate::computations::prelude::*;
use crate::simulation::bytes::SERIES;

/// The limit without its curves, on a sphere.
const LIMIT_COST: u64 = 50_000;
/// Its table, which is built several times, and more for each knot of a table that wears.
const TABLE_COST: u64 = 60_000_000;
const KNOT_COST: u64 = 100_000;
/// Its points between two places at which they crowd: centre, stick radius, worn radius, rims; and knots that are kept.
const TABLE_POINTS: usize = 256;
const TABLE_KNOTS: usize = 4_000;
/// The error of the normal force of the table that is warned of.
const LARGE_ERROR: f64 = 1e-2;
/// How far the curves go on beyond the worn part, in its radius.
const REACH: f64 = 1.25;
const REASON: &str = "the limit of wear at a constant indentation follows from g alone";

/// The limiting shape of fretting wear.
pub struct Wear;

impl Computation for Wear {
    const ABOUT: About = About {
        name: "wear",
        route: Some(Route { path: "/wear", operation: "compute_wear", tag: "simulation" }),
        title: "Compute what fretting wear leaves",
        description: "Moves a contact back and forth at a constant indentation until it has worn to its limit, in \
                      closed form: the disc that never slips stays as it is, and around it wear goes on until the \
                      pressure there is zero. Returns the shape and the pressure before and after, the removed volume, \
                      and the limiting shape as a profile for other computations. Nothing is stored.",
        reply: "The limit of wear",
        shows: "A table has shape and pressure over the radius; only `columns` has `profile`.",
        ..About::TABLE
    };

    type Request = WearRequest;
    type Outcome = WearReply;

    fn examples() -> Vec<Example> {
        vec![example(
            "ball",
            "A ball in partial slip",
            json!({
                "contact": ContactDefinition::example(),
                "drive": {"displacement": 1e-7},
                "hold": "indentation",
                "points": 50
            }),
        )]
    }

    /// The profile, the table of the limit with its series, and the curves.
    fn bytes((request, setup): &Task<Self>) -> usize {
        let (places, profile) =
            (Indenter::new(Arc::clone(&setup.profile)).singular_radii().len() + 3, &request.contact.profile);
        let points = places * TABLE_POINTS + profile.points().min(TABLE_KNOTS);
        of_shape(profile) + points * SERIES + request.points() * 5 * NUMBER
    }

    fn rows((request, _): &Task<Self>) -> (usize, usize) {
        (request.points() + 3, 5 * NUMBER_LENGTH)
    }

    fn cost((request, setup): &Task<Self>) -> Nanoseconds {
        let limit = LIMIT_COST + request.points() as u64 * RADIUS_COST;
        let table = TABLE_COST + request.contact.profile.points() as u64 * KNOT_COST;
        on_profile(&setup.profile, limit, false).saturating_add(table)
    }

    fn run((request, setup): Task<Self>, stop: &dyn Stop) -> Result<WearReply, Failure> {
        let timer = Timer::start(stop);
        let (contact, displacement) = (contact(setup, "/contact")?, request.drive.displacement);
        let worn = WornContact::new(&contact, displacement).map_err(|error| {
            let place = if let Error::OutOfRange { .. } = error { "/drive/displacement" } else { "/contact/profile" };
            Failure::at(place, error)
        })?;
        stop.check()?;
        let (shape, pressure) = curves(&contact, &worn, request.points());
        stop.check()?;
        let (profile, profile_error, warning) = limiting_profile(&contact, &worn, &request.contact, stop);
        stop.check()?;
        let mut moved = contact.clone();
        let step = Move { tangential: Some(Tangential::Displacement(displacement)), ..Move::default() };
        // A displacement within its range is always reached.
        let estimated = moved.apply(&step).map_or(&contact, |()| &moved);
        Ok(WearReply {
            contact: contact.summary().into(),
            stick_radius: worn.stick_radius(),
            worn_radius: worn.worn_radius(),
            indentation: contact.indentation(),
            normal_force: WornForce { before: contact.normal_force(), after: worn.normal_force() },
            force_amplitude: worn.force_amplitude(),
            removed_volume: worn.removed_volume(),
            depth: worn.depth().into(),
            shape,
            pressure,
            profile,
            profile_error,
            accuracy: accuracy(estimated, timer, REASON),
            warnings: present_warnings(&contact).into_iter().chain(warning).collect(),
        })
    }
}

/// Shape and pressure before wear and in the limit, at evenly spaced radii and where they have kinks.
fn curves(contact: &Contact, worn: &WornContact<'_>, points: usize) -> (WornShape, WornPressure) {
    let (reach, last) = (worn.reach(REACH), points.saturating_sub(1) as f64);
    let mut radius: Vec<f64> = (0..points).map(|index| reach * (index as f64 / last)).collect();
    radius.extend([worn.stick_radius(), contact.contact_radius(), worn.worn_radius()]);
    radius.sort_by(f64::total_cmp);
    radius.dedup_by(|next, one| *next <= *one);
    let all = |values: Vec<f64>| values.into_iter().map(finite).collect();
    let heights = worn.heights(&radius);
    let (before, after) = (contact.pressures(&radius), worn.pressures(&radius));
    let pressure = WornPressure { radius: radius.clone(), before: all(before), after: all(after) };
    (WornShape { radius, before: heights.before, after: heights.after }, pressure)
}

/// The limiting shape as a profile with its error, or a warning that says why there is none.
fn limiting_profile(
    contact: &Contact,
    worn: &WornContact<'_>,
    definition: &ContactDefinition,
    stop: &dyn Stop,
) -> (Option<Profile>, Option<WornProfileError>, Option<Warning>) {
    if !worn.wears() {
        return (Some(definition.profile.clone()), Some(WornProfileError::default()), None);
    }
    if let Some(WornTable { radii, heights, normal_force_error, rise_width }) =
        worn.table_while(&|| stop.check().is_ok())
    {
        let table = TabulatedProfile { r: radii, z: heights, indentation_error: None, pressure_error: None };
        let error = WornProfileError { normal_force: normal_force_error, rise_width };
        let warning = (normal_force_error > LARGE_ERROR).then(|| {
            let detail = format!(
                "the normal force of `profile` differs by {:.2} % from that of the limit: the rise of its g is wide \
                 beside the stuck disc",
                100.0 * normal_force_error
            );
            Warning::new("worn_profile_error", detail)
        });
        return (Some(Profile::Tabulated(table)), Some(error), warning);
    }
    let reason = if contact.indenter().rim_radius().is_some() {
        "the profile ends in a vertical edge, which a table does not have".to_owned()
    } else {
        let width = in_unit(worn.worn_radius() - worn.stick_radius(), "m");
        format!("the worn annulus, {width} wide, is too thin for a table whose g rises")
    };
    (
        None,
        None,
        Some(Warning::new("no_worn_profile", format!("the limiting shape cannot be given as a `profile`: {reason}"))),
    )
}

impl Outcome for WearReply {
    type Reply = WearReply;

    fn length(&self) -> usize {
        let table = match &self.profile {
            Some(Profile::Tabulated(table)) => table.r.len(),
            _ => 0,
        };
        (6 * self.shape.radius.len() + 2 * table) * NUMBER_LENGTH + 4_096
    }

    fn table(&self, _: &DisplayOptions) -> Option<Table<'_>> {
        let WearReply { shape, pressure, .. } = self;
        let columns = vec![
            Column::floats("radius", "m", |row| shape.radius[row]),
            Column::floats("height_before", "m", |row| shape.before[row]),
            Column::floats("height_after", "m", |row| shape.after[row]),
            Column::floats("pressure_before", "Pa", |row| pressure.before[row]),
            Column::floats("pressure_after", "Pa", |row| pressure.after[row]),
        ];
        Some(Table::flat(shape.radius.len(), columns))
    }

    /// The shape with the removed part filled, and the pressure.
    fn picture(&self, _: &DisplayOptions) -> Option<Drawing> {
        let WearReply { shape, pressure: pressures, .. } = self;
        let radii = || shape.radius.iter().copied();
        let height = |values: &[f64]| -> Vec<(f64, f64)> { radii().zip(values.iter().copied()).collect() };
        let pressure = |values: &[Option<f64>]| -> Vec<(f64, f64)> {
            radii().zip(values.iter().map(|value| value.unwrap_or(f64::NAN))).collect()
        };
        let (before, after) = (height(&shape.before), height(&shape.after));
        let outline: Vec<_> = before.iter().chain(after.iter().rev()).copied().collect();
        let heights = Panel {
            y: Axis::of("height z", "m"),
            curves: vec![
                Curve::area("removed", Colour::Orange, outline),
                Curve::line("before", Colour::Grey, before),
                Curve::line("after", Colour::Blue, after),
            ],
        };
        let pressure_panel = Panel {
            y: Axis::of("pressure p", "Pa"),
            curves: vec![
                Curve::line("before", Colour::Grey, pressure(&pressures.before)),
                Curve::line("after", Colour::Blue, pressure(&pressures.after)),
            ],
        };
        let title = format!("What wear leaves: {:.4e} m³ removed", self.removed_volume);
        Some(Drawing::Plot(Plot::new(title, Axis::of("radius r", "m"), vec![heights, pressure_panel])))
    }
}
