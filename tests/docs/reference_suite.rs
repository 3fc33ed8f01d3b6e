//! The reference problems of `reference/`, by the command line.

use crate::python::{file, program, succeed};

#[test]
fn every_problem_is_solved_below_1e_10_by_the_command_line() {
    let mut run = program("python");
    run.arg(file("python/stickslip/reference.py")).args(["run", "--below", "1e-10", "--problems"]);
    run.arg(file("reference")).args(["--code", &format!("cli={}", env!("CARGO_BIN_EXE_stickslip"))]);
    let printed = succeed(&mut run, "python is there");
    let problems = std::fs::read_dir(file("reference")).unwrap().filter(|entry| {
        let path = entry.as_ref().unwrap().path();
        path.extension().is_some_and(|ending| ending == "json")
    });
    let rows = printed.lines().filter(|line| line.starts_with("| ") && line.contains(" ms |")).count();
    assert!(rows >= 15 && rows == problems.count(), "{printed}");
}
