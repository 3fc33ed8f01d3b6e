//! A Prometheus server for a test.

use std::process::{Child, Command, Stdio};

use serde_json::json;
use tempfile::TempDir;
use tokio::net::TcpSocket;

/// The message if it is not installed.
pub const MISSING: &str =
    "this test needs Prometheus: `./check` installs it, or on Debian `apt-get install prometheus`";

/// A real Prometheus that reads one server five times a second; killed when it is dropped.
pub struct Prometheus {
    child: Child,
    /// Where it answers.
    pub base: String,
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
        Prometheus { child, base: format!("http://127.0.0.1:{port}"), _reserved: reserved, _folder: folder }
    }
}

impl Drop for Prometheus {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
