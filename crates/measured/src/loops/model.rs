//! The force that a contact on its bench would have shown at the points of a record, and how it depends on the
//! parameters.
//!
//! The memory of a contact at constant load is its turning points (Masing 1926, Madelung 1905): each branch is the
//! first loading curve at twice its size from the last turning point; where a branch comes back to the turning point
//! before the last, both are forgotten; beyond all of them the first loading curve goes on. The gradients are carried
//! through the turning points, since the force there depends on every parameter too. A steady loop is one about its own
//! middle, in which the contact would have been at rest.

use super::loading_curve::{Bench, LoadingCurve, LoadingPoint};
use super::record::{Branches, Sample, Turn};
use super::{Parameter, Start};

/// The parameters and where each of them is in a gradient.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    /// That of each column; `None` of a turning point.
    pub(super) parameters: Vec<Option<Parameter>>,
    /// Values of those that are not sought.
    pub(super) held: [f64; Parameter::ALL.len()],
    /// Values by which modulus, reduced modulus and radius are those of the definition.
    pub(super) defined: [f64; Parameter::ALL.len()],
}

impl Layout {
    pub(super) fn column(&self, parameter: Parameter) -> Option<usize> {
        self.parameters.iter().position(|&one| one == Some(parameter))
    }

    pub(super) fn columns(&self) -> usize {
        self.parameters.len()
    }

    /// The parameters with columns, and these.
    pub(super) fn sought(&self) -> impl Iterator<Item = (usize, Parameter)> {
        self.parameters.iter().enumerate().filter_map(|(column, &parameter)| Some((column, parameter?)))
    }

    /// The value of a parameter.
    pub(super) fn value(&self, values: &[f64], parameter: Parameter) -> f64 {
        self.column(parameter).map_or(self.held[parameter as usize], |column| values[column])
    }

    /// The bench of these values.
    pub(super) fn bench(&self, values: &[f64]) -> Bench {
        // E* and R act through the radius of the contact alone, a ~ (R/E*)^(1/3): as a modulus would.
        let stiffness = [Parameter::GStar, Parameter::EStar, Parameter::Radius].iter().fold(1.0, |product, &one| {
            match self.value(values, one) / self.defined[one as usize] {
                ratio if one == Parameter::GStar => product * ratio,
                ratio if ratio.is_finite() && ratio > 0.0 => {
                    product * ratio.powf(f64::from(one.power_of_stiffness()) / 3.0)
                }
                _ => product,
            }
        });
        let g_star = self.defined[Parameter::GStar as usize] * stiffness;
        // A strength acts on the area, which goes with the square of the radius.
        let area = (g_star / self.value(values, Parameter::GStar)).powi(2);
        Bench {
            friction: self.value(values, Parameter::Friction),
            g_star,
            compliance: self.value(values, Parameter::MachineCompliance),
            strength: self.value(values, Parameter::ShearStrength) * area,
            area,
        }
    }
}

/// The force at a point, N, its derivative by the displacement, N/m, and whether the whole contact slips.
#[derive(Clone, Copy, Debug)]
pub(super) struct Predicted {
    pub(super) force: f64,
    pub(super) slope: f64,
}

/// A place of known force in the memory.
#[derive(Clone, Debug)]
struct Anchor {
    place: f64,
    force: f64,
    /// Gradients of both.
    place_by: Vec<f64>,
    force_by: Vec<f64>,
}

struct Walk<'a> {
    layout: &'a Layout,
    values: &'a [f64],
    /// The delay that the displacements of the samples allow for, s.
    delay: f64,
    curve: LoadingCurve<'a>,
    /// Where first loading began.
    origin: Anchor,
    /// Turning points that are remembered, the outermost first.
    memory: Vec<Anchor>,
}

/// Calls `row` with each sample, what is predicted for it, and its gradient.
pub(super) fn predict(
    branches: &Branches,
    layout: &Layout,
    values: &[f64],
    mut row: impl FnMut(&Sample, Predicted, &[f64]),
) {
    let curve = LoadingCurve::new(&branches.contact, &branches.curve, layout.bench(values));
    let origin =
        Anchor { place: 0.0, force: 0.0, place_by: vec![0.0; layout.columns()], force_by: vec![0.0; layout.columns()] };
    let mut walk = Walk { layout, values, delay: branches.delay, curve, origin, memory: Vec::new() };
    if branches.start == Start::Steady {
        walk.start_within(branches);
    }
    let (mut branch, mut gradient, mut place_by) = (0, vec![0.0; layout.columns()], vec![0.0; layout.columns()]);
    let [force_offset, gain_drift] =
        [Parameter::ForceOffset, Parameter::GainDrift].map(|one| layout.value(values, one));
    let [offset_column, gain_column] = [Parameter::ForceOffset, Parameter::GainDrift].map(|one| layout.column(one));
    for sample in &branches.samples {
        while branch < sample.branch {
            walk.turn(&branches.turns[branch], branches.direction(branch));
            branch += 1;
        }
        let place = walk.place(sample.displacement + sample.shift, [sample.time, sample.rate], None, &mut place_by);
        let reached = walk.reached(place, branches.direction(branch));
        let mut predicted = walk.force(reached, (place, &place_by), branches.direction(branch), &mut gradient);
        let gain = 1.0 + gain_drift * sample.time;
        if gain_drift.abs() > 0.0 {
            gradient.iter_mut().for_each(|by| *by *= gain);
        }
        if let Some(column) = gain_column {
            gradient[column] += predicted.force * sample.time;
        }
        predicted =
            Predicted { force: gain * predicted.force + force_offset - sample.by_shift, slope: gain * predicted.slope };
        if let Some(column) = offset_column {
            gradient[column] += 1.0;
        }
        row(sample, predicted, &gradient);
    }
}

impl Walk<'_> {
    /// The displacement of the machine behind one that was measured at this time and velocity, and its gradient. A
    /// column of its own has no drift.
    fn place(&self, displacement: f64, at: [f64; 2], own: Option<usize>, by: &mut [f64]) -> f64 {
        by.fill(0.0);
        let (mut place, [mut time, rate]) = (displacement, at);
        if let Some(column) = own {
            (place, time) = (self.values[column], 0.0);
            by[column] = 1.0;
        }
        place += rate * self.delay;
        let terms = [(Parameter::DisplacementOffset, 1.0), (Parameter::Drift, time), (Parameter::Delay, rate)];
        for (parameter, factor) in terms {
            place -= factor * self.layout.value(self.values, parameter);
            if let Some(column) = self.layout.column(parameter) {
                by[column] -= factor;
            }
        }
        place
    }

    fn anchor(&self, turn: &Turn) -> Anchor {
        let mut place_by = vec![0.0; self.layout.columns()];
        let place = self.place(turn.displacement, [turn.time, 0.0], turn.column, &mut place_by);
        Anchor { place, force: 0.0, place_by, force_by: vec![0.0; self.layout.columns()] }
    }

    /// A record from within a cycle: the contact has been at both extremes, the one behind it last.
    fn start_within(&mut self, branches: &Branches) {
        let [highest, lowest] = branches.extremes.map(|turn| self.anchor(&turn));
        self.origin = Anchor {
            place: 0.5 * (highest.place + lowest.place),
            place_by: highest.place_by.iter().zip(&lowest.place_by).map(|(a, b)| 0.5 * (a + b)).collect(),
            ..highest.clone()
        };
        let (first, last) = if branches.rising { (highest, lowest) } else { (lowest, highest) };
        let direction = branches.direction(1);
        for (anchor, direction) in [(first, -direction), (last, direction)] {
            self.remember(anchor, direction);
        }
    }

    /// The branch in this direction ends at a turning point.
    fn turn(&mut self, turn: &Turn, direction: f64) {
        self.remember(self.anchor(turn), direction);
    }

    fn remember(&mut self, mut anchor: Anchor, direction: f64) {
        self.memory.truncate(self.reached(anchor.place, direction));
        let mut gradient = vec![0.0; self.layout.columns()];
        anchor.force = self.force(self.memory.len(), (anchor.place, &anchor.place_by), direction, &mut gradient).force;
        anchor.force_by = gradient;
        self.memory.push(anchor);
    }

    /// How many turning points are still remembered when a branch in this direction has come to a place.
    fn reached(&self, place: f64, direction: f64) -> usize {
        let mut kept = self.memory.len();
        while kept > 0 {
            let end = match kept {
                // The first turning point's branch closes where it lies opposite to the origin.
                1 => 2.0 * self.origin.place - self.memory[0].place,
                _ => self.memory[kept - 2].place,
            };
            if direction * (place - end) < 0.0 {
                break;
            }
            kept -= if kept == 1 { 1 } else { 2 };
        }
        kept
    }

    /// The force on a branch in this direction at a place, and its gradient, where `kept` turning points are
    /// remembered.
    fn force(&self, kept: usize, at: (f64, &[f64]), direction: f64, gradient: &mut [f64]) -> Predicted {
        let (place, place_by) = at;
        let (from, twice) = match kept.checked_sub(1) {
            Some(last) => (&self.memory[last], 2.0),
            None => (&self.origin, 1.0),
        };
        let way = direction * (place - from.place) / twice;
        let LoadingPoint { force, slope, by_friction, by_modulus, by_compliance, by_strength } =
            self.curve.at(way.max(0.0));
        let Bench { strength, area, .. } = self.curve.bench;
        // Noise may put a point before the beginning of its branch: there the branch goes on straight.
        let force = force + slope * way.min(0.0);
        let sign = direction * twice;
        for (column, sum) in gradient.iter_mut().enumerate() {
            *sum = from.force_by[column] + slope * (place_by[column] - from.place_by[column]);
        }
        for (column, parameter) in self.layout.sought() {
            gradient[column] += sign
                * match parameter {
                    Parameter::Friction => by_friction,
                    Parameter::MachineCompliance => by_compliance,
                    Parameter::ShearStrength => by_strength * area,
                    _ => {
                        let by_area = if parameter == Parameter::GStar { 0.0 } else { 2.0 * strength * by_strength };
                        (by_modulus + by_area) * f64::from(parameter.power_of_stiffness())
                            / 3.0
                            / self.values[column].abs().max(f64::MIN_POSITIVE)
                    }
                };
        }
        Predicted { force: from.force + sign * force, slope }
    }
}
