"""Frictional contact of two elastic bodies, exactly: in this process, or on a server.

    import stickslip as ss

    steel = ss.Body("210 GPa", 0.3)
    contact = ss.Contact(ss.Sphere("10 mm"), [steel, steel], friction=0.3, normal_force="10 N")
    contact.path(falling_amplitude=20)
    contact.residual().to_frame()

Numbers are SI, or texts and quantities of pint with their units. Positive displacement gives positive force and
positive shear stress.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import functions, profiles
from . import request_types as types
from ._native import VERSION as __version__
from .bodies import RIGID, Body, Moduli
from .contact import Contact
from .contacts import Contacts, PlanarContacts
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
from .functions import *
from .instruments import Loop, Scan, read_loop, read_scan
from .known_materials import MATERIALS as materials
from .known_materials import KnownMaterial
from .profiles import *
from .result import Named, Record, Result, Rows

if TYPE_CHECKING:
    from .client import Client, RemoteContact
    from .server import ServedClient


def connect(url: str, key: str | None = None, *, timeout: float = 90.0, retries: int = 4) -> Client:
    """A client of the service at a URL, with the same methods as this module.

    Parameters
    ----------
    url : str
        Where the service is, such as `http://localhost:8080`, or `localhost:8080`.
    key : str
        A key of access, if the service asks for one.
    timeout : float
        How long to wait for a reply, s.
    retries : int
        How often a request is repeated if the service is busy or cannot be reached.
    """
    from .client import Client

    return Client(url, key, timeout=timeout, retries=retries)


def serve(store: str = "memory:", port: int = 0) -> ServedClient:
    """Starts a server in this process and connects to it: `with serve() as api:`."""
    from .server import serve

    return serve(store, port)


def __dir__() -> list[str]:
    return sorted(__all__)


def __getattr__(name: str) -> Any:
    if name in ("Client", "RemoteContact"):
        from . import client

        return getattr(client, name)
    raise AttributeError(f"module 'stickslip' has no attribute {name!r}")


__all__ = [
    "RIGID",
    "Body",
    "Client",
    "Conflict",
    "Contact",
    "Contacts",
    "Engine",
    "Fault",
    "InvalidInput",
    "KnownMaterial",
    "Local",
    "Loop",
    "Moduli",
    "Named",
    "NotAllowed",
    "NotFound",
    "Overloaded",
    "PlanarContacts",
    "Record",
    "RemoteContact",
    "Result",
    "Rows",
    "Scan",
    "ServerError",
    "StickslipError",
    "StickslipWarning",
    "TooMuchWork",
    "__version__",
    "connect",
    "materials",
    "read_loop",
    "read_scan",
    "serve",
    "types",
]
__all__ += functions.__all__
__all__ += profiles.__all__
