"""Events of a stream (Server-Sent Events)."""

from __future__ import annotations

import json
from collections.abc import AsyncIterable, AsyncIterator, Iterable, Iterator
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Event:
    """One event: its name, its identifier and its document."""

    name: str
    id: str | None
    data: dict[str, Any]


class _Reader:
    """Makes events of lines."""

    def __init__(self) -> None:
        self.name = "message"
        self.ident: str | None = None
        self.data: list[str] = []

    def read(self, line: str) -> Event | None:
        """The event that a line ends, if it ends one."""
        if not line:
            event = Event(self.name, self.ident, json.loads("\n".join(self.data))) if self.data else None
            self.name, self.ident, self.data = "message", None, []
            return event
        field, _, value = line.partition(":")
        value = value.removeprefix(" ")
        if field == "event":
            self.name = value
        elif field == "id":
            self.ident = value
        elif field == "data":
            self.data.append(value)
        return None


def read_events(lines: Iterable[str]) -> Iterator[Event]:
    """The events of the lines of a stream."""
    reader = _Reader()
    for line in lines:
        event = reader.read(line)
        if event is not None:
            yield event


async def read_events_of(lines: AsyncIterable[str]) -> AsyncIterator[Event]:
    """The same on an event loop."""
    reader = _Reader()
    async for line in lines:
        event = reader.read(line)
        if event is not None:
            yield event
