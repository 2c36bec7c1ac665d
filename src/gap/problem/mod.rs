//! The fitting problem: whitened parameters in, weighted residuals of the data vector out.

mod coordinate;
mod look;
mod weight;

pub use coordinate::{Choice, Coordinate};
pub use look::Look;
pub use weight::{loss, robust_weight};

use super::campaign::{Campaign, Plan, Record, RunSpec};
use super::features::{self, Feature};
use super::floor;
use super::simulate::{nominal, set, Simulator, FINE};
use crate::effects::fit::FitSpec;
use crate::error::Fault;
use crate::params::Params;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Residual of a run that could not be simulated.
const FAILED: f64 = 30.0;

/// A campaign's data vector with all that is needed to predict it.
#[derive(Debug)]
pub struct Bench {
    /// Settings of the campaign.
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
        let weight = measured.iter().map(|run| weight::weights(run)).collect();
        let base = coordinate::of_base(&plan);
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
    pub fn simulate(&self, params: &Params, spec: &RunSpec) -> Result<Record, Fault> {
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
