//! The inverse of a small matrix, many times per millisecond: Gauss-Jordan without pivoting, on rows of packs.

use crate::pack::{Pack, LANES};

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
    let (upper_row, lower_row) = (&rows[k][pack], &rows[k + 1][pack]);
    let block = [[upper_row[lane], upper_row[lane + 1]], [lower_row[lane], lower_row[lane + 1]]];
    let Some([[corner, upper], [lower, q]]) = invert_block(block) else { return false };
    let (corner, upper) = (Pack::splat(corner), Pack::splat(upper));
    let (lower, q) = (Pack::splat(lower), Pack::splat(q));
    let [first, second] = [UNIT[lane], UNIT[lane + 1]];
    let keep = masks::<N>(pack, Pack::splat(1.0) - first - second);
    let (mut row_a, mut row_b) = ([Pack::splat(0.0); N], [Pack::splat(0.0); N]);
    for n in 0..N {
        let (mut x, mut y) = (keep[n] * Pack(rows[k][n]), keep[n] * Pack(rows[k + 1][n]));
        if n == pack {
            (x, y) = (x + first, y + second);
        }
        row_a[n] = corner.mul_add(x, upper * y);
        row_b[n] = lower.mul_add(x, q * y);
    }
    for row in rows.iter_mut() {
        let (x, y) = (Pack::splat(-row[pack][lane]), Pack::splat(-row[pack][lane + 1]));
        for n in 0..N {
            row[n] = y.mul_add(row_b[n], x.mul_add(row_a[n], keep[n] * Pack(row[n]))).0;
        }
    }
    rows[k] = row_a.map(|part| part.0);
    rows[k + 1] = row_b.map(|part| part.0);
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
    for pair in 0..size / 2 {
        if !two_pivots_wide(&mut packs[..size * stride], stride, 2 * pair) {
            return false;
        }
    }
    size.is_multiple_of(2) || last_pivot_wide(&mut packs[..size * stride], stride)
}

/// [`two_pivots`] for rows of `stride` packs.
#[inline(always)]
fn two_pivots_wide(packs: &mut [[f64; LANES]], stride: usize, k: usize) -> bool {
    let (pack, lane) = (k / LANES, k % LANES);
    let (above, rest) = packs.split_at_mut(k * stride);
    let (pivots, below) = rest.split_at_mut(2 * stride);
    let (row_a, row_b) = pivots.split_at_mut(stride);
    let block =
        [[row_a[pack][lane], row_a[pack][lane + 1]], [row_b[pack][lane], row_b[pack][lane + 1]]];
    let Some([[corner, upper], [lower, q]]) = invert_block(block) else { return false };
    let (corner, upper) = (Pack::splat(corner), Pack::splat(upper));
    let (lower, q) = (Pack::splat(lower), Pack::splat(q));
    let [first, second] = [UNIT[lane], UNIT[lane + 1]];
    let keep = Pack::splat(1.0) - first - second;
    row_a[pack] = (keep * Pack(row_a[pack]) + first).0;
    row_b[pack] = (keep * Pack(row_b[pack]) + second).0;
    for (a, b) in row_a.iter_mut().zip(row_b.iter_mut()) {
        let (x, y) = (Pack(*a), Pack(*b));
        *a = corner.mul_add(x, upper * y).0;
        *b = lower.mul_add(x, q * y).0;
    }
    for row in above.chunks_exact_mut(stride).chain(below.chunks_exact_mut(stride)) {
        let (x, y) = (Pack::splat(-row[pack][lane]), Pack::splat(-row[pack][lane + 1]));
        row[pack] = (keep * Pack(row[pack])).0;
        for ((own, a), b) in row.iter_mut().zip(row_a.iter()).zip(row_b.iter()) {
            *own = y.mul_add(Pack(*b), x.mul_add(Pack(*a), Pack(*own))).0;
        }
    }
    true
}

/// [`last_pivot`] for rows of `stride` packs.
#[inline(always)]
fn last_pivot_wide(packs: &mut [[f64; LANES]], stride: usize) -> bool {
    let k = packs.len() / stride - 1;
    let (pack, lane) = (k / LANES, k % LANES);
    let (above, row) = packs.split_at_mut(k * stride);
    let pivot = row[pack][lane];
    if pivot.is_nan() || pivot <= 0.0 {
        return false;
    }
    let (keep, inverse) = (Pack::splat(1.0) - UNIT[lane], Pack::splat(1.0 / pivot));
    row[pack] = (keep * Pack(row[pack]) + UNIT[lane]).0;
    for part in row.iter_mut() {
        *part = (Pack(*part) * inverse).0;
    }
    for other in above.chunks_exact_mut(stride) {
        let negative = Pack::splat(-other[pack][lane]);
        other[pack] = (keep * Pack(other[pack])).0;
        for (own, part) in other.iter_mut().zip(row.iter()) {
            *own = negative.mul_add(Pack(*part), Pack(*own)).0;
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_times_their_inverse_are_ones_on_the_diagonal() {
        // Odd and even sizes, unrolled and wide; symmetric part positive definite, condition about 30.
        for size in [1_usize, 2, 8, 13, 16, 21, 29, 32, 33, 38, 57] {
            let stride = size.div_ceil(LANES) * LANES;
            let entry = |i: usize, j: usize| {
                let apart = i as f64 - j as f64;
                1.0 / (1.0 + apart * apart) + 0.1 * apart.sin() + if i == j { 0.5 } else { 0.0 }
            };
            let mut inverse = vec![0.0; size * stride];
            for i in 0..size {
                for j in 0..size {
                    inverse[i * stride + j] = entry(i, j);
                }
            }
            assert!(invert_rows(&mut inverse, size));
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
            let mut matrix = vec![0.0; size * stride];
            for i in 0..size {
                matrix[i * stride + i] = if i == size - 1 { -1.0 } else { 1.0 };
            }
            assert!(!invert_rows(&mut matrix, size), "{size}");
        }
    }
}
