//! A contact in the plane as bytes and back, equal to the last bit: the state of its rings, little-endian `f64`.

use super::{PlanarContact, PlanarLaw, RingState, Vector};
use crate::contact::packed::{is_current, write_versions};
use crate::contact::state::Normal;
use crate::numerics::packing::{Packed, Reader, packed};

/// A prescribed normal force may differ so much from that of its indentation, relatively.
const SAME_LOAD: f64 = 1e-9;

packed!(RingState { bound, traction, slip });
packed!(PlanarContact {
    indentation,
    normal_force,
    radius,
    displacement,
    force,
    stick_radius,
    dissipated,
    elastic,
    unsettled,
    area,
    rings
});

impl Packed for Vector {
    fn pack(&self, bytes: &mut Vec<u8>) {
        self.iter().for_each(|component| component.pack(bytes));
    }

    fn unpack(reader: &mut Reader<'_>) -> Option<Vector> {
        Some([f64::unpack(reader)?, f64::unpack(reader)?])
    }
}

/// All that is left of the bytes.
impl Packed for Vec<RingState> {
    fn pack(&self, bytes: &mut Vec<u8>) {
        self.iter().for_each(|ring| ring.pack(bytes));
    }

    fn unpack(reader: &mut Reader<'_>) -> Option<Vec<RingState>> {
        let count = reader.count(size_of::<RingState>())?;
        (0..count).map(|_| RingState::unpack(reader)).collect()
    }
}

impl PlanarLaw {
    /// Numbers that distinguish laws.
    fn marks(&self) -> Vec<f64> {
        self.contact.definition_marks().into_iter().chain([self.matrices.len() as f64]).collect()
    }

    /// The state of a contact of this law as bytes, which [`PlanarLaw::unpack`] of the same program reads.
    ///
    /// ```
    /// use stickslip_mechanics::rings::{PlanarBuffers, PlanarLaw};
    #[doc = include_str!("../../example.txt")]
    /// let law = PlanarLaw::new(setup, 10)?;
    /// let (mut ball, mut buffers) = (law.start(), PlanarBuffers::default());
    /// law.step(&mut ball, Normal::Indentation(0.01), [0.001, 0.002], &mut buffers)?;
    /// let bytes = law.pack(&ball);
    /// assert_eq!(law.unpack(&bytes).unwrap().state(), ball.state());
    /// assert!(law.unpack(&bytes[1..]).is_none());
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn pack(&self, contact: &PlanarContact) -> Vec<u8> {
        let mut bytes = Vec::new();
        write_versions(&mut bytes);
        self.marks().iter().for_each(|mark| mark.pack(&mut bytes));
        contact.pack(&mut bytes);
        bytes
    }

    /// The contact of these bytes; `None` unless they are a state of a contact of this law by the same program.
    #[must_use]
    pub fn unpack(&self, bytes: &[u8]) -> Option<PlanarContact> {
        let mut reader = Reader(bytes);
        if !is_current(&mut reader) {
            return None;
        }
        for mark in self.marks() {
            reader.any().filter(|found| found.to_bits() == mark.to_bits())?;
        }
        let state = PlanarContact::unpack(&mut reader)?;
        let &PlanarContact { indentation, normal_force, radius, area, .. } = &state;
        let count = state.rings.len();
        // Steps rely on rings that cover the contact.
        let [_, load] = self.load(Normal::Indentation(indentation)).ok()?;
        let pressed = if indentation < 0.0 { 0.0 } else { self.contact.indenter.radius(indentation) };
        let covered = if area > 0.0 { count == state.touching() as usize } else { count == 0 };
        let sound = covered && count <= self.matrices.len() && radius.to_bits() == pressed.to_bits();
        (sound && (load - normal_force).abs() <= SAME_LOAD * load).then_some(state)
    }
}
