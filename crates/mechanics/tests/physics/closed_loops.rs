//! The stick radius where loops close exactly: that of the last move itself, point by point in whole numbers.

use crate::support::{PLAIN, UNIT, config, displace, press};
use proptest::prelude::*;
use stickslip_mechanics::profile::Sphere;
use stickslip_mechanics::{Contact, Elasticity, Preload, Profile, Regime, Setup, Springs};

/// Points from the centre to the indentation of the preload. Turning points lie between them, on even multiples of
/// half their distance.
const POINTS: i64 = 64;
/// Targets are multiples of this many halves of the distance: few enough that paths meet their turning points often.
const STEP: i64 = 16;

/// One straight move along an axis, in steps.
#[derive(Clone, Copy, Debug)]
enum Along {
    Slide(i64),
    Press(i64),
}

/// Points that follow the friction law on their own: level, displacement and bound are whole numbers of half the
/// distance of two points.
struct Row {
    depth: i64,
    slide: i64,
    carried: Vec<i64>,
}

impl Row {
    fn new() -> Row {
        Row { depth: 2 * POINTS, slide: 0, carried: vec![0; 2 * POINTS as usize] }
    }

    fn level(index: usize) -> i64 {
        2 * index as i64 + 1
    }

    /// Moves every point, and returns the innermost level that slips; `None` if none does.
    fn go(&mut self, step: Along) -> Option<i64> {
        let (depth, slide) = match step {
            Along::Slide(target) => (self.depth, target * STEP),
            Along::Press(target) => (target * STEP, self.slide),
        };
        let mut innermost = None;
        for (index, carried) in self.carried.iter_mut().enumerate() {
            let bound = depth - Row::level(index);
            // A point out of contact carries nothing, and one that is touched on the way has not moved.
            let before = if Row::level(index) < self.depth { *carried } else { 0 };
            let trial = before + slide - self.slide;
            *carried = if bound < 0 { 0 } else { trial.clamp(-bound, bound) };
            if bound > 0 && trial.abs() > bound && innermost.is_none() {
                innermost = Some(Row::level(index) - 1);
            }
        }
        (self.depth, self.slide) = (depth, slide);
        innermost
    }
}

fn steps() -> impl Strategy<Value = Vec<Along>> {
    let most = 2 * POINTS / STEP;
    let step = prop_oneof![
        4 => (-most..=most).prop_map(Along::Slide),
        1 => (1..=2 * most).prop_map(Along::Press),
    ];
    prop::collection::vec(step, 1..24)
}

proptest! {
    #![proptest_config(config(2000))]

    #[test]
    fn the_stick_radius_is_that_of_the_last_move_whatever_loop_it_closes(path in steps()) {
        let whole = (2 * POINTS) as f64;
        let (mut row, mut contact) = (Row::new(), UNIT.contact());
        for step in path {
            let expected = row.go(step);
            contact.apply(&match step {
                Along::Slide(target) => displace((target * STEP) as f64 / whole),
                Along::Press(target) => press((target * STEP) as f64 / whole),
            }).unwrap();
            let state = contact.state();
            let regime = match expected {
                None => Regime::Stick,
                Some(0) => Regime::GrossSlip,
                Some(_) => Regime::PartialSlip,
            };
            prop_assert_eq!(state.regime, regime, "{:?} to {:?}", row.depth, step);
            let level = expected.unwrap_or(row.depth) as f64 / whole;
            let off = (state.stick_radius * state.stick_radius - level).abs();
            prop_assert!(off < 1e-15, "{} to {step:?}: {} is not {level}", row.depth, state.stick_radius);
        }
    }
}

proptest! {
    #![proptest_config(config(200))]

    #[test]
    fn springs_stick_where_the_last_move_leaves_them_within_a_cell(
        path in prop::collection::vec(-2 * POINTS / STEP..=2 * POINTS / STEP, 1..24)
    ) {
        const COUNT: usize = 300;
        // Numbers that are not round, so that a spring comes back to its bound but for its last digits.
        let full = PLAIN.full_slip();
        let (mut row, mut springs) = (Row::new(), Springs::new(PLAIN.setup(), COUNT, PLAIN.radius).unwrap());
        for target in path {
            let expected = row.go(Along::Slide(target));
            springs.apply(&displace((target * STEP) as f64 / (2 * POINTS) as f64 * full)).unwrap();
            let state = springs.state();
            let regime = match expected {
                None => Regime::Stick,
                Some(0) => Regime::GrossSlip,
                Some(_) => Regime::PartialSlip,
            };
            prop_assert_eq!(state.regime, regime, "to {}", target);
            let radius = (expected.unwrap_or(row.depth) as f64 / (2 * POINTS) as f64).sqrt();
            let off = (state.stick_radius / state.contact_radius - radius).abs();
            prop_assert!(off <= 2.0 / COUNT as f64, "to {target}: {} is not {radius}", state.stick_radius);
        }
    }
}

#[test]
fn a_loop_that_closes_exactly_slips_no_further_in_than_its_last_move() {
    let setup = Setup {
        profile: Profile::Sphere(Sphere::new(0.01).unwrap()),
        elasticity: Elasticity::effective(1e11, 8e10).unwrap(),
        friction: 0.3,
        preload: Preload::Indentation(1e-6),
    };
    for (turns, expected) in [
        // The last move is one of 0.3 u_max: c^2/a^2 = 1 - 0.3/2; the turn at 0.2 u_max before it is wiped out.
        (&[0.8, 0.2, 0.5, 0.2][..], 0.85_f64),
        (&[1.0, 0.5, 1.0], 0.75),
        (&[0.8, 0.2, 0.5, 0.2, 0.8], 0.7),
        (&[0.6, -0.6, 0.6], 0.4),
    ] {
        let mut contact = Contact::new(setup.clone()).unwrap();
        let full = contact.gross_slip_displacement();
        for turn in turns {
            contact.apply(&displace(turn * full)).unwrap();
        }
        let state = contact.state();
        assert_eq!(state.regime, Regime::PartialSlip, "{turns:?}");
        let found = state.stick_radius / state.contact_radius;
        assert!((found - expected.sqrt()).abs() < 1e-15, "{turns:?}: {found}");
        // And so it is in a contact that has been stored.
        let back = contact.virgin().unpack(&contact.pack()).unwrap();
        assert_eq!(back.state(), state);
    }
}
