"""An FMU of `stickslip fmu` in FMPy: the archive is valid, its steps are those of the program, it goes back, and a mass on
it swings as `stickslip cycle` says. Takes the program, the archive, and the file with the definition."""

import json
import math
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave
from fmpy.validation import validate_fmu

program, archive, definition = sys.argv[1:]
contact = json.loads(Path(definition).read_text())
folder = Path(tempfile.mkdtemp())


def computed(name: str, body: dict) -> dict:
    """The reply of a command."""
    run = [program, name, "-", "--json"]
    return json.loads(subprocess.run(run, input=json.dumps(body), capture_output=True, text=True, check=True).stdout)


problems = validate_fmu(archive)
assert problems == [], problems
model = fmpy.read_model_description(archive)
names = {variable.name: variable for variable in model.modelVariables}
assert {"displacement", "normal_force", "force", "indentation_out", "friction", "radius"} < set(names), sorted(names)
assert names["force"].unit == "N" and "tangential" in names["force"].description.lower(), names["force"].description
assert float(names["normal_force"].start) == contact["preload"]["normal_force"]

unpacked = fmpy.extract(archive, str(folder / "fmu"))
assert "fmi2DoStep" in (folder / "fmu" / "sources" / "lib.rs").read_text()


def slave(**starts: float) -> FMU2Slave:
    """An instance after its initialization."""
    made = FMU2Slave(
        guid=model.guid, unzipDirectory=unpacked, modelIdentifier=model.coSimulation.modelIdentifier, instanceName="ball"
    )
    made.instantiate()
    made.setupExperiment(startTime=0.0)
    made.enterInitializationMode()
    for name, start in starts.items():
        put(made, name, start)
    made.exitInitializationMode()
    return made


def put(ball: FMU2Slave, name: str, value: float) -> None:
    ball.setReal([names[name].valueReference], [value])


def read(ball: FMU2Slave, *of: str) -> list[float]:
    return ball.getReal([names[name].valueReference for name in of])


def step(ball: FMU2Slave, displacement: float) -> float:
    """The force after a step to a displacement."""
    put(ball, "displacement", displacement)
    ball.doStep(currentCommunicationPoint=0.0, communicationStepSize=1.0)
    return read(ball, "force")[0]


# The steps are those of the program, to the last bit.
path = [3e-8, -2e-8, 5e-8, 1e-8, 2e-7, -1e-8]
states = computed("simulate", {"contact": contact, "path": {"displacement": path}})["steps"]
ball = slave()
for displacement, state in zip(path, states, strict=True):
    assert step(ball, displacement) == state["force"]
    outputs = ["indentation_out", "dissipated_energy", "elastic_energy", "stick_radius"]
    expected = [state[name.removesuffix("_out")] for name in outputs]
    assert read(ball, *outputs) == expected, (read(ball, *outputs), expected)

# It goes back to a state, and to one from bytes in another instance.
kept = ball.getFMUstate()
data = ball.serializeFMUstate(kept)
ahead = [step(ball, displacement) for displacement in path]
ball.setFMUstate(kept)
assert [step(ball, displacement) for displacement in path] == ahead
other = slave()
restored = other.deSerializeFMUstate(data)
other.setFMUstate(restored)
assert [step(other, displacement) for displacement in path] == ahead
ball.freeFMUstate(kept)
other.freeFMUstate(restored)

# A step that is refused has moved nothing; parameters and starts count.
before = read(ball, "force", "dissipated_energy")
try:
    step(ball, math.inf)
    raise SystemExit("an infinite displacement was taken")
except Exception as error:
    assert "fmi2DoStep" in str(error) or "Discard" in str(error) or "status 2" in str(error), error
assert read(ball, "force", "dissipated_energy") == before
smooth = slave(friction=0.1, normal_force=20.0, radius=0.02)
assert abs(step(smooth, 1e-5) / 2.0 - 1.0) < 1e-12
smooth.reset()
for each in (ball, other, smooth):
    each.terminate()
    each.freeInstance()

# By the loop of a master, with signals.
time = np.linspace(0.0, 1.0, 101)
signal = np.array([(t, 4e-8 * math.sin(2 * math.pi * t)) for t in time], dtype=[("time", float), ("displacement", float)])
result = fmpy.simulate_fmu(archive, stop_time=1.0, output_interval=0.01, input=signal, output=["force"])
assert len(result) >= 101 and 0.5 < np.abs(result["force"]).max() <= 3.0

# A mass on the contact: central differences from rest until the oscillation is steady.
mass, drive = 0.5, 1.5
study = {"mass": mass, "drive_force": drive}
natural = computed("cycle", {"contact": contact, "drive": {"displacement": 1e-8}, "frequency_response": study})
natural = natural["frequency_response"]["natural_frequency"]
study["frequencies"] = [0.5 * natural, 0.9 * natural]
points = computed("cycle", {"contact": contact, "drive": {"displacement": 1e-8}, "frequency_response": study})
for point in points["frequency_response"]["points"]:
    ball = slave()
    laps, parts = 60, 400
    dt = 1.0 / (point["frequency"] * parts)
    here, speed, last = 0.0, 0.0, []
    force = 0.0
    for index in range(laps * parts):
        # Leapfrog.
        speed += dt * (drive * math.cos(2 * math.pi * index / parts) - force) / mass
        here += dt * speed
        force = step(ball, here)
        if index >= (laps - 1) * parts:
            last.append(here)
    peak = 0.5 * (max(last) - min(last))
    print(f"{point['frequency']:.1f} Hz: peak {peak:.6e} m, by the program {point['peak']:.6e} m")
    assert abs(peak / point["peak"] - 1.0) < 2e-3, (peak, point)
    ball.freeInstance()

shutil.rmtree(folder)
print("the FMU works")
