//! The places below the surface at which stresses are asked for.

use crate::limits::SUBSURFACE_POINTS;
use crate::prelude::*;

requests! {
/// Points on a straight line, both ends included.
pub struct SubsurfaceLine {
    /// Where it begins: x, y, z, m.
    pub from: [f64; 3] = range::PLACE,
    /// Where it ends: x, y, z, m.
    pub to: [f64; 3] = range::PLACE,
    /// Number of points.
    pub count: usize = LINE,
}

/// A grid in a plane of constant x, y or z. Each of the other two coordinates is `[from, to, count]`, m, both ends
/// included.
pub struct SubsurfacePlane {
    /// The coordinate that is constant.
    pub normal: Direction,
    /// Its value, m.
    pub offset: f64 = range::PLACE,
    /// Range of x as `[from, to, count]`; left out where `normal` is x.
    pub x: Option<[f64; 3]> = range::PLACE,
    /// Range of y as `[from, to, count]`; left out where `normal` is y.
    pub y: Option<[f64; 3]> = range::PLACE,
    /// Range of z as `[from, to, count]`; left out where `normal` is z.
    pub z: Option<[f64; 3]> = range::PLACE,
}

/// A grid on the surface, z = 0. Each coordinate is `[from, to, count]`, m, both ends included.
pub struct SubsurfaceSurface {
    /// Range of x as `[from, to, count]`.
    pub x: [f64; 3] = range::PLACE,
    /// Range of y as `[from, to, count]`.
    pub y: [f64; 3] = range::PLACE,
}
}

/// Points of a line: two ends at least.
const LINE: std::ops::RangeInclusive<usize> = 2..=*SUBSURFACE_POINTS.end();

words! {
/// An axis: x along the motion of the first body, z into the body asked for.
pub enum Direction {
    /// Along the motion.
    X = "x",
    /// Across it.
    Y = "y",
    /// Into the body.
    Z = "z",
}
}

/// Checked places, in the order of the reply.
#[derive(Clone, Debug)]
pub enum Places {
    /// A list of x, y, z, m.
    Points(Vec<[f64; 3]>),
    /// A grid of the values along three axes, one of which may be a single one; the last axis changes fastest.
    Grid([Steps; 3]),
    /// A straight line.
    Line(SubsurfaceLine),
}

/// Evenly spaced values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steps {
    from: f64,
    to: f64,
    /// How many.
    pub count: usize,
}

impl Steps {
    /// The value of this index, m.
    pub fn at(&self, index: usize) -> f64 {
        if index == 0 {
            self.from
        } else {
            self.from + (self.to - self.from) * (index as f64 / self.count.saturating_sub(1) as f64)
        }
    }

    fn single(value: f64) -> Steps {
        Steps { from: value, to: value, count: 1 }
    }

    /// `[from, to, count]`, if it is sound.
    fn read([from, to, count]: [f64; 3], at: JsonPath<'_>, faults: &mut Faults) -> Option<Steps> {
        if from >= to {
            faults.add(at.index(1), format_args!("{to:?} must be above {from:?}"));
        }
        let most = *SUBSURFACE_POINTS.end() as f64;
        if !(count >= 2.0 && count <= most && count.fract() == 0.0) {
            faults.add(at.index(2), format_args!("{count:?} points: a grid has 2 to {most}, a whole number"));
        }
        faults.none_within(at)?;
        Some(Steps { from, to, count: count as usize })
    }
}

impl Places {
    /// The places that are given in one of these ways, of the object at `at`.
    pub(crate) fn of(
        points: Option<Vec<[f64; 3]>>,
        line: Option<SubsurfaceLine>,
        plane: Option<SubsurfacePlane>,
        surface: Option<SubsurfaceSurface>,
        at: JsonPath<'_>,
        faults: &mut Faults,
    ) -> Option<Places> {
        const WAYS: &str = "one of `points`, `line`, `plane` and `surface`";
        match (points, line, plane, surface) {
            (Some(points), None, None, None) => Some(Places::points(points, at.member("points"), faults)),
            (None, Some(line), None, None) => Some(Places::line(line, at.member("line"), faults)),
            (None, None, Some(plane), None) => Places::plane(&plane, at.member("plane"), faults),
            (None, None, None, Some(surface)) => Places::surface(&surface, at.member("surface"), faults),
            (None, None, None, None) => faults.refuse(at, format_args!("give {WAYS}")),
            _ => faults.refuse(at, format_args!("more than one place: give {WAYS}")),
        }
    }

    /// A list of points, whose coordinates have been checked but for the depths.
    fn points(points: Vec<[f64; 3]>, at: JsonPath<'_>, faults: &mut Faults) -> Places {
        for (index, point) in points.iter().enumerate() {
            check_depth(point[2], at.index(index).index(2), faults);
        }
        Places::Points(points)
    }

    fn line(line: SubsurfaceLine, at: JsonPath<'_>, faults: &mut Faults) -> Places {
        check_depth(line.from[2], at.member("from").index(2), faults);
        check_depth(line.to[2], at.member("to").index(2), faults);
        if line.from.iter().zip(&line.to).all(|(from, to)| from.to_bits() == to.to_bits()) {
            faults.add(at.member("to"), "the line ends where it begins");
        }
        Places::Line(line)
    }

    fn plane(plane: &SubsurfacePlane, at: JsonPath<'_>, faults: &mut Faults) -> Option<Places> {
        match plane.z {
            Some([from, ..]) => check_depth(from, at.member("z").index(0), faults),
            None if plane.normal == Direction::Z => check_depth(plane.offset, at.member("offset"), faults),
            None => {}
        }
        let all = [(Direction::X, plane.x), (Direction::Y, plane.y), (Direction::Z, plane.z)];
        let [x, y, z] = all.map(|(direction, given)| {
            let place = at.member(direction.name());
            match (direction == plane.normal, given) {
                (true, None) => Some(Steps::single(plane.offset)),
                (true, Some(_)) => faults.refuse(place, "is constant, and given by `offset`: leave this out"),
                (false, None) => faults.refuse(place, "give `[from, to, count]`"),
                (false, Some(given)) => Steps::read(given, place, faults),
            }
        });
        Places::grid([x?, y?, z?], at, faults)
    }

    fn surface(surface: &SubsurfaceSurface, at: JsonPath<'_>, faults: &mut Faults) -> Option<Places> {
        let x = Steps::read(surface.x, at.member("x"), faults);
        let y = Steps::read(surface.y, at.member("y"), faults);
        Places::grid([x?, y?, Steps::single(0.0)], at, faults)
    }

    fn grid(steps: [Steps; 3], at: JsonPath<'_>, faults: &mut Faults) -> Option<Places> {
        let count = steps.iter().fold(1_usize, |count, steps| count.saturating_mul(steps.count));
        let most = *SUBSURFACE_POINTS.end();
        if count > most {
            faults.add(at, format_args!("{count} places: at most {most} are allowed"));
        }
        (count <= most).then_some(Places::Grid(steps))
    }

    /// The values along the three axes, if it is a grid.
    pub fn axes(&self) -> Option<[Vec<f64>; 3]> {
        let Places::Grid(steps) = self else { return None };
        Some(steps.map(|steps| (0..steps.count).map(|index| steps.at(index)).collect()))
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        match self {
            Places::Points(points) => points.len(),
            Places::Grid(steps) => steps.iter().map(|steps| steps.count).product(),
            Places::Line(line) => line.count,
        }
    }

    /// The place of this index: x, y, z, m.
    pub fn at(&self, index: usize) -> [f64; 3] {
        match self {
            Places::Points(points) => points[index],
            Places::Grid([x, y, z]) => {
                let (rest, last) = split(index, z.count);
                let (first, middle) = split(rest, y.count);
                [x.at(first), y.at(middle), z.at(last)]
            }
            Places::Line(line) => {
                let share = index as f64 / line.count.saturating_sub(1) as f64;
                std::array::from_fn(|axis| line.from[axis] + (line.to[axis] - line.from[axis]) * share)
            }
        }
    }
}

/// Row and column of an index into rows of so many columns.
fn split(index: usize, columns: usize) -> (usize, usize) {
    (index.checked_div(columns).unwrap_or(0), index.checked_rem(columns).unwrap_or(0))
}

/// Notes a point above the surface.
fn check_depth(z: f64, at: JsonPath<'_>, faults: &mut Faults) {
    if z < 0.0 {
        faults.add(at, format_args!("{z:?} lies above the surface: z is 0 there and grows into the body"));
    }
}
