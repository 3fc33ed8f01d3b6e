//! A record of the bench as branches between turning points, thinned, and the faults that show before any fit.

use super::gaps::{gaps, loosen_inner_turns};
use super::loading_curve::{Bench, LoadingCurve};
use super::reversals::{Reversals, extent, reversals};
use super::sampled_curve::SampledCurve;
use super::turns::{Form, corner_share, form};
use super::velocity::Velocity;
use super::{Error, FEWEST_POINTS, MOST_POINTS, Record, Start, quantised};
use crate::robust::{median, quantile};
use stickslip_mechanics::{Contact, Preload, Setup, range};

/// Forces are compared after this share at either end is left out: outliers.
const OUTLYING: f64 = 0.02;
/// The largest friction coefficient that is believed.
const MOST_FRICTION: f64 = 10.0;
/// How far the measured stiffness may be from that of the definition before the units are questioned.
const MOST_STIFFNESS_RATIO: f64 = 200.0;
/// A record may end short of a turn by this share of its last step.
const END_SHARE: f64 = 0.5;
/// Turns agree within this many standard deviations.
pub(super) const AGREE: f64 = 3.0;
/// The stiffness after a reversal is that of this share of the branch.
const FIRST_SHARE: f64 = 0.1;

/// A point of the record, on its branch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    /// As measured, m.
    pub(super) measured: f64,
    /// That to which the force belongs: the delay earlier, m.
    pub(super) displacement: f64,
    pub(super) force: f64,
    pub(super) time: f64,
    /// The velocity of the displacement, m/s.
    pub(super) rate: f64,
    /// How far the displacement most likely was from where it was measured, m, and what that makes in the force, N.
    pub(super) shift: f64,
    pub(super) by_shift: f64,
    /// Zero up to the first turning point, and so on.
    pub(super) branch: usize,
}

/// Where the displacement turns, or the record ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turn {
    /// As it would be measured, m.
    pub(super) displacement: f64,
    pub(super) time: f64,
    /// What the corner of a turn is beyond its vertex, m, and how far the turn may be from either.
    pub(super) corner: f64,
    pub(super) error: f64,
    /// Its column among the parameters.
    pub(super) column: Option<usize>,
}

/// A record that can be fitted.
#[derive(Clone, Debug)]
pub(super) struct Branches {
    pub(super) samples: Vec<Sample>,
    pub(super) turns: Vec<Turn>,
    pub(super) rising: bool,
    pub(super) start: Start,
    pub(super) weight: f64,
    /// Standard deviation of the noise of the displacement, m: as given, or the most that it may be.
    pub(super) noise: f64,
    /// The drift of the displacement, m/s, as far as it was known before.
    pub(super) drift: f64,
    /// The delay of the force, s, that the displacements of the samples allow for.
    pub(super) delay: f64,
    /// Where between vertex and corner the turns are, with its standard deviation.
    pub(super) corner_share: [f64; 2],
    /// The time between two points, s; one where points are counted.
    pub(super) step: f64,
    /// Whether it has times.
    pub(super) timed: bool,
    /// The step of a displacement that was rounded, m.
    pub(super) displacement_step: Option<f64>,
    /// Whether a turn lies where points are missing.
    pub(super) turn_in_gap: bool,
    /// The highest and the lowest places, ends included.
    pub(super) extremes: [Turn; 2],
    /// The virgin contact at the load of the record.
    pub(super) contact: Contact,
    /// Its first loading.
    pub(super) curve: SampledCurve,
    /// Half the range of the force without its extremes, N.
    pub(super) half_force: f64,
    /// The middle of that range, N.
    pub(super) middle_force: f64,
    /// Stiffness just after reversals, N/m; zero if no branch shows it.
    pub(super) stiffness: f64,
}

/// What the times of a record mean.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    /// The drift of the displacement, m/s, as far as it is known.
    pub(super) drift: f64,
    /// The delay of the force, s, as far as it is known.
    pub(super) delay: f64,
    /// Whether the points of a record without times are counted: no record has times.
    pub(super) counts: bool,
}

impl Branches {
    /// Finds the branches of a record, and thins it.
    pub(super) fn new(
        record: &Record,
        index: usize,
        contact: &Contact,
        noise: Option<f64>,
        (clock, with_strength): (Clock, bool),
    ) -> Result<Branches, Error> {
        let Record { displacement, force, normal_force, start, weight, .. } = record;
        let contact = contact.pressed(normal_force.unwrap_or(contact.normal_force()))?;
        if contact.normal_force() <= 0.0 {
            return Err(Error::NoContact { record: Some(index) });
        }
        if displacement.len() < FEWEST_POINTS || displacement.len() != force.len() {
            return Err(Error::TooFewPoints { record: index });
        }
        let span = |(low, high): (f64, f64)| high - low;
        if span(extent(displacement)) <= 0.0 {
            return Err(Error::ConstantDisplacement { record: index });
        }
        let low = quantile(&mut force.clone(), OUTLYING);
        let high = quantile(&mut force.clone(), 1.0 - OUTLYING);
        if high <= low {
            return Err(Error::ConstantForce { record: index });
        }
        let timed = record.time.is_some();
        let (times, drift, delay) = match clock {
            Clock { drift, delay, .. } if timed => (times(record), drift, delay),
            _ => (times(record), 0.0, 0.0),
        };
        // A drift hides where the machine turns.
        let level: Vec<f64> = displacement.iter().zip(&times).map(|(u, time)| u - drift * time).collect();
        let displacement_step = quantised::displacement_step(displacement);
        let rounding = displacement_step.map_or(0.0, |step| quantised::variance(step).sqrt());
        let Reversals { at, rising, noise } = reversals(&level, noise.map(|noise| noise.hypot(rounding)));
        let noise = noise.max(rounding);
        if at.is_empty() {
            return Err(Error::SingleBranch { record: index });
        }
        let mut forms = forms(&times, &level, &at, noise);
        let gaps = gaps(&times, &level, (&at, noise), timed);
        gaps.iter().zip(&mut forms).for_each(|(gap, form)| gap.time.into_iter().for_each(|time| form.time = time));
        let corner_share = corner_share(&forms, noise);
        let time = |time: f64| if timed || clock.counts { time } else { 0.0 };
        let mut turns: Vec<Turn> = forms
            .iter()
            .zip(&gaps)
            .map(|(form, gap)| {
                let corner = form.corner - form.vertex;
                Turn {
                    displacement: form.vertex + corner_share[0] * corner + drift * form.time,
                    time: time(form.time),
                    corner,
                    error: form.error.hypot(gap.hidden),
                    column: None,
                }
            })
            .collect();
        let turn_in_gap = gaps.iter().any(|gap| gap.is_long) | loosen_inner_turns(&mut turns, rising, drift);
        let last = displacement.len() - 1;
        let ends = [(0, 1), (last, last - 1)].map(|(end, beside)| Turn {
            displacement: displacement[end],
            time: time(times[end]),
            corner: 0.0,
            error: noise.hypot(END_SHARE * (level[end] - level[beside])),
            column: None,
        });
        let (Some(highest), Some(lowest)) =
            (extreme(&turns, &ends, rising, drift, 1.0), extreme(&turns, &ends, rising, drift, -1.0))
        else {
            return Err(Error::SingleBranch { record: index });
        };
        let at = last_samples(&times, &forms, delay);
        let ends = last_samples(&times, &forms, 0.0);
        let velocity = Velocity::new(&times, displacement, &ends, [span(extent(displacement)), noise]);
        let every = displacement.len().div_ceil(MOST_POINTS);
        let mut samples = Vec::with_capacity(displacement.len() / every + at.len() + 1);
        let mut branch = 0;
        for (place, (&displacement, &force)) in displacement.iter().zip(force).enumerate() {
            let turning = at.get(branch) == Some(&place);
            if place % every == 0 || turning {
                samples.push(Sample {
                    measured: displacement,
                    displacement: velocity.earlier(place, delay),
                    force,
                    time: time(times[place]),
                    rate: if timed || clock.counts { velocity.at(place) } else { 0.0 },
                    shift: 0.0,
                    by_shift: 0.0,
                    branch,
                });
            }
            branch += usize::from(turning);
        }
        let mut found = Branches {
            samples,
            turns,
            rising,
            start: start.unwrap_or(Start::Steady),
            weight: *weight,
            noise,
            drift,
            delay,
            step: median(&mut times.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<f64>>()),
            timed,
            displacement_step,
            turn_in_gap,
            corner_share,
            extremes: [highest, lowest],
            curve: SampledCurve::new(&contact, with_strength),
            contact,
            half_force: 0.5 * (high - low),
            middle_force: 0.5 * (high + low),
            stiffness: 0.0,
        };
        found.stiffness = found.stiffness_after_reversals();
        Ok(found)
    }

    /// Whether the turns of either side agree.
    pub(super) fn repeats(&self) -> bool {
        self.turns.windows(3).all(|of| {
            let way = of[2].displacement - of[0].displacement - self.drift * (of[2].time - of[0].time);
            way.abs() <= AGREE * of[2].error.hypot(of[0].error)
        })
    }

    /// Whether the contact of this bench slips as a whole.
    pub(super) fn slides(&self, bench: Bench) -> bool {
        let half = 0.5 * (self.extremes[0].displacement - self.extremes[1].displacement);
        half >= LoadingCurve::new(&self.contact, &self.curve, bench).gross_slip()
    }

    /// How long it takes, s.
    pub(super) fn duration(&self) -> f64 {
        self.samples.last().map_or(0.0, |last| last.time - self.samples[0].time)
    }

    /// 1 where a branch rises, -1 where it falls.
    pub(super) fn direction(&self, branch: usize) -> f64 {
        if branch.is_multiple_of(2) == self.rising { 1.0 } else { -1.0 }
    }

    /// Refuses what no contact does, and what only another unit explains.
    pub(super) fn check(&self, index: usize, stiffness_free: bool) -> Result<(), Error> {
        let normal_force = self.contact.normal_force();
        if self.half_force > MOST_FRICTION * normal_force {
            return Err(Error::ForceUnit { record: index, force: self.half_force, normal_force });
        }
        if self.is_rectified() {
            return Err(Error::Rectified { record: index });
        }
        if let Some(difference) = self.wrong_way() {
            return Err(Error::WrongWay { record: index, difference });
        }
        let (measured, expected) = (self.stiffness, stiffness(&self.contact));
        let doubtful = measured > MOST_STIFFNESS_RATIO * expected || measured < expected / MOST_STIFFNESS_RATIO;
        if stiffness_free && measured > 0.0 && doubtful {
            return Err(Error::StiffnessUnit { record: index, measured, expected });
        }
        Ok(())
    }

    /// The median over the branches of the slope of their first tenth.
    fn stiffness_after_reversals(&self) -> f64 {
        let mut slopes: Vec<f64> = Vec::new();
        for branch in 1..=self.turns.len() {
            let from = self.samples.partition_point(|sample| sample.branch < branch);
            let to = self.samples.partition_point(|sample| sample.branch <= branch);
            let points = &self.samples[from.saturating_sub(1)..to];
            // A machine may rest before it turns back.
            let before = |sample: &Sample| -self.direction(branch) * sample.displacement;
            let turn = (0..points.len()).max_by(|a, b| before(&points[*a]).total_cmp(&before(&points[*b])));
            let points = &points[turn.unwrap_or(0)..];
            let (Some(first), Some(last)) = (points.first(), points.last()) else { continue };
            let length = last.displacement - first.displacement;
            let near = |sample: &&Sample| {
                (sample.displacement - first.displacement).abs()
                    <= FIRST_SHARE * length.abs().max(2.0 * self.noise / FIRST_SHARE)
            };
            let count = points.iter().take_while(near).count().max(3).min(points.len());
            let mean = |of: fn(&Sample) -> f64| points[..count].iter().map(of).sum::<f64>() / count as f64;
            let (u, f) = (mean(|sample| sample.displacement), mean(|sample| sample.force));
            let (mut product, mut square) = (0.0, 0.0);
            for sample in &points[..count] {
                product += (sample.displacement - u) * (sample.force - f);
                square += (sample.displacement - u).powi(2);
            }
            if square > 0.0 {
                slopes.push(product / square);
            }
        }
        median(&mut slopes).max(0.0)
    }
}

/// A contact with the geometry of a definition and friction alone, of any coefficient: what curves are sampled of.
pub(super) fn frictional(contact: &Contact) -> Result<Contact, Error> {
    if contact.shear_strength() <= 0.0 && contact.friction() > 0.0 {
        return Ok(contact.clone());
    }
    Ok(Contact::new(Setup {
        profile: contact.profile().clone(),
        elasticity: contact.elasticity(),
        friction: if contact.friction() > 0.0 { contact.friction() } else { 1.0 },
        preload: Preload::NormalForce(contact.normal_force()),
    })?)
}

/// The stiffness of a contact as defined, 2 G* a, N/m.
pub(super) fn stiffness(contact: &Contact) -> f64 {
    2.0 * contact.elasticity().g_star() * contact.stiffness_radius()
}

/// The area of a contact, m^2.
pub(super) fn area(contact: &Contact) -> f64 {
    std::f64::consts::PI * contact.contact_radius() * contact.contact_radius()
}

/// The times of a record, s, or the numbers of its points.
pub(super) fn times(record: &Record) -> Vec<f64> {
    record.time.clone().unwrap_or_else(|| (0..record.displacement.len()).map(|index| index as f64).collect())
}

/// The forms of all turns.
pub(super) fn forms(times: &[f64], level: &[f64], at: &[usize], noise: f64) -> Vec<Form> {
    let before = std::iter::once(0).chain(at.iter().copied());
    let after = at.iter().copied().skip(1).chain(std::iter::once(level.len() - 1));
    at.iter()
        .zip(before.zip(after))
        .map(|(&at, (before, after))| form(times, level, at, before..=after, noise))
        .collect()
}

/// The last sample of each branch, by forces that come so much later.
fn last_samples(times: &[f64], forms: &[Form], delay: f64) -> Vec<usize> {
    let mut least = 0;
    let last = |form: &Form| {
        let at = times.partition_point(|time| *time - delay <= form.time).saturating_sub(1).max(least);
        least = at + 1;
        at.min(times.len() - 1)
    };
    forms.iter().map(last).collect()
}

/// The same record without points that repeat the point before: an instrument that was read faster than it measures.
pub(super) fn without_doubles(record: &Record) -> Record {
    let Record { displacement, force, time, .. } = record;
    let same = |a: &[f64]| a[0].to_bits() == a[1].to_bits();
    let doubled = displacement.windows(2).zip(force.windows(2)).map(|(u, f)| same(u) && same(f));
    let kept: Vec<bool> = std::iter::once(true).chain(doubled.map(|doubled| !doubled)).collect();
    let column =
        |values: &[f64]| values.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(value, _)| *value).collect();
    if kept.iter().all(|kept| *kept) || displacement.len() != force.len() {
        return record.clone();
    }
    Record {
        displacement: column(displacement),
        force: column(force),
        time: time.as_ref().map(|time| column(time)),
        ..record.clone()
    }
}

/// The outermost place in a direction, where a machine that repeats its cycle has turned before: of turns that agree
/// the middle one, else the farthest, or an end of the record that is beyond all of them.
fn extreme(turns: &[Turn], ends: &[Turn; 2], rising: bool, drift: f64, sign: f64) -> Option<Turn> {
    let far = |turn: &Turn| sign * (turn.displacement - drift * turn.time);
    let mut side: Vec<Turn> = turns.iter().skip(usize::from(rising == (sign < 0.0))).step_by(2).copied().collect();
    side.sort_by(|a, b| far(a).total_cmp(&far(b)));
    let beyond = |end: &&Turn| side.iter().all(|turn| far(end) - far(turn) > AGREE * turn.error.hypot(end.error));
    let by_place = |a: &&Turn, b: &&Turn| far(a).total_cmp(&far(b));
    let middle = side.get(side.len() / 2);
    let agree = |farthest: &Turn| {
        middle.is_some_and(|middle| far(farthest) - far(middle) <= AGREE * farthest.error.hypot(middle.error))
    };
    let of_turns = match side.last() {
        Some(farthest) if agree(farthest) => middle,
        farthest => farthest,
    };
    let found = ends.iter().filter(beyond).max_by(by_place).or(of_turns).copied();
    let mut in_time = turns.iter().skip(usize::from(rising == (sign < 0.0))).step_by(2);
    match (found, in_time.next(), in_time.next()) {
        // Amplitudes that fall from the first on have been larger before: by as much again, or not.
        (Some(found), Some(first), Some(second)) if found == *first => {
            let fall = far(first) - far(second);
            let falls = fall > AGREE * first.error.hypot(second.error);
            let farther = Turn {
                displacement: found.displacement + sign * 0.5 * fall,
                corner: 0.0,
                error: found.error.hypot(fall),
                ..found
            };
            Some(if falls { farther } else { found })
        }
        (found, ..) => found,
    }
}

/// A positive friction that the mechanics accepts.
pub(super) fn clamp_friction(friction: f64) -> f64 {
    friction.clamp(range::MIN_POSITIVE_FRICTION, range::FRICTION.max)
}
