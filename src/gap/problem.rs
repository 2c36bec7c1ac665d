//! The fitting problem: whitened parameters in, weighted residuals of the data vector out.

use super::campaign::{Campaign, Plan, RunKind, RunSpec};
use super::features::{self, Aspect, Feature, Key};
use super::floor;
use super::simulate::{nominal, set, Simulator, DATASHEET, FINE};
use crate::effects::fit::{FitSpec, Spread};
use crate::error::Fault;
use crate::params::Params;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Datasheet parameters that are recalibrated. Density is left at its value: with one per cent of
/// spread it does what the modulus does.
const CALIBRATED: [&str; 9] = [
    "young_modulus_pa",
    "stiffness_damping_s",
    "friction_mu_inf",
    "friction_mu_drop",
    "friction_decay_speed_m_s",
    "friction_smoothing_speed_m_s",
    "friction_pressure_exponent",
    "contact_reference_pressure_pa",
    "contact_depth_m",
];
/// Residuals beyond this many standard deviations count ever less: a bifurcation that comes a little
/// early must not rule out a model that is right everywhere else.
pub const TAIL: f64 = 4.0;
/// The free block is asked once, but without any doubt about friction: it counts more.
const RINGDOWN_WEIGHT: f64 = 3.0;
/// Three numbers that say as much as a waveform.
const SNAP_WEIGHT: f64 = 4.0;
/// Residual of a run that could not be simulated.
const FAILED: f64 = 30.0;

/// An effect in one of its forms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Index into `effects::fit_specs()`.
    pub effect: usize,
    /// Index of its form.
    pub form: usize,
}

/// One whitened parameter: value = centre·exp(spread·x) or centre + spread·x, x ~ N(0, 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinate {
    /// Dotted name of the parameter.
    pub name: &'static str,
    /// Centre of the prior.
    pub centre: f64,
    /// Width of the prior.
    pub spread: Spread,
}

impl Coordinate {
    /// The parameter's value at `x`.
    pub fn value(&self, x: f64) -> f64 {
        match self.spread {
            Spread::Log(s) => self.centre * (s * x).exp(),
            Spread::Absolute(s) => self.centre + s * x,
        }
    }

    /// Standard deviation of the value where x has the standard deviation `sd`.
    pub fn deviation(&self, x: f64, sd: f64) -> f64 {
        match self.spread {
            Spread::Log(s) => (self.value(x) * s * sd).abs(),
            Spread::Absolute(s) => s * sd,
        }
    }
}

/// How much of every run is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// Up to the first snap-out: what follows the parameters without jumps.
    Start,
    /// Half way between: an optimum that has found the first snap-outs of fast runs finds the others.
    Middle,
    /// Enough to fit: the first snap-outs of all runs.
    Fit,
    /// All.
    Whole,
}

impl Look {
    /// Records are compared up to this time \[s\].
    pub fn horizon(self, run: &RunSpec) -> f64 {
        let speed = run.road_speed_m_s.abs();
        match self {
            Self::Whole => run.duration_s,
            _ if run.kind == RunKind::Ringdown => run.duration_s,
            Self::Start => FIRST.max(0.5 * features::TRAVEL / speed.max(1e-3)).min(START),
            Self::Middle => MIDDLE.max(0.75 * features::TRAVEL / speed.max(1e-3)).min(0.75 * SLOW),
            Self::Fit => START.max(features::TRAVEL / speed.max(1e-3)).min(SLOW),
        }
    }
}

/// Length of what is looked at first \[s\].
const FIRST: f64 = 1.3e-3;
/// Length of what is looked at next \[s\].
const MIDDLE: f64 = 2.0e-3;
/// Length of the fitted start of runs \[s\].
const START: f64 = 2.9e-3;
/// Longest fitted start, of slow runs \[s\].
const SLOW: f64 = 5.8e-3;

/// A campaign's data vector with all that is needed to predict it.
#[derive(Debug)]
pub struct Bench {
    /// Settings.
    pub plan: Plan,
    /// Runs in the order of the data vector.
    pub runs: Vec<RunSpec>,
    simulator: Simulator,
    /// How much of the runs is compared.
    look: Look,
    /// Measured features, run after run.
    pub measured: Vec<Vec<Feature>>,
    /// 1/σ per feature.
    inverse: Vec<Vec<f64>>,
    /// Weight per feature: features of one cell speak with one voice.
    pub weight: Vec<Vec<f64>>,
    /// Effects that may be added.
    pub specs: &'static [FitSpec],
    base: Vec<Coordinate>,
    simulations: AtomicUsize,
}

/// Residuals per run, (prediction − measurement)/σ.
pub type Residuals = Vec<Vec<f64>>;

impl Bench {
    /// Cuts the campaign's data, as far as `look` goes, into features.
    ///
    /// # Errors
    /// What stops the reduction of the block.
    pub fn new(campaign: &Campaign, specs: &'static [FitSpec], look: Look) -> Result<Self, Fault> {
        let plan = campaign.plan.clone();
        let runs: Vec<RunSpec> = campaign.runs.iter().map(|r| r.spec.clone()).collect();
        let measured: Vec<Vec<Feature>> = campaign
            .runs
            .iter()
            .enumerate()
            .map(|(i, run)| {
                let seen = run.record.until(look.horizon(&run.spec));
                features::of_run(&plan, &run.spec, i, &seen)
            })
            .collect();
        let sigma = |f: &Feature| 1.0 / floor::uncertainty(f);
        let inverse = measured.iter().map(|run| run.iter().map(sigma).collect()).collect();
        let weight = measured.iter().map(|run| weights(run)).collect();
        let base = CALIBRATED
            .iter()
            .filter_map(|key| {
                let datum = plan.nominal.get(*key).filter(|d| d.relative_std > 0.0)?;
                let name = DATASHEET.iter().find(|(k, _)| k == key)?.1;
                let spread = Spread::Log(datum.relative_std);
                Some(Coordinate { name, centre: datum.value, spread })
            })
            .collect();
        let simulator = Simulator::new(&plan)?;
        let simulations = AtomicUsize::new(0);
        Ok(Self {
            plan,
            runs,
            simulator,
            look,
            measured,
            inverse,
            weight,
            specs,
            base,
            simulations,
        })
    }

    /// How much of the runs is compared.
    pub const fn look(&self) -> Look {
        self.look
    }

    /// Number of simulations so far.
    pub fn simulations(&self) -> usize {
        self.simulations.load(Ordering::Relaxed)
    }

    /// Coordinates of the base model followed by those of the added effects.
    pub fn coordinates(&self, added: &[Choice]) -> Vec<Coordinate> {
        let of = |c: &Choice| self.specs[c.effect].forms[c.form].params;
        let effects = added.iter().flat_map(|c| of(c).iter());
        let effects =
            effects.map(|p| Coordinate { name: p.name, centre: p.centre, spread: p.spread });
        self.base.iter().copied().chain(effects).collect()
    }

    /// Number of recalibrated parameters of the base model.
    pub fn base_size(&self) -> usize {
        self.base.len()
    }

    /// Parameters of the model at `x`.
    pub fn params(&self, added: &[Choice], x: &[f64]) -> Params {
        let mut params = nominal(&self.plan);
        let values: Vec<f64> =
            self.coordinates(added).iter().zip(x).map(|(c, x)| c.value(*x)).collect();
        for (coordinate, value) in self.base.iter().zip(&values) {
            set(&mut params, coordinate.name, *value);
        }
        let mut at = self.base.len();
        for choice in added {
            let spec = &self.specs[choice.effect];
            let count = spec.forms[choice.form].params.len();
            spec.apply(choice.form, &values[at..at + count], &mut params);
            at += count;
        }
        params
    }

    /// Residuals of the runs `of` (all others empty) for several points at once.
    pub fn residuals(&self, added: &[Choice], points: &[Vec<f64>], of: &[usize]) -> Vec<Residuals> {
        let jobs: Vec<(usize, usize)> =
            (0..points.len()).flat_map(|p| of.iter().map(move |r| (p, *r))).collect();
        let done: Vec<Vec<f64>> = jobs
            .par_iter()
            .map(|(p, r)| self.residual(&self.params(added, &points[*p]), *r))
            .collect();
        let mut out = vec![vec![Vec::new(); self.runs.len()]; points.len()];
        for ((p, r), values) in jobs.into_iter().zip(done) {
            out[p][r] = values;
        }
        out
    }

    /// Values of the features of a run that `simulator` predicts.
    fn predicted(
        &self,
        simulator: &Simulator,
        params: &Params,
        spec: &RunSpec,
        run: usize,
    ) -> Result<Vec<f64>, Fault> {
        let mut record = simulator.run(params, spec, self.look.horizon(spec))?;
        for (channel, slot) in record.channel.iter_mut().enumerate() {
            if !self.measured[run].iter().any(|f| f.key.channel == channel) {
                *slot = None;
            }
        }
        let features = features::of_run(&self.plan, spec, run, &record);
        Ok(features.iter().map(|f| f.value).collect())
    }

    /// Measures what mesh and step of the fits cost, feature by feature, at `params` on the runs
    /// `of`, and takes it as their uncertainty from now on.
    ///
    /// # Errors
    /// What stops the reduction.
    pub fn measure_floor(&mut self, params: &Params, of: &[usize]) -> Result<(), Fault> {
        let fine = Simulator::cut(&self.plan, FINE)?;
        let found: Vec<Option<Vec<f64>>> = of
            .par_iter()
            .map(|r| {
                let spec = &self.runs[*r];
                let pair =
                    [&self.simulator, &fine].map(|s| self.predicted(s, params, spec, *r).ok());
                let [Some(coarse), Some(fine)] = pair else { return None };
                let same = coarse.len() == fine.len() && fine.len() == self.measured[*r].len();
                same.then(|| coarse.iter().zip(&fine).map(|(a, b)| a - b).collect())
            })
            .collect();
        for (r, errors) in of.iter().zip(found) {
            let Some(errors) = errors else { continue };
            let sigma = floor::measured(&self.measured[*r], &errors);
            self.inverse[*r] = sigma.into_iter().map(|s| 1.0 / s).collect();
        }
        Ok(())
    }

    /// Residuals of the runs `of` (all others empty) for whole parameters.
    pub fn residuals_of(&self, params: &Params, of: &[usize]) -> Residuals {
        let done: Vec<Vec<f64>> = of.par_iter().map(|r| self.residual(params, *r)).collect();
        let mut out = vec![Vec::new(); self.runs.len()];
        for (r, values) in of.iter().zip(done) {
            out[*r] = values;
        }
        out
    }

    fn residual(&self, params: &Params, run: usize) -> Vec<f64> {
        self.simulations.fetch_add(1, Ordering::Relaxed);
        let spec = &self.runs[run];
        let measured = &self.measured[run];
        let Ok(predicted) = self.predicted(&self.simulator, params, spec, run) else {
            return vec![FAILED; measured.len()];
        };
        let pairs = predicted.iter().zip(measured).zip(&self.inverse[run]);
        let residuals: Vec<f64> = pairs.map(|((p, m), w)| (p - m.value) * w).collect();
        if predicted.len() == measured.len() && residuals.iter().all(|r| r.is_finite()) {
            residuals
        } else {
            vec![FAILED; measured.len()]
        }
    }

    /// The simulated record of a run.
    ///
    /// # Errors
    /// What stops the block.
    pub fn simulate(
        &self,
        params: &Params,
        spec: &RunSpec,
    ) -> Result<super::campaign::Record, Fault> {
        self.simulations.fetch_add(1, Ordering::Relaxed);
        self.simulator.run(params, spec, spec.duration_s)
    }

    /// Weighted mean loss over the runs that `residuals` has: about 1 where the model is as good as
    /// noise and floor allow.
    pub fn gap(&self, residuals: &Residuals) -> f64 {
        let (mut sum, mut total) = (0.0, 0.0);
        for (run, weights) in residuals.iter().zip(&self.weight) {
            for (r, w) in run.iter().zip(weights) {
                sum += w * loss(*r);
                total += w;
            }
        }
        sum / f64::max(total, 1e-12)
    }

    /// Sum of weights of the runs `of`.
    pub fn total_weight(&self, of: &[usize]) -> f64 {
        of.iter().flat_map(|r| &self.weight[*r]).sum()
    }
}

/// Logarithmic loss c² ln(1 + (r/c)²): r² for small residuals.
pub fn loss(r: f64) -> f64 {
    TAIL * TAIL * (r / TAIL).powi(2).ln_1p()
}

/// Derivative of the loss over 2r: the weight of iteratively reweighted least squares.
pub fn robust_weight(r: f64) -> f64 {
    1.0 / (1.0 + (r / TAIL).powi(2))
}

/// n^(−1/2) for each of the n features of a cell: their errors are correlated.
fn weights(features: &[Feature]) -> Vec<f64> {
    let cell = |k: &Key| (k.channel, k.aspect, k.part);
    let mut count = BTreeMap::new();
    for feature in features {
        *count.entry(cell(&feature.key)).or_insert(0_usize) += 1;
    }
    let voice = |f: &Feature| match f.key.aspect {
        Aspect::Ringdown => RINGDOWN_WEIGHT,
        Aspect::Snap if f.key.part == 0 => SNAP_WEIGHT,
        _ => 1.0,
    };
    features.iter().map(|f| voice(f) / (count[&cell(&f.key)] as f64).sqrt()).collect()
}
