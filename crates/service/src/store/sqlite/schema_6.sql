-- Version 6 of the tables: how long a move took, and what a state has besides if the bodies have memory.

ALTER TABLE moves ADD COLUMN duration REAL;
ALTER TABLE moves ADD COLUMN time REAL;
ALTER TABLE moves ADD COLUMN viscous_work REAL;

DROP VIEW history;
CREATE VIEW history AS
SELECT
    c.id AS contact,
    m.sequence,
    strftime('%Y-%m-%dT%H:%M:%fZ', m.at / 1e9, 'unixepoch') AS at,
    m.to_displacement,
    m.to_force,
    m.to_indentation,
    m.to_normal_force,
    m.relative,
    m.duration,
    m.tolerance,
    m.displacement,
    m.force,
    m.indentation,
    m.normal_force,
    m.contact_radius,
    m.stick_radius,
    m.regime,
    m.dissipated_energy,
    m.elastic_energy,
    m.memory_depth,
    m.time,
    m.viscous_work,
    m.observed_force,
    m.observed_force - m.force AS innovation,
    strftime('%Y-%m-%dT%H:%M:%fZ', m.observed_at / 1e9, 'unixepoch') AS observed_at,
    m.made_by
FROM contacts AS c
INNER JOIN moves AS m ON m.contact = c.number;
