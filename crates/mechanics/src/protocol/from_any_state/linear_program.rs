//! The step of a minimax descent: a small linear program, solved on its dual by the simplex method.

/// Pivots at the most, times the number of unknowns.
const PIVOTS: usize = 50;
/// A reduced cost, or an entry of a column, below this share of the largest counts as zero.
const NEGLIGIBLE: f64 = 1e-11;

/// What a step d may do: the largest of value + slope . d over `rows`, plus the penalties, is to be smallest.
pub(super) struct Step {
    /// The linear functions under the maximum, each as its value and its slope.
    pub(super) rows: Vec<(f64, Vec<f64>)>,
    /// Linear functions of which the part above zero costs `penalty`.
    pub(super) penalised: Vec<(f64, Vec<f64>)>,
    /// What a unit above zero costs.
    pub(super) penalty: f64,
    /// The least and the largest value of each unknown: below and above zero.
    pub(super) bounds: Vec<(f64, f64)>,
    /// Linear functions that must not be above zero, and are not at d = 0.
    pub(super) limits: Vec<(f64, Vec<f64>)>,
}

impl Step {
    /// The best d, and the value there; `None` where it is not found.
    ///
    /// The dual asks for weights of all functions, not below zero, whose slopes cancel; those of the rows have the sum
    /// one, those of a penalised function and its slack the sum `penalty`. A basis to begin with is the largest row,
    /// with the bounds that cancel its slope, and the slacks.
    pub(super) fn solve(&self) -> Option<(Vec<f64>, f64)> {
        let unknowns = self.bounds.len();
        let size = unknowns + 1 + self.penalised.len();
        let mut columns: Vec<(f64, Vec<f64>)> = Vec::new();
        let column = |slope: &[f64], one: Option<usize>| {
            let mut column = slope.to_vec();
            column.resize(size, 0.0);
            if let Some(row) = one {
                column[row] = 1.0;
            }
            column
        };
        let unit = |index: usize, value: f64| {
            (0..unknowns).map(|at| if at == index { value } else { 0.0 }).collect::<Vec<_>>()
        };
        columns.extend(self.rows.iter().map(|(value, slope)| (*value, column(slope, Some(unknowns)))));
        let largest = (0..self.rows.len()).max_by(|a, b| self.rows[*a].0.total_cmp(&self.rows[*b].0))?;
        let bounds = columns.len();
        for (index, (least, most)) in self.bounds.iter().enumerate() {
            columns.push((-most, column(&unit(index, 1.0), None)));
            columns.push((*least, column(&unit(index, -1.0), None)));
        }
        columns.extend(self.limits.iter().map(|(value, slope)| (*value, column(slope, None))));
        let penalised = columns.len();
        for (index, (value, slope)) in self.penalised.iter().enumerate() {
            columns.push((*value, column(slope, Some(unknowns + 1 + index))));
            columns.push((0.0, column(&[], Some(unknowns + 1 + index))));
        }
        let mut weights = vec![0.0; size];
        let mut basis = vec![0; size];
        // The inverse of the basis, row by row.
        let mut inverse = vec![vec![0.0; size]; size];
        let slope = &self.rows[largest].1;
        for index in 0..unknowns {
            // A bound that cancels the slope: upwards where it is below zero.
            let up = slope[index] <= 0.0;
            basis[index] = bounds + 2 * index + usize::from(!up);
            inverse[index][index] = if up { 1.0 } else { -1.0 };
            inverse[index][unknowns] = slope[index].abs();
            weights[index] = slope[index].abs();
        }
        (basis[unknowns], weights[unknowns]) = (largest, 1.0);
        inverse[unknowns][unknowns] = 1.0;
        for index in 0..self.penalised.len() {
            let row = unknowns + 1 + index;
            (basis[row], weights[row]) = (penalised + 2 * index + 1, self.penalty);
            inverse[row][row] = 1.0;
        }
        let scale = self.rows.iter().map(|(value, _)| value.abs()).fold(f64::MIN_POSITIVE, f64::max);
        for pivot in 0..PIVOTS * size {
            let prices: Vec<f64> =
                (0..size).map(|at| (0..size).map(|row| columns[basis[row]].0 * inverse[row][at]).sum()).collect();
            let reduced = |(profit, column): &(f64, Vec<f64>)| {
                profit - column.iter().zip(&prices).map(|(entry, price)| entry * price).sum::<f64>()
            };
            let gains = columns.iter().map(reduced).enumerate().filter(|(_, gain)| *gain > NEGLIGIBLE * scale);
            // The largest gain; after many pivots the first one, which cannot cycle (Bland).
            let entering = if pivot < PIVOTS * size / 2 {
                gains.max_by(|a, b| a.1.total_cmp(&b.1))
            } else {
                gains.into_iter().next()
            };
            let Some((entering, _)) = entering else {
                let step = prices[..unknowns].iter().map(|price| -price).collect();
                return Some((
                    step,
                    prices.iter().skip(unknowns + 1).map(|price| self.penalty * price).sum::<f64>() + prices[unknowns],
                ));
            };
            let change: Vec<f64> = inverse
                .iter()
                .map(|row| row.iter().zip(&columns[entering].1).map(|(part, entry)| part * entry).sum())
                .collect();
            let greatest = change.iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
            let leaving = (0..size).filter(|row| change[*row] > NEGLIGIBLE * greatest).min_by(|a, b| {
                (weights[*a] / change[*a]).total_cmp(&(weights[*b] / change[*b])).then(basis[*a].cmp(&basis[*b]))
            })?;
            let share = (weights[leaving] / change[leaving]).max(0.0);
            for row in 0..size {
                weights[row] = if row == leaving { share } else { (weights[row] - share * change[row]).max(0.0) };
            }
            let by: Vec<f64> = inverse[leaving].iter().map(|part| part / change[leaving]).collect();
            for row in 0..size {
                if row == leaving {
                    inverse[row].clone_from(&by);
                } else {
                    let factor = change[row];
                    inverse[row].iter_mut().zip(&by).for_each(|(part, by)| *part -= factor * by);
                }
            }
            basis[leaving] = entering;
        }
        None
    }
}
