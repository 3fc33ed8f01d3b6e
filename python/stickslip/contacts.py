"""Many contacts stepped together over arrays, along a line or in the plane, for programs that integrate motion."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any

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


class _Together:
    """What contacts that are stepped together share, along a line and in the plane."""

    _native: _native.Contacts | _native.PlanarContacts
    #: The shape of the arrays of numbers of the contacts.
    shape: tuple[int, ...]

    def _start(
        self,
        native: Any,
        shape: int | tuple[int, ...],
        given: tuple[Shape, Material, Quantity, DefinitionMembers],
        *arguments: int,
    ) -> Any:
        """The native contacts, and their warnings."""
        profile, bodies, friction, load = given
        if load.get("normal_force") is None and load.get("contact_radius") is None:
            load = load | {"indentation": 0.0 if load.get("indentation") is None else load["indentation"]}
        self.shape = (shape,) if isinstance(shape, int) else tuple(shape)
        count = int(np.prod(self.shape, dtype=np.int64))
        made = guarded(native, count, encoded(definition(profile, bodies, friction, load)), *arguments)
        warn(json.loads(made.warnings()), set())
        return made

    def __len__(self) -> int:
        return len(self._native)

    def commit(self) -> None:
        """Commits the states of the last trial."""
        if not self._native.commit():
            raise RuntimeError("there is no trial to commit: call trial() first")

    def revert(self) -> None:
        """Discards the last trial."""
        self._native.revert()

    @property
    def memory(self) -> int:
        """Size of the committed states, bytes."""
        return self._native.memory()

    def _numbers(self, values: Quantity | Quantities, name: str, *components: int) -> Floats:
        """One number, or one for each contact; or this number of components."""
        array = floats(values, name)
        if array.shape == components or (array.size == 1 and not components):
            return array.reshape(-1)
        try:
            return np.broadcast_to(array, self.shape + components).reshape(-1)
        except ValueError:
            detail = f"an array of shape {array.shape} does not broadcast to {self.shape + components}"
            raise refused(name, detail) from None

    def _shaped(self, pair: tuple[Floats, Floats], *components: int) -> tuple[Floats, Floats]:
        return pair[0].reshape(self.shape), pair[1].reshape(self.shape + components)


class Contacts(_Together):
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
        given = (profile, bodies, friction, load)
        self._native: _native.Contacts = self._start(_native.Contacts, shape, given, threads or os.cpu_count() or 1)

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


class PlanarContacts(_Together):
    """An array of contacts with one definition that move in the plane, with partial slip in any direction.

    The surface is divided into rings, each with one traction vector and Coulomb's law. The contacts begin at zero
    indentation, or at the given load. A step is straight in displacement (m) and in indentation or normal force. A
    contact that separates loses its history, and sticks where it touches again. A refused step moves no contact. The
    error is of second order in the steps and in the number of rings, and is not stated: halve the steps and double the
    rings to see it.

    Parameters
    ----------
    shape : int | tuple of int
        Number of contacts, or the shape of the array of contacts. Displacements and forces have x and y as a last axis.
    profile, bodies, friction, **load
        As for `Contact`.
    rings : int
        Largest number of rings of a contact, 4 to 160. A contact with a constant radius has all of them, one with a
        changing radius at least a quarter of them.
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
        rings: int = 20,
        threads: int | None = None,
        **load: Unpack[DefinitionMembers],
    ):
        given = (profile, bodies, friction, load)
        cores = threads or os.cpu_count() or 1
        self._native: _native.PlanarContacts = self._start(_native.PlanarContacts, shape, given, rings, cores)

    def step(
        self,
        indentation: Quantity | Quantities | None = None,
        displacement: Quantities | None = None,
        *,
        normal_force: Quantity | Quantities | None = None,
    ) -> tuple[Floats, Floats]:
        """Moves all contacts to these indentations, m, or normal forces, N, and to these displacements [x, y], m.

        Returns F_N, N, in the shape of the contacts, and F, N, with x and y as a last axis. Arrays broadcast to these
        shapes, so that one `[x, y]` moves all contacts.
        """
        return self._shaped(guarded(self._native.step, *self._targets(indentation, displacement, normal_force)), 2)

    def trial(
        self,
        indentation: Quantity | Quantities | None = None,
        displacement: Quantities | None = None,
        *,
        normal_force: Quantity | Quantities | None = None,
    ) -> tuple[Floats, Floats]:
        """The forces after such a step from the committed states; `commit` keeps the step, `revert` discards it."""
        return self._shaped(guarded(self._native.trial, *self._targets(indentation, displacement, normal_force)), 2)

    def forces(self) -> tuple[Floats, Floats]:
        """F_N and F, N, of the committed states."""
        return self._shaped(self._native.forces(), 2)

    def state(self, index: int) -> results.PlanarState:
        """The committed state of one contact."""
        return parse(results.PlanarState, json.loads(self._native.state(index)))

    def _targets(
        self,
        indentation: Quantity | Quantities | None,
        displacement: Quantities | None,
        normal_force: Quantity | Quantities | None,
    ) -> tuple[Floats, bool, Floats]:
        given = {"indentation": indentation, "normal_force": normal_force}
        named = [(name, values) for name, values in given.items() if values is not None]
        if len(named) != 1:
            raise refused("indentation", "a step has either indentation or normal_force")
        name, values = named[0]
        if displacement is None or floats(displacement, "displacement").shape[-1:] != (2,):
            raise refused("displacement", "the last axis of displacement is x and y: allowed are pairs [x, y]")
        normal = self._numbers(values, name)
        return normal, name == "normal_force", self._numbers(displacement, "displacement", 2)


def refused(name: str, detail: str) -> InvalidInput:
    """A refusal of an argument."""
    return InvalidInput("invalid_input", detail, (Fault(f"/{name}", detail),))
