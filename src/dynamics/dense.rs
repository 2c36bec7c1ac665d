//! Dense kernels on plain slices: no allocation, fixed order of summation, shapes that vectorise.

/// `out` += Σⱼ `columns`ⱼ xⱼ; `columns` holds column j at `j * out.len()`.
pub fn add_columns(out: &mut [f64], columns: &[f64], x: &[f64]) {
    let rows = out.len();
    let mut blocks = columns.chunks_exact(4 * rows);
    let mut factors = x.chunks_exact(4);
    for (block, f) in blocks.by_ref().zip(factors.by_ref()) {
        let (a, rest) = block.split_at(rows);
        let (b, rest) = rest.split_at(rows);
        let (c, d) = rest.split_at(rows);
        for i in 0..rows {
            out[i] += (a[i] * f[0] + b[i] * f[1]) + (c[i] * f[2] + d[i] * f[3]);
        }
    }
    for (column, f) in blocks.remainder().chunks_exact(rows).zip(factors.remainder()) {
        for i in 0..rows {
            out[i] += column[i] * f;
        }
    }
}

/// Factors the row-major `size` × `size` matrix in place into L·U without pivoting, L with unit
/// diagonal; `false` if a pivot vanishes. For matrices whose symmetric part is positive definite.
pub fn factor(matrix: &mut [f64], size: usize) -> bool {
    for k in 0..size {
        let pivot = matrix[k * size + k];
        if !(pivot.is_finite() && pivot.abs() > f64::MIN_POSITIVE) {
            return false;
        }
        let inverse = 1.0 / pivot;
        let (above, below) = matrix.split_at_mut((k + 1) * size);
        let row_k = &above[k * size..];
        for row in below.chunks_exact_mut(size) {
            let factor = row[k] * inverse;
            row[k] = factor;
            for (value, u) in row[k + 1..].iter_mut().zip(&row_k[k + 1..]) {
                *value -= factor * u;
            }
        }
    }
    true
}

/// Solves with the factors of [`factor`]; `x` holds the right-hand side and becomes the solution.
pub fn solve(factors: &[f64], x: &mut [f64]) {
    let size = x.len();
    for i in 1..size {
        let row = &factors[i * size..i * size + i];
        let sum: f64 = row.iter().zip(&x[..i]).map(|(l, x)| l * x).sum();
        x[i] -= sum;
    }
    for i in (0..size).rev() {
        let row = &factors[i * size..(i + 1) * size];
        let sum: f64 = row[i + 1..].iter().zip(&x[i + 1..]).map(|(u, x)| u * x).sum();
        x[i] = (x[i] - sum) / row[i];
    }
}

/// Inverts a symmetric positive definite row-major matrix in place (Gauss-Jordan, no pivoting);
/// `false` if it is not positive definite. The result is made symmetric to the last bit.
pub fn invert(matrix: &mut [f64], size: usize) -> bool {
    for k in 0..size {
        let pivot = matrix[k * size + k];
        if !(pivot.is_finite() && pivot > 0.0) {
            return false;
        }
        let inverse = 1.0 / pivot;
        matrix[k * size + k] = 1.0;
        for value in &mut matrix[k * size..(k + 1) * size] {
            *value *= inverse;
        }
        let (above, rest) = matrix.split_at_mut(k * size);
        let (row_k, below) = rest.split_at_mut(size);
        for row in above.chunks_exact_mut(size).chain(below.chunks_exact_mut(size)) {
            let factor = row[k];
            row[k] = 0.0;
            for (value, r) in row.iter_mut().zip(row_k.iter()) {
                *value -= factor * r;
            }
        }
    }
    for i in 0..size {
        for j in 0..i {
            let mean = 0.5 * (matrix[i * size + j] + matrix[j * size + i]);
            matrix[i * size + j] = mean;
            matrix[j * size + i] = mean;
        }
    }
    true
}

/// Dot product in four interleaved partial sums.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (mut left, mut right) = (a.chunks_exact(4), b.chunks_exact(4));
    for (x, y) in left.by_ref().zip(right.by_ref()) {
        for k in 0..4 {
            sums[k] += x[k] * y[k];
        }
    }
    let rest: f64 = left.remainder().iter().zip(right.remainder()).map(|(x, y)| x * y).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Symmetric positive definite, condition about 30.
    fn example(size: usize) -> Vec<f64> {
        let mut a = vec![0.0; size * size];
        for i in 0..size {
            for j in 0..size {
                a[i * size + j] = 1.0 / (1.0 + (i as f64 - j as f64).powi(2));
            }
            a[i * size + i] += 0.5;
        }
        a
    }

    #[test]
    fn factors_and_inverse_solve_to_rounding() {
        let size = 13;
        let a = example(size);
        let x: Vec<f64> = (0..size).map(|i| (i as f64).sin()).collect();
        let b: Vec<f64> = (0..size).map(|i| dot(&a[i * size..(i + 1) * size], &x)).collect();
        let mut lu = a.clone();
        assert!(factor(&mut lu, size));
        let mut by_lu = b.clone();
        solve(&lu, &mut by_lu);
        let mut inverse = a;
        assert!(invert(&mut inverse, size));
        for i in 0..size {
            let by_inverse = dot(&inverse[i * size..(i + 1) * size], &b);
            assert!((by_lu[i] - x[i]).abs() < 1e-13 && (by_inverse - x[i]).abs() < 1e-13);
        }
    }
}
