"""A client of a real server: contacts as objects, events, retries, ends."""

from __future__ import annotations

import asyncio
import itertools
import subprocess
import sys
import textwrap
from pathlib import Path

import httpx
import pytest

import stickslip as ss
from conftest import heed_interrupts
from stickslip.aio import AsyncClient
from stickslip.server import ServedClient


def ball(api: ss.Client) -> ss.RemoteContact:
    steel = api.Body("210 GPa", 0.3)
    made = api.Contact(api.Sphere("10 mm"), [steel, api.RIGID], friction=0.3, normal_force="10 N", label="10 N")
    assert isinstance(made, ss.RemoteContact)
    return made


def test_contact_is_moved_read_renamed_and_deleted(api: ss.Client) -> None:
    contact = ball(api)
    contact.move(force="1 N")
    contact.path([5e-8, -5e-8])
    assert contact.sequence == 3
    assert [item.sequence for item in contact.history().items] == [1, 2, 3]
    assert len(contact.loop(points_per_move=5).to_frame()) > 10
    assert contact.rename("other").label == "other"
    assert contact.id in [one.id for one in api.contacts(label="other")]
    newest = [one.id for one in api.contacts(newest_first=True)]
    assert newest == [one.id for one in api.contacts()][::-1]
    assert api.open(contact.id).state.document == contact.state.document
    contact.observe([{"displacement": "10 nm", "force": 0.2}])
    contact.delete()
    with pytest.raises(ss.NotFound):
        contact.describe()


def test_undo_and_copy_on_a_server(api: ss.Client) -> None:
    contact = ball(api)
    contact.move("30 nm")
    before = contact.state.document
    contact.path(falling_amplitude=5)
    other = contact.copy()
    assert contact.undo().document == before
    assert other.sequence == 7
    assert contact.undo().force == 0.0


def test_a_table_of_a_bench_is_observed(api: ss.Client) -> None:
    import pandas

    contact = api.Contact(ss.Sphere(0.01), ss.Moduli(1e11, 8e10), 0.3, normal_force=10.0)
    found = contact.observe(pandas.DataFrame({"displacement (nm)": [10.0, 20.0], "force (mN)": [100.0, 200.0]}))
    assert [item.displacement for item in found.items] == pytest.approx([1e-8, 2e-8])
    assert contact.sequence == 2


def test_states_are_followed(api: ss.Client) -> None:
    contact = ball(api)
    contact.path([1e-8, 2e-8, 3e-8])
    seen = list(itertools.islice(contact.follow(after=0), 2))
    assert [event.sequence for event in seen] == [1, 2]
    rest = contact.follow(after=2)
    assert next(rest).state.displacement == 3e-8
    contact.delete()
    assert list(rest) == []


def test_a_request_that_breaks_off_is_repeated_with_its_key(api: ss.Client, monkeypatch: pytest.MonkeyPatch) -> None:
    contact = ball(api)
    send, broken = api._http.request, []

    def breaks_once(*arguments: object, **options: object) -> httpx.Response:
        response = send(*arguments, **options)  # type: ignore[arg-type]
        if not broken:
            broken.append(response)
            raise httpx.ReadError("the connection broke after the move")
        return response

    monkeypatch.setattr(api._http, "request", breaks_once)
    contact.move(relative=True, displacement="10 nm")
    monkeypatch.undo()
    # The repeated move has been made once.
    assert (contact.sequence, contact.state.displacement) == (1, 1e-8)


def test_what_is_no_service_is_said(api: ss.Client) -> None:
    with pytest.raises(ss.NotFound):
        api.request("GET", "/nowhere")
    with pytest.raises(ss.ServerError):
        ss.connect("http://127.0.0.1:9", retries=0).cycle({}, 1e-8)


def test_server_with_a_file_keeps_contacts(tmp_path: Path) -> None:
    store = f"sqlite:{tmp_path}/contacts.db"
    with ss.serve(store) as api:
        contact = ball(api)
        contact.move("20 nm")
        state = contact.state.document
    with ss.serve(store) as api:
        assert api.open(contact.id).state.document == state


def test_a_server_ends_with_its_process() -> None:
    program = textwrap.dedent("""
        import os, signal, stickslip as ss
        with ss.serve() as api:
            print(api.url, flush=True)
            os.kill(os.getpid(), signal.SIGINT)
            import time; time.sleep(60)
    """)
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, preexec_fn=heed_interrupts)
    assert "KeyboardInterrupt" in done.stderr
    with pytest.raises(httpx.ConnectError):
        httpx.get(done.stdout.strip() + "/healthz")


def test_the_same_names_are_awaited_in_asyncio(api: ServedClient) -> None:
    async def work() -> list[float]:
        async with AsyncClient(api.url) as client:
            contact = await client.Contact(
                client.Sphere(0.01), [client.Body(2.1e11, 0.3), client.RIGID], 0.3, normal_force=10.0
            )
            await contact.path([1e-8, 2e-8])
            seen = []
            async for event in contact.follow(after=0):
                seen.append(event.state.displacement)
                if len(seen) == 2:
                    break
            assert (await contact.state()).displacement == 2e-8
            await contact.delete()
            return seen

    assert asyncio.run(work()) == [1e-8, 2e-8]
