"""Frictional contact of two elastic bodies, exactly: in this process, or on a server.

    import stickslip as ss

    steel = ss.Body("210 GPa", 0.3)
    contact = ss.Contact(ss.Sphere("10 mm"), [steel, ss.RIGID], friction=0.3, normal_force="10 N")
    contact.path(falling_amplitude=20)
    contact.residual().to_frame()

Numbers are SI, or texts and quantities of pint with their units. Positive displacement gives positive force and
positive shear stress.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .bodies import RIGID, Body, Definition, Moduli
from .contact import Contact
from .contacts import Contacts
from .engine import Engine, Local
from .errors import (
    Conflict,
    Fault,
    InvalidInput,
    NotAllowed,
    NotFound,
    Overloaded,
    ServerError,
    StickslipError,
    StickslipWarning,
    TooMuchWork,
)
from .instruments import Loop, Scan, read_loop, read_scan
from .profiles import (
    Asperities,
    Cone,
    Ellipsoid,
    ExactSphere,
    FlatPunch,
    LoadCurve,
    PowerLaw,
    Profile,
    RoundedCone,
    RoundedPunch,
    Sphere,
    Sum,
    Tabulated,
    TruncatedCone,
    TruncatedSphere,
)
from .result import Result

if TYPE_CHECKING:
    from .client import Client, RemoteContact
    from .server import ServedClient

_local = Local()
compute = _local.compute
compute_bytes = _local.compute_bytes
simulate = _local.simulate
cycle = _local.cycle
fretting = _local.fretting
wear = _local.wear
protocols = _local.protocols
accuracy = _local.accuracy
fit_loop = _local.fit_loop
fit_profile = _local.fit_profile
sweep = _local.sweep


def connect(url: str, key: str | None = None, **options: Any) -> Client:
    """A client of the service at a URL, with the same methods as this module."""
    from .client import Client

    return Client(url, key, **options)


def serve(store: str = "memory:", port: int = 0) -> ServedClient:
    """Starts a server in this process and connects to it: `with serve() as api:`."""
    from .server import serve

    return serve(store, port)


def __getattr__(name: str) -> Any:
    if name in ("Client", "RemoteContact"):
        from . import client

        return getattr(client, name)
    raise AttributeError(f"module 'stickslip' has no attribute {name!r}")


__all__ = [
    "RIGID",
    "Asperities",
    "Body",
    "Client",
    "Cone",
    "Conflict",
    "Contact",
    "Contacts",
    "Definition",
    "Ellipsoid",
    "Engine",
    "ExactSphere",
    "Fault",
    "FlatPunch",
    "InvalidInput",
    "LoadCurve",
    "Local",
    "Loop",
    "Moduli",
    "NotAllowed",
    "NotFound",
    "Overloaded",
    "PowerLaw",
    "Profile",
    "RemoteContact",
    "Result",
    "RoundedCone",
    "RoundedPunch",
    "Scan",
    "ServerError",
    "Sphere",
    "StickslipError",
    "StickslipWarning",
    "Sum",
    "Tabulated",
    "TooMuchWork",
    "TruncatedCone",
    "TruncatedSphere",
    "accuracy",
    "compute",
    "compute_bytes",
    "connect",
    "cycle",
    "fit_loop",
    "fit_profile",
    "fretting",
    "protocols",
    "read_loop",
    "read_scan",
    "serve",
    "simulate",
    "sweep",
    "wear",
]
