//! The stress below the surface: of a contact in its present state, and `subsurface`, at the end of a path.

use serde::Serialize;
use utoipa::ToSchema;

use stickslip_plot::{Peak, Section};
use stickslip_wire::subsurface::{Places, SubsurfaceTask};
use stickslip_wire::{Subsurface, SubsurfaceReply};

use crate::computations::prelude::*;
use crate::simulation::bulk_warning;

const REASON: &str = "the stress below the surface follows from the slip history without a mesh";
/// Why some stresses below the surface have no picture.
const NO_SECTION: &str =
    "a picture shows one of `von_mises`, `max_shear` and `hydrostatic` over a `plane` or the `surface`";

/// The stress below the surface at the end of a path.
pub struct SubsurfaceOfPath;

/// Stresses below the surface, and what was asked for.
pub struct SubsurfaceTable<R> {
    reply: R,
    task: Option<SubsurfaceTask>,
}

impl Computation for SubsurfaceOfPath {
    const ABOUT: About = About {
        name: "subsurface",
        title: "Run the body of POST /simulate and print the stress below the surface that it asks for",
        description: "The stress tensor and its invariants in one of the two bodies, at the end of a path.",
        reply: "The stresses at the end of the path",
        printed: Format::Csv,
        shows: "A picture shows one of `von_mises`, `max_shear` and `hydrostatic` over a `plane` or the `surface`.",
        ..About::TABLE
    };

    type Request = SimulateRequest;
    type Outcome = SubsurfaceTable<Subsurface>;

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

    fn check_shown(task: &Simulation, shown: &DisplayOptions) -> Result<(), Fault> {
        let at = |detail: &str| Fault::new("/subsurface", detail.to_owned());
        match &task.subsurface {
            None => Err(at("missing: give the places and the fields of the stress")),
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

    fn run(mut task: Simulation, stop: &dyn Stop) -> Result<SubsurfaceTable<Subsurface>, Failure> {
        (task.steps, task.stress, task.residual) = (Steps::Last, None, false);
        let reply = simulation::simulate(&task, stop)?.subsurface.unwrap_or_default();
        Ok(SubsurfaceTable { reply, task: task.subsurface })
    }
}

impl OnContact for SubsurfaceTask {
    type Outcome = SubsurfaceTable<SubsurfaceReply>;

    fn bytes(&self) -> usize {
        bytes::of_subsurface(self)
    }

    fn rows(&self) -> (usize, usize) {
        (self.places.count(), bytes::PLACE_ROW)
    }

    fn check_shown(&self, shown: &DisplayOptions) -> Result<(), Fault> {
        let at = |detail: &str| Fault::new("/fields", detail.to_owned());
        can_show(self, shown).map_err(at)
    }

    fn cost(&self, profile: &Profile, depth: usize) -> Nanoseconds {
        cost::of_subsurface(profile, self, depth)
    }

    fn run(self, contact: Contact, _: u64, stop: &dyn Stop) -> Result<SubsurfaceTable<SubsurfaceReply>, Failure> {
        let timer = Timer::start(stop);
        needs_stress_field(&contact, "")?;
        let (stress, error) = simulation::subsurface(&contact, &self, stop)?;
        let accuracy = Accuracy { subsurface_error: Some(error), ..accuracy(&contact, timer, REASON) };
        let warnings = present_warnings(&contact).into_iter().chain(bulk_warning(self.bulk.is_some())).collect();
        Ok(SubsurfaceTable { reply: SubsurfaceReply { stress, accuracy, warnings }, task: Some(self) })
    }
}

/// Refuses a picture of what has none.
fn can_show(task: &SubsurfaceTask, shown: &DisplayOptions) -> Result<(), &'static str> {
    if shown.format.is_plot() && !task.is_section() { Err(NO_SECTION) } else { Ok(()) }
}

impl<R> Borrow<R> for SubsurfaceTable<R> {
    fn borrow(&self) -> &R {
        &self.reply
    }
}

impl<R: AsRef<Subsurface> + Serialize + ToSchema + Send> Outcome for SubsurfaceTable<R> {
    type Reply = R;

    fn table(&self, _: &DisplayOptions) -> Option<Table<'_>> {
        let stress = self.reply.as_ref();
        let columns = stress.columns().into_iter().filter_map(|(name, values)| Some((name, "Pa", values?)));
        Some(column_table([&stress.x, &stress.y, &stress.z], columns))
    }

    /// One field below the surface over a plane.
    fn picture(&self, _: &DisplayOptions) -> Option<Drawing> {
        let (stress, task) = (self.reply.as_ref(), self.task.as_ref()?);
        let fields = [
            ("von Mises stress", &stress.von_mises),
            ("largest shear stress", &stress.max_shear),
            ("mean stress", &stress.hydrostatic),
        ];
        let (name, values) =
            fields.into_iter().find_map(|(name, values)| Some((name, values.as_deref()?))).unwrap_or_default();
        let title = format!("{name} in the {} body", task.body_name());
        let section = over_plane(title, Axis::of(name, "Pa"), values, &task.places);
        let known = values.iter().enumerate().filter_map(|(index, value)| Some((index, (*value)?)));
        let largest = known.max_by(|one, other| one.1.total_cmp(&other.1));
        let rows = section.y.1.len();
        let place = |index: usize| (section.x.1[index / rows], section.y.1[index % rows]);
        let largest = largest.map(|(index, value)| Peak { value, places: vec![place(index)] });
        Some(Drawing::Section(Section { largest, ..section }))
    }
}

/// Columns of values over their places, m: a row for each place.
pub(super) fn column_table<'a>(
    [x, y, z]: [&'a [f64]; 3],
    columns: impl Iterator<Item = (impl AsRef<str>, &'static str, &'a [Option<f64>])>,
) -> Table<'a> {
    let places = [("x", x), ("y", y), ("z", z)].map(|(name, along)| Column::floats(name, "m", |row| along[row]));
    let values = columns.map(|(name, unit, values)| Column::floats(name.as_ref(), unit, |row| values[row]));
    Table::flat(x.len(), places.into_iter().chain(values).collect())
}

/// What pictures call the coordinates.
pub(super) const COORDINATES: [&str; 3] = ["x, along the motion", "y, across the motion", "z, the depth"];

/// The two coordinates of a picture over a grid of places along these axes, and the one that is constant.
pub(super) fn shown_axes([_, y, z]: &[Vec<f64>; 3]) -> [usize; 3] {
    match (y.len(), z.len()) {
        (1, _) => [0, 2, 1],
        (_, 1) => [0, 1, 2],
        _ => [1, 2, 0],
    }
}

/// Values over a grid of places, which runs along x, y and z in turn, and is a single value along one of them.
pub(super) fn over_plane(title: String, quantity: Axis, values: &[Option<f64>], places: &Places) -> Section {
    let mut axes = places.axes().unwrap_or_default();
    let [first, second, _] = shown_axes(&axes);
    let mut axis = |index: usize| (Axis::of(COORDINATES[index], "m"), std::mem::take(&mut axes[index]));
    let values = values.iter().map(|value| value.unwrap_or(f64::NAN)).collect();
    let (x, y) = (axis(first), axis(second));
    Section { title, x, y, downwards: second == 2, values: (quantity, values), largest: None, edge: None }
}
