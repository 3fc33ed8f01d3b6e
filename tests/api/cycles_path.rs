//! A path of cycles on a stored contact. The rest is tested in `crates/compute/tests/documents/cycles_path.rs`.

use serde_json::{Value, json};

use crate::common::{Server, good, problem};

#[tokio::test]
async fn a_load_oscillates_about_that_of_the_contact_when_the_path_begins() {
    let server = Server::start().await;
    let (one, other) = (server.contact().await, server.contact().await);
    for id in [&one, &other] {
        good(server.post(&format!("/contacts/{id}/move"), &json!({"normal_force": 20.0})).await).await;
    }
    let post = async |id: &str, path: Value| server.post(&format!("/contacts/{id}/path"), &json!({"path": path})).await;
    let load =
        |size: f64| json!({"displacement": 1e-7, "count": 1, "points_per_cycle": 4, "normal": {"normal_force": size}});
    let cycles = |size: f64| json!({"cycles": load(size)});
    // More than the load at the beginning, though less than three times the preload.
    let refused = problem(post(&one, cycles(21.0)).await).await;
    assert_eq!(
        (refused.code.as_str(), refused.errors[0].pointer.as_str()),
        ("invalid_input", "/path/cycles/normal/normal_force")
    );
    assert!(refused.errors[0].detail.contains("0 to 20 N"), "{refused:?}");
    let moved = good(post(&one, cycles(15.0)).await).await;
    assert_eq!(moved["sequence"], 6, "the refused path has left no move");
    let moves = [(1e-7, 35.0), (0.0, 20.0), (-1e-7, 5.0), (0.0, 20.0), (1e-7, 35.0)]
        .map(|(displacement, load)| json!({"displacement": displacement, "normal_force": load}));
    assert_eq!(moved["steps"], good(post(&other, json!({"moves": moves})).await).await["steps"]);
}
