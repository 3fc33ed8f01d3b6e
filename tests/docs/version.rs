//! `stickslip --version`, and the commit that a release shows there.

#[path = "../../build/commit.rs"]
mod commit;

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common;
use crate::python::{file, succeed};

fn git(folder: &Path, arguments: &[&str]) -> String {
    let mut git = Command::new("git");
    git.args(["-c", "user.name=test", "-c", "user.email=test@localhost"]).args(arguments).current_dir(folder);
    succeed(&mut git, "git is there").trim().to_owned()
}

#[test]
fn the_version_is_that_of_the_package() {
    let output = common::run(&["--version"]);
    let line = String::from_utf8(output.stdout).unwrap();
    let version = line.strip_prefix("stickslip ").unwrap().trim_end();
    // A debug build has no commit but one that is given.
    assert_eq!(version.split(" (").next(), Some(env!("CARGO_PKG_VERSION")), "{line}");
    assert_eq!(version.contains('('), option_env!("BUILD_COMMIT") != Some("unknown"), "{line}");
}

/// Cargo, the Python package (whose version maturin takes from its Cargo.toml), the OpenAPI document and the citation.
#[test]
fn one_version_counts_for_everything() {
    let version = env!("CARGO_PKG_VERSION");
    let read = |path: &str| std::fs::read_to_string(file(path)).unwrap();
    let crates = std::fs::read_dir(file("crates")).unwrap().map(|folder| folder.unwrap().path().join("Cargo.toml"));
    for manifest in crates.chain([file("Cargo.toml"), file("python/Cargo.toml")]) {
        let text = std::fs::read_to_string(&manifest).unwrap();
        let package = text.split("[package]").nth(1).unwrap().split("\n[").next().unwrap();
        assert!(package.contains("\nversion.workspace = true\n"), "{}", manifest.display());
    }
    let project: toml::Table = read("python/pyproject.toml").parse().unwrap();
    assert!(project["project"].get("version").is_none());
    assert_eq!(project["project"]["dynamic"].as_array().unwrap()[0].as_str(), Some("version"));
    let document: serde_json::Value = serde_json::from_str(&read("openapi/openapi.json")).unwrap();
    assert_eq!(document["info"]["version"], version);
    assert!(read("CITATION.cff").lines().any(|line| line == format!("version: {version}")));
    assert!(read("CHANGELOG.md").contains(&format!("\n## [{version}] - ")));
}

/// What others publish is named by its hash, and the checks run in the image that builds a release.
#[test]
fn actions_and_images_are_pinned_by_hash() {
    let is_hash = |text: &str, length| text.len() == length && text.chars().all(|letter| letter.is_ascii_hexdigit());
    let dockerfile = std::fs::read_to_string(file("Dockerfile")).unwrap();
    let builder = dockerfile.lines().find_map(|line| line.strip_prefix("FROM ")?.split(' ').next()).unwrap();
    let mut found = 0;
    let workflows = std::fs::read_dir(file(".github/workflows")).unwrap().map(|entry| entry.unwrap().path());
    for path in workflows.chain([file("deploy/compose.yaml")]) {
        for line in std::fs::read_to_string(&path).unwrap().lines() {
            let line = line.trim_start_matches([' ', '-']);
            if let Some(action) = line.strip_prefix("uses: ") {
                let hash = action.split(' ').next().unwrap().split('@').nth(1).unwrap();
                assert!(is_hash(hash, 40), "{}: {line}", path.display());
                found += 1;
            }
            if let Some(image) = line.strip_prefix("image: ") {
                let digest = image.split("@sha256:").nth(1).unwrap_or_default();
                assert!(is_hash(digest, 64), "{}: {line}", path.display());
                assert!(!image.starts_with("rust:") || image == builder, "{}: {line}", path.display());
                found += 1;
            }
        }
    }
    assert!(found > 30, "{found}");
}

#[test]
fn the_commit_is_that_of_the_repository_and_of_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    assert_eq!(commit::commit_of(root), None, "a source archive");
    git(root, &["init", "--quiet"]);
    assert_eq!(commit::commit_of(root), None, "nothing is committed");
    git(root, &["commit", "--quiet", "--allow-empty", "--message", "one"]);
    let (first, files) = commit::commit_of(root).unwrap();
    assert_eq!(first, git(root, &["rev-parse", "--short=12", "HEAD"]));
    let inner = root.join("archive");
    std::fs::create_dir(&inner).unwrap();
    assert_eq!(commit::commit_of(&inner), None, "a source archive within another repository");

    // Whatever moves the commit changes one of the files, so that the build script runs again, and no other run is
    // needed.
    let read = |files: &[PathBuf]| files.iter().map(|file| std::fs::read(file).unwrap()).collect::<Vec<_>>();
    let before = read(&files);
    assert_eq!(read(&files), before);
    git(root, &["pack-refs", "--all"]);
    let (_, files) = commit::commit_of(root).unwrap();
    let packed = read(&files);
    git(root, &["commit", "--quiet", "--allow-empty", "--message", "two"]);
    assert_ne!(commit::commit_of(root).unwrap().0, first);
    assert_ne!(read(&files), packed);
    // A worktree has its HEAD elsewhere.
    let worktree = root.join("worktree");
    git(root, &["worktree", "add", "--quiet", "--detach", worktree.to_str().unwrap(), &first]);
    let (commit, files) = commit::commit_of(&worktree).unwrap();
    assert!(commit == first && !files.is_empty() && files.iter().all(|file| file.exists()), "{files:?}");
}
