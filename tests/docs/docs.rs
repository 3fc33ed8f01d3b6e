//! The pages of `docs/`: their commands run as printed, and what they list is complete.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use stickslip::access::Role;
use stickslip::api::{need, route_of};
use stickslip_wire::Code;

use crate::common::openapi::{document, operations};
use crate::common::process::Process;
use crate::printed::{bash, blocks, run_page};
use crate::python::{file, succeed};

pub fn page(name: &str) -> String {
    std::fs::read_to_string(file("docs").join(name)).unwrap()
}

/// The names and texts of all pages.
pub fn pages() -> impl Iterator<Item = (String, String)> {
    let names = std::fs::read_dir(file("docs")).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.filter(|name| name.ends_with(".md")).map(|name| (name.clone(), page(&name)))
}

/// What a link to a heading ends with.
pub fn anchor(heading: &str) -> String {
    let is_kept = |letter: &char| letter.is_alphanumeric() || ['-', '_'].contains(letter);
    heading.trim_start_matches('#').trim().to_lowercase().replace(' ', "-").chars().filter(is_kept).collect()
}

#[tokio::test(flavor = "multi_thread")]
async fn every_command_of_the_pages_runs_as_printed() {
    let server = Process::start("memory:").await;
    for (name, count) in [
        ("simulate.md", 4),
        ("plane.md", 2),
        ("cycles.md", 4),
        ("residual-stress.md", 2),
        ("sliders.md", 1),
        ("conductance.md", 1),
        ("graded-bodies.md", 1),
        ("fretting.md", 2),
        ("line-contacts.md", 2),
        ("shear-strength.md", 1),
        ("viscoelastic.md", 1),
        ("adhesion.md", 1),
        ("twist.md", 1),
        ("rough-contacts.md", 1),
        ("measured-surfaces.md", 2),
        ("measured-loops.md", 1),
        ("contacts.md", 7),
        ("sweeps.md", 3),
        ("gallery.md", 1),
        ("errors.md", 1),
    ] {
        let text = page(name);
        let found = blocks(&text, "sh");
        assert_eq!(found.len(), count, "{name}");
        // `head` may leave before curl has written all, which then fails: `sed -n` reads to the end.
        assert!(found.iter().all(|(block, _)| !block.contains("| head")), "{name}: a reader that stops early");
        let said = run_page(&file("docs").join(name), &found, "-euo", &server);
        assert!(name == "gallery.md" || said.contains('{'), "{name}: {said}");
    }
    // The pages leave nothing behind but the contact of the gallery and two forks.
    assert_eq!(server.client.contacts(None, None).await.unwrap().items.len(), 3);
}

/// The second block of the page of access, in a folder with the file of keys of a running server.
#[tokio::test(flavor = "multi_thread")]
async fn a_key_is_added_to_a_running_server_as_the_page_says() {
    let text = page("access.md");
    let (block, _) = blocks(&text, "sh")[1];
    let folder = tempfile::tempdir().unwrap();
    let first = stickslip::access::new_key("bench", &[stickslip::access::Role::Read], "lab", None).unwrap();
    let keys = folder.path().join("keys");
    std::fs::write(&keys, format!("{}\n", first.entry)).unwrap();
    let server = Process::with("memory:", &["--keys", keys.to_str().unwrap()]);
    let mut run = bash("-euo", block, &server);
    let said = succeed(run.current_dir(folder.path()), "bash is there");
    assert!(said.contains("{\"items\":[]"), "{said}");
    // The key before still counts.
    let http = reqwest::Client::new();
    let reply = http.get(format!("{}/contacts", server.base)).bearer_auth(&first.key).send().await.unwrap();
    assert_eq!(reply.status(), 200);
    assert_eq!(std::fs::read_to_string(keys).unwrap().lines().count(), 2);
}

#[test]
fn every_link_between_the_pages_leads_somewhere() {
    for (name, text) in pages() {
        let targets = text.split("](").skip(1).map(|rest| rest.split(')').next().unwrap());
        for target in targets.filter(|target| !target.starts_with("http")) {
            let (path, place) = target.split_once('#').unwrap_or((target, ""));
            let there = file("docs").join(if path.is_empty() { &*name } else { path });
            assert!(there.exists(), "{name}: {target}");
            let found = place.is_empty()
                || std::fs::read_to_string(&there)
                    .unwrap()
                    .lines()
                    .any(|line| line.starts_with('#') && anchor(line) == place);
            assert!(found, "{name}: {target}");
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn the_calls_of_the_readme_run_as_printed() {
    let server = Process::start("memory:").await;
    let text = std::fs::read_to_string(file("README.md")).unwrap();
    let calls = blocks(&text, "sh");
    assert_eq!(calls.len(), 3);
    assert!(calls.iter().all(|(_, output)| output.is_some()), "each call shows its reply");
    run_page(&file("README.md"), &calls, "-euo", &server);
    assert!(server.client.contacts(None, None).await.unwrap().items.is_empty());
}

/// The pages by question of the README, which begin with a result.
const BY_QUESTION: [&str; 10] = [
    "contacts.md",
    "cycles.md",
    "fretting.md",
    "line-contacts.md",
    "measured-loops.md",
    "measured-surfaces.md",
    "plane.md",
    "residual-stress.md",
    "rough-contacts.md",
    "sweeps.md",
];

#[test]
fn a_page_by_question_asks_shows_a_result_and_says_how_to_read_it_and_when_not_to_trust_it() {
    for name in BY_QUESTION {
        let text = page(name);
        let (top, rest) = text.split_once("\n## ").unwrap();
        let question = top.split("\n\n").nth(1).unwrap();
        assert!(question.contains('?'), "{name} begins with its question: {question}");
        let at = |what: &str| top.find(what).unwrap_or_else(|| panic!("{name}: no {what} before the first heading"));
        let order = ["```python\n", "```sh\n", "!["].map(at);
        assert!(order.is_sorted(), "{name}: Python, curl, picture");
        for language in ["python", "sh"] {
            let shown = blocks(top, language);
            assert!(shown.iter().any(|(_, output)| output.is_some()), "{name}: a result below {language}");
        }
        let headings: Vec<&str> = rest.split("\n## ").filter_map(|section| section.lines().next()).collect();
        assert_eq!(headings[0], "How to read it", "{name}");
        assert!(headings.contains(&"When not to trust it"), "{name}: {headings:?}");
    }
}

#[test]
fn the_readme_is_one_screen() {
    let words = std::fs::read_to_string(file("README.md")).unwrap().split_whitespace().count();
    assert!(words <= 700, "{words} words");
}

#[test]
fn every_test_that_verification_names_exists() {
    let text = page("verification.md");
    let mut named = 0;
    for row in text.lines().filter(|line| line.starts_with('|')) {
        for (path, name) in row.split('`').filter_map(|cell| cell.split_once("::")) {
            let (path, name) = (path.trim(), name.trim());
            let source = std::fs::read_to_string(file(path)).unwrap_or_else(|error| panic!("{path}: {error}"));
            let keyword = if path.ends_with(".py") { "def" } else { "fn" };
            assert!(source.contains(&format!("{keyword} {name}(")), "{path} has no test {name}");
            named += 1;
        }
    }
    assert!(named > 250, "{named} tests are named");
}

/// Recipes name a file by its path, or by the end of it.
#[test]
fn every_source_file_that_the_architecture_names_exists() {
    let sources: Vec<PathBuf> =
        ["crates", "src", "tests"].iter().flat_map(|folder| rust_files(&file(folder))).collect();
    let text = std::fs::read_to_string(file("ARCHITECTURE.md")).unwrap();
    let codes = text.split('`').filter_map(|code| code.split("::").next());
    let named: BTreeSet<&str> = codes.filter(|code| code.ends_with(".rs") && !code.contains("NAME")).collect();
    assert!(named.len() > 100, "{} files are named", named.len());
    for path in named {
        assert!(sources.iter().any(|source| source.ends_with(path)), "ARCHITECTURE.md names {path}");
    }
}

/// A filter that matches nothing runs no test, and Cargo calls that a success.
#[test]
fn every_filter_of_a_test_command_finds_a_test() {
    let readme = std::fs::read_to_string(file("README.md")).unwrap();
    let texts = pages().chain([("README.md".to_owned(), readme)]);
    let mut seen = 0;
    for (name, text) in texts {
        for command in text.split(['`', '\n']).filter(|line| line.contains("cargo test")) {
            let words: Vec<&str> = command.split_whitespace().skip_while(|word| *word != "test").skip(1).collect();
            let after = |flag: &str| words.iter().position(|word| *word == flag).map(|index| words[index + 1]);
            let folder = match after("-p") {
                Some(member) => file("crates").join(member.trim_start_matches("stickslip-")),
                None => file("."),
            };
            let Some(target) = after("--test") else { continue };
            assert_eq!(name, "verification.md", "commands of tests stand there: {command}");
            let tests = [folder.join("tests").join(target), folder.join(format!("tests/{target}.rs"))];
            let tests = tests.into_iter().find(|path| path.exists()).unwrap_or_else(|| panic!("{name}: {command}"));
            let sources: String = rust_files(&tests).map(|path| std::fs::read_to_string(path).unwrap()).collect();
            let values = ["-p", "--test"].map(after);
            let filters = words.iter().filter(|word| !word.starts_with('-') && !values.contains(&Some(word)));
            for part in filters.flat_map(|filter| filter.split("::")).filter(|part| !part.is_empty()) {
                let names = sources.lines().filter_map(|line| {
                    let line = line.trim_start();
                    ["fn ", "async fn ", "mod ", "pub mod "].iter().find_map(|keyword| line.strip_prefix(keyword))
                });
                let found =
                    names.map(|rest| rest.split(['(', ';', ' ', '<']).next().unwrap()).any(|own| own.contains(part));
                assert!(
                    found,
                    "{name}: `{command}` runs no test: `{part}` is no part of a name in {}",
                    tests.display()
                );
                seen += 1;
            }
        }
    }
    assert!(seen > 3, "{seen} filters");
}

fn rust_files(path: &Path) -> Box<dyn Iterator<Item = PathBuf>> {
    if path.is_file() {
        return Box::new(std::iter::once(path.to_owned()));
    }
    let entries = std::fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path());
    let of_interest = |path: &PathBuf| path.is_dir() || path.extension().is_some_and(|end| end == "rs");
    Box::new(entries.filter(of_interest).flat_map(|path| rust_files(&path)))
}

#[test]
fn the_crates_depend_on_no_more_than_the_readme_says() {
    let tree = |package: &str| -> BTreeSet<String> {
        let arguments =
            ["tree", "--offline", "--locked", "--edges", "normal", "--prefix", "none", "--package", package];
        let mut cargo = Command::new(env!("CARGO"));
        let printed = succeed(cargo.args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")), "cargo is there");
        printed.lines().filter_map(|line| line.split(' ').next()).map(str::to_owned).collect()
    };
    let manifest = std::fs::read_to_string(file("crates/mechanics/Cargo.toml")).unwrap();
    let direct = manifest.split("[dependencies]\n").nth(1).unwrap().split("\n[").next().unwrap();
    assert!(direct.lines().filter(|line| !line.is_empty()).count() <= 2, "{direct}");
    let compute = tree("stickslip-compute");
    for absent in ["axum", "hyper", "prometheus", "reqwest", "rusqlite", "tokio", "tokio-postgres", "tracing"] {
        assert!(!compute.contains(absent), "stickslip-compute depends on {absent}");
    }
    let service = tree("stickslip-service");
    for absent in ["axum", "clap", "tower-http", "utoipa-axum"] {
        assert!(!service.contains(absent), "stickslip-service depends on {absent}");
    }
    let wire = tree("stickslip-wire");
    for absent in ["axum", "rusqlite", "tokio-postgres", "deadpool-postgres"] {
        assert!(!wire.contains(absent), "stickslip-wire depends on {absent}");
    }
}

/// The floors of the service, and those below that each may use, beside the ground.
const FLOORS: [(&str, &[&str]); 8] = [
    ("cli", &["api", "server", "access", "jobs", "sessions", "admission", "store"]),
    ("api", &["server", "access", "jobs", "sessions", "admission", "store"]),
    ("server", &["admission"]),
    ("access", &[]),
    ("jobs", &["admission", "store"]),
    ("sessions", &["admission", "store"]),
    ("admission", &[]),
    ("store", &[]),
];
const GROUND: [&str; 4] = ["metrics", "otlp", "tenant", "unverified_tls"];

#[test]
fn a_floor_uses_those_below_it_alone() {
    let roots = [file("src"), file("crates/service/src")];
    let mut pending = roots.to_vec();
    while let Some(path) = pending.pop() {
        if path.is_dir() {
            pending.extend(std::fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path()));
            continue;
        }
        let relative = roots.iter().find_map(|root| path.strip_prefix(root).ok()).unwrap().with_extension("");
        let floor = relative.iter().next().unwrap().to_str().unwrap().to_owned();
        if path.extension().is_none_or(|extension| extension != "rs") || ["lib", "main"].contains(&&*floor) {
            continue;
        }
        let below = FLOORS.iter().find(|(name, _)| *name == floor).map_or(&[][..], |(_, below)| below);
        for used in std::fs::read_to_string(&path).unwrap().split("crate::").skip(1) {
            let used: String = used.chars().take_while(|letter| letter.is_alphanumeric() || *letter == '_').collect();
            let known = used == floor || below.contains(&&*used) || GROUND.contains(&&*used);
            assert!(known, "{} uses {used}", path.display());
        }
    }
}

#[test]
fn the_page_of_access_lists_every_route_with_what_it_needs() {
    let document = document();
    let mut routes: Vec<_> = operations(&document).map(|(method, path, _)| (path.to_owned(), method)).collect();
    routes.sort();
    let rows: Vec<String> = [Some(Role::Read), Some(Role::Write), Some(Role::Metrics), None]
        .map(|role| {
            let needs = role.map_or("no key".to_owned(), |role| format!("`{}`", role.name()));
            let its = routes.iter().filter(|(path, method)| need(&method.parse().unwrap(), route_of(path)) == role);
            let its: Vec<_> = its.map(|(path, method)| format!("`{method} {path}`")).collect();
            format!("| {needs} | {} |", its.join(", "))
        })
        .into();
    let page = page("access.md");
    let (_, table) = page.split_once("| needs | routes |\n|---|---|\n").unwrap();
    let listed: Vec<&str> = table.lines().take_while(|line| line.starts_with('|')).collect();
    assert_eq!(listed, rows);
}

/// The page is printed anew by `UPDATE=1 cargo test --test docs errors`.
#[test]
fn the_page_of_errors_is_printed_from_the_table() {
    let path = file("docs").join("errors.md");
    let page = page("errors.md");
    let (before, rest) = page.split_once("|---|---|---|\n").unwrap();
    let (_, after) = rest.split_once("\n\n").unwrap();
    let row = |code: &Code| format!("| {} | `{}` | {} |\n", code.status(), code.as_str(), code.advice());
    let rows: String = Code::ALL.iter().map(row).collect();
    let printed = format!("{before}|---|---|---|\n{rows}\n{after}");
    if std::env::var_os("UPDATE").is_some() {
        return std::fs::write(path, &printed).unwrap();
    }
    assert_eq!(page, printed, "run this test with UPDATE=1");
}

#[test]
fn a_code_names_one_kind() {
    for code in Code::ALL {
        assert_eq!(Code::parse(code.as_str()), Some(*code));
    }
    assert_eq!(Code::parse("teapot"), None);
}

#[test]
fn the_description_of_a_warning_lists_the_codes_of_the_page() {
    let specification = document();
    let described = &specification["components"]["schemas"]["Warning"]["properties"]["code"]["description"];
    let listed: BTreeSet<&str> = described.as_str().unwrap().split('`').skip(1).step_by(2).collect();
    let text = page("warnings.md");
    let explained: BTreeSet<&str> = text.lines().filter_map(|line| line.strip_prefix("## ")).collect();
    assert_eq!(listed, explained);
}
