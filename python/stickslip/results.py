"""The replies of the service as objects, one for each schema of the OpenAPI document.

Units are SI. Arrays of numbers are NumPy arrays, in which NaN stands where a number is infinite or missing.
Written by `tools/generate.py`.
"""

from __future__ import annotations

from typing import Any

from .extras import Fretting, Plane, Swept
from .result import Floats, Result


class Accuracy(Result):
    """Which solver answered, and how accurate its answer is."""

    compute_time: float
    """Processor time that the request took but for HTTP, s: with the check, the preparation of the profile unless it
    was ready, and the loading of a stored contact; without the time for which the work gave way to that of others.
    """

    force_error: float
    """Estimated error of the forces, relative to the friction limit μ F_N, a pure number: of rounding, of curved
    paths, of the interpolation of a table, of springs; of rings, of every force on the path and relative to its
    largest load.
    """

    reason: str
    """Why this one."""

    solver: Any
    """The solver that answered."""

    stress_error: float
    """Estimated error of the stresses, relative to μ times the largest pressure (or, where that is infinite, to the
    mean), a pure number; of no meaning for a profile without a stress field.
    """

    count: int | None = None
    """Number of rings, of the solver in the plane."""

    steps: int | None = None
    """Steps of the finest of its discretisations on the whole path."""

    subsurface_error: float | None = None
    """Estimated error of the stress below the surface, relative to the largest pressure (or to the mean), a pure
    number, if it was asked for.
    """

    work_error: float | None = None
    """Estimated error of the dissipated energies, relative to μ F_N and the displacement of gross slip at the largest
    load of the path, a pure number: of rings.
    """


class AccuracyReply(Result):
    """The time and the error of each solver."""

    reference: Reference
    """What the rows are compared with."""

    rows: list[AccuracyRow]
    """One row a solver."""


class AccuracyRow(Result):
    """One solver on the path."""

    compute_time: float
    """Time spent computing, s: the median of a few runs if one takes less than some milliseconds."""

    solver: Any
    """The solver."""

    estimated_force_error: float | None = None
    """Error of the force as the solver estimates it, without a reference, relative to `force_unit`, a pure number;
    likewise.
    """

    estimated_stress_error: float | None = None
    """Error of the stress as the solver estimates it, relative to `stress_unit`, a pure number: for radii some cells
    away from kinks; likewise.
    """

    force_error: float | None = None
    """Largest difference of the force from that of the reference, over all moves, relative to `force_unit`, a pure
    number; `null` without an answer, or where it is infinite.
    """

    refused: Fault | None = None
    """Why this solver has no answer, if it has none: the move that it cannot follow."""

    stress_error: float | None = None
    """Largest difference of the shear stress at the end, over the radii, relative to `stress_unit`, a pure number;
    likewise.
    """


class Axis2(Result):
    """Two components in the plane of the scan; a line has no y."""

    x: float
    """Along x, in the unit of the quantity."""

    y: float | None = None
    """Along y, in the unit of the quantity."""


class BestLoad(Result):
    """The load under which a drive does most friction work."""

    dissipated_energy: float
    """Friction work of a cycle under it, J."""

    normal_force: float
    """Normal force, N."""

    curve: LoadCurve | None = None
    """The work at other loads, if asked for."""


class ColumnPair(Result):
    """Heights over radii."""

    height: Floats
    """Heights above the axis, m."""

    radius: Floats
    """Radii, m, increasing."""


class Comparison(Result):
    """The results of the other laws."""

    equal_peaks: Outcome | None = None
    """Equal peaks."""

    linear: Outcome | None = None
    """The linear fall."""

    minimax: Outcome | None = None
    """Minimax."""


class ContactEstimate(Result):
    """The contact as the scan alone determines it."""

    contact_radius: Estimate
    """Contact radius, m."""

    indentation: Estimate
    """Indentation, m."""

    max_pressure: Estimate
    """Largest pressure, Pa."""

    normal_force: Estimate
    """Normal force, N."""


class Cycle(Result):
    """A closed cycle: the displacement went from one turning point to the opposite one and came back.

    Smaller cycles within it are cycles of their own.
    """

    displacement_amplitude: float
    """Half the distance of its turning points, m."""

    dissipated_energy: float
    """Friction work, J, without that of the cycles within it."""

    force_amplitude: float
    """Amplitude of the tangential force, N."""

    from_: int
    """The number of the move after which it began, at its first turning point."""

    to: int
    """The number of the move that closed it."""

    secant_stiffness: float | None = None
    """Force amplitude over displacement amplitude, N/m; `null` beyond all numbers."""

    sliding_ratio: float | None = None
    """Displacement at zero force over the displacement amplitude, both from the middle of the loop, a pure number;
    `null` without friction, and if the cycle is not steady: the load changed within it, or so shortly before that
    the force does not come back with the displacement. Amplitude and work are then those of the recorded states.
    """


class CyclePage(Result):
    """The newest closed cycles of a contact, oldest first."""

    items: list[Cycle]
    """The cycles, in the order in which they closed; of those that one move closed the inner ones first."""


class CycleReply(Result):
    """Steady cycles, one for each amplitude."""

    accuracy: Accuracy
    """Solver, errors and time. `force_error` is that of the harmonics too, relative to the amplitude of the answer."""

    contact: Figures
    """The contact at its load, in a map at its preload."""

    cycles: list[SteadyCycle]
    """The cycles, in the order of the amplitudes; in a map load by load."""

    warnings: list[Warning]
    """Warnings about the result."""

    frequency_response: Resonance | None = None
    """The oscillations of a mass on the contact, if asked for."""


class DisplacementPath(Result):
    """A path of displacements."""

    displacement: Floats
    """Tangential displacements of the indenter, m, one move each."""


class EndEvent(Result):
    """The data of the event `end`, the last one."""

    reason: Any
    """Why there are no more."""


class Estimate(Result):
    """A value and its standard error, both in the unit of the quantity; `null` where it is not known."""

    standard_error: float | None = None
    """Its standard error, in the unit of the quantity."""

    value: float | None = None
    """The value, in the unit of the quantity."""


class Fault(Result):
    """One fault of a request."""

    detail: str
    """What is wrong there, and what is allowed."""

    pointer: str
    """JSON pointer (RFC 6901) into the body, or `/` and the name of a query parameter."""


class Figures(Result):
    """What follows from the definition of a contact at its preload."""

    contact_radius: float
    """Contact radius a, m; of a profile without a stress field F_N′/(2 E*), which governs the stiffness."""

    e_star: float
    """Reduced modulus E*, Pa."""

    g_star: float
    """Reduced shear modulus G*, Pa."""

    gross_slip_displacement: float
    """Displacement at which a virgin contact just slips as a whole, μ (E*/G*) d, m."""

    gross_slip_force: float
    """Tangential force then, μ F_N, N."""

    indentation: float
    """Indentation d, m."""

    normal_force: float
    """Normal force F_N, N."""

    max_pressure: float | None = None
    """Largest pressure, Pa; `null` where it is infinite, and of a profile without a stress field."""

    semi_axes: Floats | None = None
    """Semi-axes of the contact along x and y, m: of an ellipsoid."""


class FileColumn(Result):
    """A column of a file."""

    assumed: bool
    """Whether neither the file nor the query names that unit."""

    left_out: str | None = None
    """Why it was left out."""

    name: str | None = None
    """Its name in the header, if it has one."""

    quantity: str | None = None
    """What it was taken for: `x`, `y`, `z`, `displacement`, `force`, `time` or `normal_force`; `null` if it was left
    out.
    """

    unit: str | None = None
    """Its unit in the file, by its symbol (`um`) or as the file names it (`mil`); `null` if it was left out. The
    numbers of the reply are in `units`.
    """


class FilePreview(Result):
    """How a file was read."""

    columns: list[FileColumn]
    """The columns in order, with what each was taken for; none of a matrix of heights."""

    decimal_mark: str
    """What separates whole numbers from decimals: `.` or `,`."""

    encoding: str
    """The encoding, such as `UTF-8` or `UTF-16LE`, or the kind of a spreadsheet."""

    header: list[str]
    """The first lines before the numbers."""

    reading: list[str]
    """What was taken for what, in sentences."""

    rows: int
    """Number of rows of numbers."""

    rows_left_out: RowsLeftOut
    """Lines that are not in the reply: headers, remarks, and rows without a number that they need."""

    separator: str
    """What separates the columns: `semicolon`, `tab`, `white_space` or `comma`."""

    thinned: int
    """The stride: one row in so many, and one column of a matrix, is in the reply; 1 if all are."""


class FitEstimate(Result):
    """A quantity as the loops determine it, in its SI unit."""

    interval: Floats
    """Both ends of the interval that contains it with a probability of 95 %, by profile likelihood, in the SI unit of
    the quantity; `null` where there is no end.
    """

    value: float
    """The value of the best fit, in the SI unit of the quantity."""

    at_bound: bool | None = None
    """Whether the value is at the end of its range; left out if not."""

    standard_error: float | None = None
    """Its standard error, if the fit were linear, in the SI unit of the quantity; `null` where it is not determined."""


class FitReply(Result):
    """What the loops say, and what they leave open."""

    contact: Any
    """The contact with what was fitted, for `POST /contacts` and `/simulate`."""

    correlations: dict[str, dict[str, float | None]]
    """Their correlation coefficients, pure numbers, by both names; `null` where one is not determined."""

    curve: list[FittedLoop]
    """The loops as they were fitted, in SI units; long ones are thinned."""

    estimates: dict[str, FitEstimate]
    """What is free, and what is known with a standard error, by name."""

    identifiable: list[str]
    """What the loops determine: names, and combinations of them where one alone is not determined."""

    noise: NoiseLevels
    """The noise: as it was given, else as estimated."""

    residual: FitResidual
    """What the fit leaves of the measured forces."""

    warnings: list[Warning]
    """Warnings about the fit."""


class FitResidual(Result):
    """What a fit leaves of the forces."""

    largest: float
    """The largest magnitude without outliers, N."""

    outliers: float
    """Share of the points that were left out because they are far off, a pure number from 0 to 1."""

    rms: float
    """Root mean square without outliers, N."""

    runs: SignRuns
    """Whether it looks like noise."""


class FittedLoop(Result):
    """A loop as it was fitted, point by point."""

    displacement: Floats
    """Measured displacements, m."""

    force: Floats
    """The force of the fit, N."""

    measured: Floats
    """The measured force, N."""

    used: list[bool]
    """Whether the point was used; if not, it is an outlier."""


class FrettingReply(Fretting):
    """The criteria over the steady cycle, each with its values at all places."""

    accuracy: Accuracy
    """Solver, errors and time."""

    change: float
    """The largest of the errors of the largest values, relative to these, a pure number."""

    contact: Figures
    """What follows from the definition at the preload."""

    instants: int
    """Instants of the move that took most, at the places of the largest values."""

    warnings: list[Warning]
    """Warnings about the result."""

    x: Floats
    """Place along the motion of the first body, m."""

    y: Floats
    """Place across it, m."""

    z: Floats
    """Depth into the body, m; never negative."""

    crossland: Rating | None = None
    """Crossland's criterion, Pa."""

    dang_van: Rating | None = None
    """Dang Van's criterion, Pa."""

    fatemi_socie: Rating | None = None
    """Fatemi and Socie's criterion, a pure number."""

    findley: Rating | None = None
    """Findley's criterion, Pa."""

    friction_work: Rating | None = None
    """Friction work per area and cycle, J/m²; never negative."""

    ruiz: Rating | None = None
    """Ruiz's first parameter, shear stress times slip, N/m."""

    ruiz_tension: Rating | None = None
    """Ruiz's second parameter, that times the largest tension along x, N²/m³; comes with the first."""

    stress_paths: list[StressPath] | None = None
    """The stresses over the cycle at the places of `stress_paths`."""

    swt: Rating | None = None
    """Smith, Watson and Topper's criterion, Pa."""


class FrictionEstimate(Result):
    """A coefficient of friction from a measured cycle."""

    from_: int
    """The number of the move after which the cycle began."""

    interval: Floats
    """Both ends of its 95 % interval, pure numbers."""

    to: int
    """The number of the move that closed it."""

    value: float
    """Coefficient of friction μ, a pure number."""


class FrictionReply(Result):
    """The coefficient of friction that the observations of a contact have last determined."""

    id: str
    """The identifier of the contact."""

    sequence: int
    """Number of moves so far."""

    friction: FrictionEstimate | None = None
    """The estimate; left out as long as the observations do not determine it."""


class FrictionWork(Result):
    """Friction work of a cycle per area, along the radius."""

    density: Floats
    """Friction work per area, J/m²; `null` where it is infinite."""

    radius: Floats
    """Radii, m."""


class Gap(Result):
    """How far a path may be from the optimum."""

    method: str
    """How the path was found, and what speaks for it."""

    lower_bound: float | None = None
    """What some point of the contact carries after gross slip and so many reversals, whatever they are, Pa: proven.
    `null` for other starts, and at a vertical edge.
    """

    proven: float | None = None
    """1 - `lower_bound`/`largest`, a pure number: the largest gap that is not ruled out by proof."""

    spread: float | None = None
    """By how much the smallest of the alternating extrema falls short of the largest, relative to it, a pure number;
    `null` where they are not all meant to be equal: with a prescribed end, or a start from a history.
    """


class Harmonic(Result):
    """One harmonic of the answer to a drive that is a cosine."""

    in_phase: float
    """Amplitude of the cosine, in the unit of the answer."""

    order: int
    """1 for the fundamental. Even ones vanish at constant load."""

    quadrature: float
    """Amplitude of the sine, in the unit of the answer: at the fundamental at most zero for a force, at least zero for
    a displacement.
    """


class HistoryItem(Result):
    """A move that has been applied."""

    at: str
    """When it was applied (ISO 8601, UTC)."""

    move: Any
    """The move as it was given."""

    sequence: int
    """Its number, counted from 1."""

    state: State
    """The state after it."""

    by: str | None = None
    """The name of the key that made it. Left out of a move that was made without a key, and where no keys are in use.
    """

    cycle: Cycle | None = None
    """The cycle that it closed; the outermost if several."""

    observation: ObservedForce | None = None
    """What was measured there, if it is an observation."""


class HistoryPage(Result):
    """A page of the history of a contact, oldest first."""

    items: list[HistoryItem]
    """The moves."""

    next: int | None = None
    """What to give as `after` for the next page; `null` on the last."""


class Instant(Result):
    """An instant of the cycle."""

    move: int
    """Index of the move."""

    part: float
    """The part of the move that has been made, a pure number above 0 and up to 1."""


class JobEndEvent(Result):
    """The data of the event `end`, the last one before a job has ended itself."""

    reason: Any
    """Why there are no more."""


class JobList(Result):
    """Jobs of a tenant."""

    items: list[JobReply]
    """The jobs, oldest first."""


class JobProgress(Result):
    """The progress of a job."""

    done: int
    """Points that are computed and stored."""

    failed: int
    """Points among them that have no answer."""

    points: int
    """Points in all."""


class JobReply(Result):
    """A sweep that the server computes after its request has been answered."""

    created_at: str
    """When it was asked for (ISO 8601, UTC)."""

    expires_at: str
    """When it is deleted, with its result (ISO 8601, UTC)."""

    id: str
    """Its identifier."""

    point_time: float
    """Time that the solver is estimated to take for a point, on one thread, s."""

    progress: JobProgress
    """Its progress."""

    result: str
    """The path of its result, available once the state is `done`."""

    state: Any
    """Its state."""

    detail: str | None = None
    """Why it failed."""

    finished_at: str | None = None
    """When it ended (ISO 8601, UTC)."""


class JudgedReply(Result):
    """Where and in which unit the remaining stress is measured."""

    from_radius: float
    """From this radius on, m: zero, but where the stress is infinite whatever is done (the tip of a cone, the rim of a
    truncated profile).
    """

    objective: str
    """What is made small, in words."""

    pressure: Any
    """Which pressure that is."""

    to_radius: float
    """Up to this radius, m: the contact radius, but at a vertical edge."""

    unit: float
    """μ times the pressure that stresses are compared with, Pa."""


class Largest(Result):
    """The place where a criterion is largest."""

    error: float
    """The estimated distance of the value from the largest over the cycle and, in a search, over the body, in the unit
    of the criterion.
    """

    point: Floats
    """Its place: x, y, z, m."""

    value: float
    """The value, in the unit of the criterion."""

    at: Instant | None = None
    """The critical instant, if the criterion has one."""

    plane: Floats | None = None
    """Unit normal of the critical plane along x, y and z, pure numbers, if the criterion has one."""


class LineInFile(Result):
    """A profile along a line."""

    x: Floats
    """Places along the line, in the unit of `units.lateral`."""

    z: Floats
    """Heights, as many, in the unit of `units.height`."""


class LoadCurve(Result):
    """Friction work over the load."""

    dissipated_energy: Floats
    """Friction work of a cycle, J; `null` under loads that do not hold the driven force, or that the profile has no
    contact for.
    """

    normal_force: Floats
    """Normal forces, N."""


class LoopFileReply(Result):
    """A measured loop that was read from a file.

    `loop` is one of the `loops` of the body of `POST /fit`, and `units` its member.
    """

    loop: LoopInFile
    """Displacement and force, with the time and the mean load if the file has them."""

    preview: FilePreview
    """How the file was read."""

    units: Any
    """The units of the loop."""


class LoopInFile(Result):
    """A loop as a file has it: one of those of `POST /fit`, with however few or many points."""

    displacement: Floats
    """Displacements, in the unit of `units.displacement`."""

    force: Floats
    """Tangential forces, as many, in the unit of `units.force`."""

    normal_force: float | None = None
    """The mean load, N, if the file has one."""

    time: Floats | None = None
    """Times, s, as many, if the file has them."""


class LoopPage(Result):
    """A page of the hysteresis loop of a contact, oldest first.

    The first page begins with the virgin contact at sequence zero; the pages in sequence are the whole loop.
    """

    displacement: Floats
    """Tangential displacement U of the indenter, m; positive along x."""

    force: Floats
    """Tangential force F, N."""

    part: Floats
    """Fraction of that move, a pure number: 1 at its end."""

    sequence: list[int]
    """The number of the move that a point belongs to."""

    next: int | None = None
    """What to give as `after` for the next page; `null` on the last."""

    observed_force: Floats | None = None
    """Force that was measured at a point, N, `null` where none was; left out if there is none on the page."""


class MapInFile(Result):
    """Heights on a grid."""

    dx: float
    """The distance of neighbours in a row, along x, in the unit of `units.lateral`."""

    dy: float
    """The distance of rows, along y, in the unit of `units.lateral`."""

    z: list[Floats]
    """The rows of heights, in the unit of `units.height`."""


class MoveReply(Result):
    """The result of a move."""

    accuracy: Accuracy
    """Solver, errors and time."""

    id: str
    """The identifier of the contact."""

    sequence: int
    """The number of this move, and of moves so far."""

    state: State
    """The state after it."""

    stress: Stress | None = None
    """The stresses after it, if asked for."""

    warnings: list[Warning] | None = None
    """Warnings about the results from this move on that earlier replies have not given."""


class NewSession(Result):
    """A contact that has just been made."""

    contact: Figures
    """What follows from the definition at the preload."""

    id: str
    """Its identifier."""

    sequence: int
    """Number of moves so far: zero, or those of the contact that it was forked from."""

    state: State
    """Its state."""

    warnings: list[Warning]
    """Warnings about its results."""

    label: str | None = None
    """Its label, if it has one."""


class NoiseLevels(Result):
    """Standard deviations of the noise."""

    displacement: float
    """Of a displacement, m."""

    force: float
    """Of a force, N."""


class ObservationsReply(Result):
    """The result of observations."""

    id: str
    """The identifier of the contact."""

    items: list[ObservedMove]
    """The observations beside what the contact predicts."""

    sequence: int
    """The number of the last move, and of moves so far."""

    friction: FrictionEstimate | None = None
    """The coefficient of friction by the last measured cycle; left out as long as the observations do not determine
    it.
    """


class ObservedForce(Result):
    """What was measured at the displacement of a move."""

    force: float
    """Measured tangential force, N; positive along x."""

    innovation: float
    """Measured less predicted force, N."""

    predicted: float
    """Tangential force of the contact there, N, with the friction of its definition."""

    at: str | None = None
    """When it was measured, if that is known (ISO 8601, UTC)."""


class ObservedMove(Result):
    """An observation beside what the contact predicts."""

    displacement: float
    """Tangential displacement, m."""

    force: float
    """Measured tangential force, N; positive along x."""

    innovation: float
    """Measured less predicted force, N."""

    predicted: float
    """Tangential force of the contact there, N, with the friction of its definition."""


class Outcome(Result):
    """What a law leaves."""

    displacement: float
    """Tangential displacement at the end, m."""

    dissipated_energy: float
    """Work done against friction on the path, J."""

    force: float
    """Tangential force at the end, N."""

    residual: Residual
    """What remains."""

    gap: Gap | None = None
    """How far the path may be from the optimum; of `minimax` alone."""

    largest: float | None = None
    """The largest magnitude of the shear stress that remains where it is measured, Pa; `null` where it is infinite."""

    relative: float | None = None
    """The same over `judged.unit`, a pure number."""

    robustness: RobustnessReply | None = None
    """What remains if it is not followed exactly, if asked for."""


class PathReply(Result):
    """The result of a path."""

    accuracy: Accuracy
    """Solver, errors and time."""

    id: str
    """The identifier of the contact."""

    sequence: int
    """The number of the last move, and of moves so far."""

    steps: list[State]
    """The states along the path: all of them, or the last."""

    protocol: Protocol | None = None
    """The path, if it follows the law of equal peaks."""

    stress: Stress | None = None
    """The stresses at the end, if asked for."""

    warnings: list[Warning] | None = None
    """Warnings about the results from this path on that earlier replies have not given."""


class Peak(Result):
    """A local extremum of the shear stress."""

    radius: float
    """Where, m."""

    shear: float | None = None
    """Shear stress there, Pa, positive as a positive displacement causes it; `null` where it is infinite."""


class PlanarReply(Plane):
    """The result of a simulation in the plane."""

    accuracy: Accuracy
    """Solver, errors and time."""

    contact: Figures
    """What follows from the definition at the preload."""

    steps: list[PlanarState]
    """The states along the path: all of them, or the last."""

    warnings: list[Warning]
    """Warnings about the result."""

    stress: PlanarStress | None = None
    """The stresses at the end, if asked for."""

    turn_losses: Floats | None = None
    """Friction work of each turn of an ellipse, J; the first one begins at rest."""


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
    """Tangential force along x and y, N; along the displacement of a virgin contact."""

    indentation: float
    """Indentation d, m; positive when pressed in, below zero the bodies are apart."""

    normal_force: float
    """Normal force F_N, N; compression is positive."""

    regime: Any
    """How much of the contact slipped in the last move."""

    stick_radius: float
    """Radius inside which the last move did not slip, m, to the width of a ring: the contact radius if nothing
    slipped, zero in gross slip.
    """


class PlanarStress(Result):
    """Stresses along the radius at the end of a path in the plane; they are the same at every angle.

    An array that was not asked for is left out.
    """

    radius: Floats
    """Radii, m."""

    friction_work: Floats | None = None
    """Friction work per area since the start, J/m²: with `slip`, where rings follow the path."""

    pressure: Floats | None = None
    """Normal pressure, Pa; compression is positive; `null` where it is infinite."""

    shear_x: Floats | None = None
    """Shear stress along x, Pa; `null` where it is infinite."""

    shear_y: Floats | None = None
    """Shear stress along y, Pa; `null` where it is infinite."""

    slip_x: Floats | None = None
    """Slip along x, the displacement of the indenter less that of the surface, m; `null` outside the contact."""

    slip_y: Floats | None = None
    """Slip along y, m; `null` outside the contact."""


class PointFailure(Result):
    """A point without an answer."""

    code: str
    """What `POST /simulate` would give as the code of the problem."""

    detail: str
    """What is wrong."""

    index: int
    """The row, counted from 0."""

    pointer: str | None = None
    """JSON pointer into the base, if a place is to blame."""


class PointsInFile(Result):
    """Heights anywhere."""

    x: Floats
    """Places along x, in the unit of `units.lateral`."""

    y: Floats
    """Places along y, as many, in the unit of `units.lateral`."""

    z: Floats
    """Heights, as many, in the unit of `units.height`."""


class ProfileFitReply(Result):
    """A profile that was fitted to a scan, with what is left of the scan."""

    centre: Axis2
    """The axis, m."""

    g_margin: float
    """The least g′(x)/x over its mean, a pure number: 1 for a ball, 0 where g is about to fall or, at a flat end,
    constant.
    """

    left_out: ColumnPair
    """The points that were left out as outliers, thinned alike."""

    orientation: Any
    """Which way up the scan is: `peak_up` or `peak_down`."""

    profile: Any
    """The profile, for `/simulate` and `/contacts`."""

    radius_of_curvature: Estimate
    """The radius of curvature on the axis, m; `null` where the surface is flat there to within its error."""

    raw: ColumnPair
    """The points that were fitted, as heights of the gap above the axis; at most 4000 of them, evenly thinned."""

    residual: ScanResidual
    """What the profile leaves of the heights."""

    tilt: Axis2
    """The slopes of the plane that was taken off, pure numbers."""

    used: ColumnPair
    """The profile that was fitted, as the table of `profile`."""

    warnings: list[Warning]
    """Warnings about the scan."""

    contact: ContactEstimate | None = None
    """The contact under `load`."""


class Protocol(Result):
    """The path that the law of equal peaks has given."""

    cutoff_radius: float
    """Radius from which on the peaks are equal, m."""

    displacement: Floats
    """Displacements, m; usable as a path of their own."""


class ProtocolReply(Result):
    """How to move so that little shear stress remains."""

    accuracy: Accuracy
    """Solver, errors and time."""

    comparison: Comparison
    """The same for the other laws, with as many reversals."""

    contact: Figures
    """What follows from the definition at the present load."""

    displacement: float
    """Tangential displacement at the end, m."""

    dissipated_energy: float
    """Work done against friction on the path, J."""

    end: Any
    """Where the path ends."""

    force: float
    """Tangential force at the end, N."""

    judged: JudgedReply
    """Where and in which unit the remaining stress is measured."""

    kind: Any
    """The law of the amplitudes."""

    path: DisplacementPath
    """The path, to be given to `/simulate` or `/contacts/{id}/path` as it is."""

    residual: Residual
    """What remains."""

    reversals: int
    """Number of reversals N_R."""

    start: StartReply
    """How the path begins."""

    warnings: list[Warning]
    """Warnings about the results."""

    gap: Gap | None = None
    """How far the path may be from the optimum; of `minimax` alone."""

    largest: float | None = None
    """The largest magnitude of the shear stress that remains where it is measured, Pa; `null` where it is infinite."""

    relative: float | None = None
    """The same over `judged.unit`, a pure number."""

    robustness: RobustnessReply | None = None
    """What remains if it is not followed exactly, if asked for."""


class Rating(Result):
    """A criterion at all places."""

    values: Floats
    """Its values, place by place, in the unit of the criterion; `null` where a stress is infinite, and below the
    surface for a quantity of the surface.
    """

    largest: Largest | None = None
    """The largest of those that are not `null`; in a search left out if there is no largest value in the body."""

    margin: float | None = None
    """The limit over the largest value, a pure number, if a limit was given: below 1 the criterion predicts crack
    growth. Left out where the value is nowhere positive, and where it is infinite somewhere.
    """


class Reference(Result):
    """The solution that errors are measured from, with its own error."""

    compute_time: float
    """Time spent on it, s."""

    force_error: float
    """Its own estimated error of the forces, relative to `force_unit`, a pure number: smaller differences have no
    meaning.
    """

    force_unit: float
    """The unit of force errors: the largest friction limit μ F_N along the path, N."""

    radii: int
    """How many radii are compared: those where the stress of the reference is finite."""

    reason: str
    """What makes it a reference."""

    solver: Any
    """The solver."""

    stress_error: float
    """Its own estimated error of the stresses, relative to `stress_unit`, a pure number."""

    stress_unit: float
    """The unit of stress errors: μ times the largest pressure at the end of the path (or, where that is infinite, the
    mean), Pa.
    """


class RelaxReply(Result):
    """The result of relaxing a contact, or of a dry run."""

    accuracy: Accuracy
    """Solver, errors and time."""

    comparison: Comparison
    """The same for the other laws, with as many reversals."""

    contact: Figures
    """What follows from the definition at the present load."""

    displacement: float
    """Tangential displacement at the end, m."""

    dissipated_energy: float
    """Work done against friction on the path, J."""

    end: Any
    """Where the path ends."""

    force: float
    """Tangential force at the end, N."""

    judged: JudgedReply
    """Where and in which unit the remaining stress is measured."""

    kind: Any
    """The law of the amplitudes."""

    path: DisplacementPath
    """The path, to be given to `/simulate` or `/contacts/{id}/path` as it is."""

    residual: Residual
    """What remains."""

    reversals: int
    """Number of reversals N_R."""

    start: StartReply
    """How the path begins."""

    warnings: list[Warning]
    """Warnings about the results."""

    dry_run: bool
    """Whether the path was only shown."""

    id: str
    """The contact."""

    sequence: int
    """Number of moves so far."""

    gap: Gap | None = None
    """How far the path may be from the optimum; of `minimax` alone."""

    largest: float | None = None
    """The largest magnitude of the shear stress that remains where it is measured, Pa; `null` where it is infinite."""

    relative: float | None = None
    """The same over `judged.unit`, a pure number."""

    robustness: RobustnessReply | None = None
    """What remains if it is not followed exactly, if asked for."""

    steps: list[State] | None = None
    """The states along the path: all of them, or the last; if asked for."""


class Residual(Result):
    """The extrema of the shear stress of a contact."""

    peaks: list[Peak]
    """The local extrema strictly between centre and edge, from the centre outwards, each with its position to round-
    off. Where the history does not say how often the stress turns between two of its kinks, the derivative of the
    stress is sampled there, and two extrema closer together than the samples could be missed; dense searches have
    found none that was.
    """

    centre: float | None = None
    """Shear stress in the centre, Pa, positive as a positive displacement causes it; `null` where it is infinite."""

    max: float | None = None
    """Largest magnitude of the shear stress over the whole contact, centre included, Pa; `null` where it is infinite.
    """

    mean: float | None = None
    """Mean magnitude of the peaks, Pa; `null` without a peak."""

    min: float | None = None
    """Smallest magnitude among the peaks, Pa; `null` without a peak."""

    relative: float | None = None
    """`max` over μ times the largest pressure at the present load (or, where that is infinite, the mean), a pure
    number; `null` where `max` is, without a load and without friction.
    """


class Resonance(Result):
    """Steady oscillations of a mass on the contact."""

    natural_frequency: float
    """Frequency of small oscillations, Hz."""

    points: list[ResonancePoint]
    """The steady oscillation at each frequency, in the order of the frequencies. There is one only where something
    slips in each period, as under every face that is not flat: friction draws any two motions of the mass together.
    A flat face that sticks throughout adds no damping; the oscillation given is then the one with the period of the
    force, beside which a free oscillation may persist.
    """


class ResonancePoint(Result):
    """One steady oscillation."""

    amplitude: float
    """Amplitude of the first harmonic of the displacement, m."""

    frequency: float
    """Frequency, Hz."""

    peak: float
    """Half the range of the displacement, m: more or less than the amplitude, by what the higher harmonics add."""

    phase: float
    """By how much the first harmonic of the displacement lags behind the force, degrees."""

    third_harmonic: float
    """Third harmonic of the contact's force over the first, a pure number."""

    amplitude_error: float | None = None
    """Estimated error of the amplitude, m; over the amplitude it is that of the phase in rad. `null` where the steady
    oscillation was not found: all else is then what the first harmonic of the force alone would make of it, and may
    be far off.
    """

    peak_error: float | None = None
    """Estimated error of the peak, m; `null` likewise."""


class RobustnessReply(Result):
    """What remains when a protocol is not followed exactly: of the largest stress over `judged.unit`, pure numbers.

    `null` where it is infinite.
    """

    samples: int
    """How many times it was tried."""

    mean: float | None = None
    """The mean, a pure number."""

    percentile_95: float | None = None
    """The value that 95 of 100 stay below, a pure number."""

    standard_error: float | None = None
    """The standard error of the mean, a pure number."""


class RowsLeftOut(Result):
    """Lines of a file that are not in the reply."""

    count: int
    """How many there are."""

    lines: list[int]
    """Their numbers from 1 on, of the first 100."""


class ScanFileReply(Result):
    """A scan that was read from a file. `scan` and `units` are members of the body of `POST /profiles/fit`."""

    preview: FilePreview
    """How the file was read."""

    scan: Any
    """The heights, with their places."""

    units: Any
    """The units of the scan."""


class ScanResidual(Result):
    """What a profile leaves of a scan."""

    correlation_length: float
    """Distance along the scan over which it is correlated, to 1/e, m."""

    outliers: int
    """Points that were left out, fill values of the instrument among them."""

    rms: float
    """Root mean square of the points that were fitted, m: noise and roughness."""


class SessionPage(Result):
    """A page of contacts, in the order that the query asks for."""

    items: list[SessionSummary]
    """The contacts."""

    next: str | None = None
    """What to give as `after` for the next page; `null` on the last."""


class SessionReply(Result):
    """A contact."""

    contact: Figures
    """What follows from the definition at the preload."""

    created_at: str
    """When it was made (ISO 8601, UTC)."""

    id: str
    """Its identifier."""

    sequence: int
    """Number of moves so far."""

    state: State
    """Its state after the last move."""

    updated_at: str
    """When it was last moved (ISO 8601, UTC)."""

    label: str | None = None
    """Its label, if it has one."""


class SessionSummary(Result):
    """A contact as an item of a list."""

    created_at: str
    """When it was made (ISO 8601, UTC)."""

    id: str
    """Its identifier."""

    sequence: int
    """Number of moves so far."""

    updated_at: str
    """When it was last moved (ISO 8601, UTC)."""

    label: str | None = None
    """Its label, if it has one."""


class SignRuns(Result):
    """Stretches of one sign in a residual: few of them are a systematic deviation."""

    count: int
    """How many there are."""

    expected: float
    """How many noise would have on average, a pure number."""

    random: bool
    """Whether the two agree."""


class SimulateReply(Result):
    """The result of a simulation."""

    accuracy: Accuracy
    """Solver, errors and time."""

    contact: Figures
    """What follows from the definition at the preload."""

    steps: list[State]
    """The states along the path: all of them, or the last."""

    warnings: list[Warning]
    """Warnings about the result."""

    protocol: Protocol | None = None
    """The path, if it follows the law of equal peaks."""

    residual: Residual | None = None
    """The extrema of the shear stress at the end, if asked for."""

    stress: Stress | None = None
    """The stresses at the end, if asked for."""

    subsurface: Subsurface | None = None
    """The stress below the surface at the end, if asked for."""


class StartReply(Result):
    """How a path begins."""

    displacement: float
    """The first displacement of the path, m."""

    stroke: Any
    """Which beginning was chosen."""


class State(Result):
    """The state after a move."""

    contact_radius: float
    """Contact radius a, m; of a profile without a stress field F_N′/(2 E*)."""

    displacement: float
    """Tangential displacement U of the indenter, m; positive along x."""

    dissipated_energy: float
    """Work dissipated by friction since the start, J; never falls."""

    elastic_energy: float
    """Energy stored in the tangential deformation, J."""

    force: float
    """Tangential force F, N; positive for a positive displacement of a virgin contact."""

    indentation: float
    """Indentation d, m; positive when pressed in, below zero the bodies are apart."""

    memory_depth: int
    """Number of pieces of the slip history."""

    normal_force: float
    """Normal force F_N, N; compression is positive."""

    regime: Any
    """How much of the contact slipped in the last move."""

    stick_radius: float
    """Radius inside which the last move did not slip, m: the contact radius if nothing slipped, zero in gross slip."""


class StateEvent(Result):
    """The data of an event `state`: a move that has been applied, with the state after it."""

    at: str
    """When it was applied, or the contact created (ISO 8601, UTC)."""

    id: str
    """The identifier of the contact."""

    sequence: int
    """The number of the move, and of moves so far; the identifier of the event."""

    state: State
    """The state after it."""

    cycle: Cycle | None = None
    """The cycle that it closed; the outermost if several."""

    move: Any = None
    """The move as it was given; absent before the first."""

    observation: ObservedForce | None = None
    """What was measured there, if it is an observation."""


class SteadyCycle(Result):
    """One steady cycle."""

    displacement_amplitude: float
    """Amplitude of the displacement of the indenter, m."""

    dissipated_energy: float
    """Friction work of a cycle, J."""

    force_amplitude: float
    """Amplitude of the tangential force, N."""

    max_elastic_energy: float
    """The largest elastic energy of the tangential deformation in a cycle, J."""

    regime: Any
    """How much of the contact slips."""

    secant_stiffness: float
    """Force amplitude over displacement amplitude of the indenter, N/m; at the amplitude zero the tangent stiffness."""

    stick_radius: float
    """Radius of the part that never slips, m; zero in gross slip."""

    tangent_stiffness: float
    """Stiffness of the contact just after a reversal, 2 G* a, N/m; zero without friction."""

    best_load: BestLoad | None = None
    """The load under which this amplitude does most friction work, if asked for and if there is one."""

    friction_work: FrictionWork | None = None
    """The friction work per area, if asked for."""

    gross_slip_displacement: float | None = None
    """Displacement amplitude of the indenter at which gross slip begins under this load, m; in a map alone."""

    harmonics: list[Harmonic] | None = None
    """The harmonics, if asked for: of the force, N, where the displacement is driven, and of the displacement of the
    indenter, m, where the force is.
    """

    loss_factor: float | None = None
    """Dissipated energy over 2π times the largest elastic energy, a pure number; `null` where the indenter slides and
    nothing is stored, as without friction and without load.
    """

    machine_amplitude: float | None = None
    """Amplitude of the displacement at the machine, m; with `machine` alone."""

    normal_force: float | None = None
    """Normal force, N; in a map alone."""

    sliding_ratio: float | None = None
    """Displacement at zero force over the amplitude of the indenter, a pure number; `null` where it moves and there is
    no force, as without friction and without load.
    """


class Stress(Result):
    """Stresses along the radius; an array that was not asked for is left out."""

    radius: Floats
    """Radii, m."""

    displacement: Floats | None = None
    """Tangential displacement u(r) of the surface, m; positive along x."""

    pressure: Floats | None = None
    """Normal pressure, Pa; compression is positive; `null` where it is infinite."""

    shear: Floats | None = None
    """Shear stress, Pa; positive as a positive displacement causes it; `null` where it is infinite."""

    slip: Floats | None = None
    """Slip U − u(r), the displacement of the indenter less that of the surface, m; `null` outside the contact."""


class StressPath(Result):
    """The stresses at one place over the cycle, in columns, Pa, tension positive."""

    move: list[int]
    """Index of the move."""

    part: Floats
    """The part of the move that has been made, a pure number above 0 and up to 1."""

    place: int
    """Index of the place."""

    xx: Floats
    """Normal stress along x, Pa; tension is positive."""

    xy: Floats
    """Shear stress in the plane of x and y, Pa."""

    xz: Floats
    """Shear stress in the plane of x and z, Pa."""

    yy: Floats
    """Normal stress along y, Pa; tension is positive."""

    yz: Floats
    """Shear stress in the plane of y and z, Pa."""

    zz: Floats
    """Normal stress along z, Pa; tension is positive."""


class StressReply(Result):
    """The stresses of a contact, and their extrema if asked for."""

    radius: Floats
    """Radii, m."""

    displacement: Floats | None = None
    """Tangential displacement u(r) of the surface, m; positive along x."""

    pressure: Floats | None = None
    """Normal pressure, Pa; compression is positive; `null` where it is infinite."""

    residual: Residual | None = None
    """The extrema of the shear stress, if asked for."""

    shear: Floats | None = None
    """Shear stress, Pa; positive as a positive displacement causes it; `null` where it is infinite."""

    slip: Floats | None = None
    """Slip U − u(r), the displacement of the indenter less that of the surface, m; `null` outside the contact."""


class Subsurface(Result):
    """Stresses below the surface, in columns; an array that was not asked for is left out, and `null` is where a
    stress is infinite.
    """

    x: Floats
    """Place along the motion of the first body, m."""

    y: Floats
    """Place across it, m."""

    z: Floats
    """Depth into the body, m; never negative."""

    hydrostatic: Floats | None = None
    """Mean normal stress, Pa; tension is positive."""

    max_shear: Floats | None = None
    """Largest shear stress on any plane, Pa; never negative."""

    principal_1: Floats | None = None
    """Largest principal stress, Pa; tension is positive."""

    principal_2: Floats | None = None
    """Middle principal stress, Pa; tension is positive."""

    principal_3: Floats | None = None
    """Smallest principal stress, Pa; tension is positive."""

    von_mises: Floats | None = None
    """Von Mises's equivalent stress, Pa; never negative."""

    xx: Floats | None = None
    """Normal stress along x, Pa; tension is positive."""

    xy: Floats | None = None
    """Shear stress in the plane of x and y, Pa."""

    xz: Floats | None = None
    """Shear stress in the plane of x and z, Pa."""

    yy: Floats | None = None
    """Normal stress along y, Pa; tension is positive."""

    yz: Floats | None = None
    """Shear stress in the plane of y and z, Pa."""

    zz: Floats | None = None
    """Normal stress along z, Pa; tension is positive."""


class SubsurfaceReply(Result):
    """Stresses below the surface of a contact on the server."""

    x: Floats
    """Place along the motion of the first body, m."""

    y: Floats
    """Place across it, m."""

    z: Floats
    """Depth into the body, m; never negative."""

    accuracy: Accuracy
    """Solver, errors and time."""

    warnings: list[Warning]
    """Warnings about the result."""

    hydrostatic: Floats | None = None
    """Mean normal stress, Pa; tension is positive."""

    max_shear: Floats | None = None
    """Largest shear stress on any plane, Pa; never negative."""

    principal_1: Floats | None = None
    """Largest principal stress, Pa; tension is positive."""

    principal_2: Floats | None = None
    """Middle principal stress, Pa; tension is positive."""

    principal_3: Floats | None = None
    """Smallest principal stress, Pa; tension is positive."""

    von_mises: Floats | None = None
    """Von Mises's equivalent stress, Pa; never negative."""

    xx: Floats | None = None
    """Normal stress along x, Pa; tension is positive."""

    xy: Floats | None = None
    """Shear stress in the plane of x and y, Pa."""

    xz: Floats | None = None
    """Shear stress in the plane of x and z, Pa."""

    yy: Floats | None = None
    """Normal stress along y, Pa; tension is positive."""

    yz: Floats | None = None
    """Shear stress in the plane of y and z, Pa."""

    zz: Floats | None = None
    """Normal stress along z, Pa; tension is positive."""


class SweepReply(Swept):
    """The table of a sweep: a row a point."""

    columns: dict[str, Floats]
    """The columns by their names or pointers: the axes, then the outputs, in the unit of the field; `null` where a
    point has no such number or no answer.
    """

    failed: int
    """How many points have no answer."""

    failures: list[PointFailure]
    """The first of them."""

    points: int
    """How many points, and numbers in each column."""


class Warning(Result):
    """A caveat about a result."""

    code: str
    """A name for programs: `dundurs_beta`, `large_contact`, `slip_direction`, `noisy_table`, `tolerance_not_met`,
    `units`, `interaction_neglected`, `load_curve_alone`, `elliptic_slip`, `bulk_shift_neglected`; of fits also
    `many_outliers`, `fill_values`, `one_sided_scan`, `short_scan`, `machine_compliance_unknown`,
    `partial_slip_only`, `beyond_gross_slip`, `first_branch_unknown`, `turns_as_sampled`, `quantised`,
    `not_coulomb`, `not_converged`.
    """

    message: str
    """An explanation for people."""


NAMES = [
    "Accuracy",
    "AccuracyReply",
    "AccuracyRow",
    "Axis2",
    "BestLoad",
    "ColumnPair",
    "Comparison",
    "ContactEstimate",
    "Cycle",
    "CyclePage",
    "CycleReply",
    "DisplacementPath",
    "EndEvent",
    "Estimate",
    "Fault",
    "Figures",
    "FileColumn",
    "FilePreview",
    "FitEstimate",
    "FitReply",
    "FitResidual",
    "FittedLoop",
    "FrettingReply",
    "FrictionEstimate",
    "FrictionReply",
    "FrictionWork",
    "Gap",
    "Harmonic",
    "HistoryItem",
    "HistoryPage",
    "Instant",
    "JobEndEvent",
    "JobList",
    "JobProgress",
    "JobReply",
    "JudgedReply",
    "Largest",
    "LineInFile",
    "LoadCurve",
    "LoopFileReply",
    "LoopInFile",
    "LoopPage",
    "MapInFile",
    "MoveReply",
    "NewSession",
    "NoiseLevels",
    "ObservationsReply",
    "ObservedForce",
    "ObservedMove",
    "Outcome",
    "PathReply",
    "Peak",
    "PlanarReply",
    "PlanarState",
    "PlanarStress",
    "PointFailure",
    "PointsInFile",
    "ProfileFitReply",
    "Protocol",
    "ProtocolReply",
    "Rating",
    "Reference",
    "RelaxReply",
    "Residual",
    "Resonance",
    "ResonancePoint",
    "RobustnessReply",
    "RowsLeftOut",
    "ScanFileReply",
    "ScanResidual",
    "SessionPage",
    "SessionReply",
    "SessionSummary",
    "SignRuns",
    "SimulateReply",
    "StartReply",
    "State",
    "StateEvent",
    "SteadyCycle",
    "Stress",
    "StressPath",
    "StressReply",
    "Subsurface",
    "SubsurfaceReply",
    "SweepReply",
    "Warning",
]
