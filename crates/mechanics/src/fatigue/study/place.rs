//! The stresses of a place over a cycle, by fields that other places share and by sums of its own.

use std::f64::consts::TAU;
use std::ops::Range;
use std::rc::Rc;

use super::super::Measure;
use super::super::critical_distance::mean_over_depth;
use super::super::curve::{Allowance, CurveStretch, StressCurve, StressSample};
use super::{Bulk, Field, SAME_INSTANT, Study};
use crate::range::error::Error;
use crate::subsurface::{PlaceSums, Stress};

/// Depth, in contact radii, below which the passing of an edge is as smooth as all else.
const DEEP: f64 = 0.3;
/// The part of the accepted error that a mean over the depth may use.
const AVERAGING_SHARE: f64 = 0.05;
/// Rings of a state up to which a place adds them up one by one.
const FEW_RINGS: usize = 32;

impl Study<'_> {
    /// The curve of a place, m, for some measures; `None` where a stress is infinite.
    pub(super) fn curve(
        &mut self,
        place: &[f64; 3],
        wanted: Range<usize>,
        allowed: Allowance,
        passes: bool,
    ) -> Result<Option<StressCurve>, Error> {
        let radius = self.cycle.start().coordinate(place);
        if radius.to_bits() != self.near_radius.to_bits() {
            self.near.clear();
            self.near_radius = radius;
        }
        let near = passes && place[2] <= DEEP * self.radius;
        let level = self.cycle.start().level_at(radius);
        let mut stretches = Vec::new();
        for step in self.steps() {
            let turns = self.cycle.turns(step);
            let passes = if near && level.is_finite() { self.cycle.passes(step, level) } else { Vec::new() };
            let mut ends: Vec<(f64, bool)> = turns.iter().map(|part| (*part, true)).collect();
            ends.extend(passes.iter().map(|part| (*part, false)));
            ends.push((1.0, true));
            ends.sort_by(|one, other| one.0.total_cmp(&other.0));
            let mut from = (0.0, true);
            for to in ends {
                if to.0 - from.0 > SAME_INSTANT {
                    stretches.push((CurveStretch { step, from: from.0, to: to.0 }, from.1 && to.1));
                    from = to;
                }
            }
        }
        let surface = place[2] <= 0.0 && self.measures[wanted].iter().any(Measure::of_surface);
        // Noise that the curve does not see.
        let averaging = (AVERAGING_SHARE * allowed.stress.min(self.stress)).max(self.rounding());
        let mut averaging_error = 0.0_f64;
        let mut sums = None;
        let mut curve = StressCurve::follow(&stretches, allowed, |step, part, shared| {
            let field = self.field(step, part, shared)?;
            let (stress, off) = if self.averaged > 0.0 {
                mean_over_depth(&field.stresses, *place, self.averaged, averaging)
            } else {
                (self.stress(&field, *place, &mut sums), 0.0)
            };
            averaging_error = averaging_error.max(off);
            Ok(self.looked_at(&field, stress, step, (radius, surface)))
        })?;
        curve.iter_mut().for_each(|curve| curve.error.stress += averaging_error);
        Ok(curve)
    }

    /// The stress at a place. By the sums of the place, which are kept, unless a profile of many cells is asked for in
    /// lasting fields alone.
    fn stress(&self, field: &Field, place: [f64; 3], sums: &mut Option<PlaceSums>) -> Stress {
        let Field { stresses: field, lasting, .. } = field;
        if (!lasting || self.has_few_cells) && sums.is_none() && field.contact.memory_depth() <= FEW_RINGS {
            *sums = field.place_sums(place, self.radius);
        }
        match sums {
            Some(sums) if field.contact.memory_depth() <= FEW_RINGS => field.stress_by(sums, place),
            _ => field.stress(place),
        }
    }

    /// The field at an instant.
    fn field(&mut self, step: usize, part: f64, shared: bool) -> Result<Rc<Field>, Error> {
        let fields = if shared { &mut self.shared } else { &mut self.near };
        if let Some(field) = fields.get(&(step, part.to_bits())) {
            return Ok(field.clone());
        }
        if !(self.keep_going)() {
            return Err(Error::Interrupted);
        }
        let (state, prescribed) = self.cycle.state(step, part);
        let kept = fields.len() < self.kept;
        let stresses = state.into_subsurface(self.body.0, self.body.1)?;
        let field = Rc::new(Field { stresses, part: prescribed, lasting: shared && kept });
        if kept {
            fields.insert((step, part.to_bits()), field.clone());
        }
        Ok(field)
    }

    /// The sample of a place with its stress at an instant, and whether it is in contact.
    fn looked_at(
        &self,
        field: &Field,
        Stress { mut xx, yy, zz, xy, yz, xz }: Stress,
        step: usize,
        (radius, surface): (f64, bool),
    ) -> (StressSample, bool) {
        let Field { stresses: field, part, .. } = field;
        if let Some(Bulk { mean, amplitude, phase }) = self.bulk {
            xx += mean + amplitude * (TAU * (step as f64 + part) / self.cycle.moves() as f64 + phase).cos();
        }
        let contact = &field.contact;
        let edge = contact.contact_radius();
        let touched = contact.indentation() > 0.0 && radius.abs() <= edge * (1.0 + SAME_INSTANT);
        let [mut pressure, mut shear, mut slip] = [0.0; 3];
        if surface && touched {
            pressure = contact.pressure(radius);
            shear = contact.shear(radius);
            slip = contact.slip(radius.clamp(-edge, edge)).unwrap_or(0.0);
        }
        ([xx, yy, zz, xy, yz, xz, pressure, shear, slip], touched)
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::{Criterion, Cycle, Measure, Study};
    use crate::cells::call_count::during;
    use crate::profile::{PowerLaw, Sum};
    use crate::subsurface::Side;
    use crate::{Contact, Elasticity, Move, Preload, Profile, Setup, Tangential};

    #[test]
    fn a_criterion_of_stress_takes_no_slip_and_no_measure_does_below_the_surface() {
        let law = |exponent, coefficient| Profile::PowerLaw(PowerLaw::new(exponent, coefficient).unwrap());
        let profile = Profile::Sum(Sum::new(vec![law(1.3, 0.2), law(2.7, 4e4), law(5.3, 3e15)]).unwrap());
        let elasticity = Elasticity::effective(2e11, 1.7e11).unwrap();
        let preload = Preload::ContactRadius(1e-4);
        let contact = Contact::new(Setup { profile, elasticity, friction: 0.3, preload }).unwrap();
        let slide = 0.7 * contact.gross_slip_displacement();
        let moves =
            [slide, -slide].map(|to| Move { tangential: Some(Tangential::Displacement(to)), ..Move::default() });
        let cycle = Cycle::new(&contact, &moves, &|| true).unwrap();
        let measures = vec![Measure::Stress(Criterion::Crossland { alpha: 0.3 }), Measure::Ruiz];
        let mut study = Study::new(&cycle, (Side::Second, 0.3), None, measures, 1e-6, &|| true).unwrap();
        for place in [[8e-5, 0.0, 0.0], [5e-5, 3e-5, 1e-6], [0.0, 2e-5, 4e-5]] {
            let (calls, _) = during(|| study.rate_one(0, &place, None).unwrap());
            assert_eq!(calls.displacement_integral, 0, "at {place:?}");
            let (calls, _) = during(|| study.rate_one(1, &place, None).unwrap());
            assert_eq!(calls.displacement_integral > 0, place[2] <= 0.0, "at {place:?}");
        }
    }
}
