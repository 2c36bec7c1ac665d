//! Dense kernels on plain slices: no allocation, fixed order of summation, shapes that vectorise.

use crate::pack::{Pack, LANES};

/// `out` += Σⱼ `columns`ⱼ xⱼ; `columns` holds column j at `j * out.len()`; `out` is full packs.
#[inline(always)]
pub fn add_columns(out: &mut [f64], columns: &[f64], x: &[f64]) {
    let rows = out.len();
    let mut at = 0;
    // Two packs of rows at a time stay in registers while all columns pass.
    while at + 2 * LANES <= rows {
        let mut sums = [Pack::read(&out[at..]), Pack::read(&out[at + LANES..])];
        for (column, f) in columns.chunks_exact(rows).zip(x) {
            let f = Pack::splat(*f);
            sums[0] = f.mul_add(Pack::read(&column[at..at + LANES]), sums[0]);
            sums[1] = f.mul_add(Pack::read(&column[at + LANES..at + 2 * LANES]), sums[1]);
        }
        sums[0].write(&mut out[at..]);
        sums[1].write(&mut out[at + LANES..]);
        at += 2 * LANES;
    }
    while at < rows {
        let mut sum = Pack::read(&out[at..]);
        for (column, f) in columns.chunks_exact(rows).zip(x) {
            sum = Pack::splat(*f).mul_add(Pack::read(&column[at..at + LANES]), sum);
        }
        sum.write(&mut out[at..]);
        at += LANES;
    }
}

/// Solves (`matrix` + diag(`diagonal`)) x = `x` in place by Gauss-Jordan elimination without pivoting,
/// for positive definite matrices; `false` if a pivot is not positive. `matrix` is row-major with
/// rows of `stride` numbers (full packs), of which the first `size` count; `work` is as large.
#[inline(always)]
pub fn solve_with_diagonal(
    matrix: &[f64],
    diagonal: &[f64],
    x: &mut [f64],
    size: usize,
    stride: usize,
    work: &mut [f64],
) -> bool {
    work[..size * stride].copy_from_slice(&matrix[..size * stride]);
    for i in 0..size {
        work[i * stride + i] += diagonal[i];
    }
    for k in 0..size {
        let pivot = work[k * stride + k];
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        let inverse = 1.0 / pivot;
        let (first, right) = (k / LANES * LANES, x[k]);
        let (above, rest) = work[..size * stride].split_at_mut(k * stride);
        let (row_k, below) = rest.split_at_mut(stride);
        let (x_above, x_rest) = x[..size].split_at_mut(k);
        let rows = above.chunks_exact_mut(stride).zip(x_above);
        for (row, x) in rows.chain(below.chunks_exact_mut(stride).zip(&mut x_rest[1..])) {
            let factor = row[k] * inverse;
            *x -= factor * right;
            let negative = Pack::splat(-factor);
            for at in (first..stride).step_by(LANES) {
                let updated = negative
                    .mul_add(Pack::read(&row_k[at..at + LANES]), Pack::read(&row[at..at + LANES]));
                updated.write(&mut row[at..at + LANES]);
            }
        }
        row_k[k] = inverse;
    }
    for k in 0..size {
        x[k] *= work[k * stride + k];
    }
    true
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
        let diagonal = vec![0.25; size];
        let stride = 16;
        let mut wide = vec![0.0; size * stride];
        let mut shifted = a.clone();
        for i in 0..size {
            wide[i * stride..i * stride + size].copy_from_slice(&a[i * size..(i + 1) * size]);
            shifted[i * size + i] += diagonal[i];
        }
        let row = |i: usize| &shifted[i * size..(i + 1) * size];
        let mut by_jordan: Vec<f64> = (0..size).map(|i| dot(row(i), &x)).collect();
        let mut work = wide.clone();
        assert!(solve_with_diagonal(&wide, &diagonal, &mut by_jordan, size, stride, &mut work));
        let mut inverse = a;
        assert!(invert(&mut inverse, size));
        for i in 0..size {
            let by_inverse = dot(&inverse[i * size..(i + 1) * size], &b);
            assert!((by_lu[i] - x[i]).abs() < 1e-13 && (by_inverse - x[i]).abs() < 1e-13);
            assert!((by_jordan[i] - x[i]).abs() < 1e-13);
        }
    }
}
