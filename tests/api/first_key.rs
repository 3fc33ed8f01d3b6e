//! `--first-key`: a service that others can reach makes a key for itself, once.

use std::io::{BufRead as _, BufReader};
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::{Command, Stdio};

use reqwest::StatusCode;

use crate::common::binary;
use crate::common::process::{Process, ended};

fn serve(file: &Path, more: &[&str]) -> Command {
    let mut command =
        binary(&["serve", "--store", "memory:", "--listen", "0.0.0.0:0", "--log", "error", "--first-key"]);
    command.arg(file).args(more);
    command
}

/// Starts a service and ends it: its lines on standard output up to the one that names its address, which is called
/// with `key`.
async fn first_lines(file: &Path, more: &[&str]) -> (Process, Vec<String>) {
    let mut child = serve(file, more).stdout(Stdio::piped()).spawn().unwrap();
    let stdout = BufReader::new(child.stdout.take().unwrap());
    let read = move || {
        let mut lines = Vec::new();
        for line in stdout.lines() {
            lines.push(line.unwrap());
            if lines.last().unwrap().contains("listens") {
                break;
            }
        }
        lines
    };
    let lines = tokio::task::spawn_blocking(read).await.unwrap();
    let port = lines.last().unwrap().split("0.0.0.0:").nth(1).unwrap().split(',').next().unwrap();
    (Process::running(child, &format!("http://127.0.0.1:{port}")), lines)
}

async fn status(server: &Process, path: &str, key: Option<&str>) -> StatusCode {
    let call = reqwest::Client::new().get(format!("{}{path}", server.base));
    let call = match key {
        Some(key) => call.bearer_auth(key),
        None => call,
    };
    call.send().await.unwrap().status()
}

#[tokio::test(flavor = "multi_thread")]
async fn the_first_start_makes_a_key_and_prints_it_once() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("keys");
    let (server, lines) = first_lines(&file, &[]).await;
    let key = lines[0].strip_prefix("key ").unwrap().to_owned();
    assert_eq!(lines.len(), 3, "{lines:?}");
    assert!(lines[1].contains(file.to_str().unwrap()) && lines[2].contains("listens on http://0.0.0.0:"), "{lines:?}");
    let entries = std::fs::read_to_string(&file).unwrap();
    assert!(!entries.contains(&key) && entries.starts_with("first:write+metrics::sha256:"), "{entries}");
    assert_eq!(std::fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o600);
    // Others have no access, the key has all.
    assert_eq!(status(&server, "/contacts", None).await, 401);
    for path in ["/contacts", "/metrics"] {
        assert_eq!(status(&server, path, Some(&key)).await, 200, "{path}");
    }
    server.stop().await;

    // The second start prints nothing of it, and knows it.
    let (server, lines) = first_lines(&file, &[]).await;
    assert!(lines.len() == 1 && !lines[0].contains(&key), "{lines:?}");
    assert_eq!(status(&server, "/contacts", Some(&key)).await, 200);
    assert_eq!(std::fs::read_to_string(&file).unwrap(), entries);
    server.stop().await;
}

#[tokio::test(flavor = "multi_thread")]
async fn no_key_is_made_where_there_are_keys_or_none_are_wanted() {
    let folder = tempfile::tempdir().unwrap();
    let (file, own) = (folder.path().join("first"), folder.path().join("own"));
    let entry = stickslip::access::new_key("own", &[stickslip::access::Role::Read], "", None).unwrap();
    std::fs::write(&own, &entry.entry).unwrap();
    for (more, expected) in [(["--keys", own.to_str().unwrap()], 401), (["--insecure=true", "--deadline=20s"], 200)] {
        let (server, lines) = first_lines(&file, &more).await;
        assert_eq!((lines.len(), status(&server, "/contacts", None).await.as_u16()), (1, expected), "{lines:?}");
        assert!(!file.exists());
        server.stop().await;
    }
    // Without it the service does not start on such an address, nor with a file that cannot be made.
    let bare = ended(&mut binary(&["serve", "--store", "memory:", "--listen", "0.0.0.0:0"]));
    assert!(!bare.status.success() && String::from_utf8_lossy(&bare.stderr).contains("--first-key"));
    let nowhere = ended(&mut serve(Path::new("/no/such/folder/keys"), &[]));
    let said = String::from_utf8_lossy(&nowhere.stderr);
    assert!(!nowhere.status.success() && said.contains("--first-key /no/such/folder/keys"), "{said}");
}
