"""A server of this process."""

from __future__ import annotations

from . import _native
from .client import Client


class ServedClient(Client):
    """A client of a server that ends with it."""

    def __init__(self, server: _native.Server):
        super().__init__(server.url)
        self._server = server

    def close(self) -> None:
        """Closes the connections and ends the server."""
        super().close()
        self._server.stop()


def serve(store: str = "memory:", port: int = 0) -> ServedClient:
    """Starts a server on a loopback port (0 for any free one) and connects to it: `with serve() as api:`.

    It runs in threads of this process, with a store of its own unless one is named, and ends with the process at the
    latest.
    """
    if not hasattr(_native, "Server"):
        raise OSError("only the wheels for Linux have the server")
    return ServedClient(_native.Server(store, port))
