//! Third-party programs use the OpenAPI document alone: a generated client, and a tester of APIs.

use crate::common::process::Process;
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

#[tokio::test(flavor = "multi_thread")]
async fn schemathesis_finds_nothing() {
    let server = Process::start("memory:").await;
    // It needs existing contacts to start from.
    server.client.create(&crate::common::create(), &Default::default()).await.unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut ask = program("schemathesis");
    ask.arg("--config-file").arg(file("tests/python/schemathesis.toml")).arg("run");
    ask.arg(format!("{}/openapi.json", server.base)).args(["--checks", "all", "--max-examples", "3", "--no-color"]);
    ask.current_dir(folder.path());
    ask.env("SCHEMATHESIS_HOOKS", "hooks").env("PYTHONPATH", file("tests/python"));
    let said = succeed(&mut ask, "it is installed");
    assert!(said.contains("API Links"), "{said}");
}
