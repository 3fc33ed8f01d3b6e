//! The native module of the Python package: computations, contacts, the command line and the server, without a process
//! or a copy of their own. Documents go in and come out as JSON text, arrays as arrays of NumPy; the Python side makes
//! objects of them. The command line and the server come with the feature `server`, on Linux alone.

#[cfg(all(feature = "server", target_os = "linux"))]
mod command;
mod compute;
mod contact;
mod contacts;
mod history;
mod import;
mod interrupt;
mod planar_contacts;
mod problem;
#[cfg(all(feature = "server", target_os = "linux"))]
mod server;
mod stepped;
mod sweep;
mod trace;

/// `stickslip._native`.
#[pyo3::pymodule]
mod _native {
    #[cfg(all(feature = "server", target_os = "linux"))]
    #[pymodule_export]
    use super::command::main;
    #[cfg(all(feature = "server", target_os = "linux"))]
    #[pymodule_export]
    use super::compute::openapi;
    #[pymodule_export]
    use super::compute::{compute, materials, names};
    #[pymodule_export]
    use super::contact::Contact;
    #[pymodule_export]
    use super::contacts::Contacts;
    #[pymodule_export]
    use super::import::{quantity, read_loop, read_scan};
    #[pymodule_export]
    use super::planar_contacts::PlanarContacts;
    #[pymodule_export]
    use super::problem::Problem;
    #[cfg(all(feature = "server", target_os = "linux"))]
    #[pymodule_export]
    use super::server::Server;
    #[pymodule_export]
    use super::sweep::Sweep;
    #[pymodule_export]
    use super::trace::{Trace, trace};
    /// The version of the package.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
