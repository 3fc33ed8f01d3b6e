"""Many contacts stepped together over arrays: the exact contact law for programs with their own equations of motion."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING

import numpy as np

from . import _native, results
from .bodies import Material, Shape
from .contact import definition, encoded, guarded
from .documents import Quantities, Quantity, floats
from .errors import Fault, InvalidInput, warn
from .result import Floats, parse

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .request_types import DefinitionMembers


class Contacts:
    """An array of contacts with one definition.

    They begin at zero indentation, or at the given load. A step is straight in indentation and displacement (m), and
    keeps the whole history of every contact. A refused step moves no contact.

    Parameters
    ----------
    shape : int | tuple of int
        Number of contacts, or the shape of the array of contacts.
    profile, bodies, friction, **load
        As for `Contact`.
    threads : int
        Number of threads; if left out, one for each core.
    """

    def __init__(
        self,
        shape: int | tuple[int, ...],
        profile: Shape,
        bodies: Material,
        friction: Quantity,
        *,
        threads: int | None = None,
        **load: Unpack[DefinitionMembers],
    ):
        if load.get("normal_force") is None and load.get("contact_radius") is None:
            load = load | {"indentation": 0.0 if load.get("indentation") is None else load["indentation"]}
        #: The shape of the arrays of numbers of the contacts.
        self.shape = (shape,) if isinstance(shape, int) else tuple(shape)
        count = int(np.prod(self.shape, dtype=np.int64))
        given = definition(profile, bodies, friction, load)
        self._native = guarded(_native.Contacts, count, encoded(given), threads or os.cpu_count() or 1)
        warn(json.loads(self._native.warnings()), set())

    def __len__(self) -> int:
        return len(self._native)

    def step(self, indentation: Quantity | Quantities, displacement: Quantity | Quantities) -> tuple[Floats, Floats]:
        """Moves all contacts to these indentations and displacements, m; returns F_N and F_x, N, as such arrays.

        Arrays broadcast to the shape of the contacts.
        """
        targets = self._numbers(indentation, "indentation"), self._numbers(displacement, "displacement")
        return self._shaped(guarded(self._native.step, *targets))

    def trial(self, indentation: Quantity | Quantities, displacement: Quantity | Quantities) -> tuple[Floats, Floats]:
        """The forces after such a step from the committed states; `commit` keeps the step, `revert` discards it."""
        targets = self._numbers(indentation, "indentation"), self._numbers(displacement, "displacement")
        return self._shaped(guarded(self._native.trial, *targets))

    def commit(self) -> None:
        """Commits the states of the last trial."""
        if not self._native.commit():
            raise RuntimeError("there is no trial to commit: call trial() first")

    def revert(self) -> None:
        """Discards the last trial."""
        self._native.revert()

    def forces(self) -> tuple[Floats, Floats]:
        """F_N and F_x, N, of the committed states."""
        return self._shaped(self._native.forces())

    def stiffness(self, direction: int = 1) -> tuple[Floats, Floats]:
        """Normal and tangential stiffness, N/m, of the last trial or else of the committed states.

        The tangential stiffness is that of a displacement that continues upwards (1) or downwards (-1) at constant
        indentation: after a reversal the whole contact sticks, without one only a part of it.
        """
        if direction not in (1, -1):
            raise ValueError(f"direction is {direction}: allowed are 1 and -1")
        return self._shaped(self._native.stiffness(direction > 0))

    def state(self, index: int) -> results.State:
        """The committed state of one contact."""
        return parse(results.State, json.loads(self._native.state(index)))

    @property
    def memory(self) -> int:
        """Bytes that the committed states take."""
        found: int = self._native.memory()
        return found

    def _numbers(self, values: Quantity | Quantities, name: str) -> Floats:
        """One number, or one for each contact."""
        array = floats(values, name)
        if array.size == 1:
            return array.reshape(1)
        try:
            return np.broadcast_to(array, self.shape).reshape(-1)
        except ValueError:
            detail = f"an array of shape {array.shape} does not broadcast to {self.shape}"
            raise InvalidInput("invalid_input", detail, (Fault(f"/{name}", detail),)) from None

    def _shaped(self, pair: tuple[Floats, Floats]) -> tuple[Floats, Floats]:
        return pair[0].reshape(self.shape), pair[1].reshape(self.shape)
