-- Version 4 of the tables: idle contacts, and those that expired long ago, are found by an index. That of idle contacts has the
-- hour of their last move, so that a move within the hour changes no column of an index. The labels of a tenant are in the
-- order of its contacts, so that a search reads nothing else.

ALTER TABLE contacts ADD COLUMN active_hour timestamp
GENERATED ALWAYS AS (date_trunc('hour', updated_at AT TIME ZONE 'UTC')) STORED;
CREATE INDEX contacts_by_activity ON contacts (active_hour);
CREATE INDEX expired_by_time ON expired (at);
CREATE INDEX contacts_by_label ON contacts (tenant, id, label) WHERE label IS NOT NULL;
