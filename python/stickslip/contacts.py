"""Many contacts stepped together over arrays, along a line or in the plane, for programs that integrate motion."""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Mapping
from threading import Lock
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native, results
from .bodies import Material, Shape
from .contact import Fixed, encoded, guarded, owned, refused
from .documents import Document, Quantities, Quantity, floats, to_document
from .errors import InvalidInput, warn
from .profiles import Definition
from .result import Floats, parse
from .varied import Definitions, definitions

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .request_types import DefinitionMembers


#: The most contacts that are stepped together, whatever the memory.
MOST_CONTACTS = 1_000_000_000


def memory_at_hand() -> int:
    """The memory of the machine, bytes; without bound where it is not known."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return sys.maxsize


def _shape_of(shape: Any) -> tuple[int, ...] | None:
    """A shape as whole numbers of at least zero."""
    if shape is None:
        return None
    given = shape if isinstance(shape, tuple | list) else (shape,)
    wrong = next((one for one in given if isinstance(one, bool) or not isinstance(one, int | np.integer)), None)
    if wrong is not None:
        hint = ": the first argument is the shape, profile= names the shape of the indenter"
        raise refused("/shape", f"{wrong!r} is not a number of contacts{hint if hasattr(wrong, 'document') else ''}")
    if any(one < 0 for one in given):
        raise refused("/shape", f"{shape!r} is out of range: allowed are whole numbers from 0")
    if math.prod(map(int, given)) > MOST_CONTACTS:
        raise refused("/shape", f"{math.prod(map(int, given))} contacts: allowed are at most {MOST_CONTACTS}")
    return tuple(map(int, given))


def _definition(profile: Any, bodies: Any, friction: Any, load: Mapping[str, Any]) -> Definition:
    """A definition at zero indentation unless it has a load."""
    given = {"profile": profile, "bodies": bodies, "friction": friction}
    missing = [name for name, value in given.items() if value is None]
    if missing:
        raise refused(f"/{missing[0]}", f"{' and '.join(missing)} missing: give profile, bodies and friction")
    if all(load.get(name) is None for name in Definition.PRELOADS):
        load = {**load, "indentation": 0.0}
    return Definition(profile, bodies, friction, **load)


class _Together(Fixed):
    """What contacts that are stepped together share, along a line and in the plane."""

    _native: _native.Contacts | _native.PlanarContacts
    _shape: tuple[int, ...]
    _in_use: Lock

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the arrays of numbers of the contacts."""
        return self._shape

    def __len__(self) -> int:
        return len(self._native)

    def commit(self) -> None:
        """Commits the states of the last trial."""
        if not self._call("commit"):
            raise RuntimeError("there is no trial to commit: call trial() first")

    def revert(self) -> None:
        """Discards the last trial."""
        self._call("revert")

    @property
    def memory(self) -> int:
        """Size of the committed states, bytes."""
        found: int = self._call("memory")
        return found

    def _call(self, name: str, *arguments: Any) -> Any:
        return owned(self._in_use, getattr(self._native, name), *arguments)

    def _numbers(self, values: Quantity | Quantities, name: str, *components: int) -> Floats:
        """One number, or one for each contact; or this number of components."""
        array = floats(values, name)
        if array.shape == components or (array.size == 1 and not components):
            return np.ascontiguousarray(array).reshape(-1)
        try:
            return np.broadcast_to(array, self._shape + components).reshape(-1)
        except ValueError:
            detail = f"an array of shape {array.shape} does not broadcast to {self._shape + components}"
            raise refused(f"/{name}", detail) from None

    def _shaped(self, pair: tuple[Floats, Floats], *components: int) -> tuple[Floats, Floats]:
        return pair[0].reshape(self._shape), pair[1].reshape(self._shape + components)

    def _number_of(self, index: int | tuple[int, ...]) -> int:
        """The number of one contact, counted through the shape."""
        try:
            numbers = np.arange(len(self)).reshape(self._shape)
            found = numbers.reshape(-1)[index] if isinstance(index, int) else numbers[index]
            return int(found)
        except (IndexError, TypeError, ValueError) as error:
            raise IndexError(f"there is no contact {index} in an array of shape {self._shape}: {error}") from None


class Contacts(_Together):
    """An array of contacts, which are stepped together.

    They begin at zero indentation, or at the given load. A step is straight in indentation and displacement (m), and
    keeps the whole history of every contact. A step that is refused or interrupted moves no contact.

    Each number of the definition may be an array, such as `ss.Sphere(radii)` or `friction=mu`: one for each contact.

    `contacts[index]` is a copy of some of them, as NumPy indexes arrays; `copy`, `pickle` and `to_bytes` keep their
    states.

    Parameters
    ----------
    shape : int | tuple of int
        Number of contacts, or the shape of the array of contacts; if left out, that of the arrays of the definition.
    profile, bodies, friction, **load
        As for `Contact`.
    threads : int
        Number of threads; if left out, one for each core.
    """

    def __init__(
        self,
        shape: int | tuple[int, ...] | None = None,
        profile: Shape | None = None,
        bodies: Material | None = None,
        friction: Quantity | Quantities | None = None,
        *,
        threads: int | None = None,
        **load: Unpack[DefinitionMembers],
    ):
        shaped = _shape_of(shape)
        definition = _definition(profile, bodies, friction, load)
        self._start(*definitions(definition, shaped), threads or os.cpu_count() or 1)
        warn(json.loads(self._native.warnings()), set())

    def _start(self, shape: tuple[int, ...], definitions: Definitions, kinds: Any, threads: int) -> None:
        self._shape, self._definitions, self._kinds, self._threads = shape, definitions, kinds, threads
        self._in_use = Lock()
        count, memory, texts = math.prod(shape), memory_at_hand(), definitions.texts()
        self._native: _native.Contacts = guarded(_native.Contacts, count, memory, texts, kinds.tolist(), threads)

    def definition(self, index: int | tuple[int, ...] = 0) -> Document:
        """The JSON document of the definition of one contact: a copy."""
        return self._definitions.document(int(self._kinds[self._number_of(index)]) if len(self._kinds) else 0)

    def __getitem__(self, index: Any) -> Contacts:
        """A copy of some of the contacts, as NumPy indexes arrays: one contact has the shape ()."""
        numbers = np.asarray(np.arange(len(self)).reshape(self._shape)[index])
        part = Contacts.__new__(Contacts)
        part._shape, part._definitions, part._threads = numbers.shape, self._definitions, self._threads
        flat = numbers.reshape(-1)
        part._kinds = self._kinds[flat] if len(self._kinds) else self._kinds
        part._in_use = Lock()
        part._native = self._call("take", flat.tolist())
        return part

    def copy(self) -> Contacts:
        """A copy of the contacts with their states, without a trial; it evolves independently from here."""
        return self[...]

    def __copy__(self) -> Contacts:
        return self.copy()

    def __deepcopy__(self, _: Any) -> Contacts:
        return self.copy()

    def to_bytes(self) -> bytes:
        """The definitions and states as bytes, from which `from_bytes` makes the same contacts.

        They are read by this version of the package alone.
        """
        head = {"shape": self._shape, "definitions": self._definitions.packed(), "threads": self._threads}
        head |= {"kinds": self._kinds.tolist()}
        text = encoded(head)
        return len(text).to_bytes(8, "little") + text + bytes(self._call("pack"))

    @classmethod
    def from_bytes(cls, data: bytes) -> Contacts:
        """The contacts that `to_bytes` wrote, equal to the last bit."""
        try:
            end = 8 + int.from_bytes(data[:8], "little")
            head = json.loads(data[8:end])
            kinds = np.array(head["kinds"], dtype=np.uint32)
            shape, given = tuple(head["shape"]), Definitions.unpacked(head["definitions"])
            if len(kinds) not in (0, math.prod(shape)) or kinds.max(initial=0) >= len(given):
                raise ValueError("the numbers of the definitions are wrong")
            contacts = cls.__new__(cls)
            contacts._start(shape, given, kinds, head["threads"])
        except (ValueError, KeyError, TypeError) as error:
            raise InvalidInput("invalid_input", f"these bytes are not those of contacts: {error}") from None
        contacts._call("unpack", data[end:])
        return contacts

    def __reduce__(self) -> tuple[Any, ...]:
        return Contacts.from_bytes, (self.to_bytes(),)

    def __repr__(self) -> str:
        kinds = len(self._definitions)
        shape = self._definitions.template["profile"]["type"]
        return f"Contacts({self._shape}, {shape}, {kinds} definition{'' if kinds == 1 else 's'})"

    def step(
        self,
        indentation: Quantity | Quantities | None = None,
        displacement: Quantity | Quantities | None = None,
        *,
        normal_force: Quantity | Quantities | None = None,
    ) -> tuple[Floats, Floats]:
        """Moves all contacts to these indentations, m, or normal forces, N, and to these displacements, m.

        Returns F_N and F_x, N, as such arrays. Arrays broadcast to the shape of the contacts. A step to a normal force
        is straight in the indentation too, up to that under this force.
        """
        return self._shaped(self._call("step", *self._targets(indentation, displacement, normal_force)))

    def trial(
        self,
        indentation: Quantity | Quantities | None = None,
        displacement: Quantity | Quantities | None = None,
        *,
        normal_force: Quantity | Quantities | None = None,
    ) -> tuple[Floats, Floats]:
        """The forces after such a step from the committed states; `commit` keeps the step, `revert` discards it."""
        return self._shaped(self._call("trial", *self._targets(indentation, displacement, normal_force)))

    def _targets(
        self,
        indentation: Quantity | Quantities | None,
        displacement: Quantity | Quantities | None,
        normal_force: Quantity | Quantities | None,
    ) -> tuple[Floats, bool, Floats]:
        name, values = one_load(indentation, normal_force)
        if displacement is None:
            raise refused("/displacement", "a step has a displacement")
        return self._numbers(values, name), name == "normal_force", self._numbers(displacement, "displacement")

    def forces(self) -> tuple[Floats, Floats]:
        """F_N and F_x, N, of the committed states."""
        return self._shaped(self._call("forces"))

    def stiffness(self, direction: int = 1) -> tuple[Floats, Floats]:
        """Normal and tangential stiffness, N/m, of the last trial or else of the committed states.

        The tangential stiffness is that of a displacement that continues upwards (1) or downwards (-1) at constant
        indentation: after a reversal the whole contact sticks, without one only a part of it.
        """
        if direction not in (1, -1):
            raise refused("/direction", f"{direction!r} is out of range: allowed are 1 and -1")
        return self._shaped(self._call("stiffness", direction > 0))

    def state(self, index: int | tuple[int, ...]) -> results.State:
        """The committed state of one contact, by its number or its place in the shape."""
        return parse(results.State, json.loads(self._call("state", self._number_of(index))))


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
        shaped = _shape_of(shape)
        assert shaped is not None
        self._shape, self._in_use = shaped, Lock()
        document = encoded(to_document(_definition(profile, bodies, friction, load)))
        count, cores = math.prod(shaped), threads or os.cpu_count() or 1
        self._native: _native.PlanarContacts = guarded(
            _native.PlanarContacts, count, memory_at_hand(), document, rings, cores
        )
        warn(json.loads(self._native.warnings()), set())

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
        return self._shaped(self._call("step", *self._targets(indentation, displacement, normal_force)), 2)

    def trial(
        self,
        indentation: Quantity | Quantities | None = None,
        displacement: Quantities | None = None,
        *,
        normal_force: Quantity | Quantities | None = None,
    ) -> tuple[Floats, Floats]:
        """The forces after such a step from the committed states; `commit` keeps the step, `revert` discards it."""
        return self._shaped(self._call("trial", *self._targets(indentation, displacement, normal_force)), 2)

    def forces(self) -> tuple[Floats, Floats]:
        """F_N and F, N, of the committed states."""
        return self._shaped(self._call("forces"), 2)

    def state(self, index: int | tuple[int, ...]) -> results.PlanarState:
        """The committed state of one contact, by its number or its place in the shape."""
        return parse(results.PlanarState, json.loads(self._call("state", self._number_of(index))))

    def _targets(
        self,
        indentation: Quantity | Quantities | None,
        displacement: Quantities | None,
        normal_force: Quantity | Quantities | None,
    ) -> tuple[Floats, bool, Floats]:
        name, values = one_load(indentation, normal_force)
        if displacement is None or floats(displacement, "displacement").shape[-1:] != (2,):
            raise refused("/displacement", "the last axis of displacement is x and y: allowed are pairs [x, y]")
        normal = self._numbers(values, name)
        return normal, name == "normal_force", self._numbers(displacement, "displacement", 2)


def one_load(indentation: Any, normal_force: Any) -> tuple[str, Any]:
    """The load of a step, by its name."""
    given = {"indentation": indentation, "normal_force": normal_force}
    named = [(name, values) for name, values in given.items() if values is not None]
    if len(named) != 1:
        raise refused("/indentation", "a step has either indentation or normal_force")
    return named[0]
