//! The kernel's sources g' dx of a table over X = x^2, in a tree of clusters of panels, each by its Legendre moments ([`legendre`]).

use super::super::gauss;
use super::legendre::{self, LegendreMoments, ORDERS};
use super::panel::Panel;
use std::ops::Range;

/// The panels `first..last` between two squares of radii, m^2. The clusters of a tree are listed children first.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cluster {
    pub(super) first: usize,
    pub(super) last: usize,
    pub(super) interval: (f64, f64),
    pub(super) moments: LegendreMoments,
}

/// A binary tree over all panels, with one panel in a leaf.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SourceTree(Vec<Cluster>);

/// The moments, over an interval, of the sources of a panel from `low` to `high` in t.
pub(super) fn add_panel(
    moments: &mut LegendreMoments,
    interval: (f64, f64),
    panel: &Panel,
    (low, high): (f64, f64),
    weight: f64,
) {
    const NODES: usize = 20;
    let (mut places, mut weights, mut index) = ([0.0; NODES], [0.0; NODES], 0);
    let half = (0.5 * (interval.1 - interval.0)).max(f64::MIN_POSITIVE);
    let centre = 0.5 * ((interval.0 - panel.square.value()) + (interval.1 - panel.square.value()));
    gauss::Panel::fine(high - low).visit(|below, share| {
        let t = high - below;
        places[index] = (((t - panel.low) * (t + panel.low) - centre) / half).clamp(-1.0, 1.0);
        weights[index] = weight * share * t * panel.slope_over_radius(t);
        index += 1;
    });
    legendre::add_sources(moments, &places, &weights);
}

impl SourceTree {
    pub(super) fn new(panels: &[Panel]) -> SourceTree {
        let mut tree = SourceTree(Vec::with_capacity(2 * panels.len()));
        tree.build(panels, 0, panels.len());
        tree
    }

    fn build(&mut self, panels: &[Panel], first: usize, last: usize) {
        let end = panels.get(last).map_or_else(|| panels[last - 1].end().0, |next| next.square);
        let interval = (panels[first].square.value(), end.value());
        let mut moments = [0.0; ORDERS];
        if last - first == 1 {
            let panel = &panels[first];
            add_panel(&mut moments, interval, panel, (panel.low, panel.high), 1.0);
        } else {
            let middle = first.midpoint(last);
            for (first, last) in [(first, middle), (middle, last)] {
                self.build(panels, first, last);
                let child = &self.0[self.0.len() - 1];
                legendre::add_shifted(&mut moments, interval, child.interval, &child.moments, 1.0);
            }
        }
        self.0.push(Cluster { first, last, interval, moments });
    }

    /// The number of the cluster of all panels.
    pub(super) fn root(&self) -> usize {
        self.0.len() - 1
    }

    pub(super) fn cluster(&self, index: usize) -> &Cluster {
        &self.0[index]
    }

    /// The numbers of the halves of a cluster of more than one panel.
    pub(super) fn children(&self, index: usize) -> Option<[usize; 2]> {
        let Cluster { first, last, .. } = self.0[index];
        // A tree over n panels has 2n - 1 clusters.
        (last - first > 1).then(|| [index - 2 * (last - first.midpoint(last)), index - 1])
    }

    /// Goes through the panels `panels` below cluster `index`: by whole clusters where they are far, else panel by panel.
    pub(super) fn visit(
        &self,
        index: usize,
        panels: &Range<usize>,
        is_far: &impl Fn((f64, f64)) -> bool,
        far: &mut impl FnMut(&Cluster),
        near: &mut impl FnMut(usize),
    ) {
        let cluster = &self.0[index];
        if cluster.first >= panels.end || cluster.last <= panels.start {
            return;
        }
        let whole = cluster.first >= panels.start && cluster.last <= panels.end;
        if whole && is_far(cluster.interval) {
            far(cluster);
        } else if let Some(children) = self.children(index) {
            children.into_iter().for_each(|child| self.visit(child, panels, is_far, far, near));
        } else {
            near(cluster.first);
        }
    }
}
