//! A scan on the command line. What becomes of it is tested in `crates/compute/tests/documents/profile_fit.rs`, what a
//! fit finds in `crates/measured/tests/scans`.

use std::process::Output;

use serde_json::Value;

use crate::common::{number, run};

#[test]
fn a_map_over_the_limit_is_thinned() {
    let folder = tempfile::tempdir().unwrap();
    // A matrix of Gwyddion with more heights than a request may have, and a hole.
    let height = |row: usize, column: usize| {
        let (x, y) = (column as f64 - 300.0, row as f64 - 280.0);
        if (row, column) == (7, 5) { "nan".to_owned() } else { format!("{:e}", -5e-11 * (x * x + y * y)) }
    };
    let rows = (0..560).map(|row| (0..600).map(|column| height(row, column)).collect::<Vec<_>>().join("\t"));
    let header = "# Channel: Height\n# Width: 600 µm\n# Height: 560 µm\n# Value units: m\n";
    let matrix = format!("{header}{}\n", rows.collect::<Vec<_>>().join("\n"));
    let file = folder.path().join("map.txt");
    std::fs::write(&file, matrix).unwrap();
    let Output { status, stdout, stderr } = run(&["profile", file.to_str().unwrap(), "--json"]);
    let said = String::from_utf8(stderr).unwrap();
    assert!(status.success(), "{said}");
    let radius = number(&serde_json::from_slice::<Value>(&stdout).unwrap()["radius_of_curvature"]["value"]);
    assert!((radius / 0.01 - 1.0).abs() < 0.01, "{said}");
    assert!(said.contains("600 x 560 heights in m") && said.contains("kept: 300 x 280 heights"), "{said}");
}
