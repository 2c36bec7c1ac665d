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

/// Inverts the first `size` rows and columns of a matrix whose symmetric part is positive definite, in
/// place (Gauss-Jordan without pivoting); `false` if a pivot is not positive. Rows are full packs.
#[inline(always)]
pub fn invert_rows(matrix: &mut [f64], size: usize) -> bool {
    let stride = size.div_ceil(LANES);
    let packs = matrix.as_chunks_mut().0;
    match stride {
        1 => gauss_jordan::<1>(packs, size),
        2 => gauss_jordan::<2>(packs, size),
        3 => gauss_jordan::<3>(packs, size),
        4 => gauss_jordan::<4>(packs, size),
        _ => gauss_jordan_wide(packs, size, stride),
    }
}

/// [`invert_rows`] for rows of `N` packs: two pivots at a time, because going through the matrix costs more
/// than what is done to a row.
#[inline(always)]
fn gauss_jordan<const N: usize>(packs: &mut [[f64; LANES]], size: usize) -> bool {
    let rows = &mut packs.as_chunks_mut::<N>().0[..size];
    // No iterator over the pairs: a closure is not compiled for the instruction set of its caller.
    for pair in 0..size / 2 {
        if !two_pivots(rows, 2 * pair) {
            return false;
        }
    }
    size.is_multiple_of(2) || last_pivot(rows)
}

/// Eliminates columns `k` and `k` + 1; both lie in the same pack, since `k` is even.
#[inline(always)]
fn two_pivots<const N: usize>(rows: &mut [[[f64; LANES]; N]], k: usize) -> bool {
    let (pack, lane) = (k / LANES, k % LANES);
    let [a, b] = [rows[k][pack][lane], rows[k][pack][lane + 1]];
    let [c, d] = [rows[k + 1][pack][lane], rows[k + 1][pack][lane + 1]];
    let inverse_a = 1.0 / a;
    let schur = d - c * inverse_a * b;
    if !(a > 0.0 && schur > 0.0) {
        return false;
    }
    // The inverse of the block of pivots.
    let q = 1.0 / schur;
    let (upper, lower) = (-b * inverse_a * q, -c * inverse_a * q);
    let corner = inverse_a - upper * c * inverse_a;
    let [first, second] = [UNIT[lane], UNIT[lane + 1]];
    let keep = masks::<N>(pack, Pack::splat(1.0) - first - second);
    let (mut row_a, mut row_b) = ([Pack::splat(0.0); N], [Pack::splat(0.0); N]);
    for n in 0..N {
        let (mut x, mut y) = (keep[n] * Pack(rows[k][n]), keep[n] * Pack(rows[k + 1][n]));
        if n == pack {
            (x, y) = (x + first, y + second);
        }
        row_a[n] = Pack::splat(corner).mul_add(x, Pack::splat(upper) * y);
        row_b[n] = Pack::splat(lower).mul_add(x, Pack::splat(q) * y);
    }
    for row in rows.iter_mut() {
        let [x, y] = [-row[pack][lane], -row[pack][lane + 1]].map(Pack::splat);
        for n in 0..N {
            row[n] = y.mul_add(row_b[n], x.mul_add(row_a[n], keep[n] * Pack(row[n]))).0;
        }
    }
    rows[k] = row_a.map(|part| part.0);
    rows[k + 1] = row_b.map(|part| part.0);
    true
}

/// Eliminates the last column.
#[inline(always)]
fn last_pivot<const N: usize>(rows: &mut [[[f64; LANES]; N]]) -> bool {
    let k = rows.len() - 1;
    let (pack, lane) = (k / LANES, k % LANES);
    let pivot = rows[k][pack][lane];
    if pivot.is_nan() || pivot <= 0.0 {
        return false;
    }
    let keep = masks::<N>(pack, Pack::splat(1.0) - UNIT[lane]);
    let inverse = Pack::splat(1.0 / pivot);
    let mut pivot_row = [inverse; N];
    for n in 0..N {
        let kept = keep[n] * Pack(rows[k][n]);
        pivot_row[n] = if n == pack { kept + UNIT[lane] } else { kept } * inverse;
    }
    for row in rows.iter_mut() {
        let negative = Pack::splat(-row[pack][lane]);
        for n in 0..N {
            row[n] = negative.mul_add(pivot_row[n], keep[n] * Pack(row[n])).0;
        }
    }
    rows[k] = pivot_row.map(|part| part.0);
    true
}

/// `mask` in one pack of a row, ones in all others. Masks instead of single numbers written: a row that was
/// written in parts cannot be read as a whole until all parts have reached the cache.
#[inline(always)]
fn masks<const N: usize>(pack: usize, mask: Pack) -> [Pack; N] {
    let mut masks = [Pack::splat(1.0); N];
    for (n, own) in masks.iter_mut().enumerate() {
        if n == pack {
            *own = mask;
        }
    }
    masks
}

/// Zeros but for a one in each lane.
const UNIT: [Pack; LANES] = {
    let mut unit = [Pack([0.0; LANES]); LANES];
    let mut lane = 0;
    while lane < LANES {
        unit[lane].0[lane] = 1.0;
        lane += 1;
    }
    unit
};

/// [`invert_rows`] for rows of any number of packs.
#[inline(always)]
fn gauss_jordan_wide(packs: &mut [[f64; LANES]], size: usize, stride: usize) -> bool {
    for k in 0..size {
        let (pack, lane) = (k / LANES, k % LANES);
        let (above, rest) = packs[..size * stride].split_at_mut(k * stride);
        let (pivot_row, below) = rest.split_at_mut(stride);
        let pivot = pivot_row[pack][lane];
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        pivot_row[pack][lane] = 1.0;
        for part in pivot_row.iter_mut() {
            *part = (Pack(*part) * Pack::splat(1.0 / pivot)).0;
        }
        for row in above.chunks_exact_mut(stride).chain(below.chunks_exact_mut(stride)) {
            let negative = Pack::splat(-row[pack][lane]);
            row[pack][lane] = 0.0;
            for (value, part) in row.iter_mut().zip(pivot_row.iter()) {
                *value = negative.mul_add(Pack(*part), Pack(*value)).0;
            }
        }
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
        let stride = 16;
        let mut wide = vec![0.0; size * stride];
        for i in 0..size {
            wide[i * stride..i * stride + size].copy_from_slice(&a[i * size..(i + 1) * size]);
        }
        assert!(invert_rows(&mut wide, size));
        let mut inverse = a;
        assert!(invert(&mut inverse, size));
        for i in 0..size {
            let by_inverse = dot(&inverse[i * size..(i + 1) * size], &b);
            assert!((by_lu[i] - x[i]).abs() < 1e-13 && (by_inverse - x[i]).abs() < 1e-13);
            let by_jordan = dot(&wide[i * stride..i * stride + size], &b);
            assert!((by_jordan - x[i]).abs() < 1e-13);
        }
    }
}
