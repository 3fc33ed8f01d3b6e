//! `cycle`: the steady cycles of a contact at constant load, under a load that oscillates, or under many.

use serde_json::json;

use stickslip_mechanics::{Contact, Move, Profile, Tangential};
use stickslip_report::plot::{Axis, Colour, Curve, Drawing, Panel, Plot};
use stickslip_wire::cycle::CycleTask;
use stickslip_wire::definition::SharedSetup;
use stickslip_wire::{ContactDefinition, CycleReply, CycleRequest, Harmonic, SteadyCycle};

use super::{About, Computation, Example, OnContact, Outcome, Route, Shown, example, fretting_map};
use crate::admission::{Nanoseconds, Stop};
use crate::formats::{Cells, Column, Format, Table};
use crate::simulation::bytes::{NUMBER_LENGTH, STATE_LENGTH, of_shape};
use crate::simulation::cost::{RADIUS_COST, on_profile};
use crate::simulation::{self, Failure, Timer};

/// One steady cycle with its row as JSON.
const CYCLE_COST: u64 = 2_000;
/// The first harmonics of one cycle, and as much again for every eight orders.
const HARMONICS_COST: u64 = 3_000;
/// The same of a driven force or through a machine, where each node inverts the profile.
const INVERTED_HARMONICS_COST: u64 = 20_000;
/// The steady oscillation of a mass on a sphere at one frequency, some tenths of that of small oscillations or higher.
const OSCILLATION_COST: u64 = 500_000;
/// One cycle under a load that oscillates, which is stepped until three results agree.
const STEPPED_CYCLE_COST: u64 = 15_000_000;
/// The same driven by a force or through a machine, where what is left falls with the square of the step alone and each
/// step searches for a force.
const SEARCHED_CYCLE_COST: u64 = 100_000_000;
/// One steady cycle as numbers, and as JSON in a text that grows by doubling.
const CYCLE_BYTES: usize = 1_536;
/// One harmonic, likewise.
const HARMONIC_BYTES: usize = 256;
/// The friction work per area at one radius, likewise.
const DENSITY_BYTES: usize = 128;
/// Points of each branch of a steady loop in a plot.
const BRANCH_POINTS: usize = 200;

/// The steady cycles of a contact.
pub struct Cycle;

/// Steady cycles, and the contact at their load without its history.
pub struct SteadyCycles {
    contact: Contact,
    reply: CycleReply,
    task: CycleTask,
}

impl Computation for Cycle {
    const ABOUT: About = About {
        name: "cycle",
        route: Some(Route { path: "/cycle", operation: "compute_steady_cycle", tag: "simulation" }),
        title: "Compute steady cycles",
        description: "Moves a contact back and forth at constant load until every cycle is as the one before, in \
                      closed form: a displacement or a force that is a cosine, directly or through a machine of \
                      finite stiffness. Returns work, stiffness, loss factor and slip for each amplitude and, if \
                      asked for, the harmonics and the friction work per area, or the same cycles under many loads. \
                      Nothing is stored.",
        reply: "The cycles, one for each amplitude, under each load of a map",
        formats: &Format::ALL,
        printed: Format::Columns,
        shows: "The friction work per area is in `columns` alone.",
        choice: None,
    };

    type Request = CycleRequest;
    type Outcome = SteadyCycles;

    fn examples() -> Vec<Example> {
        vec![
            example(
                "amplitudes",
                "Displacement amplitudes, with the describing function",
                json!({
                    "contact": ContactDefinition::example(),
                    "drive": {"displacement": [5e-8, 1e-7, 2e-7]},
                    "harmonics": 1
                }),
            ),
            example(
                "machine",
                "A force through a machine, with the friction work per area",
                json!({
                    "contact": ContactDefinition::example(),
                    "drive": {"force": 2.0}, "machine": {"stiffness": 2e7},
                    "work_density": {"points": 50}
                }),
            ),
            example(
                "map",
                "A fretting map",
                json!({
                    "contact": ContactDefinition::example(), "drive": {"displacement": [1e-8, 3e-8, 1e-7, 3e-7]},
                    "map": {"normal_force": {"from": 1.0, "to": 100.0, "count": 40}}
                }),
            ),
        ]
    }

    fn bytes((definition, _, task): &(ContactDefinition, SharedSetup, CycleTask)) -> usize {
        task.bytes() + of_shape(&definition.profile)
    }

    fn rows((.., task): &(ContactDefinition, SharedSetup, CycleTask)) -> (usize, usize) {
        OnContact::rows(task)
    }

    fn cost((_, setup, task): &(ContactDefinition, SharedSetup, CycleTask)) -> Nanoseconds {
        task.cost(&setup.profile, 0)
    }

    fn run(
        (_, setup, task): (ContactDefinition, SharedSetup, CycleTask),
        stop: &Stop,
    ) -> Result<SteadyCycles, Failure> {
        let (contact, reply) = simulation::cycle_of(setup, &task, stop)?;
        Ok(SteadyCycles { contact, reply, task })
    }
}

impl OnContact for CycleTask {
    type Outcome = SteadyCycles;

    fn bytes(&self) -> usize {
        let curve = self.best_load.map_or(0, |study| study.points.unwrap_or(0));
        let swept = self.response.as_ref().map_or(0, |(asked, _)| asked.frequencies.as_ref().map_or(200, Vec::len));
        self.rows() * (CYCLE_BYTES + self.harmonics * HARMONIC_BYTES + (self.radii() + curve) * DENSITY_BYTES)
            + swept * CYCLE_BYTES
    }

    fn rows(&self) -> (usize, usize) {
        (CycleTask::rows(self), STATE_LENGTH + 2 * self.harmonics * 2 * NUMBER_LENGTH)
    }

    fn cost(&self, profile: &Profile, _: usize) -> Nanoseconds {
        let inverted = self.is_force_driven() || self.stiffness.is_some();
        let once = if inverted { INVERTED_HARMONICS_COST } else { HARMONICS_COST };
        let harmonics = if self.harmonics > 0 { once * (1 + self.harmonics as u64 / 8) } else { 0 };
        let each_stepped = if inverted { SEARCHED_CYCLE_COST } else { STEPPED_CYCLE_COST };
        let stepped = if self.normal.is_some() { each_stepped } else { 0 };
        // Some four hundred loads are compared.
        let searched = self.best_load.map_or(0, |study| 400 + study.points.unwrap_or(0) as u64) * CYCLE_COST;
        let each = CYCLE_COST + stepped + harmonics + searched + self.radii() as u64 * RADIUS_COST;
        let swept = self.response.as_ref().map_or(0, |(asked, _)| asked.frequencies.as_ref().map_or(200, Vec::len));
        let response = OSCILLATION_COST * swept as u64;
        on_profile(profile, each.saturating_mul(self.rows() as u64).saturating_add(response), false)
    }

    fn run(self, contact: Contact, _: u64, stop: &Stop) -> Result<SteadyCycles, Failure> {
        let contact = contact.without_history();
        let reply = simulation::cycle(&contact, &self, Timer::start(stop), stop)?;
        Ok(SteadyCycles { contact, reply, task: self })
    }
}

impl Outcome for SteadyCycles {
    type Reply = CycleReply;

    fn reply(&self) -> &CycleReply {
        &self.reply
    }

    fn table(&self, _: &Shown) -> Option<Table<'_>> {
        Some(table(&self.reply, &self.task))
    }

    fn picture(&self, _: &Shown) -> Option<Drawing> {
        Some(Drawing::Plot(plot(&self.contact, &self.reply, &self.task)))
    }
}

/// Steady cycles: a row for each amplitude.
fn table<'a>(reply: &'a CycleReply, task: &CycleTask) -> Table<'a> {
    let cycles = &reply.cycles;
    let column = |name, unit, of: fn(&SteadyCycle) -> f64| Column::floats(name, unit, move |row| of(&cycles[row]));
    let maybe = |number: Option<f64>| number.unwrap_or(f64::NAN);
    let mut columns = vec![
        column("displacement_amplitude", "m", |cycle| cycle.displacement_amplitude),
        column("force_amplitude", "N", |cycle| cycle.force_amplitude),
        column("dissipated_energy", "J", |cycle| cycle.dissipated_energy),
        column("max_elastic_energy", "J", |cycle| cycle.max_elastic_energy),
        column("secant_stiffness", "N/m", |cycle| cycle.secant_stiffness),
        column("tangent_stiffness", "N/m", |cycle| cycle.tangent_stiffness),
        Column::floats("loss_factor", "1", move |row| maybe(cycles[row].loss_factor)),
        Column::floats("sliding_ratio", "1", move |row| maybe(cycles[row].sliding_ratio)),
        column("stick_radius", "m", |cycle| cycle.stick_radius),
        Column::new("regime", Some(""), Cells::Words(Box::new(|row| cycles[row].regime.name()))),
    ];
    if task.stiffness.is_some() {
        let amplitude = Column::floats("machine_amplitude", "m", move |row| maybe(cycles[row].machine_amplitude));
        columns.insert(2, amplitude);
    }
    if task.map.is_some() {
        let load = Column::floats("normal_force", "N", move |row| maybe(cycles[row].normal_force));
        let limit = move |row: usize| maybe(cycles[row].gross_slip_displacement);
        columns.splice(0..0, [load, Column::floats("gross_slip_displacement", "m", limit)]);
    }
    let unit = if task.is_force_driven() { "m" } else { "N" };
    for index in 0..task.harmonics {
        let part = |of: fn(&Harmonic) -> f64| {
            move |row: usize| maybe(cycles[row].harmonics.as_deref().and_then(|all| all.get(index)).map(of))
        };
        let order = index + 1;
        columns.push(Column::floats(&format!("in_phase_{order}"), unit, part(|harmonic| harmonic.in_phase)));
        columns.push(Column::floats(&format!("quadrature_{order}"), unit, part(|harmonic| harmonic.quadrature)));
    }
    Table::flat(cycles.len(), columns)
}

/// Loss factor and secant stiffness over the amplitude, or the loop if there is one amplitude at constant load, or the
/// fretting map. `contact` is at the load of the cycles and has no history.
fn plot(contact: &Contact, reply: &CycleReply, task: &CycleTask) -> Plot {
    if task.map.is_some() {
        return fretting_map::plot(&reply.cycles, task.drives().len());
    }
    if let ([only], None) = (&reply.cycles[..], task.normal) {
        return steady_loop(contact, only);
    }
    let panel = |name, unit, colour, of: fn(&SteadyCycle) -> f64| {
        let mut points: Vec<_> = reply.cycles.iter().map(|cycle| (cycle.displacement_amplitude, of(cycle))).collect();
        points.sort_by(|one, other| one.0.total_cmp(&other.0));
        Panel { y: Axis { name, unit }, curves: vec![Curve { name: "", points, colour, silent: true, dots: false }] }
    };
    Plot {
        title: "Steady cycles".to_owned(),
        x: Axis { name: "displacement amplitude U₀", unit: Some("m") },
        panels: vec![
            panel("loss factor", None, Colour::Red, |cycle| cycle.loss_factor.unwrap_or(f64::NAN)),
            panel("secant stiffness", Some("N/m"), Colour::Blue, |cycle| cycle.secant_stiffness),
        ],
        bands: Vec::new(),
    }
}

/// The loop of a steady cycle, followed from its upper end.
fn steady_loop(contact: &Contact, cycle: &SteadyCycle) -> Plot {
    let mut contact = contact.clone();
    let mut at = |share: f64| {
        let displacement = share * cycle.displacement_amplitude;
        let step = Move { tangential: Some(Tangential::Displacement(displacement)), ..Move::default() };
        (displacement, contact.apply(&step).map_or(f64::NAN, |()| contact.force()))
    };
    let down = (0..=BRANCH_POINTS).map(|index| 1.0 - 2.0 * index as f64 / BRANCH_POINTS as f64);
    let up = down.clone().map(|share| -share);
    let points = down.chain(up).map(&mut at).collect();
    Plot {
        title: format!("Steady cycle of {:.4e} J", cycle.dissipated_energy),
        x: Axis { name: "displacement U", unit: Some("m") },
        panels: vec![Panel {
            y: Axis { name: "tangential force F", unit: Some("N") },
            curves: vec![Curve { name: "", points, colour: Colour::Blue, silent: true, dots: false }],
        }],
        bands: Vec::new(),
    }
}
