//! The law of equal peaks: what it gains over the linearly falling amplitude, profile by profile.

use crate::support::quadrature::integral;
use crate::support::{follow, power, pressed};
use stickslip_mechanics::profile::{Cone, ExactSphere, RoundedCone, Tabulated, TruncatedSphere};
use stickslip_mechanics::protocol::{equal_peaks, falling_amplitude};
use stickslip_mechanics::{Profile, Sphere};

/// Largest peak, and its ratio to the smallest, beyond a radius; the outermost peak apart, which the edge makes
/// smaller.
fn peaks(profile: &Profile, path: &[f64], beyond: f64) -> (f64, f64) {
    let mut contact = pressed(profile.clone());
    follow(&mut contact, path);
    let found = contact.residual().peaks;
    let sizes: Vec<f64> =
        found[..found.len() - 1].iter().filter(|peak| peak.radius > beyond).map(|peak| peak.shear.abs()).collect();
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    (largest, largest / sizes.iter().copied().fold(f64::INFINITY, f64::min))
}

/// ((largest, ratio) of the linear fall, the same of equal peaks), and the cut-off radius.
fn compared(profile: &Profile, reversals: usize) -> ((f64, f64), (f64, f64), f64) {
    let contact = pressed(profile.clone());
    let linear: Vec<f64> = falling_amplitude(reversals, contact.gross_slip_displacement()).collect();
    let equal = equal_peaks(&contact, reversals, None).unwrap();
    assert_eq!(equal.displacements.len(), reversals + 1);
    assert!(equal.displacements[reversals].abs() <= 0.0, "the path ends at zero");
    assert!((equal.displacements[0] - contact.gross_slip_displacement()).abs() <= 0.0, "and starts with gross slip");
    let cutoff = equal.cutoff_radius;
    (peaks(profile, &linear, cutoff), peaks(profile, &equal.displacements, cutoff), cutoff)
}

#[test]
fn on_a_sphere_the_law_is_the_linear_fall() {
    let contact = pressed(Profile::Sphere(Sphere::new(10.0).unwrap()));
    let full = contact.gross_slip_displacement();
    let equal = equal_peaks(&contact, 20, None).unwrap();
    for (found, expected) in equal.displacements.iter().zip(falling_amplitude(20, full)) {
        assert!((found - expected).abs() < 1e-13 * full, "{found:e} {expected:e}");
    }
}

#[test]
fn on_power_laws_the_largest_peak_falls() {
    // Of all peaks and the centre, and of all peaks but the outermost.
    for (exponent, all, inner) in [(1.5, 0.495, 0.41), (3.0, 0.129, 0.129), (4.0, 0.174, 0.174)] {
        let ((linear, before), (equal, after), cutoff) = compared(&power(exponent), 50);
        assert!(cutoff.abs() <= 0.0);
        let lower_inside = 1.0 - equal / linear;
        let contact = pressed(power(exponent));
        let law: Vec<f64> = falling_amplitude(50, contact.gross_slip_displacement()).collect();
        let [linear, equal] = [law, equal_peaks(&contact, 50, None).unwrap().displacements].map(|path| {
            let mut contact = contact.clone();
            follow(&mut contact, &path);
            contact.residual().max.unwrap()
        });
        let lower = 1.0 - equal / linear;
        assert!(
            (lower - all).abs() < 5e-4 && (lower_inside - inner).abs() < 6e-3,
            "{exponent}: {lower} {lower_inside}"
        );
        println!(
            "exponent {exponent}: ratio of peaks {before:.3} to {after:.3}, the largest stress lower by {lower:.3}, \
             the largest peak but the outermost by {lower_inside:.3}"
        );
    }
}

#[test]
fn peaks_are_more_even_than_with_the_linear_fall() {
    let radii: Vec<f64> = (0..=200).map(|index| 0.9 * f64::from(index) / 200.0).collect();
    let heights: Vec<f64> = radii.iter().map(|r| 0.1 * r * r * (1.0 + r)).collect();
    let profiles = [
        ("power 1.5", power(1.5)),
        ("power 3", power(3.0)),
        ("power 4", power(4.0)),
        ("cone", Profile::Cone(Cone::new(0.05).unwrap())),
        ("truncated sphere", Profile::TruncatedSphere(TruncatedSphere::new(10.0, 0.2).unwrap())),
        ("table", Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap())),
    ];
    for (name, profile) in profiles {
        let ((_, before), (_, after), _) = compared(&profile, 50);
        println!("{name}: ratio of largest to smallest interior peak {before:.3} to {after:.3}");
        assert!(after < before, "{name}: {before:.3} to {after:.3}");
    }
}

#[test]
fn where_the_slope_jumps_the_law_starts_from_a_cutoff() {
    let cone = Profile::Cone(Cone::new(0.05).unwrap());
    let edge = pressed(cone.clone()).contact_radius();
    let ((_, before), (_, after), cutoff) = compared(&cone, 50);
    assert!((cutoff - 0.1 * edge).abs() < 1e-15);
    assert!(before > 2.9 && after < 1.05, "{before} {after}");
    let given = equal_peaks(&pressed(cone.clone()), 50, Some(0.3 * edge)).unwrap();
    assert!((given.cutoff_radius - 0.3 * edge).abs() < 1e-15);
    // At the edge itself there is just room for it, and beyond there is none.
    assert!(equal_peaks(&pressed(cone.clone()), 5, Some(edge)).is_ok());
    assert!(equal_peaks(&pressed(cone), 5, Some(edge.next_up())).is_err());
    let worn = pressed(Profile::TruncatedSphere(TruncatedSphere::new(10.0, 0.2).unwrap()));
    assert!(equal_peaks(&worn, 5, Some(0.2)).is_ok() && equal_peaks(&worn, 5, Some(0.19)).is_err());
}

#[test]
fn on_power_laws_the_law_is_a_power() {
    // s ~ x^(2n - 2) and g ~ x^n, so that the amplitudes are 1 - (k/N)^(n/(2n - 2)) of the first.
    for exponent in [1.001, 1.05, 1.5, 2.5, 3.0, 7.0, 100.0, 1000.0] {
        let contact = pressed(power(exponent));
        let full = contact.gross_slip_displacement();
        let equal = equal_peaks(&contact, 20, None).unwrap();
        let mut worst: f64 = 0.0;
        for (index, found) in equal.displacements.iter().enumerate() {
            let size = 1.0 - (index as f64 / 20.0).powf(exponent / (2.0 * exponent - 2.0));
            worst = worst.max((found.abs() / full - size).abs());
        }
        println!("exponent {exponent}: off by {worst:.1e}");
        assert!(worst < 1e-10, "exponent {exponent}: {worst:e}");
    }
}

#[test]
fn with_a_cutoff_a_power_at_or_below_one_has_its_law_too() {
    for exponent in [0.5_f64, 0.8, 1.0] {
        let contact = pressed(power(exponent));
        let edge = contact.contact_radius();
        let equal = equal_peaks(&contact, 20, Some(0.02 * edge)).unwrap();
        // s(x)/s(a) over x/a; of a cone s = ln x.
        let q = 2.0 * exponent - 2.0;
        let s = |x: f64| if q.abs() > 0.0 { (x.powf(q) - 0.02_f64.powf(q)) / q } else { (x / 0.02).ln() };
        for (index, found) in equal.displacements.iter().enumerate().skip(1) {
            let x = (1.0 - found.abs() / contact.gross_slip_displacement()).powf(exponent.recip());
            let share = s(x) / s(1.0);
            assert!((share - index as f64 / 20.0).abs() < 1e-10, "exponent {exponent}, {index}: {share}");
        }
    }
}

#[test]
fn reversals_are_spread_evenly_in_s_by_another_quadrature() {
    let radii: Vec<f64> = (0..=12).map(|index| f64::from(index) / 12.0).collect();
    let heights: Vec<f64> = radii.iter().map(|r| 0.1 * r * r * (1.0 + r)).collect();
    let (ball, worn, flat) = (2.0_f64, 10.0_f64, 0.2_f64);
    // g' of the first two by hand.
    let of_ball = move |x: f64| (x / ball).atanh() + ball * x / ((ball - x) * (ball + x));
    let of_worn = move |x: f64| (2.0 * x * x - flat * flat) / (worn * (x * x - flat * flat).sqrt());
    let rounded = Profile::RoundedCone(RoundedCone::new(0.05, 0.15).unwrap());
    let table = Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap());
    let slope_of = |profile: &Profile| {
        let profile = profile.clone();
        Box::new(move |x: f64| profile.indenter().slope(x)) as Box<dyn Fn(f64) -> f64>
    };
    let cases = [
        (
            "exact sphere",
            Profile::ExactSphere(ExactSphere::new(ball).unwrap()),
            Box::new(of_ball) as Box<dyn Fn(f64) -> f64>,
        ),
        ("truncated sphere", Profile::TruncatedSphere(TruncatedSphere::new(worn, flat).unwrap()), Box::new(of_worn)),
        ("rounded cone", rounded.clone(), slope_of(&rounded)),
        ("table", table.clone(), slope_of(&table)),
    ];
    for (name, profile, slope) in cases {
        let contact = pressed(profile.clone());
        let (edge, indentation) = (contact.contact_radius(), contact.indentation());
        let equal = equal_peaks(&contact, 20, None).unwrap();
        let density = |x: f64| if x > 0.0 { slope(x).powi(2) / x } else { 0.0 };
        // Halved at the cut-off, the tip of the cone and the points of the table, where g' bends.
        let mut ends: Vec<f64> = radii.iter().copied().chain([0.15]).filter(|x| *x > equal.cutoff_radius).collect();
        ends.push(equal.cutoff_radius);
        ends.sort_by(f64::total_cmp);
        let s = |x: f64| -> f64 {
            let pairs = ends.windows(2).map(|pair| (pair[0], pair[1].min(x))).filter(|(low, high)| low < high);
            pairs.map(|(low, high)| integral(&density, low, high, 1e-14)).sum()
        };
        let whole = s(edge);
        let mut worst: f64 = 0.0;
        for (index, found) in equal.displacements.iter().enumerate().skip(1) {
            let level = indentation * (1.0 - found.abs() / contact.gross_slip_displacement());
            worst = worst.max((s(profile.indenter().radius(level)) / whole - index as f64 / 20.0).abs());
        }
        println!("{name}: s off by {worst:.1e}");
        assert!(worst < 1e-10, "{name}: {worst:e}");
    }
}
