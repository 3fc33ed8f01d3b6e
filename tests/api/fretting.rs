//! The criterion that a picture shows, by its parameter and its flag. The pictures are tested in
//! `crates/compute/tests/documents/fretting.rs`.

use serde_json::json;

use crate::common::{Server, assert_refused, ball, of, problem, run, with};

#[tokio::test]
async fn a_criterion_is_named_by_a_parameter_or_a_flag_or_refused() {
    let server = Server::start().await;
    let plane = json!({"normal": "y", "offset": 0.0, "x": [-1.2e-4, 1.2e-4, 13], "z": [0.0, 6e-5, 5]});
    let asked = json!({"path": {"displacement": [1e-7, -1e-7]}, "body": "first", "plane": plane,
        "criteria": {"crossland": {"alpha": 0.3}, "findley": {"k": 0.3}}});
    let body = of(&ball(), &asked);
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
    let mut places = with(body.clone(), "/points", json!([[0.0, 0.0, 1e-5]]));
    places.as_object_mut().unwrap().remove("plane");
    assert_refused(&server, "/fretting?format=svg&criterion=findley", &places, ("invalid_input", "/points", "`plane`"))
        .await;
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
