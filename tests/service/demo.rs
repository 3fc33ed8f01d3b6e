//! `stickslip demo`: a contact of each kind, a measured loop, a scan, and the page opened.

use std::collections::BTreeSet;
use std::os::unix::fs::PermissionsExt as _;

use serde_json::Value;

use crate::common::openapi::document;
use crate::common::process::Process;
use crate::common::{binary, until};

async fn get(base: &str, path: &str) -> Value {
    let reply = reqwest::get(format!("{base}{path}")).await.unwrap().error_for_status().unwrap();
    reply.json().await.unwrap()
}

#[tokio::test(flavor = "multi_thread")]
async fn the_demonstration_has_a_contact_of_each_kind_a_loop_and_a_scan() {
    let server = Process::of(binary(&["demo", "--listen", "127.0.0.1:0", "--no-browser"])).await;
    let page = get(&server.base, "/contacts?limit=1000").await;
    let mut found = BTreeSet::new();
    for contact in page["items"].as_array().unwrap() {
        let path = format!("/contacts/{}", contact["id"].as_str().unwrap());
        assert!(contact["label"].is_string() && contact["sequence"].as_u64().unwrap() >= 3, "{contact}");
        let definition = get(&server.base, &format!("{path}/definition")).await;
        found.insert(definition["profile"]["type"].as_str().unwrap().to_owned());
        if contact["label"] == "ball, fitted to a measured loop" {
            let friction = get(&server.base, &format!("{path}/friction")).await;
            assert!((friction["friction"]["value"].as_f64().unwrap() - 0.3).abs() < 3e-3, "{friction}");
        }
    }
    let kinds = &document()["components"]["schemas"]["Profile"]["discriminator"]["mapping"];
    assert_eq!(found, kinds.as_object().unwrap().keys().cloned().collect());
    server.stop().await;
}

#[tokio::test(flavor = "multi_thread")]
async fn the_demonstration_opens_its_page_where_there_is_a_desktop() {
    let folder = tempfile::tempdir().unwrap();
    let (opener, opened) = (folder.path().join("xdg-open"), folder.path().join("opened"));
    std::fs::write(&opener, format!("#!/bin/sh\necho \"$1\" > {}\n", opened.display())).unwrap();
    std::fs::set_permissions(&opener, std::fs::Permissions::from_mode(0o755)).unwrap();
    let path = std::env::join_paths(
        [folder.path().to_owned()].into_iter().chain(std::env::split_paths(&std::env::var_os("PATH").unwrap())),
    );
    let mut command = binary(&["demo", "--listen", "127.0.0.1:0"]);
    command.env("PATH", path.unwrap()).env("DISPLAY", ":0");
    let server = Process::of(command).await;
    let text =
        until("the page is opened", async || std::fs::read_to_string(&opened).ok().filter(|text| text.ends_with('\n')))
            .await;
    assert_eq!(text.trim_end(), format!("{}/", server.base));
    server.stop().await;
}
