"""Paths of what has one: documents, replies with a path or with states, and tables of moves or of states."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from . import quantities
from .documents import Document, HasReply
from .request_types import SimulatedMove
from .tables import columns_in_si, is_table

#: The members of a move.
TARGETS = tuple(SimulatedMove.__annotations__)
#: The columns that only a table of states has.
_OF_STATES = frozenset({"regime", "stick_radius", "contact_radius"})


def path_of_moves(given: Any) -> Document:
    """The path of a document, of a reply or of a table.

    A reply has a `path`, the moves of a history, or states, which are passed through again by moves that are straight
    in displacement and indentation.
    """
    if isinstance(given, HasReply):
        return _of_reply(given.reply_document())
    if is_table(given):
        return {"moves": _of_table(given)}
    if isinstance(given, Mapping):
        return dict(given)
    raise quantities.refused("/path", f"{type(given).__name__} is no path: give a document, a reply or a table")


def _of_reply(reply: Any) -> Document:
    if isinstance(reply, list):
        return _of_rows(reply)
    if "path" in reply:
        return _of_reply(reply["path"])
    for rows in ("steps", "items"):
        if isinstance(reply.get(rows), list):
            return _of_rows(reply[rows])
    if "cutoff_radius" in reply:
        return {"displacement": reply["displacement"]}
    return dict(reply)


def _of_rows(rows: Sequence[Mapping[str, Any]]) -> Document:
    if all("move" in row for row in rows):
        return {"moves": [row["move"] for row in rows]}
    states = [row.get("state", row) for row in rows]
    if any(isinstance(state.get("displacement"), list) for state in states):
        raise quantities.refused("/path", "states in the plane are no path: give {'moves': [...]}")
    return {
        "moves": _through({name: [state.get(name) for state in states] for name in ("displacement", "indentation")})
    }


def _of_table(table: Any) -> list[Document]:
    columns = columns_in_si(table, TARGETS, _OF_STATES)
    if columns.keys() & _OF_STATES:
        return _through(columns)
    rows = zip(*columns.values(), strict=True)
    named = (zip(columns, row, strict=True) for row in rows)
    return [{name: value for name, value in row if value is not None} for row in named]


def _through(columns: Mapping[str, Sequence[Any]]) -> list[Document]:
    """Moves through states: the indentation is a target where it changes."""
    moves, before = [], None
    indentations = columns.get("indentation") or [None] * len(columns["displacement"])
    for displacement, indentation in zip(columns["displacement"], indentations, strict=True):
        is_other = indentation is not None and indentation != before
        # The first state may have any load: the contact that is moved need not have it.
        moves.append({"displacement": displacement} | ({"indentation": indentation} if is_other else {}))
        before = indentation
    return moves
