//! What a quadrature over the radii of a ring needs of it.

/// A node: its weight, m, and the depth h below the outer level, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DepthNode {
    pub(crate) weight: f64,
    pub(crate) depth: f64,
}

/// The nodes of a ring, for integrals over its radii.
pub(crate) enum RingNodes {
    /// To round-off.
    Resolved(Vec<DepthNode>),
    /// Across many kinks: coarse ones, and finer ones.
    Compared(Vec<DepthNode>, Vec<DepthNode>),
}
