//! Missing heights: values by which instruments mark a point that they have not measured.

/// Fill values, in the unit of the heights (ESRI's grids; the least and the largest 16-bit number).
const FILL_VALUES: [f64; 3] = [-9999.0, -32768.0, 32767.0];
/// Units of heights, m.
const UNITS: [f64; 5] = [1.0, 1e-3, 1e-6, 1e-9, 1e-10];
/// How near a height is to a fill value that has been rounded to single precision and converted.
const ROUNDED: f64 = 1e-6;
/// So often no surface has one height to the last digit: the symmetry of a grid repeats a height up to 16 times.
const OFTEN: usize = 16;
/// An instrument has no more fill values of its own than this.
const MOST_FILLS: usize = 3;
/// The share of all heights that are fill values, at most.
const MOST: f64 = 1.0 / 3.0;
/// The share of the heights on either side that the range of the surface leaves out.
const TAIL: f64 = 0.05;

/// The fill values among the heights: those that are known as such, and those that occur often, if they are farther
/// from the surface than its heights reach from each other.
pub(super) fn fill_values(points: &[[f64; 3]]) -> Vec<f64> {
    let mut heights: Vec<f64> = points.iter().map(|point| point[2]).collect();
    heights.sort_by(f64::total_cmp);
    let known = |height: f64| {
        let near = |value: f64| (height - value).abs() <= ROUNDED * value.abs();
        FILL_VALUES.iter().any(|value| UNITS.iter().any(|unit| near(value * unit)))
    };
    let often = |run: &[f64]| run.len() > OFTEN && run.len() as f64 <= MOST * heights.len() as f64;
    let runs: Vec<&[f64]> = heights.chunk_by(|a, b| a.to_bits() == b.to_bits()).collect();
    let is_candidate = |run: &&&[f64]| known(run[0]) || often(run);
    let candidates: Vec<&[f64]> = runs.iter().filter(is_candidate).copied().collect();
    // Of a surface that comes in steps every height occurs often: then what is not known belongs to the surface.
    let in_steps = candidates.len() > MOST_FILLS;
    let is_fill = |run: &&&[f64]| known(run[0]) || (!in_steps && often(run));
    let rest: Vec<f64> = runs.iter().filter(|run| !is_fill(run)).copied().collect::<Vec<&[f64]>>().concat();
    let Some(last) = rest.len().checked_sub(1) else { return Vec::new() };
    let quantile = |share: f64| rest[(share * last as f64) as usize];
    let (low, high) = (quantile(TAIL), quantile(1.0 - TAIL));
    let far = |value: &f64| high > low && (*value < low - (high - low) || *value > high + (high - low));
    candidates.iter().filter(is_fill).map(|run| run[0]).filter(far).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(fill: &[f64], unit: f64) -> Vec<f64> {
        let surface = (0..100).map(|index| f64::from(index * index) / 50.0);
        let points: Vec<[f64; 3]> = surface.chain(fill.iter().copied()).map(|z| [0.0, 0.0, z * unit]).collect();
        fill_values(&points).iter().map(|value| (value / unit).round()).collect()
    }

    #[test]
    fn a_fill_value_is_known_in_any_unit_or_occurs_often_and_is_far_from_the_surface() {
        for unit in UNITS {
            assert_eq!(with(&[-9999.0], unit), [-9999.0]);
            assert_eq!(with(&[32767.0, -32768.0, f64::from(-9999.0f32)], unit), [-32768.0, -9999.0, 32767.0]);
        }
        assert_eq!(with(&[-3000.0; 20], 1e-9), [-3000.0]);
        // A height that occurs twice, one of the surface, a clipped one at its end.
        assert!(with(&[-3000.0; 2], 1e-9).is_empty());
        assert!(with(&[50.0; 20], 1e-9).is_empty() && with(&[198.0; 20], 1e-9).is_empty());
        // A surface in steps, one of which is its flat.
        let in_steps: Vec<f64> = (0..400).map(|index| -300.0 * f64::from(index / 20)).collect();
        assert!(with(&in_steps, 1e-9).is_empty());
        // A surface that reaches to -9999 itself.
        assert!(with(&(0..100).map(|index| -100.0 * f64::from(index) - 99.0).collect::<Vec<_>>(), 1e-9).is_empty());
    }
}
