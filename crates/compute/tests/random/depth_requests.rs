//! Random places below the surface, and random bodies of `POST /fretting`, in units of the contact.

use proptest::prelude::*;
use proptest::sample::select;
use serde_json::{Value, json};

use super::requests::{RandomPath, closed_path, contact, path_to_json, units};

/// What is asked for below the surface.
#[derive(Clone, Debug)]
pub struct RandomDepth {
    body: &'static str,
    /// Given or not; where the bodies are known it is mostly theirs.
    poisson: Option<f64>,
    places: RandomPlaces,
}

/// Places in units of the contact radius.
#[derive(Clone, Debug)]
enum RandomPlaces {
    Points(Vec<[f64; 3]>),
    Line([f64; 3], [f64; 3], usize),
    Plane(f64, usize),
    Surface(usize),
}

/// Places in one of the bodies: now and then ones that must be refused.
pub fn depth(surface_alone: bool) -> impl Strategy<Value = RandomDepth> {
    let across = || {
        prop_oneof![
            8 => -1.3..1.3_f64,
            3 => select(vec![0.0, 1.0, -1.0, 1.0 - f64::EPSILON, 1.0 + f64::EPSILON]),
            1 => (-17.0..3.0_f64).prop_map(|power| 10_f64.powf(power)),
        ]
    };
    let below = prop_oneof![
        4 => Just(0.0),
        6 => 0.0..3.0_f64,
        2 => (-17.0..3.0_f64).prop_map(|power| 10_f64.powf(power)),
        1 => Just(-0.1),
    ];
    let deep = move || if surface_alone { Just(0.0).boxed() } else { below.clone().boxed() };
    let point = move || (across(), across(), deep()).prop_map(|(x, y, z)| [x, y, z]);
    let places = prop_oneof![
        4 => prop::collection::vec(point(), 1..6).prop_map(RandomPlaces::Points),
        1 => (point(), point(), 1..5_usize).prop_map(|(from, to, count)| RandomPlaces::Line(from, to, count)),
        1 => (0.0..1.0_f64, 1..4_usize).prop_map(move |(offset, count)| {
            if surface_alone { RandomPlaces::Surface(count) } else { RandomPlaces::Plane(offset, count) }
        }),
        1 => (1..4_usize).prop_map(RandomPlaces::Surface),
    ];
    let poisson = prop::option::weighted(0.6, prop_oneof![8 => 0.0..0.5_f64, 1 => -1.1..0.6_f64]);
    (select(vec!["first", "second"]), poisson, places).prop_map(|(body, poisson, places)| RandomDepth {
        body,
        poisson,
        places,
    })
}

impl RandomDepth {
    /// The members that say where, for a contact of this radius, m.
    pub fn to_json(&self, contact: &Value, radius: f64) -> Value {
        let scaled = |place: &[f64; 3]| place.map(|part| part * radius);
        let mut asked = match &self.places {
            RandomPlaces::Points(points) => json!({"points": points.iter().map(scaled).collect::<Vec<_>>()}),
            RandomPlaces::Line(from, to, count) => {
                json!({"line": {"from": scaled(from), "to": scaled(to), "count": count}})
            }
            RandomPlaces::Plane(offset, count) => json!({"plane": {
                "normal": "y", "offset": offset * radius, "x": [-radius, radius, count], "z": [0.0, radius, 2],
            }}),
            RandomPlaces::Surface(count) => {
                json!({"surface": {"x": [-radius, radius, count], "y": [0.0, radius, 2]}})
            }
        };
        asked["body"] = json!(self.body);
        // The bodies know theirs: another one is refused.
        let known = contact["material"]["bodies"].is_array();
        if let Some(poisson) = self.poisson.or((!known).then_some(0.3)).filter(|poisson| !known || *poisson > 0.45) {
            asked["poisson_ratio"] = json!(poisson);
        }
        asked
    }
}

/// A whole request of `POST /fretting`.
#[derive(Clone, Debug)]
pub struct RandomFretting {
    contact: Value,
    path: RandomPath,
    depth: RandomDepth,
    criteria: Value,
    /// Mean, amplitude, Pa, and phase.
    bulk: Option<[f64; 3]>,
    stress_paths: bool,
    /// Without places.
    search: bool,
    /// The critical distance over the contact radius, and whether the stress is averaged.
    critical_distance: Option<(f64, bool)>,
}

/// A random request: mostly of a path that closes.
pub fn random_fretting() -> impl Strategy<Value = RandomFretting> {
    let weight = || prop_oneof![8 => 0.0..2.0_f64, 1 => Just(-1.0)];
    let inside = prop_oneof![
        2 => (weight(), prop_oneof![8 => 6.0..12.0_f64, 1 => -300.0..30.0_f64]).prop_map(|(alpha, power)| {
            let life = json!({"s_n": {"reference": 10_f64.powf(power), "cycles": 1e6, "exponent": 6.0}});
            json!({"crossland": {"alpha": alpha, "limit": 3e8, "life": life}})
        }),
        2 => weight().prop_map(|alpha| json!({"dang_van": {"alpha": alpha}})),
        1 => weight().prop_map(|k| json!({"findley": {"k": k}})),
        1 => (8.0..10.0_f64, 0.0..1.0_f64, -0.5..0.02_f64).prop_map(|(power, ductility, exponent)| {
            let strain_life = json!({
                "strength": 10_f64.powf(power), "strength_exponent": exponent,
                "ductility": ductility, "ductility_exponent": -0.6
            });
            json!({"swt": {"life": {"strain_life": strain_life}}})
        }),
        1 => Just(json!({"swt": {"youngs_modulus": 2e11}})),
        1 => weight().prop_map(|k| json!({"fatemi_socie": {"k": k, "yield": 5e8, "youngs_modulus": 2e11}})),
    ];
    let surface = prop_oneof![Just(json!({"ruiz": {}, "friction_work": {"limit": 1.0}})), Just(json!({"ruiz": {}}))];
    let asked = prop_oneof![
        3 => (depth(false), inside.boxed()),
        1 => (depth(true), surface.boxed()),
    ];
    let bulk = prop::option::weighted(0.3, (-3e8..3e8_f64, 0.0..3e8_f64, -360.0..360.0_f64));
    let search = prop::bool::weighted(0.04);
    let distance = prop::option::weighted(0.3, ((-3.0..1.0_f64).prop_map(|power| 10_f64.powf(power)), any::<bool>()));
    (contact(), closed_path(), asked, bulk, any::<bool>(), search, distance).prop_map(
        |(contact, path, (depth, criteria), bulk, stress_paths, search, critical_distance)| RandomFretting {
            contact,
            path,
            depth,
            criteria,
            bulk: bulk.map(|(mean, amplitude, phase)| [mean, amplitude, phase]),
            stress_paths,
            search,
            critical_distance,
        },
    )
}

impl RandomFretting {
    /// The request in SI units, as its JSON body.
    pub fn to_json(&self) -> Value {
        let units = units(&self.contact);
        let mut request = self.depth.to_json(&self.contact, units[4]);
        request["contact"] = self.contact.clone();
        request["path"] = path_to_json(&self.path, units);
        request["criteria"] = self.criteria.clone();
        // Many instants cost, and the default takes many.
        request["tolerance"] = json!(0.01);
        if let Some([mean, amplitude, phase]) = self.bulk {
            request["bulk"] = json!({"mean": mean, "amplitude": amplitude, "phase": phase});
        }
        if let Some((length, averaged)) = self.critical_distance {
            let method = if averaged { "line" } else { "point" };
            request["critical_distance"] = json!({"length": (length * units[4]).clamp(1e-9, 1.0), "method": method});
        }
        if self.search {
            let members = request.as_object_mut().expect("a request is an object");
            members.retain(|name, _| !matches!(name.as_str(), "points" | "line" | "plane" | "surface"));
        } else if self.stress_paths {
            request["stress_paths"] = json!([0]);
        }
        request
    }
}
