//! What most tests begin with: a service, the steel ball of `crate::common`, and a browser.

use stickslip_wire::client::Options;
use stickslip_wire::{CreateRequest, Move, MoveRequest, NewSession, State};
use uuid::Uuid;

use crate::browser::Browser;
use crate::common::process::Process;

/// Whether the page follows the contact that it shows.
pub const LIVE: &str = "document.querySelector('.badge.on') !== null";
/// Whether all that moves the controls down has been shown.
pub const WARNED: &str = "!document.querySelector('#warned').hidden";
pub const NOT_A_NUMBER: &str = "This must be a number, without its unit and without separators of thousands.";

/// A service with a contact, and a browser.
pub struct Scene {
    pub server: Process,
    pub ball: NewSession,
    pub browser: Browser,
}

impl Scene {
    /// On a desk in the light.
    pub async fn start() -> Scene {
        Scene::over(Process::with("memory:", &[]), 1280, 900, false).await
    }

    pub async fn over(server: Process, width: u32, height: u32, dark: bool) -> Scene {
        let request = CreateRequest { label: Some("Steel ball".to_owned()), ..crate::common::create() };
        let ball = server.client.create(&request, &Options::default()).await.unwrap();
        Scene { server, ball, browser: Browser::start(width, height, dark).await }
    }

    /// Opens a view by what its address has behind `#/`.
    pub async fn view(&self, address: &str) {
        self.browser.page.goto(&format!("{}/#/{address}", self.server.base)).await.unwrap();
    }

    /// Opens a tab of a contact, and waits until the page follows the contact.
    pub async fn open(&self, session: &NewSession, tab: &str) {
        self.view(&format!("contacts/{}{tab}", session.id)).await;
        self.browser.until(LIVE).await;
    }

    /// The contact that the address names, once it is another one and followed.
    pub async fn shown(&self, other_than: Option<Uuid>) -> Uuid {
        let id = "location.hash.match(/contacts.([-0-9a-f]+)/)?.[1]";
        let before = other_than.map(|id| id.to_string()).unwrap_or_default();
        self.browser.until(&format!("{id} !== undefined && {id} !== {before:?} && {LIVE}")).await;
        self.browser.value(id).await.as_str().unwrap().parse().unwrap()
    }

    /// Moves the ball to parts of the displacement of gross slip.
    pub async fn moved(&self, parts: &[f64]) {
        for part in parts {
            self.apply(Move::displacement(part * self.ball.contact.gross_slip_displacement)).await;
        }
    }

    pub async fn apply(&self, step: Move) {
        self.server.client.apply(self.ball.id, &MoveRequest::from(step), &Options::default()).await.unwrap();
    }

    /// How many moves the ball has made, and its state.
    pub async fn now(&self) -> (u64, State) {
        let now = self.server.client.contact(self.ball.id).await.unwrap();
        (now.sequence, now.state)
    }

    /// Asserts that the browser logged nothing but lines with one of the `known` words, and asked the service alone.
    pub async fn end(self, known: &[&str]) {
        self.browser.stayed_quiet_and_at(&self.server.base, known).await;
        self.browser.close().await;
    }
}
