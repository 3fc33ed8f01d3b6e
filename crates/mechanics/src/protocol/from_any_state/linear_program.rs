//! The step of a minimax descent: a small linear program, solved on its dual by the simplex method.

/// Pivots at the most, times the number of unknowns.
const PIVOTS: usize = 50;
/// A reduced cost, or an entry of a column, below this share of the largest counts as zero.
const NEGLIGIBLE: f64 = 1e-11;

/// A function linear in a step d: its value at d = 0 and its slope.
#[derive(Clone, Debug)]
pub(super) struct Linear {
    pub(super) value: f64,
    pub(super) slope: Vec<f64>,
}

/// The step d at which the largest of `rows` is smallest, and the value there, while no function of `limits` is above
/// zero, as none is at d = 0; `None` where it is not found. The limits begin with an upper and a lower bound of each
/// unknown in turn.
///
/// The dual asks for weights of all functions, not below zero, whose slopes cancel; those of the rows have the sum one.
/// A basis to begin with is the largest row, with the bounds that cancel its slope.
pub(super) fn lowest(rows: &[Linear], limits: &[Linear]) -> Option<(Vec<f64>, f64)> {
    let largest = rows.iter().enumerate().max_by(|a, b| a.1.value.total_cmp(&b.1.value))?;
    let unknowns = largest.1.slope.len();
    let size = unknowns + 1;
    let column = |function: &Linear, one: f64| {
        let entries = function.slope.iter().copied().chain([one]);
        Linear { value: function.value, slope: entries.collect() }
    };
    let columns: Vec<Linear> =
        limits.iter().map(|limit| column(limit, 0.0)).chain(rows.iter().map(|row| column(row, 1.0))).collect();
    let slope = &largest.1.slope;
    let bounds = (0..unknowns).map(|index| 2 * index + usize::from(slope[index] > 0.0));
    let mut basis: Vec<usize> = bounds.chain([limits.len() + largest.0]).collect();
    let mut weights: Vec<f64> = slope.iter().map(|part| part.abs()).chain([1.0]).collect();
    // The inverse of the basis, row by row.
    let mut inverse = vec![vec![0.0; size]; size];
    for index in 0..size {
        inverse[index][unknowns] = weights[index];
        if index < unknowns {
            inverse[index][index] = if slope[index] > 0.0 { -1.0 } else { 1.0 };
        }
    }
    let scale = rows.iter().map(|row| row.value.abs()).fold(f64::MIN_POSITIVE, f64::max);
    for pivot in 0..PIVOTS * size {
        let price = |at: usize| (0..size).map(|row| columns[basis[row]].value * inverse[row][at]).sum();
        let prices: Vec<f64> = (0..size).map(price).collect();
        let reduced = |column: &Linear| column.value - dot(&column.slope, &prices);
        let gains = columns.iter().map(reduced).enumerate().filter(|(_, gain)| *gain > NEGLIGIBLE * scale);
        // The largest gain; after many pivots the first one, which cannot cycle (Bland).
        let entering =
            if pivot < PIVOTS * size / 2 { gains.max_by(|a, b| a.1.total_cmp(&b.1)) } else { gains.into_iter().next() };
        let Some((entering, _)) = entering else {
            return Some((prices[..unknowns].iter().map(|price| -price).collect(), prices[unknowns]));
        };
        let change: Vec<f64> = inverse.iter().map(|row| dot(row, &columns[entering].slope)).collect();
        let greatest = change.iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
        let leaving = (0..size).filter(|row| change[*row] > NEGLIGIBLE * greatest).min_by(|a, b| {
            (weights[*a] / change[*a]).total_cmp(&(weights[*b] / change[*b])).then(basis[*a].cmp(&basis[*b]))
        })?;
        let share = (weights[leaving] / change[leaving]).max(0.0);
        let by: Vec<f64> = inverse[leaving].iter().map(|part| part / change[leaving]).collect();
        for row in 0..size {
            weights[row] = (weights[row] - share * change[row]).max(0.0);
            inverse[row].iter_mut().zip(&by).for_each(|(part, by)| *part -= change[row] * by);
        }
        (basis[leaving], weights[leaving], inverse[leaving]) = (entering, share, by);
    }
    None
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}
