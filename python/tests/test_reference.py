"""The reference problems: their values anew, stickslip on all of them, and codes that cannot state or solve them."""

from __future__ import annotations

import subprocess
import sys

import pytest

from conftest import ROOT
from stickslip import reference

FOLDER = ROOT / "reference"
PROBLEMS = reference.read_problems(FOLDER)
#: Problems of which stickslip states an error, and the largest it may state: rings, times, springs with memory.
NOT_EXACT = {"circular-motion": 5e-3, "elliptic-motion": 5e-2, "oblique-impact": 2e-4, "relaxation": 2e-5}


def errors(code: reference.Code) -> dict[str, float | None]:
    return {row.problem: row.error for row in reference.run(code, PROBLEMS)}


def test_the_package_solves_every_problem() -> None:
    code = reference.code_named("package")
    rows = list(reference.run(code, PROBLEMS))
    assert {row.problem: left for row in rows if (left := reference.shortcomings(row, 1e-10))} == {}
    # Elsewhere it calls itself exact.
    assert {row.problem for row in rows if row.stated} == NOT_EXACT.keys()
    assert all(row.stated <= NOT_EXACT.get(row.problem, 0) for row in rows)


def test_the_values_are_those_that_two_ways_agree_on() -> None:
    run = subprocess.run([sys.executable, FOLDER / "values.py", "--check"], capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr
    assert sorted(run.stdout.split()) == [problem["id"] for problem in PROBLEMS]


def test_every_problem_states_itself() -> None:
    for problem in PROBLEMS:
        assert set(problem["meaning"]) == {"1e-2", "1e-4", "1e-8"}
        assert all(problem[name] for name in ("statement", "found", "second", "sources", "version"))
        for case in problem["cases"]:
            for output in case["outputs"].values():
                assert output["scale"] > 0, (problem["id"], case["name"])


def test_springs_converge_and_one_spring_with_a_cap_is_found_out() -> None:
    few, many = (errors(reference.springs(count)) for count in (100, 10_000))
    assert many["oblique-paths"] < 1e-7 < few["oblique-paths"] < 1e-3
    capped = errors(reference.capped_spring)
    assert capped["oblique-paths"] > 0.1
    assert capped["random-turns"] > 0.1


def test_what_a_code_cannot_state_is_blank_and_what_it_gets_wrong_is_infinite() -> None:
    found = dict.fromkeys(errors(reference.capped_spring), "")
    table = {"capped-spring": {}}
    printed = reference.markdown(table, PROBLEMS)
    assert printed.count("|  |\n") == len(found)
    assert reference.error_of({"values": [1.0, 2.0], "scale": 2.0}, [1.0, None]) == float("inf")
    assert reference.error_of({"values": [1.0, 2.0], "scale": 2.0}, [1.0]) == float("inf")
    assert reference.error_of({"values": [1.0, 2.0], "scale": 2.0}, [1.0, 3.0]) == 0.5
    with pytest.raises(SystemExit, match="no code"):
        reference.code_named("nobody")
