//! A kill loses no measurement that was acknowledged.

use crate::common;

use common::create;
use common::kill::exact;
use common::process::Process;
use stickslip_wire::client::Options;
use stickslip_wire::{Observation, ObservationsRequest};
use tempfile::tempdir;

#[tokio::test]
async fn observations_survive_a_kill() {
    let folder = tempdir().unwrap();
    let store = format!("sqlite:{}", folder.path().join("observed.db").display());
    let process = Process::start(&store).await;
    let id = process.client.create(&create(), &Options::default()).await.unwrap().id;
    let at = Some("2026-03-01T12:00:00.000000001Z".parse().unwrap());
    let observations = [1e-7, -2e-7, 5e-8].map(|displacement| Observation { displacement, force: -0.0, at });
    let request = ObservationsRequest { observations: observations.to_vec() };
    process.client.observe(id, &request, &Options::default()).await.unwrap();
    let before = process.client.history(id, None, None).await.unwrap().items;
    assert_eq!(before.iter().map(|item| item.observation.unwrap().at).collect::<Vec<_>>(), [at; 3]);
    process.kill().await;
    let process = Process::start(&store).await;
    assert_eq!(exact(&process.client.history(id, None, None).await.unwrap().items), exact(&before));
}
