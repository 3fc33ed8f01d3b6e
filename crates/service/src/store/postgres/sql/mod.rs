//! Every statement that is sent, by name. `docs/postgres.md` says which features of the database they need.

use stickslip_wire::ContactOrder;

// The channel of notifications of changes.
macro_rules! channel {
    () => {
        "stickslip_changes"
    };
}

// The columns of a move beside its contact and its stamp, in the order of `rows::record`.
macro_rules! move_columns {
    () => {
        "sequence, at, at_ns, target_displacement, target_force, target_indentation, target_normal_force, \
         target_twist, target_torque, relative, duration, tolerance, displacement, force, indentation, normal_force, \
         contact_radius, stick_radius, regime, dissipated_energy, elastic_energy, memory_depth, time, viscous_work, \
         twist, torque, observed_force, observed_at, made_by"
    };
}

// A statement that returns its `found`, and announces the identifiers in another part of it: as many as fit into the
// payload of one notification.
macro_rules! announcing {
    ($changed:literal, $($statement:expr),+) => {
        concat!($($statement,)+ ", announced AS (
    SELECT count(pg_notify('", channel!(), "', ids)) FROM (
        SELECT string_agg(id::text, ',') AS ids
        FROM (SELECT id, row_number() OVER () / 200 AS page FROM ", $changed, ") AS numbered GROUP BY page) AS paged
) SELECT found.* FROM found, announced")
    };
}

// Behind the macros, which it uses.
pub(super) mod jobs;

/// Bounds for every statement of a connection; and no notices, which only say that a table exists already. A lock is
/// waited for briefly: until the transactions of other processes are done that are under way, but not longer with a
/// connection. What a client that falls silent in the middle of a transaction holds is given back by the server, if the
/// client is there and says nothing, or if the network to it is gone; from PostgreSQL 17 on, no transaction lasts long.
pub(super) const PREPARE_CONNECTION: &str =
    "SET statement_timeout = '10s'; SET lock_timeout = '250ms'; SET client_min_messages = 'warning';
SET SESSION CHARACTERISTICS AS TRANSACTION ISOLATION LEVEL READ COMMITTED;
SET idle_in_transaction_session_timeout = '2s'; SET tcp_user_timeout = '10s'; SET tcp_keepalives_idle = 10;
SET tcp_keepalives_interval = 2; SET tcp_keepalives_count = 3;
SELECT set_config(name, '70s', false) FROM pg_settings WHERE name = 'transaction_timeout'";

/// For the statements that copy or delete all moves of a contact, and after them.
pub(super) const ALLOW_LONG: &str = "SET statement_timeout = '60s'";
pub(super) const ALLOW_SHORT: &str = "SET statement_timeout = '10s'";

/// Settings of the writer's connection. A statement of a batch is a transaction of its
/// own. To plan it for each batch takes as long as to execute it for a few contacts, so that its plan is kept; and
/// while the tables grow too, so that it uses their indexes however small they are.
pub(super) const PREPARE_WRITER: &str = "SET plan_cache_mode = force_generic_plan; SET enable_seqscan = off";

/// Makes sessions. Locks those to append to, in the order of their identifiers, but for those that another transaction
/// holds, and appends moves to those of them that are at the expected sequence, and last moved when they are expected
/// to have: a database that is put back from a dump may have another past of the same length. Stores the receipts of
/// what it has changed alone. Returns the sessions to append to that exist, with their sequences unless another
/// transaction holds them, and whether they were as expected.
pub(super) const BATCH: &str = announcing!(
    "won",
    "
WITH locked AS (
    SELECT id, sequence, updated_at, updated_ns FROM contacts WHERE id = ANY($1::uuid[]) ORDER BY id
    FOR NO KEY UPDATE SKIP LOCKED
), won AS (
    UPDATE contacts
    SET sequence = request.sequence,
        updated_at = coalesce(request.at, contacts.updated_at),
        updated_ns = coalesce(request.ns, contacts.updated_ns)
    FROM unnest($1::uuid[], $2::bigint[], $3::bigint[], $4::timestamptz[], $5::smallint[], $52::timestamptz[],
        $53::smallint[]) AS request (id, expected, sequence, at, ns, moved_at, moved_ns)
    JOIN locked ON locked.id = request.id AND locked.sequence = request.expected
        AND (request.moved_at IS NULL OR (locked.updated_at, locked.updated_ns) = (request.moved_at, request.moved_ns))
    WHERE contacts.id = locked.id
    RETURNING contacts.id
), moved AS (
    INSERT INTO moves (contact, ",
    move_columns!(),
    ", stamp)
    SELECT move.*
    FROM unnest($6::uuid[], $7::bigint[], $8::timestamptz[], $9::smallint[], $10::double precision[],
        $11::double precision[], $12::double precision[], $13::double precision[], $14::double precision[],
        $15::double precision[], $16::boolean[], $17::double precision[], $18::double precision[],
        $19::double precision[], $20::double precision[], $21::double precision[], $22::double precision[],
        $23::double precision[], $24::double precision[], $25::text[], $26::double precision[],
        $27::double precision[], $28::bigint[], $29::double precision[], $30::double precision[],
        $31::double precision[], $32::double precision[], $33::double precision[], $34::bigint[], $35::text[],
        $36::bigint[])
        AS move (contact)
    JOIN won ON won.id = move.contact
), made AS (
    INSERT INTO contacts (id, label, definition, sequence, created_at, created_ns, updated_at, updated_ns, tenant)
    SELECT * FROM unnest($43::uuid[], $44::text[], $45::text[], $46::bigint[], $47::timestamptz[], $48::smallint[],
        $49::timestamptz[], $50::smallint[], $51::text[])
    RETURNING id
), kept AS (
    INSERT INTO receipts (key, fingerprint, created, sequence, body)
    SELECT receipt.key, receipt.fingerprint, receipt.created, receipt.sequence, receipt.body
    FROM unnest($37::uuid[], $38::text[], $39::bytea[], $40::uuid[], $41::bigint[], $42::bytea[])
        AS receipt (contact, key, fingerprint, created, sequence, body)
    JOIN (SELECT id FROM won UNION ALL SELECT id FROM made) AS changed ON changed.id = receipt.contact
    ORDER BY receipt.key
), found AS (
    SELECT contacts.id, locked.sequence, won.id IS NOT NULL
    FROM contacts LEFT JOIN locked ON locked.id = contacts.id LEFT JOIN won ON won.id = contacts.id
    WHERE contacts.id = ANY($1::uuid[])
)"
);

/// Fails if the database has no notifications, or does not allow them to this role.
pub(super) const PROBE_NOTIFY: &str = concat!("SELECT pg_notify('", channel!(), "', '')");

pub(super) const LISTEN: &str = concat!("LISTEN ", channel!());

/// The outcome of a request: the sequence of its session, the tenant of an expired one, whether the key is taken, and
/// the stamp of the last move.
pub(super) const OUTCOME: &str = "
SELECT (SELECT sequence FROM contacts WHERE id = $1),
    (SELECT tenant FROM expired WHERE id = $1),
    EXISTS (SELECT 1 FROM receipts WHERE key = $2 AND created_at > now() - $3::double precision * INTERVAL '1 second'),
    (SELECT stamp FROM moves WHERE contact = $1 AND sequence = $4)";

/// Makes room for keys that may be used again.
pub(super) const DELETE_OLD_KEYS: &str = "
DELETE FROM receipts
WHERE key = ANY($1) AND created_at <= now() - $2::double precision * INTERVAL '1 second'";

/// Keeps a receipt under a key that no client can have: a change that needs what every change needs.
pub(super) const PROBE: &str = "
INSERT INTO receipts (key, fingerprint, sequence, body) VALUES ('', '', 0, '')
ON CONFLICT (key) DO UPDATE SET created_at = now()";

/// The time of the database.
pub(super) const NOW: &str = "SELECT clock_timestamp()";

/// Letters are stored as UTF-8.
pub(super) const ENCODING: &str = "SHOW server_encoding";

/// Checks that the database answers.
pub(super) const PING: &str = "";

pub(super) const FIND: &str = "
SELECT id, label, sequence, created_at, created_ns, updated_at, updated_ns, definition, tenant
FROM contacts WHERE id = $1";

pub(super) const EXTENT: &str = "
SELECT tenant, sequence, label, octet_length(definition)::bigint,
    coalesce((SELECT octet_length(state) FROM snapshots WHERE contact = contacts.id), 0)::bigint, updated_at, updated_ns
FROM contacts WHERE id = $1";

/// The contacts and bytes of a tenant. A contact takes `$2` bytes besides its definition and its snapshot, a move `$3`,
/// and a receipt `$4`. The lengths of values that are stored apart from their rows are known without reading them.
pub(super) const USAGE: &str = "
SELECT count(*), coalesce(sum($2::bigint + octet_length(definition) + $3::bigint * sequence
        + coalesce((SELECT octet_length(state) FROM snapshots WHERE contact = contacts.id), 0)), 0)::bigint
    + (SELECT coalesce(sum($4::bigint + bytes), 0)::bigint FROM receipts WHERE tenant = $1)
FROM contacts WHERE tenant = $1";

pub(super) const SEQUENCE: &str = "SELECT sequence FROM contacts WHERE id = $1";

pub(super) const EXPIRED: &str = "SELECT tenant FROM expired WHERE id = $1";

/// A page of sessions beyond the identifier `$1`, at most `$2`: of the tenant `$4`, or of all; of those whose label
/// contains `$3`, or of all.
pub(super) fn list(of_tenant: bool, labelled: bool, order: ContactOrder) -> String {
    let (beyond, order) = match order {
        ContactOrder::Oldest => (">", "ORDER BY id"),
        ContactOrder::Newest => ("<", "ORDER BY id DESC"),
    };
    let tenant = if of_tenant { "tenant = $4" } else { "$4::text = ''" };
    let which = format!("{tenant} AND id {beyond} $1");
    let which = if labelled {
        // The labels are in the index. In the collation C, `lower` changes ASCII letters alone.
        format!(
            r#"id IN (SELECT id FROM contacts WHERE {which} AND label IS NOT NULL
                AND strpos(lower(label COLLATE "C"), lower($3::text COLLATE "C")) > 0 {order} LIMIT $2)"#
        )
    } else {
        format!("{which} AND $3::text IS NULL")
    };
    format!(
        "SELECT id, label, sequence, created_at, created_ns, updated_at, updated_ns FROM contacts
        WHERE {which} {order} LIMIT $2"
    )
}

/// Names a session that is at a sequence and has a label, perhaps the new one by an earlier attempt, and keeps the
/// receipt. Returns, if the session exists, whether it was like that and free, its sequence, and whether it has one of
/// the labels.
pub(super) const RENAME: &str = "
WITH held AS (
    SELECT id FROM contacts
    WHERE id = $1 AND sequence = $3 AND (label IS NOT DISTINCT FROM $4 OR label IS NOT DISTINCT FROM $2)
    FOR NO KEY UPDATE SKIP LOCKED
), renamed AS (
    UPDATE contacts SET label = $2 FROM held WHERE contacts.id = held.id RETURNING contacts.id
), kept AS (
    INSERT INTO receipts (key, fingerprint, created, sequence, body)
    SELECT receipt.key, receipt.fingerprint, receipt.created, receipt.sequence, receipt.body
    FROM unnest($5::uuid[], $6::text[], $7::bytea[], $8::uuid[], $9::bigint[], $10::bytea[])
        AS receipt (contact, key, fingerprint, created, sequence, body)
    JOIN renamed ON renamed.id = receipt.contact
)
SELECT held.id IS NOT NULL, contacts.sequence,
    contacts.label IS NOT DISTINCT FROM $4 OR contacts.label IS NOT DISTINCT FROM $2
FROM contacts LEFT JOIN held ON held.id = contacts.id WHERE contacts.id = $1";

/// Keeps a receipt alone.
pub(super) const KEEP: &str = "
INSERT INTO receipts (key, fingerprint, created, sequence, body)
SELECT receipt.key, receipt.fingerprint, receipt.created, receipt.sequence, receipt.body
FROM unnest($1::uuid[], $2::text[], $3::bytea[], $4::uuid[], $5::bigint[], $6::bytea[])
    AS receipt (contact, key, fingerprint, created, sequence, body)";

/// The sequence of a contact, and some of its moves beside it: in one statement, so that both are of one state of the
/// database.
pub(super) const HISTORY: &str = concat!(
    "
SELECT contacts.sequence, past.*
FROM contacts LEFT JOIN LATERAL (
SELECT ",
    move_columns!(),
    "
FROM moves WHERE contact = $1 AND sequence > $2 ORDER BY sequence LIMIT $3) AS past ON true
WHERE contacts.id = $1 ORDER BY past.sequence"
);

pub(super) const COUNT_MOVES: &str = "SELECT count(*) FROM moves WHERE contact = $1 AND sequence <= $2";

pub(super) const RECEIPT: &str = "
SELECT fingerprint, created, sequence, body FROM receipts
WHERE key = $1 AND created_at > now() - $2::double precision * INTERVAL '1 second'";

pub(super) const SNAPSHOT: &str = "SELECT sequence, state FROM snapshots WHERE contact = $1";

pub(super) const SAVE_SNAPSHOT: &str = "
INSERT INTO snapshots (contact, sequence, state) SELECT id, $2::bigint, $3::bytea FROM contacts WHERE id = $1
ON CONFLICT (contact) DO UPDATE SET sequence = excluded.sequence, state = excluded.state
WHERE snapshots.sequence < excluded.sequence OR snapshots.sequence = $4::bigint";

/// Makes a session with the first `$2` moves of `$1` and with its snapshot, if that is not after them, unless there are
/// fewer; and keeps the receipt. Returns the sequence of `$1` and how many of these moves there are. No lock is needed:
/// moves are only appended.
pub(super) const FORK: &str = concat!(
    "
WITH source AS (
    SELECT sequence, (SELECT count(*) FROM moves WHERE contact = $1 AND sequence <= $2) AS moves
    FROM contacts WHERE id = $1
), made AS (
    INSERT INTO contacts (id, label, definition, sequence, created_at, created_ns, updated_at, updated_ns, tenant)
    SELECT copy.*
    FROM unnest($3::uuid[], $4::text[], $5::text[], $6::bigint[], $7::timestamptz[], $8::smallint[],
        $9::timestamptz[], $10::smallint[], $11::text[]) AS copy
    JOIN source ON source.sequence >= $2 AND source.moves = $2
    RETURNING id
), past AS (
    INSERT INTO moves (contact, ",
    move_columns!(),
    ", stamp)
    SELECT made.id, ",
    move_columns!(),
    ", stamp
    FROM moves, made WHERE moves.contact = $1 AND moves.sequence <= $2
), state AS (
    INSERT INTO snapshots (contact, sequence, state)
    SELECT made.id, sequence, state FROM snapshots, made WHERE snapshots.contact = $1 AND snapshots.sequence <= $2
), kept AS (
    INSERT INTO receipts (key, fingerprint, created, sequence, body)
    SELECT receipt.key, receipt.fingerprint, receipt.created, receipt.sequence, receipt.body
    FROM unnest($12::uuid[], $13::text[], $14::bytea[], $15::uuid[], $16::bigint[], $17::bytea[])
        AS receipt (contact, key, fingerprint, created, sequence, body)
    JOIN made ON made.id = receipt.contact
)
SELECT source.sequence, source.moves FROM source"
);

/// Deletes a session that is at a sequence, with its moves, which have all been committed then. Returns, if the session
/// exists, whether it was at that sequence and free, and its sequence.
pub(super) const DELETE: &str = announcing!(
    "gone",
    "
WITH held AS (
    SELECT id FROM contacts WHERE id = $1 AND sequence = $2 FOR UPDATE SKIP LOCKED
), gone AS (
    DELETE FROM contacts USING held WHERE contacts.id = held.id RETURNING contacts.id
), past AS (
    DELETE FROM moves USING held WHERE moves.contact = held.id
), found AS (
    SELECT held.id IS NOT NULL AS held, contacts.sequence
    FROM contacts LEFT JOIN held ON held.id = contacts.id WHERE contacts.id = $1
)"
);

/// Receipts past their time, some at a time. What another replica is deleting is left to it.
pub(super) const PURGE_RECEIPTS: &str = "
DELETE FROM receipts WHERE key IN (
    SELECT key FROM receipts WHERE created_at <= now() - $1::double precision * INTERVAL '1 second'
    ORDER BY created_at LIMIT $2 FOR UPDATE SKIP LOCKED)";

/// Marks of sessions that expired long ago, some at a time. What another replica is deleting is left to it.
pub(super) const PURGE_MARKS: &str = "
DELETE FROM expired WHERE id IN (
    SELECT id FROM expired WHERE at <= now() - $1::double precision * INTERVAL '1 second'
    ORDER BY at LIMIT $2 FOR UPDATE SKIP LOCKED)";

/// Sessions that have not moved since. Their order makes use of the index.
pub(super) const IDLE: &str = "
SELECT id FROM contacts
WHERE active_hour <= $1::timestamptz AT TIME ZONE 'UTC' AND (updated_at, updated_ns) < ($1, $2)
ORDER BY active_hour LIMIT $3";

/// Deletes the sessions that are still idle. Sessions that another replica moves or deletes meanwhile are skipped.
pub(super) const PURGE_IDLE: &str = announcing!(
    "found",
    "
WITH found AS (
    DELETE FROM contacts WHERE id IN (
        SELECT id FROM contacts WHERE id = ANY($1) AND (updated_at, updated_ns) < ($2, $3)
        ORDER BY id FOR UPDATE SKIP LOCKED)
    RETURNING id, tenant
), past AS (
    DELETE FROM moves WHERE contact IN (SELECT id FROM found)
), marked AS (
    INSERT INTO expired (id, tenant) SELECT id, tenant FROM found ON CONFLICT DO NOTHING
)"
);

/// Moves whose contact does not exist: a recursive query that reads one row of the index for each contact.
pub(super) const ORPHANED_MOVES: &str = "
WITH RECURSIVE owners (contact) AS (
    (SELECT contact FROM moves ORDER BY contact LIMIT 1)
    UNION ALL
    SELECT (SELECT moves.contact FROM moves WHERE moves.contact > owners.contact ORDER BY moves.contact LIMIT 1)
    FROM owners WHERE owners.contact IS NOT NULL
)
SELECT contact FROM owners
WHERE contact IS NOT NULL AND NOT EXISTS (SELECT 1 FROM contacts WHERE contacts.id = owners.contact)";

/// Kept replies that cannot be sent again, but for that of the probe.
pub(super) const RECEIPT_FAULTS: &str = "
SELECT 'the kept reply for the key ' || key || ' cannot be sent again' FROM receipts
WHERE key <> '' AND (octet_length(fingerprint) <> 32 OR sequence < 0 OR octet_length(body) = 0)";
