//! Random requests that proptest can shrink, over all members of `POST /simulate`. Sizes are kept in units of the
//! contact.

use proptest::prelude::*;
use proptest::sample::select;
use proptest::strategy::Union;
use serde_json::{Map, Value, json};
use stickslip_compute::Flag;
use stickslip_compute::simulation::simulate;
use stickslip_mechanics::profile::{Parameter, families};
use stickslip_mechanics::range::{self, Range};
use stickslip_wire::{SimulateRequest, read};

use super::depth_requests::{RandomDepth, depth};

/// A number of a path.
#[derive(Clone, Copy, Debug)]
pub enum Target {
    /// In units of what the contact can bear.
    Scaled(f64),
    /// In SI units.
    Absolute(f64),
    /// The number so many numbers before.
    Repeated(usize),
    /// The negative of that.
    Negated(usize),
    /// That, off by so many units in the last place.
    Near(usize, i64),
}

/// A move of a path.
#[derive(Clone, Copy, Debug)]
pub struct RandomMove {
    /// Whether the tangential target is a force, and what it is.
    tangential: Option<(bool, Target)>,
    normal: Option<(bool, Target)>,
    relative: bool,
}

/// A path.
#[derive(Clone, Debug)]
pub enum RandomPath {
    Moves(Vec<RandomMove>),
    Displacement(Vec<Target>),
    Force(Vec<Target>),
    FallingAmplitude(usize, Option<Target>),
    EqualPeaks(usize, Option<f64>),
    Cycles(RandomCycles),
}

/// A path of cycles.
#[derive(Clone, Debug)]
pub struct RandomCycles {
    /// Whether the amplitude is a force, and what it is.
    amplitude: (bool, Target),
    mean: Option<Target>,
    count: usize,
    points: Option<usize>,
    down: bool,
    /// The same of the load, and its phase.
    load: Option<(bool, Target, f64)>,
}

/// A whole request.
#[derive(Clone, Debug)]
pub struct RandomRequest {
    contact: Value,
    path: RandomPath,
    /// Radii in units of the contact radius, or a number of points.
    radii: Option<Result<Vec<f64>, usize>>,
    fields: Option<Vec<&'static str>>,
    subsurface: Option<RandomDepth>,
    residual: bool,
    last: bool,
    solver: Option<Value>,
    tolerance: Option<f64>,
}

/// Any magnitude that a double has.
fn any_magnitude() -> impl Strategy<Value = f64> {
    let special =
        select(vec![0.0, -0.0, 5e-324, f64::MIN_POSITIVE, f64::MAX, -1.0, 1.0, f64::EPSILON, 1e300, 1e-300, -1e-300]);
    let power = (any::<bool>(), -300.0..300.0_f64);
    prop_oneof![special, power.prop_map(|(up, power)| 10_f64.powf(power).copysign(if up { 1.0 } else { -1.0 }))]
}

/// A quantity of a definition: mostly of ordinary size, sometimes anywhere in its range, rarely outside of it.
fn quantity(range: &'static Range, low: f64, high: f64) -> impl Strategy<Value = f64> {
    let (least, most) = (range.min.max(1e-300).log10(), range.max.log10());
    let ends = vec![range.min, range.max, range.min.next_up(), range.max.next_down(), range.max.next_up()];
    prop_oneof![
        30 => (low..high).prop_map(|power| 10_f64.powf(power)),
        8 => (least..most).prop_map(|power| 10_f64.powf(power)),
        1 => select(ends),
        1 => any_magnitude(),
    ]
}

/// A shape of ordinary size, sometimes of any.
fn family() -> BoxedStrategy<Value> {
    let closed = families().iter().map(|family| {
        let start = Just(Map::from_iter([("type".to_owned(), json!(family.name))])).boxed();
        let with = |members: BoxedStrategy<Map<String, Value>>, parameter: &'static Parameter| {
            (members, parameter_of(parameter)).prop_map(|(mut members, number)| {
                members.insert(parameter.name.to_owned(), json!(number));
                members
            })
        };
        let members = family.parameters.iter().fold(start, |members, parameter| with(members, parameter).boxed());
        (2, members.prop_map(Value::Object).boxed())
    });
    Union::new_weighted(closed.chain([(3, table().boxed())]).collect()).boxed()
}

/// About what the example has: an exponent is mostly small, or whole.
fn parameter_of(parameter: &'static Parameter) -> BoxedStrategy<f64> {
    let about = parameter.example.log10();
    let usual = quantity(&parameter.range, about.min(0.0) - 3.0, about + 2.0);
    if parameter.name == "exponent" {
        return prop_oneof![4 => 0.1..5.0_f64, 2 => (1..9_u8).prop_map(f64::from), 1 => usual].boxed();
    }
    usual.boxed()
}

/// Heights of a power law with some noise over radii that are even, crowded or repeated.
fn table() -> impl Strategy<Value = Value> {
    let steps = prop::collection::vec(
        prop_oneof![6 => 0.5..1.5_f64, 1 => 1e-9..1e3_f64, 1 => Just(1.0), 1 => Just(0.0)],
        2..24,
    );
    let shape = (prop_oneof![4 => -6.0..-3.0_f64, 1 => -12.0..6.0_f64], -6.0..1.0_f64, 0.5..4.0_f64);
    let noise =
        (prop_oneof![3 => Just(0.0), 1 => 1e-6..0.5_f64], prop::collection::vec(-1.0..1.0_f64, 24), any::<bool>());
    (steps, shape, noise).prop_map(|(steps, (length, height, power), (noise, each, rare))| {
        // Steps that do not rise are kept in a few tables alone: such a table is refused.
        let steps: Vec<f64> =
            steps.iter().map(|step| if *step > 0.0 || (rare && noise > 0.3) { *step } else { 1.0 }).collect();
        let total: f64 = steps.iter().sum();
        let (length, height) = (10_f64.powf(length), 10_f64.powf(length + height));
        let mut at = 0.0;
        let (mut r, mut z) = (vec![0.0], vec![0.0]);
        for (step, wobble) in steps.iter().zip(&each) {
            at += step / total;
            r.push(length * at);
            z.push(height * (at.powf(power) + noise * wobble * at * step / total));
        }
        json!({"type": "tabulated", "r": r, "z": z})
    })
}

/// Contacts that are known by their load curve alone: asperities of even, crowded or repeated gaps, a power of the
/// indentation with or without noise, ellipses.
fn curve() -> BoxedStrategy<Value> {
    let radius = || quantity(&range::RADIUS, -5.0, 0.0);
    let gaps = prop::collection::vec(prop_oneof![4 => 0.0..1.0_f64, 1 => 0.0..1e-9_f64, 1 => Just(0.5)], 1..80);
    let asperities = (gaps, radius(), -9.0..-4.0_f64, any::<bool>()).prop_map(|(gaps, radius, scale, each)| {
        let gaps: Vec<f64> = gaps.iter().map(|gap| gap * 10_f64.powf(scale)).collect();
        if each {
            let radii: Vec<f64> = (0..gaps.len()).map(|index| radius * (1.0 + 0.1 * (index % 7) as f64)).collect();
            json!({"type": "asperities", "radii": radii, "gaps": gaps})
        } else {
            json!({"type": "asperities", "radius": radius, "gaps": gaps})
        }
    });
    let steps = prop::collection::vec(prop_oneof![6 => 0.5..1.5_f64, 1 => 1e-9..1e3_f64], 1..40);
    let noise = prop_oneof![4 => Just(0.0), 1 => 1e-6..0.5_f64];
    let load_curve =
        (steps, -8.0..-4.0_f64, -2.0..4.0_f64, 1.0..3.0_f64, noise).prop_map(|(steps, length, force, power, noise)| {
            let total: f64 = steps.iter().sum();
            let mut at = 0.0;
            let (mut indentation, mut normal_force) = (vec![0.0], vec![0.0]);
            for step in steps {
                at += step / total;
                indentation.push(10_f64.powf(length) * at);
                normal_force.push(10_f64.powf(force) * at.powf(power) * (1.0 + noise * step));
            }
            json!({"type": "load_curve", "indentation": indentation, "normal_force": normal_force})
        });
    let ellipsoid = (radius(), radius(), any::<bool>()).prop_map(
        |(x, y, along)| json!({"type": "ellipsoid", "radii": [x, y], "direction": if along { "x" } else { "y" }}),
    );
    prop_oneof![asperities, load_curve, ellipsoid].boxed()
}

fn profile() -> impl Strategy<Value = Value> {
    prop_oneof![
        16 => family(),
        3 => curve(),
        2 => prop::collection::vec(family(), 1..4).prop_map(|parts| json!({"type": "sum", "parts": parts})),
    ]
}

/// A definition of a contact.
pub fn contact() -> BoxedStrategy<Value> {
    let poisson = || prop_oneof![6 => 0.0..0.5_f64, 2 => -0.99..0.0_f64, 1 => Just(0.5), 1 => any_magnitude()];
    let body = || {
        (quantity(&range::YOUNGS_MODULUS, 6.0, 12.0), poisson())
            .prop_map(|(e, nu)| json!({"youngs_modulus": e, "poisson_ratio": nu}))
    };
    let either = move || prop_oneof![4 => body(), 1 => Just(json!("rigid"))];
    let material = prop_oneof![
        1 => (body(), either()).prop_map(|(one, other)| json!({"bodies": [one, other]})),
        2 => (quantity(&range::E_STAR, 6.0, 12.0), quantity(&range::G_STAR, 6.0, 12.0))
            .prop_map(|(e, g)| json!({"effective": {"e_star": e, "g_star": g}})),
    ];
    let friction = prop_oneof![
        10 => 0.01..2.0_f64,
        2 => quantity(&range::FRICTION, -9.0, 2.0),
        2 => Just(0.0),
        1 => select(vec![1e-9, 1e-9_f64.next_down(), 100.0, 1e-3]),
    ];
    let preload = prop_oneof![
        3 => quantity(&range::NORMAL_FORCE, -3.0, 3.0).prop_map(|value| json!({"normal_force": value})),
        3 => quantity(&range::PRELOAD_INDENTATION, -9.0, -4.0).prop_map(|value| json!({"indentation": value})),
        3 => quantity(&range::CONTACT_RADIUS, -6.0, -2.0).prop_map(|value| json!({"contact_radius": value})),
        1 => select(vec!["normal_force", "indentation", "contact_radius"]).prop_map(|name| json!({name: 0.0})),
    ];
    (profile(), material, friction, preload).prop_map(|(profile, material, friction, preload)| {
        json!({"profile": profile, "material": material, "friction": friction, "preload": preload})
    })
    .boxed()
}

fn target() -> impl Strategy<Value = Target> {
    let tiny = (any::<bool>(), -18.0..-1.0_f64);
    prop_oneof![
        12 => (-1.2..1.2_f64).prop_map(Target::Scaled),
        2 => select(vec![0.0, 1.0, -1.0, 0.5, 2.0, 1.0 - 1e-15, 1.0 - f64::EPSILON, 1.0 +
            1e-12]).prop_map(Target::Scaled),
        2 => tiny.prop_map(|(up, power)| Target::Scaled(10_f64.powf(power).copysign(if up { 1.0 } else { -1.0 }))),
        1 => (1.0..1e6_f64).prop_map(Target::Scaled),
        3 => (1..6_usize).prop_map(Target::Repeated),
        2 => (1..6_usize).prop_map(Target::Negated),
        2 => (1..6_usize, -3..4_i64).prop_map(|(ago, off)| Target::Near(ago, off)),
        1 => any_magnitude().prop_map(Target::Absolute),
    ]
}

/// A normal target: mostly a load that presses.
fn load() -> impl Strategy<Value = Target> {
    prop_oneof![
        6 => (0.05..1.8_f64).prop_map(Target::Scaled),
        3 => target(),
        1 => select(vec![0.0, 1.0, 1e-9, 3.0]).prop_map(Target::Scaled),
    ]
}

fn step() -> impl Strategy<Value = RandomMove> {
    let tangential = prop_oneof![
        5 => target().prop_map(|target| Some((false, target))),
        3 => target().prop_map(|target| Some((true, target))),
        2 => Just(None),
    ];
    let normal = prop_oneof![
        5 => Just(None),
        3 => load().prop_map(|target| Some((false, target))),
        2 => load().prop_map(|target| Some((true, target))),
    ];
    (tangential, normal, prop::bool::weighted(0.25)).prop_map(|(tangential, normal, relative)| RandomMove {
        tangential,
        normal,
        relative,
    })
}

fn cycles() -> impl Strategy<Value = RandomCycles> {
    let amplitude = || prop_oneof![8 => (0.0..1.2_f64).prop_map(Target::Scaled), 1 => target()];
    let points = prop::option::weighted(0.9, prop_oneof![8 => (2..6_usize).prop_map(|half| 2 * half), 1 => 0..9_usize]);
    let phase = prop_oneof![3 => -360.0..360.0_f64, 2 => select(vec![0.0, 45.0, 90.0, -90.0, 180.0, 361.0])];
    let load = prop::option::of((any::<bool>(), amplitude(), phase));
    let mean = prop::option::of(prop_oneof![4 => (-0.5..0.5_f64).prop_map(Target::Scaled), 1 => target()]);
    ((prop::bool::weighted(0.3), amplitude()), mean, 1..4_usize, points, any::<bool>(), load).prop_map(
        |(amplitude, mean, count, points, down, load)| RandomCycles { amplitude, mean, count, points, down, load },
    )
}

/// A path that mostly ends where it began, at least when it is repeated.
pub fn closed_path() -> impl Strategy<Value = RandomPath> {
    let absolute = step().prop_map(|step| RandomMove { relative: false, ..step });
    prop_oneof![
        4 => prop::collection::vec(target(), 1..5).prop_map(RandomPath::Displacement),
        3 => cycles().prop_map(RandomPath::Cycles),
        3 => prop::collection::vec(absolute, 2..5).prop_map(RandomPath::Moves),
        1 => prop::collection::vec(target(), 1..5).prop_map(RandomPath::Force),
        1 => path(),
    ]
}

fn path() -> impl Strategy<Value = RandomPath> {
    prop_oneof![
        6 => prop::collection::vec(step(), 1..7).prop_map(RandomPath::Moves),
        4 => prop::collection::vec(target(), 1..12).prop_map(RandomPath::Displacement),
        2 => prop::collection::vec(target(), 1..8).prop_map(RandomPath::Force),
        2 => (1..30_usize, prop::option::of(target())).prop_map(|(count, size)| RandomPath::FallingAmplitude(count,
            size)),
        1 => (1..20_usize, prop::option::of(prop_oneof![4 => 0.0..1.0_f64, 1 => any_magnitude()]))
            .prop_map(|(count, cutoff)| RandomPath::EqualPeaks(count, cutoff)),
        2 => cycles().prop_map(RandomPath::Cycles),
    ]
}

/// A random request.
pub fn random_request() -> impl Strategy<Value = RandomRequest> {
    let radius = prop_oneof![
        6 => 0.0..1.2_f64,
        2 => select(vec![0.0, 1.0, 1.0 - f64::EPSILON, 1.0 + f64::EPSILON, 1e-12, 0.5]),
        1 => (-17.0..3.0_f64).prop_map(|power| 10_f64.powf(power)),
        1 => any_magnitude(),
    ];
    let radii =
        prop::option::of(prop_oneof![prop::collection::vec(radius, 1..8).prop_map(Ok), (2..8_usize).prop_map(Err),]);
    let fields =
        prop::option::of(prop::collection::vec(select(vec!["pressure", "shear", "slip", "displacement"]), 1..5));
    let solver = prop_oneof![
        8 => Just(None),
        1 => Just(Some(json!("exact"))),
        1 => (2..60_usize).prop_map(|count| Some(json!({"springs": {"count": count}}))),
    ];
    let tolerance = prop_oneof![
        1 => Just(None),
        11 => (-7.0..-2.0_f64).prop_map(|power| Some(10_f64.powf(power))),
        1 => Just(Some(1e-11)),
    ];
    let below = prop::option::weighted(0.2, depth(false));
    let asked = (radii, fields, below, prop::bool::weighted(0.3), any::<bool>());
    (contact(), path(), asked, solver, tolerance).prop_map(
        |(contact, path, (radii, fields, subsurface, residual, last), solver, tolerance)| RandomRequest {
            contact,
            path,
            radii,
            fields,
            subsurface,
            residual,
            last,
            solver,
            tolerance,
        },
    )
}

/// The units of a contact: displacement of gross slip, mu F_N, indentation, F_N, contact radius.
pub fn units(contact: &Value) -> [f64; 5] {
    let body = json!({"contact": contact, "path": {"displacement": [0.0]}, "steps": "last"});
    let simulation = read::<SimulateRequest>(body.to_string().as_bytes()).ok();
    let figures =
        simulation.and_then(|simulation| simulate(&simulation, &Flag::default()).ok()).map(|reply| reply.contact);
    let units = figures.map_or([1e-6, 1.0, 1e-6, 1.0, 1e-4], |figures| {
        let tangential = [figures.gross_slip_displacement, figures.gross_slip_force];
        let [displacement, force] = tangential;
        [displacement, force, figures.indentation, figures.normal_force, figures.contact_radius]
    });
    units.map(|unit| if unit > 0.0 { unit } else { 1e-6 })
}

/// A path in SI units, as its JSON document, for a contact of these [`units`].
pub fn path_to_json(path: &RandomPath, [displacement, force, indentation, normal_force, radius]: [f64; 5]) -> Value {
    let mut past: Vec<f64> = Vec::new();
    let mut number = |target: Target, unit: f64| {
        let ago = |count: usize, past: &[f64]| past.len().checked_sub(count).map_or(unit, |index| past[index]);
        let value = match target {
            Target::Scaled(units) => units * unit,
            Target::Absolute(value) => value,
            Target::Repeated(count) => ago(count, &past),
            Target::Negated(count) => -ago(count, &past),
            Target::Near(count, off) => {
                let value = ago(count, &past);
                (0..off.abs()).fold(value, |value, _| if off > 0 { value.next_up() } else { value.next_down() })
            }
        };
        let value = if value.is_finite() { value } else { 0.0 };
        past.push(value);
        value
    };
    match path {
        RandomPath::Displacement(targets) => {
            json!({"displacement": targets.iter().map(|target| number(*target, displacement)).collect::<Vec<_>>()})
        }
        RandomPath::Force(targets) => {
            json!({"force": targets.iter().map(|target| number(*target, force)).collect::<Vec<_>>()})
        }
        RandomPath::FallingAmplitude(count, size) => {
            let mut fall = json!({"reversals": count});
            if let Some(size) = size {
                fall["amplitude"] = json!(number(*size, displacement));
            }
            json!({"falling_amplitude": fall})
        }
        RandomPath::EqualPeaks(count, cutoff) => {
            let mut equal = json!({"reversals": count});
            if let Some(part) = cutoff {
                equal["cutoff_radius"] = json!(part * radius);
            }
            json!({"equal_peaks": equal})
        }
        RandomPath::Cycles(RandomCycles { amplitude: (is_force, size), mean, count, points, down, load }) => {
            let (name, unit) = if *is_force { ("force", force) } else { ("displacement", displacement) };
            let mut cycles = json!({name: number(*size, unit), "count": count});
            if let Some(mean) = mean {
                cycles["mean"] = json!(number(*mean, unit));
            }
            if let Some(points) = points {
                cycles["points_per_cycle"] = json!(points);
            }
            if *down {
                cycles["start"] = json!("down");
            }
            if let Some((is_force, size, phase)) = load {
                let (name, unit) =
                    if *is_force { ("normal_force", normal_force) } else { ("indentation", indentation) };
                cycles["normal"] = json!({name: number(*size, unit), "phase": phase});
            }
            json!({"cycles": cycles})
        }
        RandomPath::Moves(steps) => {
            let moves = steps.iter().map(|step| {
                let mut written = Map::new();
                let pairs = [
                    (step.tangential, ["displacement", "force"], [displacement, force]),
                    (step.normal, ["indentation", "normal_force"], [indentation, normal_force]),
                ];
                for (target, names, units) in pairs {
                    if let Some((is_force, target)) = target {
                        let index = usize::from(is_force);
                        written.insert(names[index].to_owned(), json!(number(target, units[index])));
                    }
                }
                if step.relative {
                    written.insert("relative".to_owned(), json!(true));
                }
                Value::Object(written)
            });
            json!({"moves": moves.collect::<Vec<_>>()})
        }
    }
}

impl RandomRequest {
    /// The request in SI units, as its JSON body.
    pub fn to_json(&self) -> Value {
        let units = units(&self.contact);
        let (path, radius) = (path_to_json(&self.path, units), units[4]);
        let mut request = json!({"contact": self.contact, "path": path, "residual": self.residual});
        if let Some(radii) = &self.radii {
            request["stress"] = match radii {
                Ok(parts) => json!({"radii": parts.iter().map(|part| part * radius).collect::<Vec<_>>()}),
                Err(points) => json!({"points": points}),
            };
            if let Some(fields) = &self.fields {
                request["stress"]["fields"] = json!(fields);
            }
        }
        if let Some(depth) = &self.subsurface {
            request["subsurface"] = depth.to_json(&self.contact, radius);
        }
        if self.last {
            request["steps"] = json!("last");
        }
        if let Some(solver) = &self.solver {
            request["solver"] = solver.clone();
        }
        if let Some(tolerance) = self.tolerance {
            request["tolerance"] = json!(tolerance);
        }
        request
    }
}
