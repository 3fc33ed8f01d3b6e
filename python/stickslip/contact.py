"""A contact that is moved, and read in its present state."""

from __future__ import annotations

import json
from abc import abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from . import requests, results
from .bodies import HasDefinition, Material, Shape, elastic_body
from .computations import OfContact
from .documents import Document, Quantity, to_document
from .errors import refusal, warn
from .profiles import Definition
from .result import T, parse

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from . import _native
    from .request_types import DefinitionMembers

#: The calls that move a contact, and those that read its present state.
MOVES = frozenset({"move", "path", "relax"})


class DefinedContact(HasDefinition):
    """The common base of contacts in process, on a server and for asyncio."""

    _definition: Document
    #: The codes of the warnings that have been issued for it.
    _warned: set[str]

    def definition(self) -> Document:
        """The JSON document of its definition, at its preload."""
        return self._definition

    def _document(self, name: str, given: Document, parts: dict[str, Document]) -> Document:
        """The document of what is asked for."""
        if name == "subsurface" and given["body"] is None:
            given["body"] = elastic_body(self.definition())
        if name == "fretting":
            given["contact"] = self.definition()
        document: Document = to_document(requests.assemble(name, given, parts))
        return document

    def _reply(self, kind: type[T], reply: Document, request: Document) -> T:
        warn(reply.get("warnings", ()), self._warned)
        definition = self.definition()
        return parse(kind, reply, definition=definition, **context_of(definition, request))


class AnyContact(OfContact, DefinedContact):
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
    def describe(self) -> results.SessionReply:
        """Identifier, number of moves, summary of the definition and present state."""

    @abstractmethod
    def copy(self) -> AnyContact:
        """A copy of the contact, with its history; it evolves independently from here."""

    @abstractmethod
    def undo(self, calls: int = 1) -> results.State:
        """Takes back the last calls that moved the contact."""

    @abstractmethod
    def moves(self) -> list[Document]:
        """The moves so far, in the form of a path."""

    @property
    def state(self) -> results.State:
        """The state after the last move."""
        return self.describe().state

    @property
    def summary(self) -> results.Figures:
        """Quantities that follow from the definition at its preload."""
        return self.describe().contact

    @property
    def sequence(self) -> int:
        """Number of moves so far."""
        return self.describe().sequence

    def definition_now(self) -> Document:
        """The definition with the present normal force as its preload."""
        return self.definition() | {"preload": {"normal_force": self.state.normal_force}}

    def residual(self) -> results.Residual:
        """The local extrema of the shear stress, Pa."""
        found = self.stress(2, fields=["shear"], residual=True).residual
        assert found is not None
        return found

    def _answer_of_contact(self, kind: type[T], name: str, given: Document, parts: dict[str, Document]) -> T:
        document = self._document(name, given, parts)
        if name in MOVES:
            reply = self._advance(name, document)
        elif name == "fretting":
            reply = self._compute(name, document | {"contact": self.definition_now()})
        else:
            reply = self._read(name, document)
        return self._reply(kind, reply, document)

    def _repr_html_(self) -> str:
        found = self.describe()
        return f"<b>Contact</b> after {found.sequence} moves{found.state._repr_html_()}"


def context_of(definition: Mapping[str, Any], request: Mapping[str, Any]) -> dict[str, Any]:
    """What tables and pictures need of a definition and a request."""
    return {"friction": definition.get("friction"), "drive": request.get("drive", {})}


class Contact(AnyContact):
    """A contact in this process.

    Its history is held by the solver: a move costs the same after a million others.

    Parameters
    ----------
    profile : Profile | dict
        The shape of the indenter.
    bodies : Sequence[Body | str] | Moduli | dict
        The two bodies, of which one may be `RIGID`, or their reduced moduli.
    friction : Quantity
        Coulomb's coefficient of friction, a pure number.
    label : str
        A label of your own.
    **load
        One of `normal_force` (N), `indentation` (m) and `contact_radius` (m), and other members of a definition.
    """

    def __init__(
        self,
        profile: Shape,
        bodies: Material,
        friction: Quantity,
        *,
        label: str | None = None,
        **load: Unpack[DefinitionMembers],
    ):
        given = definition(profile, bodies, friction, load)
        self._start(native_contact(given | ({} if label is None else {"label": label})))

    @classmethod
    def from_definition(cls, definition: Any) -> Contact:
        """The contact of a definition: one of this package, or a JSON document."""
        return cls._of(native_contact(to_document(requests.definition(definition))))

    @classmethod
    def from_bytes(cls, data: bytes) -> Contact:
        """The contact that `to_bytes` wrote, equal to the last bit."""
        from . import _native

        return cls._of(guarded(_native.Contact.from_bytes, data))

    @classmethod
    def _of(cls, native: _native.Contact, warned: set[str] | None = None) -> Contact:
        contact = cls.__new__(cls)
        contact._start(native, warned)
        return contact

    def _start(self, native: _native.Contact, warned: set[str] | None = None) -> None:
        self._native = native
        self._definition: Document = json.loads(native.definition())
        self._warned = set() if warned is None else set(warned)
        if warned is None:
            warn(json.loads(native.warnings()), self._warned)

    def to_bytes(self) -> bytes:
        """The definition and the moves as bytes, from which `from_bytes` makes the same contact."""
        return self._native.to_bytes()

    def moves(self) -> list[Document]:
        """The moves so far, in the form of a path."""
        found: list[Document] = json.loads(self._native.moves())
        return found

    def describe(self) -> results.SessionReply:
        """Identifier, number of moves, summary of the definition and present state."""
        return parse(results.SessionReply, json.loads(self._native.describe()))

    def copy(self) -> Contact:
        """A copy of the contact, with its history; it evolves independently from here."""
        return Contact._of(self._native.copy(), self._warned)

    def undo(self, calls: int = 1) -> results.State:
        """Takes back the last calls that moved the contact; the moves before them are repeated."""
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


def definition(profile: Shape, material: Material, friction: Quantity, load: Mapping[str, Any]) -> Document:
    """The JSON document of a definition."""
    document: Document = to_document(Definition(profile, material, friction, **load))
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
