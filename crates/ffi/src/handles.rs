//! Which contact a handle names.
//!
//! A handle is the number of a slot and how often the slot has been used before, in the bits of a pointer that nobody
//! follows. Slots are kept for the next contact when one is freed, so that an old handle finds a slot of another
//! generation: it is refused. A slot is locked while a call works on its contact.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError, TryLockError};

use crate::contact::Held;
use crate::exports::{SS_BUSY, SS_INTERNAL, SS_NO_CONTACT};
use crate::fault::Fault;

#[cfg(not(target_pointer_width = "64"))]
compile_error!("a handle needs pointers of 64 bits");

/// Slots of the first chunk; each further one has twice as many.
const FIRST_CHUNK: usize = 1024;
/// With so many chunks the number of a slot has 31 bits.
const CHUNKS: usize = 21;

struct Slot {
    /// Read before the lock, so that an old handle never makes the contact of another thread busy.
    generation: AtomicU32,
    contact: Mutex<Option<Held>>,
}

type Chunk = Box<[Slot]>;
type Locked = MutexGuard<'static, Option<Held>>;

static SLOTS: [OnceLock<Chunk>; CHUNKS] = [const { OnceLock::new() }; CHUNKS];
static FREE: Mutex<Free> = Mutex::new(Free { next: 0, slots: Vec::new() });

/// Slots without a contact: those from `next` on, and those that were used before.
struct Free {
    next: usize,
    slots: Vec<usize>,
}

/// The chunk of a slot, and its number there.
fn place(index: usize) -> (usize, usize) {
    let chunk = (index / FIRST_CHUNK + 1).ilog2();
    (chunk as usize, index - FIRST_CHUNK * ((1 << chunk) - 1))
}

fn free() -> MutexGuard<'static, Free> {
    FREE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Takes a contact in; returns its handle.
pub(crate) fn insert(contact: Held) -> Result<usize, Fault> {
    let mut free = free();
    let index = match free.slots.pop() {
        Some(index) => index,
        None => {
            free.next += 1;
            free.next - 1
        }
    };
    drop(free);
    let (chunk, offset) = place(index);
    let none = |_| Slot { generation: AtomicU32::new(1), contact: Mutex::new(None) };
    let slots = SLOTS
        .get(chunk)
        .ok_or_else(|| Fault::new(SS_INTERNAL, "there are too many contacts"))?
        .get_or_init(|| (0..FIRST_CHUNK << chunk).map(none).collect());
    let slot = &slots[offset];
    *slot.contact.lock().unwrap_or_else(PoisonError::into_inner) = Some(contact);
    Ok((slot.generation.load(Ordering::Acquire) as usize) << 32 | (index + 1))
}

/// The slot of a handle, and its contact, locked.
fn slot(handle: usize) -> Result<(&'static Slot, Locked), Fault> {
    let gone = || Fault::new(SS_NO_CONTACT, "this handle names no contact: it was freed, or never made");
    let (index, generation) = ((handle & u32::MAX as usize).checked_sub(1).ok_or_else(gone)?, handle >> 32);
    let (chunk, offset) = place(index);
    let slot = SLOTS.get(chunk).and_then(OnceLock::get).and_then(|slots| slots.get(offset)).ok_or_else(gone)?;
    let is_named = || slot.generation.load(Ordering::Acquire) as usize == generation;
    if !is_named() {
        return Err(gone());
    }
    let contact = match slot.contact.try_lock() {
        Ok(contact) => contact,
        Err(TryLockError::WouldBlock) => {
            return Err(Fault::new(SS_BUSY, "another thread is using this contact: each is used by one at a time"));
        }
        // A call has failed half-way, and with it its contact.
        Err(TryLockError::Poisoned(poisoned)) => {
            slot.contact.clear_poison();
            let mut contact = poisoned.into_inner();
            *contact = None;
            contact
        }
    };
    // It may have been freed since.
    if is_named() && contact.is_some() { Ok((slot, contact)) } else { Err(gone()) }
}

/// Works on the contact of a handle.
pub(crate) fn with<R>(handle: usize, work: impl FnOnce(&mut Held) -> Result<R, Fault>) -> Result<R, Fault> {
    let (_, mut contact) = slot(handle)?;
    contact.as_mut().map_or_else(|| Err(Fault::new(SS_NO_CONTACT, "no contact")), work)
}

/// Ends the contact of a handle.
pub(crate) fn remove(handle: usize) -> Result<(), Fault> {
    let (slot, mut contact) = slot(handle)?;
    let taken = contact.take();
    let generation = slot.generation.load(Ordering::Acquire);
    slot.generation.store(generation.saturating_add(1), Ordering::Release);
    drop(contact);
    drop(taken);
    if generation < u32::MAX {
        free().slots.push((handle & u32::MAX as usize) - 1);
    }
    Ok(())
}
