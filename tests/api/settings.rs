//! Every setting from each of its three sources, and the message about an invalid one.

use crate::common;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};

use common::binary;
use common::process::{Process, ended};
use tempfile::tempdir;

/// Three values of every setting, none of them its default.
const CASES: [(&str, [&str; 3]); 33] = [
    ("listen", ["127.0.0.1:1", "127.0.0.1:2", "127.0.0.1:3"]),
    ("keys", ["a.keys", "b.keys", "c.keys"]),
    ("first-key", ["a.keys", "b.keys", "c.keys"]),
    ("insecure", ["true", "true", "true"]),
    ("allowed-hosts", ["a.example", "b.example:81", "[2001:db8::1]"]),
    ("cors-origins", ["https://a.example", "http://b.example:81", "http://[::1]"]),
    ("tls-cert", ["a.pem", "b.pem", "c.pem"]),
    ("tls-key", ["a.pem", "b.pem", "c.pem"]),
    ("store", ["memory:", "sqlite:a.db", "sqlite:b.db"]),
    ("cache-bytes", ["1MiB", "2MiB", "3000"]),
    ("expire-after", ["1h", "2h", "30d"]),
    ("job-lease", ["1s", "2s", "1m"]),
    ("log", ["warn", "debug", "stickslip=trace"]),
    ("log-format", ["json", "json", "json"]),
    ("otlp-endpoint", ["http://a.example:4318", "http://b.example", "http://c.example"]),
    ("max-connections", ["10", "20", "30"]),
    ("max-connections-per-client", ["1", "2", "3"]),
    ("trusted-proxies", ["10.0.0.0/8", "::1", "192.0.2.1"]),
    ("max-requests", ["10", "20", "30"]),
    ("max-queue", ["10", "20", "30"]),
    ("max-requests-per-client", ["10", "20", "30"]),
    ("max-streams-per-client", ["10", "20", "30"]),
    ("max-contacts-per-tenant", ["10", "20", "30"]),
    ("max-body-bytes-per-client", ["10MiB", "20MiB", "30MiB"]),
    ("max-store-bytes-per-tenant", ["10MiB", "20MiB", "30MiB"]),
    ("max-wait", ["1s", "2s", "500ms"]),
    ("work-bytes", ["256MiB", "300MiB", "1GiB"]),
    ("deadline", ["1s", "2s", "1h"]),
    ("head-time", ["1s", "2s", "1m"]),
    ("body-time", ["1s", "2s", "1m"]),
    ("idle-time", ["1s", "2s", "1h"]),
    ("stall-time", ["1s", "2s", "1m"]),
    ("drain-time", ["1s", "2s", "1m"]),
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

/// What `stickslip config` prints: value and source by key, no value where there is none.
fn in_force(command: &mut Command) -> BTreeMap<String, (Option<String>, String)> {
    let (output, out, err) = said(command);
    assert!(output.status.success(), "{err}");
    let mut found = BTreeMap::new();
    for line in out.lines().skip(1) {
        if let Some(key) = line.strip_prefix("# ").and_then(|rest| rest.strip_suffix(" is not set")) {
            found.insert(key.to_owned(), (None, "default".to_owned()));
        } else {
            let (key, rest) = line.split_once(" = ").expect(line);
            let (value, source) = rest.rsplit_once(" # ").expect(line);
            let value =
                value.strip_prefix("[").and_then(|rest| rest.strip_suffix("]")).unwrap_or(value).trim_matches('"');
            found.insert(key.to_owned(), (Some(value.to_owned()), source.to_owned()));
        }
    }
    found
}

fn write(path: &Path, text: &str) -> String {
    std::fs::write(path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

#[test]
fn every_setting_comes_by_flag_by_environment_and_by_file_in_this_order() {
    let folder = tempdir().unwrap();
    let plain = in_force(&mut binary(&["config"]));
    let known: Vec<&str> = plain.keys().map(String::as_str).collect();
    let mut tested: Vec<&str> = CASES.iter().map(|(key, _)| *key).collect();
    tested.sort_unstable();
    assert_eq!(tested, known, "every setting needs a case, and every case a setting");
    for (key, [flag, environment, file]) in CASES {
        let (default, source) = &plain[key];
        assert_eq!(source, "default", "{key}");
        for value in [flag, environment, file] {
            assert_ne!(default.as_deref(), Some(value), "{key}");
        }
        let path = write(&folder.path().join("settings.toml"), &format!("{key} = '{file}'"));
        let (flag_argument, from_file) = (format!("--{key}={flag}"), format!("file {path}"));
        let in_variable = format!("environment {}", variable(key));
        let by_file = ["--config", &path];
        let all = [&flag_argument, "--config", &path];
        for (arguments, set, (value, source)) in [
            (&by_file[..], false, (file, from_file.as_str())),
            (&by_file[..], true, (environment, &in_variable)),
            (&all[..], false, (flag, "flag")),
            (&all[..], true, (flag, "flag")),
            (&[&flag_argument], false, (flag, "flag")),
            (&[], true, (environment, &in_variable)),
        ] {
            let mut command = binary(&["config"]);
            command.args(arguments);
            if set {
                command.env(variable(key), environment);
            }
            let found = in_force(&mut command);
            let expected = (Some(value.to_owned()), source.to_owned());
            assert_eq!(found[key], expected, "{key} {arguments:?} {set}");
            let others = found.iter().filter(|(other, _)| *other != key);
            assert!(others.clone().all(|(_, (_, source))| source == "default"), "{key}: {found:?}");
            assert_eq!(others.count(), plain.len() - 1);
        }
    }
}

#[test]
fn the_file_is_named_by_flag_or_environment_and_none_is_read_unasked() {
    let folder = tempdir().unwrap();
    let path = write(&folder.path().join("stickslip.toml"), "log = 'warn'\ncache-bytes = 4096\n");
    let in_folder = |command: &mut Command| in_force(command.current_dir(folder.path()));
    assert_eq!(in_folder(&mut binary(&["config"]))["log"].1, "default");
    let found = in_folder(binary(&["config"]).env("STICKSLIP_CONFIG", &path));
    assert_eq!(found["log"].0.as_deref(), Some("warn"));
    assert_eq!(found["cache-bytes"].0.as_deref(), Some("4096"));
    // What is printed can be given back.
    let (_, printed, _) = said(binary(&["config"]).env("STICKSLIP_CONFIG", &path));
    let again = write(&folder.path().join("again.toml"), &printed);
    let values = |found: BTreeMap<String, (Option<String>, String)>| -> Vec<_> {
        found.into_iter().map(|(key, (value, _))| (key, value)).collect()
    };
    assert_eq!(values(in_force(&mut binary(&["config", "--config", &again]))), values(found));
}

/// One line on standard error, nothing else, and no success.
fn refusal(command: &mut Command) -> String {
    let (output, out, err) = said(command);
    assert_eq!((output.status.code(), out.as_str(), err.lines().count()), (Some(2), "", 1), "{command:?} {out} {err}");
    err
}

#[test]
fn whatever_is_wrong_ends_the_start_with_one_line_that_says_what_and_what_is_allowed() {
    let folder = tempdir().unwrap();
    let file = |text: &str| write(&folder.path().join("wrong.toml"), text);
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
            let by_file = refusal(&mut binary(&[command, "--config", &file(&format!("\n{key} = '{value}'"))]));
            assert!(by_flag.starts_with(&format!("--{key} {value}: ")), "{by_flag}");
            assert!(by_environment.starts_with(&format!("{}={value}: ", variable(key))), "{by_environment}");
            assert!(by_file.contains(&format!("wrong.toml: {key} = {value}: ")), "{by_file}");
            for said in [by_flag, by_environment, by_file] {
                assert!(said.contains(allowed), "{said}");
            }
        }
        for (said, what, allowed) in [
            (refusal(&mut binary(&[command, "--listem", "x"])), "--listem", "--listen"),
            (refusal(binary(&[command]).env("STICKSLIP_LISTEM", "x")), "STICKSLIP_LISTEM=x", "STICKSLIP_LISTEN"),
            (refusal(&mut binary(&[command, "--config", &file("listem = 'x'")])), "listem = \"x\"", "listen"),
            (
                refusal(&mut binary(&[command, "--config", &file("listen = ['x']")])),
                "listen = [\"x\"]",
                "one plain value",
            ),
            (refusal(&mut binary(&[command, "--config", &file("[log]\na = 1")])), "log = ", "one plain value"),
            (
                refusal(&mut binary(&[command, "--config", &file("log = 'a'\nlog = 'b'")])),
                "wrong.toml, line 2",
                "duplicate key",
            ),
            (refusal(&mut binary(&[command, "--config", "/none"])), "/none", "cannot read"),
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
