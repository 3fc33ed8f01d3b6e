//! Refusals as exceptions with the problem document that the service would send.

use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use stickslip_compute::Refusal;

create_exception!(_native, Problem, PyException, "A refusal; its argument is the problem document as JSON text.");

/// The request identifier of documents that no server has made.
const REQUEST_ID: &str = "in process";

/// The exception for a refusal.
pub fn refused(error: impl Into<Refusal>) -> PyErr {
    let mut refusal: Refusal = error.into();
    // There is no log.
    if let Some(cause) = refusal.cause.take() {
        refusal.detail = cause;
    }
    let document = refusal.document(REQUEST_ID);
    Problem::new_err(serde_json::to_string(&document).unwrap_or_else(|error| error.to_string()))
}
