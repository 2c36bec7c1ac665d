//! The belt of a rolling tyre, flattened in the contact patch: a path for the clamped face.

use crate::error::{Fault, Problem};

/// Geometry and motion of a flattened belt.
///
/// With the arc length s along the belt, 0 in the middle of the patch, the belt's slope θ(s) has the
/// curvature κ(s) = θ′(s) = S(σ)/R, σ = (|s| − a + w/2)/w, where a is half the contact length, w the
/// blend length and S(σ) = 6σ⁵ − 15σ⁴ + 10σ³ between 0 (flat) and 1 (circle of the radius R). The
/// slope is thus three times continuously differentiable and no inertia force jumps.
#[derive(Clone, Debug, PartialEq)]
pub struct BeltPath {
    /// Radius R of the belt outside of the patch \[m\].
    pub radius: f64,
    /// Length 2a of the flattened part \[m\].
    pub contact_length: f64,
    /// Speed V of the belt relative to the axle \[m/s\].
    pub speed: f64,
    /// Slip \[-\]: the flat belt moves over the road with slip·V; positive brakes, negative drives.
    pub slip: f64,
    /// Height of the flattened belt's clamped face above the road \[m\].
    pub height: f64,
    /// Length w over which the curvature goes from 0 to 1/R \[m\].
    pub blend_length: f64,
    /// Length of belt before and behind the flat part that the path covers \[m\].
    pub lead: f64,
}

/// One sample of a belt path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeltSample {
    /// Time \[s\].
    pub time: f64,
    /// Middle of the clamped face, road frame \[m\].
    pub x: f64,
    /// Its height above the road \[m\].
    pub z: f64,
    /// Angle \[rad\], positive lifts the +x side.
    pub angle: f64,
}

impl BeltPath {
    /// All that cannot be built or is not a tyre.
    pub fn problems(&self) -> Vec<Problem> {
        let ranges = [
            ("radius", self.radius, 0.05, 2.0, "m"),
            ("contact_length", self.contact_length, 0.01, 0.5, "m"),
            ("speed", self.speed, 0.1, 150.0, "m/s"),
            ("slip", self.slip, -1.0, 1.0, "(positive brakes, negative drives)"),
            ("height", self.height, 1e-4, 0.2, "m"),
            ("blend_length", self.blend_length, 1e-4, self.contact_length, "m"),
            ("lead", self.lead, self.blend_length, self.radius, "m"),
        ];
        ranges
            .into_iter()
            .filter(|(_, value, min, max, _)| !(min..=max).contains(&value))
            .map(|(name, value, min, max, unit)| {
                Problem::new(
                    format!("belt path: {name}"),
                    value.to_string(),
                    format!("{min} to {max} {unit}"),
                    "change it, or the quantity that sets its limit",
                )
            })
            .collect()
    }

    /// Time of the whole passage \[s\].
    pub fn duration(&self) -> f64 {
        (self.contact_length + 2.0 * self.lead) / self.speed
    }

    /// Pose at time `t` \[s\]; the block runs from +x to −x relative to the axle, the axle in +x.
    pub fn at(&self, t: f64) -> BeltSample {
        let s = 0.5 * self.contact_length + self.lead - self.speed * t;
        let (x, rise) = self.offset(s.abs());
        let axle = (1.0 + self.slip) * self.speed * t;
        BeltSample {
            time: t,
            x: axle + x.copysign(s),
            z: self.height + rise,
            angle: self.slope(s.abs()).copysign(s),
        }
    }

    /// Pose, velocity and acceleration at time `t` \[s\], the latter per s and s².
    ///
    /// With the signed slope α, x′ = (1 + slip)V − V cos α, z′ = −V sin α, α′ = −Vκ, and their
    /// derivatives by the chain rule.
    pub fn motion(&self, t: f64) -> [BeltSample; 3] {
        let pose = self.at(t);
        let s = 0.5 * self.contact_length + self.lead - self.speed * t;
        let (sin, cos) = pose.angle.sin_cos();
        let (curvature, growth) = self.curvature(s.abs());
        let v = self.speed;
        let (turning, spin_up) = (-v * curvature, v * v * growth.copysign(s));
        let velocity =
            BeltSample { time: t, x: (1.0 + self.slip) * v - v * cos, z: -v * sin, angle: turning };
        let acceleration =
            BeltSample { time: t, x: v * sin * turning, z: -v * cos * turning, angle: spin_up };
        [pose, velocity, acceleration]
    }

    /// Samples every `step` \[s\] from entry to exit.
    ///
    /// # Errors
    /// [`Fault::Invalid`] with all problems of the path.
    pub fn samples(&self, step: f64) -> Result<Vec<BeltSample>, Fault> {
        let mut problems = self.problems();
        if !(step > 0.0 && step <= 1e-3) {
            problems.push(Problem::new(
                "belt path: sampling step",
                step.to_string(),
                "more than 0 to 1e-3 s",
                "5e-6 resolves a passage at any road speed",
            ));
        }
        if !problems.is_empty() {
            return Err(Fault::Invalid(problems));
        }
        let count = (self.duration() / step * (1.0 + 1e-12)).floor() as usize;
        Ok((0..=count).map(|k| self.at(k as f64 * step)).collect())
    }

    /// Slope θ \[rad\] at the arc length `s` ≥ 0.
    fn slope(&self, s: f64) -> f64 {
        let sigma = (s - 0.5 * self.contact_length) / self.blend_length + 0.5;
        let turned = if sigma <= 0.0 {
            0.0
        } else if sigma < 1.0 {
            sigma.powi(4) * (2.5 + sigma * (sigma - 3.0))
        } else {
            sigma - 0.5
        };
        turned * self.blend_length / self.radius
    }

    /// Curvature κ \[1/m\] at the arc length `s` ≥ 0, and κ′ \[1/m²\].
    fn curvature(&self, s: f64) -> (f64, f64) {
        let w = self.blend_length;
        let sigma = ((s - 0.5 * self.contact_length) / w + 0.5).clamp(0.0, 1.0);
        let share = sigma.powi(3) * (10.0 + sigma * (6.0 * sigma - 15.0));
        let growth = 30.0 * (sigma * (1.0 - sigma)).powi(2) / w;
        (share / self.radius, growth / self.radius)
    }

    /// (∫cos θ, ∫sin θ) from 0 to `s` ≥ 0 \[m\]: Gauss' rule on panels that end where κ has its kinks.
    fn offset(&self, s: f64) -> (f64, f64) {
        let (a, w) = (0.5 * self.contact_length, self.blend_length);
        let ends = [0.0, (a - 0.5 * w).min(s), (a + 0.5 * w).min(s), s];
        let (mut x, mut z) = (0.0, 0.0);
        for pair in ends.windows(2) {
            let (dx, dz) = self.integrate(pair[0], pair[1]);
            x += dx;
            z += dz;
        }
        (x, z)
    }

    fn integrate(&self, from: f64, to: f64) -> (f64, f64) {
        const PANELS: usize = 8;
        // Nodes and weights of the three-point Gauss rule on (−1, 1): exact to degree 5.
        let node = (0.6f64).sqrt();
        let rule = [(-node, 5.0 / 9.0), (0.0, 8.0 / 9.0), (node, 5.0 / 9.0)];
        let half = 0.5 * (to - from) / PANELS as f64;
        let (mut x, mut z) = (0.0, 0.0);
        for panel in 0..PANELS {
            let middle = from + half * (2 * panel + 1) as f64;
            for (at, weight) in rule {
                let (sin, cos) = self.slope(middle + half * at).sin_cos();
                x += half * weight * cos;
                z += half * weight * sin;
            }
        }
        (x, z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reference(name: &str) -> Vec<[f64; 4]> {
        let path = format!("{}/tests/data/verification/{name}", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&path).unwrap();
        text.lines()
            .skip(1)
            .map(|line| {
                let cells: Vec<f64> = line.split(',').map(|c| c.parse().unwrap()).collect();
                [cells[0], cells[1], cells[2], cells[3]]
            })
            .collect()
    }

    fn worst(path: &BeltPath, name: &str) -> [f64; 3] {
        let mut worst = [0.0f64; 3];
        for [t, x, z, angle] in reference(name) {
            let at = path.at(t);
            for (w, d) in worst.iter_mut().zip([at.x - x, at.z - z, at.angle - angle]) {
                *w = w.max(d.abs());
            }
        }
        worst
    }

    #[test]
    fn the_generator_makes_the_paths_of_the_independent_solution() {
        // Origin: paths of the reference solutions (tests/data/verification/README.md), written with
        // ten decimals.
        let braking = BeltPath {
            radius: 0.3,
            contact_length: 0.13,
            speed: 15.0,
            slip: 0.02,
            height: 0.0097,
            blend_length: 0.02,
            lead: 0.05,
        };
        let driving = BeltPath {
            contact_length: 0.12,
            speed: 8.0,
            slip: -0.03,
            height: 0.0077,
            lead: 0.055,
            ..braking.clone()
        };
        for (path, name) in [(braking, "roll-1-belt.csv"), (driving, "roll-2-belt.csv")] {
            let worst = worst(&path, name);
            assert!(worst.iter().all(|w| *w < 2e-7), "{name}: {worst:?}");
        }
    }

    #[test]
    fn the_flat_belt_slides_with_slip_times_speed() {
        let path = BeltPath {
            radius: 0.3,
            contact_length: 0.1,
            speed: 10.0,
            slip: -0.05,
            height: 0.01,
            blend_length: 0.01,
            lead: 0.04,
        };
        let middle = 0.5 * path.duration();
        let speed = (path.at(middle + 1e-5).x - path.at(middle - 1e-5).x) / 2e-5;
        assert!((speed + 0.5).abs() < 1e-9, "{speed}");
    }

    #[test]
    fn velocity_and_acceleration_are_the_derivatives_of_the_pose() {
        let path = BeltPath {
            radius: 0.3,
            contact_length: 0.12,
            speed: 10.0,
            slip: 0.03,
            height: 0.0098,
            blend_length: 0.02,
            lead: 0.05,
        };
        // Central differences over 2 dt err by dt²/6 times the third derivative, below 1e-3 of the
        // sizes that divide them here (10 m/s, 300 m/s² and so on).
        let (dt, sizes) = (1e-6, [[10.0, 10.0, 33.0], [300.0, 300.0, 2e4]]);
        for t in [1e-3, 4.2e-3, 5.5e-3, 11e-3, 16.2e-3, 17.7e-3, 20e-3] {
            let [before, now, after] = [t - dt, t, t + dt].map(|t| path.motion(t));
            for order in 1..3 {
                let rows = |m: &[BeltSample; 3], k: usize| [m[k].x, m[k].z, m[k].angle];
                let (low, high) = (rows(&before, order - 1), rows(&after, order - 1));
                for (i, value) in rows(&now, order).into_iter().enumerate() {
                    let difference = (high[i] - low[i]) / (2.0 * dt);
                    let error = (value - difference).abs() / sizes[order - 1][i];
                    assert!(error < 1e-3, "order {order}, {i} at {t}: {value} {difference}");
                }
            }
        }
    }

    #[test]
    fn every_wrong_number_is_named() {
        let path = BeltPath {
            radius: -1.0,
            contact_length: f64::NAN,
            speed: 0.0,
            slip: 3.0,
            height: 0.01,
            blend_length: 0.01,
            lead: 0.04,
        };
        let Err(Fault::Invalid(problems)) = path.samples(5e-6) else { panic!("accepted") };
        for name in ["radius", "contact_length", "speed", "slip"] {
            assert!(problems.iter().any(|p| p.what.ends_with(name)), "{name}");
        }
    }
}
