//! Any shape: families, sums, tables, load curves, asperities, ellipsoids and lines, with what is known of each from
//! its document alone.

use stickslip_mechanics::profile::{
    Asperities, Direction, Ellipsoid, Family, LineContact, LoadCurve, Parameter, Sum, Tabulated, families,
};
use stickslip_mechanics::{Body, Elasticity, Error, Indenter, Profile};

use super::draw::Draw;

/// Lengths, m, that parts of a sum have in common, so that flats, rims and kinks meet.
const SHARED: [f64; 4] = [5e-5, 1e-4, 2e-4, 5e-4];

/// A shape.
pub struct Shape {
    pub profile: Profile,
    /// The round profiles that it is the sum of; empty without a surface, and of a line.
    pub parts: Vec<Indenter>,
    /// The radius, m, of the narrowest vertical edge; infinite if there is none.
    pub rim: f64,
    /// The radii, m, at which the slope of the surface jumps.
    pub spikes: Vec<f64>,
    /// The radii, m, at which the surface bends.
    pub kinks: Vec<f64>,
    /// An ordinary indentation, m.
    pub depth: f64,
    /// The length of a line, m.
    pub line: Option<f64>,
    pub elasticity: Elasticity,
}

impl Shape {
    fn of(profile: Profile, depth: f64) -> Shape {
        let elasticity = Elasticity::effective(1.2e11, 1e11).unwrap();
        let (parts, spikes, kinks) = (Vec::new(), Vec::new(), Vec::new());
        Shape { profile, parts, rim: f64::INFINITY, spikes, kinks, depth, line: None, elasticity }
    }

    /// Any shape; an error where the numbers make none.
    pub fn draw(draw: &mut Draw<'_>) -> Result<Shape, Error> {
        match draw.below(16) {
            0..6 => family(draw),
            6..12 => sum(draw),
            12 => table(draw, false),
            13 => without_surface(draw),
            _ => line(draw),
        }
    }

    /// g(x), m, by the closed forms of the parts.
    pub fn level(&self, x: f64) -> f64 {
        self.parts.iter().map(|part| part.level(x)).sum()
    }
}

/// A number of a family about that of its example.
fn number(parameter: &Parameter, draw: &mut Draw<'_>) -> f64 {
    let (shared, index) = (draw.one_of(3), draw.below(SHARED.len()));
    match parameter.name {
        "exponent" => draw.within(0.4, 9.0),
        "flat_radius" | "tip_radius" if shared => SHARED[index],
        "coefficient" => 0.0,
        _ => parameter.example * draw.power(-1.0, 1.0),
    }
}

fn family(draw: &mut Draw<'_>) -> Result<Shape, Error> {
    let key = (draw.unit() * 2.0_f64.powi(32)) as u64;
    // The one whose name and key mix to the most: a new family takes some cases, and leaves the others as they are.
    let mixed = |family: &&&Family| {
        let mix = |sum: u64, byte: u8| (sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3).rotate_left(29);
        family.name.bytes().fold(key.wrapping_mul(0x9E37_79B9_7F4A_7C15), mix)
    };
    let family = families().iter().max_by_key(mixed).expect("there are families");
    let mut numbers: Vec<f64> = family.parameters.iter().map(|parameter| number(parameter, draw)).collect();
    let (shared, whole) = (SHARED[draw.below(SHARED.len())], draw.one_of(3));
    let mut spikes = Vec::new();
    let mut kinks: Vec<f64> = Vec::new();
    match family.name {
        "flat_punch" => numbers[0] = if whole { shared } else { shared * draw.power(-1.0, 1.0) },
        "cone" => spikes.push(0.0),
        "power_law" => {
            numbers[0] = if whole { numbers[0].ceil() } else { numbers[0] };
            numbers[1] = 3e-6 * 1e-4_f64.powf(-numbers[0]) * draw.power(-1.0, 1.0);
            spikes.extend((numbers[0] <= 1.0).then_some(0.0));
        }
        "truncated_cone" | "truncated_sphere" => spikes.push(numbers[1]),
        "rounded_punch" => kinks.push(numbers[0]),
        "rounded_cone" => kinks.push(numbers[1]),
        _ => {}
    }
    kinks.extend(spikes.iter().filter(|&&spike| spike > 0.0));
    let profile = (family.make)(&numbers)?;
    let rim = if family.name == "flat_punch" { numbers[0] } else { f64::INFINITY };
    Ok(Shape { parts: vec![profile.indenter()], rim, spikes, kinks, ..Shape::of(profile, family.indentation) })
}

fn table(draw: &mut Draw<'_>, part: bool) -> Result<Shape, Error> {
    let (count, flat) = (3 + draw.below(10), draw.below(3));
    let (mut slope, mut radii, mut heights) = (0.0, vec![0.0], vec![0.0]);
    for index in 1..count {
        let step = 1e-3 / count as f64 * draw.power(-1.0, 0.0);
        slope += if index <= flat { 0.0 } else { 100.0 * step * draw.power(-1.0, 0.3) };
        // A part of a sum may fall for a while.
        let wave = if part && index > flat { 0.1 * slope * draw.within(-3.0, 1.0) } else { 0.0 };
        radii.push(radii[index - 1] + step);
        heights.push(heights[index - 1] + step * (slope + wave));
    }
    let table = if part { Tabulated::part(&radii, &heights) } else { Tabulated::new(&radii, &heights) }?;
    let profile = Profile::Tabulated(table);
    // Between its points too.
    let kinks = profile.indenter().knots_below(f64::INFINITY);
    Ok(Shape { parts: vec![profile.indenter()], kinks, ..Shape::of(profile, 3e-6) })
}

fn sum(draw: &mut Draw<'_>) -> Result<Shape, Error> {
    let count = 2 + draw.below(3);
    let of = |_| if draw.one_of(6) { table(draw, true) } else { family(draw) };
    let shapes = (0..count).map(of).collect::<Result<Vec<Shape>, Error>>()?;
    let profile = Profile::Sum(Sum::new(shapes.iter().map(|shape| shape.profile.clone()).collect())?);
    let rim = shapes.iter().map(|shape| shape.rim).fold(f64::INFINITY, f64::min);
    let below = |of: fn(&Shape) -> &Vec<f64>| -> Vec<f64> {
        let mut all: Vec<f64> = shapes.iter().flat_map(|shape| of(shape).clone()).filter(|&r| r < rim).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    };
    let (spikes, kinks) = (below(|shape| &shape.spikes), below(|shape| &shape.kinks));
    Ok(Shape {
        parts: shapes.into_iter().flat_map(|shape| shape.parts).collect(),
        rim,
        spikes,
        kinks,
        ..Shape::of(profile, 3e-6)
    })
}

fn without_surface(draw: &mut Draw<'_>) -> Result<Shape, Error> {
    let bodies = Elasticity::of_bodies(Body::new(2e11, 0.3)?, Body::new(7e10, 0.25)?);
    match draw.below(3) {
        0 => {
            let gaps: Vec<f64> = (0..1 + draw.below(6)).map(|_| 2e-6 * draw.unit()).collect();
            Ok(Shape::of(Profile::Asperities(Asperities::new(&[1e-4 * draw.power(-1.0, 1.0)], &gaps)?), 3e-6))
        }
        1 => {
            let (mut depths, mut forces, mut slope) = (vec![0.0], vec![0.0], 0.0);
            for index in 0..2 + draw.below(8) {
                let step = 1e-6 * draw.power(-1.0, 0.0);
                slope += 1e7 * draw.power(-2.0, 0.0);
                depths.push(depths[index] + step);
                forces.push(forces[index] + slope * step);
            }
            let depth = depths[depths.len() - 1];
            Ok(Shape {
                elasticity: bodies,
                ..Shape::of(Profile::LoadCurve(LoadCurve::new(&depths, &forces, &bodies)?), depth)
            })
        }
        _ => {
            let radii = [0.01 * draw.power(-1.0, 1.0), 0.01];
            let direction = if draw.one_of(2) { Direction::X } else { Direction::Y };
            Ok(Shape { elasticity: bodies, ..Shape::of(Profile::Ellipsoid(Ellipsoid::new(radii, direction)?), 3e-6) })
        }
    }
}

fn line(draw: &mut Draw<'_>) -> Result<Shape, Error> {
    let (radius, length) = (0.05 * draw.power(-1.0, 1.0), 0.01 * draw.power(-0.5, 0.5));
    let flat = 5e-4 * draw.power(-1.0, 0.0);
    let pad = draw.one_of(2);
    let line = if pad {
        LineContact::rounded_pad(flat, radius, length, None)?
    } else {
        LineContact::cylinder(radius, length, None)?
    };
    let kinks = if pad { vec![flat] } else { Vec::new() };
    Ok(Shape { kinks, line: Some(length), ..Shape::of(Profile::Line(line), 3e-6) })
}
