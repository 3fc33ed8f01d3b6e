//! The largest value of a measure over a whole body.
//!
//! Over the surface the measures have ridges along the circles at which the edge of the contact or of a slip ends, and
//! the largest stress may also lie some way below. So places on a net of such circles, of others between them, of
//! angles and of depths are looked at over few instants; from the best of them a search along radius, angle and depth
//! begins, over all instants. By symmetry one half of the body is enough.

use std::f64::consts::PI;

use super::Rated;
use super::planes::Vector;
use super::study::Study;
use crate::range::error::Error;

/// Depths of the net, in contact radii; the first ones, and not the others, on the circles where something ends.
const DEPTHS: [f64; 12] = [0.0, 0.01, 0.03, 0.08, 0.15, 0.25, 0.35, 0.48, 0.65, 0.9, 1.2, 1.7];
const SHALLOW: usize = 4;
/// Angles of the net between the direction of motion and the one against it.
const ANGLES: usize = 13;
/// The largest step from circle to circle, in contact radii, and circles outside.
const STEP: f64 = 0.125;
const OUTSIDE: [f64; 4] = [1.1, 1.25, 1.5, 2.0];
/// Circles nearer than this, in contact radii, are one; and the largest number at which something ends.
const SAME_CIRCLE: f64 = 1e-3;
const MOST_CIRCLES: usize = 32;
/// A depth, in contact radii, at which the contact is hardly felt: where the bulk stress is all that there is.
const FAR: f64 = 100.0;
/// Of the angles, depths and circles, a search that only asks whether a larger value exists takes one in this number.
const SPARSE: usize = 3;
/// Starts of a search for each measure, and the value of one over the best.
const STARTS: usize = 5;
const WORTH: f64 = 0.75;
/// Starts are at least this far apart, in contact radii.
const APART: f64 = 0.2;
/// The first steps along radius, over the contact radius, angle and depth, and how far they fall, first and at the best
/// place.
const FIRST_STEPS: [f64; 3] = [0.06, 0.13, 0.06];
const COARSE: f64 = 1.0 / 16.0;
const FINE: f64 = 1.0 / 4096.0;
/// How often a search may go on with another plane.
const MOST_TURNS: usize = 3;
/// More rounds of the search are taken to gain this many times as much as the last ones.
const LAST_GAINS: f64 = 2.0;

/// A place of the largest value of a measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// The place, m.
    pub place: [f64; 3],
    /// The value, infinite if the measure has no largest one, and the estimated distance from the largest in the body.
    pub rated: Rated,
    /// Instants of the move that took most.
    pub instants: usize,
}

/// Distance from the axis over the contact radius, angle, and depth over the contact radius.
type Coordinates = [f64; 3];

/// The value at a place of a search.
#[derive(Clone, Copy)]
struct Candidate {
    at: Coordinates,
    found: Rated,
    instants: usize,
}

impl Study<'_> {
    /// The place of the largest value of each measure in the body.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub fn worst(&mut self) -> Result<Vec<Worst>, Error> {
        let starts = self.starts(1)?;
        (0..self.measures.len()).map(|measure| self.worst_of(measure, &starts)).collect()
    }

    /// For each measure a place where it is larger than `known` by more than the errors, if a short search finds one.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub fn larger(&mut self, known: &[f64]) -> Result<Vec<Option<Worst>>, Error> {
        let starts = self.starts(SPARSE)?;
        let mut places = Vec::with_capacity(known.len());
        for (measure, known) in known.iter().enumerate() {
            let mut larger = self.unbounded(measure)?;
            if let (None, Some(start)) = (larger, self.best_starts(measure, &starts).first()) {
                let candidate = self.climb(measure, *start, (1.0, 1.0))?.0;
                let margin = candidate.found.error + self.tolerance * candidate.found.value.abs();
                larger = (candidate.found.value - margin > *known).then(|| self.found_at(&candidate));
            }
            places.push(larger);
        }
        Ok(places)
    }

    fn along_line(&self) -> bool {
        self.cycle.start().profile().line().is_some()
    }

    /// The place of the surface where a measure is largest, and those in the plane of the motion where it is infinite.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub fn worst_of_surface(&mut self, measure: usize) -> Result<Vec<[f64; 3]>, Error> {
        self.on_surface = true;
        let found = self.starts(1).and_then(|starts| self.largest_bounded(measure, &starts));
        self.on_surface = false;
        let mut places = vec![found?.place];
        for radius in self.singular_radii() {
            for place in [[radius, 0.0, 0.0], [-radius, 0.0, 0.0]] {
                if self.rate_one(measure, &place, None)?.0.value == f64::INFINITY {
                    places.push(place);
                }
            }
        }
        Ok(places)
    }

    /// Whether a search for the largest value stays on the surface.
    fn is_flat(&self, measure: usize) -> bool {
        self.on_surface || self.measures[measure].of_surface()
    }

    fn found_at(&self, candidate: &Candidate) -> Worst {
        Worst { place: self.place(candidate.at), rated: self.rated(&candidate.found), instants: candidate.instants }
    }

    /// The radii, in contact radii, at which edges of the contact and of slip end, and kinks of the history lie.
    fn circles(&self) -> Vec<f64> {
        let mut circles = Vec::new();
        for state in self.cycle.ends() {
            circles.push(state.contact_radius());
            circles.extend(state.history.kink_levels().flat_map(|level| state.circles_of(level)));
        }
        circles.retain(|radius| *radius > 0.0);
        circles.iter_mut().for_each(|circle| *circle /= self.radius);
        circles.sort_by(|one, other| other.total_cmp(one));
        circles.dedup_by(|one, other| (*one - *other).abs() < SAME_CIRCLE);
        circles.truncate(MOST_CIRCLES);
        circles
    }

    /// The places of the net, one in `stride`, with their values over few instants.
    fn starts(&mut self, every: usize) -> Result<Vec<(Coordinates, Vec<f64>)>, Error> {
        let surface = (0..self.measures.len()).all(|measure| self.is_flat(measure));
        let (special, line) = (self.circles(), self.along_line());
        let between = (0..).map(|index| STEP * f64::from(index)).take_while(|circle| *circle < 1.0);
        let between = between.chain(OUTSIDE).step_by(every).map(|circle| (circle, DEPTHS.len()));
        let circles = special.iter().map(|circle| (*circle, SHALLOW)).chain(between);
        let mut net: Vec<Coordinates> = Vec::new();
        for (circle, depths) in circles {
            for depth in DEPTHS[..if surface { 1 } else { depths }].iter().step_by(every) {
                // Along a line only the two sides differ.
                let most = if line { 2 } else { ANGLES };
                let angles = if circle > 0.0 { most } else { 1 };
                let angle = |index: usize| PI * index as f64 / (most - 1) as f64;
                net.extend(
                    (0..angles).step_by(if line { 1 } else { every }).map(|index| [circle, angle(index), *depth]),
                );
            }
        }
        if !surface {
            net.push([0.0, 0.0, FAR]);
        }
        let mut starts = Vec::with_capacity(net.len());
        // What a start must reach by the best so far.
        let mut reach = vec![0.0_f64; self.measures.len()];
        for at in net {
            let place = self.place(at);
            let values = self.sample(&place, false, &reach)?;
            for (measure, (reach, value)) in reach.iter_mut().zip(&values).enumerate() {
                if value.is_finite() && (at[2] <= 0.0 || !self.is_flat(measure)) {
                    *reach = reach.max(WORTH * value);
                }
            }
            starts.push((at, values));
        }
        Ok(starts)
    }

    /// The best places of the net for a measure, apart from each other, the best first.
    fn best_starts(&self, measure: usize, starts: &[(Coordinates, Vec<f64>)]) -> Vec<Coordinates> {
        let surface = self.is_flat(measure);
        let mut order: Vec<&(Coordinates, Vec<f64>)> =
            starts.iter().filter(|(at, values)| values[measure].is_finite() && (!surface || at[2] <= 0.0)).collect();
        order.sort_by(|one, other| other.1[measure].total_cmp(&one.1[measure]));
        let Some(top) = order.first().map(|(_, values)| values[measure]) else { return Vec::new() };
        let mut best: Vec<Coordinates> = Vec::new();
        for (at, values) in order {
            if best.len() == STARTS || values[measure] < top - (1.0 - WORTH) * top.abs() {
                break;
            }
            let near = |other: &Coordinates| {
                let [one, other] = [*at, *other].map(Self::unit_place);
                one.iter().zip(other).map(|(one, other)| (one - other).powi(2)).sum::<f64>() < APART * APART
            };
            if !best.iter().any(near) {
                best.push(*at);
            }
        }
        best
    }

    fn worst_of(&mut self, measure: usize, starts: &[(Coordinates, Vec<f64>)]) -> Result<Worst, Error> {
        match self.unbounded(measure)? {
            Some(unbounded) => Ok(unbounded),
            None => self.largest_bounded(measure, starts),
        }
    }

    /// The largest finite value that a search finds.
    fn largest_bounded(&mut self, measure: usize, starts: &[(Coordinates, Vec<f64>)]) -> Result<Worst, Error> {
        let mut best: Option<Candidate> = None;
        for start in self.best_starts(measure, starts) {
            let candidate = self.climb(measure, start, (1.0, COARSE))?.0;
            if best.is_none_or(|best| candidate.found.value > best.found.value) {
                best = Some(candidate);
            }
        }
        let start = best.map_or([0.0; 3], |best| best.at);
        let (candidate, gained) = self.climb(measure, start, (COARSE, FINE))?;
        let mut worst = self.found_at(&candidate);
        worst.rated.error += LAST_GAINS * gained;
        Ok(worst)
    }

    /// A place of the surface at which the measure is infinite.
    fn unbounded(&mut self, measure: usize) -> Result<Option<Worst>, Error> {
        for radius in self.singular_radii() {
            let place = [radius, 0.0, 0.0];
            if self.rate_one(measure, &place, None)?.0.value == f64::INFINITY {
                let rated = Rated { value: f64::INFINITY, error: f64::INFINITY, plane: None, at: None };
                return Ok(Some(Worst { place, rated, instants: 1 }));
            }
        }
        Ok(None)
    }

    /// Where the stress of the surface may be infinite, m.
    fn singular_radii(&self) -> Vec<f64> {
        let profile = self.cycle.start().indenter();
        profile.singular_radii().into_iter().chain(profile.rim_radius()).collect()
    }

    fn unit_place([radius, angle, depth]: Coordinates) -> [f64; 3] {
        // Along the motion y is zero to the last bit.
        let (sin, cos) = if angle >= PI { (0.0, -1.0) } else { angle.sin_cos() };
        [radius * cos, radius * sin, depth]
    }

    fn place(&self, at: Coordinates) -> [f64; 3] {
        Self::unit_place(at).map(|part| self.radius * part)
    }

    fn candidate_at(&mut self, measure: usize, at: Coordinates, near: Option<Vector>) -> Result<Candidate, Error> {
        let place = self.place(at);
        let (found, instants) = self.rate_one(measure, &place, near)?;
        Ok(Candidate { at, found, instants })
    }

    /// Climbs along the coordinates in turn, in steps that are halved where none leads up, until they are so small: the
    /// best place, and the gain of the last two rounds. What a round has won is tried once more as a whole (Hooke &
    /// Jeeves 1961), so that a climb along a ridge gains speed.
    fn climb(
        &mut self,
        measure: usize,
        start: Coordinates,
        (mut share, finest): (f64, f64),
    ) -> Result<(Candidate, f64), Error> {
        let mut best = self.candidate_at(measure, start, None)?;
        let (mut gains, mut turns, mut ahead) = ([0.0; 2], 0, None);
        while share >= finest {
            let mut round = best;
            if let Some(ahead) = ahead {
                let ahead = self.candidate_at(measure, ahead, best.found.plane)?;
                if ahead.found.value.is_finite() {
                    round = self.explored(measure, ahead, share)?;
                }
            }
            if round.found.value <= best.found.value {
                round = self.explored(measure, best, share)?;
            }
            let gain = round.found.value - best.found.value;
            let again = |axis: usize| 2.0 * round.at[axis] - best.at[axis];
            ahead = (gain > 0.0).then(|| [again(0).max(0.0), again(1).clamp(0.0, PI), again(2).max(0.0)]);
            (best, gains) = (round, [gains[1], gain]);
            if gain <= 0.05 * self.tolerance * best.found.value.abs() {
                share *= 0.5;
            }
            if share < finest && best.found.plane.is_some() {
                // Another plane may have overtaken the one that was followed.
                let any = self.candidate_at(measure, best.at, None)?;
                if any.found.value > best.found.value * (1.0 + 0.05 * self.tolerance) && turns < MOST_TURNS {
                    (share, turns) = (4.0 * finest, turns + 1);
                }
                best = any;
            }
        }
        Ok((best, gains[0] + gains[1]))
    }

    /// The best of a place and of those that one step along each coordinate in turn, or the vertex of the parabola
    /// through three places, leads to.
    fn explored(&mut self, measure: usize, mut best: Candidate, share: f64) -> Result<Candidate, Error> {
        let axes = if self.is_flat(measure) { 2 } else { 3 };
        for (axis, first_step) in FIRST_STEPS.into_iter().enumerate().take(axes) {
            if axis == 1 && self.along_line() {
                continue;
            }
            let middle = best;
            let mut sides = [None; 2];
            for (side, sign) in sides.iter_mut().zip([1.0, -1.0]) {
                *side = self.step(measure, &middle, axis, sign * share * first_step)?;
                if let Some(candidate) = side.filter(|candidate| candidate.found.value > best.found.value) {
                    best = candidate;
                }
            }
            if let [Some(right), Some(left)] = sides {
                let (rise, fall) = (right.found.value - left.found.value, right.found.value + left.found.value);
                let bend = fall - 2.0 * middle.found.value;
                let vertex = if bend < 0.0 { -0.5 * rise / bend } else { 0.0 };
                if vertex.abs() > 0.02 && vertex.abs() < 1.0 {
                    let length = vertex * share * first_step;
                    let candidate = self.step(measure, &middle, axis, length)?;
                    best = candidate.filter(|candidate| candidate.found.value > best.found.value).unwrap_or(best);
                }
            }
        }
        Ok(best)
    }

    /// The place a step along one coordinate away, unless it leaves the body or is the same.
    fn step(&mut self, measure: usize, from: &Candidate, axis: usize, length: f64) -> Result<Option<Candidate>, Error> {
        let mut at = from.at;
        let most = if axis == 1 { PI } else { f64::INFINITY };
        at[axis] = (at[axis] + length).clamp(0.0, most);
        if (at[axis] - from.at[axis]).abs() <= 0.0 {
            return Ok(None);
        }
        let candidate = self.candidate_at(measure, at, from.found.plane)?;
        Ok(Some(candidate).filter(|candidate| candidate.found.value.is_finite()))
    }
}
