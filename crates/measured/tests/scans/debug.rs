use crate::synthetic::*;
use stickslip_measured::scan::*;
#[test]
fn dbg() {
    for (points, map) in [(10_000, false), (512, true)] {
        for (shape, half, tilt) in [(Shape::Cone(0.01, 4e-5), 2e-4, 7e-4), (Shape::Ball(0.0285), 2.7e-4, -8e-4)] {
            println!("{shape:?}");
            let mut random = fastrand::Rng::with_seed(1);
            let i = Instrument {
                half,
                points,
                map,
                axis: [1e-5, 0.0],
                tilt: [tilt, 0.0],
                noise: 1e-9,
                correlation: 1,
                outliers: 0.01,
                missing: 0.02,
                sign: 1.0,
            };
            let scan = i.scan(&shape, &mut random);
            let t = std::time::Instant::now();
            let fit = ScanFit::new(&scan, &Options::default(), &|| true);
            println!("{points} {map} {:?}", t.elapsed());
            match fit {
                Ok(fit) => println!("c {:?} t {:?} rms {} out {}", fit.centre, fit.tilt, fit.rms, fit.outliers),
                Err(e) => println!("{e}"),
            }
        }
    }
}
