-- Version 2 of the tables: what was measured at the displacement of a move, N, and when, in nanoseconds since 1970 (UTC). Both
-- are empty for a move without an observation, which takes a byte for each.

ALTER TABLE moves ADD COLUMN observed_force REAL;
ALTER TABLE moves ADD COLUMN observed_at INTEGER;

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
    m.observed_force,
    m.observed_force - m.force AS innovation,
    strftime('%Y-%m-%dT%H:%M:%fZ', m.observed_at / 1e9, 'unixepoch') AS observed_at
FROM contacts AS c
INNER JOIN moves AS m ON m.contact = c.number;
