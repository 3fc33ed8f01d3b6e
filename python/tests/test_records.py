"""A record of a reply is taken wherever its document is; documents are copies; what cannot be changed raises."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pandas
import pytest

import stickslip as ss
from stickslip import results, schemas
from stickslip.documents import to_document
from stickslip.paths import path_of_moves
from stickslip.result import record

STEEL = ss.Body("210 GPa", 0.3)


def example(schema: dict[str, Any], schemas_: dict[str, Any], depth: int = 0) -> Any:
    """Some JSON value of a schema."""
    if "$ref" in schema:
        return example(schemas_[schema["$ref"].rpartition("/")[2]], schemas_, depth + 1)
    for choice in ("oneOf", "allOf", "anyOf"):
        if choice in schema:
            return example(next(one for one in schema[choice] if one != {"type": "null"}), schemas_, depth + 1)
    kinds = schema.get("type", "object")
    kind = kinds if isinstance(kinds, str) else next(one for one in kinds if one != "null")
    if "enum" in schema:
        return schema["enum"][0]
    if kind == "object":
        if depth > 6:
            return {}
        return {name: example(inner, schemas_, depth + 1) for name, inner in schema.get("properties", {}).items()}
    if kind == "array":
        return [example(schema.get("items", {"type": "number"}), schemas_, depth + 1)] * 2
    return {"number": 0.5, "integer": 2, "boolean": True, "string": "one", "null": None}[kind]


def test_every_record_and_every_list_of_records_of_every_reply_is_its_document(openapi: dict[str, Any]) -> None:
    known = openapi["components"]["schemas"]
    tried = 0
    for schema in schemas.FIELDS:
        if schema not in known or "properties" not in known[schema]:
            continue
        whole = example(known[schema], known)
        found = record(schema, whole)
        assert to_document(found) == whole, schema
        for name in found.fields():
            part = getattr(found, name) if name in whole else None
            if isinstance(part, ss.Record | ss.Rows):
                # As a member of a request, under its own name and within another one.
                assert to_document({name: part}) == {name: whole[name]}, (schema, name)
                tried += 1
    assert tried > 40


def test_the_path_of_a_protocol_is_followed(here: ss.Contact) -> None:
    found = ss.protocols(here, 6)
    for given in (found.path, found, found.path.document):
        contact = here.copy()
        contact.path(given)
        assert contact.residual().max == pytest.approx(found.residual.max, rel=1e-9)
    reply = ss.simulate(here, path=found.path, residual=True)
    assert reply.residual.max == pytest.approx(found.residual.max, rel=1e-9)


def test_the_path_of_a_sweep_may_be_what_any_path_is(here: ss.Contact) -> None:
    protocol = ss.protocols(here, 4)
    tables = [protocol.path, protocol, pandas.DataFrame({"displacement (nm)": 1e9 * protocol.path.displacement})]
    tables += [protocol.path.displacement, protocol.path.displacement.tolist(), protocol.path.document]
    for way in tables:
        base = {"contact": here, "path": way, "residual": True}
        found = ss.sweep(base, {"/contact/friction": [0.3]}, {"max": "/residual/max"})
        assert found.columns["max"] == pytest.approx([protocol.residual.max], rel=1e-9)


def test_states_a_history_and_their_table_are_passed_through_again(here: ss.Contact) -> None:
    first = here.copy()
    reply = first.path(moves=[{"displacement": 1e-7}, {"indentation": 8e-7, "displacement": 2e-8}, {"force": 0.1}])
    end = first.state
    for given in (reply, reply.steps, reply.to_frame(), first.history(), first.history().items):
        contact = here.copy()
        contact.path(given)
        assert contact.state.displacement == pytest.approx(end.displacement, rel=1e-12)
        assert contact.state.force == pytest.approx(end.force, rel=1e-9)
    with pytest.raises(ss.InvalidInput, match="no member of a move"):
        here.path(pandas.DataFrame({"displacement": [1e-8], "note": ["a"]}))
    with pytest.raises(ss.InvalidInput) as refused:
        here.path(pandas.DataFrame({"displacement": ["a", "b"]}))
    assert str(refused.value.pointer).startswith("/displacement")


def test_a_profile_a_contact_and_a_definition_of_a_reply_are_taken(here: ss.Contact) -> None:
    x = np.linspace(-7e-5, 7e-5, 41)
    scan = ss.fit_profile((x, -(x**2) / 0.02), smoothing={"noise": "0.1 nm"})
    assert ss.Contact(scan.profile, [STEEL, ss.RIGID], 0.3, normal_force=1.0).sequence == 0
    displacement = 2e-7 * np.cos(np.linspace(0.0, 2.0 * np.pi, 81))
    force = here.copy().path(displacement).force
    fit = ss.fit(here, (displacement[1:], force[1:]))
    assert ss.Contact.from_definition(fit.contact).sequence == 0
    assert len(ss.cycle(fit.contact, 1e-8)) == 1


def test_a_changed_copy_of_a_document_changes_nothing_that_is_computed(here: ss.Contact) -> None:
    before = ss.cycle(here, 5e-8).dissipated_energy
    here.definition()["friction"] = 0.9
    here.definition()["profile"]["radius"] = 1.0
    assert here.definition()["friction"] == 0.3
    assert ss.cycle(here, 5e-8).dissipated_energy == before
    reply = here.path([5e-8, -5e-8])
    reply.document["steps"][0]["force"] = 9.0
    reply.steps.documents[0]["force"] = 9.0
    assert reply.force[0] < 9.0
    fit_like = results.StressReply("StressReply", here.stress(5).document)
    with pytest.raises(ValueError, match="read-only"):
        fit_like.shear *= 2.0
    frame = fit_like.to_frame()
    frame["shear"] *= 2.0


@pytest.mark.parametrize("name", ["friction", "profile", "state", "label", "anything"])
def test_what_cannot_be_changed_raises(here: ss.Contact, name: str) -> None:
    many = ss.Contacts(2, ss.Sphere(0.01), ss.Moduli(1e11, 8e10), 0.3)
    for one in (here, many, ss.Sphere(0.01), here.state):
        with pytest.raises((AttributeError, TypeError), match=r"cannot|assign"):
            setattr(one, name, 0.9)


def test_a_class_in_place_of_an_object_is_refused_at_its_place(here: ss.Contact) -> None:
    with pytest.raises(ss.InvalidInput) as refused:
        ss.Contact(ss.Sphere, [STEEL, ss.RIGID], 0.3, normal_force=1.0)  # type: ignore[arg-type]
    assert refused.value.pointer == "/profile"
    for wrong in (ss.Contact, 5, "ball"):
        with pytest.raises(ss.InvalidInput) as refused:
            ss.cycle(wrong, 1e-8)  # type: ignore[arg-type]
        assert refused.value.pointer == "/contact"


def test_records_are_copied_and_pickled_with_their_picture(here: ss.Contact) -> None:
    import pickle

    reply = here.path([5e-8, -5e-8])
    for again in (copy.deepcopy(reply), pickle.loads(pickle.dumps(reply))):
        assert again.document == reply.document
        assert len(again.plot().lines[0].get_xdata()) > 20
    assert path_of_moves(reply)["moves"][1] == {"displacement": -5e-8}
