//! The assembled tread block: parameters in, motion and load per communication step in, outputs out.

mod build;
mod memory;
mod observe;
mod reductions;
mod signals;
mod stations;
mod strike;

pub use build::Shape;
pub use reductions::{Reductions, KEPT};
pub use signals::{InputSpec, OutputSpec, Outputs, INPUTS, OUTPUTS, STATIONS};

use crate::contact::{wear, Face};
use crate::drive::{Pose, Segment};
use crate::dynamics::{
    equilibrium, kinematics, Integrator, Kinematics, Ledger, Linear, Stage, State, Statistics,
};
use crate::error::{Fault, Problem};
use crate::params::{check, table, Params, Variability, Wear};
use crate::reduction::Reduction;
use memory::Memory;
use stations::Stations;
use std::sync::Arc;

/// A tread block: reduced finite elements on a rough road.
#[derive(Clone, Debug)]
pub struct TreadBlock {
    params: Params,
    reduction: Arc<Reduction>,
    linear: Linear,
    face: Face,
    state: State,
    integrator: Integrator,
    stations: Stations,
    memory: Memory,
    wear_mass: f64,
    /// Energy of the contact springs that wear has released since the ledger was opened \[J\].
    wear_energy: f64,
    /// Prescribed motion at the time reached.
    motion: Kinematics,
    outputs: Outputs,
}

impl TreadBlock {
    /// Builds the block; the finite elements and their reduction take most of the time.
    ///
    /// # Errors
    /// [`Fault::Invalid`] with all problems of the parameters, [`Fault::File`] for a friction table.
    pub fn new(params: &Params) -> Result<Self, Fault> {
        check::checked(params)?;
        Self::with_reduction(params, Arc::new(Shape::of(params).reduce()?))
    }

    /// Builds the block on a reduction made before by [`Shape::reduce`]; blocks of one [`Shape`] may
    /// differ in all else.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_reduction(params: &Params, reduction: Arc<Reduction>) -> Result<Self, Fault> {
        check::checked(params)?;
        let linear = build::linear(&reduction, params);
        let face = build::face(&reduction, params)?;
        let integrator = build::integrator(&linear, params);
        let memory = Memory::new(params, &linear, &face.area);
        let mut block = Self {
            state: State::new(&linear),
            stations: Stations::along(&reduction.interface.x),
            params: params.clone(),
            reduction,
            linear,
            face,
            integrator,
            memory,
            wear_mass: 0.0,
            wear_energy: 0.0,
            motion: Kinematics::default(),
            outputs: Outputs::default(),
        };
        block.initialize(0.0, Pose { z: block.params.block.height, ..Pose::default() })?;
        Ok(block)
    }

    /// Puts the block at rest at `time` \[s\]: in `load` drive in frictionless static equilibrium under
    /// `pose.load` (then `pose.z` is ignored), in `trajectory` drive undeformed, or in static
    /// equilibrium where `pose.z` already presses it.
    ///
    /// # Errors
    /// [`Fault::NoConvergence`] where there is no equilibrium.
    pub fn initialize(&mut self, time: f64, pose: Pose) -> Result<(), Fault> {
        self.state = State::new(&self.linear);
        self.state.time = time;
        self.wear_mass = 0.0;
        self.integrator = build::integrator(&self.linear, &self.params);
        equilibrium::settle(&self.linear, &self.face, pose, &mut self.state)?;
        self.memory.reset(&self.params.effect, &mut self.state);
        self.motion = kinematics(&Segment::still(pose), 0.0);
        self.observe();
        self.memory.settle_sensor(&self.outputs);
        Ok(())
    }

    /// Moves the block over `h` \[s\] with the inputs of `segment`; allocates nothing.
    ///
    /// # Errors
    /// [`Fault::NoConvergence`], [`Fault::NotFinite`]; the block then stands at the last time that was
    /// reached, see [`Self::time`].
    pub fn advance(&mut self, h: f64, segment: &Segment) -> Result<(), Fault> {
        let start = self.state.time;
        let (law, density) = (&self.params.wear, self.params.rubber.density);
        let (face, wear_mass) = (&self.face, &mut self.wear_mass);
        let wear_energy = &mut self.wear_energy;
        let (effects, memory, linear) = (&self.params.effect, &mut self.memory, &self.linear);
        let outcome = self.integrator.advance(
            &self.linear,
            &self.face,
            &mut self.state,
            h,
            segment,
            &mut |step, stage, state| {
                let [mass, energy] =
                    wear_off(law, density, &face.area, step, stage, &mut state.worn);
                *wear_mass += mass;
                *wear_energy += energy;
                memory.after_step(effects, linear, face, step, stage, state);
            },
        );
        let reached = self.state.time - start;
        self.motion = kinematics(segment, reached);
        self.observe();
        self.memory.follow_belt(&self.params.effect, reached, &self.outputs);
        self.memory.show(&self.params.effect, &mut self.outputs);
        outcome?;
        if self.outputs.are_finite() {
            Ok(())
        } else {
            // Only a state that was restored damaged leads here: a step judges its own motion.
            Err(Fault::NotFinite { what: "the outputs".into(), time: self.state.time })
        }
    }

    /// Lets the block rest under its load for `duration` \[s\] without the time going on: contacts age
    /// and cool. A rest before the road starts need not be simulated.
    pub fn rest(&mut self, duration: f64) {
        self.memory.rest(&self.params.effect, duration, &mut self.state);
        self.observe();
        self.memory.show(&self.params.effect, &mut self.outputs);
    }

    /// Worn depth of the contact nodes \[m\], from the run-in to the run-out edge.
    pub fn worn(&self) -> &[f64] {
        &self.state.worn[..self.reduction.contact_nodes()]
    }

    /// Sets the worn depth of the contact nodes \[m\], as a cycle-jump over many metres does.
    pub fn set_worn(&mut self, depth: &[f64]) {
        for (worn, depth) in self.state.worn.iter_mut().zip(depth) {
            *worn = *depth;
        }
        self.observe();
    }

    /// Time reached \[s\].
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// Outputs at the time reached.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// The parameters in force.
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// The reduced model that the block was built on.
    pub fn reduction(&self) -> &Arc<Reduction> {
        &self.reduction
    }

    /// How much work was done since initialization.
    pub fn statistics(&self) -> Statistics {
        self.integrator.statistics()
    }

    /// Opens an energy ledger at the state as it stands.
    pub fn open_ledger(&mut self) {
        let compression = self.compression();
        self.wear_energy = 0.0;
        self.integrator.open_ledger(&self.linear, &self.face, &self.state, &compression);
    }

    /// The energy ledger, if one was opened.
    pub fn ledger(&self) -> Option<Ledger> {
        self.integrator.ledger().map(|ledger| Ledger { wear: self.wear_energy, ..*ledger })
    }

    /// Changes tunable parameters while the block moves.
    ///
    /// # Errors
    /// [`Fault::Invalid`] for values out of range and for fixed parameters that differ.
    pub fn retune(&mut self, params: &Params) -> Result<(), Fault> {
        let mut problems = check::problems(params);
        for spec in table::specs().filter(|s| s.variability == Variability::Fixed) {
            if (spec.get)(params) != (spec.get)(&self.params) {
                problems.push(Problem::new(
                    spec.name,
                    table::show(spec, &(spec.get)(params)),
                    format!(
                        "{} as at initialization",
                        table::show(spec, &(spec.get)(&self.params))
                    ),
                    "set fixed parameters before initialization",
                ));
            }
        }
        if !problems.is_empty() {
            return Err(Fault::Invalid(problems));
        }
        self.face = build::face(&self.reduction, params)?;
        self.params = params.clone();
        Ok(())
    }

    /// Everything that changes while the block moves, as plain numbers in a fixed order and count.
    pub fn save(&self, out: &mut Vec<f64>) {
        out.push(self.wear_mass);
        out.extend(self.motion.to_numbers());
        self.memory.save(out);
        self.state.save(out);
        self.integrator.save(out);
    }

    /// Restores what [`Self::save`] wrote; `false`, with the block unchanged, if the count does not
    /// fit or a number is not finite.
    pub fn restore(&mut self, from: &[f64]) -> bool {
        let mut own = Vec::new();
        self.save(&mut own);
        if from.len() != own.len() || from.iter().any(|x| !x.is_finite()) {
            return false;
        }
        let restored = self.read(from).is_some_and(<[f64]>::is_empty);
        self.observe();
        self.memory.show(&self.params.effect, &mut self.outputs);
        restored
    }

    /// Reads what [`Self::save`] wrote and returns the rest.
    fn read<'a>(&mut self, from: &'a [f64]) -> Option<&'a [f64]> {
        let (wear_mass, rest) = from.split_first()?;
        let (motion, rest) = rest.split_first_chunk()?;
        self.wear_mass = *wear_mass;
        self.motion = Kinematics::from_numbers(motion);
        let rest = self.memory.restore(rest)?;
        self.integrator.restore(self.state.restore(rest)?)
    }
}

/// Wears the nodes over a step of `h` \[s\]; returns the mass worn off \[kg\] and the energy of the contact
/// springs \[J\] that goes with it: pressure times what is lost in depth.
fn wear_off(
    law: &Wear,
    density: f64,
    area: &[f64],
    h: f64,
    stage: &Stage,
    worn: &mut [f64],
) -> [f64; 2] {
    if law.coefficient == 0.0 {
        return [0.0; 2];
    }
    let traction = &stage.traction;
    let (mut mass, mut energy) = (0.0, 0.0);
    for i in 0..worn.len() {
        if traction.pressure[i] > 0.0 {
            let mu = traction.tangential[i] / (traction.pressure[i] * area[i]);
            let depth =
                h * wear::depth_rate(law, density, mu, traction.pressure[i], stage.placed.slip[i]);
            worn[i] += depth;
            mass += depth * density * area[i];
            energy += depth * traction.pressure[i] * area[i];
        }
    }
    [mass, energy]
}
