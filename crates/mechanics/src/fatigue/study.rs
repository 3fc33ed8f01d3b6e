//! Measures of a cycle at many places, each at the instants that matter there.

mod place;

use std::collections::HashMap;
use std::ops::Range;
use std::rc::Rc;

use super::curve::{Allowance, stress};
use super::planes::Vector;
use super::{Cycle, Instant, Measure, Rated};
use crate::cells::shape::Reach;
use crate::contact::Contact;
use crate::profile::Profile;
use crate::range::error::Error;
use crate::subsurface::{Side, Stress, Subsurface};

/// The value of a measure of the surface below the surface.
const NO_VALUE: Rated = Rated { value: f64::NAN, error: 0.0, plane: None, at: None };
/// The part of the accepted error that the curve of a place may use.
const CURVE_SHARE: f64 = 0.5;
/// The part of it that slip and shear stress may each use in a product of both.
const PRODUCT_SHARE: f64 = 0.2;
/// A curve that was not fine enough is followed to this part of what it should have been, and at once to this part of
/// what it was at the least.
const FINER: f64 = 0.5;
const FINEST: f64 = 1e-3;
/// A criterion is resolved at the least to the tolerance times this share of its value under the largest stress.
const LEAST: f64 = 1e-3;
/// The error of a stress by rounding, and by the chords of curved moves, over the largest pressure.
const STRESS_ROUND_OFF: f64 = 1e-12;
const CHORD_ERROR: f64 = 1e-6;
/// Instants closer than this, in parts of a move, are one.
const SAME_INSTANT: f64 = 1e-12;
/// Cells of a profile whose sums a place takes at every instant.
const FEW_CELLS: usize = 64;
/// Places at which the size of the criteria is found first.
const SAMPLED_PLACES: usize = 48;
/// Bytes of fields that are kept for other places, and of the panels that one has on a profile that is no parabola.
pub const FIELD_BYTES: usize = 32 * 1024 * 1024;
const PANEL_BYTES: usize = 256 * 1024;

/// A normal stress of the body along x that goes with the cycle: mean + amplitude cos(th + phase), th growing from 0 to
/// 2 pi over the moves, by as much in each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bulk {
    /// Its mean, Pa.
    pub mean: f64,
    /// Its amplitude, Pa.
    pub amplitude: f64,
    /// Its phase, rad.
    pub phase: f64,
}

/// The largest value of a measure over some places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Largest {
    /// The index of the place.
    pub place: usize,
    /// The value there.
    pub rated: Rated,
}

/// Measures at some places.
#[derive(Clone, Debug, PartialEq)]
pub struct Ratings {
    /// The values of each measure, place by place; infinite where a stress is.
    pub values: Vec<Vec<f64>>,
    /// The largest finite one of each measure.
    pub largest: Vec<Option<Largest>>,
    /// Instants of a move, of that which took most, at the places of the largest values.
    pub instants: usize,
}

/// The stresses at an instant.
struct Field {
    stresses: Subsurface,
    /// The part of the move as prescribed.
    part: f64,
    /// Whether it is kept for other places.
    lasting: bool,
}

/// Measures of a cycle in one of the bodies.
pub struct Study<'a> {
    pub(super) cycle: &'a Cycle,
    pub(super) body: (Side, f64),
    pub(super) bulk: Option<Bulk>,
    /// The depth over which stresses are averaged, m; zero for none.
    pub(super) averaged: f64,
    /// Whether a search stays on the surface.
    pub(super) on_surface: bool,
    pub(super) measures: Vec<Measure>,
    /// Of the largest value of each measure.
    pub(super) tolerance: f64,
    pub(super) keep_going: &'a dyn Fn() -> bool,
    /// The largest contact radius, m, and pressure that stresses are compared with, Pa, with the bulk stress.
    pub(super) radius: f64,
    stress: f64,
    /// The largest displacement over the cycle less the smallest, m.
    travel: f64,
    friction: f64,
    /// The largest value of each measure so far.
    reference: Vec<f64>,
    /// Fields at instants of all places, and at those of one radius.
    shared: HashMap<(usize, u64), Rc<Field>>,
    near: HashMap<(usize, u64), Rc<Field>>,
    near_radius: f64,
    /// How many are kept of each kind.
    kept: usize,
    /// Whether the profile has so few cells that sums over all of them cost less than a few fields.
    has_few_cells: bool,
}

impl<'a> Study<'a> {
    /// Some measures in one of the bodies, with its Poisson's ratio, each to be within `tolerance` of its largest
    /// value; while
    /// `keep_going` returns true.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for Poisson's ratio, and those of [`Contact::subsurface`].
    pub fn new(
        cycle: &'a Cycle,
        body: (Side, f64),
        bulk: Option<Bulk>,
        measures: Vec<Measure>,
        tolerance: f64,
        keep_going: &'a dyn Fn() -> bool,
    ) -> Result<Study<'a>, Error> {
        let ends: Vec<Contact> = cycle.ends().collect();
        for end in &ends {
            end.subsurface(body.0, body.1)?;
        }
        let most = |of: &dyn Fn(&Contact) -> f64| ends.iter().map(of).fold(0.0, f64::max);
        let panels = if matches!(cycle.start().profile(), Profile::Sphere(_)) { 0 } else { PANEL_BYTES };
        let largest = ends.iter().map(Contact::memory_bytes).max().unwrap_or(0);
        let radius = most(&Contact::contact_radius);
        let cells = cycle.start().indenter.cells(Reach::Radius(radius));
        let added = bulk.map_or(0.0, |bulk| bulk.mean.abs() + bulk.amplitude.abs());
        Ok(Study {
            cycle,
            body,
            bulk,
            averaged: 0.0,
            on_surface: false,
            tolerance,
            keep_going,
            radius,
            stress: most(&|end| end.summary().unit_pressure()) + added,
            travel: extent(ends.iter().map(Contact::displacement)),
            friction: cycle.start().friction(),
            reference: vec![0.0; measures.len()],
            measures,
            shared: HashMap::new(),
            near: HashMap::new(),
            near_radius: f64::NAN,
            kept: FIELD_BYTES / 2 / (4 * largest + panels),
            has_few_cells: cells.is_some_and(|cells| cells.cells.len() <= FEW_CELLS),
        })
    }

    /// All measures at all places, m.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub fn rate_all(&mut self, places: &[[f64; 3]]) -> Result<Ratings, Error> {
        let stride = places.len().div_ceil(SAMPLED_PLACES).max(1);
        for place in places.iter().step_by(stride) {
            self.sample(place, true, &[])?;
        }
        let mut values = vec![Vec::with_capacity(places.len()); self.measures.len()];
        let mut largest: Vec<Option<(usize, Rated, usize)>> = vec![None; self.measures.len()];
        for (index, place) in places.iter().enumerate() {
            let (found, instants) = self.rate_some(0..self.measures.len(), place, None)?;
            for ((found, column), largest) in found.into_iter().zip(&mut values).zip(&mut largest) {
                column.push(found.value);
                if found.value.is_finite() && largest.is_none_or(|(_, before, _)| found.value > before.value) {
                    *largest = Some((index, found, instants));
                }
            }
        }
        let instants = largest.iter().flatten().map(|(_, _, instants)| *instants).max().unwrap_or(1);
        let largest = largest
            .into_iter()
            .map(|found| found.map(|(place, found, _)| Largest { place, rated: self.rated(&found) }));
        Ok(Ratings { largest: largest.collect(), values, instants })
    }

    /// The instants at which a place was looked at, with its stresses, Pa.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub fn path(&mut self, place: &[f64; 3]) -> Result<Vec<(Instant, Stress)>, Error> {
        let all = 0..self.measures.len();
        let curve = self.curve(place, all.clone(), self.allowance(all), true)?;
        let mut path: Vec<(Instant, Stress)> = Vec::new();
        let Some(curve) = curve else {
            let infinite = Stress::from_components([f64::NEG_INFINITY; 6]);
            return Ok((0..self.cycle.moves()).map(|step| (Instant { step, part: 1.0 }, infinite)).collect());
        };
        for (instant, sample) in curve.samples() {
            let at = self.prescribed(instant);
            if instant.part > 0.0 && path.last().is_none_or(|last| last.0 != at) {
                path.push((at, stress(sample)));
            }
        }
        Ok(path)
    }

    /// One measure at a place, and how many instants the move took that took most; its plane `near` one, if that is
    /// given, instead of any.
    pub(super) fn rate_one(
        &mut self,
        measure: usize,
        place: &[f64; 3],
        near: Option<Vector>,
    ) -> Result<(Rated, usize), Error> {
        self.rate_some(measure..measure + 1, place, near).map(|(found, instants)| (found[0], instants))
    }

    fn rate_some(
        &mut self,
        wanted: Range<usize>,
        place: &[f64; 3],
        near: Option<Vector>,
    ) -> Result<(Vec<Rated>, usize), Error> {
        let mut allowed = self.allowance(wanted.clone());
        loop {
            let curve = self.curve(place, wanted.clone(), allowed, true)?;
            let mut found = Vec::with_capacity(wanted.len());
            let mut excess = 0.0_f64;
            for index in wanted.clone() {
                let measure = self.measures[index];
                let one = match &curve {
                    // Of the surface alone.
                    _ if place[2] > 0.0 && measure.of_surface() => NO_VALUE,
                    Some(curve) => measure.over(curve, self.friction, near),
                    None => self.infinite(&measure, place),
                };
                if one.value.is_finite() {
                    self.reference[index] = self.reference[index].max(one.value - one.error);
                }
                if !measure.of_surface() {
                    excess = excess.max(one.error / (self.tolerance * self.resolved(index)));
                }
                found.push(one);
                if !(self.keep_going)() {
                    return Err(Error::Interrupted);
                }
            }
            let Some(curve) = curve else { return Ok((found, 1)) };
            // The centre of a ball may be worse off than the stress is; a curve that cannot be followed better is kept.
            let finer = (FINER / excess.max(1.0)).max(FINEST) * allowed.stress.min(curve.error.stress);
            if excess <= 1.0 || finer < self.rounding() || curve.error.stress > allowed.stress {
                return Ok((found, curve.instants()));
            }
            allowed.stress = finer;
        }
    }

    /// The measures at a place over few instants, those that it has for itself left out unless `passes`: lower than
    /// they are, or below what each must `reach` to count.
    pub(super) fn sample(&mut self, place: &[f64; 3], passes: bool, reach: &[f64]) -> Result<Vec<f64>, Error> {
        let any = Allowance { stress: f64::INFINITY, slip: f64::INFINITY };
        let Some(curve) = self.curve(place, 0..self.measures.len(), any, passes)? else {
            return Ok(vec![f64::INFINITY; self.measures.len()]);
        };
        let samples: Vec<Stress> = curve.samples().map(|(_, sample)| stress(sample)).collect();
        let mut values = Vec::with_capacity(self.measures.len());
        for (index, (measure, reference)) in self.measures.iter().zip(&mut self.reference).enumerate() {
            let least = reach.get(index).copied().unwrap_or(0.0);
            let value = match measure {
                Measure::Stress(criterion) => criterion.roughly(&samples, least),
                _ => measure.over(&curve, self.friction, None).value,
            };
            if value >= least {
                *reference = reference.max(value);
            }
            values.push(value);
        }
        Ok(values)
    }

    /// The largest contact radius over the cycle, m.
    #[must_use]
    pub fn contact_radius(&self) -> f64 {
        self.radius
    }

    /// A value with its instant as the move prescribes it.
    pub(super) fn rated(&self, found: &Rated) -> Rated {
        Rated { at: found.at.map(|at| self.prescribed(at)), ..*found }
    }

    fn prescribed(&self, Instant { step, part }: Instant) -> Instant {
        let part = if part > 0.0 { self.cycle.state(step, part).1 } else { 0.0 };
        if part > SAME_INSTANT {
            Instant { step, part }
        } else {
            let before = self.steps().rfind(|other| *other < step).or_else(|| self.steps().next_back());
            Instant { step: before.unwrap_or(step), part: 1.0 }
        }
    }

    /// A measure where the stress is infinite: infinite too, unless it needs slip and there is none.
    fn infinite(&self, measure: &Measure, place: &[f64; 3]) -> Rated {
        let radius = self.cycle.start().coordinate(place);
        let slips = self.cycle.ends().filter_map(|end| end.slip(radius));
        let value = if measure.of_surface() && extent(slips) <= 0.0 { 0.0 } else { f64::INFINITY };
        Rated { value, ..NO_VALUE }
    }

    /// How far the samples of a place may be off.
    fn allowance(&self, wanted: Range<usize>) -> Allowance {
        let mut allowed = Allowance { stress: f64::INFINITY, slip: f64::INFINITY };
        for index in wanted {
            let (measure, reference) = (self.measures[index], self.reference[index]);
            if measure.of_surface() {
                let slip = PRODUCT_SHARE * self.tolerance * reference / (self.friction * self.stress);
                let product = if matches!(measure, Measure::RuizTension) { slip / self.stress } else { slip };
                allowed.slip = allowed.slip.min(product.max(LEAST * self.tolerance * self.travel));
                allowed.stress = allowed.stress.min(PRODUCT_SHARE * self.tolerance * self.stress);
            } else {
                let most = self.resolved(index) / measure.sensitivity(self.stress);
                allowed.stress = allowed.stress.min(CURVE_SHARE * self.tolerance * most);
            }
        }
        Allowance { stress: allowed.stress.max(self.rounding()), ..allowed }
    }

    /// The moves over which something changes: a bulk stress goes on while the contact is held.
    fn steps(&self) -> impl DoubleEndedIterator<Item = usize> {
        let goes_on = self.bulk.is_some_and(|bulk| bulk.amplitude != 0.0);
        (0..self.cycle.moves()).filter(move |step| goes_on || self.cycle.has_length(*step))
    }

    /// The value over which the tolerance of a criterion counts.
    fn resolved(&self, index: usize) -> f64 {
        self.reference[index].max(LEAST * self.measures[index].sensitivity(self.stress) * self.stress)
    }

    /// The error of a stress, Pa, below which no curve is followed.
    fn rounding(&self) -> f64 {
        self.stress * if self.cycle.is_curved() { CHORD_ERROR } else { STRESS_ROUND_OFF }
    }
}

/// The largest of some values less the smallest; below zero for none.
fn extent(values: impl Iterator<Item = f64>) -> f64 {
    let ends = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
    ends[1] - ends[0]
}
