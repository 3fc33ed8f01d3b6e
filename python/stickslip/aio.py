"""The client for asyncio, with the same names; `state`, `summary` and `sequence` of its contacts are awaited too.

A call that is cancelled after its request was sent may still be carried out by the server: a cancelled `move`, `path`
or `relax` may leave its moves applied. `sequence()` says how many moves there are.
"""

from __future__ import annotations

import asyncio
import os
from collections.abc import AsyncIterator, Awaitable, Callable
from functools import wraps
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, TypeVar

from . import results
from .bodies import Material, Shape
from .client import of_module
from .computations import AsyncComputations, AsyncOfContact
from .contact import MOVES, DefinedContact, definition
from .documents import Document, Quantity, to_document
from .engine import NAMES, answer, request_of
from .errors import warn
from .events import read_events_of
from .exchange import Calls, ContactCalls, Following, Pause, Send, Steps, whole_url
from .instruments import Loop, LoopHints, Scan, ScanHints, content_of, hints_of, loop_of, scan_of
from .optional import needed
from .requests import definition as definition_of
from .result import Record, parse

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .request_types import DefinitionMembers

httpx = needed("httpx", "client")
P = ParamSpec("P")
T = TypeVar("T")
R = TypeVar("R", bound=Record)


def _sent(call: Callable[Concatenate[Any, P], Steps[T]]) -> Callable[Concatenate[Any, P], Awaitable[T]]:
    """The method of a client or contact that makes a call."""

    @wraps(call)
    async def method(self: Any, /, *arguments: P.args, **options: P.kwargs) -> T:
        found: T = await self._run(call(self._calls, *arguments, **options))
        return found

    return method


class AsyncContactMaker:
    """`Contact` on a server: from keywords, a definition, or the bytes of a contact in process."""

    def __init__(self, client: AsyncClient):
        self._client = client

    async def __call__(
        self,
        profile: Shape,
        bodies: Material,
        friction: Quantity,
        *,
        label: str | None = None,
        **load: Unpack[DefinitionMembers],
    ) -> AsyncContact:
        """A new contact on the server."""
        return await self._made(definition(profile, bodies, friction, load), label)

    async def from_definition(self, definition: Any) -> AsyncContact:
        """The contact of a definition: one of this package, or a JSON document."""
        document = to_document(definition_of(definition))
        label = document.pop("label", None)
        return await self._made(document, label)

    async def from_bytes(self, data: bytes) -> AsyncContact:
        """The contact that `to_bytes` of a contact in process wrote: its moves are repeated on the server."""
        made, given = await self._client._run(self._client._calls.restore(data))
        return AsyncContact(self._client, made["id"], given)

    async def _made(self, given: Document, label: str | None) -> AsyncContact:
        made = await self._client._run(self._client._calls.create(given, label))
        contact = AsyncContact(self._client, made["id"], given)
        warn(made["warnings"], contact._warned)
        return contact


class AsyncClient(AsyncComputations):
    """A service at a URL: `async with AsyncClient(url) as api:`. Calls wait on the event loop, without threads."""

    def __init__(self, url: str, key: str | None = None, *, timeout: float = 90.0, retries: int = 4):
        url = whole_url(url)
        headers = {} if key is None else {"authorization": f"Bearer {key}"}
        # Streams are open for long, and each holds a connection.
        limits = httpx.Limits(max_connections=None, max_keepalive_connections=20)
        self._http = httpx.AsyncClient(base_url=url, headers=headers, timeout=timeout, limits=limits)
        self._calls = Calls(url, retries)

    async def __aenter__(self) -> AsyncClient:
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.close()

    def __getattr__(self, name: str) -> Any:
        return of_module(name)

    @property
    def Contact(self) -> AsyncContactMaker:  # noqa: N802
        """`stickslip.Contact`, on the server."""
        return AsyncContactMaker(self)

    async def close(self) -> None:
        """Closes the connections."""
        await self._http.aclose()

    request = _sent(Calls.request)
    compute = _sent(Calls.compute)
    compute_bytes = _sent(Calls.compute_bytes)
    sweep_document = _sent(Calls.sweep_document)

    async def contact(
        self,
        profile: Shape,
        bodies: Material,
        friction: Quantity,
        *,
        label: str | None = None,
        **load: Unpack[DefinitionMembers],
    ) -> AsyncContact:
        """A new contact on the server."""
        return await self.Contact(profile, bodies, friction, label=label, **load)

    async def open(self, id: str) -> AsyncContact:  # noqa: A002
        """The contact of an identifier."""
        return AsyncContact(self, id, await self._run(self._calls.json("GET", f"/contacts/{id}/definition")))

    async def contacts(
        self, label: str | None = None, *, newest_first: bool = False
    ) -> AsyncIterator[results.SessionSummary]:
        """All contacts, oldest or newest first; with `label`, only those whose label contains it."""
        query = {"label": label, "order": "newest" if newest_first else None}
        after: str | None = None
        while True:
            given = {name: value for name, value in (query | {"after": after}).items() if value is not None}
            page = await self._run(self._calls.page(given))
            for item in page["items"]:
                yield parse(results.SessionSummary, item)
            after = page["next"]
            if after is None:
                return

    async def read_loop(self, source: str | os.PathLike[str] | bytes, **hints: Unpack[LoopHints]) -> Loop:
        """`stickslip.read_loop`, read by the server."""
        return loop_of(await self._run(self._calls.read_file("loop", content_of(source), hints_of(hints))))

    async def read_scan(self, source: str | os.PathLike[str] | bytes, **hints: Unpack[ScanHints]) -> Scan:
        """`stickslip.read_scan`, read by the server, without the formats of SurfaceTopography."""
        return scan_of(await self._run(self._calls.read_file("scan", content_of(source), hints_of(hints))))

    async def _answer(self, kind: type[R], name: str, given: Document, parts: dict[str, Document]) -> R:
        request = request_of(name, given, parts)
        call = self.sweep_document(request) if name == "/sweep" else self.compute(NAMES[name], request)
        return answer(kind, await call, given.get("contact"), request)

    async def _run(self, steps: Steps[T]) -> T:
        """Runs a call: sends its requests, and waits during its pauses."""
        try:
            step = next(steps)
            while True:
                try:
                    found = await self._perform(step)
                except httpx.TransportError as error:
                    step = steps.throw(error)
                else:
                    step = steps.send(found)
        except StopIteration as end:
            value: T = end.value
            return value

    async def _perform(self, step: Send | Pause) -> Any:
        if isinstance(step, Pause):
            return await asyncio.sleep(step.seconds)
        return await self._http.request(step.method, step.path, **step.options)


class AsyncContact(AsyncOfContact, DefinedContact):
    """A contact that a server keeps."""

    def __init__(self, client: AsyncClient, id: str, definition: Document):  # noqa: A002
        self._client = client
        self._definition = definition
        self._warned = set()
        self._calls = ContactCalls(client._calls, id)

    @property
    def id(self) -> str:
        """The identifier of the contact."""
        return self._calls.id

    describe = _sent(ContactCalls.describe)
    undo = _sent(ContactCalls.undo)
    delete = _sent(ContactCalls.delete)
    rename = _sent(ContactCalls.rename)
    history = _sent(ContactCalls.history)
    moves = _sent(ContactCalls.moves)
    loop = _sent(ContactCalls.loop)
    cycles = _sent(ContactCalls.cycles)
    observe = _sent(ContactCalls.observe)
    friction = _sent(ContactCalls.friction)

    async def state(self) -> results.State:
        """The state after the last move."""
        return (await self.describe()).state

    async def summary(self) -> results.Figures:
        """Quantities that follow from the definition at its preload."""
        return (await self.describe()).contact

    async def sequence(self) -> int:
        """Number of moves so far."""
        return (await self.describe()).sequence

    async def definition_now(self) -> Document:
        """The definition with the present normal force as its preload."""
        return self.definition() | {"preload": {"normal_force": (await self.state()).normal_force}}

    async def wait(self, duration: Quantity) -> results.MoveReply:
        """Waits for this long, s: bodies with memory relax at the indentation and the displacement that they have."""
        return await self.move(duration=duration)

    async def residual(self) -> results.Residual:
        """The local extrema of the shear stress, Pa."""
        found = (await self.stress(2, fields=["shear"], residual=True)).residual
        assert found is not None
        return found

    async def copy(self) -> AsyncContact:
        """A copy of the contact on the server, with its history; it evolves independently from here."""
        made = await self._run(self._calls.fork({}))
        copy = AsyncContact(self._client, made["id"], self._definition)
        copy._calls.made = list(self._calls.made)
        copy._warned = set(self._warned)
        return copy

    async def follow(self, after: int | None = None, *, patience: float = 300.0) -> AsyncIterator[results.StateEvent]:
        """The states of the contact, one for each move after `after`, without end.

        Without `after` the present state comes first. A broken connection is restored, also when the server restarts,
        until nothing has come for `patience` seconds.
        """
        stream = Following(self._client._calls, f"{self._calls.path}/events", after, patience)
        while True:
            broken: Exception | None = None
            try:
                async with self._client._http.stream("GET", stream.path, headers=stream.headers()) as response:
                    if response.is_error:
                        await response.aread()
                        stream.refused(response)
                    else:
                        async for event in read_events_of(response.aiter_lines()):
                            goes_on = stream.seen(event)
                            if event.name == "state":
                                yield parse(results.StateEvent, event.data)
                            if not goes_on:
                                return
            except httpx.TransportError as error:
                broken = error
            await self._client._perform(stream.pause(broken))

    def __repr__(self) -> str:
        return f"AsyncContact({self.id})"

    async def _answer_of_contact(self, kind: type[R], name: str, given: Document, parts: dict[str, Document]) -> R:
        document = self._document(name, given, parts)
        if name in MOVES:
            reply = await self._run(self._calls.advance(name, document))
        else:
            reply = await self._run(self._calls.read(name, document, self._definition))
        return self._reply(kind, reply, document)

    async def _run(self, steps: Steps[T]) -> T:
        return await self._client._run(steps)
