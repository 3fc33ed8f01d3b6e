"""The computations by their names: the same methods in process and on a server."""

from __future__ import annotations

import json
import os
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any

from . import requests, results
from .bodies import Material
from .contact import AnyContact, Contact, definition_context, encoded, guarded
from .documents import Document, HasDocument, Quantities, Quantity, members, to_document
from .errors import NotFound, warn
from .result import T, parse


class Engine(ABC):
    """What computes. Requests are the documents of the API, with keyword arguments for their members."""

    @abstractmethod
    def compute(self, name: str, document: Document) -> Document:
        """The reply of a computation to the document of its request, as it is."""

    @abstractmethod
    def sweep_document(self, document: Document) -> Document:
        """The table of a sweep as a document."""

    @abstractmethod
    def contact(
        self,
        profile: HasDocument | Mapping[str, Any],
        bodies: Material,
        friction: float,
        *,
        normal_force: Quantity | None = None,
        indentation: Quantity | None = None,
        contact_radius: Quantity | None = None,
        label: str | None = None,
    ) -> AnyContact:
        """A new contact."""

    def simulate(self, contact: Any, *, stress: requests.Stress = None, **request: Any) -> Any:
        """Moves a virgin contact along a path: `displacement=[...]`, `falling_amplitude=20` and so on.

        Returns a :class:`~stickslip.results.SimulateReply`; of a path in the plane (`ellipse=...`, `moves` with pairs)
        a :class:`~stickslip.results.PlanarReply`.
        """
        way = requests.split_path(request)
        document = {"contact": requests.definition(contact), "path": way, "stress": requests.stress(stress)} | request
        return self._answer(results.SimulateReply, "simulate", document)

    def cycle(
        self,
        contact: Any,
        displacement: Quantity | Quantities | None = None,
        *,
        force: Quantity | Quantities | None = None,
        **request: Any,
    ) -> results.CycleReply:
        """Steady cycles, one for each amplitude of displacement (m) or force (N)."""
        document = {"contact": requests.definition(contact)} | requests.cycle(displacement, force, **request)
        return self._answer(results.CycleReply, "cycle", document)

    def fretting(self, contact: Any, displacement: Quantity | None = None, **request: Any) -> results.FrettingReply:
        """Fatigue criteria over the steady cycle of this amplitude (m), or of a path."""
        return self._answer(results.FrettingReply, "fretting", requests.fretting(contact, displacement, **request))

    def protocols(
        self, contact: Any, reversals: int | None = None, *, target: float | None = None, **request: Any
    ) -> results.ProtocolReply:
        """A path of so many reversals, or of as few as reach a target, that leaves little shear stress."""
        document = {"contact": requests.definition(contact), "reversals": reversals, "target": target} | request
        return self._answer(results.ProtocolReply, "protocol", document)

    def accuracy(self, contact: Any, *, stress: requests.Stress = None, **request: Any) -> results.AccuracyReply:
        """Solvers beside a reference: errors and times on a path."""
        way = requests.split_path(request)
        document = {"contact": requests.definition(contact), "path": way, "stress": requests.stress(stress)} | request
        return self._answer(results.AccuracyReply, "accuracy", document)

    def fit_loop(
        self, contact: Any, loops: Any, *, free: Any = None, start: str | None = None, units: Any = None, **request: Any
    ) -> results.FitReply:
        """Friction and stiffness of measured loops: files that were read, documents, or arrays of U and F.

        `start` says how they begin: `steady` in a cycle that has been repeated before, or `virgin`.
        """
        measured, found = requests.loops(loops, units)
        measured = [loop if start is None else loop | {"start": start} for loop in measured]
        free = free or ["friction", "g_star", "force_offset"]
        document = {"contact": requests.definition(contact), "loops": measured, "units": found, "free": free} | request
        return self._answer(results.FitReply, "fit", document)

    def fit_profile(self, scan: Any, *, units: Any = None, **request: Any) -> results.ProfileFitReply:
        """The profile of a scan: a file that was read, a document, or arrays of x and z or x, y and z."""
        heights, found = requests.scan(scan, units)
        return self._answer(results.ProfileFitReply, "profile", {"scan": heights, "units": found} | request)

    def sweep(self, base: Mapping[str, Any], axes: Any, outputs: Any) -> results.SweepReply:
        """Numbers of many simulations that differ from `base` in a few numbers.

        `axes` are values by their JSON pointers into the base, `outputs` pointers into the replies.
        """
        base = dict(base)
        if "contact" in base:
            base["contact"] = requests.definition(base["contact"])
        document = members(base=base, axes=requests.axes(axes), outputs=requests.outputs(outputs))
        return parse(results.SweepReply, self.sweep_document(document))

    def _answer(self, kind: type[T], name: str, document: Document) -> T:
        request = to_document(document)
        reply = self.compute(name, request)
        warn(reply.get("warnings", ()))
        kind = _in_plane(reply) or kind
        return parse(kind, reply, **definition_context(request.get("contact", {})))


def _in_plane(reply: Document) -> Any:
    """The class of the reply of a simulation whose states have pairs."""
    steps = reply.get("steps")
    pairs = isinstance(steps, list) and bool(steps) and isinstance(steps[0].get("displacement"), list)
    return results.PlanarReply if pairs else None


class Local(Engine):
    """The engine of this process."""

    def compute(self, name: str, document: Document) -> Document:
        """The reply of a computation to the document of its request, as it is."""
        found: Document = json.loads(self.compute_bytes(name, document))
        return found

    def compute_bytes(self, name: str, document: Document, format: str = "columns") -> bytes:  # noqa: A002
        """The same as bytes: JSON, or another format of the computation, such as `arrow` or `svg`."""
        from . import _native

        if name not in dict(_native.names()):
            raise NotFound("not_found", f"there is no computation {name}")
        data: bytes = guarded(_native.compute, name, encoded(to_document(document)), format)
        return data

    def sweep_document(self, document: Document) -> Document:
        """The table of a sweep as a document."""
        from . import _native

        plan = guarded(_native.Sweep, encoded(document))
        found: Document = json.loads(guarded(plan.run, os.cpu_count() or 1, "columns"))
        return found

    def contact(
        self,
        profile: HasDocument | Mapping[str, Any],
        bodies: Material,
        friction: float,
        *,
        normal_force: Quantity | None = None,
        indentation: Quantity | None = None,
        contact_radius: Quantity | None = None,
        label: str | None = None,
    ) -> Contact:
        """A new contact."""
        load = {"normal_force": normal_force, "indentation": indentation, "contact_radius": contact_radius}
        return Contact(profile, bodies, friction, **load, label=label)
