//! The parameters of Ruiz, Boddington & Chen (1984) for fretting at a place of the surface.

/// What a cycle does to a place of the surface. Compare places and cycles by it; it has no limit of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ruiz {
    /// F1 = tau delta, N/m: amplitude of the shear stress times that of the slip.
    pub fretting_damage: f64,
    /// F2 = sigma_T tau delta, N^2/m^3: times the largest tension along the surface, zero where there is none.
    pub crack_initiation: f64,
}

impl Ruiz {
    /// From shear stresses, Pa, slips, m, and normal stresses along the slip, Pa, at the instants of a closed cycle.
    /// Amplitudes are half ranges.
    ///
    /// ```
    /// use stickslip_mechanics::fatigue::Ruiz;
    ///
    /// let ruiz = Ruiz::of(&[1e6, 5e6, 3e6], &[0.0, 4e-6, 1e-6], &[-7e6, 1e7, 0.0]);
    /// assert!((ruiz.fretting_damage - 4.0).abs() < 1e-12 && (ruiz.crack_initiation - 4e7).abs() < 1e-5);
    /// ```
    #[must_use]
    pub fn of(shears: &[f64], slips: &[f64], tensions: &[f64]) -> Ruiz {
        let fretting_damage = half_range(shears) * half_range(slips);
        let tension = tensions.iter().fold(0.0, |most: f64, tension| most.max(*tension));
        Ruiz { fretting_damage, crack_initiation: tension * fretting_damage }
    }
}

/// Half the difference of the largest and the smallest value; zero for none.
fn half_range(values: &[f64]) -> f64 {
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    if values.is_empty() { 0.0 } else { 0.5 * (most - least) }
}
