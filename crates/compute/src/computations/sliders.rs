//! `sliders`: a contact as springs with friction caps, for other codes.

use stickslip_mechanics::range::Quantity;
use stickslip_mechanics::sliders::{Sliders, Wanted, density};
use stickslip_mechanics::{Error, cycle::SteadyCycle};
use stickslip_wire::{SliderDensity, SliderWork, SlidersReply, SlidersRequest};

use crate::computations::prelude::*;

/// One slider on a sphere: some thousand chords are tried until all errors are equal.
const SLIDER_COST: u64 = 200_000;
/// The most sliders that an error is likely to take.
const USUAL_COUNT: f64 = 1000.0;
/// Amplitudes at which the work is compared, down to this part of gross slip.
const AMPLITUDES: usize = 41;
const SMALLEST_PART: f64 = 0.005;
/// Steps of the density.
const STEPS: usize = 100;
const REASON: &str = "the sliders are chords of the first loading curve, whose largest distance from it is found";

/// A contact as sliders in parallel.
pub struct FindSliders;

impl Computation for FindSliders {
    const ABOUT: About = About {
        name: "sliders",
        route: Some(Route { path: "/sliders", operation: "find_sliders", tag: "simulation" }),
        title: "Find sliders that move like a contact",
        description: "Returns springs with friction caps in parallel (Jenkins, Iwan) that have the tangential force of \
                      a contact at constant load, for a code that knows no more: with chords of equal errors for a \
                      number of sliders or an error of the force, or with geometric knots for an error of the work of \
                      small cycles. Nothing is stored.",
        reply: "The sliders with their errors",
        shows: "A table has a row for each slider; only `columns` has `work` and `density`.",
        ..About::TABLE
    };

    type Request = SlidersRequest;
    type Outcome = SlidersReply;

    fn examples() -> Vec<Example> {
        vec![example(
            "by error",
            "The fewest sliders for an error of 1 % of the limit of friction",
            json!({"contact": ContactDefinition::example(), "force_error": 0.01}),
        )]
    }

    fn bytes((request, ..): &Task<Self>) -> usize {
        of_shape(&request.contact.profile) + (3 * 1000 + 2 * AMPLITUDES + 2 * STEPS) * NUMBER
    }

    fn rows(_: &Task<Self>) -> (usize, usize) {
        (1000, 3 * NUMBER_LENGTH)
    }

    fn cost((_, setup, wanted): &Task<Self>) -> Nanoseconds {
        let count = match *wanted {
            Wanted::Count(count) => count as f64,
            // A ball takes 0.41 over the root of the error, and other shapes about as many.
            Wanted::ForceError(error) => (1.0 / error.sqrt()).min(USUAL_COUNT),
            Wanted::WorkError { error, .. } => (40.0 / error.sqrt()).min(USUAL_COUNT),
        };
        on_profile(&setup.profile, SLIDER_COST.saturating_mul(count as u64 + 1), false)
    }

    fn run((_, setup, wanted): Task<Self>, stop: &dyn Stop) -> Result<SlidersReply, Failure> {
        let timer = Timer::start(stop);
        let contact = contact(setup, "/contact")?;
        let sliders = Sliders::of(&contact, wanted, &|| stop.check().is_ok());
        stop.check()?;
        let sliders = sliders.map_err(|error| refused(error, wanted))?;
        let summary = contact.summary();
        let gross_slip = summary.gross_slip_displacement;
        let smallest = match wanted {
            Wanted::WorkError { smallest_amplitude, .. } => smallest_amplitude / gross_slip,
            Wanted::Count(_) | Wanted::ForceError(_) => SMALLEST_PART,
        };
        let part = |index: usize| smallest.powf(1.0 - index as f64 / (AMPLITUDES - 1) as f64);
        let amplitude: Vec<f64> = (0..AMPLITUDES).map(|index| gross_slip * part(index)).collect();
        let exact = |amplitude: f64| SteadyCycle::of(&contact, amplitude).dissipated_energy();
        let ratio =
            |amplitude: &f64| Some(sliders.work(*amplitude) / exact(*amplitude)).filter(|ratio| ratio.is_finite());
        // A contact that does not slip before it slides has no work that the sliders could miss.
        let ratio = amplitude.iter().map(|amplitude| ratio(amplitude).unwrap_or(1.0)).collect();
        let knots: Vec<f64> = (0..=STEPS).map(|step| gross_slip * (step as f64 / STEPS as f64)).collect();
        let middles = knots.windows(2).map(|pair| pair[0].midpoint(pair[1])).collect();
        Ok(SlidersReply {
            contact: summary.into(),
            force_error: sliders.force_error,
            path_error: sliders.path_error(),
            work: SliderWork { amplitude, ratio },
            density: SliderDensity { displacement: middles, density: density(&contact, &knots) },
            displacement: sliders.displacement,
            stiffness: sliders.stiffness,
            slip_force: sliders.slip_force,
            accuracy: accuracy(&contact, timer, REASON),
            warnings: present_warnings(&contact),
        })
    }
}

fn refused(error: Error, wanted: Wanted) -> Failure {
    let place = match &error {
        Error::NothingSlides => "/contact",
        Error::OutOfRange { quantity: Quantity::Displacement, .. } => "/smallest_amplitude",
        _ => match wanted {
            Wanted::Count(_) => "/count",
            Wanted::ForceError(_) => "/force_error",
            Wanted::WorkError { .. } => "/work_error",
        },
    };
    Failure::at(place, error)
}

impl Outcome for SlidersReply {
    type Reply = SlidersReply;

    fn length(&self) -> usize {
        (3 * self.displacement.len() + 2 * (AMPLITUDES + STEPS)) * NUMBER_LENGTH + 2_048
    }

    fn table(&self, _: &DisplayOptions) -> Option<Table<'_>> {
        let columns = vec![
            Column::floats("displacement", "m", |row| self.displacement[row]),
            Column::floats("stiffness", "N/m", |row| self.stiffness[row]),
            Column::floats("slip_force", "N", |row| self.slip_force[row]),
        ];
        Some(Table::flat(self.displacement.len(), columns))
    }

    /// The first loading of the sliders, and the density of those of the contact.
    fn picture(&self, _: &DisplayOptions) -> Option<Drawing> {
        let force = |displacement: f64| -> f64 {
            let carried = self.stiffness.iter().zip(&self.displacement);
            carried.map(|(stiffness, knot)| stiffness * displacement.min(*knot)).sum()
        };
        let knots = std::iter::once(0.0).chain(self.displacement.iter().copied());
        let loading: Vec<_> = knots.map(|knot| (knot, force(knot))).collect();
        let density = self.density.displacement.iter().copied().zip(self.density.density.iter().copied());
        let forces = Panel {
            y: Axis::of("tangential force F", "N"),
            curves: vec![Curve::line("sliders", Colour::Blue, loading.clone()), Curve::dots("", Colour::Blue, loading)],
        };
        let densities = Panel { y: Axis::of("density", "N/m²"), curves: vec![Curve::line("", Colour::Grey, density)] };
        let title = format!("{} sliders, {:.1e} of μ F_N off at most", self.displacement.len(), self.force_error);
        Some(Drawing::Plot(Plot::new(title, Axis::of("displacement U", "m"), vec![forces, densities])))
    }
}
