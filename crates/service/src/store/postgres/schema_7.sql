-- Version 7 of the tables: twist. While a contact is twisted, displacement and force are not stated, and stored as zero.

ALTER TABLE moves
    ADD COLUMN target_twist double precision,
    ADD COLUMN target_torque double precision,
    ADD COLUMN twist double precision,
    ADD COLUMN torque double precision;
