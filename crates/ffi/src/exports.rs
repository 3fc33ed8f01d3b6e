//! The functions of the library. `include/stickslip.h` is printed from this file: the comments are its manual.

#![allow(non_camel_case_types)]

use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr;
use std::slice;

use crate::contact::{Held, MOST_TURNING_POINTS, Target};
use crate::fault::{Fault, code_of, last};
use crate::handles;

/// Done.
pub const SS_OK: c_int = 0;
/// A pointer that is needed is NULL, or not aligned.
pub const SS_NULL: c_int = 1;
/// The handle names no contact: it was freed, or never made.
pub const SS_NO_CONTACT: c_int = 2;
/// Another thread is using this contact.
pub const SS_BUSY: c_int = 3;
/// The definition is not valid JSON, or no definition of a contact.
pub const SS_INVALID_DEFINITION: c_int = 4;
/// A number is out of its range, or the contact cannot do this. The contact is as before.
pub const SS_REFUSED: c_int = 5;
/// There is no trial to commit.
pub const SS_NO_TRIAL: c_int = 6;
/// The buffer is too small.
pub const SS_BUFFER: c_int = 7;
/// The bytes or numbers are not a state of such a contact by this version of the library.
pub const SS_INVALID_STATE: c_int = 8;
/// Contacts of this kind do not have this.
pub const SS_NOT_AVAILABLE: c_int = 9;
/// A fault of the library; the contact is lost. Please report the text.
pub const SS_INTERNAL: c_int = 10;

/// The load of a step: as it is; the number is not read.
pub const SS_CONSTANT_LOAD: c_int = 0;
/// The load of a step: an indentation, m; below zero the bodies are apart.
pub const SS_INDENTATION: c_int = 1;
/// The load of a step: a normal force, N.
pub const SS_NORMAL_FORCE: c_int = 2;

/// Nothing slipped in the last step.
pub const SS_STICK: c_int = 0;
/// An outer ring slipped.
pub const SS_PARTIAL_SLIP: c_int = 1;
/// All of the contact slipped.
pub const SS_GROSS_SLIP: c_int = 2;
/// There is no contact.
pub const SS_SEPARATED: c_int = 3;

/// A contact. The pointer is a handle: it is never followed, and one that has been freed is refused.
#[repr(C)]
pub struct ss_contact {
    _opaque: [u8; 0],
}

/// The state of a contact. Along a line the second components are zero.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ss_contact_state {
    /// Tangential displacement of the indenter, m.
    pub displacement: [f64; 2],
    /// Tangential force, N; a positive displacement gives a positive force.
    pub force: [f64; 2],
    /// Indentation, m; below zero a gap.
    pub indentation: f64,
    /// Normal force, N.
    pub normal_force: f64,
    /// Contact radius, m.
    pub contact_radius: f64,
    /// Radius of the part that did not slip in the last step, m.
    pub stick_radius: f64,
    /// Friction work since the start, J.
    pub dissipated_energy: f64,
    /// Elastic energy of the tangential deformation, J.
    pub elastic_energy: f64,
    /// Turning points of the slip history; zero in the plane.
    pub turning_points: usize,
    /// SS_STICK, SS_PARTIAL_SLIP, SS_GROSS_SLIP or SS_SEPARATED.
    pub regime: c_int,
}

/// A place to write to.
///
/// # Safety
/// A pointer that is neither NULL nor misaligned is one to a value that may be written, for as long as `'a`.
unsafe fn place<'a, T>(pointer: *mut T) -> Result<&'a mut T, Fault> {
    if pointer.is_null() || !pointer.is_aligned() {
        return Err(Fault::new(SS_NULL, "a pointer to write to is NULL or not aligned"));
    }
    // SAFETY: as the caller promises.
    Ok(unsafe { &mut *pointer })
}

/// The items at a pointer.
///
/// # Safety
/// A pointer that is neither NULL nor misaligned is one to so many items, which nobody writes to for as long as `'a`.
unsafe fn items<'a, T>(pointer: *const T, count: usize) -> Result<&'a [T], Fault> {
    check_items(pointer, count)?;
    // SAFETY: as the caller promises; the length has been checked.
    Ok(if count == 0 { &[] } else { unsafe { slice::from_raw_parts(pointer, count) } })
}

/// The items at a pointer, to be written to.
///
/// # Safety
/// As of [`items`], and nobody else reads them.
unsafe fn places<'a, T>(pointer: *mut T, count: usize) -> Result<&'a mut [T], Fault> {
    check_items(pointer, count)?;
    // SAFETY: as the caller promises; the length has been checked.
    Ok(if count == 0 { &mut [] } else { unsafe { slice::from_raw_parts_mut(pointer, count) } })
}

fn check_items<T>(pointer: *const T, count: usize) -> Result<(), Fault> {
    if count > 0 && (pointer.is_null() || !pointer.is_aligned()) {
        return Err(Fault::new(SS_NULL, "a pointer to numbers is NULL or not aligned"));
    }
    let fits = count.checked_mul(size_of::<T>()).is_some_and(|bytes| bytes <= isize::MAX as usize);
    fits.then_some(()).ok_or_else(|| Fault::new(SS_REFUSED, "no array is so long"))
}

/// Makes a contact with `make` and writes its handle, or NULL.
///
/// # Safety
/// As of [`place`].
unsafe fn made(contact: *mut *mut ss_contact, make: impl FnOnce() -> Result<Held, Fault>) -> c_int {
    code_of(|| {
        // SAFETY: as the caller promises.
        let place = unsafe { place(contact) }?;
        *place = ptr::null_mut();
        *place = ptr::without_provenance_mut(handles::insert(make()?)?);
        Ok(())
    })
}

/// The text of a definition.
///
/// # Safety
/// A pointer that is not NULL is one to a text that ends with a zero byte.
unsafe fn definition<'a>(json: *const c_char) -> Result<&'a [u8], Fault> {
    if json.is_null() {
        return Err(Fault::new(SS_NULL, "the definition is NULL"));
    }
    // SAFETY: as the caller promises.
    Ok(unsafe { CStr::from_ptr(json) }.to_bytes())
}

/// Makes the contact of a definition: the JSON text that POST /contacts takes, in UTF-8, ending with a zero byte. The
/// contact is at rest under its preload and moves along a line. The handle written to `contact` belongs to the caller,
/// who frees it by ss_free; it is NULL if the call fails.
///
/// # Safety
/// `json` is a text that ends with a zero byte, `contact` a place for one handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ss_contact_new(json: *const c_char, contact: *mut *mut ss_contact) -> c_int {
    // SAFETY: as the caller promises.
    unsafe { made(contact, || Held::line(definition(json)?)) }
}

/// Makes a contact that moves in the plane, solved by at most `rings` rings (4 to 160). As ss_contact_new.
///
/// # Safety
/// As of ss_contact_new.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ss_planar_new(json: *const c_char, rings: usize, contact: *mut *mut ss_contact) -> c_int {
    // SAFETY: as the caller promises.
    unsafe { made(contact, || Held::planar(definition(json)?, rings)) }
}

/// Makes a copy of a contact with its state, which shares what follows from the definition: so arrays of contacts are
/// made. The handle belongs to the caller, who frees it by ss_free.
///
/// # Safety
/// `copy` is a place for one handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ss_copy(contact: *const ss_contact, copy: *mut *mut ss_contact) -> c_int {
    // SAFETY: as the caller promises.
    unsafe { made(copy, || handles::with(contact.addr(), |held| Ok(held.clone()))) }
}

/// Ends a contact. NULL is no contact, and nothing is done.
#[unsafe(no_mangle)]
pub extern "C" fn ss_free(contact: *mut ss_contact) -> c_int {
    code_of(|| if contact.is_null() { Ok(()) } else { handles::remove(contact.addr()) })
}

/// A step that is committed, or on trial.
///
/// # Safety
/// As of ss_step.
unsafe fn step(
    contact: *mut ss_contact,
    on_trial: bool,
    (load, normal): (c_int, f64),
    displacement: *const f64,
    forces: *mut f64,
) -> c_int {
    code_of(|| {
        handles::with(contact.addr(), |held| {
            let count = held.components();
            // SAFETY: as the caller promises.
            let (displacement, forces) = unsafe { (items(displacement, count)?, places(forces, count + 1)?) };
            held.step(on_trial, Target { load, normal, displacement }, forces)
        })
    })
}

/// Moves a contact straight to a load and a displacement, and commits it. `load` says what `normal` is:
/// SS_CONSTANT_LOAD, SS_INDENTATION (m) or SS_NORMAL_FORCE (N; the contact moves to the indentation of this force).
/// `displacement` has one number, m, in the plane two. `forces` receives the normal and then the tangential force, N:
/// two numbers, in the plane three. A step that fails has moved nothing. A trial is discarded.
///
/// # Safety
/// `displacement` and `forces` have so many numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ss_step(
    contact: *mut ss_contact,
    load: c_int,
    normal: f64,
    displacement: *const f64,
    forces: *mut f64,
) -> c_int {
    // SAFETY: as the caller promises.
    unsafe { step(contact, false, (load, normal), displacement, forces) }
}

/// The forces that such a step would lead to, from the committed state on: for iterations of one time step. The trial
/// is kept until ss_commit, ss_revert, the next trial or the next step. As ss_step.
///
/// # Safety
/// As of ss_step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ss_trial(
    contact: *mut ss_contact,
    load: c_int,
    normal: f64,
    displacement: *const f64,
    forces: *mut f64,
) -> c_int {
    // SAFETY: as the caller promises.
    unsafe { step(contact, true, (load, normal), displacement, forces) }
}

/// Makes the state of the last trial the committed one.
#[unsafe(no_mangle)]
pub extern "C" fn ss_commit(contact: *mut ss_contact) -> c_int {
    code_of(|| handles::with(contact.addr(), Held::commit))
}

/// Discards the last trial, if there is one.
#[unsafe(no_mangle)]
pub extern "C" fn ss_revert(contact: *mut ss_contact) -> c_int {
    code_of(|| {
        handles::with(contact.addr(), |held| {
            held.revert();
            Ok(())
        })
    })
}

/// Steps `count` contacts of one kind, one after the other, each as ss_step does: contact i to `normal[i]` and to
/// its numbers of `displacement`; its forces follow those of contact i - 1. `normal` may be NULL under
/// SS_CONSTANT_LOAD.
/// Ends at the first contact that fails; `done` receives how many were stepped, and may be NULL. Threads may call it at
/// once for different contacts.
///
/// # Safety
/// `contacts` has `count` handles, `normal` as many numbers, `displacement` and `forces` as many times the numbers of
/// one contact.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ss_step_many(
    contacts: *const *mut ss_contact,
    count: usize,
    load: c_int,
    normal: *const f64,
    displacement: *const f64,
    forces: *mut f64,
    done: *mut usize,
) -> c_int {
    let mut stepped = 0;
    let code = code_of(|| {
        // SAFETY: as the caller promises.
        let contacts = unsafe { items(contacts, count) }?;
        let normals = if load == SS_CONSTANT_LOAD { 0 } else { count };
        // SAFETY: as the caller promises.
        let normal = unsafe { items(normal, normals) }?;
        let Some(first) = contacts.first() else { return Ok(()) };
        let components = handles::with(first.addr(), |held| Ok(held.components()))?;
        let too_many = || Fault::new(SS_REFUSED, "no array is so long");
        let numbers = count.checked_mul(components + 1).ok_or_else(too_many)?;
        // SAFETY: as the caller promises.
        let (all, forces) = unsafe { (items(displacement, numbers - count)?, places(forces, numbers)?) };
        let parts = all.chunks_exact(components).zip(forces.chunks_exact_mut(components + 1));
        for ((index, contact), (displacement, forces)) in contacts.iter().enumerate().zip(parts) {
            let target = Target { load, normal: normal.get(index).copied().unwrap_or(0.0), displacement };
            handles::with(contact.addr(), |held| {
                if held.components() != components {
                    return Err(Fault::new(SS_NOT_AVAILABLE, "the contacts of an array are of one kind"));
                }
                held.step(false, target, forces)
            })
            .map_err(|fault| Fault::new(fault.code, format!("contact {index}: {}", fault.text)))?;
            stepped += 1;
        }
        Ok(())
    });
    // SAFETY: as the caller promises.
    if let Ok(done) = unsafe { place(done) } {
        *done = stepped;
    }
    code
}

/// The committed state.
///
/// # Safety
/// `state` is a place for one state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ss_state(contact: *const ss_contact, state: *mut ss_contact_state) -> c_int {
    code_of(|| {
        // SAFETY: as the caller promises.
        let place = unsafe { place(state) }?;
        *place = handles::with(contact.addr(), |held| Ok(held.state()))?;
        Ok(())
    })
}

/// Normal stiffness and tangential stiffness, N/m, of the last trial or else of the committed state: two numbers. The
/// tangential one is that of a displacement that goes on upwards, or downwards if `direction` is negative. Not in the
/// plane.
///
/// # Safety
/// `stiffness` is a place for two numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ss_stiffness(contact: *const ss_contact, direction: c_int, stiffness: *mut f64) -> c_int {
    code_of(|| {
        // SAFETY: as the caller promises.
        let places = unsafe { places(stiffness, 2) }?;
        places.copy_from_slice(&handles::with(contact.addr(), |held| held.stiffness(direction))?);
        Ok(())
    })
}

/// Writes the committed state with its history as bytes, for a restart by the same version of the library on a machine
/// of the same kind. `length` receives how many there are: with a `capacity` of zero, `bytes` may be NULL and the call
/// only asks that.
///
/// # Safety
/// `bytes` is a place for `capacity` bytes, `length` one for a number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ss_pack(
    contact: *const ss_contact,
    bytes: *mut c_void,
    capacity: usize,
    length: *mut usize,
) -> c_int {
    code_of(|| {
        // SAFETY: as the caller promises.
        let (places, length) = unsafe { (places(bytes.cast::<u8>(), capacity)?, place(length)?) };
        let packed = handles::with(contact.addr(), |held| Ok(held.pack()))?;
        *length = packed.len();
        match places.get_mut(..packed.len()) {
            Some(places) => places.copy_from_slice(&packed),
            None if capacity == 0 => {}
            None => return Err(Fault::new(SS_BUFFER, format!("the state has {} bytes", packed.len()))),
        }
        Ok(())
    })
}

/// Makes the state that ss_pack has written the committed one. The contact has the definition of the one that was
/// packed; that is checked by its preload.
///
/// # Safety
/// `bytes` has `length` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ss_unpack(contact: *mut ss_contact, bytes: *const c_void, length: usize) -> c_int {
    code_of(|| {
        // SAFETY: as the caller promises.
        let bytes = unsafe { items(bytes.cast::<u8>(), length) }?;
        handles::with(contact.addr(), |held| held.unpack(bytes))
    })
}

/// Doubles of a history of bounded size.
fn fixed_length(turning_points: usize) -> Result<usize, Fault> {
    if turning_points > MOST_TURNING_POINTS {
        let text = format!("{turning_points} turning points: allowed are 0 to {MOST_TURNING_POINTS}");
        return Err(Fault::new(SS_REFUSED, text));
    }
    Ok(2 * turning_points + 4)
}

/// Writes the committed state in 2 `turning_points` + 4 doubles, for programs that keep so many for each contact.
/// `dropped`, which may be NULL, receives 1 if turning points were dropped, the smallest loops first: the force then
/// has an error, stays below friction times the normal force, and no cycle yields work. Otherwise it receives 0, and
/// the state is the same but for rounding. What slipped in the last step is not kept. Not in the plane.
///
/// # Safety
/// `numbers` is a place for so many doubles, `dropped` NULL or a place for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ss_packed_fixed(
    contact: *const ss_contact,
    turning_points: usize,
    numbers: *mut f64,
    dropped: *mut c_int,
) -> c_int {
    code_of(|| {
        // SAFETY: as the caller promises.
        let places = unsafe { places(numbers, fixed_length(turning_points)?) }?;
        let (packed, left_out) = handles::with(contact.addr(), |held| held.packed_fixed(turning_points))?;
        places.copy_from_slice(&packed);
        // SAFETY: as the caller promises.
        if let Ok(dropped) = unsafe { place(dropped) } {
            *dropped = c_int::from(left_out);
        }
        Ok(())
    })
}

/// Makes the state that ss_packed_fixed has written the committed one.
///
/// # Safety
/// `numbers` has 2 `turning_points` + 4 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ss_unpack_fixed(
    contact: *mut ss_contact,
    turning_points: usize,
    numbers: *const f64,
) -> c_int {
    code_of(|| {
        // SAFETY: as the caller promises.
        let numbers = unsafe { items(numbers, fixed_length(turning_points)?) }?;
        handles::with(contact.addr(), |held| held.unpack_fixed(numbers))
    })
}

/// What was wrong with the last call of this thread that failed: a text that belongs to the library and is valid until
/// the next failure of this thread.
#[unsafe(no_mangle)]
pub extern "C" fn ss_last_error() -> *const c_char {
    last()
}

/// The version of the library, such as "0.1.0": a text that is valid for ever. Within 0.x functions are added and none
/// is changed.
#[unsafe(no_mangle)]
pub extern "C" fn ss_version() -> *const c_char {
    const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(version) => version,
        Err(_) => panic!("a version has no zero bytes"),
    };
    VERSION.as_ptr()
}
