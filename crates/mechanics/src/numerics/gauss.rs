//! Gauss-Legendre rules, and how wide a panel each may cover.
//!
//! A rule of n points errs like rho^(-2n), rho the sum of the half-axes of the largest ellipse about the panel, foci at
//! its ends and half its width the unit, that holds no singularity (Trefethen 2008). Eight points need rho = 10,
//! twelve 4.6 and twenty 2.6 to reach round-off; so the width of a panel follows from how far the integrand's nearest
//! singularities are.

/// Abscissae below one half and their weights, on 0..1; the other half is the mirror image.
type Rule = [(f64, f64)];

const EIGHT: [(f64, f64); 4] = [
    (0.019_855_071_751_231_884, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_64, 0.111_190_517_226_687_24),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_65),
    (0.408_282_678_752_175_1, 0.181_341_891_689_180_98),
];

const TWELVE: [(f64, f64); 6] = [
    (0.009_219_682_876_640_375, 0.023_587_668_193_255_914),
    (0.047_941_371_814_762_57, 0.053_469_662_997_659_21),
    (0.115_048_662_902_847_65, 0.080_039_164_271_673_11),
    (0.206_341_022_856_691_3, 0.101_583_713_361_532_96),
    (0.316_084_250_500_909_9, 0.116_746_268_269_177_4),
    (0.437_383_295_744_265_54, 0.124_573_522_906_701_39),
];

/// The rule of eight points over 0..1, in rising order.
pub(crate) const EIGHT_POINTS: [(f64, f64); 8] = both_halves(&EIGHT);
/// The rule of twelve points over 0..1, in rising order.
pub(crate) const TWELVE_POINTS: [(f64, f64); 12] = both_halves(&TWELVE);

/// The rule of twenty points over 0..1, in rising order.
pub(crate) const TWENTY_POINTS: [(f64, f64); 20] = both_halves(&TWENTY);

/// A rule over 0..1 by its lower half.
const fn both_halves<const N: usize>(lower: &Rule) -> [(f64, f64); N] {
    let mut points = [(0.0, 0.0); N];
    let mut index = 0;
    while index < lower.len() {
        let (at, weight) = lower[index];
        points[index] = (at, weight);
        points[N - 1 - index] = (1.0 - at, weight);
        index += 1;
    }
    points
}

const TWENTY: [(f64, f64); 10] = [
    (0.003_435_700_407_452_537_6, 0.008_807_003_569_576_059),
    (0.018_014_036_361_043_105, 0.020_300_714_900_193_47),
    (0.043_882_785_874_337_05, 0.031_336_024_167_054_536),
    (0.080_441_514_088_890_6, 0.041_638_370_788_352_37),
    (0.126_834_046_769_924_6, 0.050_965_059_908_620_22),
    (0.181_973_159_636_742_5, 0.059_097_265_980_759_21),
    (0.244_566_499_024_586_46, 0.065_844_319_224_588_32),
    (0.313_146_955_642_290_2, 0.071_048_054_659_191_02),
    (0.386_107_074_429_177_44, 0.074_586_493_236_301_87),
    (0.461_736_739_433_251_35, 0.076_376_693_565_362_93),
];

/// The integrals over 0..1 of a function and of its square, by its values at the points of a rule.
pub(crate) fn first_and_second<const N: usize>(rule: &[(f64, f64); N], values: [f64; N]) -> (f64, f64) {
    rule.iter()
        .zip(values)
        .fold((0.0, 0.0), |(first, second), (&(_, weight), h)| (first + weight * h, second + weight * h * h))
}

/// A stretch below the top of what is still to be integrated: its width and the rule for it.
#[derive(Clone, Copy)]
pub(crate) struct QuadraturePanel {
    pub(crate) width: f64,
    rule: &'static Rule,
}

impl QuadraturePanel {
    /// A panel by the shorter rule, whatever the integrand.
    pub(crate) fn coarse(width: f64) -> QuadraturePanel {
        QuadraturePanel { width, rule: &EIGHT }
    }

    /// A panel by the longer rule, for an integrand analytic far around.
    pub(crate) fn fine(width: f64) -> QuadraturePanel {
        QuadraturePanel { width, rule: &TWENTY }
    }

    /// The same panel by a rule that is long enough for an integrand whose derivative of any order m is at most
    /// `growth`^m of itself, over the width: what Gauss's remainder leaves of it is round-off.
    ///
    /// That remainder is f^(2n) (n!)^4/((2n + 1) ((2n)!)^3) for n points (Abramowitz & Stegun 1964, 25.4.29): twelve
    /// points follow a growth of eight, twenty one of twenty-four. A panel as wide as the singularities
    /// allow leaves its rule nothing to spare for the growth, so that it gets the next longer one.
    pub(crate) fn following(self, growth: f64) -> QuadraturePanel {
        let rule: &Rule = if growth <= 1.0 {
            self.rule
        } else if growth <= 8.0 && self.rule.len() == EIGHT.len() {
            &TWELVE
        } else {
            &TWENTY
        };
        QuadraturePanel { rule, ..self }
    }

    /// Calls `visit(distance below the panel's top, weight)` at every abscissa; the weights add up to the width.
    pub(crate) fn visit(&self, mut visit: impl FnMut(f64, f64)) {
        for &(u, weight) in self.rule {
            visit(self.width * u, self.width * weight);
            visit(self.width * (1.0 - u), self.width * weight);
        }
    }

    /// The abscissae from the panel's top on, with their weights.
    pub(crate) fn nodes(self) -> impl Iterator<Item = (f64, f64)> {
        let lower = self.rule.iter().map(|&(u, weight)| (u, weight));
        let upper = self.rule.iter().rev().map(|&(u, weight)| (1.0 - u, weight));
        lower.chain(upper).map(move |(u, weight)| (self.width * u, self.width * weight))
    }
}

/// Where an integrand fails to be analytic, seen from the axis of integration.
#[derive(Clone, Copy)]
pub(crate) struct Singular {
    /// It is singular at zero plus and minus this times i.
    pub(crate) below: f64,
    /// It is singular at this point of the axis, above the panels.
    pub(crate) above: f64,
}

impl Singular {
    /// The panel that hangs from `top` and covers `left`, or what can be covered of it.
    pub(crate) fn panel(&self, top: f64, left: f64) -> QuadraturePanel {
        if top <= 0.0 {
            // Only rounding leads here.
            return QuadraturePanel { width: left, rule: &EIGHT };
        }
        let bottom = (top - left).max(0.0);
        let foci = (bottom * bottom + self.below * self.below).sqrt() + (top * top + self.below * self.below).sqrt();
        // Rounding may put the top on the singularity; the panels must get off it.
        let room = (self.above - top).max(1e-9 * top);
        if foci >= 5.05 * left && left <= 0.5 * room {
            return QuadraturePanel { width: left, rule: &EIGHT };
        }
        if foci >= 2.45 * left && left <= 1.4 * room {
            return QuadraturePanel { width: left, rule: &TWELVE };
        }
        let width = if foci >= 1.5 * left { left } else { left.min(0.8 * top) };
        QuadraturePanel { width: width.min(4.0 * room), rule: &TWENTY }
    }
}

/// int_0^length f(s) ds for an f analytic wherever |Im s| < pi/2 and, on the real axis, up to `room` beyond s = 0, with
/// no faster change than by a factor e over `scale`. It ends early when the panels, taken from s = 0, no longer count:
/// give first the end where f is large.
pub(crate) fn along_strip(length: f64, scale: f64, room: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let widest = (8.0 * scale).min(3.0);
    let room = room.max(1e-9);
    let (mut total, mut done) = (0.0, 0.0);
    while done < length {
        let left = length - done;
        let width = left.min(widest).min(4.0 * (room + done));
        let within = |share: f64| width <= share && width <= 3.0 * share * scale && width <= share * (room + done);
        let rule: &Rule = if within(0.6) {
            &EIGHT
        } else if within(1.4) {
            &TWELVE
        } else {
            &TWENTY
        };
        let mut part = 0.0;
        QuadraturePanel { width, rule }.visit(|s, weight| part += weight * f(done + s));
        total += part;
        if part.abs() * left < 1e-18 * total.abs() * width {
            break;
        }
        done += width;
    }
    total
}

#[cfg(test)]
mod tests {
    use super::{Singular, along_strip};

    #[test]
    fn a_panel_as_wide_as_allowed_reaches_round_off() {
        // int_0^1 dt / (0.9^2 + t^2), singular at +-0.9i.
        let singular = Singular { below: 0.9, above: f64::INFINITY };
        let (mut total, mut done) = (0.0, 0.0);
        while done < 1.0 {
            let panel = singular.panel(1.0 - done, 1.0 - done);
            panel.visit(|t, weight| total += weight / (0.81 + (1.0 - done - t).powi(2)));
            done += panel.width;
        }
        assert!((total - (1.0f64 / 0.9).atan() / 0.9).abs() < 4e-16);
    }

    #[test]
    fn a_strip_of_any_length() {
        for length in [1e-9f64, 0.5, 2.9, 7.0, 40.0] {
            let exact = 2.0 * (0.5 * length).tanh().atan();
            let ours = along_strip(length, 1.0, f64::INFINITY, |s| 1.0 / s.cosh());
            assert!((ours / exact - 1.0).abs() < 1e-15, "{length}: {ours} {exact}");
        }
    }
}
