//! The inverse of a small matrix, many times per millisecond: Gauss-Jordan without pivoting, on rows of packs.

use crate::pack::{Pack, LANES};

/// Inverts the first `size` rows and columns of a matrix whose symmetric part is positive definite, in
/// place (Gauss-Jordan without pivoting); `false` if a pivot is not positive. Rows are `n` packs; `room` is
/// two rows.
///
/// Two pivots at a time, because going through the matrix costs more than what is done to a row.
#[inline(always)]
pub fn invert_rows(matrix: &mut [Pack], n: usize, size: usize, room: &mut [Pack]) -> bool {
    let matrix = &mut matrix[..size * n];
    if n == 1 {
        if let Ok(rows) = <&mut [Pack; LANES]>::try_from(&mut *matrix) {
            return invert_eight(rows);
        }
    }
    for pair in 0..size / 2 {
        if !two_pivots(matrix, n, 2 * pair, room) {
            return false;
        }
    }
    size.is_multiple_of(2) || last_pivot(matrix, n, size - 1, room)
}

/// [`invert_rows`] for eight rows of one pack: nothing is left to be checked or to be found out at run time.
#[inline(always)]
fn invert_eight(rows: &mut [Pack; LANES]) -> bool {
    let mut k = 0;
    while k < LANES - 1 {
        let (x, y) = (rows[k], rows[k + 1]);
        let block = [[x.0[k], x.0[k + 1]], [y.0[k], y.0[k + 1]]];
        let Some(block) = invert_block(block) else { return false };
        let [[corner, upper], [lower, q]] = block.map(|row| row.map(Pack::splat));
        let (x, y) = (KEEP[k].mul_add(x, UNIT[k]), KEEP[k].mul_add(y, UNIT[k + 1]));
        let (a, b) = (corner.mul_add(x, upper * y), lower.mul_add(x, q * y));
        for row in rows.iter_mut() {
            let (x, y) = (Pack::splat(row.0[k]), Pack::splat(row.0[k + 1]));
            *row = (-y).mul_add(b, (-x).mul_add(a, KEEP[k] * *row));
        }
        (rows[k], rows[k + 1]) = (a, b);
        k += 2;
    }
    true
}

/// Eliminates columns `k` and `k` + 1; both lie in the same pack, since `k` is even.
#[inline(always)]
fn two_pivots(matrix: &mut [Pack], n: usize, k: usize, room: &mut [Pack]) -> bool {
    let (pack, lane) = (k / LANES, k % LANES);
    let (row_a, row_b) = room[..2 * n].split_at_mut(n);
    row_a.copy_from_slice(&matrix[k * n..(k + 1) * n]);
    row_b.copy_from_slice(&matrix[(k + 1) * n..(k + 2) * n]);
    let (upper_row, lower_row) = (row_a[pack].0, row_b[pack].0);
    let block = [[upper_row[lane], upper_row[lane + 1]], [lower_row[lane], lower_row[lane + 1]]];
    let Some([[corner, upper], [lower, q]]) = invert_block(block) else { return false };
    let (corner, upper) = (Pack::splat(corner), Pack::splat(upper));
    let (lower, q) = (Pack::splat(lower), Pack::splat(q));
    let (first, second, keep) = (UNIT[lane], UNIT[lane + 1], KEEP[lane]);
    // Masks instead of single numbers written: a row that was written in parts cannot be read as a whole
    // until all parts have reached the cache.
    row_a[pack] = keep.mul_add(row_a[pack], first);
    row_b[pack] = keep.mul_add(row_b[pack], second);
    for i in 0..n {
        let (x, y) = (row_a[i], row_b[i]);
        row_a[i] = corner.mul_add(x, upper * y);
        row_b[i] = lower.mul_add(x, q * y);
    }
    for row in matrix.chunks_exact_mut(n) {
        let (x, y) = (Pack::splat(row[pack].0[lane]), Pack::splat(row[pack].0[lane + 1]));
        row[pack] = keep * row[pack];
        for i in 0..n {
            row[i] = (-y).mul_add(row_b[i], (-x).mul_add(row_a[i], row[i]));
        }
    }
    matrix[k * n..(k + 1) * n].copy_from_slice(row_a);
    matrix[(k + 1) * n..(k + 2) * n].copy_from_slice(row_b);
    true
}

/// Inverse of two rows of two, `None` if a pivot is not positive.
#[inline(always)]
fn invert_block([[a, b], [c, d]]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let inverse_a = 1.0 / a;
    let schur = d - c * inverse_a * b;
    if !(a > 0.0 && schur > 0.0) {
        return None;
    }
    let q = 1.0 / schur;
    let upper = -b * inverse_a * q;
    Some([[inverse_a - upper * c * inverse_a, upper], [-c * inverse_a * q, q]])
}

/// Eliminates the last column, number `k`.
#[inline(always)]
fn last_pivot(matrix: &mut [Pack], n: usize, k: usize, room: &mut [Pack]) -> bool {
    let (pack, lane) = (k / LANES, k % LANES);
    let own = &mut room[..n];
    own.copy_from_slice(&matrix[k * n..(k + 1) * n]);
    let pivot = own[pack].0[lane];
    if pivot.is_nan() || pivot <= 0.0 {
        return false;
    }
    let (keep, inverse) = (Pack::splat(1.0) - UNIT[lane], Pack::splat(1.0 / pivot));
    own[pack] = keep.mul_add(own[pack], UNIT[lane]);
    for part in own.iter_mut() {
        *part = *part * inverse;
    }
    for row in matrix.chunks_exact_mut(n) {
        let x = Pack::splat(row[pack].0[lane]);
        row[pack] = keep * row[pack];
        for i in 0..n {
            row[i] = (-x).mul_add(own[i], row[i]);
        }
    }
    matrix[k * n..(k + 1) * n].copy_from_slice(own);
    true
}

/// Zeros but for a one in each lane.
pub const UNIT: [Pack; LANES] = {
    let mut unit = [Pack([0.0; LANES]); LANES];
    let mut lane = 0;
    while lane < LANES {
        unit[lane].0[lane] = 1.0;
        lane += 1;
    }
    unit
};

/// Ones but for zeros in each lane and the next one.
const KEEP: [Pack; LANES] = {
    let mut keep = [Pack([1.0; LANES]); LANES];
    let mut lane = 0;
    while lane < LANES - 1 {
        (keep[lane].0[lane], keep[lane].0[lane + 1]) = (0.0, 0.0);
        lane += 1;
    }
    keep
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pack::Aligned;

    #[test]
    fn rows_times_their_inverse_are_ones_on_the_diagonal() {
        // Odd and even sizes, unrolled and wide; symmetric part positive definite, condition about 30.
        for size in [1_usize, 2, 8, 13, 16, 21, 29, 32, 33, 38, 57] {
            let stride = size.div_ceil(LANES) * LANES;
            let entry = |i: usize, j: usize| {
                let apart = i as f64 - j as f64;
                1.0 / (1.0 + apart * apart) + 0.1 * apart.sin() + if i == j { 0.5 } else { 0.0 }
            };
            let n = stride / LANES;
            let mut inverse = Aligned::zeros(size * stride);
            for i in 0..size {
                for j in 0..size {
                    inverse[i * stride + j] = entry(i, j);
                }
            }
            let mut room = vec![Pack::default(); 2 * n];
            assert!(invert_rows(inverse.packs_mut(), n, size, &mut room));
            for i in 0..size {
                for j in 0..size {
                    let one: f64 = (0..size).map(|k| entry(i, k) * inverse[k * stride + j]).sum();
                    let wanted = if i == j { 1.0 } else { 0.0 };
                    assert!(
                        (one - wanted).abs() < 1e-12,
                        "size {size}, row {i}, column {j}: {one}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_is_refused() {
        for size in [2_usize, 3, 40, 41] {
            let stride = size.div_ceil(LANES) * LANES;
            let n = stride / LANES;
            let mut matrix = Aligned::zeros(size * stride);
            for i in 0..size {
                matrix[i * stride + i] = if i == size - 1 { -1.0 } else { 1.0 };
            }
            let mut room = vec![Pack::default(); 2 * n];
            assert!(!invert_rows(matrix.packs_mut(), n, size, &mut room), "{size}");
        }
    }
}
