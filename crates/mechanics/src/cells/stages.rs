//! Cells as far as contacts have reached: those that serve contacts between two radii whose ratio is four, each built
//! when first asked for.
//!
//! Which stage is taken depends on the radius, level or load alone, not on what was asked before: so results are the
//! same whatever came first.

use std::sync::{Arc, OnceLock};

use super::shape::{Reach, Shape};
use super::{Cells, grid};

/// The octaves of a stage.
const OCTAVES: i32 = 2;
/// The number of the lowest stage, far below every contact, and of the highest, far beyond.
const LOWEST: i32 = -200;
const HIGHEST: i32 = 25;

/// The stages of a shape. A clone shares them, and they take no part in a comparison: they follow from the parameters.
#[derive(Clone)]
pub(crate) struct Stages(Arc<OnceLock<Box<Stage>>>);

/// One of them.
struct Stage {
    number: i32,
    /// The levels, m, between which it serves.
    levels: (f64, f64),
    cells: Cells,
    /// One that was built later.
    next: OnceLock<Box<Stage>>,
}

impl std::fmt::Debug for Stages {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("..")
    }
}

impl PartialEq for Stages {
    fn eq(&self, _: &Stages) -> bool {
        true
    }
}

impl Stages {
    /// Stages of which none is built.
    pub(crate) fn new() -> Stages {
        Stages(Arc::new(OnceLock::new()))
    }

    /// The only one, which serves all contacts.
    pub(crate) fn whole(cells: Cells) -> Stages {
        let levels = (f64::NEG_INFINITY, f64::INFINITY);
        let stage = Stage { number: i32::MAX, levels, cells, next: OnceLock::new() };
        Stages(Arc::new(OnceLock::from(Box::new(stage))))
    }

    /// All cells, where there is but one stage.
    pub(crate) fn everything(&self) -> Option<&Cells> {
        self.0.get().filter(|stage| stage.number == i32::MAX).map(|stage| &stage.cells)
    }

    /// The cells of a shape that reach beyond something, or to its end; `None` once `keep_going` has returned false.
    pub(crate) fn up_to(&self, shape: &dyn Shape, reach: Reach, keep_going: &dyn Fn() -> bool) -> Option<&Cells> {
        if let Some(cells) = self.everything() {
            return Some(cells);
        }
        let last = number(shape.end_radius().next_down());
        match reach {
            Reach::Radius(radius) => self.stage(shape, number(radius).min(last), keep_going),
            Reach::Level(level) => {
                let serves =
                    |stage: &&Stage| stage.levels.0 <= level && (level < stage.levels.1 || stage.number == last);
                if let Some(stage) = self.built().find(serves) {
                    return Some(&stage.cells);
                }
                self.stage(shape, first_above(shape, last, |_| 1.0, level), keep_going)
            }
            Reach::Load(load) => {
                // int x dg is no larger than x g.
                let mut number = first_above(shape, last, |x| x, load);
                loop {
                    let cells = self.stage(shape, number, keep_going)?;
                    if number >= last || load < cells.top.load.value() {
                        return Some(cells);
                    }
                    number += 1;
                }
            }
        }
    }

    fn built(&self) -> impl Iterator<Item = &Stage> {
        std::iter::successors(self.0.get(), |stage| stage.next.get()).map(Box::as_ref)
    }

    fn stage(&self, shape: &dyn Shape, number: i32, keep_going: &dyn Fn() -> bool) -> Option<&Cells> {
        if let Some(stage) = self.built().find(|stage| stage.number == number) {
            return Some(&stage.cells);
        }
        let (low, high) = (start(number), start(number + 1).min(shape.end_radius()));
        let levels = (shape.level(low), shape.level(high));
        let stage =
            Stage { number, levels, cells: grid::cells(shape, (low, high), keep_going)?, next: OnceLock::new() };
        let mut place = &*self.0;
        let mut stage = Box::new(stage);
        // Another thread may have put one there in the meantime, even the same.
        while let Err(mine) = place.set(stage) {
            stage = mine;
            let there = place.get()?;
            if there.number == number {
                return Some(&there.cells);
            }
            place = &there.next;
        }
        place.get().map(|stage| &stage.cells)
    }
}

/// Where a stage starts, m.
fn start(number: i32) -> f64 {
    f64::from(OCTAVES * number).exp2()
}

/// The stage that serves contacts of a radius, m.
fn number(radius: f64) -> i32 {
    let exponent = ((radius.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    exponent.div_euclid(OCTAVES).clamp(LOWEST, HIGHEST)
}

/// The first stage up to `last` at whose end g times a weight exceeds a value.
fn first_above(shape: &dyn Shape, last: i32, weight: impl Fn(f64) -> f64, value: f64) -> i32 {
    let (mut low, mut high) = (LOWEST, last);
    while low < high {
        let middle = low + (high - low) / 2;
        let end = start(middle + 1);
        if weight(end) * shape.level(end) > value { high = middle } else { low = middle + 1 }
    }
    low
}
