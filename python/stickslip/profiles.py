"""Shapes of the indenter, one class for each profile of the API, and places in a body.

Written by `tools/generate.py`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from typing import Any, ClassVar

from . import request_types as types
from .bodies import ContactPart, Material, Part, Shape
from .documents import Quantities, Quantity


@dataclass(frozen=True, eq=False)
class Profile(Part):
    """A shape of the indenter before it is loaded."""

    TYPE: ClassVar[str] = ""


@dataclass(frozen=True, eq=False, kw_only=True)
class Asperities(Profile):
    """Hertzian asperities between two rigid bodies, of which each is an elastic contact of its own."""

    TYPE: ClassVar[str] = "asperities"

    gaps: Quantities
    """Distances of the tips from the flat before the load, m, in any order; an offset does not matter, because the
    indentation counts from the first touch.
    """
    radii: Quantities | None = None
    """Radii of curvature, m, one for each gap; or give one `radius` for all."""
    radius: Quantity | None = None
    """Radius of curvature of all asperities, m."""


@dataclass(frozen=True, eq=False)
class Cone(Profile):
    """A cone."""

    TYPE: ClassVar[str] = "cone"

    slope: Quantity
    """Slope dz/dr, a pure number."""


@dataclass(frozen=True, eq=False)
class Cylinder(Profile):
    """A cylinder pressed along a line on a flat, in plane strain."""

    TYPE: ClassVar[str] = "cylinder"

    radius: Quantity
    """Radius R, m; for two cylinders 1/R = 1/R₁ + 1/R₂."""
    _: KW_ONLY
    length: Quantity
    """Length L of the contact, m: forces are those of all of it."""
    reference_length: Quantity | None = None
    """The length that fixes the displacements, m: dδ = 2/(π E* L) ln(reference_length/t) dF_N for the half-width t.
    Left out, twice the radius. Half-widths stay below nine tenths of it; stresses, forces and the work of closed
    cycles under a force do not depend on it.
    """


@dataclass(frozen=True, eq=False, kw_only=True)
class Ellipsoid(Profile):
    """A gap x²/(2 R_x) + y²/(2 R_y); `material` must name the bodies."""

    TYPE: ClassVar[str] = "ellipsoid"

    direction: types.MotionAxis
    """The axis along which the indenter moves."""
    radii: Quantities
    """The principal radii of curvature of the gap, R_x and R_y, m; their ratio is 10⁶ at the most."""


@dataclass(frozen=True, eq=False)
class ExactSphere(Profile):
    """A sphere without approximation."""

    TYPE: ClassVar[str] = "exact_sphere"

    radius: Quantity
    """Radius R, m; the contact radius stays below 0.9 of it."""


@dataclass(frozen=True, eq=False)
class FlatPunch(Profile):
    """A flat punch."""

    TYPE: ClassVar[str] = "flat_punch"

    radius: Quantity
    """Radius of the punch, m."""


@dataclass(frozen=True, eq=False, kw_only=True)
class LoadCurve(Profile):
    """A load curve from the first touch on.

    Its slope must not fall.
    """

    TYPE: ClassVar[str] = "load_curve"

    indentation: Quantities
    """Indentations d, m: from 0 on, increasing. The indentation never exceeds the last."""
    normal_force: Quantities
    """The normal force F_N at each, N: from 0 on."""


@dataclass(frozen=True, eq=False, kw_only=True)
class PowerLaw(Profile):
    """A power law."""

    TYPE: ClassVar[str] = "power_law"

    coefficient: Quantity
    """Coefficient, m^(1−n)."""
    exponent: Quantity
    """Exponent n, a pure number."""


@dataclass(frozen=True, eq=False, kw_only=True)
class RoundedCone(Profile):
    """A cone with a rounded tip."""

    TYPE: ClassVar[str] = "rounded_cone"

    slope: Quantity
    """Slope dz/dr of the cone, a pure number."""
    tip_radius: Quantity
    """Radius up to which the tip is a parabola, m."""


@dataclass(frozen=True, eq=False, kw_only=True)
class RoundedPad(Profile):
    """A flat pad with rounded edges pressed along a line on a flat, in plane strain."""

    TYPE: ClassVar[str] = "rounded_pad"

    edge_radius: Quantity
    """Radius R of the edges, m."""
    flat_half_width: Quantity
    """Half-width b of the flat, m."""
    length: Quantity
    """Length L of the contact, m: forces are those of all of it."""
    reference_length: Quantity | None = None
    """The length that fixes the displacements, m, as of a cylinder. Left out, `length`."""


@dataclass(frozen=True, eq=False, kw_only=True)
class RoundedPunch(Profile):
    """A flat punch with a rounded edge."""

    TYPE: ClassVar[str] = "rounded_punch"

    edge_radius: Quantity
    """Radius of curvature of the edge, m."""
    flat_radius: Quantity
    """Radius of the flat end, m."""


@dataclass(frozen=True, eq=False)
class Sphere(Profile):
    """A sphere in Hertz's approximation."""

    TYPE: ClassVar[str] = "sphere"

    radius: Quantity
    """Radius of curvature R of the gap, m; for two spheres 1/R = 1/R₁ + 1/R₂."""


@dataclass(frozen=True, eq=False)
class Sum(Profile):
    """A sum of profiles."""

    TYPE: ClassVar[str] = "sum"

    parts: Sequence[Shape]
    """The profiles that are added up."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Tabulated(Profile):
    """A table of heights over radii, of equal lengths."""

    TYPE: ClassVar[str] = "tabulated"

    r: Quantities
    """Radii, m: from 0 on, increasing. The contact radius stays below the last."""
    z: Quantities
    """Heights z above the plane, m; an offset does not matter."""
    indentation_error: Quantities | None = None
    """Standard errors of the indentation at which a contact has each radius, m, as `POST /profiles/fit` gives them:
    they take the place of what the heights say of their noise and of the shape between them. Of the length of `r`,
    and together with `pressure_error`.
    """
    pressure_error: Quantities | None = None
    """The largest standard error of the pressure in a contact of each radius, over E*, a pure number. Of the length of
    `r`, and together with `indentation_error`.
    """


@dataclass(frozen=True, eq=False, kw_only=True)
class TruncatedCone(Profile):
    """A truncated cone."""

    TYPE: ClassVar[str] = "truncated_cone"

    flat_radius: Quantity
    """Radius of the flat end, m."""
    slope: Quantity
    """Slope dz/dr outside the flat, a pure number."""


@dataclass(frozen=True, eq=False, kw_only=True)
class TruncatedSphere(Profile):
    """A truncated sphere."""

    TYPE: ClassVar[str] = "truncated_sphere"

    flat_radius: Quantity
    """Radius of the flat end, m."""
    radius: Quantity
    """Radius of curvature R, m."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Line(Part):
    """Points on a straight line, both ends included."""

    count: int
    """Number of points."""
    from_: Quantities
    """Where it begins: x, y, z, m."""
    to: Quantities
    """Where it ends: x, y, z, m."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Plane(Part):
    """A grid in a plane of constant x, y or z.

    Each of the other two coordinates is `[from, to, count]`, m, both ends included.
    """

    normal: types.Direction
    """The coordinate that is constant."""
    offset: Quantity
    """Its value, m."""
    x: Quantities | None = None
    """x from, to and number; left out where `normal` is x."""
    y: Quantities | None = None
    """y from, to and number; left out where `normal` is y."""
    z: Quantities | None = None
    """z from, to and number; left out where `normal` is z."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Surface(Part):
    """A grid on the surface, z = 0.

    Each coordinate is `[from, to, count]`, m, both ends included.
    """

    x: Quantities
    """x from, to and number."""
    y: Quantities
    """y from, to and number."""


@dataclass(frozen=True, eq=False)
class Definition(ContactPart):
    """A contact by its shape, bodies, friction and preload, of which one number is given."""

    profile: Shape
    """The shape of the indenter."""
    bodies: Material
    """The two bodies, or their reduced moduli."""
    friction: Quantity
    """Coulomb's coefficient of friction μ, a pure number."""
    normal_force: Quantity | None = None
    """Normal force, N."""
    indentation: Quantity | None = None
    """Indentation, m."""
    contact_radius: Quantity | None = None
    """Contact radius, m."""
    bulk: types.BulkPerForce | Mapping[str, Any] | None = None
    """A stress along x that comes with the tangential force and moves the stick zone: with a `cylinder`, under a
    constant load.
    """


__all__ = [
    "Profile",
    "Asperities",
    "Cone",
    "Cylinder",
    "Ellipsoid",
    "ExactSphere",
    "FlatPunch",
    "LoadCurve",
    "PowerLaw",
    "RoundedCone",
    "RoundedPad",
    "RoundedPunch",
    "Sphere",
    "Sum",
    "Tabulated",
    "TruncatedCone",
    "TruncatedSphere",
    "Line",
    "Plane",
    "Surface",
    "Definition",
]
