//! Third-party programs use the OpenAPI document alone: linters, generated clients, and a tester of APIs.

use std::path::Path;

use serde_json::Value;

use crate::common::process::Process;
use crate::node::{modules, node, npm_program};
use crate::python::{file, program, succeed};

#[tokio::test(flavor = "multi_thread")]
async fn a_client_generated_from_the_document_works() {
    let server = Process::start("memory:").await;
    let folder = tempfile::tempdir().unwrap();
    let mut generate = program("openapi-python-client");
    generate.args(["generate", "--meta", "none", "--fail-on-warning", "--path"]).arg(file("openapi/openapi.json"));
    succeed(generate.arg("--output-path").arg(folder.path().join("made")), "it is installed");
    let mut run = program("python");
    let said = succeed(run.env("PYTHONPATH", folder.path()).arg(file("tests/python/client.py")).arg(&server.base), "");
    assert!(said.contains("the generated client works"), "{said}");
}

/// Asks with the operations that a choice of Schemathesis takes, over the links between them.
async fn schemathesis_finds_nothing(choice: &str) {
    let server = Process::start("memory:").await;
    // It needs existing contacts to start from.
    server.client.create(&crate::common::create(), &Default::default()).await.unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut ask = program("schemathesis");
    ask.arg("--config-file").arg(file("tests/python/schemathesis.toml")).arg("run");
    ask.arg(format!("{}/openapi.json", server.base)).args(["--checks", "all", "--max-examples", "3", "--no-color"]);
    ask.args([choice, "^/contacts"]).current_dir(folder.path());
    ask.env("SCHEMATHESIS_HOOKS", "hooks").env("PYTHONPATH", file("tests/python"));
    let said = succeed(&mut ask, "it is installed");
    assert!(said.contains("API Links"), "{said}");
}

#[tokio::test(flavor = "multi_thread")]
async fn schemathesis_finds_nothing_in_contacts() {
    schemathesis_finds_nothing("--include-path-regex").await;
}

#[tokio::test(flavor = "multi_thread")]
async fn schemathesis_finds_nothing_elsewhere() {
    schemathesis_finds_nothing("--exclude-path-regex").await;
}

#[test]
fn the_linters_have_nothing_to_say() {
    let document = file("openapi/openapi.json");
    let mut redocly = npm_program("redocly");
    redocly.arg("lint").arg(&document).arg("--config").arg(file("tests/node/redocly.yaml")).arg("--format=json");
    let said: Value = serde_json::from_str(&succeed(&mut redocly, "it is installed")).unwrap();
    assert_eq!((&said["totals"]["errors"], &said["totals"]["warnings"]), (&0.into(), &0.into()), "{said:#}");
    let mut spectral = npm_program("spectral");
    spectral.arg("lint").arg(&document).arg("--ruleset").arg(file("tests/node/spectral.yaml"));
    // It ends with 1 for anything that it finds.
    succeed(spectral.arg("--fail-severity=hint"), "it is installed");
}

/// The example as a project of its own, with the types of the document.
fn typescript(folder: &Path) {
    for name in ["client.ts", "package.json", "tsconfig.json"] {
        std::fs::copy(file("examples/typescript").join(name), folder.join(name)).unwrap();
    }
    std::os::unix::fs::symlink(modules(), folder.join("node_modules")).unwrap();
    let mut generate = npm_program("openapi-typescript");
    generate.arg(file("openapi/openapi.json")).arg("--output").arg(folder.join("stickslip.ts"));
    succeed(&mut generate, "it is installed");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_client_in_typescript_compiles_strictly_and_works() {
    let server = Process::start("memory:").await;
    let folder = tempfile::tempdir().unwrap();
    typescript(folder.path());
    // Beside it, in the same run of the compiler, the example with a member that is misspelt: the types know it.
    let source = std::fs::read_to_string(folder.path().join("client.ts")).unwrap();
    std::fs::write(folder.path().join("misspelt.ts"), source.replace("friction: 0.3", "fricton: 0.3")).unwrap();
    let settings = std::fs::read_to_string(folder.path().join("tsconfig.json")).unwrap();
    let both = settings.replace(r#""client.ts""#, r#""client.ts", "misspelt.ts""#);
    std::fs::write(folder.path().join("tsconfig.json"), both).unwrap();
    let refused = npm_program("tsc").current_dir(folder.path()).output().unwrap();
    let said = String::from_utf8(refused.stdout).unwrap();
    let mut errors = said.lines().filter(|line| line.contains("error TS"));
    assert!(errors.all(|line| line.starts_with("misspelt.ts(")) && said.contains("fricton"), "{said}");
    let said = succeed(node().arg(folder.path().join("client.js")).arg(&server.base), "");
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines.len(), 2 + 5 + 1 + 2 + 1, "{said}");
    assert!(lines[0].starts_with("1: 1.") && lines[0].ends_with("partial_slip"), "{said}");
    assert_eq!(lines[7], "refused: force_exceeds_friction");
    assert!(lines[8].starts_with("event 1: ") && lines[9].starts_with("event 2: -0.5"), "{said}");
    assert_eq!(lines[10], "deleted");
    assert!(server.client.contacts(None, None).await.unwrap().items.is_empty());
}
