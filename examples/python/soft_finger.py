"""A soft finger holds a peg until its force has relaxed: it presses, takes the weight, waits, and lets the peg slip.

    python soft_finger.py

Its force relaxes at the place to which it was moved.
"""

import pandas

import stickslip as ss

GEL = ss.Body("1 MPa", 0.5, prony=[(0.2, "0.1 s"), (0.3, "10 s")])
FRICTION, LOAD, WEIGHT = 0.8, 2.0, 1.0


def main() -> pandas.DataFrame:
    """The states of the finger, from the weight on to the last one before the peg slips."""
    finger = ss.Contact(ss.Sphere("8 mm"), [GEL, ss.RIGID], FRICTION, normal_force=LOAD)
    state = finger.move(force=WEIGHT, duration="0.2 s", tolerance=1e-4).state
    states, step = [state], 1.0
    while step > 1e-4:
        try:
            # The peg hangs on while the finger stays where it is.
            states.append(finger.move(force=WEIGHT, duration=step, tolerance=1e-4).state)
        except ss.InvalidInput:
            # Friction does not hold it to the end of the wait: a shorter one.
            step /= 4.0
    columns = ("time", "displacement", "force", "normal_force", "contact_radius", "stick_radius", "viscous_work")
    return pandas.DataFrame([[getattr(state, name) for name in columns] for state in states], columns=columns)


if __name__ == "__main__":
    print(main().to_string(index=False))
