//! The OpenAPI document: what the attributes of handlers and types generate, completed by what attributes cannot
//! express.

mod base;
mod keys;
mod parameters;
mod refusals;
mod responses;
mod schemas;

use serde_json::{Map, Value, json};

use stickslip_mechanics::DEFAULT_TOLERANCE;
use stickslip_mechanics::range::{self, Range};
use stickslip_wire::limits;

pub use base::base;

/// The text of the document, from what the attributes generate.
pub fn complete(described: &utoipa::openapi::OpenApi) -> String {
    let mut document = serde_json::to_value(described).unwrap_or_default();
    write_limits(&mut document);
    schemas::write(&mut document);
    parameters::write(&mut document);
    refusals::write(&mut document);
    keys::write(&mut document);
    responses::write(&mut document);
    format!("{document:#}\n")
}

/// Every operation with its method and path.
fn operations(document: &mut Value) -> impl Iterator<Item = (&str, &str, &mut Value)> {
    let paths = document.get_mut("paths").and_then(Value::as_object_mut);
    paths.into_iter().flatten().flat_map(|(path, methods)| {
        let methods = methods.as_object_mut().into_iter().flatten();
        methods.map(move |(method, operation)| (method.as_str(), path.as_str(), operation))
    })
}

/// What a property of a schema is limited to.
enum Limit {
    Number(Range),
    Count(usize, usize),
    Numbers(usize, usize, Range),
    Items(usize, usize),
    Length(usize),
    Tolerance,
}

/// The limits, by schema and property. They are written here and not beside the fields, because an attribute takes a
/// literal alone, and a limit is to be one constant.
fn limited() -> Vec<(&'static str, &'static str, Limit)> {
    use Limit::{Count, Items, Length, Number, Numbers, Tolerance};
    let (moves, radii, points) = (&limits::PATH_MOVES, &limits::STRESS_RADII, &limits::TABLE_POINTS);
    let mut all = vec![
        ("SphereProfile", "radius", Number(range::RADIUS)),
        ("ExactSphereProfile", "radius", Number(range::RADIUS)),
        ("ConeProfile", "slope", Number(range::SLOPE)),
        ("PowerLawProfile", "exponent", Number(range::EXPONENT)),
        ("PowerLawProfile", "coefficient", Number(range::COEFFICIENT)),
        ("FlatPunchProfile", "radius", Number(range::RADIUS)),
        ("TruncatedConeProfile", "slope", Number(range::SLOPE)),
        ("TruncatedConeProfile", "flat_radius", Number(range::FLAT_RADIUS)),
        ("TruncatedSphereProfile", "radius", Number(range::RADIUS)),
        ("TruncatedSphereProfile", "flat_radius", Number(range::FLAT_RADIUS)),
        ("RoundedPunchProfile", "flat_radius", Number(range::FLAT_RADIUS)),
        ("RoundedPunchProfile", "edge_radius", Number(range::EDGE_RADIUS)),
        ("RoundedConeProfile", "slope", Number(range::SLOPE)),
        ("RoundedConeProfile", "tip_radius", Number(range::TIP_RADIUS)),
        ("TabulatedProfile", "r", Numbers(*points.start(), *points.end(), range::TABLE_RADIUS)),
        ("TabulatedProfile", "z", Numbers(*points.start(), *points.end(), range::TABLE_HEIGHT)),
        ("SumProfile", "parts", Items(*limits::SUM_PARTS.start(), *limits::SUM_PARTS.end())),
        ("EqualPeaks", "reversals", Count(*limits::REVERSALS.start(), *limits::REVERSALS.end())),
        ("EqualPeaks", "cutoff_radius", Number(range::CONTACT_RADIUS)),
        ("ElasticBody", "youngs_modulus", Number(range::YOUNGS_MODULUS)),
        ("ElasticBody", "poisson_ratio", Number(range::POISSON_RATIO)),
        ("Effective", "e_star", Number(range::E_STAR)),
        ("Effective", "g_star", Number(range::G_STAR)),
        ("ContactDefinition", "friction", Number(range::FRICTION)),
        ("CreateRequest", "friction", Number(range::FRICTION)),
        ("CreateRequest", "label", Length(limits::LABEL_LENGTH)),
        ("ForkRequest", "label", Length(limits::LABEL_LENGTH)),
        ("Preload", "normal_force", Number(range::NORMAL_FORCE)),
        ("Preload", "indentation", Number(range::PRELOAD_INDENTATION)),
        ("Preload", "contact_radius", Number(range::CONTACT_RADIUS)),
        ("Material", "bodies", Items(2, 2)),
        ("Path", "moves", Items(*moves.start(), *moves.end())),
        ("Path", "displacement", Numbers(*moves.start(), *moves.end(), range::DISPLACEMENT)),
        ("Path", "force", Numbers(*moves.start(), *moves.end(), range::FORCE)),
        ("FallingAmplitude", "reversals", Count(*limits::REVERSALS.start(), *limits::REVERSALS.end())),
        ("FallingAmplitude", "amplitude", Number(range::DISPLACEMENT)),
        ("StressRequest", "points", Count(*limits::STRESS_POINTS.start(), *limits::STRESS_POINTS.end())),
        ("StressRequest", "radii", Numbers(*radii.start(), *radii.end(), range::CONTACT_RADIUS)),
        ("SweepRequest", "axes", Items(*limits::SWEEP_AXES.start(), *limits::SWEEP_AXES.end())),
        ("SweepRequest", "outputs", Items(*limits::SWEEP_OUTPUTS.start(), *limits::SWEEP_OUTPUTS.end())),
        ("Axis", "values", Numbers(*limits::AXIS_VALUES.start(), *limits::AXIS_VALUES.end(), limits::AXIS_NUMBER)),
        ("Span", "from", Number(limits::AXIS_NUMBER)),
        ("Span", "to", Number(limits::AXIS_NUMBER)),
        ("Span", "count", Count(*limits::AXIS_COUNT.start(), *limits::AXIS_COUNT.end())),
        ("Springs", "count", Count(range::SPRING_COUNT.min as usize, range::SPRING_COUNT.max as usize)),
    ];
    all.push(("AccuracyRequest", "solvers", Items(*limits::SOLVERS.start(), *limits::SOLVERS.end())));
    let reversals = &limits::PROTOCOL_REVERSALS;
    for schema in ["ProtocolRequest", "RelaxRequest"] {
        all.push((schema, "reversals", Count(*reversals.start(), *reversals.end())));
        all.push((schema, "target", Number(limits::TARGET)));
    }
    all.push(("ProtocolStart", "displacement", Number(range::DISPLACEMENT)));
    all.push(("Robustness", "amplitude_error", Number(limits::AMPLITUDE_ERROR)));
    all.push(("Robustness", "friction_error", Number(limits::FRICTION_ERROR)));
    all.push(("Robustness", "samples", Count(*limits::SAMPLES.start(), *limits::SAMPLES.end())));
    all.push(("Robustness", "seed", Count(0, *limits::SEED.end() as usize)));
    for schema in ["SimulateRequest", "AccuracyRequest", "MoveRequest", "PathRequest"] {
        all.push((schema, "tolerance", Tolerance));
    }
    for schema in ["Move", "MoveRequest"] {
        all.push((schema, "displacement", Number(range::DISPLACEMENT)));
        all.push((schema, "force", Number(range::FORCE)));
        all.push((schema, "indentation", Number(range::INDENTATION)));
        // The wider range: as an increment it may be negative.
        all.push((schema, "normal_force", Number(range::FORCE)));
    }
    all
}

fn write_limits(document: &mut Value) {
    for (schema, property, limit) in limited() {
        if let Some(schema) = document.pointer_mut(&format!("/components/schemas/{schema}")) {
            visit_property(schema, property, &|node| write_limit(node, &limit));
        }
    }
}

/// Calls `visit` on every property of this name, however deep the schema hides it in alternatives.
fn visit_property(node: &mut Value, property: &str, visit: &dyn Fn(&mut Map<String, Value>)) {
    match node {
        Value::Object(members) => {
            if let Some(Value::Object(found)) = members.get_mut("properties").and_then(|all| all.get_mut(property)) {
                visit(found);
            }
            members.values_mut().for_each(|member| visit_property(member, property, visit));
        }
        Value::Array(elements) => elements.iter_mut().for_each(|element| visit_property(element, property, visit)),
        _ => {}
    }
}

fn write_limit(node: &mut Map<String, Value>, limit: &Limit) {
    let mut set = |name: &str, value: Value| node.insert(name.to_owned(), value);
    match limit {
        Limit::Number(range) => {
            set("minimum", json!(range.min));
            set("maximum", json!(range.max));
        }
        Limit::Count(least, most) => {
            set("minimum", json!(least));
            set("maximum", json!(most));
        }
        Limit::Items(least, most) => {
            set("minItems", json!(least));
            set("maxItems", json!(most));
        }
        Limit::Numbers(least, most, range) => {
            set("minItems", json!(least));
            set("maxItems", json!(most));
            if let Some(Value::Object(items)) = node.get_mut("items") {
                write_limit(items, &Limit::Number(*range));
            }
        }
        Limit::Length(most) => {
            set("maxLength", json!(most));
        }
        Limit::Tolerance => {
            set("minimum", json!(limits::TOLERANCE.start()));
            set("maximum", json!(limits::TOLERANCE.end()));
            set("default", json!(DEFAULT_TOLERANCE));
        }
    }
}
