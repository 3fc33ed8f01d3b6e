-- Version 5 of the tables: the space that the kept replies of a tenant take is read from an index alone. The keys of a tenant
-- with a name begin with it and a space.

ALTER TABLE receipts
    ADD COLUMN tenant text NOT NULL
        GENERATED ALWAYS AS (CASE WHEN strpos(key, ' ') > 0 THEN split_part(key, ' ', 1) ELSE '' END) STORED,
    ADD COLUMN bytes bigint NOT NULL GENERATED ALWAYS AS (octet_length(body) + 2 * octet_length(key)) STORED;
CREATE INDEX receipts_by_tenant ON receipts (tenant) INCLUDE (bytes);
