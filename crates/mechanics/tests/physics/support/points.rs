//! Brute force for oblique paths on a sphere: independent points, each followed event by event.
//!
//! A point at level y carries w, is bounded by |w| <= d - y, and follows the indenter while it sticks. On a straight
//! move bound and indenter change at constant rates, so that a point which starts to slip slips to the end: there are
//! three events (touch, slip, lift-off), and between them nothing but addition. The function w(y) is then cut into
//! straight parts by bisection, down to the last digits, wherever three points are out of line; no kink is known
//! beforehand. Unit of length: d at the start. Radii: x^2 = y, which makes them units of the first contact radius.

/// A path of waypoints (d, W), the start included.
#[derive(Clone, Debug)]
pub struct Points {
    path: Vec<(f64, f64)>,
}

/// w over y at one instant: nodes (y, w) from the centre to the edge, straight between them.
pub struct Shape {
    nodes: Vec<(f64, f64)>,
}

impl Points {
    pub fn new(start: (f64, f64)) -> Points {
        Points { path: vec![start] }
    }

    pub fn go(&mut self, waypoint: (f64, f64)) {
        self.path.push(waypoint);
    }

    fn depth(&self) -> f64 {
        self.path.last().map_or(0.0, |&(depth, _)| depth)
    }

    /// w of the point at level y after the whole path.
    pub fn carried(&self, y: f64) -> f64 {
        // While it sticks, w = anchor.0 + W - anchor.1: a sum of increments would drift.
        let mut anchor = (0.0, self.path[0].1);
        for pair in self.path.windows(2) {
            let ((d0, w0), (d1, w1)) = (pair[0], pair[1]);
            if d1 <= y {
                anchor = (0.0, w1);
                continue;
            }
            if d0 < y {
                anchor = (0.0, w0 + (w1 - w0) * ((y - d0) / (d1 - d0)));
            }
            let (trial, bound) = (anchor.0 + (w1 - anchor.1), d1 - y);
            if trial.abs() > bound {
                anchor = (bound.copysign(trial), w1);
            }
        }
        anchor.0 + (self.path[self.path.len() - 1].1 - anchor.1)
    }

    pub fn shape(&self) -> Shape {
        const CELLS: usize = 32;
        let depth = self.depth().max(0.0);
        // What the numbers of the path are rounded by.
        let unit = self.path.iter().fold(0.0, |unit: f64, (depth, w)| unit.max(depth.abs() + w.abs()));
        // Just inside an edge, present or past, something thin may hide between parts that are in line.
        let edges = self.path.iter().map(|(edge, _)| *edge).filter(|edge| *edge > 0.0 && *edge <= depth);
        let edges =
            edges.flat_map(|edge| (1..=16).map(move |power| edge * (1.0 - 0.125_f64.powi(power))).chain([edge]));
        let cells = (1..CELLS).map(|index| depth * (index as f64 / CELLS as f64));
        let mut ends: Vec<f64> = cells.chain(edges).filter(|end| *end < depth).collect();
        ends.sort_by(f64::total_cmp);
        let mut nodes = vec![(0.0, self.carried(0.0))];
        if depth > 0.0 {
            // The edge itself is out of contact by the letter; its bound is zero.
            let carried = ends.into_iter().map(|end| (end, self.carried(end))).chain([(depth, 0.0)]);
            for outer in carried {
                let inner = nodes[nodes.len() - 1];
                self.refine(inner, outer, unit, &mut nodes);
            }
        }
        Shape { nodes }
    }

    fn refine(&self, inner: (f64, f64), outer: (f64, f64), unit: f64, nodes: &mut Vec<(f64, f64)>) {
        let width = outer.0 - inner.0;
        if width <= 0.0 {
            return;
        }
        let off = |fraction: f64| {
            let y = inner.0 + fraction * width;
            let straight = inner.1 + (outer.1 - inner.1) * ((y - inner.0) / width);
            (self.carried(y) - straight).abs()
        };
        let middle = 0.5 * (inner.0 + outer.0);
        let thin = width <= 1e-16 * unit || middle <= inner.0 || middle >= outer.0;
        if thin || [0.29, 0.5, 0.77].into_iter().all(|t| off(t) <= 1e-15 * unit) {
            nodes.push(outer);
            return;
        }
        let middle = (middle, self.carried(middle));
        self.refine(inner, middle, unit, nodes);
        self.refine(middle, outer, unit, nodes);
    }
}

impl Shape {
    fn parts(&self) -> impl Iterator<Item = [(f64, f64); 2]> {
        self.nodes.windows(2).map(|pair| [pair[0], pair[1]])
    }

    /// int_0^a w dx: F_x over 2 G* m; mu F_N in the same unit is 2/3 a d.
    pub fn force(&self) -> f64 {
        self.parts()
            .map(|[(y0, w0), (y1, w1)]| {
                let (x0, x1) = (y0.sqrt(), y1.sqrt());
                let width = (y1 - y0) / (x0 + x1);
                width * (w0 + (w1 - w0) * (x1 + 2.0 * x0) / (3.0 * (x0 + x1)))
            })
            .sum()
    }

    /// int_0^a w^2 dx: elastic energy over G* m^2, by three Gauss points a part, exact for a quartic in x.
    pub fn energy(&self) -> f64 {
        self.parts()
            .map(|[(y0, w0), (y1, w1)]| {
                let (x0, x1) = (y0.sqrt(), y1.sqrt());
                let width = (y1 - y0) / (x0 + x1);
                let squared = |t: f64| {
                    let x = x0 + t * width;
                    // (x^2 - x0^2)/(x1^2 - x0^2) without the difference of squares.
                    let w = w0 + (w1 - w0) * t * (x + x0) / (x1 + x0);
                    w * w
                };
                let node = 0.5 * 0.6_f64.sqrt();
                width * (5.0 * squared(0.5 - node) + 8.0 * squared(0.5) + 5.0 * squared(0.5 + node)) / 18.0
            })
            .sum()
    }

    /// -(1/2) int dw/sqrt(y - r^2) over y > r^2: tau over 2 G* m/pi; mu p_max in the same unit is a.
    pub fn stress(&self, r: f64) -> f64 {
        let s = r * r;
        self.parts()
            .filter(|[_, (y1, _)]| *y1 > s)
            .map(|[(y0, w0), (y1, w1)]| {
                let outer = (y1 - s).sqrt();
                if y0 > s { -(w1 - w0) / (outer + (y0 - s).sqrt()) } else { -(w1 - w0) / (y1 - y0) * outer }
            })
            .sum()
    }

    /// The levels of all nodes: kinks among them, with others ever closer to them, as the bisection left them.
    pub fn levels(&self) -> Vec<f64> {
        self.nodes.iter().map(|(y, _)| *y).collect()
    }

    /// Levels at which the slope changes, from the centre outward, as the bisection left them.
    pub fn kinks(&self) -> Vec<f64> {
        let mut kinks: Vec<f64> = Vec::new();
        let slopes: Vec<(f64, f64, f64)> = self
            .parts()
            .filter(|[(y0, _), (y1, _)]| y1 - y0 > 1e-9 * y1)
            .map(|[(y0, w0), (y1, w1)]| (y0, y1, (w1 - w0) / (y1 - y0)))
            .collect();
        for pair in slopes.windows(2) {
            let ((_, end, before), (start, _, after)) = (pair[0], pair[1]);
            if (after - before).abs() > 1e-5 {
                kinks.push(0.5 * (end + start));
            }
        }
        kinks
    }
}
