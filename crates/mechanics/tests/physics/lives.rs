//! Lives against bisection of the printed formulas, and the Basquin curve of a bar.

use stickslip_mechanics::Stress;
use stickslip_mechanics::fatigue::{Criterion, LIVES, LifeCurve, NoLife, StrainLife};

use crate::support::{Random, cases};

const STEEL: f64 = 2.1e11;
const POISSON: f64 = 0.3;

/// The cycles at which a falling function of them has a value.
fn bisected(value: f64, of_cycles: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (-40.0_f64, 80.0_f64);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if of_cycles(middle.exp()) > value { low = middle } else { high = middle }
    }
    low.exp()
}

fn any_constants(random: &mut Random) -> StrainLife {
    StrainLife {
        strength: 10f64.powf(random.within(8.0, 9.7)),
        strength_exponent: random.within(-0.2, -0.03),
        ductility: 10f64.powf(random.within(-3.0, 0.5)),
        ductility_exponent: random.within(-1.2, -0.3),
    }
}

#[test]
fn lives_are_those_of_the_printed_formulas() {
    let mut random = Random(3);
    for case in 0..cases(300) {
        let constants = any_constants(&mut random);
        let StrainLife { strength, strength_exponent: b, ductility, ductility_exponent: c } = constants;
        let shear_modulus = STEEL / (2.0 * (1.0 + POISSON));
        let swt = |n: f64| {
            strength * strength / STEEL * (2.0 * n).powf(2.0 * b) + strength * ductility * (2.0 * n).powf(b + c)
        };
        let fatemi_socie = |n: f64| strength / shear_modulus * (2.0 * n).powf(b) + ductility * (2.0 * n).powf(c);
        let (reference, cycles, exponent) =
            (random.within(1e8, 5e8), 10f64.powf(random.within(3.0, 8.0)), random.within(3.0, 20.0));
        let s_n = |n: f64| reference * (n / cycles).powf(-1.0 / exponent);
        let of_curve: [(LifeCurve, &dyn Fn(f64) -> f64); 3] = [
            (LifeCurve::smith_watson_topper(&constants, STEEL).unwrap(), &swt),
            (LifeCurve::fatemi_socie(&constants, STEEL, POISSON).unwrap(), &fatemi_socie),
            (LifeCurve::of_stress(reference, cycles, exponent).unwrap(), &s_n),
        ];
        for (curve, of_cycles) in of_curve {
            let wanted = 10f64.powf(random.within(-0.2, 11.9));
            let value = of_cycles(wanted);
            let truth = bisected(value, of_cycles);
            let found = curve.cycles(value).unwrap();
            assert!((found / truth - 1.0).abs() < 1e-10, "case {case}: {found:e} {truth:e} {constants:?}");
            assert!((found / wanted - 1.0).abs() < 1e-10, "case {case}: {found:e} {wanted:e} {constants:?}");
            // The bracket has the life of every value within the error.
            let error = value * 10f64.powf(random.within(-9.0, 0.3));
            let life = curve.life(value, error);
            let other = bisected((value + error * random.within(-1.0, 1.0)).max(1e-300), of_cycles);
            let within = |cycles: f64| {
                cycles >= life.shortest * (1.0 - 1e-9) && life.longest.is_none_or(|most| cycles <= most * (1.0 + 1e-9))
            };
            assert!(life.cycles == Ok(found) && within(found), "case {case}: {life:?}");
            assert!(within(other) || !(LIVES[0]..=LIVES[1]).contains(&other), "case {case}: {other:e} {life:?}");
            // Its ends are the lives of the ends of the error.
            let ends = [value + error, value - error].map(|end| bisected(end.max(1e-300), of_cycles));
            let shortest = if ends[0] < LIVES[0] { 0.0 } else { ends[0] };
            assert!((life.shortest - shortest).abs() <= 1e-9 * shortest, "case {case}: {life:?} {ends:?}");
            assert_eq!(life.longest.is_none(), ends[1] > LIVES[1], "case {case}: {life:?} {ends:?}");
        }
    }
}

#[test]
fn a_bar_and_a_tube_that_stay_elastic_have_the_lives_of_basquin() {
    let constants = StrainLife { strength: 9e8, strength_exponent: -0.09, ductility: 0.0, ductility_exponent: -0.6 };
    let amplitude = 3e8;
    // amplitude = strength (2N)^b.
    let truth = 0.5 * (amplitude / constants.strength).powf(1.0 / constants.strength_exponent);
    let bar = [1.0, -1.0].map(|sign| Stress { xx: sign * amplitude, ..Stress::default() });
    let tube = [1.0, -1.0].map(|sign| Stress { xy: sign * amplitude, ..Stress::default() });
    let (youngs_modulus, poisson) = (STEEL, POISSON);
    let swt = Criterion::SmithWatsonTopper { youngs_modulus, poisson }.of(&bar).value;
    let found = LifeCurve::smith_watson_topper(&constants, STEEL).unwrap().cycles(swt).unwrap();
    assert!((found / truth - 1.0).abs() < 1e-6, "{found:e} {truth:e}");
    let sheared = Criterion::FatemiSocie { k: 0.0, yield_stress: 4e8, youngs_modulus, poisson }.of(&tube).value;
    let found = LifeCurve::fatemi_socie(&constants, STEEL, POISSON).unwrap().cycles(sheared).unwrap();
    assert!((found / truth - 1.0).abs() < 1e-6, "{found:e} {truth:e}");
}

#[test]
fn a_value_without_a_life_says_why() {
    let curve = LifeCurve::of_stress(3e8, 1e6, 5.0).unwrap();
    for (value, error, why, shortest, longest) in [
        (0.0, 0.0, NoLife::NotPositive, LIVES[1], None),
        (-1e8, 4e8, NoLife::NotPositive, 1e6, None),
        (1e6, 0.0, NoLife::TooLong, LIVES[1], None),
        (1e6, 2.99e8, NoLife::TooLong, 1e6, None),
        (1e10, 0.0, NoLife::TooShort, 0.0, Some(LIVES[0])),
        (1e10, 9.7e9, NoLife::TooShort, 0.0, Some(1e6)),
        (f64::INFINITY, 0.0, NoLife::InfiniteStress, 0.0, None),
    ] {
        let life = curve.life(value, error);
        assert_eq!(life.cycles, Err(why), "{value:e}");
        assert!((life.shortest - shortest).abs() <= 1e-9 * shortest, "{value:e}: {life:?}");
        assert!(
            life.longest.is_none() == longest.is_none()
                && life.longest.zip(longest).is_none_or(|(one, other)| (one / other - 1.0).abs() < 1e-9),
            "{value:e}: {life:?}"
        );
    }
    for bad in [(0.0, 1e6, 5.0), (3e8, 0.5, 5.0), (3e8, 1e6, 0.0), (3e8, f64::NAN, 5.0)] {
        assert!(LifeCurve::of_stress(bad.0, bad.1, bad.2).is_err(), "{bad:?}");
    }
    let good = StrainLife { strength: 9e8, strength_exponent: -0.09, ductility: 0.3, ductility_exponent: -0.6 };
    for bad in [
        StrainLife { strength_exponent: 0.0, ..good },
        StrainLife { ductility_exponent: 0.1, ..good },
        StrainLife { ductility: -0.1, ..good },
        StrainLife { strength: 0.0, ..good },
    ] {
        assert!(LifeCurve::smith_watson_topper(&bad, STEEL).is_err(), "{bad:?}");
        assert!(LifeCurve::fatemi_socie(&bad, STEEL, POISSON).is_err(), "{bad:?}");
    }
}
