//! A contact as an FMU: the functions of FMI 2.0 for co-simulation, on the contacts of the C library.
//!
//! `stickslip fmu FILE --out ball.fmu` puts this library, the definition and modelDescription.xml into an archive. The
//! inputs are those at the end of a step; the contact moves straight to them, exactly, however long the step is. A
//! master with variable steps goes back by fmi2GetFMUstate and fmi2SetFMUstate, or by bytes.

#![allow(non_snake_case, clippy::missing_safety_doc)]

mod model;

use std::ffi::{CStr, CString, c_char, c_int, c_uint, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::ptr::null_mut;
use std::slice::{from_raw_parts, from_raw_parts_mut};

use model::{Resources, State};

/// Has the library carry its source, behind the mark that `stickslip fmu` looks for.
macro_rules! source {
    ($NAME:ident, $file:literal) => {
        #[used]
        static $NAME: &str = concat!("\0stickslip-fmu-", "source:", $file, "\n", include_str!($file), "\0");
    };
}

source!(LIB, "lib.rs");
source!(MODEL, "model.rs");

const OK: c_int = 0;
const DISCARD: c_int = 2;
const ERROR: c_int = 3;

type Logger = unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);

/// The functions of the master, of which this library uses the first.
#[repr(C)]
pub struct Callbacks {
    logger: Option<Logger>,
    allocate_memory: *const c_void,
    free_memory: *const c_void,
    step_finished: *const c_void,
    environment: *mut c_void,
}

/// An instance, which fmi2FreeInstance ends.
pub struct Instance {
    resources: Resources,
    state: State,
    /// Until fmi2ExitInitializationMode parameters may be set.
    initializing: bool,
    name: CString,
    logger: Option<Logger>,
    environment: *mut c_void,
}

impl Instance {
    fn log(&self, text: &str) {
        let (Some(logger), Ok(text)) = (self.logger, CString::new(text)) else { return };
        // SAFETY: the function of the master, called as FMI says; the text is printed by "%s".
        unsafe {
            logger(self.environment, self.name.as_ptr(), ERROR, c"error".as_ptr(), c"%s".as_ptr(), text.as_ptr());
        }
    }
}

/// Works on an instance: failures are logged and become `failed`; no panic leaves it.
///
/// # Safety
/// The pointer is NULL or one that fmi2Instantiate has returned and fmi2FreeInstance has not ended, used by one thread.
unsafe fn on(instance: *mut Instance, failed: c_int, work: impl FnOnce(&mut Instance) -> Result<(), String>) -> c_int {
    // SAFETY: as the caller promises.
    let Some(instance) = (unsafe { instance.as_mut() }) else { return ERROR };
    match catch_unwind(AssertUnwindSafe(|| work(instance))) {
        Ok(Ok(())) => OK,
        Ok(Err(text)) => {
            instance.log(&text);
            failed
        }
        Err(_) => {
            instance.log("internal error");
            ERROR
        }
    }
}

/// The text at a pointer.
///
/// # Safety
/// NULL, or a text that ends with a zero byte.
unsafe fn text(pointer: *const c_char) -> String {
    if pointer.is_null() {
        return String::new();
    }
    // SAFETY: as the caller promises.
    unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
}

/// The folder of a URI such as file:///tmp/x%20y/resources.
fn folder(uri: &str) -> PathBuf {
    let path = uri.strip_prefix("file:").unwrap_or(uri);
    let path = path.strip_prefix("//localhost").or_else(|| path.strip_prefix("//")).unwrap_or(path).as_bytes();
    let (mut bytes, mut at) = (Vec::new(), 0);
    while at < path.len() {
        let digits = path.get(at + 1..at + 3).and_then(|digits| std::str::from_utf8(digits).ok());
        match digits.filter(|_| path[at] == b'%').and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                at += 3;
            }
            None => {
                bytes.push(path[at]);
                at += 1;
            }
        }
    }
    PathBuf::from(String::from_utf8_lossy(&bytes).into_owned())
}

/// "default", the platform of the standard headers.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// "2.0".
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// An instance for co-simulation; NULL if the resources cannot be read, or are those of another archive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: c_int,
    guid: *const c_char,
    resources: *const c_char,
    callbacks: *const Callbacks,
    _visible: c_int,
    _logging: c_int,
) -> *mut Instance {
    const CO_SIMULATION: c_int = 1;
    // SAFETY: texts and callbacks of the master.
    let (name, guid, uri, callbacks) = unsafe { (text(name), text(guid), text(resources), callbacks.as_ref()) };
    let (logger, environment) = callbacks.map_or((None, null_mut()), |given| (given.logger, given.environment));
    let name = CString::new(name).unwrap_or_default();
    let made = catch_unwind(|| {
        let resources = Resources::read(&folder(&uri))?;
        let state = resources.start()?;
        if kind != CO_SIMULATION || guid != resources.guid {
            return Err("this FMU is for co-simulation, and the GUID that of its modelDescription.xml".to_owned());
        }
        Ok((resources, state))
    });
    let failure = match made {
        Ok(Ok((resources, state))) => {
            let instance = Instance { resources, state, initializing: true, name, logger, environment };
            return Box::into_raw(Box::new(instance));
        }
        Ok(Err(failure)) => failure,
        Err(_) => "internal error".to_owned(),
    };
    if let (Some(logger), Ok(failure)) = (logger, CString::new(failure)) {
        // SAFETY: as in `Instance::log`.
        unsafe { logger(environment, name.as_ptr(), ERROR, c"error".as_ptr(), c"%s".as_ptr(), failure.as_ptr()) };
    }
    null_mut()
}

/// Ends an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(instance: *mut Instance) {
    if !instance.is_null() {
        // SAFETY: from `Box::into_raw` of fmi2Instantiate, and not used again.
        drop(unsafe { Box::from_raw(instance) });
    }
}

/// Declares functions that change an instance and take values which are not read.
macro_rules! changes {
    ($($(#[$about:meta])* $name:ident($($unread:ty),*) $failed:ident $work:expr;)+) => {$(
        $(#[$about])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(instance: *mut Instance $(, _: $unread)*) -> c_int {
            // SAFETY: the instance of the master.
            unsafe { on(instance, $failed, $work) }
        }
    )+};
}

changes! {
    /// Failures are always logged.
    fmi2SetDebugLogging(c_int, usize, *const *const c_char) ERROR |_| Ok(());
    /// Time does not enter the law.
    fmi2SetupExperiment(c_int, f64, f64, c_int, f64) ERROR |_| Ok(());
    /// Inputs and parameters may be set.
    fmi2EnterInitializationMode() ERROR |_| Ok(());
    /// Makes the contact with them.
    fmi2ExitInitializationMode() ERROR |instance| {
        instance.resources.initialize(&mut instance.state)?;
        instance.initializing = false;
        Ok(())
    };
    /// Nothing is left to do.
    fmi2Terminate() ERROR |_| Ok(());
    /// Back to the state after fmi2Instantiate.
    fmi2Reset() ERROR |instance| {
        instance.state = instance.resources.start()?;
        instance.initializing = true;
        Ok(())
    };
    /// Moves the contact straight to the inputs; a step that is refused is discarded and has moved nothing.
    fmi2DoStep(f64, f64, c_int) DISCARD |instance| instance.resources.step(&mut instance.state);
    /// Steps end at once.
    fmi2CancelStep() ERROR |_| Err("no step is pending".to_owned());
}

/// The values of variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    instance: *mut Instance,
    references: *const c_uint,
    count: usize,
    values: *mut f64,
) -> c_int {
    let work = |instance: &mut Instance| {
        if count == 0 {
            return Ok(());
        }
        // SAFETY: arrays of the master of this length.
        let (references, values) = unsafe { (from_raw_parts(references, count), from_raw_parts_mut(values, count)) };
        for (reference, value) in references.iter().zip(values) {
            *value = instance.resources.get(&mut instance.state, *reference as usize)?;
        }
        Ok(())
    };
    // SAFETY: the instance of the master.
    unsafe { on(instance, ERROR, work) }
}

/// Sets inputs, and before the first step parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    instance: *mut Instance,
    references: *const c_uint,
    count: usize,
    values: *const f64,
) -> c_int {
    let work = |instance: &mut Instance| {
        if count == 0 {
            return Ok(());
        }
        // SAFETY: arrays of the master of this length.
        let (references, values) = unsafe { (from_raw_parts(references, count), from_raw_parts(values, count)) };
        let Instance { resources, state, initializing, .. } = instance;
        let mut pairs = references.iter().zip(values);
        pairs.try_for_each(|(reference, value)| resources.set(state, *reference as usize, *value, *initializing))
    };
    // SAFETY: the instance of the master.
    unsafe { on(instance, ERROR, work) }
}

/// Declares functions for variables and features that there are none of: no reference is accepted.
macro_rules! without {
    ($($(#[$about:meta])* $name:ident($($count:ident,)? $($unread:ty),*);)+) => {$(
        $(#[$about])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(instance: *mut Instance, _: *const c_uint, count: usize
            $(, _: $unread)*) -> c_int {
            // SAFETY: the instance of the master.
            unsafe { on(instance, ERROR, |_| if count == 0 { Ok(()) } else { Err("there are none".to_owned()) }) }
        }
    )+};
}

without! {
    /// There are no integers.
    fmi2GetInteger(*mut c_int);
    /// There are no integers.
    fmi2SetInteger(*const c_int);
    /// There are no truth values.
    fmi2GetBoolean(*mut c_int);
    /// There are no truth values.
    fmi2SetBoolean(*const c_int);
    /// There are no texts.
    fmi2GetString(*mut *const c_char);
    /// There are no texts.
    fmi2SetString(*const *const c_char);
    /// Inputs have no derivatives.
    fmi2SetRealInputDerivatives(*const c_int, *const f64);
    /// Outputs have no derivatives.
    fmi2GetRealOutputDerivatives(*const c_int, *mut f64);
    /// The law has no derivatives at turning points.
    fmi2GetDirectionalDerivative(*const c_uint, usize, *const f64, *mut f64);
}

/// Declares what is asked of pending steps, of which there are none.
macro_rules! statuses {
    ($($name:ident),+) => {$(
        /// No step is pending.
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(_: *mut Instance, _: c_int, _: *mut c_void) -> c_int {
            DISCARD
        }
    )+};
}

statuses! { fmi2GetStatus, fmi2GetRealStatus, fmi2GetIntegerStatus, fmi2GetBooleanStatus, fmi2GetStringStatus }

/// A copy of the state, in the place of an earlier one if there is one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(instance: *mut Instance, kept: *mut *mut Kept) -> c_int {
    let work = |instance: &mut Instance| {
        // SAFETY: a place of the master.
        let place = unsafe { kept.as_mut() }.ok_or("NULL")?;
        let state = Kept { state: instance.state.clone(), initializing: instance.initializing };
        // SAFETY: NULL, or from this function.
        match unsafe { place.as_mut() } {
            Some(kept) => *kept = state,
            None => *place = Box::into_raw(Box::new(state)),
        }
        Ok(())
    };
    // SAFETY: the instance of the master.
    unsafe { on(instance, ERROR, work) }
}

/// A state that a master keeps.
pub struct Kept {
    state: State,
    initializing: bool,
}

/// Goes back to a state, which stays the master's.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(instance: *mut Instance, kept: *mut Kept) -> c_int {
    let work = |instance: &mut Instance| {
        // SAFETY: from fmi2GetFMUstate.
        let kept = unsafe { kept.as_ref() }.ok_or("NULL")?;
        (instance.state, instance.initializing) = (kept.state.clone(), kept.initializing);
        Ok(())
    };
    // SAFETY: the instance of the master.
    unsafe { on(instance, ERROR, work) }
}

/// Ends a state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(_: *mut Instance, kept: *mut *mut Kept) -> c_int {
    // SAFETY: a place of the master, with NULL or a state of fmi2GetFMUstate.
    if let Some(place) = unsafe { kept.as_mut() }
        && !place.is_null()
    {
        // SAFETY: from `Box::into_raw`, and not used again.
        drop(unsafe { Box::from_raw(*place) });
        *place = null_mut();
    }
    OK
}

/// The bytes of a state: whether it initializes, then those of the model.
///
/// # Safety
/// NULL, or a state of fmi2GetFMUstate.
unsafe fn bytes_of(instance: &Instance, kept: *const Kept) -> Result<Vec<u8>, String> {
    // SAFETY: as the caller promises.
    let kept = unsafe { kept.as_ref() }.ok_or("NULL")?;
    let mut bytes = vec![u8::from(kept.initializing)];
    bytes.extend(instance.resources.serialize(&kept.state));
    Ok(bytes)
}

/// How many bytes a state has.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    instance: *mut Instance,
    kept: *const Kept,
    size: *mut usize,
) -> c_int {
    let work = |instance: &mut Instance| {
        // SAFETY: a state and a place of the master.
        let (bytes, size) = unsafe { (bytes_of(instance, kept)?, size.as_mut().ok_or("NULL")?) };
        *size = bytes.len();
        Ok(())
    };
    // SAFETY: the instance of the master.
    unsafe { on(instance, ERROR, work) }
}

/// Writes a state as bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    instance: *mut Instance,
    kept: *const Kept,
    place: *mut u8,
    size: usize,
) -> c_int {
    let work = |instance: &mut Instance| {
        // SAFETY: a state of the master.
        let bytes = unsafe { bytes_of(instance, kept) }?;
        if place.is_null() || bytes.len() > size {
            return Err(format!("the state has {} bytes", bytes.len()));
        }
        // SAFETY: so many bytes of the master.
        let places = unsafe { from_raw_parts_mut(place, size) };
        places[..bytes.len()].copy_from_slice(&bytes);
        Ok(())
    };
    // SAFETY: the instance of the master.
    unsafe { on(instance, ERROR, work) }
}

/// Makes a state of such bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    instance: *mut Instance,
    bytes: *const u8,
    size: usize,
    kept: *mut *mut Kept,
) -> c_int {
    let work = |instance: &mut Instance| {
        if bytes.is_null() || kept.is_null() || size == 0 {
            return Err("NULL".to_owned());
        }
        // SAFETY: so many bytes of the master.
        let (mark, bytes) = unsafe { from_raw_parts(bytes, size) }.split_first().ok_or("no bytes")?;
        let state = Kept { state: instance.resources.deserialize(bytes)?, initializing: *mark != 0 };
        // SAFETY: a place of the master.
        unsafe { *kept = Box::into_raw(Box::new(state)) };
        Ok(())
    };
    // SAFETY: the instance of the master.
    unsafe { on(instance, ERROR, work) }
}
