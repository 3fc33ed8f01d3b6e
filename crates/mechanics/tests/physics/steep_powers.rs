//! Energies, surface displacement and slip under powers of the radius, against quadratures of their definitions that
//! share nothing with the engine.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

use proptest::prelude::*;
use stickslip_mechanics::profile::{PowerLaw, Sum, TruncatedCone};
use stickslip_mechanics::{Contact, Elasticity, Preload, Profile, Setup};

use crate::subsurface_kinks::gauss;
use crate::support::quadrature::integral;
use crate::support::{config, displace, sphere};

const E_STAR: f64 = 1e11;
const G_STAR: f64 = 8e10;
const FRICTION: f64 = 0.3;

/// kappa of a multiple of one half: kappa(n + 2) = kappa(n) (n + 2)/(n + 1) from kappa(0) = 1, kappa(1/2), kappa(1) =
/// pi/2 and kappa(3/2), kappa(n) = sqrt(pi) Gamma(n/2 + 1)/Gamma((n + 1)/2).
fn kappa(power: f64) -> f64 {
    let mut n = power % 2.0;
    let mut kappa = [1.0, 1.311_028_777_146_059_8, FRAC_PI_2, 1.797_210_352_103_388_4][(2.0 * n) as usize];
    while n < power {
        kappa *= (n + 2.0) / (n + 1.0);
        n += 2.0;
    }
    kappa
}

/// A first loading at constant indentation under g(x) = B x^n + x^2/R.
struct FirstLoading {
    power: f64,
    scale: f64,
    curvature: f64,
    depth: f64,
    position: f64,
    edge: f64,
    stick: f64,
    contact: Contact,
}

/// The radius below `high` at which g has this value.
fn radius_of(g: impl Fn(f64) -> f64, level: f64, high: f64) -> f64 {
    let (mut low, mut high) = (0.0, high);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if g(middle) < level { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

impl FirstLoading {
    /// c r^n, with a sphere of this curvature, 1/m, unless that is zero; `inactive` adds a part that never touches.
    fn new(power: f64, coefficient: f64, curvature: f64, inactive: bool, depth: f64, displacement: f64) -> Self {
        let mut parts = vec![Profile::PowerLaw(PowerLaw::new(power, coefficient).unwrap())];
        if curvature > 0.0 {
            parts.push(sphere(curvature.recip()));
        }
        if inactive {
            parts.push(Profile::TruncatedCone(TruncatedCone::new(0.1, 10.0).unwrap()));
        }
        let profile = if parts.len() == 1 { parts.remove(0) } else { Profile::Sum(Sum::new(parts).unwrap()) };
        let setup = Setup {
            profile,
            elasticity: Elasticity::effective(E_STAR, G_STAR).unwrap(),
            friction: FRICTION,
            preload: Preload::Indentation(depth),
        };
        let mut contact = Contact::new(setup).unwrap();
        contact.apply(&displace(displacement)).unwrap();
        let scale = kappa(power) * coefficient;
        let g = |x: f64| scale * x.powf(power) + curvature * x * x;
        let edge = radius_of(g, depth, 10.0);
        let position = displacement / (FRICTION * E_STAR / G_STAR);
        let stick = radius_of(g, depth - position, edge);
        FirstLoading { power, scale, curvature, depth, position, edge, stick, contact }
    }

    fn g(&self, x: f64) -> f64 {
        self.scale * x.powf(self.power) + self.curvature * x * x
    }

    /// m = mu E*/G*.
    fn ratio() -> f64 {
        FRICTION * E_STAR / G_STAR
    }

    /// 2 G* m^2 int (slip) (bound) dx over the ring that slips, J.
    fn dissipated(&self) -> f64 {
        let work = |x: f64| (self.position - (self.depth - self.g(x))) * (self.depth - self.g(x));
        let size = self.depth * self.depth * self.edge;
        2.0 * G_STAR * Self::ratio().powi(2) * integral(&work, self.stick, self.edge, 1e-17 * size)
    }

    /// G* m^2 int w^2 dx, J.
    fn elastic(&self) -> f64 {
        let squared = |x: f64| (self.depth - self.g(x)).powi(2);
        let size = self.depth * self.depth * self.edge;
        let slipped = integral(&squared, self.stick, self.edge, 1e-17 * size);
        G_STAR * Self::ratio().powi(2) * (self.position * self.position * self.stick + slipped)
    }

    /// (2/pi) int u_x dx/sqrt(r^2 - x^2), m, over the angle whose sine is x/r.
    fn surface(&self, r: f64) -> f64 {
        let angle = |x: f64| if x < r { x.atan2(((r - x) * (r + x)).sqrt()) } else { FRAC_PI_2 };
        let (stick, edge) = (angle(self.stick), angle(self.edge));
        let slipped = integral(&|turn: f64| self.depth - self.g(r * turn.sin()), stick, edge, 1e-16 * self.depth);
        Self::ratio() * FRAC_2_PI * (self.position * stick + slipped)
    }

    fn energies_agree(&self) {
        let state = self.contact.state();
        for (found, expected) in [(state.dissipated_energy, self.dissipated()), (state.elastic_energy, self.elastic())]
        {
            let error = (found / expected - 1.0).abs();
            assert!(error < 1e-12, "power {}: {found:e} is not {expected:e} J, {error:e}", self.power);
        }
    }

    fn displacements_agree(&self, r: f64) {
        let (found, expected) = (self.contact.surface_displacement(r), self.surface(r));
        let error = (found / expected - 1.0).abs();
        assert!(error < 1e-12, "power {} at {r:e} m: {found:e} is not {expected:e} m, {error:e}", self.power);
        if let Some(slip) = self.contact.slip(r) {
            let displacement = Self::ratio() * self.position;
            let error = (slip - (displacement - expected)).abs() / displacement;
            assert!(error < 1e-12, "power {} at {r:e} m: the slip {slip:e} m is off by {error:e}", self.power);
        }
    }
}

#[test]
fn the_friction_work_of_a_sphere_with_a_tenth_power_is_that_of_sixty_digits() {
    let loading = FirstLoading::new(10.0, 5e24, 1.0, false, 2e-5, 1e-5);
    let found = loading.contact.state().dissipated_energy;
    assert!((found / 3.139670721e-3 - 1.0).abs() < 2e-10, "{found:e}");
    loading.energies_agree();
}

#[test]
fn the_surface_displacement_of_a_tenth_power_is_that_of_sixty_digits() {
    let loading = FirstLoading::new(10.0, 5e24, 0.0, false, 1e-5, 1e-5);
    let found = loading.contact.surface_displacement(0.001108562);
    assert!((found / 2.0897962247393612e-6 - 1.0).abs() < 1e-13, "{found:e}");
}

proptest! {
    #![proptest_config(config(200))]

    #[test]
    fn energies_in_sums_with_any_whole_or_half_power_are_their_integrals(
        halves in prop_oneof![5_i32..=24, 5_i32..=120],
        size in -2.0..-0.5_f64,
        sphere_share in prop_oneof![Just(0.0), 1e-3..10.0_f64],
        slide in 0.05..1.5_f64,
    ) {
        let power = 0.5 * f64::from(halves);
        // c r^n reaches the depth at about r = 10^size.
        let (radius, depth) = (10f64.powf(size), 10f64.powf(size - 2.0));
        let coefficient = depth / radius.powf(power);
        let curvature = sphere_share * depth / (radius * radius);
        FirstLoading::new(power, coefficient, curvature, true, depth,
            slide * FirstLoading::ratio() * depth).energies_agree();
    }

    #[test]
    fn surface_displacement_and_slip_of_any_whole_or_half_power_are_their_integrals(
        halves in prop_oneof![4_i32..=24, 4_i32..=240],
        size in -2.0..-0.5_f64,
        sphere_share in prop_oneof![Just(0.0), 1e-3..10.0_f64],
        slide in 0.05..1.5_f64,
        places in prop::collection::vec(prop_oneof![0.01..0.999_f64, 1.001..3.0_f64], 8),
    ) {
        let power = 0.5 * f64::from(halves);
        let (radius, depth) = (10f64.powf(size), 10f64.powf(size - 2.0));
        let coefficient = depth / radius.powf(power);
        let curvature = sphere_share * depth / (radius * radius);
        let loading = FirstLoading::new(power, coefficient, curvature, false, depth,
            slide * FirstLoading::ratio() * depth);
        for place in places {
            loading.displacements_agree(place * loading.edge);
        }
    }
}

/// int_0^1 of a smooth f by two hundred panels.
fn panels(f: impl Fn(f64) -> f64) -> f64 {
    let rule = gauss(24);
    let panel = |index: u32| rule.iter().map(|(u, weight)| weight * f((f64::from(index) + u) / 200.0)).sum::<f64>();
    (0..200).map(panel).sum::<f64>() / 200.0
}

proptest! {
    #![proptest_config(config(200))]

    /// A power above a kink: there g changes with x^n, not with the n-th power of the distance from the kink.
    #[test]
    fn force_and_work_of_a_steep_power_beside_a_rim_are_their_integrals(
        power in 8.0..130.0_f64,
        flat_share in 0.01..0.99_f64,
        slope in 1e-3..0.3_f64,
        slide in 0.3..1.5_f64,
    ) {
        // Both parts have risen alike at the edge, 1 m; the indenter then moves beyond gross slip or short of it.
        let flat = flat_share;
        let t_of = |x: f64| ((x - flat) * (x + flat)).max(0.0).sqrt();
        let cone = |x: f64| slope * x * t_of(x).atan2(flat);
        let scale = cone(1.0);
        let unit = Profile::PowerLaw(PowerLaw::new(power, 1e-3).unwrap()).indenter().level(1.0) / 1e-3;
        let parts = vec![
            Profile::PowerLaw(PowerLaw::new(power, scale / unit).unwrap()),
            Profile::TruncatedCone(TruncatedCone::new(slope, flat).unwrap()),
        ];
        let g = |x: f64| scale * x.powf(power) + cone(x);
        let depth = 2.0 * scale;
        let setup = Setup {
            profile: Profile::Sum(Sum::new(parts).unwrap()),
            elasticity: Elasticity::effective(E_STAR, G_STAR).unwrap(),
            friction: FRICTION,
            preload: Preload::ContactRadius(1.0),
        };
        let mut contact = Contact::new(setup).unwrap();
        let (ratio, position) = (FirstLoading::ratio(), slide * depth);
        contact.apply(&displace(ratio * position)).unwrap();
        // Over the coordinate in which both parts are smooth, from the stick radius or from the rim to the edge.
        let stick = if slide < 1.0 { radius_of(g, depth - position, 1.0) } else { 0.0 };
        let over = |low: f64, high: f64, f: &dyn Fn(f64) -> f64| {
            if low >= flat {
                let (from, to) = (t_of(low), t_of(high));
                (to - from) * panels(|u| {
                    let t = from + (to - from) * u;
                    let x = t.hypot(flat);
                    f(x) * t / x
                })
            } else {
                (high - low) * panels(|u| f(low + (high - low) * u))
            }
        };
        let slipped = |f: &dyn Fn(f64) -> f64| {
            if stick < flat { over(stick, flat, f) + over(flat, 1.0, f) } else { over(stick, 1.0, f) }
        };
        let bound = |x: f64| depth - g(x);
        let force = 2.0 * G_STAR * ratio * (position.min(depth) * stick + slipped(&bound));
        let work = 2.0 * G_STAR * ratio * ratio * slipped(&|x| (position - bound(x)) * bound(x));
        let state = contact.state();
        for (found, expected, what) in [(state.force, force, "force"), (state.dissipated_energy, work, "work")] {
            let error = (found / expected - 1.0).abs();
            prop_assert!(error < 2e-12, "{what} of the power {power}: {found:e} is not {expected:e}, {error:e}");
        }
    }
}

/// Of g = B x^n + x^2/R the kernel at the centre is int g'/x dx = n/(n - 1) B a^(n-1) + 2 a/R.
#[test]
fn the_pressure_at_the_centre_of_a_tip_hardly_less_sharp_than_a_cone_is_finite() {
    let (a, curvature): (f64, f64) = (1e-4, 100.0);
    for power in [1.000_001, 1.0001, 1.002, 1.003, 1.0035, 1.3] {
        let tip = Profile::PowerLaw(PowerLaw::new(power, 0.08).unwrap());
        for (profile, curvature) in
            [(tip.clone(), 0.0), (Profile::Sum(Sum::new(vec![sphere(curvature.recip()), tip]).unwrap()), curvature)]
        {
            let elasticity = Elasticity::effective(E_STAR, G_STAR).unwrap();
            let preload = Preload::ContactRadius(a);
            let mut contact = Contact::new(Setup { profile, elasticity, friction: FRICTION, preload }).unwrap();
            let level = contact.indentation() - curvature * a * a;
            let expected = E_STAR * (power / (power - 1.0) * level / a + 2.0 * curvature * a) / std::f64::consts::PI;
            contact.apply(&displace(2.0 * contact.gross_slip_displacement())).unwrap();
            let found = [
                contact.pressure(0.0),
                contact.pressures(&[0.5 * a, 0.0])[1],
                contact.summary().max_pressure.unwrap(),
                contact.shear(0.0) / FRICTION,
                contact.residual().max.unwrap() / FRICTION,
            ];
            for pressure in found {
                assert!((pressure / expected - 1.0).abs() < 1e-13, "{power}: {found:?} Pa are not {expected} Pa");
            }
            assert!(contact.pressure(1e-160) <= expected * (1.0 + 1e-13), "{power}");
        }
    }
}
