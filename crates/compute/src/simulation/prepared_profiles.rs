//! Prepared profiles, which contacts and requests share: found by a digest of their numbers.

use std::any::Any;
use std::sync::Arc;
use std::time::Duration;

use sha2::{Digest as _, Sha256};
use stickslip_mechanics::Elasticity;
use stickslip_wire::DefinedProfile;
use stickslip_wire::profile::{SumProfile, TabulatedProfile};

use super::{check_parsed, cost_of_preparation};
use crate::documents::Parsed;
use crate::prelude::*;

/// The key of a prepared profile: a digest.
pub type ProfileKey = [u8; 32];

/// Where prepared profiles are kept, as long as there is room.
pub trait ProfileCache: Send + Sync {
    /// Whether a profile is kept.
    fn holds(&self, key: &ProfileKey) -> bool;

    /// A profile, for one more user.
    fn get(&self, key: &ProfileKey) -> Option<Arc<Profile>>;

    /// Keeps a profile of this many bytes that has just been prepared, unless one with this key is kept already;
    /// returns the profile to use.
    fn keep(&self, key: ProfileKey, profile: Arc<Profile>, bytes: usize) -> Arc<Profile>;
}

/// The shared profiles, for work that ends when its flag is raised.
#[derive(Clone)]
pub struct Profiles<S> {
    cache: Arc<dyn ProfileCache>,
    stop: S,
    /// How long preparing one may take.
    allowed: Duration,
}

impl<S: Stop> Profiles<S> {
    /// Those that are kept there.
    pub fn new(cache: Arc<dyn ProfileCache>, stop: S, allowed: Duration) -> Profiles<S> {
        Profiles { cache, stop, allowed }
    }

    /// The cost of preparing the profile of a document: zero if it is cached.
    ///
    /// # Errors
    /// [`Cause::Preparation`](super::Cause) if it cannot end in time.
    pub fn cost(&self, document: &dyn Parsed) -> Result<Nanoseconds, Failure> {
        document.profile().map_or(Ok(0), |defined| self.cost_of(&defined))
    }

    /// The same for a profile.
    ///
    /// # Errors
    /// As [`Profiles::cost`].
    pub fn cost_of(&self, defined: &DefinedProfile<'_>) -> Result<Nanoseconds, Failure> {
        if defined.profile.points() == 0
            || self.cache.holds(&key_of(defined.profile, defined.material.elasticity().as_ref()))
        {
            return Ok(0);
        }
        cost_of_preparation(defined, self.allowed)
    }

    /// Checks a document, and has the flag count the time that it takes.
    ///
    /// # Errors
    /// As [`check_parsed`].
    pub fn check(&self, document: Box<dyn Parsed>) -> Result<Result<Box<dyn Any + Send>, Rejection>, Failure> {
        check_parsed(document, self, &self.stop)
    }
}

impl<S: Stop> Prepare for Profiles<S> {
    fn profile(
        &self,
        document: &wire::Profile,
        bodies: Option<&Elasticity>,
        prepare: &mut dyn FnMut() -> Option<Profile>,
    ) -> Option<Arc<Profile>> {
        if document.points() == 0 {
            return prepare().map(Arc::new);
        }
        let key = key_of(document, bodies);
        self.cache.get(&key).or_else(|| Some(self.cache.keep(key, Arc::new(prepare()?), bytes::of_shape(document))))
    }

    fn keep_going(&self) -> bool {
        self.stop.check().is_ok()
    }
}

/// What distinguishes profiles: all their numbers, and the moduli where they belong to bodies.
fn key_of(profile: &wire::Profile, bodies: Option<&Elasticity>) -> ProfileKey {
    let mut hash = Sha256::new();
    add(profile, &mut hash);
    if let Some(bodies) = bodies.filter(|_| profile.depends_on_bodies()) {
        add_column("bodies", &[bodies.e_star(), bodies.g_star()], &mut hash);
    }
    hash.finalize().into()
}

fn add(profile: &wire::Profile, hash: &mut Sha256) {
    match profile {
        wire::Profile::Tabulated(TabulatedProfile { r, z, indentation_error, pressure_error }) => {
            add_column("r", r, hash);
            add_column("z", z, hash);
            for (name, errors) in [("indentation_error", indentation_error), ("pressure_error", pressure_error)] {
                errors.iter().for_each(|errors| add_column(name, errors, hash));
            }
        }
        wire::Profile::Sum(SumProfile { parts }) => {
            add_column("sum", &[parts.len() as f64], hash);
            parts.iter().for_each(|part| add(part, hash));
        }
        wire::Profile::Asperities(asperities) => {
            // Both, so that a profile that wrongly has both is no other one.
            add_column("radii", asperities.radii.as_deref().unwrap_or_default(), hash);
            add_column("radius", asperities.radius.as_slice(), hash);
            add_column("gaps", &asperities.gaps, hash);
        }
        wire::Profile::LoadCurve(curve) => {
            add_column("indentation", &curve.indentation, hash);
            add_column("normal_force", &curve.normal_force, hash);
        }
        // A few numbers with their names.
        other => hash.update(serde_json::to_vec(other).unwrap_or_default()),
    }
}

/// Adds a name, which no other kind of profile begins with, and numbers with how many they are.
fn add_column(name: &str, numbers: &[f64], hash: &mut Sha256) {
    hash.update(name);
    hash.update((numbers.len() as u64).to_le_bytes());
    hash.update(numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>());
}
