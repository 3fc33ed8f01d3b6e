//! Conversion of a contact to bytes and back, equal to the last bit.
//!
//! Everything that a move changes is written as it is, sums included. What follows from the definition is not, because
//! the reader has already made a contact from it. Little-endian `f64` throughout:
//!
//! | bytes | what |
//! |---|---|
//! | 4 | [`LAYOUT`] and, in the upper half, [`ENGINE`] |
//! | 4 x 8 | indentation and normal force of the preload, 1/m (two parts): whether it is the same contact |
//! | 8 x 8 | displacement (two parts), normal force, friction work (two parts), errors of curved paths (three) |
//! | the rest | the slip history, see `slip_history/packed.rs`; of a contact with a law of its own shear strength, |
//! | | work of adhesion, level (two parts), and of adhesion its bond and loss come before that of its tangential |
//! | | problem; of a contact that is twisted, level, whether it has springs, and these or the history of the twist, |
//! | | and the sign of the error before it; |
//! | | of bodies with memory their springs are in its place |

use std::sync::Arc;

use super::Contact;
use super::adhesion::Bond;
use super::law::Interface;
use super::twist::Twist;
use crate::numerics::packing::{Packed, Reader};
use crate::slip_history::SlipHistory;
use crate::slip_history::limit::Coulomb;
use crate::springs::law::SpringLaw;
use crate::springs::rows::Rows;
use crate::viscoelastic::{SPRINGS, Viscoelastic};

/// The version of the results of the engine. **Raise it with every change that alters a result in any bit**, for
/// whatever contact: bytes of another version are not read, so that states packed by an older engine are recomputed
/// from their moves and agree with those that never were packed. `tests/physics/packed.rs` compares a digest of results
/// for it.
pub const ENGINE: u16 = 22;

/// The version of the arrangement of the bytes.
const LAYOUT: u16 = 4;

/// Writes the versions that bytes begin with.
pub(crate) fn write_versions(bytes: &mut Vec<u8>) {
    bytes.extend_from_slice(&LAYOUT.to_le_bytes());
    bytes.extend_from_slice(&ENGINE.to_le_bytes());
}

/// Reads the versions at the beginning, and compares them with those of this program.
pub(crate) fn is_current(reader: &mut Reader<'_>) -> bool {
    [LAYOUT, ENGINE].into_iter().all(|version| reader.bytes() == Some(version.to_le_bytes()))
}

/// A state with its history as bytes.
///
/// ```
#[doc = include_str!("../example.txt")]
/// contact.apply(&slide(0.001))?;
/// let bytes = contact.pack();
/// assert_eq!(contact.packed_length(), bytes.len());
/// assert!(Contact::is_current_packing(&bytes) && !Contact::is_current_packing(&[0; 4]));
/// let back = Contact::new(setup.clone())?.unpack(&bytes).unwrap();
/// assert_eq!(back.force().to_bits(), contact.force().to_bits());
/// let other = Contact::new(Setup { preload: Preload::Indentation(0.02), ..setup })?;
/// assert!(other.unpack(&bytes).is_none());
/// # Ok::<(), Error>(())
/// ```
impl Contact {
    /// How many bytes [`Contact::pack`] makes.
    #[must_use]
    pub fn packed_length(&self) -> usize {
        let history = match self.law.as_deref() {
            None if self.viscoelastic.is_some() => 0,
            Some(Interface { twist: Some(Twist { springs: Some(springs), .. }), .. }) => {
                3 * size_of::<f64>() + springs.packed_length()
            }
            Some(Interface { twist: Some(twist), .. }) => 3 * size_of::<f64>() + twist.contact.history.packed_length(),
            Some(law) => {
                let adhesion = if law.adhesion.is_some() { 2 } else { 0 };
                let tangential = self.tangential().map_or(0, |contact| contact.history.packed_length());
                (4 + adhesion) * size_of::<f64>() + tangential
            }
            None => self.history.packed_length(),
        };
        let bodies = self.viscoelastic.as_ref().map_or(0, |bodies| bodies.rows.packed_length());
        2 * size_of::<u16>() + 12 * size_of::<f64>() + history + bodies
    }

    /// The state with its history as bytes. They are read by [`Contact::unpack`] of the same program alone: another
    /// version of the engine or of the layout refuses them.
    #[must_use]
    pub fn pack(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(self.packed_length());
        write_versions(&mut bytes);
        self.definition_marks().iter().for_each(|mark| mark.pack(&mut bytes));
        self.displacement.pack(&mut bytes);
        self.normal_force.pack(&mut bytes);
        self.dissipated.pack(&mut bytes);
        self.path_error.pack(&mut bytes);
        self.work_error.pack(&mut bytes);
        // Its sign tells that the contact is twisted.
        if self.is_twisted() { -self.path_kernel } else { self.path_kernel }.pack(&mut bytes);
        match self.law.as_deref() {
            Some(Interface { twist: Some(twist), .. }) => {
                self.history.edge().level.pack(&mut bytes);
                f64::from(u8::from(twist.springs.is_some())).pack(&mut bytes);
                match &twist.springs {
                    Some(springs) => springs.pack(&mut bytes),
                    None => twist.contact.history.pack(&mut bytes),
                }
            }
            Some(law) => {
                [law.strength, self.work_of_adhesion()].iter().for_each(|value| value.pack(&mut bytes));
                self.history.edge().level.pack(&mut bytes);
                if let Some(adhesion) = &law.adhesion {
                    [f64::from(adhesion.bond as u8), adhesion.loss].iter().for_each(|value| value.pack(&mut bytes));
                }
                law.tangential.iter().for_each(|contact| contact.history.pack(&mut bytes));
            }
            None => match &self.viscoelastic {
                Some(bodies_with_memory) => bodies_with_memory.rows.pack(&mut bytes),
                None => self.history.pack(&mut bytes),
            },
        }
        bytes
    }

    /// Whether bytes are of this layout and engine, so that [`Contact::unpack`] reads them if they are undamaged.
    #[must_use]
    pub fn is_current_packing(bytes: &[u8]) -> bool {
        is_current(&mut Reader(bytes))
    }

    /// The contact in the packed state, equal to the last bit to the one that was packed. `self` is any state of a
    /// contact of the same definition, such as the virgin one. `None` for bytes that are cut short, of another version,
    /// of a contact with another preload, or of no valid state; damage that leaves valid numbers is not detected.
    #[must_use]
    pub fn unpack(&self, bytes: &[u8]) -> Option<Contact> {
        let mut reader = Reader(bytes);
        if !is_current(&mut reader) {
            return None;
        }
        for value in self.definition_marks() {
            reader.any().filter(|found| found.to_bits() == value.to_bits())?;
        }
        let mut contact = self.clone();
        contact.displacement = Packed::unpack(&mut reader)?;
        contact.normal_force = Packed::unpack(&mut reader)?;
        contact.dissipated = Packed::unpack(&mut reader)?;
        // The error of a stress may be without bound.
        (contact.path_error, contact.work_error, contact.path_kernel) = (reader.any()?, reader.any()?, reader.any()?);
        if let Some(bodies) = &self.viscoelastic {
            let law = SpringLaw::Coulomb(self.material(&bodies.prony));
            let rows = Rows::unpack(&mut reader, &law, SPRINGS)?;
            contact.viscoelastic = Some(Box::new(Viscoelastic { prony: Arc::clone(&bodies.prony), rows }));
            let normal_force = contact.normal_force;
            contact.take_up_memory();
            contact.normal_force = normal_force;
            return Some(contact);
        }
        if contact.path_kernel.is_sign_negative() {
            contact.path_kernel = -contact.path_kernel;
            contact.law = None;
            let history = SlipHistory::new(&Coulomb(&contact.indenter), Packed::unpack(&mut reader)?);
            contact.history = history.at_position(contact.scaled(contact.displacement));
            return contact.with_twist_of(&mut reader);
        }
        if self.law.as_ref().is_none_or(|law| law.twist.is_some()) {
            contact.law = None;
            contact.history = Packed::unpack(&mut reader)?;
            return Some(contact);
        }
        for value in [self.shear_strength(), self.work_of_adhesion()] {
            reader.any().filter(|found| found.to_bits() == value.to_bits())?;
        }
        contact.history = SlipHistory::new(&Coulomb(&contact.indenter), Packed::unpack(&mut reader)?);
        if let Some(adhesion) = contact.law.as_mut().and_then(|law| law.adhesion.as_mut()) {
            let bond: f64 = Packed::unpack(&mut reader)?;
            let all = [Bond::Apart, Bond::Held, Bond::PulledOff].into_iter();
            adhesion.bond = { all }.find(|known| f64::from(*known as u8).to_bits() == bond.to_bits())?;
            adhesion.loss = Packed::unpack(&mut reader)?;
        }
        contact.renew_tangential();
        match contact.law.as_mut().and_then(|law| law.tangential.as_deref_mut()) {
            Some(tangential) => tangential.history = Packed::unpack(&mut reader)?,
            None => reader.0.is_empty().then_some(())?,
        }
        Some(contact)
    }

    /// Numbers that distinguish contacts of different definitions, and machines that compute a preload differently.
    pub(crate) fn definition_marks(&self) -> [f64; 4] {
        let (hi, lo) = self.inverse_scale.parts();
        [self.preload.0.value(), self.preload.1, hi, lo]
    }
}
