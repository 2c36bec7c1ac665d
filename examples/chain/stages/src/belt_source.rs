//! BeltSource.fmu: the path of a belt that flattens in the contact patch.

use crate::belt_path::{BeltPath, BeltSample};
use crate::stage::{Stage, Variable};

/// Position in the table of the first output.
const X: usize = 8;

/// The belt under one block.
#[derive(Clone, Debug)]
pub struct BeltSource {
    path: BeltPath,
    delay: f64,
    motion: [BeltSample; 3],
}

impl BeltSource {
    fn tell(&mut self, values: &mut [f64], time: f64) {
        self.motion = self.path.motion(time - self.delay);
        let now = self.motion[0];
        values[X..X + 3].copy_from_slice(&[now.x, now.z, now.angle]);
    }
}

impl Stage for BeltSource {
    const IDENTIFIER: &'static str = "BeltSource";
    const DESCRIPTION: &'static str =
        "Path of a tyre's belt that is flattened in the contact patch, for one tread block";
    const DERIVATIVES: u32 = 2;
    const TAKES_DERIVATIVES: bool = false;
    const STEP: f64 = 1e-5;

    #[rustfmt::skip]
    fn table() -> Vec<Variable> {
        let p = Variable::parameter;
        vec![
            p("tyre.radius", "m", 0.3, (0.05, 2.0), "Radius of the belt outside of the contact patch"),
            p("contact.length", "m", 0.12, (0.01, 0.5), "Length of the flattened belt"),
            p("speed", "m/s", 10.0, (0.1, 150.0), "Speed of the belt relative to the axle"),
            p("slip", "1", 0.03, (-1.0, 1.0), "Sliding of the flat belt over its speed; positive brakes"),
            p("height", "m", 0.0098, (1e-4, 0.2), "Height of the flat belt above the road"),
            p("blend.length", "m", 0.02, (1e-4, 0.5), "Length over which the curvature goes from the circle's to zero"),
            p("lead", "m", 0.05, (1e-4, 2.0), "Length of belt before the flat part at which the path starts"),
            p("delay", "s", 0.0, (-10.0, 10.0), "By how much later the block passes: its place along the belt over the speed"),
            Variable::output("belt.x", "m", "Middle of the block's clamped face, forward, road frame"),
            Variable::output("belt.z", "m", "Its height above the road"),
            Variable::output("belt.angle", "rad", "Its angle; positive lifts the +x side"),
        ]
    }

    fn start(values: &mut [f64], time: f64) -> Result<Self, String> {
        let [radius, contact_length, speed, slip, height, blend_length, lead, delay] =
            std::array::from_fn(|i| values[i]);
        let path = BeltPath { radius, contact_length, speed, slip, height, blend_length, lead };
        let problems: Vec<_> = path.problems().iter().map(ToString::to_string).collect();
        if !problems.is_empty() {
            return Err(problems.join("; "));
        }
        let mut source = Self { motion: path.motion(0.0), path, delay };
        source.tell(values, time);
        Ok(source)
    }

    fn step(
        &mut self,
        values: &mut [f64],
        _rates: &[Option<f64>],
        time: f64,
        h: f64,
    ) -> Result<(), String> {
        self.tell(values, time + h);
        Ok(())
    }

    fn derivative(&self, output: usize, order: u32) -> Option<f64> {
        let at = self.motion.get(order as usize)?;
        [at.x, at.z, at.angle].get(output.checked_sub(X)?).copied()
    }
}
