//! A server in threads of this process, for notebooks and tests.

use std::net::SocketAddr;
use std::time::Duration;

use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use stickslip::admission::Pool;
use stickslip::api::{self, Access, App};
use stickslip::jobs::{self, Jobs};
use stickslip::server::OwnHosts;
use stickslip::sessions::{self, Sessions};
use stickslip::store;
use tokio::net::TcpListener;
use tokio::runtime::{Builder, Runtime};
use tokio::sync::oneshot;
use tokio::task::JoinHandle;

/// How long requests under way may delay the end.
const SHUTDOWN_TIMEOUT: Duration = Duration::from_secs(2);

/// A server on a free port of the loopback address, which ends with this process at the latest.
#[pyclass(module = "stickslip._native")]
pub struct Server {
    address: SocketAddr,
    running: Option<Running>,
}

struct Running {
    /// The process whose threads it has.
    process: u32,
    runtime: Runtime,
    stop: oneshot::Sender<()>,
    served: JoinHandle<()>,
}

#[pymethods]
impl Server {
    /// Opens the store of this URL and listens on a port, or on a free one if it is zero.
    #[new]
    fn new(py: Python<'_>, store: &str, port: u16) -> PyResult<Server> {
        py.detach(|| start(store, port)).map_err(PyOSError::new_err)
    }

    /// Where it listens.
    #[getter]
    fn url(&self) -> String {
        format!("http://{}", self.address)
    }

    /// Ends it; the second time this does nothing.
    fn stop(&mut self, py: Python<'_>) {
        let Some(running) = self.running.take().and_then(Running::own) else { return };
        let Running { runtime, stop, served, .. } = running;
        py.detach(|| {
            stop.send(()).ok();
            // What does not end in time is ended with the runtime.
            runtime.block_on(async { tokio::time::timeout(SHUTDOWN_TIMEOUT, served).await }).ok();
            runtime.shutdown_timeout(SHUTDOWN_TIMEOUT);
        });
    }
}

impl Running {
    /// It, in its own process. A forked child has a copy without its threads, for which to wait would be without end.
    fn own(self) -> Option<Running> {
        if self.process == std::process::id() {
            return Some(self);
        }
        std::mem::forget(self);
        None
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.running = self.running.take().and_then(Running::own);
    }
}

fn start(store: &str, port: u16) -> Result<Server, String> {
    let runtime = Builder::new_multi_thread().enable_all().build().map_err(|error| error.to_string())?;
    let store = runtime.block_on(store::open(store)).map_err(|error| error.to_string())?;
    let listener = runtime.block_on(TcpListener::bind(SocketAddr::from(([127, 0, 0, 1], port))));
    let listener = listener.map_err(|error| format!("cannot listen on port {port}: {error}"))?;
    let address = listener.local_addr().map_err(|error| error.to_string())?;
    let pool = Pool::with_defaults();
    let jobs = Jobs::new(store.clone(), pool.clone());
    let sessions = Sessions::new(store, pool.clone(), sessions::CAPACITY);
    runtime.spawn(jobs.clone().work(jobs::LEASE));
    let hosts = OwnHosts { listen: address, names: [].into(), origins: [].into() };
    let app = App { sessions, jobs, pool, access: Access { hosts: Some(hosts), ..Access::default() } };
    let (stop, stopped) = oneshot::channel::<()>();
    let served = runtime.spawn(async move {
        let stop = async move {
            stopped.await.ok();
        };
        // The listener is bound: what fails later is for the clients to see.
        api::serve(listener, app, stop).await;
    });
    Ok(Server { address, running: Some(Running { process: std::process::id(), runtime, stop, served }) })
}
