"""Runs the reference problems on codes, and prints errors and times.

    python -m stickslip.reference run --code cli                  # the program stickslip on the path
    python -m stickslip.reference run --code package --code springs --markdown table.md --picture table.svg
    python -m stickslip.reference run --code service=http://localhost:8080 --below 1e-10

The problems are the documents of the folder `reference` of the repository (`--problems FOLDER` elsewhere). A code is a
function that takes the name of a problem and the inputs of a case, and gives its outputs by name, or raises `Unstated`
if it has no words for the problem: its cell then stays empty. To try your own code, name a file with such a function
`code` by `--code FILE.py`; `reference/codes` has those of Tamaas, ContactMechanics, slippy and LAMMPS.

Beside NumPy nothing is needed; this file runs alone, too (`python reference.py run --code cli=PROGRAM`), and draws the
picture if matplotlib is installed.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import math
import os
import platform
import subprocess
import sys
import time
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Document = dict[str, Any]
Array = NDArray[np.float64]
#: A code: the name of a problem and the inputs of a case in, outputs by name out.
Code = Callable[[str, Document], Document]
#: What stickslip computes: the name of a computation and its request in, the reply out.
Compute = Callable[[str, Document], Document]
#: The name among outputs under which a code may state its own largest error, where it does not call itself exact.
STATED = "stated_error"


class Unstated(NotImplementedError):
    """The code cannot state this problem; any `NotImplementedError` says the same."""


# ------------------------------------------------------------------------------------------------------ stickslip


def effective(inputs: Document) -> Document:
    """The contact of a problem with moduli of the pair."""
    e_star = inputs["e_star"]
    contact = {
        "profile": inputs.get("profile") or {"type": "sphere", "radius": inputs["radius"]},
        "material": {"effective": {"e_star": e_star, "g_star": inputs.get("g_star", e_star)}},
        "friction": inputs.get("friction", 0.3),
    }
    if contact["profile"]["type"] == "ellipsoid":
        # The axis of a motion that does not take place, and a body of this modulus.
        contact["profile"] = {**contact["profile"], "direction": "x"}
        contact["material"] = {"bodies": [{"youngs_modulus": e_star, "poisson_ratio": 0.0}, "rigid"]}
    load = "normal_force" if "normal_force" in inputs else "indentation"
    return {**contact, "preload": {load: inputs[load]}}


def stated(*replies: Document, names: tuple[str, ...] = ("force_error",)) -> Document:
    """What the code says of its own error, where it does not call itself exact."""
    return {STATED: max(float(reply["accuracy"][name]) for reply in replies for name in names)}


def impact(inputs: Document, count: int) -> tuple[Array, float]:
    """The indentation of a ball that strikes a plane, after 1, 2, …, `count` - 1 even steps, and the duration."""
    stiffness = 4 / 3 * inputs["e_star"] * inputs["radius"] ** 0.5 / inputs["mass"]
    speed = inputs["normal_velocity"]
    deepest = (5 * speed**2 / (4 * stiffness)) ** 0.4
    # int (1 - s^(5/2))^(-1/2) ds from 0 to 1, a beta function.
    duration = 2 * math.gamma(0.4) * math.gamma(0.5) / math.gamma(0.9) * 0.4 * deepest / speed
    finer = 40
    h, state, found = duration / count / finer, np.array([0.0, speed]), []

    def rate(state: Array) -> Array:
        return np.array([state[1], -stiffness * max(state[0], 0.0) ** 1.5])

    for step in range(1, count // 2 * finer + 1):
        first = rate(state)
        second = rate(state + h / 2 * first)
        third = rate(state + h / 2 * second)
        state = state + h / 6 * (first + 2 * second + 2 * third + rate(state + h * third))
        if step % finer == 0:
            found.append(float(state[0]))
    return np.array([*found, *found[-2::-1]]), duration


def steps(reply: Document, *names: str) -> Document:
    """Columns of the states after each move."""
    return {name: [step[name] for step in reply["steps"]] for name in names}


def stickslip(compute: Compute) -> Code:
    """The problems as requests of stickslip, however it is called."""

    def simulate(contact: Document, **rest: Any) -> Document:
        return compute("simulate", {"contact": contact, **rest})

    def normal_contact(inputs: Document) -> Document:
        radii = inputs.get("radii")
        asked = {"stress": {"radii": radii, "fields": ["pressure"]}} if radii else {}
        reply = simulate(effective(inputs), path={"displacement": [0.0]}, **asked)
        found = steps(reply, "contact_radius", "indentation")
        return {**found, "pressure": reply["stress"]["pressure"]} if radii else {"indentation": found["indentation"]}

    def first_loading(inputs: Document) -> Document:
        reply = simulate(effective(inputs), path={"force": inputs["forces"]}, stress={"radii": inputs["radii"]})
        return {**steps(reply, "displacement", "stick_radius"), "shear": reply["stress"]["shear"]}

    def oblique_paths(inputs: Document) -> Document:
        moves = [{"indentation": d, "displacement": u} for d, u in inputs["moves"]]
        return steps(simulate(effective(inputs), path={"moves": moves}), "normal_force", "force")

    def displaced(inputs: Document) -> Document:
        contact = effective(inputs)
        if "shear_strength" in inputs:
            contact["shear_strength"] = inputs["shear_strength"]
        return steps(simulate(contact, path={"displacement": inputs["displacements"]}), "force")

    def paper_figures(inputs: Document) -> Document:
        path, stress = {"displacement": inputs["displacements"]}, {"radii": inputs["radii"]}
        reply = simulate(effective(inputs), path=path, stress=stress)
        return {**steps(reply, "force"), "shear": reply["stress"]["shear"]}

    def falling_amplitude(inputs: Document) -> Document:
        path, stress = {"displacement": inputs["displacements"]}, {"radii": inputs["radii"]}
        reply = simulate(effective(inputs), path=path, stress=stress, residual=True, steps="last")
        largest = [reply["residual"]["max"]]
        return {**steps(reply, "force"), "shear": reply["stress"]["shear"], "largest_shear": largest}

    def cycles(inputs: Document) -> list[Document]:
        kind = "force" if "force_amplitudes" in inputs else "displacement"
        drive = {kind: inputs[f"{kind}_amplitudes"]}
        request = {"contact": effective(inputs), "drive": drive, "harmonics": 3}
        found: list[Document] = compute("cycle", request)["cycles"]
        return found

    def loops(inputs: Document) -> Document:
        names = ("dissipated_energy", "displacement_amplitude", "force_amplitude")
        found = cycles(inputs)
        return {name: [cycle[name] for cycle in found] for name in names}

    def harmonics(inputs: Document) -> Document:
        found = cycles(inputs)
        parts = [(order, part) for order in (1, 3) for part in ("in_phase", "quadrature")]
        return {
            f"{part}_{order}": [
                next(one[part] for one in cycle["harmonics"] if one["order"] == order) for cycle in found
            ]
            for order, part in parts
        }

    def line_contact(inputs: Document) -> Document:
        body = {name: inputs[name] for name in ("youngs_modulus", "poisson_ratio")}
        contact = {
            "profile": {"type": "cylinder", "radius": inputs["radius"], "length": inputs["length"]},
            "material": {"bodies": [body, body]},
            "friction": inputs["friction"],
            "preload": {"normal_force": inputs["normal_force"]},
            "bulk": {"body": "second", "stress_per_force": inputs["stress_per_force"]},
        }
        below = {"body": "second", "points": inputs["points"]}
        reply = simulate(contact, path={"force": inputs["forces"]}, stress={"x": inputs["x"]}, subsurface=below)
        tensor = {name: reply["subsurface"][name] for name in ("xx", "yy", "zz", "xz")}
        width = [reply["steps"][-1]["contact_radius"]]
        return {"contact_half_width": width, "shear": reply["stress"]["shear"], **tensor}

    def pad(inputs: Document) -> Document:
        names = ("flat_half_width", "edge_radius", "length")
        contact = effective({**inputs, "profile": {"type": "rounded_pad", **{name: inputs[name] for name in names}}})
        reply = simulate(contact, path={"displacement": [0.0]}, stress={"x": inputs["x"], "fields": ["pressure"]})
        return {"contact_half_width": steps(reply, "contact_radius")["contact_radius"], **reply["stress"]}

    def stress_in_depth(inputs: Document) -> Document:
        below = {"body": "second", "points": inputs["points"], "poisson_ratio": inputs["poisson_ratio"]}
        below["fields"] = ["tensor", "von_mises"]
        path = {"displacement": inputs["displacements"]}
        found: Document = simulate(effective(inputs), path=path, subsurface=below)["subsurface"]
        return found

    def wear_limit(inputs: Document) -> Document:
        drive = {"displacement": inputs["displacement_amplitude"]}
        reply = compute("wear", {"contact": effective(inputs), "drive": drive, "hold": "indentation"})
        numbers = {name: [reply[name]] for name in ("stick_radius", "worn_radius", "force_amplitude", "removed_volume")}
        return {**numbers, "normal_force": [reply["normal_force"]["after"]]}

    def conductance(inputs: Document) -> Document:
        contact = {
            "profile": {"type": "sphere", "radius": inputs["radius"]},
            "material": {"bodies": [inputs["body"], inputs["body"]]},
            "friction": 0.3,
            "preload": {"normal_force": inputs["normal_forces"][0]},
        }
        reply = simulate(contact, path={"moves": [{"normal_force": load} for load in inputs["normal_forces"]]})
        return steps(reply, "electrical_conductance", "thermal_conductance")

    def sliders(inputs: Document) -> Document:
        reply = compute("sliders", {"contact": effective(inputs), "count": inputs["count"]})
        return {**reply, "force_error": [reply["force_error"]]}

    def rolling(inputs: Document) -> Document:
        profile = {"type": "cylinder", "radius": inputs["radius"], "length": inputs["length"]}
        contact = effective({**inputs, "profile": profile})
        replies = [compute("rolling", {"contact": contact, "ratio": ratio}) for ratio in inputs["ratios"]]
        widths = [reply["stick"][1] - reply["stick"][0] for reply in replies]
        return {"creep": [reply["creep"] for reply in replies], "stick_width": widths}

    def turns(inputs: Document, radii: list[float], tolerance: float, *after: int) -> tuple[Document, Document]:
        """The force so many 64ths of a turn after its beginning and the work of a turn, steady, and the reply."""
        path = {"ellipse": {"radii": radii, "turns": 3, "steps_per_turn": 64}}
        reply = simulate(effective(inputs), path=path, tolerance=tolerance)
        x, y = zip(*(reply["steps"][place - 65]["force"] for place in after), strict=True)
        return {"force_x": [*x], "force_y": [*y], "turn_work": reply["turn_losses"][-1:]}, reply

    def circular_motion(inputs: Document) -> Document:
        found, replies = zip(*(turns(inputs, [radius, radius], 1e-3, 64) for radius in inputs["radii"]), strict=True)
        whole = {name: [one[name][0] for one in found] for name in found[0]}
        return whole | stated(*replies, names=("force_error", "work_error"))

    def elliptic_motion(inputs: Document) -> Document:
        # Rings that would halve the error below the vertical edge of a punch take a hundred times as long.
        found, reply = turns(inputs, inputs["radii"], 1e-2, 16, 32)
        return found | stated(reply, names=("force_error", "work_error"))

    def twist(inputs: Document) -> Document:
        contact = effective(inputs)
        contact["material"]["effective"]["shear_modulus"] = inputs["shear_modulus"]
        hoop = {"radii": inputs["radii"], "fields": ["hoop"]}
        reply = simulate(contact, path={"twist": inputs["twists"]}, stress=hoop)
        top = inputs["twists"][0]
        first, _, last = simulate(contact, path={"twist": [top, -top, top]})["steps"]
        return {
            **steps(reply, "torque"),
            "gross_slip_torque": [reply["contact"]["gross_slip_torque"]],
            "hoop": reply["stress"]["hoop"],
            "cycle_work": [last["dissipated_energy"] - first["dissipated_energy"]],
        }

    def adhesion(inputs: Document) -> Document:
        loads = inputs.get("normal_forces")
        contact = effective({**inputs, "friction": 0, "normal_force": loads[0] if loads else inputs["normal_force"]})
        contact |= {"adhesion": {"work": inputs["work"]}, "shear_strength": inputs["shear_strength"]}
        if not loads:
            return steps(simulate(contact, path={"displacement": inputs["displacements"]}), "force")
        reply = simulate(contact, path={"moves": [{"normal_force": load} for load in loads]})
        found = steps(reply, "contact_radius", "indentation")
        return {**found, "pull_off_force": [reply["contact"]["pull_off_force"]]}

    def relaxation(inputs: Document) -> Document:
        times = inputs["times"]
        spans = [after - before for before, after in zip([0.0, *times], times, strict=False)]
        contact = {**effective(inputs), "prony": inputs["prony"]}
        if "to" in inputs:
            moves = [{"duration": span} for span in spans]
            begin, end, pace = inputs["indentation"], inputs["to"], inputs["in"]
            for move, time in zip(moves, times, strict=True):
                move["indentation"] = begin + (end - begin) * min(time / pace, 1.0)
        elif "speed" in inputs:
            pairs = zip(spans, times, strict=True)
            moves = [{"duration": span, "displacement": inputs["speed"] * time} for span, time in pairs]
            moves.insert(0, {"duration": 1e3 * max(term["time"] for term in inputs["prony"])})
        else:
            moves = [{"duration": span, "normal_force": inputs["normal_force"]} for span in spans]
        reply = simulate(contact, path={"moves": moves})
        found = steps(reply, "normal_force", "force", "indentation")
        return {name: values[-len(times) :] for name, values in found.items()} | stated(reply)

    def struck(inputs: Document, speed: float, count: int, force: Array) -> tuple[float, Array]:
        """The velocity after an impact in so many steps, and the forces; each iteration is one path of the contact."""
        moving, depth, duration = inputs["mass"] * 2 / 7, *impact(inputs, count)
        h, force = duration / count, np.interp(np.arange(1, count) / count, np.linspace(0, 1, len(force)), force)
        # A contact begins with an indentation, however small.
        contact = effective({**inputs, "indentation": 1e-6 * depth[0]})
        for _ in range(40):
            velocity = speed - h / moving * np.cumsum(force)
            displacement = h * (speed + np.append(0.0, np.cumsum(velocity[:-1])))
            moves = [{"indentation": d, "displacement": u} for d, u in zip(depth, displacement, strict=True)]
            reply = simulate(contact, path={"moves": moves})
            before, force = force, np.array([step["force"] for step in reply["steps"]])
            if np.abs(force - before).max() < 1e-13 * np.abs(force).max():
                return float(velocity[-1]), np.array([0.0, *force, 0.0])
        raise RuntimeError("the impact does not converge")

    def oblique_impact(inputs: Document) -> Document:
        found, change = [], 0.0
        for speed in inputs["tangential_velocities"]:
            coarse, forces = struck(inputs, speed, 250, np.zeros(2))
            fine, _ = struck(inputs, speed, 500, forces)
            found.append(fine + (fine - coarse) / 3)
            change = max(change, abs(fine - coarse))
        unit = inputs["friction"] * inputs["normal_velocity"]
        return {"rebound_velocity": found, "duration": [impact(inputs, 250)[1]], STATED: change / unit}

    problems: dict[str, Callable[[Document], Document]] = {
        "oblique-impact": oblique_impact,
        "circular-motion": circular_motion,
        "elliptic-motion": elliptic_motion,
        "twist": twist,
        "adhesion": adhesion,
        "relaxation": relaxation,
        "normal-contact": normal_contact,
        "first-loading": first_loading,
        "oblique-paths": oblique_paths,
        "random-turns": displaced,
        "falling-amplitude": falling_amplitude,
        "paper-figures": paper_figures,
        "loops": loops,
        "harmonics": harmonics,
        "line-contact": line_contact,
        "pad": pad,
        "stress-in-depth": stress_in_depth,
        "wear-limit": wear_limit,
        "shear-strength": displaced,
        "conductance": conductance,
        "sliders": sliders,
        "rolling": rolling,
    }

    def code(problem: str, inputs: Document) -> Document:
        if problem not in problems:
            raise Unstated(problem)
        return problems[problem](inputs)

    return code


def by_program(program: str) -> Compute:
    """The command line."""

    def compute(name: str, request: Document) -> Document:
        run = subprocess.run([program, name, "-", "--json"], input=json.dumps(request), capture_output=True, text=True)
        if run.returncode:
            raise RuntimeError(run.stderr or run.stdout)
        reply: Document = json.loads(run.stdout)
        return reply

    return compute


def by_service(base: str) -> Compute:
    """A running service; `STICKSLIP_KEY` is its key, if it wants one."""

    def compute(name: str, request: Document) -> Document:
        headers = {"content-type": "application/json"}
        if "STICKSLIP_KEY" in os.environ:
            headers["authorization"] = "Bearer " + os.environ["STICKSLIP_KEY"]
        call = urllib.request.Request(f"{base.rstrip('/')}/{name}", json.dumps(request).encode(), headers)
        with urllib.request.urlopen(call) as response:
            reply: Document = json.load(response)
        return reply

    return compute


def by_package() -> Compute:
    """The package, in this process."""
    from stickslip import Local

    local = Local()

    def compute(name: str, request: Document) -> Document:
        reply: Document = local.compute(name, request)
        return reply

    return compute


# --------------------------------------------------------------------------------------------------------- others


def moves_of(problem: str, inputs: Document) -> tuple[float, list[tuple[float, float]]]:
    """The indentation at the start, and pairs of indentation and displacement: of a ball on a path of displacements."""
    if problem not in ("oblique-paths", "random-turns", "falling-amplitude", "paper-figures"):
        raise Unstated(problem)
    if "moves" in inputs:
        return inputs["indentation"], [(d, u) for d, u in inputs["moves"]]
    e_star, radius = inputs["e_star"], inputs["radius"]
    start = (3 * inputs["normal_force"] / (4 * e_star * radius**0.5)) ** (2 / 3)
    return start, [(start, u) for u in inputs["displacements"]]


def springs(count: int = 10_000) -> Code:
    """Springs of the method of dimensionality reduction, clamped after each move (Kraft & Pohrt 2016, corrected)."""

    def code(problem: str, inputs: Document) -> Document:
        start, moves = moves_of(problem, inputs)
        e_star, g_star, mu, radius = (inputs[name] for name in ("e_star", "g_star", "friction", "radius"))
        m, widest = mu * e_star / g_star, max([start, *(d for d, _ in moves)])
        width = (widest * radius) ** 0.5 / count
        level = ((np.arange(count) + 0.5) * width) ** 2 / radius
        w, before, depth = np.zeros(count), 0.0, start
        loads, forces = [], []
        for d, u in moves:
            # A spring that is met on the way moves with the rest of it.
            part = np.where(level > depth, np.clip((d - level) / (d - depth), 0, 1), 1.0) if d > depth else 1.0
            room = np.maximum(d - level, 0)
            w = np.clip(w + (u - before) / m * part, -room, room)
            before, depth = u, d
            loads.append(float(2 * e_star * room.sum() * width))
            forces.append(float(2 * g_star * m * w.sum() * width))
        if "radii" not in inputs:
            return {"normal_force": loads, "force": forces}
        # Displacements are straight between the springs: an arcosh for each.
        x = np.append(np.append(0.0, (np.arange(count) + 0.5) * width), count * width)
        values = m * np.append(np.append(w[0], w), 0.0)
        slopes = np.diff(values) / np.diff(x)
        shear = []
        for r in inputs["radii"]:
            # At the centre the integral of slope/x is that from the first spring on.
            reach = np.arccosh(np.maximum(x / r, 1)) if r > 0 else np.log(np.maximum(x, x[1]))
            shear.append(float(-g_star / np.pi * (slopes * np.diff(reach)).sum()))
        return {"force": forces[-1:] if problem == "falling-amplitude" else forces, "shear": shear}

    return code


def dragged(inputs: Document, steps: int = 1000) -> Document:
    """A spring with a cap on an ellipse, in so many steps for each turn: the force is drawn back along itself."""
    load, limit = inputs["normal_force"], inputs["friction"] * inputs["normal_force"]
    ball = (3 * load * inputs.get("radius", 0) / (4 * inputs["e_star"])) ** (1 / 3)
    stiffness = 2 * inputs["g_star"] * inputs.get("profile", {}).get("radius", ball)
    force, forces, work = 0j, list[complex](), 0.0
    turn = np.exp(2j * np.pi * np.arange(steps + 1) / steps)
    for chord in np.tile(np.diff(inputs["radii"][0] * turn.real + 1j * inputs["radii"][1] * turn.imag), 4):
        force += stiffness * chord
        over = max(abs(force) / limit, 1.0)
        force, work = force / over, (work if len(forces) % steps else 0.0) + limit * (over - 1) * limit / stiffness
        forces.append(force)
    found = np.array(forces)[[-1 - 3 * steps // 4, -1 - steps // 2]]
    return {"force_x": [*found.real], "force_y": [*found.imag], "turn_work": [work]}


def capped_spring(problem: str, inputs: Document) -> Document:
    """One spring with the tangent stiffness 2 G* a and the cap mu F_N, the law of many particle codes."""
    if problem == "elliptic-motion":
        return dragged(inputs)
    start, moves = moves_of(problem, inputs)
    e_star, g_star, mu, radius = (inputs[name] for name in ("e_star", "g_star", "friction", "radius"))
    force, before, depth = 0.0, 0.0, start
    loads, forces = [], []
    for target, displacement in moves:
        # In a hundred steps, as a particle code would.
        for part in np.linspace(0, 1, 101)[1:]:
            d, u = depth + (target - depth) * part, (displacement - before) * 0.01
            limit = mu * 4 / 3 * e_star * radius**0.5 * d**1.5
            force = float(np.clip(force + 2 * g_star * (radius * d) ** 0.5 * u, -limit, limit))
        before, depth = displacement, target
        loads.append(4 / 3 * e_star * radius**0.5 * target**1.5)
        forces.append(force)
    return {"normal_force": loads, "force": forces} if problem != "falling-amplitude" else {"force": forces[-1:]}


def code_in(path: Path) -> Code:
    """The function `code` of a file."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None:
        raise SystemExit(f"{path} is not a file of Python")
    module = importlib.util.module_from_spec(spec)
    # For files beside it, and not for those beside this one, which have names of other packages.
    beside = Path(__file__).resolve().parent
    sys.path[:] = [folder for folder in sys.path if Path(folder).resolve() != beside] + [str(path.parent)]
    spec.loader.exec_module(module)
    code: Code = module.code
    print(f"{path.stem}: {getattr(module, 'VERSION', 'version not stated')}")
    return code


def code_named(name: str) -> Code:
    """A code by its name on the command line: `name`, `name=where`, or a file of Python."""
    if name.endswith(".py"):
        return code_in(Path(name))
    kind, _, where = name.partition("=")
    if kind == "cli":
        return stickslip(by_program(where or "stickslip"))
    if kind == "service":
        return stickslip(by_service(where or "http://localhost:8080"))
    if kind == "package":
        return stickslip(by_package())
    if kind == "springs":
        return springs(int(where or 10_000))
    if kind == "capped-spring":
        return capped_spring
    raise SystemExit(f"{name} is no code; codes are cli, service, package, springs, capped-spring, and files FILE.py")


# ---------------------------------------------------------------------------------------------------------- running


def read_problems(folder: Path) -> list[Document]:
    """The documents of a folder, sorted by name."""
    documents = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(folder.glob("*.json"))]
    if not documents:
        raise SystemExit(f"there are no problems in {folder}: name their folder by --problems")
    return documents


def error_of(expected: Document, found: list[float | None]) -> float:
    """The largest difference from the values of an output, over its scale."""
    if len(found) != len(expected["values"]) or any(value is None for value in found):
        return float("inf")
    return float(np.abs(np.array(found, dtype=float) - expected["values"]).max() / expected["scale"])


class Row(NamedTuple):
    """How a code did on a problem: the largest error over the outputs it gives, and the time of all cases, s.

    Both are None for a problem that it cannot state. `stated` is what it says of its own error, 0 where it calls itself
    exact. Outputs that it leaves out, `missing`, do not count as errors.
    """

    problem: str
    error: float | None
    seconds: float | None
    stated: float
    missing: list[str]


def solve(code: Code, problem: Document) -> Row:
    """A code on a problem."""
    worst, seconds, stated, compared, missing = 0.0, 0.0, 0.0, 0, []
    try:
        for case in problem["cases"]:
            begin = time.perf_counter()
            found = code(problem["id"], case["inputs"])
            seconds += time.perf_counter() - begin
            stated = max(stated, found.get(STATED, 0.0))
            for name, expected in case["outputs"].items():
                if name in found:
                    compared += 1
                    worst = max(worst, error_of(expected, found[name]))
                else:
                    missing.append(f"{case['name']}: {name}")
    except NotImplementedError:
        compared = 0
    if not compared:
        return Row(problem["id"], None, None, 0.0, [])
    return Row(problem["id"], worst, seconds, stated, missing)


def run(code: Code, problems: list[Document]) -> Iterator[Row]:
    """A code on every problem."""
    return (solve(code, problem) for problem in problems)


def shortcomings(row: Row, below: float) -> list[str]:
    """What is missing, and an error that is neither below the limit nor within what the code states."""
    if row.error is None:
        return ["not stated"]
    large = [] if row.error < max(below, row.stated) else [f"error {row.error:.3g}, stated {row.stated:.3g}"]
    return large + [f"{left} is missing" for left in row.missing]


Table = dict[str, dict[str, tuple[float, float]]]


def markdown(table: Table, problems: list[Document]) -> str:
    """Errors and times, a row for each problem; empty where a code cannot state it."""
    lines = ["| problem | " + " | ".join(table) + " |", "|---" * (len(table) + 1) + "|"]
    for problem in problems:
        cells = [table[code].get(problem["id"]) for code in table]
        shown = ["" if cell is None else f"{cell[0]:.1e}, {1e3 * cell[1]:.3g} ms" for cell in cells]
        lines.append(f"| {problem['id']} | " + " | ".join(shown) + " |")
    return "\n".join(lines) + "\n"


def picture(table: Table, path: str) -> None:
    """Errors over times, a mark for each problem and a colour for each code."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 4.5), layout="constrained")
    for code, row in table.items():
        errors = [max(error, 1e-17) for error, _ in row.values()]
        axes.loglog([seconds for _, seconds in row.values()], errors, "o", label=code)
    axes.set(xlabel="time of all cases of a problem (s)", ylabel="largest error")
    figure.legend(loc="outside right upper")
    figure.savefig(path)


def main(arguments: list[str] | None = None) -> int:
    """The command line."""
    parser = argparse.ArgumentParser(prog="python -m stickslip.reference", description="Runs the reference problems.")
    parser.add_argument("command", choices=["run"])
    parser.add_argument(
        "--code", action="append", required=True, help="cli[=PROGRAM], service[=URL], package, FILE.py, …"
    )
    parser.add_argument("--problems", type=Path, default=Path("reference"), help="the folder of the documents")
    parser.add_argument("--results", type=Path, help="a file of results, which is read, extended and written")
    parser.add_argument("--markdown", help="a file for the table")
    parser.add_argument("--picture", help="a file for the picture, svg or png; needs matplotlib")
    parser.add_argument(
        "--below", type=float, help="fail if an error is neither below this nor stated, or anything is missing"
    )
    asked = parser.parse_args(arguments)
    problems = read_problems(asked.problems)
    kept = asked.results is not None and asked.results.exists()
    table: Table = json.loads(asked.results.read_text(encoding="utf-8")) if kept else {}
    bad = []
    for name in asked.code:
        rows = list(run(code_named(name), problems))
        table[Path(name.partition("=")[0]).stem.removeprefix("with_")] = {
            row.problem: (row.error, row.seconds) for row in rows if row.error is not None and row.seconds is not None
        }
        if asked.below is not None:
            bad += [f"{name}, {row.problem}: {text}" for row in rows for text in shortcomings(row, asked.below)]
    if asked.results:
        asked.results.write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")
    printed = markdown(table, problems)
    versions = ", ".join(sorted({problem["version"] for problem in problems}))
    print(f"reference problems {versions}; Python {platform.python_version()}, NumPy {np.__version__}\n")
    print(printed, end="")
    if asked.markdown:
        Path(asked.markdown).write_text(printed, encoding="utf-8")
    if asked.picture:
        picture(table, asked.picture)
    for line in bad:
        print(line, file=sys.stderr)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
