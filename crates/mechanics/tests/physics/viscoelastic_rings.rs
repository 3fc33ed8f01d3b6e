//! Bodies with memory against rings of constant traction on the surface of a half-space, in small steps of time: no
//! transform between x and r, and each ring feels the others.

use std::f64::consts::PI;
use std::sync::Arc;

use stickslip_mechanics::{
    Contact, Elasticity, Friction, Law, Move, Normal, Preload, Profile, Prony, PronyTerm, Setup, Sphere, Tangential,
};

const RINGS: usize = 56;
const STEP: f64 = 0.01;
const E_STAR: f64 = 2.0;
const G_STAR: f64 = 1.6;
const FRICTION: f64 = 0.5;
const TERMS: [(f64, f64); 2] = [(0.4, 0.3), (0.3, 3.0)];
const DEPTH: f64 = 0.01;

/// The complete elliptic integrals of the parameter m, by means.
fn elliptic(m: f64) -> (f64, f64) {
    let (mut a, mut b, mut sum, mut power) = (1.0_f64, (1.0 - m).sqrt(), 0.5 * m, 1.0);
    for _ in 0..12 {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        sum += power * c * c;
        power *= 2.0;
    }
    let k = PI / (2.0 * a);
    (k, k * (1.0 - sum))
}

/// The displacement at r under a pressure 1 over a disc, of a half-space of the modulus 1 (Johnson 1985, eq. 3.29).
fn under_disc(radius: f64, r: f64) -> f64 {
    if r < radius {
        return 4.0 / PI * radius * elliptic(r * r / (radius * radius)).1;
    }
    let m = radius * radius / (r * r);
    let (k, e) = elliptic(m);
    4.0 / PI * r * (e - (1.0 - m) * k)
}

/// The solution of a linear system whose rows end with the right side.
fn solved(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let count = rows.len();
    for column in 0..count {
        let pivot = rows[column].clone();
        for row in &mut rows[column + 1..] {
            let share = row[column] / pivot[column];
            row.iter_mut().zip(&pivot).for_each(|(value, of)| *value -= share * of);
        }
    }
    let mut found = vec![0.0; count];
    for row in (0..count).rev() {
        let known: f64 = (row + 1..count).map(|column| rows[row][column] * found[column]).sum();
        found[row] = (rows[row][count] - known) / rows[row][row];
    }
    found
}

/// One direction of the surface: displacement and memory of each ring.
struct Side {
    modulus: f64,
    u: Vec<f64>,
    v: Vec<[f64; 2]>,
    /// Over a step: s = alpha u + beta, by ring.
    alpha: f64,
    beta: Vec<f64>,
    kernel: [[f64; 2]; 2],
}

impl Side {
    fn new(modulus: f64) -> Side {
        let (u, v, beta) = (vec![0.0; RINGS], vec![[0.0; 2]; RINGS], vec![0.0; RINGS]);
        Side { modulus, u, v, alpha: 0.0, beta, kernel: [[1.0; 2]; 2] }
    }

    fn begin(&mut self, time: f64) {
        // exp(-t/T), and its mean.
        self.kernel = TERMS.map(|(_, of)| {
            let x: f64 = time / of;
            [(-x).exp(), if x > 0.0 { -(-x).exp_m1() / x } else { 1.0 }]
        });
        self.alpha = (0..2).map(|term| TERMS[term].0 * (1.0 - self.kernel[term][1])).sum();
        for ring in 0..RINGS {
            let (u, v) = (self.u[ring], self.v[ring]);
            let part = |term: usize| self.kernel[term][1] * u - self.kernel[term][0] * (u - v[term]);
            self.beta[ring] = (0..2).map(|term| TERMS[term].0 * part(term)).sum();
        }
    }

    /// What K p is of a ring whose displacement becomes u.
    fn wanted(&self, ring: usize, u: f64) -> f64 {
        ((1.0 - self.alpha) * u - self.beta[ring]) * self.modulus
    }

    fn end(&mut self, matrix: &[Vec<f64>], tractions: &[f64]) {
        for ring in 0..RINGS {
            let u = self.free(ring, matrix, tractions);
            let old = self.u[ring];
            for term in 0..2 {
                let [decay, mean] = self.kernel[term];
                self.v[ring][term] = u - (u - old) * mean - decay * (old - self.v[ring][term]);
            }
            self.u[ring] = u;
        }
    }

    /// The displacement of a ring under all tractions.
    fn free(&self, ring: usize, matrix: &[Vec<f64>], tractions: &[f64]) -> f64 {
        let pressed: f64 = matrix[ring].iter().zip(tractions).map(|(of, traction)| of * traction).sum();
        (pressed / self.modulus + self.beta[ring]) / (1.0 - self.alpha)
    }
}

struct Rings {
    edges: Vec<f64>,
    places: Vec<f64>,
    matrix: Vec<Vec<f64>>,
    normal: Side,
    along: Side,
    p: Vec<f64>,
    q: Vec<f64>,
    moved: f64,
}

impl Rings {
    fn new() -> Rings {
        let width = 1.12 * DEPTH.sqrt() / RINGS as f64;
        let edges: Vec<f64> = (0..=RINGS).map(|ring| width * ring as f64).collect();
        let places: Vec<f64> = (0..RINGS).map(|ring| width * (ring as f64 + 0.5)).collect();
        let row = |r: &f64| -> Vec<f64> {
            let inner = |ring: usize| if ring == 0 { 0.0 } else { under_disc(edges[ring], *r) };
            (0..RINGS).map(|ring| under_disc(edges[ring + 1], *r) - inner(ring)).collect()
        };
        let matrix = places.iter().map(row).collect();
        let (normal, along, zero) = (Side::new(E_STAR), Side::new(G_STAR), vec![0.0; RINGS]);
        Rings { edges, places, matrix, normal, along, p: zero.clone(), q: zero, moved: 0.0 }
    }

    /// The tractions of some rings for which K p is wanted, those of the others being given.
    fn tractions(&self, of: &[usize], wanted: impl Fn(usize) -> f64, given: &[f64]) -> Vec<f64> {
        let row = |&ring: &usize| -> Vec<f64> {
            let others = (0..RINGS).filter(|other| !of.contains(other));
            let rest: f64 = others.map(|other| self.matrix[ring][other] * given[other]).sum();
            of.iter().map(|other| self.matrix[ring][*other]).chain([wanted(ring) - rest]).collect()
        };
        let mut all = given.to_vec();
        solved(of.iter().map(row).collect()).into_iter().zip(of).for_each(|(found, ring)| all[*ring] = found);
        all
    }

    fn step(&mut self, depth: f64, moved: f64, time: f64) {
        self.normal.begin(time);
        let target = |rings: &Rings, ring: usize| depth - 0.5 * rings.places[ring] * rings.places[ring];
        let before: Vec<bool> = self.p.iter().map(|p| *p > 0.0).collect();
        let mut inside = before.clone();
        for _ in 0..60 {
            let of: Vec<usize> = (0..RINGS).filter(|ring| inside[*ring]).collect();
            let wanted = |ring: usize| self.normal.wanted(ring, target(self, ring));
            self.p = self.tractions(&of, wanted, &[0.0; RINGS]);
            let keeps = |ring: usize| match inside[ring] {
                true => self.p[ring] >= 0.0,
                false => self.normal.free(ring, &self.matrix, &self.p) < target(self, ring),
            };
            let next: Vec<bool> = (0..RINGS).map(keeps).collect();
            if next == inside {
                break;
            }
            inside = next;
        }
        self.normal.end(&self.matrix, &self.p);

        self.along.begin(time);
        let way = moved - self.moved;
        // A ring that touches in this step carries nothing yet.
        let mut sign: Vec<f64> = (0..RINGS).map(|ring| if inside[ring] && before[ring] { 0.0 } else { 2.0 }).collect();
        for _ in 0..200 {
            let of: Vec<usize> = (0..RINGS).filter(|ring| sign[*ring] == 0.0).collect();
            let bound = |ring: usize| if sign[ring].abs() < 1.5 { sign[ring] * FRICTION * self.p[ring] } else { 0.0 };
            let given: Vec<f64> = (0..RINGS).map(bound).collect();
            self.q = self.tractions(&of, |ring| self.along.wanted(ring, self.along.u[ring] + way), &given);
            let next = |ring: usize| {
                let limit = FRICTION * self.p[ring];
                if sign[ring] == 0.0 && self.q[ring].abs() > limit {
                    return self.q[ring].signum();
                }
                let slip = way - (self.along.free(ring, &self.matrix, &self.q) - self.along.u[ring]);
                let back = sign[ring].abs() > 0.5 && slip * sign[ring] < -1e-14;
                if back { 0.0 } else { sign[ring] }
            };
            let next: Vec<f64> = (0..RINGS).map(next).collect();
            if next == sign {
                break;
            }
            sign = next;
        }
        self.along.end(&self.matrix, &self.q);
        self.moved = moved;
    }

    fn force(&self, tractions: &[f64]) -> f64 {
        let area = |ring: usize| PI * (self.edges[ring + 1].powi(2) - self.edges[ring].powi(2));
        (0..RINGS).map(|ring| tractions[ring] * area(ring)).sum()
    }
}

fn contact(memory: Option<Arc<Prony>>) -> Contact {
    Contact::new(Setup {
        profile: Profile::Sphere(Sphere::new(1.0).unwrap()),
        elasticity: Elasticity::effective(E_STAR, G_STAR).unwrap(),
        friction: Law { limit: Friction::from(FRICTION), memory },
        preload: Preload::Indentation(DEPTH),
    })
    .unwrap()
}

#[test]
fn springs_with_memory_are_the_rings_of_a_half_space_through_slip_lift_off_and_the_dent() {
    let terms = TERMS.map(|(ratio, time)| PronyTerm { ratio, time });
    let mut springs = contact(Some(Arc::new(Prony::new(&terms).unwrap())));
    let mut elastic = contact(None);
    let (unit, scale) = (elastic.normal_force(), elastic.gross_slip_displacement());
    let mut rings = Rings::new();
    rings.step(DEPTH, 0.0, 0.0);
    assert!((rings.force(&rings.p) / unit - 1.0).abs() < 1e-3, "{} {unit}", rings.force(&rings.p));
    // Shear, wait, back under less load, lift off, wait, press on the dent that is left, shear again.
    let legs = [
        (DEPTH, 0.5, 0.5),
        (DEPTH, 0.5, 1.0),
        (0.6 * DEPTH, 0.1, 0.6),
        (-0.1 * DEPTH, 0.1, 0.3),
        (-0.1 * DEPTH, 0.1, 0.5),
        (0.8 * DEPTH, 0.1, 1.0),
        (0.8 * DEPTH, 0.4, 0.5),
    ];
    let (mut here, mut most) = ([DEPTH, 0.0], 0.0_f64);
    for (index, (depth, share, time)) in legs.into_iter().enumerate() {
        let (target, count) = (share * scale, (time / STEP).round());
        for step in 1..=count as usize {
            let part = step as f64 / count;
            let at = |from: f64, to: f64| from + part * (to - from);
            rings.step(at(here[0], depth), at(here[1], target), time / count);
        }
        here = [depth, target];
        let tangential = Some(Tangential::Displacement(target));
        let to = Move { tangential, normal: Some(Normal::Indentation(depth)), ..Move::default() };
        springs.apply(&Move { duration: time, ..to }).unwrap();
        elastic.apply(&to).unwrap();
        let found = [springs.normal_force() / unit, springs.force() / (FRICTION * unit)];
        let expected = [rings.force(&rings.p) / unit, rings.force(&rings.q) / (FRICTION * unit)];
        let error = [0, 1].map(|of: usize| (found[of] - expected[of]).abs());
        assert!(error[0] < 1e-4 && error[1] < 3e-4, "{index}: {found:?} {expected:?}");
        most = most.max((elastic.normal_force() / unit - expected[0]).abs());
    }
    assert!(most > 0.2 && !springs.beyond_annulus(), "elastic bodies are not as these: {most}");
}
