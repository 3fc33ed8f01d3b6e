-- Version 2 of the tables: what was measured at the displacement of a move, N, and when, in nanoseconds since 1970 (UTC). Both
-- are empty for a move without an observation, which takes no room for them.

ALTER TABLE moves ADD COLUMN observed_force double precision, ADD COLUMN observed_at bigint;
