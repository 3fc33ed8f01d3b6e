//! `stickslip-report speed`: its columns, and errors of the expected order. No assertion depends on a time.

use std::process::{Command, Output};

use serde_json::{Value, json};

const SCENES: &str = "first_loading,reversals_20,oblique,cone,power_4,exact_sphere";

fn speed(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_stickslip-report")).arg("speed").args(arguments).output().unwrap()
}

#[test]
fn the_report_finds_the_known_orders_of_error() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let output = speed(&["--out", out, "--scenes", SCENES, "--largest", "1000", "--budget", "3600"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let report: Value = serde_json::from_str(&read("report.json")).unwrap();
    let rows = report["rows"].as_array().unwrap();
    // Exact and reference, and three kernels with 10, 100 and 1000 springs.
    assert_eq!(rows.len(), SCENES.split(',').count() * 11);
    let csv = read("report.csv");
    assert_eq!(csv.lines().count(), rows.len() + 1);
    assert!(csv.starts_with("scene,solver,springs,ratio,force_error,stress_error,kink_error,median,lower,upper,least"));
    let page = read("report.md");
    assert!(page.contains("| scene | solver | springs | × exact | force error |"));
    assert!(page.contains(report["machine"].as_str().unwrap()) && page.contains("load average"));
    for kind in ["stress", "force"] {
        let chart = read(&format!("{kind}.svg"));
        for named in ["reversals_20", "exact", "springs_arcosh", "springs_level", "recipe", "time, s"] {
            assert!(chart.contains(named), "{kind} {named}");
        }
        // Three springs on each of three lines, the exact solver, and its legend; the reference has no error.
        assert_eq!(chart.matches("<circle").count(), 11, "{kind}");
    }
    for row in rows {
        let [lower, median, upper, least] =
            ["lower", "median", "upper", "least"].map(|column| row[column].as_f64().unwrap());
        assert!(0.0 < least && least <= lower && lower <= median && median <= upper, "{row}");
        let [lower, ratio, upper] = ["ratio_lower", "ratio", "ratio_upper"].map(|column| row[column].as_f64().unwrap());
        assert!(0.0 < lower && lower <= ratio && ratio <= upper, "{row}");
        assert!(row["solver"] != "exact" || ratio.to_bits() == 1.0_f64.to_bits(), "{row}");
        assert!(row["solver"] == "reference" || row["runs"].as_u64() >= Some(3), "{row}");
    }
    assert_eq!((&report["missing"], &report["external"]), (&json!([]), &json!([])));

    let error = |scene: &str, solver: &str, springs: Value, column: &str| -> f64 {
        let same = |row: &&Value| row["scene"] == scene && row["solver"] == solver && row["springs"] == springs;
        rows.iter().find(same).unwrap_or_else(|| panic!("{scene} {solver} {springs}"))[column].as_f64().unwrap()
    };
    for scene in SCENES.split(',') {
        assert!(error(scene, "exact", Value::Null, "force_error") < 1e-13, "{scene}");
        assert!(error(scene, "exact", Value::Null, "stress_error") < 1e-11, "{scene}");
        // At a kink the stress has a cusp: a radius that is rounded once moves it by the root of that.
        assert!(error(scene, "exact", Value::Null, "kink_error") < 1e-6, "{scene}");
        for kernel in ["springs_arcosh", "springs_level", "recipe"] {
            // Of second order: a hundred times fewer springs cost ten thousand times the error, or nearly.
            let (coarse, fine) =
                (error(scene, kernel, 10.into(), "force_error"), error(scene, kernel, 1000.into(), "force_error"));
            assert!(fine < coarse / 1000.0, "{scene} {kernel}: {coarse:e} to {fine:e}");
            let (coarse, fine) =
                (error(scene, kernel, 10.into(), "stress_error"), error(scene, kernel, 1000.into(), "stress_error"));
            assert!(fine < coarse, "{scene} {kernel}: {coarse:e} to {fine:e}");
        }
    }
    // With a single kink, differences lose what straight lines between the springs keep.
    let by = |kernel| error("first_loading", kernel, 1000.into(), "stress_error");
    assert!(by("recipe") > 3.0 * by("springs_arcosh"));
    assert!(error("first_loading", "exact", Value::Null, "kink_error") < 1e-13);
}

#[test]
fn solvers_without_time_left_are_listed_and_not_estimated() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let output = speed(&["--out", out, "--scenes", "reversal", "--largest", "100", "--budget", "0"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("report.json")).unwrap()).unwrap();
    let named = |list: &str| -> Vec<String> {
        let all = report[list].as_array().unwrap().iter();
        all.map(|row| format!("{} {}", row["solver"].as_str().unwrap(), row["springs"])).collect()
    };
    // The first of each kind is always measured, as nothing is known of it.
    assert_eq!(
        named("rows"),
        ["exact null", "springs_arcosh 10", "springs_level 10", "recipe 10", "reference null"],
        "{report:#}"
    );
    assert_eq!(named("missing").len(), 3);
    assert!(report["missing"][0]["reason"].as_str().unwrap().starts_with("100: no time left"), "{report:#}");
    let page = std::fs::read_to_string(folder.path().join("report.md")).unwrap();
    assert!(page.contains("## Not measured") && page.contains("| reversal | recipe | 100: no time left"));
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
