"""What all problems share: agreement of two ways, roots, and the form of a document."""

from mpmath import mp, mpf

mp.dps = 40
VERSION = "2.0.0"


def near(first, second, digits, what):
    """Both ways agree, relative to the larger."""
    error = abs(mpf(first) - mpf(second)) / max(abs(mpf(first)), abs(mpf(second)), mpf(10) ** -300)
    assert error < mpf(10) ** -digits, f"{what}: {first} and {second} differ by {mp.nstr(error, 3)}"


def root(f, low, high):
    """The root of a function that grows, by halving."""
    low, high = mpf(low), mpf(high)
    assert f(low) < 0 < f(high), "no root"
    for _ in range(150):
        middle = (low + high) / 2
        low, high = (middle, high) if f(middle) < 0 else (low, middle)
    return middle


def out(unit, *values, scale=None):
    """An output as it stands in a document: 17 digits, and what errors are relative to."""
    values = [float(value) for value in values]
    return {"unit": unit, "values": values, "scale": float(scale) if scale else max(abs(value) for value in values)}


def problem(name, title, statement, found, second, sources, cases, meaning=None):
    """A document."""
    meaning = meaning or {
        "1e-2": "as good as the finite elements and grids of everyday use",
        "1e-4": "no measurement distinguishes the answer from the exact one",
        "1e-8": "the code solves the equations themselves, or a discretisation that converges fast",
    }
    return {
        "suite": "stickslip reference",
        "version": VERSION,
        "id": name,
        "title": title,
        "statement": statement,
        "errors": "An error is the largest difference from `values`, divided by `scale`.",
        "meaning": meaning,
        "found": found,
        "second": second,
        "sources": sources,
        "cases": cases,
    }
