//! Dense kernels on plain slices: no allocation, fixed order of summation, shapes that vectorise.

use crate::pack::{Pack, LANES};

/// `out` = Σⱼ `columns`ⱼ xⱼ; `columns` holds column j at `j * out.len()` packs, for every number of the packs `x`.
#[inline(always)]
pub fn multiply(out: &mut [Pack], columns: &[Pack], x: &[Pack]) {
    product(out, columns, [0, out.len()], x);
}

/// [`multiply`] with the lower halves of columns that are twice as high as `out`.
#[inline(always)]
pub fn multiply_below(out: &mut [Pack], columns: &[Pack], x: &[Pack]) {
    product(out, columns, [out.len(), 2 * out.len()], x);
}

/// [`multiply`] with the packs of columns from one to the other; columns are as high as the last of them.
#[inline(always)]
fn product(out: &mut [Pack], columns: &[Pack], [from, height]: [usize; 2], x: &[Pack]) {
    let mut at = 0;
    while at < out.len() {
        // As many rows at a time as sixteen registers hold while all columns pass; of few rows two sums, so that a product
        // need not wait for the one before.
        at += match out.len() - at {
            1 => rows::<1, 2>(out, at, columns, [from, height], x),
            2 => rows::<2, 2>(out, at, columns, [from, height], x),
            3 => rows::<3, 2>(out, at, columns, [from, height], x),
            4 | 8 => rows::<4, 1>(out, at, columns, [from, height], x),
            5 | 9 | 10 => rows::<5, 1>(out, at, columns, [from, height], x),
            7 | 13 | 14 => rows::<7, 1>(out, at, columns, [from, height], x),
            _ => rows::<6, 1>(out, at, columns, [from, height], x),
        };
    }
}

/// [`product`] for the `N` packs of `out` from number `at` on; returns `N`. Columns go to `SUMS` sums in turn.
#[inline(always)]
fn rows<const N: usize, const SUMS: usize>(
    out: &mut [Pack],
    at: usize,
    columns: &[Pack],
    [from, height]: [usize; 2],
    x: &[Pack],
) -> usize {
    let mut sums = [[Pack::default(); N]; SUMS];
    let first = from + at;
    // Said once, so that it need not be checked in every column.
    assert!(first + N <= height, "rows beyond the end of a column");
    let mut columns = columns.chunks_exact(height);
    for x in x {
        for pair in 0..LANES / 2 {
            let [Some(even), Some(odd)] = [columns.next(), columns.next()] else { break };
            let (even, odd) = (&even[first..first + N], &odd[first..first + N]);
            let (a, b) = (Pack::splat(x.0[2 * pair]), Pack::splat(x.0[2 * pair + 1]));
            for n in 0..N {
                sums[0][n] = a.mul_add(even[n], sums[0][n]);
            }
            for n in 0..N {
                sums[SUMS - 1][n] = b.mul_add(odd[n], sums[SUMS - 1][n]);
            }
        }
    }
    let out = &mut out[at..at + N];
    for n in 0..N {
        out[n] = if SUMS == 2 { sums[0][n] + sums[SUMS - 1][n] } else { sums[0][n] };
    }
    N
}

/// Σ aᵢ bᵢ of plain numbers, in eight interleaved partial sums, so that none waits for the one before.
#[inline(always)]
pub fn scalar_product(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let mut sums = Pack::default();
    for (a, b) in a.iter().zip(b) {
        sums += Pack(*a) * Pack(*b);
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.sum() + rest
}

/// `to` += `weight` · `row`.
#[inline(always)]
pub fn add(to: &mut [f64], weight: f64, row: &[f64]) {
    for (to, value) in to.iter_mut().zip(row) {
        *to += weight * value;
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
            add(row, -factor, row_k);
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

/// Dot product of numbers in packs, in eight interleaved partial sums that are left in `sums`: what ends in
/// memory becomes vector instructions.
#[inline(always)]
pub fn dot(a: &[Pack], b: &[Pack], sums: &mut Pack) -> f64 {
    let mut own = Pack::default();
    for (x, y) in a.iter().zip(b) {
        own = x.mul_add(*y, own);
    }
    *sums = own;
    own.sum()
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
    fn the_inverse_solves_to_rounding() {
        let size = 13;
        let a = example(size);
        let x: Vec<f64> = (0..size).map(|i| (i as f64).sin()).collect();
        let row = |i: usize| &a[i * size..(i + 1) * size];
        let b: Vec<f64> = (0..size).map(|i| scalar_product(row(i), &x)).collect();
        let mut inverse = a.clone();
        assert!(invert(&mut inverse, size));
        for i in 0..size {
            let found = scalar_product(&inverse[i * size..(i + 1) * size], &b);
            assert!((found - x[i]).abs() < 1e-13);
        }
    }
}
