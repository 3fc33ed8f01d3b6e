//! The pages of `docs/`: their commands run as printed, and what they list is complete.

use std::process::Command;

use crate::common::process::Process;
use crate::python::{file, succeed};

fn page(name: &str) -> String {
    std::fs::read_to_string(file("docs").join(name)).unwrap()
}

#[tokio::test(flavor = "multi_thread")]
async fn every_command_of_the_pages_runs_as_printed() {
    let server = Process::start("memory:").await;
    for (name, blocks) in [("simulate.md", 2), ("session.md", 5), ("gallery.md", 1), ("errors.md", 1)] {
        let text = page(name);
        let found: Vec<&str> = text.split("```sh\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
        assert_eq!(found.len(), blocks, "{name}");
        let script = found.concat().replace("localhost:8080", server.base.trim_start_matches("http://"));
        let folder = tempfile::tempdir().unwrap();
        let mut run = Command::new("bash");
        run.args(["-euo", "pipefail", "-c", &script]).current_dir(folder.path());
        let said = succeed(&mut run, "bash is there");
        assert!(name == "gallery.md" || said.contains('{'), "{name}: {said}");
    }
    // Nothing that a page makes is left behind but the contact of the gallery, and what was forked to show how.
    assert_eq!(server.client.contacts(None, None).await.unwrap().items.len(), 2);
}

#[test]
fn every_link_between_the_pages_leads_somewhere() {
    for name in ["simulate.md", "session.md", "dashboards.md", "limits.md", "gallery.md", "errors.md"] {
        let text = page(name);
        let targets = text.split("](").skip(1).map(|rest| rest.split(')').next().unwrap());
        for target in targets.filter(|target| !target.starts_with("http")) {
            let (path, place) = target.split_once('#').unwrap_or((target, ""));
            let there = file("docs").join(if path.is_empty() { name } else { path });
            assert!(there.exists(), "{name}: {target}");
            let heading = |line: &str| line.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
            let found = place.is_empty()
                || std::fs::read_to_string(&there)
                    .unwrap()
                    .lines()
                    .any(|line| line.starts_with('#') && heading(line) == place);
            assert!(found, "{name}: {target}");
        }
    }
}
