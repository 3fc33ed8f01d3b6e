//! Regions of a field over a grid: interpolated between the places, and bounded by closed lines of equal value.
//!
//! Between the places the field is a monotone cubic along one coordinate and then along the other (Fritsch & Carlson
//! 1980, with the slopes of Fritsch & Butland 1984): smooth, and between the values at the four corners of a cell, so
//! that no extremum appears that is not in the data. A cell with a corner that has no value has none either.

/// Cells along a side that a coarse grid is refined to, about.
const REFINED: usize = 128;
/// Places along a side at most: of a finer grid so many are drawn.
const MOST: usize = 256;

/// Values over a grid: all along `y` at the first of `x`, then at the next; NaN where there is none.
pub(super) struct Grid {
    x: Vec<f64>,
    y: Vec<f64>,
    values: Vec<f64>,
}

/// A closed line about a region, or about a hole in one.
pub(super) struct Outline {
    /// Its corners, the region on their left.
    pub(super) points: Vec<(f64, f64)>,
    /// Whether the side from the corner of this index on is where values end, not where they are equal.
    pub(super) ends: Vec<bool>,
    /// The area within, above zero of a region and below zero of a hole.
    pub(super) area: f64,
}

impl Grid {
    fn value(&self, column: usize, row: usize) -> f64 {
        self.values[column * self.y.len() + row]
    }

    /// As many places as a picture needs, of values at given ones: all along `y` at the first of `x`, then at the next.
    pub(super) fn refined(x: &[f64], y: &[f64], values: &[f64]) -> Grid {
        let (columns, rows) = (sampled(x.len()), sampled(y.len()));
        let (coarse_x, coarse_y) = (at(x, &columns), at(y, &rows));
        let (fine_x, fine_y) = (refined_axis(&coarse_x), refined_axis(&coarse_y));
        let along = |column: &usize| {
            let values: Vec<f64> = rows.iter().map(|row| values[column * y.len() + row]).collect();
            interpolated(&coarse_y, &values, &fine_y)
        };
        let along: Vec<Vec<f64>> = columns.iter().map(along).collect();
        let mut fine = vec![f64::NAN; fine_x.len() * fine_y.len()];
        for row in 0..fine_y.len() {
            let across: Vec<f64> = along.iter().map(|column| column[row]).collect();
            for (column, value) in interpolated(&coarse_x, &across, &fine_x).into_iter().enumerate() {
                fine[column * fine_y.len() + row] = value;
            }
        }
        Grid { x: fine_x, y: fine_y, values: fine }
    }

    /// The outlines of the region where the field is at least `level`, those about the largest areas first.
    pub(super) fn outlines(&self, level: f64) -> Vec<Outline> {
        let mut sides = Vec::new();
        for column in 0..self.x.len() - 1 {
            for row in 0..self.y.len() - 1 {
                self.sides_of(column, row, level, &mut sides);
            }
        }
        sides.sort_unstable_by_key(|side| (side.from, side.to));
        let mut used = vec![false; sides.len()];
        let mut outlines = Vec::new();
        for first in 0..sides.len() {
            if used[first] {
                continue;
            }
            let mut outline = Outline { points: Vec::new(), ends: Vec::new(), area: 0.0 };
            let mut next = Some(first);
            while let Some(index) = next {
                used[index] = true;
                outline.points.push(self.place(sides[index].from, level));
                outline.ends.push(sides[index].ends);
                let to = sides[index].to;
                let from = sides.partition_point(|side| side.from < to);
                next = (from..sides.len()).take_while(|index| sides[*index].from == to).find(|index| !used[*index]);
            }
            outline.area = area(&outline.points);
            outlines.push(outline);
        }
        outlines.sort_by(|one, other| other.area.abs().total_cmp(&one.area.abs()));
        outlines
    }

    fn is_cell(&self, column: usize, row: usize) -> bool {
        column + 1 < self.x.len()
            && row + 1 < self.y.len()
            && [(0, 0), (1, 0), (1, 1), (0, 1)].iter().all(|(i, j)| self.value(column + i, row + j).is_finite())
    }

    /// The sides of the part of a cell where the field is at least `level`, but for those shared with the next cell.
    fn sides_of(&self, column: usize, row: usize, level: f64, sides: &mut Vec<Side>) {
        if !self.is_cell(column, row) {
            return;
        }
        let corners = [(column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1)];
        let values = corners.map(|(i, j)| self.value(i, j));
        let inside = values.map(|value| value >= level);
        // Beyond the edges below, to the right, above and to the left.
        let ends = [
            row == 0 || !self.is_cell(column, row - 1),
            !self.is_cell(column + 1, row),
            !self.is_cell(column, row + 1),
            column == 0 || !self.is_cell(column - 1, row),
        ];
        let mut line: Vec<(Vertex, usize)> = Vec::with_capacity(8);
        for edge in 0..4 {
            let next = (edge + 1) % 4;
            if inside[edge] {
                line.push((self.corner(corners[edge]), edge));
            }
            if inside[edge] != inside[next] {
                line.push((self.crossing(corners[edge], corners[next]), edge));
            }
        }
        // At a saddle the mean decides which corners are joined.
        let saddle = inside[0] == inside[2] && inside[1] == inside[3] && inside[0] != inside[1];
        let joined = values.iter().map(|value| 0.25 * value).sum::<f64>() >= level;
        let parts: Vec<Vec<(Vertex, usize)>> = if saddle && !joined {
            // Each corner with the crossings before and after it.
            let at = line.iter().position(|(vertex, _)| vertex.is_corner(self)).unwrap_or(0);
            let before = (at + line.len() - 1) % line.len();
            line.rotate_left(before);
            vec![line[..3].to_vec(), line[3..].to_vec()]
        } else {
            vec![line]
        };
        for part in parts {
            for (index, (from, edge)) in part.iter().enumerate() {
                let (to, next_edge) = part[(index + 1) % part.len()];
                // A side within one edge of the cell starts on that edge, at a corner or a crossing.
                let along = if to.is_corner(self) { (next_edge + 3) % 4 } else { next_edge };
                let is_edge = *edge == along;
                if !is_edge || ends[*edge] {
                    sides.push(Side { from: from.0, to: to.0, ends: is_edge });
                }
            }
        }
    }

    fn corner(&self, (column, row): (usize, usize)) -> Vertex {
        Vertex(column * self.y.len() + row)
    }

    /// Between two neighbours: numbered by the one nearer the origin, those along x behind all corners, those along y
    /// behind these.
    fn crossing(&self, one: (usize, usize), other: (usize, usize)) -> Vertex {
        let low = one.min(other);
        let kind = if one.0 == other.0 { 2 } else { 1 };
        Vertex(kind * self.values.len() + self.corner(low).0)
    }

    /// Where a corner or a crossing of the level is.
    fn place(&self, vertex: usize, level: f64) -> (f64, f64) {
        let (kind, index) = (vertex / self.values.len(), vertex % self.values.len());
        let (column, row) = (index / self.y.len(), index % self.y.len());
        let (x, y, here) = (self.x[column], self.y[row], self.value(column, row));
        let share = |there: f64| ((level - here) / (there - here)).clamp(0.0, 1.0);
        match kind {
            0 => (x, y),
            1 => (x + (self.x[column + 1] - x) * share(self.value(column + 1, row)), y),
            _ => (x, y + (self.y[row + 1] - y) * share(self.value(column, row + 1))),
        }
    }
}

/// A corner of the grid, or a crossing between two.
#[derive(Clone, Copy, PartialEq)]
struct Vertex(usize);

impl Vertex {
    fn is_corner(self, grid: &Grid) -> bool {
        self.0 < grid.values.len()
    }
}

/// A part of an outline, from one vertex to another.
struct Side {
    from: usize,
    to: usize,
    ends: bool,
}

fn area(points: &[(f64, f64)]) -> f64 {
    let next = points.iter().cycle().skip(1);
    0.5 * points.iter().zip(next).map(|(one, other)| one.0 * other.1 - other.0 * one.1).sum::<f64>()
}

/// The indices of at most [`MOST`] of `count` values, both ends among them.
fn sampled(count: usize) -> Vec<usize> {
    let kept = count.min(MOST);
    (0..kept).map(|index| index * (count - 1) / (kept - 1).max(1)).collect()
}

fn at(values: &[f64], kept: &[usize]) -> Vec<f64> {
    kept.iter().map(|index| values[*index]).collect()
}

/// An axis with its values, and as many between each two as make about [`REFINED`] cells.
fn refined_axis(values: &[f64]) -> Vec<f64> {
    let parts = REFINED.div_ceil(values.len().saturating_sub(1).max(1)).max(1);
    let between = |pair: &[f64]| -> Vec<f64> {
        (0..parts).map(|part| pair[0] + (pair[1] - pair[0]) * (part as f64 / parts as f64)).collect()
    };
    values.windows(2).flat_map(between).chain(values.last().copied()).collect()
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
    use super::{Grid, area, interpolated};

    fn refined(coarse: &Grid) -> Grid {
        Grid::refined(&coarse.x, &coarse.y, &coarse.values)
    }

    /// A grid of a function over [0, 1] x [0, 1].
    fn grid(count: usize, of: impl Fn(f64, f64) -> f64) -> Grid {
        let axis: Vec<f64> = (0..count).map(|index| index as f64 / (count - 1) as f64).collect();
        let values = axis.iter().flat_map(|x| axis.iter().map(|y| of(*x, *y))).collect();
        Grid { x: axis.clone(), y: axis, values }
    }

    /// Numbers between 0 and 1 that repeat in no short order.
    fn scattered(index: usize) -> f64 {
        ((12.9898 * index as f64 + 1.0).sin() * 43_758.545).rem_euclid(1.0)
    }

    #[test]
    fn the_field_between_places_stays_between_their_values() {
        for count in [2, 3, 7, 40, 300] {
            let mut coarse = grid(count, |_, _| 0.0);
            let rough: Vec<f64> = (0..count * count).map(scattered).collect();
            coarse.values.clone_from(&rough);
            let fine = refined(&coarse);
            assert!(fine.x.len() >= count.min(128) && fine.x.len() <= 257, "{}", fine.x.len());
            if count > 256 {
                continue;
            }
            let parts = (fine.x.len() - 1) / (count - 1);
            for (index, value) in fine.values.iter().enumerate() {
                let (i, j) = (index / fine.y.len(), index % fine.y.len());
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
        let mut coarse = grid(9, |x, y| x + y);
        coarse.values[4 * 9 + 4] = f64::NAN;
        let fine = refined(&coarse);
        let outlines = fine.outlines(f64::NEG_INFINITY);
        assert_eq!(outlines.len(), 2, "the edge of the grid, and that of the hole");
        assert!((outlines[0].area - 1.0).abs() < 1e-12, "{}", outlines[0].area);
        assert!((outlines[1].area + 1.0 / 16.0).abs() < 0.005, "{}", outlines[1].area);
        assert!(outlines.iter().all(|outline| outline.ends.iter().all(|ends| *ends)));
    }

    #[test]
    fn the_region_above_a_level_has_its_area() {
        // A round hill, from a coarse grid too.
        let hill = |x: f64, y: f64| 1.0 - (x - 0.5).powi(2) - (y - 0.5).powi(2);
        for (count, allowed) in [(25, 3e-3), (161, 5e-5)] {
            let outlines = refined(&grid(count, hill)).outlines(1.0 - 0.09);
            assert_eq!(outlines.len(), 1);
            let error = (outlines[0].area - std::f64::consts::PI * 0.09).abs();
            assert!(error < allowed, "{count}: {error}");
            assert!((area(&outlines[0].points) - outlines[0].area).abs() < 1e-15);
            assert!(outlines[0].ends.iter().all(|ends| !ends));
        }
        // A bowl is a region with a hole.
        let outlines = refined(&grid(41, |x, y| -hill(x, y))).outlines(-1.0 + 0.09);
        assert_eq!(outlines.len(), 2);
        assert!(outlines[0].area > 0.999 && (outlines[1].area + 0.09 * std::f64::consts::PI).abs() < 1e-3);
    }

    #[test]
    fn the_areas_above_levels_of_a_rough_field_add_up_to_its_mean() {
        // int v = int (area above a level) d level, for a field that is straight between its places.
        let mut rough = grid(130, |_, _| 0.0);
        rough.values = (0..130 * 130).map(scattered).collect();
        let levels = 400;
        let above: f64 = (0..levels)
            .map(|index| {
                let outlines = rough.outlines((f64::from(index) + 0.5) / f64::from(levels));
                outlines.iter().map(|outline| outline.area).sum::<f64>() / f64::from(levels)
            })
            .sum();
        let cells = 129.0 * 129.0;
        let corners = |i: usize, j: usize| [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(m, n)| rough.value(i + m, j + n));
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
