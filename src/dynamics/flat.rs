//! The inverse Delassus matrix with the normal velocities eliminated, in the frame of the road.

use super::dense;
use super::kinematics::Kinematics;
use crate::pack::{Aligned, Pack, LANES};

/// S = \[S_tt S_tn; S_nt S_nn\] with the normal velocities eliminated (theory eq. 3.9): what one vector
/// is multiplied by stands in one matrix, column by column of 2 · stride numbers.
#[derive(Clone, Debug)]
pub struct FlatMatrices {
    /// Slope of the normal force by the normal velocity that the elimination assumes, per node
    /// \[N s/m\].
    pub normal_slope: Aligned,
    /// Diagonal of B \[N s/m\]: how a node resists to sliding faster than the others.
    pub resistance: Aligned,
    /// \[B; Pᵀ\], B = S_tt − P S_nt symmetric, P = S_tn A⁻¹.
    pub by_tangential: Aligned,
    /// \[P; A⁻¹\], A⁻¹ = (S_nn + normal slope)⁻¹ symmetric.
    pub by_normal: Aligned,
    /// sin and cos of the block's angle in the frame of the split.
    frame: [f64; 2],
    /// A⁻¹ and S_tn A⁻¹ while they are made, without padding.
    room: [Aligned; 2],
    /// S in the frame of the split.
    turned: Aligned,
}

/// Ways into the frame of a split, as sin and cos.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turn {
    /// From the block's frame.
    pub(super) of_block: [f64; 2],
    /// From the road's frame, of which the split's may lag behind.
    pub(super) of_road: [f64; 2],
}

impl Turn {
    /// From the split's frame to the block's.
    #[inline(always)]
    pub(super) fn back(&self) -> [f64; 2] {
        let [sin, cos] = self.of_block;
        [-sin, cos]
    }
}

/// (x, z) ← (cos x − sin z, sin x + cos z) for `n` packs of x, then as many of z.
#[inline(always)]
pub(super) fn turn(vectors: &mut [Pack], n: usize, sin_cos: [f64; 2]) {
    let [sin, cos] = sin_cos.map(Pack::splat);
    let (x, z) = vectors[..2 * n].split_at_mut(n);
    for k in 0..n {
        (x[k], z[k]) = (cos.mul_add(x[k], -(sin * z[k])), sin.mul_add(x[k], cos * z[k]));
    }
}

impl FlatMatrices {
    /// Room for `nodes` nodes, `stride` with the padding.
    pub(super) fn new(nodes: usize, stride: usize) -> Self {
        Self {
            normal_slope: Aligned::zeros(stride),
            resistance: Aligned::zeros(stride),
            by_tangential: Aligned::zeros(2 * stride * columns(nodes)),
            by_normal: Aligned::zeros(2 * stride * columns(nodes)),
            frame: [0.0, 1.0],
            room: [(); 2].map(|()| Aligned::zeros(nodes * nodes)),
            turned: Aligned::zeros(4 * nodes * nodes),
        }
    }

    /// How vectors come into the frame of the split while the block moves like this; `None` if they are in it.
    #[inline(always)]
    pub(super) fn turn(&self, motion: &Kinematics) -> Option<Turn> {
        let ([sin, cos], [of_road_sin, of_road_cos]) = (self.frame, motion.sin_cos);
        let turned = sin != 0.0 || of_road_sin != 0.0;
        let of_road =
            [sin * of_road_cos - cos * of_road_sin, cos * of_road_cos + sin * of_road_sin];
        turned.then_some(Turn { of_block: self.frame, of_road })
    }

    /// Splits S of the block's frame in that of a road against which the block is turned by `angle` \[rad\];
    /// `false` if the block is numerically singular.
    pub(super) fn split(
        &mut self,
        s: &[f64],
        angle: f64,
        normal_slope: impl Iterator<Item = f64>,
    ) -> bool {
        for (slope, given) in self.normal_slope.iter_mut().zip(normal_slope) {
            *slope = given;
        }
        if angle == 0.0 {
            self.frame = [0.0, 1.0];
            self.turned.copy_from_slice(s);
        } else {
            self.frame = angle.sin_cos().into();
            turn_matrix(s, self.frame, &mut self.turned);
        }
        self.eliminate()
    }

    /// The split of what stands in `turned`.
    fn eliminate(&mut self) -> bool {
        let (stride, n) = (self.normal_slope.len(), self.turned.len().isqrt() / 2);
        let (tangential, normal) = self.turned.split_at(2 * n * n);
        let [tangential, normal] = [tangential, normal].map(|half| half.chunks_exact(2 * n));
        let [a_inverse, p] = &mut self.room;
        for (i, (to, from)) in a_inverse.chunks_exact_mut(n).zip(normal.clone()).enumerate() {
            to.copy_from_slice(&from[n..]);
            to[i] += self.normal_slope[i];
        }
        if !dense::invert(a_inverse, n) {
            return false;
        }
        p.fill(0.0);
        for (p, s) in p.chunks_exact_mut(n).zip(tangential.clone()) {
            for (s_tn, row) in s[n..].iter().zip(a_inverse.chunks_exact(n)) {
                dense::add(p, *s_tn, row);
            }
        }
        self.by_tangential.fill(0.0);
        self.by_normal.fill(0.0);
        for (i, (s, p)) in tangential.clone().zip(p.chunks_exact(n)).enumerate() {
            let (b, p_t) = self.by_tangential[i * 2 * stride..].split_at_mut(stride);
            b[..n].copy_from_slice(&s[..n]);
            p_t[..n].copy_from_slice(p);
            for (p, s_nt) in p.iter().zip(normal.clone()) {
                dense::add(&mut b[..n], -p, &s_nt[..n]);
            }
            self.resistance[i] = b[i];
            for (j, p) in p.iter().enumerate() {
                self.by_normal[j * 2 * stride + i] = *p;
            }
            let a_inverse = &a_inverse[i * n..(i + 1) * n];
            self.by_normal[i * 2 * stride + stride..][..n].copy_from_slice(a_inverse);
        }
        true
    }
}

/// R S Rᵀ of a symmetric S, R the turn of every node's vector by `sin` and `cos`, see [`turn`].
fn turn_matrix(s: &[f64], [sin, cos]: [f64; 2], out: &mut [f64]) {
    let n = s.len().isqrt() / 2;
    let (ss, sc, cc) = (sin * sin, sin * cos, cos * cos);
    for i in 0..n {
        for j in 0..n {
            let at = |r: usize, c: usize| s[(r * n + i) * 2 * n + c * n + j];
            let (xx, xz, zx, zz) = (at(0, 0), at(0, 1), at(1, 0), at(1, 1));
            let mut put = |r: usize, c: usize, value| out[(r * n + i) * 2 * n + c * n + j] = value;
            put(0, 0, cc * xx - sc * (xz + zx) + ss * zz);
            put(0, 1, sc * (xx - zz) + cc * xz - ss * zx);
            put(1, 0, sc * (xx - zz) + cc * zx - ss * xz);
            put(1, 1, ss * xx + sc * (xz + zx) + cc * zz);
        }
    }
}

/// Columns of a matrix per contact node: an even number, and a full pack, which is compiled without a loop, of few.
pub(super) fn columns(nodes: usize) -> usize {
    nodes.next_multiple_of(2).max(LANES)
}
