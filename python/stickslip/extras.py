"""Attributes of some results besides their fields."""

from __future__ import annotations

from typing import Any

from . import schemas
from .optional import needed
from .result import Record, Result

#: The criteria of a rating, by their names in the reply.
CRITERIA = tuple(name for name, (kind, _) in schemas.FIELDS["FrettingReply"].items() if kind == "Rating")


class Fretting(Result):
    """Fatigue criteria over a steady cycle."""

    @property
    def ratings(self) -> dict[str, Any]:
        """The criteria that were asked for."""
        found = {name: getattr(self, name, None) for name in CRITERIA}
        return {name: rating for name, rating in found.items() if rating is not None}

    @property
    def worst(self) -> str | None:
        """The criterion with the smallest margin, or the first one if none has a limit."""
        margins = {name: rating.margin for name, rating in self.ratings.items() if rating.margin is not None}
        return min(margins, key=lambda name: margins[name]) if margins else next(iter(self.ratings), None)

    @property
    def margin(self) -> float | None:
        """The limit over the largest value of the worst criterion: below 1 it predicts crack growth."""
        margin: float | None = self.ratings[self.worst].margin if self.worst else None
        return margin

    @property
    def life(self) -> float | None:
        """The fewest cycles to a crack that any criterion with a `life` has; None where none of them has one."""
        lives = [rating.life.cycles for rating in self.ratings.values() if rating.life is not None]
        return min((float(cycles) for cycles in lives if cycles is not None), default=None)

    @property
    def place(self) -> tuple[float, float, float] | None:
        """Where the worst criterion is largest: x, y, z, m."""
        largest = self.ratings[self.worst].largest if self.worst else None
        return None if largest is None else (*(float(part) for part in largest.point),)  # type: ignore[return-value]


class Swept(Result):
    """The table of a sweep."""


class Uncertain(Record):
    """An output of uncertain inputs, which is a number with its standard uncertainty."""

    @property
    def nominal_value(self) -> float:
        """The mean, NaN where too few points have the number."""
        return _number(self._document.get("mean"))

    @property
    def std_dev(self) -> float:
        """The standard uncertainty, NaN where too few points have the number."""
        return _number(self._document.get("standard_uncertainty"))

    def ufloat(self) -> Any:
        """It as a number of the package `uncertainties`: the mean and its standard uncertainty."""
        return needed("uncertainties", "units").ufloat(self.nominal_value, self.std_dev, self._document.get("name"))

    def __repr__(self) -> str:
        return f"{self._document.get('name')}: {self.nominal_value:.6g} ± {self.std_dev:.2g}"


def _number(value: Any) -> float:
    return float("nan") if value is None else float(value)
