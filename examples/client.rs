//! The life of a contact with the typed client: `cargo run --example client -- [URL]`.

use futures::StreamExt as _;
use stickslip_wire::client::{Client, Error, Event, Options};
use stickslip_wire::{CreateRequest, Move, StressRequest};

const BALL: &str = r#"{
    "label": "from Rust",
    "profile": {"type": "sphere", "radius": 0.01},
    "material": {"bodies": [
        {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}
    ]},
    "friction": 0.3,
    "preload": {"normal_force": 10.0}
}"#;

#[tokio::main]
async fn main() -> Result<(), Box<dyn std::error::Error>> {
    let service = std::env::args().nth(1).unwrap_or_else(|| "http://localhost:8080".to_owned());
    for line in life(&service).await? {
        println!("{line}");
    }
    Ok(())
}

/// Creates a contact, moves it, reads it and deletes it; the results, line by line.
pub async fn life(service: &str) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let client = Client::new(service);
    let ball: CreateRequest = serde_json::from_str(BALL)?;
    let made = client.create(&ball, &Options::default()).await?;
    let mut lines = vec![format!("{} slips as a whole at {} N", made.id, made.contact.gross_slip_force)];

    // With an idempotency key a repeated move is made once.
    let once = Options { idempotency_key: Some("first-move".to_owned()), ..Options::default() };
    for _ in 0..2 {
        let moved = client.apply(made.id, &Move { force: Some(1.5), ..Move::default() }.into(), &once).await?;
        lines.push(format!("move {}: {:e} m", moved.sequence, moved.state.displacement.unwrap_or_default()));
    }

    // A refused move: the problem says where and why.
    let too_much = Move { force: Some(4.0), ..Move::default() };
    if let Err(Error::Problem(problem)) = client.apply(made.id, &too_much.into(), &Options::default()).await {
        lines.push(format!("{}: {}", problem.code, problem.detail));
    }

    let request = StressRequest { points: Some(3), ..StressRequest::default() };
    let stress = client.stress(made.id, &request, true).await?;
    lines.push(format!("shear stress: {:?} Pa", stress.stress.shear.unwrap_or_default()));

    let mut events = client.events(made.id, Some(0)).await?;
    if let Some(Event::State(state)) = events.next().await.transpose()? {
        lines.push(format!("event {}: {} N", state.sequence, state.state.force.unwrap_or_default()));
    }
    drop(events);
    client.delete(made.id, &Options::default()).await?;
    lines.push("deleted".to_owned());
    Ok(lines)
}
