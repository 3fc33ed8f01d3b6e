"""Results answer as arrays and tables, with the columns and units that the engine writes itself."""

from __future__ import annotations

import inspect
import json
import pickle
import typing
from typing import Any

import numpy as np
import pandas
import pytest

import stickslip as ss
from conftest import ROOT
from stickslip import computations, results, schemas
from stickslip.client import RemoteContact
from stickslip.engine import PATHS
from stickslip.result import as_column

API = json.loads((ROOT / "openapi" / "openapi.json").read_text())
METHODS = {"profile": "fit_profile", "protocol": "protocols"}


def examples(path: str) -> dict[str, Any]:
    content = API["paths"][path]["post"]["requestBody"]["content"]["application/json"]
    named = {name: example["value"] for name, example in content.get("examples", {}).items()}
    reference = content["schema"]["$ref"].rpartition("/")[2]
    return named or {"example": API["components"]["schemas"][reference]["example"]}


def written(data: bytes) -> tuple[dict[str, list[Any]], dict[str, str]]:
    """The columns and units of a stream of Arrow."""
    pyarrow = pytest.importorskip("pyarrow")
    table = pyarrow.ipc.open_stream(data).read_all()
    units = {field.name: (field.metadata or {}).get(b"unit", b"").decode() for field in table.schema}
    return table.to_pydict(), units


def assert_same(frame: pandas.DataFrame, data: bytes) -> None:
    columns, units = written(data)
    assert set(frame.columns) == set(columns)
    for name, expected in columns.items():
        found = frame[name]
        if found.dtype.kind in "biuf":
            wanted = np.array([np.nan if value is None else value for value in expected], dtype=float)
            assert np.array_equal(found.to_numpy(dtype=float), wanted, equal_nan=True), name
        elif name == "at":
            assert [pandas.Timestamp(text) for text in found] == expected
        else:
            assert [None if value != value else value for value in found] == expected, name
        if units[name]:
            assert frame.attrs["units"].get(name) == units[name], name


CASES = [
    (name, key)
    for name, path in PATHS.items()
    for key in examples(path)
    if "arrow" in str(API["paths"][path]["post"]["responses"]["200"]["content"])
]


@pytest.mark.parametrize(("name", "key"), CASES)
def test_a_frame_is_what_the_engine_writes_as_arrow(api: ss.Client, name: str, key: str) -> None:
    request = examples(PATHS[name])[key]
    for engine in (ss.Local(), api):
        found = getattr(engine, METHODS.get(name, name))(**flattened(name, request))
        assert_same(found.to_frame(), engine.compute_bytes(name, request, "arrow"))
        assert len(found) == len(found.to_frame()) == len(list(found)) > 0
        again = written_table(found)
        assert set(again) == set(found.to_frame().columns)


def written_table(found: Any) -> dict[str, Any]:
    return found.to_arrow().to_pydict()


def flattened(name: str, request: dict[str, Any]) -> dict[str, Any]:
    """The keywords of a method for the document of a request."""
    signature = inspect.signature(getattr(computations.Computations, METHODS.get(name, name)))
    keywords: dict[str, Any] = {}
    for member, value in request.items():
        keywords |= {member: value} if member in signature.parameters else value
    return keywords


def test_pages_of_a_contact_are_what_the_server_writes_as_arrow(api: ss.Client) -> None:
    contact = api.Contact(ss.Sphere("10 mm"), [ss.Body(2.1e11, 0.3), ss.RIGID], 0.3, normal_force=10.0)
    contact.path(falling_amplitude=6)
    contact.observe([{"displacement": "10 nm", "force": 0.2}])
    contact.path([1e-8, -1e-8, 1e-8])
    path = f"/contacts/{contact.id}"
    for name, found, query in (
        ("history", contact.history(), {}),
        ("loop", contact.loop(points_per_move=2), {"points_per_move": 2}),
        ("loop", contact.loop(last=1), {"last": 1}),
        ("cycles", contact.cycles(), {}),
        ("residual", contact.residual(), {}),
        ("stress", contact.stress(40, fields=["pressure", "slip"]), {"points": 40, "fields": "pressure,slip"}),
    ):
        data = api.request("GET", f"{path}/{name}", params={**query, "format": "arrow"}).content
        assert_same(found.to_frame(), data)
    assert isinstance(contact, RemoteContact)


def test_a_path_answers_as_arrays(ball: ss.Contact) -> None:
    path = ball.path([5e-8, -5e-8, 1e-8])
    assert path.displacement.tolist() == [5e-8, -5e-8, 1e-8]
    assert path.force.tolist() == [step.force for step in path.steps]
    assert path.regime.tolist() == ["partial_slip"] * 3
    assert path.memory_depth.dtype == np.int64
    assert [step.force for step in path] == path.force.tolist()
    assert path.steps[-1].document == path.steps[1:][-1].document == ball.state.document
    assert path.to_frame().attrs["units"]["force"] == "N"
    assert isinstance(path.steps[0], results.State)
    with pytest.raises(AttributeError, match="it has"):
        path.forces  # noqa: B018
    with pytest.raises(AttributeError, match="cannot be set"):
        path.sequence = 3
    assert pickle.loads(pickle.dumps(path)).force.tolist() == path.force.tolist()


def test_every_computation_has_a_table(ball: ss.Contact) -> None:
    cycle = ball.cycle([1e-9, 1e-8], harmonics=3)
    assert cycle.loss_factor.shape == (2,)
    frame = cycle.to_frame()
    assert {"in_phase_1", "quadrature_3"} <= set(frame.columns)
    assert ball.cycle(force=[0.1], harmonics=1).to_frame().attrs["units"]["in_phase_1"] == "m"
    accuracy = ss.accuracy(ball, [1e-8], solvers=["exact", {"springs": {"count": 50}}]).to_frame()
    assert accuracy["solver"].tolist() == ["exact", "springs"]
    assert accuracy["count"].iloc[1] == 50
    assert len(ss.protocols(ball, 4).to_frame()) == 5
    fit = ss.fit(**flattened("fit", examples("/fit")["steady"]))
    assert list(fit.estimates.to_frame().index) == ["friction", "g_star"]
    # Where there is no value the JSON says null, and the attribute is None.
    assert ss.fretting(ball, 1e-8, crossland={"alpha": 0.3}).crossland.margin is None


def test_an_axis_has_one_unit_whose_prefix_fits(ball: ss.Contact) -> None:
    for result, x, y in (
        (ball.path([5e-8, -5e-8, 1e-8]), "displacement U (nm)", "tangential force F (N)"),
        (ball.stress(50), "radius r (µm)", "stress (MPa)"),
        (ball.residual(), "radius (µm)", "peak of the shear stress (MPa)"),
        (ball.cycle([1e-9, 1e-8, 1e-7]), "displacement amplitude (nm)", "friction work of a cycle (nJ)"),
        (ss.protocols(ball, 4), "move", "displacement U (nm)"),
    ):
        axes = result.plot()
        axes.figure.canvas.draw()
        for axis, label in ((axes.xaxis, x), (axes.yaxis, y)):
            assert axis.get_label_text() == label
            texts = [text for one in axis.get_ticklabels() if (text := one.get_text())]
            # Numbers alone, in that unit: the digits that are read are few.
            numbers = [float(text.replace("\N{MINUS SIGN}", "-")) for text in texts]
            assert numbers
            assert all(abs(number) < 10_000 for number in numbers), (result.schema, texts)
    with pytest.raises(TypeError, match="has no picture"):
        ball.state.plot()


def test_a_column_keeps_the_kind_of_its_values() -> None:
    assert as_column([1, 2]).dtype == np.int64
    assert as_column([1, None]).dtype == np.float64
    assert as_column([None, None]).dtype == np.float64
    assert as_column([True, False]).dtype == np.bool_
    assert as_column(["a", "b"]).dtype.kind == "U"
    assert as_column(["a", None]).tolist() == ["a", None]
    assert as_column([[1.0, 2.0], [3.0, 4.0]]).shape == (2, 2)
    # In the plane a state has pairs: two columns, and an array for one state.
    states = ss.Rows[results.State]("State", [{"force": [1.0, 2.0], "memory_depth": 1}, {"force": [3.0, 4.0]}])
    assert states.force.shape == (2, 2)
    assert list(states.table()[0]) == ["force_x", "force_y", "memory_depth"]
    assert states.table()[1]["force_y"] == "N"
    assert states[1].force.tolist() == [3.0, 4.0]


def returned(hint: Any, into: set[str]) -> None:
    """The classes of results that an annotation holds."""
    name = hint.__name__ if isinstance(hint, type) else ""
    if name in results.NAMES and name not in into:
        into.add(name)
        for field in typing.get_type_hints(hint, vars(results)).values():
            returned(field, into)
    for part in typing.get_args(hint):
        returned(part, into)


def test_every_class_of_results_is_returned_by_a_method() -> None:
    from stickslip import aio, client

    found: set[str] = set()
    space = vars(computations) | vars(results) | {"results": results}
    for owner in (computations.Computations, computations.OfContact, client.Client, RemoteContact, aio.AsyncContact):
        for name, method in inspect.getmembers(owner, callable):
            hint = getattr(method, "__annotations__", {}).get("return")
            if hint is not None and not name.startswith("__") and "results." in str(hint):
                returned(eval(str(hint), space | vars(client) | vars(typing)), found)
    for owner in (ss.Contact, ss.Contacts):
        for prop in (getattr(owner, name) for name in ("state", "summary") if name in dir(owner)):
            hint = prop.fget.__annotations__["return"] if isinstance(prop, property) else None
            if hint:
                returned(eval(hint, space), found)
    # What a simulation returns besides, of a path in the plane.
    assert found | {"PlanarReply"} == set(results.NAMES)
    assert set(results.NAMES) <= set(schemas.FIELDS)
