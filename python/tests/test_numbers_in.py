"""Every number that comes in is read in one way: kinds of values times units times places, against plain SI numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pandas
import pytest

import stickslip as ss
from stickslip import members, requests
from stickslip.documents import floats, to_document

STEEL = ss.Body(2.1e11, 0.3)
#: SI units with others of the same dimension.
UNITS = {"m": ("m", "mm", "um", "nm"), "N": ("N", "mN", "kN"), "Pa": ("Pa", "MPa", "GPa"), "1": ("1",)}
FACTORS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "N": 1.0, "mN": 1e-3, "kN": 1e3}
FACTORS |= {"Pa": 1.0, "MPa": 1e6, "GPa": 1e9, "1": 1.0}
Maker = Callable[[np.ndarray, str], Any]


def packages() -> dict[str, Maker]:
    """What makes arrays with units of numbers and the name of a unit."""
    import pint

    pint_units = pint.UnitRegistry()
    polars, xarray = pytest.importorskip("polars"), pytest.importorskip("xarray")
    makers: dict[str, Maker] = {
        "pint": lambda numbers, unit: numbers * pint_units(unit if unit != "1" else "dimensionless"),
        "pint in a list": lambda numbers, unit: [one * pint_units(unit if unit != "1" else "") for one in numbers],
        "xarray of pint": lambda numbers, unit: xarray.DataArray(numbers * pint_units(unit if unit != "1" else "")),
        "texts": lambda numbers, unit: [f"{one!r} {unit if unit != '1' else ''}" for one in numbers.tolist()],
        "series of texts": lambda numbers, unit: pandas.Series([f"{one!r} {unit}" for one in numbers.tolist()]),
        "named series": lambda numbers, unit: pandas.Series(numbers, name=f"column ({unit})"),
        "named by brackets": lambda numbers, unit: pandas.Series(numbers, name=f"column [{unit}]"),
        "named polars": lambda numbers, unit: polars.Series(f"column ({unit})", numbers),
        "attributes": lambda numbers, unit: with_attributes(pandas.Series(numbers), unit),
        "attributes by name": lambda numbers, unit: with_attributes(pandas.Series(numbers, name="A"), {"a": unit}),
        "xarray": lambda numbers, unit: xarray.DataArray(numbers, attrs={"units": unit}),
    }
    if (units := installed("astropy.units")) is not None:
        makers["astropy"] = lambda numbers, unit: numbers * units.Unit("" if unit == "1" else unit)
        makers["astropy in a list"] = lambda numbers, unit: [
            one * units.Unit("" if unit == "1" else unit) for one in numbers
        ]
    if (unyt := installed("unyt")) is not None:
        makers["unyt"] = lambda numbers, unit: unyt.unyt_array(numbers, "dimensionless" if unit == "1" else unit)
    if (quantities := installed("quantities")) is not None:
        # It has no millinewtons.
        spelled = {"1": ("dimensionless", 1.0), "mN": ("N", 1e-3), "kN": ("N", 1e3)}

        def of_quantities(numbers: np.ndarray, unit: str) -> Any:
            name, factor = spelled.get(unit, (unit, 1.0))
            return quantities.Quantity(numbers * factor, name)

        makers["quantities"] = of_quantities
    return makers


def installed(name: str) -> Any:
    try:
        return pytest.importorskip(name)
    except pytest.skip.Exception:
        return None


def with_attributes(column: Any, units: Any) -> Any:
    column.attrs["units"] = units
    return column


def plain() -> dict[str, Callable[[np.ndarray], Any]]:
    """What makes arrays of SI numbers."""
    polars, pyarrow, xarray = (pytest.importorskip(name) for name in ("polars", "pyarrow", "xarray"))
    return {
        "list": lambda numbers: numbers.tolist(),
        "tuple": lambda numbers: tuple(numbers.tolist()),
        "array": lambda numbers: numbers,
        "strided": lambda numbers: np.repeat(numbers, 2)[::2],
        "reversed": lambda numbers: numbers[::-1].copy()[::-1],
        "long double": lambda numbers: numbers.astype(np.longdouble),
        "objects": lambda numbers: numbers.astype(object),
        "decimals": lambda numbers: [Fraction(one) for one in numbers.tolist()],
        "not masked": np.ma.array,
        "pandas": pandas.Series,
        "nullable": lambda numbers: pandas.Series(numbers, dtype="Float64"),
        "pandas of arrow": lambda numbers: pandas.Series(numbers, dtype=pandas.ArrowDtype(pyarrow.float64())),
        "index": pandas.Index,
        "polars": lambda numbers: polars.Series(numbers),
        "pyarrow": lambda numbers: pyarrow.array(numbers),
        "xarray": xarray.DataArray,
    }


def placed(value: Any, name: str) -> Any:
    """The numbers that a member has in the request, as a call of the package makes it."""
    contact = {"profile": {"type": "sphere", "radius": 0.01}}
    if name == "steps of arrays":
        return floats(value, "displacement").tolist()
    if name == "loop":
        found, _ = requests.loops({"displacement": value, "force": [0.0] * 5}, None)
        return to_document(found)[0]["displacement"]
    if name == "scan":
        found, _ = requests.scan((value, [0.0] * 5), None)
        return found["line"]["x"]
    if name == "table of moves":
        way = requests.assemble("path", {}, {"path": {"displacement": pandas.DataFrame({"force": list(value)})}})
        return [move["force"] for move in to_document(way)["path"]["moves"]]
    path = name.split("/")
    document: Any = value
    for one in reversed(path):
        document = {one: document}
    found = to_document(contact | document)
    for one in path:
        found = found[one]
    return found


PLACES = {
    "path/displacement": "m",
    "path/force": "N",
    "profile/r": "m",
    "drive/displacement": "m",
    "profile/radii": "m",
    "plane/x": "m",
    "steps of arrays": "m",
    "loop": "m",
    "scan": "m",
    "material/youngs_modulus": "Pa",
    "contact/friction": "1",
}


def test_kinds_of_values_times_units_times_places_are_the_plain_numbers() -> None:
    generator = np.random.default_rng(5)
    makers, bare = packages(), plain()
    tried = set()
    for case in range(600):
        place, si = list(PLACES.items())[generator.integers(len(PLACES))]
        numbers = np.round(generator.uniform(0.1, 0.9, 5), 6)
        expected = numbers
        if case % 2:
            kind = list(makers)[generator.integers(len(makers))]
            unit = UNITS[si][generator.integers(len(UNITS[si]))]
            if unit == "1" and kind in ("named series", "named by brackets", "named polars", "series of texts"):
                continue
            value, expected = makers[kind](numbers, unit), numbers * FACTORS[unit]
        else:
            kind = list(bare)[generator.integers(len(bare))]
            value = bare[kind](numbers)
        found = placed(value, place)
        assert np.allclose(found, expected, rtol=1e-13, atol=0.0), (kind, place)
        assert all(type(one) is float for one in found), (kind, place)
        tried.add((kind, place))
    assert len(tried) > 150


def test_every_unit_of_the_members_is_known_to_every_package() -> None:
    pint = pytest.importorskip("pint").UnitRegistry()
    spelled = {unit: unit.replace("·", "*").replace("Ω", "ohm") for unit in {*members.MEMBERS.values()} - {"", "1"}}
    makers: dict[str, Callable[[str], Any]] = {
        "text": lambda unit: f"3 {unit}",
        "name": lambda unit: pandas.Series([3.0], name=f"column [{unit}]"),
        "pint": lambda unit: 3.0 * pint(spelled[unit]),
    }
    if (units := installed("astropy.units")) is not None:
        makers["astropy"] = lambda unit: 3.0 * units.Unit(spelled[unit])
    if (unyt := installed("unyt")) is not None:
        makers["unyt"] = lambda unit: unyt.unyt_quantity(3.0, spelled[unit].replace("^", "**"))
    if (quantities := installed("quantities")) is not None:
        makers["quantities"] = lambda unit: quantities.Quantity(3.0, spelled[unit].replace("^", "**"))
    tried = 0
    for name, unit in members.MEMBERS.items():
        if unit in ("", "1"):
            continue
        for kind, make in makers.items():
            found = np.ravel(to_document({name: make(unit)})[name])
            assert found == pytest.approx([3.0], rel=1e-14), (name, unit, kind)
            tried += 1
    assert tried > 150


@pytest.mark.parametrize("degrees", [0.0, 1.0, -30.0, 180.0])
def test_an_angle_is_in_the_unit_of_its_member(degrees: float) -> None:
    pint = pytest.importorskip("pint").UnitRegistry()
    radians = math.radians(degrees)
    given: list[Any] = [f"{degrees!r} deg", f"{radians!r} rad", f"{60.0 * degrees!r} arcmin", degrees * pint.deg]
    given += [pandas.Series([degrees], name="twist (deg)"), f"{1e3 * radians!r} mrad"]
    for one in given:
        assert np.ravel(to_document({"twist": one})["twist"]) == pytest.approx([radians], rel=1e-13, abs=1e-300)
        assert np.ravel(to_document({"phase": one})["phase"]) == pytest.approx([degrees], rel=1e-13, abs=1e-300)
    contact = ss.Contact(ss.Sphere(0.01), [STEEL, STEEL], 0.3, normal_force=10.0)
    reply = ss.simulate(contact, twist=[f"{1e-3 * degrees!r} deg"])
    assert reply.steps[0].twist == pytest.approx(1e-3 * radians)


def test_a_single_quantity_of_each_package_is_the_same_shape() -> None:
    makers = packages()
    for kind in ("pint in a list", "astropy in a list", "texts"):
        if kind in makers:
            assert ss.Sphere(makers[kind](np.array([10.0]), "mm")[0]) == ss.Sphere(0.01), kind
    unyt, quantities = pytest.importorskip("unyt"), pytest.importorskip("quantities")
    assert ss.Sphere(unyt.unyt_quantity(10.0, "mm")) == ss.Sphere(10.0 * quantities.mm) == ss.Sphere(0.01)
    assert ss.Sphere(np.float32(0.5)) == ss.Sphere(np.longdouble(0.5)) == ss.Sphere(np.array(0.5)) == ss.Sphere(0.5)


def test_a_unit_of_another_dimension_is_refused_at_its_place() -> None:
    for kind, make in packages().items():
        with pytest.raises(ss.InvalidInput) as refused:
            to_document({"path": {"displacement": make(np.array([1.0, 2.0]), "N")}})
        assert refused.value.code == "unknown_unit", kind
        assert str(refused.value.pointer).startswith("/path/displacement"), kind
    with pytest.raises(ss.InvalidInput, match="furlongs"):
        to_document({"radius": pandas.Series([1.0], name="r (furlongs per fortnight)")})


MASKED = np.ma.array([1e-8, 2e-8, 3e-8], mask=[False, True, False])


def test_a_masked_number_is_refused_at_its_place_and_is_missing_in_a_scan() -> None:
    import pint

    masked: list[Any] = [MASKED, MASKED * pint.UnitRegistry().m, list(MASKED)]
    if installed("astropy") is not None:
        from astropy import units
        from astropy.utils.masked import Masked

        masked.append(Masked([1e-8, 2e-8, 3e-8] * units.m, mask=[False, True, False]))
    for one in masked:
        for name in ("displacement", "force"):
            if name == "force" and one is not MASKED:
                continue
            with pytest.raises(ss.InvalidInput) as refused:
                to_document({"loops": [{name: one}]})
            assert refused.value.pointer == f"/loops/0/{name}/1"
        found, _ = requests.scan(([0.0, 1.0, 2.0], one), None)
        assert found["line"]["z"][1] is None
        assert found["line"]["z"][0] == 1e-8
    assert to_document({"scan": {"map": {"z": np.ma.array([[1.0, 2.0]], mask=[[False, True]])}}}) == {
        "scan": {"map": {"z": [[1.0, None]]}}
    }
    with pytest.raises(ss.InvalidInput) as refused:
        ss.Contacts(3, ss.Sphere(0.01), ss.Moduli(1e11, 8e10), np.ma.array([0.3, 0.4, 0.5], mask=[False, True, False]))
    assert refused.value.pointer == "/friction/1"
    many = ss.Contacts(3, ss.Sphere(0.01), ss.Moduli(1e11, 8e10), 0.3)
    with pytest.raises(ss.InvalidInput) as refused:
        many.step(1e-6, MASKED)
    assert refused.value.pointer == "/displacement/1"


def test_the_unit_in_the_name_of_a_selected_column_counts() -> None:
    x = np.linspace(-70.0, 70.0, 41)
    frame = pandas.DataFrame({"x (um)": x, "z (um)": -(x**2) / (2.0 * 1e4)})
    for given in (frame, (frame["x (um)"], frame["z (um)"])):
        found = ss.fit_profile(given, smoothing={"noise": "0.1 nm"})
        assert found.radius_of_curvature.value == pytest.approx(0.01, rel=1e-3)


def test_units_in_attributes_count_in_any_case_and_two_that_differ_are_refused() -> None:
    frame = pandas.DataFrame({"Displacement": [10.0, -20.0]})
    frame.attrs["units"] = {"displacement": "nm"}
    assert to_document({"displacement": frame["Displacement"]})["displacement"] == pytest.approx([1e-8, -2e-8])
    column = with_attributes(pandas.Series([1.0], name="radius (mm)"), "um")
    with pytest.raises(ss.InvalidInput, match="attrs have the unit um"):
        to_document({"radius": column})
    pint = pytest.importorskip("pint").UnitRegistry()
    xarray = pytest.importorskip("xarray")
    with pytest.raises(ss.InvalidInput, match="its values have"):
        to_document({"radius": xarray.DataArray([1.0] * pint.mm, attrs={"units": "um"})})
    frame.attrs["units"] = {"displacement": "nm", "DISPLACEMENT": "um"}
    with pytest.raises(ss.InvalidInput, match="several units"):
        to_document({"displacement": frame["Displacement"]})


def test_two_columns_of_one_quantity_are_refused(here: ss.Contact) -> None:
    with pytest.raises(ss.InvalidInput, match="two columns"):
        here.path(pandas.DataFrame({"displacement": [1e-8], "displacement (nm)": [20.0]}))
    assert here.sequence == 0


def test_an_angle_is_its_tangent_where_a_slope_or_friction_is_expected_and_refused_elsewhere() -> None:
    pint = pytest.importorskip("pint").UnitRegistry()
    angles: list[Any] = ["45 deg", "45°", f"{math.pi / 4!r} rad", "50 gon", 45 * pint.deg, "2700 arcmin"]
    if (units := installed("astropy.units")) is not None:
        angles.append(45 * units.deg)
    if (unyt := installed("unyt")) is not None:
        angles.append(unyt.unyt_quantity(45.0, "degree"))
    if (quantities := installed("quantities")) is not None:
        angles.append(45 * quantities.deg)
    for angle in angles:
        assert to_document({"slope": angle, "friction": angle}) == {
            "slope": pytest.approx(1.0, rel=1e-12),
            "friction": pytest.approx(1.0, rel=1e-12),
        }, angle
        with pytest.raises(ss.InvalidInput, match="angle") as refused:
            to_document({"bodies": [{"poisson_ratio": angle}]})
        assert refused.value.pointer == "/bodies/0/poisson_ratio"
    assert to_document({"friction": pandas.Series([45.0], name="friction (deg)")})["friction"] == pytest.approx([1.0])
    assert to_document({"friction": "30 %"})["friction"] == pytest.approx(0.3)
    assert to_document({"phase": ["90 deg", f"{math.pi / 2!r} rad", 90 * pint.deg]})["phase"] == pytest.approx(
        [90.0] * 3
    )


@pytest.mark.parametrize(
    "wrong",
    [
        True,
        np.True_,
        np.array([True, False]),
        1j,
        np.array([1.0 + 0.0j]),
        np.array(["2026-01-01"], dtype="datetime64[s]"),
        np.array([1], dtype="timedelta64[s]"),
        ss.Sphere,
        float("nan"),
        np.inf,
        b"1",
        np.array([object()]),
        {1e-8},
        pandas.Timestamp("2026-01-01") - pandas.Timestamp("2025-01-01"),
    ],
    ids=str,
)
def test_what_is_no_number_is_refused_at_its_place(wrong: Any) -> None:
    with pytest.raises(ss.InvalidInput) as refused:
        to_document({"profile": {"radius": wrong}})
    assert str(refused.value.pointer).startswith("/profile/radius")
    many = ss.Contacts(1, ss.Sphere(0.01), ss.Moduli(1e11, 8e10), 0.3)
    with pytest.raises(ss.InvalidInput) as refused:
        many.step(wrong, 0.0)
    assert str(refused.value.pointer).startswith("/indentation")


def test_an_uncertainty_is_refused_and_not_dropped() -> None:
    uncertainties = pytest.importorskip("uncertainties")
    for value in (uncertainties.ufloat(1e-8, 1e-9), [uncertainties.ufloat(1e-8, 1e-9)]):
        with pytest.raises(ss.InvalidInput, match="nominal_value") as refused:
            to_document({"radius": value})
        assert str(refused.value.pointer).startswith("/radius")


class Furlongs:
    """A number with a unit of a package that nobody knows."""

    unit = "furlong"

    def __float__(self) -> float:
        return 1.0

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        return np.array([1.0])


def test_a_unit_of_an_unknown_package_is_refused() -> None:
    with pytest.raises(ss.InvalidInput, match="not known here") as refused:
        to_document({"radius": Furlongs()})
    assert refused.value.code == "unknown_unit"


def test_a_table_in_place_of_an_array_keeps_its_units_or_is_refused(here: ss.Contact) -> None:
    pyarrow, polars = pytest.importorskip("pyarrow"), pytest.importorskip("polars")
    places = {"z (um)": [1.0, 2.0], "x (um)": [0.0, 30.0], "y (mm)": [0.0, 0.01]}
    expected = here.subsurface(points=[[0.0, 0.0, 1e-6], [3e-5, 1e-5, 2e-6]])
    with_attributes_ = pandas.DataFrame({"x": [0.0, 30.0], "y": [0.0, 10.0], "z": [1.0, 2.0]})
    with_attributes_.attrs["units"] = dict.fromkeys("xyz", "um")
    structured = np.array([(0.0, 0.0, 1e-6), (3e-5, 1e-5, 2e-6)], dtype=[("x", float), ("y", float), ("z", float)])
    tables: list[Any] = [pandas.DataFrame(places), polars.DataFrame(places), pyarrow.table(places), with_attributes_]
    for table in [*tables, structured]:
        found = here.subsurface(points=table)
        for name in ("x", "y", "z", "xx"):
            assert getattr(found, name) == pytest.approx(getattr(expected, name), rel=1e-9, abs=1e-20), type(table)
    frame = pandas.DataFrame({"r (um)": [10.0, 20.0]})
    for give in (lambda: here.stress(radii=frame), lambda: ss.cycle(here, frame), lambda: ss.Sphere(frame).document()):
        with pytest.raises(ss.InvalidInput, match="give one of its columns"):
            to_document(give())
    assert here.stress(radii=frame["r (um)"]).radius == pytest.approx([1e-5, 2e-5])


def test_tables_of_other_libraries_are_read_by_their_names(here: ss.Contact) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    fields = pyarrow.schema([pyarrow.field("displacement", pyarrow.float64(), metadata={"unit": "nm"})])
    tables: list[Any] = [
        pyarrow.table({"displacement (nm)": [10.0, -20.0]}),
        pyarrow.table({"displacement": [10.0, -20.0]}, schema=fields),
        np.array([(1e-8,), (-2e-8,)], dtype=[("displacement", float)]),
    ]
    if installed("astropy") is not None:
        from astropy import units
        from astropy.table import QTable, Table

        tables.append(QTable({"displacement": [10.0, -20.0] * units.nm}))
        tables.append(Table({"displacement": [10.0, -20.0]}, units={"displacement": "nm"}))
    for table in tables:
        contact = here.copy()
        contact.path(table)
        moved = [move["displacement"] for move in contact.moves()]
        assert moved == pytest.approx([1e-8, -2e-8], rel=1e-14), type(table)


def test_the_values_of_an_axis_have_the_unit_of_what_they_change() -> None:
    swept = requests.axes({"/contact/profile/radius": ["10 mm", "2 cm"], "/contact/friction": ["45 deg"]})
    assert swept[0]["values"] == pytest.approx([0.01, 0.02])
    assert swept[1]["values"] == pytest.approx([1.0])
    with pytest.raises(ss.InvalidInput) as refused:
        requests.axes({"/contact/profile/radius": ["10 N"]})
    assert refused.value.pointer == "/axes/0/values/0"
