//! Sparse times dense matrix. The library's product goes through a checked lookup per number and took half of the time
//! in which a block is built.

use nalgebra::DMatrix;
use nalgebra_sparse::CscMatrix;

/// `matrix` · `dense`.
pub fn product(matrix: &CscMatrix<f64>, dense: &DMatrix<f64>) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(matrix.nrows(), dense.ncols());
    let (offsets, rows, values) = matrix.csc_data();
    for (from, mut to) in dense.column_iter().zip(out.column_iter_mut()) {
        let to = to.as_mut_slice();
        for (x, ends) in from.iter().zip(offsets.windows(2)) {
            let entries = ends[0]..ends[1];
            for (row, value) in rows[entries.clone()].iter().zip(&values[entries]) {
                to[*row] += value * x;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra_sparse::CooMatrix;

    #[test]
    fn it_is_the_product_of_the_library() {
        let mut entries = CooMatrix::new(7, 5);
        for k in 0..12_usize {
            entries.push((3 * k) % 7, (2 * k) % 5, 1.0 + (k as f64).sin());
        }
        let sparse = CscMatrix::from(&entries);
        let dense = DMatrix::from_fn(5, 3, |i, j| (i as f64 - 2.0 * j as f64).cos());
        assert!((product(&sparse, &dense) - &sparse * &dense).amax() < 1e-14);
    }
}
