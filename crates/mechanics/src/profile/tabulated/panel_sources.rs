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
    let nodes = gauss::TWENTY_POINTS.map(|(u, share)| (high - (high - low) * u, weight * (high - low) * share));
    sources.add_sources(
        &nodes.map(|(t, _)| panel.square.value() - sources.interval.0 + (t - panel.low) * (t + panel.low)),
        &nodes.map(|(t, share)| share * t * panel.slope_over_radius(t)),
    );
}
