//! Steps of the right size: error control on a dyadic division of the communication step.

use super::energy::{self, Ledger};
use super::linear::Linear;
use super::matrices::StageMatrices;
use super::stage::Stage;
use super::state::State;
use super::tr_bdf2::{TrBdf2, D, W};
use crate::contact::Face;
use crate::drive::Segment;
use crate::error::Fault;
use crate::pack::Aligned;

/// A communication step is divided into at most 2^LEVELS internal steps.
const LEVELS: usize = 12;
/// Smallest parts of a communication step.
const TICKS: usize = 1 << LEVELS;
/// Communication steps that differ by less than this share use the same matrices.
const SAME_STEP: f64 = 1e-9;
/// Time over which the scale of the error control forgets \[s\].
const SCALE_MEMORY: f64 = 2e-3;
/// Share of the block's mass that moves with the tread face, for the scale of the error control.
const MOVING_SHARE: f64 = 0.3;

/// What the integrator is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Error of a step over the scale of the motion \[-\].
    pub tolerance: f64,
    /// Largest step \[s\].
    pub max_step: f64,
    /// Smallest step \[s\].
    pub min_step: f64,
}

/// How much work was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Steps tried.
    pub steps: u64,
    /// Steps rejected by the error control or for want of convergence.
    pub rejected: u64,
    /// Newton iterations.
    pub iterations: u64,
    /// Step matrices computed.
    pub matrices: u64,
}

/// Integrator with all its buffers; allocates nothing after construction.
#[derive(Clone, Debug)]
pub struct Integrator {
    settings: Settings,
    /// Pressure \[Pa\] for whose contact stiffness the normal velocities are eliminated.
    typical_pressure: f64,
    matrices: Vec<StageMatrices>,
    last_h: f64,
    /// The state was set from outside since the last step.
    fresh: bool,
    step: TrBdf2,
    statistics: Statistics,
    ledger: Option<Ledger>,
}

impl Integrator {
    /// An integrator for `linear`.
    ///
    /// The solver converges the faster, the nearer the pressures are to `typical_pressure` \[Pa\].
    pub fn new(linear: &Linear, settings: Settings, typical_pressure: f64) -> Self {
        let mut step = TrBdf2::new(linear);
        step.stage.newton.serve(settings.tolerance);
        Self {
            settings,
            typical_pressure,
            matrices: vec![StageMatrices::new(linear); LEVELS + 1],
            last_h: 0.0,
            fresh: true,
            step,
            statistics: Statistics::default(),
            ledger: None,
        }
    }

    /// Work done so far.
    pub fn statistics(&self) -> Statistics {
        Statistics { iterations: self.step.iterations, ..self.statistics }
    }

    /// The energy ledger, if one is kept.
    pub fn ledger(&self) -> Option<&Ledger> {
        self.ledger.as_ref()
    }

    /// Opens an energy ledger at the state as it stands.
    pub fn open_ledger(
        &mut self,
        linear: &Linear,
        face: &Face,
        state: &State,
        compression: &[f64],
    ) {
        let stored = energy::stored(linear, face, state, compression);
        self.step.keep_power = true;
        self.step.powers = Default::default();
        self.ledger = Some(Ledger { stored_at_start: stored, stored, ..Ledger::default() });
    }

    /// The state is set from outside: nothing is carried over from the step before.
    pub fn start_afresh(&mut self) {
        self.fresh = true;
    }

    /// Displacements \[m\] and velocities \[m/s\] of the contact nodes relative to the clamped face, block frame,
    /// as the last step left them; `None` if the state was set from outside since.
    pub fn contact_motion(&self) -> Option<[&Aligned; 2]> {
        (!self.fresh).then(|| self.step.contact_motion())
    }

    /// What is carried from step to step besides the state, as numbers in a fixed count.
    pub fn save(&self, out: &mut Vec<f64>) {
        out.extend([self.last_h, f64::from(u8::from(self.fresh))]);
        self.step.save(out);
    }

    /// Reads what [`Self::save`] wrote; returns the rest, or `None`, and the next step then starts afresh, if
    /// there is too little.
    pub fn restore<'a>(&mut self, from: &'a [f64]) -> Option<&'a [f64]> {
        self.fresh = true;
        let ([last_h, fresh], rest) = from.split_first_chunk()?;
        let rest = self.step.restore(rest)?;
        (self.last_h, self.fresh) = (*last_h, *fresh == 1.0);
        Some(rest)
    }

    /// Moves `state` over `h` \[s\]; `after_step(step size, end of step, state)` sees every accepted
    /// step and may change the state's factors and worn depths.
    ///
    /// # Errors
    /// [`Fault::NoConvergence`] and [`Fault::NotFinite`]; `state` then stands at the last good time.
    pub fn advance(
        &mut self,
        linear: &Linear,
        face: &Face,
        state: &mut State,
        h: f64,
        segment: &Segment,
        after_step: &mut dyn FnMut(f64, &Stage, &mut State),
    ) -> Result<(), Fault> {
        let start = state.time;
        let interval = if (h - self.last_h).abs() <= SAME_STEP * h { self.last_h } else { h };
        self.last_h = interval;
        self.step.start_from(linear, state, self.fresh);
        self.fresh = false;
        let mut at = 0;
        while at < TICKS {
            let wish = self.level(interval, at, state.step);
            let level = self.try_levels(linear, face, state, segment, interval, at, wish)?;
            let step = interval / (1_usize << level) as f64;
            after_step(step, &self.step.stage, state);
            self.close_ledger(linear, face, state, step);
            at += TICKS >> level;
            state.time = start + h * (at as f64 / TICKS as f64);
        }
        Ok(())
    }

    /// Takes a step from tick `at`, halving it until it is good; returns its level.
    #[allow(clippy::too_many_arguments)]
    fn try_levels(
        &mut self,
        linear: &Linear,
        face: &Face,
        state: &mut State,
        segment: &Segment,
        interval: f64,
        at: usize,
        mut level: usize,
    ) -> Result<usize, Fault> {
        let from = interval * (at as f64 / TICKS as f64);
        let mut gentle = false;
        loop {
            let h = interval / (1_usize << level) as f64;
            let last_resort = level == LEVELS || 0.5 * h < self.settings.min_step;
            let tried = self.try_step(linear, face, state, segment, from, h, level);
            if gentle {
                self.step.stage.newton.set_gentle(false);
            }
            match tried {
                Ok(ratio) => {
                    let growth = (0.9 * ratio.max(1e-6).powf(-1.0 / 3.0)).clamp(0.3, 2.0);
                    state.step = (h * growth).min(self.settings.max_step);
                    if ratio <= 1.0 || last_resort {
                        self.step.accept(state);
                        return Ok(level);
                    }
                }
                Err(fault) if last_resort && gentle => return Err(fault),
                Err(_) if last_resort => {
                    // A corner under many times the mean pressure may fall into slip at 10⁷/s, faster than any
                    // step that one would take: its end is found without the way to it.
                    gentle = true;
                    self.step.stage.newton.set_gentle(true);
                    continue;
                }
                Err(_) => state.step = 0.25 * h,
            }
            self.statistics.rejected += 1;
            level += 1;
        }
    }

    /// Smallest level whose step is within the wish and starts on its grid.
    fn level(&self, interval: f64, at: usize, wish: f64) -> usize {
        let wish = if wish > 0.0 { wish } else { self.settings.max_step };
        let wish = wish.min(self.settings.max_step) * (1.0 + 1e-9);
        (0..LEVELS)
            .find(|k| interval / (1_usize << k) as f64 <= wish && at % (TICKS >> k) == 0)
            .unwrap_or(LEVELS)
    }

    /// One step of `h` from `from` \[s\] after the start of the segment; returns its error over the
    /// tolerance.
    #[allow(clippy::too_many_arguments)]
    fn try_step(
        &mut self,
        linear: &Linear,
        face: &Face,
        state: &mut State,
        segment: &Segment,
        from: f64,
        h: f64,
        level: usize,
    ) -> Result<f64, Fault> {
        let not_finite = |what: &str| Fault::NotFinite { what: what.into(), time: state.time };
        let matrices = &mut self.matrices[level];
        let angle = segment.angle.at(from + h);
        if !matrices.fit(linear, D * h, state.stiffness_factor, angle) {
            self.statistics.matrices += 1;
            let slopes = face.approach_slopes(self.typical_pressure, D * h);
            if !matrices.compute(linear, D * h, state.stiffness_factor, angle, slopes) {
                matrices.a = 0.0;
                return Err(not_finite("the Delassus matrix"));
            }
        }
        self.statistics.steps += 1;
        self.step.take(linear, face, state, matrices, segment, from, h)?;
        let error = self.step.error;
        if !error.is_finite() {
            return Err(not_finite("the motion of the block"));
        }
        let road = segment.x.rate(from + h).abs();
        let floor = (MOVING_SHARE * linear.block_mass).sqrt() * road.max(1e-3);
        let remembered = state.scale * (-h / SCALE_MEMORY).exp();
        let scale = remembered.max(floor).max(self.step.speed);
        if error <= self.settings.tolerance * scale {
            state.scale = scale;
        }
        Ok(error / (self.settings.tolerance * scale))
    }

    fn close_ledger(&mut self, linear: &Linear, face: &Face, state: &State, h: f64) {
        let Some(ledger) = &mut self.ledger else { return };
        let [start, middle, end] = self.step.powers;
        ledger.add(&start, W * h);
        ledger.add(&middle, W * h);
        ledger.add(&end, D * h);
        self.step.powers[0] = end;
        let compression = &self.step.stage.placed.compression;
        ledger.stored = energy::stored(linear, face, state, compression);
    }
}
