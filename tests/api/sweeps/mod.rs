//! Sweeps: the same numbers as their points one by one, at once and as jobs, whatever happens to the processes.

mod jobs;
mod refusals;
mod survival;
mod tables;

use std::time::Duration;

use crate::common::{Server, ball};
use reqwest::{Method, Response};
use serde_json::{Value, json};

/// How long anything may take before a test gives up; nothing is measured by it.
const PATIENCE: Duration = Duration::from_secs(120);

/// The body of `POST /simulate` of the paper's figure 5, for 20 reversals.
fn base() -> Value {
    json!({"contact": ball(), "path": {"falling_amplitude": {"reversals": 20}}, "steps": "last", "residual": true})
}

/// A sweep that is stored in many chunks, each of which is soon done.
fn long(points: usize) -> Value {
    let mut base = base();
    base["contact"]["profile"] = json!({"type": "cone", "slope": 0.1});
    base["residual"] = json!(false);
    let span = json!({"from": 0.1, "to": 0.5, "count": points});
    json!({"base": base, "axes": [{"pointer": "/contact/friction", "linear": span}], "outputs": ["/steps/0/force"]})
}

/// A small sweep that is to be a job.
fn small_job() -> Value {
    json!({"base": base(), "axes": [{"pointer": "/contact/friction", "values": [0.1, 0.2]}],
        "outputs": ["/residual/max"], "job": true})
}

/// Waits until `look` finds something.
async fn until<T>(what: &str, mut look: impl AsyncFnMut() -> Option<T>) -> T {
    let found = async {
        loop {
            match look().await {
                Some(found) => break found,
                None => tokio::time::sleep(Duration::from_millis(20)).await,
            }
        }
    };
    tokio::time::timeout(PATIENCE, found).await.unwrap_or_else(|_| panic!("waited in vain until {what}"))
}

/// A server somewhere.
struct Place {
    base: String,
    http: reqwest::Client,
}

impl Place {
    fn at(base: &str) -> Place {
        Place { base: base.to_owned(), http: reqwest::Client::new() }
    }

    fn of(server: &Server) -> Place {
        Place::at(&server.base)
    }

    async fn send(&self, method: Method, path: &str, body: Option<&Value>, headers: &[(&str, &str)]) -> Response {
        let mut call = self.http.request(method, format!("{}{path}", self.base));
        for (name, value) in headers {
            call = call.header(*name, *value);
        }
        if let Some(body) = body { call.json(body) } else { call }.send().await.unwrap()
    }

    async fn post(&self, path: &str, body: &Value) -> Response {
        self.send(Method::POST, path, Some(body), &[]).await
    }

    async fn get(&self, path: &str) -> Response {
        self.send(Method::GET, path, None, &[]).await
    }

    /// Starts a job; its path.
    async fn start(&self, body: &Value) -> String {
        let response = self.post("/sweep", body).await;
        let status = response.status();
        assert_eq!(status, 202, "{}", response.text().await.unwrap());
        response.headers()["location"].to_str().unwrap().to_owned()
    }

    async fn job(&self, path: &str) -> Value {
        let response = self.get(path).await;
        assert_eq!(response.status(), 200, "{path}");
        response.json().await.unwrap()
    }

    /// How a job stands when it has ended.
    async fn ended(&self, path: &str) -> Value {
        until("the job ends", async || Some(self.job(path).await).filter(|job| job["state"] != "running")).await
    }

    /// The result of a job, exactly as it was sent.
    async fn result(&self, path: &str) -> String {
        let job = self.ended(path).await;
        assert_eq!((&job["state"], &job["progress"]["done"]), (&json!("done"), &job["progress"]["points"]), "{job}");
        self.get(job["result"].as_str().unwrap()).await.text().await.unwrap()
    }
}
