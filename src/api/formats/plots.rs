//! The plots of a contact's stress, history, loop and cycles.

use uuid::Uuid;

use super::fretting_map;
use stickslip_mechanics::{Contact, Move, Regime, Tangential};
use stickslip_report::plot::{Axis, Band, Colour, Curve, Panel, Plot, Section, in_unit};
use stickslip_wire::cycle::CycleTask;
use stickslip_wire::fit::FittedLoop;
use stickslip_wire::profile_fit::ColumnPair;
use stickslip_wire::subsurface::{Places, SubsurfaceTask};
use stickslip_wire::{
    Cycle, CyclePage, CycleReply, FitReply, FrettingReply, HistoryPage, LoopPage, ProfileFitReply, State, SteadyCycle,
    StressReply, Subsurface,
};

/// Why some stresses below the surface have no picture.
pub const NO_SECTION: &str =
    "a picture is of one of `von_mises`, `max_shear` and `hydrostatic` over a `plane` or the `surface`";
/// Why some ratings have none.
pub const NO_RATED_SECTION: &str = "a picture is of one criterion over a `plane` or the `surface`";
/// Points of each branch of a steady loop.
const BRANCH_POINTS: usize = 200;
/// How far the strokes of outliers reach at most, in standard deviations of the residual.
const LARGEST_RESIDUAL: f64 = 10.0;

/// Shear stress between the bounds of friction, with the regions that stuck and slipped in the last move.
#[must_use]
pub fn stress(id: Uuid, sequence: u64, contact: &Contact, reply: &StressReply) -> Plot {
    let over = |values: &Option<Vec<Option<f64>>>, factor: f64| {
        let values = values.iter().flatten().map(|value| factor * value.unwrap_or(f64::NAN));
        reply.radius.iter().copied().zip(values).collect::<Vec<_>>()
    };
    let state = contact.state();
    let friction = contact.friction();
    let (stick, edge) = (state.stick_radius, state.contact_radius);
    let mut bands = Vec::new();
    if state.regime != Regime::Separated {
        if stick > 0.0 {
            bands.push(Band { name: "stick", from: 0.0, to: stick, colour: Colour::Blue });
        }
        if stick < edge {
            bands.push(Band { name: "slip", from: stick, to: edge, colour: Colour::Red });
        }
    }
    let curve = |name, points, colour, silent| Curve { name, points, colour, silent };
    Plot {
        title: format!("Contact {id} after move {sequence}: shear stress"),
        x: Axis { name: "radius r", unit: Some("m") },
        panels: vec![Panel {
            y: Axis { name: "stress", unit: Some("Pa") },
            curves: vec![
                curve("friction bound ±μp", over(&reply.pressure, friction), Colour::Grey, false),
                curve("", over(&reply.pressure, -friction), Colour::Grey, true),
                curve("shear stress τ", over(&reply.shear, 1.0), Colour::Blue, false),
            ],
        }],
        bands,
    }
}

/// One field below the surface over a plane.
#[must_use]
pub fn section(stress: &Subsurface, task: &SubsurfaceTask) -> Section {
    let fields = [
        ("von Mises stress", &stress.von_mises),
        ("largest shear stress", &stress.max_shear),
        ("mean stress", &stress.hydrostatic),
    ];
    let (name, values) =
        fields.into_iter().find_map(|(name, values)| Some((name, values.as_deref()?))).unwrap_or_default();
    over_plane(format!("{name} in the {} body", task.body_name()), (name, "Pa"), values, &task.places)
}

/// One fatigue criterion over a plane.
#[must_use]
pub fn fretting(reply: &FrettingReply, places: &Places) -> Section {
    let (title, name, unit, values) = match reply.ratings().next() {
        Some((name, unit, rating)) => {
            let largest = rating.largest.as_ref().map(|largest| format!(", at most {:.4e} {unit}", largest.value));
            (format!("{name}{}", largest.unwrap_or_default()), name, unit, &rating.values[..])
        }
        None => Default::default(),
    };
    over_plane(title, (name, unit), values, places)
}

fn over_plane(
    title: String,
    (name, unit): (&'static str, &'static str),
    values: &[Option<f64>],
    places: &Places,
) -> Section {
    let [x, y, z] = places.axes().unwrap_or_default();
    let values = values.iter().map(|value| value.unwrap_or(f64::NAN)).collect();
    let axis = |name| Axis { name, unit: Some("m") };
    let (across, along, depth) = (axis("x, along the motion"), axis("y, across the motion"), axis("depth z"));
    // The grid runs along x, y and z in turn, and is a single value along one of them.
    let (first, second, downwards) = if y.len() == 1 {
        ((across, x), (depth, z), true)
    } else if z.len() == 1 {
        ((across, x), (along, y), false)
    } else {
        ((along, y), (depth, z), true)
    };
    let unit = Axis { name, unit: Some(unit).filter(|unit| *unit != "1") };
    Section { title, x: first, y: second, downwards, values: (unit, values) }
}

/// Displacement, force and friction work over the moves.
#[must_use]
pub fn history(id: Uuid, page: &HistoryPage) -> Plot {
    let panel = |name, unit, colour, of: fn(&State) -> f64| Panel {
        y: Axis { name, unit: Some(unit) },
        curves: vec![Curve {
            name: "",
            points: page.items.iter().map(|item| (item.sequence as f64, of(&item.state))).collect(),
            colour,
            silent: true,
        }],
    };
    Plot {
        title: format!("Contact {id}: history{}", shown(page.items.iter().map(|item| item.sequence))),
        x: Axis { name: "move", unit: None },
        panels: vec![
            panel("displacement", "m", Colour::Blue, |state| state.displacement),
            panel("force", "N", Colour::Blue, |state| state.force),
            panel("friction work", "J", Colour::Red, |state| state.dissipated_energy),
        ],
        bands: Vec::new(),
    }
}

/// Force over displacement.
#[must_use]
pub fn hysteresis_loop(id: Uuid, page: &LoopPage) -> Plot {
    let points = page.displacement.iter().copied().zip(page.force.iter().copied()).collect();
    Plot {
        title: format!(
            "Contact {id}: hysteresis loop{}",
            shown(page.sequence.iter().copied().filter(|number| *number > 0))
        ),
        x: Axis { name: "displacement U", unit: Some("m") },
        panels: vec![Panel {
            y: Axis { name: "tangential force F", unit: Some("N") },
            curves: vec![Curve { name: "", points, colour: Colour::Blue, silent: true }],
        }],
        bands: Vec::new(),
    }
}

/// Which moves a plot shows, for its title.
fn shown(mut moves: impl DoubleEndedIterator<Item = u64>) -> String {
    let Some(last) = moves.next_back() else { return String::new() };
    match moves.next() {
        Some(first) if first < last => format!(", moves {first} to {last}"),
        _ => format!(", move {last}"),
    }
}

/// Amplitudes, friction work and stiffness of the cycles over the moves that closed them.
#[must_use]
pub fn cycles(id: Uuid, page: &CyclePage) -> Plot {
    let panel = |name, unit, colour, of: fn(&Cycle) -> f64| Panel {
        y: Axis { name, unit: Some(unit) },
        curves: vec![Curve {
            name: "",
            points: page.items.iter().map(|cycle| (cycle.to as f64, of(cycle))).collect(),
            colour,
            silent: true,
        }],
    };
    Plot {
        title: format!("Contact {id}: closed cycles"),
        x: Axis { name: "move", unit: None },
        panels: vec![
            panel("displacement amplitude", "m", Colour::Blue, |cycle| cycle.displacement_amplitude),
            panel("force amplitude", "N", Colour::Blue, |cycle| cycle.force_amplitude),
            panel("friction work", "J", Colour::Red, |cycle| cycle.dissipated_energy),
            panel("secant stiffness", "N/m", Colour::Blue, |cycle| cycle.secant_stiffness.unwrap_or(f64::NAN)),
        ],
        bands: Vec::new(),
    }
}

/// Loss factor and secant stiffness over the amplitude, or the loop if there is one amplitude at constant load, or the
/// fretting map. `contact` is at the load of
/// the cycles and has no history.
#[must_use]
pub fn cycle(contact: &Contact, reply: &CycleReply, task: &CycleTask) -> Plot {
    if task.map.is_some() {
        return fretting_map::plot(&reply.cycles, task.drives().len());
    }
    if let ([only], None) = (&reply.cycles[..], task.normal) {
        return steady_loop(contact, only);
    }
    let panel = |name, unit, colour, of: fn(&SteadyCycle) -> f64| {
        let mut points: Vec<_> = reply.cycles.iter().map(|cycle| (cycle.displacement_amplitude, of(cycle))).collect();
        points.sort_by(|one, other| one.0.total_cmp(&other.0));
        Panel { y: Axis { name, unit }, curves: vec![Curve { name: "", points, colour, silent: true }] }
    };
    Plot {
        title: "Steady cycles".to_owned(),
        x: Axis { name: "displacement amplitude U₀", unit: Some("m") },
        panels: vec![
            panel("loss factor", None, Colour::Red, |cycle| cycle.loss_factor.unwrap_or(f64::NAN)),
            panel("secant stiffness", Some("N/m"), Colour::Blue, |cycle| cycle.secant_stiffness),
        ],
        bands: Vec::new(),
    }
}

/// The loop of a steady cycle, followed from its upper end.
fn steady_loop(contact: &Contact, cycle: &SteadyCycle) -> Plot {
    let mut contact = contact.clone();
    let mut at = |share: f64| {
        let displacement = share * cycle.displacement_amplitude;
        let step = Move { tangential: Some(Tangential::Displacement(displacement)), ..Move::default() };
        (displacement, contact.apply(&step).map_or(f64::NAN, |()| contact.force()))
    };
    let down = (0..=BRANCH_POINTS).map(|index| 1.0 - 2.0 * index as f64 / BRANCH_POINTS as f64);
    let up = down.clone().map(|share| -share);
    let points = down.chain(up).map(&mut at).collect();
    Plot {
        title: format!("Steady cycle of {:.4e} J", cycle.dissipated_energy),
        x: Axis { name: "displacement U", unit: Some("m") },
        panels: vec![Panel {
            y: Axis { name: "tangential force F", unit: Some("N") },
            curves: vec![Curve { name: "", points, colour: Colour::Blue, silent: true }],
        }],
        bands: Vec::new(),
    }
}

/// A scan and the profile that was fitted to it, over the difference of both.
#[must_use]
pub fn profile_fit(reply: &ProfileFitReply) -> Plot {
    let used = &reply.used;
    let fitted = |radius: f64| {
        let above = used.radius.partition_point(|&r| r < radius).clamp(1, used.radius.len() - 1);
        let (low, high) = (used.radius[above - 1], used.radius[above]);
        let share = (radius - low) / (high - low);
        used.height[above - 1] + share * (used.height[above] - used.height[above - 1])
    };
    let pairs = |columns: &ColumnPair| -> Vec<(f64, f64)> {
        columns.radius.iter().copied().zip(columns.height.iter().copied()).collect()
    };
    let residual = |columns: &ColumnPair| pairs(columns).into_iter().map(|(r, z)| (r, z - fitted(r))).collect();
    // A point that was left out has no neighbours to be joined with: a short stroke to the profile marks it.
    let strokes = |to: fn(f64, f64) -> [f64; 2]| -> Vec<(f64, f64)> {
        let each = pairs(&reply.left_out).into_iter();
        each.flat_map(|(r, z)| to(z, fitted(r)).map(|end| (r, end)).into_iter().chain([(r, f64::NAN)])).collect()
    };
    let curve = |name, points, colour| Curve { name, points, colour, silent: false };
    let most = reply.residual.rms * LARGEST_RESIDUAL;
    Plot {
        title: format!("Profile from a scan: residual {:.3e} m rms", reply.residual.rms),
        x: Axis { name: "radius r", unit: Some("m") },
        panels: vec![
            Panel {
                y: Axis { name: "height of the gap", unit: Some("m") },
                curves: vec![
                    curve("scan", pairs(&reply.raw), Colour::Grey),
                    curve("left out", clipped(strokes(|z, f| [f, z]), used), Colour::Red),
                    curve("profile", pairs(used), Colour::Blue),
                ],
            },
            Panel {
                y: Axis { name: "scan less profile", unit: Some("m") },
                curves: vec![
                    curve("scan", residual(&reply.raw), Colour::Grey),
                    curve(
                        "left out",
                        strokes(|z, f| [0.0, z - f]).into_iter().map(|(r, e)| (r, e.clamp(-most, most))).collect(),
                        Colour::Red,
                    ),
                ],
            },
        ],
        bands: Vec::new(),
    }
}

/// Strokes within half the height of a profile about it: an outlier may be far off.
fn clipped(strokes: Vec<(f64, f64)>, used: &ColumnPair) -> Vec<(f64, f64)> {
    let top = used.height.last().copied().unwrap_or(0.0);
    strokes.into_iter().map(|(r, z)| (r, z.clamp(-0.5 * top, 1.5 * top))).collect()
}

/// Measured loops and what was fitted to them, over the difference of both.
#[must_use]
pub fn loop_fit(reply: &FitReply) -> Plot {
    // Loops are not joined with each other.
    let over = |of: fn(&FittedLoop, usize) -> f64| -> Vec<(f64, f64)> {
        let each = |curve: &FittedLoop| -> Vec<(f64, f64)> {
            let points = curve.displacement.iter().enumerate().map(|(point, u)| (*u, of(curve, point)));
            points.chain([(f64::NAN, f64::NAN)]).collect()
        };
        reply.curve.iter().flat_map(each).collect()
    };
    // A point that was left out is drawn alone.
    let outliers = |of: fn(&FittedLoop, usize) -> f64| -> Vec<(f64, f64)> {
        let each = |curve: &FittedLoop| -> Vec<(f64, f64)> {
            let left = curve.used.iter().enumerate().filter(|(_, used)| !**used);
            left.flat_map(|(point, _)| [(curve.displacement[point], of(curve, point)), (f64::NAN, f64::NAN)]).collect()
        };
        reply.curve.iter().flat_map(each).collect()
    };
    let curve = |name, points, colour, silent| Curve { name, points, colour, silent };
    let measured: fn(&FittedLoop, usize) -> f64 = |curve, point| curve.measured[point];
    let residual: fn(&FittedLoop, usize) -> f64 = |curve, point| curve.measured[point] - curve.force[point];
    let left = outliers(measured);
    let silent = left.is_empty();
    Plot {
        title: format!("Measured loop: residual {} rms", in_unit(reply.residual.rms, "N")),
        x: Axis { name: "measured displacement", unit: Some("m") },
        panels: vec![
            Panel {
                y: Axis { name: "tangential force F", unit: Some("N") },
                curves: vec![
                    curve("measured", over(measured), Colour::Grey, false),
                    curve("outliers", left, Colour::Red, silent),
                    curve("fitted", over(|curve, point| curve.force[point]), Colour::Blue, false),
                ],
            },
            Panel {
                y: Axis { name: "measured less fitted", unit: Some("N") },
                curves: vec![
                    curve("", over(residual), Colour::Grey, true),
                    curve("", outliers(residual), Colour::Red, true),
                ],
            },
        ],
        bands: Vec::new(),
    }
}
