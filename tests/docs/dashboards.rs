//! The dashboards of `deploy/`: each of their queries is run by its data source.

use std::collections::BTreeMap;
use std::process::Command;
use std::time::Duration;

use serde_json::{Value, json};
use stickslip_wire::Move;

use crate::common::create;
use crate::common::postgres::Cluster;
use crate::common::process::Process;
use crate::common::prometheus::{MISSING, Prometheus};
use crate::docs::page;
use crate::node::node;
use crate::python::{file, program, succeed};

fn dashboard(name: &str) -> Value {
    let text = std::fs::read_to_string(file(&format!("deploy/grafana/dashboards/{name}.json"))).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// The targets of a dashboard, with the titles of their panels.
fn targets(dashboard: &Value) -> Vec<(String, Value)> {
    let panels = dashboard["panels"].as_array().unwrap().iter();
    panels
        .flat_map(|panel| {
            let title = panel["title"].as_str().unwrap().to_owned();
            panel["targets"].as_array().unwrap().iter().map(move |target| (title.clone(), target.clone()))
        })
        .collect()
}

#[tokio::test(flavor = "multi_thread")]
async fn every_query_of_the_dashboards_is_answered() {
    let cluster = Cluster::shared();
    let database = cluster.database().await;
    let server = Process::start(&database).await;
    let prometheus = Prometheus::start(server.base.trim_start_matches("http://"));
    let made = server.client.create(&create(), &Default::default()).await.unwrap();

    // Rates need readings before and after; so the contact moves while each query is asked until it has an answer.
    let mut steps = 0_u32;
    let operations = dashboard("operations");
    let queries = targets(&operations);
    assert!(queries.len() > 12, "{}", queries.len());
    let mut values = BTreeMap::new();
    let asked = async {
        for (title, target) in &queries {
            assert_eq!(target["datasource"]["uid"], "prometheus", "{title}");
            let query = target["expr"].as_str().unwrap().replace("$__rate_interval", "1m");
            loop {
                steps += 1;
                let step = Move::displacement(1e-8 * f64::from(steps % 7)).into();
                server.client.apply(made.id, &step, &Default::default()).await.unwrap();
                let found = prometheus.query(&[("query", &query)]).await;
                if !found.is_empty() && found.iter().all(|(_, value)| value.is_finite()) {
                    let legend = target["legendFormat"].as_str().unwrap();
                    for label in legend.split("{{").skip(1).map(|rest| rest.split("}}").next().unwrap()) {
                        assert!(found[0].0[label].is_string(), "{title}: no label {label}");
                    }
                    values.insert(query, found[0].1);
                    break;
                }
                tokio::time::sleep(Duration::from_millis(100)).await;
            }
        }
    };
    tokio::time::timeout(Duration::from_secs(120), asked).await.expect("a query has no answer");
    assert!(values["sum(rate(stickslip_moves_total[1m]))"] > 0.0, "{values:?}");
    let share = values.iter().find(|(query, _)| query.contains("cache_hits")).unwrap().1;
    assert!((0.0..=1.0).contains(share), "{share}");
}

/// A cycle of displacements to and fro, beyond the gross slip of the contact of the examples, m.
fn measured_cycle() -> Vec<f64> {
    let turn = |step: u32| (f64::from(step) * std::f64::consts::TAU / 20.0).cos();
    (0..=20).map(|step| 3e-7 * turn(step)).collect()
}

/// A contact that follows a bench which is exactly as it predicts.
async fn follow_bench(server: &Process) -> String {
    let http = reqwest::Client::new();
    let post = async |path: String, body: Value| -> Value {
        let reply = http.post(format!("{}{path}", server.base)).json(&body).send().await.unwrap();
        reply.error_for_status().unwrap().json().await.unwrap()
    };
    let displacements = measured_cycle();
    let (bench, contact) = (server.client.create(&create(), &Default::default()).await.unwrap().id, create());
    let path = json!({"path": {"displacement": displacements}, "steps": "all"});
    let states = post(format!("/contacts/{bench}/path"), path).await;
    let measured = states["steps"].as_array().unwrap().iter();
    let observations: Vec<Value> =
        measured.map(|state| json!({"displacement": state["displacement"], "force": state["force"]})).collect();
    assert_eq!(observations.len(), displacements.len());
    let id = server.client.create(&contact, &Default::default()).await.unwrap().id;
    post(format!("/contacts/{id}/observations"), json!({"observations": observations})).await;
    id.to_string()
}

/// What a data source finds in a reply by a selector with dots.
fn select<'a>(reply: &'a Value, selector: &str) -> &'a Value {
    let pointer: String = selector.split('.').filter(|part| !part.is_empty()).map(|part| format!("/{part}")).collect();
    reply.pointer(&pointer).unwrap_or_else(|| panic!("no {selector} in {reply}"))
}

#[tokio::test(flavor = "multi_thread")]
async fn every_panel_of_a_contact_works_on_sqlite() {
    let folder = tempfile::tempdir().unwrap();
    let server = Process::start(&format!("sqlite:{}", folder.path().join("contacts.db").display())).await;
    let id = follow_bench(&server).await;
    let board = dashboard("contact");
    let of = |text: &Value| text.as_str().unwrap().replace("${service}", &server.base).replace("${contact}", &id);
    // The panel of the page has its service from the data source.
    let text = page("dashboards.md");
    let pasted = text.split("```json\n").nth(1).unwrap().split("```").next().unwrap();
    let pasted = pasted.replace("\"/contacts/ID/", "\"${service}/contacts/${contact}/");
    let pasted: Value = serde_json::from_str(&pasted).unwrap();

    // The list of contacts, by the language in which the data source selects.
    let variable = &board["templating"]["list"][1]["query"]["infinityQuery"];
    let page: Value = reqwest::get(of(&variable["url"])).await.unwrap().json().await.unwrap();
    let mut select_contacts = node();
    let script = "const [, expression, page] = process.argv;\
                  require('jsonata')(expression).evaluate(JSON.parse(page)).then((found) => \
                  console.log(JSON.stringify(found)))";
    let expression = variable["root_selector"].as_str().unwrap();
    let said = succeed(select_contacts.args(["-e", script, expression, &page.to_string()]), "it is installed");
    let choices: Vec<Value> = serde_json::from_str(&said).unwrap();
    assert_eq!((choices.len(), choices[0]["__value"].as_str()), (2, Some(id.as_str())), "the newest first: {said}");
    assert!(choices[0]["__text"].as_str().unwrap().ends_with(&id), "{said}");

    let mut titles = Vec::new();
    for (title, target) in targets(&board).into_iter().chain(targets(&pasted)) {
        assert_eq!(target["datasource"]["uid"], "infinity", "{title}");
        assert!(target["url"].as_str().unwrap().starts_with("${service}/"), "{title}: the address is a variable");
        let reply = reqwest::get(of(&target["url"])).await.unwrap().error_for_status().unwrap();
        let reply: Value = reply.json().await.unwrap();
        let found = select(&reply, target["root_selector"].as_str().unwrap());
        let rows = found.as_array().map_or(vec![found], |rows| rows.iter().collect());
        assert!(!rows.is_empty(), "{title}");
        for column in target["columns"].as_array().unwrap() {
            let cells = rows.iter().map(|row| select(row, column["selector"].as_str().unwrap()));
            let shown = |cell: &Value| match column["type"].as_str() {
                Some("number") => cell.is_number(),
                Some("timestamp") => cell.as_str().is_some_and(|at| at.ends_with('Z')),
                _ => false,
            };
            assert!(cells.clone().all(shown), "{title}: {column} {cells:?}");
        }
        titles.push(title);
    }
    assert_eq!(titles.len(), 10 + 1, "{titles:?}");
}

#[test]
fn what_is_provisioned_is_there_and_fits_together() {
    let check = Command::new("promtool").args(["check", "config"]).arg(file("deploy/prometheus.yml")).output();
    assert!(check.expect(MISSING).status.success());
    let mut compose = Command::new("docker-compose");
    compose.arg("--file").arg(file("deploy/compose.yaml")).args(["config", "--quiet"]);
    compose.env("POSTGRES_PASSWORD", "letters").env("GRAFANA_PASSWORD", "digits");
    succeed(&mut compose, "this test needs docker-compose: `./check` installs it");
    let mut read = program("python");
    let said = succeed(read.arg(file("tests/python/deploy.py")).arg(file("deploy")), "it is installed");
    assert!(said.contains("deploy fits together"), "{said}");
}
