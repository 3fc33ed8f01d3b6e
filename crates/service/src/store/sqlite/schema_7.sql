-- Version 7 of the tables: twist. While a contact is twisted, displacement and force are not stated, and stored as zero.

ALTER TABLE moves ADD COLUMN to_twist REAL;
ALTER TABLE moves ADD COLUMN to_torque REAL;
ALTER TABLE moves ADD COLUMN twist REAL;
ALTER TABLE moves ADD COLUMN torque REAL;

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
    m.to_twist,
    m.to_torque,
    m.relative,
    m.duration,
    m.tolerance,
    iif(m.twist IS NULL, m.displacement, NULL) AS displacement,
    iif(m.twist IS NULL, m.force, NULL) AS force,
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
    m.twist,
    m.torque,
    m.observed_force,
    m.observed_force - m.force AS innovation,
    strftime('%Y-%m-%dT%H:%M:%fZ', m.observed_at / 1e9, 'unixepoch') AS observed_at,
    m.made_by
FROM contacts AS c
INNER JOIN moves AS m ON m.contact = c.number;
