//! A contact that follows a bench: observations are moves, stored and exported with what was measured, and the last
//! measured cycle says what the friction is.

use crate::common;

use std::pin::pin;
use std::sync::Arc;

use common::kill::{Random, exact};
use common::{PATIENCE, Server, along, create, problem};
use futures::StreamExt as _;
use reqwest::Method;
use serde_json::{Value, json};
use stickslip::store::{SqliteStore, Store};
use stickslip_mechanics::Contact;
use stickslip_wire::client::{Event, Options};
use stickslip_wire::{
    CreateRequest, Document as _, ForkRequest, Move, NewSession, NoFriction, Observation, ObservationsReply,
    ObservationsRequest, PathRequest, Steps,
};
use uuid::Uuid;

/// Measurements of a cycle.
const POINTS: usize = 20;

/// What a bench with this friction would measure, with a little noise, from the first loading on: so many cycles at
/// three times the displacement of gross slip that the contact has.
fn measured(friction: f64, cycles: usize) -> Vec<Observation> {
    let mut random = Random(5);
    let [amplitude, mut bench] = [create().friction, friction]
        .map(|friction| Contact::new(CreateRequest { friction, ..create() }.check().unwrap().setup).unwrap());
    (0..=POINTS * cycles)
        .map(|step| {
            let displacement =
                3.0 * amplitude.gross_slip_displacement() * (std::f64::consts::TAU * step as f64 / POINTS as f64).cos();
            bench.apply(&Move::displacement(displacement).step()).unwrap();
            Observation { displacement, force: bench.force() + 0.05 + 0.01 * random.number(), at: None }
        })
        .collect()
}

async fn contact(server: &Server) -> NewSession {
    server.client.create(&create(), &Options::default()).await.unwrap()
}

async fn observe(server: &Server, id: Uuid, observations: Vec<Observation>) -> ObservationsReply {
    server.client.observe(id, &ObservationsRequest { observations }, &Options::default()).await.unwrap()
}

#[tokio::test]
async fn observations_are_moves_with_what_was_measured_beside_them() {
    let server = Server::start().await;
    let (bench, twin) = (contact(&server).await, contact(&server).await);
    let at: jiff::Timestamp = "2026-03-01T12:00:00.123456789Z".parse().unwrap();
    let given = [(1e-7, 1.0, None), (-5e-8, -0.5, Some(at)), (2e-7, 2.5, Some(at))];
    let given = given.map(|(displacement, force, at)| Observation { displacement, force, at });
    let reply = observe(&server, bench.id, given.to_vec()).await;
    let moved = along(given.iter().map(|one| Move::displacement(one.displacement)).collect());
    let moved = PathRequest { steps: Steps::All, ..moved };
    let steps = server.client.path(twin.id, &moved, &Options::default()).await.unwrap().steps;
    assert_eq!((reply.id, reply.sequence, reply.items.len(), reply.friction), (bench.id, 3, 3, None));
    for ((item, given), state) in reply.items.iter().zip(&given).zip(&steps) {
        assert_eq!(exact(&(item.displacement, item.force)), exact(&(given.displacement, given.force)));
        assert_eq!(
            exact(&(item.predicted, item.innovation)),
            exact(&(state.force.unwrap(), given.force - state.force.unwrap()))
        );
    }
    let read = server.client.contact(bench.id).await.unwrap();
    assert_eq!(exact(&read.state), exact(&server.client.contact(twin.id).await.unwrap().state));

    let page = server.client.hysteresis_loop(bench.id, None, None, Some(2)).await.unwrap();
    let measured: Vec<_> = (0..7).map(|point| page.observed_force(point)).collect();
    assert_eq!(measured, [None, None, Some(1.0), None, Some(-0.5), None, Some(2.5)]);
    let csv = server.get(&format!("/contacts/{}/loop?format=csv", bench.id)).await.text().await.unwrap();
    let ends = reply.items.iter().map(|item| format!(",{:?},{:?},{:?},,", item.force, item.predicted, item.innovation));
    assert!(csv.lines().nth(1).unwrap().ends_with(",,,"), "{csv}");
    for (line, end) in csv.lines().skip(2).zip(ends) {
        assert!(line.ends_with(&end), "{line} {end}");
    }

    // In the history, its copy by a fork, and the events.
    server.client.apply(bench.id, &Move::displacement(0.0).into(), &Options::default()).await.unwrap();
    let copy = server.client.fork(bench.id, &ForkRequest::default(), &Options::default()).await.unwrap().id;
    let mut events = pin!(server.client.events(bench.id, Some(0)).await.unwrap());
    let history = server.client.history(copy, None, None).await.unwrap().items;
    assert_eq!(exact(&history), exact(&server.client.history(bench.id, None, None).await.unwrap().items));
    for (index, item) in history.iter().enumerate() {
        let event = tokio::time::timeout(PATIENCE, events.next()).await.unwrap().unwrap().unwrap();
        let Event::State(event) = event else { panic!("{event:?}") };
        assert_eq!(event.observation, item.observation);
        let Some(given) = given.get(index) else {
            assert_eq!(item.observation, None);
            continue;
        };
        let observed = item.observation.unwrap();
        let innovation = given.force - item.state.force.unwrap();
        assert_eq!((item.step, observed.at), (Move::displacement(given.displacement), given.at));
        let numbers = (observed.force, observed.predicted, observed.innovation);
        assert_eq!(exact(&numbers), exact(&(given.force, item.state.force.unwrap(), innovation)));
    }
}

#[tokio::test]
async fn bad_observations_are_refused_at_their_place_and_change_nothing() {
    let server = Server::start().await;
    let id = contact(&server).await.id;
    let path = format!("/contacts/{id}/observations");
    let good = json!({"displacement": 1e-7, "force": 1.0, "at": "2026-03-01T12:00:00Z"});
    let beside = |other: Value| json!({"observations": [good, other]}).to_string();
    let cases = [
        (json!({}).to_string(), "/observations"),
        (json!({"observations": []}).to_string(), "/observations"),
        (json!({"observations": vec![good.clone(); 100_001]}).to_string(), "/observations"),
        (beside(json!({"displacement": 1e-7})), "/observations/1/force"),
        (beside(json!({"displacement": 1e-7, "force": 1.0, "indentation": 1.0})), "/observations/1/indentation"),
        (beside(json!({"displacement": 1e-7, "force": 1.0, "at": "noon"})), "/observations/1/at"),
        (beside(json!({"displacement": 1e-7, "force": 1.0, "at": "2026-03-01T11:59:59.9Z"})), "/observations/1/at"),
        (beside(json!({"displacement": 1e-7, "force": 1.0, "at": "2400-01-01T00:00:00Z"})), "/observations/1/at"),
        // Millinewtons: no coefficient of friction is 120 at 10 N.
        (beside(json!({"displacement": 1e-7, "force": 1200.0})), "/observations/1/force"),
    ];
    for (body, pointer) in cases {
        let refused = problem(server.send(Method::POST, &path, Some(&body), &[]).await).await;
        assert_eq!((refused.status, refused.code.as_str()), (422, "invalid_input"), "{pointer}");
        assert_eq!(refused.errors.iter().map(|fault| fault.pointer.as_str()).collect::<Vec<_>>(), [pointer]);
    }
    let read = server.client.contact(id).await.unwrap();
    assert_eq!((read.sequence, exact(&read.state.displacement.unwrap())), (0, exact(&0.0)));
    let unknown = server.client.friction(id).await.unwrap();
    assert_eq!((unknown.friction, unknown.reason), (None, Some(NoFriction::NoCycle)));
}

#[tokio::test]
async fn a_replay_gives_the_same_state_and_the_same_estimate() {
    let store: Arc<dyn Store> = Arc::new(SqliteStore::in_memory().unwrap());
    let server = Server::start().await;
    let forgetful = Server::with(Arc::clone(&store), 0).await;
    let (made, other) = (contact(&server).await, contact(&forgetful).await);
    let mut last = None;
    for cycles in 1..=4 {
        let observations = measured(0.4, cycles);
        let reply = observe(&server, made.id, observations.clone()).await;
        let replayed = observe(&forgetful, other.id, observations).await;
        assert_eq!(exact(&replayed.items), exact(&reply.items));
        assert_eq!(exact(&replayed.friction), exact(&reply.friction));
        last = reply.friction;
    }
    assert!(last.is_some());
    // A server that has seen nothing of it reads the same.
    let fresh = Server::with(store, 0).await;
    for (server, id) in [(&server, made.id), (&forgetful, other.id), (&fresh, other.id)] {
        let friction = server.client.friction(id).await.unwrap();
        assert_eq!((friction.sequence, exact(&friction.friction)), (204, exact(&last)));
    }
    let states = (server.client.contact(made.id).await.unwrap(), fresh.client.contact(other.id).await.unwrap());
    assert_eq!(exact(&states.0.state), exact(&states.1.state));
}

/// From what a measured cycle the friction follows is tested in `crates/measured/tests/loops/cycle_friction.rs`.
#[tokio::test]
async fn an_estimate_needs_a_cycle_all_of_whose_moves_are_measured() {
    let server = Server::start().await;
    for unmeasured in [None, Some(50)] {
        let id = contact(&server).await.id;
        let mut last = None;
        for (index, observation) in measured(0.45, 3).into_iter().enumerate() {
            if Some(index) == unmeasured {
                let step = Move::displacement(observation.displacement);
                server.client.apply(id, &step.into(), &Options::default()).await.unwrap();
            } else {
                last = observe(&server, id, vec![observation]).await.friction;
            }
        }
        let estimated = server.client.friction(id).await.unwrap();
        assert_eq!(exact(&estimated.friction), exact(&last));
        assert_eq!(estimated.reason, last.is_none().then_some(NoFriction::NotMeasured));
        let Some(found) = last else {
            assert_eq!(unmeasured, Some(50), "the whole cycle has a friction");
            continue;
        };
        assert!(unmeasured.is_none() && found.interval[0] < 0.45 && 0.45 < found.interval[1], "{found:?}");
        assert_eq!((found.from, found.to), (1 + 2 * POINTS as u64, 1 + 3 * POINTS as u64));
    }
}
