//! Passes the versions of the program and of the compiler to the program, and compresses the files of the page.

#[path = "build/commit.rs"]
mod commit;

use std::ffi::OsStr;
use std::fs::{self, File};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use flate2::Compression;
use flate2::write::GzEncoder;

/// The folder of the page.
const PAGE: &str = "src/page";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=build");
    println!("cargo::rerun-if-changed={PAGE}");
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(compiler).arg("--version").output();
    let version = output.ok().and_then(|output| String::from_utf8(output.stdout).ok());
    // "rustc 1.95.0 (…)": the number alone.
    let number = version.as_deref().and_then(|line| line.split_whitespace().nth(1)).unwrap_or("unknown");
    println!("cargo::rustc-env=BUILD_COMPILER={number}");
    pass_version();

    let out = std::env::var_os("OUT_DIR").expect("Cargo names the folder for what is built");
    let out = Path::new(&out);
    let files = fs::read_dir(PAGE).expect("the folder of the page exists");
    let mut paths: Vec<PathBuf> =
        files.map(|entry| entry.expect("the folder of the page can be read").path()).collect();
    paths.sort();
    let mut list = String::from("[");
    for path in paths {
        let plain = path.canonicalize().expect("a file of the page exists");
        let name = plain.file_name().and_then(OsStr::to_str).expect("the files of the page have plain names");
        let packed = out.join(format!("{name}.gz"));
        let bytes = fs::read(&plain).expect("a file of the page can be read");
        pack(&packed, &bytes);
        let mut version = DefaultHasher::new();
        bytes.hash(&mut version);
        // Of both encodings, and so weak.
        let tag = format!("W/\"{:016x}\"", version.finish());
        let (plain, packed) = (format!("include_bytes!({plain:?})"), format!("include_bytes!({packed:?})"));
        list.push_str(&format!("Asset {{ name: {name:?}, tag: {tag:?}, plain: {plain}, packed: {packed} }},\n"));
    }
    list.push(']');
    fs::write(out.join("page.in"), list).expect("the folder can be written");
}

/// Passes the version, with the commit where it is known: from `BUILD_COMMIT`, else from the repository. A debug build
/// asks no repository, so that a commit does not build all tests again.
fn pass_version() {
    println!("cargo::rerun-if-env-changed=BUILD_COMMIT");
    let given = std::env::var("BUILD_COMMIT").ok().filter(|commit| !commit.is_empty() && commit != "unknown");
    let is_release = std::env::var("PROFILE").is_ok_and(|profile| profile == "release");
    let commit = given.or_else(|| {
        let (commit, files) = is_release.then(|| commit::commit_of(Path::new("."))).flatten()?;
        for file in files {
            println!("cargo::rerun-if-changed={}", file.display());
        }
        Some(commit)
    });
    let version = std::env::var("CARGO_PKG_VERSION").expect("Cargo gives the version");
    let whole = commit.as_ref().map_or_else(|| version.clone(), |commit| format!("{version} ({commit})"));
    println!("cargo::rustc-env=BUILD_VERSION={whole}");
    println!("cargo::rustc-env=BUILD_COMMIT={}", commit.as_deref().unwrap_or("unknown"));
}

fn pack(to: &Path, bytes: &[u8]) {
    let mut encoder = GzEncoder::new(File::create(to).expect("the folder can be written"), Compression::best());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).expect("a file of the page can be packed");
}
