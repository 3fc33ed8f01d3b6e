//! Passes the versions of the program and of the compiler to the program, and compresses the files of the page and of
//! Swagger UI.

#[path = "build/commit.rs"]
mod commit;

use std::ffi::OsStr;
use std::fs::{self, File};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::io::{Cursor, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::Command;

use flate2::Compression;
use flate2::write::GzEncoder;
use zip::ZipArchive;

/// The folder of the page.
const PAGE: &str = "src/page";
/// What opens the document of this service in Swagger UI, in place of its own file of this name.
const OPENING: &str = "build/swagger-initializer.js";
/// The other files that its page loads.
const SWAGGER_UI: [&str; 7] = [
    "favicon-16x16.png",
    "favicon-32x32.png",
    "index.css",
    "index.html",
    "swagger-ui-bundle.js",
    "swagger-ui-standalone-preset.js",
    "swagger-ui.css",
];

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
    let name = |path: &Path| path.file_name().and_then(OsStr::to_str).expect("plain names").to_owned();
    let read = |path: &PathBuf| (name(path), fs::read(path).expect("a file of the page can be read"));
    write_assets(out, "page", paths.iter().map(read).collect());
    write_assets(out, "docs", swagger_ui());
}

/// The files of Swagger UI that its page loads, with what opens this service's document.
fn swagger_ui() -> Vec<(String, Vec<u8>)> {
    let archive = Cursor::new(utoipa_swagger_ui_vendored::SWAGGER_UI_VENDORED);
    let mut archive = ZipArchive::new(archive).expect("Swagger UI is an archive");
    let mut found = vec![("swagger-initializer.js".to_owned(), fs::read(OPENING).expect("the file exists"))];
    for index in 0..archive.len() {
        let mut file = archive.by_index(index).expect("the archive can be read");
        let path = file.name().expect("plain names").into_owned();
        let Some(name) = SWAGGER_UI.iter().find(|name| path.ends_with(&format!("/dist/{name}"))) else { continue };
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).expect("the archive can be read");
        found.push(((*name).to_owned(), bytes));
    }
    assert_eq!(found.len(), SWAGGER_UI.len() + 1, "Swagger UI has all of its files");
    found
}

/// Compresses files, and writes the list of them that the program includes.
fn write_assets(out: &Path, list_name: &str, files: Vec<(String, Vec<u8>)>) {
    let mut list = String::from("[");
    for (name, bytes) in files {
        let packed = out.join(format!("{list_name}-{name}.gz"));
        pack(&packed, &bytes);
        let mut version = DefaultHasher::new();
        bytes.hash(&mut version);
        // Of both encodings, and so weak.
        let tag = format!("W/\"{:016x}\"", version.finish());
        list.push_str(&format!("Asset::new({name:?}, {tag:?}, include_bytes!({packed:?})),\n"));
    }
    list.push(']');
    fs::write(out.join(format!("{list_name}.in")), list).expect("the folder can be written");
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
