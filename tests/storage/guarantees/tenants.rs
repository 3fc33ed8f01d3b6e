//! Tenants: a contact names its owner, and lists are separate.

use jiff::{SignedDuration, Timestamp};
use stickslip::store::{Session, Store, StoreError, Tenant};
use uuid::Uuid;

use crate::common::kill::exact;
use crate::fixtures::{records, session, stored};

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
            let page = store.list(tenant.cloned(), None, after, 3).await.unwrap();
            assert!(page.len() <= 3);
            let Some(last) = page.last() else { break };
            after = Some(last.id);
            seen.extend(page.into_iter().map(|found| found.id));
        }
        assert_eq!(seen, own.collect::<Vec<_>>(), "{tenant:?}");
    }
    assert!(store.list(Some(Tenant::new("nobody")), None, None, 10).await.unwrap().is_empty());
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
            store.heading(gone.id).await.map(drop),
            store.history(gone.id, 0, 1).await.map(drop),
            store.append(gone.id, 0, records(0, 1), None).await,
            store.delete(gone.id, 0).await,
        ] {
            assert!(matches!(&refused, Err(StoreError::Expired(tenant)) if *tenant == gone.tenant), "{refused:?}");
        }
    }
    store.find(stays.id).await.unwrap();
}
