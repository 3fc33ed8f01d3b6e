//! What the panels of a table are to stresses far away: sources of 1/sqrt kernels, in clusters.

use super::panel::KernelPanel;
use crate::numerics::cluster_tree::ClusterTree;
use crate::numerics::gauss;
use crate::numerics::multipole::Multipole;

/// The panels' sources g' dx over X = x^2.
pub(super) fn sources(panels: &[KernelPanel]) -> ClusterTree<Multipole> {
    ClusterTree::new(panels.len(), 1, |items, halves| {
        let last = &panels[items.end - 1];
        let end = last.span(panels.get(items.end)).outer;
        let mut sources = Multipole::empty((panels[items.start].square.value(), end.value()));
        match halves {
            Some(halves) => halves.into_iter().for_each(|half: &Multipole| sources.add(half, 1.0)),
            None => add_panel(&mut sources, last, (last.low, last.high), 1.0),
        }
        sources
    })
}

/// Adds the sources of a panel from `low` to `high` in t.
pub(super) fn add_panel(sources: &mut Multipole, panel: &KernelPanel, (low, high): (f64, f64), weight: f64) {
    let places = gauss::TWENTY_POINTS.map(|(u, _)| high - (high - low) * u);
    let slopes = panel.slopes_over_radius(places);
    let share = |index: usize| weight * (high - low) * gauss::TWENTY_POINTS[index].1;
    sources.add_sources(
        &places.map(|t| panel.square.value() - sources.interval.0 + (t - panel.low) * (t + panel.low)),
        &std::array::from_fn(|index| share(index) * places[index] * slopes[index]),
    );
}
