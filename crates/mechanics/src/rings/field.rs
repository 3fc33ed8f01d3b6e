//! Stresses, slip and friction work over the radius at the end of a path.
//!
//! What the rings have is taken at the middle of their area and drawn straight in r^2 from ring to ring; a traction as
//! its share of mu p, so that it is mu p where the ring slips, whatever the pressure does within it.

use super::discretisation::Discretisation;
use super::follow::Scene;
use super::solution::{Solution, extrapolated};
use super::step::RingState;
use super::stiffness::Vector;
use crate::contact::Contact;

/// The stress error over the difference that twice as many rings make: beside the edge of the stick zone the stress
/// is a root, whose error goes with N^(-1/2).
const BESIDE_STICK: f64 = 4.0;

#[derive(Clone, Debug)]
pub(super) struct Field {
    reach: f64,
    /// Traction over mu p, of the rings in contact.
    ratio: Vec<Vector>,
    slip: Vec<Vector>,
    /// Friction work per area, J/m^2, as vectors along x.
    work: Vec<Vector>,
    stress_error: f64,
    /// The contact under the load at the end.
    pressed: Contact,
    /// The exact contact at the end of a path along one line, and its direction.
    line: Option<(Contact, Vector)>,
}

impl Field {
    pub(super) fn new(scene: &Scene<'_>, runs: &[Discretisation; 4]) -> Field {
        let [one, two, four, fine] = runs;
        let (count, coarse) = (fine.matrix.count, one.matrix.count);
        // What more steps change on the few rings.
        let refined = |of: &dyn Fn(&Discretisation, usize) -> Vector| -> Vec<Vector> {
            let refined = |ring: usize, axis: usize| {
                extrapolated([one, two, four].map(|run| of(run, ring)[axis])) - of(one, ring)[axis]
            };
            (0..coarse).map(|ring| [0, 1].map(|axis| refined(ring, axis))).collect()
        };
        let blended = |of: &dyn Fn(&Discretisation, usize) -> Vector| -> Vec<Vector> {
            let change = refined(of);
            let at = |ring: usize| {
                let (own, change) = (of(fine, ring), between(&change, middle(ring, count)));
                [own[0] + change[0], own[1] + change[1]]
            };
            (0..count).map(at).collect()
        };
        let ratio_of = |run: &Discretisation, ring: usize| {
            let RingState { bound, traction, .. } = run.rings[ring];
            traction.map(|component| if bound > 0.0 { component / bound } else { 0.0 })
        };
        let mut ratio = blended(&ratio_of);
        for ratio in &mut ratio {
            let size = ratio[0].hypot(ratio[1]).max(1.0);
            *ratio = ratio.map(|component| component / size);
        }
        // Friction times the largest pressure on a ring, as a force.
        let area = std::f64::consts::PI * scene.reach * scene.reach / count as f64;
        let largest = scene.contact.friction() * scene.pressed.summary().unit_pressure() * area;
        let of_few: Vec<Vector> = (0..coarse).map(|ring| ratio_of(one, ring)).collect();
        let change = refined(&ratio_of);
        let error = |ring: usize| {
            let (own, few) = (ratio_of(fine, ring), between(&of_few, middle(ring, count)));
            let [x, y] = between(&change, middle(ring, count));
            let error = BESIDE_STICK * (own[0] - few[0]).hypot(own[1] - few[1]) + 0.5 * x.hypot(y);
            if largest.is_finite() && largest > 0.0 { error * (fine.rings[ring].bound / largest).min(1.0) } else { 0.0 }
        };
        let stress_error = (0..count).map(error).fold(0.0, f64::max);
        ratio.truncate(fine.touching());
        let of_slip = |run: &Discretisation, ring: usize| run.slipped[ring];
        let of_work = |run: &Discretisation, ring: usize| {
            let rings = run.matrix.count as f64 / count as f64;
            [run.dissipated[ring] / area * rings, 0.0]
        };
        let (slip, work) = (blended(&of_slip), blended(&of_work));
        Field { reach: scene.reach, ratio, slip, work, stress_error, pressed: scene.pressed.clone(), line: None }
    }

    /// At the end of a path along one line.
    pub(super) fn along_line(scene: &Scene<'_>, contact: Contact, direction: Vector) -> Field {
        let (ratio, slip, work) = (Vec::new(), Vec::new(), Vec::new());
        let line = Some((contact, direction));
        Field { reach: scene.reach, ratio, slip, work, stress_error: 0.0, pressed: scene.pressed.clone(), line }
    }

    fn share(&self, radius: f64) -> f64 {
        (radius / self.reach).powi(2)
    }

    fn touches(&self, radius: f64) -> bool {
        self.pressed.indentation() > 0.0 && radius <= self.pressed.contact_radius()
    }
}

/// The middle of a ring, as a share of the area of all.
fn middle(ring: usize, count: usize) -> f64 {
    (ring as f64 + 0.5) / count as f64
}

/// The value at a share of the area, straight between the middles of the rings.
fn between(values: &[Vector], share: f64) -> Vector {
    let Some(last) = values.len().checked_sub(1) else { return [0.0; 2] };
    let place = (share * values.len() as f64 - 0.5).clamp(0.0, last as f64);
    let index = (place as usize).min(last.saturating_sub(1));
    let part = place - index as f64;
    let next = values[(index + 1).min(last)];
    [0, 1].map(|axis| values[index][axis] + part * (next[axis] - values[index][axis]))
}

/// What is known over the radius at the end of the path, at radii of at least zero, m.
impl Solution {
    /// Estimated error of the shear stress, over mu times the largest pressure (or the mean where that is infinite).
    #[must_use]
    pub fn stress_error(&self) -> f64 {
        self.field.stress_error
    }

    /// The contact under the load at the end of the path, without its tangential history: for the pressure.
    #[must_use]
    pub fn pressed(&self) -> &Contact {
        &self.field.pressed
    }

    /// Shear stress along x and y, Pa, at each of `radii`, m; at most mu p, and zero outside the contact.
    #[must_use]
    pub fn shears(&self, radii: &[f64]) -> Vec<[f64; 2]> {
        let Field { ratio, pressed, line, .. } = &self.field;
        if let Some((contact, direction)) = line {
            return contact.shears(radii).into_iter().map(|shear| direction.map(|part| part * shear + 0.0)).collect();
        }
        let shear = |(&radius, pressure): (&f64, f64)| {
            // The rings in contact are fewer than all where the contact was larger.
            let part = self.field.share(radius) * self.count as f64 / ratio.len().max(1) as f64;
            let share = between(ratio, part);
            let bound = pressed.friction() * pressure;
            if self.field.touches(radius) && bound > 0.0 { share.map(|share| share * bound + 0.0) } else { [0.0; 2] }
        };
        radii.iter().zip(pressed.pressures(radii)).map(shear).collect()
    }

    /// Slip of the indenter over the surface since the start along x and y, m; `None` outside the contact. Where the
    /// contact grew later, it includes what the indenter moved before it touched.
    #[must_use]
    pub fn slip(&self, radius: f64) -> Option<[f64; 2]> {
        if let Some((contact, direction)) = &self.field.line {
            return contact.slips(&[radius])[0].map(|slip| direction.map(|part| part * slip + 0.0));
        }
        self.field.touches(radius).then(|| between(&self.field.slip, self.field.share(radius)).map(|slip| slip + 0.0))
    }

    /// Friction work per area since the start, J/m^2; zero outside the largest contact of the path, and not a number
    /// along one line, where no rings keep it.
    #[must_use]
    pub fn friction_work(&self, radius: f64) -> f64 {
        let Field { work, reach, line, .. } = &self.field;
        if line.is_some() {
            return f64::NAN;
        }
        if radius > *reach { 0.0 } else { between(work, self.field.share(radius))[0].max(0.0) }
    }
}
