-- Version 5 of the tables: the space that the kept replies of a tenant take is read from an index. The keys of a tenant with a
-- name begin with it and a space.

CREATE INDEX receipts_by_tenant ON receipts (substr(key, 1, instr(key, ' ')), octet_length(body) + 2 * octet_length(key));
