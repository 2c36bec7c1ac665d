//! Structured mesh of the rectangular block: biquadratic quadrilaterals, named edges.

/// Mesh of a block of length × height, x along the road, z up from the tread face.
///
/// Nodes are numbered column by column from the run-in edge (x = −l/2), in each column from the tread
/// face (z = 0) to the clamped face (z = h), so that the stiffness matrix has a small bandwidth.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// x of the node columns \[m\], 2 per element plus one.
    pub x: Vec<f64>,
    /// z of the node rows \[m\], 2 per element plus one.
    pub z: Vec<f64>,
}

impl Mesh {
    /// A block of `length` × `height` \[m\] with `along` × `up` elements, graded towards the edges
    /// of the tread face and towards the face itself, where contact makes the stresses steep.
    pub fn block(length: f64, height: f64, along: usize, up: usize) -> Self {
        let x = nodes(&graded_both_ends(along, EDGE_GRADING), length, -0.5 * length);
        let z = nodes(&graded_one_end(up, FACE_GRADING), height, 0.0);
        Self { x, z }
    }

    /// Number of elements along the road and up.
    pub fn elements(&self) -> (usize, usize) {
        ((self.x.len() - 1) / 2, (self.z.len() - 1) / 2)
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.x.len() * self.z.len()
    }

    /// Node in column `i`, row `j`.
    pub fn node(&self, i: usize, j: usize) -> usize {
        i * self.z.len() + j
    }

    /// Position \[m\] of a node.
    pub fn position(&self, node: usize) -> [f64; 2] {
        [self.x[node / self.z.len()], self.z[node % self.z.len()]]
    }

    /// Nodes of the tread face from the run-in to the run-out edge.
    pub fn tread_face(&self) -> Vec<usize> {
        (0..self.x.len()).map(|i| self.node(i, 0)).collect()
    }

    /// Nodes of the run-in side from the tread face to the clamped face.
    pub fn run_in_side(&self) -> Vec<usize> {
        (0..self.z.len()).map(|j| self.node(0, j)).collect()
    }

    /// Is the node glued to the belt?
    pub fn is_clamped(&self, node: usize) -> bool {
        node % self.z.len() == self.z.len() - 1
    }

    /// Length of the tread face that each of its nodes stands for \[m\]: Simpson's rule per element,
    /// which is what a biquadratic element makes of an even pressure.
    pub fn tread_face_weights(&self) -> Vec<f64> {
        let mut weights = vec![0.0; self.x.len()];
        for e in 0..self.elements().0 {
            let size = self.x[2 * e + 2] - self.x[2 * e];
            weights[2 * e] += size / 6.0;
            weights[2 * e + 1] += size * 4.0 / 6.0;
            weights[2 * e + 2] += size / 6.0;
        }
        weights
    }
}

/// Ratio of the largest to the smallest element along the face.
const EDGE_GRADING: f64 = 2.0;
/// Ratio of the element at the clamped face to the one at the tread face.
const FACE_GRADING: f64 = 2.0;

/// Element sizes, sum 1, growing geometrically from both ends to the middle.
fn graded_both_ends(count: usize, ratio: f64) -> Vec<f64> {
    let half = (count.max(2) - 1) as f64 / 2.0;
    normalised((0..count).map(|e| {
        let from_end = (e.min(count - 1 - e)) as f64;
        ratio.powf(from_end / half.max(1.0))
    }))
}

/// Element sizes, sum 1, growing geometrically from the first to the last.
fn graded_one_end(count: usize, ratio: f64) -> Vec<f64> {
    let last = (count.max(2) - 1) as f64;
    normalised((0..count).map(|e| ratio.powf(e as f64 / last)))
}

fn normalised(sizes: impl Iterator<Item = f64>) -> Vec<f64> {
    let sizes: Vec<f64> = sizes.collect();
    let total: f64 = sizes.iter().sum();
    sizes.iter().map(|s| s / total).collect()
}

/// Node coordinates: element ends and middles.
fn nodes(sizes: &[f64], total: f64, start: f64) -> Vec<f64> {
    let mut out = vec![start];
    let mut at = start;
    for size in sizes {
        out.push(at + 0.5 * size * total);
        at += size * total;
        out.push(at);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn face_weights_add_up_to_the_length_and_are_symmetric() {
        let mesh = Mesh::block(0.015, 0.010, 7, 5);
        let weights = mesh.tread_face_weights();
        let total: f64 = weights.iter().sum();
        assert!((total - 0.015).abs() < 1e-15, "closed form: the length; got {total}");
        for (a, b) in weights.iter().zip(weights.iter().rev()) {
            assert!((a - b).abs() < 1e-15);
        }
    }
}
