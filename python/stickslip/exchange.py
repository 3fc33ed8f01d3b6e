"""What is sent to a service and how it is repeated: each call is a generator of what it waits for.

`client` runs them on threads and `aio` on an event loop, so that both do the same.
"""

from __future__ import annotations

import json
import logging
import random
import time
import uuid
from collections.abc import Generator
from dataclasses import dataclass, field
from email.utils import parsedate_to_datetime
from typing import Any, TypeAlias, TypeVar

from . import results
from .documents import Document, to_document
from .engine import PATHS, Format, path_of
from .errors import Fault, InvalidInput, NotFound, ServerError, StickslipError, refusal
from .members import MOST_PLACES
from .optional import needed
from .result import parse
from .tables import columns_in_si, is_table

httpx = needed("httpx", "client")

#: Statuses after which a retry may help, and the longest wait, s.
RETRIED = frozenset({429, 502, 503, 504})
LONGEST_WAIT = 30.0
#: Waits that are logged, s.
LOGGED_WAIT = 1.0
#: Radii in one query.
MOST_RADII = 1000
#: Moves in one path.
MOST_MOVES = 100_000
#: The tolerance of moves that name none.
TOLERANCE = 1e-10
log = logging.getLogger("stickslip")
T = TypeVar("T")


@dataclass(frozen=True)
class Send:
    """A request to be sent, for its response."""

    method: str
    path: str
    options: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Pause:
    """A time to wait, s."""

    seconds: float


#: What a call waits for, one after the other, and what it returns.
Steps: TypeAlias = Generator[Send | Pause, Any, T]


def pause(attempt: int, why: str) -> Pause:
    """The pause before another attempt; one over a second is logged."""
    seconds = min(0.1 * 2.0**attempt, LONGEST_WAIT) * (0.5 + random.random())
    if seconds > LOGGED_WAIT:
        log.warning("%s: another attempt in %.1f s", why, seconds)
    return Pause(seconds)


def whole_url(url: str) -> str:
    """A URL with its scheme: http where none is given."""
    return url if "://" in url else f"http://{url}"


def advised(response: Any) -> float | None:
    """The time that a server advises to wait, s."""
    advice = response.headers.get("retry-after")
    if advice is None:
        return None
    if advice.isdigit():
        return float(advice)
    try:
        return max(0.0, parsedate_to_datetime(advice).timestamp() - time.time())
    except ValueError:
        return None


def failed(response: Any) -> StickslipError:
    """The exception of a response."""
    if response.headers.get("content-type", "").startswith("application/problem+json"):
        error = refusal(response.json())
    else:
        detail = f"status {response.status_code}, which is not a reply of the service"
        error = ServerError("unexpected_reply", detail)
    error.retry_after = advised(response)
    return error


def unreachable(base: Any, error: Exception) -> ServerError:
    """The exception where no response comes."""
    return ServerError("unreachable", f"{base} cannot be reached: {error}")


class Calls:
    """The calls of a client."""

    def __init__(self, base: str, retries: int):
        self.base = base
        self.retries = retries

    def request(self, /, method: str, path: str, *, idempotent: bool = False, **options: Any) -> Steps[Any]:
        """A request that is repeated if the service is busy or cannot be reached; a long advice to wait is raised."""
        headers = dict(options.pop("headers", {}))
        if idempotent:
            headers["idempotency-key"] = str(uuid.uuid4())
        send = Send(method, path, {"headers": headers, **options})
        for attempt in range(self.retries + 1):
            last = attempt == self.retries
            try:
                response = yield send
            except httpx.TransportError as error:
                if last:
                    raise unreachable(self.base, error) from error
                yield pause(attempt, f"{self.base} cannot be reached")
                continue
            if response.is_error:
                advice = advised(response)
                if last or response.status_code not in RETRIED or (advice or 0.0) > LONGEST_WAIT:
                    raise failed(response)
                if advice is None:
                    yield pause(attempt, f"{self.base} replied {response.status_code}")
                else:
                    if advice > LOGGED_WAIT:
                        log.warning("%s asks to wait: another attempt in %.1f s", self.base, advice)
                    yield Pause(advice)
                continue
            return response
        raise AssertionError("the last attempt returns or raises")

    def json(self, method: str, path: str, **options: Any) -> Steps[Document]:
        """The document of a reply."""
        found: Document = (yield from self.request(method, path, **options)).json()
        return found

    def compute(self, name: str, document: Document) -> Steps[Document]:
        """The reply of a computation to the document of its request, unchanged."""
        return self.json("POST", path_of(name), json=to_document(document))

    def compute_bytes(self, name: str, document: Document, format: Format = "columns") -> Steps[bytes]:  # noqa: A002
        """The same as bytes: JSON, or another format of the computation, such as `arrow` or `svg`."""
        query = {} if format == "columns" else {"format": format}
        response = yield from self.request("POST", path_of(name), json=to_document(document), params=query)
        content: bytes = response.content
        return content

    def sweep_document(self, document: Document) -> Steps[Document]:
        """The table of a sweep as a document; the call waits for a sweep that runs as a job."""
        response = yield from self.request("POST", "/sweep", json=document, idempotent=True)
        found: Document = response.json()
        if response.status_code != 202:
            return found
        job, wait = found["id"], 0.1
        log.info("the sweep runs as the job %s", job)
        while found["state"] not in ("done", "failed"):
            if wait > LOGGED_WAIT:
                log.info("the job %s is at %s; the next look is in %.1f s", job, found["progress"], wait)
            yield Pause(wait)
            wait = min(2.0 * wait, 5.0)
            found = yield from self.json("GET", f"/jobs/{job}")
        return (yield from self.json("GET", f"/jobs/{job}/result"))

    def create(self, definition: Document, label: str | None) -> Steps[Document]:
        """The reply to a new contact."""
        document = definition | ({} if label is None else {"label": label})
        return self.json("POST", "/contacts", json=document, idempotent=True)

    def restore(self, data: bytes) -> Steps[tuple[Document, Document]]:
        """A contact of what `to_bytes` of a contact in process wrote: the reply to its creation, and its definition."""
        try:
            document = json.loads(data)
            definition, moves, label = document["definition"], document["moves"], document.get("label")
        except (ValueError, KeyError, TypeError) as error:
            detail = f"these bytes are not those of a contact: {error}"
            raise InvalidInput("invalid_input", detail) from None
        made = yield from self.create(definition, label)
        first = 0
        while first < len(moves):
            tolerance = moves[first][1]
            end = first + 1
            while end < len(moves) and moves[end][1] == tolerance and end - first < MOST_MOVES:
                end += 1
            path = {"moves": [move for move, _ in moves[first:end]]}
            body = {"path": path, "steps": "last", "tolerance": tolerance}
            yield from self.json("POST", f"/contacts/{made['id']}/path", json=body, idempotent=True)
            first = end
        return made, definition

    def page(self, query: Document) -> Steps[Document]:
        """A page of contacts."""
        return self.json("GET", "/contacts", params=query)

    def stress(self, path: str, query: Document) -> Steps[Document]:
        """Stresses of one state at as many radii as in process, by several queries if they are many."""
        axis = next((name for name in ("radii", "x") if len(query.get(name) or ()) > MOST_RADII), None)
        if axis is None:
            return (yield from self.json("GET", path, params=_listed(query)))
        places = query[axis]
        if len(places) > MOST_PLACES:
            # Each of the queries would be within the limit.
            detail = f"{len(places)} elements: allowed are 1 to {MOST_PLACES}"
            raise InvalidInput("invalid_input", detail, (Fault(f"/{axis}", detail),))
        for _ in range(self.retries + 1):
            parts, tags = [], set()
            for first in range(0, len(places), MOST_RADII):
                part = _listed(query | {axis: places[first : first + MOST_RADII]})
                response = yield from self.request("GET", path, params=part)
                parts.append(response.json())
                tags.add(response.headers.get("etag"))
            if len(tags) == 1:
                whole: Document = parts[0]
                lists = {name for name, value in whole.items() if isinstance(value, list)}
                joined = {name: [item for part in parts for item in part[name]] for name in lists}
                return whole | joined
        detail = "other clients kept moving the contact while its stresses were read"
        raise InvalidInput("conflict", detail, (Fault(f"/{axis}", detail),))

    def read_file(self, kind: str, content: bytes, hints: Document) -> Steps[Document]:
        """The scan or loop that the importer of the server finds in a file."""
        body = {"content": content, "headers": {"content-type": "application/octet-stream"}}
        return self.json("POST", f"/files/{kind}", params=hints, **body)


def _listed(query: Document) -> Document:
    """The values of a query."""

    def text(value: Any) -> Any:
        if isinstance(value, list):
            return ",".join(str(item) for item in value)
        return str(value).lower() if isinstance(value, bool) else value

    return {name: text(value) for name, value in query.items()}


class ContactCalls:
    """The calls of a contact on a server."""

    def __init__(self, calls: Calls, id: str):  # noqa: A002
        self.calls = calls
        self.id = id
        #: The number of moves before each call that moved it.
        self.made: list[int] = []

    @property
    def path(self) -> str:
        """Its path."""
        return f"/contacts/{self.id}"

    def describe(self) -> Steps[results.SessionReply]:
        """Identifier, number of moves, summary of the definition and present state."""
        return parse(results.SessionReply, (yield from self.calls.json("GET", self.path)))

    def delete(self) -> Steps[None]:
        """Deletes the contact on the server; one that is already deleted, as by a lost response, is no error."""
        try:
            yield from self.calls.request("DELETE", self.path)
        except NotFound:
            return

    def rename(self, label: str | None) -> Steps[results.SessionReply]:
        """Changes the label of the contact."""
        body = {"label": label}
        return parse(results.SessionReply, (yield from self.calls.json("PATCH", self.path, json=body, idempotent=True)))

    def history(
        self, *, after: int | None = None, limit: int | None = None, last: int | None = None, cycles: bool | None = None
    ) -> Steps[results.HistoryPage]:
        """A page of its moves: at most `limit` after a number, or the `last` ones; `cycles=False` marks no cycles."""
        marked = None if cycles is None else str(bool(cycles)).lower()
        query = _given(after=after, limit=limit, last=last, cycles=marked)
        return parse(results.HistoryPage, (yield from self.calls.json("GET", f"{self.path}/history", params=query)))

    def moves(self) -> Steps[list[Document]]:
        """The moves so far, in the form of a path."""
        moves: list[Document] = []
        after: int | None = 0
        while after is not None:
            query = {"after": after, "limit": 1000}
            page = yield from self.calls.json("GET", f"{self.path}/history", params=query)
            moves += [item["move"] for item in page["items"]]
            after = page["next"]
        return moves

    def loop(
        self,
        *,
        after: int | None = None,
        limit: int | None = None,
        last: int | None = None,
        points_per_move: int | None = None,
    ) -> Steps[results.LoopPage]:
        """A page of its force-displacement loop: as of the history, with so many points for each move."""
        query = _given(after=after, limit=limit, last=last, points_per_move=points_per_move)
        return parse(results.LoopPage, (yield from self.calls.json("GET", f"{self.path}/loop", params=query)))

    def cycles(self, *, last: int | None = None) -> Steps[results.CyclePage]:
        """The closed cycles of the history, or the last ones."""
        query = _given(last=last)
        return parse(results.CyclePage, (yield from self.calls.json("GET", f"{self.path}/cycles", params=query)))

    def observe(self, observations: Any) -> Steps[results.ObservationsReply]:
        """Follows a bench: displacements with the measured forces, and the forces that the contact predicts."""
        if is_table(observations):
            columns = columns_in_si(observations, ("displacement", "force"), ())
            rows = zip(*columns.values(), strict=True)
            observations = [dict(zip(columns, row, strict=True)) for row in rows]
        body = to_document({"observations": observations})
        reply = yield from self.calls.json("POST", f"{self.path}/observations", json=body, idempotent=True)
        return parse(results.ObservationsReply, reply)

    def friction(self) -> Steps[results.FrictionReply]:
        """The coefficient of friction from the observations of the contact."""
        return parse(results.FrictionReply, (yield from self.calls.json("GET", f"{self.path}/friction")))

    def fork(self, body: Document) -> Steps[Document]:
        """The reply to a new contact with the same past, or with a part of it."""
        return self.calls.json("POST", f"{self.path}/fork", json=body, idempotent=True)

    def undo(self, calls: int = 1) -> Steps[results.State]:
        """Takes back the last calls of this object that moved the contact, which gets a new identifier."""
        kept = len(self.made) - calls
        if kept < 0:
            detail = f"{len(self.made)} calls have moved this contact"
            raise InvalidInput("invalid_input", detail, (Fault("/calls", detail),))
        made = yield from self.fork({"sequence": self.made[kept]} if calls else {})
        yield from self.delete()
        self.id, self.made = made["id"], self.made[:kept]
        return (yield from self.describe()).state

    def advance(self, kind: str, document: Document) -> Steps[Document]:
        """Makes a `move`, a `path` or the path of `relax`."""
        found = yield from self.calls.json("POST", f"{self.path}/{kind}", json=document, idempotent=True)
        if not found.get("dry_run"):
            self.made.append(found["sequence"] - (1 if kind == "move" else moves_of(document, found)))
        return found

    def read(self, kind: str, document: Document, definition: Document) -> Steps[Document]:
        """The `stress`, the `subsurface` stress or the steady `cycle` of the present state."""
        if kind == "subsurface":
            return (yield from self.calls.json("POST", f"{self.path}/{kind}", json=document))
        if kind == "stress":
            return (yield from self.calls.stress(f"{self.path}/{kind}", document))
        now = definition | {"preload": {"normal_force": (yield from self.describe()).state.normal_force}}
        name = "fretting" if kind == "fretting" else "cycle"
        return (yield from self.calls.json("POST", PATHS[name], json=document | {"contact": now}))


def _given(**query: Any) -> Document:
    return {name: value for name, value in query.items() if value is not None}


def moves_of(document: Document, reply: Document) -> int:
    """Number of moves of a path that has been followed."""
    way = document.get("path", {})
    if "cycles" in way:
        cycles = way["cycles"]
        return 1 + int(cycles["count"]) * int(cycles.get("points_per_cycle", 64 if "normal" in cycles else 2))
    for name in ("falling_amplitude", "equal_peaks"):
        if name in way:
            return int(way[name]["reversals"]) + 1
    listed = next((moves for moves in way.values() if isinstance(moves, list)), None)
    return len(reply["path"]["displacement"] if listed is None else listed)


class Following:
    """A stream of events that goes on after a connection has broken, or the server has been started again."""

    def __init__(self, calls: Calls, path: str, last: int | None, patience: float):
        self.calls, self.path, self.last, self.patience = calls, path, last, patience
        self._attempt = 0
        self._broken_since: float | None = None

    def headers(self) -> dict[str, str]:
        """The headers of the next request."""
        resumed = {} if self.last is None else {"last-event-id": str(self.last)}
        return {"accept": "text/event-stream"} | resumed

    def refused(self, response: Any) -> None:
        """Raises what no later attempt can change."""
        if response.status_code not in RETRIED:
            raise failed(response)

    def seen(self, event: Any) -> bool:
        """Whether the stream goes on after this event."""
        self._attempt, self._broken_since = 0, None
        if event.id is not None:
            self.last = int(event.id)
        return not (event.name == "end" and event.data.get("reason") != "stopping")

    def pause(self, error: Exception | None) -> Pause:
        """The pause before the next request; raises once nothing has come for longer than `patience`."""
        now = time.monotonic()
        self._broken_since = self._broken_since or now
        if now - self._broken_since > self.patience:
            raise unreachable(self.calls.base, error or Exception("it gives no events")) from error
        self._attempt += 1
        return pause(self._attempt, f"{self.calls.base} gives no events")
