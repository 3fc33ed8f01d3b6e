"""A contact in process: closed forms, history, copies, undo, pickle, memory, interrupts."""

from __future__ import annotations

import copy
import pickle
import resource
import signal
import subprocess
import sys
import textwrap
import time
import warnings

import numpy as np
import pytest

import stickslip as ss
from conftest import heed_interrupts

STEEL = ss.Body("210 GPa", 0.3)


def test_force_is_that_of_cattaneo_and_mindlin(ball: ss.Contact) -> None:
    summary = ball.summary
    for share in (0.1, 0.5, 0.9):
        state = ball.copy().move(share * summary.gross_slip_displacement).state
        assert state.force == pytest.approx(3.0 * (1.0 - (1.0 - share) ** 1.5), rel=1e-13)
    # Hertz: a^3 = 3 F R/(4 E*).
    assert summary.contact_radius**3 == pytest.approx(0.75 * 10.0 * 0.01 / summary.e_star, rel=1e-13)


def test_path_is_applied_whole_or_not_at_all(ball: ss.Contact) -> None:
    ball.move("20 nm")
    before = ball.state.document
    with pytest.raises(ss.InvalidInput) as refused:
        ball.path(moves=[{"displacement": 1e-7}, {"force": 3.5}])
    assert refused.value.code == "force_exceeds_friction"
    assert refused.value.pointer == "/path/moves/1"
    assert (ball.state.document, ball.sequence) == (before, 1)


def test_undo_leads_back_to_the_last_bit(ball: ss.Contact) -> None:
    states = [ball.state.document]
    ball.move(force="1 N")
    states.append(ball.state.document)
    ball.path([5e-8, -5e-8, 1e-8])
    states.append(ball.state.document)
    ball.relax(8)
    ball.undo()
    assert ball.state.document == states[2]
    assert ball.undo().document == states[1]
    assert ball.undo().document == states[0]
    with pytest.raises(ss.InvalidInput):
        ball.undo()


def test_copies_go_their_own_ways(ball: ss.Contact, here: ss.Contact) -> None:
    in_process = ball is here
    ball.path(falling_amplitude=7)
    before = ball.state.document
    for other in (ball.copy(), *([copy.copy(ball), copy.deepcopy(ball)] if in_process else [])):
        assert other.state.document == before
        other.move("50 nm")
        assert ball.state.document == before != other.state.document


def test_pickle_has_the_same_history_to_the_last_bit(here: ss.Contact) -> None:
    ball = here
    ball.path(moves=[{"displacement": 8e-8}, {"force": 0.3, "normal_force": 12.0}, {"displacement": -2e-8}])
    back = pickle.loads(pickle.dumps(ball))
    assert back.state.document == ball.state.document
    assert back.residual().document == ball.residual().document
    assert back.undo().document == ball.undo().document


def test_results_have_tables_and_pictures(ball: ss.Contact) -> None:
    path = ball.path(falling_amplitude=20)
    assert len(path.to_frame()) == 21
    stress = ball.stress(200)
    assert isinstance(stress.shear, np.ndarray)
    assert list(stress.to_frame().columns) == ["radius", "pressure", "shear"]
    below = ball.subsurface(plane={"normal": "y", "offset": 0.0, "x": [-1e-4, 1e-4, 5], "z": [0.0, 1e-4, 4]})
    cycle = ball.cycle(np.geomspace(1e-9, 1e-7, 5))
    life = {"s_n": {"reference": "200 MPa", "cycles": 1e6, "exponent": 8}}
    crossland = {"alpha": 0.3, "limit": "300 MPa", "life": life}
    distance = {"length": "10 um", "method": "point"}
    fretting = ball.fretting("50 nm", crossland=crossland, critical_distance=distance, tolerance=1e-2)
    assert fretting.crossland.critical_distance.life.cycles > fretting.crossland.life.cycles
    assert list(fretting.to_frame().columns) == ["x", "y", "z", "crossland", "crossland_cycles"]
    wear = ss.wear(ball, "50 nm", hold="indentation", points=20)
    assert wear.profile_error is not None
    assert wear.shape.radius.size == 23
    for result in (path, stress, ball.residual(), below, cycle, fretting, wear):
        result.plot()
        assert "<table" in result._repr_html_()
        assert type(result).__name__ in repr(result)


def test_warnings_of_replies_are_python_warnings_with_a_code() -> None:
    with pytest.warns(ss.StickslipWarning, match=r"\[dundurs_beta\]") as caught:
        ss.Contact(ss.Sphere(0.01), [STEEL, ss.RIGID], 0.3, normal_force=10.0)
    assert {warning.message.code for warning in caught} == {"dundurs_beta", "slip_direction"}
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=r"\[(dundurs_beta|slip_direction)\]")
        ss.Contact(ss.Sphere(0.01), [STEEL, ss.RIGID], 0.3, normal_force=10.0)


def test_memory_does_not_grow_over_many_contacts() -> None:
    definition = ss.Definition(ss.Sphere(0.01), [STEEL, ss.RIGID], 0.3, normal_force=10.0)

    def make(count: int) -> int:
        for _ in range(count):
            contact = ss.Contact.from_definition(definition)
            contact.path([1e-8, -1e-8])
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    before = make(2_000)
    # 100 bytes a contact would be 2 MB.
    assert make(20_000) - before < 2_000


def test_an_interrupt_stops_a_long_call() -> None:
    program = textwrap.dedent("""
        import stickslip as ss, warnings
        warnings.simplefilter("ignore")
        print("begun", flush=True)
        try:
            while True:
                ss.protocols(ss.Definition(ss.Sphere(0.01), ss.Moduli(1e11, 8e10), 0.3, normal_force=10.0), 40,
                             kind="minimax", robustness=dict(amplitude_error=0.01, samples=10000))
        except KeyboardInterrupt:
            print("interrupted", flush=True)
    """)
    command = [sys.executable, "-c", program]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, preexec_fn=heed_interrupts)
    assert process.stdout is not None
    assert process.stdout.readline() == "begun\n"
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=60)[0] == "interrupted\n"
    assert process.returncode == 0


def test_tables_of_arrow_share_the_numbers_of_their_results() -> None:
    pyarrow = pytest.importorskip("pyarrow")
    contact = ss.Contact(ss.Sphere("10 mm"), [ss.Body(2.1e11, 0.3), ss.RIGID], friction=0.3, normal_force=10.0)
    stress = contact.stress(200)
    table = stress.to_arrow()
    assert np.shares_memory(table["radius"].chunk(0).to_numpy(), stress.radius)
    assert pyarrow.table(stress).equals(table)
    contact.move("50 nm")
    peaks = contact.residual()
    assert peaks.to_arrow().to_pandas().equals(peaks.to_frame())


def test_bodies_that_conduct_have_the_conductance_of_their_constriction() -> None:
    copper = ss.Body("copper", resistivity="17 nOhm*m", conductivity="390 W/(m·K)")
    contact = ss.Contact(ss.Sphere("10 mm"), [copper, copper], friction=0.3, normal_force="10 N")
    # Holm (1967): 4 a over the sum of the resistivities.
    radius = contact.state.contact_radius
    assert contact.state.electrical_conductance == pytest.approx(4.0 * radius / 3.4e-8, rel=1e-12)
    assert contact.summary.thermal_conductance == pytest.approx(4.0 * radius / (2.0 / 390.0), rel=1e-12)
    many = ss.Contacts(
        profile=ss.Sphere(0.01), bodies=[ss.Body(2.1e11, 0.3, resistivity=[1e-7, 2e-7])] * 2, friction=0.3
    )
    many.step(normal_force=10.0, displacement=0.0)
    assert many.state(0).electrical_conductance == pytest.approx(2.0 * many.state(1).electrical_conductance)
