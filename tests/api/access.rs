//! Access control: every role at every endpoint, and what one tenant sees of another.

use crate::common;

use std::collections::BTreeSet;

use common::openapi::{document, examples, operations, with_query};
use common::postgres::Cluster;
use common::process::Process;
use common::tables::same_numbers;
use common::{ball, problem, run, until};
use futures::StreamExt as _;
use reqwest::{Method, Response};
use serde_json::{Value, json};
use stickslip::access::{Keys, Role, new_key};
use stickslip::store::Tenant;
use stickslip_wire::client::{Event, Options};
use stickslip_wire::{EndReason, JobState};
use tempfile::{TempDir, tempdir};
use uuid::Uuid;

/// Method and path of every endpoint with the roles that may call it, as `docs/access.md` lists them; none means
/// everybody. A test of the documentation compares the list with the routes.
fn endpoints() -> Vec<(String, String, &'static [&'static str])> {
    let (_, table) = include_str!("../../docs/access.md").split_once("| needs | routes |\n|---|---|\n").unwrap();
    let row = |line: &'static str| {
        let (needs, routes) = line.trim_matches(['|', ' ']).split_once(" | ").unwrap();
        let roles: &[&str] = match needs.trim_matches('`') {
            "read" => &["read", "write"],
            "write" => &["write"],
            "metrics" => &["metrics"],
            _ => &[],
        };
        routes.split(", ").map(move |route| {
            let (method, path) = route.trim_matches('`').split_once(' ').unwrap();
            (method.to_owned(), path.to_owned(), roles)
        })
    };
    table.lines().take_while(|line| line.starts_with('|')).flat_map(row).collect()
}

/// The first body that the document shows for an endpoint.
fn body(document: &Value, method: &str, path: &str) -> Option<Value> {
    let operation = &document["paths"][path][method.to_lowercase()];
    examples(document, operation).into_iter().next()
}

fn sweep_job() -> Value {
    let base = json!({"contact": ball(), "path": {"force": [1.0]}});
    json!({"base": base, "outputs": ["/steps/0/displacement"], "job": true,
        "axes": [{"pointer": "/contact/friction", "values": [0.3, 0.4]}]})
}

/// A server with a file of keys.
struct Guarded {
    process: Process,
    http: reqwest::Client,
    keys: Vec<(&'static str, String)>,
    folder: TempDir,
}

impl Guarded {
    /// Each key has a name by which it is called, its roles and its tenant.
    async fn start(store: &str, more: &[&str], keys: &[(&'static str, &[Role], &str)]) -> Guarded {
        let folder = tempdir().unwrap();
        let made = keys.iter().map(|(name, roles, tenant)| (*name, new_key(name, roles, tenant, None).unwrap()));
        let made: Vec<_> = made.collect();
        let file = folder.path().join("keys");
        let entries: Vec<&str> = made.iter().map(|(_, new)| new.entry.as_str()).collect();
        std::fs::write(&file, format!("# for the test\n{}\n", entries.join("\n"))).unwrap();
        let process = Process::with(store, &[&["--keys", file.to_str().unwrap()], more].concat());
        let keys = made.into_iter().map(|(name, new)| (name, new.key)).collect();
        Guarded { process, http: reqwest::Client::new(), keys, folder }
    }

    fn key(&self, name: &str) -> &str {
        &self.keys.iter().find(|(known, _)| *known == name).unwrap().1
    }

    async fn send(
        &self,
        who: Option<&str>,
        method: &str,
        path: &str,
        body: Option<&Value>,
        headers: &[(&str, &str)],
    ) -> Response {
        let method: Method = method.parse().unwrap();
        let mut call = self.http.request(method, format!("{}{path}", self.process.base));
        if let Some(who) = who {
            call = call.header("authorization", format!("Bearer {}", self.key(who)));
        }
        for (name, value) in headers {
            call = call.header(*name, *value);
        }
        match body {
            Some(Value::String(file)) => {
                call.header("content-type", "application/octet-stream").body(file.clone()).send().await.unwrap()
            }
            Some(body) => call.json(body).send().await.unwrap(),
            None => call.send().await.unwrap(),
        }
    }

    /// Replaces the file of keys.
    fn replace(&self, entries: &str) {
        let new = self.folder.path().join("new");
        std::fs::write(&new, entries).unwrap();
        std::fs::rename(new, self.folder.path().join("keys")).unwrap();
    }

    async fn contact(&self, who: &str) -> Uuid {
        let client = self.process.client.clone().with_key(self.key(who));
        client.create(&common::create(), &Options::default()).await.unwrap().id
    }

    /// The identifier of a new contact or job for a route.
    async fn subject(&self, route: &str) -> String {
        if route.starts_with("/jobs") { self.job("write").await } else { self.contact("write").await.to_string() }
    }

    /// A job that is done.
    async fn job(&self, who: &str) -> String {
        let response = self.send(Some(who), "POST", "/sweep", Some(&sweep_job()), &[]).await;
        let path = response.headers()["location"].to_str().unwrap().to_owned();
        until("the job ends", async || {
            let job: Value = self.send(Some(who), "GET", &path, None, &[]).await.json().await.unwrap();
            (job["state"] != "running").then_some(())
        })
        .await;
        path.strip_prefix("/jobs/").unwrap().to_owned()
    }
}

#[tokio::test]
async fn every_role_has_its_permissions_at_every_endpoint() {
    let keys: [(&'static str, &[Role], &str); 4] = [
        ("write", &[Role::Write], "lab"),
        ("read", &[Role::Read], "lab"),
        ("metrics", &[Role::Metrics], "lab"),
        ("both", &[Role::Read, Role::Metrics], "lab"),
    ];
    let server = Guarded::start("memory:", &[], &keys).await;
    let document = document();
    let mut tried = 0;
    for (method, route, allowed) in endpoints() {
        for who in [None, Some("write"), Some("read"), Some("metrics"), Some("both")] {
            let roles: &[&str] = match who {
                None => &[],
                Some("both") => &["read", "metrics"],
                Some(_) => std::slice::from_ref(who.as_ref().unwrap()),
            };
            let path = route.replace("{id}", &server.subject(&route).await).replace("{code}", "forbidden");
            let path = with_query(&method, &path);
            let send = async |method: &str| {
                let body = if method == "HEAD" { None } else { body(&document, method, &route) };
                server.send(who, method, &path, body.as_ref(), &[]).await
            };
            let expected = match who {
                _ if allowed.is_empty() || roles.iter().any(|role| allowed.contains(role)) => None,
                None => Some((401, "unauthorized")),
                Some(_) => Some((403, "forbidden")),
            };
            // HEAD is as GET.
            let is_stream = path.ends_with("/events");
            if method == "GET" && !is_stream {
                let status = send("HEAD").await.status();
                assert_eq!(status.as_u16(), expected.map_or(200, |(status, _)| status), "{who:?} HEAD {path}");
            }
            let response = send(&method).await;
            tried += 1;
            let Some((status, code)) = expected else {
                assert!(response.status().is_success(), "{who:?} {method} {path}: {}", response.status());
                continue;
            };
            let challenge = response.headers().get("www-authenticate").cloned();
            assert_eq!(challenge.map(|it| it == "Bearer"), (status == 401).then_some(true), "{who:?} {method} {path}");
            let refused = problem(response).await;
            assert_eq!((refused.status, refused.code.as_str()), (status, code), "{who:?} {method} {path}");
        }
    }
    assert_eq!(tried, 5 * operations(&document).count(), "the list has every operation");
    // An unlisted route requires the highest role.
    for (method, path) in [("GET", "/nothing"), ("PUT", "/contacts"), ("GET", "/contacts/"), ("GET", "//contacts")] {
        for (who, expected) in [(None, vec![401]), (Some("read"), vec![403]), (Some("write"), vec![404, 405])] {
            let status = server.send(who, method, path, None, &[]).await.status().as_u16();
            assert!(expected.contains(&status), "{who:?} {method} {path}: {status}");
        }
    }
}

#[tokio::test]
async fn a_key_counts_only_whole_and_once_and_as_a_bearer() {
    let server = Guarded::start("memory:", &[], &[("a", &[Role::Write], ""), ("b", &[Role::Read], "")]).await;
    let (a, b) = (server.key("a"), server.key("b"));
    let send = async |values: &[String]| {
        let mut call = server.http.get(format!("{}/contacts", server.process.base));
        for value in values {
            call = call.header("authorization", value);
        }
        call.send().await.unwrap().status().as_u16()
    };
    for valid in [format!("Bearer {a}"), format!("bearer {b}"), format!("BEARER   {a}  ")] {
        assert_eq!(send(std::slice::from_ref(&valid)).await, 200, "{valid}");
    }
    for bad in [
        a.to_owned(),
        format!("Basic {a}"),
        "Bearer".to_owned(),
        "Bearer ".to_owned(),
        format!("Bearer{a}"),
        format!("Bearer {a} {b}"),
        format!("Bearer {a},{b}"),
        format!("Bearer {}", "x".repeat(5_000)),
    ] {
        assert_eq!(send(std::slice::from_ref(&bad)).await, 401, "{bad}");
    }
    assert_eq!(send(&[format!("Bearer {a}"), format!("Bearer {a}")]).await, 401);
    let elsewhere = server.http.get(format!("{}/contacts?key={a}&access_token={a}", server.process.base));
    assert_eq!(elsewhere.header("x-api-key", a).send().await.unwrap().status().as_u16(), 401);
}

/// All of a reply, except what differs in each.
async fn seen(response: Response, id: Uuid) -> (u16, Vec<(String, String)>, String) {
    let status = response.status().as_u16();
    let request_id = response.headers()["x-request-id"].to_str().unwrap().to_owned();
    let mut headers: Vec<(String, String)> = response
        .headers()
        .iter()
        .filter(|(name, _)| !["x-request-id", "date"].contains(&name.as_str()))
        .map(|(name, value)| (name.to_string(), value.to_str().unwrap().to_owned()))
        .collect();
    headers.sort();
    let text = response.text().await.unwrap();
    (status, headers, text.replace(&request_id, "REQUEST").replace(&id.to_string(), "ID"))
}

/// A request: method, route, body and header.
type Attempt = (String, String, Option<Value>, Option<(&'static str, &'static str)>);

/// Requests about a contact, valid and bad.
fn attempts(document: &Value) -> Vec<Attempt> {
    let mut all = Vec::new();
    for (method, route, _) in endpoints().into_iter().filter(|(_, route, _)| route.contains("{id}")) {
        let tags =
            [("if-match", "\"0\""), ("if-match", "\"9\""), ("if-match", "nonsense"), ("idempotency-key", "once")];
        let events = [("last-event-id", "0"), ("last-event-id", "7")];
        let own = body(document, &method, &route);
        for header in [None].into_iter().chain(tags.into_iter().chain(events).map(Some)) {
            all.push((method.clone(), route.clone(), own.clone(), header));
        }
        for wrong in [json!({"nonsense": 1}), json!({"force": 1e6})] {
            all.push((method.clone(), route.clone(), Some(wrong), None));
        }
    }
    all
}

#[tokio::test]
async fn what_belongs_to_another_tenant_does_not_exist() {
    let folder = tempdir().unwrap();
    let file = folder.path().join("tenants.db").to_str().unwrap().to_owned();
    let attempts = attempts(&document());
    let keys: [(&'static str, &[Role], &str); 4] = [
        ("north", &[Role::Write], "north"),
        ("reader", &[Role::Read], "north"),
        ("south", &[Role::Write], "south"),
        ("nameless", &[Role::Write], ""),
    ];
    // With cached states, and with none.
    for (store, cache) in
        [("memory:".to_owned(), "1MiB"), (format!("sqlite:{file}"), "1MiB"), (format!("sqlite:{file}"), "0")]
    {
        let server = Guarded::start(&store, &["--cache-bytes", cache], &keys).await;
        let client = |who: &str| server.process.client.clone().with_key(server.key(who));
        let (id, nobody) = (server.contact("north").await, Uuid::now_v7());
        let options = Options { idempotency_key: Some(format!("first-{cache}")), ..Options::default() };
        client("north").apply(id, &stickslip_wire::Move::displacement(1e-8).into(), &options).await.unwrap();
        let before = client("reader").contact(id).await.unwrap();
        for who in ["south", "nameless"] {
            for (method, route, body, header) in &attempts {
                let about = async |id: Uuid| {
                    let path = with_query(method, &route.replace("{id}", &id.to_string()));
                    seen(server.send(Some(who), method, &path, body.as_ref(), header.as_slice()).await, id).await
                };
                let (theirs, missing) = (about(id).await, about(nobody).await);
                assert_eq!(theirs, missing, "{who} {method} {route} {body:?} {header:?}");
                assert!(matches!(theirs.0, 404 | 422), "{who} {method} {route} {body:?} {header:?}: {theirs:?}");
            }
            assert!(client(who).contacts(None, None).await.unwrap().items.iter().all(|item| item.id != id));
            // Idempotency keys are separate for each tenant.
            let retry = client(who).apply(id, &stickslip_wire::Move::displacement(1e-8).into(), &options).await;
            assert_eq!(retry.unwrap_err().problem().unwrap().status, 404);
        }
        assert_eq!(format!("{:?}", client("reader").contact(id).await.unwrap()), format!("{before:?}"));
        assert_eq!(client("north").history(id, None, None).await.unwrap().items.len(), 1);
        // The same key of a request makes one contact for each tenant.
        let options = Options { idempotency_key: Some(format!("made-{cache}")), ..Options::default() };
        let mut made = BTreeSet::new();
        for who in ["north", "south", "nameless", "north", "south", "nameless"] {
            made.insert(client(who).create(&common::create(), &options).await.unwrap().id);
        }
        assert_eq!(made.len(), 3);
        let listed = client("reader").contacts(None, None).await.unwrap().items;
        assert_eq!(listed.iter().filter(|item| made.contains(&item.id)).count(), 1);
        // A fork belongs to the tenant of its original.
        let fork = client("north").fork(id, &Default::default(), &Options::default()).await.unwrap().id;
        client("reader").contact(fork).await.unwrap();
        assert_eq!(client("south").contact(fork).await.unwrap_err().problem().unwrap().status, 404);
        server.process.stop().await;
    }
    without_keys_the_nameless_tenant_is_served(&file).await;
}

/// A server without keys shows the contacts of the tenant without a name, and no others.
async fn without_keys_the_nameless_tenant_is_served(file: &str) {
    let open = Process::start(&format!("sqlite:{file}")).await;
    let listed = open.client.contacts(None, None).await.unwrap().items;
    assert_eq!(listed.len(), 2, "one of each round");
    let database = rusqlite::Connection::open(file).unwrap();
    let all: i64 = database.query_row("SELECT count(*) FROM sessions", [], |row| row.get(0)).unwrap();
    let theirs: String =
        database.query_row("SELECT id FROM sessions WHERE tenant = 'north' LIMIT 1", [], |row| row.get(0)).unwrap();
    assert_eq!(all, 10);
    let refused = open.client.contact(theirs.parse().unwrap()).await.unwrap_err();
    assert_eq!(refused.problem().unwrap().status, 404);
    open.stop().await;
}

#[tokio::test]
async fn a_job_is_there_for_its_tenant_alone() {
    let keys: [(&'static str, &[Role], &str); 2] =
        [("north", &[Role::Write], "north"), ("south", &[Role::Write], "south")];
    let server = Guarded::start("memory:", &[], &keys).await;
    let (job, options) = (server.job("north").await, [("idempotency-key", "mine")]);
    for (method, more) in [("GET", ""), ("GET", "/result"), ("GET", "/events"), ("DELETE", "")] {
        let refusal = problem(server.send(Some("south"), method, &format!("/jobs/{job}{more}"), None, &[]).await).await;
        assert_eq!(refusal.code, "job_not_found", "{method} {more}");
    }
    assert_eq!(server.send(Some("north"), "GET", &format!("/jobs/{job}/result"), None, &[]).await.status(), 200);
    // The name of a request belongs to its tenant, and so does what it may ask for.
    let sweep = sweep_job();
    let mut places = BTreeSet::new();
    for who in ["north", "south", "north"] {
        let response = server.send(Some(who), "POST", "/sweep", Some(&sweep), &options).await;
        places.insert(response.headers()["location"].to_str().unwrap().to_owned());
    }
    assert_eq!(places.len(), 2);
    let full = loop {
        let response = server.send(Some("north"), "POST", "/sweep", Some(&sweep), &[]).await;
        if response.status() != 202 {
            break response;
        }
    };
    // The oldest of them that has ended is kept for a day from then.
    let wait: u64 = full.headers()["retry-after"].to_str().unwrap().parse().unwrap();
    assert!((86_000..=86_400).contains(&wait), "{wait}");
    let refusal = problem(full).await;
    assert!(refusal.code == "too_many_jobs" && refusal.detail.contains("GET /jobs"), "{refusal:?}");
    let client = |who: &str| server.process.client.clone().with_key(server.key(who));
    let listed = client("north").jobs(None).await.unwrap().items;
    assert_eq!((listed.len(), client("south").jobs(None).await.unwrap().items.len()), (50, 1));
    assert!(listed.is_sorted_by_key(|job| job.id) && listed[0].id.to_string() == job);
    let done = client("north").jobs(Some(JobState::Done)).await.unwrap().items;
    assert!(done.iter().all(|job| job.state == JobState::Done) && done[0].id.to_string() == job);
    assert!(client("north").jobs(Some(JobState::Failed)).await.unwrap().items.is_empty());
    assert_eq!(server.send(Some("north"), "GET", "/jobs?state=lost", None, &[]).await.status(), 422);
    // Room is made by deleting what is listed.
    client("north").delete_job(listed[0].id).await.unwrap();
    assert_eq!(server.send(Some("north"), "POST", "/sweep", Some(&sweep), &[]).await.status(), 202);
    assert_eq!(server.send(Some("south"), "POST", "/sweep", Some(&sweep), &[]).await.status(), 202);
}

#[tokio::test]
async fn only_its_tenant_learns_that_a_contact_has_expired() {
    let keys: [(&'static str, &[Role], &str); 2] =
        [("north", &[Role::Write], "north"), ("south", &[Role::Read], "south")];
    let server = Guarded::start("memory:", &["--expire-after", "1s"], &keys).await;
    let id = server.contact("north").await;
    let get =
        async |who: &str| server.send(Some(who), "GET", &format!("/contacts/{id}"), None, &[]).await.status().as_u16();
    let client = server.process.client.clone().with_key(server.key("north"));
    let mut events = Box::pin(client.events(id, Some(0)).await.unwrap());
    let last = tokio::time::timeout(common::PATIENCE, events.next()).await.expect("it does not expire");
    assert_eq!(last.unwrap().unwrap(), Event::End(EndReason::Expired));
    assert_eq!(get("north").await, 410);
    assert_eq!(get("south").await, 404);
    let history = server.send(Some("south"), "GET", &format!("/contacts/{id}/history"), None, &[]).await;
    assert_eq!(history.status().as_u16(), 404);
}

#[tokio::test]
async fn a_changed_file_of_keys_counts_at_once_and_ends_the_events_of_revoked_keys() {
    let keys: [(&'static str, &[Role], &str); 2] = [("kept", &[Role::Write], "lab"), ("revoked", &[Role::Read], "lab")];
    let server = Guarded::start("memory:", &[], &keys).await;
    let file = server.folder.path().join("keys");
    let before = std::fs::read_to_string(&file).unwrap();
    let kept: String =
        before.lines().filter(|line| !line.starts_with("revoked")).map(|line| format!("{line}\n")).collect();
    let events = format!("/contacts/{}/events", server.contact("kept").await);
    let mut followed = server.send(Some("revoked"), "GET", &events, None, &[]).await;
    let mut followed_on = server.send(Some("kept"), "GET", &events, None, &[]).await;
    assert!(followed.chunk().await.unwrap().is_some() && followed_on.chunk().await.unwrap().is_some());
    let list = async |who: &str| server.send(Some(who), "GET", "/contacts", None, &[]).await.status().as_u16();

    server.replace(&kept);
    server.process.signal("HUP");
    until("the key is revoked", async || (list("revoked").await == 401).then_some(())).await;
    assert_eq!(list("kept").await, 200);
    let rest =
        tokio::time::timeout(common::PATIENCE, followed.text()).await.expect("the events of a revoked key go on");
    assert!(rest.unwrap().ends_with("event: end\ndata: {\"reason\":\"revoked\"}\n\n"));
    // Other keys do not notice.
    let path = events.replace("/events", "/move");
    let moved = server.send(Some("kept"), "POST", &path, Some(&json!({"displacement": 1e-8})), &[]).await;
    assert_eq!(moved.status(), 200);
    assert!(followed_on.chunk().await.unwrap().is_some());

    // Without a signal too. What is wrong changes nothing.
    server.replace(&before);
    until("the key is known again", async || (list("revoked").await == 200).then_some(())).await;
    server.replace("nonsense");
    until("the log says so", async || server.process.log().contains("keys unchanged").then_some(())).await;
    assert_eq!((list("revoked").await, list("kept").await), (200, 200));
}

#[tokio::test]
async fn a_key_with_an_end_counts_until_then() {
    let server = Guarded::start("memory:", &[], &[("kept", &[Role::Write], "lab")]).await;
    let id = server.contact("kept").await;
    let before = std::fs::read_to_string(server.folder.path().join("keys")).unwrap();
    let send = async |key: &str, path: &str| {
        server.http.get(format!("{}{path}", server.process.base)).bearer_auth(key).send().await.unwrap()
    };
    let events = format!("/contacts/{id}/events");
    // A slow machine may not have it in use before its end: then the next one lives longer.
    let mut seconds = 1;
    let in_use = async || {
        let end = jiff::Timestamp::now() + jiff::SignedDuration::from_secs(seconds);
        let brief = new_key("brief", &[Role::Read], "lab", Some(end)).unwrap();
        server.replace(&format!("{before}{} # for a moment\n", brief.entry));
        server.process.signal("HUP");
        seconds *= 2;
        while jiff::Timestamp::now() < end {
            let followed = send(&brief.key, &events).await;
            if followed.status() == 200 {
                return Some((brief.key, followed));
            }
        }
        None
    };
    let (key, mut followed) = until("a key is in use before its end", in_use).await;
    let end = async { while followed.chunk().await.unwrap().is_some() {} };
    tokio::time::timeout(common::PATIENCE, end).await.expect("the events of an expired key go on");
    let refused = problem(send(&key, "/contacts").await).await;
    assert_eq!((refused.status, refused.detail.as_str()), (401, "the key has expired"));
}

#[test]
fn the_command_line_makes_keys_with_several_roles_an_end_and_a_note() {
    let made = |more: &[&str]| {
        let output = run(&[&["key", "new", "--name", "a", "--tenant", "lab"], more].concat());
        let text = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
        if output.status.success() { Ok(text) } else { Err(text) }
    };
    for roles in
        [&["--role", "read+metrics"][..], &["--role", "read,metrics"], &["--role", "read", "--role", "metrics"]]
    {
        let printed =
            made(&[roles, &["--expires-at", "2027-01-31T13:00:00+01:00", "--note", "room 3"]].concat()).unwrap();
        let entry = printed.lines().nth(1).unwrap().strip_prefix("entry ").unwrap();
        assert!(entry.starts_with("a:read+metrics:lab:sha256:"), "{entry}");
        assert!(entry.ends_with(":2027-01-31T12:00:00Z # room 3"), "{entry}");
        let mut keys = Keys::default();
        keys.add(entry).unwrap();
        let key = printed.lines().next().unwrap().strip_prefix("key   ").unwrap();
        let holder = keys.holder(key.as_bytes()).unwrap();
        assert_eq!(holder.expires_at, Some("2027-01-31T12:00:00Z".parse().unwrap()));
    }
    for (wrong, why) in [
        (&["--role", "reed"][..], "write, read, metrics"),
        (&["--role", "read", "--expires-at", "soon"], "--expires-at"),
        (&["--role", "read", "--note", "a, b"], "commas"),
    ] {
        let said = made(wrong).unwrap_err();
        assert!(said.lines().count() == 1 && said.contains(why), "{said}");
    }
}

#[test]
fn a_key_is_known_by_its_hash_alone_and_has_its_roles() {
    let bench = new_key("bench", &[Role::Write], "lab", None).unwrap();
    let graph = new_key("graph", &[Role::Metrics, Role::Read], "", None).unwrap();
    let mut keys = Keys::default();
    keys.add(&format!("# keys\n{} # the bench\n\n  {},\n", bench.entry, graph.entry)).unwrap();
    assert_eq!(keys.count(), 2);
    let holder = keys.holder(bench.key.as_bytes()).unwrap();
    assert_eq!((&*holder.name, &holder.tenant), ("bench", &Tenant::new("lab")));
    assert!(holder.allows(Role::Write) && holder.allows(Role::Read) && !holder.allows(Role::Metrics));
    let holder = keys.holder(graph.key.as_bytes()).unwrap();
    assert!(!holder.allows(Role::Write) && holder.allows(Role::Read) && holder.allows(Role::Metrics));
    assert_eq!(holder.tenant, Tenant::default());
    let mut other = bench.key.clone();
    other.pop();
    let hash = bench.entry.rsplit(':').next().unwrap();
    let (upper, longer) = (bench.key.to_uppercase(), format!("{}0", bench.key));
    for unknown in ["", "bench", hash, &other, &bench.key[1..], &upper, &longer, &"x".repeat(100_000)] {
        assert_eq!(keys.holder(unknown.as_bytes()), None, "{unknown}");
    }
    assert_ne!(new_key("bench", &[Role::Write], "lab", None).unwrap().key, bench.key);
}

#[test]
fn an_entry_that_is_wrong_is_refused_by_its_line_and_not_shown() {
    let good = new_key("good", &[Role::Read], "", None).unwrap().entry;
    let hash = good.rsplit(':').next().unwrap().to_owned();
    for (entry, why) in [
        (hash.clone(), "name:roles:tenant:sha256:hash"),
        (format!("a:read:sha256:{hash}"), "name:roles:tenant:sha256:hash"),
        (format!("a:reed::sha256:{hash}"), "write, read, metrics"),
        (format!("a:::sha256:{hash}"), "write, read, metrics"),
        (format!("a b:read::sha256:{hash}"), "name"),
        (format!(":read::sha256:{hash}"), "name"),
        (format!("a:read:t t:sha256:{hash}"), "tenant"),
        (format!("a:read::sha256:{}", &hash[1..]), "64 hexadecimal digits"),
        (format!("a:read::sha256:{}g", &hash[1..]), "64 hexadecimal digits"),
        (format!("a:read::sha256:{hash}:soon"), "2027-01-31T12:00:00Z"),
        (format!("a:read::sha256:{hash}"), "two entries"),
        (good.replace(&hash[..4], "0000"), "this name"),
    ] {
        let mut keys = Keys::default();
        let wrong = keys.add(&format!("{good}\n\n{entry}")).unwrap_err();
        assert_eq!(wrong.line, 3);
        assert!(wrong.why.contains(why) && !wrong.to_string().contains(&hash[8..]), "{entry}: {wrong}");
    }
}

#[tokio::test]
async fn the_history_names_the_key_that_made_a_move_where_keys_are_in_use() {
    let folder = tempdir().unwrap();
    let cluster = Cluster::shared();
    for store in [format!("sqlite:{}", folder.path().join("contacts.db").display()), cluster.database().await] {
        let keys: [(&'static str, &[Role], &str); 3] =
            [("bench-1", &[Role::Write], ""), ("desk", &[Role::Write], ""), ("reader", &[Role::Read], "")];
        let server = Guarded::start(&store, &[], &keys).await;
        // On a database that several servers share, another one shows the same.
        let replica = store.starts_with("postgres").then_some(Guarded::start(&store, &[], &keys[2..]));
        let id = server.contact("desk").await;
        let moves = json!({"path": {"displacement": [2e-8, 1e-8]}});
        let seen = json!({"observations": [{"displacement": 3e-8, "force": 0.1}]});
        for (who, call, body) in [
            ("bench-1", "move", json!({"displacement": 1e-8})),
            ("desk", "path", moves),
            ("bench-1", "observations", seen),
            ("desk", "relax", json!({"reversals": 2})),
        ] {
            let response = server.send(Some(who), "POST", &format!("/contacts/{id}/{call}"), Some(&body), &[]).await;
            assert!(response.status().is_success(), "{call}: {}", response.text().await.unwrap());
        }
        let fork = server.send(Some("bench-1"), "POST", &format!("/contacts/{id}/fork"), None, &[]).await;
        let fork = fork.json::<Value>().await.unwrap()["id"].as_str().unwrap().to_owned();
        let moved = json!({"force": 0.0});
        server.send(Some("bench-1"), "POST", &format!("/contacts/{fork}/move"), Some(&moved), &[]).await;

        let mut servers = vec![server];
        if let Some(replica) = replica {
            servers.push(replica.await);
        }
        let first = ["bench-1", "desk", "desk", "bench-1"];
        let mut sequences = Vec::new();
        for server in &servers {
            let get = async |path: &str| server.send(Some("reader"), "GET", path, None, &[]).await;
            for (id, last) in [(id.to_string(), "desk"), (fork.clone(), "bench-1")] {
                let page: Value = get(&format!("/contacts/{id}/history")).await.json().await.unwrap();
                let by: Vec<&str> =
                    page["items"].as_array().unwrap().iter().map(|item| item["by"].as_str().unwrap()).collect();
                assert_eq!((&by[..4], by[by.len() - 1]), (&first[..], last));
                assert!(by[4..by.len() - 1].iter().all(|name| *name == "desk"), "{by:?}");
                sequences.push(by.len());
                let mut written = Vec::new();
                for format in ["rows", "csv", "ndjson", "arrow"] {
                    let table = get(&format!("/contacts/{id}/history?format={format}&limit=100")).await;
                    written.push(table.bytes().await.unwrap());
                }
                let (names, rows) = same_numbers(&written[0], &written[1], &written[2], &written[3]);
                assert_eq!(names.last().unwrap(), "by");
                assert_eq!(rows.iter().map(|row| row.last().unwrap()).collect::<Vec<_>>(), by);
                // A table that is sent piece by piece has the column too.
                let csv = get(&format!("/contacts/{id}/history?format=csv")).await.bytes().await.unwrap();
                assert_eq!(csv, written[1]);
            }
        }
        assert!(sequences.iter().all(|count| *count > 5), "relaxing moves the contact: {sequences:?}");
        drop(servers);

        // Without keys nobody has a name, and there is no field and no column for one; with keys what was made
        // meanwhile has none.
        let open = Process::start(&store).await;
        let path = format!("{}/contacts/{id}", open.base);
        let moved =
            reqwest::Client::new().post(format!("{path}/move")).json(&json!({"displacement": 0.0})).send().await;
        assert!(moved.unwrap().status().is_success());
        let page: Value = reqwest::get(format!("{path}/history")).await.unwrap().json().await.unwrap();
        assert!(page["items"].as_array().unwrap().iter().all(|item| item.get("by").is_none()), "{page}");
        let csv = reqwest::get(format!("{path}/history?format=csv")).await.unwrap().text().await.unwrap();
        assert!(csv.lines().next().unwrap().ends_with("innovation,twist,torque"), "{csv}");
        drop(open);
        let server = Guarded::start(&store, &[], &keys).await;
        let page = server.send(Some("reader"), "GET", &format!("/contacts/{id}/history"), None, &[]).await;
        let page: Value = page.json().await.unwrap();
        let items = page["items"].as_array().unwrap();
        assert!(items[0]["by"] == "bench-1" && items[items.len() - 1].get("by").is_none(), "{page}");
        let rows = server.send(Some("reader"), "GET", &format!("/contacts/{id}/history?format=rows"), None, &[]).await;
        assert_eq!(rows.json::<Value>().await.unwrap().as_array().unwrap().last().unwrap()["by"], Value::Null);
    }
}
