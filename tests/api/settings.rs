//! Every setting from each of its two sources, and the message about an invalid one.

use crate::common;

use std::collections::BTreeMap;
use std::process::{Command, Output};

use common::binary;
use common::process::{Process, ended};
use tempfile::tempdir;

/// Two values of every setting, none of them its default.
const CASES: [(&str, [&str; 2]); 33] = [
    ("listen", ["127.0.0.1:1", "127.0.0.1:2"]),
    ("keys", ["a.keys", "b.keys"]),
    ("first-key", ["a.keys", "b.keys"]),
    ("insecure", ["true", "true"]),
    ("allowed-hosts", ["a.example", "b.example:81"]),
    ("cors-origins", ["https://a.example", "http://b.example:81"]),
    ("tls-cert", ["a.pem", "b.pem"]),
    ("tls-key", ["a.pem", "b.pem"]),
    ("store", ["memory:", "sqlite:a.db"]),
    ("cache-bytes", ["1MiB", "2MiB"]),
    ("expire-after", ["1h", "2h"]),
    ("job-lease", ["1s", "2s"]),
    ("log", ["warn", "debug"]),
    ("log-format", ["json", "json"]),
    ("otlp-endpoint", ["http://a.example:4318", "http://b.example"]),
    ("max-connections", ["10", "20"]),
    ("max-connections-per-client", ["1", "2"]),
    ("trusted-proxies", ["10.0.0.0/8", "::1"]),
    ("max-requests", ["10", "20"]),
    ("max-queue", ["10", "20"]),
    ("max-requests-per-client", ["10", "20"]),
    ("max-streams-per-client", ["10", "20"]),
    ("max-contacts-per-tenant", ["10", "20"]),
    ("max-body-bytes-per-client", ["10MiB", "20MiB"]),
    ("max-store-bytes-per-tenant", ["10MiB", "20MiB"]),
    ("max-wait", ["1s", "2s"]),
    ("work-bytes", ["256MiB", "300MiB"]),
    ("deadline", ["1s", "2s"]),
    ("head-time", ["1s", "2s"]),
    ("body-time", ["1s", "2s"]),
    ("idle-time", ["1s", "2s"]),
    ("stall-time", ["1s", "2s"]),
    ("drain-time", ["1s", "2s"]),
];

fn variable(key: &str) -> String {
    format!("STICKSLIP_{}", key.to_uppercase().replace('-', "_"))
}

fn said(command: &mut Command) -> (Output, String, String) {
    let output = ended(command);
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    (output, out, err)
}

/// What `stickslip config` prints: value and source by variable, no value where there is none.
fn in_force(command: &mut Command) -> BTreeMap<String, (Option<String>, String)> {
    let (output, out, err) = said(command);
    assert!(output.status.success(), "{err}");
    let (mut found, mut source) = (BTreeMap::new(), "");
    for line in out.lines().skip(1) {
        if let Some(name) = line.strip_prefix("# ").and_then(|rest| rest.strip_suffix(" is not set")) {
            found.insert(name.to_owned(), (None, "default".to_owned()));
        } else if let Some(from) = line.strip_prefix("# ").and_then(|rest| rest.strip_suffix(":")) {
            source = from;
        } else {
            let default = line.strip_prefix("# default: ");
            let (name, value) = default.unwrap_or(line).split_once('=').expect(line);
            let source = if default.is_some() { "default" } else { source };
            found.insert(name.to_owned(), (Some(value.to_owned()), source.to_owned()));
        }
    }
    found
}

#[test]
fn every_setting_comes_by_flag_and_by_environment_in_this_order() {
    let plain = in_force(&mut binary(&["config"]));
    let known: Vec<&str> = plain.keys().map(String::as_str).collect();
    let mut tested: Vec<String> = CASES.iter().map(|(key, _)| variable(key)).collect();
    tested.sort_unstable();
    assert_eq!(tested, known, "every setting needs a case, and every case a setting");
    for (key, [flag, environment]) in CASES {
        let name = variable(key);
        let (default, source) = &plain[&name];
        assert_eq!(source, "default", "{key}");
        let argument = format!("--{key}={flag}");
        for (arguments, set, (value, source)) in [
            (&[&argument][..], true, (flag, "by a flag")),
            (&[&argument], false, (flag, "by a flag")),
            (&[], true, (environment, "by the environment")),
        ] {
            assert_ne!(default.as_deref(), Some(value), "{key}");
            let mut command = binary(&["config"]);
            command.args(arguments);
            if set {
                command.env(&name, environment);
            }
            let found = in_force(&mut command);
            assert_eq!(found[&name], (Some(value.to_owned()), source.to_owned()), "{key} {arguments:?} {set}");
            let others = found.iter().filter(|(other, _)| **other != name);
            assert!(others.clone().all(|(_, (_, source))| source == "default"), "{key}: {found:?}");
            assert_eq!(others.count(), plain.len() - 1);
        }
    }
}

#[test]
fn what_is_printed_is_an_environment_that_sets_the_same() {
    let (_, printed, _) =
        said(&mut binary(&["config", "--log", "warn", "--keys", "a.keys,b.keys", "--cache-bytes=4096"]));
    let lines = printed.lines().filter(|line| !line.starts_with('#')).map(|line| line.split_once('=').unwrap());
    let set: Vec<_> = lines.collect();
    assert_eq!(set.len(), 3, "{printed}");
    let (_, again, _) = said(binary(&["config"]).envs(set));
    assert_eq!(again.replace("by the environment", "by a flag"), printed);
}

/// One line on standard error, nothing else, and no success.
fn refusal(command: &mut Command) -> String {
    let (output, out, err) = said(command);
    assert_eq!((output.status.code(), out.as_str(), err.lines().count()), (Some(2), "", 1), "{command:?} {out} {err}");
    err
}

#[test]
fn whatever_is_wrong_ends_the_start_with_one_line_that_says_what_and_what_is_allowed() {
    for command in ["serve", "config"] {
        for (key, value, allowed) in [
            ("listen", "nowhere", "Address and port"),
            ("cache-bytes", "lots", "such as 64MiB"),
            ("expire-after", "10ms", "at least 1s"),
            ("log", "a=b=c", "trace"),
            ("log-format", "xml", "text or json"),
            ("cors-origins", "*", "such as https://"),
        ] {
            let by_flag = refusal(&mut binary(&[command, &format!("--{key}"), value]));
            let by_environment = refusal(binary(&[command]).env(variable(key), value));
            assert!(by_flag.starts_with(&format!("--{key} {value}: ")), "{by_flag}");
            assert!(by_environment.starts_with(&format!("{}={value}: ", variable(key))), "{by_environment}");
            for said in [by_flag, by_environment] {
                assert!(said.contains(allowed), "{said}");
            }
        }
        for (said, what, allowed) in [
            (refusal(&mut binary(&[command, "--listem", "x"])), "--listem", "--listen"),
            (refusal(binary(&[command]).env("STICKSLIP_LISTEM", "x")), "STICKSLIP_LISTEM=x", "STICKSLIP_LISTEN"),
            // The settings were a file once.
            (refusal(&mut binary(&[command, "--config", "a.toml"])), "--config", "unknown setting"),
        ] {
            assert!(said.contains(what) && said.contains(allowed), "{said}");
        }
    }
    // The near name alone, or else those of this command alone.
    let near = refusal(&mut binary(&["serve", "--allowed-host", "x"]));
    assert!(near.ends_with("is it --allowed-hosts?\n"), "{near}");
    let far = refusal(&mut binary(&["key", "new", "--quite-another", "x"]));
    assert!(far.contains("--expires-at, --name, --note, --role, --tenant") && !far.contains("--listen"), "{far}");
    // Kubernetes sets these for every container beside a service of this name.
    let beside = [("STICKSLIP_SERVICE_HOST", "10.0.0.1"), ("STICKSLIP_PORT_8080_TCP", "tcp://10.0.0.1:8080")];
    in_force(binary(&["config"]).envs(beside));
}

#[tokio::test]
async fn without_a_command_it_serves_the_store_of_the_folder_and_makes_none() {
    let folder = tempdir().unwrap();
    let with = |arguments: &[&str]| {
        let mut command = binary(arguments);
        command.args(["--listen", "127.0.0.1:0"]).current_dir(folder.path());
        command
    };
    let output = ended(&mut with(&[]));
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), said.lines().count()), (Some(2), 1), "{said}");
    assert!(said.contains("stickslip.db") && said.contains("`stickslip serve`"), "{said}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    for arguments in [&["serve"][..], &[]] {
        let process = Process::of(with(arguments)).await;
        process.client.healthz().await.unwrap();
        process.stop().await;
        assert!(folder.path().join("stickslip.db").exists());
    }
}
