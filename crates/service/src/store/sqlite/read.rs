//! The queries of readers. Each runs within one transaction, and so sees one state of the database.

use jiff::Timestamp;
use rusqlite::{Connection, params};
use uuid::Uuid;

use crate::store::rows::{self, RowReader as _};
use crate::store::{
    CONTACT_BYTES, Clock, Extent, IsSmall, Page, RECEIPT_LIFETIME, RECEIPT_OVERHEAD, Receipt, Record, Session,
    Snapshot, Tenant, Usage, Whole,
};
use stickslip_wire::{ContactOrder, SessionSummary};

use super::columns::{CONTACTS, MOVE_COLUMNS, SUMMARY_COLUMNS, all, clamped_nanoseconds, first, record, to_integer};
use super::fault::Fault;
use super::statements::{missing, number_and_sequence};

/// Sessions that one search for idle ones examines.
const IDLE_PAGE: usize = 1_000;

/// Whether the database can be read at all.
pub(super) fn alive(database: &Connection) -> Result<(), Fault> {
    Ok(database.prepare_cached("SELECT number FROM contacts LIMIT 1")?.exists([]).map(drop)?)
}

pub(super) fn find(database: &Connection, id: Uuid) -> Result<Session, Fault> {
    let sql = format!("SELECT {SUMMARY_COLUMNS}, c.definition, c.tenant FROM {CONTACTS} WHERE c.id = ?1");
    let found = first(database, &sql, [id.to_string()], |row| rows::session(row))?;
    found.ok_or_else(|| missing(database, id))
}

pub(super) fn extent(database: &Connection, id: Uuid) -> Result<Extent, Fault> {
    let sql = "SELECT tenant, (SELECT coalesce(max(sequence), 0) FROM moves WHERE contact = number), label,
                   octet_length(definition),
                   coalesce((SELECT octet_length(state) FROM snapshots WHERE contact = number), 0)
               FROM contacts WHERE id = ?1";
    first(database, sql, [id.to_string()], |row| rows::extent(row))?.ok_or_else(|| missing(database, id))
}

/// The extent of a session, and if that is small, the session with its moves.
pub(super) fn load(database: &Connection, id: Uuid, is_small: IsSmall) -> Result<(Extent, Option<Whole>), Fault> {
    let extent = extent(database, id)?;
    if !is_small(&extent) {
        return Ok((extent, None));
    }
    let most = usize::try_from(extent.sequence).unwrap_or(usize::MAX);
    let (session, moves) = (find(database, id)?, history(database, id, 0, most)?);
    Ok((extent, Some(Whole { session, moves })))
}

/// How many replies of a tenant are kept, and their bytes. All of it is in an index, with these very expressions.
const KEPT_REPLIES: &str = "
SELECT count(*), coalesce(sum(octet_length(body) + 2 * octet_length(key)), 0) FROM receipts
WHERE substr(key, 1, instr(key, ' ')) = ?1";

/// Bytes that a move takes in the file, with the longest name of a key and the unused part of its page.
pub(super) const MOVE_BYTES: u64 = 220;

pub(super) fn usage(database: &Connection, tenant: &Tenant) -> Result<Usage, Fault> {
    // The length of a text or blob is in the head of its row. SQLite reads no more for it.
    let sql = format!(
        "SELECT count(*), coalesce(sum({CONTACT_BYTES} + octet_length(definition)
             + {MOVE_BYTES} * coalesce((SELECT max(sequence) FROM moves WHERE contact = number), 0)
             + coalesce((SELECT octet_length(state) FROM snapshots WHERE contact = number), 0)), 0)
         FROM contacts WHERE tenant = ?1"
    );
    let stored = first(database, &sql, [tenant.name()], |row| Ok((row.count()?, row.count()?)))?;
    let (contacts, stored) = stored.unwrap_or_default();
    // The keys of a tenant with a name begin with it and a space.
    let prefix = if tenant.name().is_empty() { String::new() } else { format!("{} ", tenant.name()) };
    let kept = first(database, KEPT_REPLIES, [prefix], |row| Ok((row.count()?, row.count()?)))?;
    let (count, bytes) = kept.unwrap_or_default();
    Ok(Usage { contacts, bytes: stored + RECEIPT_OVERHEAD * count + bytes })
}

pub(super) fn list(
    database: &Connection,
    tenant: Option<&Tenant>,
    label: Option<&str>,
    page: Page,
) -> Result<Vec<SessionSummary>, Fault> {
    let after = page.after.map(|id| id.to_string());
    // Every identifier comes after the empty text and before this letter.
    let (after, beyond, order) = match page.order {
        ContactOrder::Oldest => (after.unwrap_or_default(), ">", ""),
        ContactOrder::Newest => (after.unwrap_or_else(|| "g".to_owned()), "<", "DESC"),
    };
    let of_tenant = if tenant.is_some() { "AND c.tenant = ?4" } else { "AND ?4 = ''" };
    // SQLite lowers ASCII letters alone. The index holds the lowered labels, so that no row is read for another label.
    let labelled = match label {
        Some(_) => "AND c.label IS NOT NULL AND instr(lower(c.label), lower(?3)) > 0",
        None => "AND ?3 IS NULL",
    };
    let sql = format!(
        "SELECT {SUMMARY_COLUMNS} FROM {CONTACTS} WHERE c.id {beyond} ?1 {of_tenant} {labelled}
         ORDER BY c.id {order} LIMIT ?2"
    );
    let tenant = tenant.map_or("", Tenant::name);
    let which = params![after, to_integer(page.limit as u64)?, label, tenant];
    Ok(all(database, &sql, which, |row| rows::summary(row))?)
}

pub(super) fn history(database: &Connection, id: Uuid, after: u64, limit: usize) -> Result<Vec<Record>, Fault> {
    let (number, last) = number_and_sequence(database, id)?;
    let Ok(from) = to_integer(after) else { return Ok(Vec::new()) };
    let sql =
        format!("SELECT {MOVE_COLUMNS} FROM moves WHERE contact = ?1 AND sequence > ?2 ORDER BY sequence LIMIT ?3");
    let page = all(database, &sql, [number, from, to_integer(limit as u64)?], record)?;
    rows::check_page(id, after, &page, limit, last)?;
    Ok(page)
}

pub(super) fn count_moves(database: &Connection, id: Uuid, end: u64) -> Result<u64, Fault> {
    let (number, _) = number_and_sequence(database, id)?;
    let sql = "SELECT count(*) FROM moves WHERE contact = ?1 AND sequence <= ?2";
    Ok(first(database, sql, [number, to_integer(end)?], |row| row.count())?.unwrap_or(0))
}

pub(super) fn receipt(database: &Connection, key: &str, clock: Clock) -> Result<Option<Receipt>, Fault> {
    let sql = "SELECT fingerprint, created, sequence, body FROM receipts WHERE key = ?1 AND at > ?2";
    let after = clamped_nanoseconds(clock.ago(RECEIPT_LIFETIME));
    Ok(first(database, sql, params![key, after], |row| rows::receipt(key, row))?)
}

pub(super) fn snapshot(database: &Connection, id: Uuid) -> Result<Option<Snapshot>, Fault> {
    let (number, _) = number_and_sequence(database, id)?;
    let sql = "SELECT sequence, state FROM snapshots WHERE contact = ?1";
    Ok(first(database, sql, [number], |row| rows::snapshot(row))?)
}

/// The sessions of a page that have not moved since a time, and where the next page begins, if there is one.
pub(super) fn idle(database: &Connection, since: Timestamp, after: i64) -> Result<(Vec<Uuid>, Option<i64>), Fault> {
    let sql = format!(
        "SELECT c.number, c.id, iif(m.sequence > c.inherited, m.at, c.initial_updated_at) < ?1 FROM {CONTACTS}
         WHERE c.number > ?2 ORDER BY c.number LIMIT ?3"
    );
    let page = all(database, &sql, [clamped_nanoseconds(since), after, IDLE_PAGE as i64], |row| {
        Ok((row.next()?, row.uuid()?, row.next::<bool>()?))
    })?;
    let next = page.last().filter(|_| page.len() == IDLE_PAGE).map(|(number, ..)| *number);
    Ok((page.into_iter().filter_map(|(_, id, is_idle)| is_idle.then_some(id)).collect(), next))
}

/// Faults of the file, and of data that belongs to no single session.
pub(super) fn check_integrity(database: &Connection) -> Result<Vec<String>, Fault> {
    let texts = |sql: &str| -> rusqlite::Result<Vec<String>> {
        database.prepare(sql)?.query_map([], |row| row.get(0))?.collect()
    };
    let mut found = texts("PRAGMA integrity_check(100)")?;
    found.retain(|line| line != "ok");
    // A recursive query that reads one row of the index for each contact.
    found.extend(texts(
        "WITH RECURSIVE owners (contact) AS (
             SELECT min(contact) FROM moves
             UNION ALL
             SELECT (SELECT min(contact) FROM moves WHERE contact > owners.contact) FROM owners
             WHERE contact IS NOT NULL)
         SELECT 'the moves of contact number ' || contact || ' belong to no contact' FROM owners
         WHERE contact IS NOT NULL AND contact NOT IN (SELECT number FROM contacts)
             AND contact NOT IN (SELECT contact FROM unowned)",
    )?);
    found.extend(texts(
        "SELECT 'the snapshot of contact number ' || contact || ' belongs to no contact' FROM snapshots
         WHERE contact NOT IN (SELECT number FROM contacts)",
    )?);
    // The last move of a session gives the number of its moves; the receipt of a reply is a second source.
    found.extend(texts(
        "WITH replies AS (
             SELECT CASE WHEN json_valid(CAST(body AS TEXT)) THEN CAST(body AS TEXT) ->> '$.id' END AS id,
                    max(sequence) AS sequence
             FROM receipts GROUP BY 1)
         SELECT 'contact ' || c.id || ': move ' || r.sequence || ' was acknowledged, and the last one stored is '
             || coalesce((SELECT max(sequence) FROM moves WHERE contact = c.number), 0)
         FROM replies AS r INNER JOIN contacts AS c ON c.id = r.id
         WHERE r.sequence > coalesce((SELECT max(sequence) FROM moves WHERE contact = c.number), 0)",
    )?);
    found.extend(texts(
        "SELECT 'the kept reply ' || number || ' cannot be sent again' FROM receipts
         WHERE length(fingerprint) <> 32 OR sequence < 0 OR NOT json_valid(CAST(body AS TEXT))",
    )?);
    found.extend(texts(JOB_FAULTS)?);
    Ok(found)
}

/// Jobs whose columns contradict each other or their chunks, and chunks of no job.
const JOB_FAULTS: &str = "
WITH stored AS (
    SELECT j.number, coalesce(sum(max(min(j.chunk, j.points - c.chunk * j.chunk), 0)), 0) AS computed,
        count(c.chunk) AS chunks, coalesce(min(c.chunk), 0) AS first, coalesce(max(c.chunk), 0) AS last
    FROM jobs AS j LEFT JOIN job_chunks AS c ON c.job = j.number GROUP BY j.number)
SELECT 'job ' || id || ': ' || done || ' points are counted as done, and ' || s.computed || ' are stored'
FROM jobs INNER JOIN stored AS s USING (number) WHERE done <> s.computed
UNION ALL
SELECT 'job ' || id || ': it has a chunk beyond its ' || points || ' points'
FROM jobs INNER JOIN stored AS s USING (number) WHERE s.chunks > 0 AND (s.first < 0 OR s.last * chunk >= points)
UNION ALL
SELECT 'job ' || id || ': it has ended at ' || done || ' of ' || points || ' points without an error'
FROM jobs WHERE finished_at IS NOT NULL AND error IS NULL AND done <> points
UNION ALL
SELECT 'job ' || id || ': all of its points are done, and it has not ended'
FROM jobs WHERE finished_at IS NULL AND done >= points
UNION ALL
SELECT 'job ' || id || ': of ' || done || ' points ' || failed || ' have no answer' FROM jobs
WHERE failed NOT BETWEEN 0 AND done
UNION ALL
SELECT 'job ' || id || ': its request is not JSON' FROM jobs WHERE NOT json_valid(request)
UNION ALL
SELECT 'the chunk ' || chunk || ' of job number ' || job || ' belongs to no job' FROM job_chunks
WHERE job NOT IN (SELECT number FROM jobs)";

#[cfg(test)]
mod tests {
    use rusqlite::Connection;

    use super::KEPT_REPLIES;
    use crate::store::sqlite::schema::{MIGRATIONS, migrate};

    #[test]
    fn the_space_of_kept_replies_is_read_from_an_index_alone() {
        let mut database = Connection::open_in_memory().unwrap();
        migrate(&mut database, MIGRATIONS).unwrap();
        let plan = format!("EXPLAIN QUERY PLAN {KEPT_REPLIES}");
        let plan: String = database.query_row(&plan, [""], |row| row.get(3)).unwrap();
        assert!(plan.contains("USING COVERING INDEX receipts_by_tenant"), "{plan}");
    }
}
