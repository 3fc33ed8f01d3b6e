//! `rolling`: a cylinder that rolls steadily with a tangential force.

use stickslip_mechanics::Error;
use stickslip_mechanics::rolling::{Drive, Rolling};
use stickslip_wire::{RollingReply, RollingRequest};

use crate::computations::prelude::*;

/// What a cylinder takes without its curves.
const ROLLING_COST: u64 = 20_000;
const REASON: &str = "closed form (Carter 1926)";

/// A cylinder that rolls.
pub struct Roll;

impl Computation for Roll {
    const ABOUT: About = About {
        name: "rolling",
        route: Some(Route { path: "/rolling", operation: "compute_rolling", tag: "simulation" }),
        title: "Compute the creep of a rolling cylinder",
        description: "A cylinder that rolls steadily towards +x under its load carries a tangential force by a stick \
                      zone at its leading edge and slip behind it. Returns creep, stick zone and tractions for a \
                      force over μ F_N or a creep. Nothing is stored.",
        reply: "Creep, stick zone and tractions",
        shows: "A table has pressure and shear stress over x.",
        ..About::TABLE
    };

    type Request = RollingRequest;
    type Outcome = RollingReply;

    fn examples() -> Vec<Example> {
        vec![example(
            "cylinders",
            "Two steel cylinders at half of gross slip",
            json!({"contact": RollingRequest::example_contact(), "ratio": 0.5, "points": 50}),
        )]
    }

    fn bytes((request, ..): &Task<Self>) -> usize {
        of_shape(&request.contact.profile) + 3 * request.points() * NUMBER
    }

    fn rows((request, ..): &Task<Self>) -> (usize, usize) {
        (request.points(), 3 * NUMBER_LENGTH)
    }

    fn cost((request, setup, _): &Task<Self>) -> Nanoseconds {
        on_profile(&setup.profile, ROLLING_COST + request.points() as u64 * RADIUS_COST, false)
    }

    fn run((request, setup, drive): Task<Self>, stop: &dyn Stop) -> Result<RollingReply, Failure> {
        let timer = Timer::start(stop);
        let contact = contact(setup, "/contact")?;
        let rolling = Rolling::of(&contact, drive).map_err(|error| {
            let place = match (&error, drive) {
                (Error::NothingSlides, _) => "/contact",
                (Error::OutOfRange { .. }, Drive::Ratio(_)) => "/ratio",
                (Error::OutOfRange { .. }, Drive::Creep(_)) => "/creep",
                _ => "/contact/profile",
            };
            Failure::at(place, error)
        })?;
        let (a, last) = (contact.contact_radius(), request.points().saturating_sub(1) as f64);
        let x: Vec<f64> = (0..request.points()).map(|index| a * (2.0 * (index as f64 / last) - 1.0)).collect();
        let distances: Vec<f64> = x.iter().map(|x| x.abs()).collect();
        Ok(RollingReply {
            contact: contact.summary().into(),
            ratio: rolling.ratio(),
            creep: rolling.creep(),
            stick: rolling.stick(),
            pressure: contact.pressures(&distances),
            shear: x.iter().map(|x| rolling.shear(*x)).collect(),
            x,
            accuracy: accuracy(&contact, timer, REASON),
            warnings: present_warnings(&contact),
        })
    }
}

impl Outcome for RollingReply {
    type Reply = RollingReply;

    fn length(&self) -> usize {
        3 * self.x.len() * NUMBER_LENGTH + 2_048
    }

    fn table(&self, _: &DisplayOptions) -> Option<Table<'_>> {
        let columns = vec![
            Column::floats("x", "m", |row| self.x[row]),
            Column::floats("pressure", "Pa", |row| self.pressure[row]),
            Column::floats("shear", "Pa", |row| self.shear[row]),
        ];
        Some(Table::flat(self.x.len(), columns))
    }

    fn picture(&self, _: &DisplayOptions) -> Option<Drawing> {
        let over = |values: &[f64]| -> Vec<(f64, f64)> { self.x.iter().copied().zip(values.iter().copied()).collect() };
        let panel = Panel {
            y: Axis::of("stress", "Pa"),
            curves: vec![
                Curve::line("pressure p", Colour::Grey, over(&self.pressure)),
                Curve::line("shear stress τ", Colour::Blue, over(&self.shear)),
            ],
        };
        let title = format!("Rolling at {:.3} μ F_N: creep {:.3e}", self.ratio, self.creep);
        Some(Drawing::Plot(Plot::new(title, Axis::of("place x", "m"), vec![panel])))
    }
}
