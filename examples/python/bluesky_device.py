"""A contact as a device of Bluesky: a plan sets its displacement, and reads its forces.

    python bluesky_device.py

A plan that was written for a bench runs on the model first, and its documents go where those of the bench go.
"""

from typing import Any

import pandas
from bluesky import RunEngine
from bluesky.plans import list_scan
from ophyd import Component, Device, Signal
from ophyd.status import DeviceStatus

import stickslip as ss


class ContactDevice(Device):  # type: ignore[misc]
    """Lengths in m, forces in N. A move is refused as one of the contact is, and changes nothing then."""

    displacement = Component(Signal, kind="normal")
    force = Component(Signal, kind="hinted")
    stick_radius = Component(Signal, kind="normal")
    friction = Component(Signal, kind="config")

    def __init__(self, name: str, contact: ss.Contact):
        super().__init__(name=name)
        self.contact = contact
        self.friction.put(contact.definition()["friction"])
        self._show()

    def set(self, displacement: float) -> DeviceStatus:
        """Moves the contact."""
        self.contact.move(displacement)
        self._show()
        status = DeviceStatus(self)
        status.set_finished()
        return status

    def _show(self) -> None:
        for name in ("displacement", "force", "stick_radius"):
            getattr(self, name).put(getattr(self.contact.state, name))


def main() -> pandas.DataFrame:
    """The readings of a scan up to gross slip."""
    steel = ss.Body("210 GPa", 0.3)
    contact = ss.Contact(ss.Sphere("10 mm"), [steel, steel], friction=0.3, normal_force="10 N")
    device, rows = ContactDevice("ball", contact), list[dict[str, Any]]()
    engine, most = RunEngine(), contact.summary.gross_slip_displacement
    engine.subscribe(lambda _, document: rows.append(document["data"]), "event")
    engine(list_scan([device], device, [share * most for share in (0.1, 0.3, 0.5, 0.7, 0.9)]))
    return pandas.DataFrame(rows)


if __name__ == "__main__":
    print(main().to_string(index=False))
