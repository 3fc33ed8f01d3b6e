"""A client of a service: the same methods as in process, contacts as objects."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from functools import wraps
from typing import TYPE_CHECKING, Any, Concatenate, NoReturn, ParamSpec, TypeVar

import numpy as np

from . import results
from .bodies import Material, Shape
from .contact import POINTS_OF_A_PICTURE, AnyContact, definition
from .documents import Document, Quantity, to_document
from .engine import Engine, path_of
from .errors import warn
from .events import read_events
from .exchange import Calls, ContactCalls, Following, Pause, Send, Steps, whole_url
from .instruments import Loop, LoopHints, Scan, ScanHints, content_of, hints_of, loop_of, scan_of
from .optional import needed
from .requests import definition as definition_of
from .result import Curve, Floats, Record, parse

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .request_types import DefinitionMembers

httpx = needed("httpx", "client")
P = ParamSpec("P")
T = TypeVar("T")
R = TypeVar("R", bound=Record)
#: Moves of one page of a loop at most.
MOST_MOVES_OF_A_PAGE = 1000
#: Names of the module that a client does not have, and what does the same.
IN_PROCESS_ALONE = {
    "Contacts": "stickslip.Contacts works in process only: on a server make each contact by api.Contact",
    "PlanarContacts": "stickslip.PlanarContacts works in process only: a server has api.simulate in the plane",
    "Local": "stickslip.Local is the engine of this process",
    "Engine": "stickslip.Engine is the base of this client",
    "serve": "stickslip.serve starts a server: this is already a client of one",
    "connect": "stickslip.connect makes a client: this is one already",
}


def of_module(name: str) -> Any:
    """Names of the module that a client has too, such as shapes: one line moves a notebook to a server."""
    import stickslip

    if name in IN_PROCESS_ALONE:
        raise AttributeError(IN_PROCESS_ALONE[name])
    if name in stickslip.__all__:
        return getattr(stickslip, name)
    raise AttributeError(f"a client has no {name}")


def _sent(call: Callable[Concatenate[Any, P], Steps[T]]) -> Callable[Concatenate[Any, P], T]:
    """The method of a client or contact that makes a call."""

    @wraps(call)
    def method(self: Any, /, *arguments: P.args, **options: P.kwargs) -> T:
        found: T = self._run(call(self._calls, *arguments, **options))
        return found

    return method


class ContactMaker:
    """`Contact` on a server: from keywords, a definition, or the bytes of a contact in process."""

    def __init__(self, client: Client):
        self._client = client

    def __call__(
        self,
        profile: Shape,
        bodies: Material,
        friction: Quantity,
        *,
        label: str | None = None,
        **load: Unpack[DefinitionMembers],
    ) -> RemoteContact:
        """A new contact on the server."""
        return self._made(definition(profile, bodies, friction, load), label)

    def from_definition(self, definition: Any) -> RemoteContact:
        """The contact of a definition: one of this package, or a JSON document."""
        document = to_document(definition_of(definition))
        label = document.pop("label", None)
        return self._made(document, label)

    def from_bytes(self, data: bytes) -> RemoteContact:
        """The contact that `to_bytes` of a contact in process wrote: its moves are repeated on the server."""
        made, given = self._client._run(self._client._calls.restore(data))
        return RemoteContact(self._client, made["id"], given)

    def _made(self, given: Document, label: str | None) -> RemoteContact:
        made = self._client._run(self._client._calls.create(given, label))
        contact = RemoteContact(self._client, made["id"], given)
        warn(made["warnings"], contact._warned)
        return contact


class Client(Engine):
    """A service at a URL. Changes carry idempotency keys, so that a repeated request changes nothing twice.

    Waits of over a second are logged by the logger `stickslip`.
    """

    def __init__(self, url: str, key: str | None = None, *, timeout: float = 90.0, retries: int = 4):
        url = whole_url(url)
        headers = {} if key is None else {"authorization": f"Bearer {key}"}
        self._http = httpx.Client(base_url=url, headers=headers, timeout=timeout)
        self._calls = Calls(url, retries)

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __getattr__(self, name: str) -> Any:
        return of_module(name)

    @property
    def url(self) -> str:
        """Where the service is."""
        return self._calls.base

    @property
    def Contact(self) -> ContactMaker:  # noqa: N802
        """`stickslip.Contact`, on the server."""
        return ContactMaker(self)

    def close(self) -> None:
        """Closes the connections."""
        self._http.close()

    request = _sent(Calls.request)
    compute = _sent(Calls.compute)
    compute_bytes = _sent(Calls.compute_bytes)
    sweep_document = _sent(Calls.sweep_document)

    def contact(
        self,
        profile: Shape,
        bodies: Material,
        friction: Quantity,
        *,
        label: str | None = None,
        **load: Unpack[DefinitionMembers],
    ) -> RemoteContact:
        """A new contact on the server."""
        return self.Contact(profile, bodies, friction, label=label, **load)

    def open(self, id: str) -> RemoteContact:  # noqa: A002
        """The contact of an identifier."""
        return RemoteContact(self, id, self._run(self._calls.json("GET", f"/contacts/{id}/definition")))

    def contacts(self, label: str | None = None, *, newest_first: bool = False) -> Iterator[results.SessionSummary]:
        """All contacts, oldest or newest first; with `label`, only those whose label contains it."""
        query = {"label": label, "order": "newest" if newest_first else None}
        after: str | None = None
        while True:
            given = {name: value for name, value in (query | {"after": after}).items() if value is not None}
            page = self._run(self._calls.page(given))
            yield from (parse(results.SessionSummary, item) for item in page["items"])
            after = page["next"]
            if after is None:
                return

    def read_loop(self, source: str | os.PathLike[str] | bytes, **hints: Unpack[LoopHints]) -> Loop:
        """`stickslip.read_loop`, read by the server."""
        return loop_of(self._run(self._calls.read_file("loop", content_of(source), hints_of(hints))))

    def read_scan(self, source: str | os.PathLike[str] | bytes, **hints: Unpack[ScanHints]) -> Scan:
        """`stickslip.read_scan`, read by the server, without the formats of SurfaceTopography."""
        return scan_of(self._run(self._calls.read_file("scan", content_of(source), hints_of(hints))))

    def _run(self, steps: Steps[T]) -> T:
        """Runs a call: sends its requests, and waits during its pauses."""
        try:
            step = next(steps)
            while True:
                try:
                    found = self._perform(step)
                except httpx.TransportError as error:
                    step = steps.throw(error)
                else:
                    step = steps.send(found)
        except StopIteration as end:
            value: T = end.value
            return value

    def _perform(self, step: Send | Pause) -> Any:
        if isinstance(step, Pause):
            return time.sleep(step.seconds)
        return self._http.request(step.method, step.path, **step.options)


class RemoteCurve:
    """The moves of a contact on a server between two of their numbers, which are followed when they are drawn."""

    def __init__(self, contact: RemoteContact, id: str, first: int, end: int):  # noqa: A002
        self._contact, self._id, self._first, self._end = contact, id, first, end

    def points(self) -> tuple[Floats, Floats]:
        """Displacements, m, and tangential forces, N."""
        calls = ContactCalls(self._contact._client._calls, self._id)
        after, found = self._first, []
        if after > 0:
            # A page that does not begin at the first move does not have the state before it.
            found.append(self._contact._run(calls.loop(after=after - 1, limit=1)))
        while after < self._end:
            limit = min(MOST_MOVES_OF_A_PAGE, self._end - after)
            page = calls.loop(after=after, limit=limit, points_per_move=POINTS_OF_A_PICTURE)
            found.append(self._contact._run(page))
            after += limit
        joined = [np.concatenate([getattr(page, name) for page in found]) for name in ("displacement", "force")]
        return joined[0], joined[1]


class RemoteContact(AnyContact):
    """A contact that a server keeps."""

    def __init__(self, client: Client, id: str, definition: Document, calls: ContactCalls | None = None):  # noqa: A002
        self._client = client
        self._definition = definition
        self._warned = set()
        self._calls = calls or ContactCalls(client._calls, id)

    @property
    def id(self) -> str:
        """The identifier of the contact."""
        return self._calls.id

    describe = _sent(ContactCalls.describe)
    undo = _sent(ContactCalls.undo)
    delete = _sent(ContactCalls.delete)
    rename = _sent(ContactCalls.rename)
    _history = _sent(ContactCalls.history)
    moves = _sent(ContactCalls.moves)
    _loop = _sent(ContactCalls.loop)
    cycles = _sent(ContactCalls.cycles)
    observe = _sent(ContactCalls.observe)
    friction = _sent(ContactCalls.friction)
    _moved = _sent(ContactCalls.advance)

    def _advance(self, kind: str, document: Document) -> tuple[Document, Curve | None]:
        reply = self._moved(kind, document)
        dry = bool(reply.get("dry_run"))
        return reply, None if dry else RemoteCurve(self, self.id, self._calls.made[-1], reply["sequence"])

    def copy(self) -> RemoteContact:
        """A copy of the contact on the server, with its history; it evolves independently from here."""
        made = self._run(self._calls.fork({}))
        calls = ContactCalls(self._client._calls, made["id"])
        calls.made = list(self._calls.made)
        copy = RemoteContact(self._client, made["id"], self._definition, calls)
        copy._warned = set(self._warned)
        return copy

    def history(
        self, *, after: int | None = None, limit: int | None = None, last: int | None = None, cycles: bool | None = None
    ) -> results.HistoryPage:
        """A page of its moves: at most `limit` after a number, or the `last` ones; `cycles=False` marks no cycles."""
        page = self._history(after=after, limit=limit, last=last, cycles=cycles)
        return self._drawn(page, [item["sequence"] for item in page._document["items"]])

    def loop(
        self,
        *,
        after: int | None = None,
        limit: int | None = None,
        last: int | None = None,
        points_per_move: int | None = None,
    ) -> results.LoopPage:
        """A page of its force-displacement loop: as of the history, with so many points for each move."""
        page = self._loop(after=after, limit=limit, last=last, points_per_move=points_per_move)
        return self._drawn(page, [number for number in page._document["sequence"] if number > 0])

    def _drawn(self, page: R, numbers: list[int]) -> R:
        """A page with the curve of its moves."""
        curve = RemoteCurve(self, self.id, numbers[0] - 1, numbers[-1]) if numbers else None
        return parse(type(page), page._document, **{**page.context, "curve": curve})

    def follow(self, after: int | None = None, *, patience: float = 300.0) -> Iterator[results.StateEvent]:
        """The states of the contact, one for each move after `after`, without end.

        Without `after` the present state comes first. A broken connection is restored, also when the server restarts,
        until nothing has come for `patience` seconds.
        """
        stream = Following(self._client._calls, f"{self._calls.path}/events", after, patience)
        while True:
            broken: Exception | None = None
            try:
                with self._client._http.stream("GET", stream.path, headers=stream.headers()) as response:
                    if response.is_error:
                        response.read()
                        stream.refused(response)
                    else:
                        for event in read_events(response.iter_lines()):
                            goes_on = stream.seen(event)
                            if event.name == "state":
                                yield parse(results.StateEvent, event.data)
                            if not goes_on:
                                return
            except httpx.TransportError as error:
                broken = error
            self._client._perform(stream.pause(broken))

    def to_bytes(self) -> NoReturn:
        """Refused: the contact is on its server. `api.Contact.from_bytes` moves a contact in process there."""
        raise TypeError("a contact on a server has no bytes: api.open(contact.id) finds it again")

    def __repr__(self) -> str:
        return f"RemoteContact({self.id})"

    def _read(self, kind: str, document: Document) -> Document:
        return self._run(self._calls.read(kind, document, self._definition))

    def _compute(self, name: str, document: Document) -> Document:
        return self._run(self._client._calls.json("POST", path_of(name), json=document))

    def _run(self, steps: Steps[T]) -> T:
        return self._client._run(steps)
