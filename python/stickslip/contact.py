"""A contact that lives: it is moved, and read in its present state."""

from __future__ import annotations

import json
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import bodies, requests, results
from .bodies import Material
from .documents import Document, HasDocument, Quantities, Quantity, members, to_document
from .errors import refusal, warn
from .result import T, parse

if TYPE_CHECKING:
    from . import _native


class AnyContact(ABC):
    """A contact in this process or on a server. All units are SI; numbers may be given with their units."""

    @abstractmethod
    def _advance(self, kind: str, document: Document) -> Document:
        """Makes a `move`, a `path` or the path of `relax`."""

    @abstractmethod
    def _read(self, kind: str, document: Document) -> Document:
        """The `stress`, the `subsurface` stress or the steady `cycle` of the present state."""

    @abstractmethod
    def _compute(self, name: str, document: Document) -> Document:
        """A computation that defines its contact itself."""

    @abstractmethod
    def describe(self) -> results.NewSession | results.SessionReply:
        """Identifier, number of moves, summary of the definition and present state."""

    @abstractmethod
    def definition(self) -> Document:
        """The JSON document of its definition, at its preload."""

    @abstractmethod
    def copy(self) -> AnyContact:
        """The same contact once more, with its history; it goes its own way from here."""

    @abstractmethod
    def undo(self, calls: int = 1) -> results.State:
        """Takes back the last calls that moved it."""

    @property
    def state(self) -> results.State:
        """The state after the last move."""
        return self.describe().state

    @property
    def summary(self) -> results.Figures:
        """What follows from the definition at its preload."""
        return self.describe().contact

    @property
    def sequence(self) -> int:
        """Number of moves so far."""
        return self.describe().sequence

    def definition_now(self) -> Document:
        """The definition with the present normal force as its preload."""
        return self.definition() | {"preload": {"normal_force": self.state.normal_force}}

    def move(
        self,
        displacement: Quantity | None = None,
        *,
        force: Quantity | None = None,
        indentation: Quantity | None = None,
        normal_force: Quantity | None = None,
        relative: bool | None = None,
        stress: requests.Stress = None,
        tolerance: float | None = None,
    ) -> results.MoveReply:
        """Moves straight to a displacement (m) or force (N), and an indentation (m) or normal force (N)."""
        targets = {"displacement": displacement, "force": force, "indentation": indentation}
        rest = {"normal_force": normal_force, "relative": relative, "stress": requests.stress(stress)}
        return self._reply(results.MoveReply, self._advance("move", members(**targets, **rest, tolerance=tolerance)))

    def path(
        self,
        displacement: Quantities | None = None,
        *,
        force: Quantities | None = None,
        moves: Sequence[Mapping[str, Any]] | None = None,
        falling_amplitude: int | Mapping[str, Any] | None = None,
        equal_peaks: int | Mapping[str, Any] | None = None,
        cycles: Mapping[str, Any] | None = None,
        steps: str | None = None,
        stress: requests.Stress = None,
        tolerance: float | None = None,
    ) -> results.PathReply:
        """Follows a path, whole or not at all: one of displacements (m), forces (N), moves, reversals or cycles."""
        given = requests.path(
            displacement=displacement,
            force=force,
            moves=moves,
            falling_amplitude=falling_amplitude,
            equal_peaks=equal_peaks,
            cycles=cycles,
        )
        document = members(path=given, steps=steps, stress=requests.stress(stress), tolerance=tolerance)
        return self._reply(results.PathReply, self._advance("path", document))

    def relax(
        self,
        reversals: int | None = None,
        *,
        target: float | None = None,
        kind: str | None = None,
        end: str | None = None,
        dry_run: bool | None = None,
        steps: str | None = None,
    ) -> results.RelaxReply:
        """Follows the path from here that leaves little shear stress, or shows it in a dry run."""
        document = members(reversals=reversals, target=target, kind=kind, end=end, dry_run=dry_run, steps=steps)
        return self._reply(results.RelaxReply, self._advance("relax", document))

    def stress(
        self,
        points: int | None = None,
        *,
        radii: Quantities | None = None,
        fields: Sequence[str] | None = None,
        residual: bool = False,
    ) -> results.StressReply:
        """Pressure, shear stress (Pa), slip and displacement (m) over the radius, at so many points or these radii."""
        document = members(points=points, fields=fields, residual=residual)
        if radii is not None:
            document |= members(radii=radii)
        return self._reply(results.StressReply, self._read("stress", document))

    def residual(self) -> results.Residual:
        """The local extrema of the shear stress, Pa."""
        found = self.stress(2, fields=["shear"], residual=True).residual
        assert found is not None
        return found

    def subsurface(self, *, body: str | None = None, **request: Any) -> results.SubsurfaceReply:
        """The stress below the surface at `points`, on a `line`, in a `plane` or on the `surface`.

        The body is the first one that is elastic if it is not named; the members are those of the API.
        """
        body = body or bodies.elastic_body(self.definition())
        return self._reply(results.SubsurfaceReply, self._read("subsurface", members(body=body, **request)))

    def cycle(
        self, displacement: Quantity | Quantities | None = None, *, force: Any = None, **request: Any
    ) -> results.CycleReply:
        """Steady cycles at the present load, one for each amplitude of displacement (m) or force (N)."""
        document = to_document(requests.cycle(displacement, force, **request))
        return self._reply(results.CycleReply, self._read("cycle", document))

    def fretting(self, displacement: Quantity | None = None, **request: Any) -> results.FrettingReply:
        """Fatigue criteria over the steady cycle of this amplitude (m), or of a path, at the present load.

        The cycle begins with a contact that was never moved. Without places the worst place is looked for.
        """
        document = to_document(requests.fretting(self.definition_now(), displacement, **request))
        return self._reply(results.FrettingReply, self._compute("fretting", document))

    def _reply(self, kind: type[T], document: Document) -> T:
        warn(document.get("warnings", ()))
        definition = self.definition()
        return parse(kind, document, definition=definition, **definition_context(definition))

    def _repr_html_(self) -> str:
        found = self.describe()
        return f"<b>Contact</b> after {found.sequence} moves{found.state.to_frame().T.to_html(header=False)}"


def definition_context(definition: Mapping[str, Any]) -> dict[str, Any]:
    """What pictures need of a definition."""
    return {"friction": definition.get("friction")}


class Contact(AnyContact):
    """A contact in this process.

    Its history is held by the solver: a move costs the same after a million others.
    """

    def __init__(
        self,
        profile: HasDocument | Mapping[str, Any],
        bodies: Material,
        friction: float,
        *,
        normal_force: Quantity | None = None,
        indentation: Quantity | None = None,
        contact_radius: Quantity | None = None,
        label: str | None = None,
    ):
        given = definition(profile, bodies, friction, normal_force, indentation, contact_radius)
        self._start(native_contact(given | ({} if label is None else {"label": label})))
        warn(self._described()["warnings"])

    @classmethod
    def from_definition(cls, definition: Any) -> Contact:
        """The contact of a definition: one of this package, or a JSON document."""
        return cls._of(native_contact(to_document(definition)))

    @classmethod
    def from_bytes(cls, data: bytes) -> Contact:
        """The contact that `to_bytes` wrote, equal to the last bit."""
        from . import _native

        return cls._of(guarded(_native.Contact.from_bytes, data))

    @classmethod
    def _of(cls, native: _native.Contact) -> Contact:
        contact = cls.__new__(cls)
        contact._start(native)
        return contact

    def _start(self, native: _native.Contact) -> None:
        self._native = native
        self._definition: Document = json.loads(native.definition())

    def to_bytes(self) -> bytes:
        """Definition and moves, from which the same contact is made again."""
        return self._native.to_bytes()

    def moves(self) -> list[Document]:
        """The moves so far, as a path takes them."""
        found: list[Document] = json.loads(self._native.moves())
        return found

    def describe(self) -> results.NewSession:
        """Identifier, number of moves, summary of the definition and present state."""
        return parse(results.NewSession, self._described())

    def definition(self) -> Document:
        """The JSON document of its definition, at its preload."""
        return self._definition

    def copy(self) -> Contact:
        """The same contact once more, with its history; it goes its own way from here."""
        return Contact._of(self._native.copy())

    def undo(self, calls: int = 1) -> results.State:
        """Takes back the last calls that moved it, which are made again up to there."""
        guarded(self._native.undo, calls)
        return self.state

    def __reduce__(self) -> tuple[Any, ...]:
        return Contact.from_bytes, (self.to_bytes(),)

    def __copy__(self) -> Contact:
        return self.copy()

    def __deepcopy__(self, _: Any) -> Contact:
        return self.copy()

    def __repr__(self) -> str:
        return f"Contact({self._definition['profile']['type']}, {self.sequence} moves)"

    def _described(self) -> Document:
        found: Document = json.loads(self._native.describe())
        return found

    def _advance(self, kind: str, document: Document) -> Document:
        found: Document = json.loads(guarded(self._native.advance, kind, encoded(document)))
        return found

    def _read(self, kind: str, document: Document) -> Document:
        found: Document = json.loads(guarded(self._native.read, kind, encoded(document)))
        return found

    def _compute(self, name: str, document: Document) -> Document:
        from . import _native

        found: Document = json.loads(guarded(_native.compute, name, encoded(document)))
        return found


def definition(
    profile: HasDocument | Mapping[str, Any],
    material: Material,
    friction: float,
    normal_force: Quantity | None,
    indentation: Quantity | None,
    contact_radius: Quantity | None,
) -> Document:
    """The JSON document of a definition."""
    given = bodies.Definition(profile, material, friction, normal_force, indentation, contact_radius)
    document: Document = to_document(given)
    return document


def encoded(document: Any) -> bytes:
    """The JSON text of a document."""
    return json.dumps(document, separators=(",", ":")).encode()


def guarded(call: Any, *arguments: Any) -> Any:
    """The result of a native call; its refusals are the exceptions of this package."""
    from . import _native

    try:
        return call(*arguments)
    except _native.Problem as problem:
        raise refusal(problem.args[0]) from None


def native_contact(document: Document) -> _native.Contact:
    """The native contact of a definition."""
    from . import _native

    contact: _native.Contact = guarded(_native.Contact, encoded(document))
    return contact
