//! The exposure of a service: where it listens, what browsers may do with it, and that it keeps its secrets.

use crate::common;

use std::process::Command;

use common::process::{Process, ended};
use common::{ball, binary};
use reqwest::header::HeaderMap;
use serde_json::Value;
use stickslip::access::{Role, new_key};
use stickslip_wire::client::{Client, Options};
use tempfile::tempdir;

/// The one line with which it ends at start.
fn refused(command: &mut Command) -> String {
    let output = ended(command);
    let said = String::from_utf8(output.stderr).unwrap();
    let ended = (output.status.code(), output.stdout.len(), said.lines().count());
    assert_eq!(ended, (Some(1), 0, 1), "{command:?} {said}");
    said
}

#[tokio::test]
async fn without_keys_it_listens_on_loopback_only_unless_insecure() {
    let folder = tempdir().unwrap();
    let log = folder.path().join("log");
    for address in ["0.0.0.0:0", "[::]:0", "192.0.2.1:8080", "[2001:db8::1]:80", "[::ffff:192.0.2.1]:80"] {
        let said = refused(&mut binary(&["--store", "memory:", "--listen", address]));
        assert!(said.contains(address) && said.contains("--keys") && said.contains("--insecure"), "{said}");
        let said = refused(binary(&["serve", "--store", "memory:"]).env("STICKSLIP_LISTEN", address));
        assert!(said.contains(address), "{said}");
    }
    refused(&mut binary(&["--store", "memory:", "--listen", "0.0.0.0:0", "--insecure=false"]));
    // Without any keys it does not start.
    let empty = folder.path().join("empty");
    std::fs::write(&empty, "# nobody yet\n").unwrap();
    for keys in ["", empty.to_str().unwrap(), "/nowhere", "a:read::sha256:00"] {
        for listen in ["127.0.0.1:0", "0.0.0.0:0"] {
            let said =
                refused(binary(&["--store", "memory:", "--listen", listen, "--insecure"]).env("STICKSLIP_KEYS", keys));
            assert!(said.starts_with("--keys"), "{said}");
        }
    }
    let entry = new_key("a", &[Role::Read], "", None).unwrap().entry;
    std::fs::write(&empty, &entry).unwrap();
    let everywhere = ["--listen", "0.0.0.0:0", "--store", "memory:"];
    let with = |more: &[&str]| {
        let mut command = binary(&everywhere);
        command.args(more).stderr(std::fs::File::create(&log).unwrap());
        command
    };
    let mut by_environment = with(&[]);
    by_environment.env("STICKSLIP_INSECURE", "true");
    let mut keys_in_environment = with(&[]);
    keys_in_environment.env("STICKSLIP_KEYS", &entry);
    for (command, keyed) in [
        (with(&["--insecure"]), false),
        (by_environment, false),
        (with(&["--keys", empty.to_str().unwrap()]), true),
        (keys_in_environment, true),
    ] {
        std::fs::write(&log, "").unwrap();
        let process = Process::of(command).await;
        let said = std::fs::read_to_string(&log).unwrap();
        assert_eq!(said.contains("keys are sent unencrypted"), keyed, "{said}");
        assert_eq!(said.contains("no keys are set"), !keyed, "{said}");
        let client = Client::new(process.base.replace("0.0.0.0", "127.0.0.1"));
        client.healthz().await.unwrap();
        let address = process.base.trim_start_matches("http://").to_owned();
        let check = tokio::task::spawn_blocking(move || binary(&["healthcheck", "--listen", &address]).status());
        assert!(check.await.unwrap().unwrap().success());
        process.stop().await;
    }
}

#[tokio::test]
async fn without_keys_pages_of_other_sites_see_and_change_nothing() {
    let arguments = ["--allowed-hosts", "lab.example", "--cors-origins", "https://page.example"];
    let server = Process::with("memory:", &arguments);
    let (http, port) = (reqwest::Client::new(), server.base.rsplit_once(':').unwrap().1.to_owned());
    let id = server.client.create(&common::create(), &Options::default()).await.unwrap().id;
    let send = async |method: &str, path: &str, headers: &[(&str, &str)]| {
        let mut call = http.request(method.parse().unwrap(), format!("{}{path}", server.base));
        for (name, value) in headers {
            call = call.header(*name, *value);
        }
        let response = call.send().await.unwrap();
        let status = response.status().as_u16();
        if status == 403 {
            assert_eq!(common::problem(response).await.code, "foreign_origin");
        }
        status
    };
    let (fork, contact) = (format!("/contacts/{id}/fork"), format!("/contacts/{id}"));
    // A name that points here for a moment is that of another site.
    let rebound = format!("evil.example:{port}");
    for (method, path) in
        [("GET", "/contacts"), ("POST", &*fork), ("DELETE", &*contact), ("GET", "/metrics"), ("GET", "/")]
    {
        assert_eq!(send(method, path, &[("host", &rebound)]).await, 403, "{method} {path}");
        assert_eq!(send(method, path, &[("host", "192.0.2.1")]).await, 403, "{method} {path}");
    }
    for host in ["evil@localhost", "evil@lab.example", "lab.example:evil", "lab.example:99999"] {
        assert_eq!(send("GET", "/contacts", &[("host", host)]).await, 403, "{host}");
    }
    assert_eq!(send("POST", &fork, &[("origin", &server.base), ("origin", "https://evil.example")]).await, 400);
    for host in [rebound.as_str(), "lab.example", "localhost"] {
        assert_eq!(send("GET", "/healthz", &[("host", host)]).await, 200);
        assert_eq!(send("GET", "/contacts", &[("host", host)]).await, if host == rebound { 403 } else { 200 });
    }
    // A change without a body needs no permission of a browser to be sent.
    let own = format!("http://localhost:{port}");
    for (headers, status) in [
        (&[("origin", "https://evil.example")][..], 403),
        (&[("origin", "null")], 403),
        (&[("sec-fetch-site", "cross-site")], 403),
        (&[("origin", "http://localhost:1")], 403),
        (&[("origin", "https://page.example"), ("sec-fetch-site", "cross-site")], 201),
        (&[("origin", &server.base), ("sec-fetch-site", "same-origin")], 201),
        (&[("origin", &own), ("host", own.trim_start_matches("http://"))], 201),
        (&[("origin", "https://lab.example"), ("host", "lab.example")], 201),
    ] {
        assert_eq!(send("POST", &fork, headers).await, status, "{headers:?}");
    }
    assert_eq!(send("DELETE", &contact, &[("origin", "https://evil.example")]).await, 403);
    assert_eq!(server.client.contacts(None, None).await.unwrap().items.len(), 1 + 4);
}

fn header<'a>(headers: &'a HeaderMap, name: &str) -> Option<&'a str> {
    headers.get(name).map(|value| value.to_str().unwrap())
}

#[tokio::test]
async fn every_reply_says_what_browsers_must_not_do_with_it() {
    let entry = new_key("a", &[Role::Read], "", None).unwrap().entry;
    let server = Process::with("memory:", &["--keys", &entry]);
    let http = reqwest::Client::builder().redirect(reqwest::redirect::Policy::none()).build().unwrap();
    for (path, page, status) in [
        ("/healthz", false, 200),
        ("/openapi.json", false, 200),
        ("/contacts", false, 401),
        ("/nothing", false, 401),
        ("/docs", true, 303),
        ("/docs/", true, 200),
        ("/docs/swagger-ui-bundle.js", true, 200),
        ("/docs/nothing", true, 404),
        ("/", true, 200),
        ("/page/main.js", true, 200),
        ("/page/nothing", true, 404),
    ] {
        let response = http.get(format!("{}{path}", server.base)).send().await.unwrap();
        let headers = response.headers();
        assert_eq!(response.status().as_u16(), status, "{path}");
        assert_eq!(header(headers, "x-content-type-options"), Some("nosniff"), "{path}");
        assert_eq!(header(headers, "x-frame-options"), Some("DENY"), "{path}");
        assert_eq!(header(headers, "referrer-policy"), Some("no-referrer"), "{path}");
        assert_eq!(header(headers, "cross-origin-resource-policy"), Some("same-origin"), "{path}");
        // Files of pages are revalidated each time, so that no old one is used with a new one.
        let kept = if page { (status == 200).then_some("no-cache") } else { Some("no-store") };
        assert_eq!(header(headers, "cache-control"), kept, "{path}");
        let policy = header(headers, "content-security-policy").unwrap();
        assert!(policy.starts_with("default-src 'none';") && policy.contains("frame-ancestors 'none'"), "{policy}");
        assert_eq!(policy.contains("script-src 'self';"), page, "{path}");
        assert!(!policy.contains("unsafe-eval") && !policy.contains("script-src 'self' 'unsafe-inline'"));
        assert!(path.starts_with("/docs") || !policy.contains("unsafe"), "{policy}");
        // Only configured origins are allowed.
        assert!(headers.keys().all(|name| !name.as_str().starts_with("access-control")), "{path}");
    }
    // The pages need no more than their policies allow: they have no inline scripts.
    for (path, source) in [("/docs/", "src=\"./"), ("/", "type=\"module\" src=\"page/")] {
        let page = http.get(format!("{}{path}", server.base)).send().await.unwrap().text().await.unwrap();
        for script in page.split("<script").skip(1) {
            assert!(script.trim_start().starts_with(source), "{script}");
        }
        assert!(!page.contains("onload=") && !page.contains("http://") && !page.contains("https://"), "{page}");
    }
}

#[tokio::test]
async fn a_page_of_a_named_origin_may_do_what_its_key_allows_and_others_nothing() {
    let new = new_key("page", &[Role::Write], "", None).unwrap();
    let origins = "https://lab.example,http://localhost:3000";
    let server = Process::with("memory:", &["--keys", &new.entry, "--cors-origins", origins]);
    let http = reqwest::Client::new();
    let url = format!("{}/contacts", server.base);
    for (origin, allowed) in [
        ("https://lab.example", true),
        ("http://localhost:3000", true),
        ("https://lab.example:444", false),
        ("http://lab.example", false),
        ("https://evil.example", false),
        ("null", false),
    ] {
        let expected = allowed.then_some(origin);
        // A browser asks first, and sends no key along.
        let asked = http.request(reqwest::Method::OPTIONS, &url).header("origin", origin);
        let asked = asked.header("access-control-request-method", "POST");
        let asked =
            asked.header("access-control-request-headers", "authorization,content-type,idempotency-key,if-match");
        let answer = asked.send().await.unwrap();
        assert!(answer.status().is_success(), "{origin}");
        assert_eq!(header(answer.headers(), "access-control-allow-origin"), expected, "{origin}");
        let list = |name: &str| header(answer.headers(), name).unwrap_or_default().to_lowercase();
        for name in [
            "authorization",
            "content-type",
            "idempotency-key",
            "if-match",
            "if-none-match",
            "last-event-id",
            "x-request-id",
        ] {
            assert!(list("access-control-allow-headers").split(',').any(|allowed| allowed == name), "{name}");
        }
        assert_eq!(list("access-control-allow-methods"), "get,post,patch,delete");
        assert!(!answer.headers().contains_key("access-control-allow-credentials"));
        // Then it sends the request, and shows the page what it may see.
        let call = http.post(&url).header("origin", origin).json(&ball());
        let made = call.header("authorization", format!("Bearer {}", new.key)).send().await.unwrap();
        assert_eq!(made.status().as_u16(), 201);
        assert_eq!(header(made.headers(), "access-control-allow-origin"), expected, "{origin}");
        let exposed = header(made.headers(), "access-control-expose-headers").unwrap().to_lowercase();
        for name in ["etag", "link", "location", "x-request-id", "retry-after"] {
            assert!(exposed.split(',').any(|shown| shown == name), "{name}");
        }
        // Refusals too can be read by the page.
        let refused = http.get(&url).header("origin", origin).send().await.unwrap();
        assert_eq!(refused.status().as_u16(), 401);
        assert_eq!(header(refused.headers(), "access-control-allow-origin"), expected, "{origin}");
    }
    for bad in ["*", "null", "lab.example", "https://lab.example/", "https://a.example,https://*.b.example"] {
        let output = ended(&mut binary(&["config", "--cors-origins", bad]));
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), said.lines().count()), (Some(2), 1), "{said}");
        assert!(said.contains("--cors-origins") && said.contains("such as https://"), "{said}");
    }
}

/// A log holds none of these, in whatever writing.
fn holds_none(text: &str, secrets: &[&str], place: &str) {
    for secret in secrets {
        let found = text.lines().find(|line| line.to_lowercase().contains(&secret.to_lowercase()));
        assert!(found.is_none(), "{place} shows {secret}: {found:?}");
    }
}

fn hash_of(entry: &str) -> &str {
    entry.rsplit(':').next().unwrap()
}

#[tokio::test]
async fn no_secret_is_ever_logged_or_printed() {
    let folder = tempdir().unwrap();
    let cluster = common::postgres::Cluster::shared();
    // The database trusts every client, so that the password is not checked.
    let url = cluster.database().await.replace("stickslip@", "stickslip:pass-word-7@");
    let good = new_key("good", &[Role::Write, Role::Metrics], "lab", None).unwrap();
    let weak = new_key("weak", &[Role::Read], "lab", None).unwrap();
    let stranger = new_key("stranger", &[Role::Read], "lab", None).unwrap();
    let keys = folder.path().join("keys");
    std::fs::write(&keys, format!("{}\n{}\n", good.entry, weak.entry)).unwrap();
    let secrets = [
        "pass-word-7",
        &good.key["stickslip_".len()..],
        &weak.key["stickslip_".len()..],
        &stranger.key["stickslip_".len()..],
        hash_of(&good.entry),
        hash_of(&weak.entry),
    ];
    for format in ["text", "json"] {
        let arguments = ["--keys", keys.to_str().unwrap(), "--log", "trace", "--log-format", format];
        let server = Process::with(&url, &arguments);
        let http = reqwest::Client::new();
        let mut statuses = Vec::new();
        for authorization in [
            format!("Bearer {}", good.key),
            format!("Bearer {}", weak.key),
            format!("Bearer {}", stranger.key),
            format!("Basic {}", good.key),
            good.key.clone(),
            format!("Bearer {} {}", good.key, weak.key),
        ] {
            let with = |call: reqwest::RequestBuilder| call.header("authorization", authorization.clone());
            let made = with(http.post(format!("{}/contacts", server.base)).json(&ball())).send().await.unwrap();
            statuses.push(made.status().as_u16());
            let made: Value = made.json().await.unwrap();
            let id = made["id"].as_str().unwrap_or("nobody").to_owned();
            for path in ["", "/history", "/stress?points=3", "/nothing"] {
                let url = format!("{}/contacts/{id}{path}", server.base);
                statuses.push(with(http.get(url)).send().await.unwrap().status().as_u16());
            }
            let moved = with(http.post(format!("{}/contacts/{id}/move", server.base)).body("{\"force\": 0.1}"));
            statuses.push(moved.header("content-type", "application/json").send().await.unwrap().status().as_u16());
            statuses.push(
                with(http.delete(format!("{}/contacts/{id}", server.base))).send().await.unwrap().status().into(),
            );
        }
        for expected in [200, 201, 204, 401, 403, 404] {
            assert!(statuses.contains(&expected), "{statuses:?}");
        }
        let said = server.stop().await;
        // The log is not empty: it has requests, and lines of the libraries.
        assert!(said.contains("TRACE") && said.contains("tokio_postgres") && said.contains("a key was accepted"));
        holds_none(&said, &secrets, format);
    }
    // What is printed of settings, wherever they come from.
    let inline = format!("{},{}", good.entry, weak.entry);
    let mut by_environment = binary(&["config"]);
    by_environment.envs([("STICKSLIP_STORE", url.as_str()), ("STICKSLIP_KEYS", inline.as_str())]);
    for mut command in [binary(&["config", "--store", &url, "--keys", &inline]), by_environment] {
        let output = ended(&mut command);
        let printed = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
        assert!(
            output.status.success()
                && printed.contains("stickslip:***@")
                && printed.contains("good:write+metrics:lab:")
        );
        holds_none(&printed, &secrets, "config");
    }
    // The messages about invalid settings.
    let wrong = |name: &str, text: String| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let loud = format!("{url}=loud");
    let broken = url.replace("127.0.0.1:", "127.0.0.1:x");
    for arguments in [
        vec!["--store", &broken],
        vec!["--store", &url, "--keys", &good.key],
        vec!["--listen", &good.key],
        vec!["--listen", &url],
        vec!["--log-format", &url],
        vec!["--cache-bytes", &url],
        vec!["--expire-after", &good.entry],
        vec!["--log", &loud],
        vec!["--cors-origins", &url],
        vec!["--keys", &format!("{}\n{}x", weak.entry, good.entry)],
        vec!["--keys", &wrong("a", format!("{}\n{}\n", good.entry, good.key))],
    ] {
        let output = ended(binary(&arguments).current_dir(folder.path()));
        let printed = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
        assert!(!output.status.success() && printed.lines().count() == 1, "{arguments:?}: {printed}");
        holds_none(&printed, &secrets, &format!("{arguments:?}"));
    }
    let mut misspelt = binary(&["config"]);
    let output = ended(misspelt.env("STICKSLIP_STOER", &url).env("STICKSLIP_KEYZ", &good.entry));
    assert!(!output.status.success());
    holds_none(&String::from_utf8(output.stderr).unwrap(), &secrets, "a misspelt variable");
}
