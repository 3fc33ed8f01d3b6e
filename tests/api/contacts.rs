//! Contacts: one move at a time, all or nothing, repeatable, and the same after a replay to the last bit.

use crate::common;

use std::sync::Arc;

use common::{Server, ball, create, good, problem, varied_moves, with};
use futures::future::join_all;
use reqwest::{Method, Response, StatusCode};
use serde_json::{Value, json};
use stickslip::admission::Pool;
use stickslip::sessions::Sessions;
use stickslip::store::SqliteStore;
use stickslip_wire::client::Options;
use stickslip_wire::{ForkRequest, Move, PathRequest, Steps};

fn along(moves: Vec<Move>) -> PathRequest {
    PathRequest { steps: Steps::All, ..common::along(moves) }
}

#[tokio::test]
async fn a_path_is_all_or_nothing() {
    let server = Server::start().await;
    let (client, options) = (&server.client, Options::default());
    let id = client.create(&create(), &options).await.unwrap().id;
    client.apply(id, &Move::displacement(1e-7).into(), &options).await.unwrap();
    let before = client.contact(id).await.unwrap();

    let refused =
        client.path(id, &along(vec![Move::displacement(0.0), Move::force(99.0)]), &options).await.unwrap_err();
    let refused = refused.problem().unwrap();
    assert_eq!(
        (refused.code.as_str(), refused.errors[0].pointer.as_str()),
        ("force_exceeds_friction", "/path/moves/1")
    );
    client.apply(id, &Move::force(99.0).into(), &options).await.unwrap_err();
    assert_eq!(client.contact(id).await.unwrap(), before);
    assert_eq!(client.history(id, None, None).await.unwrap().items.len(), 1);

    let reply = client.path(id, &along(vec![Move::displacement(0.0), Move::force(1.0)]), &options).await.unwrap();
    assert_eq!(reply.sequence, 3);
}

#[tokio::test]
async fn a_fork_begins_after_any_move_and_is_what_the_contact_was_then() {
    // Without a cache, every state is replayed.
    let pool = Pool::with_defaults();
    let server = Server::over(Sessions::new(Arc::new(SqliteStore::in_memory().unwrap()), pool.clone(), 0), pool).await;
    let (client, options) = (&server.client, Options::default());
    let id = client.create(&create(), &options).await.unwrap().id;
    let virgin = client.contact(id).await.unwrap().state;
    let path = client.path(id, &along(varied_moves(100, 0.0)), &options).await.unwrap();
    for sequence in [0_u64, 1, 33, 99, 100] {
        let wanted = ForkRequest { sequence: Some(sequence), label: None };
        let fork = client.fork(id, &wanted, &options).await.unwrap();
        let then = usize::try_from(sequence).unwrap();
        let expected = then.checked_sub(1).map_or(virgin, |last| path.steps[last]);
        assert_eq!((fork.sequence, fork.state), (sequence, expected));
        let past = client.history(fork.id, None, None).await.unwrap().items;
        assert_eq!(past, client.history(id, None, None).await.unwrap().items[..then]);
        // It goes on as the contact did.
        let rest = client.path(fork.id, &along(varied_moves(100, 0.0).split_off(then)), &options).await;
        assert!(then == 100 || rest.unwrap().steps == path.steps[then..]);
    }
    let target = format!("/contacts/{id}/fork");
    for wrong in ["101", "9223372036854775807"] {
        let body = format!("{{\"sequence\": {wrong}}}");
        let refused = problem(server.send(Method::POST, &target, Some(&body), &[]).await).await;
        let place = (refused.status, refused.errors[0].pointer.as_str(), refused.errors[0].detail.as_str());
        assert_eq!(place, (422, "/sequence", "the contact has made 100 moves: give 0 to 100"));
    }
    for wrong in ["-1", "1.5", "9223372036854775808", "\"3\"", "null"] {
        let body = format!("{{\"sequence\": {wrong}}}");
        let refused = problem(server.send(Method::POST, &target, Some(&body), &[]).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, "/sequence"), "{wrong}");
    }
    assert_eq!(client.contacts(None, None).await.unwrap().items.len(), 6);
}

#[tokio::test]
async fn the_newest_contacts_are_listed_first_where_that_is_asked_for() {
    let server = Server::start().await;
    let mut made = Vec::new();
    for _ in 0..5 {
        made.push(server.client.create(&create(), &Options::default()).await.unwrap().id);
    }
    let page = async |after, limit| {
        let page = server.client.newest_contacts(after, Some(limit)).await.unwrap();
        (page.items.into_iter().map(|item| item.id).collect::<Vec<_>>(), page.next)
    };
    assert_eq!(page(None, 2).await, (vec![made[4], made[3]], Some(made[3])));
    assert_eq!(page(Some(made[3]), 9).await, (vec![made[2], made[1], made[0]], None));
    let oldest = good(server.get("/contacts?order=oldest").await).await;
    assert_eq!(oldest, good(server.get("/contacts").await).await);
    assert_eq!(oldest["items"][0]["id"], made[0].to_string());
    let refused = problem(server.get("/contacts?order=latest").await).await;
    assert!(refused.errors[0].detail.contains("`oldest`, `newest`"), "{refused:?}");
}

#[tokio::test]
async fn a_new_label_is_no_move_and_is_found() {
    let server = Server::start().await;
    let (client, options) = (&server.client, Options::default());
    let id = client.create(&create(), &options).await.unwrap().id;
    let other = client.create(&create(), &options).await.unwrap().id;
    client.apply(id, &Move::displacement(1e-7).into(), &options).await.unwrap();
    let before = client.contact(id).await.unwrap();
    let target = format!("/contacts/{id}");
    let tags = async || server.get(&target).await.headers()["etag"].to_str().unwrap().to_owned();
    let old = tags().await;
    let found = async |label: &str| {
        let items = client.contacts_labelled(label, None, None).await.unwrap().items;
        items.into_iter().map(|item| item.id).collect::<Vec<_>>()
    };
    assert!(found("").await.is_empty(), "a contact without a label is not found by one");

    let renamed = client.rename(id, Some("Ärger im STAHL, 3 %_"), &options).await.unwrap();
    assert_eq!(renamed, client.contact(id).await.unwrap());
    assert_eq!(renamed.label.as_deref(), Some("Ärger im STAHL, 3 %_"));
    assert_eq!((renamed.sequence, renamed.state, renamed.updated_at), (1, before.state, before.updated_at));
    // A browser that has the old name asks for the new one.
    let headers = [("if-none-match", old.as_str())];
    assert_eq!(server.send(Method::GET, &target, None, &headers).await.status(), StatusCode::OK);
    let new = tags().await;
    let headers = [("if-none-match", new.as_str())];
    assert_eq!(server.send(Method::GET, &target, None, &headers).await.status(), StatusCode::NOT_MODIFIED);
    assert_eq!((found("im stahl, 3 %_").await, found("ärger").await), (vec![id], vec![]));
    client.rename(other, Some("stahl"), &options).await.unwrap();
    assert_eq!(found("stahl").await, [id, other]);
    let page = client.contacts_labelled("stahl", None, Some(1)).await.unwrap();
    assert_eq!((page.items[0].id, page.next), (id, Some(id)));
    assert_eq!(client.contacts_labelled("stahl", page.next, Some(1)).await.unwrap().items[0].id, other);

    let long = json!({"label": "x".repeat(201)}).to_string();
    for body in ["{}", &long] {
        let refused = problem(server.send(Method::PATCH, &target, Some(body), &[]).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, "/label"), "{body}");
    }
    for query in [format!("label={}", "x".repeat(201)), "label=%00".to_owned()] {
        let refused = problem(server.get(&format!("/contacts?{query}")).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, "/label"));
    }
}

#[tokio::test]
async fn a_tag_with_a_label_compares_the_label_too() {
    let server = Server::start().await;
    let id = server.post("/contacts", &with(ball(), "/label", json!("a"))).await.json::<Value>().await.unwrap();
    let target = format!("/contacts/{}", id["id"].as_str().unwrap());
    let tag_of = |response: &Response| response.headers()["etag"].to_str().unwrap().to_owned();
    let shown = async || tag_of(&server.get(&target).await);
    let rename = async |tag: &str, label: Value| {
        let body = json!({"label": label}).to_string();
        server.send(Method::PATCH, &target, Some(&body), &[("if-match", tag)]).await
    };
    // Of two clients with one tag the second has not seen the label that it would replace.
    let first = shown().await;
    let renamed = rename(&first, json!("b")).await;
    assert_eq!((renamed.status().as_u16(), tag_of(&renamed)), (200, shown().await));
    let steps = json!({"path": {"displacement": [1e-8]}}).to_string();
    let measured = json!({"observations": [{"displacement": 1e-8, "force": 0.1}]}).to_string();
    let asked = |tag: String| {
        let (server, target, steps, measured) = (&server, &target, &steps, &measured);
        async move {
            let send = async |method, path: &str, body: &str| {
                server.send(method, &format!("{target}{path}"), Some(body), &[("if-match", &*tag)]).await
            };
            [
                send(Method::PATCH, "", "{\"label\": \"c\"}").await,
                send(Method::POST, "/relax", "{\"reversals\": 2, \"dry_run\": true}").await,
                send(Method::POST, "/relax", "{\"reversals\": 2}").await,
                send(Method::POST, "/move", "{\"displacement\": 1e-8}").await,
                send(Method::POST, "/path", steps).await,
                send(Method::POST, "/observations", measured).await,
                send(Method::DELETE, "", "").await,
            ]
        }
    };
    for refused in asked(first).await {
        let refused = problem(refused).await;
        assert_eq!((refused.status, refused.code.as_str()), (412, "stale_sequence"), "{}", refused.detail);
    }
    let now: Value = server.get(&target).await.json().await.unwrap();
    assert_eq!((&now["label"], &now["sequence"]), (&json!("b"), &json!(0)));
    // The sequence alone does not compare the label, and there is a checksum of no label.
    assert_eq!(rename("\"0\"", json!(null)).await.status(), 200);
    assert_eq!(rename("\"0.00000000\"", json!("d")).await.status(), 200);
    for stale in ["\"0.00000000\"", "\"1\"", "\"7\""] {
        assert_eq!(rename(stale, json!("e")).await.status(), 412, "{stale}");
    }
    for wrong in ["\"0.\"", "\"0.xyz\"", "\"0.123456789\"", "\"0.+1234567\"", "\".00000000\""] {
        assert_eq!(rename(wrong, json!("e")).await.status(), 422, "{wrong}");
    }
    // The tag that is shown serves for everything.
    let [renamed, dry, ..] = asked(shown().await).await;
    assert_eq!((renamed.status().as_u16(), dry.status().as_u16()), (200, 412));
    let [_, dry, relaxed, ..] = asked(shown().await).await;
    assert_eq!((dry.status().as_u16(), relaxed.status().as_u16()), (200, 200));
    for (method, path, body) in [
        (Method::POST, "/move", "{\"displacement\": 1e-8}"),
        (Method::POST, "/path", &steps),
        (Method::POST, "/observations", &measured),
        (Method::PATCH, "", "{\"label\": null}"),
    ] {
        let tag = shown().await;
        let reply = server.send(method, &format!("{target}{path}"), Some(body), &[("if-match", &*tag)]).await;
        assert!(reply.status().is_success(), "{path}: {}", reply.text().await.unwrap());
    }
    let any = server.send(Method::DELETE, &target, None, &[("if-match", "*")]).await;
    assert_eq!(any.status(), StatusCode::NO_CONTENT);
}

#[tokio::test]
async fn a_retry_gets_the_first_reply_again() {
    let server = Server::start().await;
    let id = server.contact().await;
    let (contact, ball) = (format!("/contacts/{id}"), ball().to_string());
    let [moved, path, fork, observed] =
        ["move", "path", "fork", "observations"].map(|change| format!("{contact}/{change}"));
    for (key, target, body) in [
        ("one", "/contacts", &*ball),
        ("two", &*moved, r#"{"displacement": 1e-7}"#),
        ("three", &*path, r#"{"path": {"displacement": [2e-8, 3e-8]}}"#),
        ("four", &*fork, "{}"),
        ("five", &*observed, r#"{"observations": [{"displacement": 1e-7, "force": 1.2}]}"#),
    ] {
        let headers = [("idempotency-key", key)];
        let first = server.send(Method::POST, target, Some(body), &headers).await;
        assert!(first.status().is_success(), "{target}");
        let again = server.send(Method::POST, target, Some(body), &headers).await;
        assert_eq!(first.status(), again.status());
        for name in ["etag", "location"] {
            assert_eq!(first.headers().get(name), again.headers().get(name));
        }
        assert_eq!(first.bytes().await.unwrap(), again.bytes().await.unwrap(), "{target}");

        let other = server.send(Method::POST, &moved, Some(r#"{"displacement": 5e-8}"#), &headers).await;
        let other = problem(other).await;
        assert_eq!((other.status, other.code.as_str()), (422, "idempotency_key_reused"));
    }
    let shown: Value = server.get(&contact).await.json().await.unwrap();
    assert_eq!(shown["sequence"], 4);
    assert_eq!(server.client.contacts(None, None).await.unwrap().items.len(), 3);

    // The retry gets its reply even when the contact is deleted.
    server.send(Method::DELETE, &contact, None, &[]).await;
    let late =
        server.send(Method::POST, &moved, Some(r#"{"displacement": 1e-7}"#), &[("idempotency-key", "two")]).await;
    assert_eq!(late.status(), StatusCode::OK);
}

#[tokio::test]
async fn twins_that_arrive_together_are_applied_once() {
    let server = Server::start().await;
    let id = server.contact().await;
    let moved = format!("/contacts/{id}/move");
    let headers = [("idempotency-key", "twin"), ("if-match", "\"0\"")];
    let body = json!({"displacement": 1e-9, "relative": true}).to_string();
    let twins = join_all((0..20).map(|_| server.send(Method::POST, &moved, Some(&body), &headers))).await;
    let mut bodies = Vec::new();
    for twin in twins {
        assert_eq!(twin.status(), StatusCode::OK);
        bodies.push(twin.bytes().await.unwrap());
    }
    bodies.dedup();
    assert_eq!(bodies.len(), 1);
    assert_eq!(server.client.contact(id.parse().unwrap()).await.unwrap().sequence, 1);

    let ball = ball().to_string();
    let key = [("idempotency-key", "born-together")];
    let twins = join_all((0..20).map(|_| server.send(Method::POST, "/contacts", Some(&ball), &key))).await;
    for twin in twins {
        let status = twin.status();
        assert_eq!(status, StatusCode::CREATED, "{}", twin.text().await.unwrap());
    }
    assert_eq!(server.client.contacts(None, None).await.unwrap().items.len(), 2);
}
