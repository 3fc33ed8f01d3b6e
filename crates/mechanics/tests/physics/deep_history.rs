//! The shear stress of a history of a thousand pieces and more, at many radii at once, against Masing's sum with twice
//! the digits.

use proptest::prelude::any;
use stickslip_mechanics::{DoubleDouble, Move, Tangential};

use super::support::{Random, UNIT, forall};

/// Turning points of falling size, of either sign in turn; each falls by a random share of at most 10^`decade`.
fn turns(count: usize, decade: f64, random: &mut Random) -> Vec<f64> {
    let (mut size, mut sign) = (0.98, 1.0);
    let mut turns = Vec::with_capacity(count);
    for _ in 0..count {
        turns.push(sign * size);
        size *= 1.0 - 10_f64.powf(random.within(decade - 3.0, decade));
        sign = -sign;
    }
    turns
}

/// Masing (1926) on a sphere of radius, indentation and m of one: tau/(G*/pi) = s_n V(1) + sum of (s_(k-1) - s_k)
/// V(y_k), V(y) = 2 sqrt(y - r^2), where slip of the sign s_k began at y_k = 1 - |U_k - U_(k-1)|/2, or 1 - |U_1|.
fn masing(turns: &[f64], r: f64) -> f64 {
    let square = DoubleDouble::square_of(r);
    let v = |level: DoubleDouble| (level - square).sqrt() * 2.0;
    let (mut sum, mut before, mut sign_before) = (DoubleDouble::ZERO, 0.0, 0.0);
    for &turn in turns {
        let way = (DoubleDouble::from(turn) - DoubleDouble::from(before)).abs();
        let half = if before == 0.0 { way } else { way.halved() };
        let sign = turn.signum();
        sum = sum + v(DoubleDouble::from(1.0) - half) * (sign_before - sign);
        (before, sign_before) = (turn, sign);
    }
    (sum + v(DoubleDouble::from(1.0)) * sign_before).value() / std::f64::consts::PI
}

#[test]
fn a_deep_history_has_the_stresses_of_masings_sum_however_its_turning_points_crowd() {
    forall(12, (130..1500_usize, -4.0..-1.5_f64, any::<u64>()), |(count, decade, seed)| {
        let mut random = Random(seed | 1);
        let turns = turns(count, decade, &mut random);
        let mut contact = UNIT.contact();
        for &turn in &turns {
            let step = Move { tangential: Some(Tangential::Displacement(turn)), ..Move::default() };
            contact.apply(&step).unwrap();
        }
        assert_eq!(contact.memory_depth(), count + 1);
        // Places anywhere, and between the turning points wherever they crowd.
        let mut radii: Vec<f64> = (0..60).map(|_| random.within(0.0, 1.0)).collect();
        radii.extend((0..60).map(|_| {
            let turn = turns[(random.within(0.0, count as f64) as usize).min(count - 1)].abs();
            (1.0 - turn * random.within(0.999, 1.001)).abs().sqrt()
        }));
        let unit = contact.summary().unit_shear();
        for (shear, &r) in contact.shears(&radii).into_iter().zip(&radii) {
            let error = (shear - masing(&turns, r)).abs();
            assert!(error <= 1e-14 * unit, "{r}: {shear}, off by {error:e} after {count} turns");
        }
    });
}
