//! The laws that a contact of any shape obeys after any path.

use std::f64::consts::PI;

use stickslip_mechanics::{Contact, Error, Indenter, Move, Normal, Preload, Setup, Springs, Tangential};

use super::draw::Draw;
use super::shapes::Shape;

/// The most moves of a path.
const MOVES: usize = 7;
/// Steps of a move between which its force bounds its work.
const STEPS: u32 = 12;
/// Annuli thinner than this share of the contact radius are not integrated over.
const THIN: f64 = 1e-7;
/// The share of a radius to which a kink of the slip history is known as a plain number, and the error that the cusp of
/// the shear stress makes of it.
const ROUNDED: f64 = 1e-15;
const CUSP: f64 = 1e-7;
/// A radius nearer than this to a singular one, over it, is on neither side of it.
const BESIDE: f64 = 1e-9;

/// Draws a shape, a load and a path, follows it, and panics where a law is broken. Returns whether there was a contact.
pub fn examine(bytes: &[u8]) -> bool {
    let mut draw = Draw(bytes);
    let Ok(shape) = Shape::draw(&mut draw) else { return false };
    let Ok(virgin) = pressed(&shape, &mut draw) else { return false };
    let case = Case { shape: &shape, virgin: &virgin };
    let mut contact = virgin.clone();
    case.pressed(&contact);
    if draw.one_of(4) {
        case.by_its_own_forces(&mut draw);
    }
    for _ in 0..1 + draw.below(MOVES) {
        let step = step(&contact, &mut draw);
        let before = contact.clone();
        match contact.apply(&step) {
            Ok(()) => case.moved(&before, &step, &contact),
            Err(error) => case.refused(&before, &step, &contact, &error),
        }
    }
    case.pressed(&contact);
    case.stressed(&contact, &mut draw);
    case.work_of_the_force(&contact, &mut draw);
    if draw.one_of(10) {
        case.springs(&mut draw);
    }
    true
}

/// A contact at any load: an ordinary one, one that hardly touches, one that ends beside a kink.
fn pressed(shape: &Shape, draw: &mut Draw<'_>) -> Result<Contact, Error> {
    let friction = draw.power(-2.0, 0.3);
    let setup = |preload| Setup { profile: shape.profile.clone(), elasticity: shape.elasticity, friction, preload };
    let preload = match draw.below(8) {
        0 if !shape.kinks.is_empty() => {
            Preload::ContactRadius(shape.kinks[draw.below(shape.kinks.len())] * (1.0 + draw.power(-16.0, 0.0)))
        }
        0 | 1 => Preload::Indentation(shape.depth * draw.power(-16.0, 0.0)),
        2 => Preload::NormalForce(draw.power(-12.0, 2.0)),
        3 => {
            // A load in all digits.
            let contact = Contact::new(setup(Preload::Indentation(shape.depth * draw.power(-4.0, 1.0))))?;
            Preload::NormalForce(contact.normal_force())
        }
        _ => Preload::Indentation(shape.depth * draw.power(-1.5, 1.0)),
    };
    Contact::new(setup(preload))
}

/// The next move of a path.
fn step(contact: &Contact, draw: &mut Draw<'_>) -> Move {
    let state = contact.state();
    let (full, limit) = (contact.gross_slip_displacement(), contact.summary().gross_slip_force);
    let slide = |draw: &mut Draw<'_>| {
        let place = match draw.below(4) {
            0 => -state.displacement * draw.within(0.5, 1.0),
            1 => -state.displacement,
            2 => state.displacement + full * draw.power(-12.0, 0.0) * draw.within(-1.0, 1.0),
            _ => full * draw.within(-1.5, 1.5),
        };
        Some(Tangential::Displacement(place))
    };
    let push = |draw: &mut Draw<'_>| {
        let share = if draw.one_of(6) { 1.0 - draw.power(-12.0, 0.3) } else { draw.within(0.0, 1.0) };
        Some(Tangential::Force(limit * if draw.one_of(2) { -share } else { share }))
    };
    let press = |draw: &mut Draw<'_>| {
        if draw.one_of(2) {
            Some(Normal::NormalForce(state.normal_force * draw.within(0.1, 1.6)))
        } else {
            let share = if draw.one_of(6) { draw.within(-0.3, 0.0) } else { draw.within(0.1, 1.6) };
            Some(Normal::Indentation(state.indentation.abs() * share))
        }
    };
    let (tangential, normal) = match draw.below(16) {
        0..6 => (slide(draw), None),
        6..11 => (push(draw), None),
        11..13 => (None, press(draw)),
        13..15 => (slide(draw), press(draw)),
        _ => (push(draw), press(draw)),
    };
    Move { tangential, normal, ..Move::default() }
}

/// What a law is asked of.
struct Case<'a> {
    shape: &'a Shape,
    virgin: &'a Contact,
}

impl Case<'_> {
    /// Fails with the case.
    fn check(&self, contact: &Contact, held: bool, law: impl FnOnce() -> String) {
        assert!(held, "{}\n{:?}\n{:?}\n{:?}", law(), self.shape.profile, self.virgin.summary(), contact.state());
    }

    /// `found` is `expected` to a part of `unit`.
    fn close(&self, contact: &Contact, what: &str, [found, expected]: [f64; 2], allowed: f64) {
        // A NaN fails as well.
        let held = (found - expected).abs() <= allowed;
        self.check(contact, held, || format!("{what}: {found:e} is not {expected:e} to {allowed:e}"));
    }

    /// `found` is no more than `most`.
    fn at_most(&self, contact: &Contact, what: &str, [found, most]: [f64; 2], allowed: f64) {
        let held = found - most <= allowed;
        self.check(contact, held, || format!("{what}: {found:e} exceeds {most:e} by more than {allowed:e}"));
    }

    /// The laws of normal contact.
    fn pressed(&self, contact: &Contact) {
        let (depth, a, shape) = (contact.indentation(), contact.contact_radius(), self.shape);
        // The closed forms of a table end where it falls, though the sum goes on.
        let falls = |part: &Indenter| part.limit_radius().is_some_and(|limit| limit <= a);
        if depth <= 0.0 || shape.parts.is_empty() || shape.parts.iter().any(falls) {
            return;
        }
        self.check(contact, a <= shape.rim, || format!("the contact radius {a:e} is beyond the rim {:e}", shape.rim));
        if a < shape.rim * (1.0 - BESIDE) {
            self.at_most(contact, "the level at the edge", [shape.level(a * (1.0 - BESIDE)), depth], 1e-11 * depth);
            self.at_most(contact, "the indentation", [depth, shape.level(a * (1.0 + BESIDE))], 1e-11 * depth);
        }
        let lever = |x: f64| (depth - shape.level(x)).clamp(0.0, depth);
        let breaks = breaks(&shape.kinks, a);
        let load = integral(&breaks, |places| places.iter().map(|&x| lever(x)).collect());
        let force = contact.normal_force();
        let sizes: f64 = shape.parts.iter().map(|part| part.level(a).abs()).sum();
        let allowed = 1e-9 * force * (1.0 + 1e-3 * sizes / depth);
        self.close(contact, "F_N", [2.0 * self.shape.elasticity.e_star() * load, force], allowed);
    }

    /// The laws of a move that was followed.
    fn moved(&self, before: &Contact, step: &Move, contact: &Contact) {
        let (from, to) = (before.state(), contact.state());
        let limit = contact.summary().gross_slip_force;
        let loose = 1e-12 + contact.path_error();
        match step.tangential {
            Some(Tangential::Displacement(target)) => {
                self.close(contact, "displacement", [to.displacement, target], 0.0);
            }
            Some(Tangential::Force(target)) => self.close(contact, "force", [to.force, target], loose * limit),
            None | Some(Tangential::Twist(_) | Tangential::Torque(_)) => {
                self.close(contact, "displacement", [to.displacement, from.displacement], 0.0);
            }
        }
        match step.normal {
            Some(Normal::Indentation(target)) => self.close(contact, "indentation", [to.indentation, target], 0.0),
            Some(Normal::NormalForce(target)) => self.close(contact, "F_N", [to.normal_force, target], 0.0),
            None => self.close(contact, "F_N", [to.normal_force, from.normal_force], 0.0),
        }
        self.at_most(contact, "|F| <= mu F_N", [to.force.abs(), limit], 1e-13 * limit);
        self.check(contact, to.dissipated_energy >= from.dissipated_energy, || "friction gave work back".into());
        self.check(contact, to.elastic_energy >= 0.0, || "a negative energy".into());
        self.check(contact, to.stick_radius <= to.contact_radius, || "sticks beyond the edge".into());
    }

    /// A move that was refused has changed nothing, and a force that friction holds is not refused.
    fn refused(&self, before: &Contact, step: &Move, contact: &Contact, error: &Error) {
        self.check(contact, before.state() == contact.state(), || format!("{error} has changed the state"));
        let limit = contact.summary().gross_slip_force;
        let held = |target: f64| target.abs() < limit * (1.0 - 1e-12);
        if let (Some(Tangential::Force(target)), None) = (step.tangential, step.normal) {
            self.check(contact, !held(target), || format!("{step:?} is refused: {error}"));
        }
    }

    /// |tau| <= mu p, largest values, one radius as many, and the forces as integrals.
    fn stressed(&self, contact: &Contact, draw: &mut Draw<'_>) {
        let (a, shape, summary) = (contact.contact_radius(), self.shape, contact.summary());
        if contact.indentation() <= 0.0 || !contact.profile().has_stress_field() || contact.normal_force() <= 0.0 {
            return;
        }
        let residual = contact.residual();
        let mut radii: Vec<f64> = (0..8).map(|_| a * draw.unit()).collect();
        radii.extend((0..4).map(|_| a * (1.0 - draw.power(-16.0, 0.0))));
        radii.extend([0.0, a, a.next_down(), 1.5 * a]);
        for kink in &shape.kinks {
            radii.extend([*kink, kink.next_down(), kink.next_up(), kink * (1.0 + draw.power(-14.0, 0.0))]);
        }
        let cusps: Vec<f64> =
            residual.peaks.iter().map(|peak| peak.radius.abs()).chain([contact.state().stick_radius]).collect();
        radii.extend(&cusps);
        let (pressures, shears) = (contact.pressures(&radii), contact.shears(&radii));
        let mu = contact.friction();
        let area = shape.line.map_or(PI * a * a, |length| 2.0 * a * length);
        let unit = mu * contact.normal_force() / area;
        let largest = [summary.max_pressure, residual.max];
        for (index, &r) in radii.iter().enumerate() {
            let (p, tau) = (pressures[index], shears[index]);
            let bound = mu * p;
            let cusp = cusps.iter().any(|cusp| (r - cusp).abs() < ROUNDED * r);
            let loose = if cusp { CUSP } else { 1e-9 };
            if bound < f64::INFINITY {
                // Beside the edge both are as good as the distance to it is known.
                let loose = loose + 1e-15 * a / (a - r.min(a)).max(f64::MIN_POSITIVE);
                self.at_most(
                    contact,
                    &format!("|tau| <= mu p at {r:e}"),
                    [tau.abs(), bound],
                    loose * bound + 1e-9 * unit,
                );
            }
            let one = [contact.pressure(r), contact.shear(r)];
            for (one, many, name) in [(one[0], p, "p"), (one[1], tau, "tau")] {
                let same = one.to_bits() == many.to_bits() || (one - many).abs() <= loose * (bound + unit);
                self.check(contact, same, || format!("{name} at {r:e}: {one:e} alone, {many:e} among many"));
            }
            if let Some(most) = largest[0] {
                self.at_most(contact, &format!("p <= max_pressure at {r:e}"), [p, most], 1e-6 * most);
            }
            if let Some(most) = largest[1].filter(|_| r <= a) {
                let allowed = 1e-6 * most + 1e-9 * unit;
                self.at_most(contact, &format!("|tau| <= residual.max at {r:e}"), [tau.abs(), most], allowed);
            }
        }
        if let Some(infinite) = self.infinite(contact) {
            let found = summary.max_pressure.is_none();
            self.check(contact, found == infinite, || format!("max_pressure is {:?}", summary.max_pressure));
            self.check(contact, infinite || residual.max.is_some(), || "residual.max is infinite".into());
        }
        let mut inner = shape.kinks.clone();
        // Those of a table that goes on beyond a fall too.
        inner.extend(contact.profile().indenter().knots_below(a));
        inner.extend(residual.peaks.iter().map(|peak| peak.radius.abs()));
        inner.extend((1..6).map(|index| 0.2 * f64::from(index) * a).chain([contact.state().stick_radius]));
        let breaks = breaks(&inner, a);
        let at_edge = |kink: &f64| (kink - a).abs() < THIN * a;
        if breaks.windows(2).any(|pair| pair[1] - pair[0] < THIN * a) || shape.kinks.iter().any(at_edge) {
            // Radii as plain numbers do not tell the places in so thin an annulus apart.
            return;
        }
        let around = |r: f64| shape.line.map_or(2.0 * PI * r, |length| 2.0 * length);
        let force = |stress: &dyn Fn(&[f64]) -> Vec<f64>| {
            integral(&breaks, |places| stress(places).into_iter().zip(places).map(|(s, &r)| s * around(r)).collect())
        };
        let (found, expected) = (force(&|places| contact.pressures(places)), contact.normal_force());
        self.close(contact, "the integral of the pressure", [found, expected], 1e-5 * expected);
        let found = force(&|places| contact.shears(places));
        let limit = summary.gross_slip_force;
        self.close(contact, "the integral of the shear stress", [found, contact.force()], 5e-3 * limit);
    }

    /// Whether the pressure is infinite somewhere, where the document decides that.
    fn infinite(&self, contact: &Contact) -> Option<bool> {
        let (a, depth, shape) = (contact.contact_radius(), contact.indentation(), self.shape);
        if shape.line.is_some() {
            return Some(false);
        }
        let edge = shape.level(shape.rim.min(1e9));
        let beside = |one: f64, other: f64| (one - other).abs() <= BESIDE * other;
        if shape.rim.is_finite() && beside(depth, edge) || shape.spikes.iter().any(|&spike| beside(a, spike)) {
            return None;
        }
        Some(a >= shape.rim * (1.0 - BESIDE) && depth > edge || shape.spikes.iter().any(|&spike| spike < a))
    }

    /// A move at constant load: the work of the force, between its values at the ends of steps, is stored or lost.
    fn work_of_the_force(&self, contact: &Contact, draw: &mut Draw<'_>) {
        let (from, full) = (contact.state(), contact.gross_slip_displacement());
        let way = full * draw.within(-2.5, 2.5);
        let go = |share: f64| {
            let mut probe = contact.clone();
            let target = Some(Tangential::Displacement(from.displacement + share * way));
            probe.apply(&Move { tangential: target, ..Move::default() }).map(|()| probe.state())
        };
        let states: Result<Vec<_>, _> = (0..=STEPS).map(|index| go(f64::from(index) / f64::from(STEPS))).collect();
        let Ok(states) = states else { return };
        let works = states.windows(2).map(|pair| {
            let step = pair[1].displacement - pair[0].displacement;
            let (one, other) = (pair[0].force * step, pair[1].force * step);
            [one.min(other), one.max(other)]
        });
        let [least, most] = works.fold([0.0, 0.0], |sum, work| [sum[0] + work[0], sum[1] + work[1]]);
        let last = states[states.len() - 1];
        let gain = last.elastic_energy - from.elastic_energy + last.dissipated_energy - from.dissipated_energy;
        let size = contact.summary().gross_slip_force * full;
        let allowed = 1e-9 * size + 1e-14 * (from.elastic_energy + from.dissipated_energy);
        self.at_most(contact, "the energy of a move", [gain, most], allowed);
        self.at_most(contact, "the least work of a move", [least, gain], allowed);
    }

    /// A path of equal or falling amplitudes, and the same driven by the forces that it has.
    fn by_its_own_forces(&self, draw: &mut Draw<'_>) {
        let (full, limit) = (self.virgin.gross_slip_displacement(), self.virgin.summary().gross_slip_force);
        let (mut amplitude, fall) =
            (full * draw.within(-1.2, 1.2), if draw.one_of(3) { 1.0 } else { draw.within(0.5, 1.0) });
        let [mut one, mut other] = [self.virgin.clone(), self.virgin.clone()];
        for _ in 0..2 + draw.below(10) {
            let slide = Move { tangential: Some(Tangential::Displacement(amplitude)), ..Move::default() };
            if one.apply(&slide).is_err() || one.force().abs() > 0.999 * limit {
                other.clone_from(&one);
            } else {
                let push = Move { tangential: Some(Tangential::Force(one.force())), ..Move::default() };
                let pushed = other.apply(&push);
                self.check(&one, pushed.is_ok(), || format!("{push:?}: {pushed:?}"));
                let places = [other.displacement(), one.displacement()];
                self.close(&one, "displacement by its own force", places, 1e-9 * full);
            }
            amplitude *= -fall;
        }
        let states = [&one, &other].map(Contact::state);
        let works = states.map(|state| state.dissipated_energy);
        self.close(&one, "work by its own forces", works, 1e-8 * limit * full);
    }

    /// The discrete foundation of the paper on a straight path.
    fn springs(&self, draw: &mut Draw<'_>) {
        let (a, limit) = (self.virgin.stiffness_radius(), self.virgin.summary().gross_slip_force);
        let depth = self.virgin.indentation();
        // Cells that are wider than the annulus beyond a flat do not resolve it.
        let thin = self.shape.kinks.iter().any(|kink| (kink / self.virgin.contact_radius() - 1.0).abs() < 0.02);
        if limit <= 0.0 || thin || !self.virgin.profile().has_stress_field() || self.shape.line.is_some() {
            return;
        }
        let setup = Setup {
            profile: self.shape.profile.clone(),
            elasticity: self.shape.elasticity,
            friction: self.virgin.friction(),
            preload: Preload::Indentation(depth),
        };
        let Ok(mut springs) = Springs::new(setup, 500, a) else { return };
        let mut contact = self.virgin.clone();
        for _ in 0..3 {
            let target = contact.gross_slip_displacement() * draw.within(-1.2, 1.2);
            let slide = Move { tangential: Some(Tangential::Displacement(target)), ..Move::default() };
            if contact.apply(&slide).is_ok() && springs.apply(&slide).is_ok() {
                self.close(&contact, "the force of springs", [springs.force(), contact.force()], 0.03 * limit);
            }
        }
    }
}

/// From zero to the edge `a`, m, by the places inside it.
fn breaks(places: &[f64], a: f64) -> Vec<f64> {
    let mut breaks: Vec<f64> = places.iter().copied().filter(|&r| r > 0.0 && r < a).chain([0.0, a]).collect();
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    breaks
}

/// int f over stretches at whose ends it may be infinite, by the double exponential rule (Takahasi & Mori 1974), with
/// all values of f asked for at once.
fn integral(breaks: &[f64], f: impl Fn(&[f64]) -> Vec<f64>) -> f64 {
    const STEP: f64 = 0.125;
    let (mut places, mut weights) = (Vec::new(), Vec::new());
    for pair in breaks.windows(2) {
        let width = pair[1] - pair[0];
        for index in -26..=26 {
            let t = STEP * f64::from(index);
            let (bent, stretch) = (0.5 * PI * t.sinh(), 0.5 * PI * t.cosh());
            let share = 1.0 / (1.0 + (2.0 * bent.abs()).exp());
            let place = if t < 0.0 { pair[0] + width * share } else { pair[1] - width * share };
            if place > pair[0] && place < pair[1] {
                places.push(place);
                weights.push(STEP * width * 0.5 * stretch / bent.cosh().powi(2));
            }
        }
    }
    f(&places).into_iter().zip(weights).map(|(value, weight)| value * weight).sum()
}
