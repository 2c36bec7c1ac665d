//! What stands for the tread face in contact: the nodes of the mesh, or fewer points through which the face
//! moves as a polynomial (interface reduction of the Craig-Bampton model).

use super::craig_bampton::CraigBampton;
use crate::mesh::Mesh;
use nalgebra::DMatrix;
use std::f64::consts::PI;

/// Contact points of the tread face from the run-in to the run-out edge, edges included.
#[derive(Clone, Debug, PartialEq)]
pub struct Interface {
    /// Their places from the middle of the face \[m\].
    pub x: Vec<f64>,
    /// Length of the face that each stands for \[m\].
    pub weights: Vec<f64>,
}

impl Interface {
    /// The nodes of the mesh.
    pub fn of_mesh(mesh: &Mesh) -> Self {
        Self { x: mesh.x.clone(), weights: mesh.tread_face_weights() }
    }

    /// `count` Gauss-Lobatto points, at least two: dense towards the edges, where the pressure is steep. Their
    /// quadrature is exact to degree 2·`count` − 3.
    ///
    /// Displacements of the face are the polynomials through the points: on a block of 15 mm eight of them are
    /// within 0.5 % of a fine mesh where elements need eleven nodes (`docs/src/speed.md`). The face is stiffer
    /// than the mesh below it, and on blocks of 6 mm the amplitude tells, so that nodes stay the default.
    pub fn gauss_lobatto(mesh: &Mesh, count: usize) -> Self {
        let (first, last) = (mesh.x[0], mesh.x[mesh.x.len() - 1]);
        let (middle, half) = (0.5 * (first + last), 0.5 * (last - first));
        let (points, weights) = lobatto(count);
        let mut x: Vec<f64> = points.iter().map(|xi| middle + half * xi).collect();
        // The edges to the last bit.
        (x[0], x[count - 1]) = (first, last);
        Self { x, weights: weights.iter().map(|w| half * w).collect() }
    }

    /// Number of contact points.
    pub fn points(&self) -> usize {
        self.x.len()
    }

    /// Displacements at the places `at` from those of the points: rows places, columns points (Lagrange's
    /// polynomials in their second barycentric form).
    pub fn interpolation(&self, at: &[f64]) -> DMatrix<f64> {
        let n = self.points();
        // Distances as shares of the face, so that products of many stay in range.
        let scale = 4.0 / (self.x[n - 1] - self.x[0]);
        let weight = |i: usize| {
            let others = (0..n).filter(|j| *j != i);
            1.0 / others.map(|j| scale * (self.x[i] - self.x[j])).product::<f64>()
        };
        let weights: Vec<f64> = (0..n).map(weight).collect();
        let mut out = DMatrix::zeros(at.len(), n);
        for (row, place) in at.iter().enumerate() {
            if let Some(same) = self.x.iter().position(|x| x == place) {
                out[(row, same)] = 1.0;
                continue;
            }
            let terms: Vec<f64> =
                self.x.iter().zip(&weights).map(|(x, w)| w / (scale * (place - x))).collect();
            let sum: f64 = terms.iter().sum();
            for (column, term) in terms.iter().enumerate() {
                out[(row, column)] = term / sum;
            }
        }
        out
    }

    /// `reduced`, whose contact nodes are those of `mesh`, with the face held to the polynomials through these
    /// points (theory eq. 1.4a): C ← TᵀCT, M ← TᵀMT, T the interpolation for both directions.
    pub fn restrict(&self, reduced: &CraigBampton, mesh: &Mesh) -> CraigBampton {
        let shape = self.interpolation(&mesh.x);
        let (nodes, points) = shape.shape();
        let modes = reduced.basis.ncols() - 2 * nodes;
        let mut t = DMatrix::zeros(2 * nodes + modes, 2 * points + modes);
        for axis in 0..2 {
            t.view_mut((axis * nodes, axis * points), (nodes, points)).copy_from(&shape);
        }
        t.view_mut((2 * nodes, 2 * points), (modes, modes)).fill_with_identity();
        CraigBampton {
            stiffness: t.transpose() * &reduced.stiffness * &t,
            mass: t.transpose() * &reduced.mass * &t,
            basis: &reduced.basis * &t,
            contact_nodes: points,
        }
    }
}

/// Gauss-Lobatto points on \[−1, 1\] and their weights: the ends and the extrema of Legendre's polynomial of
/// degree `count` − 1, by Newton's method from the Chebyshev points.
fn lobatto(count: usize) -> (Vec<f64>, Vec<f64>) {
    let degree = count - 1;
    let p = degree as f64;
    // P and the one before it at x.
    let legendre = |x: f64| {
        let (mut before, mut now) = (1.0, x);
        for k in 2..=degree {
            let k = k as f64;
            (before, now) = (now, ((2.0 * k - 1.0) * x * now - (k - 1.0) * before) / k);
        }
        (before, now)
    };
    let point = |i: usize| {
        let mut x = -(PI * i as f64 / p).cos();
        for _ in 0..20 {
            let (before, now) = legendre(x);
            x -= (x * now - before) / ((p + 1.0) * now);
        }
        x
    };
    let points: Vec<f64> = (0..count).map(point).collect();
    let weights = points.iter().map(|x| 2.0 / (p * (p + 1.0) * legendre(*x).1.powi(2))).collect();
    (points, weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::check::elements_for;

    #[test]
    fn five_points_and_weights_are_those_of_the_closed_form() {
        // Abramowitz and Stegun, 25.4.32: 0, ±√(3/7), ±1 with 32/45, 49/90, 1/10.
        let (x, w) = lobatto(5);
        let exact_x = [-1.0, -(3.0_f64 / 7.0).sqrt(), 0.0, (3.0_f64 / 7.0).sqrt(), 1.0];
        let exact_w = [0.1, 49.0 / 90.0, 32.0 / 45.0, 49.0 / 90.0, 0.1];
        for i in 0..5 {
            assert!((x[i] - exact_x[i]).abs() < 1e-15 && (w[i] - exact_w[i]).abs() < 1e-15);
        }
    }

    #[test]
    fn polynomials_of_their_degree_pass_through_the_points_unchanged() {
        // 22 points and x^21 on a face of 45 mm: exact but for rounding.
        let mesh = Mesh::block(0.045, 0.010, 16, 3);
        let interface = Interface::gauss_lobatto(&mesh, 22);
        let power = |x: f64| (x / 0.0225).powi(21);
        let shape = interface.interpolation(&mesh.x);
        for (row, x) in mesh.x.iter().enumerate() {
            let value: f64 =
                interface.x.iter().enumerate().map(|(i, at)| shape[(row, i)] * power(*at)).sum();
            assert!((value - power(*x)).abs() < 1e-11, "{value} at {x}");
        }
        let length: f64 = interface.weights.iter().sum();
        assert!((length - 0.045).abs() < 1e-15, "weights add up to the length, got {length}");
    }

    #[test]
    fn every_motion_of_the_points_moves_the_nodes_that_the_mesh_is_given_for_them() {
        // Least singular value of T: at 29 nodes it is 0.9 for 12 points but 1e-6 for 29, and the contact solver then
        // finds no solution.
        for points in 4..=40 {
            let mesh = Mesh::block(0.045, 0.010, elements_for(points), 1);
            let shape = Interface::gauss_lobatto(&mesh, points).interpolation(&mesh.x);
            let least = shape.singular_values().min();
            assert!(least > 0.08, "{points} points: {least}");
        }
    }
}
