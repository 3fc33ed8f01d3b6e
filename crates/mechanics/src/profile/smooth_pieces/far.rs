//! What a piece is to far radii: a [`Multipole`] over x^2 from its inner end on, by its power series.

use super::sampled_series::TERMS;
use crate::numerics::multipole::{Multipole, ORDERS};

/// int Y^j P_k dY/4 from -1 to 1, a row for each j: by (2k + 1) Y P_k = (k + 1) P_(k+1) + k P_(k-1). Zero for k > j.
const SMOOTH: [[f64; ORDERS]; TERMS] = {
    let mut rows = [[0.0; ORDERS]; TERMS];
    rows[0][0] = 0.5;
    let mut j = 1;
    while j < TERMS {
        let mut k = j % 2;
        while k <= j {
            let below = if k > 0 { rows[j - 1][k - 1] } else { 0.0 };
            rows[j][k] = ((k + 1) as f64 * rows[j - 1][k + 1] + k as f64 * below) / (2 * k + 1) as f64;
            k += 2;
        }
        j += 1;
    }
    rows
};
/// int t^j P_k(2 t^2 - 1) dt from 0 to 1, a row for each j: with a = (j - 1)/2 the product of a - i for i below k, over
/// that of a + 1 + i for i up to k, halved (Abramowitz & Stegun 1964, 22.13.9).
const KINK: [[f64; ORDERS]; TERMS] = {
    let mut rows = [[0.0; ORDERS]; TERMS];
    let mut j = 0;
    while j < TERMS {
        let a = 0.5 * (j as f64 - 1.0);
        rows[j][0] = 0.5 / (a + 1.0);
        let mut k = 1;
        while k < ORDERS {
            rows[j][k] = rows[j][k - 1] * (a + 1.0 - k as f64) / (a + 1.0 + k as f64);
            k += 1;
        }
        j += 1;
    }
    rows
};

/// That of a smooth piece by the coefficients of q in Y; `gap` is the difference of the squares of its ends.
pub(super) fn of_smooth(series: &[f64], gap: f64) -> Multipole {
    of(series, &SMOOTH, gap, gap)
}

/// That of a piece at a kink by the coefficients of gamma in powers of t over the t where it ends, whose square is
/// `gap`.
pub(super) fn of_kink(series: &[f64], gap: f64) -> Multipole {
    of(series, &KINK, gap, gap.sqrt())
}

fn of(series: &[f64], rows: &[[f64; ORDERS]], gap: f64, unit: f64) -> Multipole {
    let mut far = Multipole::empty((0.0, gap));
    for (c, row) in series.iter().zip(rows) {
        let c = unit * c;
        far.moments.iter_mut().zip(row).for_each(|(moment, share)| *moment += c * share);
    }
    far
}
