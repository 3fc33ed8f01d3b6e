//! What a steady turn of an ellipse loses, over the amplitude, the ratio of the radii and the phase.

use stickslip_mechanics::Error;

use super::{turn_losses, two_turns};
use crate::report::table;

/// a over the displacement of gross slip.
const AMPLITUDES: [f64; 2] = [0.3, 0.6];
/// b/a.
const RATIOS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// Degrees.
const PHASES: [f64; 4] = [0.0, 30.0, 60.0, 90.0];
const PER_TURN: usize = 16;
pub(super) const TOLERANCE: f64 = 1e-3;

/// The friction work of the second turn over mu F_N u_max, as a table.
pub(super) fn losses() -> Result<String, Error> {
    let names = format!("a / u_max | b / a{}", PHASES.map(|phase| format!(" | phase {phase:.0}°")).concat());
    let row = |(amplitude, ratio): (f64, f64)| {
        let cell = |phase| Ok(format!(" {:.3} |", loss(amplitude, ratio, phase)?));
        let cells: String = PHASES.into_iter().map(cell).collect::<Result<_, Error>>()?;
        Ok(format!("| {amplitude} | {ratio} |{cells}"))
    };
    let rows = AMPLITUDES.into_iter().flat_map(|amplitude| RATIOS.map(|ratio| (amplitude, ratio)));
    Ok(table(&names, rows.map(row).collect::<Result<Vec<_>, Error>>()?))
}

fn loss(amplitude: f64, ratio: f64, phase: f64) -> Result<f64, Error> {
    let radii = [amplitude, ratio * amplitude];
    let solution = two_turns(radii, phase.to_radians(), PER_TURN, None, TOLERANCE)?;
    Ok(turn_losses(&solution.states, PER_TURN)[1])
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{AMPLITUDES, PHASES, RATIOS, loss};

    /// The friction work of a cycle along a line between -amplitude and amplitude (Mindlin & Deresiewicz 1953), over mu
    /// F_N u_max: the force on the way down is F_A - 2 (1 - (1 - s/2)^(3/2)) after a way s.
    fn of_line(amplitude: f64) -> f64 {
        let left = 1.0 - amplitude;
        8.0 * amplitude - 4.0 * amplitude * (1.0 - left.powf(1.5)) - 3.2 * (1.0 - left.powf(2.5))
    }

    #[test]
    fn the_table_of_the_documentation_is_that_of_the_engine_and_of_the_closed_form_on_lines() {
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/plane.md");
        let page = std::fs::read_to_string(page).unwrap();
        let mut rows = 0;
        for (amplitude, ratio) in AMPLITUDES.into_iter().flat_map(|one| RATIOS.map(|ratio| (one, ratio))) {
            let begin = format!("| {amplitude} | {ratio} |");
            let row = page.lines().find_map(|line| line.strip_prefix(&begin)).unwrap_or_else(|| panic!("no {begin}"));
            let written: Vec<f64> = row.split_terminator('|').map(|cell| cell.trim().parse().unwrap()).collect();
            assert_eq!(written.len(), PHASES.len(), "{row}");
            for (written, phase) in written.into_iter().zip(PHASES) {
                let found = loss(amplitude, ratio, phase).unwrap();
                assert!((written - found).abs() < 1e-3, "{begin} {phase}: {found}");
                let line = match (ratio, phase) {
                    (0.0, _) => Some(of_line(amplitude)),
                    (_, 90.0) => Some(of_line(amplitude * ratio.hypot(1.0))),
                    _ => None,
                };
                assert!(line.is_none_or(|line| (written - line).abs() < 1.5e-3), "{begin} {phase}: {line:?}");
            }
            rows += 1;
        }
        assert_eq!(rows, 10);
        // By an independent prototype in NumPy.
        assert!((loss(0.6, 1.0, 0.0).unwrap() - 0.5556).abs() < 1e-3);
        assert!((loss(0.6, 0.5, 0.0).unwrap() - 0.2131).abs() < 1e-3);
    }
}
