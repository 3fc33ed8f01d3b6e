"""A client whose server is busy, away or killed; many calls at once without threads; the same limits and errors."""

from __future__ import annotations

import asyncio
import json
import logging
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime, timedelta, timezone
from email.utils import format_datetime
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from test_client import ball as remote_ball

import stickslip as ss
from stickslip import exchange
from stickslip.aio import AsyncClient
from stickslip.client import RemoteContact

BALL = ss.Definition(ss.Sphere(0.01), ss.Moduli(1.15e11, 8.5e10), 0.3, normal_force=10.0)


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@contextmanager
def service(port: int, store: str) -> Iterator[subprocess.Popen[bytes]]:
    """The service as a process of its own, once it answers."""
    command = [sys.executable, "-m", "stickslip", "serve", "--listen", f"127.0.0.1:{port}", "--store", store]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        deadline = time.monotonic() + 60.0
        while time.monotonic() < deadline:
            try:
                httpx.get(f"http://127.0.0.1:{port}/readyz").raise_for_status()
                break
            except httpx.HTTPError:
                time.sleep(0.05)
        yield process
    finally:
        process.send_signal(signal.SIGKILL)
        process.wait()


@contextmanager
def answering(replies: list[tuple[int, dict[str, str], str]]) -> Iterator[tuple[str, list[str]]]:
    """A server that gives these replies, one after the other, and the requests that it had."""
    had: list[str] = []

    class Handler(BaseHTTPRequestHandler):
        def reply(self) -> None:
            had.append(f"{self.command} {self.path} {self.headers.get('last-event-id')}")
            status, headers, text = replies[min(len(had), len(replies)) - 1]
            self.send_response(status)
            for name, value in {"content-length": str(len(text)), **headers}.items():
                self.send_header(name, value)
            self.end_headers()
            self.wfile.write(text.encode())

        do_GET = do_POST = do_DELETE = reply  # noqa: N815

        def log_message(self, *_: Any) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}", had
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def event(name: str, number: int | None, document: dict[str, Any]) -> str:
    ident = "" if number is None else f"id: {number}\n"
    return f"event: {name}\n{ident}data: {json.dumps(document)}\n\n"


def test_follow_goes_on_after_the_server_was_killed_and_started_again(tmp_path: Path) -> None:
    port, store = free_port(), f"sqlite:{tmp_path}/contacts.db"
    url = f"http://127.0.0.1:{port}"
    with ss.connect(url) as api:
        with service(port, store):
            contact = api.Contact.from_definition(BALL)
            contact.path([1e-8, 2e-8])
            followed = contact.follow(after=0)
            assert [next(followed).sequence for _ in range(2)] == [1, 2]
        # It is dead now, and nothing listens.
        seen: list[int] = []
        follower = threading.Thread(target=lambda: seen.append(next(followed).sequence))
        follower.start()
        time.sleep(1.0)
        with service(port, store):
            contact.move("30 nm")
            follower.join(30.0)
            assert seen == [3]


@pytest.mark.parametrize("status", [502, 503])
def test_follow_goes_on_after_a_gateway_said_that_the_server_is_away(status: int) -> None:
    state = {"id": "x", "at": "", "state": {}}
    first = event("state", 1, state | {"sequence": 1})
    last = event("state", 2, state | {"sequence": 2}) + event("end", None, {"reason": "deleted"})
    stream = {"content-type": "text/event-stream"}
    replies = [(200, stream, first), (status, {}, "away"), (status, {}, "away"), (200, stream, last)]
    with answering(replies) as (url, had), ss.connect(url) as api:
        followed = RemoteContact(api, "x", {}).follow(after=0)
        assert [one.sequence for one in followed] == [1, 2]
    assert [one.rpartition(" ")[2] for one in had] == ["0", "1", "1", "1"]


def test_follow_gives_up_once_it_has_been_patient() -> None:
    with ss.connect(f"http://127.0.0.1:{free_port()}") as api:
        followed = RemoteContact(api, "x", {}).follow(after=0, patience=0.3)
        with pytest.raises(ss.ServerError, match="cannot be reached"):
            next(followed)


def test_a_repeated_delete_is_no_error(api: ss.Client, monkeypatch: pytest.MonkeyPatch) -> None:
    contact = remote_ball(api)
    send, broken = api._http.request, []

    def breaks_once(*arguments: object, **options: object) -> httpx.Response:
        response = send(*arguments, **options)
        if not broken:
            broken.append(response)
            raise httpx.ReadError("the connection broke after the contact was deleted")
        return response

    monkeypatch.setattr(api._http, "request", breaks_once)
    contact.delete()
    contact.delete()
    with pytest.raises(ss.NotFound):
        contact.describe()


def test_a_wait_is_logged_and_one_of_hours_is_raised(caplog: pytest.LogCaptureFixture) -> None:
    in_hours = format_datetime(datetime.now(timezone.utc) + timedelta(hours=2), usegmt=True)
    for advice in ("7200", in_hours):
        with answering([(503, {"retry-after": advice}, "")]) as (url, had), ss.connect(url) as api:
            with pytest.raises(ss.ServerError) as refused:
                api.request("GET", "/contacts")
            assert refused.value.retry_after == pytest.approx(7200.0, abs=60.0)
            assert len(had) == 1
    with (
        caplog.at_level(logging.INFO, "stickslip"),
        answering([(429, {"retry-after": "2"}, ""), (200, {}, "{}")]) as (
            url,
            had,
        ),
    ):
        with ss.connect(url) as api:
            assert api.request("GET", "/contacts").status_code == 200
        assert len(had) == 2
        assert exchange.pause(0, "it is short").seconds < 1.0
        assert exchange.pause(8, "it is long").seconds > 1.0
    first, second = [record.getMessage() for record in caplog.records if record.name == "stickslip"]
    assert first == f"{url} asks to wait: another attempt in 2.0 s"
    assert second.startswith("it is long: another attempt in ")


def test_many_followers_hold_up_no_call_and_take_no_threads(api: ss.Client) -> None:
    followers = 60

    async def work() -> tuple[int, list[int], float]:
        async with AsyncClient(api.url) as client:
            contact = await client.Contact.from_definition(BALL)
            events: list[int] = []

            async def follow() -> None:
                async for one in contact.follow(after=0):
                    events.append(one.sequence)

            tasks = [asyncio.create_task(follow()) for _ in range(followers)]
            await asyncio.sleep(0.2)
            await contact.path([1e-8, 2e-8])
            while len(events) < 2 * followers:
                await asyncio.sleep(0.01)
            threads = threading.active_count()
            await contact.cycle([1e-9])
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            assert all(task.cancelled() for task in tasks)
            return threads, events, (await contact.state()).displacement

    before = threading.active_count()
    threads, events, displacement = asyncio.run(asyncio.wait_for(work(), 60.0))
    assert threads == before
    assert sorted(events) == [1] * followers + [2] * followers
    assert displacement == 2e-8


def test_asyncio_computes_what_the_client_computes(api: ss.Client, here: ss.Contact) -> None:
    async def work() -> list[Any]:
        async with AsyncClient(api.url) as client:
            contact = await client.Contact.from_bytes(here.to_bytes())
            sweep = await client.sweep(
                {"contact": BALL, "path": {"falling_amplitude": 3}, "residual": True},
                {"/contact/friction": [0.1, 0.2]},
                {"remaining": "/residual/relative"},
            )
            fretting = await contact.fretting("50 nm", crossland={"alpha": 0.3}, tolerance=1e-2)
            labels = [one.label async for one in client.contacts(newest_first=True)]
            return [await client.cycle(BALL, [1e-8]), await contact.residual(), sweep, fretting, len(labels)]

    here.path(falling_amplitude=4)
    cycle, residual, sweep, fretting, count = asyncio.run(work())
    assert cycle.cycles[0].document == ss.cycle(BALL, [1e-8]).cycles[0].document
    assert residual.document == here.residual().document
    assert sweep.columns["remaining"].shape == (2,)
    assert fretting.margin is None
    assert fretting.worst == "crossland"
    assert count >= 1


def test_a_sweep_that_is_a_job_is_waited_for(engine: Any) -> None:
    base = {"contact": BALL, "path": {"falling_amplitude": 3}, "residual": True}
    axes, outputs = {"/contact/friction": np.linspace(0.1, 0.3, 5)}, {"remaining": "/residual/relative"}
    found = engine.sweep(base, axes, outputs, job=True)
    assert np.array_equal(found.columns["remaining"], ss.sweep(base, axes, outputs).columns["remaining"])
    assert (len(found), found.points, found.failed) == (5, 5, 0)


def test_limits_are_those_in_process(ball: ss.Contact, here: ss.Contact) -> None:
    for contact in (ball, here):
        contact.path([8e-8, -5e-8])
    radii = np.linspace(0.0, 7e-5, 2500)
    found, expected = (contact.stress(radii=radii, fields=["shear", "slip"]) for contact in (ball, here))
    for name in ("radius", "shear", "slip"):
        assert np.array_equal(getattr(found, name), getattr(expected, name), equal_nan=True)
    assert np.isfinite(found.shear).all()
    assert len(ball.stress(radii=np.linspace(0.0, 7e-5, 10_000), fields=["pressure"]).radius) == 10_000
    for axis in ("radii", "x"):
        refused = []
        for contact in (ball, here):
            with pytest.raises(ss.InvalidInput) as error:
                contact.stress(**{axis: np.linspace(0.0, 7e-5, 10_001)})
            refused.append(str(error.value))
        assert refused[0] == refused[1]
        assert f"/{axis}: 10001 elements: allowed are 1 to 10000" in refused[0]


def test_errors_are_those_in_process(ball: ss.Contact, engine: Any) -> None:
    with pytest.raises(ss.InvalidInput) as refused:
        ball.undo()
    assert refused.value.pointer == "/calls"
    with pytest.raises(ss.NotFound):
        engine.compute("friction", {})
    with pytest.raises(ss.InvalidInput):
        engine.Contact.from_bytes(b"no contact")
    with pytest.raises(ss.InvalidInput) as refused:
        engine.read_loop(b"")
    assert refused.value.code == "invalid_input"


def test_nothing_is_computed_in_process_in_silence(api: ss.Client) -> None:
    with pytest.raises(AttributeError, match="in process only"):
        api.Contacts  # noqa: B018
    with pytest.raises(TypeError, match="has no bytes"):
        remote_ball(api).to_bytes()
    with answering([(500, {}, "")]) as (url, had), ss.connect(url) as client:
        calls = [
            lambda: client.compute_bytes("cycle", {}),
            lambda: client.read_loop(b"u,F\n0,0\n"),
            lambda: client.read_scan(b"x,z\n0,0\n"),
            lambda: client.Contact.from_definition(BALL),
            lambda: client.sweep({"contact": BALL}, {"/contact/friction": [0.1]}, "/steps/0/force"),
        ]
        for call in calls:
            with pytest.raises(ss.ServerError):
                call()
        assert len(had) == len(calls)


def test_a_contact_moves_to_a_server_with_its_history(api: ss.Client, here: ss.Contact) -> None:
    here.path(moves=[{"displacement": 8e-8}, {"force": 0.3, "normal_force": 12.0}, {"displacement": -2e-8}])
    here.move("10 nm", tolerance=1e-8)
    there = api.Contact.from_bytes(here.to_bytes())
    assert there.state.document == here.state.document
    assert there.moves() == here.moves()
    assert there.sequence == here.sequence == 4


def test_files_are_read_alike(engine: Any) -> None:
    rows = "\n".join(f"{0.1 * k:.1f},{0.5 * k:.1f}" for k in range(20))
    loop = engine.read_loop(f"displacement (um),force (mN)\n{rows}\n".encode())
    assert (loop.units, loop.loop["force"][3]) == ({"displacement": "um", "force": "mN"}, 1.5)
    by_number = engine.read_loop(f"a,b\n{rows}\n".encode(), displacement=2, force=1, force_unit="lbf")
    assert by_number.loop["force"][3] == pytest.approx(0.3 * 4.4482216152605)
    scan = engine.read_scan(f"x (mm),z (um)\n{rows}\n".encode())
    assert scan.units == {"lateral": "mm", "height": "um"}


def test_a_forked_child_of_a_served_process_ends() -> None:
    program = """
import os, sys, time
import stickslip as ss
with ss.serve() as api:
    child = os.fork()
    if child == 0:
        sys.exit(7)
    for _ in range(600):
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            break
        time.sleep(0.1)
    assert done and os.waitstatus_to_exitcode(status) == 7, "the child hangs"
    # The server of the parent goes on.
    assert api.Contact(ss.Sphere(0.01), ss.Moduli(1e11, 8e10), 0.3, normal_force=1.0).sequence == 0
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=180)
    assert done.returncode == 0, done.stderr
