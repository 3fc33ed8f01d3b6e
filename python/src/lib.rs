//! The native module of the Python package: computations, contacts, the command line and the server, without a process
//! or a copy of their own. Documents go in and come out as JSON text, arrays as bytes of `f64`; the Python side makes
//! objects of them.

mod command;
mod compute;
mod contact;
mod contacts;
mod import;
mod interrupt;
mod problem;
mod server;
mod sweep;

/// `stickslip._native`.
#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    use super::command::main;
    #[pymodule_export]
    use super::compute::{compute, names, openapi};
    #[pymodule_export]
    use super::contact::Contact;
    #[pymodule_export]
    use super::contacts::Contacts;
    #[pymodule_export]
    use super::import::{quantity, read_loop, read_scan};
    #[pymodule_export]
    use super::problem::Problem;
    #[pymodule_export]
    use super::server::Server;
    #[pymodule_export]
    use super::sweep::Sweep;
}
