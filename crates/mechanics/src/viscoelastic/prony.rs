//! The relaxation of a body: R(t) = 1 - sum g_i (1 - exp(-t/T_i)).
//!
//! A spring of instantaneous stiffness 1 carries p = w - sum g_i v_i under the deflection w, and each v_i follows w:
//! v_i' = (w - v_i)/T_i. So s = sum g_i v_i is the deflection that it would keep if it were let go at once. A free
//! spring (w = s) relaxes in as many modes as there are terms: the retardation times of the same material. The matrix
//! of these is made symmetric by the scale sqrt(g_i T_i), and a mode of the rate k is v_i ~ 1/(1 - k T_i) with 1 = sum
//! g_i/(1 - k T_i).

use crate::range;
use crate::range::Quantity;
use crate::range::error::Error;

/// The most terms of a series.
pub const MOST_TERMS: usize = 16;
/// Times closer together than this are one, relative: the error is of the square of it.
const SAME_TIME: f64 = 1e-4;

/// One term of a Prony series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PronyTerm {
    /// By how much of the instantaneous modulus it relaxes, a pure number.
    pub ratio: f64,
    /// Its relaxation time, s.
    pub time: f64,
}

/// A Prony series: how the moduli of the bodies relax from their instantaneous values.
#[derive(Clone, Debug, PartialEq)]
pub struct Prony {
    /// From the shortest time on, no two the same.
    pub(super) terms: Vec<PronyTerm>,
    pub(super) modes: Vec<Mode>,
}

/// Bodies without a memory.
pub(crate) static ELASTIC: Prony = Prony { terms: Vec::new(), modes: Vec::new() };

/// A mode in which a free spring relaxes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mode {
    /// 1/s; zero for the flow of a fluid.
    rate: f64,
    /// From the v_i to its amplitude, and back.
    pub(super) of: [f64; MOST_TERMS],
    pub(super) to: [f64; MOST_TERMS],
}

/// ```
/// use stickslip_mechanics::{Prony, PronyTerm};
///
/// let rubber = Prony::new(&[PronyTerm { ratio: 0.5, time: 1.0 }, PronyTerm { ratio: 0.2, time: 0.1 }])?;
/// assert!((rubber.relaxed() - 0.3).abs() < 1e-15 && !rubber.is_fluid());
/// assert!((rubber.relaxation(0.1) - (0.3 + 0.5 * (-0.1_f64).exp() + 0.2 * (-1.0_f64).exp())).abs() < 1e-15);
/// assert!(Prony::new(&[PronyTerm { ratio: 1.1, time: 1.0 }]).is_err() && Prony::new(&[]).is_err());
/// # Ok::<(), stickslip_mechanics::Error>(())
/// ```
impl Prony {
    /// A series of 1 to [`MOST_TERMS`] terms, whose ratios add up to 1 at most.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::PRONY_RATIO`] and [`range::PRONY_TIME`], for the number of terms, and for the
    /// sum of the ratios.
    pub fn new(terms: &[PronyTerm]) -> Result<Prony, Error> {
        range::PRONY_TERMS.check(terms.len() as f64)?;
        let mut sorted = Vec::with_capacity(terms.len());
        for term in terms {
            range::PRONY_RATIO.check(term.ratio)?;
            range::PRONY_TIME.check(term.time)?;
            sorted.push(*term);
        }
        let sum: f64 = terms.iter().map(|term| term.ratio).sum();
        if sum > 1.0 + 1e-12 {
            let allowed = "a sum of at most 1 over all terms".to_owned();
            return Err(Error::OutOfRange { quantity: Quantity::PronyRatio, value: sum, allowed });
        }
        sorted.sort_by(|one, other| one.time.total_cmp(&other.time));
        let mut terms: Vec<PronyTerm> = Vec::with_capacity(sorted.len());
        for term in sorted {
            match terms.last_mut() {
                Some(last) if term.time - last.time <= SAME_TIME * last.time => {
                    let ratio = last.ratio + term.ratio;
                    last.time = (last.ratio * last.time + term.ratio * term.time) / ratio;
                    last.ratio = ratio;
                }
                _ => terms.push(term),
            }
        }
        let modes = (0..terms.len()).map(|index| mode(&terms, index)).collect();
        Ok(Prony { terms, modes })
    }

    /// Its terms, from the shortest time on.
    #[must_use]
    pub fn terms(&self) -> &[PronyTerm] {
        &self.terms
    }

    /// The relaxed modulus over the instantaneous one.
    #[must_use]
    pub fn relaxed(&self) -> f64 {
        let left = 1.0 - self.terms.iter().map(|term| term.ratio).sum::<f64>();
        if left < 1e-12 { 0.0 } else { left }
    }

    /// Whether it relaxes to nothing, so that it flows under a load.
    #[must_use]
    pub fn is_fluid(&self) -> bool {
        self.relaxed() <= 0.0
    }

    /// R(t), the modulus after a time, s, over the instantaneous one.
    #[must_use]
    pub fn relaxation(&self, time: f64) -> f64 {
        self.relaxed() + self.terms.iter().map(|term| term.ratio * (-time / term.time).exp()).sum::<f64>()
    }

    /// Twice the energy of a spring: w^2 without the share of the terms, and that of each.
    pub(crate) fn energy(&self, v: &[f64], w: f64) -> f64 {
        let terms = self.terms.iter().zip(v).map(|(term, v)| term.ratio * (w - v) * (w - v));
        self.relaxed() * w * w + terms.sum::<f64>()
    }

    /// The shortest of its times, s.
    pub(crate) fn shortest_time(&self) -> f64 {
        self.terms[0].time
    }
}

impl Mode {
    /// What is left of it after a time, s.
    pub(super) fn left(&self, time: f64) -> f64 {
        (-self.rate * time).exp()
    }
}

/// The mode whose retardation time is the next above the time of a term.
fn mode(terms: &[PronyTerm], index: usize) -> Mode {
    let (pole, next) = (terms[index].time, terms.get(index + 1).map(|term| term.time));
    // In D = retardation time - T_index, so that the distance from the pole keeps its digits.
    let excess = |distance: f64| {
        let tau = pole + distance;
        1.0 - terms.iter().map(|term| term.ratio * tau / ((pole - term.time) + distance)).sum::<f64>()
    };
    let left = 1.0 - terms.iter().map(|term| term.ratio).sum::<f64>();
    let endless = next.is_none() && left < 1e-12;
    let [mut low, mut high] = [0.0, next.map_or(f64::MAX, |next| next - pole)];
    if next.is_none() && !endless {
        // 1 - sum g tau/(tau - T) rises to 1 - sum g.
        high = pole;
        while excess(high) < 0.0 && high < 1e300 {
            high *= 2.0;
        }
    }
    if !endless {
        for _ in 0..2000 {
            let middle = if low > 0.0 && high / low > 4.0 { (low * high).sqrt() } else { 0.5 * (low + high) };
            if middle <= low || middle >= high {
                break;
            }
            // It falls to minus infinity towards the pole, and rises from term to term.
            if excess(middle) < 0.0 { low = middle } else { high = middle }
        }
    }
    let distance = 0.5 * (low + high);
    let rate = if endless { 0.0 } else { (pole + distance).recip() };
    let (mut of, mut to, mut square) = ([0.0; MOST_TERMS], [0.0; MOST_TERMS], 0.0);
    for (place, term) in terms.iter().enumerate() {
        // 1 - T_i/tau
        let apart = if endless { 1.0 } else { ((pole - term.time) + distance) * rate };
        let scale = (term.ratio * term.time).sqrt();
        let component = scale / apart;
        square += component * component;
        (of[place], to[place]) = (component * scale, component / scale);
    }
    of.iter_mut().for_each(|of| *of /= square);
    Mode { rate, of, to }
}
