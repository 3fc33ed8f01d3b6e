//! Searches among many contacts, on the real binary: they hold up nobody else.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::common::raw::{Service, get};
use crate::common::{create, until};
use futures::future::join_all;
use rusqlite::Connection;
use stickslip_wire::client::Options;

const CONTACTS: usize = 100_000;
const CLIENTS: usize = 64;

#[tokio::test]
async fn searches_for_a_label_hold_up_no_other_reads() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("contacts.db");
    let store = format!("sqlite:{}", file.display());
    let id = {
        let service = Service::start_on(&store, &[]);
        let id = service.client.create(&create(), &Options::default()).await.unwrap().id;
        service.signal("TERM");
        // The file has no log once it is closed.
        until("it stops", async || (!file.with_extension("db-wal").exists()).then_some(())).await;
        id
    };
    let database = Connection::open(&file).unwrap();
    let copies = database.execute(
        "WITH RECURSIVE copies (n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM copies WHERE n < ?1)
         INSERT INTO contacts (id, label, tenant, created_at, initial_updated_at, inherited, definition)
         SELECT format('00000000-0000-7000-8000-%012x', n), 'bench ' || n, tenant, created_at, initial_updated_at, 0,
             definition
         FROM copies, contacts WHERE id = ?2",
        (CONTACTS as i64, id.to_string()),
    );
    assert_eq!(copies.unwrap(), CONTACTS);
    drop(database);
    let service = Arc::new(Service::start_on(&store, &["--max-contacts-per-tenant", "200000"]));
    let contact = get(&format!("/contacts/{id}"));
    // From now on it is cached.
    assert_eq!(service.ask("127.0.0.1", &contact).await.unwrap().statuses, [200]);
    let done = Arc::new(AtomicUsize::new(0));
    let searches = (0..CLIENTS).map(|_| {
        let (service, done) = (Arc::clone(&service), Arc::clone(&done));
        tokio::spawn(async move {
            let answer = service.ask("127.0.0.1", &get("/contacts?label=nothing")).await.unwrap();
            done.fetch_add(1, Ordering::Relaxed);
            assert!(answer.statuses == [200] && answer.text.contains(r#"{"items":[],"next":null}"#), "{}", answer.text);
        })
    });
    let searches: Vec<_> = searches.collect();
    until("a search ends", async || (done.load(Ordering::Relaxed) > 0).then_some(())).await;
    // All of the searches have been asked for before it.
    assert_eq!(service.ask("127.0.0.1", &contact).await.unwrap().statuses, [200]);
    let before = done.load(Ordering::Relaxed);
    println!("{before} of {CLIENTS} searches were done before a contact was read");
    for search in join_all(searches).await {
        search.unwrap();
    }
    assert!(before < CLIENTS / 2, "{before} of {CLIENTS} searches were done before a contact was read");
}
