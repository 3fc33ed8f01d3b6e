"""A client of a service: the same methods as in process, contacts as objects."""

from __future__ import annotations

import random
import time
import uuid
from collections.abc import Iterator, Mapping
from typing import Any

import httpx

from . import results
from .bodies import Material
from .contact import AnyContact, definition
from .documents import Document, HasDocument, Quantity, members, to_document
from .engine import Engine
from .errors import ServerError, StickslipError, refusal, warn
from .events import Event, read_events
from .result import parse

#: The path of each computation.
PATHS = {
    "simulate": "/simulate",
    "accuracy": "/accuracy",
    "protocol": "/protocols",
    "cycle": "/cycle",
    "fretting": "/fretting",
    "wear": "/wear",
    "profile": "/profiles/fit",
    "fit": "/fit",
}
#: What a retry may help against, and how long it waits at the most, s.
RETRIED = frozenset({429, 502, 503, 504})
LONGEST_WAIT = 30.0


class Client(Engine):
    """A service at a URL. Changes carry idempotency keys, so that a repeated request changes nothing twice."""

    def __init__(self, url: str, key: str | None = None, *, timeout: float = 90.0, retries: int = 4):
        headers = {} if key is None else {"authorization": f"Bearer {key}"}
        self._http = httpx.Client(base_url=url, headers=headers, timeout=timeout)
        self._retries = retries

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __getattr__(self, name: str) -> Any:
        # Shapes, bodies and errors are those of the package, so that a notebook changes by one line.
        import stickslip

        if name == "Contact":
            return self.contact
        if name in stickslip.__all__:
            return getattr(stickslip, name)
        raise AttributeError(name)

    def close(self) -> None:
        """Closes the connections."""
        self._http.close()

    def compute(self, name: str, document: Document) -> Document:
        """The reply of a computation to the document of its request, as it is."""
        return self.request("POST", PATHS[name], json=to_document(document)).json()  # type: ignore[no-any-return]

    def sweep_document(self, document: Document) -> Document:
        """The table of a sweep as a document; one that is run as a job is waited for."""
        response = self.request("POST", "/sweep", json=document, idempotent=True)
        found: Document = response.json()
        if response.status_code != 202:
            return found
        job, wait = found["id"], 0.1
        while found["state"] not in ("done", "failed"):
            time.sleep(wait)
            wait = min(2.0 * wait, 5.0)
            found = self.request("GET", f"/jobs/{job}").json()
        return self.request("GET", f"/jobs/{job}/result").json()  # type: ignore[no-any-return]

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
    ) -> RemoteContact:
        """A new contact on the server."""
        given = definition(profile, bodies, friction, normal_force, indentation, contact_radius)
        document = given | ({} if label is None else {"label": label})
        made = self.request("POST", "/contacts", json=document, idempotent=True).json()
        warn(made["warnings"])
        return RemoteContact(self, made["id"], given)

    def open(self, id: str) -> RemoteContact:  # noqa: A002
        """The contact of an identifier."""
        return RemoteContact(self, id, self.request("GET", f"/contacts/{id}/definition").json())

    def contacts(self, label: str | None = None, *, newest_first: bool = False) -> Iterator[results.SessionSummary]:
        """All contacts, oldest or newest first; of a label alone, if one is given."""
        after: str | None = None
        order = "newest" if newest_first else None
        while True:
            page = self.request("GET", "/contacts", params=members(label=label, order=order, after=after)).json()
            yield from (parse(results.SessionSummary, item) for item in page["items"])
            after = page["next"]
            if after is None:
                return

    def request(self, method: str, path: str, *, idempotent: bool = False, **options: Any) -> httpx.Response:
        """The response to a request, which is repeated if the service is busy or cannot be reached."""
        headers = dict(options.pop("headers", {}))
        if idempotent:
            headers["idempotency-key"] = str(uuid.uuid4())
        for attempt in range(self._retries + 1):
            last = attempt == self._retries
            try:
                response = self._http.request(method, path, headers=headers, **options)
            except httpx.TransportError as error:
                if last:
                    raise ServerError("unreachable", f"{self._http.base_url} cannot be reached: {error}") from error
                time.sleep(_pause(attempt, None))
                continue
            if response.status_code in RETRIED and not last:
                time.sleep(_pause(attempt, response.headers.get("retry-after")))
                continue
            if response.is_error:
                raise _failed(response)
            return response
        raise AssertionError("the last attempt returns or raises")

    def stream(self, path: str, last: int | None) -> Iterator[Event]:
        """The events of a stream from the one after `last` on; a connection that breaks is made again."""
        attempt = 0
        while True:
            headers = {"accept": "text/event-stream"} | ({} if last is None else {"last-event-id": str(last)})
            try:
                with self._http.stream("GET", path, headers=headers, timeout=httpx.Timeout(90.0)) as response:
                    if response.is_error:
                        response.read()
                        raise _failed(response)
                    for event in read_events(response.iter_lines()):
                        attempt = 0
                        if event.id is not None:
                            last = int(event.id)
                        yield event
                        if event.name == "end" and event.data.get("reason") != "stopping":
                            return
            except httpx.TransportError as error:
                if attempt >= self._retries:
                    raise ServerError("unreachable", f"{self._http.base_url} cannot be reached: {error}") from error
            time.sleep(_pause(attempt, None))
            attempt += 1


class RemoteContact(AnyContact):
    """A contact that a server keeps."""

    def __init__(self, client: Client, id: str, definition: Document):  # noqa: A002
        self._client = client
        self._definition = definition
        self.id = id
        #: The number of moves before each call that moved it.
        self._calls: list[int] = []

    @property
    def _path(self) -> str:
        return f"/contacts/{self.id}"

    def describe(self) -> results.SessionReply:
        """Identifier, number of moves, summary of the definition and present state."""
        return parse(results.SessionReply, self._client.request("GET", self._path).json())

    def definition(self) -> Document:
        """The JSON document of its definition, at its preload."""
        return self._definition

    def copy(self) -> RemoteContact:
        """The same contact once more on the server, with its history; it goes its own way from here."""
        return self._fork({})

    def undo(self, calls: int = 1) -> results.State:
        """Takes back the last calls of this object that moved it: the contact gets a new identifier."""
        if calls > len(self._calls):
            raise ValueError(f"{len(self._calls)} calls of this object have moved the contact")
        kept = len(self._calls) - calls
        fork = self._fork({"sequence": self._calls[kept]} if calls else {})
        self.delete()
        self.id, self._calls = fork.id, self._calls[:kept]
        return self.state

    def delete(self) -> None:
        """Deletes it on the server."""
        self._client.request("DELETE", self._path)

    def rename(self, label: str | None) -> results.SessionReply:
        """Changes its label."""
        reply = self._client.request("PATCH", self._path, json={"label": label}, idempotent=True)
        return parse(results.SessionReply, reply.json())

    def history(self, **query: Any) -> results.HistoryPage:
        """A page of its moves: `after`, `limit`, `last`, `cycles`."""
        return parse(results.HistoryPage, self._client.request("GET", f"{self._path}/history", params=query).json())

    def loop(self, **query: Any) -> results.LoopPage:
        """A page of its force-displacement loop: `after`, `limit`, `last`, `points_per_move`."""
        return parse(results.LoopPage, self._client.request("GET", f"{self._path}/loop", params=query).json())

    def cycles(self, **query: Any) -> results.CyclePage:
        """The closed cycles of its past: `last`."""
        return parse(results.CyclePage, self._client.request("GET", f"{self._path}/cycles", params=query).json())

    def observe(self, observations: Any) -> results.ObservationsReply:
        """Follows a bench: displacements with the measured forces, beside what the contact predicts."""
        body = members(observations=observations)
        reply = self._client.request("POST", f"{self._path}/observations", json=body, idempotent=True)
        return parse(results.ObservationsReply, reply.json())

    def friction(self) -> results.FrictionReply:
        """The coefficient of friction by its observations."""
        return parse(results.FrictionReply, self._client.request("GET", f"{self._path}/friction").json())

    def follow(self, after: int | None = None) -> Iterator[results.StateEvent]:
        """Its states, one for each move after `after`, without end; a broken connection resumes by itself."""
        for event in self._client.stream(f"{self._path}/events", after):
            if event.name == "state":
                yield parse(results.StateEvent, event.data)

    def __repr__(self) -> str:
        return f"RemoteContact({self.id})"

    def _fork(self, body: Document) -> RemoteContact:
        made = self._client.request("POST", f"{self._path}/fork", json=body, idempotent=True).json()
        fork = RemoteContact(self._client, made["id"], self._definition)
        fork._calls = list(self._calls)
        return fork

    def _advance(self, kind: str, document: Document) -> Document:
        reply = self._client.request("POST", f"{self._path}/{kind}", json=document, idempotent=True)
        found: Document = reply.json()
        if not found.get("dry_run"):
            moves = 1 if kind == "move" else _moves(document, found)
            self._calls.append(found["sequence"] - moves)
        return found

    def _read(self, kind: str, document: Document) -> Document:
        if kind == "subsurface":
            return self._client.request("POST", f"{self._path}/{kind}", json=document).json()  # type: ignore[no-any-return]
        if kind == "stress":
            query = {name: _listed(value) for name, value in document.items()}
            return self._client.request("GET", f"{self._path}/{kind}", params=query).json()  # type: ignore[no-any-return]
        return self._compute("cycle", {"contact": self.definition_now()} | document)

    def _compute(self, name: str, document: Document) -> Document:
        return self._client.compute(name, document)


def _listed(value: Any) -> Any:
    """A value of a query."""
    if isinstance(value, list):
        return ",".join(str(item) for item in value)
    return str(value).lower() if isinstance(value, bool) else value


def _moves(document: Document, reply: Document) -> int:
    """Number of moves of a path that has been followed."""
    way = document.get("path", {})
    if "cycles" in way:
        cycles = way["cycles"]
        return 1 + int(cycles["count"]) * int(cycles.get("points_per_cycle", 2))
    for name in ("falling_amplitude", "equal_peaks"):
        if name in way:
            return int(way[name]["reversals"]) + 1
    listed = next((moves for moves in way.values() if isinstance(moves, list)), None)
    return len(reply["path"]["displacement"] if listed is None else listed)


def _pause(attempt: int, advice: str | None) -> float:
    """How long to wait before the next attempt, s."""
    if advice is not None and advice.isdigit():
        return min(float(advice), LONGEST_WAIT)
    return min(0.1 * 2.0**attempt, LONGEST_WAIT) * (0.5 + random.random())


def _failed(response: httpx.Response) -> StickslipError:
    if response.headers.get("content-type", "").startswith("application/problem+json"):
        return refusal(response.json())
    return ServerError("unexpected_reply", f"status {response.status_code}, which is not a reply of the service")
