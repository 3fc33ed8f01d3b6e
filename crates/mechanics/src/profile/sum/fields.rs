//! Stresses and displacements of a sum with tables at many radii, since both are linear in g: each table goes through
//! its panels once for all rings, and the kernels of the other parts are added ring by ring.

use super::super::shape::span;
use super::super::tabulated::{Kernel, SumAndSize, WeightedPanels, add_to};
use super::super::{Profile, Ring, Span, StressRadius};
use super::Sum;

/// The parts of a sum over weighted rings.
pub(crate) struct SumFields<'a> {
    tables: Vec<WeightedPanels<'a>>,
    others: Vec<&'a Profile>,
    spans: Vec<(Span, f64)>,
}

impl SumFields<'_> {
    /// The parts over rings from the centre outward, each with its weight, for sums at so many radii; `None` without a
    /// table, and with levels at a vertical edge.
    pub(in super::super) fn new<'a>(sum: &'a Sum, rings: &[(Ring, f64)], radii: usize) -> Option<SumFields<'a>> {
        let (mut tables, mut others) = (Vec::new(), Vec::new());
        let spans: Vec<(Span, f64)> = rings.iter().map(|(ring, weight)| (span(sum, ring), *weight)).collect();
        for part in &sum.parts {
            match part {
                Profile::Tabulated(table) => tables.push(table.panels_over(&spans, radii)?),
                other => others.push(other),
            }
        }
        (!tables.is_empty()).then_some(SumFields { tables, others, spans })
    }

    /// The weighted sums of a kernel at radii.
    pub(in super::super) fn sums(&self, kernel: Kernel, radii: &[StressRadius]) -> Vec<SumAndSize> {
        let mut sums = vec![(0.0, 0.0); radii.len()];
        for table in &self.tables {
            for (sum, (term, size)) in sums.iter_mut().zip(table.sums(kernel, radii)) {
                *sum = (sum.0 + term, sum.1 + size);
            }
        }
        for (at, sum) in radii.iter().zip(&mut sums) {
            for (span, weight) in self.spans.iter().filter(|(_, weight)| weight.abs() > 0.0) {
                self.others.iter().for_each(|part| add_to(sum, weight * kernel.of_part(part, at, span)));
            }
        }
        sums
    }
}
