"""In process and by HTTP: the same bytes for every example of the API."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from conftest import ROOT
from stickslip.engine import PATHS

API = json.loads((ROOT / "openapi" / "openapi.json").read_text())


def examples(path: str) -> dict[str, Any]:
    content = API["paths"][path]["post"]["requestBody"]["content"]["application/json"]
    named = {name: example["value"] for name, example in content.get("examples", {}).items()}
    reference = content["schema"]["$ref"].rpartition("/")[2]
    return named or {"example": API["components"]["schemas"][reference]["example"]}


def without_times(text: bytes | str) -> Any:
    """A reply but for how long it took; numbers keep all of their digits."""

    def drop(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        return {name: value for name, value in pairs if name != "compute_time"}

    return json.loads(text, object_pairs_hook=drop, parse_float=str)


CASES = [(name, path, key) for name, path in PATHS.items() for key in examples(path)]


@pytest.mark.parametrize(("name", "path", "key"), CASES)
def test_computations(api: ss.Client, name: str, path: str, key: str) -> None:
    request = examples(path)[key]
    here = ss.compute_bytes(name, request)
    there = api.request("POST", path, json=request).content
    assert without_times(here) == without_times(there)


@pytest.mark.parametrize("format", ["csv", "arrow", "svg"])
def test_formats(api: ss.Client, format: str) -> None:  # noqa: A002
    request = examples("/cycle")["amplitudes"]
    there = api.request("POST", "/cycle", json=request, params={"format": format}).content
    assert ss.compute_bytes("cycle", request, format) == there


def test_sweep(api: ss.Client) -> None:
    request = examples("/sweep")["example"]
    here = ss.sweep(request["base"], request["axes"], request["outputs"])
    there = api.sweep(request["base"], request["axes"], request["outputs"])
    assert here.document == there.document
    assert len(here.to_frame()) == here.points


@pytest.mark.parametrize("kind", ["move", "path", "relax"])
def test_moves_of_a_contact(api: ss.Client, kind: str) -> None:
    for request in examples(f"/contacts/{{id}}/{kind}").values():
        here, there = (
            made.contact(ss.Sphere(0.01), [ss.Body(2.1e11, 0.3), ss.RIGID], 0.3, normal_force=10.0)
            for made in (ss.Local(), api)
        )
        for contact in (here, there):
            contact.path([8e-8, -5e-8])
        replies = [contact._advance(kind, request)[0] for contact in (here, there)]
        replies += [
            contact.stress(50, fields=["pressure", "shear", "slip", "displacement"]).document
            for contact in (here, there)
        ]
        replies += [contact.residual().document for contact in (here, there)]
        replies += [contact.copy().state.document for contact in (here, there)]
        for one, other in zip(replies[::2], replies[1::2], strict=True):
            for reply in (one, other):
                reply.pop("id", None)
            assert without_times(json.dumps(one)) == without_times(json.dumps(other))


def test_stress_below_the_surface_and_cycles_of_a_contact(api: ss.Client, here: ss.Contact) -> None:
    ball = here
    there = api.contact(ss.Sphere(0.01), [ss.Body(2.1e11, 0.3), ss.RIGID], 0.3, normal_force=10.0)
    for contact in (ball, there):
        contact.path(falling_amplitude=5)
    request = {"points": [[0.0, 0.0, 5e-5], [1e-5, 2e-5, 1e-6]], "fields": ["tensor", "von_mises"]}
    one, other = ball.subsurface(**request), there.subsurface(**request)
    assert np.array_equal(one.von_mises, other.von_mises)
    assert np.array_equal(one.xz, other.xz)
    # At a load that has not changed, the contact of the definition is the contact without its history.
    amplitudes = np.geomspace(1e-9, 1e-7, 20)
    one, other = ball.cycle(amplitudes), there.cycle(amplitudes)
    assert [row.document for row in one.cycles] == [row.document for row in other.cycles]
