//! Progress of long commands: drawn on a terminal alone, and nothing of it on standard output.

use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::json;

use crate::common;
use crate::common::process::Process;
use crate::python::succeed;

/// What a command writes to its terminal, and what to standard output, which is a file.
fn on_a_terminal(folder: &Path, arguments: &[&str]) -> (String, Vec<u8>) {
    let out = folder.join("out");
    let words = arguments.iter().map(|word| format!("'{word}'")).collect::<Vec<_>>().join(" ");
    let line = format!("'{}' {words} > '{}'", env!("CARGO_BIN_EXE_stickslip"), out.display());
    let mut script = common::clean(Command::new("script"));
    script.args(["--quiet", "--return", "--command", &line, "/dev/null"]).env("TERM", "xterm").stdin(Stdio::null());
    (succeed(&mut script, "script is there, of util-linux"), std::fs::read(out).unwrap())
}

#[tokio::test(flavor = "multi_thread")]
async fn long_commands_show_their_progress_on_a_terminal_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let store = format!("sqlite:{}", path("contacts.db"));
    let server = Process::start(&store).await;
    let made = server.client.create(&common::create(), &Default::default()).await.unwrap();
    let moves = json!({"path": {"displacement": (0..50).map(|step| f64::from(step % 5) * 1e-8).collect::<Vec<_>>()}});
    let url = format!("{}/contacts/{}/path", server.base, made.id);
    reqwest::Client::new().post(url).json(&moves).send().await.unwrap().error_for_status().unwrap();
    server.stop().await;
    let sweep = json!({"base": {"contact": common::ball(), "path": {"displacement": [1e-8]}},
        "axes": [{"pointer": "/contact/friction", "linear": {"from": 0.1, "to": 0.5, "count": 300}}],
        "outputs": ["/steps/0/force"]});
    std::fs::write(path("sweep.json"), sweep.to_string()).unwrap();
    let (file, copies) = (path("sweep.json"), [path("a.db"), path("b.db")]);
    for (arguments, shown) in [
        (["sweep", &file, "--threads", "1", "--format", "csv"].as_slice(), "300 points"),
        (&["check", "--store", &store], "50 moves"),
        (&["backup", &copies[0], "--store", &store], "left"),
    ] {
        let (terminal, printed) = on_a_terminal(folder.path(), arguments);
        assert!(terminal.contains(shown) && terminal.contains('['), "{arguments:?}: {terminal:?}");
        // What is made is not made twice.
        let again: Vec<&str> =
            arguments.iter().map(|word| if *word == copies[0] { &copies[1][..] } else { *word }).collect();
        let quiet = common::run(&again);
        assert!(quiet.status.success() && quiet.stderr.is_empty(), "{}", String::from_utf8_lossy(&quiet.stderr));
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).replace("b.db", "a.db");
        assert_eq!(text(&quiet.stdout), text(&printed), "{arguments:?}");
    }
}
