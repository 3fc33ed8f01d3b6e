//! `cycle`: the steady cycles of a contact at constant load, under a load that oscillates, or under many.

mod map;
mod steady;
mod studies;
mod timed;

use stickslip_mechanics::{Error, Move, Preload, Tangential};
use stickslip_wire::cycle::CycleTask;
use stickslip_wire::{CycleReply, CycleRequest, Harmonic, SteadyCycle};

use crate::computations::prelude::*;
use crate::simulation::bytes::STATE_LENGTH;

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
/// One cycle of bodies with memory at one frequency, for each term of their series.
const TIMED_CYCLE_COST: u64 = 2_000_000;
/// Points of each branch of a steady loop in a plot.
const BRANCH_POINTS: usize = 200;

/// The steady cycles of a contact.
pub struct Cycle;

/// Steady cycles, and the contact at their load without its history.
pub struct SteadyCycles {
    contact: Contact,
    reply: CycleReply,
    task: CycleTask,
    /// What is held for long, of bodies with memory.
    held: Preload,
}

impl Computation for Cycle {
    const ABOUT: About = About {
        name: "cycle",
        route: Some(Route { path: "/cycle", operation: "compute_steady_cycle", tag: "simulation" }),
        title: "Compute steady cycles",
        description: "Moves a contact back and forth at constant load until every cycle repeats the one before it, in \
                      closed form: a displacement or a force that is a cosine, directly or through a machine of finite \
                      stiffness. Returns work, stiffness, loss factor and slip for each amplitude and, if asked for, \
                      the harmonics and the friction work per area, or the same cycles under many loads. Of bodies \
                      with memory, the cycles at each frequency. Nothing is stored.",
        reply: "The cycles, one for each amplitude, under each load of a map or at each frequency",
        shows: "Only `columns` has the friction work per area.",
        ..About::TABLE
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
            example(
                "frequencies",
                "Bodies with memory: the loss over frequency and amplitude",
                json!({
                    "contact": rubber(), "drive": {"displacement": [1e-5, 1e-4]},
                    "frequency": [0.01, 0.1, 1.0, 10.0, 100.0]
                }),
            ),
        ]
    }

    fn bytes((definition, _, task): &Task<Self>) -> usize {
        task.bytes() + of_shape(&definition.profile)
    }

    fn rows((.., task): &Task<Self>) -> (usize, usize) {
        OnContact::rows(task)
    }

    fn cost((_, setup, task): &Task<Self>) -> Nanoseconds {
        let terms = setup.friction.memory.as_ref().map_or(0, |prony| prony.terms().len() as u64);
        let timed = TIMED_CYCLE_COST.saturating_mul(terms).saturating_mul(task.rows() as u64);
        task.cost(&setup.profile, 0).saturating_add(if task.frequencies.is_empty() { 0 } else { timed })
    }

    fn run((_, setup, task): Task<Self>, stop: &dyn Stop) -> Result<SteadyCycles, Failure> {
        let (timer, held) = (Timer::start(stop), setup.preload);
        SteadyCycles::of(contact(setup, "/contact")?, task, held, timer, stop)
    }
}

impl OnContact for CycleTask {
    type Outcome = SteadyCycles;

    fn bytes(&self) -> usize {
        let curve = self.best_load.map_or(0, |study| study.points.unwrap_or(0));
        self.rows() * (2 * OBJECT + self.harmonics * ROW + (self.radii() + curve) * 2 * NUMBER)
            + frequencies(self) * 2 * OBJECT
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
        let response = OSCILLATION_COST * frequencies(self) as u64;
        on_profile(profile, each.saturating_mul(self.rows() as u64).saturating_add(response), false)
    }

    fn takes_shear_strength(&self) -> bool {
        self.study_of_friction().is_none()
    }

    fn run(self, contact: Contact, _: u64, stop: &dyn Stop) -> Result<SteadyCycles, Failure> {
        let elastic = contact.check_elastic("`/cycle`");
        let adheres = elastic.is_ok() && contact.work_of_adhesion() > 0.0;
        let known = if adheres { Err(Error::Adhesive("`/cycle`")) } else { elastic };
        known.map_err(|error| Failure::at("", error))?;
        cost::check(OnContact::cost(&self, contact.profile(), 0), stop)?;
        let held = Preload::NormalForce(contact.normal_force());
        SteadyCycles::of(contact.without_history(), self, held, Timer::start(stop), stop)
    }
}

/// The contact of an example: a ball of rubber on a rigid plane.
fn rubber() -> serde_json::Value {
    json!({
        "profile": {"type": "sphere", "radius": 0.01},
        "material": {"bodies": [{"youngs_modulus": 3e6, "poisson_ratio": 0.5}, "rigid"]},
        "friction": 0.8, "prony": [{"ratio": 0.6, "time": 0.1}],
        "preload": {"indentation": 2e-4}
    })
}

/// Frequencies of the oscillations of a mass.
fn frequencies(task: &CycleTask) -> usize {
    task.response.as_ref().map_or(0, |(asked, _)| asked.frequencies.as_ref().map_or(studies::FREQUENCIES, Vec::len))
}

impl SteadyCycles {
    fn of(
        contact: Contact,
        task: CycleTask,
        held: Preload,
        timer: Timer<'_>,
        stop: &dyn Stop,
    ) -> Result<SteadyCycles, Failure> {
        let reply = match task.map {
            _ if !task.frequencies.is_empty() => timed::cycles(&contact, &task, held, timer, stop)?,
            Some(map) => map::cycles(&contact, &task, map, timer, stop)?,
            None => steady::steady_cycles(&contact, &task, timer, stop)?,
        };
        Ok(SteadyCycles { contact, reply, task, held })
    }
}

impl Borrow<CycleReply> for SteadyCycles {
    fn borrow(&self) -> &CycleReply {
        &self.reply
    }
}

impl Outcome for SteadyCycles {
    type Reply = CycleReply;

    /// A row for each amplitude, under each load of a map or at each frequency.
    fn table(&self, _: &DisplayOptions) -> Option<Table<'_>> {
        let (cycles, task) = (&self.reply.cycles, &self.task);
        let column = |name, unit, of: fn(&SteadyCycle) -> f64| Column::floats(name, unit, move |row| of(&cycles[row]));
        let mut columns = Vec::new();
        let timed = !task.frequencies.is_empty();
        if timed {
            columns.push(Column::floats("frequency", "Hz", |row| cycles[row].frequency));
        }
        if timed || task.map.is_some() {
            columns.push(Column::floats("normal_force", "N", |row| cycles[row].normal_force));
            columns.push(Column::floats("gross_slip_displacement", "m", |row| cycles[row].gross_slip_displacement));
        }
        let [angle, force, stiffness] = if task.twists() { ["rad", "N·m", "N·m/rad"] } else { ["m", "N", "N/m"] };
        if task.twists() {
            columns.push(Column::floats("twist_amplitude", angle, |row| cycles[row].twist_amplitude));
            columns.push(Column::floats("torque_amplitude", force, |row| cycles[row].torque_amplitude));
        } else {
            columns.push(Column::floats("displacement_amplitude", angle, |row| cycles[row].displacement_amplitude));
            columns.push(Column::floats("force_amplitude", force, |row| cycles[row].force_amplitude));
        }
        if task.stiffness.is_some() {
            columns.push(Column::floats("machine_amplitude", angle, |row| cycles[row].machine_amplitude));
        }
        columns.push(column("dissipated_energy", "J", |cycle| cycle.dissipated_energy));
        if timed {
            columns.push(Column::floats("viscous_work", "J", |row| cycles[row].viscous_work));
        }
        columns.extend([
            column("max_elastic_energy", "J", |cycle| cycle.max_elastic_energy),
            column("secant_stiffness", stiffness, |cycle| cycle.secant_stiffness),
            column("tangent_stiffness", stiffness, |cycle| cycle.tangent_stiffness),
            Column::floats("loss_factor", "1", |row| cycles[row].loss_factor),
            Column::floats("sliding_ratio", "1", |row| cycles[row].sliding_ratio),
            column("stick_radius", "m", |cycle| cycle.stick_radius),
            Column::words("regime", |row| cycles[row].regime.name()),
        ]);
        let unit = if task.is_force_driven() { angle } else { force };
        for index in 0..task.harmonics {
            let part = |name: &str, of: fn(&Harmonic) -> f64| {
                let value = move |row: usize| cycles[row].harmonics.as_deref()?.get(index).map(of);
                Column::floats(&format!("{name}_{}", index + 1), unit, value)
            };
            columns.push(part("in_phase", |harmonic| harmonic.in_phase));
            columns.push(part("quadrature", |harmonic| harmonic.quadrature));
        }
        Some(Table::flat(cycles.len(), columns))
    }

    fn picture(&self, _: &DisplayOptions) -> Option<Drawing> {
        let SteadyCycles { contact, reply, task, held } = self;
        Some(Drawing::Plot(if task.frequencies.is_empty() {
            plot(contact, &reply.cycles, task)
        } else {
            timed::plot(contact, reply, task, *held)
        }))
    }
}

/// Loss factor and secant stiffness over the amplitude, or the loop if there is one amplitude at constant load, or the
/// fretting map. `contact` is at the load of the cycles and has no history.
fn plot(contact: &Contact, cycles: &[SteadyCycle], task: &CycleTask) -> Plot {
    if task.map.is_some() {
        return map::plot(cycles, task.drives().len());
    }
    if let ([only], None) = (cycles, task.normal) {
        return steady_loop(contact, only, task.twists());
    }
    let panel = |y, colour, of: fn(&SteadyCycle) -> f64| {
        let mut points: Vec<_> = cycles.iter().map(|cycle| (cycle.amplitude(), of(cycle))).collect();
        points.sort_by(|one, other| one.0.total_cmp(&other.0));
        Panel { y, curves: vec![Curve::line("", colour, points)] }
    };
    let loss =
        panel(Axis { name: "loss factor", unit: None }, Colour::Red, |cycle| cycle.loss_factor.unwrap_or(f64::NAN));
    let (x, unit) = if task.twists() {
        (Axis::of("angle amplitude ω₀", "rad"), "N·m/rad")
    } else {
        (Axis::of("displacement amplitude U₀", "m"), "N/m")
    };
    let stiffness = panel(Axis::of("secant stiffness", unit), Colour::Blue, |cycle| cycle.secant_stiffness);
    Plot::new("Steady cycles", x, vec![loss, stiffness])
}

/// The loop of a steady cycle, followed from its upper end.
fn steady_loop(contact: &Contact, cycle: &SteadyCycle, twists: bool) -> Plot {
    let mut contact = contact.clone();
    let at = |share: f64| {
        let place = share * cycle.amplitude();
        let target = if twists { Tangential::Twist(place) } else { Tangential::Displacement(place) };
        let step = Move { tangential: Some(target), ..Move::default() };
        let force = contact.apply(&step).map(|()| contact.state().torque.unwrap_or_else(|| contact.force()));
        (place, force.unwrap_or(f64::NAN))
    };
    let down = (0..=BRANCH_POINTS).map(|index| 1.0 - 2.0 * index as f64 / BRANCH_POINTS as f64);
    let up = down.clone().map(|share| -share);
    let curves = vec![Curve::line("", Colour::Blue, down.chain(up).map(at))];
    Plot::new(
        format!("Steady cycle of {:.4e} J", cycle.dissipated_energy),
        if twists { Axis::of("angle of twist ω", "rad") } else { Axis::of("displacement U", "m") },
        vec![Panel {
            y: if twists { Axis::of("torque M", "N·m") } else { Axis::of("tangential force F", "N") },
            curves,
        }],
    )
}
