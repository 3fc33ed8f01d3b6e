"""The values of the reference problems, by closed forms and quadratures in 40 digits.

    pip install mpmath numpy
    python values.py            # writes the documents beside this file
    python values.py --check    # computes everything anew and compares; writes nothing
    python values.py twist      # this one alone

It shares nothing with stickslip, neither code nor results. Every output is computed in a second way that uses other
formulas, `second` of each document, and nothing is written unless the two agree to the stated digits. Inputs are
doubles at their exact values.
"""

import json
import sys
from pathlib import Path

from found.cycles import harmonics, loops
from found.depth import stress_in_depth
from found.ellipse import elliptic_motion
from found.impact import oblique_impact
from found.laws import adhesion, relaxation, twist
from found.lines import line_contact, pad
from found.normal import normal_contact
from found.others import conductance, rolling, shear_strength, sliders, wear_limit
from found.plane import circular_motion
from found.tangential import falling_amplitude, first_loading, oblique_paths, paper_figures, random_turns

FOLDER = Path(__file__).parent
PROBLEMS = (
    normal_contact,
    first_loading,
    oblique_paths,
    random_turns,
    falling_amplitude,
    paper_figures,
    oblique_impact,
    circular_motion,
    elliptic_motion,
    loops,
    harmonics,
    line_contact,
    pad,
    stress_in_depth,
    wear_limit,
    shear_strength,
    conductance,
    sliders,
    rolling,
    twist,
    adhesion,
    relaxation,
)


#: By how much outputs may differ on other machines, over their scale; LAPACK's last bits reach far in these.
LAST_BITS = {"circular-motion": 2e-10, "elliptic-motion": 1e-12}


def same(found, stored, room=1e-13):
    """Equal but for the last bits of outputs, by which libraries of other machines differ."""
    if isinstance(found, dict) and "scale" in found and found["unit"] == stored["unit"]:
        pairs = zip([*found["values"], found["scale"]], [*stored["values"], stored["scale"]], strict=True)
        return all(abs(one - other) <= room * stored["scale"] for one, other in pairs)
    if isinstance(found, dict):
        return found.keys() == stored.keys() and all(same(found[name], stored[name], room) for name in found)
    if isinstance(found, list):
        return len(found) == len(stored) and all(same(*pair, room) for pair in zip(found, stored))
    return found == stored


def main():
    named = [name for name in sys.argv[1:] if name != "--check"]
    for make in PROBLEMS:
        if named and make.__name__.replace("_", "-") not in named:
            continue
        document = make()
        path = FOLDER / f"{document['id']}.json"
        if "--check" in sys.argv[1:]:
            room = LAST_BITS.get(document["id"], 1e-13)
            assert same(document, json.loads(path.read_text()), room), f"{path.name} is not what this program computes"
        else:
            path.write_text(json.dumps(document, indent=1, ensure_ascii=False) + "\n")
        print(document["id"])


if __name__ == "__main__":
    main()
