//! The inverse of the tangential Newton matrix, kept from one iteration and step to the next: mended node by node
//! where a slope has changed much, corrected while it is applied for what is left, made anew where neither serves.

use super::flat::{columns, FlatMatrices};
use super::{dense, gauss_jordan};
use crate::pack::{Aligned, Pack, LANES};

/// How closely an inverse has to fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Closeness {
    /// Convergence is slow.
    pub(super) slow: bool,
    /// Newton's method may stop early.
    pub(super) early: bool,
}

impl Closeness {
    /// Change of a slope, as a share of what resists at the node, up to which corrections serve.
    fn same_slope(self) -> f64 {
        match (self.early, self.slow) {
            (false, false) => 0.3,
            (false, true) => 0.03,
            (true, false) => 0.5,
            (true, true) => 0.1,
        }
    }
}

/// Corrections for what slopes have changed: each multiplies the error by that share.
const CORRECTIONS: usize = 2;
/// A share of the nodes, one in this many, may be mended; with more, an inverse made anew costs no more.
const MENDED: usize = 3;
/// Nodes mended before the inverse is made anew, lest rounding adds up.
const MENDED_IN_ALL: f64 = 64.0;
/// Least pivot of a mended node, as a share of the one before: below it the matrix is nearly singular.
const LEAST_PIVOT: f64 = 0.05;

/// K⁻¹ = (B + g − c Pᵀ)⁻¹ for the slopes g and c that were kept with it.
#[derive(Clone, Debug)]
pub(super) struct KeptInverse {
    /// Column by column.
    columns: Aligned,
    /// g: slope of the tangential force by the tangential speed \[N s/m\].
    slope: Aligned,
    /// c: the same by the normal speed \[N s/m\].
    coupling: Aligned,
    known: bool,
    /// It holds for the slopes as they stand, without corrections.
    exact: bool,
    /// Nodes mended since it was made.
    mended: f64,
    /// Two rows: of the elimination, of what is beyond and a column that is mended, of corrections.
    room: Aligned,
    nodes: usize,
}

impl KeptInverse {
    pub(super) fn new(nodes: usize, stride: usize) -> Self {
        Self {
            columns: Aligned::zeros(stride * columns(nodes)),
            slope: Aligned::zeros(stride),
            coupling: Aligned::zeros(stride),
            known: false,
            exact: false,
            mended: 0.0,
            room: Aligned::zeros(2 * stride),
            nodes,
        }
    }

    /// The inverse is made anew before it is used again.
    pub(super) fn forget(&mut self) {
        self.known = false;
    }

    /// What a stage carries to the next one, as numbers.
    pub(super) fn save(&self, out: &mut Vec<f64>) {
        out.extend([f64::from(u8::from(self.known)), self.mended]);
        for part in [&self.slope, &self.coupling, &self.columns] {
            out.extend_from_slice(part);
        }
    }

    /// Reads what [`Self::save`] wrote; returns the rest, or `None` if there is too little.
    pub(super) fn restore<'a>(&mut self, from: &'a [f64]) -> Option<&'a [f64]> {
        let ([known, mended], mut from) = from.split_first_chunk()?;
        for part in [&mut self.slope, &mut self.coupling, &mut self.columns] {
            let (own, rest) = from.split_at_checked(part.len())?;
            part.copy_from_slice(own);
            from = rest;
        }
        (self.known, self.mended) = (*known == 1.0, *mended);
        Some(from)
    }

    /// Makes the inverse fit for `slope` and `coupling`; `false` if K is not positive definite.
    #[inline(always)]
    pub(super) fn fit(
        &mut self,
        n: usize,
        m: &FlatMatrices,
        slope: &[Pack],
        coupling: &[Pack],
        closeness: Closeness,
    ) -> bool {
        self.exact = false;
        if self.known && self.mend(n, m, slope, closeness.same_slope()) {
            return true;
        }
        self.slope.packs_mut()[..n].copy_from_slice(&slope[..n]);
        self.coupling.packs_mut()[..n].copy_from_slice(&coupling[..n]);
        self.known = self.make(n, m);
        (self.exact, self.mended) = (true, 0.0);
        self.known
    }

    /// K⁻¹ for the slopes that are kept; `false` if K is not positive definite.
    #[inline(always)]
    fn make(&mut self, n: usize, m: &FlatMatrices) -> bool {
        let (slope, coupling) = (&self.slope.packs()[..n], &self.coupling.packs()[..n]);
        // Row by row the transpose: its inverse then stands column by column.
        let columns = &mut self.columns.packs_mut()[..self.nodes * n];
        let given = m.by_tangential.packs().chunks_exact(2 * n);
        for (i, (to, column)) in columns.chunks_exact_mut(n).zip(given).enumerate() {
            let (b, p) = column.split_at(n);
            for k in 0..n {
                to[k] = (-coupling[k]).mul_add(p[k], b[k]);
            }
            // The diagonal by a whole pack, see `gauss_jordan`.
            let (pack, lane) = (i / LANES, i % LANES);
            to[pack] = gauss_jordan::UNIT[lane].mul_add(slope[pack], to[pack]);
        }
        gauss_jordan::invert_rows(columns, n, self.nodes, self.room.packs_mut())
    }

    /// Mends the inverse for the nodes whose slope has changed too much for corrections; `false`, with an inverse
    /// that is of no more use, if they are too many or K is no longer positive definite.
    #[inline(always)]
    fn mend(&mut self, n: usize, m: &FlatMatrices, slope: &[Pack], same: f64) -> bool {
        let own = &m.resistance.packs()[..n];
        let kept = &self.slope.packs()[..n];
        let beyond = &mut self.room.packs_mut()[..n];
        let mut farthest = Pack::splat(f64::MIN);
        for k in 0..n {
            let change = (slope[k] - kept[k]).abs();
            beyond[k] = change - Pack::splat(same) * (own[k] + slope[k].min(kept[k]));
            farthest = farthest.max(beyond[k]);
        }
        // By way of memory: what ends there becomes vector instructions.
        self.room.packs_mut()[n] = farthest;
        if farthest.largest() <= 0.0 {
            return true;
        }
        let count = self.room[..self.nodes].iter().filter(|beyond| **beyond > 0.0).count();
        if MENDED * count > self.nodes || self.mended >= MENDED_IN_ALL {
            return false;
        }
        self.mended += count as f64;
        for i in 0..self.nodes {
            if self.room[i] > 0.0 && !self.mend_node(n, i, slope[i / LANES].0[i % LANES]) {
                return false;
            }
        }
        true
    }

    /// Gives node `i` another slope (Sherman and Morrison): K⁻¹ − K⁻¹eᵢ eᵢᵀK⁻¹ · δ/(1 + δ eᵢᵀK⁻¹eᵢ).
    #[inline(always)]
    fn mend_node(&mut self, n: usize, i: usize, slope: f64) -> bool {
        let (pack, lane) = (i / LANES, i % LANES);
        let change = slope - self.slope[i];
        let columns = &mut self.columns.packs_mut()[..self.nodes * n];
        let own = &mut self.room.packs_mut()[n..2 * n];
        own.copy_from_slice(&columns[i * n..(i + 1) * n]);
        let pivot = 1.0 + change * own[pack].0[lane];
        if pivot.is_nan() || pivot < LEAST_PIVOT {
            return false;
        }
        let factor = -change / pivot;
        for column in columns.chunks_exact_mut(n) {
            let weight = Pack::splat(factor * column[pack].0[lane]);
            for k in 0..n {
                column[k] = weight.mul_add(own[k], column[k]);
            }
        }
        self.slope[i] = slope;
        true
    }

    /// x = K'⁻¹ `residual` and [B; Pᵀ] x for slopes K' that may have changed: x ← K⁻¹ (`residual` − (K' − K) x).
    ///
    /// B x is what is left of K x, which is known.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    pub(super) fn solve(
        &mut self,
        n: usize,
        m: &FlatMatrices,
        slope: &[Pack],
        coupling: &[Pack],
        residual: &[Pack],
        x: &mut [Pack],
        of_x: &mut [Pack],
    ) {
        let (columns, by_tangential) = (self.columns.packs(), m.by_tangential.packs());
        let (kept_slope, kept_coupling) = (&self.slope.packs()[..n], &self.coupling.packs()[..n]);
        let left = &mut self.room.packs_mut()[..n];
        left.copy_from_slice(&residual[..n]);
        let (b_x, p_x) = of_x[..2 * n].split_at_mut(n);
        let corrections = if self.exact { 0 } else { CORRECTIONS };
        for correction in 0..=corrections {
            dense::multiply(x, columns, left);
            dense::multiply_below(p_x, by_tangential, x);
            if correction == corrections {
                break;
            }
            for k in 0..n {
                let by_slope = (slope[k] - kept_slope[k]).mul_add(-x[k], residual[k]);
                left[k] = (coupling[k] - kept_coupling[k]).mul_add(p_x[k], by_slope);
            }
        }
        for k in 0..n {
            b_x[k] = kept_coupling[k].mul_add(p_x[k], kept_slope[k].mul_add(-x[k], left[k]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mended_and_corrected_inverse_solves_for_the_slopes_as_they_stand() {
        // Reference: the residual of the equations themselves. B has condition about 30; two of eight slopes change
        // by much, the others and the coupling by a fiftieth: corrections leave its cube, 1e-5, at most.
        let (nodes, n) = (8, 1);
        let apart = |i: usize, j: usize| 1.0 / (1.0 + (i as f64 - j as f64).powi(2));
        let b = |i: usize, j: usize| apart(i, j) + if i == j { 0.5 } else { 0.0 };
        let p_t = |i: usize, j: usize| 0.2 * (0.3 * i as f64 - 0.5 * j as f64).sin();
        let mut m = FlatMatrices::new(nodes, nodes);
        for j in 0..nodes {
            for i in 0..nodes {
                m.by_tangential[16 * j + i] = b(i, j);
                m.by_tangential[16 * j + 8 + i] = p_t(i, j);
            }
            m.resistance[j] = b(j, j);
        }
        let packed =
            |f: &dyn Fn(usize) -> f64| [Pack([f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7)])];
        let mut inverse = KeptInverse::new(nodes, nodes);
        let old = |i: usize| 0.1 * i as f64;
        let (slope, coupling) = (packed(&old), packed(&|i| 0.3 - 0.05 * i as f64));
        let loosely = Closeness { slow: false, early: false };
        assert!(inverse.fit(n, &m, &slope, &coupling, loosely));
        let new = |i: usize| if i % 4 == 1 { 5.0 } else { 1.02 * old(i) };
        let (slope, coupling) = (packed(&new), packed(&|i| 0.306 - 0.051 * i as f64));
        assert!(inverse.fit(n, &m, &slope, &coupling, loosely));
        assert_eq!(inverse.mended, 2.0);
        let residual = packed(&|i| (i as f64).cos());
        let (mut x, mut of_x) = ([Pack::default()], [Pack::default(); 2]);
        inverse.solve(n, &m, &slope, &coupling, &residual, &mut x, &mut of_x);
        for i in 0..nodes {
            let row = |j: usize| b(i, j) - coupling[0].0[i] * p_t(i, j);
            let sum: f64 = (0..nodes).map(|j| row(j) * x[0].0[j]).sum();
            let off = sum + slope[0].0[i] * x[0].0[i] - residual[0].0[i];
            assert!(off.abs() < 1e-5, "row {i}: {off}");
            // B x and Pᵀ x, of which the first is found without a product.
            for (found, matrix) in of_x.iter().zip([&b as &dyn Fn(usize, usize) -> f64, &p_t]) {
                let sum: f64 = (0..nodes).map(|j| matrix(i, j) * x[0].0[j]).sum();
                assert!((found.0[i] - sum).abs() < 1e-12, "row {i}: {} for {sum}", found.0[i]);
            }
        }
    }
}
