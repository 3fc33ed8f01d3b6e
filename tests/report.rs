//! `stickslip report`: its columns, and errors that fall as they must. Times are never judged.

mod common;

use serde_json::Value;

const SCENES: &str = "first_loading,reversals_20,oblique,cone,power_4,exact_sphere";

#[test]
fn the_report_finds_the_known_orders_of_error() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let ended = common::run(&["report", "--out", out, "--scenes", SCENES, "--largest", "1000"]);
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let report: Value = serde_json::from_str(&read("report.json")).unwrap();
    let rows = report["rows"].as_array().unwrap();
    // Exact and reference, and three kernels on 10, 100 and 1000 springs.
    assert_eq!(rows.len(), SCENES.split(',').count() * 11);
    let csv = read("report.csv");
    assert_eq!(csv.lines().count(), rows.len() + 1);
    assert!(csv.starts_with("scene,solver,springs,ratio,force_error,stress_error,kink_error,median,lower,upper,least"));
    assert!(read("report.md").contains("| scene | solver | springs | × exact | force error |"));

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
fn an_unknown_scene_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let ended = common::run(&["report", "--out", folder.path().to_str().unwrap(), "--scenes", "third_loading"]);
    assert!(!ended.status.success());
    let said = String::from_utf8_lossy(&ended.stderr);
    assert!(said.contains("third_loading") && said.contains("first_loading"), "{said}");
}
