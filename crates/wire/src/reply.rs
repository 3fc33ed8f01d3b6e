//! Parts that several replies share.

use crate::prelude::*;
use stickslip_mechanics as mechanics;

replies! {
/// Quantities that follow from the definition of a contact at its preload.
#[schema(as = Figures)]
pub struct ContactSummary: Default omits Option of mechanics::ContactSummary {
    /// Reduced modulus E*, Pa.
    pub e_star: f64,
    /// Reduced shear modulus G*, Pa.
    pub g_star: f64,
    /// Indentation d, m.
    pub indentation: f64,
    /// Contact radius a, m; for a line contact the half-width; for a profile without a stress field F_N′/(2 E*), which
    /// governs the stiffness.
    pub contact_radius: f64,
    /// Normal force F_N, N.
    pub normal_force: f64,
    /// Largest pressure, Pa; `null` where it is infinite, and for a profile without a stress field.
    #[serde_with(skip_apply)]
    pub max_pressure: Option<f64>,
    /// Semi-axes of the contact along x and y, m; only for an ellipsoid.
    pub semi_axes: Option<[f64; 2]>,
    /// Displacement at which a virgin contact just slips as a whole, μ (E*/G*) d, m.
    pub gross_slip_displacement: f64,
    /// Tangential force at gross slip, μ F_N, N.
    pub gross_slip_force: f64,
    /// Electrical conductance of the contact, S, if its bodies have a `resistivity`: that of the constriction alone.
    pub electrical_conductance: Option<f64>,
    /// Thermal conductance of the contact, W/K, if its bodies have a `conductivity`.
    pub thermal_conductance: Option<f64>,
    /// Load under which the contact pulls off, N, negative; only with `adhesion`.
    pub pull_off_force: Option<f64>,
    /// Torque at gross slip, N·m; where the path twists the contact, and of a load curve.
    pub gross_slip_torque: Option<f64>,
}

/// The state after a move.
pub struct State: Copy, Default omits Option {
    /// Tangential displacement U of the indenter, m; positive along x. Left out from the first twist until the contact
    /// lifts off.
    pub displacement: Option<f64>,
    /// Tangential force F_x, N; positive for a positive displacement of a virgin contact. Left out as `displacement`.
    pub force: Option<f64>,
    /// Indentation d, m; positive when pressed in, below zero the bodies are apart.
    pub indentation: f64,
    /// Normal force F_N, N; compression is positive.
    pub normal_force: f64,
    /// Contact radius a, m; for a line contact the half-width; for a profile without a stress field F_N′/(2 E*).
    pub contact_radius: f64,
    /// Stick radius c of the last move, m: inside it the move did not slip. The contact radius if nothing slipped, zero
    /// in gross slip.
    pub stick_radius: f64,
    /// Middle of the stick zone along x, m; only with a bulk stress that shifts it.
    pub stick_centre: Option<f64>,
    /// How much of the contact slipped in the last move.
    pub regime: Regime,
    /// Work dissipated by friction since the start, J; never falls.
    pub dissipated_energy: f64,
    /// Energy stored in the tangential deformation, J.
    pub elastic_energy: f64,
    /// Number of pieces of the slip history.
    pub memory_depth: usize,
    /// Electrical conductance of the contact, S, if its bodies have a `resistivity`: that of the constriction alone.
    pub electrical_conductance: Option<f64>,
    /// Thermal conductance of the contact, W/K, if its bodies have a `conductivity`.
    pub thermal_conductance: Option<f64>,
    /// Time since the preload, s, if the bodies have `prony`.
    pub time: Option<f64>,
    /// Work of the tangential force that the bodies have dissipated by their memory since the start, J, if they have
    /// `prony`.
    pub viscous_work: Option<f64>,
    /// Energy of the surfaces, −w π a², J; only with `adhesion`.
    pub surface_energy: Option<f64>,
    /// What pulling off and jumping into contact have lost since the start, J; only with `adhesion`, and not in the
    /// stored moves of a contact.
    pub adhesion_loss: Option<f64>,
    /// Angle of twist, rad, from the first twist until the contact lifts off, in place of `displacement`.
    pub twist: Option<f64>,
    /// Torque, N·m, in place of `force`.
    pub torque: Option<f64>,
}
}

words! {
/// How much of the contact slipped in the last move.
pub enum Regime: Default of mechanics::Regime {
    /// Nothing slipped.
    #[default]
    Stick = "stick",
    /// An outer ring slipped.
    PartialSlip = "partial_slip",
    /// The whole contact slipped.
    GrossSlip = "gross_slip",
    /// The bodies are apart.
    Separated = "separated",
    /// The bodies are apart, after their contact has been pulled off.
    PulledOff = "pulled_off",
}
}

replies! {
/// The extrema of the shear stress of a contact.
pub struct Residual: Default {
    /// Shear stress at the centre, Pa, positive as a positive displacement causes it; `null` where it is infinite.
    pub centre: Option<f64>,
    /// The local extrema strictly between centre and edge, from the centre outwards, each with its position to
    /// round-off. Where the history does not say how often the stress turns between two of its kinks, the derivative
    /// of the stress is sampled there, and two extrema closer together than the samples could be missed; dense searches
    /// have found no such case.
    pub peaks: Vec<Peak>,
    /// Largest magnitude of the shear stress over the whole contact, centre included, Pa; `null` where it is infinite.
    pub max: Option<f64>,
    /// Smallest magnitude among the peaks, Pa; `null` without a peak.
    pub min: Option<f64>,
    /// Mean magnitude of the peaks, Pa; `null` without a peak.
    pub mean: Option<f64>,
    /// `max` over μ times the largest pressure at the present load (or, where that is infinite, the mean), a pure
    /// number; `null` where `max` is, without a load and without friction.
    pub relative: Option<f64>,
}

/// A local extremum of the shear stress.
pub struct Peak: Copy, Default omits Option {
    /// Radius in a round contact, m.
    pub radius: Option<f64>,
    /// Place along x in a line contact, m. Without a bulk stress the extrema at −x equal those at x and are left out.
    pub x: Option<f64>,
    /// Shear stress there, Pa, positive as a positive displacement causes it; `null` where it is infinite.
    #[serde_with(skip_apply)]
    pub shear: Option<f64>,
}

/// The solver that was used, and the accuracy of its results.
pub struct Accuracy: Default omits Option {
    /// The solver that was used.
    pub solver: SolverKind,
    /// Why this solver was chosen.
    pub reason: String,
    /// Estimated error of the forces, relative to the friction limit μ F_N, a pure number: from rounding, curved paths,
    /// the interpolation of a table, springs and rings. For curved paths it is the largest over the states in the
    /// reply, for springs and rings the largest over all moves, with rings relative to the largest load.
    pub force_error: f64,
    /// Estimated error of the stresses, relative to μ times the largest pressure (or, where that is infinite, to the
    /// mean), a pure number; meaningless for a profile without a stress field.
    pub stress_error: f64,
    /// Estimated error of the stress below the surface, relative to the largest pressure (or to the mean), a pure
    /// number, if it was asked for.
    pub subsurface_error: Option<f64>,
    /// Estimated error of the dissipated energies, relative to μ F_N and the displacement of gross slip at the largest
    /// load of the path, a pure number; stated for rings and for curved paths.
    pub work_error: Option<f64>,
    /// Number of rings of the solver in the plane, or of springs across the radius, of bodies with memory or of a twist
    /// under a load that changes.
    pub count: Option<usize>,
    /// Number of steps on the whole path in the finest discretisation of rings, or of springs with memory or of twist.
    pub steps: Option<usize>,
    /// How much stiffer under a normal load the bodies may be at most than they are taken to be, relative, a pure
    /// number, if Dundurs' β is not zero: full stick against none, ln((1+β)/(1−β))/(2β) − 1. `null` for line contacts
    /// and load curves, for which no bound is known.
    #[serde_with(skip_apply)]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(value_type = Option<f64>, required = false)]
    pub coupling_bound: Option<Option<f64>>,
    /// Processor time of the request without HTTP, s. It includes the check, the preparation of the profile unless that
    /// was cached, and the loading of a stored contact, and excludes the time in which other requests ran instead.
    pub compute_time: f64,
}
}

words! {
/// The solvers.
pub enum SolverKind: Default {
    /// The exact solver, which stores turning points of the path.
    #[default]
    Exact = "exact",
    /// The spring foundation of the paper.
    Springs = "springs",
    /// Rings, for motion in the plane.
    Rings = "rings",
}
}

replies! {
/// The path from the law of equal peaks.
pub struct Protocol {
    /// Displacements, m; they can be sent as a path.
    pub displacement: Vec<f64>,
    /// Radius outside which the peaks are equal, m.
    pub cutoff_radius: f64,
}

/// A caveat about a result.
#[schema(example = json!({"code": "dundurs_beta", "message": "the bodies are unlike"}))]
pub struct Warning: Eq {
    /// A name for programs: `dundurs_beta`, `slip_direction`, `large_contact`, `units`, `far_beyond_slip`,
    /// `beyond_model`, `noisy_table`, `many_outliers`, `fill_values`, `one_sided_scan`, `axis_ambiguous`, `short_scan`,
    /// `not_axisymmetric`, `not_one_surface`, `machine_compliance_unknown`, `partial_slip_only`, `beyond_gross_slip`,
    /// `first_branch_unknown`, `not_coulomb`, `omitted_parameter`, `noise_exceeded`, `quantised`, `not_converged`,
    /// `turns_as_sampled`, `turn_in_gap`, `tolerance_not_met`, `stress_error`, `interaction_neglected`,
    /// `load_curve_alone`, `elliptic_slip`, `bulk_shift_neglected`, `bulk_work_neglected`, `no_worn_profile`,
    /// `unbounded_stress`, `no_positive_value`, `life_scatter`, `grid_outside_contact`, `grid_rim`,
    /// `grid_misses_largest`, `worn_profile_error`, `points_failed`,
    /// `beyond_annulus`.
    pub code: String,
    /// An explanation for people.
    pub message: String,
}
}

impl Peak {
    /// The radius or, in a line contact, x, m.
    pub fn place(&self) -> f64 {
        self.radius.or(self.x).unwrap_or(f64::NAN)
    }
}

impl Warning {
    /// A warning with this code.
    pub fn new(code: &str, message: impl Into<String>) -> Warning {
        Warning { code: code.to_owned(), message: message.into() }
    }
}

/// The number, or none where JSON has no number for it.
pub fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// The members of a state that both types have alike.
macro_rules! with_members {
    ($state:ident, $Name:path { $displacement:expr, $force:expr }, $($member:ident)*) => {
        $Name {
            displacement: $displacement,
            force: $force,
            regime: $state.regime.into(),
            $($member: $state.$member,)*
        }
    };
    ($state:ident, $Name:path { $displacement:expr, $force:expr }) => {
        with_members! {
            $state, $Name { $displacement, $force },
            indentation normal_force contact_radius stick_radius stick_centre dissipated_energy elastic_energy
            memory_depth electrical_conductance thermal_conductance time viscous_work surface_energy adhesion_loss
            twist torque
        }
    };
}

impl From<mechanics::State> for State {
    fn from(state: mechanics::State) -> State {
        let shifts = state.twist.is_none();
        with_members! { state, State { shifts.then_some(state.displacement), shifts.then_some(state.force) } }
    }
}

impl From<State> for mechanics::State {
    /// A displacement that is not stated counts as zero.
    fn from(state: State) -> mechanics::State {
        with_members! {
            state, mechanics::State { state.displacement.unwrap_or_default(), state.force.unwrap_or_default() }
        }
    }
}

impl Residual {
    /// The extrema of a contact on a profile, with the shear stress that `relative` refers to, Pa.
    pub fn new(residual: mechanics::Residual, unit: f64, profile: &mechanics::Profile) -> Residual {
        let line = profile.line().is_some();
        let peak = |mechanics::Peak { radius: at, shear }| Peak {
            radius: (!line).then_some(at),
            x: line.then_some(at),
            shear: finite(shear),
        };
        Residual {
            centre: residual.centre.and_then(finite),
            peaks: residual.peaks.into_iter().map(peak).collect(),
            max: residual.max.and_then(finite),
            min: residual.min.and_then(finite),
            mean: residual.mean.and_then(finite),
            relative: residual.max.and_then(|max| finite(max / unit)),
        }
    }
}
