//! The commit that a program is built from: part of the build script, and of the test of it.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The commit of a folder that is the root of a git repository, and the files that change with it. None elsewhere, such
/// as in a source archive, even one that lies within another repository.
pub fn commit_of(folder: &Path) -> Option<(String, Vec<PathBuf>)> {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).current_dir(folder).output().ok()?;
        let text = String::from_utf8(output.stdout).ok().filter(|_| output.status.success())?;
        Some(text.trim().to_owned())
    };
    // Empty at the root itself.
    if !git(&["rev-parse", "--show-prefix"])?.is_empty() {
        return None;
    }
    let commit = git(&["rev-parse", "--short=12", "HEAD"])?;
    let branch = git(&["symbolic-ref", "--quiet", "HEAD"]);
    let names = ["HEAD", "logs/HEAD", "packed-refs"].into_iter().map(str::to_owned).chain(branch);
    let files = names.filter_map(|name| git(&["rev-parse", "--git-path", &name])).map(|path| folder.join(path));
    // Cargo would run the script again and again for a file that does not exist.
    Some((commit, files.filter(|file| file.exists()).collect()))
}
