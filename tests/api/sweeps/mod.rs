//! Sweeps: the same table at once and as jobs, whatever happens to the processes.

mod jobs;
mod survival;
mod tables;

use crate::common::{Server, ball, until};
use serde_json::{Value, json};

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

impl Server {
    /// Starts a job; its path.
    async fn start_job(&self, body: &Value) -> String {
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

    /// A job once it has ended.
    async fn ended_job(&self, path: &str) -> Value {
        until("the job ends", async || Some(self.job(path).await).filter(|job| job["state"] != "running")).await
    }

    /// The result of a job, exactly as it was sent.
    async fn job_result(&self, path: &str) -> String {
        let job = self.ended_job(path).await;
        assert_eq!((&job["state"], &job["progress"]["done"]), (&json!("done"), &job["progress"]["points"]), "{job}");
        self.get(job["result"].as_str().unwrap()).await.text().await.unwrap()
    }
}
