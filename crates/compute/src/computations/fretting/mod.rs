//! `fretting`: fatigue criteria over the steady cycle of a contact.

mod picture;
mod rating;
mod warnings;

use std::iter;

use stickslip_mechanics::Stress;
use stickslip_mechanics::fatigue::{self, CriticalDistance};
use stickslip_wire::fretting::FrettingTask;
use stickslip_wire::{FrettingReply, FrettingRequest};

use super::subsurface::column_table;
use crate::computations::prelude::*;
use crate::simulation::bytes::PLACE_ROW;
use crate::simulation::cost::{KINK_COST, MOVE_COST, PLACE_COST};

/// One instant of a curved move, with the mesh of the many pieces that it leaves.
const CURVED_INSTANT_COST: u64 = 20_000_000;
/// Instants of each move that a place is assumed to need.
const ASSUMED_INSTANTS: usize = 48;
/// One state of a cycle with its field under a sphere, at an instant that one place alone has.
const FIELD_COST: u64 = 1_000;
/// Places of the net of a search, and of that which only asks whether a larger value exists; instants of each move
/// there.
const NET: u64 = 2_500;
const SPARSE_NET: u64 = 250;
const NET_INSTANTS: u64 = 9;
/// Places that such a search climbs over for each criterion.
const CLIMB: u64 = 500;
const SHORT_CLIMB: u64 = 15;
/// Depths at which a stress is averaged.
const LINE_DEPTHS: u64 = 100;
/// One stress in the search for a plane among those of a grid alone.
const GRID_PLANES_COST: u64 = 5_000;
/// One stress in one criterion without planes.
const CRITERION_COST: u64 = 1_000;
/// One stress in the search for a critical plane.
const PLANES_COST: u64 = 20_000;
/// Places of a search for the largest values, which are held together.
const SEARCHED_PLACES: usize = 4_096;

/// Fatigue criteria over the steady cycle of a contact.
pub struct Fretting;

/// The criteria, and what was asked for.
pub struct Rated {
    reply: FrettingReply,
    task: FrettingTask,
}

impl Computation for Fretting {
    const ABOUT: About = About {
        name: "fretting",
        route: Some(Route { path: "/fretting", operation: "rate_fretting", tag: "simulation" }),
        title: "Rate a cycle for fretting fatigue",
        description: "Repeats a path until it closes, computes the stress tensor at every place over the steady \
                      cycle and rates it by fatigue criteria: where would a crack start, on which plane, and how far \
                      is it from a limit. Nothing is stored.",
        reply: "The criteria, place by place",
        shows: "A picture shows one criterion over a `plane`, the `surface` or a `line`.",
        choice: Some(CRITERION),
        ..About::TABLE
    };

    type Request = FrettingRequest;
    type Outcome = Rated;

    fn examples() -> Vec<Example> {
        vec![
            example(
                "section",
                "Crossland's criterion under a cycle in partial slip",
                json!({
                    "contact": ContactDefinition::example(),
                    "path": {"cycles": {"displacement": 1e-7, "count": 1}},
                    "body": "first",
                    "plane": {"normal": "y", "offset": 0.0, "x": [-1.2e-4, 1.2e-4, 25], "z": [0.0, 6e-5, 7]},
                    "criteria": {"crossland": {"alpha": 0.3, "limit": 3e8}}
                }),
            ),
            example(
                "surface",
                "Critical planes and Ruiz's parameters on the surface, with a bulk stress",
                json!({
                    "contact": ContactDefinition::example(),
                    "path": {"displacement": [1e-7, -1e-7]},
                    "body": "first",
                    "surface": {"x": [-1.2e-4, 1.2e-4, 9], "y": [-1e-5, 1e-5, 2]},
                    "bulk": {"amplitude": 5e7},
                    "criteria": {"findley": {"k": 0.3}, "ruiz": {}, "friction_work": {}}
                }),
            ),
            example(
                "life",
                "Lives at the worst place and at a critical distance below it",
                json!({
                    "contact": ContactDefinition::example(),
                    "path": {"cycles": {"displacement": 1e-7, "count": 1}},
                    "body": "first",
                    "surface": {"x": [-1.2e-4, 1.2e-4, 13], "y": [0.0, 1e-5, 2]},
                    "critical_distance": {"length": 1e-5, "method": "point"},
                    "criteria": {
                        "crossland": {"alpha": 0.3, "life": {
                            "s_n": {"reference": 3e8, "cycles": 1e6, "exponent": 8.0}
                        }},
                        "swt": {"life": {"strain_life": {
                            "strength": 9.5e8, "strength_exponent": -0.09, "ductility": 0.26, "ductility_exponent": -0.6
                        }}}
                    }
                }),
            ),
        ]
    }

    fn check_shown((.., task): &Task<Self>, shown: &DisplayOptions) -> Result<(), Fault> {
        picture::criterion(task, shown).map(drop)
    }

    /// The states and fields of a cycle, the places of a search, and the values.
    fn bytes((definition, _, task): &Task<Self>) -> usize {
        let lives = task.measures.iter().flatten().filter(|asked| asked.life.is_some()).count();
        let columns = lives + task.measures.iter().flatten().count();
        let path = size_of::<Stress>() + 8 * 2 * NUMBER_LENGTH;
        let instants = task.plan.length() * ASSUMED_INSTANTS;
        task.places.count() * (3 + columns) * NUMBER
            + SEARCHED_PLACES * (4 + columns) * NUMBER
            + task.stress_paths.len() * instants * path
            + fatigue::MOST_BYTES
            + fatigue::FIELD_BYTES
            + of_shape(&definition.profile)
    }

    fn rows((.., task): &Task<Self>) -> (usize, usize) {
        (task.places.count(), PLACE_ROW)
    }

    /// Of the criteria at some places and of the search beside them, or of a search for the worst places.
    fn cost((_, setup, task): &Task<Self>) -> Nanoseconds {
        let moves = task.plan.length() as u64;
        let stress = match &*setup.profile {
            Profile::Sphere(_) => KINK_COST * 4,
            _ => PLACE_COST,
        };
        let (planes, all) = (task.planes() as u64, task.measures.iter().flatten().count());
        let instants = moves * ASSUMED_INSTANTS as u64;
        let each = instants.saturating_mul(stress + FIELD_COST + CRITERION_COST + planes * PLANES_COST);
        let (net, climb) = if task.searches() { (NET, CLIMB) } else { (SPARSE_NET, SHORT_CLIMB) };
        let netted = (net * moves * NET_INSTANTS).saturating_mul(stress + CRITERION_COST + planes * GRID_PLANES_COST);
        let curved = (task.plan.curved() * ASSUMED_INSTANTS) as u64;
        let followed = (instants * MOVE_COST).saturating_add(curved.saturating_mul(CURVED_INSTANT_COST));
        // Below each worst place of the surface, which a search may have to look for.
        let (below, climb) = match task.critical_distance {
            None => (0, climb),
            Some(CriticalDistance::Point(_)) => (1, 2 * climb),
            Some(CriticalDistance::Line(_)) => (LINE_DEPTHS, 2 * climb),
        };
        let averaged = (below * all as u64).saturating_mul(instants * stress);
        let places = (task.places.count() as u64).saturating_add(climb * all as u64);
        places.saturating_mul(each).saturating_add(averaged).saturating_add(netted).saturating_add(followed)
    }

    fn run(task: Task<Self>, stop: &dyn Stop) -> Result<Rated, Failure> {
        cost::check(Self::cost(&task), stop)?;
        let (_, setup, task) = task;
        Ok(Rated { reply: rating::rate(setup, &task, stop)?, task })
    }
}

/// Which criterion a picture shows.
const CRITERION: Choice = Choice {
    name: "criterion",
    description: "Which criterion a picture shows, by its name in the reply: `crossland`, `dang_van`, `findley`, \
                  `swt`, `fatemi_socie`, `ruiz`, `ruiz_tension` or `friction_work`. It must be one of `criteria`, and \
                  may be left out if there is only one. Other formats have all criteria.",
    words: &picture::NAMES,
};

impl Borrow<FrettingReply> for Rated {
    fn borrow(&self) -> &FrettingReply {
        &self.reply
    }
}

impl Outcome for Rated {
    type Reply = FrettingReply;

    fn table(&self, _: &DisplayOptions) -> Option<Table<'_>> {
        let FrettingReply { x, y, z, .. } = &self.reply;
        let ratings = self.reply.ratings().flat_map(|(name, unit, rating)| {
            let cycles = rating.cycles.iter().map(move |cycles| (format!("{name}_cycles"), "1", &cycles[..]));
            iter::once((name.to_owned(), unit, &rating.values[..])).chain(cycles)
        });
        Some(column_table([x, y, z], ratings))
    }

    fn picture(&self, shown: &DisplayOptions) -> Option<Drawing> {
        let criterion = picture::criterion(&self.task, shown).ok()??;
        Some(picture::plot(&self.reply, &self.task, criterion))
    }
}
