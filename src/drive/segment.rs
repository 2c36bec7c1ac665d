//! The inputs over one communication step as polynomials of time.

/// Polynomial c₀ + c₁ s + c₂ s² + c₃ s³ of the time s \[s\] since the start of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Cubic(pub [f64; 4]);

impl Cubic {
    /// A constant.
    pub fn constant(value: f64) -> Self {
        Self([value, 0.0, 0.0, 0.0])
    }

    /// A straight line from `value` with `slope`.
    pub fn line(value: f64, slope: f64) -> Self {
        Self([value, slope, 0.0, 0.0])
    }

    /// Cubic Hermite interpolation between two values and their rates over `h` \[s\].
    pub fn hermite(h: f64, (x0, v0): (f64, f64), (x1, v1): (f64, f64)) -> Self {
        let mean = (x1 - x0) / h;
        Self([x0, v0, (3.0 * mean - 2.0 * v0 - v1) / h, (v0 + v1 - 2.0 * mean) / (h * h)])
    }

    /// Value at `s`.
    pub fn at(&self, s: f64) -> f64 {
        let [c0, c1, c2, c3] = self.0;
        c0 + s * (c1 + s * (c2 + s * c3))
    }

    /// First derivative at `s`.
    pub fn rate(&self, s: f64) -> f64 {
        let [_, c1, c2, c3] = self.0;
        c1 + s * (2.0 * c2 + s * 3.0 * c3)
    }

    /// Second derivative at `s`.
    pub fn curvature(&self, s: f64) -> f64 {
        let [_, _, c2, c3] = self.0;
        2.0 * c2 + s * 6.0 * c3
    }
}

/// Belt pose and normal load over one communication step; `s` counts from the start of the step.
///
/// Road frame: x forward, z up, road at z = 0 and at rest; the angle lifts the +x side.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Segment {
    /// Middle of the clamped face, x \[m\].
    pub x: Cubic,
    /// Middle of the clamped face, z \[m\]; ignored in `load` drive.
    pub z: Cubic,
    /// Angle of the clamped face \[rad\].
    pub angle: Cubic,
    /// Normal load \[N\]; ignored in `trajectory` drive.
    pub load: Cubic,
}

/// Values of the inputs at one instant.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Pose {
    /// Middle of the clamped face, x \[m\].
    pub x: f64,
    /// Middle of the clamped face, z \[m\].
    pub z: f64,
    /// Angle of the clamped face \[rad\].
    pub angle: f64,
    /// Normal load \[N\].
    pub load: f64,
}

impl Segment {
    /// Nothing moves.
    pub fn still(pose: Pose) -> Self {
        Self {
            x: Cubic::constant(pose.x),
            z: Cubic::constant(pose.z),
            angle: Cubic::constant(pose.angle),
            load: Cubic::constant(pose.load),
        }
    }

    /// Pose at `s` \[s\].
    pub fn pose(&self, s: f64) -> Pose {
        Pose { x: self.x.at(s), z: self.z.at(s), angle: self.angle.at(s), load: self.load.at(s) }
    }
}
