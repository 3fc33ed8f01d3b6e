"""What Schemathesis checks besides: a valid request gets 422 for what no schema could have said."""

import json
import re

import schemathesis

# A schema says what members there are, of which type, how long, and in which range: then it has to.
SAYABLE = re.compile(r"unknown|missing|invalid (type|value|length)|elements: allowed|characters|is not (a|one of) ")
# JSON Schema takes 20.0 for a whole number, and this service does not.
WHOLE = re.compile(r"floating point `[0-9]+\.0(e[0-9]+)?`, expected a whole number")
OUT_OF_RANGE = re.compile(r"^(?:\w+ = )?(\S+) is out of range")
# Their ranges depend on the contact, on another member, or on whether the numbers of a move are increments.
DEPENDENT = (
    "reference_length", "cutoff_radius", "contact_radius", "indentation", "normal_force", "force", "displacement",
)
SEQUENCE = re.compile(r'"[0-9]{1,19}"|\*')


def at(body, pointer):
    """The member of a body at a JSON pointer; None if there is none."""
    for part in pointer.split("/")[1:]:
        try:
            body = body[int(part)] if isinstance(body, list) else body[part]
        except (KeyError, IndexError, TypeError, ValueError):
            return None
    return body


def is_sayable(fault, body):
    """Whether the document should have excluded this request."""
    detail, pointer = fault["detail"], fault["pointer"]
    if pointer.startswith("/base") or "for motion in the plane" in detail:
        # The base of a sweep is a simulation of which the axes may leave anything out; the tolerance of motion in the
        # plane has a range of its own, which depends on the path.
        return False
    found = OUT_OF_RANGE.match(detail)
    if not found:
        return SAYABLE.search(detail) is not None and WHOLE.search(detail) is None
    # What follows from several numbers is no number that was sent.
    sent = at(body, pointer)
    is_sent = isinstance(sent, (int, float)) and abs(sent - float(found[1])) <= 1e-6 * abs(sent)
    return is_sent and pointer.rsplit("/", 1)[-1] not in DEPENDENT


@schemathesis.check
def refused_for_a_reason(ctx, response, case):
    """A valid request that is answered with 422 says why, and no schema could have said so."""
    if response.status_code != 422 or case.meta is None:
        return
    parts = [case.meta.generation, *case.meta.components.values()]
    if not all(part.mode.is_positive for part in parts):
        return
    if not SEQUENCE.fullmatch(str(case.headers.get("If-Match", "*"))):
        # The coverage phase has a bare 0 among its valid values, which the pattern does not allow.
        return
    problem = json.loads(response.text)
    for fault in problem.get("errors", []):
        assert not is_sayable(fault, case.body), f"the document allows what is refused: {fault}"
