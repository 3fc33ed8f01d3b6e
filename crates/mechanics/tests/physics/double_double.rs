//! Numbers with twice the digits of a double.

use stickslip_mechanics::DoubleDouble;

#[test]
fn a_third_times_three_is_one_to_thirty_digits() {
    let third = DoubleDouble::from(1.0).over(DoubleDouble::from(3.0));
    let rest = third * 3.0 - DoubleDouble::from(1.0);
    assert!(rest.value().abs() < 1e-31);
    assert!((third.value() * 3.0 - 1.0 + third.parts().1 * 3.0).abs() < 1e-16);
}

#[test]
fn small_differences_survive() {
    let near = DoubleDouble::from(1.0) - DoubleDouble::from(1e-25);
    assert!(((DoubleDouble::from(1.0) - near).value() - 1e-25).abs() < 1e-40);
}

#[test]
fn the_root_of_two_squares_back() {
    let root = DoubleDouble::from(2.0).sqrt();
    assert!((root * root - DoubleDouble::from(2.0)).value().abs() < 1e-30);
}
