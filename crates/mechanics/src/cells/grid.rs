//! The cells of a profile that gives gamma above each of its kinks.
//!
//! Above a kink k, with s the distance in t = sqrt(x^2 - k^2) of the next singularity beneath it, one cell up to 0.6 s
//! has twenty-four Chebyshev points: the ellipse about it through +-i s has rho = 7.1, and as many terms leave 1e-20.
//! From there on each cell is half as wide in x^2 as it is far from k^2: the singularity lies two widths below it, rho
//! = 9.9, and sixteen points leave 1e-16. Where the next kink is no further than 1.1 s, one cell reaches it: rho = 4.2,
//! and 1e-15. No cell is wider than a quarter of its distance from the ceiling.

use super::{Cell, Cells, Powers};
use crate::numerics::chebyshev::{SIXTEEN, TWENTY_FOUR, counted};
use crate::numerics::double_double::DoubleDouble;

/// The part of the distance to the next singularity that a cell above a kink covers, and the most that it does where it
/// reaches the next kink.
const KINK: f64 = 0.6;
const WIDEST: f64 = 1.1;
/// The width of a cell over its distance from the kink beneath, in squares.
const GROWTH: f64 = 0.5;
/// The width of a cell over the distance of its inner end from the ceiling, in squares.
const BELOW_CEILING: f64 = 0.25;
/// The share of the largest below which the last terms of a series are rounding.
const NEGLIGIBLE: f64 = 1e-17;
/// A cell narrower than this share of its square is not worth its border.
const NARROWEST: f64 = 1e-13;

/// Beyond every contact: where the cells of a profile without an end would end, m.
pub(crate) const ENDLESS: f64 = 1e100;

/// Where g is not analytic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Kink {
    /// Radius, m.
    pub(crate) radius: f64,
    /// What gamma is above it.
    pub(crate) powers: Powers,
}

/// The kinks of several profiles added up. A kink within another profile keeps the least power of the two.
pub(crate) fn united(parts: impl Iterator<Item = Vec<Kink>>) -> Vec<Kink> {
    let mut kinks: Vec<Kink> = parts.flatten().collect();
    kinks.sort_by(|a, b| a.radius.total_cmp(&b.radius));
    let mut united: Vec<Kink> = Vec::with_capacity(kinks.len());
    for kink in kinks {
        match united.last_mut() {
            Some(last) if last.radius.to_bits() == kink.radius.to_bits() => last.powers = last.powers.and(kink.powers),
            // What lies beneath goes on as an odd function of zeta.
            Some(_) => united.push(Kink { powers: Powers::All(1).and(kink.powers), ..kink }),
            None => united.push(kink),
        }
    }
    united
}

/// gamma at several t, m, above `base`, m, of what begins at the kink `own`, m, by its gamma above that: zero below it.
pub(crate) fn above<const N: usize>(
    own: f64,
    base: f64,
    t: [f64; N],
    gammas: impl Fn([f64; N]) -> [f64; N],
) -> [f64; N] {
    let further = (base - own) * (base + own);
    if further < 0.0 {
        return [0.0; N];
    }
    if further <= 0.0 {
        return gammas(t);
    }
    let places = t.map(|t| (t * t + further).sqrt());
    let found = gammas(places);
    std::array::from_fn(|lane| found[lane] * (t[lane] / places[lane]))
}

/// A profile between its kinks.
pub(crate) trait Grid {
    /// The kinks from the innermost on, where the surface leaves the plane.
    fn kinks(&self) -> Vec<Kink>;

    /// The radius, m, at which g ceases to be analytic, never reached by a contact.
    fn ceiling(&self) -> f64 {
        f64::INFINITY
    }

    /// gamma = dg/dt at several t = sqrt(x^2 - base^2), m, above `base`, m: one of its kinks, or of those of a sum that
    /// it is a part of.
    fn gammas<const N: usize>(&self, base: f64, t: [f64; N]) -> [f64; N];
}

/// The first `count` cells of a profile from the radius `start`, m, outward, or fewer where they come to its end, whose
/// square, m^2, is given.
pub(crate) fn cells(grid: &impl Grid, start: f64, end: DoubleDouble, count: usize) -> Cells {
    let kinks = grid.kinks();
    let ceiling = grid.ceiling();
    let room = |square: DoubleDouble| {
        let distance = (DoubleDouble::square_of(ceiling) - square).value();
        if ceiling < f64::INFINITY { BELOW_CEILING * distance } else { f64::INFINITY }
    };
    let (mut cells, start): (Vec<Cell>, _) = (Vec::new(), DoubleDouble::square_of(start));
    for (index, kink) in kinks.iter().enumerate() {
        let base = DoubleDouble::square_of(kink.radius);
        let next = kinks.get(index + 1).map(|next| DoubleDouble::square_of(next.radius));
        let top = next.filter(|next| *next < end).unwrap_or(end);
        if top <= base || top <= start {
            continue;
        }
        let whole = (top - base).value();
        let fits = |width: f64| if whole - width > NARROWEST * top.value() { width } else { whole };
        let mut reached = (start - base).value();
        if reached <= 0.0 {
            let singular = if let Some(below) = index.checked_sub(1) {
                (base - DoubleDouble::square_of(kinks[below].radius)).value()
            } else if kink.radius > 0.0 {
                base.value()
            } else {
                f64::INFINITY
            };
            let widest = if whole <= WIDEST * WIDEST * singular { whole } else { fits(KINK * KINK * singular) };
            reached = widest.min(fits(room(base)));
            cells.push(first_cell(grid, kink, base, reached.sqrt()));
        }
        while whole - reached > 0.0 && cells.len() < count {
            let square = base + DoubleDouble::from(reached);
            let next = fits(reached + (GROWTH * reached).min(room(square)));
            cells.push(smooth_cell(grid, kink.radius, square, (reached, next - reached)));
            reached = next;
        }
        if cells.len() >= count {
            break;
        }
    }
    Cells::new(cells)
}

fn first_cell(grid: &impl Grid, kink: &Kink, square: DoubleDouble, high: f64) -> Cell {
    let terms = match kink.powers {
        Powers::All(power) => {
            let t = TWENTY_FOUR.places(0.0, high);
            let gammas = grid.gammas(kink.radius, t);
            TWENTY_FOUR
                .terms(&std::array::from_fn(|lane| gammas[lane] / (0..power).fold(1.0, |unit, _| unit * t[lane])))
        }
        Powers::Odd => {
            let t = TWENTY_FOUR.places(0.0, high * high).map(f64::sqrt);
            let gammas = grid.gammas(kink.radius, t);
            TWENTY_FOUR.terms(&std::array::from_fn(|lane| gammas[lane] / t[lane]))
        }
    };
    Cell::new(kink.radius, square, high, counted(&terms, NEGLIGIBLE), kink.powers)
}

/// A cell above the kink `base`, m, whose inner end lies `below` beyond the kink and that is `width` wide, in squares,
/// m^2.
fn smooth_cell(grid: &impl Grid, base: f64, square: DoubleDouble, (below, width): (f64, f64)) -> Cell {
    let t = SIXTEEN.places(0.0, width).map(|above| (below + above).sqrt());
    let gammas = grid.gammas(base, t);
    let terms = SIXTEEN.terms(&std::array::from_fn(|lane| gammas[lane] / t[lane]));
    Cell::new(base, square, width.sqrt(), counted(&terms, NEGLIGIBLE), Powers::Odd)
}
