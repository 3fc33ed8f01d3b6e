//! The body of `POST /fretting` and its reply: fatigue criteria over the stresses of a closed cycle.

mod reply;

pub use reply::{FrettingReply, Instant, Largest, Rating, StressPath};

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};
use serde_with::{apply, skip_serializing_none};
use utoipa::ToSchema;

use stickslip_mechanics::fatigue::{self, Criterion, Measure};
use stickslip_mechanics::range::{self, Quantity, Range};
use stickslip_mechanics::subsurface::Side;

use crate::check::{Faults, JsonPath, Rejection};
use crate::definition::{BodyName, ContactDefinition, DefinedProfile, SharedSetup};
use crate::document::Document;
use crate::limits::{
    Array, FRETTING_MOVES, Keywords, Limit, Limited, STRESS_PATHS, SUBSURFACE_POINTS, Tolerance, Triple, limits,
};
use crate::path::{PHASE, Path, Plan};
use crate::prepare::Prepare;
use crate::single_key::not_null;
use crate::subsurface::{Places, SubsurfaceLine, SubsurfacePlane, SubsurfaceRequest, SubsurfaceSurface};

/// Error of a criterion that is accepted if the request does not say, at given places and in a search.
const DEFAULT_TOLERANCE: f64 = 1e-4;
const SEARCH_TOLERANCE: f64 = 1e-3;

/// A contact, a path that closes, and the fatigue criteria that its steady cycle is rated by; the server keeps nothing
/// of it. Without `points`, `line`, `plane` and `surface` the largest value of each criterion in the body is searched
/// for.
#[skip_serializing_none]
#[apply(Option => #[serde(default, deserialize_with = "not_null")] #[schema(nullable = false)])]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
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
    pub path: Path,
    /// Which body.
    pub body: BodyName,
    /// Its Poisson's ratio, a pure number. Where the material has `bodies` it is known, and may be left out.
    pub poisson_ratio: Option<f64>,
    /// Where: a list of x, y, z, m, with z of at least zero.
    pub points: Option<Vec<[f64; 3]>>,
    /// Where: a straight line.
    pub line: Option<SubsurfaceLine>,
    /// Where: a grid in a plane.
    pub plane: Option<SubsurfacePlane>,
    /// Where: a grid on the surface.
    pub surface: Option<SubsurfaceSurface>,
    /// A normal stress of the body along x that goes with the cycle, mean + amplitude · cos(th + phase), where th
    /// grows from 0 to 360 degrees, by as much in each move.
    pub bulk: Option<BulkCycle>,
    /// The criteria.
    pub criteria: Criteria,
    /// Indices of places whose stresses over the cycle are wanted too.
    pub stress_paths: Option<Vec<usize>>,
    /// Error of a criterion, relative to its largest value, that is accepted; a pure number. In a search it is 1e-3 if
    /// left out.
    pub tolerance: Option<f64>,
}
limits!(FrettingRequest {
    poisson_ratio: range::POISSON_RATIO,
    points: Array(SUBSURFACE_POINTS, Triple(range::PLACE)),
    stress_paths: PATHS,
    tolerance: Tolerance(DEFAULT_TOLERANCE),
});
/// Which stresses over the cycle may be asked for.
const PATHS: Array<RangeInclusive<usize>> = Array(STRESS_PATHS, 0..=*SUBSURFACE_POINTS.end() - 1);
/// A value that a material bears.
const BEARABLE: Range = Range { quantity: Quantity::Number, unit: "", min: 1e-300, max: 1e30 };

/// A bulk stress along x that goes with the cycle.
#[skip_serializing_none]
#[apply(Option => #[serde(default, deserialize_with = "not_null")] #[schema(nullable = false)])]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct BulkCycle {
    /// Its mean, Pa; zero if left out.
    pub mean: Option<f64>,
    /// Its amplitude, Pa; zero if left out.
    pub amplitude: Option<f64>,
    /// Its phase, degrees; zero if left out.
    pub phase: Option<f64>,
}
limits!(BulkCycle { mean: range::BULK_STRESS, amplitude: range::BULK_STRESS, phase: PHASE });

/// Which criteria, at least one.
#[skip_serializing_none]
#[apply(Option => #[serde(default, deserialize_with = "not_null")] #[schema(nullable = false)])]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Criteria {
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
#[skip_serializing_none]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Weighted {
    /// The weight, a pure number.
    pub alpha: f64,
    /// The value that the material bears, Pa.
    #[serde(default, deserialize_with = "not_null")]
    #[schema(nullable = false)]
    pub limit: Option<f64>,
}
limits!(Weighted { alpha: range::FATIGUE_WEIGHT, limit: BEARABLE });

/// Findley's criterion.
#[skip_serializing_none]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Findley {
    /// The weight of the normal stress, a pure number.
    pub k: f64,
    /// The value that the material bears, Pa.
    #[serde(default, deserialize_with = "not_null")]
    #[schema(nullable = false)]
    pub limit: Option<f64>,
}
limits!(Findley { k: range::FATIGUE_WEIGHT, limit: BEARABLE });

/// A criterion that needs strains.
#[skip_serializing_none]
#[apply(Option => #[serde(default, deserialize_with = "not_null")] #[schema(nullable = false)])]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct StrainBased {
    /// Young's modulus of the body, Pa. Where the material has `bodies` it is known, and may be left out.
    pub youngs_modulus: Option<f64>,
    /// The value that the material bears, Pa.
    pub limit: Option<f64>,
}
limits!(StrainBased { youngs_modulus: range::YOUNGS_MODULUS, limit: BEARABLE });

/// Fatemi and Socie's criterion.
#[skip_serializing_none]
#[apply(Option => #[serde(default, deserialize_with = "not_null")] #[schema(nullable = false)])]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct FatemiSocie {
    /// The weight of the normal stress, a pure number.
    pub k: f64,
    /// The yield stress, Pa.
    #[serde(rename = "yield")]
    pub yield_stress: f64,
    /// Young's modulus of the body, Pa. Where the material has `bodies` it is known, and may be left out.
    pub youngs_modulus: Option<f64>,
    /// The value that the material bears, a pure number.
    pub limit: Option<f64>,
}

impl FatemiSocie {
    fn members(&self) -> [(&'static str, Option<f64>, Range); 4] {
        [
            ("k", Some(self.k), range::FATIGUE_WEIGHT),
            ("yield", Some(self.yield_stress), range::YIELD_STRESS),
            ("youngs_modulus", self.youngs_modulus, range::YOUNGS_MODULUS),
            ("limit", self.limit, BEARABLE),
        ]
    }
}

impl Limited for FatemiSocie {
    const SCHEMA: &'static str = "FatemiSocie";

    fn limits() -> Vec<(&'static str, serde_json::Value)> {
        let any = FatemiSocie { k: 0.0, yield_stress: 0.0, youngs_modulus: None, limit: None };
        any.members().map(|(name, _, range)| (name, range.keywords())).into()
    }
}

/// A quantity of the surface.
#[skip_serializing_none]
#[apply(Option => #[serde(default, deserialize_with = "not_null")] #[schema(nullable = false)])]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct SurfaceCriterion {
    /// The value that the material bears.
    pub limit: Option<f64>,
}
limits!(SurfaceCriterion { limit: BEARABLE });

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
    /// The criteria of stress that are asked for, in the order of the reply, with their limits.
    pub criteria: [Option<(Criterion, Option<f64>)>; 5],
    /// Ruiz's parameters, with the limit of the first.
    pub ruiz: Option<SurfaceCriterion>,
    /// The friction work, with its limit.
    pub friction_work: Option<SurfaceCriterion>,
    /// Places whose stresses over the cycle are asked for.
    pub stress_paths: Vec<usize>,
    /// The error that is accepted.
    pub tolerance: f64,
}

impl FrettingTask {
    /// Whether the body is searched for the largest values.
    #[must_use]
    pub fn searches(&self) -> bool {
        self.places.count() == 0
    }

    /// How many criteria search for a critical plane.
    #[must_use]
    pub fn planes(&self) -> usize {
        let has_plane = |criterion: &Criterion| {
            use Criterion::{FatemiSocie, Findley, SmithWatsonTopper};
            matches!(criterion, Findley { .. } | SmithWatsonTopper { .. } | FatemiSocie { .. })
        };
        self.criteria.iter().flatten().filter(|(criterion, _)| has_plane(criterion)).count()
    }

    /// What is computed, with limits, by the order of the reply.
    #[must_use]
    pub fn measures(&self) -> [Option<(Measure, Option<f64>)>; 8] {
        let stress = |index: usize| self.criteria[index].map(|(criterion, limit)| (Measure::Stress(criterion), limit));
        let surface = |asked: Option<SurfaceCriterion>, measure| asked.map(|asked| (measure, asked.limit));
        [
            stress(0),
            stress(1),
            stress(2),
            stress(3),
            stress(4),
            surface(self.ruiz, Measure::Ruiz),
            self.ruiz.map(|_| (Measure::RuizTension, None)),
            surface(self.friction_work, Measure::FrictionWork),
        ]
    }
}

impl Document for FrettingRequest {
    type Checked = (ContactDefinition, SharedSetup, FrettingTask);

    fn profile(&self) -> Option<DefinedProfile<'_>> {
        Some(self.contact.defined_profile("/contact/profile"))
    }

    fn check_with(self, profiles: &dyn Prepare) -> Result<Self::Checked, Rejection> {
        let mut faults = Faults::default();
        let at = |name| JsonPath::Root.member(name);
        let setup = self.contact.check(at("contact"), profiles, &mut faults);
        faults.needs_stress_field(setup.as_ref(), at("contact").member("profile"));
        let plan = self.path.check(at("path"), &mut faults);
        if let Some(plan) = &plan {
            let most = *FRETTING_MOVES.end();
            if plan.length() > most {
                faults.add(at("path"), format_args!("{} moves: at most {most} can be rated", plan.length()));
            }
        }
        let searches = self.points.is_none() && self.line.is_none() && self.plane.is_none() && self.surface.is_none();
        let default = if searches { SEARCH_TOLERANCE } else { DEFAULT_TOLERANCE };
        let tolerance = Tolerance(default).of(self.tolerance, &mut faults);
        let bulk = self.bulk.map(|bulk| {
            bulk.check_members(at("bulk"), &mut faults);
            let [mean, amplitude, phase] = [bulk.mean, bulk.amplitude, bulk.phase].map(|part| part.unwrap_or(0.0));
            fatigue::Bulk { mean, amplitude, phase: phase.to_radians() }
        });
        let places = SubsurfaceRequest {
            body: self.body,
            poisson_ratio: self.poisson_ratio,
            // Any place: a search has none.
            points: if searches { Some(vec![[0.0; 3]]) } else { self.points },
            line: self.line,
            plane: self.plane,
            surface: self.surface,
            fields: None,
            bulk: None,
        };
        let mut asked = places.at(&self.contact, JsonPath::Root, &mut faults);
        if let Some(asked) = asked.as_mut().filter(|_| searches) {
            asked.places = Places::Points(Vec::new());
        }
        let youngs_modulus = self.contact.material.youngs_modulus(self.body);
        let poisson = asked.as_ref().map_or(0.0, |asked| asked.poisson_ratio);
        let criteria = self.criteria.check((youngs_modulus, poisson), at("criteria"), &mut faults);
        let stress_paths = self.stress_paths.unwrap_or_default();
        Limit::check(&PATHS, &stress_paths, at("stress_paths"), &mut faults);
        if let Some(asked) = &asked {
            self.criteria.check_surface(&asked.places, at("criteria"), &mut faults);
            for (index, place) in stress_paths.iter().enumerate() {
                if searches {
                    let detail = "a search finds its places itself: name them, or leave `stress_paths` out";
                    faults.add(at("stress_paths").index(index), detail);
                } else if *place >= asked.places.count() {
                    let most = asked.places.count().saturating_sub(1);
                    let detail = format_args!("there is no place {place}: the last is {most}");
                    faults.add(at("stress_paths").index(index), detail);
                }
            }
        }
        let task = plan.zip(asked).map(|(plan, asked)| FrettingTask {
            plan,
            body: (asked.side, asked.poisson_ratio),
            places: asked.places,
            bulk,
            criteria,
            ruiz: self.criteria.ruiz,
            friction_work: self.criteria.friction_work,
            stress_paths,
            tolerance,
        });
        faults.done(setup.zip(task).map(|(setup, task)| (self.contact, setup, task)))
    }
}

impl Criteria {
    /// The criteria of stress for a body, whose Young's modulus may be unknown.
    fn check(
        &self,
        (youngs_modulus, poisson): (Option<f64>, f64),
        at: JsonPath<'_>,
        faults: &mut Faults,
    ) -> [Option<(Criterion, Option<f64>)>; 5] {
        if *self == Criteria::default() {
            let names = "`crossland`, `dang_van`, `findley`, `swt`, `fatemi_socie`, `ruiz`, `friction_work`";
            faults.add(at, format_args!("empty: give at least one of {names}"));
        }
        let modulus = |given: Option<f64>, name: &str, faults: &mut Faults| {
            let place = at.member(name);
            match (given, youngs_modulus) {
                (Some(given), Some(known)) if (given - known).abs() > 0.0 => {
                    let detail = format_args!("{given:?} contradicts the {known:?} of this body: leave this out");
                    faults.add(place.member("youngs_modulus"), detail);
                }
                (None, None) => {
                    let detail = "give the body's `youngs_modulus`: this criterion needs the moduli of both bodies";
                    faults.add(place.member("youngs_modulus"), detail);
                }
                _ => {}
            }
            given.or(youngs_modulus).unwrap_or(1.0)
        };
        if let Some(weighted) = &self.crossland {
            weighted.check_members(at.member("crossland"), faults);
        }
        if let Some(weighted) = &self.dang_van {
            weighted.check_members(at.member("dang_van"), faults);
        }
        if let Some(findley) = &self.findley {
            findley.check_members(at.member("findley"), faults);
        }
        if let Some(swt) = &self.swt {
            swt.check_members(at.member("swt"), faults);
        }
        if let Some(fatemi) = &self.fatemi_socie {
            let place = at.member("fatemi_socie");
            for (name, value, range) in fatemi.members() {
                Limit::check(&range, &value, place.member(name), faults);
            }
        }
        for (name, surface) in [("ruiz", &self.ruiz), ("friction_work", &self.friction_work)] {
            if let Some(surface) = surface {
                surface.check_members(at.member(name), faults);
            }
        }
        [
            self.crossland.map(|asked| (Criterion::Crossland { alpha: asked.alpha }, asked.limit)),
            self.dang_van.map(|asked| (Criterion::DangVan { alpha: asked.alpha }, asked.limit)),
            self.findley.map(|asked| (Criterion::Findley { k: asked.k }, asked.limit)),
            self.swt.map(|asked| {
                let youngs_modulus = modulus(asked.youngs_modulus, "swt", faults);
                (Criterion::SmithWatsonTopper { youngs_modulus, poisson }, asked.limit)
            }),
            self.fatemi_socie.map(|asked| {
                let youngs_modulus = modulus(asked.youngs_modulus, "fatemi_socie", faults);
                let FatemiSocie { k, yield_stress, limit, .. } = asked;
                (Criterion::FatemiSocie { k, yield_stress, youngs_modulus, poisson }, limit)
            }),
        ]
    }

    /// Notes the criteria of the surface that are asked for below it.
    fn check_surface(&self, places: &Places, at: JsonPath<'_>, faults: &mut Faults) {
        if (0..places.count()).all(|index| places.at(index)[2] == 0.0) {
            return;
        }
        for (name, asked) in [("ruiz", self.ruiz.is_some()), ("friction_work", self.friction_work.is_some())] {
            if asked {
                faults.add(at.member(name), "is of the surface: ask for places with z = 0, or leave this out");
            }
        }
    }
}
