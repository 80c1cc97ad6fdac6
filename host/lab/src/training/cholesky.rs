//! Systems of linear equations whose matrix is symmetric and positive definite.

/// x of `matrix` · x = `right`, by Cholesky's method; `matrix` is square, row after row, and only its lower triangle is read.
/// None when it is not positive definite.
#[must_use]
pub fn solve(matrix: &[f64], right: &[f64]) -> Option<Vec<f64>> {
    let size = right.len();
    let mut lower = matrix.to_vec();
    for row in 0..size {
        for column in 0..=row {
            let (before, own) = lower.split_at(row * size);
            let known = if column == row { &own[..column] } else { &before[column * size..][..column] };
            let rest = own[column] - dot(&own[..column], known);
            let pivot = if column < row { before[column * size + column] } else { rest.sqrt() };
            // The comparison also catches what is no number.
            if !(pivot > 0.0 && pivot.is_finite()) {
                return None;
            }
            lower[row * size + column] = rest / pivot;
        }
    }
    let mut solution = right.to_vec();
    for row in 0..size {
        let (known, rest) = solution.split_at_mut(row);
        rest[0] = (rest[0] - dot(&lower[row * size..][..row], known)) / lower[row * size + row];
    }
    for row in (0..size).rev() {
        let below: f64 = (row + 1..size).map(|other| lower[other * size + row] * solution[other]).sum();
        solution[row] = (solution[row] - below) / lower[row * size + row];
    }
    Some(solution)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
