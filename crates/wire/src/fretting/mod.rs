//! The body of `POST /fretting` and its reply: fatigue criteria over the stresses of a closed cycle.

mod life;
mod reply;

pub use life::{SnCurve, StrainLife, StrainLifeCurve, StressLife};
pub use reply::{BelowSurface, CRITERIA, FrettingReply, Instant, Largest, Life, NoLife, Rating, StressPath};

use stickslip_mechanics::fatigue::{self, Criterion, LifeCurve, Measure};
use stickslip_mechanics::subsurface::Side;

use crate::definition::of_body;
use crate::limits::{FRETTING_MOVES, SUBSURFACE_POINTS};
use crate::path::{PHASE, TimedPath};
use crate::prelude::*;
use crate::subsurface::{Places, SubsurfaceLine, SubsurfacePlane, SubsurfaceSurface, poisson_ratio};

/// Error of a criterion that is accepted if the request does not say, at given places and in a search.
const DEFAULT_TOLERANCE: f64 = 1e-4;
const SEARCH_TOLERANCE: f64 = 1e-3;

requests! {
/// A contact, a path that closes, and the fatigue criteria that its steady cycle is rated by. Nothing is stored.
/// Without `points`, `line`, `plane` and `surface` the largest value of each criterion in the body is searched for.
#[schema(example = json!({
    "contact": ContactDefinition::example(),
    "path": {"cycles": {"displacement": 1e-7, "count": 1}},
    "body": "first",
    "plane": {"normal": "y", "offset": 0.0, "x": [-1.2e-4, 1.2e-4, 25], "z": [0.0, 6e-5, 7]},
    "criteria": {"crossland": {"alpha": 0.3, "limit": 3e8}}
}))]
pub struct FrettingRequest {
    /// The contact.
    pub contact: ContactDefinition,
    /// A path of at most 200 moves that ends where it began, at least when it is repeated.
    pub path: TimedPath,
    /// The body that is rated.
    pub body: BodyName,
    /// Poisson's ratio of the body, a pure number; it may be left out if the material has `bodies`.
    pub poisson_ratio: Option<f64> = range::POISSON_RATIO,
    /// Where: a list of x, y, z, m, with z not negative.
    pub points: Option<Vec<[f64; 3]>> = Array(SUBSURFACE_POINTS, range::PLACE),
    /// Where: a straight line.
    pub line: Option<SubsurfaceLine>,
    /// Where: a grid in a plane.
    pub plane: Option<SubsurfacePlane>,
    /// Where: a grid on the surface.
    pub surface: Option<SubsurfaceSurface>,
    /// A normal stress of the body along x that varies with the cycle, mean + amplitude · cos(θ + phase), where θ grows
    /// from 0 to 360 degrees, by the same amount in each move.
    pub bulk: Option<BulkCycle>,
    /// The criteria.
    pub criteria: Criteria,
    /// The distance below the worst point of the surface at which criteria of stress are also evaluated.
    pub critical_distance: Option<CriticalDistance>,
    /// Indices of places for which to return the stresses over the cycle.
    pub stress_paths: Option<Vec<usize>> = PATHS,
    /// Accepted error of a criterion, relative to its largest value, a pure number. In a search the default is 1e-3.
    pub tolerance: Option<f64> = Tolerance(DEFAULT_TOLERANCE),
}

/// A bulk stress along x that varies with the cycle.
pub struct BulkCycle: Copy, Default {
    /// Its mean, Pa; zero if left out.
    pub mean: Option<f64> = range::BULK_STRESS,
    /// Its amplitude, Pa; zero if left out.
    pub amplitude: Option<f64> = range::BULK_STRESS,
    /// Its phase, degrees; zero if left out.
    pub phase: Option<f64> = PHASE,
}

/// The critical distance of the material (Taylor 2007).
pub struct CriticalDistance: Copy {
    /// The critical distance L_c, m: (threshold of the stress intensity range/range of the fatigue limit)²/π.
    pub length: f64 = range::CRITICAL_LENGTH,
    /// How the critical distance is used.
    pub method: CriticalMethod,
}

/// The criteria, at least one.
pub struct Criteria: Copy, Default {
    /// √J2a + α · the largest hydrostatic stress, Pa (Crossland 1956).
    pub crossland: Option<Weighted>,
    /// The largest of shear stress + α · hydrostatic stress, Pa (Dang Van 1973).
    pub dang_van: Option<Weighted>,
    /// The largest of shear amplitude + k · largest normal stress on a plane, Pa (Findley 1959).
    pub findley: Option<Findley>,
    /// The largest of normal stress times amplitude of the normal strain on a plane, Pa (Smith, Watson & Topper 1970).
    pub swt: Option<StrainBased>,
    /// The largest amplitude of the shear strain, raised by the normal stress, a pure number (Fatemi & Socie 1988).
    pub fatemi_socie: Option<FatemiSocie>,
    /// Shear stress times slip at the surface, N/m (Ruiz, Boddington & Chen 1984).
    pub ruiz: Option<SurfaceCriterion>,
    /// Friction work per area and cycle at the surface, J/m².
    pub friction_work: Option<SurfaceCriterion>,
}

/// A criterion with a weight of the hydrostatic stress.
pub struct Weighted: Copy {
    /// The weight, a pure number.
    pub alpha: f64 = range::FATIGUE_WEIGHT,
    /// The value that the material withstands, Pa.
    pub limit: Option<f64> = BEARABLE,
    /// Number of cycles that the material withstands, from tests.
    pub life: Option<StressLife>,
}

/// Findley's criterion.
pub struct Findley: Copy {
    /// The weight of the normal stress, a pure number.
    pub k: f64 = range::FATIGUE_WEIGHT,
    /// The value that the material withstands, Pa.
    pub limit: Option<f64> = BEARABLE,
    /// Number of cycles that the material withstands, from tests.
    pub life: Option<StressLife>,
}

/// A criterion that needs strains.
pub struct StrainBased: Copy, Default {
    /// Young's modulus of the body, Pa; it may be left out if the material has `bodies`.
    pub youngs_modulus: Option<f64> = range::YOUNGS_MODULUS,
    /// The value that the material withstands, Pa.
    pub limit: Option<f64> = BEARABLE,
    /// Number of cycles that the material withstands, from tests.
    pub life: Option<StrainLife>,
}

/// Fatemi and Socie's criterion.
pub struct FatemiSocie: Copy {
    /// The weight of the normal stress, a pure number.
    pub k: f64 = range::FATIGUE_WEIGHT,
    /// The yield stress, Pa.
    pub r#yield: f64 = range::YIELD_STRESS,
    /// Young's modulus of the body, Pa; it may be left out if the material has `bodies`.
    pub youngs_modulus: Option<f64> = range::YOUNGS_MODULUS,
    /// The value that the material withstands, a pure number.
    pub limit: Option<f64> = BEARABLE,
    /// Number of cycles that the material withstands, from tests.
    pub life: Option<StrainLife>,
}

/// A quantity that is defined on the surface.
pub struct SurfaceCriterion: Copy, Default {
    /// The value that the material withstands.
    pub limit: Option<f64> = BEARABLE,
    /// Number of cycles that the material withstands, from tests.
    pub life: Option<StressLife>,
}
}

words! {
/// How a critical distance L_c is used along the inward normal.
pub enum CriticalMethod {
    /// The stress at the depth L_c/2.
    Point = "point",
    /// At each instant the mean stress over the depth 2 L_c.
    Line = "line",
}
}

/// Which stresses over the cycle may be asked for.
const PATHS: Array<RangeInclusive<usize>> = Array(0..=100, 0..=*SUBSURFACE_POINTS.end() - 1);
/// A value that a material bears.
const BEARABLE: Range = Range { quantity: Quantity::Number, unit: "", min: 1e-300, max: 1e30 };

/// The criterion to compute, and the limit and life of the material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AskedMeasure {
    /// What is computed.
    pub measure: Measure,
    /// The value that the material withstands.
    pub limit: Option<f64>,
    /// The cycles that the material withstands.
    pub life: Option<LifeCurve>,
}

/// A checked request.
#[derive(Clone, Debug)]
pub struct FrettingTask {
    /// The path.
    pub plan: Plan,
    /// The body and its Poisson's ratio.
    pub body: (Side, f64),
    /// Where; none for a search.
    pub places: Places,
    /// The bulk stress.
    pub bulk: Option<fatigue::Bulk>,
    /// What is computed, by the order of the reply.
    pub measures: [Option<AskedMeasure>; 8],
    /// Where below the surface criteria of stress are evaluated too.
    pub critical_distance: Option<fatigue::CriticalDistance>,
    /// Places whose stresses over the cycle are asked for.
    pub stress_paths: Vec<usize>,
    /// The error that is accepted.
    pub tolerance: f64,
}

impl FrettingTask {
    /// Whether the body is searched for the largest values.
    pub fn searches(&self) -> bool {
        self.places.count() == 0
    }

    /// How many criteria search for a critical plane.
    pub fn planes(&self) -> usize {
        use Criterion::{FatemiSocie, Findley, SmithWatsonTopper};
        let has_plane = |asked: &&AskedMeasure| {
            matches!(asked.measure, Measure::Stress(Findley { .. } | SmithWatsonTopper { .. } | FatemiSocie { .. }))
        };
        self.measures.iter().flatten().filter(has_plane).count()
    }
}

impl Document for FrettingRequest {
    type Checked = (ContactDefinition, SharedSetup, FrettingTask);

    fn profile(&self) -> Option<DefinedProfile<'_>> {
        Some(self.contact.defined_profile("/contact/profile"))
    }

    fn checked(self, profiles: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let at = |name| JsonPath::Root.member(name);
        let setup = self.contact.check(at("contact"), profiles, faults);
        faults.needs_stress_field(setup.as_ref(), at("contact").member("profile"));
        let plan = self.path.check(at("path"), faults);
        if let Some(Plan::Timed(..)) = &plan {
            faults.unanswerable(at("path").member("duration"), Error::NoMemory);
        }
        if let Some(plan) = &plan {
            if plan.twists() {
                faults.add(at("path"), "cycles are rated along the surface, without a twist");
            }
            let most = *FRETTING_MOVES.end();
            if plan.length() > most {
                faults.add(at("path"), format_args!("{} moves: at most {most} can be rated", plan.length()));
            }
        }
        let searches = self.points.is_none() && self.line.is_none() && self.plane.is_none() && self.surface.is_none();
        let default = if searches { SEARCH_TOLERANCE } else { DEFAULT_TOLERANCE };
        let bulk = self.bulk.map(|bulk| {
            let [mean, amplitude, phase] = [bulk.mean, bulk.amplitude, bulk.phase].map(|part| part.unwrap_or(0.0));
            fatigue::Bulk { mean, amplitude, phase: phase.to_radians() }
        });
        let places = if searches {
            Some(Places::Points(Vec::new()))
        } else {
            Places::of(self.points, self.line, self.plane, self.surface, JsonPath::Root, faults)
        };
        let poisson = poisson_ratio(self.body, self.poisson_ratio, &self.contact, JsonPath::Root, faults);
        let youngs_modulus = self.contact.material.youngs_modulus(self.body);
        let constants = (youngs_modulus, poisson.unwrap_or(0.0));
        let measures = self.criteria.check(constants, at("criteria"), faults);
        let stress_paths = self.stress_paths.unwrap_or_default();
        if let Some(places) = &places {
            if (0..places.count()).any(|index| places.at(index)[2] != 0.0) {
                self.criteria.refuse_below("ask for places with z = 0, or leave this out", at("criteria"), faults);
            }
            if self.critical_distance.is_some() {
                self.criteria.refuse_below("leave this or `critical_distance` out", at("criteria"), faults);
                if !searches && (0..places.count()).all(|index| places.at(index)[2] > 0.0) {
                    let detail = "starts from the surface: ask for a place with z = 0, or for no places, to search";
                    faults.add(at("critical_distance"), detail);
                }
            }
            for (index, place) in stress_paths.iter().enumerate() {
                if searches {
                    let detail = "a search has no list of places: give one, or leave `stress_paths` out";
                    faults.add(at("stress_paths").index(index), detail);
                } else if *place >= places.count() {
                    let most = places.count().saturating_sub(1);
                    let detail = format_args!("place {place} is not in the list: the last is {most}");
                    faults.add(at("stress_paths").index(index), detail);
                }
            }
        }
        let task = plan.zip(places).zip(poisson).map(|((plan, places), poisson)| FrettingTask {
            plan,
            body: (self.body.into(), poisson),
            places,
            bulk,
            measures,
            critical_distance: self.critical_distance.map(|CriticalDistance { length, method }| match method {
                CriticalMethod::Point => fatigue::CriticalDistance::Point(length),
                CriticalMethod::Line => fatigue::CriticalDistance::Line(length),
            }),
            stress_paths,
            tolerance: self.tolerance.unwrap_or(default),
        });
        setup.zip(task).map(|(setup, task)| (self.contact, setup, task))
    }
}

impl Criteria {
    /// What they compute in a body, whose Young's modulus may be unknown, with limits.
    fn check(
        &self,
        (youngs_modulus, poisson): (Option<f64>, f64),
        at: JsonPath<'_>,
        faults: &mut Faults,
    ) -> [Option<AskedMeasure>; 8] {
        if *self == Criteria::default() {
            // Ruiz's second parameter comes with the first.
            let names = CRITERIA.into_iter().filter(|(name, ..)| *name != "ruiz_tension");
            let names: Vec<String> = names.map(|(name, ..)| format!("`{name}`")).collect();
            faults.add(at, format_args!("empty: give at least one of {}", names.join(", ")));
        }
        let modulus = |given: Option<f64>, name: &str, faults: &mut Faults| {
            let missing = "give the body's `youngs_modulus`: this criterion needs the moduli of both bodies";
            let place = at.member(name);
            of_body(youngs_modulus, given, missing, place.member("youngs_modulus"), faults).unwrap_or(1.0)
        };
        let of = |measure, limit, life: Option<StressLife>| AskedMeasure {
            measure,
            limit,
            life: life.and_then(StressLife::curve),
        };
        let stress = |criterion, limit, life| of(Measure::Stress(criterion), limit, life);
        let strain = |criterion, limit, life| AskedMeasure { measure: Measure::Stress(criterion), limit, life };
        [
            self.crossland.map(|asked| stress(Criterion::Crossland { alpha: asked.alpha }, asked.limit, asked.life)),
            self.dang_van.map(|asked| stress(Criterion::DangVan { alpha: asked.alpha }, asked.limit, asked.life)),
            self.findley.map(|asked| stress(Criterion::Findley { k: asked.k }, asked.limit, asked.life)),
            self.swt.map(|asked| {
                let youngs_modulus = modulus(asked.youngs_modulus, "swt", faults);
                let of_strain = |curve: &_| LifeCurve::smith_watson_topper(curve, youngs_modulus);
                let life = asked.life.and_then(|life| life.curve(of_strain));
                strain(Criterion::SmithWatsonTopper { youngs_modulus, poisson }, asked.limit, life)
            }),
            self.fatemi_socie.map(|asked| {
                let youngs_modulus = modulus(asked.youngs_modulus, "fatemi_socie", faults);
                let of_strain = |curve: &_| LifeCurve::fatemi_socie(curve, youngs_modulus, poisson);
                let life = asked.life.and_then(|life| life.curve(of_strain));
                let FatemiSocie { k, r#yield: yield_stress, limit, .. } = asked;
                strain(Criterion::FatemiSocie { k, yield_stress, youngs_modulus, poisson }, limit, life)
            }),
            self.ruiz.map(|asked| of(Measure::Ruiz, asked.limit, asked.life)),
            self.ruiz.map(|_| of(Measure::RuizTension, None, None)),
            self.friction_work.map(|asked| of(Measure::FrictionWork, asked.limit, asked.life)),
        ]
    }

    /// Notes the criteria of the surface that are asked for below it.
    fn refuse_below(&self, advice: &str, at: JsonPath<'_>, faults: &mut Faults) {
        let of_surface = [("ruiz", self.ruiz.is_some()), ("friction_work", self.friction_work.is_some())];
        for (name, _) in of_surface.into_iter().filter(|(_, asked)| *asked) {
            faults.add(at.member(name), format_args!("is defined on the surface only: {advice}"));
        }
    }
}
