//! The fewest reversals that leave no more than a given stress.

use std::num::NonZeroUsize;

use super::Design;

/// How many smaller numbers of reversals are checked after bisection.
const FEWER: usize = 3;

/// What [`fewest`] has found.
pub enum Fewest {
    /// The number of reversals, and the design.
    Found(usize, Design),
    /// Not even the largest number suffices: its design.
    OutOfReach(Design),
}

/// The design of the fewest reversals, up to `most`, that leave no more than `largest`, Pa, by doubling and bisection.
///
/// # Errors
/// Those of `design`, which is asked for a number of reversals.
pub fn fewest<E>(
    largest: f64,
    most: NonZeroUsize,
    mut design: impl FnMut(usize) -> Result<Design, E>,
) -> Result<Fewest, E> {
    let most = most.get();
    let (mut low, mut high) = (0, 1);
    let mut found = loop {
        let tried = design(high)?;
        if tried.largest <= largest {
            break tried;
        }
        if high == most {
            return Ok(Fewest::OutOfReach(tried));
        }
        (low, high) = (high, (2 * high).min(most));
    };
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        let tried = design(middle)?;
        if tried.largest <= largest {
            (high, found) = (middle, tried);
        } else {
            low = middle;
        }
    }
    // On some shapes fewer reversals leave less stress: check a few smaller numbers too.
    for fewer in (high.saturating_sub(FEWER).max(1)..high).rev().skip(1) {
        let tried = design(fewer)?;
        if tried.largest <= largest {
            (high, found) = (fewer, tried);
        }
    }
    Ok(Fewest::Found(high, found))
}
