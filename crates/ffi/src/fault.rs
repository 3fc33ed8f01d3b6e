//! Why a call has failed: a code to return, and a text that the thread keeps until its next failure.

use std::any::Any;
use std::cell::RefCell;
use std::ffi::{CString, c_char, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};

use stickslip_mechanics::Error;

use crate::exports::{SS_INTERNAL, SS_OK, SS_REFUSED};

thread_local! {
    static LAST: RefCell<CString> = RefCell::default();
}

/// A failure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// One of the codes of [`crate::exports`].
    pub code: c_int,
    /// What is wrong, what is allowed.
    pub text: String,
}

impl Fault {
    /// A failure of this code.
    pub fn new(code: c_int, text: impl Into<String>) -> Fault {
        Fault { code, text: text.into() }
    }
}

impl From<Error> for Fault {
    fn from(error: Error) -> Fault {
        Fault::new(SS_REFUSED, error.to_string())
    }
}

/// The code of a call: no panic leaves it.
pub(crate) fn code_of(call: impl FnOnce() -> Result<(), Fault>) -> c_int {
    let result = catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|panic| Err(of_panic(&*panic)));
    let Err(Fault { code, text }) = result else { return SS_OK };
    let text = CString::new(text.replace('\0', " ")).unwrap_or_default();
    // A thread that ends has no text any more.
    let _ = LAST.try_with(|last| *last.borrow_mut() = text);
    code
}

fn of_panic(panic: &(dyn Any + Send)) -> Fault {
    let text = panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
    Fault::new(SS_INTERNAL, format!("internal error: {}", text.unwrap_or("unknown")))
}

/// The text of the last failure of this thread.
pub(crate) fn last() -> *const c_char {
    LAST.try_with(|last| last.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}
