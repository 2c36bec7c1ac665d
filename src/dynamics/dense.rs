//! Dense kernels on plain slices: no allocation, fixed order of summation, shapes that vectorise.

use crate::pack::{Pack, LANES};

/// `out` += Σⱼ `columns`ⱼ xⱼ; `columns` holds column j at `j * out.len()`; `out` is full packs.
#[inline(always)]
pub fn add_columns(out: &mut [f64], columns: &[f64], x: &[f64]) {
    add_lower_columns(out, columns, x, 0);
}

/// [`add_columns`] of the lower part of longer columns, from number `start` on.
#[inline(always)]
pub fn add_lower_columns(out: &mut [f64], columns: &[f64], x: &[f64], start: usize) {
    let rows = (start + out.len()) / LANES;
    let columns = columns.as_chunks().0;
    let (mut at, mut rest) = (start / LANES, &mut *out.as_chunks_mut().0);
    while !rest.is_empty() {
        // As many rows at a time as registers hold while all columns pass.
        let count = match rest.len() {
            1 => add_rows::<1>(rest, columns, x, rows, at),
            2 => add_rows::<2>(rest, columns, x, rows, at),
            3 => add_rows::<3>(rest, columns, x, rows, at),
            5 => add_rows::<5>(rest, columns, x, rows, at),
            6 => add_rows::<6>(rest, columns, x, rows, at),
            _ => add_rows::<4>(rest, columns, x, rows, at),
        };
        at += count;
        rest = &mut rest[count..];
    }
}

/// [`add_columns`] for the first `N` packs of `out`, which are packs `at` and on of `rows` in a column.
#[inline(always)]
fn add_rows<const N: usize>(
    out: &mut [[f64; LANES]],
    columns: &[[f64; LANES]],
    x: &[f64],
    rows: usize,
    at: usize,
) -> usize {
    let Some(out) = out.first_chunk_mut::<N>() else { return out.len() };
    let mut sums = out.map(Pack);
    for (column, f) in columns.chunks_exact(rows).zip(x) {
        let Some(column) = column[at..].first_chunk::<N>() else { break };
        let f = Pack::splat(*f);
        for n in 0..N {
            sums[n] = f.mul_add(Pack(column[n]), sums[n]);
        }
    }
    for n in 0..N {
        out[n] = sums[n].0;
    }
    N
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

/// Dot product in eight interleaved partial sums.
#[inline(always)]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = Pack::splat(0.0);
    let (mut left, mut right) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    for (x, y) in left.by_ref().zip(right.by_ref()) {
        sums = Pack::read(x).mul_add(Pack::read(y), sums);
    }
    let rest: f64 = left.remainder().iter().zip(right.remainder()).map(|(x, y)| x * y).sum();
    let [a, b, c, d, e, f, g, h] = sums.0;
    ((a + b) + (c + d)) + ((e + f) + (g + h)) + rest
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
