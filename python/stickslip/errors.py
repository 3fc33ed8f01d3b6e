"""Refusals as exceptions, and warnings of results as Python warnings."""

from __future__ import annotations

import json
import re
import sys
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

_RANGE = re.compile(r"allowed is (\S+) to (\S+)(?: (\S+))?$")
_HERE = str(Path(__file__).parent)


@dataclass(frozen=True)
class Fault:
    """One fault of a request: where, by a JSON pointer, and what is wrong there."""

    pointer: str
    detail: str

    @property
    def range(self) -> tuple[float, float] | None:
        """The smallest and the largest allowed value, in SI units, if the fault is about a range."""
        found = _RANGE.search(self.detail)
        if found is None:
            return None
        try:
            return float(found[1]), float(found[2])
        except ValueError:
            return None


class StickslipError(Exception):
    """A refusal. `code` is its kind, `errors` are the faults of the request with their places."""

    def __init__(self, code: str, detail: str, errors: Sequence[Fault] = (), document: Mapping[str, Any] | None = None):
        self.code = code
        self.detail = detail
        self.errors = tuple(errors)
        self.document: Mapping[str, Any] = document or {}
        #: When the server advises to ask again, s from its reply.
        self.retry_after: float | None = None
        places = "".join(f"\n  {fault.pointer}{': ' * bool(fault.pointer)}{fault.detail}" for fault in self.errors)
        super().__init__(f"{code}: {'' if places else detail}{places}")

    @property
    def pointer(self) -> str | None:
        """The place of the first fault, as a JSON pointer into the document of the request."""
        return self.errors[0].pointer if self.errors else None

    @property
    def range(self) -> tuple[float, float] | None:
        """The range that the first fault names, in SI units."""
        return self.errors[0].range if self.errors else None

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.code, self.detail, self.errors, dict(self.document))


class InvalidInput(StickslipError, ValueError):
    """A number is out of its range, a member is unknown or missing, or the mechanics has no answer to it."""


class TooMuchWork(StickslipError):
    """The request takes longer than is allowed for one."""


class NotFound(StickslipError, LookupError):
    """A contact, job, computation or page was not found."""


class Conflict(StickslipError):
    """The contact is not in the state that the request needs."""


class NotAllowed(StickslipError, PermissionError):
    """A key is missing, or does not allow the request."""


class Overloaded(StickslipError):
    """There is no capacity at present, or a quota is used up."""


class ServerError(StickslipError):
    """A fault of the server, or a reply that does not come from a server of this kind."""


_BY_CODE: dict[str, type[StickslipError]] = {"too_much_work": TooMuchWork, "not_json": InvalidInput}
_BY_STATUS: dict[int, type[StickslipError]] = {
    401: NotAllowed,
    403: NotAllowed,
    404: NotFound,
    409: Conflict,
    410: NotFound,
    412: Conflict,
    422: InvalidInput,
    429: Overloaded,
    503: Overloaded,
}


#: What is given, as the reader of JSON calls it, in words of the package.
_GIVEN = {"null": "nothing", "object": "an object", "map": "an object", "array": "a list", "sequence": "a list"}
_MISPLACED = re.compile(
    r"invalid (?:type|value): (?:(?:floating point|integer|boolean|character) `(?P<one>[^`]*)`"
    r"|string (?P<text>\".*\")|(?P<kind>[a-z ]+)), expected (?P<wanted>.*)",
    re.DOTALL,
)
_LENGTH = re.compile(r"invalid length (\d+), expected (.*)", re.DOTALL)
_CONFLICT = re.compile(r"(`[^`]*` conflicts with `[^`]*`), expected (.*)", re.DOTALL)
_UNKNOWN = re.compile(r"unknown (?:variant|field) (`[^`]*`), (?:expected (?:one of )?(.*)|there are no .*)", re.DOTALL)
_MISSING = re.compile(r"missing field (`[^`]*`)")
_ONE_KEY = re.compile(r"an object with one key, one of((?: `[^`]*`)+)")


def _wanted(text: str) -> str:
    """What is expected, in words of the package."""
    text = _ONE_KEY.sub(lambda found: "one of " + ", ".join(found[1].split()), text)
    if text.startswith("struct "):
        return "an object with named members"
    text = re.sub("^(an array|a sequence)", "a list", text)
    return {"f64": "a number", "a map": "an object"}.get(text, text)


def _in_words(detail: str) -> str:
    """The detail of a fault, without the words of the reader of JSON."""
    if found := _MISPLACED.fullmatch(detail):
        given = found["one"] or found["text"] or _GIVEN.get(found["kind"], found["kind"])
        wanted = _wanted(found["wanted"])
        if wanted == "a list" and (found["one"] or found["text"]):
            return f"{given} is one {'value' if found['text'] else 'number'}, and a list is expected: give [{given}]"
        return f"{given} is given, and {wanted} is expected"
    if found := _LENGTH.fullmatch(detail):
        wanted = _wanted(found[2])
        return f"it is empty: give {wanted}" if found[1] == "0" else f"{found[1]} are given, and {wanted} is expected"
    if found := _CONFLICT.fullmatch(detail):
        return f"{found[1]}: give {_wanted(found[2])}"
    if found := _UNKNOWN.fullmatch(detail):
        return f"{found[1]} is not known here" + (f": give {found[2]}" if found[2] else "")
    return _MISSING.sub(r"\1 is missing", detail)


def refusal(document: Mapping[str, Any] | str) -> StickslipError:
    """The exception for a problem document."""
    found: Mapping[str, Any] = json.loads(document) if isinstance(document, str) else document
    code, status = str(found.get("code", "internal")), int(found.get("status", 500))
    kind = _BY_CODE.get(code) or _BY_STATUS.get(status) or (InvalidInput if 400 <= status < 500 else ServerError)
    faults = [Fault(fault["pointer"], _in_words(fault["detail"])) for fault in found.get("errors", [])]
    return kind(code, str(found.get("detail", found.get("title", code))), faults, found)


class StickslipWarning(UserWarning):
    r"""A caveat about a result that is valid; `code` is its kind.

    The text begins with the code, so that one kind can be filtered:
    `warnings.filterwarnings("ignore", message=r"\[dundurs_beta\]")`.
    """

    def __init__(self, code: str, message: str):
        self.code = code
        super().__init__(f"[{code}] {message}")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.code, str(self).partition("] ")[2])


#: The codes of the warnings that have been issued, by the definitions of contacts.
_SEEN: dict[str, set[str]] = {}
#: Definitions that are remembered.
_MOST_SEEN = 1000


def seen_of(definition: Mapping[str, Any]) -> set[str]:
    """The codes of the warnings that have been issued for a definition by the functions of the package."""
    if len(_SEEN) >= _MOST_SEEN:
        _SEEN.clear()
    return _SEEN.setdefault(json.dumps(definition, sort_keys=True), set())


def warn(found: Sequence[Mapping[str, str]], seen: set[str]) -> None:
    """Issues the warnings of a reply at the line that called the package, each code once for a contact."""
    found = [warning for warning in found if warning["code"] not in seen]
    if not found:
        return
    seen.update(warning["code"] for warning in found)
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_HERE):
        level, frame = level + 1, frame.f_back
    for warning in found:
        warnings.warn(StickslipWarning(warning["code"], warning["message"]), stacklevel=level)
