//! The sign of a zero in the reply of a new contact.

use serde_json::json;

use crate::common::{Server, ball, with};

#[tokio::test]
async fn a_zero_of_a_new_contact_has_no_sign() {
    let server = Server::start().await;
    for friction in [0.0, 0.3] {
        let contact = with(ball(), "/friction", json!(friction));
        let text = server.post("/contacts", &contact).await.text().await.unwrap();
        assert!(text.contains("\"id\"") && !text.contains("-0.0"), "{text}");
    }
}
