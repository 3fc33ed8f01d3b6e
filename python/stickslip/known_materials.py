"""Elastic constants of materials by their names: the table of the service, and your own."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from . import _native, quantities
from .documents import Quantity, to_document
from .optional import needed

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True)
class KnownMaterial:
    """Typical elastic constants of a material, with their source and the range that such materials have."""

    name: str
    #: Young's modulus, Pa, and Poisson's ratio, a pure number.
    youngs_modulus: float
    poisson_ratio: float
    source: str = ""
    #: The smallest and the largest of each, by their names; empty if it is not known.
    range: Mapping[str, tuple[float, float]] | None = None


def _plain(name: str) -> str:
    """A name without case, blanks and hyphens."""
    return re.sub(r"[\s\-_.]+", "", name).casefold()


class Materials(Mapping[str, KnownMaterial]):
    """Materials by their names, in any case: `ss.materials["100Cr6"]`, `ss.Body("100Cr6")`."""

    def __init__(self) -> None:
        self._all: dict[str, KnownMaterial] = {}
        self._names: dict[str, str] = {}
        for row in json.loads(_native.materials()):
            ranges = {name: (low, high) for name, (low, high) in row.pop("range").items()}
            self._put(KnownMaterial(range=ranges, **row))

    def _put(self, material: KnownMaterial) -> None:
        self._all[material.name] = material
        found = re.fullmatch(r"(.*?)\s*\((.*)\)", material.name)
        # "100Cr6 (AISI 52100)" is found by either name.
        names = [material.name, *([found[1], found[2]] if found else [])]
        self._names |= {_plain(name): material.name for name in names}

    def __getitem__(self, name: str) -> KnownMaterial:
        key = self._names.get(_plain(name)) if isinstance(name, str) else None
        if key is None:
            raise KeyError(self.unknown(name))
        return self._all[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._all)

    def __len__(self) -> int:
        return len(self._all)

    def unknown(self, name: Any) -> str:
        """What to say of a name that is not known."""
        near = get_close_matches(_plain(str(name)), self._names, n=3, cutoff=0.5)
        hint = f"did you mean {' or '.join(dict.fromkeys(self._names[one] for one in near))}? " if near else ""
        return (
            f"the material {name!r} is not known: {hint}`list(ss.materials)` has the names, `ss.materials.add` adds one"
        )

    def add(self, name: str, youngs_modulus: Quantity, poisson_ratio: Quantity, source: str = "") -> KnownMaterial:
        """Adds a material of your own, Pa and a pure number; one of the same name is replaced."""
        given = to_document({"youngs_modulus": youngs_modulus, "poisson_ratio": poisson_ratio})
        material = KnownMaterial(name, given["youngs_modulus"], given["poisson_ratio"], source)
        self._put(material)
        return material

    def to_frame(self) -> pandas.DataFrame:
        """The table, in SI units."""
        columns = ("name", "youngs_modulus", "poisson_ratio", "source")
        rows = [{name: getattr(one, name) for name in columns} for one in self._all.values()]
        frame: pandas.DataFrame = needed("pandas", "pandas").DataFrame(rows, columns=columns).set_index("name")
        frame.attrs["units"] = {"youngs_modulus": "Pa", "poisson_ratio": "1"}
        return frame

    def __repr__(self) -> str:
        return f"Materials({', '.join(self._all)})"


#: The known materials.
MATERIALS = Materials()


def constants_of(name: str) -> tuple[float, float]:
    """Young's modulus, Pa, and Poisson's ratio of a material.

    Raises
    ------
    InvalidInput
        For a name that is not known.
    """
    try:
        found = MATERIALS[name]
    except KeyError as error:
        raise quantities.refused("/material", error.args[0]) from None
    return found.youngs_modulus, found.poisson_ratio
