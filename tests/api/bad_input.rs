//! Bad input: every refusal is a problem document that names the place, and nothing is ever a 500.

use crate::common;

use std::sync::Arc;
use std::time::Duration;

use common::{Server, ball, problem};
use reqwest::Method;
use serde_json::{Value, json};
use stickslip::admission::{Capacity, Pool};
use stickslip::sessions::{CAPACITY, Sessions};
use stickslip::store::MemoryStore;

/// A sound simulation with the value at a pointer replaced; `null` removes it.
fn with(pointer: &str, value: Value) -> Value {
    let mut body = json!({"contact": ball(), "path": {"displacement": [1e-7, 0.0]}});
    let (parent, member) = pointer.rsplit_once('/').unwrap();
    let parent = body.pointer_mut(parent).unwrap();
    match (value, parent) {
        (Value::Null, Value::Object(members)) => drop(members.remove(member)),
        (value, Value::Array(elements)) => elements[member.parse::<usize>().unwrap()] = value,
        (value, parent) => parent[member] = value,
    }
    body
}

#[tokio::test]
async fn every_fault_is_named_at_its_place() {
    let server = Server::start().await;
    let many = vec![0.0; 100_001];
    for (pointer, value, named, word) in [
        ("/contact/profile/radius", json!(-1.0), "/contact/profile/radius", "1e-15"),
        ("/contact/profile/radius", json!("wide"), "/contact/profile/radius", "a number"),
        ("/contact/profile/radius", Value::Null, "/contact/profile/radius", "missing"),
        ("/contact/profile/type", json!("cube"), "/contact/profile/type", "sphere"),
        ("/contact/profile/colour", json!("red"), "/contact/profile/colour", "unknown field"),
        ("/contact/friction", json!(-0.1), "/contact/friction", "0 to 100"),
        ("/contact/friction", Value::Null, "/contact/friction", "missing"),
        ("/contact/material/bodies", json!(["rigid", "rigid"]), "/contact/material/bodies", "elastic"),
        ("/contact/material/bodies/1", json!("soft"), "/contact/material/bodies/1", "rigid"),
        ("/contact/material/bodies", json!(["rigid"]), "/contact/material/bodies", "2"),
        ("/contact/material/bodies/0/poisson_ratio", json!(0.6), "/contact/material/bodies/0/poisson_ratio", "0.5"),
        (
            "/contact/material",
            json!({"effective": {"e_star": 0.0, "g_star": 1e9}}),
            "/contact/material/effective/e_star",
            "Pa",
        ),
        ("/contact/preload", json!({"weight": 1.0}), "/contact/preload", "`normal_force`"),
        ("/contact/preload", json!({"normal_force": 1.0, "indentation": 1.0}), "/contact/preload", "conflicts"),
        ("/contact/preload/normal_force", json!(-1.0), "/contact/preload/normal_force", "0 to"),
        ("/path", json!({"displacement": many}), "/path/displacement", "100000"),
        ("/path", json!({"displacement": []}), "/path/displacement", "1 to"),
        ("/path/displacement/1", json!(1e10), "/path/displacement/1", "1e9 m"),
        ("/path/displacement/1", json!(true), "/path/displacement/1", "a number"),
        ("/path", json!({"moves": [{"force": 1.0}, {}]}), "/path/moves/1", "no target"),
        ("/path", json!({"moves": [{"force": 1.0, "displacement": 0.0}]}), "/path/moves/0/force", "at most one"),
        ("/path", json!({"moves": [{"speed": 1.0}]}), "/path/moves/0/speed", "unknown field"),
        ("/path", json!({"falling_amplitude": {"reversals": 0}}), "/path/falling_amplitude/reversals", "1 to"),
        ("/path", json!({"falling_amplitude": {"reversals": 2.5}}), "/path/falling_amplitude/reversals", "whole"),
        ("/path", json!({"spiral": {}}), "/path", "`falling_amplitude`"),
        ("/stress", json!({"points": 1}), "/stress/points", "2 to 10000"),
        ("/stress", json!({}), "/stress", "`radii`"),
        ("/stress", json!({"points": 2, "radii": [0.0]}), "/stress", "conflicts"),
        ("/stress", json!({"radii": [0.0, -1.0]}), "/stress/radii/1", "0 to"),
        ("/stress", json!({"points": 2, "fields": ["heat"]}), "/stress/fields/0", "`pressure`"),
        ("/steps", json!("some"), "/steps", "`all`"),
        ("/solver", json!("magic"), "/solver", "exact"),
        ("/solver", json!({"springs": {"count": 1}}), "/solver/springs/count", "2 to"),
        ("/tolerance", json!(1.0), "/tolerance", "1e-2"),
        ("/residual", json!("yes"), "/residual", "true or false"),
        ("/extra", json!(1), "/extra", "unknown field"),
    ] {
        let refused = problem(server.post("/simulate", &with(pointer, value.clone())).await).await;
        let shown =
            format!("{pointer} {}: {:?}", value.to_string().chars().take(60).collect::<String>(), refused.errors);
        assert_eq!((refused.status, refused.code.as_str()), (422, "invalid_input"), "{shown}");
        assert_eq!(refused.errors[0].pointer, named, "{shown}");
        assert!(refused.errors[0].detail.contains(word), "{shown}");
    }
}

#[tokio::test]
async fn a_label_holds_no_character_that_ends_a_text_in_a_database() {
    let server = Server::start().await;
    let mut body = ball();
    body["label"] = json!("before\0after");
    let refused = problem(server.post("/contacts", &body).await).await;
    assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, "/label"));
}

#[tokio::test]
async fn all_ranges_are_reported_at_once() {
    let server = Server::start().await;
    let mut body = with("/contact/friction", json!(-1.0));
    body["contact"]["profile"]["radius"] = json!(0.0);
    body["path"] = json!({"displacement": [1e10, 0.0, -1e10]});
    let refused = problem(server.post("/simulate", &body).await).await;
    let pointers: Vec<&str> = refused.errors.iter().map(|fault| fault.pointer.as_str()).collect();
    assert_eq!(
        pointers,
        ["/contact/profile/radius", "/contact/friction", "/path/displacement/0", "/path/displacement/2"]
    );
}

#[tokio::test]
async fn numbers_that_are_none_are_invalid_and_not_a_syntax_error() {
    let server = Server::start().await;
    let sound = with("/path/displacement/1", json!(12.5)).to_string();
    for number in ["1e999", "-1e999", "null", "\"NaN\""] {
        let refused =
            problem(server.send(Method::POST, "/simulate", Some(&sound.replace("12.5", number)), &[]).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, "/path/displacement/1"), "{number}");
    }
    for number in ["NaN", "Infinity", "1e", ".5", "0x1"] {
        let refused =
            problem(server.send(Method::POST, "/simulate", Some(&sound.replace("12.5", number)), &[]).await).await;
        assert_eq!((refused.status, refused.code.as_str()), (400, "not_json"), "{number}");
    }
}

#[tokio::test]
async fn what_the_mechanics_cannot_answer_is_named_with_its_limit() {
    let server = Server::start().await;
    let body = with("/path", json!({"moves": [{"force": 1.0}, {"force": -3.5}]}));
    let refused = problem(server.post("/simulate", &body).await).await;
    assert_eq!((refused.status, refused.code.as_str()), (422, "force_exceeds_friction"));
    assert_eq!(refused.errors[0].pointer, "/path/moves/1");
    assert!(refused.errors[0].detail.contains("3e0") || refused.errors[0].detail.contains("= 3"), "{refused:?}");
}

#[tokio::test]
async fn work_is_bounded() {
    let server = Server::start().await;
    let mut body = with("/path", json!({"falling_amplitude": {"reversals": 99_999}}));
    body["solver"] = json!({"springs": {"count": 1_000_000}});
    let refused = problem(server.post("/simulate", &body).await).await;
    assert_eq!(refused.errors[0].pointer, "/solver/springs/count");

    let mut body = with("/path", json!({"falling_amplitude": {"reversals": 99_999}}));
    body["steps"] = json!("last");
    assert_eq!(server.post("/simulate", &body).await.status(), 200);
    body["residual"] = json!(true);
    let pool = Pool::new(Capacity { deadline: Duration::from_secs(1), ..Capacity::default() });
    let sessions = Sessions::new(Arc::new(MemoryStore::new()), pool.clone(), CAPACITY);
    let server = Server::over(sessions, pool).await;
    let refused = problem(server.post("/simulate", &body).await).await;
    assert_eq!((refused.status, refused.code.as_str()), (422, "too_much_work"));
}

#[tokio::test]
async fn a_long_text_in_the_head_does_not_come_back_whole() {
    let server = Server::start().await;
    let (id, long) = (server.contact().await, "x".repeat(30_000));
    let moved = format!("/contacts/{id}/move");
    for (method, path) in [
        (Method::GET, format!("/contacts/{long}")),
        (Method::DELETE, format!("/contacts/{long}")),
        (Method::GET, format!("/contacts/{long}/stress?points=5")),
        (Method::GET, format!("/jobs/{long}")),
        (Method::GET, format!("/problems/{long}")),
        (Method::GET, format!("/{long}")),
        (Method::GET, format!("/contacts?{long}=1")),
        (Method::GET, format!("/contacts?after={long}")),
        (Method::GET, format!("/contacts?label={long}")),
        (Method::GET, format!("/contacts/{id}/history?format={long}")),
        (Method::GET, format!("/contacts/{id}/stress?points={long}")),
        (Method::GET, format!("/contacts/{id}/stress?points=5&fields={long}")),
    ] {
        let refused = server.send(method, &path, None, &[]).await;
        assert!(refused.status().is_client_error(), "{}", &path[..40]);
        let text = refused.text().await.unwrap();
        assert!(text.len() < 2_000, "{} bytes: {}", text.len(), &text[..200]);
    }
    for name in ["if-match", "idempotency-key", "content-encoding"] {
        let refused = server.send(Method::POST, &moved, Some("{\"force\": 1}"), &[(name, &long)]).await;
        assert!(refused.status().is_client_error(), "{name}");
        let text = refused.text().await.unwrap();
        assert!(text.len() < 2_000, "{name}: {} bytes", text.len());
    }
    for (name, of) in [("accept", "stress?points=5"), ("last-event-id", "events")] {
        let refused = server.send(Method::GET, &format!("/contacts/{id}/{of}"), None, &[(name, &long)]).await;
        assert!(refused.status().is_client_error(), "{name}");
        let text = refused.text().await.unwrap();
        assert!(text.len() < 2_000, "{name}: {} bytes", text.len());
    }
}

#[tokio::test]
async fn the_envelope_is_checked_too() {
    let server = Server::start().await;
    let id = server.contact().await;
    let sound = with("/path/displacement/1", json!(0.0)).to_string();
    let deep = "[".repeat(200_000);
    let nested = format!("{{\"contact\":{}", "{\"profile\":".repeat(50_000));
    let large = format!("{{\"path\": \"{}\"}}", "x".repeat(9 * 1024 * 1024));
    let contact = format!("/contacts/{id}");
    let (moved, stress, history) =
        (format!("{contact}/move"), format!("{contact}/stress"), format!("{contact}/history"));
    let json = ("content-type", "application/json");
    for (method, path, body, headers, status, code) in [
        (Method::POST, "/simulate", Some("nonsense"), vec![], 400, "not_json"),
        (Method::POST, "/simulate", Some(""), vec![], 400, "not_json"),
        (Method::POST, "/simulate", Some(&*deep), vec![], 400, "not_json"),
        (Method::POST, "/simulate", Some(&*nested), vec![], 400, "not_json"),
        (Method::POST, "/simulate", Some("[1, 2]"), vec![], 422, "invalid_input"),
        (Method::POST, "/simulate", Some("null"), vec![], 422, "invalid_input"),
        (Method::POST, "/simulate", Some(&*large), vec![], 413, "too_large"),
        (Method::POST, "/simulate", None, vec![], 415, "unsupported_media_type"),
        (Method::POST, "/contacts", None, vec![("content-type", "text/plain")], 415, "unsupported_media_type"),
        (Method::POST, "/contacts", None, vec![("content-type", "application/jsonp")], 415, "unsupported_media_type"),
        (Method::PUT, "/simulate", Some(&*sound), vec![], 405, "method_not_allowed"),
        (Method::GET, "/nowhere", None, vec![], 404, "not_found"),
        (Method::GET, "/problems/none", None, vec![], 404, "not_found"),
        (Method::GET, "/contacts/7", None, vec![], 404, "contact_not_found"),
        (Method::GET, "/contacts/%ff", None, vec![], 404, "contact_not_found"),
        (Method::GET, "/contacts/01890a5d-ac96-774b-bcce-b302099a8057", None, vec![], 404, "contact_not_found"),
        (Method::DELETE, "/contacts/01890a5d-ac96-774b-bcce-b302099a8057", None, vec![], 404, "contact_not_found"),
        (Method::POST, "/contacts/7/move", Some("{\"force\": 1}"), vec![], 404, "contact_not_found"),
        (Method::POST, &*moved, Some("{}"), vec![], 422, "invalid_input"),
        (Method::POST, &*moved, Some("{\"force\": 1}"), vec![("if-match", "0")], 422, "invalid_input"),
        (Method::POST, &*moved, Some("{\"force\": 1}"), vec![("if-match", "\"1\"")], 412, "stale_sequence"),
        (Method::POST, &*moved, Some("{\"force\": 1}"), vec![("idempotency-key", "")], 422, "invalid_input"),
        (Method::POST, &*moved, Some("{\"force\": 1}"), vec![("idempotency-key", "two words")], 422, "invalid_input"),
        (Method::POST, &*moved, Some("{\"force\": 30}"), vec![], 422, "force_exceeds_friction"),
        (Method::DELETE, &*contact, None, vec![("if-match", "\"9\"")], 412, "stale_sequence"),
        (Method::GET, &*stress, None, vec![], 422, "invalid_input"),
    ] {
        let shown = format!("{method} {path} {headers:?}");
        let refused = problem(server.send(method, path, body, &headers).await).await;
        assert_eq!((refused.status, refused.code.as_str()), (status, code), "{shown}: {}", refused.detail);
    }
    for (path, pointer) in [
        ("/contacts?limit=0", "/limit"),
        ("/contacts?limit=1001", "/limit"),
        ("/contacts?after=7", "/after"),
        ("/contacts?sort=label", "/sort"),
        ("/contacts?limit=1&limit=2", "/limit"),
        (&*format!("{contact}?x=1"), "/x"),
        (&*format!("{stress}?points=1"), "/points"),
        (&*format!("{stress}?points=many"), "/points"),
        (&*format!("{stress}?radii=0,-1"), "/radii/1"),
        (&*format!("{stress}?radii=0,,1"), "/radii"),
        (&*format!("{stress}?radii=NaN"), "/radii/0"),
        (&*format!("{stress}?points=5&fields=heat"), "/fields"),
        (&*format!("{stress}?points=5&residual=maybe"), "/residual"),
        (&*format!("{history}?after=-1"), "/after"),
    ] {
        let refused = problem(server.get(path).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, pointer), "{path}");
    }
    let allowed = server.send(Method::PUT, "/contacts", None, &[json]).await;
    assert!(allowed.headers()["allow"].to_str().unwrap().contains("POST"));
    let charset = [("content-type", "application/json; charset=utf-8")];
    let call = server.http.post(format!("{}/simulate", server.base)).header(charset[0].0, charset[0].1).body(sound);
    assert_eq!(call.send().await.unwrap().status(), 200);
    assert_eq!(server.client.contact(id.parse().unwrap()).await.unwrap().sequence, 0);
}
