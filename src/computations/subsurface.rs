//! The stress below the surface: of a contact in its present state, and `subsurface`, at the end of a path.

use serde::Serialize;
use serde_json::json;
use utoipa::ToSchema;

use stickslip_mechanics::{Contact, Profile};
use stickslip_report::plot::{Axis, Drawing, Peak, Section};
use stickslip_wire::simulate::Simulation;
use stickslip_wire::subsurface::{Places, SubsurfaceTask};
use stickslip_wire::{ContactDefinition, Fault, SimulateRequest, Steps, Subsurface, SubsurfaceReply};

use super::{About, Computation, Example, OnContact, Outcome, Shown, example};
use crate::admission::{Nanoseconds, Stop};
use crate::formats::{Column, Format, SUBSURFACE_ROW, Table};
use crate::simulation::{self, Failure, bytes, cost};

/// Why some stresses below the surface have no picture.
const NO_SECTION: &str =
    "a picture is of one of `von_mises`, `max_shear` and `hydrostatic` over a `plane` or the `surface`";

/// The stress below the surface at the end of a path.
pub struct SubsurfaceOfPath;

/// Stresses below the surface, and what was asked for.
pub struct Below<R> {
    reply: R,
    task: Option<SubsurfaceTask>,
}

impl Computation for SubsurfaceOfPath {
    const ABOUT: About = About {
        name: "subsurface",
        route: None,
        title: "Run the body of POST /simulate and print the stress below the surface that it asks for",
        description: "The stress tensor and its invariants in one of the two bodies, at the end of a path.",
        reply: "The stresses at the end of the path",
        formats: &Format::ALL,
        printed: Format::Csv,
        shows: "A picture is of one of `von_mises`, `max_shear` and `hydrostatic` over a `plane` or the `surface`.",
        choice: None,
    };

    type Request = SimulateRequest;
    type Outcome = Below<Subsurface>;

    fn examples() -> Vec<Example> {
        vec![example(
            "section",
            "Von Mises stress in the plane of the motion",
            json!({
                "contact": ContactDefinition::example(),
                "path": {"displacement": [1e-7]},
                "subsurface": {
                    "body": "first",
                    "plane": {"normal": "y", "offset": 0.0, "x": [-2e-4, 2e-4, 41], "z": [0.0, 2e-4, 21]},
                    "fields": ["von_mises"]
                }
            }),
        )]
    }

    fn check_shown(task: &Simulation, shown: &Shown) -> Result<(), Fault> {
        let at = |detail: &str| Fault { pointer: "/subsurface".to_owned(), detail: detail.to_owned() };
        match &task.subsurface {
            None => Err(at("missing: it says where the stress is asked for")),
            Some(task) => can_show(task, shown).map_err(at),
        }
    }

    fn bytes(task: &Simulation) -> usize {
        bytes::of_simulation(task)
    }

    fn rows(task: &Simulation) -> (usize, usize) {
        task.subsurface.as_ref().map_or((0, 0), OnContact::rows)
    }

    fn cost(task: &Simulation) -> Nanoseconds {
        cost::of_simulation(task)
    }

    fn run(mut task: Simulation, stop: &Stop) -> Result<Below<Subsurface>, Failure> {
        (task.steps, task.stress, task.residual) = (Steps::Last, None, false);
        let reply = simulation::simulate(&task, stop)?.subsurface.unwrap_or_default();
        Ok(Below { reply, task: task.subsurface })
    }
}

impl OnContact for SubsurfaceTask {
    type Outcome = Below<SubsurfaceReply>;

    fn bytes(&self) -> usize {
        bytes::of_subsurface(self)
    }

    fn rows(&self) -> (usize, usize) {
        (self.places.count(), SUBSURFACE_ROW)
    }

    fn check_shown(&self, shown: &Shown) -> Result<(), Fault> {
        let at = |detail: &str| Fault { pointer: "/fields".to_owned(), detail: detail.to_owned() };
        can_show(self, shown).map_err(at)
    }

    fn cost(&self, profile: &Profile, depth: usize) -> Nanoseconds {
        cost::of_subsurface(profile, self, depth)
    }

    fn run(self, contact: Contact, _: u64, stop: &Stop) -> Result<Below<SubsurfaceReply>, Failure> {
        Ok(Below { reply: simulation::subsurface_reply(&contact, &self, stop)?, task: Some(self) })
    }
}

/// Refuses a picture of what has none.
fn can_show(task: &SubsurfaceTask, shown: &Shown) -> Result<(), &'static str> {
    if shown.format.is_plot() && !task.is_section() { Err(NO_SECTION) } else { Ok(()) }
}

impl<R: AsRef<Subsurface> + Serialize + ToSchema + Send> Outcome for Below<R> {
    type Reply = R;

    fn reply(&self) -> &R {
        &self.reply
    }

    fn table(&self, _: &Shown) -> Option<Table<'_>> {
        Some(table(self.reply.as_ref()))
    }

    fn picture(&self, _: &Shown) -> Option<Drawing> {
        Some(Drawing::Section(section(self.reply.as_ref(), self.task.as_ref()?)))
    }
}

/// The stress below the surface: a row for each place.
fn table(reply: &Subsurface) -> Table<'_> {
    let mut columns = vec![
        Column::floats("x", "m", |row| reply.x[row]),
        Column::floats("y", "m", |row| reply.y[row]),
        Column::floats("z", "m", |row| reply.z[row]),
    ];
    for (name, values) in reply.columns() {
        if let Some(values) = values {
            columns.push(Column::floats(name, "Pa", |row| values[row].unwrap_or(f64::NAN)));
        }
    }
    Table::flat(reply.x.len(), columns)
}

/// One field below the surface over a plane.
fn section(stress: &Subsurface, task: &SubsurfaceTask) -> Section {
    let fields = [
        ("von Mises stress", &stress.von_mises),
        ("largest shear stress", &stress.max_shear),
        ("mean stress", &stress.hydrostatic),
    ];
    let (name, values) =
        fields.into_iter().find_map(|(name, values)| Some((name, values.as_deref()?))).unwrap_or_default();
    let title = format!("{name} in the {} body", task.body_name());
    let section = over_plane(title, (name, "Pa"), values, &task.places);
    let known = values.iter().enumerate().filter_map(|(index, value)| Some((index, (*value)?)));
    let largest = known.max_by(|one, other| one.1.total_cmp(&other.1));
    let rows = section.y.1.len();
    let place = |index: usize| (section.x.1[index / rows], section.y.1[index % rows]);
    Section { largest: largest.map(|(index, value)| Peak { value, places: vec![place(index)] }), ..section }
}

/// Values over a grid of places, which are in order of its axes.
pub(super) fn over_plane(
    title: String,
    (name, unit): (&'static str, &'static str),
    values: &[Option<f64>],
    places: &Places,
) -> Section {
    let [x, y, z] = places.axes().unwrap_or_default();
    let values = values.iter().map(|value| value.unwrap_or(f64::NAN)).collect();
    let axis = |name| Axis { name, unit: Some("m") };
    let (across, along, depth) = (axis("x, along the motion"), axis("y, across the motion"), axis("z, the depth"));
    // The grid runs along x, y and z in turn, and is a single value along one of them.
    let (first, second, downwards) = if y.len() == 1 {
        ((across, x), (depth, z), true)
    } else if z.len() == 1 {
        ((across, x), (along, y), false)
    } else {
        ((along, y), (depth, z), true)
    };
    let unit = Axis { name, unit: Some(unit).filter(|unit| *unit != "1") };
    Section { title, x: first, y: second, downwards, values: (unit, values), largest: None, edge: None }
}
