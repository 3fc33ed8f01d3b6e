//! `stickslip-report figures` beside the figures of the documentation, which a person has looked at.

#[path = "../../../tests/common/pictures.rs"]
mod pictures;

use std::fs;
use std::path::Path;
use std::process::Command;

/// How far a line may be from its reference, pixels: coordinates are rounded to whole ones.
const SHIFT: f64 = 1.0;

#[test]
fn the_figures_of_the_documentation_are_those_that_the_command_draws() {
    let folder = tempfile::tempdir().unwrap();
    let mut tool = Command::new(env!("CARGO_BIN_EXE_stickslip-report"));
    let output = tool.args(["figures", "--out", folder.path().to_str().unwrap()]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let written = fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().path());
    let drawn: Vec<_> = written.filter(|file| file.extension().is_some_and(|end| end == "svg")).collect();
    assert_eq!(drawn.len(), 18, "{drawn:?}");
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/figures");
    for file in drawn {
        let reference = kept.join(file.file_name().unwrap());
        let [found, reference] = [&file, &reference].map(|file| fs::read_to_string(file).unwrap());
        let other = pictures::other_lines(&found, &reference, SHIFT);
        assert!(other.is_none(), "{} is another picture: {}", file.display(), other.unwrap_or_default());
    }
}
