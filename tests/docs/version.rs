//! `stickslip --version`, and the commit that a release shows there.

#[path = "../../build/commit.rs"]
mod commit;

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common;
use crate::python::succeed;

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
