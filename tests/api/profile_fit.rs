//! A scan on the command line. What becomes of it is tested in `crates/compute/tests/documents/profile_fit.rs`, what a
//! fit finds in `crates/measured/tests/scans`.

use serde_json::Value;

use crate::common::{number, run};

fn radius(printed: &[u8]) -> f64 {
    number(&serde_json::from_slice::<Value>(printed).unwrap()["radius_of_curvature"]["value"])
}

#[test]
fn a_file_of_an_instrument_is_read_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let read = |name: &str, bytes: &[u8]| {
        let file = folder.path().join(name);
        std::fs::write(&file, bytes).unwrap();
        let output = run(&["profile", file.to_str().unwrap(), "--json"]);
        (output.status.success(), output.stdout, String::from_utf8(output.stderr).unwrap())
    };
    // A matrix of Gwyddion with more heights than a request may have, and a hole.
    let height = |row: usize, column: usize| {
        let (x, y) = (column as f64 - 300.0, row as f64 - 280.0);
        if (row, column) == (7, 5) { "nan".to_owned() } else { format!("{:e}", -5e-11 * (x * x + y * y)) }
    };
    let rows = (0..560).map(|row| (0..600).map(|column| height(row, column)).collect::<Vec<_>>().join("\t"));
    let header = "# Channel: Height\n# Width: 600 µm\n# Height: 560 µm\n# Value units: m\n";
    let matrix = format!("{header}{}\n", rows.collect::<Vec<_>>().join("\n"));
    let (good, printed, said) = read("map.txt", matrix.as_bytes());
    assert!(good && (radius(&printed) / 0.01 - 1.0).abs() < 0.01, "{said}");
    assert!(said.contains("600 x 560 heights in m") && said.contains("kept: 300 x 280 heights"), "{said}");
    // What a column was taken for is said.
    let row = |x: i32| format!("{x};{:.3}\n", -(f64::from(x) - 7.0).powi(2) / 20.0);
    let rows = (-200..=200).map(row).collect::<String>();
    let (_, printed, said) = read("line.csv", format!("X [µm];Z [nm]\n{}", rows.replace('.', ",")).as_bytes());
    assert!((radius(&printed) / 0.01 - 1.0).abs() < 0.01, "{said}");
    assert!(said.contains("x is `X [µm]`, in um") && said.contains("decimal commas"), "{said}");
}
