"""Many contacts stepped together over arrays: the exact contact law for codes with equations of motion of their own."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _native, results
from .bodies import Material
from .contact import definition, encoded, guarded
from .documents import HasDocument, Quantities, Quantity, floats
from .result import Floats, parse


class Contacts:
    """So many contacts of one definition.

    They begin at an indentation of zero, or at the load that is given. A step is straight in indentation and
    displacement (m), and leaves every contact with all of its history. A step that is refused has moved none.
    """

    def __init__(
        self,
        count: int,
        profile: HasDocument | Mapping[str, Any],
        bodies: Material,
        friction: float,
        *,
        normal_force: Quantity | None = None,
        indentation: Quantity | None = None,
        contact_radius: Quantity | None = None,
        threads: int | None = None,
    ):
        if normal_force is None and contact_radius is None:
            indentation = 0.0 if indentation is None else indentation
        given = definition(profile, bodies, friction, normal_force, indentation, contact_radius)
        self._native = guarded(_native.Contacts, count, encoded(given), threads or os.cpu_count() or 1)

    def __len__(self) -> int:
        return len(self._native)

    def step(self, indentation: Quantity | Quantities, displacement: Quantity | Quantities) -> tuple[Floats, Floats]:
        """Moves all contacts to these indentations and displacements, m; returns F_N and F_x, N, of shape (n,)."""
        return _pair(
            guarded(
                self._native.step, self._bytes(indentation, "indentation"), self._bytes(displacement, "displacement")
            )
        )

    def trial(self, indentation: Quantity | Quantities, displacement: Quantity | Quantities) -> tuple[Floats, Floats]:
        """The forces that such a step would lead to from the committed states, until `commit` or `revert`."""
        return _pair(
            guarded(
                self._native.trial, self._bytes(indentation, "indentation"), self._bytes(displacement, "displacement")
            )
        )

    def commit(self) -> None:
        """Takes over the states of the last trial."""
        if not self._native.commit():
            raise RuntimeError("there is no trial to commit: call trial() first")

    def revert(self) -> None:
        """Forgets the last trial."""
        self._native.revert()

    def forces(self) -> tuple[Floats, Floats]:
        """F_N and F_x, N, of the committed states."""
        return _pair(self._native.forces())

    def stiffness(self, direction: int = 1) -> tuple[Floats, Floats]:
        """Normal and tangential stiffness, N/m, of the last trial or else of the committed states.

        The tangential one is that of a displacement which goes on upwards (1) or downwards (-1) at constant
        indentation: after a turn the whole contact sticks, and on the way on only a part of it does.
        """
        if direction not in (1, -1):
            raise ValueError(f"direction is {direction}: allowed are 1 and -1")
        return _pair(self._native.stiffness(direction > 0))

    def state(self, index: int) -> results.State:
        """The committed state of one contact."""
        return parse(results.State, json.loads(self._native.state(index)))

    @property
    def memory(self) -> int:
        """Bytes that the committed states take."""
        found: int = self._native.memory()
        return found

    def _bytes(self, values: Quantity | Quantities, name: str) -> bytes:
        array = floats(values, name)
        return np.broadcast_to(array, (len(self),)).tobytes() if array.size == 1 else array.tobytes()


def _pair(buffers: tuple[bytearray, bytearray]) -> tuple[Floats, Floats]:
    return np.frombuffer(buffers[0], dtype=np.float64), np.frombuffer(buffers[1], dtype=np.float64)
