//! `stickslip-report speed`: its columns, and errors of the expected order. No assertion depends on a time.

use std::os::unix::fs::PermissionsExt as _;
use std::process::{Command, Output};

const SCENES: &str = "first_loading,reversals_20,oblique,cone,power_4,exact_sphere";

fn speed(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_stickslip-report")).arg("speed").args(arguments).output().unwrap()
}

/// The rows of the table of a report: scene, solver and springs, then numbers.
fn rows(page: &str) -> Vec<Vec<String>> {
    let head = "| scene | solver | springs | × exact | force error | stress error | at kinks | median, s |\n";
    let (_, table) = page.split_once(head).unwrap();
    let rows = table.lines().skip(1).take_while(|line| line.starts_with('|'));
    rows.map(|row| row.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()).collect()
}

#[test]
fn the_report_finds_the_known_orders_of_error() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let output = speed(&["--out", out, "--scenes", SCENES, "--largest", "1000"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let page = read("report.md");
    let rows = rows(&page);
    // Exact and reference, and three kernels with 10, 100 and 1000 springs.
    assert_eq!(rows.len(), SCENES.split(',').count() * 11);
    assert!(page.contains(" build. It took ") && !page.contains("Not measured"), "{page:.500}");
    for kind in ["stress", "force"] {
        let chart = read(&format!("{kind}.svg"));
        for named in ["reversals_20", "exact", "springs_arcosh", "springs_level", "recipe", "time, s"] {
            assert!(chart.contains(named), "{kind} {named}");
        }
        // Three springs on each of three lines, the exact solver, and its legend; the reference has no error.
        assert_eq!(chart.matches("<circle").count(), 11, "{kind}");
    }
    for row in &rows {
        let ratios = row[3].replace("**", "").replace(" (", " to ").replace(')', "");
        let ratios: Vec<f64> = ratios.split(" to ").map(|ratio| ratio.parse().unwrap()).collect();
        let [ratio, lower, upper] = ratios[..] else { panic!("{row:?}") };
        assert!(0.0 < lower && lower <= ratio && ratio <= upper && row[7].parse::<f64>().unwrap() > 0.0, "{row:?}");
    }

    let [force, stress, kinks] = [4, 5, 6];
    let error = |scene: &str, solver: &str, springs: &str, column: usize| -> f64 {
        let same = |row: &&Vec<String>| row[..3] == [scene, solver, springs];
        rows.iter().find(same).unwrap_or_else(|| panic!("{scene} {solver} {springs}"))[column].parse().unwrap()
    };
    for scene in SCENES.split(',') {
        assert!(error(scene, "exact", "", force) < 1e-13, "{scene}");
        assert!(error(scene, "exact", "", stress) < 1e-11, "{scene}");
        // At a kink the stress has a cusp: a radius that is rounded once moves it by the root of that.
        assert!(error(scene, "exact", "", kinks) < 1e-6, "{scene}");
        for kernel in ["springs_arcosh", "springs_level", "recipe"] {
            // Of second order: a hundred times fewer springs cost ten thousand times the error, or nearly.
            let [coarse, fine] = ["10", "1000"].map(|springs| error(scene, kernel, springs, force));
            assert!(fine < coarse / 1000.0, "{scene} {kernel}: {coarse:e} to {fine:e}");
            let [coarse, fine] = ["10", "1000"].map(|springs| error(scene, kernel, springs, stress));
            assert!(fine < coarse, "{scene} {kernel}: {coarse:e} to {fine:e}");
        }
    }
    // With a single kink, differences lose what straight lines between the springs keep.
    let by = |kernel| error("first_loading", kernel, "1000", stress);
    assert!(by("recipe") > 3.0 * by("springs_arcosh"));
    assert!(error("first_loading", "exact", "", kinks) < 1e-13);
}

#[test]
fn solvers_by_others_are_measured_or_listed_with_their_reason() {
    let folder = tempfile::tempdir().unwrap();
    let python = folder.path().join("python");
    // Knows its version, answers a scene of ten springs, and refuses others.
    let script = r#"#!/bin/sh
[ "$1" = --version ] && echo "Python 0" && exit
case "$(cat)" in
    *'"count":10,'*) printf '{"seconds": 1, "forces": [0, 0], "shears": [%s0]}' "$(printf '0, %.0s' $(seq 1001))" ;;
    *) echo first >&2; echo "the last word" >&2; exit 1 ;;
esac
"#;
    std::fs::write(&python, script).unwrap();
    std::fs::set_permissions(&python, std::fs::Permissions::from_mode(0o755)).unwrap();
    let [out, python] = [folder.path(), &python].map(|path| path.to_str().unwrap());
    let output = speed(&["--out", out, "--scenes", "reversal", "--largest", "100", "--external", python]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let page = std::fs::read_to_string(folder.path().join("report.md")).unwrap();
    assert!(page.contains("External solvers run on Python 0."), "{page:.500}");
    let rows = rows(&page);
    let numpy: Vec<_> = rows.iter().filter(|row| row[1] == "numpy").collect();
    assert!(numpy.len() == 1 && numpy[0][2] == "10" && numpy[0][7] == "1.00e0", "{numpy:?}");
    // A force that stays zero is off by the largest of the path.
    assert!((0.1..1.0).contains(&numpy[0][4].parse::<f64>().unwrap()), "{numpy:?}");
    assert!(page.ends_with(
        "## Not measured\n\n| scene | solver | why |\n|---|---|---|\n| reversal | numpy | the last word |\n\
         | reversal | aspher | the last word |\n"
    ));
}

#[test]
fn a_python_that_does_not_exist_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let arguments = ["--out", out, "--scenes", "reversal", "--largest", "10", "--external", "/no/such/python"];
    let output = speed(&arguments);
    assert!(!output.status.success());
    assert!(String::from_utf8_lossy(&output.stderr).contains("/no/such/python does not run"));
}

#[test]
fn an_unknown_scene_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let output = speed(&["--out", folder.path().to_str().unwrap(), "--scenes", "third_loading"]);
    assert!(!output.status.success());
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(message.contains("third_loading") && message.contains("first_loading"), "{message}");
}
