//! Numbers drawn from bytes, so that a fuzzer can steer them.

/// The bytes that are left; once they are used up all numbers are the least of their ranges.
pub struct Draw<'a>(pub &'a [u8]);

impl Draw<'_> {
    /// Even over [0, 1).
    pub fn unit(&mut self) -> f64 {
        let Some((head, rest)) = self.0.split_first_chunk() else { return 0.0 };
        self.0 = rest;
        f64::from(u32::from_le_bytes(*head)) / 2.0_f64.powi(32)
    }

    /// Even over [low, high).
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A power of ten, its exponent even over [low, high).
    pub fn power(&mut self, low: f64, high: f64) -> f64 {
        10_f64.powf(self.within(low, high))
    }

    /// A whole number below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    /// Whether one case of `count` has come up; not where the bytes are used up.
    pub fn one_of(&mut self, count: usize) -> bool {
        self.below(count) + 1 == count
    }
}
