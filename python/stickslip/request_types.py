"""The types of the members of requests: words, and objects as dictionaries.

Written by `tools/generate.py`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, TypeAlias, TypedDict, Union

from .bodies import Material
from .documents import Quantities, Quantity

Auto: TypeAlias = Literal["auto"]
"""The string that leaves a choice to the service."""
Axisymmetry: TypeAlias = Literal["tested", "assumed"]
"""What a scan says of the symmetry of its body."""
BodyName: TypeAlias = Literal["first", "second"]
"""One of the two bodies in contact."""
CriticalMethod: TypeAlias = Literal["point", "line"]
"""How a critical distance L_c is used along the inward normal."""
Direction: TypeAlias = Literal["x", "y", "z"]
"""An axis: x along the motion of the first body, z into the body asked for."""
EndReason: TypeAlias = Literal["deleted", "expired", "stopping", "revoked", "damaged", "failed"]
"""Why there are no more events."""
Field: TypeAlias = Literal["pressure", "shear", "slip", "displacement", "hoop"]
"""A quantity along the radius."""
FirstStroke: TypeAlias = Literal["given", "gross_slip", "partial", "stay"]
"""The beginning of a path."""
FirstTurn: TypeAlias = Literal["up", "down"]
"""Where cycles begin and end."""
FitParameter: TypeAlias = Literal["friction", "g_star", "e_star", "radius", "machine_compliance", "displacement_offset", "force_offset", "drift", "delay", "gain_drift", "shear_strength"]
"""A quantity of the contact or of the bench that a fit can determine."""
ForceUnit: TypeAlias = Literal["N", "mN", "uN", "kN"]
"""A unit of force."""
Hold: TypeAlias = Literal["indentation", "normal_force"]
"""The quantity that is held constant while a contact wears."""
JobState: TypeAlias = Literal["running", "done", "failed"]
"""The state of a job."""
LengthUnit: TypeAlias = Literal["m", "mm", "um", "nm"]
"""A unit of length."""
LoopStart: TypeAlias = Literal["steady", "virgin"]
"""How a record begins."""
MotionAxis: TypeAlias = Literal["x", "y"]
"""The axis of the tangential motion."""
NoFriction: TypeAlias = Literal["no_cycle", "not_measured", "too_many_moves", "not_determined", "not_estimated"]
"""Why the observations do not determine the friction."""
NoLife: TypeAlias = Literal["not_positive", "too_long", "too_short", "infinite_stress"]
"""Why a value has no life."""
PressureUnit: TypeAlias = Literal["largest", "mean"]
"""The pressure that stresses are compared with."""
ProtocolEnd: TypeAlias = Literal["displacement_zero", "force_zero", "free"]
"""Where a path ends."""
ProtocolKind: TypeAlias = Literal["linear", "equal_peaks", "minimax"]
"""The law of the amplitudes."""
Regime: TypeAlias = Literal["stick", "partial_slip", "gross_slip", "separated", "pulled_off"]
"""How much of the contact slipped in the last move."""
Rigid: TypeAlias = Literal["rigid"]
"""The name of a body that does not deform."""
ScanOrientation: TypeAlias = Literal["auto", "peak_up", "peak_down"]
"""Which way up a scan is."""
SolverKind: TypeAlias = Literal["exact", "springs", "rings"]
"""The solvers."""
Steps: TypeAlias = Literal["all", "last"]
"""Which states of a path to return."""
SubsurfaceField: TypeAlias = Literal["tensor", "principal", "von_mises", "max_shear", "hydrostatic"]
"""A quantity below the surface."""


class Adhesion(TypedDict):
    """How two surfaces adhere (Johnson, Kendall & Roberts)."""

    work: Quantity
    """The work of adhesion w, J/m²."""


class _AxisNeeded(TypedDict):
    pointer: str


class Axis(_AxisNeeded, total=False):
    """A number of the base and the values that it takes.

    `pointer`, and one key out of `linear`, `logarithmic` and `values`.
    """

    linear: Span | Mapping[str, Any]
    """Evenly spaced values."""
    logarithmic: Span | Mapping[str, Any]
    """Values with the same ratio from one to the next; both ends positive, or both negative."""
    name: str
    """The name of the column; if left out, the pointer."""
    values: Quantities
    """These values."""


class BestLoadStudy(TypedDict, total=False):
    """A search for the load that damps most."""

    points: int
    """Also ask for the work at this many loads, evenly spaced up to three times the best one."""


class Bulk(TypedDict, total=False):
    """A uniform stress, Pa, tension positive; a component left out is zero."""

    xx: Quantity
    """Normal stress along x."""
    xy: Quantity
    """Shear stress in the plane of x and y."""
    xz: Quantity
    """Shear stress in the plane of x and z."""
    yy: Quantity
    """Normal stress along y."""
    yz: Quantity
    """Shear stress in the plane of y and z."""
    zz: Quantity
    """Normal stress along z."""


class BulkCycle(TypedDict, total=False):
    """A bulk stress along x that varies with the cycle."""

    amplitude: Quantity
    """Its amplitude, Pa; zero if left out."""
    mean: Quantity
    """Its mean, Pa; zero if left out."""
    phase: Quantity
    """Its phase, degrees; zero if left out."""


class BulkPerForce(TypedDict):
    """A bulk stress along x in one of the bodies, in proportion to the tangential force and in phase with it."""

    body: BodyName
    """The body that carries the stress."""
    stress_per_force: Quantity
    """The stress over the tangential force, Pa/N; tension is positive."""


class _CentrePlaceNeeded(TypedDict):
    x: Quantity


class CentrePlace(_CentrePlaceNeeded, total=False):
    """The place of an axis."""

    y: Quantity
    """Along the columns of a map, m; if left out, 0, as for a line."""


class Criteria(TypedDict, total=False):
    """The criteria, at least one."""

    crossland: Weighted | Mapping[str, Any]
    """√J2a + α · the largest hydrostatic stress, Pa (Crossland 1956)."""
    dang_van: Weighted | Mapping[str, Any]
    """The largest of shear stress + α · hydrostatic stress, Pa (Dang Van 1973)."""
    fatemi_socie: FatemiSocie | Mapping[str, Any]
    """The largest amplitude of the shear strain, raised by the normal stress, a pure number (Fatemi & Socie 1988)."""
    findley: Findley | Mapping[str, Any]
    """The largest of shear amplitude + k · largest normal stress on a plane, Pa (Findley 1959)."""
    friction_work: SurfaceCriterion | Mapping[str, Any]
    """Friction work per area and cycle at the surface, J/m²."""
    ruiz: SurfaceCriterion | Mapping[str, Any]
    """Shear stress times slip at the surface, N/m (Ruiz, Boddington & Chen 1984)."""
    swt: StrainBased | Mapping[str, Any]
    """The largest of normal stress times amplitude of the normal strain on a plane, Pa (Smith, Watson & Topper 1970).
    """


class CriticalDistance(TypedDict):
    """The critical distance of the material (Taylor 2007)."""

    length: Quantity
    """The critical distance L_c, m: (threshold of the stress intensity range/range of the fatigue limit)²/π."""
    method: CriticalMethod
    """How the critical distance is used."""


class CycleDriveDisplacement(TypedDict):
    """Amplitude of the tangential displacement, m: of the indenter or, with `machine`, of the machine."""

    displacement: Quantity | Quantities
    """Amplitude of the tangential displacement, m: of the indenter or, with `machine`, of the machine."""


class CycleDriveForce(TypedDict):
    """Amplitude of the tangential force, N; below μ F_N."""

    force: Quantity | Quantities
    """Amplitude of the tangential force, N; below μ F_N."""


class CycleDriveTwist(TypedDict):
    """Amplitude of the angle of twist, rad: of the indenter or, with `machine`, of the machine."""

    twist: Quantity | Quantities
    """Amplitude of the angle of twist, rad: of the indenter or, with `machine`, of the machine."""


class CycleDriveTorque(TypedDict):
    """Amplitude of the torque, N·m; below that of gross slip."""

    torque: Quantity | Quantities
    """Amplitude of the torque, N·m; below that of gross slip."""


class _CyclicPathNeeded(TypedDict):
    count: int


class CyclicPath(_CyclicPathNeeded, total=False):
    """Equal cycles: exactly one of `displacement` and `force`, the amplitude.

    The path has 1 + n k moves, at most 100 000, for n cycles of k moves: the first from the present state to the
    first turn, then k each cycle, which ends at that turn again. Under a constant load the difference of the
    dissipated energies of two states k moves apart is the friction work of a cycle.
    """

    displacement: Quantity
    """Amplitude A of the tangential displacement of the indenter, m."""
    force: Quantity
    """Amplitude A of the tangential force, N. The magnitude of the force must stay below the friction limit μ F_N."""
    mean: Quantity
    """The value halfway between the turns, m or N; if left out, zero."""
    normal: NormalOscillation | Mapping[str, Any]
    """Oscillation of the load in the same cycles; if left out, the load is constant."""
    points_per_cycle: int
    """Moves per cycle k, an even number: the points of mean + A cos(2π t), or mean - A cos(2π t) from the lower turn,
    at t = j/k. If left out, the two turns alone under a constant load (points add recorded states between them),
    otherwise 64.
    """
    start: FirstTurn
    """The first turn."""


class _EllipseNeeded(TypedDict):
    radii: Quantities
    turns: int


class Ellipse(_EllipseNeeded, total=False):
    """Turns around the ellipse x = a cos θ, y = b sin(θ + phase), after a move to its beginning.

    Between the points of the ellipse the path follows the curve.
    """

    phase: Quantity
    """Phase, degrees: an upright ellipse at 0, a line at 90; if left out, 0."""
    steps_per_turn: int
    """Moves in each turn, each with its state; if left out, 64. The path has one more move, at most 100 000 in all."""


class _EqualPeaksNeeded(TypedDict):
    reversals: int


class EqualPeaks(_EqualPeaksNeeded, total=False):
    """A tangential oscillation that dies away by the law of equal peaks; it ends at displacement zero."""

    cutoff_radius: Quantity
    """Radius outside which the peaks are equal, m, up to the contact radius. For a profile whose slope jumps (the tip
    of a cone, the rim of a flat) it must lie outside the jump; if left out, it is then a tenth of the way from the
    jump to the edge, and zero for other profiles.
    """


class _FallingAmplitudeNeeded(TypedDict):
    reversals: int


class FallingAmplitude(_FallingAmplitudeNeeded, total=False):
    """A tangential oscillation that dies away; it ends at displacement zero."""

    amplitude: Quantity
    """Displacement of the first reversal, m; if left out, the displacement at which the contact just slips as a whole.
    """

FatemiSocie = TypedDict("FatemiSocie", {"k": "Quantity", "life": "StrainLife", "limit": "Quantity", "yield": "Quantity", "youngs_modulus": "Quantity"}, total=False)


class _FindleyNeeded(TypedDict):
    k: Quantity


class Findley(_FindleyNeeded, total=False):
    """Findley's criterion."""

    life: StressLife | Mapping[str, Any]
    """Number of cycles that the material withstands, from tests."""
    limit: Quantity
    """The value that the material withstands, Pa."""


class FitNoise(TypedDict, total=False):
    """Standard deviations of the noise of a measurement, in SI units."""

    displacement: Quantity
    """Of a displacement, m."""
    force: Quantity
    """Of a force, N."""


class FitUnits(TypedDict, total=False):
    """The units of measured loops."""

    displacement: LengthUnit
    """Unit of `displacement`."""
    force: ForceUnit
    """Unit of `force`."""


class _FrequencyResponseNeeded(TypedDict):
    drive_force: Quantity
    mass: Quantity


class FrequencyResponse(_FrequencyResponseNeeded, total=False):
    """A mass that only the contact holds, and a force on it that is a cosine of time."""

    frequencies: Quantities
    """Frequencies, Hz; if left out, 200 from 0.3 to 1.5 times the frequency of small oscillations."""


class FrettingMap(TypedDict):
    """Steady cycles under many loads: each amplitude under each of them."""

    normal_force: LoadSpan | Mapping[str, Any]
    """The loads."""


class Input(TypedDict, total=False):
    """A number of the base that is known with an uncertainty.

    `pointer` or `pointers`, and one of `normal` and `uniform`.
    """

    name: str
    """The name of the input; if left out, the first pointer."""
    normal: Normal | Mapping[str, Any]
    """A normal distribution."""
    pointer: str
    """JSON pointer to the number in the base."""
    pointers: Sequence[str]
    """JSON pointers to the places that have this number, such as the modulus of two bodies of one steel."""
    uniform: Uniform | Mapping[str, Any]
    """A uniform distribution."""


class _KnownValueNeeded(TypedDict):
    value: Quantity


class KnownValue(_KnownValueNeeded, total=False):
    """A value that is known from elsewhere."""

    standard_error: Quantity
    """Its standard error, in the same unit; zero, the default, holds the value fixed."""


class KnownValues(TypedDict, total=False):
    """Values known beforehand, by name."""

    delay: KnownValue | Mapping[str, Any]
    """Time by which the measured force follows the measured displacement, s."""
    displacement_offset: KnownValue | Mapping[str, Any]
    """Measured displacement at which the contact is not displaced, m."""
    drift: KnownValue | Mapping[str, Any]
    """Drift rate of the zero of the displacement, m/s."""
    e_star: KnownValue | Mapping[str, Any]
    """Reduced modulus E*, Pa."""
    force_offset: KnownValue | Mapping[str, Any]
    """Measured force at zero force on the contact, N."""
    friction: KnownValue | Mapping[str, Any]
    """Coulomb's coefficient of friction μ, a pure number."""
    g_star: KnownValue | Mapping[str, Any]
    """Reduced shear modulus G*, Pa."""
    gain_drift: KnownValue | Mapping[str, Any]
    """Rate at which the gain of the force drifts, relative to the gain at time zero, 1/s."""
    machine_compliance: KnownValue | Mapping[str, Any]
    """Compliance of the machine in series with the contact, m/N."""
    radius: KnownValue | Mapping[str, Any]
    """Radius of a sphere, m."""
    shear_strength: KnownValue | Mapping[str, Any]
    """Shear strength of the interface τ₀ beside friction, Pa."""


class LineScan(TypedDict):
    """A scan along a line through the axis, in any order."""

    x: Quantities
    """Places along the line, in the unit of `units.lateral`."""
    z: Quantities
    """Heights, one for each place, in the unit of `units.height`."""

LoadSpan = TypedDict("LoadSpan", {"count": "int", "from": "Quantity", "to": "Quantity"}, total=True)


class Machine(TypedDict):
    """A machine in series with the contact."""

    stiffness: Quantity
    """Its stiffness, N/m; with `twist` or `torque` N·m/rad."""


class MapScan(TypedDict):
    """A scan on a grid.

    The first height is at x = y = 0.
    """

    dx: Quantity
    """The distance of neighbours in a row, along x, in the unit of `units.lateral`."""
    dy: Quantity
    """The distance of rows, along y, in the unit of `units.lateral`."""
    z: Sequence[Quantities] | Quantities
    """The rows of heights, all of equal length, in the unit of `units.height`."""


class _MeasuredLoopNeeded(TypedDict):
    displacement: Quantities
    force: Quantities


class MeasuredLoop(_MeasuredLoopNeeded, total=False):
    """Force over displacement as measured on a bench, point by point in the order of time, under a constant load."""

    normal_force: Quantity
    """The load, N; if left out, that of the contact."""
    start: LoopStart
    """How the record begins; if left out, it is taken as `steady`, with a warning."""
    time: Quantities
    """Times, s, increasing, one for each point; only `drift`, `delay` and `gain_drift` need them."""
    weight: Quantity
    """Weight of the loop relative to the others, a pure number. Default: 1.0."""


class Move(TypedDict, total=False):
    """One move, straight to its targets.

    At most one tangential target (`displacement`, `force`, `twist` or `torque`) and one normal target
    (`indentation` or `normal_force`), at least one in all or a `duration`. Without a tangential target displacement
    and twist stay, without a normal one the indentation stays.
    """

    displacement: Quantity
    """Tangential displacement of the indenter, m."""
    duration: Quantity
    """How long the move takes, s, at an even pace; at once if left out. Only of bodies with `prony`. Without a target
    it waits.
    """
    force: Quantity
    """Tangential force, N. Its magnitude must stay below the friction limit μ F_N."""
    indentation: Quantity
    """Indentation, m; below zero the bodies are apart and the slip history is lost."""
    normal_force: Quantity
    """Normal force, N; below zero, if it is no increment, only with `adhesion`."""
    relative: bool
    """Whether the numbers are increments to the present state, instead of the targets themselves."""
    torque: Quantity
    """Torque about the axis of the contact, N·m, in place of `twist`; its magnitude must stay below that of gross
    slip.
    """
    twist: Quantity
    """Angle of twist about the axis of the contact, rad, since it last touched, in place of `displacement` or `force`.
    """


class NamedOutput(TypedDict):
    """A number of the reply to `POST /simulate`, and the name of its column."""

    name: str
    """The name of the column."""
    pointer: str
    """JSON pointer to the number in the reply."""


class _NormalNeeded(TypedDict):
    standard_uncertainty: Quantity


class Normal(_NormalNeeded, total=False):
    """A normal distribution."""

    mean: Quantity
    """The mean, in the unit of the field; if left out, the number of the base."""


class NormalOscillation(TypedDict, total=False):
    """An oscillation of the load.

    Its value at the beginning + amplitude cos(2π t + phase), with the t of the cycles. Exactly one of
    `normal_force` and `indentation`, the amplitude. Moves in displacement and indentation are exact; those with a
    force are followed to the tolerance.
    """

    indentation: Quantity
    """Amplitude of the indentation, m. Below zero the bodies are apart and the slip history is lost."""
    normal_force: Quantity
    """Amplitude of the normal force, N, at most the normal force at the beginning."""
    phase: Quantity
    """Phase, degrees; if left out, zero."""


class _ObservationNeeded(TypedDict):
    displacement: Quantity
    force: Quantity


class Observation(_ObservationNeeded, total=False):
    """A displacement and the force that was measured there."""

    at: str
    """When it was measured (RFC 3339, from 1678 to 2261); not before the measurement that precedes it."""


class _PathMovesNeeded(TypedDict):
    moves: Sequence[Move | Mapping[str, Any]]


class PathMoves(_PathMovesNeeded, total=False):
    """Moves, one after the other."""

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class _PathDisplacementNeeded(TypedDict):
    displacement: Quantities


class PathDisplacement(_PathDisplacementNeeded, total=False):
    """Tangential displacements of the indenter, m, one move each."""

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class _PathForceNeeded(TypedDict):
    force: Quantities


class PathForce(_PathForceNeeded, total=False):
    """Tangential forces, N, one move each."""

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class _PathFallingAmplitudeNeeded(TypedDict):
    falling_amplitude: FallingAmplitude | Mapping[str, Any]


class PathFallingAmplitude(_PathFallingAmplitudeNeeded, total=False):
    """Back and forth with an amplitude that falls linearly to zero (eq.

    20 of the paper).
    """

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class _PathEqualPeaksNeeded(TypedDict):
    equal_peaks: EqualPeaks | Mapping[str, Any]


class PathEqualPeaks(_PathEqualPeaksNeeded, total=False):
    """Back and forth from gross slip to rest.

    With the amplitudes that leave equal peaks of shear stress on the profile of the contact.
    """

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class _PathCyclesNeeded(TypedDict):
    cycles: CyclicPath | Mapping[str, Any]


class PathCycles(_PathCyclesNeeded, total=False):
    """Equal cycles about a mean, under a constant load or one that oscillates too."""

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class _PathTwistNeeded(TypedDict):
    twist: Quantities


class PathTwist(_PathTwistNeeded, total=False):
    """Angles of twist, rad, one move each."""

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class _PathTorqueNeeded(TypedDict):
    torque: Quantities


class PathTorque(_PathTorqueNeeded, total=False):
    """Torques, N·m, one move each."""

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class PointScan(TypedDict):
    """Heights at places, in any order."""

    x: Quantities
    """Places along x, in the unit of `units.lateral`."""
    y: Quantities
    """Places along y, one for each x, in the unit of `units.lateral`."""
    z: Quantities
    """Heights, one for each place, in the unit of `units.height`."""


class PreloadNormalForce(TypedDict):
    """Normal force, N; below zero only with `adhesion`."""

    normal_force: Quantity
    """Normal force, N; below zero only with `adhesion`."""


class PreloadIndentation(TypedDict):
    """Indentation, m; below zero only with `adhesion`."""

    indentation: Quantity
    """Indentation, m; below zero only with `adhesion`."""


class PreloadContactRadius(TypedDict):
    """Contact radius, m."""

    contact_radius: Quantity
    """Contact radius, m."""


class PronyTerm(TypedDict):
    """A term of a Prony series."""

    ratio: Quantity
    """By how much of the instantaneous modulus it relaxes, a pure number; all of them add up to 1 at most, which is a
    fluid.
    """
    time: Quantity
    """Its relaxation time, s."""


class ProtocolStartDisplacement(TypedDict):
    """This displacement of a contact that has never moved, m; the path begins with it."""

    displacement: Quantity
    """This displacement of a contact that has never moved, m; the path begins with it."""


class ProtocolStartContactId(TypedDict):
    """The present state of the contact of this identifier, whatever its history."""

    contact_id: str
    """The present state of the contact of this identifier, whatever its history."""


class Rings(TypedDict):
    """Rings of constant traction, for motion in the plane."""

    count: int
    """Number of rings across the radius of the largest contact."""


class Robustness(TypedDict, total=False):
    """Errors with which a protocol is followed.

    It is tried many times, each time with different random errors.
    """

    amplitude_error: Quantity
    """Standard deviation of each displacement, relative to itself, a pure number; normally distributed."""
    friction_error: Quantity
    """Largest relative error of the coefficient of friction, up or down, a pure number; uniformly distributed. Not for
    a start from a contact on the server, whose history belongs to its own coefficient.
    """
    samples: int
    """Number of trials."""
    seed: int
    """Seed of the random numbers: the same seed gives the same reply."""


class ScanDataLine(TypedDict):
    """A profile along a line through the axis."""

    line: LineScan | Mapping[str, Any]
    """A profile along a line through the axis."""


class ScanDataMap(TypedDict):
    """Heights on a grid."""

    map: MapScan | Mapping[str, Any]
    """Heights on a grid."""


class ScanDataPoints(TypedDict):
    """Heights at arbitrary places."""

    points: PointScan | Mapping[str, Any]
    """Heights at arbitrary places."""


class ScanLoad(TypedDict):
    """A load on the body that was scanned."""

    friction: Quantity
    """Coulomb's coefficient of friction μ, a pure number."""
    material: Material
    """The elastic constants."""
    preload: Preload
    """The normal load."""


class ScanUnits(TypedDict, total=False):
    """The units of a scan."""

    height: LengthUnit
    """Unit of z."""
    lateral: LengthUnit
    """Unit of x and y, and of dx and dy."""


class SimulatedMove(TypedDict, total=False):
    """One move, straight to its targets.

    At most one tangential target (`displacement`, `force`, `twist` or `torque`) and one normal target
    (`indentation` or `normal_force`), at least one in all or a `duration`. Without a tangential target displacement
    and twist stay, without a normal one the indentation stays. A pair [x, y] is a target in the plane.
    """

    displacement: Components
    """Tangential displacement of the indenter, m, along x or [x, y]."""
    duration: Quantity
    """How long the move takes, s, at an even pace; at once if left out. Only of bodies with `prony`, along a line.
    Without a target it waits.
    """
    force: Components
    """Tangential force, N, along x or [x, y]. Its magnitude must stay below the friction limit μ F_N."""
    indentation: Quantity
    """Indentation, m; below zero the bodies are apart and the slip history is lost."""
    normal_force: Quantity
    """Normal force, N; below zero, if it is no increment, only with `adhesion`."""
    relative: bool
    """Whether the numbers are increments to the present state, instead of the targets themselves."""
    torque: Quantity
    """Torque about the axis of the contact, N·m, in place of `twist`; its magnitude must stay below that of gross
    slip.
    """
    twist: Quantity
    """Angle of twist about the axis of the contact, rad, since it last touched, in place of `displacement` or `force`.
    """


class _SimulatedPathMovesNeeded(TypedDict):
    moves: Sequence[SimulatedMove | Mapping[str, Any]]


class SimulatedPathMoves(_SimulatedPathMovesNeeded, total=False):
    """Moves, one after the other."""

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class _SimulatedPathDisplacementNeeded(TypedDict):
    displacement: Quantities


class SimulatedPathDisplacement(_SimulatedPathDisplacementNeeded, total=False):
    """Tangential displacements of the indenter, m, one move each."""

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class _SimulatedPathForceNeeded(TypedDict):
    force: Quantities


class SimulatedPathForce(_SimulatedPathForceNeeded, total=False):
    """Tangential forces, N, one move each."""

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class _SimulatedPathFallingAmplitudeNeeded(TypedDict):
    falling_amplitude: FallingAmplitude | Mapping[str, Any]


class SimulatedPathFallingAmplitude(_SimulatedPathFallingAmplitudeNeeded, total=False):
    """Back and forth with an amplitude that falls linearly to zero (eq.

    20 of the paper).
    """

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class _SimulatedPathEqualPeaksNeeded(TypedDict):
    equal_peaks: EqualPeaks | Mapping[str, Any]


class SimulatedPathEqualPeaks(_SimulatedPathEqualPeaksNeeded, total=False):
    """Back and forth from gross slip to rest.

    With the amplitudes that leave equal peaks of shear stress on the profile of the contact.
    """

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class _SimulatedPathCyclesNeeded(TypedDict):
    cycles: CyclicPath | Mapping[str, Any]


class SimulatedPathCycles(_SimulatedPathCyclesNeeded, total=False):
    """Equal cycles about a mean, under a constant load or one that oscillates too."""

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class _SimulatedPathEllipseNeeded(TypedDict):
    ellipse: Ellipse | Mapping[str, Any]


class SimulatedPathEllipse(_SimulatedPathEllipseNeeded, total=False):
    """Turns around an ellipse."""

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class _SimulatedPathTwistNeeded(TypedDict):
    twist: Quantities


class SimulatedPathTwist(_SimulatedPathTwistNeeded, total=False):
    """Angles of twist, rad, one move each."""

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class _SimulatedPathTorqueNeeded(TypedDict):
    torque: Quantities


class SimulatedPathTorque(_SimulatedPathTorqueNeeded, total=False):
    """Torques, N·m, one move each."""

    duration: Quantity
    """How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`."""


class SmoothingNoise(TypedDict):
    """The standard deviation of the noise of a height, m."""

    noise: Quantity
    """The standard deviation of the noise of a height, m."""


class SmoothingKnots(TypedDict):
    """This many intervals of constant curvature, without a penalty on their differences."""

    knots: int
    """This many intervals of constant curvature, without a penalty on their differences."""


class SnCurve(TypedDict):
    """An S-N curve of the values of a criterion."""

    cycles: Quantity
    """Number of cycles that the material withstands at `reference`, a pure number."""
    exponent: Quantity
    """The exponent k, a pure number: the number of cycles falls as value^(−k)."""
    reference: Quantity
    """A value, in the unit of the criterion."""


class SolverSprings(TypedDict):
    """The spring foundation of the paper: a reference for comparison, slower and approximate.

    It follows a tangential force only at constant indentation, and a normal force only without a tangential target
    (else `unsupported_move`).
    """

    springs: Springs | Mapping[str, Any]
    """The spring foundation of the paper: a reference for comparison, slower and approximate. It follows a tangential
    force only at constant indentation, and a normal force only without a tangential target (else
    `unsupported_move`).
    """


class SolverRings(TypedDict):
    """Rings: the approximate solver for motion in the plane, which also follows motion along a line.

    Without a number, a path with pairs that leaves its first line is followed by as many rings as the tolerance
    needs.
    """

    rings: Rings | Mapping[str, Any]
    """Rings: the approximate solver for motion in the plane, which also follows motion along a line. Without a number,
    a path with pairs that leaves its first line is followed by as many rings as the tolerance needs.
    """

Span = TypedDict("Span", {"count": "int", "from": "Quantity", "to": "Quantity"}, total=True)


class Springs(TypedDict):
    """The spring foundation."""

    count: int
    """Number of springs across the diameter of the contact."""


class StrainBased(TypedDict, total=False):
    """A criterion that needs strains."""

    life: StrainLife
    """Number of cycles that the material withstands, from tests."""
    limit: Quantity
    """The value that the material withstands, Pa."""
    youngs_modulus: Quantity
    """Young's modulus of the body, Pa; it may be left out if the material has `bodies`."""


class StrainLifeSN(TypedDict):
    """Cycles = `cycles` · (value/`reference`)^(−`exponent`) (Basquin 1910)."""

    s_n: SnCurve | Mapping[str, Any]
    """Cycles = `cycles` · (value/`reference`)^(−`exponent`) (Basquin 1910)."""


class StrainLifeStrainLife(TypedDict):
    """For `swt`: value = (σf'²/E) (2N)^(2b) + σf' εf' (2N)^(b + c); for `fatemi_socie`.

    Value = (τf'/G) (2N)^b + γf' (2N)^c.
    """

    strain_life: StrainLifeCurve | Mapping[str, Any]
    """For `swt`: value = (σf'²/E) (2N)^(2b) + σf' εf' (2N)^(b + c); for `fatemi_socie`: value = (τf'/G) (2N)^b + γf'
    (2N)^c.
    """


class StrainLifeCurve(TypedDict):
    """The constants of Basquin, Coffin and Manson.

    Of normal stress and strain for `swt`, of shear stress and shear strain for `fatemi_socie`.
    """

    ductility: Quantity
    """Fatigue ductility coefficient, a pure number: εf' or, of shear strain, γf'."""
    ductility_exponent: Quantity
    """Fatigue ductility exponent c, a pure number."""
    strength: Quantity
    """Fatigue strength coefficient, Pa: σf' or, of shear stress, τf'."""
    strength_exponent: Quantity
    """Fatigue strength exponent b, a pure number."""


class StressLife(TypedDict):
    """The life of a criterion: an S-N curve."""

    s_n: SnCurve | Mapping[str, Any]
    """Cycles = `cycles` · (value/`reference`)^(−`exponent`) (Basquin 1910)."""


class StressRequest(TypedDict, total=False):
    """Where stresses are asked for.

    Exactly one of `points` and `radii` (for a line contact `x`), and which `fields`.
    """

    fields: Sequence[Field]
    """Which fields are computed; if left out, `pressure` and `shear`."""
    points: int
    """Number of radii, evenly spaced from the centre to the edge of the contact, both included; for a line contact
    from the edge at −a to the edge at a.
    """
    radii: Quantities
    """Radii in a round contact, m; outside the contact the stresses are zero."""
    x: Quantities
    """Places along x in a line contact, m."""

SubsurfaceLine = TypedDict("SubsurfaceLine", {"count": "int", "from": "Quantities", "to": "Quantities"}, total=True)


class _SubsurfacePlaneNeeded(TypedDict):
    normal: Direction
    offset: Quantity


class SubsurfacePlane(_SubsurfacePlaneNeeded, total=False):
    """A grid in a plane of constant x, y or z.

    Each of the other two coordinates is `[from, to, count]`, m, both ends included.
    """

    x: Quantities
    """Range of x as `[from, to, count]`; left out where `normal` is x."""
    y: Quantities
    """Range of y as `[from, to, count]`; left out where `normal` is y."""
    z: Quantities
    """Range of z as `[from, to, count]`; left out where `normal` is z."""


class _SubsurfaceRequestNeeded(TypedDict):
    body: BodyName


class SubsurfaceRequest(_SubsurfaceRequestNeeded, total=False):
    """The stress in one of the bodies, tension positive.

    X along the motion of the first body, which carries the profile, z into the body asked for, the origin on the
    axis of the contact. Exactly one of `points`, `line`, `plane` and `surface` says where.
    """

    bulk: Bulk | Mapping[str, Any]
    """A uniform stress of the body that is added, Pa. In this model it does not shift the stick zone."""
    fields: Sequence[SubsurfaceField]
    """Which fields are computed; if left out, `tensor`."""
    line: SubsurfaceLine | Mapping[str, Any]
    """A straight line."""
    plane: SubsurfacePlane | Mapping[str, Any]
    """A grid in a plane."""
    points: Sequence[Quantities] | Quantities
    """A list of x, y, z, m, with z not negative."""
    poisson_ratio: Quantity
    """Poisson's ratio of the body, a pure number; it may be left out if the material has `bodies`."""
    surface: SubsurfaceSurface | Mapping[str, Any]
    """A grid on the surface."""


class SubsurfaceSurface(TypedDict):
    """A grid on the surface, z = 0.

    Each coordinate is `[from, to, count]`, m, both ends included.
    """

    x: Quantities
    """Range of x as `[from, to, count]`."""
    y: Quantities
    """Range of y as `[from, to, count]`."""


class SurfaceCriterion(TypedDict, total=False):
    """A quantity that is defined on the surface."""

    life: StressLife | Mapping[str, Any]
    """Number of cycles that the material withstands, from tests."""
    limit: Quantity
    """The value that the material withstands."""

Uniform = TypedDict("Uniform", {"from": "Quantity", "to": "Quantity"}, total=True)


class WearDrive(TypedDict):
    """The cycles that wear a contact."""

    displacement: Quantity
    """Amplitude of the tangential displacement, m; below that of gross slip."""


class _WeightedNeeded(TypedDict):
    alpha: Quantity


class Weighted(_WeightedNeeded, total=False):
    """A criterion with a weight of the hydrostatic stress."""

    life: StressLife | Mapping[str, Any]
    """Number of cycles that the material withstands, from tests."""
    limit: Quantity
    """The value that the material withstands, Pa."""


class WorkDensity(TypedDict, total=False):
    """Where the friction work per area is asked for: exactly one of `points` and `radii` (for a line contact `x`)."""

    points: int
    """Number of radii, evenly spaced from the centre to the edge of the contact, both included; for a line contact
    from the edge at −a to the edge at a.
    """
    radii: Quantities
    """Radii, m; outside the contact there is no work."""
    x: Quantities
    """Places along x in a line contact, m."""


class DefinitionMembers(TypedDict, total=False):
    """The preload of a contact, of which one number is given, and what may be left out."""

    normal_force: Quantity | None
    """Normal force, N; below zero only with `adhesion`."""
    indentation: Quantity | None
    """Indentation, m; below zero only with `adhesion`."""
    contact_radius: Quantity | None
    """Contact radius, m."""
    adhesion: Adhesion | Mapping[str, Any] | None
    """Adhesion of the JKR kind; only with `friction` 0. Load and preload may then pull."""
    bulk: BulkPerForce | Mapping[str, Any] | None
    """A bulk stress along x in proportion to the tangential force, which shifts the stick zone: only with a `cylinder`
    and under a constant load.
    """
    prony: Sequence[PronyTerm | Mapping[str, Any]] | None
    """The memory of the bodies, a Prony series of 1 to 16 terms: their moduli are those of the instant, and relax as
    R(t) = 1 − Σ ratio (1 − exp(−t/time)). Both bodies are alike, or one is rigid. The preload is put on at once at
    time 0, and moves have a `duration`.
    """
    shear_strength: Quantity | None
    """Shear strength τ₀ of the interface, Pa: shear stress stays below τ₀ + μp. Zero if left out; otherwise the load
    must stay constant from the first tangential move on.
    """

Centre: TypeAlias = Union[
    "Auto",
    "CentrePlace | Mapping[str, Any]",
    "Mapping[str, Any]",
]
"""Where the axis is: the string `"auto"`, or a place."""
Components: TypeAlias = Union[
    "Quantity",
    "Quantities",
    "Mapping[str, Any]",
]
"""A number along x, or a pair [x, y]."""
CycleDrive: TypeAlias = Union[
    "CycleDriveDisplacement",
    "CycleDriveForce",
    "CycleDriveTwist",
    "CycleDriveTorque",
    "Mapping[str, Any]",
]
"""What is prescribed as a cosine, one key: its amplitude, or a list of amplitudes with a cycle for each."""
Output: TypeAlias = Union[
    "str",
    "NamedOutput | Mapping[str, Any]",
    "Mapping[str, Any]",
]
"""A number of the reply to `POST /simulate`: a JSON pointer, or an object that names its column too."""
Path: TypeAlias = Union[
    "PathMoves",
    "PathDisplacement",
    "PathForce",
    "PathFallingAmplitude",
    "PathEqualPeaks",
    "PathCycles",
    "PathTwist",
    "PathTorque",
    "Mapping[str, Any]",
]
"""A path, one key: a list of moves, or a short form of one."""
Preload: TypeAlias = Union[
    "PreloadNormalForce",
    "PreloadIndentation",
    "PreloadContactRadius",
    "Mapping[str, Any]",
]
"""The normal load that the contact starts with, one key. Zero is a contact just touching."""
ProtocolStart: TypeAlias = Union[
    "ProtocolStartDisplacement",
    "ProtocolStartContactId",
    "Mapping[str, Any]",
]
"""The state that the reversals begin from, one key."""
ScanData: TypeAlias = Union[
    "ScanDataLine",
    "ScanDataMap",
    "ScanDataPoints",
    "Mapping[str, Any]",
]
"""Heights with their places, one key. A height of `null` is missing."""
SimulatedPath: TypeAlias = Union[
    "SimulatedPathMoves",
    "SimulatedPathDisplacement",
    "SimulatedPathForce",
    "SimulatedPathFallingAmplitude",
    "SimulatedPathEqualPeaks",
    "SimulatedPathCycles",
    "SimulatedPathEllipse",
    "SimulatedPathTwist",
    "SimulatedPathTorque",
    "Mapping[str, Any]",
]
"""A path, one key: a list of moves, or a short form of one."""
Smoothing: TypeAlias = Union[
    "Literal[\"auto\"]",
    "SmoothingNoise",
    "SmoothingKnots",
    "Mapping[str, Any]",
]
"""How the smoothness of a profile is chosen, one key or `"auto"`."""
Solver: TypeAlias = Union[
    "Literal[\"exact\"]",
    "SolverSprings",
    "SolverRings",
    "Mapping[str, Any]",
]
"""A solver: the string `"exact"`, or an object with one key."""
StrainLife: TypeAlias = Union[
    "StrainLifeSN",
    "StrainLifeStrainLife",
    "Mapping[str, Any]",
]
"""The life of a criterion with strains: an S-N curve, or the strain-life curve of the criterion."""
