//! The tables, and the way from an older version to the present one. `docs/storage.md` explains them to people.
//!
//! A version that has been released is frozen: what comes later is a step of its own at the end of [`VERSIONS`].

use rusqlite::Connection;

/// What makes a file one of ours: "stck" in the header.
pub(super) const APPLICATION: i32 = 0x7374_636b;

/// What leads from each version to the next; the first one from nothing.
const VERSIONS: [&str; 4] = [VERSION_1, VERSION_2, VERSION_3, VERSION_4];

/// The version that this program writes.
pub(super) const NEWEST: i32 = VERSIONS.len() as i32;

/// Sessions, their moves, and the replies that retries are owed.
///
/// Moves refer to sessions by a short number. There is no foreign key between them, as the past of a deleted session is
/// removed bit by bit after it. What a session's last move says is not repeated beside the session: a move writes one row.
/// A definition, which may be long, stands last, so that nobody else has to pass it.
const VERSION_1: &str = "
CREATE TABLE contacts (
    number INTEGER PRIMARY KEY,
    id TEXT NOT NULL UNIQUE,
    label TEXT,
    created_at INTEGER NOT NULL,
    initial_updated_at INTEGER NOT NULL,
    inherited INTEGER NOT NULL,
    definition TEXT NOT NULL
) STRICT;
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
CREATE TABLE receipts (
    number INTEGER PRIMARY KEY,
    key TEXT NOT NULL UNIQUE,
    fingerprint BLOB NOT NULL,
    created TEXT,
    sequence INTEGER NOT NULL,
    body BLOB NOT NULL,
    at INTEGER NOT NULL
) STRICT;
";

/// Snapshots, sessions that have expired, pasts without an owner, and views for people.
const VERSION_2: &str = "
CREATE TABLE snapshots (
    contact INTEGER PRIMARY KEY REFERENCES contacts (number) ON DELETE CASCADE,
    sequence INTEGER NOT NULL,
    state BLOB NOT NULL
) STRICT;
CREATE TABLE expired (
    id TEXT PRIMARY KEY,
    at INTEGER NOT NULL
) STRICT, WITHOUT ROWID;
CREATE TABLE unowned (
    contact INTEGER PRIMARY KEY,
    forming INTEGER NOT NULL
) STRICT;
CREATE VIEW sessions AS
SELECT
    c.id,
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
";

/// Tenants. What was there before belongs to the one without a name.
const VERSION_3: &str = "
ALTER TABLE contacts ADD COLUMN tenant TEXT NOT NULL DEFAULT '';
ALTER TABLE expired ADD COLUMN tenant TEXT NOT NULL DEFAULT '';
CREATE INDEX contacts_by_tenant ON contacts (tenant, id);
DROP VIEW sessions;
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
";

/// Jobs, and what came of their chunks.
const VERSION_4: &str = "
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
";

/// The version of a database; nought where there is nothing in it yet.
pub(super) fn version(connection: &Connection) -> rusqlite::Result<i32> {
    connection.pragma_query_value(None, "user_version", |row| row.get(0))
}

/// Brings the tables to the newest version, all of the way or not at all.
pub(super) fn migrate(connection: &mut Connection) -> rusqlite::Result<()> {
    let transaction = connection.transaction_with_behavior(rusqlite::TransactionBehavior::Immediate)?;
    let found = usize::try_from(version(&transaction)?).unwrap_or_default();
    for step in VERSIONS.iter().skip(found) {
        transaction.execute_batch(step)?;
    }
    if found < VERSIONS.len() {
        transaction.pragma_update(None, "application_id", APPLICATION)?;
        transaction.pragma_update(None, "user_version", NEWEST)?;
    }
    transaction.commit()
}

#[cfg(test)]
mod tests {
    use super::{NEWEST, migrate, version};
    use rusqlite::Connection;

    #[test]
    fn a_new_database_gets_every_version_and_the_views_can_be_read() {
        let mut connection = Connection::open_in_memory().unwrap();
        migrate(&mut connection).unwrap();
        migrate(&mut connection).unwrap();
        assert_eq!(version(&connection).unwrap(), NEWEST);
        for view in ["sessions", "history"] {
            assert!(!connection.prepare(&format!("SELECT * FROM {view}")).unwrap().exists([]).unwrap());
        }
    }
}
