//! Invalid scans: each is refused by what is wrong with it, and nothing panics.

use proptest::prelude::*;
use stickslip_measured::scan::{Error, Options, Orientation, Scan, ScanFit, Smoothing};
use stickslip_mechanics::Preload;

use crate::steel;

fn ball(count: usize, half: f64) -> Vec<[f64; 2]> {
    let at = |index: usize| half * (2.0 * index as f64 / (count - 1) as f64 - 1.0);
    (0..count).map(|index| [at(index), at(index).powi(2) / 0.02]).collect()
}

fn fit(points: Vec<[f64; 2]>, options: &Options) -> Result<ScanFit, Error> {
    ScanFit::new(&Scan::line(points), options, &|| true)
}

#[test]
fn each_fault_has_its_error() {
    let auto = Options::default();
    let refused = |points, options: &Options| fit(points, options).unwrap_err();
    assert_eq!(refused(vec![[0.0, 0.0]], &auto), Error::TooFewPoints { used: 1 });
    let holes = ball(200, 1e-4).into_iter().map(|[x, _]| [x, f64::NAN]).collect();
    assert_eq!(refused(holes, &auto), Error::TooFewPoints { used: 0 });
    assert_eq!(refused(vec![[1e-5, 2e-9]; 50], &auto), Error::NoExtent { what: "place" });
    let flat = ball(50, 1e-4).into_iter().map(|[x, _]| [x, 1e-9]).collect();
    assert_eq!(refused(flat, &auto), Error::NoExtent { what: "height" });
    assert!(matches!(refused(ball(50, 1e6), &auto), Error::Extent { .. }));
    let steep = ball(50, 1e-6).into_iter().map(|[x, z]| [x, 1e12 * z]).collect();
    assert!(matches!(refused(steep, &auto), Error::Steep { .. }));
    let up = Options { orientation: Some(Orientation::PeakUp), ..auto };
    assert_eq!(refused(ball(500, 1e-4), &up), Error::Hollow);
    // With the axis beside the middle too: from one end the surface rises at first.
    let beside_middle = ball(500, 1e-4).into_iter().map(|[x, z]| [x, z + 1e-3 * x]).collect();
    assert_eq!(refused(beside_middle, &up), Error::Hollow);
    let beside = Options { centre: Some([5e-4, 0.0]), ..auto };
    assert!(matches!(refused(ball(500, 1e-4), &beside), Error::AxisOutside { .. }));
    let scan = Scan::line(ball(500, 1e-4));
    assert_eq!(ScanFit::new(&scan, &auto, &|| false).unwrap_err(), Error::Interrupted);
}

#[test]
fn a_scan_that_is_too_short_says_how_far_it_would_have_to_reach() {
    let short = fit(ball(400, 4.1e-5), &Options::default()).unwrap();
    let error = short.contact(steel(), 0.3, Preload::NormalForce(10.0)).unwrap_err();
    // Hertz: a^3 = 3 F R/(4 E*).
    let radius = (0.75 * 10.0 * 0.01 / (2.1e11 / 0.91f64)).cbrt();
    let Error::TooShort { reach, needed } = error else { panic!("{error}") };
    assert!((reach - 4.1e-5).abs() < 1e-9 && (needed / radius - 1.0).abs() < 1e-3, "{error}");
    assert_eq!(error.to_string(), "the scan does not reach the edge of the contact: 41.0 um of about 68.8 um");
    for preload in [Preload::Indentation(1e-6), Preload::ContactRadius(1e-4)] {
        let Err(Error::TooShort { needed, .. }) = short.contact(steel(), 0.3, preload) else { panic!("{preload:?}") };
        assert!((needed / 1e-4 - 1.0).abs() < 1e-3, "{needed}");
    }
}

#[test]
fn the_load_that_is_prescribed_has_no_error() {
    let found = fit(ball(400, 1e-4), &Options::default()).unwrap();
    let a = found.contact(steel(), 0.3, Preload::ContactRadius(5e-5)).unwrap();
    assert_eq!((a.contact_radius.value, a.contact_radius.standard_error), (5e-5, 0.0));
    let d = found.contact(steel(), 0.3, Preload::Indentation(1e-7)).unwrap();
    assert_eq!((d.indentation.value, d.indentation.standard_error), (1e-7, 0.0));
    // Just touching.
    let none = found.contact(steel(), 0.3, Preload::NormalForce(0.0)).unwrap();
    assert_eq!((none.contact_radius.value, none.max_pressure.value), (0.0, 0.0));
    assert!(none.max_pressure.standard_error.is_finite() || none.max_pressure.standard_error.is_nan());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_numbers_have_a_profile_or_an_error(
        points in prop::collection::vec(
            (-1e-3..1e-3f64, prop_oneof![Just(0.0), -1e-6..1e-6f64, Just(1e300), Just(f64::NAN)]),
            0..60,
        ),
        plane in any::<bool>(),
        level in any::<bool>(),
        smoothing in prop_oneof![Just(Smoothing::Auto), Just(Smoothing::Knots(100)), Just(Smoothing::Noise(1e-9))],
        scale in prop_oneof![Just(1.0), Just(1e-6), Just(1e5)],
    ) {
        let scan = if plane {
            Scan::area(points.into_iter().enumerate().map(|(index, (x, z))| [scale * x, (index % 7) as f64 * 1e-4, z]))
        } else {
            Scan::line(points.into_iter().map(|(x, z)| [scale * x, z]))
        };
        let found = ScanFit::new(&scan, &Options { level, smoothing, ..Options::default() }, &|| true);
        // Only intervals that were asked for can follow the noise.
        let asked = matches!(smoothing, Smoothing::Knots(_));
        prop_assert!(asked || !matches!(found, Err(Error::Rough)), "{:?}", found.err());
        if let Ok(found) = found {
            prop_assert!(found.rms.is_finite() && found.table.height.iter().all(|z| z.is_finite()));
            for force in [1e-6, 1.0, 1e6] {
                if let Ok(contact) = found.contact(steel(), 0.3, Preload::NormalForce(force)) {
                    prop_assert!(contact.max_pressure.value > 0.0);
                }
            }
        }
    }
}
