"""A contact that is moved, and read in its present state."""

from __future__ import annotations

import json
from abc import abstractmethod
from collections.abc import Mapping
from copy import deepcopy
from dataclasses import fields
from difflib import get_close_matches
from threading import Lock
from typing import TYPE_CHECKING, Any

from . import requests, results
from .bodies import HasDefinition, Material, Shape, elastic_body
from .computations import OfContact
from .documents import Document, Quantity, to_document
from .errors import Conflict, Fault, InvalidInput, refusal, warn
from .profiles import Definition
from .result import T, parse

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from typing_extensions import Unpack

    from . import _native
    from .request_types import DefinitionMembers
    from .result import Curve

#: The calls that move a contact, and those that read its present state.
MOVES = frozenset({"move", "path", "relax"})
#: The keywords of a contact beside shape, bodies and friction.
_LOADS = tuple(field.name for field in fields(Definition) if field.name not in ("profile", "bodies", "friction"))
#: All of its keywords.
_MEMBERS = ("profile", "bodies", "friction", "label", *_LOADS)
_MODULI = "bodies=ss.Moduli(e_star, g_star)"
#: What is meant by names that a contact does not have.
_MEANT = dict.fromkeys(("load", "force", "preload"), "normal_force")
_MEANT |= dict.fromkeys(("effective", "moduli", "e_star", "g_star"), _MODULI)
_MEANT |= {"material": "bodies", "materials": "bodies", "mu": "friction", "shape": "profile"}
#: Points for each move in the picture of a loop.
POINTS_OF_A_PICTURE = 32
#: Moves of a page of a history.
PAGE = 100
#: Points for each move of a loop at most.
MOST_POINTS = 100


class Fixed:
    """An object whose public attributes cannot be set: to assign one would change nothing that is computed."""

    def __setattr__(self, name: str, value: object) -> None:
        if not name.startswith("_"):
            kind = type(self).__name__
            raise AttributeError(f"{name} of a {kind} cannot be set: its definition does not change; make a new {kind}")
        object.__setattr__(self, name, value)


class DefinedContact(Fixed, HasDefinition):
    """The common base of contacts in process, on a server and for asyncio."""

    _definition: Document
    #: The codes of the warnings that have been issued for it.
    _warned: set[str]

    def definition(self) -> Document:
        """The JSON document of its definition, at its preload: a copy."""
        return deepcopy(self._definition)

    def _document(self, name: str, given: Document, parts: dict[str, Document]) -> Document:
        """The document of what is asked for."""
        if name == "subsurface" and given["body"] is None:
            given["body"] = elastic_body(self.definition())
        if name == "fretting":
            given["contact"] = self.definition()
        document: Document = to_document(requests.assemble(name, given, parts))
        return document

    def _reply(self, kind: type[T], reply: Document, request: Document, curve: Any = None) -> T:
        warn(reply.get("warnings", ()), self._warned)
        definition = self.definition()
        return parse(kind, reply, definition=definition, curve=curve, **context_of(definition, request))


class AnyContact(OfContact, DefinedContact):
    """A contact in this process or on a server. All units are SI; numbers may be given with their units."""

    @abstractmethod
    def _advance(self, kind: str, document: Document) -> tuple[Document, Curve | None]:
        """Makes a `move`, a `path` or the path of `relax`; returns the reply, and the curve of its loop."""

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

    def wait(self, duration: Quantity) -> results.MoveReply:
        """Waits for this long, s: bodies with memory relax at the indentation and the displacement that they have."""
        return self.move(duration=duration)

    def residual(self) -> results.Residual:
        """The local extrema of the shear stress, Pa."""
        found = self.stress(2, fields=["shear"], residual=True).residual
        assert found is not None
        return found

    def _answer_of_contact(self, kind: type[T], name: str, given: Document, parts: dict[str, Document]) -> T:
        document = self._document(name, given, parts)
        curve = None
        if name in MOVES:
            reply, curve = self._advance(name, document)
        elif name == "fretting":
            reply = self._compute(name, document | {"contact": self.definition_now()})
        else:
            reply = self._read(name, document)
        return self._reply(kind, reply, document, curve)

    @abstractmethod
    def history(
        self, *, after: int | None = None, limit: int | None = None, last: int | None = None, cycles: bool | None = None
    ) -> results.HistoryPage:
        """A page of its moves: at most `limit` after a number, or the `last` ones; `cycles=False` marks no cycles."""

    @abstractmethod
    def loop(
        self,
        *,
        after: int | None = None,
        limit: int | None = None,
        last: int | None = None,
        points_per_move: int | None = None,
    ) -> results.LoopPage:
        """A page of its force-displacement loop: as of the history, with so many points for each move."""

    @abstractmethod
    def cycles(self, *, last: int | None = None) -> results.CyclePage:
        """The closed cycles of the history, or the last ones."""

    def plot(self, ax: Axes | None = None, *, last: int = 1000, **options: Any) -> Axes:
        """The loop of the last moves, in `ax` or in a new figure; returns the axes."""
        return self.loop(last=last, points_per_move=POINTS_OF_A_PICTURE).plot(ax, **options)

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
        self._in_use = Lock()
        self._definition: Document = json.loads(native.definition())
        self._warned = set() if warned is None else set(warned)
        if warned is None:
            warn(json.loads(native.warnings()), self._warned)

    def to_bytes(self) -> bytes:
        """The definition and the moves as bytes, from which `from_bytes` makes the same contact."""
        found: bytes = self._call("to_bytes")
        return found

    def moves(self) -> list[Document]:
        """The moves so far, in the form of a path."""
        found: list[Document] = json.loads(self._call("moves"))
        return found

    def describe(self) -> results.SessionReply:
        """Identifier, number of moves, summary of the definition and present state."""
        return parse(results.SessionReply, json.loads(self._call("describe")))

    def copy(self) -> Contact:
        """A copy of the contact, with its history; it evolves independently from here."""
        return Contact._of(self._call("copy"), self._warned)

    def undo(self, calls: int = 1) -> results.State:
        """Takes back the last calls that moved the contact; the moves before them are repeated."""
        self._call("undo", calls)
        return self.state

    def history(
        self, *, after: int | None = None, limit: int | None = None, last: int | None = None, cycles: bool | None = None
    ) -> results.HistoryPage:
        """A page of its moves: at most `limit` after a number, or the `last` ones; `cycles=False` marks no cycles.

        The moves are repeated for it.
        """
        first, end, following = self._window(after, limit, last)
        items = json.loads(self._call("history", first, end))
        if cycles is False:
            items = [{name: value for name, value in item.items() if name != "cycle"} for item in items]
        return parse(results.HistoryPage, {"items": items, "next": following}, curve=self._curve(first, end))

    def loop(
        self,
        *,
        after: int | None = None,
        limit: int | None = None,
        last: int | None = None,
        points_per_move: int | None = None,
    ) -> results.LoopPage:
        """A page of its force-displacement loop: as of the history, with so many points for each move."""
        first, end, _ = self._window(after, limit, last)
        points = 1 if points_per_move is None else points_per_move
        if not isinstance(points, int) or not 1 <= points <= MOST_POINTS:
            raise refused("/points_per_move", f"{points!r} is out of range: allowed is 1 to {MOST_POINTS}")
        page = json.loads(self._call("points", first, end, points))
        return parse(results.LoopPage, page, curve=self._curve(first, end))

    def cycles(self, *, last: int | None = None) -> results.CyclePage:
        """The closed cycles of the history, or the last ones."""
        return parse(results.CyclePage, {"items": json.loads(self._call("cycles", PAGE if last is None else last))})

    def _window(self, after: int | None, limit: int | None, last: int | None) -> tuple[int, int, int | None]:
        """The first and the last move of a page, and where the next one begins."""
        if last is not None and (after is not None or limit is not None):
            raise refused("/last", "conflicts with `after` and `limit`: leave them out")
        for name, value in (("after", after), ("limit", limit), ("last", last)):
            if value is not None and (not isinstance(value, int) or value < 0):
                raise refused(f"/{name}", f"{value!r} is not a number of moves")
        made = self.sequence
        first = max(made - last, 0) if last is not None else min(after or 0, made)
        end = min(first + (last if last is not None else limit if limit is not None else PAGE), made)
        return first, end, end if end < made else None

    def _curve(self, first: int, end: int) -> Curve:
        """The curve of these moves, which is followed when it is drawn."""
        return self.copy()._call("trace", first, end)  # type: ignore[no-any-return]

    def __reduce__(self) -> tuple[Any, ...]:
        return Contact.from_bytes, (self.to_bytes(),)

    def __copy__(self) -> Contact:
        return self.copy()

    def __deepcopy__(self, _: Any) -> Contact:
        return self.copy()

    def __repr__(self) -> str:
        return f"Contact({self._definition['profile']['type']}, {self.sequence} moves)"

    def _call(self, name: str, *arguments: Any) -> Any:
        return owned(self._in_use, getattr(self._native, name), *arguments)

    def _advance(self, kind: str, document: Document) -> tuple[Document, Curve | None]:
        reply, curve = self._call("advance", kind, encoded(document))
        return json.loads(reply), curve

    def _read(self, kind: str, document: Document) -> Document:
        found: Document = json.loads(self._call("read", kind, encoded(document)))
        return found

    def _compute(self, name: str, document: Document) -> Document:
        from . import _native

        found: Document = json.loads(guarded(_native.compute, name, encoded(document)))
        return found


def definition(profile: Shape, material: Material, friction: Quantity, load: Mapping[str, Any]) -> Document:
    """The JSON document of a definition."""
    unknown = [name for name in load if name not in _LOADS]
    if unknown:
        name = unknown[0]
        near = get_close_matches(name, _MEMBERS, n=1)
        hint = _MEANT.get(name) or (near[0] if near else "")
        known = f"{', '.join(_MEMBERS[:-1])} and {_MEMBERS[-1]}"
        raise TypeError(f"a contact has no {name!r}: {f'did you mean {hint}? ' if hint else ''}known are {known}")
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


def owned(in_use: Lock, call: Any, *arguments: Any) -> Any:
    """The result of a native call of an object that one thread may use at a time."""
    if not in_use.acquire(blocking=False):
        detail = "another thread is using this object: give each thread a copy() of its own, or share it by a lock"
        raise Conflict("in_use", detail)
    try:
        return guarded(call, *arguments)
    finally:
        in_use.release()


def refused(place: str, detail: str) -> InvalidInput:
    """The refusal of an argument at its place."""
    return InvalidInput("invalid_input", detail, (Fault(place, detail),))


def native_contact(document: Document) -> _native.Contact:
    """The native contact of a definition."""
    from . import _native

    contact: _native.Contact = guarded(_native.Contact, encoded(document))
    return contact
