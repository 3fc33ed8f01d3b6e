//! Stresses and displacements of a sum with tables at many radii, since both are linear in g: each table goes through
//! its panels once for all rings, and the kernels of the other parts are added by pieces, or ring by ring.

use super::super::shape::{self, KernelOrder, Shape, span};
use super::super::smooth_pieces::SmoothPieces;
use super::super::{Profile, Ring, Span, StressRadius};
use super::Sum;
use crate::cells::field::{SumAndSize, WeightedCells, add_to};
use crate::cells::kernel::Kernel;

/// The parts of a sum over weighted rings.
pub(crate) struct SumFields<'a> {
    tables: Vec<WeightedCells<'a>>,
    /// The other parts, each with its pieces, if it has such.
    others: Vec<(&'a Profile, Option<SmoothPieces<'a, Profile>>)>,
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
                Profile::Tabulated(table) => tables.push(table.cells_over(&spans, radii)?),
                other => others.push((other, pieces(other, &spans))),
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
        for (part, pieces) in &self.others {
            let found = match (kernel, pieces) {
                (Kernel::Root, Some(pieces)) => {
                    pieces.sums(radii).into_iter().map(|kernel| (kernel, kernel.abs())).collect()
                }
                (Kernel::RootSlope, Some(pieces)) => pieces.slopes(radii, |_| true),
                _ => radii.iter().map(|at| self.by_rings(part, kernel, at)).collect(),
            };
            sums.iter_mut().zip(found).for_each(|(sum, (term, size))| *sum = (sum.0 + term, sum.1 + size));
        }
        sums
    }

    /// The same of one part, ring by ring.
    fn by_rings(&self, part: &Profile, kernel: Kernel, at: &StressRadius) -> SumAndSize {
        let mut sum = (0.0, 0.0);
        for (span, weight) in self.spans.iter().filter(|(_, weight)| weight.abs() > 0.0) {
            add_to(&mut sum, weight * of_part(kernel, part, at, span));
        }
        sum
    }
}

/// The sum of a kernel over a part of a sum.
pub(super) fn of_part(kernel: Kernel, part: &Profile, at: &StressRadius, span: &Span) -> f64 {
    match kernel {
        Kernel::Root => Shape::kernel(part, KernelOrder::Value, at, span),
        Kernel::RootSlope => Shape::kernel(part, KernelOrder::Slope, at, span),
        Kernel::Arccos | Kernel::Arcsin => {
            kernel.angle_sum(at, span, || (part.rise(span), shape::displacement_integral(part, at, span)))
        }
    }
}

/// The pieces of a part over weighted spans from the centre outward.
fn pieces<'a>(part: &'a Profile, spans: &[(Span, f64)]) -> Option<SmoothPieces<'a, Profile>> {
    let mut made = SmoothPieces::within(part, spans.last()?.0.outer_radius, 0.0, spans.len());
    spans.iter().rev().try_for_each(|(span, weight)| made.add(span, *weight))?;
    Some(made)
}
