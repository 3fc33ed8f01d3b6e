//! Regions of a field over a grid: interpolated between the places, and bounded by closed lines of equal value.
//!
//! Between the places the field is a monotone cubic along one coordinate and then along the other (Fritsch & Carlson
//! 1980, with the slopes of Fritsch & Butland 1984): smooth, and between the values at the four corners of a cell, so
//! that no extremum appears that is not in the data. A cell with a corner that has no value has none either.

use std::collections::BTreeMap;

/// Cells along a side that a coarse grid is refined to, about.
const REFINED: usize = 128;
/// Cells along a side at most, whatever the grid.
const MOST: usize = 256;

/// Values over a grid: all along `y` at the first of `x`, then at the next. Where there is none, and all round, is NaN:
/// both ends of each axis are there twice.
pub(super) struct Grid {
    x: Vec<f64>,
    y: Vec<f64>,
    values: Vec<f64>,
}

/// A closed line about a region, or about a hole in one.
pub(super) struct Outline {
    /// Its corners, the region on their left, and whether each is where values end, not where they are equal.
    corners: Vec<((f64, f64), bool)>,
    /// The area within, above zero of a region and below zero of a hole.
    pub(super) area: f64,
}

impl Outline {
    fn new(corners: Vec<((f64, f64), bool)>) -> Outline {
        let next = corners.iter().cycle().skip(1);
        let area =
            corners.iter().zip(next).map(|((one, _), (other, _))| one.0 * other.1 - other.0 * one.1).sum::<f64>();
        Outline { corners, area: 0.5 * area }
    }

    pub(super) fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.corners.iter().map(|corner| corner.0)
    }

    /// The parts along which values are equal.
    pub(super) fn lines(&self) -> Vec<Vec<(f64, f64)>> {
        let mut corners = self.corners.clone();
        match corners.iter().position(|corner| corner.1) {
            Some(end) => corners.rotate_left(end),
            None => corners.push(corners[0]),
        }
        let parts = corners.split(|corner| corner.1).filter(|part| part.len() > 1);
        parts.map(|part| part.iter().map(|corner| corner.0).collect()).collect()
    }
}

impl Grid {
    /// As many places as a picture needs, of values at given ones: all along `y` at the first of `x`, then at the next.
    pub(super) fn refined(x: &[f64], y: &[f64], values: &[f64]) -> Grid {
        let (fine_x, fine_y) = (refined_axis(x), refined_axis(y));
        let (inner_x, inner_y) = (&fine_x[1..fine_x.len() - 1], &fine_y[1..fine_y.len() - 1]);
        let along: Vec<Vec<f64>> = values.chunks(y.len()).map(|column| interpolated(y, column, inner_y)).collect();
        let mut fine = vec![f64::NAN; fine_x.len() * fine_y.len()];
        for row in 0..inner_y.len() {
            let across: Vec<f64> = along.iter().map(|column| column[row]).collect();
            for (column, value) in interpolated(x, &across, inner_x).into_iter().enumerate() {
                if value.is_finite() {
                    fine[(column + 1) * fine_y.len() + row + 1] = value;
                }
            }
        }
        Grid { x: fine_x, y: fine_y, values: fine }
    }

    /// The outlines of the region where the field is at least `level`.
    pub(super) fn outlines(&self, level: f64) -> Vec<Outline> {
        let rows = self.y.len();
        // From each crossing of the level to the next one. A crossing between two neighbours is numbered by the one
        // nearer the origin and by the axis along which the other lies.
        let mut next = BTreeMap::new();
        for low in (0..self.values.len() - rows).filter(|low| low % rows + 1 < rows) {
            let corners = [low, low + rows, low + rows + 1, low + 1].map(|place| self.values[place]);
            let crossings = [2 * low, 2 * (low + rows) + 1, 2 * (low + 1), 2 * low + 1];
            let inside = corners.map(|value| value >= level);
            let is_saddle = inside[0] == inside[2] && inside[1] == inside[3] && inside[0] != inside[1];
            // At a saddle the mean decides which corners are joined.
            let joined = corners.iter().map(|value| 0.25 * value).sum::<f64>() >= level;
            for side in (0..4).filter(|side| inside[*side] && !inside[(side + 1) % 4]) {
                let steps =
                    if is_saddle && !joined { 3 } else { (1..4).find(|n| inside[(side + n + 1) % 4]).unwrap_or(3) };
                next.insert(crossings[side], crossings[(side + steps) % 4]);
            }
        }
        let mut outlines = Vec::new();
        while let Some((first, mut last)) = next.pop_first() {
            let mut corners = vec![self.place(first, level)];
            while let Some(after) = next.remove(&last) {
                corners.push(self.place(last, level));
                last = after;
            }
            outlines.push(Outline::new(corners));
        }
        outlines
    }

    /// Where a crossing of the level is, and whether that is where values end.
    fn place(&self, crossing: usize, level: f64) -> ((f64, f64), bool) {
        let (low, rows) = (crossing / 2, self.y.len());
        let high = low + [rows, 1][crossing % 2];
        let share = match (self.values[low], self.values[high]) {
            (here, _) if here.is_nan() => 1.0,
            (_, there) if there.is_nan() => 0.0,
            (here, there) => ((level - here) / (there - here)).clamp(0.0, 1.0),
        };
        let between = |axis: &[f64], low: usize, high: usize| axis[low] + (axis[high] - axis[low]) * share;
        let place = (between(&self.x, low / rows, high / rows), between(&self.y, low % rows, high % rows));
        (place, self.values[low].is_nan() || self.values[high].is_nan())
    }
}

/// An axis with as many places between each two values as make about [`REFINED`] cells, and both ends twice.
fn refined_axis(values: &[f64]) -> Vec<f64> {
    let cells = values.len().saturating_sub(1).max(1);
    let parts = (REFINED.div_ceil(cells) * cells).min(MOST);
    let place = |part: usize| {
        let at = (part * cells) as f64 / parts as f64;
        let low = at as usize;
        let [from, to] = [low, low + 1].map(|index| values[index.min(values.len() - 1)]);
        from + (to - from) * (at - low as f64)
    };
    let inner = (0..=parts).map(place);
    [values[0]].into_iter().chain(inner).chain(values.last().copied()).collect()
}

/// The values of a monotone cubic through `(x, values)` at places that rise and lie within; NaN beside a missing value.
fn interpolated(x: &[f64], values: &[f64], places: &[f64]) -> Vec<f64> {
    let slopes = slopes(x, values);
    let mut interval = 0;
    let value = |place: &f64| {
        while interval + 2 < x.len() && *place >= x[interval + 1] {
            interval += 1;
        }
        let (low, high) = (interval, (interval + 1).min(x.len() - 1));
        if *place <= x[low] || low == high {
            return values[low];
        }
        if *place >= x[high] {
            return values[high];
        }
        let (width, from, to) = (x[high] - x[low], values[low], values[high]);
        let t = (place - x[low]) / width;
        // Hermite's form about the straight line.
        let bend = (1.0 - t) * (slopes[low] * width - (to - from)) - t * (slopes[high] * width - (to - from));
        let value = from + t * (to - from) + t * (1.0 - t) * bend;
        // Rounding must not lead beyond the neighbours; `clamp` keeps a missing value.
        if from <= to {
            value.clamp(from, to)
        } else if to < from {
            value.clamp(to, from)
        } else {
            f64::NAN
        }
    };
    places.iter().map(value).collect()
}

/// Slopes at each place with which the cubics between them are monotone; zero at an extremum.
fn slopes(x: &[f64], values: &[f64]) -> Vec<f64> {
    let secant = |index: usize| (values[index + 1] - values[index]) / (x[index + 1] - x[index]);
    let of = |index: usize| {
        let before = index.checked_sub(1).map(secant).filter(|slope| slope.is_finite());
        let after = (index + 1 < x.len()).then(|| secant(index)).filter(|slope| slope.is_finite());
        match (before, after) {
            (Some(before), Some(after)) if before * after > 0.0 => {
                let (short, long) = (x[index] - x[index - 1], x[index + 1] - x[index]);
                let share = (short + 2.0 * long) / (3.0 * (short + long));
                1.0 / (share / before + (1.0 - share) / after)
            }
            (Some(_), Some(_)) | (None, None) => 0.0,
            (Some(only), None) | (None, Some(only)) => only,
        }
    };
    (0..x.len()).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::{Grid, interpolated};

    /// The refined grid of values over [0, 1] x [0, 1].
    fn refined(count: usize, values: &[f64]) -> Grid {
        let axis: Vec<f64> = (0..count).map(|index| index as f64 / (count - 1) as f64).collect();
        Grid::refined(&axis, &axis, values)
    }

    /// The values of a function over [0, 1] x [0, 1].
    fn sampled(count: usize, of: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        let place = |index: usize| index as f64 / (count - 1) as f64;
        (0..count * count).map(|index| of(place(index / count), place(index % count))).collect()
    }

    /// Numbers between 0 and 1 that repeat in no short order.
    fn scattered(index: usize) -> f64 {
        ((12.9898 * index as f64 + 1.0).sin() * 43_758.545).rem_euclid(1.0)
    }

    #[test]
    fn the_field_between_places_stays_between_their_values() {
        for count in [2, 3, 7, 40, 300] {
            let rough: Vec<f64> = (0..count * count).map(scattered).collect();
            let fine = refined(count, &rough);
            let cells = fine.x.len() - 3;
            assert!((128..=256).contains(&cells), "{cells}");
            if count > 256 {
                continue;
            }
            let parts = cells / (count - 1);
            for (i, j) in (0..=cells).flat_map(|i| (0..=cells).map(move |j| (i, j))) {
                let value = &fine.values[(i + 1) * fine.y.len() + j + 1];
                let near = |at: usize| [at / parts, at.div_ceil(parts)];
                let corners = near(i).into_iter().flat_map(|i| near(j).map(|j| rough[i * count + j]));
                let (low, high) = corners
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
                assert!((low..=high).contains(value), "{count}: {value} outside {low} to {high}");
            }
        }
    }

    #[test]
    fn a_missing_value_leaves_its_cells_blank_and_no_others() {
        let mut coarse = sampled(9, |x, y| x + y);
        coarse[4 * 9 + 4] = f64::NAN;
        let outlines = refined(9, &coarse).outlines(f64::NEG_INFINITY);
        assert_eq!(outlines.len(), 2, "the edge of the grid, and that of the hole");
        assert!((outlines[0].area - 1.0).abs() < 1e-12, "{}", outlines[0].area);
        assert!((outlines[1].area + 1.0 / 16.0).abs() < 0.005, "{}", outlines[1].area);
        assert!(outlines.iter().all(|outline| outline.lines().is_empty()));
    }

    #[test]
    fn the_region_above_a_level_has_its_area() {
        // A round hill, from a coarse grid too.
        let hill = |x: f64, y: f64| 1.0 - (x - 0.5).powi(2) - (y - 0.5).powi(2);
        for (count, allowed) in [(25, 3e-3), (161, 5e-5)] {
            let outlines = refined(count, &sampled(count, hill)).outlines(1.0 - 0.09);
            assert_eq!(outlines.len(), 1);
            let error = (outlines[0].area - std::f64::consts::PI * 0.09).abs();
            assert!(error < allowed, "{count}: {error}");
            let lines = outlines[0].lines();
            assert!(lines.len() == 1 && lines[0].len() == outlines[0].points().count() + 1);
        }
        // A bowl is a region with a hole.
        let outlines = refined(41, &sampled(41, |x, y| -hill(x, y))).outlines(-1.0 + 0.09);
        assert_eq!(outlines.len(), 2);
        assert!(outlines[0].area > 0.999 && (outlines[1].area + 0.09 * std::f64::consts::PI).abs() < 1e-3);
    }

    #[test]
    fn the_areas_above_levels_of_a_rough_field_add_up_to_its_mean() {
        // int v = int (area above a level) d level, for a field that is straight between its places.
        let values: Vec<f64> = (0..130 * 130).map(scattered).collect();
        let rough = refined(130, &values);
        let levels = 400;
        let above: f64 = (0..levels)
            .map(|index| {
                let outlines = rough.outlines((f64::from(index) + 0.5) / f64::from(levels));
                outlines.iter().map(|outline| outline.area).sum::<f64>() / f64::from(levels)
            })
            .sum();
        let cells = 129.0 * 129.0;
        let corners = |i: usize, j: usize| [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(m, n)| values[130 * (i + m) + j + n]);
        let mean: f64 = (0..129)
            .flat_map(|i| (0..129).map(move |j| (i, j)))
            .map(|(i, j)| 0.25 * corners(i, j).iter().sum::<f64>() / cells)
            .sum();
        assert!((above / mean - 1.0).abs() < 0.02, "{above} {mean}");
    }

    #[test]
    fn a_straight_line_stays_one_and_an_extremum_where_it_is() {
        let x = [0.0, 1.0, 3.0, 4.0];
        let places: Vec<f64> = (0..=40).map(|index| 0.1 * f64::from(index)).collect();
        for (place, value) in places.iter().zip(interpolated(&x, &x.map(|x| 2.0 * x - 1.0), &places)) {
            assert!((value - (2.0 * place - 1.0)).abs() < 1e-12);
        }
        let peak = interpolated(&x, &[0.0, 2.0, 1.0, 1.0], &places);
        assert!(peak.iter().all(|value| *value <= 2.0) && (peak[10] - 2.0).abs() < 1e-12);
    }
}
