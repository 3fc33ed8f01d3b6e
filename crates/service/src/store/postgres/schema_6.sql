-- Version 6 of the tables: how long a move took, and what a state has besides if the bodies have memory.

ALTER TABLE moves
    ADD COLUMN duration double precision,
    ADD COLUMN time double precision,
    ADD COLUMN viscous_work double precision;
