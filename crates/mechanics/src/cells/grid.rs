//! The cells of a shape, by its gamma above each of its kinks.
//!
//! Above a kink k, with s the distance in t = sqrt(x^2 - k^2) of the next singularity beneath it, one cell up to 0.6 s
//! has twenty-four Chebyshev points: the ellipse about it through +-i s has rho = 7.1, and as many terms leave 1e-20.
//! From there on each cell is half as wide in x^2 as it is far from k^2: the singularity lies two widths below it, rho
//! = 9.9, and sixteen points leave 1e-16. Where the next kink is no further than 1.1 s, one cell reaches it: rho = 4.2,
//! and 1e-15. A cell whose last terms are more than rounding is halved, however it came to be too wide: where g grows
//! steeply, or beside a singularity above.
//!
//! At a tip where g is an uneven power no cell has a series, and where it is a steep one few points do. What lies so
//! near to it that the difference is rounding is taken for a cone, or for a parabola, with the right end.

use super::shape::{Kink, Powers, Shape};
use super::{Cell, Cells};
use crate::numerics::chebyshev::{Points, SIXTEEN, TWENTY_FOUR, counted};
use crate::numerics::double_double::DoubleDouble;

/// The part of the distance to the next singularity that a cell above a kink covers, and the most that it does where it
/// reaches the next kink.
const KINK: f64 = 0.6;
const WIDEST: f64 = 1.1;
/// The width of a cell over its distance from the kink beneath, in squares.
pub(crate) const GROWTH: f64 = 0.5;
/// The share of the largest term up to which the last terms of a series are left out.
const NEGLIGIBLE: f64 = 1e-16;
/// The share of the largest term up to which the last terms of a series are rounding.
const RESOLVED: f64 = 5e-16;
/// The differences of values, over the largest, that rounding makes of a constant.
const CONSTANT: f64 = 1e-15;
/// Halving that makes the last terms smaller by less than this factor meets the rounding of gamma.
const GAIN: f64 = 4.0;
/// How many times more gamma may grow in the outer half of a cell than in its inner half so that rules of twelve points
/// follow the square of its integral, in t and in squares, and the share of gamma from which on this counts.
const STEEP: f64 = 40.0;
const STEEP_IN_SQUARES: f64 = 8.0;
const WEAK: f64 = 1e-6;
/// The order of a series in t from which on these rules do not follow, and the share that may be left there.
const FOLLOWED: usize = 11;
const UNFOLLOWED: f64 = 1e-7;
/// The least whole power of a tip that is steeper.
const STEEPEST: usize = 6;
/// A cell narrower than this share of its square is not worth its border.
const NARROWEST: f64 = 1e-13;
/// The least radius of the first cell at an uneven tip over that of the least contact, and the share of g that may go
/// wrong below it.
const TIP: f64 = 1e-18;
/// Cells between two questions whether to go on.
const BETWEEN_QUESTIONS: usize = 64;

/// A series that fits gamma over a cell, and how large its last terms are over what counts.
struct Fit {
    terms: Vec<f64>,
    left: f64,
    /// Whether gamma grows so fast that rules of a few points would not follow it.
    steep: bool,
}

/// What a cell is made of: the shape and the kink beneath.
struct Above<'a> {
    shape: &'a dyn Shape,
    kink: Kink,
    base: DoubleDouble,
}

/// The cells of a shape up to a radius `end`, m, of contacts from the radius `start`, m, on; `None` once `keep_going`
/// has returned false.
pub(super) fn cells(shape: &dyn Shape, (start, end): (f64, f64), keep_going: &dyn Fn() -> bool) -> Option<Cells> {
    let kinks = shape.kinks();
    let (mut cells, end) = (Vec::new(), DoubleDouble::square_of(end));
    for (index, &kink) in kinks.iter().enumerate() {
        let base = kink.at.square;
        let next = kinks.get(index + 1).map(|next| next.at.square);
        let top = next.filter(|next| *next < end).unwrap_or(end);
        if top <= base {
            break;
        }
        let whole = (top - base).value();
        let fits = |width: f64| if whole - width > NARROWEST * top.value() { width } else { whole };
        let above = Above { shape, kink, base };
        let power = match kink.powers {
            Powers::Uneven(power) => Some(power),
            Powers::All(power) if power >= STEEPEST => Some((power + 1) as f64),
            _ => None,
        };
        let mut reached = if let Some(power) = power {
            let core = start * tip(power);
            let width = fits(core * core);
            let level = shape.level(width.sqrt());
            if power < 2.0 {
                let slope = level / width.sqrt();
                // At the centre, where that of the cone is infinite, the kernel of the power n is n/(n - 1) slopes.
                let most = if power > 1.0 { slope * power / (power - 1.0) } else { f64::INFINITY };
                cells.push(Cell::tip(width.sqrt(), &[slope], most));
            } else {
                cells.push(Cell::tip(width.sqrt(), &[0.0, 2.0 * level / width.sqrt()], f64::INFINITY));
            }
            width
        } else {
            let singular = if let Some(below) = index.checked_sub(1) {
                (base - kinks[below].at.square).value()
            } else if kink.at.radius > 0.0 {
                base.value()
            } else {
                f64::INFINITY
            };
            let (cell, width) = above.first(fits(first_width(whole, singular)));
            cells.push(cell);
            width
        };
        while whole - reached > 0.0 {
            if cells.len() % BETWEEN_QUESTIONS == 0 && !keep_going() {
                return None;
            }
            let (cell, next) = above.further(reached, fits(reached + GROWTH * reached) - reached);
            if !cell.depth.is_finite() {
                // No contact is so large.
                return Some(Cells::new(cells, None));
            }
            cells.push(cell);
            reached = fits(next);
        }
        if !keep_going() {
            return None;
        }
    }
    Some(Cells::new(cells, Some(end)))
}

/// How wide the cell above a kink may be, in squares, m^2, of the whole up to the next one, for a singularity beneath
/// at this distance in squares.
pub(crate) fn first_width(whole: f64, singular: f64) -> f64 {
    if whole <= WIDEST * WIDEST * singular { whole } else { KINK * KINK * singular }
}

/// The radius of what stands for an uneven tip over that of the least contact.
fn tip(power: f64) -> f64 {
    if power > 1.0 { f64::EPSILON.powf((power - 1.0).recip()).clamp(TIP, 0.5) } else { TIP }
}

impl Above<'_> {
    /// The cell above the kink, and its width in squares, m^2, at most this.
    fn first(&self, widest: f64) -> (Cell, f64) {
        let fit = |width: f64| {
            let high = width.sqrt();
            match self.kink.powers {
                Powers::All(power) => {
                    let power = power as i32;
                    self.fit(&TWENTY_FOUR, |u| (high * u, u.powi(power)))
                }
                _ => self.fit(&TWENTY_FOUR, |u| (high * u.sqrt(), u.sqrt())),
            }
        };
        let (Fit { terms, .. }, width) = narrowed(widest, fit);
        (Cell::new(self.kink.at.radius, self.base, width.sqrt(), &terms, self.kink.powers), width)
    }

    /// The cell whose inner end lies `below` beyond the kink, in squares, m^2, at most so wide, and where it ends.
    fn further(&self, below: f64, widest: f64) -> (Cell, f64) {
        let fit = |width: f64| {
            self.fit(&SIXTEEN, |u| {
                let t = (below + width * u).sqrt();
                (t, t / width.sqrt())
            })
        };
        let (Fit { terms, .. }, width) = narrowed(widest, fit);
        let square = self.base + DoubleDouble::from(below);
        (Cell::new(self.kink.at.radius, square, width.sqrt(), &terms, Powers::Odd), below + width)
    }

    /// The series over 0..1 of gamma over a divisor; a place gives t, m, and the divisor.
    fn fit<const N: usize>(&self, points: &Points<N>, place: impl Fn(f64) -> (f64, f64)) -> Fit {
        let places = points.places(0.0, 1.0).map(place);
        let gammas = places.map(|(t, _)| self.shape.gamma(self.kink.at.radius, t));
        let largest = gammas.iter().fold(0.0_f64, |largest, gamma| largest.max(gamma.abs()));
        let values: [f64; N] = std::array::from_fn(|lane| gammas[lane] / places[lane].1);
        let (least, most) = values.iter().fold((f64::MAX, f64::MIN), |(a, b), &value| (a.min(value), b.max(value)));
        if most - least <= CONSTANT * most {
            return Fit { terms: vec![0.5 * (least + most)], left: 0.0, steep: false };
        }
        let terms = points.terms(&values);
        let size = terms.iter().fold(0.0_f64, |size, term| size.max(term.abs()));
        let left = terms[N - 2..].iter().fold(0.0_f64, |left, term| left.max(term.abs()));
        let left = if size > 0.0 { left / size } else { 0.0 };
        let (outer, inner) = (gammas[0] - gammas[N / 2], gammas[N / 2] - gammas[N - 1]);
        let grows = |times: f64| outer > times * inner.abs() && outer > WEAK * largest;
        let steep = if N > 16 && self.kink.powers != Powers::Odd {
            grows(STEEP) || terms[FOLLOWED].abs() > UNFOLLOWED * size
        } else {
            grows(STEEP_IN_SQUARES)
        };
        let steep = steep || !largest.is_finite();
        Fit { terms: counted(&terms, NEGLIGIBLE).to_vec(), left, steep }
    }
}

/// The fit over the widest cell that leaves rounding, each half as wide as the one before, and its width.
fn narrowed(widest: f64, fit: impl Fn(f64) -> Fit) -> (Fit, f64) {
    let (mut width, mut best) = (widest, fit(widest));
    while (best.steep || best.left > RESOLVED) && width > NARROWEST * widest {
        let next = fit(0.5 * width);
        if !best.steep && next.left * GAIN > best.left {
            break;
        }
        (width, best) = (0.5 * width, next);
    }
    (best, width)
}
