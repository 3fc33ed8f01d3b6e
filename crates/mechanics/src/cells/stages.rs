//! Cells as far as contacts have reached: those up to some radius, up to a larger one, and so on, each built when first
//! asked for.
//!
//! The cells of a stage begin those of the next, and which stage is taken depends on the radius, level or load alone,
//! not on what was asked before: so results are the same whatever came first.

use std::sync::{Arc, OnceLock};

use super::Cells;

/// How many stages there are, and the cells in the first, twice as many as which each further one has. The last one has
/// all.
const STAGES: usize = 8;
const FIRST: usize = 8;
/// How much of a level or a load may be rounding.
const ROUNDING: f64 = 1e-9;

/// The stages of a profile. A clone shares them, and they take no part in a comparison: they follow from the
/// parameters.
#[derive(Clone)]
pub(crate) struct Stages(Arc<[OnceLock<Cells>]>);

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
        Stages((0..STAGES).map(|_| OnceLock::new()).collect())
    }

    /// The first stage of which something holds, else the last; `build` makes at most so many cells.
    fn first(&self, build: impl Fn(usize) -> Cells, holds: impl Fn(&Cells) -> bool) -> &Cells {
        let last = self.0.len() - 1;
        for (index, stage) in self.0[..last].iter().enumerate() {
            let cells = stage.get_or_init(|| build(FIRST << index));
            if holds(cells) {
                return cells;
            }
        }
        self.0[last].get_or_init(|| build(usize::MAX))
    }

    /// Cells that reach beyond a radius, m; all of them if none does.
    pub(crate) fn up_to(&self, radius: f64, build: impl Fn(usize) -> Cells) -> &Cells {
        self.first(build, |cells| radius < cells.top.radius)
    }

    /// Cells that reach beyond a level, m.
    pub(crate) fn up_to_level(&self, level: f64, build: impl Fn(usize) -> Cells) -> &Cells {
        self.first(build, |cells| level < (1.0 - ROUNDING) * cells.top.level.value())
    }

    /// Cells that reach beyond a load, m^2.
    pub(crate) fn up_to_load(&self, load: f64, build: impl Fn(usize) -> Cells) -> &Cells {
        self.first(build, |cells| load < (1.0 - ROUNDING) * cells.top.load.value())
    }
}
