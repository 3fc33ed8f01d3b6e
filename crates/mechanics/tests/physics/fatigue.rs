//! Fatigue criteria against paths with known answers, the laws that they obey, and searches by trial of all.

use std::f64::consts::{PI, SQRT_2, TAU};

use proptest::prelude::*;
use stickslip_mechanics::fatigue::{
    Ball, Criterion, Cycle, Instant, MAX_INSTANTS, Measure, Rated, Study, enclosing_ball,
};
use stickslip_mechanics::protocol::falling_amplitude;
use stickslip_mechanics::range::Quantity;
use stickslip_mechanics::subsurface::Side;
use stickslip_mechanics::{Contact, Elasticity, Error, Move, Preload, Setup, Stress};

use crate::support::{Random, config, displace, oblique, press, push, sphere};

const ALPHA: f64 = 0.3;
const K: f64 = 0.4;
/// Of steel, MPa.
const YOUNGS_MODULUS: f64 = 2.1e5;
const POISSON: f64 = 0.3;
const YIELD_STRESS: f64 = 400.0;

const SWT: Criterion = Criterion::SmithWatsonTopper { youngs_modulus: YOUNGS_MODULUS, poisson: POISSON };

fn fatemi_socie(k: f64, yield_stress: f64) -> Criterion {
    Criterion::FatemiSocie { k, yield_stress, youngs_modulus: YOUNGS_MODULUS, poisson: POISSON }
}

fn all() -> [Criterion; 5] {
    [
        Criterion::Crossland { alpha: ALPHA },
        Criterion::DangVan { alpha: ALPHA },
        Criterion::Findley { k: K },
        SWT,
        fatemi_socie(K, YIELD_STRESS),
    ]
}

fn values(path: &[Stress]) -> [f64; 5] {
    all().map(|criterion| criterion.of(path).value)
}

#[track_caller]
fn assert_values(path: &[Stress], expected: [f64; 5]) {
    let found = values(path);
    for (one, other) in found.into_iter().zip(expected) {
        assert!((one - other).abs() <= 1e-11 * other.abs().max(1e-300), "{found:?} is not {expected:?}");
    }
}

fn tension(xx: f64) -> Stress {
    Stress { xx, ..Stress::default() }
}

fn shear_modulus() -> f64 {
    0.5 * YOUNGS_MODULUS / (1.0 + POISSON)
}

/// The largest of sin(t) (1 + q (1 + cos(t))) over t.
fn sheared_tension(q: f64) -> f64 {
    let cos = (((1.0 + q).powi(2) + 8.0 * q * q).sqrt() - 1.0 - q) / (4.0 * q);
    (1.0 - cos * cos).sqrt() * (1.0 + q * (1.0 + cos))
}

#[test]
fn tension_and_compression() {
    let s = 200.0;
    let root = 3f64.sqrt();
    let plane = 0.5 * s * (K + K.hypot(1.0));
    let strained = sheared_tension(0.5 * K * s / YIELD_STRESS);
    assert_values(
        &[tension(s), tension(-s)],
        [
            s / root + ALPHA * s / 3.0,
            0.5 * s + ALPHA * s / 3.0,
            plane,
            s * s / YOUNGS_MODULUS,
            0.5 * s / shear_modulus() * strained,
        ],
    );
    // From zero to s: half the amplitude, the same largest stress.
    let half = 0.25 * s * (2.0 * K + (2.0 * K).hypot(1.0));
    assert_values(
        &[tension(0.0), tension(s), tension(0.3 * s)],
        [
            0.5 * s / root + ALPHA * s / 3.0,
            0.25 * s + ALPHA * s / 3.0,
            half,
            0.5 * s * s / YOUNGS_MODULUS,
            0.25 * s / shear_modulus() * strained,
        ],
    );
}

#[test]
fn reversed_shear() {
    let tau = 70.0;
    let at = |xy: f64| Stress { xy, ..Stress::default() };
    // On a plane turned by t/2 the amplitude is tau cos(t), the largest normal stress tau abs(sin(t)).
    let q = K * tau / YIELD_STRESS;
    let sin = ((1.0 + 8.0 * q * q).sqrt() - 1.0) / (4.0 * q);
    let strained = tau / shear_modulus() * (1.0 - sin * sin).sqrt() * (1.0 + q * sin);
    assert_values(
        &[at(tau), at(-tau)],
        [tau, tau, tau * K.hypot(1.0), (1.0 + POISSON) * tau * tau / YOUNGS_MODULUS, strained],
    );
}

#[test]
fn tension_and_torsion_out_of_phase_have_a_constant_amplitude() {
    // Von Mises's ratio: the path of the deviator is a circle.
    let s = 120.0;
    let torsion = s / 3f64.sqrt();
    let path: Vec<Stress> = (0..60)
        .map(|index| (TAU * f64::from(index) / 60.0).sin_cos())
        .map(|(sin, cos)| Stress { xx: s * cos, xy: torsion * sin, ..Stress::default() })
        .collect();
    let crossland = Criterion::Crossland { alpha: ALPHA }.of(&path);
    assert!((crossland.value - (torsion + ALPHA * s / 3.0)).abs() < 1e-12 * s && crossland.at.unwrap().step == 0);
    // Tresca's shear is largest in tension: sqrt(s^2 cos^2/4 + s^2 sin^2/3) + alpha s cos/3 at cos = 2 alpha.
    let dang_van = Criterion::DangVan { alpha: ALPHA }.of(&path).value;
    let at = |cos: f64| s * ((cos * cos / 4.0 + (1.0 - cos * cos) / 3.0).sqrt() + ALPHA * cos / 3.0);
    let expected = (0..60).map(|index| at((TAU * f64::from(index) / 60.0).cos())).fold(0.0, f64::max);
    assert!((dang_van - expected).abs() < 1e-12 * s);
    // The cross section, on which the shear is the torsion alone, beats every other plane.
    let findley = Criterion::Findley { k: 0.0 }.of(&path);
    assert!((findley.value - torsion).abs() < 1e-9 * s, "{findley:?}");
    assert!(
        findley
            .plane
            .is_some_and(|normal| (normal[0].abs() - 1.0).abs() < 1e-6 || (normal[1].abs() - 1.0).abs() < 1e-6)
    );
}

#[test]
fn a_square_of_shears_has_its_diagonal_as_amplitude() {
    let tau = 50.0;
    let corner = |xz: f64, yz: f64| Stress { xz: tau * xz, yz: tau * yz, ..Stress::default() };
    let path = [corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)];
    let diagonal = SQRT_2 * tau;
    let [crossland, dang_van, ..] = values(&path);
    assert!((crossland - diagonal).abs() < 1e-13 * tau && (dang_van - diagonal).abs() < 1e-13 * tau);
    // On the plane of z, and on those along a diagonal.
    let findley = Criterion::Findley { k: 0.0 }.of(&path).value;
    assert!((findley - diagonal).abs() < 1e-9 * tau, "{findley}");
    // A triangle that leaves one corner out has the same circle.
    assert!((Criterion::Findley { k: 0.0 }.of(&path[..3]).value - diagonal).abs() < 1e-9 * tau);
}

#[test]
fn a_constant_stress_has_its_mean_alone() {
    let still = Stress { xx: 30.0, yy: -10.0, zz: 25.0, xy: 8.0, yz: -4.0, xz: 12.0 };
    let [crossland, dang_van, findley, swt, fatemi_socie] = values(&[still; 7]);
    assert!((crossland - ALPHA * 15.0).abs() < 1e-13 && (dang_van - ALPHA * 15.0).abs() < 1e-13);
    assert!((findley - K * still.principal()[0]).abs() < 1e-9);
    assert_eq!((swt, fatemi_socie), (0.0, 0.0));
}

#[test]
fn where_nothing_is_or_something_is_infinite() {
    let edge = Stress::from_components([f64::NEG_INFINITY; 6]);
    for criterion in all() {
        assert_eq!(criterion.of(&[]), Rated { value: 0.0, error: 0.0, plane: None, at: None });
        let at = Some(Instant { step: 1, part: 1.0 });
        let at_edge = Rated { value: f64::INFINITY, error: 0.0, plane: None, at };
        assert_eq!(criterion.of(&[tension(1.0), edge, tension(2.0)]), at_edge);
        assert_eq!(criterion.checked(), Ok(criterion));
    }
    assert_eq!(values(&[Stress::default(); 4]).to_vec(), [0.0; 5]);
    // No tension, no opening: the whole path is compressed.
    let pressed = [-900.0, -1000.0].map(|p| Stress { xx: p, yy: p - 90.0, zz: p + 50.0, ..Stress::default() });
    assert_eq!((SWT.of(&pressed).value, fatemi_socie(1.0, YIELD_STRESS).of(&pressed).value), (0.0, 0.0));
    for wrong in [Criterion::Findley { k: -0.1 }, fatemi_socie(K, 0.0), Criterion::DangVan { alpha: f64::NAN }] {
        assert!(matches!(wrong.checked(), Err(Error::OutOfRange { .. })));
    }
}

/// A random stress with components up to `size`.
fn any_stress(random: &mut Random, size: f64) -> Stress {
    Stress::from_components(std::array::from_fn(|_| random.within(-size, size)))
}

/// A closed path of random straight lines with points between.
fn any_path(random: &mut Random, corners: usize, between: usize) -> Vec<Stress> {
    let ends: Vec<Stress> = (0..corners).map(|_| any_stress(random, 100.0)).collect();
    (0..corners * between)
        .map(|index| {
            let (corner, part) = (index / between, (index % between) as f64 / between as f64);
            ends[corner] * (1.0 - part) + ends[(corner + 1) % corners] * part
        })
        .collect()
}

/// A random rotation: the columns of a quaternion's matrix.
fn any_rotation(random: &mut Random) -> [[f64; 3]; 3] {
    let [a, b, c, d]: [f64; 4] = std::array::from_fn(|_| random.within(-1.0, 1.0));
    let n = a * a + b * b + c * c + d * d;
    [
        [a * a + b * b - c * c - d * d, 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
        [2.0 * (b * c + a * d), a * a - b * b + c * c - d * d, 2.0 * (c * d - a * b)],
        [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d],
    ]
    .map(|row| row.map(|part| part / n))
}

fn matrix(stress: &Stress) -> [[f64; 3]; 3] {
    let [xx, yy, zz, xy, yz, xz] = stress.components();
    [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
}

fn rotated(stress: &Stress, turn: &[[f64; 3]; 3]) -> Stress {
    let s = matrix(stress);
    let at = |i: usize, j: usize| {
        (0..9).map(|index| turn[i][index / 3] * s[index / 3][index % 3] * turn[j][index % 3]).sum::<f64>()
    };
    Stress::from_components([at(0, 0), at(1, 1), at(2, 2), at(0, 1), at(1, 2), at(0, 2)])
}

proptest! {
    #![proptest_config(config(60))]

    /// Planes are found wherever they lie, and at the same instant.
    #[test]
    fn a_rotation_changes_the_plane_alone(seed in any::<u64>(), corners in 2_usize..6, offset in -300.0..100.0) {
        let mut random = Random(seed);
        let mean = any_stress(&mut random, 30.0) + Stress { xx: offset, yy: offset, zz: offset, ..Stress::default() };
        let path: Vec<Stress> = any_path(&mut random, corners, 5).iter().map(|stress| *stress + mean).collect();
        let turn = any_rotation(&mut random);
        let turned: Vec<Stress> = path.iter().map(|stress| rotated(stress, &turn)).collect();
        for criterion in all() {
            let [one, other] = [&path, &turned].map(|path| criterion.of(path));
            let unit = one.value.abs().max(1e-6 * criterion.of(&[tension(100.0), tension(-100.0)]).value);
            prop_assert!((one.value - other.value).abs() <= 2e-9 * unit, "{criterion:?}: {one:?} {other:?}");
        }
    }

    /// Degree one; two with SWT; Fatemi and Socie's is of degree one if the yield stress grows too.
    #[test]
    fn a_criterion_scales_with_its_stresses(seed in any::<u64>(), corners in 2_usize..6, power in -8_i32..8) {
        let path = any_path(&mut Random(seed), corners, 5);
        let factor = 8f64.powi(power);
        let scaled: Vec<Stress> = path.iter().map(|stress| *stress * factor).collect();
        let [crossland, dang_van, findley, swt, _] = values(&path).map(|value| factor * value);
        let strained = factor * fatemi_socie(K, YIELD_STRESS).of(&path).value;
        prop_assert_eq!([crossland, dang_van, findley, factor * swt].to_vec(), values(&scaled)[..4].to_vec());
        let grown = fatemi_socie(K, factor * YIELD_STRESS).of(&scaled).value;
        prop_assert!((grown / strained - 1.0).abs() < 1e-14);
    }
}

/// The plane search against normals one degree apart, with the smallest circle by trial of all.
#[test]
fn no_plane_of_a_dense_grid_beats_the_critical_one() {
    let mut random = Random(5);
    for case in 0..12 {
        let offset = [-60.0, -20.0, 0.0][case % 3];
        let path: Vec<Stress> = any_path(&mut random, 2 + case % 4, 1)
            .iter()
            .map(|stress| *stress + Stress { xx: offset, yy: offset, zz: offset, ..Stress::default() })
            .collect();
        for criterion in [Criterion::Findley { k: K }, SWT, fatemi_socie(4.0, YIELD_STRESS)] {
            let found = criterion.of(&path);
            let mut dense = f64::NEG_INFINITY;
            for latitude in 0..=90 {
                let (sin, cos) = f64::from(latitude).to_radians().sin_cos();
                for longitude in 0..((360.0 * sin).ceil() as u32).max(1) {
                    let (y, x) = (f64::from(longitude).to_radians() / sin.max(1e-9)).sin_cos();
                    dense = dense.max(on_plane(&criterion, &path, [sin * x, sin * y, cos]));
                }
            }
            assert!(found.value >= dense, "{criterion:?} {path:?}: {found:?} below {dense}");
            let own = found.plane.map(|normal| on_plane(&criterion, &path, normal)).unwrap_or_default();
            assert!((own - found.value).abs() <= 1e-12 * found.value.abs(), "{criterion:?}: {own} is not {found:?}");
            // What the dense grid itself misses, half a degree off.
            let range = match criterion {
                Criterion::Findley { .. } => 100.0,
                _ => criterion.of(&[tension(200.0), tension(-200.0)]).value,
            };
            assert!(found.value - dense <= 2e-3 * range, "{criterion:?}: {found:?} far above {dense}");
        }
    }
}

/// A criterion on one plane by its definition.
fn on_plane(criterion: &Criterion, path: &[Stress], normal: [f64; 3]) -> f64 {
    let tractions: Vec<[f64; 3]> =
        path.iter().map(|stress| matrix(stress).map(|row| (0..3).map(|i| row[i] * normal[i]).sum())).collect();
    let along = |one: &[f64; 3]| (0..3).map(|i| one[i] * normal[i]).sum::<f64>();
    let normals: Vec<f64> = tractions.iter().map(along).collect();
    let most = normals.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let shears: Vec<[f64; 3]> = tractions
        .iter()
        .zip(&normals)
        .map(|(one, along)| std::array::from_fn(|i| one[i] - along * normal[i]))
        .collect();
    match *criterion {
        Criterion::Findley { k } => by_trial(&shears).radius + k * most,
        Criterion::SmithWatsonTopper { .. } => {
            let strains = path.iter().zip(&normals).map(|(stress, along)| {
                let trace = stress.xx + stress.yy + stress.zz;
                ((1.0 + POISSON) * along - POISSON * trace) / YOUNGS_MODULUS
            });
            let (least, longest) =
                strains.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), strain| (a.min(strain), b.max(strain)));
            most.max(0.0) * 0.5 * (longest - least)
        }
        Criterion::FatemiSocie { k, yield_stress, .. } => {
            by_trial(&shears).radius / shear_modulus() * (1.0 + k * most / yield_stress).max(0.0)
        }
        _ => unreachable!("a criterion of planes"),
    }
}

/// The smallest ball by trial of all sets of points on its surface; their circumcentres by elimination.
fn by_trial<const N: usize>(points: &[[f64; N]]) -> Ball<N> {
    let mut best = Ball { center: [0.0; N], radius: f64::INFINITY };
    for set in 1_u32..1 << points.len() {
        let chosen: Vec<&[f64; N]> = (0..points.len()).filter(|i| set >> i & 1 == 1).map(|i| &points[i]).collect();
        if chosen.len() > N + 1 {
            continue;
        }
        if let Some(center) = circumcenter(&chosen) {
            let distance = |point: &[f64; N]| (0..N).map(|i| (point[i] - center[i]).powi(2)).sum::<f64>().sqrt();
            let radius = points.iter().map(distance).fold(0.0, f64::max);
            if radius < best.radius {
                best = Ball { center, radius };
            }
        }
    }
    best
}

/// The point as far from all points in the flat through them: 2 A A^T x = diagonal of A A^T.
fn circumcenter<const N: usize>(points: &[&[f64; N]]) -> Option<[f64; N]> {
    let arms: Vec<[f64; N]> =
        points[1..].iter().map(|point| std::array::from_fn(|i| point[i] - points[0][i])).collect();
    let count = arms.len();
    let gram = |i: usize, j: usize| (0..N).map(|k| arms[i][k] * arms[j][k]).sum::<f64>();
    let mut rows: Vec<Vec<f64>> =
        (0..count).map(|i| (0..count).map(|j| 2.0 * gram(i, j)).chain([gram(i, i)]).collect()).collect();
    for i in 0..count {
        let pivot = (i..count).max_by(|a, b| rows[*a][i].abs().total_cmp(&rows[*b][i].abs()))?;
        rows.swap(i, pivot);
        if rows[i][i].abs() <= 1e-12 * gram(0, 0) {
            return None;
        }
        for j in 0..count {
            if j != i {
                let factor = rows[j][i] / rows[i][i];
                (i..=count).for_each(|k| rows[j][k] -= factor * rows[i][k]);
            }
        }
    }
    Some(std::array::from_fn(|k| {
        points[0][k] + (0..count).map(|i| rows[i][count] / rows[i][i] * arms[i][k]).sum::<f64>()
    }))
}

fn compare<const N: usize>(points: &[[f64; N]]) {
    let (found, expected) = (enclosing_ball(points), by_trial(points));
    assert!((found.radius - expected.radius).abs() <= 1e-12 * expected.radius, "{found:?} is not {expected:?}");
    let off = (0..N).map(|i| (found.center[i] - expected.center[i]).powi(2)).sum::<f64>().sqrt();
    assert!(off <= 1e-6 * expected.radius, "{found:?} is not {expected:?}");
}

#[test]
fn the_enclosing_ball_is_the_smallest_of_all_that_points_carry() {
    let mut random = Random(3);
    for case in 0..60 {
        let mut point = || random.within(-1.0, 1.0);
        compare::<2>(&(0..2 + case % 9).map(|_| std::array::from_fn(|_| point())).collect::<Vec<_>>());
        compare::<5>(&(0..2 + case % 9).map(|_| std::array::from_fn(|_| point())).collect::<Vec<_>>());
        // In a plane of five dimensions, and on a grid, where points coincide and lie on one sphere.
        compare::<5>(&(0..9).map(|_| [point(), 0.0, point(), 0.0, 0.0]).collect::<Vec<_>>());
        compare::<5>(&(0..10).map(|_| std::array::from_fn(|_| point().round())).collect::<Vec<_>>());
    }
}

#[test]
fn a_ball_around_many_points_of_a_sphere_is_that_sphere() {
    let mut random = Random(9);
    for offset in [0.0, 1e3] {
        for copies in [1, 3] {
            let mut points: Vec<[f64; 5]> = Vec::new();
            for _ in 0..1000 {
                let along: [f64; 5] = std::array::from_fn(|_| random.within(-1.0, 1.0));
                let length = along.iter().map(|part| part * part).sum::<f64>().sqrt();
                // Its antipode too, so that the sphere is the smallest ball.
                for sign in [1.0, -1.0] {
                    points.extend([along.map(|part| offset + sign * part / length)].repeat(copies));
                }
            }
            let ball = enclosing_ball(&points);
            assert!((ball.radius - 1.0).abs() <= 1e-15 * offset.max(4.0), "{ball:?}");
            assert!(ball.center.iter().all(|part| (part - offset).abs() < 1e-15 * offset.max(10.0)), "{ball:?}");
        }
    }
    assert_eq!(enclosing_ball(&[[2.0, 3.0]; 1000]), Ball { center: [2.0, 3.0], radius: 0.0 });
    assert_eq!(enclosing_ball::<3>(&[]), Ball { center: [0.0; 3], radius: 0.0 });
}

/// A sphere with a = d = p_max = 1 and mu = 0.5: gross slip at U = 0.5.
fn unit() -> Contact {
    let elasticity = Elasticity::effective(0.5 * PI, 0.5 * PI).unwrap();
    let preload = Preload::Indentation(1.0);
    Contact::new(Setup { profile: sphere(1.0), elasticity, friction: 0.5, preload }).unwrap()
}

fn cycle(moves: &[Move]) -> Result<Cycle, Error> {
    Cycle::new(&unit(), moves, &|| true)
}

const BODY: (Side, f64) = (Side::Second, 0.3);
const PLACE: [f64; 3] = [-0.98, 0.0, 0.02];

/// The stresses at each place at so many instants of each move.
fn stress_paths(cycle: &Cycle, instants: usize, places: &[[f64; 3]]) -> Vec<Vec<Stress>> {
    let states = cycle.states(instants, &|| true).unwrap();
    let fields: Vec<_> = states.iter().map(|state| state.subsurface(BODY.0, BODY.1).unwrap()).collect();
    places.iter().map(|place| fields.iter().map(|field| field.at(*place).unwrap()).collect()).collect()
}

#[test]
fn the_published_figures_of_a_sphere_moved_to_and_fro() {
    let cycle = cycle(&[displace(0.3), displace(-0.3)]).unwrap();
    let path = &stress_paths(&cycle, 256, &[PLACE])[0];
    let amplitude = Criterion::Crossland { alpha: 0.0 }.of(path).value;
    assert!((amplitude - 0.303_364_330_750).abs() < 1e-11, "{amplitude}");
    let dang_van = Criterion::DangVan { alpha: 0.3 }.of(path).value;
    assert!((dang_van - 0.313_215_178_853).abs() < 1e-11, "{dang_van}");
    for criterion in [Criterion::DangVan { alpha: 0.3 }, Criterion::Findley { k: 0.3 }] {
        let measures = vec![Measure::Stress(criterion)];
        let found = Study::new(&cycle, BODY, None, measures, 1e-4, &|| true).unwrap().rate_all(&[PLACE]).unwrap();
        let (rated, full) = (found.largest[0].unwrap().rated, criterion.of(path).value);
        assert!((rated.value / full - 1.0).abs() < 2e-4, "{rated:?} {full}");
        assert!(rated.error <= 1e-4 * rated.value && found.instants < MAX_INSTANTS);
    }
}

#[test]
fn what_a_protocol_takes_away_the_next_cycles_of_service_no_longer_carry() {
    // Service moves by a fifth of gross slip about the place where the ball was left. Deeper history than that stays.
    let crossland = |history: &[f64]| {
        let mut contact = unit();
        let full = contact.gross_slip_displacement();
        for share in history {
            contact.apply(&displace(share * full)).unwrap();
        }
        let middle = contact.state().displacement;
        let moves = [displace(middle + 0.2 * full), displace(middle - 0.2 * full)];
        let places: Vec<[f64; 3]> = (-60..=60).map(|index| [0.02 * f64::from(index), 0.0, 0.0]).collect();
        let paths = stress_paths(&Cycle::new(&contact, &moves, &|| true).unwrap(), 16, &places);
        paths.iter().map(|path| Criterion::Crossland { alpha: ALPHA }.of(path).value).fold(0.0, f64::max)
    };
    // Pushed to gross slip and back to where it began; or moved back and forth at falling amplitude, 20 reversals.
    let pushed = crossland(&[1.0, 0.0]);
    let relieved = crossland(&falling_amplitude(20, 1.0).collect::<Vec<_>>());
    let virgin = crossland(&[]);
    println!("Crossland over p_max: virgin {virgin:.4}, pushed {pushed:.4}, relieved {relieved:.4}");
    // The numbers of docs/fretting.md.
    for (found, published) in [(virgin, 0.2835), (pushed, 0.3042), (relieved, 0.2836)] {
        assert!((found - published).abs() < 5e-5, "{found} is not {published}");
    }
}

#[test]
fn a_cycle_is_steady_and_its_moves_may_be_split() {
    let moves = [oblique(1.3, 0.2), push(-0.1), press(0.8), oblique(1.0, -0.15)];
    let cycle = cycle(&moves).unwrap();
    let mut contact = unit();
    for step in moves.iter().cycle().take(12) {
        contact.apply(step).unwrap();
    }
    for instants in [1, 5] {
        let states = cycle.states(instants, &|| true).unwrap();
        assert_eq!(states.len(), 4 * instants);
        for step in 0..4 {
            contact.apply(&moves[step]).unwrap();
            let (ours, theirs) = (states[(step + 1) * instants - 1].state(), contact.state());
            assert!(
                (ours.force - theirs.force).abs() < 1e-13 && (ours.displacement - theirs.displacement).abs() < 1e-13
            );
            assert!((ours.elastic_energy - theirs.elastic_energy).abs() < 1e-13);
        }
    }
}

#[test]
fn moves_that_drift_are_no_cycle() {
    let away = Move { relative: true, ..displace(0.1) };
    let deeper = Move { relative: true, ..press(1e-6) };
    assert!(cycle(&[away, displace(0.0), away]).is_ok(), "an absolute move closes it");
    let Err(Error::OpenCycle { quantity, drift }) = cycle(&[away, away]) else { panic!("it drifts") };
    assert!(quantity == Quantity::Displacement && (drift - 0.2).abs() < 1e-12);
    let Err(Error::OpenCycle { quantity, drift }) = cycle(&[displace(0.1), deeper]) else { panic!("it sinks") };
    assert!(quantity == Quantity::Indentation && (drift - 1e-6).abs() < 1e-12);
}

#[test]
fn a_cycle_can_be_interrupted() {
    let moves = [displace(0.1), displace(-0.1)];
    assert!(matches!(Cycle::new(&unit(), &moves, &|| false), Err(Error::Interrupted)));
    let cycle = cycle(&moves).unwrap();
    assert!(matches!(cycle.states(4, &|| false), Err(Error::Interrupted)));
}
