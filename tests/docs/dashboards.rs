//! The dashboards of `deploy/`: each of their queries is run by its data source.

use std::collections::BTreeMap;
use std::process::Command;
use std::time::Duration;

use serde_json::Value;
use stickslip_wire::{Move, MoveRequest};
use tokio_postgres::NoTls;

use crate::common::create;
use crate::common::postgres::Cluster;
use crate::common::process::Process;
use crate::common::prometheus::{MISSING, Prometheus};
use crate::python::{file, program, succeed};

const MOVES: usize = 5;

/// What a query finds: a number for each set of labels. None if there is no answer.
async fn ask(prometheus: &Prometheus, http: &reqwest::Client, query: &str) -> Option<Vec<(Value, f64)>> {
    let reply = http.get(format!("{}/api/v1/query", prometheus.base)).query(&[("query", query)]).send().await.ok()?;
    let answer: Value = reply.json().await.ok()?;
    assert_ne!(answer["status"], "error", "{query}: {answer}");
    let found = answer["data"]["result"].as_array()?.iter();
    found.map(|one| Some((one["metric"].clone(), one["value"][1].as_str()?.parse().ok()?))).collect()
}

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
    let http = reqwest::Client::new();

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
                let found = ask(&prometheus, &http, &query).await.unwrap_or_default();
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

    contact_dashboard(&server, &database, made.id, steps as usize).await;
}

/// The queries of the dashboard of a contact that has made so many moves.
async fn contact_dashboard(server: &Process, database: &str, id: uuid::Uuid, moves: usize) {
    for force in 0..MOVES {
        let request = MoveRequest { force: Some(0.1 * force as f64), ..MoveRequest::default() };
        server.client.apply(id, &request, &Default::default()).await.unwrap();
    }
    let moves = moves + MOVES;
    let (client, connection) = tokio_postgres::connect(database, NoTls).await.unwrap();
    tokio::spawn(connection);
    let board = dashboard("contact");
    let variable = &board["templating"]["list"][0];
    let rows = client.query(variable["query"].as_str().unwrap(), &[]).await.unwrap();
    assert_eq!(rows.iter().map(|row| row.get::<_, String>("__value")).collect::<Vec<_>>(), [id.to_string()]);
    assert!(rows[0].get::<_, String>("__text").ends_with(&id.to_string()));

    let (mut tables, mut urls) = (0, 0);
    for (title, target) in targets(&board) {
        match target["datasource"]["uid"].as_str().unwrap() {
            "postgres" => {
                let query = target["rawSql"].as_str().unwrap().replace("$contact", &id.to_string());
                let query = query.replace("$__timeFilter(at)", "at BETWEEN now() - interval '1 hour' AND now()");
                let rows = client.query(&query, &[]).await.unwrap();
                assert_eq!(rows.len(), moves, "{title}");
                assert_eq!(rows[0].columns()[0].name(), "time", "{title}");
                rows.iter().for_each(|row| assert!(row.get::<_, f64>(1).is_finite(), "{title}"));
                tables += 1;
            }
            "infinity" => {
                let url = target["url"].as_str().unwrap().replace("$contact", &id.to_string());
                let url = url.replace("http://stickslip:8080", &server.base);
                let rows: Vec<Value> = reqwest::get(url).await.unwrap().json().await.unwrap();
                assert!(rows.len() > 100, "{title}: {}", rows.len());
                for column in target["columns"].as_array().unwrap() {
                    let name = column["selector"].as_str().unwrap();
                    assert!(rows.iter().all(|row| row[name].is_number()), "{title}: {name}");
                }
                urls += 1;
            }
            other => panic!("{title}: {other}"),
        }
    }
    assert_eq!((tables, urls), (4, 2));
}

#[test]
fn what_is_provisioned_is_there_and_fits_together() {
    let check = Command::new("promtool").args(["check", "config"]).arg(file("deploy/prometheus.yml")).output();
    assert!(check.expect(MISSING).status.success());
    let mut read = program("python");
    let said = succeed(read.arg(file("tests/python/deploy.py")).arg(file("deploy")), "it is installed");
    assert!(said.contains("deploy fits together"), "{said}");
}
