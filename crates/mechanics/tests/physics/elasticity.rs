//! The reduced moduli of pairs of bodies.

use stickslip_mechanics::{Body, Elasticity};

#[test]
fn like_bodies_have_mindlins_ratio_and_no_coupling() {
    for nu in [0.0, 0.25, 0.3, 0.5] {
        let body = Body::new(2.1e11, nu).unwrap();
        let pair = Elasticity::of_bodies(body, body);
        let ratio = (2.0 - nu) / (2.0 * (1.0 - nu));
        assert!((pair.e_star() / pair.g_star() / ratio - 1.0).abs() < 1e-15);
        assert!(pair.dundurs_beta().unwrap().abs() < 1e-16);
    }
}

#[test]
fn a_very_stiff_partner_is_a_rigid_one() {
    let soft = Body::new(1e6, 0.2).unwrap();
    let stiff = Elasticity::of_bodies(soft, Body::new(1e18, 0.3).unwrap());
    let rigid = Elasticity::against_rigid(soft);
    assert!((stiff.e_star() / rigid.e_star() - 1.0).abs() < 1e-11);
    assert!((stiff.dundurs_beta().unwrap() - rigid.dundurs_beta().unwrap()).abs() < 1e-11);
}
