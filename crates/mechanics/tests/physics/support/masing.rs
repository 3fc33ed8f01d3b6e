//! The sphere at constant load in closed form: Cattaneo's first loading, Masing's doubling, Madelung's wiping-out.
//!
//! In units of u_max, mu F_N and mu p_max, with s = r^2/a^2: first loading to u leaves the stick radius c^2/a^2 = 1 -
//! u, F = 1 - (1 - u)^(3/2) and tau = sqrt(1 - s) - sqrt(1 - u - s). Every later stroke adds twice that of half its
//! length.

/// A contact at constant load, given by its surviving turning points, in the units of the displacement given.
#[derive(Clone, Debug)]
pub struct Masing {
    /// u_max.
    full: f64,
    /// The displacement at which the contact would be virgin; gross slip drags it along.
    pub origin: f64,
    /// Whether gross slip has ever dragged the origin.
    pub dragged: bool,
    pub turns: Vec<f64>,
    pub now: f64,
    direction: f64,
}

/// Force of first loading to u >= 0, over mu F_N.
pub fn first_force(u: f64) -> f64 {
    if u < 1.0 { -(1.5 * (-u).ln_1p()).exp_m1() } else { 1.0 }
}

/// Shear stress of first loading to u >= 0 at r^2 = s a^2, over mu p_max.
pub fn first_stress(u: f64, s: f64) -> f64 {
    let outer = (1.0 - s).max(0.0).sqrt();
    let stuck = 1.0 - u.min(1.0) - s;
    if stuck > 0.0 { u / (outer + stuck.sqrt()) } else { outer }
}

impl Masing {
    pub fn new(full: f64) -> Masing {
        Masing { full, origin: 0.0, dragged: false, turns: Vec::new(), now: 0.0, direction: 0.0 }
    }

    pub fn go(&mut self, target: f64) {
        let change = target - self.now;
        if change.abs() <= 0.0 {
            return;
        }
        let direction = change.signum();
        if direction * self.direction < 0.0 {
            self.turns.push(self.now);
        }
        self.direction = direction;
        // A branch ends where the turn before its own start is met again; the first one where it meets the virgin
        // curve.
        while let Some(&start) = self.turns.last() {
            let before = self.turns.len().checked_sub(2).map(|index| self.turns[index]);
            let end = before.unwrap_or(2.0 * self.origin - start);
            if (target - end) * direction < 0.0 {
                break;
            }
            self.turns.truncate(self.turns.len().saturating_sub(2));
        }
        if self.turns.is_empty() && (target - self.origin).abs() > self.full {
            self.origin = target - direction * self.full;
            self.dragged = true;
        }
        self.now = target;
    }

    /// The strokes that remain: factor with sign, and amplitude over u_max.
    pub fn strokes(&self) -> impl Iterator<Item = (f64, f64)> {
        let ends = self.turns.iter().copied().chain([self.now]);
        let starts = [self.origin].into_iter().chain(self.turns.iter().copied());
        ends.zip(starts).enumerate().map(|(index, (end, start))| {
            let factor = if index == 0 { 1.0 } else { 2.0 };
            let stroke = end - start;
            (factor * stroke.signum(), stroke.abs() / (factor * self.full))
        })
    }

    /// F/(mu F_N).
    pub fn force(&self) -> f64 {
        self.strokes().map(|(factor, u)| factor * first_force(u)).sum()
    }

    /// tau/(mu p_max) at r^2 = s a^2.
    pub fn stress(&self, s: f64) -> f64 {
        self.strokes().map(|(factor, u)| factor * first_stress(u, s)).sum()
    }
}
