//! `stickslip demo`: the service with contacts to look at, and its page in a browser.

use std::ffi::OsStr;
use std::net::SocketAddr;
use std::process::{Command, Stdio};

use clap::Args;
use serde::Deserialize;
use serde_json::{Value, json};
use stickslip_compute::Flag;
use stickslip_compute::computations::{DisplayOptions, compute, entries};
use stickslip_compute::documents::Parse;
use stickslip_compute::formats::Format;
use stickslip_wire::session::Advance;
use stickslip_wire::{CreateRequest, ObservationsRequest, PathRequest};

use super::command_error::CommandError;
use super::io::{parsed, print};
use crate::sessions::Sessions;

/// A contact of each kind of profile that is stated by its numbers, with a path.
const CONTACTS: &str = include_str!("demo.json");

/// What opens an address in the browser of a desktop, on Linux and on macOS.
const OPENER: &str = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };

/// Where the demonstration listens, and whether it opens a browser.
#[derive(Args)]
pub struct Demo {
    /// Address and port to listen on; port 0 takes any free port.
    #[arg(long, env = "STICKSLIP_LISTEN", default_value = "127.0.0.1:8080")]
    pub listen: SocketAddr,
    /// Print the address of the page, and open no browser.
    #[arg(long)]
    no_browser: bool,
}

/// A contact, and the path that it is moved along.
#[derive(Deserialize)]
struct Scene {
    contact: Value,
    path: Value,
}

impl Demo {
    /// Creates the contacts.
    ///
    /// # Errors
    /// What a request was refused with.
    pub async fn create_contacts(&self, sessions: &Sessions) -> Result<(), String> {
        let scenes: Vec<Scene> = serde_json::from_str(CONTACTS).map_err(|error| error.to_string())?;
        for Scene { contact, path } in scenes {
            create(sessions, &contact, advance::<PathRequest>(&json!({"path": path, "steps": "last"}))?).await?;
        }
        let (request, mut reply) = fitted("profile")?;
        let mut contact = request["load"].clone();
        contact["profile"] = reply["profile"].take();
        contact["label"] = json!("ball, from a scan of its surface");
        let path = json!({"path": {"falling_amplitude": {"reversals": 20}}, "steps": "last"});
        create(sessions, &contact, advance::<PathRequest>(&path)?).await?;
        let (request, mut reply) = fitted("fit")?;
        let mut contact = reply["contact"].take();
        contact["label"] = json!("ball, fitted to a measured loop");
        create(sessions, &contact, advance::<ObservationsRequest>(&observations(&request["loops"][0]))?).await
    }

    /// Opens the page, where there is a desktop with a browser, and prints its address.
    ///
    /// # Errors
    /// The address cannot be printed.
    pub fn open_page(&self, page: &str) -> Result<(), String> {
        print(format_args!("open {page} in a browser; the contacts are in memory, and end with Ctrl-C"))?;
        let has = |variable| std::env::var_os(variable).is_some_and(|value| value.as_os_str() != OsStr::new(""));
        // Elsewhere, the program might start a browser of text on this terminal.
        let has_desktop = cfg!(target_os = "macos") || has("DISPLAY") || has("WAYLAND_DISPLAY");
        if !self.no_browser && has_desktop {
            let mut opener = Command::new(OPENER);
            opener.arg(page).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
            // Without one, the address that was printed is enough. Its end is awaited, so that it leaves no process.
            let _ = std::thread::Builder::new().name("browser".to_owned()).spawn(move || opener.status());
        }
        Ok(())
    }
}

/// The moves of a body.
fn advance<T: Parse<Checked = Advance>>(body: &Value) -> Result<Advance, String> {
    T::read(body.to_string().as_bytes()).map_err(refused)
}

/// What a request was refused with.
fn refused(error: impl Into<CommandError>) -> String {
    error.into().message(false)
}

/// Creates a contact and moves it.
async fn create(sessions: &Sessions, contact: &Value, moves: Advance) -> Result<(), String> {
    let creation = CreateRequest::read(contact.to_string().as_bytes()).map_err(refused)?;
    let made = sessions.create(creation, None).await.map_err(|error| error.to_string())?;
    let id = made.created.ok_or("no contact was created")?;
    sessions.apply(id, moves, None, None).await.map(drop).map_err(|error| error.to_string())
}

/// The first example of a computation that fits measured data, and its reply.
fn fitted(name: &str) -> Result<(Value, Value), String> {
    let entry = entries().into_iter().find(|entry| entry.about.name == name);
    let examples = entry.map(|entry| (entry.examples)()).unwrap_or_default();
    let example = examples.into_iter().next().ok_or_else(|| format!("{name} has no example"))?;
    let shown = DisplayOptions::in_format(Format::Columns);
    let reply = compute(name, example.value.to_string().as_bytes(), shown, &Flag::default());
    Ok((example.value, parsed(&reply.map_err(refused)?)?))
}

/// A measured loop in micrometres as observations of a contact.
fn observations(measured: &Value) -> Value {
    let column = |name: &str| measured[name].as_array().into_iter().flatten().filter_map(Value::as_f64);
    let rows = column("displacement").zip(column("force"));
    let rows = rows.map(|(displacement, force)| json!({"displacement": 1e-6 * displacement, "force": force}));
    json!({"observations": rows.collect::<Vec<_>>()})
}
