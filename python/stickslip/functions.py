"""The computations of this process as functions. Written by `tools/generate.py`."""

from .engine import Local

_local = Local()
compute = _local.compute
compute_bytes = _local.compute_bytes
accuracy = _local.accuracy
cycle = _local.cycle
fit = _local.fit
fit_loop = _local.fit_loop
fit_profile = _local.fit_profile
fretting = _local.fretting
protocols = _local.protocols
rolling = _local.rolling
simulate = _local.simulate
sliders = _local.sliders
sweep = _local.sweep
wear = _local.wear

__all__ = [
    "compute",
    "compute_bytes",
    "accuracy",
    "cycle",
    "fit",
    "fit_loop",
    "fit_profile",
    "fretting",
    "protocols",
    "rolling",
    "simulate",
    "sliders",
    "sweep",
    "wear",
]
