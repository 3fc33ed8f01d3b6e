"""Pictures: a loop through points on the way, one unit on an axis, sections without gaps, a search as its margins."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest

import stickslip as ss


def exact(u: np.ndarray, limit: float, slip: float) -> np.ndarray:
    """Cattaneo (1938): first loading to gross slip."""
    return limit * (1.0 - np.maximum(1.0 - u / slip, 0.0) ** 1.5)


def check_loop(axes: Any, limit: float, slip: float) -> None:
    """The line of a loop to gross slip and back is the loop, and not the lines between its turns."""
    line = axes.lines[0]
    u, force = line.get_xdata(), line.get_ydata()
    assert len(u) > 40
    top = int(np.argmax(u))
    # The area of the loop is what slip loses: with chords alone it would be far less.
    loop = slice(top, None)
    area = abs(np.trapezoid(force[loop], u[loop]))
    assert area > 1.2 * limit * slip
    middle = 0.5 * (u[: top + 1][1:] + u[: top + 1][:-1])
    drawn = np.interp(middle, u[: top + 1], force[: top + 1])
    assert np.abs(drawn - exact(middle, limit, slip)).max() < 0.01 * limit


def test_a_loop_is_drawn_through_points_on_the_way(ball: ss.Contact) -> None:
    summary = ball.summary
    turns = 4.0 * summary.gross_slip_displacement * np.array([1.0, -1.0, 1.0])
    reply = ball.path(turns)
    for one in (reply, ss.simulate(ball, turns), ball.history(), ball.loop(), ball.loop(points_per_move=7), ball):
        _, axes = plt.subplots()
        assert one.plot(ax=axes) is axes
        check_loop(axes, 3.0, summary.gross_slip_displacement)


def far_from(points: np.ndarray, line: np.ndarray) -> float:
    """The largest distance of points from the polygon through the points of a line."""
    begin, along = line[:-1], np.diff(line, axis=0)
    length = np.maximum((along**2).sum(axis=1), 1e-300)
    part = np.clip(((points[:, None] - begin) * along).sum(axis=2) / length, 0.0, 1.0)
    return float(np.linalg.norm(points[:, None] - begin - part[..., None] * along, axis=2).min(axis=1).max())


@pytest.mark.parametrize("kind", ["corner", "ellipse", "forces", "load"])
def test_motion_in_the_plane_is_drawn_through_points_on_the_way(kind: str, engine: Any) -> None:
    contact = ss.Contact(ss.Sphere(0.01), ss.Moduli(1e11, 8e10), 0.3, normal_force=10.0)
    full = contact.summary.gross_slip_displacement
    parts = 64
    if kind == "ellipse":
        turn = {"radii": [0.6 * full, 0.4 * full], "turns": 1}
        reply = engine.simulate(contact, ellipse=turn | {"steps_per_turn": 4})
        fine = engine.simulate(contact, ellipse=turn | {"steps_per_turn": 4 * parts})
    else:
        ends = np.array([[0.0, 0.0], [0.9, 0.0], [0.2, 0.6], [-0.5, 0.1]])
        name, scale = ("force", 2.6) if kind == "forces" else ("displacement", 2.0 * full)
        load = np.array([10.0, 10.0, 12.0, 9.0] if kind == "load" else [10.0] * 4)

        def moves(parts: int) -> list[dict[str, Any]]:
            share = np.arange(1, 3 * parts + 1) / parts
            to = scale * np.stack([np.interp(share, range(4), ends[:, axis]) for axis in range(2)], axis=1)
            loads = np.interp(share, range(4), load)
            rows = zip(to.tolist(), loads.tolist(), strict=True)
            return [{name: at} | ({"normal_force": force} if kind == "load" else {}) for at, force in rows]

        reply, fine = engine.simulate(contact, moves=moves(1)), engine.simulate(contact, moves=moves(parts))
    axes = reply.plot()
    line, dots = axes.lines[0].get_xydata(), axes.lines[1].get_xydata()
    assert dots == pytest.approx(np.array(reply.force))
    exact = np.array(fine.force)
    # The force turns on the way to a displacement: the lines between the ends of the moves are far from it.
    assert kind == "forces" or far_from(exact, np.vstack([[0.0, 0.0], dots])) > 0.1
    assert far_from(exact, line) < 0.02
    assert far_from(dots, line) < 0.01


def test_a_picture_of_an_earlier_path_is_of_that_path(ball: ss.Contact) -> None:
    first = ball.path([1e-7, -1e-7])
    second = ball.path([5e-8])
    ends = second.plot().lines[0].get_xdata()
    assert (ends[0], ends[-1]) == (-1e-7, 5e-8)
    assert first.plot().lines[0].get_xdata()[0] == 0.0


def test_states_without_their_path_are_dots() -> None:
    states = [{"displacement": u, "force": f} for u, f in ((0.0, 0.0), (1e-7, 2.0), (-1e-7, -2.0))]
    axes = ss.Result("PathReply", {"steps": states}).plot()
    assert [line.get_linestyle() for line in axes.lines] == ["None"]


def test_a_contact_that_is_twisted_is_drawn_by_its_angle_and_torque() -> None:
    contact = ss.Contact(ss.Sphere(0.01), [ss.Body(2.1e11, 0.3)] * 2, 0.3, normal_force=10.0)
    reply = ss.simulate(contact, twist=["0.02 deg", "-0.02 deg"], stress={"points": 20, "fields": ["hoop"]})
    axes = reply.plot()
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("angle of twist ω (µrad)", "torque M (µN·m)")
    assert axes.lines[1].get_xdata() == pytest.approx(np.radians([0.02, -0.02]))
    assert len(axes.lines[0].get_xdata()) > 20
    _, axes = plt.subplots()
    reply.stress.plot(ax=axes)
    assert axes.lines[-1].get_label() == "hoop stress τ"


def test_states_are_drawn_beside_one_another_with_labels(here: ss.Contact) -> None:
    _, axes = plt.subplots()
    for reversals in (2, 4):
        contact = here.copy()
        contact.path(falling_amplitude=reversals)
        contact.stress().plot(ax=axes, label=f"{reversals} reversals")
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels == ["friction bound ±μp", "2 reversals", "4 reversals"]


def test_a_section_is_drawn_without_gaps_and_labels_are_numbers(here: ss.Contact) -> None:
    plane = ss.Plane(normal="y", offset=0, x=[-1.5e-4, 1.5e-4, 31], z=[0, 1.5e-4, 16])
    axes = here.subsurface(plane=plane, fields=["von_mises"]).plot()
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (µm)", "z (µm)")
    assert not axes.lines
    # Filled between levels from edge to edge, and no points.
    assert all(type(one).__name__ == "QuadContourSet" for one in axes.collections)
    assert axes.get_xlim() == pytest.approx((-1.5e-4, 1.5e-4))
    bar = axes.figure.axes[1]
    assert bar.get_ylabel() == "von mises stress (MPa)"
    axes.figure.canvas.draw()
    texts = [label.get_text() for label in axes.get_xticklabels()]
    assert "µm" not in "".join(texts)


def test_a_search_is_drawn_as_its_margins(here: ss.Contact) -> None:
    found = here.fretting("50 nm", crossland={"alpha": 0.3, "limit": "300 MPa"}, findley={"k": 0.3, "limit": 2e8})
    axes = found.plot()
    heights = [bar.get_height() for bar in axes.patches]
    assert heights == pytest.approx([rating.margin for rating in found.ratings.values()])


def test_a_contact_in_process_has_what_one_on_a_server_has(here: ss.Contact, api: Any) -> None:
    there = api.Contact.from_definition(here)
    for contact in (here, there):
        contact.path([1e-7, -1e-7, 1e-7, -1e-7])
        contact.move(force="0.5 N")
    for ask in (
        lambda contact: [item | {"at": None} for item in contact.history().document["items"]],
        lambda contact: contact.history(after=1, limit=2).document["next"],
        lambda contact: contact.history(last=2).items.sequence.tolist(),
        lambda contact: ["cycle" in item for item in contact.history(cycles=False).document["items"]],
        lambda contact: contact.loop(points_per_move=5).document,
        lambda contact: contact.loop(after=2, limit=2).document,
        lambda contact: contact.cycles().document,
        lambda contact: contact.cycles(last=1).document,
    ):
        mine, theirs = ask(here), ask(there)
        if isinstance(mine, list) and mine and isinstance(mine[0], dict):
            mine, theirs = ([{k: v for k, v in one.items() if k != "at"} for one in side] for side in (mine, theirs))
        assert mine == theirs
    for wrong in ({"last": 2, "after": 1}, {"last": -1}):
        with pytest.raises(ss.InvalidInput):
            here.history(**wrong)
    with pytest.raises(ss.InvalidInput, match="1 to 100"):
        here.loop(points_per_move=101)
