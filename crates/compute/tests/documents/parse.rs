//! The documents of requests without a server: every fault is found at its place, and extreme integers in any count are
//! refused or accepted, but nothing overflows. Numbers of replies are found by their pointers.

use serde_json::{Number, Value, json};
use stickslip_wire::json_value::{JsonValue, Pointer};
use stickslip_wire::pointer_lookup::{Lookup, lookup};
use stickslip_wire::{
    AccuracyRequest, CreateRequest, Document, ForkRequest, MoveRequest, PathRequest, Peak, ProtocolRequest, Rejection,
    RelaxRequest, RenameRequest, Residual, SimulateRequest, Stress, SweepRequest, parse, read,
};

use crate::json::nodes;

fn with(profile: &str, path: &str) -> String {
    format!(
        r#"{{"contact":{{"profile":{profile},"material":{{"effective":{{"e_star":1e11,"g_star":1e11}}}},
        "friction":0.3,"preload":{{"normal_force":10}}}},"path":{path}}}"#
    )
}

/// Those that `faults.rs` does not make of the examples.
#[test]
fn faults_of_any_kind_of_text_are_found_at_their_place() {
    let sphere = r#"{"type":"sphere","radius":0.01}"#;
    for (body, pointer, word) in [
        (with(r#"{"radius":"x","type":"sphere"}"#, r#"{"force":[1]}"#), "/contact/profile/radius", "a number"),
        (with(r#"{"radius":1}"#, r#"{"force":[1]}"#), "/contact/profile/type", "missing"),
        (with(r#"{"type":"cube","radius":1}"#, r#"{"force":[1]}"#), "/contact/profile/type", "sphere"),
        (with(r#"{"type":"sphere","radius":1,"a/b":2}"#, "{}"), "/contact/profile/a~1b", "unknown field"),
        (with(r#"{"type":"sphere","radius":1,"`x":2}"#, "{}"), "/contact/profile/`x", "unknown field"),
        (with(r#"{"type":"sphere","radius":1,"radius":2}"#, "{}"), "/contact/profile/radius", "duplicate"),
        (with(sphere, r#"{"force":[1],"displacement":[1]}"#), "/path", "conflicts"),
        (with(sphere, "{}"), "/path", "one key"),
        (with(r#"["sphere",1]"#, r#"{"force":[1]}"#), "/contact/profile", "an object"),
        (with(sphere, r#"{"moves":[[0,1]]}"#), "/path/moves/0", "an object"),
        (with(sphere, r#"{"falling_amplitude":[3,1e-7]}"#), "/path/falling_amplitude", "an object"),
    ] {
        let Err(Rejection::Invalid(faults)) = parse::<SimulateRequest>(body.as_bytes()) else { panic!("{body}") };
        assert_eq!(faults[0].pointer, pointer, "{body}: {faults:?}");
        assert!(faults[0].detail.contains(word), "{body}: {faults:?}");
    }
}

#[test]
fn a_broken_end_is_not_json_even_after_an_unknown_member() {
    for body in ["", "{", r#"{"colour": 1"#, r#"{"contact": 1} x"#, "\u{feff}", "{\u{feff}}", "NaN", ".5", "0x1", "1e"]
    {
        assert!(matches!(parse::<SimulateRequest>(body.as_bytes()), Err(Rejection::NotJson(_))), "{body}");
    }
    assert!(matches!(parse::<SimulateRequest>(b"{\"\xff\": 1}"), Err(Rejection::NotJson(_))));
}

#[test]
fn a_byte_order_mark_is_read_and_what_is_not_a_number_is_refused_with_a_hint() {
    let body = with(r#"{"type":"sphere","radius":0.01}"#, r#"{"moves":[{"force":1}]}"#);
    let read = |text: &str| parse::<SimulateRequest>(text.as_bytes());
    assert_eq!(format!("{:?}", read(&format!("\u{feff}{body}")).unwrap()), format!("{:?}", read(&body).unwrap()));
    for value in ["NaN", "nan", "Infinity", "-Infinity", "inf", "-inf"] {
        for place in ["", "\n\n  "] {
            let Err(Rejection::NotJson(detail)) = read(&body.replace("0.01", &format!("{place}{value}"))) else {
                panic!("{value}");
            };
            assert!(detail.contains("write `null` where one is missing"), "{value}: {detail}");
        }
    }
    for value in ["nil", "N", "x", "0.01,,"] {
        let Err(Rejection::NotJson(detail)) = read(&body.replace("0.01", value)) else { panic!("{value}") };
        assert!(!detail.contains("null"), "{value}: {detail}");
    }
    let wide: Vec<u8> = format!("\u{feff}{body}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    let Err(Rejection::NotJson(detail)) = parse::<SimulateRequest>(&wide) else { panic!() };
    assert!(detail.contains("UTF-16"), "{detail}");
}

const EXTREMES: [u64; 9] =
    [0, 1, i32::MAX as u64, u32::MAX as u64, 1 << 53, (1 << 53) + 1, 1 << 63, u64::MAX - 1, u64::MAX];

/// The pointers of the faults of a body; none if it is accepted.
fn faults<D: Document>(body: &Value) -> Vec<String> {
    match read::<D>(body.to_string().as_bytes()) {
        Ok(_) => Vec::new(),
        Err(Rejection::Invalid(faults)) => faults.into_iter().map(|fault| fault.pointer).collect(),
        Err(other) => panic!("{body}: {other}"),
    }
}

/// The document of a request, and a request whose counts are to be replaced.
type Case = (fn(&Value) -> Vec<String>, Value, &'static [&'static str]);

fn cases() -> Vec<Case> {
    let contact = json!({"profile": {"type": "sphere", "radius": 0.01}, "friction": 0.3,
        "material": {"effective": {"e_star": 1e11, "g_star": 1e11}}, "preload": {"normal_force": 10}});
    let simulate = json!({"contact": contact, "path": {"falling_amplitude": {"reversals": 3}},
        "stress": {"points": 3}, "solver": {"springs": {"count": 10}}, "residual": true});
    let mut equal_peaks = simulate.clone();
    equal_peaks["path"] = json!({"equal_peaks": {"reversals": 3}});
    let mut cycles = simulate.clone();
    cycles["path"] = json!({"cycles": {"displacement": 1e-7, "count": 3, "points_per_cycle": 4, "mean": 1e-8,
        "normal": {"normal_force": 1.0, "phase": 90.0}}});
    let accuracy = json!({"contact": contact, "path": simulate["path"], "stress": {"points": 3, "fields": ["shear"]},
        "solvers": ["exact", {"springs": {"count": 10}}, {"springs": {"count": 10}}]});
    let protocol = json!({"contact": contact, "reversals": 3, "robustness": {"samples": 3, "seed": 3}});
    let axis = |kind: &str, pointer: &str| json!({"pointer": pointer, kind: {"from": 1.0, "to": 2.0, "count": 2}});
    let sweep = json!({"base": simulate, "outputs": ["/residual/max"], "axes": [axis("linear", "/contact/friction"),
        axis("logarithmic", "/contact/preload/normal_force"), axis("linear", "/contact/profile/radius")]});
    let mut create = contact.clone();
    create["label"] = json!("ball");
    const SIMULATE: &[&str] = &["/path/falling_amplitude/reversals", "/stress/points", "/solver/springs/count"];
    const ACCURACY: &[&str] = &[
        "/path/falling_amplitude/reversals",
        "/stress/points",
        "/solvers/1/springs/count",
        "/solvers/2/springs/count",
    ];
    vec![
        (faults::<SimulateRequest>, simulate.clone(), SIMULATE),
        (faults::<SimulateRequest>, equal_peaks, &["/path/equal_peaks/reversals", "/stress/points"]),
        (faults::<SimulateRequest>, cycles, &["/path/cycles/count", "/path/cycles/points_per_cycle", "/stress/points"]),
        (faults::<AccuracyRequest>, accuracy, ACCURACY),
        (faults::<ProtocolRequest>, protocol, &["/reversals", "/robustness/samples", "/robustness/seed"]),
        (faults::<RelaxRequest>, json!({"reversals": 3}), &["/reversals"]),
        (faults::<MoveRequest>, json!({"displacement": 1e-7, "stress": {"points": 3}}), &["/stress/points"]),
        (
            faults::<PathRequest>,
            json!({"path": {"falling_amplitude": {"reversals": 3}}, "stress": {"points": 3}}),
            &["/path/falling_amplitude/reversals", "/stress/points"],
        ),
        (faults::<SweepRequest>, sweep, &["/axes/0/linear/count", "/axes/1/logarithmic/count", "/axes/2/linear/count"]),
        (faults::<CreateRequest>, create, &[]),
        (faults::<ForkRequest>, json!({"label": "ball", "sequence": 3}), &[]),
        (faults::<RenameRequest>, json!({"label": "ball"}), &[]),
    ]
}

#[test]
fn extreme_counts_are_refused_at_their_place() {
    for (faults, body, counts) in cases() {
        assert_eq!(faults(&body), Vec::<String>::new(), "{body}");
        for (count, extreme) in counts.iter().flat_map(|count| EXTREMES.map(|extreme| (*count, extreme))) {
            let mut body = body.clone();
            *body.pointer_mut(count).unwrap() = json!(extreme);
            let found = faults(&body);
            if extreme > 10_000_000 && !(count.ends_with("seed") && extreme < 1 << 53) {
                assert!(found.iter().any(|pointer| pointer == count), "{count} = {extreme}: {found:?}");
            }
        }
    }
}

/// Nothing overflows.
#[test]
fn extreme_numbers_may_stand_in_place_of_any_or_of_all_counts() {
    for (faults, body, counts) in cases() {
        for extreme in EXTREMES.into_iter().filter(|extreme| *extreme > 1 << 53) {
            let mut body = body.clone();
            counts.iter().for_each(|count| *body.pointer_mut(count).unwrap() = json!(extreme));
            let found = faults(&body);
            assert!(counts.iter().all(|count| found.iter().any(|pointer| pointer == count)), "{extreme}: {found:?}");
        }
        for (place, _) in nodes(&body).into_iter().filter(|(_, value)| value.is_number()) {
            for extreme in [json!(u64::MAX), json!(i64::MIN), json!(1e308), json!(-1e308), json!(1e-308)] {
                let mut body = body.clone();
                *body.pointer_mut(&place).unwrap() = extreme;
                let _ = faults(&body);
            }
        }
    }
}

#[test]
fn a_number_is_found_as_a_pointer_finds_it_in_the_written_document() {
    let peak = |radius, shear| Peak { radius: Some(radius), x: None, shear };
    let residual = Residual {
        centre: None,
        peaks: vec![peak(1e-5, Some(-2.5)), peak(2e-5, None)],
        max: Some(2.5),
        min: Some(2.5),
        mean: Some(2.5),
        relative: Some(2.5),
    };
    let written = serde_json::to_value(&residual).unwrap();
    for pointer in ["/max", "/centre", "/peaks/0/radius", "/peaks/0/shear", "/peaks/1/shear"] {
        let found = lookup(&residual, &Pointer::parse(pointer).unwrap());
        assert_eq!(found, Lookup::Number(written.pointer(pointer).unwrap().as_f64()), "{pointer}");
    }
    for (pointer, found) in [
        ("/peaks/2/radius", Lookup::Nothing),
        ("/peaks/00/radius", Lookup::Nothing),
        ("/none", Lookup::Nothing),
        ("/max/0", Lookup::Nothing),
        ("/centre/0", Lookup::Nothing),
        ("/peaks", Lookup::Other),
        ("/peaks/0", Lookup::Other),
        ("", Lookup::Other),
    ] {
        assert_eq!(lookup(&residual, &Pointer::parse(pointer).unwrap()), found, "{pointer}");
    }
    let stress = Stress { radius: Some(vec![0.0]), ..Stress::default() };
    assert_eq!(lookup(&stress, &Pointer::parse("/shear/0").unwrap()), Lookup::Nothing);
}

#[test]
fn numbers_are_put_where_numbers_are_or_may_be() {
    let base = json!({"a": [1, {"b/c": 2.5}], "text": "x"});
    for (pointer, value) in [("/a/0", 7), ("/a/1/b~1c", 7), ("/new", 7), ("/a/1/new", 7)] {
        let mut document = base.clone();
        let pointer = Pointer::parse(pointer).unwrap();
        assert!(pointer.put(&mut document, Number::from(value)), "{pointer}");
        assert_eq!(document.pointer(&pointer.to_string()), Some(&json!(7)));
    }
    for pointer in ["", "/text", "/a", "/a/2", "/a/00", "/a/-", "/text/x", "/none/x"] {
        let mut document = base.clone();
        assert!(!Pointer::parse(pointer).unwrap().put(&mut document, Number::from(7)), "{pointer}");
        assert_eq!(document, base);
    }
    assert!(Pointer::parse("a").is_none() && Pointer::parse("/~2").is_none());
}

#[test]
fn a_member_given_twice_is_refused_wherever_it_is() {
    let of = |text: &str| serde_json::from_str::<JsonValue>(text);
    assert_eq!(of(r#"{"a":[1,-2,0.1,"s",null,true,{}]}"#).unwrap().0, json!({"a":[1,-2,0.1,"s",null,true,{}]}));
    assert!(of(r#"{"a":[{"b":1,"b":1}]}"#).unwrap_err().to_string().contains("duplicate field `b`"));
}
