-- Version 4 of the tables: contacts that expired long ago are found by their time, and removed; the labels of a tenant in
-- the order of its contacts, lowered as a search compares them.

CREATE INDEX expired_by_time ON expired (at);
CREATE INDEX contacts_by_label ON contacts (tenant, id, lower(label)) WHERE label IS NOT NULL;
