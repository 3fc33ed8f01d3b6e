//! `simulate`: the states and stresses of a contact along a path.

use std::borrow::Borrow;

use stickslip_wire::PlanarReply;

use super::{plane, residual, stress};
use crate::computations::prelude::*;
use crate::simulation::bytes::{STATE_LENGTH, of_simulation};

/// What a reply has besides states and stresses, bytes of JSON.
const REPLY_LENGTH: usize = 2_048;

/// The states of a contact along a path, and the stresses at its end.
pub struct Simulate;

impl Computation for Simulate {
    const ABOUT: About = About {
        name: "simulate",
        route: Some(Route { path: "/simulate", operation: "simulate_path", tag: "simulation" }),
        title: "Simulate a path",
        description: "Follows a path from the preloaded contact and returns the states along it, and the stresses \
                      and their extrema at its end if asked for. Nothing is stored, so that a repeated request \
                      simply runs again.",
        reply: "The states, and the other results that were asked for",
        shows: "All formats but `columns` show one part of the document: the residual stress if it is asked for, a row \
                for each extremum; otherwise the stresses over the radius; otherwise the states along the path. `show` \
                names another part.",
        choice: Some(SHOW),
        ..About::TABLE
    };

    type Request = SimulateRequest;
    type Outcome = Simulated;

    fn examples() -> Vec<Example> {
        vec![
            example(
                "back and forth",
                "Falling amplitude, with the residual stresses",
                json!({
                    "contact": ContactDefinition::example(),
                    "path": {"falling_amplitude": {"reversals": 20}},
                    "stress": {"points": 200}, "residual": true
                }),
            ),
            example(
                "by force",
                "A cycle of the tangential force, with the last state only",
                json!({
                    "contact": example_contact(json!({"type": "sphere", "radius": 0.01}), json!({"indentation": 1e-6})),
                    "path": {"force": [0.5, -0.5, 0.5]}, "steps": "last", "solver": "exact"
                }),
            ),
            example(
                "line contact",
                "A cylinder on a flat with a bulk stress in proportion to the tangential force",
                json!({
                    "contact": line_contact(), "path": {"force": [290.0, -290.0, 0.0]},
                    "stress": {"points": 101}, "residual": true
                }),
            ),
            example(
                "springs",
                "The same contact on the paper's spring foundation",
                json!({
                    "contact": example_contact(
                        json!({"type": "sphere", "radius": 0.01}),
                        json!({"contact_radius": 1e-4})
                    ),
                    "path": {"moves": [{"displacement": 1e-7}, {"indentation": 8e-7, "displacement": 0.0}]},
                    "solver": {"springs": {"count": 1000}}
                }),
            ),
            example(
                "in the plane",
                "Once round a circle, with the stresses at its end",
                json!({
                    "contact": example_contact(json!({"type": "sphere", "radius": 0.01}), json!({"indentation": 1e-6})),
                    "path": {"ellipse": {"radii": [2e-7, 2e-7], "turns": 1, "steps_per_turn": 32}},
                    "stress": {"points": 50, "fields": ["pressure", "shear", "slip"]}
                }),
            ),
        ]
    }

    fn check_shown(task: &Simulation, shown: &DisplayOptions) -> Result<(), Fault> {
        let part = part(shown, task.residual, task.stress.is_some());
        let is_asked = match part {
            "residual" => task.residual,
            "stress" => task.stress.is_some(),
            _ => true,
        };
        let fault = || Fault::new("/show", format!("the body does not ask for `{part}`"));
        if is_asked { Ok(()) } else { Err(fault()) }
    }

    fn bytes(task: &Simulation) -> usize {
        of_simulation(task)
    }

    fn rows(task: &Simulation) -> (usize, usize) {
        let radii = task.stress.as_ref().map_or(0, StressRequest::length);
        ((2 * task.plan.length()).max(radii), OBJECT)
    }

    fn cost(task: &Simulation) -> Nanoseconds {
        cost::of_simulation(task)
    }

    fn run(task: Simulation, stop: &dyn Stop) -> Result<Simulated, Failure> {
        let reply = simulation::simulate_any(&task, stop)?;
        Ok(Simulated { reply, task })
    }
}

/// A reply with what it was asked of, which a loop is drawn by.
pub struct Simulated {
    reply: SimulationReply,
    task: Simulation,
}

impl Borrow<SimulationReply> for Simulated {
    fn borrow(&self) -> &SimulationReply {
        &self.reply
    }
}

impl Outcome for Simulated {
    type Reply = SimulationReply;

    fn length(&self) -> usize {
        match &self.reply {
            SimulationReply::Line(reply) => reply.length(),
            SimulationReply::Plane(PlanarReply { steps, stress, .. }) => {
                let radii = stress.as_ref().map_or(0, |stress| stress.radius.len());
                REPLY_LENGTH + steps.len() * STATE_LENGTH + radii * 7 * NUMBER_LENGTH
            }
        }
    }

    fn table(&self, shown: &DisplayOptions) -> Option<Table<'_>> {
        match &self.reply {
            SimulationReply::Line(reply) => reply.table(shown),
            SimulationReply::Plane(reply) => plane::table(reply, part(shown, false, reply.stress.is_some())),
        }
    }

    fn picture(&self, shown: &DisplayOptions) -> Option<Drawing> {
        match &self.reply {
            SimulationReply::Line(reply) => reply.picture(shown),
            SimulationReply::Plane(reply) => {
                let part = part(shown, false, reply.stress.is_some());
                plane::plot(reply, part, Vec::new()).map(Drawing::Plot)
            }
        }
    }

    fn computed_picture(&self, shown: &DisplayOptions, stop: &dyn Stop) -> Result<Option<Drawing>, Failure> {
        match &self.reply {
            SimulationReply::Line(reply)
                if reply.steps.len() > 1 && part(shown, reply.residual.is_some(), reply.stress.is_some()) == STEPS =>
            {
                Ok(Some(Drawing::Plot(loop_of(simulation::trace_simulation(&self.task, stop)?, &reply.steps))))
            }
            SimulationReply::Plane(reply)
                if self.task.steps == Steps::All && part(shown, false, reply.stress.is_some()) == STEPS =>
            {
                let curve = simulation::trace_in_plane(&self.task, reply, stop)?;
                Ok(plane::plot(reply, STEPS, curve).map(Drawing::Plot))
            }
            _ => Ok(self.picture(shown)),
        }
    }
}

impl Outcome for SimulateReply {
    type Reply = SimulateReply;

    fn length(&self) -> usize {
        let along = |stress: &Stress| {
            stress.places().len() * (1 + stress::fields(stress).iter().filter(|field| field.2.is_some()).count())
        };
        let below = self.subsurface.as_ref().map_or(0, |stress| {
            stress.x.len() * (3 + stress.columns().iter().filter(|(_, values)| values.is_some()).count())
        });
        let numbers = self.stress.as_ref().map_or(0, along) + below;
        REPLY_LENGTH + self.steps.len() * STATE_LENGTH + numbers * NUMBER_LENGTH
    }

    /// A row for each state, radius or extremum.
    fn table(&self, shown: &DisplayOptions) -> Option<Table<'_>> {
        match part(shown, self.residual.is_some(), self.stress.is_some()) {
            "residual" => self.residual.as_ref().map(residual::table),
            "stress" => {
                let stress = self.stress.as_ref()?;
                Some(stress::table(stress::place_column(stress), &stress::fields(stress)))
            }
            _ => {
                let (state, first) = (|row: usize| &self.steps[row], self.steps.first());
                let twists = self.steps.iter().any(|state| state.twist.is_some());
                let more = columns_of_some_states(first, twists, state);
                Some(Table::flat(self.steps.len(), state_columns(state).into_iter().chain(more).collect()))
            }
        }
    }

    /// Force over displacement, the stresses over the radius, or the extrema.
    fn picture(&self, shown: &DisplayOptions) -> Option<Drawing> {
        let plot = match part(shown, self.residual.is_some(), self.stress.is_some()) {
            "residual" => {
                let between = self.stress.as_ref().map(|stress| stress::points(stress.places(), &stress.shear));
                residual::plot(
                    "Residual stress at the end of the path".to_owned(),
                    self.residual.as_ref()?,
                    between.unwrap_or_default(),
                )
            }
            "stress" => stresses(self.stress.as_ref()?),
            _ => loop_of(Vec::new(), &self.steps),
        };
        Some(Drawing::Plot(plot))
    }
}

/// The part that is shown if nothing else is asked for.
const STEPS: &str = "steps";
/// Which part is shown.
const SHOW: Choice = Choice {
    name: "show",
    description: "Which part of the document a format other than `columns` shows: the states along the path (`steps`), \
                  the stresses over the radius (`stress`), or the extrema of the shear stress (`residual`).",
    words: &["steps", "stress", "residual"],
};

/// What is asked for, in the order in which it is shown if the query names nothing.
fn part(shown: &DisplayOptions, has_residual: bool, has_stress: bool) -> &'static str {
    shown.choice.unwrap_or(match (has_residual, has_stress) {
        (true, _) => "residual",
        (false, true) => "stress",
        (false, false) => STEPS,
    })
}

/// The columns of a state by its row.
pub fn state_columns<'a>(state: impl Fn(usize) -> &'a State + Copy + Send + 'a) -> [Column<'a>; 10] {
    let floats = |name, unit, of: fn(&State) -> f64| Column::floats(name, unit, move |row| of(state(row)));
    [
        Column::floats("displacement", "m", move |row| state(row).displacement),
        Column::floats("force", "N", move |row| state(row).force),
        floats("indentation", "m", |state| state.indentation),
        floats("normal_force", "N", |state| state.normal_force),
        floats("contact_radius", "m", |state| state.contact_radius),
        floats("stick_radius", "m", |state| state.stick_radius),
        Column::words("regime", move |row| state(row).regime.name()),
        floats("dissipated_energy", "J", |state| state.dissipated_energy),
        floats("elastic_energy", "J", |state| state.elastic_energy),
        Column::counts("memory_depth", move |row| state(row).memory_depth as u64),
    ]
}

/// Name, unit and value of a column.
type OptionalColumn = (&'static str, &'static str, fn(&State) -> Option<f64>);

/// The columns of a state that not every contact has, if the first state has them; of a twist if any may have it.
pub fn columns_of_some_states<'a>(
    first: Option<&State>,
    twists: bool,
    state: impl Fn(usize) -> &'a State + Copy + Send + 'a,
) -> Vec<Column<'a>> {
    let columns: [OptionalColumn; 9] = [
        ("stick_centre", "m", |state| state.stick_centre),
        ("electrical_conductance", "S", |state| state.electrical_conductance),
        ("thermal_conductance", "W/K", |state| state.thermal_conductance),
        ("time", "s", |state| state.time),
        ("viscous_work", "J", |state| state.viscous_work),
        ("surface_energy", "J", |state| state.surface_energy),
        ("adhesion_loss", "J", |state| state.adhesion_loss),
        ("twist", "rad", |state| state.twist),
        ("torque", "N·m", |state| state.torque),
    ];
    let has = |(name, _, of): &OptionalColumn| {
        first.is_some_and(|first| of(first).is_some()) || twists && matches!(*name, "twist" | "torque")
    };
    let column = |(name, unit, of): OptionalColumn| Column::floats(name, unit, move |row| of(state(row)));
    columns.into_iter().filter(has).map(column).collect()
}

/// A panel for each unit.
fn stresses(stress: &Stress) -> Plot {
    let [pressure, shear, slip, displacement, hoop] = stress::fields(stress);
    let drawn = [
        (pressure, Colour::Grey),
        (shear, Colour::Blue),
        (hoop, Colour::Blue),
        (slip, Colour::Red),
        (displacement, Colour::Blue),
    ];
    let panels = stress::panels(stress.places(), &drawn, &[("stress", "Pa"), ("displacement", "m")]);
    Plot::new("Stresses at the end of the path", stress::place_axis(stress.x.is_some()), panels)
}

/// The curve of a path, and the states at the ends of its moves.
fn loop_of(curve: Vec<simulation::Point>, steps: &[State]) -> Plot {
    let twisted = steps.iter().any(|state| state.twist.is_some());
    let ends = steps.iter().map(|state| match (state.twist, state.torque) {
        (Some(twist), Some(torque)) => (twist, torque),
        _ => (state.displacement.unwrap_or_default(), state.force.unwrap_or_default()),
    });
    let curves = vec![Curve::line("", Colour::Blue, curve), Curve::dots("", Colour::Blue, ends)];
    let (x, y) = if twisted {
        (Axis::of("angle of twist ω", "rad"), Axis::of("torque M", "N·m"))
    } else {
        (Axis::of("displacement U", "m"), Axis::of("tangential force F", "N"))
    };
    Plot::new("States along the path", x, vec![Panel { y, curves }])
}
