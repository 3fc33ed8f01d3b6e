//! Bad input around the members of a document, which `faults.rs` has and `crates/compute/tests/documents`: the
//! envelope, queries, headers, moves and the amount of work. Every refusal is a problem document, and nothing is ever a
//! 500.

use std::time::Duration;

use reqwest::Method;
use serde_json::{Value, json};
use stickslip::admission::{Capacity, Pool};

use crate::common::{Server, assert_refused, ball, changed, good, of, problem, with};

fn simulation(path: Value) -> Value {
    of(&ball(), &json!({"path": path}))
}

#[tokio::test]
async fn work_is_bounded() {
    let server = Server::start().await;
    let long = simulation(json!({"falling_amplitude": {"reversals": 99_999}}));
    let springs = with(long.clone(), "/solver", json!({"springs": {"count": 1_000_000}}));
    assert_refused(&server, "/simulate", &springs, ("invalid_input", "/solver/springs/count", "")).await;
    let last = with(long, "/steps", json!("last"));
    good(server.post("/simulate", &last).await).await;
    let pool = Pool::new(Capacity { deadline: Duration::from_secs(1), ..Capacity::default() });
    let server = Server::in_pool(pool).await;
    let refused = problem(server.post("/simulate", &changed(last, &json!({"residual": true}))).await).await;
    assert_eq!((refused.status, refused.code.as_str()), (422, "too_much_work"));
}

#[tokio::test]
async fn a_long_text_in_the_head_does_not_come_back_whole() {
    let server = Server::start().await;
    let (id, long) = (server.contact().await, "x".repeat(30_000));
    let contact = format!("/contacts/{id}");
    let (get, moved) = (Method::GET, format!("{contact}/move"));
    let body = Some("{\"force\": 1}");
    for (method, path, body, header) in [
        (&get, format!("/contacts/{long}"), None, ""),
        (&Method::DELETE, format!("/contacts/{long}"), None, ""),
        (&get, format!("/contacts/{long}/stress?points=5"), None, ""),
        (&get, format!("/jobs/{long}"), None, ""),
        (&get, format!("/problems/{long}"), None, ""),
        (&get, format!("/{long}"), None, ""),
        (&get, format!("/contacts?{long}=1"), None, ""),
        (&get, format!("/contacts?after={long}"), None, ""),
        (&get, format!("/contacts?label={long}"), None, ""),
        (&get, format!("{contact}/history?format={long}"), None, ""),
        (&get, format!("{contact}/stress?points={long}"), None, ""),
        (&get, format!("{contact}/stress?points=5&fields={long}"), None, ""),
        (&Method::POST, moved.clone(), body, "if-match"),
        (&Method::POST, moved.clone(), body, "idempotency-key"),
        (&Method::POST, moved, body, "content-encoding"),
        (&get, format!("{contact}/stress?points=5"), None, "accept"),
        (&get, format!("{contact}/events"), None, "last-event-id"),
    ] {
        let headers: &[(&str, &str)] = if header.is_empty() { &[] } else { &[(header, &long)] };
        let refused = server.send(method.clone(), &path, body, headers).await;
        assert!(refused.status().is_client_error(), "{:.40} {header}", path);
        let text = refused.text().await.unwrap();
        assert!(text.len() < 2_000, "{header} {} bytes: {:.200}", text.len(), text);
    }
}

#[tokio::test]
async fn the_envelope_is_checked_too() {
    let server = Server::start().await;
    let contact = format!("/contacts/{}", server.contact().await);
    let sound = simulation(json!({"displacement": [1e-7, 0.0]})).to_string();
    let deep = "[".repeat(200_000);
    let nested = format!("{{\"contact\":{}", "{\"profile\":".repeat(50_000));
    let large = format!("{{\"path\": \"{}\"}}", "x".repeat(9 * 1024 * 1024));
    let (moved, stress) = (format!("{contact}/move"), format!("{contact}/stress"));
    let (get, post, none) = (Method::GET, Method::POST, "01890a5d-ac96-774b-bcce-b302099a8057");
    let (nobody, force) = (format!("/contacts/{none}"), Some("{\"force\": 1}"));
    let type_of = |kind| vec![("content-type", kind)];
    for (method, path, body, headers, status, code) in [
        (&post, "/simulate", Some("nonsense"), vec![], 400, "not_json"),
        (&post, "/simulate", Some(""), vec![], 400, "not_json"),
        (&post, "/simulate", Some(&*deep), vec![], 400, "not_json"),
        (&post, "/simulate", Some(&*nested), vec![], 400, "not_json"),
        (&post, "/simulate", Some("[1, 2]"), vec![], 422, "invalid_input"),
        (&post, "/simulate", Some("null"), vec![], 422, "invalid_input"),
        (&post, "/simulate", Some(&*large), vec![], 413, "too_large"),
        (&post, "/simulate", None, vec![], 415, "unsupported_media_type"),
        (&post, "/contacts", None, type_of("text/plain"), 415, "unsupported_media_type"),
        (&post, "/contacts", None, type_of("application/jsonp"), 415, "unsupported_media_type"),
        (&Method::PUT, "/simulate", Some(&*sound), vec![], 405, "method_not_allowed"),
        (&get, "/nowhere", None, vec![], 404, "not_found"),
        (&get, "/problems/none", None, vec![], 404, "not_found"),
        (&get, "/docs//index.css", None, vec![], 404, "not_found"),
        (&get, "/contacts/7", None, vec![], 404, "contact_not_found"),
        (&get, "/contacts/%ff", None, vec![], 404, "contact_not_found"),
        (&get, &*nobody, None, vec![], 404, "contact_not_found"),
        (&Method::DELETE, &*nobody, None, vec![], 404, "contact_not_found"),
        (&post, &*moved, Some("{}"), vec![], 422, "invalid_input"),
        (&post, &*moved, force, vec![("if-match", "0")], 422, "invalid_input"),
        (&post, &*moved, force, vec![("idempotency-key", "")], 422, "invalid_input"),
        (&post, &*moved, force, vec![("idempotency-key", "two words")], 422, "invalid_input"),
        (&post, &*moved, Some("{\"force\": 30}"), vec![], 422, "force_exceeds_friction"),
        (&get, &*stress, None, vec![], 422, "invalid_input"),
    ] {
        let refused = problem(server.send(method.clone(), path, body, &headers).await).await;
        assert_eq!((refused.status, refused.code.as_str()), (status, code), "{method} {path} {headers:?}: {refused:?}");
    }
    // A letter by its percent sign is the same path.
    assert_eq!(server.get("/problems/not%5Ffound").await.status(), 200);
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
        (&*format!("{contact}/history?after=-1"), "/after"),
    ] {
        let refused = problem(server.get(path).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, pointer), "{path}");
    }
    // Pairs of the plane have no meaning for a stored contact.
    let turn = json!({"moves": [{"displacement": [1e-8, 0.0]}, {"displacement": [0.0, 1e-8]}]});
    for (call, body, pointer) in [
        ("move", json!({"displacement": [1e-8, 1e-8]}), "/displacement"),
        ("path", json!({"path": turn}), "/path/moves/0/displacement"),
        ("path", json!({"path": {"ellipse": {}}}), "/path"),
    ] {
        let refused = problem(server.post(&format!("{contact}/{call}"), &body).await).await;
        assert!(refused.status == 422 && refused.errors[0].pointer.starts_with(pointer), "{call}: {refused:?}");
    }
    let allowed = server.send(Method::PUT, "/contacts", None, &type_of("application/json")).await;
    assert!(allowed.headers()["allow"].to_str().unwrap().contains("POST"));
    let charset = ("content-type", "application/json; charset=utf-8");
    let call = server.http.post(format!("{}/simulate", server.base)).header(charset.0, charset.1).body(sound);
    assert_eq!(call.send().await.unwrap().status(), 200);
    assert_eq!(good(server.get(&contact).await).await["sequence"], 0);
}
