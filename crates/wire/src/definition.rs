//! The definition of a contact: profile, material, friction and preload.

use std::sync::Arc;

use stickslip_mechanics as mechanics;
use stickslip_mechanics::subsurface::Side;
use stickslip_mechanics::{Conduction, Friction, Law, Prony, Setup, elasticity};

use super::limits::count;
use super::line_profiles::BulkPerForce;
use crate::prelude::*;

requests! {
/// Two bodies pressed together, at rest and never moved tangentially.
#[schema(example = json!(ContactDefinition::example()))]
pub struct ContactDefinition {
    /// The shape of the indenter.
    pub profile: Profile,
    /// The elastic constants.
    pub material: Material,
    /// Coulomb's coefficient of friction μ, a pure number.
    pub friction: f64 = range::FRICTION,
    /// Shear strength τ₀ of the interface, Pa: shear stress stays below τ₀ + μp. Zero if left out; otherwise the load
    /// must stay constant from the first tangential move on.
    pub shear_strength: Option<f64> = range::SHEAR_STRENGTH,
    /// Adhesion of the JKR kind; only with `friction` 0. Load and preload may then pull.
    pub adhesion: Option<Adhesion>,
    /// The normal load that the contact starts with.
    pub preload: Preload,
    /// A bulk stress along x in proportion to the tangential force, which shifts the stick zone: only with a `cylinder`
    /// and under a constant load.
    pub bulk: Option<BulkPerForce>,
    /// The memory of the bodies, a Prony series of 1 to 16 terms: their moduli are those of the instant, and relax as
    /// R(t) = 1 − Σ ratio (1 − exp(−t/time)). Both bodies are alike, or one is rigid. The preload is put on at once at
    /// time 0, and moves have a `duration`.
    pub prony: Option<Vec<PronyTerm>> = Items(PRONY_TERMS),
}

/// A term of a Prony series.
#[schema(example = json!({"ratio": 0.5, "time": 0.1}))]
pub struct PronyTerm: Copy {
    /// By how much of the instantaneous modulus it relaxes, a pure number; all of them add up to 1 at most, which is a
    /// fluid.
    pub ratio: f64 = range::PRONY_RATIO,
    /// Its relaxation time, s.
    pub time: f64 = range::PRONY_TIME,
}

/// How two surfaces adhere (Johnson, Kendall & Roberts).
pub struct Adhesion: Copy {
    /// The work of adhesion w, J/m².
    pub work: f64 = range::ADHESION,
}

/// An isotropic, linearly elastic body.
pub struct ElasticBody {
    /// Young's modulus E, Pa.
    pub youngs_modulus: f64 = range::YOUNGS_MODULUS,
    /// Poisson's ratio ν, a pure number.
    pub poisson_ratio: f64 = range::POISSON_RATIO,
    /// Electrical resistivity ρ, Ω·m; of both bodies or of neither. The replies then have the electrical conductance of
    /// the contact.
    pub resistivity: Option<f64> = range::RESISTIVITY,
    /// Thermal conductivity k, W/(m·K); of both bodies or of neither. The replies then have the thermal conductance of
    /// the contact.
    pub conductivity: Option<f64> = range::CONDUCTIVITY,
}

/// The reduced moduli of the pair of bodies.
pub struct Effective {
    /// E*, Pa: 1/E* = Σ (1−νᵢ²)/Eᵢ.
    pub e_star: f64 = range::E_STAR,
    /// G*, Pa: 1/G* = Σ (2−νᵢ)/(4Gᵢ).
    pub g_star: f64 = range::G_STAR,
    /// G, Pa: 1/G = 1/G₁ + 1/G₂; only twist needs it.
    pub shear_modulus: Option<f64> = range::SHEAR_MODULUS,
    /// The two bodies on which the moduli were measured, if they are known. The contact has the moduli above; the
    /// stress below its surface, the fatigue criteria and the warnings use the constants of these bodies.
    pub bodies: Option<Vec<Body>> = BODIES,
}
}

/// A checked definition of Coulomb's law alone, whose profile copies and other contacts share.
pub type SharedSetup = Setup<Arc<mechanics::Profile>>;

/// The same under any limit of friction, of bodies with or without memory.
pub type FrictionSetup = Setup<Arc<mechanics::Profile>, Law>;

/// The profile of the contact that a document defines.
#[derive(Clone, Copy, Debug)]
pub struct DefinedProfile<'a> {
    /// JSON pointer to it.
    pub pointer: &'static str,
    /// The profile.
    pub profile: &'a Profile,
    /// The bodies that have it.
    pub material: &'a Material,
}

words! {
/// One of the two bodies in contact.
pub enum BodyName of Side {
    /// The body with the profile, which moves along x; the shear stress on its surface is −τ.
    First = "first",
    /// The plane body; the shear stress on its surface is +τ.
    Second = "second",
}
}

choices! {
/// The elastic constants, one key: the two bodies, or their reduced moduli.
pub enum Material {
    /// The two bodies in contact; one of them may be rigid.
    "bodies" => Bodies(Vec<Body>) = BODIES,
    /// The reduced moduli.
    "effective" => Effective(Effective),
}
}

/// One of the two bodies: its elastic constants, or the string `"rigid"`.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
#[serde(untagged)]
pub enum Body {
    /// An elastic body.
    Elastic(ElasticBody),
    /// A rigid body.
    Rigid(Rigid),
}

/// The name of a body that does not deform.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Rigid {
    /// It does not deform.
    Rigid,
}

/// How many terms a Prony series has.
pub(crate) const PRONY_TERMS: RangeInclusive<usize> = count(&range::PRONY_TERMS);
/// A range that adhesion reaches on the other side of zero as well: a definition without it is checked against the
/// range itself.
struct Pulling(Range);

impl Preload {
    /// Notes a preload that pulls, as it may where the bodies adhere.
    pub(crate) fn check_pressing(&self, at: JsonPath<'_>, faults: &mut Faults) {
        match self {
            Preload::NormalForce(force) => {
                Limit::check(&range::NORMAL_FORCE, force, at.member("normal_force"), faults);
            }
            Preload::Indentation(depth) => {
                Limit::check(&range::PRELOAD_INDENTATION, depth, at.member("indentation"), faults);
            }
            Preload::ContactRadius(_) => {}
        }
    }
}

impl Limit<f64> for Pulling {
    fn keywords(&self) -> Value {
        Limit::<f64>::keywords(&Range { min: -self.0.max, ..self.0 })
    }

    fn check(&self, value: &f64, at: JsonPath<'_>, faults: &mut Faults) {
        Limit::check(&Range { min: -self.0.max, ..self.0 }, value, at, faults);
    }
}

/// How many bodies there are.
const BODIES: Items = Items(2..=2);

choices! {
/// The normal load that the contact starts with, one key. Zero is a contact just touching.
pub enum Preload {
    /// Normal force, N; below zero only with `adhesion`.
    "normal_force" => NormalForce(f64) = Pulling(range::NORMAL_FORCE),
    /// Indentation, m; below zero only with `adhesion`.
    "indentation" => Indentation(f64) = Pulling(range::PRELOAD_INDENTATION),
    /// Contact radius, m.
    "contact_radius" => ContactRadius(f64) = range::CONTACT_RADIUS,
}
}

object_or_string!(
    Body: "an object with `youngs_modulus` and `poisson_ratio`, or the string \"rigid\"",
    ElasticBody => Elastic,
    "rigid" => Body::Rigid(Rigid::Rigid)
);

impl ContactDefinition {
    /// The contact of the examples in the OpenAPI document: a steel ball on a steel plane.
    pub fn example() -> Value {
        let steel = json!({"youngs_modulus": 2.1e11, "poisson_ratio": 0.3});
        json!({
            "profile": {"type": "sphere", "radius": 0.01},
            "material": {"bodies": [steel, steel]},
            "friction": 0.3,
            "preload": {"normal_force": 10.0}
        })
    }

    /// The profile, which is at this JSON pointer.
    pub fn defined_profile(&self, pointer: &'static str) -> DefinedProfile<'_> {
        DefinedProfile { pointer, profile: &self.profile, material: &self.material }
    }

    /// As [`ContactDefinition::check_any`], for what knows Coulomb's law alone.
    pub fn check(&self, at: JsonPath<'_>, profiles: &dyn Prepare, faults: &mut Faults) -> Option<SharedSetup> {
        let setup = self.check_any(at, profiles, faults)?;
        faults.of_law(setup.coulomb("this computation"), at)
    }

    /// As [`ContactDefinition::check_any`], for what knows elastic bodies and a shear strength, and no adhesion.
    pub fn check_limited(
        &self,
        at: JsonPath<'_>,
        profiles: &dyn Prepare,
        faults: &mut Faults,
    ) -> Option<FrictionSetup> {
        let setup = self.check_any(at, profiles, faults)?;
        let mut without = setup.clone();
        without.friction.limit.shear_strength = 0.0;
        faults.of_law(without.coulomb("this computation"), at).map(|_| setup)
    }

    /// The checked setup with its profile prepared by `profiles`; its faults are noted at `at`.
    pub fn check_any(&self, at: JsonPath<'_>, profiles: &dyn Prepare, faults: &mut Faults) -> Option<FrictionSetup> {
        // A load curve is one of certain bodies, whose own faults are noted after those of the profile.
        let (bodies, place) = (self.material.elasticity(), at.member("profile"));
        let profile = profiles.profile(&self.profile, bodies.as_ref(), &mut || {
            self.profile.check(bodies.as_ref(), place, &|| profiles.keep_going(), faults)
        });
        let elasticity = self.material.check(at.member("material"), faults);
        if matches!((&self.profile, &self.material), (Profile::Ellipsoid(_), Material::Effective(_))) {
            faults.add(at.member("material").member("effective"), mechanics::Error::BodiesNeeded);
        }
        let preload = (&self.preload).into();
        if self.adhesion.is_none() {
            self.preload.check_pressing(at.member("preload"), faults);
        }
        let (mut profile, elasticity) = (profile?, elasticity?);
        if let Some(bulk) = &self.bulk {
            profile = Arc::new(bulk.check(&profile, &self.material, at.member("bulk"), faults)?);
        }
        if faults.none_within(at).is_some()
            && let Err(error) = profile.prepare_for(&preload, &elasticity, &|| profiles.keep_going())
        {
            faults.unanswerable(place, error);
            return None;
        }
        let shear_strength = self.shear_strength.unwrap_or(0.0);
        let adhesion = self.adhesion.map_or(0.0, |adhesion| adhesion.work);
        let law = Law { limit: Friction { coefficient: self.friction, shear_strength, adhesion }, memory: None };
        let setup = Setup { profile, elasticity, friction: law, preload };
        match &self.prony {
            Some(terms) => self.check_memory(terms, setup, at.member("prony"), faults),
            None => Some(setup),
        }
    }

    /// The setup with the memory of its bodies.
    fn check_memory(
        &self,
        terms: &[PronyTerm],
        mut setup: FrictionSetup,
        at: JsonPath<'_>,
        faults: &mut Faults,
    ) -> Option<FrictionSetup> {
        let terms: Vec<mechanics::PronyTerm> =
            terms.iter().map(|&PronyTerm { ratio, time }| mechanics::PronyTerm { ratio, time }).collect();
        match Prony::new(&terms) {
            Ok(prony) => setup.friction.memory = Some(Arc::new(prony)),
            Err(error) => faults.unanswerable(at, error),
        }
        if let Some([Body::Elastic(first), Body::Elastic(second)]) = self.material.bodies()
            && (first.youngs_modulus.to_bits(), first.poisson_ratio.to_bits())
                != (second.youngs_modulus.to_bits(), second.poisson_ratio.to_bits())
        {
            faults.add(at, "both bodies relax alike: give them the same constants, or make one of them rigid");
        }
        if self.shear_strength.is_some_and(|strength| strength > 0.0) {
            faults.unanswerable(at, mechanics::Error::Viscoelastic("`shear_strength`"));
        }
        if self.adhesion.is_some() {
            faults.unanswerable(at, mechanics::Error::Viscoelastic("`adhesion`"));
        }
        faults.needs_round_contact(Some(&setup), at, "`prony`");
        faults.needs_stress_field(Some(&setup), at);
        faults.none_within(at)?;
        Some(setup)
    }

    /// The JSON pointer, in a definition with this preload, to the quantity that the mechanics refuses. A preload can
    /// be at fault by what follows from it, such as the indentation under a force.
    pub fn place_of(quantity: Quantity, preload: &mechanics::Preload) -> &'static str {
        match quantity {
            Quantity::Friction => "/friction",
            Quantity::ShearStrength => "/shear_strength",
            Quantity::PronyTerms | Quantity::PronyRatio | Quantity::PronyTime => "/prony",
            Quantity::Adhesion => "/adhesion/work",
            Quantity::NormalForce | Quantity::Indentation | Quantity::ContactRadius => match preload {
                mechanics::Preload::NormalForce(_) => "/preload/normal_force",
                mechanics::Preload::Indentation(_) => "/preload/indentation",
                mechanics::Preload::ContactRadius(_) => "/preload/contact_radius",
            },
            Quantity::EStar => "/material/effective/e_star",
            Quantity::GStar => "/material/effective/g_star",
            Quantity::ShearModulus => "/material/effective/shear_modulus",
            Quantity::YoungsModulus | Quantity::PoissonRatio => "/material/bodies",
            _ => "/profile",
        }
    }
}

impl Faults {
    /// The setup of a contact at this place, unless a computation does not know its law.
    fn of_law(&mut self, setup: Result<SharedSetup, mechanics::Error>, at: JsonPath<'_>) -> Option<SharedSetup> {
        setup.map_err(|error| self.unanswerable(at.member(member_of_law(&error)), error)).ok()
    }
}

/// The member that has what a computation does not know.
pub(crate) fn member_of_law(error: &mechanics::Error) -> &'static str {
    match error {
        mechanics::Error::Viscoelastic(_) => "prony",
        mechanics::Error::Adhesive(_) => "adhesion",
        _ => "shear_strength",
    }
}

impl Material {
    /// The two bodies, where they are known.
    pub fn bodies(&self) -> Option<&[Body]> {
        match self {
            Material::Bodies(bodies) => Some(bodies),
            Material::Effective(moduli) => moduli.bodies.as_deref(),
        }
    }

    /// Their elasticity, unless they are at fault.
    pub fn elasticity(&self) -> Option<elasticity::Elasticity> {
        self.check(JsonPath::Root, &mut Faults::default())
    }

    /// The two bodies in their order, where they are known: `None` among them is rigid.
    pub fn checked_bodies(&self) -> Option<[Option<elasticity::Body>; 2]> {
        let [first, second] = self.bodies()? else { return None };
        Some([first, second].map(|body| body.elastic().flatten()))
    }

    /// Whether the contact has a conductance.
    pub fn conducts(&self) -> bool {
        let conducts = |body: &Body| {
            matches!(
                body, Body::Elastic(body) if body.resistivity.is_some() || body.conductivity.is_some()
            )
        };
        self.bodies().is_some_and(|bodies| bodies.iter().any(conducts))
    }

    /// Young's modulus of one of the bodies, Pa, where it is known.
    pub fn youngs_modulus(&self, body: BodyName) -> Option<f64> {
        match self.bodies()?.get(usize::from(body == BodyName::Second))? {
            Body::Elastic(body) => Some(body.youngs_modulus),
            Body::Rigid(_) => None,
        }
    }

    pub(crate) fn check(&self, at: JsonPath<'_>, faults: &mut Faults) -> Option<elasticity::Elasticity> {
        match self {
            Material::Effective(moduli) => {
                let Effective { e_star, g_star, shear_modulus, bodies } = moduli;
                let elasticity = match bodies {
                    Some(bodies) => {
                        let at = at.member("effective");
                        check_bodies(bodies, at.member("bodies"), faults)?.with_moduli(*e_star, *g_star).ok()
                    }
                    None => elasticity::Elasticity::effective(*e_star, *g_star).ok(),
                };
                match shear_modulus {
                    Some(modulus) => elasticity?.with_shear_modulus(*modulus).ok(),
                    None => elasticity,
                }
            }
            Material::Bodies(bodies) => check_bodies(bodies, at.member("bodies"), faults),
        }
    }
}

fn check_bodies(bodies: &[Body], at: JsonPath<'_>, faults: &mut Faults) -> Option<elasticity::Elasticity> {
    let [first, second] = bodies else { return None };
    check_conduction([first, second], at, faults)?;
    match [first, second].map(Body::elastic) {
        [Some(first), Some(second)] => Some(elasticity::Elasticity::of_bodies(first?, second?)),
        [Some(body), None] | [None, Some(body)] => Some(elasticity::Elasticity::against_rigid(body?)),
        [None, None] => faults.refuse(at, "both bodies are rigid: one of them must be elastic"),
    }
}

/// Current and heat pass two bodies, so that what one of them says of itself the other must say too.
fn check_conduction(bodies: [&Body; 2], at: JsonPath<'_>, faults: &mut Faults) -> Option<()> {
    let given = |of: fn(&ElasticBody) -> Option<f64>| {
        bodies.map(|body| if let Body::Elastic(body) = body { of(body) } else { None }).map(|value| value.is_some())
    };
    let properties =
        [("resistivity", given(|body| body.resistivity)), ("conductivity", given(|body| body.conductivity))];
    for (name, given) in properties {
        let index = match given {
            [true, false] => 0,
            [false, true] => 1,
            _ => continue,
        };
        faults.add(at.index(index).member(name), "the other body has none: give it for both bodies or for neither");
    }
    faults.none_within(at)
}

/// The constant of a body as its material has it, or else the request. Noted at `at` if they differ or, with what is
/// `missing`, if neither has it.
pub(crate) fn of_body(
    known: Option<f64>,
    given: Option<f64>,
    missing: &str,
    at: JsonPath<'_>,
    faults: &mut Faults,
) -> Option<f64> {
    match (known, given) {
        (Some(known), Some(given)) if (known - given).abs() > 0.0 => {
            faults.refuse(at, format_args!("{given:?} contradicts the {known:?} of this body: leave this out"))
        }
        (None, None) => faults.refuse(at, missing),
        (known, given) => known.or(given),
    }
}

impl Body {
    /// It for the mechanics, unless it is rigid; none within for one that is out of its limits.
    fn elastic(&self) -> Option<Option<elasticity::Body>> {
        match self {
            Body::Elastic(ElasticBody { youngs_modulus, poisson_ratio, resistivity, conductivity }) => Some(
                elasticity::Body::new(*youngs_modulus, *poisson_ratio)
                    .and_then(|body| Ok(body.conducting(Conduction::new(*resistivity, *conductivity)?)))
                    .ok(),
            ),
            Body::Rigid(Rigid::Rigid) => None,
        }
    }
}

impl From<&Preload> for mechanics::Preload {
    fn from(preload: &Preload) -> mechanics::Preload {
        match *preload {
            Preload::NormalForce(force) => mechanics::Preload::NormalForce(force),
            Preload::Indentation(depth) => mechanics::Preload::Indentation(depth),
            Preload::ContactRadius(radius) => mechanics::Preload::ContactRadius(radius),
        }
    }
}
