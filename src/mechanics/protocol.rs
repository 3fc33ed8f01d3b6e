//! Paths that lower the residual shear stress.

/// The linearly falling amplitude of Kraft & Pohrt (2016), eq. 20: the displacements
/// u(k) = A (N + 1 - k)/N (-1)^(k+1) for k = 1 to N + 1, m, the last of which is nought.
///
/// `reversals` is N, `amplitude` is A, m.
pub fn falling_amplitude(reversals: usize, amplitude: f64) -> impl Iterator<Item = f64> {
    (0..=reversals).map(move |index| {
        let left = (reversals - index) as f64;
        let size = amplitude * (left / reversals.max(1) as f64);
        if index % 2 == 0 { size } else { 0.0 - size }
    })
}
