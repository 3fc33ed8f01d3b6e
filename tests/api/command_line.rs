//! The command line beside its computations: completions, manual pages, and refusals in words.

use std::collections::BTreeSet;
use std::net::TcpListener;

use serde_json::{Value, json};
use stickslip_wire::ProblemDocument;

use crate::common::{ball, binary, run};

fn printed(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The names of the commands, as the help has them.
fn commands() -> BTreeSet<String> {
    let help = printed(&["--help"]);
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names = listed.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    names.filter_map(|line| Some(line.split_whitespace().next()?.to_owned())).filter(|name| name != "help").collect()
}

#[test]
fn every_shell_completes_every_command() {
    let commands = commands();
    assert!(commands.len() > 15 && commands.contains("simulate") && commands.contains("completions"), "{commands:?}");
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = printed(&["completions", shell]);
        for command in &commands {
            assert!(script.contains(command.as_str()), "{shell} does not complete {command}");
        }
        assert!(script.contains("--format") || script.contains("-l format"), "{shell}");
    }
}

#[test]
fn a_computation_is_found_by_its_name_in_the_api() {
    for (alias, name) in [("protocols", "protocol"), ("fit-profile", "profile")] {
        assert_eq!(printed(&[alias, "--help"]).replace(alias, name), printed(&[name, "--help"]).replace(alias, name));
        assert!(printed(&["--help"]).contains(&format!("[alias: {alias}]")), "the help names {alias}");
    }
}

#[test]
fn every_command_has_a_manual_page() {
    let folder = tempfile::tempdir().unwrap();
    let pages = folder.path().join("man");
    printed(&["man", pages.to_str().unwrap()]);
    for command in commands() {
        let page = std::fs::read_to_string(pages.join(format!("stickslip-{command}.1"))).unwrap();
        assert!(page.contains(".SH NAME") && page.contains(&command.replace('-', "\\-")), "{command}: {page}");
    }
    assert!(std::fs::read_to_string(pages.join("stickslip.1")).unwrap().contains("stickslip\\-simulate"));
}

/// The document that a refused command prints.
fn refused(arguments: &[&str]) -> ProblemDocument {
    let output = run(arguments);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && output.stdout.is_empty(), "{arguments:?}: {text}");
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{arguments:?}: {error} in {text}"))
}

#[test]
fn with_json_every_fault_is_a_problem_document() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let cell = file("cell.csv", "X [um];Z [nm]\n1;2\n3;four\n");
    let broken = file("broken.csv", "x [um];F [N]\n1;2\n3;four\n");
    let sound = file("sound.csv", "X [um];Z [nm]\n-2;-4\n-1;-1\n0;0\n1;-1\n2;-4\n");
    let contact = file("contact.json", r#"{"profile": {"type": "sphere", "radius": true}}"#);
    let load = file("load.json", r#"{"friction": "much"}"#);
    let sweep = file("sweep.json", r#"{"base": {}, "axes": []}"#);
    let array = file("array.json", "[1]");
    let absent = folder.path().join("absent.json");
    let absent = absent.to_str().unwrap();
    for (arguments, code, pointer) in [
        (&["profile", &cell] as &[&str], "invalid_input", Some("/line/3/column/2")),
        (&["fit", &broken, "--contact", "examples/data/ball_contact.json"], "invalid_input", Some("/line/3/column/2")),
        (&["fit", &sound], "invalid_input", None),
        (&["fit", &sound, "--contact", &contact], "invalid_input", Some("/profile/radius")),
        (&["fit", &sound, "--contact", absent], "invalid_input", None),
        (&["fit", &sound, "--contact", &cell], "not_json", None),
        (&["profile", &sound, "--load", &load], "invalid_input", Some("/friction")),
        (&["profile", &sound, "--load", absent], "invalid_input", None),
        (&["simulate", absent], "invalid_input", None),
        (&["cycle", &array, "--map", "1:2:3"], "invalid_input", None),
        (&["protocol", "--contact", &cell], "invalid_input", None),
        (&["sweep", absent], "invalid_input", None),
        (&["sweep", &cell], "not_json", None),
        (&["sweep", &sweep], "invalid_input", Some("/outputs")),
    ] {
        let problem = refused(&[arguments, &["--json"]].concat());
        assert_eq!(problem.code, code, "{arguments:?}: {problem:?}");
        assert!(!problem.detail.is_empty());
        let found = problem.errors.first().map(|fault| fault.pointer.as_str());
        assert_eq!(found, pointer, "{arguments:?}: {problem:?}");
    }
}

#[test]
fn a_body_is_read_from_standard_input_and_a_refusal_is_a_failure() {
    let simulated = |force: f64| {
        let body = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(&body, json!({"contact": ball(), "path": {"force": [force]}}).to_string()).unwrap();
        binary(&["simulate", "-"]).stdin(body.reopen().unwrap()).output().unwrap()
    };
    let (good, bad) = (simulated(1.0), simulated(3.0));
    let reply: Value = serde_json::from_slice(&good.stdout).unwrap();
    assert!(good.status.success() && (reply["steps"][0]["force"].as_f64().unwrap() - 1.0).abs() < 1e-12, "{reply}");
    let problem: ProblemDocument = serde_json::from_slice(&bad.stderr).unwrap();
    assert_eq!((bad.status.code(), problem.code.as_str()), (Some(1), "force_exceeds_friction"));
    assert_eq!(problem.errors[0].pointer, "/path/force/0");
}

#[test]
fn an_address_in_use_names_the_remedy() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = taken.local_addr().unwrap().to_string();
    let refused = run(&["serve", "--store", "memory:", "--listen", &address]);
    let text = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(!refused.status.success());
    assert!(text.contains(&format!("cannot listen on {address}")) && text.contains("--listen 127.0.0.1:0"), "{text}");
}
