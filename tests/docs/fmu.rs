//! A contact as an FMU, checked by FMPy.

use std::path::PathBuf;

use crate::common::run;
use crate::python::{file, program, succeed};

/// The wrapper that was built with this test.
fn library() -> PathBuf {
    std::env::current_exe().unwrap().with_file_name("libstickslip_fmu.so")
}

#[test]
fn an_fmu_is_valid_and_simulates_as_the_program_does() {
    let folder = tempfile::tempdir().unwrap();
    let [definition, archive] = ["ball.json", "ball.fmu"].map(|name| folder.path().join(name));
    std::fs::write(&definition, stickslip_wire::ContactDefinition::example().to_string()).unwrap();
    let [contact, out, library] = [&definition, &archive, &library()].map(|path| path.to_str().unwrap().to_owned());
    let made = run(&["fmu", &contact, "--out", &out, "--library", &library]);
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let mut check = program("python");
    check.arg(file("tests/python/fmu.py")).arg(env!("CARGO_BIN_EXE_stickslip")).args([&archive, &definition]);
    let said = succeed(&mut check, "it is installed");
    assert!(said.contains("the FMU works"), "{said}");
}

#[test]
fn what_cannot_be_an_fmu_is_refused_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let [definition, archive] = ["ball.json", "ball.fmu"].map(|name| folder.path().join(name));
    let [contact, out] = [&definition, &archive].map(|path| path.to_str().unwrap().to_owned());
    let refusal = |text: &str, arguments: &[&str]| {
        std::fs::write(&definition, text).unwrap();
        let refused = run(&[&["fmu", contact.as_str(), "--out", out.as_str()][..], arguments].concat());
        assert!(!refused.status.success() && !archive.exists());
        String::from_utf8_lossy(&refused.stderr).into_owned()
    };
    let example = stickslip_wire::ContactDefinition::example().to_string();
    assert!(refusal(&example, &["--library", "absent.so"]).contains("absent.so"));
    assert!(refusal("{}", &[]).contains("profile"));
    assert!(refusal(&example.replace("0.3", "-1"), &[]).contains("/friction"));
    let memory = example.replacen('{', r#"{"prony": [{"ratio": 0.5, "time": 1.0}], "#, 1);
    let said = refusal(&memory, &[]);
    assert!(said.contains("an FMU"), "{said}");
}
