-- Version 1 of the tables; `docs/storage.md` explains the columns. Once released it is frozen: what comes later is a script of
-- its own. Times are nanoseconds since 1970 (UTC), quantities are in SI units.

-- A definition, which may be long, stands last, so that reading the other columns need not pass it. How many moves a contact
-- has made is not repeated here: its last move says so, and a move writes one row.
CREATE TABLE contacts (
    number INTEGER PRIMARY KEY,
    id TEXT NOT NULL UNIQUE,
    label TEXT,
    tenant TEXT NOT NULL,
    created_at INTEGER NOT NULL,
    initial_updated_at INTEGER NOT NULL,
    inherited INTEGER NOT NULL,
    definition TEXT NOT NULL
) STRICT;
CREATE INDEX contacts_by_tenant ON contacts (tenant, id);

-- There is no foreign key to `contacts`: the moves of a deleted contact are removed after it, some at a time. SQLite stores
-- -0.0 as 0.0, and a replay must be exact: bit n of `negative_zeros` is set where the n-th number of the row is -0.0.
CREATE TABLE moves (
    contact INTEGER NOT NULL,
    sequence INTEGER NOT NULL,
    at INTEGER NOT NULL,
    to_displacement REAL,
    to_force REAL,
    to_indentation REAL,
    to_normal_force REAL,
    relative INTEGER NOT NULL,
    tolerance REAL NOT NULL,
    displacement REAL NOT NULL,
    force REAL NOT NULL,
    indentation REAL NOT NULL,
    normal_force REAL NOT NULL,
    contact_radius REAL NOT NULL,
    stick_radius REAL NOT NULL,
    regime TEXT NOT NULL,
    dissipated_energy REAL NOT NULL,
    elastic_energy REAL NOT NULL,
    memory_depth INTEGER NOT NULL,
    negative_zeros INTEGER NOT NULL,
    PRIMARY KEY (contact, sequence)
) STRICT, WITHOUT ROWID;

-- Replies that retries get again.
CREATE TABLE receipts (
    number INTEGER PRIMARY KEY,
    key TEXT NOT NULL UNIQUE,
    fingerprint BLOB NOT NULL,
    created TEXT,
    sequence INTEGER NOT NULL,
    body BLOB NOT NULL,
    at INTEGER NOT NULL
) STRICT;

-- Packed states for a replay to begin at.
CREATE TABLE snapshots (
    contact INTEGER PRIMARY KEY REFERENCES contacts (number) ON DELETE CASCADE,
    sequence INTEGER NOT NULL,
    state BLOB NOT NULL
) STRICT;

-- Contacts that have expired.
CREATE TABLE expired (
    id TEXT PRIMARY KEY,
    tenant TEXT NOT NULL,
    at INTEGER NOT NULL
) STRICT, WITHOUT ROWID;

-- Numbers whose moves belong to no contact: of a fork that is being copied (`forming`), or to be removed.
CREATE TABLE unowned (
    contact INTEGER PRIMARY KEY,
    forming INTEGER NOT NULL
) STRICT;

-- Jobs, and the results of their chunks.
CREATE TABLE jobs (
    number INTEGER PRIMARY KEY,
    id TEXT NOT NULL UNIQUE,
    tenant TEXT NOT NULL,
    created_at INTEGER NOT NULL,
    finished_at INTEGER,
    error TEXT,
    points INTEGER NOT NULL,
    chunk INTEGER NOT NULL,
    done INTEGER NOT NULL,
    failed INTEGER NOT NULL,
    bytes INTEGER NOT NULL,
    cost INTEGER NOT NULL,
    request TEXT NOT NULL
) STRICT;
CREATE TABLE job_chunks (
    job INTEGER NOT NULL REFERENCES jobs (number) ON DELETE CASCADE,
    chunk INTEGER NOT NULL,
    content BLOB NOT NULL,
    PRIMARY KEY (job, chunk)
) STRICT;

-- Views for people.
CREATE VIEW sessions AS
SELECT
    c.id,
    c.tenant,
    c.label,
    coalesce(m.sequence, 0) AS sequence,
    strftime('%Y-%m-%dT%H:%M:%fZ', c.created_at / 1e9, 'unixepoch') AS created_at,
    strftime('%Y-%m-%dT%H:%M:%fZ', iif(m.sequence > c.inherited, m.at, c.initial_updated_at) / 1e9, 'unixepoch')
        AS updated_at,
    c.definition
FROM contacts AS c
LEFT JOIN moves AS m
    ON m.contact = c.number AND m.sequence = (SELECT max(sequence) FROM moves WHERE contact = c.number);
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
    m.memory_depth
FROM contacts AS c
INNER JOIN moves AS m ON m.contact = c.number;
