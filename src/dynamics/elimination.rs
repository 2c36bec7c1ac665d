//! A small linear system, solved once with each matrix: Gaussian elimination without pivoting, on rows of packs.

use super::gauss_jordan::UNIT;
use crate::pack::{Pack, LANES};

/// Solves K x = r for K whose symmetric part is positive definite; `false` if a pivot vanishes.
///
/// Row i of `rows` holds Kᵢ of `size` numbers, then rᵢ, then zeros that fill the last of `width` packs; `x` is as wide
/// and holds −1 after the solution. Two pivots at a time, because going through the matrix costs more than what is
/// done to a row.
#[inline(always)]
pub fn solve_rows(rows: &mut [Pack], width: usize, size: usize, x: &mut [Pack]) -> bool {
    let rows = &mut rows[..size * width];
    for pair in 0..size / 2 {
        if !two_pivots(rows, width, 2 * pair) {
            return false;
        }
    }
    let x = &mut x[..width];
    x.fill(Pack::default());
    put(x, size, -1.0);
    for i in (0..size).rev() {
        let (pack, lane) = (i / LANES, i % LANES);
        let row = &rows[i * width + pack..(i + 1) * width];
        let mut sums = Pack::default();
        for (u, x) in row.iter().zip(&x[pack..]) {
            sums = u.mul_add(*x, sums);
        }
        let pivot = row[0].0[lane];
        if !usable(pivot) {
            return false;
        }
        put(x, i, -sums.sum() / pivot);
    }
    true
}

/// Packs of a row that holds `size` numbers of a matrix and one of a right-hand side.
pub fn width(size: usize) -> usize {
    (size + 1).div_ceil(LANES)
}

/// Eliminates columns `k` and `k` + 1 below their rows; both lie in the same pack, since `k` is even.
#[inline(always)]
fn two_pivots(rows: &mut [Pack], width: usize, k: usize) -> bool {
    let (pack, lane) = (k / LANES, k % LANES);
    let (above, below) = rows.split_at_mut((k + 2) * width);
    let (first, second) = above[k * width..].split_at_mut(width);
    // What is to the left is not needed any more.
    let (first, second) = (&first[pack..], &mut second[pack..]);
    let packs = first.len();
    let second = &mut second[..packs];
    let per_first = 1.0 / first[0].0[lane];
    let share = Pack::splat(-second[0].0[lane] * per_first);
    for i in 0..packs {
        second[i] = share.mul_add(first[i], second[i]);
    }
    let (upper, pivot) = (first[0].0[lane + 1], second[0].0[lane + 1]);
    if !(usable(first[0].0[lane]) && usable(pivot)) {
        return false;
    }
    let per_second = 1.0 / pivot;
    for row in below.chunks_exact_mut(width) {
        let row = &mut row[pack..][..packs];
        let of_first = row[0].0[lane] * per_first;
        let of_second = (row[0].0[lane + 1] - of_first * upper) * per_second;
        let (of_first, of_second) = (Pack::splat(-of_first), Pack::splat(-of_second));
        for i in 0..packs {
            row[i] = of_second.mul_add(second[i], of_first.mul_add(first[i], row[i]));
        }
    }
    true
}

fn usable(pivot: f64) -> bool {
    pivot.is_finite() && pivot.abs() > f64::MIN_POSITIVE
}

/// Number `i` of `x`, which is 0, becomes `value`: by a whole pack, since one that was written in parts cannot be read
/// as a whole until all parts have reached the cache.
#[inline(always)]
fn put(x: &mut [Pack], i: usize, value: f64) {
    x[i / LANES] = UNIT[i % LANES].mul_add(Pack::splat(value), x[i / LANES]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pack::Aligned;

    #[test]
    fn the_solution_satisfies_the_equations_to_rounding() {
        // Odd and even sizes, packs just full and just not; symmetric part positive definite, condition about 30.
        for size in [1_usize, 2, 7, 8, 13, 16, 41, 42] {
            let entry = |i: usize, j: usize| {
                let apart = i as f64 - j as f64;
                1.0 / (1.0 + apart * apart) + 0.1 * apart.sin() + if i == j { 0.5 } else { 0.0 }
            };
            let right = |i: usize| (0.7 * i as f64).cos();
            let width = width(size);
            let mut rows = Aligned::zeros(size * width * LANES);
            for i in 0..size {
                for j in 0..size {
                    rows[i * width * LANES + j] = entry(i, j);
                }
                rows[i * width * LANES + size] = right(i);
            }
            let mut x = Aligned::zeros(width * LANES);
            assert!(solve_rows(rows.packs_mut(), width, size, x.packs_mut()));
            for i in 0..size {
                let sum: f64 = (0..size).map(|j| entry(i, j) * x[j]).sum();
                assert!((sum - right(i)).abs() < 1e-12, "size {size}, row {i}: {sum}");
            }
        }
    }

    #[test]
    fn a_matrix_without_pivots_is_refused() {
        for size in [1_usize, 2, 9] {
            let width = width(size);
            let mut rows = vec![Pack::default(); size * width];
            assert!(!solve_rows(&mut rows, width, size, &mut vec![Pack::default(); width]));
        }
    }
}
