"""The client that openapi-python-client makes of the document, at work: create, move, look at the stress."""

import sys

from made import Client
from made.api.contacts import create_contact, get_contact, get_history, get_stress, move_contact, watch_contact
from made.api.simulation import run_sweep
from made.models import (
    Axis,
    CreateRequest,
    ElasticBody,
    Field,
    MaterialBodies,
    MoveRequest,
    NamedOutput,
    PreloadNormalForce,
    ProblemDocument,
    Rigid,
    SphereProfile,
    SphereProfileType,
    SweepRequest,
    SweepRequestBase,
)

RADIUS, LOAD, FRICTION = 0.01, 10.0, 0.3
YOUNG, POISSON = 2.1e11, 0.3

client = Client(base_url=sys.argv[1])
ball = CreateRequest(
    label="made by a machine",
    profile=SphereProfile(type_=SphereProfileType.SPHERE, radius=RADIUS),
    material=MaterialBodies(bodies=[ElasticBody(youngs_modulus=YOUNG, poisson_ratio=POISSON), Rigid.RIGID]),
    friction=FRICTION,
    preload=PreloadNormalForce(normal_force=LOAD),
)
made = create_contact.sync(client=client, body=ball)
assert made.label == "made by a machine" and made.sequence == 0, made

# Hertz, by hand: a^3 = 3 F R / (4 E*).
e_star = YOUNG / (1 - POISSON**2)
radius = (0.75 * LOAD * RADIUS / e_star) ** (1 / 3)
assert abs(made.contact.contact_radius / radius - 1) < 1e-12, made.contact

# Cattaneo, by hand: at F = mu F_N / 2 the stick radius is a (1/2)^(1/3).
moved = move_contact.sync(id=made.id, client=client, body=MoveRequest(force=0.5 * FRICTION * LOAD))
assert moved.sequence == 1 and moved.state.regime == "partial_slip", moved
assert abs(moved.state.stick_radius / radius - 0.5 ** (1 / 3)) < 1e-12, moved.state

# In the ring that slips the shear stress is mu p, and p is Hertz's.
radii = [0.9 * radius, 0.95 * radius]
found = get_stress.sync(id=made.id, client=client, radii=radii, fields=[Field.PRESSURE, Field.SHEAR])
largest = 1.5 * LOAD / (3.141592653589793 * radius**2)
for r, pressure, shear in zip(found.radius, found.pressure, found.shear, strict=True):
    assert abs(pressure / (largest * (1 - (r / radius) ** 2) ** 0.5) - 1) < 1e-9, found
    assert abs(shear / (FRICTION * pressure) - 1) < 1e-9, found

# A refusal is a typed document as well, with the place of the fault.
refused = move_contact.sync(id=made.id, client=client, body=MoveRequest(force=FRICTION * LOAD))
assert isinstance(refused, ProblemDocument) and refused.code == "force_exceeds_friction", refused
assert refused.errors[0].pointer == "", "the whole move"
assert get_contact.sync(id=made.id, client=client).sequence == 1
assert [item.sequence for item in get_history.sync(id=made.id, client=client).items] == [1]

# Events end after as many as are asked for, so that they can be read whole.
events = watch_contact.sync(id=made.id, client=client, last_event_id_header=0, limit=1)
assert events.startswith("id: 1\nevent: state\ndata: {") and events.count("data: ") == 1, events
# Columns of a sweep by names of their own. Gross slip begins at mu F_N.
contact = {name: value for name, value in ball.to_dict().items() if name != "label"}
table = run_sweep.sync(
    client=client,
    body=SweepRequest(
        base=SweepRequestBase.from_dict({"contact": contact, "path": {"displacement": [1e-8]}}),
        axes=[Axis(pointer="/contact/friction", name="mu", values=[0.1, 0.2])],
        outputs=[NamedOutput(pointer="/contact/gross_slip_force", name="limit")],
    ),
)
for friction, limit in zip(table.columns["mu"], table.columns["limit"], strict=True):
    assert abs(limit / (friction * LOAD) - 1) < 1e-12, table
print("the generated client works")
