"""What a method says of a keyword that it does not have: where the keyword belongs, or which one is meant."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from difflib import get_close_matches
from functools import wraps
from typing import Any, TypeVar

Owner = TypeVar("Owner")
#: The methods that have a keyword, by its name.
_HAVING: dict[str, list[str]] = {}


def explained(owner: type[Owner]) -> type[Owner]:
    """A class whose methods refuse a keyword that they do not have in words of the package."""
    of = "contact" if "OfContact" in owner.__name__ else "ss"
    for name, method in list(vars(owner).items()):
        if inspect.isfunction(method) and not name.startswith("_"):
            parameters = list(inspect.signature(method).parameters.values())[1:]
            known = [one.name for one in parameters]
            placed = [one.name for one in parameters if one.kind is not inspect.Parameter.KEYWORD_ONLY]
            if not inspect.iscoroutinefunction(method):
                for keyword in known:
                    _HAVING.setdefault(keyword, []).append(f"{of}.{name}")
            setattr(owner, name, _explained(method, f"{of}.{name}", frozenset(known), placed))
    return owner


def _explained(method: Callable[..., Any], name: str, known: frozenset[str], placed: list[str]) -> Callable[..., Any]:
    if inspect.iscoroutinefunction(method):

        @wraps(method)
        async def awaited(self: Any, /, *arguments: Any, **keywords: Any) -> Any:
            if not known.issuperset(keywords) or len(arguments) > len(placed):
                raise _unknown(name, keywords, known, placed)
            return await method(self, *arguments, **keywords)

        return awaited

    @wraps(method)
    def called(self: Any, /, *arguments: Any, **keywords: Any) -> Any:
        if not known.issuperset(keywords) or len(arguments) > len(placed):
            raise _unknown(name, keywords, known, placed)
        return method(self, *arguments, **keywords)

    return called


def _unknown(method: str, keywords: dict[str, Any], known: frozenset[str], placed: list[str]) -> TypeError:
    """The refusal of the first keyword that is not known, or else of too many arguments without a name."""
    name = next((one for one in keywords if one not in known), None)
    if name is None:
        taken = f"{' and '.join(placed)} without {'their names' if len(placed) > 1 else 'its name'}" if placed else ""
        return TypeError(f"{method} takes {taken or 'no argument without its name'}: name the others")
    near = get_close_matches(name, known, n=1)
    if name in _HAVING:
        meant = f"{' and '.join(_HAVING[name])} {'have' if len(_HAVING[name]) > 1 else 'has'} it; "
    else:
        meant = f"did you mean {near[0]}? " if near else ""
    return TypeError(f"{method} has no keyword {name!r}: {meant}known are {', '.join(sorted(known))}")
