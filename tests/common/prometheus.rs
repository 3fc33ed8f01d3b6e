//! A Prometheus server for a test.

use std::process::{Child, Command, Stdio};

use serde_json::{Value, json};
use tempfile::TempDir;
use tokio::net::TcpSocket;

/// The message if it is not installed.
pub const MISSING: &str =
    "this test needs Prometheus: `./check` installs it, or on Debian `apt-get install prometheus`";

/// A real Prometheus that reads one server five times a second; killed when it is dropped.
pub struct Prometheus {
    child: Child,
    /// Where it answers.
    base: String,
    http: reqwest::Client,
    // Keeps the port while the server is not yet there, or away.
    _reserved: TcpSocket,
    _folder: TempDir,
}

impl Prometheus {
    pub fn start(target: &str) -> Prometheus {
        let folder = tempfile::tempdir().unwrap();
        let config = json!({"scrape_configs": [{"job_name": "stickslip", "scrape_interval": "200ms",
            "scrape_timeout": "200ms", "static_configs": [{"targets": [target]}]}]});
        let file = folder.path().join("prometheus.json");
        // JSON is YAML.
        std::fs::write(&file, config.to_string()).unwrap();
        let (port, reserved) = super::port::reserve();
        let child = Command::new("prometheus")
            .arg(format!("--config.file={}", file.display()))
            .arg(format!("--storage.tsdb.path={}", folder.path().join("data").display()))
            .arg(format!("--web.listen-address=127.0.0.1:{port}"))
            .arg("--log.level=error")
            .stdout(Stdio::null())
            .spawn()
            .expect(MISSING);
        let base = format!("http://127.0.0.1:{port}");
        Prometheus { child, base, http: reqwest::Client::new(), _reserved: reserved, _folder: folder }
    }

    /// What it answers; none while it is not yet there.
    pub async fn ask(&self, path: &str, questions: &[(&str, &str)]) -> Option<Value> {
        let call = self.http.get(format!("{}/api/v1/{path}", self.base)).query(questions);
        let reply: Value = call.send().await.ok()?.json().await.ok()?;
        assert_ne!(reply["errorType"], "bad_data", "{questions:?}: {reply}");
        (reply["status"] == "success").then(|| reply["data"].clone())
    }

    /// The samples that a query finds: their labels and values.
    pub async fn query(&self, questions: &[(&str, &str)]) -> Vec<(Value, f64)> {
        let data = self.ask("query", questions).await.unwrap_or_default();
        let value = |sample: &Value| sample["value"][1].as_str().unwrap().parse().unwrap();
        let found = data["result"].as_array().into_iter().flatten();
        found.map(|sample| (sample["metric"].clone(), value(sample))).collect()
    }
}

impl Drop for Prometheus {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
