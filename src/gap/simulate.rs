//! One run of a campaign with given parameters, as the rig would have measured it.

use super::campaign::{Plan, Record, RunKind, RunSpec};
use super::ripple::Ripple;
use crate::block::{Shape, TreadBlock};
use crate::drive::{Pose, Segment};
use crate::error::Fault;
use crate::params::{table, NormalDrive, Params, Value};
use crate::reduction::Reduction;
use crate::scenario::{self, Inputs, Scenario, Slide};
use std::sync::Arc;

/// Names of the datasheet and of the parameters they mean.
pub const DATASHEET: [(&str, &str); 12] = [
    ("young_modulus_pa", "rubber.young_modulus"),
    ("poisson_ratio", "rubber.poisson_ratio"),
    ("density_kg_m3", "rubber.density"),
    ("stiffness_damping_s", "rubber.stiffness_damping"),
    ("friction_mu_inf", "friction.mu_inf"),
    ("friction_mu_drop", "friction.mu_drop"),
    ("friction_decay_speed_m_s", "friction.decay_speed"),
    ("friction_smoothing_speed_m_s", "friction.smoothing_speed"),
    ("friction_pressure_exponent", "friction.pressure_exponent"),
    ("contact_reference_pressure_pa", "contact.reference_pressure"),
    ("contact_depth_m", "contact.depth"),
    ("friction_reference_pressure_pa", "friction.reference_pressure"),
];

/// How finely the block is cut: elements along and up, highest mode \[Hz\], tolerance of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fineness {
    /// Elements along the tread face and over the height.
    elements: (usize, usize),
    /// Fixed-interface modes up to this frequency are kept \[Hz\].
    bound: f64,
    /// Error of one internal step relative to the motion's own scale \[-\].
    tolerance: f64,
}

/// For the fits: several times faster than the default.
pub const FIT: Fineness = Fineness { elements: (6, 4), bound: 14e3, tolerance: 3e-3 };
/// What the fits' error is measured against.
pub const FINE: Fineness = Fineness { elements: (10, 6), bound: 24e3, tolerance: 1e-3 };
/// Height above the road at which the struck block hangs \[m\]; the measured approach is minus this.
const HANGING: f64 = 1.0;
/// Speed of the blow at the tread face \[m/s\].
const BLOW: f64 = 0.3;

/// Sets the parameter `name`; `false` if it does not exist.
pub fn set(params: &mut Params, name: &str, value: f64) -> bool {
    table::find(name).is_some_and(|spec| (spec.set)(params, &Value::Real(value)))
}

/// Puts the block of `plan` on its rig: sizes and carriage.
pub(super) fn mount(params: &mut Params, plan: &Plan) {
    params.block.length = plan.block.length_m;
    params.block.height = plan.block.height_m;
    params.block.width = plan.block.width_m;
    params.carriage.mass = plan.rig.load_carriage_mass_kg;
    params.carriage.damping = plan.rig.load_carriage_damping_n_s_m;
}

/// The base model at the datasheet's values.
pub fn nominal(plan: &Plan) -> Params {
    let mut params = Params::default();
    mount(&mut params, plan);
    params.wear.coefficient = 0.0;
    cut(&mut params, FIT);
    for (key, name) in DATASHEET {
        if let Some(datum) = plan.nominal.get(key) {
            set(&mut params, name, datum.value);
        }
    }
    params
}

/// Sets how finely the block is cut.
fn cut(params: &mut Params, fineness: Fineness) {
    params.solver.elements_along = fineness.elements.0;
    params.solver.elements_up = fineness.elements.1;
    params.solver.frequency_bound = fineness.bound;
    params.solver.tolerance = fineness.tolerance;
}

/// Simulates runs of one campaign; the reduction is made once.
#[derive(Clone, Debug)]
pub struct Simulator {
    plan: Plan,
    reduction: Arc<Reduction>,
    fineness: Fineness,
    ripple: Option<Ripple>,
}

impl Simulator {
    /// The same rig, its drives with a ripple or without one.
    pub(super) fn rippled(self, ripple: Option<Ripple>) -> Self {
        Self { ripple, ..self }
    }

    /// For the block of `plan`.
    ///
    /// # Errors
    /// What stops the reduction.
    pub fn new(plan: &Plan) -> Result<Self, Fault> {
        Self::cut(plan, FIT)
    }

    /// The same, cut as finely as `fineness` says.
    ///
    /// # Errors
    /// What stops the reduction.
    pub fn cut(plan: &Plan, fineness: Fineness) -> Result<Self, Fault> {
        let mut params = nominal(plan);
        cut(&mut params, fineness);
        let reduction = Arc::new(Shape::of(&params).reduce()?);
        Ok(Self { plan: plan.clone(), reduction, fineness, ripple: None })
    }

    /// The run as the rig would have measured it up to `until` \[s\], without noise, at the campaign's
    /// sampling rate.
    ///
    /// # Errors
    /// What stops the block.
    pub fn run(&self, params: &Params, spec: &RunSpec, until: f64) -> Result<Record, Fault> {
        let until = until.min(spec.duration_s);
        let mut params = params.clone();
        cut(&mut params, self.fineness);
        params.drive.normal = match spec.kind {
            RunKind::Ringdown => NormalDrive::Trajectory,
            _ => NormalDrive::Load,
        };
        let mut block = TreadBlock::with_reduction(&params, Arc::clone(&self.reduction))?;
        let mut sampler = Sampler::new(&self.plan, until);
        match spec.kind {
            RunKind::Ringdown => self.ring(&mut block, until, &mut sampler)?,
            _ => self.slide(&mut block, spec, until, &mut sampler)?,
        }
        Ok(sampler.record)
    }

    fn ring(&self, block: &mut TreadBlock, until: f64, sampler: &mut Sampler) -> Result<(), Fault> {
        let step = 1.0 / self.plan.sampling_rate;
        let pose = Pose { z: self.plan.block.height_m + HANGING, ..Pose::default() };
        block.initialize(0.0, pose)?;
        block.strike(BLOW);
        sampler.push(0.0, block);
        for k in 1..=rows(until, step) {
            block.advance(step, &Segment::still(pose))?;
            sampler.push(k as f64 * step, block);
        }
        Ok(())
    }

    fn slide(
        &self,
        block: &mut TreadBlock,
        spec: &RunSpec,
        until: f64,
        sampler: &mut Sampler,
    ) -> Result<(), Fault> {
        let step = 1.0 / self.plan.sampling_rate;
        let slide = motion(&self.plan, spec);
        let scenario = Scenario::Slide(slide.clone());
        // Whole samples only: a scenario would end with a shorter step.
        let duration = rows(until, step) as f64 * step;
        let plan = scenario::Plan { step, duration, inputs: Inputs::Exact };
        block.initialize(scenario.start(), scenario.pose(scenario.start()))?;
        // The block is settled: a rest before the road starts only ages and cools the contact.
        block.rest(spec.dwell_s);
        let visit = |t: f64, block: &TreadBlock| {
            sampler.push(t, block);
            Ok(())
        };
        match self.ripple {
            Some(ripple) => ripple.go_on(block, &slide, &plan, visit),
            None => scenario::go_on(block, &scenario, &plan, visit),
        }
    }
}

/// Road motion and load of a run.
fn motion(plan: &Plan, spec: &RunSpec) -> Slide {
    let end = spec.road_speed_end_m_s.unwrap_or(spec.road_speed_m_s);
    Slide {
        speed: spec.road_speed_m_s,
        speed_end: end,
        sweep: if spec.kind == RunKind::SpeedRamp { spec.duration_s } else { 0.0 },
        start_ramp: plan.rig.start_ramp_s,
        dwell: 0.0,
        load: spec.mean_pressure_pa * plan.block.length_m * plan.block.width_m,
    }
}

/// Road speed \[m/s\] of a run at `t` \[s\].
pub fn road_speed(plan: &Plan, spec: &RunSpec, t: f64) -> f64 {
    motion(plan, spec).road_speed(t)
}

/// Number of samples after the first.
fn rows(duration: f64, step: f64) -> usize {
    (duration / step + 1e-6).floor().max(0.0) as usize
}

/// Collects what the rig's channels would show.
struct Sampler {
    record: Record,
    /// Height of the block \[m\], from which the approach counts.
    height: f64,
}

impl Sampler {
    fn new(plan: &Plan, until: f64) -> Self {
        let count = rows(until, 1.0 / plan.sampling_rate) + 1;
        let column = || Vec::with_capacity(count);
        let channel = std::array::from_fn(|_| Some(column()));
        let record = Record { time: column(), channel, clock: 1.0 };
        Self { record, height: plan.block.height_m }
    }

    fn push(&mut self, t: f64, block: &TreadBlock) {
        let out = block.outputs();
        let values = [
            out.contact_force[0],
            out.contact_force[1],
            out.run_in_velocity[0] + out.deflection_velocity,
            out.run_in_displacement[0] + out.deflection,
            self.height - out.carriage_z,
        ];
        self.record.time.push(t);
        for (column, value) in self.record.channel.iter_mut().zip(values) {
            if let Some(column) = column {
                column.push(value);
            }
        }
    }
}
