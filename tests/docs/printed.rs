//! The commands of a page, with what the page says that they print and draw.
//!
//! A block `output` below a block `sh` is what that block prints, and a vector picture that it writes is the one of
//! this name that the page shows. `UPDATE=1` writes both anew.

use std::path::Path;
use std::process::Command;

use crate::common::pictures::other_lines;
use crate::common::process::Process;
use crate::python::{file, succeed};

/// Stands between what two blocks print.
const SEPARATOR: char = '\u{1e}';
/// How far a number that a page prints may be from the one that is printed, relative: searches and libraries round.
const ROUNDING: f64 = 1e-6;
/// How far a line of a picture may be from its reference, pixels: coordinates are rounded to whole ones.
const SHIFT: f64 = 1.0;

/// The blocks of a page in a language, each with the output below it.
pub fn blocks<'a>(text: &'a str, language: &str) -> Vec<(&'a str, Option<&'a str>)> {
    let mut found = Vec::new();
    for rest in text.split(&format!("```{language}\n")).skip(1) {
        let (block, below) = rest.split_once("```\n").unwrap();
        let output = below.trim_start_matches('\n').strip_prefix("```output\n");
        found.push((block, output.map(|rest| rest.split("```").next().unwrap())));
    }
    found
}

/// Bash with these options and commands, for a server at its address, which finds the command `stickslip`.
pub fn bash(options: &str, commands: &str, server: &Process) -> Command {
    let mut bash = Command::new("bash");
    let script = commands.replace("localhost:8080", server.base.trim_start_matches("http://"));
    bash.args([options, "pipefail", "-c", &script]);
    let programs = Path::new(env!("CARGO_BIN_EXE_stickslip")).parent().unwrap();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = [programs.to_owned()].into_iter().chain(std::env::split_paths(&path));
    bash.env("PATH", std::env::join_paths(path).unwrap());
    bash
}

/// Runs the commands of a page in a folder, and compares what they print and draw with the page. Returns all that they
/// have printed.
pub fn run_page(page: &Path, commands: &[(&str, Option<&str>)], options: &str, server: &Process) -> String {
    let folder = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink(file("examples"), folder.path().join("examples")).unwrap();
    let script: String = commands.iter().map(|(block, _)| format!("{block}\nprintf '{SEPARATOR}'\n")).collect();
    let said = succeed(bash(options, &script, server).current_dir(folder.path()), "bash is installed");
    let updates = std::env::var_os("UPDATE").is_some();
    let mut text = std::fs::read_to_string(page).unwrap();
    for ((block, output), printed) in commands.iter().zip(said.split(SEPARATOR)) {
        let Some(output) = output else { continue };
        let printed = format!("{}\n", printed.trim_end());
        if updates {
            text = text.replacen(
                &format!("{block}```\n\n```output\n{output}"),
                &format!("{block}```\n\n```output\n{printed}"),
                1,
            );
        } else {
            assert!(is_alike(output, &printed), "{}: the page shows\n{output}\nfor\n{printed}", page.display());
        }
    }
    if updates {
        std::fs::write(page, &text).unwrap();
    }
    let shown =
        text.split("](").skip(1).filter_map(|rest| rest.split(')').next()).filter(|path| path.ends_with(".svg"));
    for path in shown {
        let name = Path::new(path).file_name().unwrap();
        let drawn = [folder.path().join(path), folder.path().join(name)].into_iter().find(|drawn| drawn.exists());
        let Some(drawn) = drawn.map(|drawn| std::fs::read_to_string(drawn).unwrap()) else { continue };
        let shown = page.with_file_name(path);
        if updates {
            std::fs::write(&shown, &drawn).unwrap();
        }
        let other = other_lines(&drawn, &std::fs::read_to_string(&shown).unwrap(), SHIFT);
        assert!(other.is_none(), "{} is another picture: {}", shown.display(), other.unwrap_or_default());
    }
    said
}

/// Whether two texts differ by the rounding of numbers at most.
fn is_alike(shown: &str, printed: &str) -> bool {
    let (shown, printed) = (parts(shown), parts(printed));
    let pairs = shown.iter().zip(&printed);
    shown.len() == printed.len() && pairs.clone().all(|(a, b)| a == b || numbers_agree(a, b))
}

/// The numbers of a text, and what is between them.
fn parts(text: &str) -> Vec<&str> {
    let is_of_number = |letter: char| letter.is_ascii_digit() || "+-.eE".contains(letter);
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let end = rest.find(|letter| is_of_number(letter) != is_of_number(first)).unwrap_or(rest.len());
        found.push(&rest[..end]);
        rest = &rest[end..];
    }
    found
}

fn numbers_agree(shown: &str, printed: &str) -> bool {
    let [Ok(shown), Ok(printed)] = [shown, printed].map(str::parse::<f64>) else { return false };
    (shown - printed).abs() <= ROUNDING * shown.abs().max(printed.abs())
}

#[test]
fn printed_numbers_may_differ_by_rounding_alone() {
    assert!(is_alike("{\"max\":0.17335201,\"n\":20}\n", "{\"max\":0.17335201000000003,\"n\":20}\n"));
    assert!(is_alike("3e-09 N", "3e-9 N"));
    for other in
        ["{\"max\":0.17336,\"n\":20}\n", "{\"max\":0.17335201,\"n\":21}\n", "{\"least\":0.17335201,\"n\":20}\n", ""]
    {
        assert!(!is_alike("{\"max\":0.17335201,\"n\":20}\n", other), "{other}");
    }
}

#[test]
fn an_output_belongs_to_the_block_above_it() {
    let page = "```sh\na\n```\n\n```output\n1\n```\n\nText\n\n```sh\nb\n```\n\nText\n\n```output\n2\n```\n";
    assert_eq!(blocks(page, "sh"), [("a\n", Some("1\n")), ("b\n", None)]);
}
