"""The replies as objects. Units are SI. Written by `tools/generate.py`.

Arrays of numbers are NumPy arrays, in which NaN stands where a number is infinite or missing; a single
one is None there. A result whose items are rows has their columns as arrays too. What has no class of its
own is a `Record` with its fields as attributes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import request_types as types
from .extras import Fretting, Swept, Uncertain
from .result import Counts, Flags, Floats, Named, Record, Result, Rows, Texts


class Accuracy(Result):
    """The solver that was used, and the accuracy of its results."""

    compute_time: float
    """Processor time of the request without HTTP, s. It includes the check, the preparation of the profile unless that
    was cached, and the loading of a stored contact, and excludes the time in which other requests ran instead.
    """

    force_error: float
    """Estimated error of the forces, relative to the friction limit μ F_N, a pure number: from rounding, curved paths,
    the interpolation of a table, springs and rings. For curved paths it is the largest over the states in the
    reply, for springs and rings the largest over all moves, with rings relative to the largest load.
    """

    reason: str
    """Why this solver was chosen."""

    solver: types.SolverKind
    """The solver that was used."""

    stress_error: float
    """Estimated error of the stresses, relative to μ times the largest pressure (or, where that is infinite, to the
    mean), a pure number; meaningless for a profile without a stress field.
    """

    count: int | None
    """Number of rings of the solver in the plane, or of springs across the radius, of bodies with memory or of a twist
    under a load that changes.
    """

    coupling_bound: float | None
    """How much stiffer under a normal load the bodies may be at most than they are taken to be, relative, a pure
    number, if Dundurs' β is not zero: full stick against none, ln((1+β)/(1−β))/(2β) − 1. `null` for line contacts
    and load curves, for which no bound is known.
    """

    steps: int | None
    """Number of steps on the whole path in the finest discretisation of rings, or of springs with memory or of twist.
    """

    subsurface_error: float | None
    """Estimated error of the stress below the surface, relative to the largest pressure (or to the mean), a pure
    number, if it was asked for.
    """

    work_error: float | None
    """Estimated error of the dissipated energies, relative to μ F_N and the displacement of gross slip at the largest
    load of the path, a pure number; stated for rings and for curved paths.
    """


class AccuracyReply(Result):
    """The time and the error of each solver."""

    reference: Record
    """The solution that the rows are compared with."""

    rows: Rows[Record]
    """One row for each solver."""

    if TYPE_CHECKING:

        @property
        def compute_time(self) -> Floats:
            """Of each row: Time spent computing, s: the median of a few runs if one takes less than a few
            milliseconds.
            """

        @property
        def estimated_force_error(self) -> Floats:
            """Of each row: Error of the force over all moves as the solver estimates it, relative to the friction
            limit μ F_N, a pure number; `null` without a result, or where it is infinite.
            """

        @property
        def estimated_stress_error(self) -> Floats:
            """Of each row: Error of the stress at the end as the solver estimates it, relative to `stress_unit`, a
            pure number: the largest over the contact, for springs without the cells near a singular radius of the
            profile; `null` without a result, or where it is infinite.
            """

        @property
        def force_error(self) -> Floats:
            """Of each row: Largest difference of the force from that of the reference, over all moves, relative to
            `force_unit`, a pure number; `null` without a result, or where it is infinite.
            """

        @property
        def steps(self) -> Counts:
            """Of each row: Steps of the finest discretisation, of rings in the plane."""

        @property
        def stress_error(self) -> Floats:
            """Of each row: Largest difference of the shear stress at the end, over the radii, relative to
            `stress_unit`, a pure number; `null` without a result, or where it is infinite.
            """

        @property
        def work_error(self) -> Floats:
            """Of each row: Difference of the friction work from that of the reference at the end of a path in the
            plane, over `force_unit` times the displacement of gross slip, a pure number.
            """


class CyclePage(Result):
    """The newest closed cycles of a contact, oldest first."""

    items: Rows[Record]
    """The cycles, in the order in which they closed; if one move closed several, the inner ones first."""

    if TYPE_CHECKING:

        @property
        def displacement_amplitude(self) -> Floats:
            """Of each row: Half the distance between its turning points, m."""

        @property
        def dissipated_energy(self) -> Floats:
            """Of each row: Friction work, J, without that of the cycles within it."""

        @property
        def force_amplitude(self) -> Floats:
            """Of each row: Amplitude of the tangential force, N."""

        @property
        def from_(self) -> Counts:
            """Of each row: The number of the move after which the cycle began, at its first turning point."""

        @property
        def secant_stiffness(self) -> Floats:
            """Of each row: Force amplitude over displacement amplitude, N/m; `null` if it is too large for a number."""

        @property
        def sliding_ratio(self) -> Floats:
            """Of each row: Displacement at zero force over the displacement amplitude, both measured from the middle
            of the loop, a pure number; `null` without friction, and if the cycle is not steady. A cycle is not
            steady if the load changed within it, or so shortly before it that the force does not return with the
            displacement; amplitude and work are then those of the recorded states.
            """

        @property
        def to(self) -> Counts:
            """Of each row: The number of the move that closed the cycle."""


class CycleReply(Result):
    """Steady cycles, one for each amplitude."""

    accuracy: Accuracy
    """Solver, errors and time. `force_error` also holds for the harmonics, relative to the amplitude of the response.
    """

    contact: Figures
    """The contact at its load; in a map, at its preload."""

    cycles: Rows[Record]
    """The cycles, in the order of the amplitudes; in a map load by load, with frequencies one by one."""

    warnings: Rows[Record]
    """Warnings about the result."""

    frequency_response: Record | None
    """The oscillations of a mass on the contact, if asked for."""

    if TYPE_CHECKING:

        @property
        def displacement_amplitude(self) -> Floats:
            """Of each row: Amplitude of the displacement of the indenter, m; left out where the contact is twisted."""

        @property
        def dissipated_energy(self) -> Floats:
            """Of each row: Friction work of a cycle, J: the area of the force-displacement loop, without
            `viscous_work`.
            """

        @property
        def force_amplitude(self) -> Floats:
            """Of each row: Amplitude of the tangential force, N; left out where the contact is twisted."""

        @property
        def frequency(self) -> Floats:
            """Of each row: Frequency, Hz; only of bodies with `prony`."""

        @property
        def friction_energy(self) -> Floats:
            """Of each row: All energy that friction dissipates in a cycle, J, where a bulk stress does work too: the
            integral of `friction_work` over the contact. Otherwise it equals `dissipated_energy` and is left out.
            """

        @property
        def gross_slip_displacement(self) -> Floats:
            """Of each row: Displacement amplitude of the indenter at which gross slip begins under this load, m; only
            in a map, and of bodies with `prony`, whose slow cycles have it.
            """

        @property
        def loss_factor(self) -> Floats:
            """Of each row: Dissipated energy, and viscous work, over 2π times the largest elastic energy, a pure
            number; `null` where the indenter slides and nothing is stored, as without friction and without load.
            """

        @property
        def machine_amplitude(self) -> Floats:
            """Of each row: Amplitude of the displacement at the machine, m, or of its angle, rad; only with `machine`.
            """

        @property
        def max_elastic_energy(self) -> Floats:
            """Of each row: The largest elastic energy of the tangential deformation in a cycle, J."""

        @property
        def normal_force(self) -> Floats:
            """Of each row: Normal force, N; only in a map, and of bodies with `prony`, that to which they have
            relaxed.
            """

        @property
        def regime(self) -> Texts:
            """Of each row: How much of the contact slips."""

        @property
        def secant_stiffness(self) -> Floats:
            """Of each row: Force amplitude over displacement amplitude of the indenter, N/m, or torque over angle,
            N·m/rad; at zero amplitude the tangent stiffness.
            """

        @property
        def sliding_ratio(self) -> Floats:
            """Of each row: Displacement at zero force over the amplitude of the indenter, a pure number; `null` where
            the indenter moves without a force, as without friction and without load.
            """

        @property
        def stick_radius(self) -> Floats:
            """Of each row: Stick radius c of the cycle, m: inside it nothing ever slips. The contact radius if nothing
            slips, zero in gross slip.
            """

        @property
        def tangent_stiffness(self) -> Floats:
            """Of each row: Stiffness of the contact just after a reversal, 2 G* a, N/m, under twist (16/3) G a³,
            N·m/rad; zero without friction.
            """

        @property
        def torque_amplitude(self) -> Floats:
            """Of each row: Amplitude of the torque, N·m, where `twist` or `torque` is driven."""

        @property
        def twist_amplitude(self) -> Floats:
            """Of each row: Amplitude of the angle of twist of the indenter, rad, where `twist` or `torque` is driven.
            """

        @property
        def viscous_work(self) -> Floats:
            """Of each row: Work of the tangential force that the bodies dissipate in a cycle by their memory, J, if
            they have `prony`.
            """


class Figures(Result):
    """Quantities that follow from the definition of a contact at its preload."""

    contact_radius: float
    """Contact radius a, m; for a line contact the half-width; for a profile without a stress field F_N′/(2 E*), which
    governs the stiffness.
    """

    e_star: float
    """Reduced modulus E*, Pa."""

    g_star: float
    """Reduced shear modulus G*, Pa."""

    gross_slip_displacement: float
    """Displacement at which a virgin contact just slips as a whole, μ (E*/G*) d, m."""

    gross_slip_force: float
    """Tangential force at gross slip, μ F_N, N."""

    indentation: float
    """Indentation d, m."""

    normal_force: float
    """Normal force F_N, N."""

    electrical_conductance: float | None
    """Electrical conductance of the contact, S, if its bodies have a `resistivity`: that of the constriction alone."""

    gross_slip_torque: float | None
    """Torque at gross slip, N·m; where the path twists the contact, and of a load curve."""

    max_pressure: float | None
    """Largest pressure, Pa; `null` where it is infinite, and for a profile without a stress field."""

    pull_off_force: float | None
    """Load under which the contact pulls off, N, negative; only with `adhesion`."""

    semi_axes: Floats | None
    """Semi-axes of the contact along x and y, m; only for an ellipsoid."""

    thermal_conductance: float | None
    """Thermal conductance of the contact, W/K, if its bodies have a `conductivity`."""


class FitReply(Result):
    """The quantities that the loops determine, and the ones that they leave undetermined."""

    contact: Any
    """The contact with the fitted values, for `POST /contacts` and `/simulate`."""

    correlations: Any
    """Correlation coefficients of the estimates, pure numbers, by both names; `null` where one is not determined."""

    curve: Rows[Record]
    """The loops as they were fitted, in SI units; long ones are thinned."""

    estimates: Named[Record]
    """Estimates of the free quantities, and of those known with a standard error, by name."""

    free: list[Any]
    """The quantities that were fitted: those of the request, or those that the loops decided on."""

    identifiable: list[Any]
    """What the loops determine: quantities by name, or combinations of them where a single one is not determined."""

    noise: Record
    """The noise as given, otherwise as estimated."""

    omitted: Rows[Record]
    """A score test of each quantity that was not free."""

    residual: Record
    """Measured less fitted forces."""

    sensitivity: Rows[Record]
    """The change of the estimates by small errors of the bench that were not free."""

    warnings: Rows[Record]
    """Warnings about the fit."""


class FrettingReply(Fretting):
    """The criteria over the steady cycle, each with its values at all places."""

    accuracy: Accuracy
    """Solver, errors and time."""

    change: float
    """The largest relative error among the largest values of the criteria, a pure number."""

    contact: Figures
    """Quantities that follow from the definition at the preload."""

    instants: int
    """Number of instants in the move that needed most, at the places of the largest values."""

    warnings: Rows[Record]
    """Warnings about the result."""

    x: Floats
    """Place along the motion of the first body, m."""

    y: Floats
    """Place across the motion of the first body, m."""

    z: Floats
    """Depth into the body, m; never negative."""

    crossland: Record | None
    """Crossland's criterion, Pa."""

    dang_van: Record | None
    """Dang Van's criterion, Pa."""

    fatemi_socie: Record | None
    """Fatemi and Socie's criterion, a pure number."""

    findley: Record | None
    """Findley's criterion, Pa."""

    friction_work: Record | None
    """Friction work per area and cycle, J/m²; never negative."""

    ruiz: Record | None
    """Ruiz's first parameter, shear stress times slip, N/m."""

    ruiz_tension: Record | None
    """Ruiz's second parameter, the first times the largest tension along x, N²/m³; returned with the first."""

    stress_paths: Rows[Record] | None
    """The stresses over the cycle at the places of `stress_paths`."""

    swt: Record | None
    """Smith, Watson and Topper's criterion, Pa."""


class FrictionReply(Result):
    """The latest coefficient of friction that the observations of a contact determine."""

    id: str
    """The identifier of the contact."""

    sequence: int
    """Number of moves so far."""

    friction: Record | None
    """The estimate; left out as long as the observations do not determine it."""

    reason: types.NoFriction | None
    """Why there is no estimate; left out where there is one."""


class HistoryPage(Result):
    """A page of the history of a contact, oldest first."""

    items: Rows[Record]
    """The moves."""

    next: int | None
    """The value of `after` for the next page; `null` on the last page."""

    if TYPE_CHECKING:

        @property
        def at(self) -> Texts:
            """Of each row: When it was applied (ISO 8601, UTC)."""

        @property
        def by(self) -> Texts:
            """Of each row: The name of the key that made it. Left out for a move that was made without a key, and
            where no keys are in use.
            """

        @property
        def sequence(self) -> Counts:
            """Of each row: Its number, counted from 1."""


class LoopPage(Result):
    """A page of the hysteresis loop of a contact, oldest first.

    The first page begins with the virgin contact at sequence zero; the pages in sequence are the whole loop.
    """

    displacement: Floats
    """Tangential displacement U of the indenter, m; positive along x; `null` while the contact is twisted."""

    force: Floats
    """Tangential force F_x, N; `null` while the contact is twisted."""

    part: Floats
    """Fraction of that move at the point, a pure number: 1 at its end."""

    sequence: Counts
    """The number of the move that a point belongs to."""

    next: int | None
    """The value of `after` for the next page; `null` on the last page."""

    observed_force: Floats | None
    """Force that was measured at each point, N, `null` where none was measured; left out if the page has no measured
    force.
    """

    torque: Floats | None
    """Torque, N·m, as `twist`."""

    twist: Floats | None
    """Angle of twist, rad, `null` while the contact is not twisted; left out if the page has no twist."""


class MoveReply(Result):
    """The result of a move."""

    accuracy: Accuracy
    """Solver, errors and time."""

    id: str
    """The identifier of the contact."""

    sequence: int
    """The number of this move, which is the number of moves so far."""

    state: State
    """The state after it."""

    stress: Record | None
    """The stresses after it, if asked for."""

    warnings: Rows[Record] | None
    """Warnings that apply from this move on and that earlier replies have not given."""


class ObservationsReply(Result):
    """The result of observations."""

    id: str
    """The identifier of the contact."""

    items: Rows[Record]
    """The observations with the forces that the contact predicts."""

    sequence: int
    """The number of the last move, which is the number of moves so far."""

    friction: Record | None
    """The coefficient of friction from the last measured cycle; left out as long as the observations do not determine
    it.
    """

    if TYPE_CHECKING:

        @property
        def displacement(self) -> Floats:
            """Of each row: Tangential displacement, m."""

        @property
        def force(self) -> Floats:
            """Of each row: Measured tangential force, N; positive along x."""

        @property
        def innovation(self) -> Floats:
            """Of each row: Measured less predicted force, N."""

        @property
        def predicted(self) -> Floats:
            """Of each row: Tangential force of the contact there, N, with the friction of its definition."""


class PathReply(Result):
    """The result of a path."""

    accuracy: Accuracy
    """Solver, errors and time."""

    id: str
    """The identifier of the contact."""

    sequence: int
    """The number of the last move, which is the number of moves so far."""

    steps: Rows[State]
    """The states along the path: all of them, or the last."""

    protocol: Record | None
    """The path, if it follows the law of equal peaks."""

    stress: Record | None
    """The stresses at the end, if asked for."""

    warnings: Rows[Record] | None
    """Warnings that apply from this path on and that earlier replies have not given."""

    if TYPE_CHECKING:

        @property
        def adhesion_loss(self) -> Floats:
            """Of each row: What pulling off and jumping into contact have lost since the start, J; only with
            `adhesion`, and not in the stored moves of a contact.
            """

        @property
        def contact_radius(self) -> Floats:
            """Of each row: Contact radius a, m; for a line contact the half-width; for a profile without a stress
            field F_N′/(2 E*).
            """

        @property
        def displacement(self) -> Floats:
            """Of each row: Tangential displacement U of the indenter, m; positive along x. Left out from the first
            twist until the contact lifts off.
            """

        @property
        def dissipated_energy(self) -> Floats:
            """Of each row: Work dissipated by friction since the start, J; never falls."""

        @property
        def elastic_energy(self) -> Floats:
            """Of each row: Energy stored in the tangential deformation, J."""

        @property
        def electrical_conductance(self) -> Floats:
            """Of each row: Electrical conductance of the contact, S, if its bodies have a `resistivity`: that of the
            constriction alone.
            """

        @property
        def force(self) -> Floats:
            """Of each row: Tangential force F_x, N; positive for a positive displacement of a virgin contact. Left out
            as `displacement`.
            """

        @property
        def indentation(self) -> Floats:
            """Of each row: Indentation d, m; positive when pressed in, below zero the bodies are apart."""

        @property
        def memory_depth(self) -> Counts:
            """Of each row: Number of pieces of the slip history."""

        @property
        def normal_force(self) -> Floats:
            """Of each row: Normal force F_N, N; compression is positive."""

        @property
        def regime(self) -> Texts:
            """Of each row: How much of the contact slipped in the last move."""

        @property
        def stick_centre(self) -> Floats:
            """Of each row: Middle of the stick zone along x, m; only with a bulk stress that shifts it."""

        @property
        def stick_radius(self) -> Floats:
            """Of each row: Stick radius c of the last move, m: inside it the move did not slip. The contact radius if
            nothing slipped, zero in gross slip.
            """

        @property
        def surface_energy(self) -> Floats:
            """Of each row: Energy of the surfaces, −w π a², J; only with `adhesion`."""

        @property
        def thermal_conductance(self) -> Floats:
            """Of each row: Thermal conductance of the contact, W/K, if its bodies have a `conductivity`."""

        @property
        def time(self) -> Floats:
            """Of each row: Time since the preload, s, if the bodies have `prony`."""

        @property
        def torque(self) -> Floats:
            """Of each row: Torque, N·m, in place of `force`."""

        @property
        def twist(self) -> Floats:
            """Of each row: Angle of twist, rad, from the first twist until the contact lifts off, in place of
            `displacement`.
            """

        @property
        def viscous_work(self) -> Floats:
            """Of each row: Work of the tangential force that the bodies have dissipated by their memory since the
            start, J, if they have `prony`.
            """


class PlanarReply(Result):
    """The result of a simulation in the plane."""

    accuracy: Accuracy
    """Solver, errors and time."""

    contact: Figures
    """Quantities that follow from the definition at the preload."""

    steps: Rows[PlanarState]
    """The states along the path: all of them, or the last."""

    warnings: Rows[Record]
    """Warnings about the result."""

    stress: Record | None
    """The stresses at the end, if asked for."""

    turn_losses: Floats | None
    """Friction work of each turn of an ellipse, J; the first one begins at rest."""

    if TYPE_CHECKING:

        @property
        def contact_radius(self) -> Floats:
            """Of each row: Contact radius a, m."""

        @property
        def dissipated_energy(self) -> Floats:
            """Of each row: Work dissipated by friction since the start, J; never falls."""

        @property
        def elastic_energy(self) -> Floats:
            """Of each row: Energy stored in the tangential deformation, J."""

        @property
        def electrical_conductance(self) -> Floats:
            """Of each row: Electrical conductance of the contact, S, if its bodies have a `resistivity`: that of the
            constriction alone.
            """

        @property
        def indentation(self) -> Floats:
            """Of each row: Indentation d, m; positive when pressed in, below zero the bodies are apart."""

        @property
        def normal_force(self) -> Floats:
            """Of each row: Normal force F_N, N; compression is positive."""

        @property
        def regime(self) -> Texts:
            """Of each row: How much of the contact slipped in the last move."""

        @property
        def stick_radius(self) -> Floats:
            """Of each row: Stick radius c of the last move, m: inside it the move did not slip, to the width of a
            ring. The contact radius if nothing slipped, zero in gross slip.
            """

        @property
        def thermal_conductance(self) -> Floats:
            """Of each row: Thermal conductance of the contact, W/K, if its bodies have a `conductivity`."""


class PlanarState(Result):
    """The state after a move in the plane."""

    contact_radius: float
    """Contact radius a, m."""

    displacement: Floats
    """Tangential displacement of the indenter along x and y, m."""

    dissipated_energy: float
    """Work dissipated by friction since the start, J; never falls."""

    elastic_energy: float
    """Energy stored in the tangential deformation, J."""

    force: Floats
    """Tangential force along x and y, N; in a virgin contact it points along the displacement."""

    indentation: float
    """Indentation d, m; positive when pressed in, below zero the bodies are apart."""

    normal_force: float
    """Normal force F_N, N; compression is positive."""

    regime: types.Regime
    """How much of the contact slipped in the last move."""

    stick_radius: float
    """Stick radius c of the last move, m: inside it the move did not slip, to the width of a ring. The contact radius
    if nothing slipped, zero in gross slip.
    """

    electrical_conductance: float | None
    """Electrical conductance of the contact, S, if its bodies have a `resistivity`: that of the constriction alone."""

    thermal_conductance: float | None
    """Thermal conductance of the contact, W/K, if its bodies have a `conductivity`."""


class ProfileFitReply(Result):
    """A profile that was fitted to a scan, with the residual of the scan."""

    axisymmetry: types.Axisymmetry
    """Whether the scan was tested for a body that is not of revolution: `tested` of a map; `assumed` of a line, which
    knows one section alone.
    """

    centre: Record
    """The axis, m."""

    g_margin: float
    """The least g′(x)/x over its mean, a pure number: 1 for a ball, 0 where g is about to fall or, at a flat end,
    constant.
    """

    left_out: Record
    """The points that were left out as outliers, thinned in the same way."""

    orientation: types.ScanOrientation
    """Which way up the scan is: `peak_up` or `peak_down`."""

    profile: Any
    """The profile, for `/simulate` and `/contacts`."""

    radius_of_curvature: Record
    """The radius of curvature on the axis, m; `null` where the surface is flat there to within its error."""

    raw: Record
    """The points that were fitted, as heights of the gap above the axis; at most 4000 of them, evenly thinned."""

    residual: Record
    """Measured heights less the profile."""

    tilt: Record
    """The slopes of the plane that was subtracted, pure numbers."""

    used: Record
    """The fitted profile, as the table of `profile`."""

    warnings: Rows[Record]
    """Warnings about the scan."""

    contact: Record | None
    """The contact under `load`."""

    suggested: Record | None
    """A body that is not of revolution, where the residual shows one: its profile is for `/simulate` and `/contacts`.
    """


class ProtocolReply(Result):
    """How to move so that little shear stress remains."""

    displacement: float
    """Tangential displacement at the end, m."""

    dissipated_energy: float
    """Work done against friction on the path, J."""

    force: float
    """Tangential force at the end, N."""

    residual: Residual
    """The extrema of the shear stress that remains."""

    accuracy: Accuracy
    """Solver, errors and time."""

    comparison: Record
    """The results of the other laws, with the same number of reversals."""

    contact: Figures
    """Quantities that follow from the definition at the present load."""

    end: types.ProtocolEnd
    """Where the path ends."""

    judged: Record
    """Where and in which unit the remaining stress is measured."""

    kind: types.ProtocolKind
    """The law of the amplitudes."""

    path: Record
    """The path, which `/simulate` and `/contacts/{id}/path` take as it is."""

    reversals: int
    """Number of reversals N."""

    start: Record
    """How the path begins."""

    warnings: Rows[Record]
    """Warnings about the results."""

    gap: Record | None
    """How far the path may be from the optimum; only for `minimax`."""

    largest: float | None
    """The largest magnitude of the shear stress that remains where it is measured, Pa; `null` where it is infinite."""

    relative: float | None
    """`largest` over `judged.unit`, a pure number."""

    robustness: Record | None
    """The stress that remains if the path is not followed exactly, if asked for."""


class RelaxReply(Result):
    """The result of relaxing a contact, or of a dry run."""

    displacement: float
    """Tangential displacement at the end, m."""

    dissipated_energy: float
    """Work done against friction on the path, J."""

    force: float
    """Tangential force at the end, N."""

    residual: Residual
    """The extrema of the shear stress that remains."""

    accuracy: Accuracy
    """Solver, errors and time."""

    comparison: Record
    """The results of the other laws, with the same number of reversals."""

    contact: Figures
    """Quantities that follow from the definition at the present load."""

    end: types.ProtocolEnd
    """Where the path ends."""

    judged: Record
    """Where and in which unit the remaining stress is measured."""

    kind: types.ProtocolKind
    """The law of the amplitudes."""

    path: Record
    """The path, which `/simulate` and `/contacts/{id}/path` take as it is."""

    reversals: int
    """Number of reversals N."""

    start: Record
    """How the path begins."""

    warnings: Rows[Record]
    """Warnings about the results."""

    dry_run: bool
    """Whether this was a dry run, which applies nothing."""

    id: str
    """The contact."""

    sequence: int
    """Number of moves so far."""

    gap: Record | None
    """How far the path may be from the optimum; only for `minimax`."""

    largest: float | None
    """The largest magnitude of the shear stress that remains where it is measured, Pa; `null` where it is infinite."""

    relative: float | None
    """`largest` over `judged.unit`, a pure number."""

    robustness: Record | None
    """The stress that remains if the path is not followed exactly, if asked for."""

    steps: Rows[State] | None
    """The states along the path: all of them, or the last; if asked for."""

    if TYPE_CHECKING:

        @property
        def adhesion_loss(self) -> Floats:
            """Of each row: What pulling off and jumping into contact have lost since the start, J; only with
            `adhesion`, and not in the stored moves of a contact.
            """

        @property
        def contact_radius(self) -> Floats:
            """Of each row: Contact radius a, m; for a line contact the half-width; for a profile without a stress
            field F_N′/(2 E*).
            """

        @property
        def elastic_energy(self) -> Floats:
            """Of each row: Energy stored in the tangential deformation, J."""

        @property
        def electrical_conductance(self) -> Floats:
            """Of each row: Electrical conductance of the contact, S, if its bodies have a `resistivity`: that of the
            constriction alone.
            """

        @property
        def indentation(self) -> Floats:
            """Of each row: Indentation d, m; positive when pressed in, below zero the bodies are apart."""

        @property
        def memory_depth(self) -> Counts:
            """Of each row: Number of pieces of the slip history."""

        @property
        def normal_force(self) -> Floats:
            """Of each row: Normal force F_N, N; compression is positive."""

        @property
        def regime(self) -> Texts:
            """Of each row: How much of the contact slipped in the last move."""

        @property
        def stick_centre(self) -> Floats:
            """Of each row: Middle of the stick zone along x, m; only with a bulk stress that shifts it."""

        @property
        def stick_radius(self) -> Floats:
            """Of each row: Stick radius c of the last move, m: inside it the move did not slip. The contact radius if
            nothing slipped, zero in gross slip.
            """

        @property
        def surface_energy(self) -> Floats:
            """Of each row: Energy of the surfaces, −w π a², J; only with `adhesion`."""

        @property
        def thermal_conductance(self) -> Floats:
            """Of each row: Thermal conductance of the contact, W/K, if its bodies have a `conductivity`."""

        @property
        def time(self) -> Floats:
            """Of each row: Time since the preload, s, if the bodies have `prony`."""

        @property
        def torque(self) -> Floats:
            """Of each row: Torque, N·m, in place of `force`."""

        @property
        def twist(self) -> Floats:
            """Of each row: Angle of twist, rad, from the first twist until the contact lifts off, in place of
            `displacement`.
            """

        @property
        def viscous_work(self) -> Floats:
            """Of each row: Work of the tangential force that the bodies have dissipated by their memory since the
            start, J, if they have `prony`.
            """


class Residual(Result):
    """The extrema of the shear stress of a contact."""

    peaks: Rows[Record]
    """The local extrema strictly between centre and edge, from the centre outwards, each with its position to round-
    off. Where the history does not say how often the stress turns between two of its kinks, the derivative of the
    stress is sampled there, and two extrema closer together than the samples could be missed; dense searches have
    found no such case.
    """

    centre: float | None
    """Shear stress at the centre, Pa, positive as a positive displacement causes it; `null` where it is infinite."""

    max: float | None
    """Largest magnitude of the shear stress over the whole contact, centre included, Pa; `null` where it is infinite.
    """

    mean: float | None
    """Mean magnitude of the peaks, Pa; `null` without a peak."""

    min: float | None
    """Smallest magnitude among the peaks, Pa; `null` without a peak."""

    relative: float | None
    """`max` over μ times the largest pressure at the present load (or, where that is infinite, the mean), a pure
    number; `null` where `max` is, without a load and without friction.
    """

    if TYPE_CHECKING:

        @property
        def radius(self) -> Floats:
            """Of each row: Radius in a round contact, m."""

        @property
        def shear(self) -> Floats:
            """Of each row: Shear stress there, Pa, positive as a positive displacement causes it; `null` where it is
            infinite.
            """

        @property
        def x(self) -> Floats:
            """Of each row: Place along x in a line contact, m. Without a bulk stress the extrema at −x equal those at
            x and are left out.
            """


class RollingReply(Result):
    """Creep, stick zone and tractions of a cylinder that rolls steadily."""

    accuracy: Accuracy
    """Solver, errors and time."""

    contact: Figures
    """The contact at its preload."""

    creep: float
    """Creep, a pure number."""

    pressure: Floats
    """Pressure, Pa."""

    ratio: float
    """Tangential force over μ F_N, a pure number."""

    shear: Floats
    """Shear stress, Pa; positive with a positive force."""

    stick: Floats
    """Where the stick zone begins and ends along x, m; it ends at the leading edge."""

    warnings: Rows[Record]
    """Warnings about the result."""

    x: Floats
    """Places along x, m, from the trailing edge −a to the leading edge a."""


class SessionReply(Result):
    """A contact."""

    contact: Figures
    """Quantities that follow from the definition at the preload."""

    created_at: str
    """When it was created (ISO 8601, UTC)."""

    id: str
    """Its identifier."""

    sequence: int
    """Number of moves so far."""

    state: State
    """Its state after the last move."""

    updated_at: str
    """When it was last moved (ISO 8601, UTC)."""

    label: str | None
    """Its label, if it has one."""


class SessionSummary(Result):
    """A contact as an item of a list."""

    created_at: str
    """When it was created (ISO 8601, UTC)."""

    id: str
    """Its identifier."""

    sequence: int
    """Number of moves so far."""

    updated_at: str
    """When it was last moved (ISO 8601, UTC)."""

    label: str | None
    """Its label, if it has one."""


class SimulateReply(Result):
    """The result of a simulation."""

    accuracy: Accuracy
    """Solver, errors and time."""

    contact: Figures
    """Quantities that follow from the definition at the preload."""

    steps: Rows[State]
    """The states along the path: all of them, or the last."""

    warnings: Rows[Record]
    """Warnings about the result."""

    protocol: Record | None
    """The path, if it follows the law of equal peaks."""

    residual: Residual | None
    """The extrema of the shear stress at the end, if asked for."""

    stress: Record | None
    """The stresses at the end, if asked for."""

    subsurface: Record | None
    """The stress below the surface at the end, if asked for."""

    if TYPE_CHECKING:

        @property
        def adhesion_loss(self) -> Floats:
            """Of each row: What pulling off and jumping into contact have lost since the start, J; only with
            `adhesion`, and not in the stored moves of a contact.
            """

        @property
        def contact_radius(self) -> Floats:
            """Of each row: Contact radius a, m; for a line contact the half-width; for a profile without a stress
            field F_N′/(2 E*).
            """

        @property
        def displacement(self) -> Floats:
            """Of each row: Tangential displacement U of the indenter, m; positive along x. Left out from the first
            twist until the contact lifts off.
            """

        @property
        def dissipated_energy(self) -> Floats:
            """Of each row: Work dissipated by friction since the start, J; never falls."""

        @property
        def elastic_energy(self) -> Floats:
            """Of each row: Energy stored in the tangential deformation, J."""

        @property
        def electrical_conductance(self) -> Floats:
            """Of each row: Electrical conductance of the contact, S, if its bodies have a `resistivity`: that of the
            constriction alone.
            """

        @property
        def force(self) -> Floats:
            """Of each row: Tangential force F_x, N; positive for a positive displacement of a virgin contact. Left out
            as `displacement`.
            """

        @property
        def indentation(self) -> Floats:
            """Of each row: Indentation d, m; positive when pressed in, below zero the bodies are apart."""

        @property
        def memory_depth(self) -> Counts:
            """Of each row: Number of pieces of the slip history."""

        @property
        def normal_force(self) -> Floats:
            """Of each row: Normal force F_N, N; compression is positive."""

        @property
        def regime(self) -> Texts:
            """Of each row: How much of the contact slipped in the last move."""

        @property
        def stick_centre(self) -> Floats:
            """Of each row: Middle of the stick zone along x, m; only with a bulk stress that shifts it."""

        @property
        def stick_radius(self) -> Floats:
            """Of each row: Stick radius c of the last move, m: inside it the move did not slip. The contact radius if
            nothing slipped, zero in gross slip.
            """

        @property
        def surface_energy(self) -> Floats:
            """Of each row: Energy of the surfaces, −w π a², J; only with `adhesion`."""

        @property
        def thermal_conductance(self) -> Floats:
            """Of each row: Thermal conductance of the contact, W/K, if its bodies have a `conductivity`."""

        @property
        def time(self) -> Floats:
            """Of each row: Time since the preload, s, if the bodies have `prony`."""

        @property
        def torque(self) -> Floats:
            """Of each row: Torque, N·m, in place of `force`."""

        @property
        def twist(self) -> Floats:
            """Of each row: Angle of twist, rad, from the first twist until the contact lifts off, in place of
            `displacement`.
            """

        @property
        def viscous_work(self) -> Floats:
            """Of each row: Work of the tangential force that the bodies have dissipated by their memory since the
            start, J, if they have `prony`.
            """


class SlidersReply(Result):
    """Sliders in parallel: each is a spring with a friction cap, and all are moved by the same displacement."""

    accuracy: Accuracy
    """Solver, errors and time: of the contact, to which the sliders add theirs."""

    contact: Figures
    """The contact at its preload."""

    density: Record
    """The density of sliders that the contact itself has."""

    displacement: Floats
    """Displacements at which the sliders slip on first loading, m, increasing."""

    force_error: float
    """The largest error of the force on first loading over μ F_N, a pure number. After one reversal it is at most
    twice that.
    """

    path_error: float
    """A bound of the error of the force over μ F_N on any path at this load, a pure number."""

    slip_force: Floats
    """The forces at which they slip, N; all together μ F_N."""

    stiffness: Floats
    """Their stiffnesses, N/m."""

    warnings: Rows[Record]
    """Warnings about the result."""

    work: Record
    """The work of steady cycles over that of the contact."""


class State(Result):
    """The state after a move."""

    contact_radius: float
    """Contact radius a, m; for a line contact the half-width; for a profile without a stress field F_N′/(2 E*)."""

    dissipated_energy: float
    """Work dissipated by friction since the start, J; never falls."""

    elastic_energy: float
    """Energy stored in the tangential deformation, J."""

    indentation: float
    """Indentation d, m; positive when pressed in, below zero the bodies are apart."""

    memory_depth: int
    """Number of pieces of the slip history."""

    normal_force: float
    """Normal force F_N, N; compression is positive."""

    regime: types.Regime
    """How much of the contact slipped in the last move."""

    stick_radius: float
    """Stick radius c of the last move, m: inside it the move did not slip. The contact radius if nothing slipped, zero
    in gross slip.
    """

    adhesion_loss: float | None
    """What pulling off and jumping into contact have lost since the start, J; only with `adhesion`, and not in the
    stored moves of a contact.
    """

    displacement: float
    """Tangential displacement U of the indenter, m; positive along x. Left out from the first twist until the contact
    lifts off.
    """

    electrical_conductance: float | None
    """Electrical conductance of the contact, S, if its bodies have a `resistivity`: that of the constriction alone."""

    force: float
    """Tangential force F_x, N; positive for a positive displacement of a virgin contact. Left out as `displacement`."""

    stick_centre: float | None
    """Middle of the stick zone along x, m; only with a bulk stress that shifts it."""

    surface_energy: float | None
    """Energy of the surfaces, −w π a², J; only with `adhesion`."""

    thermal_conductance: float | None
    """Thermal conductance of the contact, W/K, if its bodies have a `conductivity`."""

    time: float | None
    """Time since the preload, s, if the bodies have `prony`."""

    torque: float | None
    """Torque, N·m, in place of `force`."""

    twist: float | None
    """Angle of twist, rad, from the first twist until the contact lifts off, in place of `displacement`."""

    viscous_work: float | None
    """Work of the tangential force that the bodies have dissipated by their memory since the start, J, if they have
    `prony`.
    """


class StateEvent(Result):
    """The data of an event `state`: a move that has been applied, with the state after it."""

    at: str
    """When it was applied, or the contact created (ISO 8601, UTC)."""

    id: str
    """The identifier of the contact."""

    sequence: int
    """The number of the move, which is the number of moves so far and the identifier of the event."""

    state: State
    """The state after it."""

    cycle: Record | None
    """The cycle that it closed; the outermost if several."""

    move: Any
    """The move as it was given; absent before the first move."""

    observation: Record | None
    """The measurement, if the move is an observation."""


class StressReply(Result):
    """The stresses of a contact, and their extrema if asked for."""

    displacement: Floats | None
    """Tangential displacement u(r) of the surface, m; positive along x."""

    hoop: Floats | None
    """Hoop stress of a contact that is twisted, Pa; positive as a positive angle causes it."""

    pressure: Floats | None
    """Normal pressure, Pa; compression is positive; `null` where it is infinite."""

    radius: Floats | None
    """Radii in a round contact, m."""

    shear: Floats | None
    """Shear stress, Pa; positive as a positive displacement causes it; `null` where it is infinite."""

    slip: Floats | None
    """Slip U − u(r), the displacement of the indenter less that of the surface, m; `null` outside the contact."""

    x: Floats | None
    """Places along x in a line contact, m."""

    residual: Residual | None
    """The extrema of the shear stress, if asked for."""


class SubsurfaceReply(Result):
    """Stresses below the surface of a contact on the server."""

    x: Floats
    """Place along the motion of the first body, m."""

    y: Floats
    """Place across the motion of the first body, m."""

    z: Floats
    """Depth into the body, m; never negative."""

    accuracy: Accuracy
    """Solver, errors and time."""

    warnings: Rows[Record]
    """Warnings about the result."""

    hydrostatic: Floats | None
    """Mean normal stress, Pa; tension is positive."""

    max_shear: Floats | None
    """Largest shear stress on any plane, Pa; never negative."""

    principal_1: Floats | None
    """Largest principal stress, Pa; tension is positive."""

    principal_2: Floats | None
    """Middle principal stress, Pa; tension is positive."""

    principal_3: Floats | None
    """Smallest principal stress, Pa; tension is positive."""

    von_mises: Floats | None
    """Von Mises's equivalent stress, Pa; never negative."""

    xx: Floats | None
    """Normal stress along x, Pa; tension is positive."""

    xy: Floats | None
    """Shear stress in the plane of x and y, Pa."""

    xz: Floats | None
    """Shear stress in the plane of x and z, Pa."""

    yy: Floats | None
    """Normal stress along y, Pa; tension is positive."""

    yz: Floats | None
    """Shear stress in the plane of y and z, Pa."""

    zz: Floats | None
    """Normal stress along z, Pa; tension is positive."""


class SweepReply(Swept):
    """The table of a sweep: one row for each point."""

    columns: dict[str, Floats]
    """The columns by their names or pointers: the axes, then the outputs, in the unit of the field; `null` where a
    point lacks the number or has no result.
    """

    failed: int
    """Number of points without a result."""

    failures: Rows[Record]
    """The first points without a result."""

    points: int
    """Number of points, which is the length of each column."""


class UncertainOutput(Uncertain):
    """The distribution of an output; `null` where too few points have it."""

    name: str
    """The name of the output: its own, else its pointer."""

    shares: Named[Record]
    """The share of the variance that each input has by itself, by its name: Sobol's index of first order."""

    interval: Floats | None
    """The interval that holds 95 % of the values, with 2.5 % on either side, in the unit of the field."""

    mean: float | None
    """The mean, in the unit of the field."""

    mean_error: float | None
    """Standard error of the mean by the number of points, in the unit of the field."""

    standard_uncertainty: float | None
    """The standard uncertainty, in the unit of the field."""

    standard_uncertainty_error: float | None
    """Standard error of the standard uncertainty by the number of points, in the unit of the field."""


class UncertaintyReply(Result):
    """What uncertain inputs mean for the outputs of a simulation (GUM, supplement 1)."""

    failed: int
    """Number of points without a result: where a number is out of the range of its field, for example. The numbers
    above are those of the other points.
    """

    failures: Rows[Record]
    """The first points without a result."""

    outputs: Rows[UncertainOutput]
    """The outputs."""

    points: int
    """Number of points."""

    warnings: Rows[Record]
    """Warnings about the result."""


class WearReply(Result):
    """The limit that wear approaches in a contact."""

    accuracy: Accuracy
    """Solver, errors and time: of the forces before wear, and of the table if the profile has one."""

    contact: Figures
    """The contact before wear."""

    depth: Record
    """The largest depth that is removed."""

    force_amplitude: float
    """Amplitude of the tangential force in the limit, N, where the whole contact sticks."""

    indentation: float
    """The indentation, which is held, m."""

    normal_force: Record
    """The normal force, N."""

    pressure: Record
    """The pressure, Pa, at the same radii; in the limit it is infinite, and so `null`, at the stick radius."""

    removed_volume: float
    """The volume that is removed, m³."""

    shape: Record
    """The height of the undeformed surface above its lowest point, m, from the centre to beyond the worn radius."""

    stick_radius: float
    """Stick radius c of the cycle, m: inside it nothing ever slips. It is the contact radius in the limit."""

    warnings: Rows[Record]
    """Warnings about the result."""

    worn_radius: float
    """Radius up to which the surface wears, m."""

    profile: Any
    """The limiting shape for the computations that follow: a table, or the profile itself if nothing wears; left out
    if it has none, with a warning that gives the reason. In the table a steep rise of g takes the place of the jump
    at the stick radius: with the jump itself the contact at this indentation would be ambiguous.
    """

    profile_error: Record | None
    """How far `profile` is from the limit; left out without `profile`. The errors that other computations state do not
    include it.
    """


NAMES = [
    "Accuracy",
    "AccuracyReply",
    "CyclePage",
    "CycleReply",
    "Figures",
    "FitReply",
    "FrettingReply",
    "FrictionReply",
    "HistoryPage",
    "LoopPage",
    "MoveReply",
    "ObservationsReply",
    "PathReply",
    "PlanarReply",
    "PlanarState",
    "ProfileFitReply",
    "ProtocolReply",
    "RelaxReply",
    "Residual",
    "RollingReply",
    "SessionReply",
    "SessionSummary",
    "SimulateReply",
    "SlidersReply",
    "State",
    "StateEvent",
    "StressReply",
    "SubsurfaceReply",
    "SweepReply",
    "UncertainOutput",
    "UncertaintyReply",
    "WearReply",
]
