//! The library as it is installed: what it exports, and programs that link it.

mod support;

use std::path::Path;
use std::process::Command;

use support::libraries;

/// The output of a command that must succeed.
fn output(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let (said, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{command:?}: {}\n{said}\n{errors}", output.status);
    said.into_owned()
}

fn has(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success())
}

#[test]
fn the_library_exports_its_own_names_alone() {
    let names = output(
        Command::new("nm")
            .args(["-D", "--defined-only", "--format=posix"])
            .arg(libraries().join("libstickslip_ffi.so")),
    );
    let names: Vec<&str> = names.lines().filter_map(|line| line.split(' ').next()).collect();
    assert_eq!(names.len(), include_str!("../src/exports.rs").matches("#[unsafe(no_mangle)]").count(), "{names:?}");
    assert!(names.iter().all(|name| name.starts_with("ss_")), "{names:?}");
    let dynamic = output(Command::new("readelf").arg("-d").arg(libraries().join("libstickslip_ffi.so")));
    assert!(dynamic.contains("[libstickslip.so.0]"), "{dynamic}");
}

#[test]
fn the_examples_are_built_by_make_and_run() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/c");
    let build = Path::new(env!("CARGO_TARGET_TMPDIR")).join("examples-c");
    let fortran = if has("gfortran") { "gfortran" } else { "" };
    let settings = [
        format!("BUILD={}", build.display()),
        format!("LIBRARY={}", libraries().join("libstickslip_ffi.so").display()),
        format!("FC={fortran}"),
    ];
    let _ = std::fs::remove_dir_all(&build);
    let said = output(Command::new("make").arg("-C").arg(&examples).args(&settings).arg("check"));
    for program in ["ball: ok", "lammps: ok", "many: ok"] {
        assert!(said.contains(program), "{program} is missing in\n{said}");
    }
    assert!(fortran.is_empty() || said.contains("fortran: ok"), "{said}");
    // Valgrind finds what is lost or read before it is written. The threads of OpenMP stay until the end.
    let programs = ["ball", "lammps", "many", "fortran"];
    for program in programs.iter().filter(|program| has("valgrind") && build.join(program).exists()) {
        let mut valgrind = Command::new("valgrind");
        valgrind.args(["--quiet", "--error-exitcode=9", "--leak-check=full", "--errors-for-leak-kinds=definite"]);
        output(valgrind.arg(build.join(program)).env("LD_LIBRARY_PATH", &build).env("OMP_NUM_THREADS", "2"));
    }
}

#[test]
fn a_release_has_the_libraries_and_programs_link_them() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("release");
    let _ = std::fs::remove_dir_all(&folder);
    output(Command::new(root.join(".ci/libraries")).arg(libraries()).arg(&folder));
    assert!(folder.join("libstickslip_fmu.so").exists());
    let [include, lib] = ["include", "lib"].map(|name| folder.join(name));
    // Static, without a shared library to find; and dynamic, by the name that is installed.
    let archive = lib.join("libstickslip.a");
    let ways: [(&str, Vec<String>); 2] = [
        ("static", vec![archive.display().to_string()]),
        (
            "dynamic",
            vec![format!("-L{}", lib.display()), "-lstickslip".into(), format!("-Wl,-rpath,{}", lib.display())],
        ),
    ];
    for (name, link) in ways {
        let program = folder.join(name);
        let mut cc = Command::new("cc");
        cc.arg("-I").arg(&include).arg(root.join("examples/c/ball.c")).args(link);
        output(cc.args(["-lm", "-lpthread", "-ldl", "-o"]).arg(&program));
        assert!(output(&mut Command::new(&program)).contains("ball: ok"), "{name}");
    }
}
