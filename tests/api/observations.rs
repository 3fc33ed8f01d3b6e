//! A contact that follows a bench: observations are moves, stored and exported with what was measured, and the last
//! measured cycle says what the friction is.

use crate::common;

use std::pin::pin;
use std::sync::Arc;

use common::kill::{Random, exact};
use common::{PATIENCE, Server, create, problem};
use futures::StreamExt as _;
use reqwest::Method;
use serde_json::{Value, json};
use stickslip::store::{MemoryStore, Store};
use stickslip_wire::client::{Event, Options};
use stickslip_wire::{
    ForkRequest, Move, NewSession, Observation, ObservationsReply, ObservationsRequest, Path, PathRequest, Steps,
};
use uuid::Uuid;

/// The friction of the contact of the examples.
const FRICTION: f64 = 0.3;
/// Measurements of a cycle.
const POINTS: usize = 20;

/// A bench with another friction than the contact has: a ball (Cattaneo 1938, Mindlin 1949; Masing 1926).
struct Bench {
    /// Normal force, N.
    load: f64,
    /// Displacement of gross slip at the friction of the definition, m.
    unit: f64,
    /// Amplitude of the displacement, m.
    amplitude: f64,
    /// Force at rest, N.
    offset: f64,
    /// Standard deviation of the measured force over the friction force, roughly.
    noise: f64,
    random: Random,
}

impl Bench {
    /// A bench whose amplitude is so many times the displacement of gross slip at the friction of the definition.
    fn new(contact: &NewSession, amplitude: f64, noise: f64) -> Bench {
        let unit = contact.contact.gross_slip_displacement;
        let load = contact.contact.normal_force;
        Bench { load, unit, amplitude: amplitude * unit, offset: 0.05, noise, random: Random(5) }
    }

    /// The force on first loading.
    fn loading(&self, friction: f64, displacement: f64) -> f64 {
        let part = (displacement / (self.unit * friction / FRICTION)).min(1.0);
        friction * self.load * (1.0 - (1.0 - part).powf(1.5))
    }

    /// A cycle from the largest displacement to the smallest and back, its first point left out.
    fn cycle(&mut self, friction: f64) -> Vec<Observation> {
        (1..=POINTS).map(|step| self.measure(friction, step)).collect()
    }

    fn measure(&mut self, friction: f64, step: usize) -> Observation {
        let top = self.loading(friction, self.amplitude);
        let displacement = if step == POINTS {
            self.amplitude
        } else {
            self.amplitude * (std::f64::consts::TAU * step as f64 / POINTS as f64).cos()
        };
        let force = if step <= POINTS / 2 {
            top - 2.0 * self.loading(friction, 0.5 * (self.amplitude - displacement))
        } else {
            2.0 * self.loading(friction, 0.5 * (self.amplitude + displacement)) - top
        };
        // The sum of three is nearly normal, with a standard deviation of one.
        let noise = self.random.number() + self.random.number() + self.random.number();
        Observation { displacement, force: force + self.offset + self.noise * friction * self.load * noise, at: None }
    }

    /// The first loading, and so many cycles.
    fn cycles(&mut self, friction: f64, count: usize) -> Vec<Observation> {
        let begin = self.measure(friction, POINTS);
        std::iter::once(begin).chain((0..count).flat_map(|_| self.cycle(friction))).collect()
    }
}

async fn contact(server: &Server) -> NewSession {
    server.client.create(&create(), &Options::default()).await.unwrap()
}

async fn observe(server: &Server, id: Uuid, observations: Vec<Observation>) -> ObservationsReply {
    server.client.observe(id, &ObservationsRequest { observations }, &Options::default()).await.unwrap()
}

fn slide(displacement: Vec<f64>) -> PathRequest {
    PathRequest { path: Path::Displacement(displacement), stress: None, steps: Steps::All, tolerance: None }
}

#[tokio::test]
async fn observations_are_moves_with_what_was_measured_beside_them() {
    let server = Server::start().await;
    let (bench, twin) = (contact(&server).await, contact(&server).await);
    let at: jiff::Timestamp = "2026-03-01T12:00:00.123456789Z".parse().unwrap();
    let given = [(1e-7, 1.0, None), (-5e-8, -0.5, Some(at)), (2e-7, 2.5, Some(at))];
    let given = given.map(|(displacement, force, at)| Observation { displacement, force, at });
    let reply = observe(&server, bench.id, given.to_vec()).await;
    let moved = slide(given.iter().map(|one| one.displacement).collect());
    let steps = server.client.path(twin.id, &moved, &Options::default()).await.unwrap().steps;
    assert_eq!((reply.id, reply.sequence, reply.items.len(), reply.friction), (bench.id, 3, 3, None));
    for ((item, given), state) in reply.items.iter().zip(&given).zip(&steps) {
        assert_eq!(exact(&(item.displacement, item.force)), exact(&(given.displacement, given.force)));
        assert_eq!(exact(&(item.predicted, item.innovation)), exact(&(state.force, given.force - state.force)));
    }
    let read = server.client.contact(bench.id).await.unwrap();
    assert_eq!(exact(&read.state), exact(&server.client.contact(twin.id).await.unwrap().state));

    let page = server.client.hysteresis_loop(bench.id, None, None, Some(2)).await.unwrap();
    let measured: Vec<_> = (0..7).map(|point| page.observed_force(point)).collect();
    assert_eq!(measured, [None, None, Some(1.0), None, Some(-0.5), None, Some(2.5)]);
    let csv = server.get(&format!("/contacts/{}/loop?format=csv", bench.id)).await.text().await.unwrap();
    let ends = reply.items.iter().map(|item| format!(",{:?},{:?},{:?}", item.force, item.predicted, item.innovation));
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
        let innovation = given.force - item.state.force;
        assert_eq!((item.step, observed.at), (Move::displacement(given.displacement), given.at));
        let numbers = (observed.force, observed.predicted, observed.innovation);
        assert_eq!(exact(&numbers), exact(&(given.force, item.state.force, innovation)));
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
    assert_eq!((read.sequence, exact(&read.state.displacement)), (0, exact(&0.0)));
    assert_eq!(server.client.friction(id).await.unwrap().friction, None);
}

#[tokio::test]
async fn a_replay_gives_the_same_state_and_the_same_estimate() {
    let store: Arc<dyn Store> = Arc::new(MemoryStore::new());
    let server = Server::start().await;
    let forgetful = Server::with(Arc::clone(&store), 0).await;
    let (made, other) = (contact(&server).await, contact(&forgetful).await);
    let mut bench = Bench::new(&made, 3.0, 0.01);
    let mut last = None;
    for _ in 0..4 {
        let observations = bench.cycles(0.4, 1);
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
        assert_eq!((friction.sequence, exact(&friction.friction)), (84, exact(&last)));
    }
    let states = (server.client.contact(made.id).await.unwrap(), fresh.client.contact(other.id).await.unwrap());
    assert_eq!(exact(&states.0.state), exact(&states.1.state));
}

#[tokio::test]
async fn an_estimate_needs_a_measured_cycle_that_slides() {
    let server = Server::start().await;
    let friction = async |amplitude: f64, change: fn(usize, Observation) -> Option<Observation>| {
        let made = contact(&server).await;
        let observations = Bench::new(&made, amplitude, 0.005).cycles(0.45, 3);
        let mut last = None;
        for (index, observation) in observations.into_iter().enumerate() {
            if let Some(observation) = change(index, observation) {
                last = observe(&server, made.id, vec![observation]).await.friction;
            } else {
                let step = Move::displacement(observation.displacement);
                server.client.apply(made.id, &step.into(), &Options::default()).await.unwrap();
            }
        }
        assert_eq!(exact(&server.client.friction(made.id).await.unwrap().friction), exact(&last));
        last
    };
    let found = friction(3.0, |_, observation| Some(observation)).await.unwrap();
    assert!(found.interval[0] < 0.45 && 0.45 < found.interval[1], "{found:?}");
    assert!((found.value - 0.45).abs() < 0.005, "{found:?}");
    assert_eq!((found.from, found.to), (1 + 2 * POINTS as u64, 1 + 3 * POINTS as u64));
    // Two thirds of the displacement of gross slip at this friction; one move without a measurement; a force of zero.
    assert_eq!(friction(1.0, |_, observation| Some(observation)).await, None);
    assert_eq!(friction(3.0, |index, observation| (index != 50).then_some(observation)).await, None);
    assert_eq!(friction(3.0, |_, observation| Some(Observation { force: 0.0, ..observation })).await, None);
}

#[tokio::test]
async fn friction_that_wears_in_is_followed_within_a_tenth_of_its_change() {
    const CYCLES: usize = 2_000;
    const BATCH: usize = 100;
    let server = Server::start().await;
    let made = contact(&server).await;
    let mut bench = Bench::new(&made, 3.0, 0.01);
    let friction = |cycle: usize| 0.3 + 0.3 * (1.0 - (-4.0 * cycle as f64 / CYCLES as f64).exp());
    let begin = bench.measure(friction(0), POINTS);
    observe(&server, made.id, vec![begin]).await;
    let (mut total, mut covered) = (0.0, 0);
    for batch in 0..CYCLES / BATCH {
        let cycles = BATCH * batch..BATCH * (batch + 1);
        let last = friction(cycles.end - 1);
        let observations = cycles.flat_map(|cycle| bench.cycle(friction(cycle))).collect();
        let found = observe(&server, made.id, observations).await.friction.unwrap();
        let error = (found.value - last).abs();
        assert!(error < 0.03 && found.interval[1] - found.interval[0] < 0.03, "batch {batch}: {found:?} for {last}");
        total += error;
        covered += usize::from(found.interval[0] <= last && last <= found.interval[1]);
    }
    let batches = CYCLES / BATCH;
    assert!(total / (batches as f64) < 0.004, "{}", total / batches as f64);
    assert!(covered >= batches - 3, "{covered} of {batches}");
    assert_eq!(server.client.contact(made.id).await.unwrap().sequence, (CYCLES * POINTS + 1) as u64);
}
