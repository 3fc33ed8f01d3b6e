//! Tables in every format hold the same numbers, and who has a version already is told so.

mod common;

use common::{Server, problem};
use reqwest::{Method, Response};
use serde_json::{Value, json};

const STRESS: &str = "stress?points=7&fields=pressure,slip";

/// A server, and the path of a contact with three moves behind it.
async fn moved() -> (Server, String) {
    let server = Server::start().await;
    let contact = format!("/contacts/{}", server.contact().await);
    let path = json!({"path": {"displacement": [1e-7, -5e-8, 2e-8]}});
    assert!(server.post(&format!("{contact}/path"), &path).await.status().is_success());
    (server, contact)
}

async fn accepting(server: &Server, path: &str, accept: &str) -> Response {
    server.send(Method::GET, path, None, &[("accept", accept)]).await
}

fn header<'a>(response: &'a Response, name: &str) -> &'a str {
    response.headers()[name].to_str().unwrap()
}

/// What a number or a text is in CSV.
fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// The flat formats at a path hold these rows.
async fn hold(server: &Server, path: &str, names: &[&str], rows: &[Vec<Value>]) {
    let join = if path.contains('?') { '&' } else { '?' };
    let objects: Vec<Value> = rows
        .iter()
        .map(|row| names.iter().zip(row).map(|(name, value)| ((*name).to_owned(), value.clone())).collect())
        .collect();

    let response = server.get(&format!("{path}{join}format=rows")).await;
    assert_eq!(header(&response, "content-type"), "application/vnd.stickslip.rows+json");
    assert_eq!(header(&response, "vary"), "accept");
    assert_eq!(response.json::<Vec<Value>>().await.unwrap(), objects);

    let response = server.get(&format!("{path}{join}format=ndjson")).await;
    assert_eq!(header(&response, "content-type"), "application/x-ndjson");
    let text = response.text().await.unwrap();
    let lines: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines, objects);

    let response = server.get(&format!("{path}{join}format=csv")).await;
    assert_eq!(header(&response, "content-type"), "text/csv; charset=utf-8");
    let text = response.text().await.unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next().unwrap().split(',').collect::<Vec<_>>(), names);
    let cells: Vec<Vec<String>> = lines.map(|line| line.split(',').map(str::to_owned).collect()).collect();
    let expected: Vec<Vec<String>> = rows.iter().map(|row| row.iter().map(cell).collect()).collect();
    assert_eq!(cells, expected);
}

#[tokio::test]
async fn stresses_are_the_same_in_every_format() {
    let (server, contact) = moved().await;
    // Slip has no value outside the contact.
    let path = format!("{contact}/stress?radii=0,1e-5,1&fields=pressure,slip");
    let columns: Value = server.get(&path).await.json().await.unwrap();
    assert!(columns["slip"][2].is_null() && columns["pressure"][0].is_number());
    let names = ["radius", "pressure", "slip"];
    let rows: Vec<Vec<Value>> =
        (0..3).map(|index| names.iter().map(|name| columns[*name][index].clone()).collect()).collect();
    hold(&server, &path, &names, &rows).await;
}

#[tokio::test]
async fn a_history_is_the_same_in_every_format() {
    let (server, contact) = moved().await;
    let path = format!("{contact}/history");
    let page: Value = server.get(&path).await.json().await.unwrap();
    let names = [
        "sequence",
        "at",
        "displacement",
        "force",
        "indentation",
        "normal_force",
        "contact_radius",
        "stick_radius",
        "regime",
        "dissipated_energy",
        "elastic_energy",
        "memory_depth",
    ];
    let items = page["items"].as_array().unwrap();
    assert_eq!(items.len(), 3);
    let value =
        |item: &Value, name: &str| if item[name].is_null() { item["state"][name].clone() } else { item[name].clone() };
    let rows: Vec<Vec<Value>> = items.iter().map(|item| names.iter().map(|name| value(item, name)).collect()).collect();
    hold(&server, &path, &names, &rows).await;

    let first = server.get(&format!("{path}?limit=2&format=csv")).await;
    let link = header(&first, "link").to_owned();
    let next = link.trim_start_matches('<').split('>').next().unwrap();
    let rest = server.get(next).await;
    assert!(rest.headers().get("link").is_none());
    assert!(rest.text().await.unwrap().lines().nth(1).unwrap().starts_with("3,"));
}

#[tokio::test]
async fn accept_chooses_and_the_query_outweighs_it() {
    let (server, contact) = moved().await;
    let path = format!("{contact}/{STRESS}");
    for (accept, expected) in [
        ("*/*", "application/json"),
        ("text/html,application/xhtml+xml,*/*;q=0.8", "application/json"),
        ("text/csv", "text/csv; charset=utf-8"),
        ("text/*", "text/csv; charset=utf-8"),
        ("application/json;q=0.2, application/x-ndjson;q=0.9", "application/x-ndjson"),
        ("application/json;q=0, */*;q=0.5", "application/vnd.stickslip.rows+json"),
    ] {
        assert_eq!(header(&accepting(&server, &path, accept).await, "content-type"), expected, "{accept}");
    }
    let named = accepting(&server, &format!("{path}&format=csv"), "application/json").await;
    assert_eq!(header(&named, "content-type"), "text/csv; charset=utf-8");

    for end in [STRESS, "history"] {
        for accept in ["text/html", "application/json;q=0"] {
            let refused = problem(accepting(&server, &format!("{contact}/{end}"), accept).await).await;
            assert_eq!((refused.status, refused.code.as_str()), (406, "not_acceptable"), "{accept}");
            for known in ["application/json", "text/csv", "application/x-ndjson", "?format=rows"] {
                assert!(refused.detail.contains(known), "{}", refused.detail);
            }
        }
    }
    for (query, pointer) in
        [("format=xml", "/format"), ("format=csv&residual=true", "/residual"), ("formats=csv", "/formats")]
    {
        let refused = problem(server.get(&format!("{path}&{query}")).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, pointer));
    }
}

#[tokio::test]
async fn who_has_a_version_already_is_told_so_until_the_contact_moves() {
    let (server, contact) = moved().await;
    let paths = ["", "/stress?points=7", "/stress?points=7&format=csv", "/history", "/history?format=rows&limit=9"];
    let mut tags = Vec::new();
    for path in paths {
        let path = format!("{contact}{path}");
        let tag = header(&server.get(&path).await, "etag").to_owned();
        for known in [tag.clone(), format!("W/{tag}"), format!("\"other\", {tag}"), "*".to_owned()] {
            let response = server.send(Method::GET, &path, None, &[("if-none-match", &known)]).await;
            assert_eq!((response.status().as_u16(), header(&response, "etag")), (304, tag.as_str()), "{path} {known}");
            assert!(response.bytes().await.unwrap().is_empty());
        }
        tags.push((path, tag));
    }
    assert_ne!(tags[1].1, tags[2].1, "two formats are two versions");
    server.post(&format!("{contact}/move"), &json!({"displacement": 3e-8})).await;
    for (path, tag) in tags {
        let response = server.send(Method::GET, &path, None, &[("if-none-match", &tag)]).await;
        assert_eq!(response.status(), 200, "{path}");
        assert_ne!(header(&response, "etag"), tag, "{path}");
    }
    let gone = server.send(Method::GET, "/contacts/nowhere", None, &[("if-none-match", "*")]).await;
    assert_eq!(gone.status(), 404);
}
