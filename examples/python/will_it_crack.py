"""Will it crack where it frets? Crossland's margin over the amplitude of the motion, with a bulk stress.

python will_it_crack.py
"""

import pandas

import stickslip as ss

TITANIUM = ss.Body("115 GPa", 0.32)


def main() -> pandas.DataFrame:
    """The margin (below 1 the criterion predicts crack growth) and the worst place, by the amplitude."""
    pad = ss.Contact(ss.Sphere("50 mm"), [TITANIUM, TITANIUM], friction=0.6, normal_force="50 N")
    slip = pad.summary.gross_slip_displacement
    rows = []
    for share in (0.2, 0.5, 0.8):
        found = pad.fretting(share * slip, bulk="150 MPa", crossland={"alpha": 0.4, "limit": "350 MPa"})
        assert found.place is not None
        rows.append({"amplitude over gross slip": share, "margin": found.margin, "x in um": 1e6 * found.place[0]})
    return pandas.DataFrame(rows)


if __name__ == "__main__":
    print(main().to_string(index=False))
