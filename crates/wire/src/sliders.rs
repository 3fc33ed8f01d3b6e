//! The body of `POST /sliders` and its reply: a contact as sliders in parallel.

use stickslip_mechanics::sliders;

use crate::prelude::*;

requests! {
/// A contact, and what its sliders have to keep: one of `count`, `force_error` and `work_error`. Nothing is stored.
#[schema(example = json!({"contact": ContactDefinition::example(), "force_error": 0.01}))]
pub struct SlidersRequest {
    /// The contact, whose normal load stays as it is.
    pub contact: ContactDefinition,
    /// Number of sliders. Fewer are returned where the first loading is straight, as for a flat punch.
    pub count: Option<usize> = count(&sliders::COUNT),
    /// Largest error of a first loading over μ F_N, a pure number: the fewest sliders that keep it.
    pub force_error: Option<f64> = sliders::ERROR,
    /// Largest relative error of the work of a steady cycle from `smallest_amplitude` on, a pure number: the fewest
    /// sliders with geometric knots that keep it.
    pub work_error: Option<f64> = sliders::ERROR,
    /// The smallest amplitude for `work_error`, m; below the displacement of gross slip.
    pub smallest_amplitude: Option<f64> = Range { min: 0.0, ..range::DISPLACEMENT },
}
}

replies! {
/// Sliders in parallel: each is a spring with a friction cap, and all are moved by the same displacement.
pub struct SlidersReply {
    /// The contact at its preload.
    pub contact: ContactSummary,
    /// Displacements at which the sliders slip on first loading, m, increasing.
    pub displacement: Vec<f64>,
    /// Their stiffnesses, N/m.
    pub stiffness: Vec<f64>,
    /// The forces at which they slip, N; all together μ F_N.
    pub slip_force: Vec<f64>,
    /// The largest error of the force on first loading over μ F_N, a pure number. After one reversal it is at most
    /// twice that.
    pub force_error: f64,
    /// A bound of the error of the force over μ F_N on any path at this load, a pure number.
    pub path_error: f64,
    /// The work of steady cycles over that of the contact.
    pub work: SliderWork,
    /// The density of sliders that the contact itself has.
    pub density: SliderDensity,
    /// Solver, errors and time: of the contact, to which the sliders add theirs.
    pub accuracy: Accuracy,
    /// Warnings about the result.
    pub warnings: Vec<Warning>,
}

/// The work of steady cycles of sliders over that of the contact.
pub struct SliderWork: Default {
    /// Amplitudes of the displacement, m, increasing up to gross slip.
    pub amplitude: Vec<f64>,
    /// Work of the sliders over that of the contact, a pure number.
    pub ratio: Vec<f64>,
}

/// The stiffness that begins to slip for each unit of displacement, −d²F/dU² of the first loading: the distribution of
/// Iwan's elements, and Preisach's density along its diagonal.
pub struct SliderDensity: Default {
    /// Middles of equal steps of the displacement, m, up to gross slip.
    pub displacement: Vec<f64>,
    /// Mean density in each, N/m². A flat adds to the last slider alone.
    pub density: Vec<f64>,
}
}

impl Document for SlidersRequest {
    type Checked = (SlidersRequest, SharedSetup, sliders::Wanted);

    fn profile(&self) -> Option<DefinedProfile<'_>> {
        Some(self.contact.defined_profile("/contact/profile"))
    }

    fn checked(self, profiles: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let at = |name| JsonPath::Root.member(name);
        let setup = self.contact.check(at("contact"), profiles, faults);
        if self.contact.bulk.is_some() {
            faults.add(
                at("contact").member("bulk"),
                "sliders have no zones that a bulk stress could shift: leave it out",
            );
        }
        let wanted = match (self.count, self.force_error, self.work_error) {
            (Some(count), None, None) => Some(sliders::Wanted::Count(count)),
            (None, Some(error), None) => Some(sliders::Wanted::ForceError(error)),
            (None, None, Some(error)) => match self.smallest_amplitude {
                Some(smallest_amplitude) => Some(sliders::Wanted::WorkError { error, smallest_amplitude }),
                None => {
                    faults.refuse(at("smallest_amplitude"), "`work_error` needs the amplitude from which on it holds")
                }
            },
            _ => faults.refuse(JsonPath::Root, "expected one of `count`, `force_error`, `work_error`"),
        };
        if self.work_error.is_none() && self.smallest_amplitude.is_some() {
            faults.add(at("smallest_amplitude"), "it belongs to `work_error`: leave it out");
        }
        Some((self, setup?, wanted?))
    }
}
