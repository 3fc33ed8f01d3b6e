//! The plane on which a criterion is largest: a grid of normals, then a search from its peaks.
//!
//! Normal stress, shear amplitude and their products are largest values over instants and supports of functions that
//! are smooth in the normal, of second degree. So a peak is at least once continuously differentiable, wide
//! unless a criterion is cut off at zero, and reached by parabolas. Where it is cut off, the planes of the largest
//! tension at each instant join the grid.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::LazyLock;

use super::ball::dot;

/// Angle between neighbours of the grid: five degrees.
const GRID: f64 = PI / 36.0;
/// Normals closer than this are neighbours: it reaches the next one on each side.
const NEIGHBOURS: f64 = 1.3 * GRID;
/// The search starts from so many planes of the grid at most.
const MOST_STARTS: usize = 16;
/// A plane lower than the largest by more than this share of the range over the grid is not searched from.
const SLACK: f64 = 0.1;
/// One lower by less than this share, as much as the grid can be below a peak, is one even if a neighbour is higher,
/// unless a search has ended near it: peaks can hide between the planes of the grid.
const OFF_PEAK: f64 = 0.03;
/// The distance of the first parabola, and of the last. The error of a value is of the order of the latter's square.
const FIRST_STEP: f64 = 0.5 * GRID;
const LAST_STEP: f64 = 1e-5;
/// Circles around the highest peak on which others are looked for, and planes on each.
const CIRCLES: [f64; 2] = [0.5 * GRID, GRID];
const AROUND: usize = 12;
/// More parabolas than a search needs; a safeguard only.
const MOST_STEPS: usize = 60;

/// A vector, or the normal of a plane if it has the length one.
pub(super) type Vector = [f64; 3];

/// Normals of the upper half of a sphere.
static NORMALS: LazyLock<Vec<Vector>> = LazyLock::new(|| normals(GRID));
/// Half as many each way, for a search that only looks where to begin.
static FEW_NORMALS: LazyLock<Vec<Vector>> = LazyLock::new(|| normals(2.0 * GRID));

/// Normals of the upper half of a sphere, the angle `apart`, a part of a right one.
fn normals(apart: f64) -> Vec<Vector> {
    let mut normals = vec![[0.0, 0.0, 1.0]];
    for latitude in 1..=(FRAC_PI_2 / apart).round() as u32 {
        let tilt = f64::from(latitude) * apart;
        // Around the equator opposite normals are the same plane.
        let turn = if tilt < FRAC_PI_2 - 0.5 * apart { 2.0 * PI } else { PI };
        let count = (turn * tilt.sin() / apart).round();
        normals.extend((0..count as u32).map(|index| {
            let (sin, cos) = (turn * f64::from(index) / count).sin_cos();
            [tilt.sin() * cos, tilt.sin() * sin, tilt.cos()]
        }));
    }
    normals
}

/// The normals of a coarse grid, and `more`.
pub(super) fn coarse_grid(more: &[Vector]) -> impl Iterator<Item = &Vector> {
    FEW_NORMALS.iter().chain(more)
}

/// The normals of the grid, and `more`.
fn grid(more: &[Vector]) -> impl Iterator<Item = &Vector> {
    NORMALS.iter().chain(more)
}

/// The largest peaks of a function that opposite normals share, and their normals, sought from the grid and from
/// `more`; the largest of all comes first.
pub(super) fn peaks(more: &[Vector], mut value: impl FnMut(&Vector) -> f64) -> Vec<(f64, Vector)> {
    let highest_first = |one: &(f64, Vector), other: &(f64, Vector)| other.0.total_cmp(&one.0);
    let mut normals: Vec<(f64, Vector)> = grid(more).map(|normal| (value(normal), *normal)).collect();
    normals.sort_by(highest_first);
    let (mut best, top, bottom) = (normals[0], normals[0].0, normals[normals.len() - 1].0);
    let near = |normal: &Vector, others: &[(f64, Vector)]| {
        others.iter().any(|other| dot(&other.1, normal).abs() > NEIGHBOURS.cos())
    };
    let mut found: Vec<(f64, Vector)> = Vec::with_capacity(MOST_STARTS);
    for (rank, start) in normals.iter().enumerate() {
        if start.0 < top - SLACK * (top - bottom) || found.len() == MOST_STARTS {
            break;
        }
        let hidden = start.0 >= best.0 - OFF_PEAK * (top - bottom) && !near(&start.1, &found);
        if hidden || !near(&start.1, &normals[..rank]) {
            let peak = climb(*start, FIRST_STEP, &mut value);
            if peak.0 > best.0 {
                best = peak;
            }
            found.push(peak);
        }
    }
    found.extend(beside(&best.1, &mut value));
    found.push(best);
    found.sort_by(highest_first);
    found
}

/// Peaks so near to one that the grid does not distinguish them: climbed from the highest planes of circles around it.
fn beside(normal: &Vector, mut value: impl FnMut(&Vector) -> f64) -> Vec<(f64, Vector)> {
    let [one, two] = axes(normal);
    let mut found = Vec::new();
    for distance in CIRCLES {
        let circle: [(f64, Vector); AROUND] = std::array::from_fn(|index| {
            let (sin, cos) = (2.0 * PI * index as f64 / AROUND as f64).sin_cos();
            let tilted = unit(&std::array::from_fn(|i| normal[i] + distance * (cos * one[i] + sin * two[i])));
            (value(&tilted), tilted)
        });
        for index in 0..AROUND {
            let (before, after) = (circle[(index + AROUND - 1) % AROUND].0, circle[(index + 1) % AROUND].0);
            if circle[index].0 >= before && circle[index].0 > after {
                found.push(climb(circle[index], 0.25 * distance, &mut value));
            }
        }
    }
    found
}

/// The peak next to a normal, from a distance of the first parabola on: parabolas through six values, and the best
/// value seen where a parabola has no maximum.
pub(super) fn climb(start: (f64, Vector), mut step: f64, mut value: impl FnMut(&Vector) -> f64) -> (f64, Vector) {
    let mut best = start;
    for _ in 0..MOST_STEPS {
        if step < LAST_STEP {
            break;
        }
        let (middle, normal) = best;
        let [one, two] = axes(&normal);
        let mut at = |a: f64, b: f64| {
            let tilted = unit(&std::array::from_fn(|i| normal[i] + step * (a * one[i] + b * two[i])));
            let found = value(&tilted);
            if found > best.0 {
                best = (found, tilted);
            }
            found
        };
        let [right, left, up, down, corner] =
            [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (1.0, 1.0)].map(|(a, b)| at(a, b));
        let slope = [0.5 * (right - left), 0.5 * (up - down)];
        let (xx, yy, xy) = (right + left - 2.0 * middle, up + down - 2.0 * middle, corner - right - up + middle);
        let determinant = xx * yy - xy * xy;
        let inside = if xx < 0.0 && determinant > 0.0 {
            let (a, b) = ((xy * slope[1] - yy * slope[0]) / determinant, (xy * slope[0] - xx * slope[1]) / determinant);
            let far = a.hypot(b);
            at(a * 2.0 / far.max(2.0), b * 2.0 / far.max(2.0));
            far <= 1.0
        } else {
            false
        };
        if inside || best.0 <= middle {
            step *= 0.25;
        }
    }
    best
}

/// Two directions in the plane of a normal, at right angles to each other.
pub(super) fn axes(&[x, y, z]: &Vector) -> [Vector; 2] {
    // Duff et al. (2017).
    let sign = 1.0_f64.copysign(z);
    let (a, b) = (-1.0 / (sign + z), -x * y / (sign + z));
    [[1.0 + sign * x * x * a, sign * b, -sign * x], [b, sign + y * y * a, -y]]
}

/// The vector at the length one.
pub(super) fn unit(vector: &Vector) -> Vector {
    let length = dot(vector, vector).sqrt();
    vector.map(|part| part / length)
}
