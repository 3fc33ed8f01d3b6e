//! Which contact a handle names.
//!
//! A handle is the number of a slot and how often the slot has been used before, in the bits of a pointer that nobody
//! follows. Slots are kept for the next contact when one is freed, so that an old handle finds a slot of another
//! generation: it is refused. A slot is locked while a call works on its contact.

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
    generation: u32,
    contact: Option<Held>,
}

type Chunk = Box<[Mutex<Slot>]>;

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
    let slots = SLOTS
        .get(chunk)
        .ok_or_else(|| Fault::new(SS_INTERNAL, "there are too many contacts"))?
        .get_or_init(|| (0..FIRST_CHUNK << chunk).map(|_| Mutex::new(Slot { generation: 1, contact: None })).collect());
    let mut slot = slots[offset].lock().unwrap_or_else(PoisonError::into_inner);
    slot.contact = Some(contact);
    Ok((slot.generation as usize) << 32 | (index + 1))
}

/// Locks the slot of a handle with its contact.
fn slot(handle: usize) -> Result<MutexGuard<'static, Slot>, Fault> {
    let gone = || Fault::new(SS_NO_CONTACT, "this handle names no contact: it was freed, or never made");
    let (index, generation) = ((handle & u32::MAX as usize).checked_sub(1).ok_or_else(gone)?, handle >> 32);
    let (chunk, offset) = place(index);
    let mutex = SLOTS.get(chunk).and_then(OnceLock::get).and_then(|slots| slots.get(offset)).ok_or_else(gone)?;
    let slot = match mutex.try_lock() {
        Ok(slot) => slot,
        Err(TryLockError::WouldBlock) => {
            return Err(Fault::new(SS_BUSY, "another thread is using this contact: each is used by one at a time"));
        }
        // A call has failed half-way, and with it its contact.
        Err(TryLockError::Poisoned(poisoned)) => {
            mutex.clear_poison();
            let mut slot = poisoned.into_inner();
            slot.contact = None;
            slot
        }
    };
    if slot.generation as usize == generation && slot.contact.is_some() { Ok(slot) } else { Err(gone()) }
}

/// Works on the contact of a handle.
pub(crate) fn with<R>(handle: usize, work: impl FnOnce(&mut Held) -> Result<R, Fault>) -> Result<R, Fault> {
    let mut slot = slot(handle)?;
    slot.contact.as_mut().map_or_else(|| Err(Fault::new(SS_NO_CONTACT, "no contact")), work)
}

/// Ends the contact of a handle.
pub(crate) fn remove(handle: usize) -> Result<(), Fault> {
    let mut slot = slot(handle)?;
    let contact = slot.contact.take();
    let reusable = slot.generation < u32::MAX;
    slot.generation = slot.generation.saturating_add(1);
    drop(slot);
    drop(contact);
    if reusable {
        free().slots.push((handle & u32::MAX as usize) - 1);
    }
    Ok(())
}
