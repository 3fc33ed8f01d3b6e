//! The body of `POST /cycle`, the parameters of `GET /contacts/{id}/cycle`, and their reply.

mod map;
mod reply;
mod studies;

pub use map::{FrettingMap, LoadSpan};
pub use reply::{CycleReply, FrictionWork, Harmonic, SteadyCycle};
pub use studies::{BestLoad, BestLoadStudy, FrequencyResponse, LoadCurve, Resonance, ResonancePoint};

use stickslip_mechanics::Error;
use stickslip_mechanics::cycle;
use stickslip_mechanics::cycle::OscillatingLoad;

use self::studies::FREQUENCY;
use crate::definition::member_of_law;
use crate::limits::{BEST_LOADS, CYCLE_AMPLITUDES, CYCLE_RADII, HARMONICS, MAP_CYCLES};
use crate::path::NormalOscillation;
use crate::prelude::*;
use crate::stress::{STRESS_PLACES, STRESS_RADII};

/// The default tolerance of cycles under an oscillating load and of oscillations of a mass: the error of the former
/// falls with a low power of the number of steps, which cost time.
const DEFAULT_TOLERANCE: f64 = 1e-6;

requests! {
/// A contact that is moved back and forth until every cycle repeats the one before it. Nothing is stored.
#[schema(example = json!({
    "contact": ContactDefinition::example(),
    "drive": {"displacement": [5e-8, 1e-7, 2e-7]},
    "harmonics": 3
}))]
pub struct CycleRequest {
    /// The contact.
    pub contact: ContactDefinition,
    /// What is prescribed as a cosine, and its amplitudes.
    pub drive: CycleDrive,
    /// Frequency, Hz, or a list of frequencies with the cycles of all amplitudes for each: of bodies with `prony`,
    /// whose cycles depend on it. The load has then been held for long: the normal force of a preload, or its
    /// indentation. Only a displacement is driven, and of the other options only `harmonics` is allowed. At most 100
    /// 000 cycles.
    #[schema(value_type = Option<f64>)]
    pub frequency: Option<Amplitudes> = Within(FREQUENCIES, FREQUENCY),
    /// A machine in series with the contact: an amplitude of displacement or twist is then that of the machine.
    pub machine: Option<Machine>,
    /// Ask for the harmonics from the first to this one.
    pub harmonics: Option<usize> = HARMONICS,
    /// Ask for the friction work per area. Radii times amplitudes are at most 200 000. Not with `normal`.
    pub work_density: Option<WorkDensity>,
    /// The normal load oscillates too, about that of the contact.
    pub normal: Option<NormalOscillation>,
    /// Tolerance, a pure number: of cycles with `normal` relative to μ F_N and to the work of that force, of
    /// `frequency_response` relative to the amplitude.
    pub tolerance: Option<f64> = Tolerance(DEFAULT_TOLERANCE),
    /// Ask for the oscillations of a mass that only the contact holds and a force drives. Not with `machine` or
    /// `normal`.
    pub frequency_response: Option<FrequencyResponse>,
    /// Ask for the normal force under which each amplitude does the most friction work; with at most 100 amplitudes,
    /// not with `normal`.
    pub best_load: Option<BestLoadStudy>,
    /// Repeat all amplitudes under many loads, whatever the preload of the contact: a fretting map. Of the other
    /// options only `machine` is allowed. At most 100 000 cycles.
    pub map: Option<FrettingMap>,
}

/// A machine in series with the contact.
pub struct Machine: Copy {
    /// Its stiffness, N/m; with `twist` or `torque` N·m/rad.
    pub stiffness: f64 = range::MACHINE_STIFFNESS,
}

/// Where the friction work per area is asked for: exactly one of `points` and `radii` (for a line contact `x`).
pub struct WorkDensity: Default {
    /// Number of radii, evenly spaced from the centre to the edge of the contact, both included; for a line contact
    /// from the edge at −a to the edge at a.
    pub points: Option<usize> = STRESS_POINTS,
    /// Radii, m; outside the contact there is no work.
    pub radii: Option<Vec<f64>> = STRESS_RADII,
    /// Places along x in a line contact, m.
    pub x: Option<Vec<f64>> = STRESS_PLACES,
}
}

choices! {
/// What is prescribed as a cosine, one key: its amplitude, or a list of amplitudes with a cycle for each.
pub enum CycleDrive {
    /// Amplitude of the tangential displacement, m: of the indenter or, with `machine`, of the machine.
    #[schema(value_type = f64)]
    "displacement" => Displacement(Amplitudes) = Within(CYCLE_AMPLITUDES, Range { min: 0.0, ..range::DISPLACEMENT }),
    /// Amplitude of the tangential force, N; below μ F_N.
    #[schema(value_type = f64)]
    "force" => Force(Amplitudes) = Within(CYCLE_AMPLITUDES, Range { min: 0.0, ..range::FORCE }),
    /// Amplitude of the angle of twist, rad: of the indenter or, with `machine`, of the machine.
    #[schema(value_type = f64)]
    "twist" => Twist(Amplitudes) = Within(CYCLE_AMPLITUDES, Range { min: 0.0, ..range::TWIST }),
    /// Amplitude of the torque, N·m; below that of gross slip.
    #[schema(value_type = f64)]
    "torque" => Torque(Amplitudes) = Within(CYCLE_AMPLITUDES, Range { min: 0.0, ..range::TORQUE }),
}
}

/// One amplitude, or a list of them.
pub type Amplitudes = NumberOr<Vec<f64>>;

impl Numbers for Vec<f64> {
    const EXPECTED: &'static str = "a number or an array of numbers";
}

/// What a study says of a cycle by twist.
const NO_TWIST: &str = "not available for a twist: leave this out";
/// Frequencies of a list.
const FREQUENCIES: RangeInclusive<usize> = 1..=1_000;

/// The limits of a number, and of a list of so many.
struct Within(RangeInclusive<usize>, Range);

impl Limit<Amplitudes> for Within {
    fn keywords(&self) -> Value {
        // Some keywords are for a number, the others for a list: JSON Schema applies each to its own type.
        let mut keywords = Limit::<Vec<f64>>::keywords(&Array(self.0.clone(), self.1));
        keywords["type"] = json!(["number", "array"]);
        keywords["items"]["type"] = json!("number");
        (keywords["minimum"], keywords["maximum"]) = (json!(self.1.min), json!(self.1.max));
        keywords
    }

    fn check(&self, value: &Amplitudes, at: JsonPath<'_>, faults: &mut Faults) {
        match value {
            Amplitudes::One(amplitude) => faults.number(at, *amplitude, &self.1),
            Amplitudes::Many(amplitudes) => Array(self.0.clone(), self.1).check(amplitudes, at, faults),
        }
    }
}

impl Amplitudes {
    /// The amplitudes.
    pub fn all(&self) -> &[f64] {
        match self {
            Amplitudes::One(amplitude) => std::slice::from_ref(amplitude),
            Amplitudes::Many(amplitudes) => amplitudes,
        }
    }
}

impl CycleDrive {
    /// Its amplitudes.
    pub fn amplitudes(&self) -> &Amplitudes {
        match self {
            CycleDrive::Displacement(amplitudes)
            | CycleDrive::Force(amplitudes)
            | CycleDrive::Twist(amplitudes)
            | CycleDrive::Torque(amplitudes) => amplitudes,
        }
    }

    /// Its name.
    pub fn name(&self) -> &'static str {
        match self {
            CycleDrive::Displacement(_) => "displacement",
            CycleDrive::Force(_) => "force",
            CycleDrive::Twist(_) => "twist",
            CycleDrive::Torque(_) => "torque",
        }
    }
}

/// Checked options.
#[derive(Clone, Debug)]
pub struct CycleTask {
    drive: CycleDrive,
    /// The stiffness of the machine, N/m, if there is one.
    pub stiffness: Option<f64>,
    /// The number of harmonics; zero if none are asked for.
    pub harmonics: usize,
    /// Where the friction work per area is asked for.
    pub density: Option<StressRequest>,
    /// A load that oscillates, with the tolerance.
    pub normal: Option<(OscillatingLoad, f64)>,
    /// A mass on the contact, with the tolerance.
    pub response: Option<(FrequencyResponse, f64)>,
    /// The best load of each amplitude.
    pub best_load: Option<BestLoadStudy>,
    /// The loads of a fretting map.
    pub map: Option<FrettingMap>,
    /// The frequencies, Hz, of bodies with memory; empty for elastic bodies.
    pub frequencies: Vec<f64>,
    /// JSON pointer to the drive.
    drive_at: &'static str,
}

impl CycleTask {
    /// The checked options of a query, whose parameters are a machine's stiffness, N/m, and the members of the others.
    pub fn of_query(
        drive: CycleDrive,
        stiffness: Option<f64>,
        harmonics: Option<usize>,
        density: Option<WorkDensity>,
        faults: &mut Faults,
    ) -> Option<CycleTask> {
        let at = JsonPath::Root;
        drive.check_limits(at, faults);
        Limit::check(&range::MACHINE_STIFFNESS, &stiffness, at.member("machine_stiffness"), faults);
        Limit::check(&HARMONICS, &harmonics, at.member("harmonics"), faults);
        density.check_limits(at, faults);
        let twists = matches!(drive, CycleDrive::Twist(_) | CycleDrive::Torque(_));
        if let Some(density) = density.as_ref().filter(|_| twists) {
            let given = [("points", density.points.is_some()), ("radii", density.radii.is_some())];
            let name = given.into_iter().find_map(|(name, is_given)| is_given.then_some(name)).unwrap_or("x");
            faults.add(at.member(name), NO_TWIST);
        }
        CycleTask::new((drive, ""), stiffness, harmonics, (density, ""), faults)
    }

    /// The checked options, of which some come with a JSON pointer to them.
    fn new(
        (drive, drive_at): (CycleDrive, &'static str),
        stiffness: Option<f64>,
        harmonics: Option<usize>,
        (density, density_at): (Option<WorkDensity>, &str),
        faults: &mut Faults,
    ) -> Option<CycleTask> {
        let at = JsonPath::Pointer(density_at);
        let density = match density {
            None => None,
            Some(WorkDensity { points, radii, x }) => {
                Some(StressRequest { points, radii, x, fields: None }.checked(at, faults)?)
            }
        };
        let (count, radii) = (drive.amplitudes().all().len(), density.as_ref().map_or(0, StressRequest::length));
        if count.saturating_mul(radii) > CYCLE_RADII {
            let detail =
                format_args!("{radii} radii at each of {count} amplitudes: allowed are {CYCLE_RADII} radii in all");
            faults.add(at, detail);
        }
        let harmonics = harmonics.unwrap_or(0);
        Some(CycleTask {
            drive,
            stiffness,
            harmonics,
            density,
            normal: None,
            response: None,
            best_load: None,
            map: None,
            frequencies: Vec::new(),
            drive_at,
        })
    }

    /// The drives, one for each cycle.
    pub fn drives(&self) -> impl ExactSizeIterator<Item = cycle::Drive> + '_ {
        let drive = match self.drive {
            CycleDrive::Displacement(_) | CycleDrive::Twist(_) => cycle::Drive::Displacement,
            CycleDrive::Force(_) | CycleDrive::Torque(_) => cycle::Drive::Force,
        };
        self.drive.amplitudes().all().iter().copied().map(drive)
    }

    /// How many cycles there are.
    pub fn rows(&self) -> usize {
        let times = self.map.map_or(1, |map| map.normal_force.count).saturating_mul(self.frequencies.len().max(1));
        self.drives().len().saturating_mul(times)
    }

    /// The JSON pointer to the amplitude of this index.
    pub fn place_of(&self, index: usize) -> String {
        let (base, name) = (self.drive_at, self.drive.name());
        match self.drive.amplitudes() {
            Amplitudes::One(_) => format!("{base}/{name}"),
            Amplitudes::Many(_) => format!("{base}/{name}/{index}"),
        }
    }

    /// Whether the force or the torque is driven.
    pub fn is_force_driven(&self) -> bool {
        matches!(self.drive, CycleDrive::Force(_) | CycleDrive::Torque(_))
    }

    /// Whether the contact is twisted.
    pub fn twists(&self) -> bool {
        matches!(self.drive, CycleDrive::Twist(_) | CycleDrive::Torque(_))
    }

    /// The first of the studies that know the friction of a displacement alone, if any is asked for.
    pub fn study_of_friction(&self) -> Option<&'static str> {
        let studies = [
            ("normal", self.normal.is_some()),
            ("frequency_response", self.response.is_some()),
            ("best_load", self.best_load.is_some()),
            ("map", self.map.is_some()),
            ("work_density", self.density.is_some()),
        ];
        studies.into_iter().find(|(_, asked)| *asked).map(|(name, _)| name)
    }

    /// How many radii there are for each cycle.
    pub fn radii(&self) -> usize {
        self.density.as_ref().map_or(0, StressRequest::length)
    }
}

impl Document for CycleRequest {
    type Checked = (ContactDefinition, FrictionSetup, CycleTask);

    fn profile(&self) -> Option<DefinedProfile<'_>> {
        Some(self.contact.defined_profile("/contact/profile"))
    }

    fn checked(self, profiles: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let CycleRequest { contact, drive, machine, harmonics, work_density, normal, tolerance, .. } = self;
        let (response, best_load, map) = (self.frequency_response, self.best_load, self.map);
        let setup = contact.check_any(JsonPath::Root.member("contact"), profiles, faults);
        let stiffness = machine.map(|machine| machine.stiffness);
        let task = CycleTask::new((drive, "/drive"), stiffness, harmonics, (work_density, "/work_density"), faults);
        let at = |name| JsonPath::Root.member(name);
        let others = [
            ("machine", stiffness.is_some()),
            ("work_density", task.as_ref().is_some_and(|task| task.radii() > 0)),
            ("normal", normal.is_some()),
            ("frequency_response", response.is_some()),
            ("best_load", best_load.is_some()),
            ("map", map.is_some()),
        ];
        check_memory(setup.as_ref(), self.frequency.as_ref(), (task.as_ref(), &others), faults);
        let tolerance = tolerance.unwrap_or(DEFAULT_TOLERANCE);
        let load = normal.and_then(|normal| normal.swing(at("normal"), faults));
        if best_load.is_some() && task.as_ref().is_some_and(|task| task.drives().len() > *BEST_LOADS.end()) {
            faults.add(at("best_load"), format_args!("too many amplitudes: at most {} allowed", BEST_LOADS.end()));
        }
        let constant = [
            ("work_density", task.as_ref().is_some_and(|task| task.radii() > 0)),
            ("frequency_response", response.is_some()),
            ("best_load", best_load.is_some()),
        ];
        for (name, _) in constant.into_iter().filter(|(_, asked)| *asked && normal.is_some()) {
            faults.add(at(name), "not available under an oscillating load: leave this or `normal` out");
        }
        if response.is_some() && stiffness.is_some() {
            faults.add(at("frequency_response"), "only the contact holds the mass: leave this or `machine` out");
        }
        if let Some(map) = &map {
            map.check(task.as_ref().map_or(0, |task| task.drives().len()), at("map"), faults);
            let others = [("harmonics", harmonics.is_some()), ("normal", normal.is_some())];
            for (name, _) in constant.into_iter().chain(others).filter(|(_, asked)| *asked) {
                faults.add(at(name), "not available in a fretting map: leave this or `map` out");
            }
        }
        if task.as_ref().is_some_and(|task| task.radii() > 0) {
            faults.needs_stress_field(setup.as_ref(), at("work_density"));
        }
        let normal = load.map(|load| (load, tolerance));
        let response = response.map(|response| (response, tolerance));
        let frequencies = self.frequency.map_or_else(Vec::new, |frequency| frequency.all().to_vec());
        let task = task.map(|task| CycleTask { normal, response, best_load, map, frequencies, ..task });
        let study = task.as_ref().and_then(CycleTask::study_of_friction);
        if let Some(setup) = setup.as_ref().filter(|setup| setup.friction.memory.is_none()) {
            let known = match study {
                Some(_) => setup.clone().coulomb("this study of cycles").err(),
                None => (setup.friction.limit.adhesion > 0.0).then_some(Error::Adhesive("`/cycle`")),
            };
            if let Some(error) = known {
                faults.unanswerable(at("contact").member(member_of_law(&error)), error);
            }
        }
        if let Some(study) = study.filter(|_| task.as_ref().is_some_and(CycleTask::twists)) {
            faults.add(at(study), NO_TWIST);
        }
        setup.zip(task).map(|(setup, task)| (contact, setup, task))
    }
}

/// Notes frequencies of elastic bodies, bodies with memory without one, and what their cycles do not have.
fn check_memory(
    setup: Option<&FrictionSetup>,
    frequency: Option<&Amplitudes>,
    (task, others): (Option<&CycleTask>, &[(&'static str, bool)]),
    faults: &mut Faults,
) {
    let (Some(setup), at) = (setup, |name| JsonPath::Root.member(name)) else { return };
    match (&setup.friction.memory, frequency) {
        (Some(_), None) => {
            faults.add(at("frequency"), "the cycles of bodies with memory depend on the frequency: give it, Hz");
        }
        (None, Some(_)) => {
            let detail = "elastic cycles depend on no frequency: leave this out, or give the contact `prony`";
            faults.add(at("frequency"), detail);
        }
        (None, None) => {}
        (Some(prony), Some(frequency)) => {
            if prony.is_fluid() {
                faults.unanswerable(at("contact").member("prony"), Error::FluidUnderLoad);
            }
            for (name, _) in others.iter().filter(|(_, asked)| *asked) {
                faults.add(at(name), format_args!("`{name}` is not available for bodies with memory: leave it out"));
            }
            let Some(task) = task else { return };
            if task.is_force_driven() || task.twists() {
                let detail = "not available for bodies with memory: drive the displacement, or follow a path in time";
                faults.add(at("drive").member(task.drive.name()), detail);
            }
            let (cycles, times) = (task.drives().len(), frequency.all().len());
            if cycles.saturating_mul(times) > MAP_CYCLES {
                let detail =
                    format_args!("{times} frequencies of {cycles} amplitudes: allowed are {MAP_CYCLES} cycles");
                faults.add(at("frequency"), detail);
            }
        }
    }
}
