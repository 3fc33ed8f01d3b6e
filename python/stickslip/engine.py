"""The computations by their names: the same methods in process and on a server."""

from __future__ import annotations

import json
import os
from abc import abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from . import _native, requests, results
from .bodies import Material, Shape
from .computations import Computations
from .contact import AnyContact, Contact, DefinedContact, context_of, encoded, guarded
from .documents import Document, Quantity, to_document
from .errors import NotFound, seen_of, warn
from .result import Floats, T, parse

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .request_types import DefinitionMembers

#: The formats of tables and pictures.
Format: TypeAlias = Literal["columns", "rows", "csv", "ndjson", "arrow", "svg", "png"]
#: The path of each computation by its name, and its name by its path.
PATHS: dict[str, str] = {name: path for name, path in _native.names() if path is not None}
NAMES = {path: name for name, path in PATHS.items()}


class Engine(Computations):
    """The interface of all computations: in this process, or on a server."""

    @abstractmethod
    def compute(self, name: str, document: Document) -> Document:
        """The reply of a computation to the document of its request, unchanged."""

    @abstractmethod
    def compute_bytes(self, name: str, document: Document, format: Format = "columns") -> bytes:  # noqa: A002
        """The same as bytes: JSON, or another format of the computation, such as `arrow` or `svg`."""

    @abstractmethod
    def sweep_document(self, document: Document) -> Document:
        """The table of a sweep as a document."""

    @abstractmethod
    def contact(
        self,
        profile: Shape,
        bodies: Material,
        friction: Quantity,
        *,
        label: str | None = None,
        **load: Unpack[DefinitionMembers],
    ) -> AnyContact:
        """A new contact."""

    def _answer(self, kind: type[T], name: str, given: Document, parts: dict[str, Document]) -> T:
        request = request_of(name, given, parts)
        reply = self.sweep_document(request) if name == "/sweep" else self.compute(NAMES[name], request)
        return answer(kind, reply, given.get("contact"), request)


def request_of(name: str, given: Document, parts: dict[str, Document]) -> Document:
    """The document of a request by the path of its computation."""
    request: Document = to_document(requests.assemble(name, given, parts))
    return request


def answer(kind: type[T], reply: Document, contact: Any, request: Mapping[str, Any]) -> T:
    """The result of a reply, with its warnings."""
    definition = request.get("contact", {})
    seen = contact._warned if isinstance(contact, DefinedContact) else seen_of(definition) if definition else set()
    warn(reply.get("warnings", ()), seen)
    found: type[T] = _other_shape(reply) or kind
    curve = SimulatedCurve(request) if found in (results.SimulateReply, results.PlanarReply) else None
    return parse(found, reply, curve=curve, **context_of(definition, request))


class SimulatedCurve:
    """The path of a simulation, which is followed when it is drawn; in the plane of its forces along x and y, N."""

    def __init__(self, request: Mapping[str, Any]):
        self._request = {name: value for name, value in request.items() if name not in ("stress", "residual", "steps")}

    def points(self) -> tuple[Floats, Floats]:
        """Displacements, m, and tangential forces, N."""
        found: tuple[Floats, Floats] = guarded(_native.trace, encoded(self._request))
        return found


def path_of(name: str) -> str:
    """The path of a computation."""
    if name not in PATHS:
        raise NotFound("not_found", f"there is no computation {name}: there are {', '.join(PATHS)}")
    return PATHS[name]


def _other_shape(reply: Document) -> Any:
    """The class of a reply of another shape: in the plane, where states have pairs, or of uncertain inputs."""
    if isinstance(reply.get("outputs"), list):
        return results.UncertaintyReply
    steps = reply.get("steps")
    pairs = isinstance(steps, list) and bool(steps) and isinstance(steps[0].get("displacement"), list)
    return results.PlanarReply if pairs else None


class Local(Engine):
    """The engine of this process."""

    def compute(self, name: str, document: Document) -> Document:
        """The reply of a computation to the document of its request, unchanged."""
        found: Document = json.loads(self.compute_bytes(name, document))
        return found

    def compute_bytes(self, name: str, document: Document, format: Format = "columns") -> bytes:  # noqa: A002
        """The same as bytes: JSON, or another format of the computation, such as `arrow` or `svg`."""
        if name not in dict(_native.names()):
            path_of(name)
        data: bytes = guarded(_native.compute, name, encoded(to_document(document)), format)
        return data

    def sweep_document(self, document: Document) -> Document:
        """The table of a sweep as a document."""
        plan = guarded(_native.Sweep, encoded(document))
        found: Document = json.loads(guarded(plan.run, os.cpu_count() or 1, "columns"))
        return found

    def contact(
        self,
        profile: Shape,
        bodies: Material,
        friction: Quantity,
        *,
        label: str | None = None,
        **load: Unpack[DefinitionMembers],
    ) -> Contact:
        """A new contact."""
        return Contact(profile, bodies, friction, label=label, **load)
