-- Version 4 of the tables: contacts that expired long ago are found by their time, and removed.

CREATE INDEX expired_by_time ON expired (at);
