//! The picture of a fatigue criterion over HTTP and on the command line: which one it shows, where its unit and its
//! marks come from, and what has none.

use crate::common;

use std::io::Write as _;
use std::process::{Command, Stdio};

use common::{Server, ball, good, number, of, problem};
use serde_json::{Value, json};

/// Three criteria in the plane of the motion.
fn asked() -> Value {
    json!({
        "path": {"displacement": [1e-7, -1e-7]}, "body": "first",
        "plane": {"normal": "y", "offset": 0.0, "x": [-1.2e-4, 1.2e-4, 13], "z": [0.0, 6e-5, 5]},
        "criteria": {"crossland": {"alpha": 0.3}, "findley": {"k": 0.3}}
    })
}

fn with(changes: &Value) -> Value {
    let mut asked = asked();
    asked.as_object_mut().unwrap().extend(changes.as_object().unwrap().clone());
    for place in ["points", "line", "surface"] {
        if asked.get(place).is_some() {
            asked.as_object_mut().unwrap().remove("plane");
        }
    }
    of(&ball(), &asked)
}

async fn svg(server: &Server, query: &str, body: &Value) -> String {
    let reply = server.post(&format!("/fretting?format=svg{query}"), body).await;
    assert_eq!(reply.status(), 200, "{query}");
    reply.text().await.unwrap()
}

#[tokio::test]
async fn a_picture_shows_the_criterion_that_is_named_in_its_own_unit() {
    let server = Server::start().await;
    let surface = json!({
        // The middles of its sides slip, and the trailing one is under tension.
        "surface": {"x": [-6.6e-5, 6.6e-5, 5], "y": [-6.6e-5, 6.6e-5, 5]},
        "criteria": {"ruiz": {}, "friction_work": {}, "dang_van": {"alpha": 0.3}}
    });
    for (changes, name, title, unit) in [
        (json!({}), "crossland", "Crossland", "MPa"),
        (json!({}), "findley", "Findley", "MPa"),
        (surface.clone(), "dang_van", "Dang Van", "MPa"),
        (surface.clone(), "friction_work", "Friction work per cycle", "J/m²"),
        (surface.clone(), "ruiz_tension", "Ruiz, with tension", "N²/m³"),
        (surface, "ruiz", "Ruiz, shear stress times slip", "N/m"),
    ] {
        let body = with(&changes);
        let reply = good(server.post("/fretting", &body).await).await;
        let largest = &reply[name]["largest"];
        let text = svg(&server, &format!("&criterion={name}"), &body).await;
        // The title has the value of the reply in the unit of the scale, whatever the prefix.
        let heading = text.lines().find(|line| line.starts_with(&format!("{title}, first body: largest "))).unwrap();
        let shown = heading.split("largest ").nth(1).unwrap().split(" at ").next().unwrap();
        let (digits, shown_unit) = shown.split_once(' ').unwrap();
        let exact = number(&largest["value"]);
        let mantissa = |value: f64| value / 10f64.powf(value.log10().floor());
        assert!((mantissa(digits.parse().unwrap()) / mantissa(exact) - 1.0).abs() < 1e-3, "{heading} {exact}");
        assert!(heading.contains(unit), "{heading}");
        let scale = shown_unit.trim_start_matches("· ");
        assert!(
            text.contains(&format!("{title} / {scale}")) || text.contains(&format!("{title} / ({scale})")),
            "{scale}"
        );
        // A ring in the legend, and one with its halo at the worst place.
        assert_eq!(text.matches("<circle").count(), 3, "{name}");
        assert!(text.contains("edge of the contact at the preload"));
    }
    // One criterion alone needs no name; Ruiz's second parameter comes with the first.
    let text = svg(&server, "", &with(&json!({"criteria": {"crossland": {"alpha": 0.3}}}))).await;
    assert!(text.contains("Crossland, first body: largest "));
    let ruiz = json!({"surface": {"x": [-1e-4, 1e-4, 3], "y": [-1e-4, 1e-4, 3]}, "criteria": {"ruiz": {}}});
    assert!(svg(&server, "", &with(&ruiz)).await.contains("Ruiz, shear stress times slip"));
    let png = server.post("/fretting?format=png&criterion=findley", &with(&json!({}))).await;
    assert!(png.bytes().await.unwrap().starts_with(b"\x89PNG"));
    // A table has all of them, whichever is named.
    let table = server.post("/fretting?format=csv&criterion=findley", &with(&json!({}))).await.text().await.unwrap();
    assert!(table.starts_with("x,y,z,crossland,findley\n"));
}

#[tokio::test]
async fn a_line_is_a_curve_and_points_have_no_picture() {
    let server = Server::start().await;
    for (line, axis, is_on_contact) in [
        (json!({"from": [-1e-4, 0.0, 0.0], "to": [1e-4, 0.0, 0.0], "count": 41}), "x, along the motion / µm", true),
        (json!({"from": [-5e-5, 0.0, 0.0], "to": [-5e-5, 0.0, 5e-5], "count": 41}), "z, the depth / µm", false),
        (json!({"from": [0.0, 0.0, 0.0], "to": [5e-5, 5e-5, 0.0], "count": 41}), "distance along the line / µm", true),
    ] {
        let text = svg(&server, "&criterion=crossland", &with(&json!({"line": line}))).await;
        assert!(text.contains(axis) && text.contains("Crossland, first body: largest "), "{line}");
        assert_eq!(text.contains("on the contact at the preload"), is_on_contact, "{line}");
    }
    let points = with(&json!({"points": [[0.0, 0.0, 1e-5], [1e-5, 0.0, 1e-5]]}));
    let refused = problem(server.post("/fretting?format=svg&criterion=crossland", &points).await).await;
    assert_eq!(refused.errors[0].pointer, "/points");
    assert!(refused.errors[0].detail.contains("`plane`"), "{}", refused.errors[0].detail);
}

#[tokio::test]
async fn a_criterion_that_cannot_be_shown_is_refused_with_those_that_can() {
    let server = Server::start().await;
    for (query, named) in [
        ("?format=svg", &["choose one of `crossland`, `findley`"][..]),
        ("?format=svg&criterion=swt", &["`swt` is not asked for", "`crossland`, `findley`"]),
        ("?format=csv&criterion=ruiz", &["`ruiz` is not asked for", "`crossland`, `findley`"]),
        ("?criterion=tresca", &["`tresca` is not one of", "`dang_van`", "`ruiz_tension`"]),
        ("?criterion=findley&criterion=crossland", &["given twice"]),
    ] {
        let refused = problem(server.post(&format!("/fretting{query}"), &with(&json!({}))).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, "/criterion"), "{query}");
        for named in named {
            assert!(refused.errors[0].detail.contains(named), "{query}: {}", refused.errors[0].detail);
        }
    }
}

#[test]
fn the_command_line_names_the_criterion_likewise() {
    let run = |more: &[&str]| {
        let mut child = Command::new(env!("CARGO_BIN_EXE_stickslip"))
            .args([&["fretting", "-"], more].concat())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // An option that is refused is refused before the document is read, so that the pipe may be closed already.
        let _ = child.stdin.take().unwrap().write_all(with(&json!({})).to_string().as_bytes());
        let done = child.wait_with_output().unwrap();
        (done.status.success(), [done.stdout, done.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()))
    };
    let (good, [svg, _]) = run(&["--format", "svg", "--criterion", "findley"]);
    assert!(good && svg.contains("Findley, first body: largest "));
    for (arguments, said) in [
        (&["--format", "svg"][..], "choose one of `crossland`, `findley`"),
        (&["--format", "svg", "--criterion", "swt"], "`swt` is not asked for"),
        (&["--criterion", "tresca"], "expected: crossland or dang_van"),
    ] {
        let (good, [_, error]) = run(arguments);
        assert!(!good && error.contains(said), "{error}");
    }
}
