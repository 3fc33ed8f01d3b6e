//! Tenants: a contact names its owner, and lists are separate.

use jiff::{SignedDuration, Timestamp};
use stickslip::store::{Page, Receipt, RequestKey, Session, Store, StoreError, Tenant, Usage};
use uuid::Uuid;

use crate::common::kill::exact;
use crate::fixtures::{receipt, records, session, snapshot, stored};

pub async fn a_session_is_its_tenants_for_ever(store: &dyn Store) {
    let tenants = [Tenant::new("north"), Tenant::new("South-2"), Tenant::new("south-2"), Tenant::default()];
    let before = session(None).id;
    let mut made: Vec<(Tenant, Uuid)> = Vec::new();
    for round in 0..3 {
        for tenant in &tenants {
            let new = Session { tenant: tenant.clone(), ..session(None) };
            store.create(new.clone(), None).await.unwrap();
            if round == 1 {
                store.append(new.id, 0, records(0, 2), None).await.unwrap();
                let copy = Session { tenant: tenant.clone(), sequence: 2, ..session(None) };
                store.fork(new.id, copy.clone(), None).await.unwrap();
                assert_eq!(exact(&store.find(copy.id).await.unwrap()), exact(&copy));
                made.push((tenant.clone(), copy.id));
            } else {
                assert_eq!(exact(&store.find(new.id).await.unwrap()), exact(&new));
            }
            assert_eq!(store.find(new.id).await.unwrap().tenant, *tenant);
            made.push((tenant.clone(), new.id));
        }
    }
    made.sort_by_key(|(_, id)| *id);
    for tenant in tenants.iter().map(Some).chain([None]) {
        let own = made.iter().filter(|(owner, _)| tenant.is_none_or(|tenant| owner == tenant)).map(|(_, id)| *id);
        let (mut seen, mut after) = (Vec::new(), Some(before));
        loop {
            let page = store.list(tenant.cloned(), None, Page::oldest(after, 3)).await.unwrap();
            assert!(page.len() <= 3);
            let Some(last) = page.last() else { break };
            after = Some(last.id);
            seen.extend(page.into_iter().map(|found| found.id));
        }
        assert_eq!(seen, own.collect::<Vec<_>>(), "{tenant:?}");
    }
    assert!(store.list(Some(Tenant::new("nobody")), None, Page::oldest(None, 10)).await.unwrap().is_empty());
}

pub async fn a_request_for_an_expired_contact_gets_its_tenant(store: &dyn Store) {
    let (stays, _) = stored(store, 0).await;
    let long_ago = Timestamp::now() - SignedDuration::from_hours(5);
    let old = |tenant: &str| Session {
        tenant: Tenant::new(tenant),
        created_at: long_ago,
        updated_at: long_ago,
        ..session(None)
    };
    let (theirs, nameless) = (old("north"), old(""));
    for made in [&theirs, &nameless] {
        store.create(made.clone(), None).await.unwrap();
    }
    assert_eq!(store.purge_expired(Some(long_ago + SignedDuration::from_hours(1))).await.unwrap(), 2);
    for gone in [theirs, nameless] {
        for refused in [
            store.find(gone.id).await.map(drop),
            store.extent(gone.id).await.map(drop),
            store.history(gone.id, 0, 1).await.map(drop),
            store.append(gone.id, 0, records(0, 1), None).await,
            store.delete(gone.id, 0).await,
        ] {
            assert!(matches!(&refused, Err(StoreError::Expired(tenant)) if *tenant == gone.tenant), "{refused:?}");
        }
    }
    store.find(stays.id).await.unwrap();
}

pub async fn what_a_tenant_takes_is_counted_apart_and_given_back(store: &dyn Store) {
    const MOVES: u64 = 1_000;
    // The name of one begins that of the other.
    let tenants = [Tenant::new("lab"), Tenant::new("lab-2"), Tenant::default()];
    let usage = async || {
        let [one, two, three] = tenants.each_ref().map(|tenant| store.usage(tenant));
        let all = futures::join!(one, two, three);
        [all.0.unwrap(), all.1.unwrap(), all.2.unwrap()]
    };
    let nothing = usage().await;
    for (index, tenant) in tenants.iter().enumerate() {
        let before = usage().await;
        let of_tenant = |key: &str| {
            let request = RequestKey { key: key.to_owned(), fingerprint: [7; 32] }.for_tenant(tenant);
            let kept = receipt(key, None, 1);
            Receipt { request, reply: stickslip::store::Reply { body: vec![b'x'; 5_000], ..kept.reply } }
        };
        let added = |from: [Usage; 3], to: [Usage; 3]| {
            for other in (0..3).filter(|other| *other != index) {
                assert_eq!(from[other], to[other], "of another tenant");
            }
            (to[index].contacts - from[index].contacts, to[index].bytes - from[index].bytes)
        };
        let made = Session { tenant: tenant.clone(), ..session(None) };
        store.create(made.clone(), None).await.unwrap();
        let definition = serde_json::to_string(&*made.definition).unwrap().len() as u64;
        let created = usage().await;
        let (contacts, bytes) = added(before, created);
        assert!(contacts == 1 && (definition..definition + 2_000).contains(&bytes), "{bytes}");

        store.append(made.id, 0, records(0, MOVES), None).await.unwrap();
        let moved = usage().await;
        assert_eq!(added(created, moved), (0, MOVES * store.move_bytes()));

        store.save_snapshot(made.id, snapshot(MOVES), None).await.unwrap();
        let saved = usage().await;
        assert_eq!(added(moved, saved), (0, snapshot(MOVES).state.len() as u64));

        let copy = Session { tenant: tenant.clone(), sequence: MOVES, ..session(None) };
        store.fork(made.id, copy.clone(), None).await.unwrap();
        let forked = usage().await;
        assert_eq!(added(saved, forked), (1, saved[index].bytes - before[index].bytes));

        store.append(made.id, MOVES, records(MOVES, MOVES + 1), Some(of_tenant("kept"))).await.unwrap();
        let kept = usage().await;
        let (contacts, bytes) = added(forked, kept);
        assert!(contacts == 0 && (5_000..6_000).contains(&(bytes - store.move_bytes())), "{bytes}");

        store.delete(copy.id, MOVES).await.unwrap();
        store.delete(made.id, MOVES + 1).await.unwrap();
        let (contacts, bytes) = added(before, usage().await);
        // The reply stays for retries.
        assert!(contacts == 0 && (5_000..6_000).contains(&bytes), "{bytes}");
    }
    assert!(nothing.iter().zip(usage().await).all(|(before, after)| before.contacts == after.contacts));
}
