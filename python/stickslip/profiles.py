"""Shapes of the indenter, one class for each profile of the API, and places in a body.

Written by `tools/generate.py`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, InitVar, dataclass
from typing import Any, ClassVar

from . import request_types as types
from .bodies import ContactPart, Material, Part, Shape, radius_of
from .documents import Quantities, Quantity


@dataclass(frozen=True, eq=False)
class Profile(Part):
    """A shape of the indenter before it is loaded."""

    TYPE: ClassVar[str] = ""


@dataclass(frozen=True, eq=False, kw_only=True)
class Asperities(Profile):
    """Hertzian asperities between two rigid bodies; each asperity is an elastic contact of its own."""

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

    radius: Quantity | None = None
    """Radius R, m; for two cylinders 1/R = 1/R₁ + 1/R₂."""
    _: KW_ONLY
    length: Quantity
    """Length L of the contact, m; forces are totals over this length."""
    reference_length: Quantity | None = None
    """The length that fixes the displacements, m: dδ = 2/(π E* L) ln(reference_length/t) dF_N for the half-width t. If
    left out, twice the radius. Half-widths must stay below nine tenths of it; stresses, forces and the work of
    closed cycles under a force do not depend on it.
    """
    diameter: InitVar[Quantity | None] = None
    """The diameter 2 R, m, in place of the radius."""

    def __post_init__(self, diameter: Quantity | None) -> None:
        radius_of(self, self.radius, diameter)


@dataclass(frozen=True, eq=False, kw_only=True)
class Ellipsoid(Profile):
    """A gap x²/(2 R_x) + y²/(2 R_y); `material` must name the bodies."""

    TYPE: ClassVar[str] = "ellipsoid"

    direction: types.MotionAxis
    """The axis along which the indenter moves."""
    radii: Quantities
    """The principal radii of curvature of the gap, R_x and R_y, m; their ratio is at most 10⁶."""


@dataclass(frozen=True, eq=False)
class ExactSphere(Profile):
    """A sphere without approximation."""

    TYPE: ClassVar[str] = "exact_sphere"

    radius: Quantity | None = None
    """Radius R, m; the contact radius stays below 0.9 of it."""
    _: KW_ONLY
    diameter: InitVar[Quantity | None] = None
    """The diameter 2 R, m, in place of the radius."""

    def __post_init__(self, diameter: Quantity | None) -> None:
        radius_of(self, self.radius, diameter)


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
    """Indentations d, m: increasing from 0. The indentation must not exceed the last."""
    normal_force: Quantities
    """The normal force F_N at each indentation, N: increasing from 0."""


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
    """Length L of the contact, m; forces are totals over this length."""
    reference_length: Quantity | None = None
    """The length that fixes the displacements, m, as for a cylinder. If left out, `length`."""


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

    radius: Quantity | None = None
    """Radius of curvature R of the gap, m; for two spheres 1/R = 1/R₁ + 1/R₂."""
    _: KW_ONLY
    diameter: InitVar[Quantity | None] = None
    """The diameter 2 R, m, in place of the radius."""

    def __post_init__(self, diameter: Quantity | None) -> None:
        radius_of(self, self.radius, diameter)


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
    """Radii, m: increasing from 0. The contact radius must stay below the last."""
    z: Quantities
    """Heights z above the plane, m; an offset does not matter."""
    indentation_error: Quantities | None = None
    """Standard errors of the indentation at which a contact has each radius, m, as `POST /profiles/fit` gives them:
    they replace the estimates from the noise of the heights and from the shape between them. One for each radius in
    `r`; requires `pressure_error`.
    """
    pressure_error: Quantities | None = None
    """The largest standard error of the pressure in a contact of each radius, over E*, a pure number. One for each
    radius in `r`; requires `indentation_error`.
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
    """Range of x as `[from, to, count]`; left out where `normal` is x."""
    y: Quantities | None = None
    """Range of y as `[from, to, count]`; left out where `normal` is y."""
    z: Quantities | None = None
    """Range of z as `[from, to, count]`; left out where `normal` is z."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Surface(Part):
    """A grid on the surface, z = 0.

    Each coordinate is `[from, to, count]`, m, both ends included.
    """

    x: Quantities
    """Range of x as `[from, to, count]`."""
    y: Quantities
    """Range of y as `[from, to, count]`."""


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
    """Normal force, N; below zero only with `adhesion`."""
    indentation: Quantity | None = None
    """Indentation, m; below zero only with `adhesion`."""
    contact_radius: Quantity | None = None
    """Contact radius, m."""
    adhesion: types.Adhesion | Mapping[str, Any] | None = None
    """Adhesion of the JKR kind; only with `friction` 0. Load and preload may then pull."""
    bulk: types.BulkPerForce | Mapping[str, Any] | None = None
    """A bulk stress along x in proportion to the tangential force, which shifts the stick zone: only with a `cylinder`
    and under a constant load.
    """
    prony: Sequence[types.PronyTerm | Mapping[str, Any]] | None = None
    """The memory of the bodies, a Prony series of 1 to 16 terms: their moduli are those of the instant, and relax as
    R(t) = 1 − Σ ratio (1 − exp(−t/time)). Both bodies are alike, or one is rigid. The preload is put on at once at
    time 0, and moves have a `duration`.
    """
    shear_strength: Quantity | None = None
    """Shear strength τ₀ of the interface, Pa: shear stress stays below τ₀ + μp. Zero if left out; otherwise the load
    must stay constant from the first tangential move on.
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
