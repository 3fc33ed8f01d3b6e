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
        places = "".join(f"\n  {fault.pointer}: {fault.detail}" for fault in self.errors)
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


#: Texts of the JSON reader, in words of the package.
_IN_WORDS = (
    (
        re.compile(r"invalid type: (?:floating point|integer) `([^`]*)`, expected (?:an array|a sequence)\b.*"),
        r"\1 is one number, and a list of them is expected: give [\1]",
    ),
    (
        re.compile(r"invalid type: string \"(.*?)\", expected (?:an array|a sequence)\b.*"),
        r'"\1" is one value, and a list is expected: give ["\1"]',
    ),
    (re.compile(r"unknown variant `([^`]*)`, expected (?:one of )?(.*)"), r"`\1` is not known here: give \2"),
    (re.compile(r"unknown field `([^`]*)`, expected (?:one of )?(.*)"), r"`\1` is not known here: give \2"),
    (re.compile(r"invalid type: (?:map|sequence), expected f64\b.*"), "one number is expected, not several"),
    (re.compile(r"invalid type: boolean `(\w+)`, expected f64\b.*"), r"\1 is a flag, and a number is expected"),
    (
        re.compile(r"invalid type: sequence, expected (?:struct|a map|an object)\b.*"),
        "an object with named members is expected, not a list",
    ),
)


def _in_words(detail: str) -> str:
    """The detail of a fault, without the words of the reader of JSON."""
    for text, words in _IN_WORDS:
        detail = text.sub(words, detail)
    return detail


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
