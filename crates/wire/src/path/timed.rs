//! A path whose moves all take the same time: an object with the one key of the path, and `duration` beside it.

use std::borrow::Cow;
use std::fmt;

use serde::de::value::StringDeserializer;
use serde::de::{DeserializeSeed, Error as _, MapAccess, Visitor};
use serde::forward_to_deserialize_any;
use utoipa::PartialSchema;
use utoipa::openapi::schema::{Schema, SchemaFormat, Type};
use utoipa::openapi::{KnownFormat, ObjectBuilder, RefOr};

use crate::plane::SimulatedPath;
use crate::prelude::*;

/// The name of the member.
const DURATION: &str = "duration";

/// A path, and how long each of its moves takes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Timed<P> {
    /// The path.
    #[serde(flatten)]
    pub path: P,
    /// How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duration: Option<f64>,
}

/// A path along a line.
pub type TimedPath = Timed<Path>;
/// A path along a line or in the plane, or of a twist.
pub type TimedSimulatedPath = Timed<SimulatedPath>;

impl<P> From<P> for Timed<P> {
    fn from(path: P) -> Timed<P> {
        Timed { path, duration: None }
    }
}

impl From<Path> for Timed<SimulatedPath> {
    fn from(path: Path) -> Timed<SimulatedPath> {
        SimulatedPath::from(path).into()
    }
}

impl<P: ToSchema> ToSchema for Timed<P> {
    fn name() -> Cow<'static, str> {
        P::name()
    }

    fn schemas(schemas: &mut Vec<(String, RefOr<Schema>)>) {
        P::schemas(schemas);
    }
}

impl<P: PartialSchema> PartialSchema for Timed<P> {
    /// That of the path, each of whose alternatives may have the duration.
    fn schema() -> RefOr<Schema> {
        let mut schema = P::schema();
        if let RefOr::T(Schema::OneOf(choices)) = &mut schema {
            for choice in &mut choices.items {
                if let RefOr::T(Schema::Object(object)) = choice {
                    let about = "How long each move takes, s, unless it says so itself; at once if left out. Only of \
                                 bodies with `prony`.";
                    let double = Some(SchemaFormat::KnownFormat(KnownFormat::Double));
                    let number = ObjectBuilder::new().schema_type(Type::Number).format(double);
                    object.properties.insert(DURATION.to_owned(), number.description(Some(about)).into());
                }
            }
        }
        schema
    }
}

impl<P: Limited + ToSchema> Limited for Timed<P> {
    fn add_limits(found: &mut LimitsOfSchemas) {
        P::add_limits(found);
        if let Cow::Borrowed(name) = P::name() {
            let members = found.entry(name).or_default();
            if members.iter().all(|(member, _)| *member != DURATION) {
                members.push((DURATION, Limit::<f64>::keywords(&range::DURATION)));
            }
        }
    }

    fn check_limits(&self, at: JsonPath<'_>, faults: &mut Faults) {
        self.path.check_limits(at, faults);
        Limit::check(&range::DURATION, &self.duration, at.member(DURATION), faults);
    }
}

impl Timed<Path> {
    /// As [`Path::check`].
    pub fn check(self, at: JsonPath<'_>, faults: &mut Faults) -> Option<Plan> {
        let plan = self.path.check(at, faults);
        timed(plan?, self.duration, at, faults)
    }
}

impl Timed<SimulatedPath> {
    /// As [`SimulatedPath::check`].
    pub(crate) fn check(self, rings: bool, at: JsonPath<'_>, faults: &mut Faults) -> Option<Plan> {
        let plan = self.path.check(rings, at, faults);
        timed(plan?, self.duration, at, faults)
    }
}

/// The plan whose moves take this long.
fn timed(plan: Plan, duration: Option<f64>, at: JsonPath<'_>, faults: &mut Faults) -> Option<Plan> {
    let Some(duration) = duration else { return Some(plan) };
    let what = match &plan {
        Plan::EqualPeaks(_) => "`equal_peaks`",
        Plan::Plane(_) => "motion in the plane",
        Plan::Twist(_) | Plan::Torque(_) => "twist",
        _ => return Some(Plan::Timed(Box::new(plan), duration)),
    };
    faults.refuse(at.member(DURATION), Error::Viscoelastic(what))
}

/// A deserializer, a visitor or a map without the duration, which is kept.
struct Beside<'a, T> {
    inner: T,
    duration: &'a mut Option<f64>,
}

impl<'de, P: Deserialize<'de>> Deserialize<'de> for Timed<P> {
    fn deserialize<D: Deserializer<'de>>(inner: D) -> Result<Self, D::Error> {
        let mut duration = None;
        let path = P::deserialize(Beside { inner, duration: &mut duration })?;
        Ok(Timed { path, duration })
    }
}

impl<'de, D: Deserializer<'de>> Deserializer<'de> for Beside<'_, D> {
    type Error = D::Error;

    fn deserialize_any<V: Visitor<'de>>(self, inner: V) -> Result<V::Value, D::Error> {
        self.inner.deserialize_any(Beside { inner, duration: self.duration })
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map struct enum identifier ignored_any
    }
}

impl<'de, V: Visitor<'de>> Visitor<'de> for Beside<'_, V> {
    type Value = V::Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.inner.expecting(f)
    }

    fn visit_map<A: MapAccess<'de>>(self, inner: A) -> Result<V::Value, A::Error> {
        self.inner.visit_map(Beside { inner, duration: self.duration })
    }
}

impl<'de, A: MapAccess<'de>> MapAccess<'de> for Beside<'_, A> {
    type Error = A::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, A::Error> {
        while let Some(key) = self.inner.next_key::<String>()? {
            if key != DURATION {
                return seed.deserialize(StringDeserializer::new(key)).map(Some);
            }
            if self.duration.is_some() {
                return Err(A::Error::duplicate_field(DURATION));
            }
            *self.duration = self.inner.next_value()?;
        }
        Ok(None)
    }

    fn next_value_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<T::Value, A::Error> {
        self.inner.next_value_seed(seed)
    }
}
