//! The picture of a fatigue criterion. The rest is tested in `crates/compute/tests/documents/fretting.rs`.

use serde_json::{Value, json};

use crate::common::{Server, assert_refused, ball, changed, good, number, of, problem, run};

/// A cycle in partial slip of the ball, rated by Crossland below its middle.
fn asked(changes: Value) -> Value {
    let mut body = json!({"path": {"displacement": [1e-7, -1e-7]}, "body": "first",
        "points": [[0.0, 0.0, 1e-5]], "criteria": {"crossland": {"alpha": 0.3}}});
    if ["plane", "line", "surface", "search"].iter().any(|place| changes.get(place).is_some()) {
        body.as_object_mut().unwrap().remove("points");
    }
    let mut body = changed(body, &changes);
    body.as_object_mut().unwrap().remove("search");
    of(&ball(), &body)
}

async fn rated(server: &Server, body: &Value) -> Value {
    good(server.post("/fretting", body).await).await
}

async fn svg(server: &Server, query: &str, body: &Value) -> String {
    let reply = server.post(&format!("/fretting?format=svg{query}"), body).await;
    assert_eq!(reply.status(), 200, "{query}");
    reply.text().await.unwrap()
}

#[tokio::test]
async fn a_picture_shows_the_criterion_that_is_named_in_its_own_unit() {
    let server = Server::start().await;
    let plane = json!({
        "plane": {"normal": "y", "offset": 0.0, "x": [-1.2e-4, 1.2e-4, 13], "z": [0.0, 6e-5, 5]},
        "criteria": {"crossland": {"alpha": 0.3}, "findley": {"k": 0.3}}
    });
    let surface = json!({
        // The middles of its sides slip, and the trailing one is under tension.
        "surface": {"x": [-6.6e-5, 6.6e-5, 5], "y": [-6.6e-5, 6.6e-5, 5]},
        "criteria": {"ruiz": {}, "friction_work": {}, "dang_van": {"alpha": 0.3}}
    });
    for (changes, name, title, unit) in [
        (&plane, "findley", "Findley", "MPa"),
        (&surface, "friction_work", "Friction work per cycle", "J/m²"),
        (&surface, "ruiz_tension", "Ruiz, with tension", "N²/m³"),
        (&surface, "ruiz", "Ruiz, shear stress times slip", "N/m"),
    ] {
        let body = asked(changes.clone());
        let exact = number(&rated(&server, &body).await[name]["largest"]["value"]);
        let text = svg(&server, &format!("&criterion={name}"), &body).await;
        // The title has the value of the reply in the unit of the scale, whatever the prefix.
        let heading = text.lines().find(|line| line.starts_with(&format!("{title}, first body: largest "))).unwrap();
        let shown = heading.split("largest ").nth(1).unwrap().split(" at ").next().unwrap();
        let (digits, shown_unit) = shown.split_once(' ').unwrap();
        let mantissa = |value: f64| value / 10f64.powf(value.log10().floor());
        assert!((mantissa(digits.parse().unwrap()) / mantissa(exact) - 1.0).abs() < 1e-3, "{heading} {exact}");
        assert!(heading.contains(unit), "{heading}");
        let scale = shown_unit.trim_start_matches("· ");
        assert!([scale.to_owned(), format!("({scale})")].iter().any(|it| text.contains(&format!("{title} / {it}"))));
        // A ring in the legend, and one with its halo at the worst place.
        assert_eq!(text.matches("<circle").count(), 3, "{name}");
        assert!(text.contains("edge of the contact at the preload"));
    }
    let line = |from: [f64; 3], to: [f64; 3]| asked(json!({"line": {"from": from, "to": to, "count": 41}}));
    for (body, axis, is_on_contact) in [
        (line([-1e-4, 0.0, 0.0], [1e-4, 0.0, 0.0]), "x, along the motion / µm", true),
        (line([-5e-5, 0.0, 0.0], [-5e-5, 0.0, 5e-5]), "z, the depth / µm", false),
        (line([0.0, 0.0, 0.0], [5e-5, 5e-5, 0.0]), "distance along the line / µm", true),
    ] {
        let text = svg(&server, "", &body).await;
        assert!(text.contains(axis) && text.contains("Crossland, first body: largest "), "{axis}");
        assert_eq!(text.contains("on the contact at the preload"), is_on_contact, "{axis}");
    }
    // Ruiz's second parameter comes with the first. A table has all criteria, whichever is named.
    let ruiz = changed(surface, &json!({"criteria": {"ruiz": {}}}));
    assert!(svg(&server, "", &asked(ruiz)).await.contains("Ruiz, shear stress times slip"));
    let body = asked(plane);
    let table = server.post("/fretting?format=csv&criterion=findley", &body).await.text().await.unwrap();
    assert!(table.starts_with("x,y,z,crossland,findley\n"));
    for (query, named) in [
        ("?format=svg", &["choose one of `crossland`, `findley`"][..]),
        ("?format=csv&criterion=ruiz", &["`ruiz` is not asked for", "`crossland`, `findley`"]),
        ("?criterion=tresca", &["`tresca` is not one of", "`dang_van`", "`ruiz_tension`"]),
        ("?criterion=findley&criterion=crossland", &["given twice"]),
    ] {
        let refused = problem(server.post(&format!("/fretting{query}"), &body).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, "/criterion"), "{query}");
        assert!(named.iter().all(|named| refused.errors[0].detail.contains(named)), "{query}: {refused:?}");
    }
    assert_refused(&server, "/fretting?format=svg", &asked(json!({})), ("invalid_input", "/points", "`plane`")).await;
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("body.json");
    std::fs::write(&file, body.to_string()).unwrap();
    for (arguments, said) in [
        (&["--format", "svg"][..], "choose one of `crossland`, `findley`"),
        (&["--format", "svg", "--criterion", "swt"], "`swt` is not asked for"),
        (&["--criterion", "tresca"], "expected: crossland or dang_van"),
    ] {
        let refused = run(&[&["fretting", file.to_str().unwrap()], arguments].concat());
        let error = String::from_utf8_lossy(&refused.stderr);
        assert!(!refused.status.success() && error.contains(said), "{error}");
    }
}
