//! What `POST /protocols` and `POST /contacts/{id}/relax` reply.

use super::{ProtocolEnd, ProtocolKind};
use crate::prelude::*;

replies! {
/// How to move so that little shear stress remains.
pub struct ProtocolReply omits Option {
    /// Quantities that follow from the definition at the present load.
    pub contact: ContactSummary,
    /// The law of the amplitudes.
    pub kind: ProtocolKind,
    /// Where the path ends.
    pub end: ProtocolEnd,
    /// Number of reversals N.
    pub reversals: usize,
    /// The path, which `/simulate` and `/contacts/{id}/path` take as it is.
    pub path: DisplacementPath,
    /// How the path begins.
    pub start: StartReply,
    /// Where and in which unit the remaining stress is measured.
    pub judged: JudgedReply,
    /// The stress that the path leaves, and its end.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// The results of the other laws, with the same number of reversals.
    pub comparison: Comparison,
    /// Solver, errors and time.
    pub accuracy: Accuracy,
    /// Warnings about the results.
    pub warnings: Vec<Warning>,
}

/// A path of displacements.
pub struct DisplacementPath {
    /// Tangential displacements of the indenter, m, one move each.
    pub displacement: Vec<f64>,
}

/// How a path begins.
pub struct StartReply {
    /// The first displacement of the path, m.
    pub displacement: f64,
    /// The beginning that was chosen.
    pub stroke: FirstStroke,
}
}

words! {
/// The beginning of a path.
pub enum FirstStroke of stickslip_mechanics::protocol::FirstMove {
    /// A displacement of a contact that has never moved, as asked for.
    Given = "given",
    /// A stroke to gross slip, which erases the whole slip history.
    GrossSlip = "gross_slip",
    /// A stroke that erases the outer part of the slip history and keeps the inner one.
    Partial = "partial",
    /// No path: less stress is present already than any path would leave.
    Stay = "stay",
}
}

replies! {
/// Where and in which unit the remaining stress is measured.
pub struct JudgedReply {
    /// Smallest radius where it is measured, m: zero, unless the slope of the profile jumps and the stress is infinite
    /// there after any path (the tip of a cone, the rim of a truncated profile).
    pub from_radius: f64,
    /// Largest radius where it is measured, m: the contact radius, unless the edge is vertical.
    pub to_radius: f64,
    /// μ times the pressure that stresses are compared with, Pa.
    pub unit: f64,
    /// Which pressure `unit` refers to.
    pub pressure: PressureUnit,
    /// The quantity that is minimised, in words.
    pub objective: String,
}
}

words! {
/// The pressure that stresses are compared with.
pub enum PressureUnit {
    /// The largest pressure.
    Largest = "largest",
    /// The mean pressure, where the largest is infinite.
    Mean = "mean",
}
}

replies! {
/// How far a path may be from the optimum.
pub struct Gap {
    /// By how much the smallest of the alternating extrema falls short of the largest, relative to it, a pure number;
    /// `null` where the law does not make all of them equal: with a prescribed end, or a start from a history.
    pub spread: Option<f64>,
    /// Proven lower bound of the largest shear stress after gross slip and this number of reversals, whatever their
    /// amplitudes, Pa. `null` for other starts, and at a vertical edge.
    pub lower_bound: Option<f64>,
    /// 1 - `lower_bound`/`largest`, a pure number: the largest gap that is not ruled out by proof.
    pub proven: Option<f64>,
    /// How the path was found, and the evidence that it is optimal.
    pub method: String,
}

/// Statistics of the largest stress over `judged.unit` that remains when a protocol is not followed exactly, pure
/// numbers. `null` where it is infinite.
pub struct RobustnessReply {
    /// Number of trials.
    pub samples: usize,
    /// The mean, a pure number.
    pub mean: Option<f64>,
    /// The standard error of the mean, a pure number.
    pub standard_error: Option<f64>,
    /// The value below which 95 of 100 trials stay, a pure number.
    pub percentile_95: Option<f64>,
}

/// The results of the other laws.
pub struct Comparison: Default omits Option {
    /// Amplitudes that fall linearly.
    pub linear: Option<Outcome>,
    /// Equal peaks.
    pub equal_peaks: Option<Outcome>,
    /// Minimax.
    pub minimax: Option<Outcome>,
}

/// The stress that a law leaves, and the end of its path.
pub struct Outcome omits Option {
    /// The extrema of the shear stress that remains.
    pub residual: Residual,
    /// The largest magnitude of the shear stress that remains where it is measured, Pa; `null` where it is infinite.
    #[serde_with(skip_apply)]
    pub largest: Option<f64>,
    /// `largest` over `judged.unit`, a pure number.
    #[serde_with(skip_apply)]
    pub relative: Option<f64>,
    /// Tangential displacement at the end, m.
    pub displacement: f64,
    /// Tangential force at the end, N.
    pub force: f64,
    /// Work done against friction on the path, J.
    pub dissipated_energy: f64,
    /// How far the path may be from the optimum; only for `minimax`.
    pub gap: Option<Gap>,
    /// The stress that remains if the path is not followed exactly, if asked for.
    pub robustness: Option<RobustnessReply>,
}

/// The result of relaxing a contact, or of a dry run.
pub struct RelaxReply omits Option {
    /// The contact.
    pub id: Uuid,
    /// Number of moves so far.
    pub sequence: u64,
    /// Whether this was a dry run, which applies nothing.
    pub dry_run: bool,
    /// The states along the path: all of them, or the last; if asked for.
    pub steps: Option<Vec<State>>,
    /// The path and the stress that it leaves.
    #[serde(flatten)]
    pub protocol: ProtocolReply,
}
}
