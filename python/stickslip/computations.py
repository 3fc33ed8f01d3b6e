"""The computations as methods with their keywords. Written by `tools/generate.py`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, overload

from . import request_types as types
from . import results
from .bodies import ContactLike
from .documents import Document, Quantities, Quantity
from .keywords import explained
from .profiles import Line, Plane, Surface
from .requests import LoopLike, ScanLike
from .result import T


@explained
class Computations(ABC):
    """The computations, which take a contact at the preload of its definition."""

    @abstractmethod
    def _answer(self, kind: type[T], name: str, given: Document, parts: dict[str, Document]) -> T:
        """The reply to the members of a request, some of which are parts of one member."""

    def accuracy(
        self,
        contact: ContactLike,
        displacement: Quantities | None = None,
        *,
        duration: Quantity | None = None,
        moves: Sequence[types.SimulatedMove | Mapping[str, Any]] | None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        ellipse: types.Ellipse | Mapping[str, Any] | None = None,
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        path: types.SimulatedPath | None = None,
        solvers: Sequence[types.Solver] | None = None,
        stress: int | types.StressRequest | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.AccuracyReply:
        """Compare solvers.

        Follows a path from the preloaded contact with each of the solvers, and compares the forces along it and the
        shear stresses at its end with a reference: the exact solver, refined where moves are curved, or in the plane
        more rings in smaller steps. This shows what a coarser model would do to your own numbers. The row of a solver
        that cannot follow the path gives the reason. The springs of all solvers together, times moves and stress
        points, are limited as in one simulation. Nothing is stored.

        The contact is taken at the preload of its definition, as if it was never moved: the history and the present
        load of a `Contact` that has been moved do not matter.

        Parameters
        ----------
        contact : ContactLike
            The contact.
        displacement : Quantities
            Tangential displacements of the indenter, m, one move each.
        duration : Quantity
            How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`.
        moves : Sequence[SimulatedMove | dict]
            Moves, one after the other.
        force : Quantities
            Tangential forces, N, one move each.
        falling_amplitude : int | FallingAmplitude | dict
            Back and forth with an amplitude that falls linearly to zero (eq. 20 of the paper). A number alone is its
            `reversals`. Needs `reversals`; may have `amplitude`.
        equal_peaks : int | EqualPeaks | dict
            Back and forth from gross slip to rest, with the amplitudes that leave equal peaks of shear stress on the
            profile of the contact. A number alone is its `reversals`. Needs `reversals`; may have `cutoff_radius`.
        cycles : CyclicPath | dict
            Equal cycles about a mean, under a constant load or one that oscillates too. Needs `count`; may have
            `displacement`, `force`, `mean`, `normal`, `points_per_cycle`, `start`.
        ellipse : Ellipse | dict
            Turns around an ellipse. Needs `radii`, `turns`; may have `phase`, `steps_per_turn`.
        twist : Quantities
            Angles of twist, rad, one move each.
        torque : Quantities
            Torques, N·m, one move each.
        path : SimulatedPath
            The path, along a line or in the plane.
        solvers : Sequence[Solver]
            The solvers, in the order of the rows; if left out, the exact one and 10, 100, 1000 and 10 000 springs. In
            the plane only rings; if left out, 10, 20, 40 and 80.
        stress : int | StressRequest | dict
            Where the shear stress at the end of the path is compared; if left out, at 200 radii evenly spaced from the
            centre to the edge. `fields`, if given, must include `shear`; only the shear stress is compared. A number
            alone is its `points`. May have `fields`, `points`, `radii`, `x`.
        tolerance : Quantity
            Tolerance of results that are not exact, relative to μ F_N, a pure number. The reference is computed to a
            sixteenth of this. In the plane it determines the steps and is at least 1e-5; if left out, 1e-3. Default:
            1e-10.

        Returns
        -------
        AccuracyReply
            The time and the error of each solver.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> reply = ss.accuracy(
        ...     contact=ss.Definition(ss.Sphere(radius=0.01), [ss.Body(2.1e+11, 0.3), ss.Body(2.1e+11, 0.3)], 0.3,
        ...         normal_force=10.0),
        ...     falling_amplitude={'reversals': 20},
        ... )
        """
        given: Document = {
            "contact": contact,
            "path": path,
            "solvers": solvers,
            "stress": stress,
            "tolerance": tolerance,
        }
        parts: dict[str, Document] = {
            "path": {
                "duration": duration,
                "moves": moves,
                "displacement": displacement,
                "force": force,
                "falling_amplitude": falling_amplitude,
                "equal_peaks": equal_peaks,
                "cycles": cycles,
                "ellipse": ellipse,
                "twist": twist,
                "torque": torque,
            },
        }
        return self._answer(results.AccuracyReply, "/accuracy", given, parts)

    def cycle(
        self,
        contact: ContactLike,
        displacement: Quantity | Quantities | None = None,
        *,
        force: Quantity | Quantities | None = None,
        twist: Quantity | Quantities | None = None,
        torque: Quantity | Quantities | None = None,
        best_load: int | bool | types.BestLoadStudy | Mapping[str, Any] | None = None,
        frequency: Quantity | Quantities | None = None,
        frequency_response: types.FrequencyResponse | Mapping[str, Any] | None = None,
        harmonics: int | None = None,
        machine: Quantity | types.Machine | Mapping[str, Any] | None = None,
        map: types.FrettingMap | Mapping[str, Any] | None = None,
        normal: types.NormalOscillation | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
        work_density: int | types.WorkDensity | Mapping[str, Any] | None = None,
    ) -> results.CycleReply:
        """Compute steady cycles.

        Moves a contact back and forth at constant load until every cycle repeats the one before it, in closed form: a
        displacement or a force that is a cosine, directly or through a machine of finite stiffness. Returns work,
        stiffness, loss factor and slip for each amplitude and, if asked for, the harmonics and the friction work per
        area, or the same cycles under many loads. Of bodies with memory, the cycles at each frequency. Nothing is
        stored.

        The contact is taken at the preload of its definition, as if it was never moved: the history and the present
        load of a `Contact` that has been moved do not matter.

        Parameters
        ----------
        contact : ContactLike
            The contact.
        displacement : Quantity | Quantities
            Amplitude of the tangential displacement, m: of the indenter or, with `machine`, of the machine.
        force : Quantity | Quantities
            Amplitude of the tangential force, N; below μ F_N.
        twist : Quantity | Quantities
            Amplitude of the angle of twist, rad: of the indenter or, with `machine`, of the machine.
        torque : Quantity | Quantities
            Amplitude of the torque, N·m; below that of gross slip.
        best_load : int | bool | BestLoadStudy | dict
            Ask for the normal force under which each amplitude does the most friction work; with at most 100
            amplitudes, not with `normal`. A number alone is its `points`. May have `points`.
        frequency : Quantity | Quantities
            Frequency, Hz, or a list of frequencies with the cycles of all amplitudes for each: of bodies with `prony`,
            whose cycles depend on it. The load has then been held for long: the normal force of a preload, or its
            indentation. Only a displacement is driven, and of the other options only `harmonics` is allowed. At most
            100 000 cycles.
        frequency_response : FrequencyResponse | dict
            Ask for the oscillations of a mass that only the contact holds and a force drives. Not with `machine` or
            `normal`. Needs `drive_force`, `mass`; may have `frequencies`.
        harmonics : int
            Ask for the harmonics from the first to this one.
        machine : Quantity | Machine | dict
            A machine in series with the contact: an amplitude of displacement or twist is then that of the machine. A
            number alone is its `stiffness`. Needs `stiffness`.
        map : FrettingMap | dict
            Repeat all amplitudes under many loads, whatever the preload of the contact: a fretting map. Of the other
            options only `machine` is allowed. At most 100 000 cycles. Needs `normal_force`.
        normal : NormalOscillation | dict
            The normal load oscillates too, about that of the contact. May have `indentation`, `normal_force`, `phase`.
        tolerance : Quantity
            Tolerance, a pure number: of cycles with `normal` relative to μ F_N and to the work of that force, of
            `frequency_response` relative to the amplitude. Default: 1e-6.
        work_density : int | WorkDensity | dict
            Ask for the friction work per area. Radii times amplitudes are at most 200 000. Not with `normal`. A number
            alone is its `points`. May have `points`, `radii`, `x`.

        Returns
        -------
        CycleReply
            Steady cycles, one for each amplitude.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> reply = ss.cycle(
        ...     contact=ss.Definition(ss.Sphere(radius=0.01), [ss.Body(2.1e+11, 0.3), ss.Body(2.1e+11, 0.3)], 0.3,
        ...         normal_force=10.0),
        ...     displacement=[5e-08, 1e-07, 2e-07],
        ...     harmonics=1,
        ... )
        """
        given: Document = {
            "best_load": best_load,
            "contact": contact,
            "frequency": frequency,
            "frequency_response": frequency_response,
            "harmonics": harmonics,
            "machine": machine,
            "map": map,
            "normal": normal,
            "tolerance": tolerance,
            "work_density": work_density,
        }
        parts: dict[str, Document] = {
            "drive": {
                "displacement": displacement,
                "force": force,
                "twist": twist,
                "torque": torque,
            },
        }
        return self._answer(results.CycleReply, "/cycle", given, parts)

    def fit(
        self,
        contact: ContactLike,
        loops: LoopLike | Sequence[LoopLike],
        *,
        free: Sequence[types.FitParameter] | None = None,
        known: bool | types.KnownValues | Mapping[str, Any] | None = None,
        noise: bool | types.FitNoise | Mapping[str, Any] | None = None,
        units: bool | types.FitUnits | Mapping[str, Any] | None = None,
        start: types.LoopStart | None = None,
    ) -> results.FitReply:
        """Fit friction and stiffness to measured loops.

        Finds the turning points of measured loops of force over displacement, and the coefficient of friction, the
        moduli, the compliance of the machine, the offsets and the drift that fit best. States what the loops determine,
        what they determine only in combination, and within which intervals. Nothing is stored.

        The contact is taken at the preload of its definition, as if it was never moved: the history and the present
        load of a `Contact` that has been moved do not matter. A loop may be a file that was read, a table with named
        columns, or arrays of displacement and force. `start` states how all of them begin.

        Parameters
        ----------
        contact : ContactLike
            The contact as far as it is known. Free quantities start from their values here.
        loops : LoopLike | Sequence[LoopLike]
            The measured loops, which are fitted together. A loop is a file or its path, a table, a document, or arrays
            of displacement and force.
        free : Sequence[FitParameter]
            The quantities that the fit determines. If left out, the loops decide: friction, stiffness and force offset,
            the compliance of the machine if a loop reaches gross slip, and what the score tests show to differ from
            zero. If left out: friction, g_star and force_offset. One of 'friction', 'g_star', 'e_star', 'radius',
            'machine_compliance', 'displacement_offset', 'force_offset', 'drift', 'delay', 'gain_drift',
            'shear_strength'.
        known : bool | KnownValues | dict
            Values known from elsewhere. One with a standard error takes part in the fit, whether it is free or not. A
            number alone is a value that is held fixed. May have `delay`, `displacement_offset`, `drift`, `e_star`,
            `force_offset`, `friction`, `g_star`, `gain_drift`, `machine_compliance`, `radius`, `shear_strength`.
        noise : bool | FitNoise | dict
            The noise of the measured numbers; if left out, it is estimated from the loops. May have `displacement`,
            `force`.
        units : bool | FitUnits | dict
            The units of `displacement` and `force` of the loops; if left out, SI. Everything else is in SI units. May
            have `displacement`, `force`.
        start : LoopStart
            How all loops begin.

        Returns
        -------
        FitReply
            The quantities that the loops determine, and the ones that they leave undetermined.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> reply = ss.fit(
        ...     contact=ss.Definition(ss.Sphere(radius=0.01), [ss.Body(2.1e+11, 0.3), ss.Body(2.1e+11, 0.3)], 0.2,
        ...         normal_force=10.0),
        ...     loops=[{'displacement': [0.41, 0.3416, 0.2734, 0.2049, 0.1367, 0.0683, 0.0, -0.0683, -0.1367,
        ...         -0.2049, -0.2734, -0.3416, -0.41, -0.3416, -0.2734, -0.2049, -0.1367, -0.0683, 0.0, 0.0683, 0.1367,
        ...         0.2049, 0.2734, 0.3416, 0.41], 'force': [3.001, 1.923, 0.888, -0.025, -0.881, -1.625, -2.231,
        ...         -2.733, -3.0, -2.993, -2.989, -3.0, -2.994, -1.921, -0.901, 0.031, 0.865, 1.607, 2.234, 2.732,
        ...         2.998, 2.997, 3.001, 2.987, 2.999], 'start': 'steady'}],
        ...     free=['friction', 'g_star'],
        ...     known={'machine_compliance': {'value': 0.0}},
        ...     units={'displacement': 'um', 'force': 'N'},
        ... )
        """
        given: Document = {
            "contact": contact,
            "free": free,
            "known": known,
            "loops": loops,
            "noise": noise,
            "units": units,
            "start": start,
        }
        parts: dict[str, Document] = {
        }
        return self._answer(results.FitReply, "/fit", given, parts)

    def fretting(
        self,
        contact: ContactLike,
        displacement: Quantity | Quantities | None = None,
        *,
        crossland: types.Weighted | Mapping[str, Any] | None = None,
        dang_van: types.Weighted | Mapping[str, Any] | None = None,
        fatemi_socie: types.FatemiSocie | Mapping[str, Any] | None = None,
        findley: types.Findley | Mapping[str, Any] | None = None,
        friction_work: bool | types.SurfaceCriterion | Mapping[str, Any] | None = None,
        ruiz: bool | types.SurfaceCriterion | Mapping[str, Any] | None = None,
        swt: bool | types.StrainBased | Mapping[str, Any] | None = None,
        duration: Quantity | None = None,
        moves: Sequence[types.Move | Mapping[str, Any]] | None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        body: types.BodyName | None = None,
        bulk: Quantity | types.BulkCycle | Mapping[str, Any] | None = None,
        criteria: bool | types.Criteria | Mapping[str, Any] | None = None,
        critical_distance: types.CriticalDistance | Mapping[str, Any] | None = None,
        line: Line | types.SubsurfaceLine | Mapping[str, Any] | None = None,
        path: types.Path | None = None,
        plane: Plane | types.SubsurfacePlane | Mapping[str, Any] | None = None,
        points: Sequence[Quantities] | Quantities | None = None,
        poisson_ratio: Quantity | None = None,
        stress_paths: Sequence[int] | None = None,
        surface: Surface | types.SubsurfaceSurface | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.FrettingReply:
        """Rate a cycle for fretting fatigue.

        Repeats a path until it closes, computes the stress tensor at every place over the steady cycle and rates it by
        fatigue criteria: where would a crack start, on which plane, and how far is it from a limit. Nothing is stored.

        The contact is taken at the preload of its definition, as if it was never moved: the history and the present
        load of a `Contact` that has been moved do not matter. One displacement is the amplitude of a cycle, several are
        a path.

        Parameters
        ----------
        contact : ContactLike
            The contact.
        displacement : Quantity | Quantities
            Tangential displacements of the indenter, m, one move each.
        crossland : Weighted | dict
            √J2a + α · the largest hydrostatic stress, Pa (Crossland 1956). Needs `alpha`; may have `life`, `limit`.
            `life` has `s_n` (`cycles`, `exponent`, `reference`).
        dang_van : Weighted | dict
            The largest of shear stress + α · hydrostatic stress, Pa (Dang Van 1973). Needs `alpha`; may have `life`,
            `limit`. `life` has `s_n` (`cycles`, `exponent`, `reference`).
        fatemi_socie : FatemiSocie | dict
            The largest amplitude of the shear strain, raised by the normal stress, a pure number (Fatemi & Socie 1988).
            Needs `k`, `yield`; may have `life`, `limit`, `youngs_modulus`. `life` has `s_n` (`cycles`, `exponent`,
            `reference`) or `strain_life` (`ductility`, `ductility_exponent`, `strength`, `strength_exponent`).
        findley : Findley | dict
            The largest of shear amplitude + k · largest normal stress on a plane, Pa (Findley 1959). Needs `k`; may
            have `life`, `limit`. `life` has `s_n` (`cycles`, `exponent`, `reference`).
        friction_work : bool | SurfaceCriterion | dict
            Friction work per area and cycle at the surface, J/m². May have `life`, `limit`. `life` has `s_n` (`cycles`,
            `exponent`, `reference`).
        ruiz : bool | SurfaceCriterion | dict
            Shear stress times slip at the surface, N/m (Ruiz, Boddington & Chen 1984). May have `life`, `limit`. `life`
            has `s_n` (`cycles`, `exponent`, `reference`).
        swt : bool | StrainBased | dict
            The largest of normal stress times amplitude of the normal strain on a plane, Pa (Smith, Watson & Topper
            1970). May have `life`, `limit`, `youngs_modulus`. `life` has `s_n` (`cycles`, `exponent`, `reference`) or
            `strain_life` (`ductility`, `ductility_exponent`, `strength`, `strength_exponent`).
        duration : Quantity
            How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`.
        moves : Sequence[Move | dict]
            Moves, one after the other.
        force : Quantities
            Tangential forces, N, one move each.
        falling_amplitude : int | FallingAmplitude | dict
            Back and forth with an amplitude that falls linearly to zero (eq. 20 of the paper). A number alone is its
            `reversals`. Needs `reversals`; may have `amplitude`.
        equal_peaks : int | EqualPeaks | dict
            Back and forth from gross slip to rest, with the amplitudes that leave equal peaks of shear stress on the
            profile of the contact. A number alone is its `reversals`. Needs `reversals`; may have `cutoff_radius`.
        cycles : CyclicPath | dict
            Equal cycles about a mean, under a constant load or one that oscillates too. Needs `count`; may have
            `displacement`, `force`, `mean`, `normal`, `points_per_cycle`, `start`.
        twist : Quantities
            Angles of twist, rad, one move each.
        torque : Quantities
            Torques, N·m, one move each.
        body : BodyName
            The body that is rated. If left out, the first body that is not rigid. One of 'first', 'second'.
        bulk : Quantity | BulkCycle | dict
            A normal stress of the body along x that varies with the cycle, mean + amplitude · cos(θ + phase), where θ
            grows from 0 to 360 degrees, by the same amount in each move. A number alone is its `amplitude`. May have
            `amplitude`, `mean`, `phase`.
        criteria : bool | Criteria | dict
            The criteria. May have `crossland`, `dang_van`, `fatemi_socie`, `findley`, `friction_work`, `ruiz`, `swt`.
        critical_distance : CriticalDistance | dict
            The distance below the worst point of the surface at which criteria of stress are also evaluated. A length
            alone is used by the point method. Needs `length`, `method`.
        line : Line | SubsurfaceLine | dict
            Where: a straight line. Needs `count`, `from`, `to`.
        path : Path
            A path of at most 200 moves that ends where it began, at least when it is repeated.
        plane : Plane | SubsurfacePlane | dict
            Where: a grid in a plane. Needs `normal`, `offset`; may have `x`, `y`, `z`.
        points : Sequence[Quantities] | Quantities
            Where: a list of x, y, z, m, with z not negative.
        poisson_ratio : Quantity
            Poisson's ratio of the body, a pure number; it may be left out if the material has `bodies`.
        stress_paths : Sequence[int]
            Indices of places for which to return the stresses over the cycle.
        surface : Surface | SubsurfaceSurface | dict
            Where: a grid on the surface. Needs `x`, `y`.
        tolerance : Quantity
            Accepted error of a criterion, relative to its largest value, a pure number. In a search the default is
            1e-3. Default: 0.0001.

        Returns
        -------
        FrettingReply
            The criteria over the steady cycle, each with its values at all places.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> reply = ss.fretting(
        ...     contact=ss.Definition(ss.Sphere(radius=0.01), [ss.Body(2.1e+11, 0.3), ss.Body(2.1e+11, 0.3)], 0.3,
        ...         normal_force=10.0),
        ...     crossland={'alpha': 0.3, 'life': {'s_n': {'cycles': 1000000.0, 'exponent': 8.0, 'reference':
        ...         300000000.0}}},
        ...     swt={'life': {'strain_life': {'ductility': 0.26, 'ductility_exponent': -0.6, 'strength':
        ...         950000000.0, 'strength_exponent': -0.09}}},
        ...     cycles={'count': 1, 'displacement': 1e-07},
        ...     body='first',
        ...     critical_distance={'length': 1e-05, 'method': 'point'},
        ...     surface={'x': [-0.00012, 0.00012, 13], 'y': [0.0, 1e-05, 2]},
        ... )
        """
        given: Document = {
            "body": body,
            "bulk": bulk,
            "contact": contact,
            "criteria": criteria,
            "critical_distance": critical_distance,
            "line": line,
            "path": path,
            "plane": plane,
            "points": points,
            "poisson_ratio": poisson_ratio,
            "stress_paths": stress_paths,
            "surface": surface,
            "tolerance": tolerance,
        }
        parts: dict[str, Document] = {
            "criteria": {
                "crossland": crossland,
                "dang_van": dang_van,
                "fatemi_socie": fatemi_socie,
                "findley": findley,
                "friction_work": friction_work,
                "ruiz": ruiz,
                "swt": swt,
            },
            "path": {
                "duration": duration,
                "moves": moves,
                "displacement": displacement,
                "force": force,
                "falling_amplitude": falling_amplitude,
                "equal_peaks": equal_peaks,
                "cycles": cycles,
                "twist": twist,
                "torque": torque,
            },
        }
        return self._answer(results.FrettingReply, "/fretting", given, parts)

    def fit_profile(
        self,
        scan: ScanLike,
        *,
        centre: types.Centre | None = None,
        level: bool | None = None,
        load: types.ScanLoad | Mapping[str, Any] | None = None,
        orientation: types.ScanOrientation | None = None,
        smoothing: types.Smoothing | None = None,
        units: bool | types.ScanUnits | Mapping[str, Any] | None = None,
    ) -> results.ProfileFitReply:
        """Fit a profile to a scan.

        Finds the axis of a scan of heights, subtracts its tilt, leaves out its outliers and fits the smoothest profile
        that its noise allows and whose contact is a full circle; with `load`, it also computes the contact, with
        standard errors. Nothing is stored.

        The scan may be a file that was read, a table with named columns, or arrays of x and z.

        Parameters
        ----------
        scan : ScanLike
            The heights, with their places. A file or its path, a table, a document, or arrays of x and z, or of x, y
            and z.
        centre : Centre
            Where the axis of the body is, m; `auto` searches for it.
        level : bool
            Whether to subtract a tilt, if the scan distinguishes it from an off-centre axis. Default: true.
        load : ScanLoad | dict
            A load, for which the reply then describes the contact. Needs `friction`, `material`, `preload`. `material`
            has `effective` (`e_star`, `g_star`, `bodies`, `shear_modulus`).
        orientation : ScanOrientation
            Which way up the scan is; `auto` derives it from the curvature of the surface. Default: auto. One of 'auto',
            'peak_up', 'peak_down'.
        smoothing : Smoothing
            How the smoothness of the profile is chosen; `auto` is generalised cross-validation.
        units : bool | ScanUnits | dict
            The units of the scan; if left out, metres. Everything else is in SI units. May have `height`, `lateral`.

        Returns
        -------
        ProfileFitReply
            A profile that was fitted to a scan, with the residual of the scan.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> reply = ss.fit_profile(
        ...     scan={'line': {'x': [-70.0, -60.0, -50.0, -40.0, -30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0, 40.0,
        ...         50.0, 60.0, 70.0], 'z': [-245.2, -179.7, -125.3, -79.6, -45.3, -20.4, -4.6, 0.3, -5.1, -19.8, -44.7,
        ...         -80.2, -124.9, -180.4, None]}},
        ...     load={'friction': 0.3, 'material': {'bodies': [{'poisson_ratio': 0.3, 'youngs_modulus':
        ...         210000000000.0}, {'poisson_ratio': 0.3, 'youngs_modulus': 210000000000.0}]}, 'preload':
        ...         {'normal_force': 1.0}},
        ...     units={'height': 'nm', 'lateral': 'um'},
        ... )
        """
        given: Document = {
            "centre": centre,
            "level": level,
            "load": load,
            "orientation": orientation,
            "scan": scan,
            "smoothing": smoothing,
            "units": units,
        }
        parts: dict[str, Document] = {
        }
        return self._answer(results.ProfileFitReply, "/profiles/fit", given, parts)

    def protocols(
        self,
        contact: ContactLike | None = None,
        reversals: int | None = None,
        *,
        end: types.ProtocolEnd | None = None,
        kind: types.ProtocolKind | None = None,
        robustness: bool | types.Robustness | Mapping[str, Any] | None = None,
        start: types.ProtocolStart | None = None,
        target: Quantity | None = None,
    ) -> results.ProtocolReply:
        """Find a protocol.

        Finds displacements that leave little shear stress, in a given number of reversals or in the fewest that reach a
        target. States the stress that remains, how far it may be from the optimum, and the stress that the other laws
        would leave. Nothing is stored or changed.

        The contact is taken at the preload of its definition, as if it was never moved: the history and the present
        load of a `Contact` that has been moved do not matter.

        Parameters
        ----------
        contact : ContactLike
            The contact; may be left out where `start` names one on the server.
        reversals : int
            Number of reversals N; give this or `target`.
        end : ProtocolEnd
            Where the path ends. One of 'displacement_zero', 'force_zero', 'free'.
        kind : ProtocolKind
            The law of the amplitudes. One of 'linear', 'equal_peaks', 'minimax'.
        robustness : bool | Robustness | dict
            Ask for the stress that remains if the protocol is not followed exactly. May have `amplitude_error`,
            `friction_error`, `samples`, `seed`.
        start : ProtocolStart
            The state that the reversals begin from; if left out, gross slip at its full amplitude.
        target : Quantity
            The largest |τ|/(μ p_max) that may remain, a pure number (over the mean pressure where the largest is
            infinite): the smallest number of reversals that reaches it is found.

        Returns
        -------
        ProtocolReply
            How to move so that little shear stress remains.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> reply = ss.protocols(
        ...     contact=ss.Definition(ss.Sphere(radius=0.01), [ss.Body(2.1e+11, 0.3), ss.Body(2.1e+11, 0.3)], 0.3,
        ...         normal_force=10.0),
        ...     reversals=20,
        ...     end='free',
        ...     kind='minimax',
        ... )
        """
        given: Document = {
            "contact": contact,
            "end": end,
            "kind": kind,
            "reversals": reversals,
            "robustness": robustness,
            "start": start,
            "target": target,
        }
        parts: dict[str, Document] = {
        }
        return self._answer(results.ProtocolReply, "/protocols", given, parts)

    def rolling(
        self,
        contact: ContactLike,
        *,
        creep: Quantity | None = None,
        points: int | None = None,
        ratio: Quantity | None = None,
    ) -> results.RollingReply:
        """Compute the creep of a rolling cylinder.

        A cylinder that rolls steadily towards +x under its load carries a tangential force by a stick zone at its
        leading edge and slip behind it. Returns creep, stick zone and tractions for a force over μ F_N or a creep.
        Nothing is stored.

        The contact is taken at the preload of its definition, as if it was never moved: the history and the present
        load of a `Contact` that has been moved do not matter.

        Parameters
        ----------
        contact : ContactLike
            The contact; its profile is a `cylinder`.
        creep : Quantity
            Creep, a pure number below μ a/R in magnitude; positive with a positive force.
        points : int
            Number of places of the curves, evenly spaced from −a to a; 200 if left out.
        ratio : Quantity
            Tangential force over μ F_N, a pure number between −1 and 1; positive along +x.

        Returns
        -------
        RollingReply
            Creep, stick zone and tractions of a cylinder that rolls steadily.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> reply = ss.rolling(
        ...     contact=ss.Definition(ss.Cylinder(length=0.01, radius=0.025), [ss.Body(2.1e+11, 0.3),
        ...         ss.Body(2.1e+11, 0.3)], 0.3, normal_force=1000.0),
        ...     points=50,
        ...     ratio=0.5,
        ... )
        """
        given: Document = {
            "contact": contact,
            "creep": creep,
            "points": points,
            "ratio": ratio,
        }
        parts: dict[str, Document] = {
        }
        return self._answer(results.RollingReply, "/rolling", given, parts)

    @overload
    def simulate(
        self,
        contact: ContactLike,
        displacement: Quantities | None = None,
        *,
        duration: Quantity | None = None,
        moves: None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        ellipse: None = None,
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        path: None = None,
        residual: bool | None = None,
        solver: None = None,
        steps: types.Steps | None = None,
        stress: int | types.StressRequest | Mapping[str, Any] | None = None,
        subsurface: Quantity | types.SubsurfaceRequest | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.SimulateReply: ...

    @overload
    def simulate(
        self,
        contact: ContactLike,
        displacement: Quantities | None = None,
        *,
        duration: Quantity | None = None,
        moves: Sequence[types.SimulatedMove | Mapping[str, Any]] | None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        ellipse: types.Ellipse | Mapping[str, Any],
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        path: types.SimulatedPath | None = None,
        residual: bool | None = None,
        solver: types.Solver | None = None,
        steps: types.Steps | None = None,
        stress: int | types.StressRequest | Mapping[str, Any] | None = None,
        subsurface: Quantity | types.SubsurfaceRequest | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.PlanarReply: ...

    @overload
    def simulate(
        self,
        contact: ContactLike,
        displacement: Quantities | None = None,
        *,
        duration: Quantity | None = None,
        moves: Sequence[types.SimulatedMove | Mapping[str, Any]] | None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        ellipse: types.Ellipse | Mapping[str, Any] | None = None,
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        path: types.SimulatedPath | None = None,
        residual: bool | None = None,
        solver: types.Solver | None = None,
        steps: types.Steps | None = None,
        stress: int | types.StressRequest | Mapping[str, Any] | None = None,
        subsurface: Quantity | types.SubsurfaceRequest | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.SimulateReply | results.PlanarReply: ...

    def simulate(
        self,
        contact: ContactLike,
        displacement: Quantities | None = None,
        *,
        duration: Quantity | None = None,
        moves: Sequence[types.SimulatedMove | Mapping[str, Any]] | None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        ellipse: types.Ellipse | Mapping[str, Any] | None = None,
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        path: types.SimulatedPath | None = None,
        residual: bool | None = None,
        solver: types.Solver | None = None,
        steps: types.Steps | None = None,
        stress: int | types.StressRequest | Mapping[str, Any] | None = None,
        subsurface: Quantity | types.SubsurfaceRequest | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.SimulateReply | results.PlanarReply:
        """Simulate a path.

        Follows a path from the preloaded contact and returns the states along it, and the stresses and their extrema at
        its end if asked for. Nothing is stored, so that a repeated request simply runs again.

        The contact is taken at the preload of its definition, as if it was never moved: the history and the present
        load of a `Contact` that has been moved do not matter.

        Parameters
        ----------
        contact : ContactLike
            The contact.
        displacement : Quantities
            Tangential displacements of the indenter, m, one move each.
        duration : Quantity
            How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`.
        moves : Sequence[SimulatedMove | dict]
            Moves, one after the other.
        force : Quantities
            Tangential forces, N, one move each.
        falling_amplitude : int | FallingAmplitude | dict
            Back and forth with an amplitude that falls linearly to zero (eq. 20 of the paper). A number alone is its
            `reversals`. Needs `reversals`; may have `amplitude`.
        equal_peaks : int | EqualPeaks | dict
            Back and forth from gross slip to rest, with the amplitudes that leave equal peaks of shear stress on the
            profile of the contact. A number alone is its `reversals`. Needs `reversals`; may have `cutoff_radius`.
        cycles : CyclicPath | dict
            Equal cycles about a mean, under a constant load or one that oscillates too. Needs `count`; may have
            `displacement`, `force`, `mean`, `normal`, `points_per_cycle`, `start`.
        ellipse : Ellipse | dict
            Turns around an ellipse. Needs `radii`, `turns`; may have `phase`, `steps_per_turn`.
        twist : Quantities
            Angles of twist, rad, one move each.
        torque : Quantities
            Torques, N·m, one move each.
        path : SimulatedPath
            The path.
        residual : bool
            Ask for the extrema of the shear stress at the end of the path.
        solver : Solver
            The solver to use; if left out, the cheapest that can serve the request.
        steps : Steps
            Which states to return. One of 'all', 'last'.
        stress : int | StressRequest | dict
            Ask for stresses at the end of the path. A number alone is its `points`. May have `fields`, `points`,
            `radii`, `x`.
        subsurface : Quantity | SubsurfaceRequest | dict
            Ask for the stress below the surface at the end of the path; only with the exact solver. Needs `body`; may
            have `bulk`, `fields`, `line`, `plane`, `points`, `poisson_ratio`, `surface`.
        tolerance : Quantity
            Tolerance of results that are not exact, relative to μ F_N, a pure number. For rings it is at least 1e-5
            and, if left out, 1e-3. Default: 1e-10.

        Returns
        -------
        SimulateReply | PlanarReply
            The result of a simulation, along a line or in the plane: the latter if the path has pairs or is an ellipse,
            or rings are asked for.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> reply = ss.simulate(
        ...     contact=ss.Definition(ss.Sphere(radius=0.01), [ss.Body(2.1e+11, 0.3), ss.Body(2.1e+11, 0.3)], 0.3,
        ...         normal_force=10.0),
        ...     falling_amplitude={'reversals': 20},
        ...     residual=True,
        ...     stress={'points': 200},
        ... )
        """
        given: Document = {
            "contact": contact,
            "path": path,
            "residual": residual,
            "solver": solver,
            "steps": steps,
            "stress": stress,
            "subsurface": subsurface,
            "tolerance": tolerance,
        }
        parts: dict[str, Document] = {
            "path": {
                "duration": duration,
                "moves": moves,
                "displacement": displacement,
                "force": force,
                "falling_amplitude": falling_amplitude,
                "equal_peaks": equal_peaks,
                "cycles": cycles,
                "ellipse": ellipse,
                "twist": twist,
                "torque": torque,
            },
        }
        return self._answer(results.SimulateReply, "/simulate", given, parts)

    def sliders(
        self,
        contact: ContactLike,
        *,
        count: int | None = None,
        force_error: Quantity | None = None,
        smallest_amplitude: Quantity | None = None,
        work_error: Quantity | None = None,
    ) -> results.SlidersReply:
        """Find sliders that move like a contact.

        Returns springs with friction caps in parallel (Jenkins, Iwan) that have the tangential force of a contact at
        constant load, for a code that knows no more: with chords of equal errors for a number of sliders or an error of
        the force, or with geometric knots for an error of the work of small cycles. Nothing is stored.

        The contact is taken at the preload of its definition, as if it was never moved: the history and the present
        load of a `Contact` that has been moved do not matter.

        Parameters
        ----------
        contact : ContactLike
            The contact, whose normal load stays as it is.
        count : int
            Number of sliders. Fewer are returned where the first loading is straight, as for a flat punch.
        force_error : Quantity
            Largest error of a first loading over μ F_N, a pure number: the fewest sliders that keep it.
        smallest_amplitude : Quantity
            The smallest amplitude for `work_error`, m; below the displacement of gross slip.
        work_error : Quantity
            Largest relative error of the work of a steady cycle from `smallest_amplitude` on, a pure number: the fewest
            sliders with geometric knots that keep it.

        Returns
        -------
        SlidersReply
            Sliders in parallel: each is a spring with a friction cap, and all are moved by the same displacement.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> reply = ss.sliders(
        ...     contact=ss.Definition(ss.Sphere(radius=0.01), [ss.Body(2.1e+11, 0.3), ss.Body(2.1e+11, 0.3)], 0.3,
        ...         normal_force=10.0),
        ...     force_error=0.01,
        ... )
        """
        given: Document = {
            "contact": contact,
            "count": count,
            "force_error": force_error,
            "smallest_amplitude": smallest_amplitude,
            "work_error": work_error,
        }
        parts: dict[str, Document] = {
        }
        return self._answer(results.SlidersReply, "/sliders", given, parts)

    @overload
    def sweep(
        self,
        base: Mapping[str, Any],
        axes: Mapping[str, Quantities] | Sequence[types.Axis],
        outputs: str | Mapping[str, str] | Sequence[types.Output],
        *,
        inputs: None = None,
        job: bool | None = None,
        samples: int | None = None,
        seed: int | None = None,
    ) -> results.SweepReply: ...

    @overload
    def sweep(
        self,
        base: Mapping[str, Any],
        axes: None = None,
        outputs: str | Mapping[str, str] | Sequence[types.Output] | None = None,
        *,
        inputs: Mapping[Any, Any] | Sequence[types.Input | Mapping[str, Any]],
        job: bool | None = None,
        samples: int | None = None,
        seed: int | None = None,
    ) -> results.UncertaintyReply: ...

    @overload
    def sweep(
        self,
        base: Mapping[str, Any],
        axes: Mapping[str, Quantities] | Sequence[types.Axis] | None = None,
        outputs: str | Mapping[str, str] | Sequence[types.Output] | None = None,
        *,
        inputs: Mapping[Any, Any] | Sequence[types.Input | Mapping[str, Any]] | None = None,
        job: bool | None = None,
        samples: int | None = None,
        seed: int | None = None,
    ) -> results.SweepReply | results.UncertaintyReply: ...

    def sweep(
        self,
        base: Mapping[str, Any],
        axes: Mapping[str, Quantities] | Sequence[types.Axis] | None = None,
        outputs: str | Mapping[str, str] | Sequence[types.Output] | None = None,
        *,
        inputs: Mapping[Any, Any] | Sequence[types.Input | Mapping[str, Any]] | None = None,
        job: bool | None = None,
        samples: int | None = None,
        seed: int | None = None,
    ) -> results.SweepReply | results.UncertaintyReply:
        """Run a sweep.

        Runs `POST /simulate` for each combination of the values of up to three axes, and returns a table of the
        outputs. A point without a result is a row of `null` and is listed among the failures. A small sweep is answered
        at once. A large one becomes a job: 202 with the URL of the job in `Location` or, with `Accept: text/event-
        stream`, its events. A retry with the same `Idempotency-Key` gets the numbers of the first attempt, or its job.
        With a key, a table of more than 65536 numbers is the result of a job.

        `axes` may be values by their pointers, `outputs` pointers by the names of their columns. With `inputs` in place
        of `axes` the reply says how sure the outputs are.

        Parameters
        ----------
        base : Mapping[str, Any]
            The body of `POST /simulate` that each point is made from. A number that an axis sets may be left out.
        axes : Mapping[str, Quantities] | Sequence[Axis]
            The numbers that change.
        outputs : str | Mapping[str, str] | Sequence[Output]
            JSON pointers to numbers in the reply to `POST /simulate`, one column each, with or without a name. Where a
            point lacks the number, such as the third of two peaks, the column has `null`.
        inputs : Mapping[Any, Any] | Sequence[Input | dict]
            The numbers that are uncertain, in place of `axes`; the reply is then an `UncertaintyReply`. Distributions
            by their pointers are taken too: each a number with its standard uncertainty (`ufloat` of `uncertainties`,
            `plus_minus` of pint), an estimate of a fit, {'normal': ...} or {'uniform': ...}.
        job : bool
            Run the sweep as a job even if it is small.
        samples : int
            Base points for `inputs`, each of which takes as many simulations as there are inputs, and two more; 1024 if
            left out.
        seed : int
            The samples of two sweeps with the same seed are the same; 0 if left out.

        Returns
        -------
        SweepReply | UncertaintyReply
            The reply to a sweep.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> reply = ss.sweep(
        ...     base={'contact': {'friction': 0.3, 'material': {'bodies': [{'poisson_ratio': 0.3, 'youngs_modulus':
        ...         210000000000.0}, {'poisson_ratio': 0.3, 'youngs_modulus': 210000000000.0}]}, 'preload':
        ...         {'normal_force': 10.0}, 'profile': {'radius': 0.01, 'type': 'sphere'}}, 'path':
        ...         {'falling_amplitude': {'reversals': 20}}, 'residual': True, 'steps': 'last'},
        ...     axes=[{'linear': {'count': 100, 'from': 1, 'to': 100}, 'pointer':
        ...         '/path/falling_amplitude/reversals'}],
        ...     outputs=['/residual/max'],
        ... )
        """
        given: Document = {
            "axes": axes,
            "base": base,
            "inputs": inputs,
            "job": job,
            "outputs": outputs,
            "samples": samples,
            "seed": seed,
        }
        parts: dict[str, Document] = {
        }
        return self._answer(results.SweepReply, "/sweep", given, parts)

    def wear(
        self,
        contact: ContactLike,
        displacement: Quantity | None = None,
        *,
        hold: types.Hold | None = None,
        points: int | None = None,
    ) -> results.WearReply:
        """Compute what fretting wear leaves.

        Moves a contact back and forth at a constant indentation until it has worn to its limit, in closed form: the
        disc that never slips stays as it is, and around it wear goes on until the pressure there is zero. Returns the
        shape and the pressure before and after, the removed volume, and the limiting shape as a profile for other
        computations. Nothing is stored.

        The contact is taken at the preload of its definition, as if it was never moved: the history and the present
        load of a `Contact` that has been moved do not matter.

        Parameters
        ----------
        contact : ContactLike
            The contact. Its profile must have a stress field.
        displacement : Quantity
            Amplitude of the tangential displacement, m; below that of gross slip.
        hold : Hold
            The quantity that is held constant: `indentation`. Under a constant normal force the final shape depends on
            the course of wear, so `normal_force` is refused. One of 'indentation', 'normal_force'.
        points : int
            Number of radii of the curves, evenly spaced and with both ends; 200 if left out. Stick radius, contact
            radius and worn radius are added to them.

        Returns
        -------
        WearReply
            The limit that wear approaches in a contact.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> reply = ss.wear(
        ...     contact=ss.Definition(ss.Sphere(radius=0.01), [ss.Body(2.1e+11, 0.3), ss.Body(2.1e+11, 0.3)], 0.3,
        ...         normal_force=10.0),
        ...     displacement=1e-07,
        ...     hold='indentation',
        ...     points=50,
        ... )
        """
        given: Document = {
            "contact": contact,
            "hold": hold,
            "points": points,
        }
        parts: dict[str, Document] = {
            "drive": {
                "displacement": displacement,
            },
        }
        return self._answer(results.WearReply, "/wear", given, parts)

    fit_loop = fit


@explained
class AsyncComputations(ABC):
    """The computations, which take a contact at the preload of its definition."""

    @abstractmethod
    async def _answer(self, kind: type[T], name: str, given: Document, parts: dict[str, Document]) -> T:
        """The reply to the members of a request, some of which are parts of one member."""

    async def accuracy(
        self,
        contact: ContactLike,
        displacement: Quantities | None = None,
        *,
        duration: Quantity | None = None,
        moves: Sequence[types.SimulatedMove | Mapping[str, Any]] | None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        ellipse: types.Ellipse | Mapping[str, Any] | None = None,
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        path: types.SimulatedPath | None = None,
        solvers: Sequence[types.Solver] | None = None,
        stress: int | types.StressRequest | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.AccuracyReply:
        """`accuracy`, awaited."""
        given: Document = {
            "contact": contact,
            "path": path,
            "solvers": solvers,
            "stress": stress,
            "tolerance": tolerance,
        }
        parts: dict[str, Document] = {
            "path": {
                "duration": duration,
                "moves": moves,
                "displacement": displacement,
                "force": force,
                "falling_amplitude": falling_amplitude,
                "equal_peaks": equal_peaks,
                "cycles": cycles,
                "ellipse": ellipse,
                "twist": twist,
                "torque": torque,
            },
        }
        return await self._answer(results.AccuracyReply, "/accuracy", given, parts)

    async def cycle(
        self,
        contact: ContactLike,
        displacement: Quantity | Quantities | None = None,
        *,
        force: Quantity | Quantities | None = None,
        twist: Quantity | Quantities | None = None,
        torque: Quantity | Quantities | None = None,
        best_load: int | bool | types.BestLoadStudy | Mapping[str, Any] | None = None,
        frequency: Quantity | Quantities | None = None,
        frequency_response: types.FrequencyResponse | Mapping[str, Any] | None = None,
        harmonics: int | None = None,
        machine: Quantity | types.Machine | Mapping[str, Any] | None = None,
        map: types.FrettingMap | Mapping[str, Any] | None = None,
        normal: types.NormalOscillation | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
        work_density: int | types.WorkDensity | Mapping[str, Any] | None = None,
    ) -> results.CycleReply:
        """`cycle`, awaited."""
        given: Document = {
            "best_load": best_load,
            "contact": contact,
            "frequency": frequency,
            "frequency_response": frequency_response,
            "harmonics": harmonics,
            "machine": machine,
            "map": map,
            "normal": normal,
            "tolerance": tolerance,
            "work_density": work_density,
        }
        parts: dict[str, Document] = {
            "drive": {
                "displacement": displacement,
                "force": force,
                "twist": twist,
                "torque": torque,
            },
        }
        return await self._answer(results.CycleReply, "/cycle", given, parts)

    async def fit(
        self,
        contact: ContactLike,
        loops: LoopLike | Sequence[LoopLike],
        *,
        free: Sequence[types.FitParameter] | None = None,
        known: bool | types.KnownValues | Mapping[str, Any] | None = None,
        noise: bool | types.FitNoise | Mapping[str, Any] | None = None,
        units: bool | types.FitUnits | Mapping[str, Any] | None = None,
        start: types.LoopStart | None = None,
    ) -> results.FitReply:
        """`fit`, awaited."""
        given: Document = {
            "contact": contact,
            "free": free,
            "known": known,
            "loops": loops,
            "noise": noise,
            "units": units,
            "start": start,
        }
        parts: dict[str, Document] = {
        }
        return await self._answer(results.FitReply, "/fit", given, parts)

    async def fretting(
        self,
        contact: ContactLike,
        displacement: Quantity | Quantities | None = None,
        *,
        crossland: types.Weighted | Mapping[str, Any] | None = None,
        dang_van: types.Weighted | Mapping[str, Any] | None = None,
        fatemi_socie: types.FatemiSocie | Mapping[str, Any] | None = None,
        findley: types.Findley | Mapping[str, Any] | None = None,
        friction_work: bool | types.SurfaceCriterion | Mapping[str, Any] | None = None,
        ruiz: bool | types.SurfaceCriterion | Mapping[str, Any] | None = None,
        swt: bool | types.StrainBased | Mapping[str, Any] | None = None,
        duration: Quantity | None = None,
        moves: Sequence[types.Move | Mapping[str, Any]] | None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        body: types.BodyName | None = None,
        bulk: Quantity | types.BulkCycle | Mapping[str, Any] | None = None,
        criteria: bool | types.Criteria | Mapping[str, Any] | None = None,
        critical_distance: types.CriticalDistance | Mapping[str, Any] | None = None,
        line: Line | types.SubsurfaceLine | Mapping[str, Any] | None = None,
        path: types.Path | None = None,
        plane: Plane | types.SubsurfacePlane | Mapping[str, Any] | None = None,
        points: Sequence[Quantities] | Quantities | None = None,
        poisson_ratio: Quantity | None = None,
        stress_paths: Sequence[int] | None = None,
        surface: Surface | types.SubsurfaceSurface | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.FrettingReply:
        """`fretting`, awaited."""
        given: Document = {
            "body": body,
            "bulk": bulk,
            "contact": contact,
            "criteria": criteria,
            "critical_distance": critical_distance,
            "line": line,
            "path": path,
            "plane": plane,
            "points": points,
            "poisson_ratio": poisson_ratio,
            "stress_paths": stress_paths,
            "surface": surface,
            "tolerance": tolerance,
        }
        parts: dict[str, Document] = {
            "criteria": {
                "crossland": crossland,
                "dang_van": dang_van,
                "fatemi_socie": fatemi_socie,
                "findley": findley,
                "friction_work": friction_work,
                "ruiz": ruiz,
                "swt": swt,
            },
            "path": {
                "duration": duration,
                "moves": moves,
                "displacement": displacement,
                "force": force,
                "falling_amplitude": falling_amplitude,
                "equal_peaks": equal_peaks,
                "cycles": cycles,
                "twist": twist,
                "torque": torque,
            },
        }
        return await self._answer(results.FrettingReply, "/fretting", given, parts)

    async def fit_profile(
        self,
        scan: ScanLike,
        *,
        centre: types.Centre | None = None,
        level: bool | None = None,
        load: types.ScanLoad | Mapping[str, Any] | None = None,
        orientation: types.ScanOrientation | None = None,
        smoothing: types.Smoothing | None = None,
        units: bool | types.ScanUnits | Mapping[str, Any] | None = None,
    ) -> results.ProfileFitReply:
        """`fit_profile`, awaited."""
        given: Document = {
            "centre": centre,
            "level": level,
            "load": load,
            "orientation": orientation,
            "scan": scan,
            "smoothing": smoothing,
            "units": units,
        }
        parts: dict[str, Document] = {
        }
        return await self._answer(results.ProfileFitReply, "/profiles/fit", given, parts)

    async def protocols(
        self,
        contact: ContactLike | None = None,
        reversals: int | None = None,
        *,
        end: types.ProtocolEnd | None = None,
        kind: types.ProtocolKind | None = None,
        robustness: bool | types.Robustness | Mapping[str, Any] | None = None,
        start: types.ProtocolStart | None = None,
        target: Quantity | None = None,
    ) -> results.ProtocolReply:
        """`protocols`, awaited."""
        given: Document = {
            "contact": contact,
            "end": end,
            "kind": kind,
            "reversals": reversals,
            "robustness": robustness,
            "start": start,
            "target": target,
        }
        parts: dict[str, Document] = {
        }
        return await self._answer(results.ProtocolReply, "/protocols", given, parts)

    async def rolling(
        self,
        contact: ContactLike,
        *,
        creep: Quantity | None = None,
        points: int | None = None,
        ratio: Quantity | None = None,
    ) -> results.RollingReply:
        """`rolling`, awaited."""
        given: Document = {
            "contact": contact,
            "creep": creep,
            "points": points,
            "ratio": ratio,
        }
        parts: dict[str, Document] = {
        }
        return await self._answer(results.RollingReply, "/rolling", given, parts)

    @overload
    async def simulate(
        self,
        contact: ContactLike,
        displacement: Quantities | None = None,
        *,
        duration: Quantity | None = None,
        moves: None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        ellipse: None = None,
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        path: None = None,
        residual: bool | None = None,
        solver: None = None,
        steps: types.Steps | None = None,
        stress: int | types.StressRequest | Mapping[str, Any] | None = None,
        subsurface: Quantity | types.SubsurfaceRequest | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.SimulateReply: ...

    @overload
    async def simulate(
        self,
        contact: ContactLike,
        displacement: Quantities | None = None,
        *,
        duration: Quantity | None = None,
        moves: Sequence[types.SimulatedMove | Mapping[str, Any]] | None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        ellipse: types.Ellipse | Mapping[str, Any],
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        path: types.SimulatedPath | None = None,
        residual: bool | None = None,
        solver: types.Solver | None = None,
        steps: types.Steps | None = None,
        stress: int | types.StressRequest | Mapping[str, Any] | None = None,
        subsurface: Quantity | types.SubsurfaceRequest | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.PlanarReply: ...

    @overload
    async def simulate(
        self,
        contact: ContactLike,
        displacement: Quantities | None = None,
        *,
        duration: Quantity | None = None,
        moves: Sequence[types.SimulatedMove | Mapping[str, Any]] | None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        ellipse: types.Ellipse | Mapping[str, Any] | None = None,
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        path: types.SimulatedPath | None = None,
        residual: bool | None = None,
        solver: types.Solver | None = None,
        steps: types.Steps | None = None,
        stress: int | types.StressRequest | Mapping[str, Any] | None = None,
        subsurface: Quantity | types.SubsurfaceRequest | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.SimulateReply | results.PlanarReply: ...

    async def simulate(
        self,
        contact: ContactLike,
        displacement: Quantities | None = None,
        *,
        duration: Quantity | None = None,
        moves: Sequence[types.SimulatedMove | Mapping[str, Any]] | None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        ellipse: types.Ellipse | Mapping[str, Any] | None = None,
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        path: types.SimulatedPath | None = None,
        residual: bool | None = None,
        solver: types.Solver | None = None,
        steps: types.Steps | None = None,
        stress: int | types.StressRequest | Mapping[str, Any] | None = None,
        subsurface: Quantity | types.SubsurfaceRequest | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.SimulateReply | results.PlanarReply:
        """`simulate`, awaited."""
        given: Document = {
            "contact": contact,
            "path": path,
            "residual": residual,
            "solver": solver,
            "steps": steps,
            "stress": stress,
            "subsurface": subsurface,
            "tolerance": tolerance,
        }
        parts: dict[str, Document] = {
            "path": {
                "duration": duration,
                "moves": moves,
                "displacement": displacement,
                "force": force,
                "falling_amplitude": falling_amplitude,
                "equal_peaks": equal_peaks,
                "cycles": cycles,
                "ellipse": ellipse,
                "twist": twist,
                "torque": torque,
            },
        }
        return await self._answer(results.SimulateReply, "/simulate", given, parts)

    async def sliders(
        self,
        contact: ContactLike,
        *,
        count: int | None = None,
        force_error: Quantity | None = None,
        smallest_amplitude: Quantity | None = None,
        work_error: Quantity | None = None,
    ) -> results.SlidersReply:
        """`sliders`, awaited."""
        given: Document = {
            "contact": contact,
            "count": count,
            "force_error": force_error,
            "smallest_amplitude": smallest_amplitude,
            "work_error": work_error,
        }
        parts: dict[str, Document] = {
        }
        return await self._answer(results.SlidersReply, "/sliders", given, parts)

    @overload
    async def sweep(
        self,
        base: Mapping[str, Any],
        axes: Mapping[str, Quantities] | Sequence[types.Axis],
        outputs: str | Mapping[str, str] | Sequence[types.Output],
        *,
        inputs: None = None,
        job: bool | None = None,
        samples: int | None = None,
        seed: int | None = None,
    ) -> results.SweepReply: ...

    @overload
    async def sweep(
        self,
        base: Mapping[str, Any],
        axes: None = None,
        outputs: str | Mapping[str, str] | Sequence[types.Output] | None = None,
        *,
        inputs: Mapping[Any, Any] | Sequence[types.Input | Mapping[str, Any]],
        job: bool | None = None,
        samples: int | None = None,
        seed: int | None = None,
    ) -> results.UncertaintyReply: ...

    @overload
    async def sweep(
        self,
        base: Mapping[str, Any],
        axes: Mapping[str, Quantities] | Sequence[types.Axis] | None = None,
        outputs: str | Mapping[str, str] | Sequence[types.Output] | None = None,
        *,
        inputs: Mapping[Any, Any] | Sequence[types.Input | Mapping[str, Any]] | None = None,
        job: bool | None = None,
        samples: int | None = None,
        seed: int | None = None,
    ) -> results.SweepReply | results.UncertaintyReply: ...

    async def sweep(
        self,
        base: Mapping[str, Any],
        axes: Mapping[str, Quantities] | Sequence[types.Axis] | None = None,
        outputs: str | Mapping[str, str] | Sequence[types.Output] | None = None,
        *,
        inputs: Mapping[Any, Any] | Sequence[types.Input | Mapping[str, Any]] | None = None,
        job: bool | None = None,
        samples: int | None = None,
        seed: int | None = None,
    ) -> results.SweepReply | results.UncertaintyReply:
        """`sweep`, awaited."""
        given: Document = {
            "axes": axes,
            "base": base,
            "inputs": inputs,
            "job": job,
            "outputs": outputs,
            "samples": samples,
            "seed": seed,
        }
        parts: dict[str, Document] = {
        }
        return await self._answer(results.SweepReply, "/sweep", given, parts)

    async def wear(
        self,
        contact: ContactLike,
        displacement: Quantity | None = None,
        *,
        hold: types.Hold | None = None,
        points: int | None = None,
    ) -> results.WearReply:
        """`wear`, awaited."""
        given: Document = {
            "contact": contact,
            "hold": hold,
            "points": points,
        }
        parts: dict[str, Document] = {
            "drive": {
                "displacement": displacement,
            },
        }
        return await self._answer(results.WearReply, "/wear", given, parts)

    fit_loop = fit


@explained
class OfContact(ABC):
    """The calls that move a contact or read its present state."""

    @abstractmethod
    def _answer_of_contact(self, kind: type[T], name: str, given: Document, parts: dict[str, Document]) -> T:
        """The reply to the members of a request, some of which are parts of one member."""

    def move(
        self,
        displacement: Quantity | None = None,
        *,
        duration: Quantity | None = None,
        force: Quantity | None = None,
        indentation: Quantity | None = None,
        normal_force: Quantity | None = None,
        relative: bool | None = None,
        stress: int | types.StressRequest | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
        torque: Quantity | None = None,
        twist: Quantity | None = None,
    ) -> results.MoveReply:
        """Applies one move.

        Moves of one contact are applied one at a time, in the order of their arrival.

        Parameters
        ----------
        displacement : Quantity
            Tangential displacement of the indenter, m.
        duration : Quantity
            How long the move takes, s, at an even pace; at once if left out. Only of bodies with `prony`. Without a
            target it waits.
        force : Quantity
            Tangential force, N. Its magnitude must stay below the friction limit μ F_N.
        indentation : Quantity
            Indentation, m; below zero the bodies are apart and the slip history is lost.
        normal_force : Quantity
            Normal force, N; below zero, if it is no increment, only with `adhesion`.
        relative : bool
            Whether the numbers are increments to the present state, instead of the targets themselves.
        stress : int | StressRequest | dict
            Ask for stresses after the move. A number alone is its `points`. May have `fields`, `points`, `radii`, `x`.
        tolerance : Quantity
            Tolerance of results that are not exact, relative to μ F_N, a pure number. Default: 1e-10.
        torque : Quantity
            Torque about the axis of the contact, N·m, in place of `twist`; its magnitude must stay below that of gross
            slip.
        twist : Quantity
            Angle of twist about the axis of the contact, rad, since it last touched, in place of `displacement` or
            `force`.

        Returns
        -------
        MoveReply
            The result of a move.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> steel = ss.Body("210 GPa", 0.3)
        >>> ball = ss.Contact(ss.Sphere("10 mm"), [steel, steel], 0.3, normal_force="10 N")
        >>> state = ball.move(force="1 N").state
        """
        given: Document = {
            "displacement": displacement,
            "duration": duration,
            "force": force,
            "indentation": indentation,
            "normal_force": normal_force,
            "relative": relative,
            "stress": stress,
            "tolerance": tolerance,
            "torque": torque,
            "twist": twist,
        }
        parts: dict[str, Document] = {
        }
        return self._answer_of_contact(results.MoveReply, "move", given, parts)

    def path(
        self,
        displacement: Quantities | None = None,
        *,
        duration: Quantity | None = None,
        moves: Sequence[types.Move | Mapping[str, Any]] | None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        path: types.Path | None = None,
        steps: types.Steps | None = None,
        stress: int | types.StressRequest | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.PathReply:
        """Applies all moves of the path, or none if one of them is refused.

        Parameters
        ----------
        displacement : Quantities
            Tangential displacements of the indenter, m, one move each.
        duration : Quantity
            How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`.
        moves : Sequence[Move | dict]
            Moves, one after the other.
        force : Quantities
            Tangential forces, N, one move each.
        falling_amplitude : int | FallingAmplitude | dict
            Back and forth with an amplitude that falls linearly to zero (eq. 20 of the paper). A number alone is its
            `reversals`. Needs `reversals`; may have `amplitude`.
        equal_peaks : int | EqualPeaks | dict
            Back and forth from gross slip to rest, with the amplitudes that leave equal peaks of shear stress on the
            profile of the contact. A number alone is its `reversals`. Needs `reversals`; may have `cutoff_radius`.
        cycles : CyclicPath | dict
            Equal cycles about a mean, under a constant load or one that oscillates too. Needs `count`; may have
            `displacement`, `force`, `mean`, `normal`, `points_per_cycle`, `start`.
        twist : Quantities
            Angles of twist, rad, one move each.
        torque : Quantities
            Torques, N·m, one move each.
        path : Path
            The path.
        steps : Steps
            Which states to return. One of 'all', 'last'.
        stress : int | StressRequest | dict
            Ask for stresses at the end of the path. A number alone is its `points`. May have `fields`, `points`,
            `radii`, `x`.
        tolerance : Quantity
            Tolerance of results that are not exact, relative to μ F_N, a pure number. Default: 1e-10.

        Returns
        -------
        PathReply
            The result of a path.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> steel = ss.Body("210 GPa", 0.3)
        >>> ball = ss.Contact(ss.Sphere("10 mm"), [steel, steel], 0.3, normal_force="10 N")
        >>> force = ball.path([5e-8, -5e-8]).force
        """
        given: Document = {
            "path": path,
            "steps": steps,
            "stress": stress,
            "tolerance": tolerance,
        }
        parts: dict[str, Document] = {
            "path": {
                "duration": duration,
                "moves": moves,
                "displacement": displacement,
                "force": force,
                "falling_amplitude": falling_amplitude,
                "equal_peaks": equal_peaks,
                "cycles": cycles,
                "twist": twist,
                "torque": torque,
            },
        }
        return self._answer_of_contact(results.PathReply, "path", given, parts)

    def relax(
        self,
        reversals: int | None = None,
        *,
        dry_run: bool | None = None,
        end: types.ProtocolEnd | None = None,
        kind: types.ProtocolKind | None = None,
        steps: types.Steps | None = None,
        target: Quantity | None = None,
    ) -> results.RelaxReply:
        """Relax a contact.

        Finds the path from the present state that leaves the least shear stress, whatever the history, and applies all
        of it or nothing. A dry run returns the same and changes nothing.

        Parameters
        ----------
        reversals : int
            Largest number of reversals N; give this or `target`. The path begins with one more stroke.
        dry_run : bool
            Whether to compute the path without applying it. The reply of a dry run is not kept for a retry.
        end : ProtocolEnd
            Where the path ends. One of 'displacement_zero', 'force_zero', 'free'.
        kind : ProtocolKind
            The law of the amplitudes. One of 'linear', 'equal_peaks', 'minimax'.
        steps : Steps
            Ask for the states along the path. One of 'all', 'last'.
        target : Quantity
            The largest |τ|/(μ p_max) that may remain, a pure number (over the mean pressure where the largest is
            infinite): the smallest number of reversals that reaches it is found.

        Returns
        -------
        RelaxReply
            The result of relaxing a contact, or of a dry run.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> steel = ss.Body("210 GPa", 0.3)
        >>> ball = ss.Contact(ss.Sphere("10 mm"), [steel, steel], 0.3, normal_force="10 N")
        >>> left = ball.relax(8).residual.max
        """
        given: Document = {
            "dry_run": dry_run,
            "end": end,
            "kind": kind,
            "reversals": reversals,
            "steps": steps,
            "target": target,
        }
        parts: dict[str, Document] = {
        }
        return self._answer_of_contact(results.RelaxReply, "relax", given, parts)

    def subsurface(
        self,
        *,
        body: types.BodyName | None = None,
        bulk: bool | types.Bulk | Mapping[str, Any] | None = None,
        fields: Sequence[types.SubsurfaceField] | None = None,
        line: Line | types.SubsurfaceLine | Mapping[str, Any] | None = None,
        plane: Plane | types.SubsurfacePlane | Mapping[str, Any] | None = None,
        points: Sequence[Quantities] | Quantities | None = None,
        poisson_ratio: Quantity | None = None,
        surface: Surface | types.SubsurfaceSurface | Mapping[str, Any] | None = None,
    ) -> results.SubsurfaceReply:
        """Compute the stress below the surface.

        The stress tensor and its invariants in one of the two bodies, in the present state of the contact, whatever its
        history. Nothing changes.

        Parameters
        ----------
        body : BodyName
            The body whose stress is asked for. If left out, the first body that is not rigid. One of 'first', 'second'.
        bulk : bool | Bulk | dict
            A uniform stress of the body that is added, Pa. In this model it does not shift the stick zone. A number
            alone is its `amplitude`. May have `xx`, `xy`, `xz`, `yy`, `yz`, `zz`.
        fields : Sequence[SubsurfaceField]
            Which fields are computed; if left out, `tensor`. One of 'tensor', 'principal', 'von_mises', 'max_shear',
            'hydrostatic'.
        line : Line | SubsurfaceLine | dict
            A straight line. Needs `count`, `from`, `to`.
        plane : Plane | SubsurfacePlane | dict
            A grid in a plane. Needs `normal`, `offset`; may have `x`, `y`, `z`.
        points : Sequence[Quantities] | Quantities
            A list of x, y, z, m, with z not negative.
        poisson_ratio : Quantity
            Poisson's ratio of the body, a pure number; it may be left out if the material has `bodies`.
        surface : Surface | SubsurfaceSurface | dict
            A grid on the surface. Needs `x`, `y`.

        Returns
        -------
        SubsurfaceReply
            Stresses below the surface of a contact on the server.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> steel = ss.Body("210 GPa", 0.3)
        >>> ball = ss.Contact(ss.Sphere("10 mm"), [steel, steel], 0.3, normal_force="10 N")
        >>> plane = ss.Plane(normal="y", offset=0, x=[-1e-4, 1e-4, 5], z=[0, 1e-4, 4])
        >>> stress = ball.subsurface(plane=plane, fields=["von_mises"]).von_mises
        """
        given: Document = {
            "body": body,
            "bulk": bulk,
            "fields": fields,
            "line": line,
            "plane": plane,
            "points": points,
            "poisson_ratio": poisson_ratio,
            "surface": surface,
        }
        parts: dict[str, Document] = {
        }
        return self._answer_of_contact(results.SubsurfaceReply, "subsurface", given, parts)

    def cycle(
        self,
        displacement: Quantity | Quantities | None = None,
        *,
        force: Quantity | Quantities | None = None,
        twist: Quantity | Quantities | None = None,
        torque: Quantity | Quantities | None = None,
        best_load: int | bool | types.BestLoadStudy | Mapping[str, Any] | None = None,
        frequency: Quantity | Quantities | None = None,
        frequency_response: types.FrequencyResponse | Mapping[str, Any] | None = None,
        harmonics: int | None = None,
        machine: Quantity | types.Machine | Mapping[str, Any] | None = None,
        map: types.FrettingMap | Mapping[str, Any] | None = None,
        normal: types.NormalOscillation | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
        work_density: int | types.WorkDensity | Mapping[str, Any] | None = None,
    ) -> results.CycleReply:
        """Compute steady cycles.

        Moves a contact back and forth at constant load until every cycle repeats the one before it, in closed form: a
        displacement or a force that is a cosine, directly or through a machine of finite stiffness. Returns work,
        stiffness, loss factor and slip for each amplitude and, if asked for, the harmonics and the friction work per
        area, or the same cycles under many loads. Of bodies with memory, the cycles at each frequency. Nothing is
        stored.

        The load is the present one, and the history does not matter. `stickslip.cycle(contact)` is at the preload of
        the definition instead.

        Parameters
        ----------
        displacement : Quantity | Quantities
            Amplitude of the tangential displacement, m: of the indenter or, with `machine`, of the machine.
        force : Quantity | Quantities
            Amplitude of the tangential force, N; below μ F_N.
        twist : Quantity | Quantities
            Amplitude of the angle of twist, rad: of the indenter or, with `machine`, of the machine.
        torque : Quantity | Quantities
            Amplitude of the torque, N·m; below that of gross slip.
        best_load : int | bool | BestLoadStudy | dict
            Ask for the normal force under which each amplitude does the most friction work; with at most 100
            amplitudes, not with `normal`. A number alone is its `points`. May have `points`.
        frequency : Quantity | Quantities
            Frequency, Hz, or a list of frequencies with the cycles of all amplitudes for each: of bodies with `prony`,
            whose cycles depend on it. The load has then been held for long: the normal force of a preload, or its
            indentation. Only a displacement is driven, and of the other options only `harmonics` is allowed. At most
            100 000 cycles.
        frequency_response : FrequencyResponse | dict
            Ask for the oscillations of a mass that only the contact holds and a force drives. Not with `machine` or
            `normal`. Needs `drive_force`, `mass`; may have `frequencies`.
        harmonics : int
            Ask for the harmonics from the first to this one.
        machine : Quantity | Machine | dict
            A machine in series with the contact: an amplitude of displacement or twist is then that of the machine. A
            number alone is its `stiffness`. Needs `stiffness`.
        map : FrettingMap | dict
            Repeat all amplitudes under many loads, whatever the preload of the contact: a fretting map. Of the other
            options only `machine` is allowed. At most 100 000 cycles. Needs `normal_force`.
        normal : NormalOscillation | dict
            The normal load oscillates too, about that of the contact. May have `indentation`, `normal_force`, `phase`.
        tolerance : Quantity
            Tolerance, a pure number: of cycles with `normal` relative to μ F_N and to the work of that force, of
            `frequency_response` relative to the amplitude. Default: 1e-6.
        work_density : int | WorkDensity | dict
            Ask for the friction work per area. Radii times amplitudes are at most 200 000. Not with `normal`. A number
            alone is its `points`. May have `points`, `radii`, `x`.

        Returns
        -------
        CycleReply
            Steady cycles, one for each amplitude.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> steel = ss.Body("210 GPa", 0.3)
        >>> ball = ss.Contact(ss.Sphere("10 mm"), [steel, steel], 0.3, normal_force="10 N")
        >>> work = ball.cycle(["10 nm", "30 nm"]).dissipated_energy
        """
        given: Document = {
            "best_load": best_load,
            "frequency": frequency,
            "frequency_response": frequency_response,
            "harmonics": harmonics,
            "machine": machine,
            "map": map,
            "normal": normal,
            "tolerance": tolerance,
            "work_density": work_density,
        }
        parts: dict[str, Document] = {
            "drive": {
                "displacement": displacement,
                "force": force,
                "twist": twist,
                "torque": torque,
            },
        }
        return self._answer_of_contact(results.CycleReply, "cycle", given, parts)

    def fretting(
        self,
        displacement: Quantity | Quantities | None = None,
        *,
        crossland: types.Weighted | Mapping[str, Any] | None = None,
        dang_van: types.Weighted | Mapping[str, Any] | None = None,
        fatemi_socie: types.FatemiSocie | Mapping[str, Any] | None = None,
        findley: types.Findley | Mapping[str, Any] | None = None,
        friction_work: bool | types.SurfaceCriterion | Mapping[str, Any] | None = None,
        ruiz: bool | types.SurfaceCriterion | Mapping[str, Any] | None = None,
        swt: bool | types.StrainBased | Mapping[str, Any] | None = None,
        duration: Quantity | None = None,
        moves: Sequence[types.Move | Mapping[str, Any]] | None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        body: types.BodyName | None = None,
        bulk: Quantity | types.BulkCycle | Mapping[str, Any] | None = None,
        criteria: bool | types.Criteria | Mapping[str, Any] | None = None,
        critical_distance: types.CriticalDistance | Mapping[str, Any] | None = None,
        line: Line | types.SubsurfaceLine | Mapping[str, Any] | None = None,
        path: types.Path | None = None,
        plane: Plane | types.SubsurfacePlane | Mapping[str, Any] | None = None,
        points: Sequence[Quantities] | Quantities | None = None,
        poisson_ratio: Quantity | None = None,
        stress_paths: Sequence[int] | None = None,
        surface: Surface | types.SubsurfaceSurface | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.FrettingReply:
        """Rate a cycle for fretting fatigue.

        Repeats a path until it closes, computes the stress tensor at every place over the steady cycle and rates it by
        fatigue criteria: where would a crack start, on which plane, and how far is it from a limit. Nothing is stored.

        The load is the present one, and the history does not matter: the path begins with a contact that was never
        moved. `stickslip.fretting(contact)` is at the preload of the definition instead. One displacement is the
        amplitude of a cycle, several are a path.

        Parameters
        ----------
        displacement : Quantity | Quantities
            Tangential displacements of the indenter, m, one move each.
        crossland : Weighted | dict
            √J2a + α · the largest hydrostatic stress, Pa (Crossland 1956). Needs `alpha`; may have `life`, `limit`.
            `life` has `s_n` (`cycles`, `exponent`, `reference`).
        dang_van : Weighted | dict
            The largest of shear stress + α · hydrostatic stress, Pa (Dang Van 1973). Needs `alpha`; may have `life`,
            `limit`. `life` has `s_n` (`cycles`, `exponent`, `reference`).
        fatemi_socie : FatemiSocie | dict
            The largest amplitude of the shear strain, raised by the normal stress, a pure number (Fatemi & Socie 1988).
            Needs `k`, `yield`; may have `life`, `limit`, `youngs_modulus`. `life` has `s_n` (`cycles`, `exponent`,
            `reference`) or `strain_life` (`ductility`, `ductility_exponent`, `strength`, `strength_exponent`).
        findley : Findley | dict
            The largest of shear amplitude + k · largest normal stress on a plane, Pa (Findley 1959). Needs `k`; may
            have `life`, `limit`. `life` has `s_n` (`cycles`, `exponent`, `reference`).
        friction_work : bool | SurfaceCriterion | dict
            Friction work per area and cycle at the surface, J/m². May have `life`, `limit`. `life` has `s_n` (`cycles`,
            `exponent`, `reference`).
        ruiz : bool | SurfaceCriterion | dict
            Shear stress times slip at the surface, N/m (Ruiz, Boddington & Chen 1984). May have `life`, `limit`. `life`
            has `s_n` (`cycles`, `exponent`, `reference`).
        swt : bool | StrainBased | dict
            The largest of normal stress times amplitude of the normal strain on a plane, Pa (Smith, Watson & Topper
            1970). May have `life`, `limit`, `youngs_modulus`. `life` has `s_n` (`cycles`, `exponent`, `reference`) or
            `strain_life` (`ductility`, `ductility_exponent`, `strength`, `strength_exponent`).
        duration : Quantity
            How long each move takes, s, unless it says so itself; at once if left out. Only of bodies with `prony`.
        moves : Sequence[Move | dict]
            Moves, one after the other.
        force : Quantities
            Tangential forces, N, one move each.
        falling_amplitude : int | FallingAmplitude | dict
            Back and forth with an amplitude that falls linearly to zero (eq. 20 of the paper). A number alone is its
            `reversals`. Needs `reversals`; may have `amplitude`.
        equal_peaks : int | EqualPeaks | dict
            Back and forth from gross slip to rest, with the amplitudes that leave equal peaks of shear stress on the
            profile of the contact. A number alone is its `reversals`. Needs `reversals`; may have `cutoff_radius`.
        cycles : CyclicPath | dict
            Equal cycles about a mean, under a constant load or one that oscillates too. Needs `count`; may have
            `displacement`, `force`, `mean`, `normal`, `points_per_cycle`, `start`.
        twist : Quantities
            Angles of twist, rad, one move each.
        torque : Quantities
            Torques, N·m, one move each.
        body : BodyName
            The body that is rated. If left out, the first body that is not rigid. One of 'first', 'second'.
        bulk : Quantity | BulkCycle | dict
            A normal stress of the body along x that varies with the cycle, mean + amplitude · cos(θ + phase), where θ
            grows from 0 to 360 degrees, by the same amount in each move. A number alone is its `amplitude`. May have
            `amplitude`, `mean`, `phase`.
        criteria : bool | Criteria | dict
            The criteria. May have `crossland`, `dang_van`, `fatemi_socie`, `findley`, `friction_work`, `ruiz`, `swt`.
        critical_distance : CriticalDistance | dict
            The distance below the worst point of the surface at which criteria of stress are also evaluated. A length
            alone is used by the point method. Needs `length`, `method`.
        line : Line | SubsurfaceLine | dict
            Where: a straight line. Needs `count`, `from`, `to`.
        path : Path
            A path of at most 200 moves that ends where it began, at least when it is repeated.
        plane : Plane | SubsurfacePlane | dict
            Where: a grid in a plane. Needs `normal`, `offset`; may have `x`, `y`, `z`.
        points : Sequence[Quantities] | Quantities
            Where: a list of x, y, z, m, with z not negative.
        poisson_ratio : Quantity
            Poisson's ratio of the body, a pure number; it may be left out if the material has `bodies`.
        stress_paths : Sequence[int]
            Indices of places for which to return the stresses over the cycle.
        surface : Surface | SubsurfaceSurface | dict
            Where: a grid on the surface. Needs `x`, `y`.
        tolerance : Quantity
            Accepted error of a criterion, relative to its largest value, a pure number. In a search the default is
            1e-3. Default: 0.0001.

        Returns
        -------
        FrettingReply
            The criteria over the steady cycle, each with its values at all places.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> steel = ss.Body("210 GPa", 0.3)
        >>> ball = ss.Contact(ss.Sphere("10 mm"), [steel, steel], 0.3, normal_force="10 N")
        >>> margin = ball.fretting("50 nm", crossland={"alpha": 0.3, "limit": "300 MPa"}).margin
        """
        given: Document = {
            "body": body,
            "bulk": bulk,
            "criteria": criteria,
            "critical_distance": critical_distance,
            "line": line,
            "path": path,
            "plane": plane,
            "points": points,
            "poisson_ratio": poisson_ratio,
            "stress_paths": stress_paths,
            "surface": surface,
            "tolerance": tolerance,
        }
        parts: dict[str, Document] = {
            "criteria": {
                "crossland": crossland,
                "dang_van": dang_van,
                "fatemi_socie": fatemi_socie,
                "findley": findley,
                "friction_work": friction_work,
                "ruiz": ruiz,
                "swt": swt,
            },
            "path": {
                "duration": duration,
                "moves": moves,
                "displacement": displacement,
                "force": force,
                "falling_amplitude": falling_amplitude,
                "equal_peaks": equal_peaks,
                "cycles": cycles,
                "twist": twist,
                "torque": torque,
            },
        }
        return self._answer_of_contact(results.FrettingReply, "fretting", given, parts)

    def stress(
        self,
        points: int | None = None,
        *,
        fields: Sequence[types.Field] | None = None,
        radii: Quantities | None = None,
        x: Quantities | None = None,
        residual: bool | None = None,
    ) -> results.StressReply:
        """Get the stresses of a contact.

        Pressure, shear stress, slip and displacement over the radius in the present state, and the residual stress on
        request.

        Parameters
        ----------
        points : int
            Number of radii, evenly spaced from the centre to the edge of the contact, both included; for a line contact
            from the edge at −a to the edge at a.
        fields : Sequence[Field]
            Which fields are computed; if left out, `pressure` and `shear`. One of 'pressure', 'shear', 'slip',
            'displacement', 'hoop'.
        radii : Quantities
            Radii in a round contact, m; outside the contact the stresses are zero.
        x : Quantities
            Places along x in a line contact, m.
        residual : bool
            Also ask for the extrema of the shear stress.

        Returns
        -------
        StressReply
            The stresses of a contact, and their extrema if asked for.

        Raises
        ------
        InvalidInput
            With the pointer of the member that is wrong, and its range.

        Examples
        --------
        >>> import stickslip as ss
        >>> steel = ss.Body("210 GPa", 0.3)
        >>> ball = ss.Contact(ss.Sphere("10 mm"), [steel, steel], 0.3, normal_force="10 N")
        >>> shear = ball.stress(200).shear
        """
        given: Document = {
            "fields": fields,
            "points": points,
            "radii": radii,
            "x": x,
            "residual": residual,
        }
        parts: dict[str, Document] = {
        }
        return self._answer_of_contact(results.StressReply, "stress", given, parts)


@explained
class AsyncOfContact(ABC):
    """The calls that move a contact or read its present state."""

    @abstractmethod
    async def _answer_of_contact(self, kind: type[T], name: str, given: Document, parts: dict[str, Document]) -> T:
        """The reply to the members of a request, some of which are parts of one member."""

    async def move(
        self,
        displacement: Quantity | None = None,
        *,
        duration: Quantity | None = None,
        force: Quantity | None = None,
        indentation: Quantity | None = None,
        normal_force: Quantity | None = None,
        relative: bool | None = None,
        stress: int | types.StressRequest | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
        torque: Quantity | None = None,
        twist: Quantity | None = None,
    ) -> results.MoveReply:
        """`move`, awaited."""
        given: Document = {
            "displacement": displacement,
            "duration": duration,
            "force": force,
            "indentation": indentation,
            "normal_force": normal_force,
            "relative": relative,
            "stress": stress,
            "tolerance": tolerance,
            "torque": torque,
            "twist": twist,
        }
        parts: dict[str, Document] = {
        }
        return await self._answer_of_contact(results.MoveReply, "move", given, parts)

    async def path(
        self,
        displacement: Quantities | None = None,
        *,
        duration: Quantity | None = None,
        moves: Sequence[types.Move | Mapping[str, Any]] | None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        path: types.Path | None = None,
        steps: types.Steps | None = None,
        stress: int | types.StressRequest | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.PathReply:
        """`path`, awaited."""
        given: Document = {
            "path": path,
            "steps": steps,
            "stress": stress,
            "tolerance": tolerance,
        }
        parts: dict[str, Document] = {
            "path": {
                "duration": duration,
                "moves": moves,
                "displacement": displacement,
                "force": force,
                "falling_amplitude": falling_amplitude,
                "equal_peaks": equal_peaks,
                "cycles": cycles,
                "twist": twist,
                "torque": torque,
            },
        }
        return await self._answer_of_contact(results.PathReply, "path", given, parts)

    async def relax(
        self,
        reversals: int | None = None,
        *,
        dry_run: bool | None = None,
        end: types.ProtocolEnd | None = None,
        kind: types.ProtocolKind | None = None,
        steps: types.Steps | None = None,
        target: Quantity | None = None,
    ) -> results.RelaxReply:
        """`relax`, awaited."""
        given: Document = {
            "dry_run": dry_run,
            "end": end,
            "kind": kind,
            "reversals": reversals,
            "steps": steps,
            "target": target,
        }
        parts: dict[str, Document] = {
        }
        return await self._answer_of_contact(results.RelaxReply, "relax", given, parts)

    async def subsurface(
        self,
        *,
        body: types.BodyName | None = None,
        bulk: bool | types.Bulk | Mapping[str, Any] | None = None,
        fields: Sequence[types.SubsurfaceField] | None = None,
        line: Line | types.SubsurfaceLine | Mapping[str, Any] | None = None,
        plane: Plane | types.SubsurfacePlane | Mapping[str, Any] | None = None,
        points: Sequence[Quantities] | Quantities | None = None,
        poisson_ratio: Quantity | None = None,
        surface: Surface | types.SubsurfaceSurface | Mapping[str, Any] | None = None,
    ) -> results.SubsurfaceReply:
        """`subsurface`, awaited."""
        given: Document = {
            "body": body,
            "bulk": bulk,
            "fields": fields,
            "line": line,
            "plane": plane,
            "points": points,
            "poisson_ratio": poisson_ratio,
            "surface": surface,
        }
        parts: dict[str, Document] = {
        }
        return await self._answer_of_contact(results.SubsurfaceReply, "subsurface", given, parts)

    async def cycle(
        self,
        displacement: Quantity | Quantities | None = None,
        *,
        force: Quantity | Quantities | None = None,
        twist: Quantity | Quantities | None = None,
        torque: Quantity | Quantities | None = None,
        best_load: int | bool | types.BestLoadStudy | Mapping[str, Any] | None = None,
        frequency: Quantity | Quantities | None = None,
        frequency_response: types.FrequencyResponse | Mapping[str, Any] | None = None,
        harmonics: int | None = None,
        machine: Quantity | types.Machine | Mapping[str, Any] | None = None,
        map: types.FrettingMap | Mapping[str, Any] | None = None,
        normal: types.NormalOscillation | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
        work_density: int | types.WorkDensity | Mapping[str, Any] | None = None,
    ) -> results.CycleReply:
        """`cycle`, awaited."""
        given: Document = {
            "best_load": best_load,
            "frequency": frequency,
            "frequency_response": frequency_response,
            "harmonics": harmonics,
            "machine": machine,
            "map": map,
            "normal": normal,
            "tolerance": tolerance,
            "work_density": work_density,
        }
        parts: dict[str, Document] = {
            "drive": {
                "displacement": displacement,
                "force": force,
                "twist": twist,
                "torque": torque,
            },
        }
        return await self._answer_of_contact(results.CycleReply, "cycle", given, parts)

    async def fretting(
        self,
        displacement: Quantity | Quantities | None = None,
        *,
        crossland: types.Weighted | Mapping[str, Any] | None = None,
        dang_van: types.Weighted | Mapping[str, Any] | None = None,
        fatemi_socie: types.FatemiSocie | Mapping[str, Any] | None = None,
        findley: types.Findley | Mapping[str, Any] | None = None,
        friction_work: bool | types.SurfaceCriterion | Mapping[str, Any] | None = None,
        ruiz: bool | types.SurfaceCriterion | Mapping[str, Any] | None = None,
        swt: bool | types.StrainBased | Mapping[str, Any] | None = None,
        duration: Quantity | None = None,
        moves: Sequence[types.Move | Mapping[str, Any]] | None = None,
        force: Quantities | None = None,
        falling_amplitude: int | types.FallingAmplitude | Mapping[str, Any] | None = None,
        equal_peaks: int | types.EqualPeaks | Mapping[str, Any] | None = None,
        cycles: types.CyclicPath | Mapping[str, Any] | None = None,
        twist: Quantities | None = None,
        torque: Quantities | None = None,
        body: types.BodyName | None = None,
        bulk: Quantity | types.BulkCycle | Mapping[str, Any] | None = None,
        criteria: bool | types.Criteria | Mapping[str, Any] | None = None,
        critical_distance: types.CriticalDistance | Mapping[str, Any] | None = None,
        line: Line | types.SubsurfaceLine | Mapping[str, Any] | None = None,
        path: types.Path | None = None,
        plane: Plane | types.SubsurfacePlane | Mapping[str, Any] | None = None,
        points: Sequence[Quantities] | Quantities | None = None,
        poisson_ratio: Quantity | None = None,
        stress_paths: Sequence[int] | None = None,
        surface: Surface | types.SubsurfaceSurface | Mapping[str, Any] | None = None,
        tolerance: Quantity | None = None,
    ) -> results.FrettingReply:
        """`fretting`, awaited."""
        given: Document = {
            "body": body,
            "bulk": bulk,
            "criteria": criteria,
            "critical_distance": critical_distance,
            "line": line,
            "path": path,
            "plane": plane,
            "points": points,
            "poisson_ratio": poisson_ratio,
            "stress_paths": stress_paths,
            "surface": surface,
            "tolerance": tolerance,
        }
        parts: dict[str, Document] = {
            "criteria": {
                "crossland": crossland,
                "dang_van": dang_van,
                "fatemi_socie": fatemi_socie,
                "findley": findley,
                "friction_work": friction_work,
                "ruiz": ruiz,
                "swt": swt,
            },
            "path": {
                "duration": duration,
                "moves": moves,
                "displacement": displacement,
                "force": force,
                "falling_amplitude": falling_amplitude,
                "equal_peaks": equal_peaks,
                "cycles": cycles,
                "twist": twist,
                "torque": torque,
            },
        }
        return await self._answer_of_contact(results.FrettingReply, "fretting", given, parts)

    async def stress(
        self,
        points: int | None = None,
        *,
        fields: Sequence[types.Field] | None = None,
        radii: Quantities | None = None,
        x: Quantities | None = None,
        residual: bool | None = None,
    ) -> results.StressReply:
        """`stress`, awaited."""
        given: Document = {
            "fields": fields,
            "points": points,
            "radii": radii,
            "x": x,
            "residual": residual,
        }
        parts: dict[str, Document] = {
        }
        return await self._answer_of_contact(results.StressReply, "stress", given, parts)
