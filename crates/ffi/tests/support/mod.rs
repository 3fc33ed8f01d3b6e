//! What the tests share.

#![allow(dead_code)]

use std::ffi::{CStr, CString};
use std::path::PathBuf;
use std::ptr::null_mut;

use stickslip_ffi::exports::*;

/// A steel ball on a rigid plane.
pub const BALL: &str = r#"{"profile": {"type": "sphere", "radius": 0.01},
    "material": {"bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]},
    "friction": 0.3, "preload": {"normal_force": 10.0}}"#;

/// It with other profiles.
pub fn definitions() -> Vec<String> {
    let profiles = [
        r#"{"type": "sphere", "radius": 0.01}"#,
        r#"{"type": "cone", "slope": 0.05}"#,
        r#"{"type": "truncated_cone", "slope": 0.05, "flat_radius": 5e-5}"#,
        r#"{"type": "flat_punch", "radius": 1e-4}"#,
        r#"{"type": "power_law", "exponent": 3.0, "coefficient": 1e5}"#,
    ];
    profiles.iter().map(|profile| BALL.replace(r#"{"type": "sphere", "radius": 0.01}"#, profile)).collect()
}

pub fn text(json: &str) -> CString {
    CString::new(json).unwrap()
}

/// The contact of a definition.
pub fn fresh(json: &str) -> *mut ss_contact {
    let (json, mut contact) = (text(json), null_mut());
    // SAFETY: a text, and a place for a handle.
    assert_eq!(unsafe { ss_contact_new(json.as_ptr(), &raw mut contact) }, SS_OK, "{}", failure());
    contact
}

/// The text of the last failure.
pub fn failure() -> String {
    // SAFETY: the text of the library, before the next failure.
    unsafe { CStr::from_ptr(ss_last_error()) }.to_str().unwrap().to_owned()
}

/// Bytes of memory that this process has.
pub fn resident_bytes() -> usize {
    let pages = std::fs::read_to_string("/proc/self/statm").unwrap();
    4096 * pages.split(' ').nth(1).unwrap().parse::<usize>().unwrap()
}

/// The folder with the libraries that were built for this test.
pub fn libraries() -> PathBuf {
    std::env::current_exe().unwrap().parent().unwrap().to_owned()
}
