//! Synthetic scans of known shapes, with the faults of real ones.

use stickslip_measured::scan::Scan;
use stickslip_mechanics::profile::{Profile, RoundedCone, RoundedPunch, Sphere, Tabulated};

/// A shape whose contact is known.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Radius of curvature.
    Ball(f64),
    /// Radius of curvature, radius of the flat, half the width over which its rim is rounded.
    WornBall(f64, f64, f64),
    /// Slope, radius of the tip.
    Cone(f64, f64),
    /// Radius of the flat, of the edge.
    Punch(f64, f64),
    /// A cone with a hyperbola as its tip: slope, and radius over which it is blunt.
    Hyperboloid(f64, f64),
}

impl Shape {
    /// f(r), m.
    pub fn height(&self, r: f64) -> f64 {
        match *self {
            Shape::Ball(radius) => r * r / (2.0 * radius),
            Shape::WornBall(radius, flat, rim) => {
                // The slope rises linearly over the rim, from zero to that of the ball.
                let (inner, outer) = (flat - rim, flat + rim);
                let over_rim = |r: f64| (r - inner).max(0.0).powi(2) / (2.0 * radius) * outer / (outer - inner);
                if r < outer { over_rim(r) } else { over_rim(outer) + (r * r - outer * outer) / (2.0 * radius) }
            }
            Shape::Cone(slope, tip) => {
                if r < tip {
                    slope * r * r / (2.0 * tip)
                } else {
                    slope * (r - 0.5 * tip)
                }
            }
            Shape::Punch(flat, edge) => (r - flat).max(0.0).powi(2) / (2.0 * edge),
            Shape::Hyperboloid(slope, blunt) => slope * r * r / (r.hypot(blunt) + blunt),
        }
    }

    /// The profile of the mechanics, up to `reach`, m.
    pub fn profile(&self, reach: f64) -> Profile {
        match *self {
            Shape::Ball(radius) => Profile::Sphere(Sphere::new(radius).unwrap()),
            Shape::WornBall(..) => self.table(reach, 1),
            Shape::Hyperboloid(..) => self.table(reach, 2),
            Shape::Cone(slope, tip) => Profile::RoundedCone(RoundedCone::new(slope, tip).unwrap()),
            Shape::Punch(flat, edge) => Profile::RoundedPunch(RoundedPunch::new(flat, edge).unwrap()),
        }
    }

    /// A table of 2000 steps, which grow outward as a power of the radius.
    fn table(&self, reach: f64, power: i32) -> Profile {
        let radii: Vec<f64> =
            (0..=2_000).map(|index| 1.01 * reach * (f64::from(index) / 2_000.0).powi(power)).collect();
        let heights: Vec<f64> = radii.iter().map(|&r| self.height(r)).collect();
        Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap())
    }
}

/// What an instrument does to a shape.
#[derive(Clone, Debug)]
pub struct Instrument {
    /// Half the length of a line, or of the side of a map, m.
    pub half: f64,
    /// Points along a line, or along the side of a map.
    pub points: usize,
    /// Whether it scans an area.
    pub map: bool,
    /// Where the axis is, m.
    pub axis: [f64; 2],
    /// Slopes of the stage.
    pub tilt: [f64; 2],
    /// Standard deviation of the noise, m, and over how many points it is correlated.
    pub noise: f64,
    pub correlation: usize,
    /// Shares of outliers and of missing points.
    pub outliers: f64,
    pub missing: f64,
    /// The share of points that have the fill value of the instrument, m, in place of a height.
    pub dropouts: f64,
    pub fill: f64,
    /// +1 where heights are those of the gap.
    pub sign: f64,
}

impl Instrument {
    /// Places and heights, m.
    pub fn heights(&self, shape: &Shape, random: &mut fastrand::Rng) -> Vec<[f64; 3]> {
        let at = |index: usize| self.half * (2.0 * index as f64 / (self.points - 1) as f64 - 1.0);
        let rows = if self.map { self.points } else { 1 };
        let noise =
            correlated(rows, self.points, if self.map { self.correlation } else { 1 }, self.correlation, random);
        let mut points = Vec::new();
        for row in 0..rows {
            for column in 0..self.points {
                let (x, y) = (at(column), if self.map { at(row) } else { 0.0 });
                let (u, v) = (x - self.axis[0], y - self.axis[1]);
                let mut height = shape.height(u.hypot(v)) + self.tilt[0] * u + self.tilt[1] * v;
                height += self.noise * noise[row * self.points + column];
                if random.f64() < self.outliers {
                    height +=
                        self.noise.max(1e-9) * (20.0 + 1000.0 * random.f64()) * if random.bool() { 1.0 } else { -1.0 };
                }
                let height = if random.f64() < self.missing { f64::NAN } else { self.sign * height + 3e-6 };
                let dropped = self.dropouts > 0.0 && random.f64() < self.dropouts;
                let height = if dropped { self.fill } else { height };
                points.push([x, y, height]);
            }
        }
        points
    }

    pub fn scan(&self, shape: &Shape, random: &mut fastrand::Rng) -> Scan {
        let points = self.heights(shape, random);
        if self.map { Scan::area(points) } else { Scan::line(points.into_iter().map(|[x, _, z]| [x, z])) }
    }
}

pub fn normal(random: &mut fastrand::Rng) -> f64 {
    (-2.0 * (1.0 - random.f64()).ln()).sqrt() * (std::f64::consts::TAU * random.f64()).cos()
}

/// Noise of unit variance: white noise averaged over boxes of `down` times `along` points.
fn correlated(rows: usize, columns: usize, down: usize, along: usize, random: &mut fastrand::Rng) -> Vec<f64> {
    let (tall, wide) = (rows + down - 1, columns + along - 1);
    let white: Vec<f64> = (0..tall * wide).map(|_| normal(random)).collect();
    let mut across = vec![0.0; tall * columns];
    for row in 0..tall {
        for column in 0..columns {
            across[row * columns + column] = white[row * wide + column..][..along].iter().sum();
        }
    }
    let scale = 1.0 / ((down * along) as f64).sqrt();
    (0..rows * columns).map(|index| scale * (0..down).map(|step| across[index + step * columns]).sum::<f64>()).collect()
}
