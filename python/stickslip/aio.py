"""The client for asyncio, with the same names: each call runs on a thread of its own, and contacts are objects too."""

from __future__ import annotations

import asyncio
import functools
from collections.abc import AsyncIterator
from typing import Any

from . import results
from .client import Client, RemoteContact


class _Awaitable:
    """An object whose methods are awaited."""

    def __init__(self, inner: Any):
        self._inner = inner

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._inner, name)
        if not callable(found) or isinstance(found, type):
            return found

        @functools.wraps(found)
        async def call(*arguments: Any, **options: Any) -> Any:
            reply = await asyncio.to_thread(found, *arguments, **options)
            return AsyncContact(reply) if isinstance(reply, RemoteContact) else reply

        return call


class AsyncContact(_Awaitable):
    """A contact on a server. `state`, `summary` and `sequence` are methods here."""

    async def state(self) -> results.State:
        """The state after the last move."""
        return (await self.describe()).state  # type: ignore[no-any-return]

    async def summary(self) -> results.Figures:
        """What follows from the definition at its preload."""
        return (await self.describe()).contact  # type: ignore[no-any-return]

    async def sequence(self) -> int:
        """Number of moves so far."""
        return (await self.describe()).sequence  # type: ignore[no-any-return]

    async def follow(self, after: int | None = None) -> AsyncIterator[results.StateEvent]:
        """Its states, one for each move after `after`; a broken connection resumes by itself."""
        events = self._inner.follow(after)
        while (event := await asyncio.to_thread(next, events, None)) is not None:
            yield event


class AsyncClient(_Awaitable):
    """A service at a URL: `async with AsyncClient(url) as api:`."""

    def __init__(self, url: str, key: str | None = None, **options: Any):
        super().__init__(Client(url, key, **options))

    async def __aenter__(self) -> AsyncClient:
        return self

    async def __aexit__(self, *_: object) -> None:
        self._inner.close()
