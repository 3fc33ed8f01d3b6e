//! Preparing profiles: work that is admitted, is done once for all who need the same profile, and counts.

use std::sync::Arc;

use crate::common::raw::{Service, post};
use crate::common::{Server, ball, good, metric, of, with};
use serde_json::{Value, json};
use stickslip::admission::Pool;
use stickslip::sessions::{CAPACITY, Sessions};
use stickslip::store::SqliteStore;

const MIB: usize = 1024 * 1024;

/// A ball with a table of so many points, each its own by `number`.
fn table(points: usize, number: usize) -> Value {
    let radius = 0.01 * (1.0 + 1e-3 * number as f64);
    let radii: Vec<_> = (0..points).map(|index| 1e-3 * index as f64 / points as f64).collect();
    let heights: Vec<_> = radii.iter().map(|r| r * r / (2.0 * radius)).collect();
    with(ball(), "/profile", json!({"type": "tabulated", "r": radii, "z": heights}))
}

fn load_curve(points: usize) -> Value {
    let depths: Vec<_> = (0..points).map(|index| 1e-6 * index as f64 / points as f64).collect();
    let forces: Vec<_> = depths.iter().map(|depth: &f64| 1e10 * depth.powf(1.5)).collect();
    let curve = json!({"type": "load_curve", "indentation": depths, "normal_force": forces});
    with(with(ball(), "/profile", curve), "/preload", json!({"indentation": 5e-7}))
}

fn moved(contact: &Value) -> Value {
    of(contact, &json!({"path": {"displacement": [1e-8]}}))
}

async fn prepared(server: &Server) -> u64 {
    metric(&server.base, "stickslip_profiles_prepared_total").await
}

#[tokio::test]
async fn requests_and_contacts_with_the_same_table_prepare_it_once() {
    let store = Arc::new(SqliteStore::in_memory().unwrap());
    let server = Server::with(store.clone(), CAPACITY).await;
    let first = good(server.post("/simulate", &moved(&table(200, 1))).await).await;
    let second = good(server.post("/simulate", &moved(&table(200, 1))).await).await;
    assert_eq!(first["steps"], second["steps"]);
    // Another friction, preload, material and question, and the same profile.
    let other = with(with(table(200, 1), "/friction", json!(0.7)), "/preload/normal_force", json!(5.0));
    let other = with(other, "/material", json!({"effective": {"e_star": 1e11, "g_star": 8e10}}));
    let id = good(server.post("/contacts", &other).await).await["id"].as_str().unwrap().to_owned();
    let drive = json!({"drive": {"displacement": 1e-8}});
    good(server.post("/cycle", &of(&other, &drive)).await).await;
    let axis = json!([{"pointer": "/contact/friction", "linear": {"from": 0.1, "to": 0.5, "count": 9}}]);
    let sweep = json!({"base": moved(&table(200, 1)), "axes": axis, "outputs": ["/steps/0/force"]});
    good(server.post("/sweep", &sweep).await).await;
    assert_eq!(prepared(&server).await, 1);
    assert_eq!(metric(&server.base, "stickslip_profiles_shared_total").await, 4);
    // Another process, to whom the contact is new, prepares it for the first who needs it.
    let restarted = Server::with(store, CAPACITY).await;
    good(restarted.post("/simulate", &moved(&table(200, 1))).await).await;
    good(restarted.get(&format!("/contacts/{id}")).await).await;
    assert_eq!((prepared(&restarted).await, metric(&restarted.base, "stickslip_profiles_shared_total").await), (1, 1));
    // One number apart, a shorter one, and one that begins as another ends.
    good(server.post("/simulate", &moved(&with(table(200, 1), "/profile/z/7", json!(6.15e-8)))).await).await;
    good(server.post("/simulate", &moved(&table(201, 1))).await).await;
    assert_eq!(prepared(&server).await, 3);
}

#[tokio::test]
async fn a_load_curve_is_shared_by_the_same_bodies_alone() {
    let server = Server::start().await;
    let soft = json!({"effective": {"e_star": 1e10, "g_star": 8e9}});
    let soft = with(load_curve(100), "/material", soft);
    let mut radii = Vec::new();
    for contact in [&load_curve(100), &soft, &load_curve(100), &soft] {
        radii.push(good(server.post("/simulate", &moved(contact)).await).await["contact"]["contact_radius"].clone());
    }
    assert_eq!(prepared(&server).await, 2);
    assert_eq!((&radii[0], &radii[1]), (&radii[2], &radii[3]));
    assert_ne!(radii[0], radii[1]);
}

#[tokio::test]
async fn many_profiles_and_contacts_stay_within_the_bound_of_the_cache() {
    let store = Arc::new(SqliteStore::in_memory().unwrap());
    let server = Server::with(store.clone(), MIB).await;
    let mut ids = Vec::new();
    for number in 0..20 {
        good(server.post("/simulate", &moved(&table(40, number))).await).await;
        ids.push(good(server.post("/contacts", &table(40, 100 + number)).await).await["id"].clone());
        let bytes = metric(&server.base, "stickslip_cache_bytes").await;
        assert!((160 * 1024..=MIB as u64).contains(&bytes), "{bytes}");
    }
    // The last are there, and the first are gone; to use one keeps it.
    let before = prepared(&server).await;
    assert_eq!(before, 40);
    good(server.post("/simulate", &moved(&table(40, 19))).await).await;
    assert_eq!(prepared(&server).await, before);
    good(server.post("/simulate", &moved(&table(40, 0))).await).await;
    assert_eq!(prepared(&server).await, before + 1);
    let first = ids[0].as_str().unwrap();
    good(server.post(&format!("/contacts/{first}/move"), &json!({"displacement": 1e-8})).await).await;
    assert_eq!(prepared(&server).await, before + 2);
    // Contacts that share one count it once: all of these fit, of which six would not.
    let sharing = Server::with(store, MIB).await;
    for _ in 0..50 {
        good(sharing.post("/contacts", &table(40, 7)).await).await;
    }
    assert_eq!((prepared(&sharing).await, metric(&sharing.base, "stickslip_cache_contacts").await), (1, 50));
    // Without a cache each request has its own.
    let bare = Server::with(Arc::new(SqliteStore::in_memory().unwrap()), 0).await;
    for _ in 0..2 {
        good(bare.post("/simulate", &moved(&table(40, 1))).await).await;
    }
    assert_eq!((prepared(&bare).await, metric(&bare.base, "stickslip_cache_bytes").await), (2, 0));
}

#[tokio::test]
async fn a_profile_is_prepared_with_a_turn_on_a_thread_of_the_solver() {
    let (store, pool) = (Arc::new(SqliteStore::in_memory().unwrap()), Pool::with_defaults());
    let server = Server::over(Sessions::new(store.clone(), pool.clone(), CAPACITY), pool.clone()).await;
    let turns = |pool: &Pool| pool.meters().wait.get_sample_count();
    // Few enough points that the body is parsed, and the simulation made, by whoever serves the connection.
    let (small, body) = (table(12, 1), moved(&table(12, 2)));
    assert!(body.to_string().len() < 1024);
    let before = turns(&pool);
    good(server.post("/simulate", &body).await).await;
    assert_eq!((prepared(&server).await, turns(&pool) - before), (1, 1));
    good(server.post("/simulate", &body).await).await;
    assert_eq!((prepared(&server).await, turns(&pool) - before), (1, 1), "a profile that is ready is no work");
    let id = good(server.post("/contacts", &small).await).await["id"].as_str().unwrap().to_owned();
    assert_eq!((prepared(&server).await, turns(&pool) - before), (2, 2));
    // So is that of a contact that is loaded from the store.
    let pool = Pool::with_defaults();
    let loading = Server::over(Sessions::new(store, pool.clone(), CAPACITY), pool.clone()).await;
    good(loading.get(&format!("/contacts/{id}")).await).await;
    assert_eq!((prepared(&loading).await, turns(&pool)), (1, 1));
}

#[tokio::test]
async fn a_profile_that_cannot_be_ready_in_time_is_refused_at_once_and_a_contact_of_it_too() {
    let service = Service::start(&["--deadline", "1s", "--log", "warn"]);
    let column = |number: &dyn Fn(usize) -> String| (0..10_000).map(number).collect::<Vec<_>>().join(",");
    let (r, z) = (column(&|index| format!("{index}e-7")), column(&|index| format!("{}e-9", index / 3)));
    let parts = vec![format!(r#"{{"type":"tabulated","r":[{r}],"z":[{z}]}}"#); 16].join(",");
    let profile = format!(r#"{{"type":"sum","parts":[{parts}]}}"#);
    let rest =
        r#""material":{"effective":{"e_star":1e11,"g_star":8e10}},"friction":0.3,"preload":{"normal_force":1.0}"#;
    let contact = format!(r#"{{"profile":{profile},{rest}}}"#);
    let simulation = format!(r#"{{"contact":{contact},"path":{{"displacement":[0.0]}}}}"#);
    for (place, body, pointer) in
        [("/simulate", simulation, "/contact/profile"), ("/contacts", contact.clone(), "/profile")]
    {
        let refused = service.ask("127.0.0.2", &post(place, &body)).await.unwrap();
        assert_eq!(refused.statuses, [422], "{}", refused.text);
        for part in ["too_much_work", &format!("\"pointer\":\"{pointer}\""), "preparing this profile is estimated at"] {
            assert!(refused.text.contains(part), "{part}: {}", refused.text);
        }
    }
}
