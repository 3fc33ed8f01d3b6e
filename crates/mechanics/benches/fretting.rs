//! What fatigue criteria cost at the instants that matter, over the same at 16 equal instants of each move, which miss
//! cusps:
//! Crossland's and Findley's criterion at 1000 places under a ball moved to and fro, to 1e-4; and the search of the
//! body, to 1e-3.
//!
//! `cargo bench -p stickslip-mechanics --bench fretting` prints a table. The ratio is the median over pairs of runs, so
//! that other
//! work on the machine counts on both sides.

use std::hint::black_box;
use std::time::{Duration, Instant};

use stickslip_mechanics::fatigue::{Criterion, Cycle, Measure, Study};
use stickslip_mechanics::subsurface::Side;
use stickslip_mechanics::{Contact, Elasticity, Error, Move, Preload, Profile, Setup, Sphere, Tangential};

const BODY: (Side, f64) = (Side::Second, 0.3);
const INSTANTS: usize = 16;
const PAIRS: usize = 5;

fn cycle() -> Result<Cycle, Error> {
    let contact = Contact::new(Setup {
        profile: Profile::Sphere(Sphere::new(0.01)?),
        elasticity: Elasticity::effective(1.15e11, 8.5e10)?,
        friction: 0.3,
        preload: Preload::NormalForce(10.0),
    })?;
    let slide = 0.6 * contact.gross_slip_displacement();
    let to = |target| Move { tangential: Some(Tangential::Displacement(target)), ..Move::default() };
    Cycle::new(&contact, &[to(slide), to(-slide)], &|| true)
}

fn timed<T>(work: impl FnOnce() -> Result<T, Error>) -> Result<Duration, Error> {
    let start = Instant::now();
    black_box(work()?);
    Ok(start.elapsed())
}

fn main() -> Result<(), Error> {
    let cycle = cycle()?;
    let radius = cycle.start().contact_radius();
    let places: Vec<[f64; 3]> = (0..50)
        .flat_map(|x| (0..20).map(move |z| [f64::from(x) / 20.0 - 1.225, 0.0, f64::from(z) / 20.0]))
        .map(|place| place.map(|part| radius * part))
        .collect();
    println!("{:32} {:>12} {:>8}", "", "time", "ratio");
    for (name, criterion) in
        [("Crossland", Criterion::Crossland { alpha: 0.3 }), ("Findley", Criterion::Findley { k: 0.3 })]
    {
        let equal = || -> Result<Vec<f64>, Error> {
            let states = cycle.states(INSTANTS, &|| true)?;
            let fields: Vec<_> =
                states.iter().map(|state| state.subsurface(BODY.0, BODY.1)).collect::<Result<_, _>>()?;
            let path = |place: &[f64; 3]| {
                fields.iter().map(|field| field.at(*place).expect("a place near the contact")).collect::<Vec<_>>()
            };
            Ok(places.iter().map(|place| criterion.of(&path(place)).value).collect())
        };
        let study = |tolerance| Study::new(&cycle, BODY, None, vec![Measure::Stress(criterion)], tolerance, &|| true);
        for (work, search) in [("1000 places", false), ("search", true)] {
            let mut pairs = Vec::new();
            for _ in 0..PAIRS {
                let one = timed(equal)?;
                let other = timed(|| {
                    if search { study(1e-3)?.worst().map(drop) } else { study(1e-4)?.rate_all(&places).map(drop) }
                })?;
                pairs.push((other.as_secs_f64() / one.as_secs_f64(), other));
            }
            pairs.sort_by(|one, other| one.0.total_cmp(&other.0));
            let (ratio, time) = pairs[PAIRS / 2];
            println!("{:32} {time:>12.1?} {ratio:>8.2}", format!("{name}, {work}"));
        }
    }
    Ok(())
}
