//! Newton's law of the carriage, and forces before anything moves: both hold whatever block and road do.
//!
//! M z̈ + c ż = load − N with the approach z and the normal force N as they were measured: no parameter of the block
//! is in it. Twice integrated over a run of 24 ms, an error of N of a thousandth of the load moves z by 10 µm. What
//! breaks it is in the rig or in its sensors: a gain, an offset, cross-talk from friction, a load that is not
//! constant, a clock.

use super::campaign::{Campaign, Run, RunKind, APPROACH, FRICTION, NORMAL};
use super::symmetry::{Finding, Rule};

/// Missing force over the load, median of the runs, from which the balance is broken. In the labelled campaigns it
/// stays within 0.0002, single runs within 0.001.
const MISSING: f64 = 0.0015;
/// Remainder of z over what is expected, median of the runs: 0.9 to 1.05 in the labelled campaigns.
const ASTRAY: f64 = 1.4;
/// What sampling without an anti-aliasing filter adds to the remainder of z \[m\].
const ALIASED: f64 = 0.15e-6;
/// Mean friction before the road moves, in its standard deviations.
const RUBBING: f64 = 5.0;
/// Fewest runs for a median.
const FEWEST: usize = 4;

/// What the carriage and the first samples say.
pub fn findings(campaign: &Campaign) -> Vec<Finding> {
    let mut out = Vec::new();
    let found: Vec<[f64; 2]> = campaign.runs.iter().filter_map(|r| carriage(campaign, r)).collect();
    if found.len() >= FEWEST {
        let [missing, astray] = [0, 1].map(|k| median(found.iter().map(|f| f[k]).collect()));
        out.push(Finding {
            rule: Rule::Balance,
            value: 1.0 + missing,
            broken: missing.abs() > MISSING,
            text: format!(
                "load that the motion of the carriage asks for over the load: {:.4}, should be 1",
                1.0 + missing
            ),
        });
        out.push(Finding {
            rule: Rule::Carriage,
            value: astray,
            broken: astray > ASTRAY,
            text: format!(
                "the carriage strays from where the normal force sends it by {astray:.2} times the noise"
            ),
        });
    }
    out.extend(before_the_start(campaign));
    out
}

/// Missing force over the load, and the remainder of z over what noise and sampling explain.
fn carriage(campaign: &Campaign, run: &Run) -> Option<[f64; 2]> {
    let plan = &campaign.plan;
    let (normal, approach) =
        (run.record.channel[NORMAL].as_ref()?, run.record.channel[APPROACH].as_ref()?);
    let noise = plan.noise[APPROACH].filter(|n| *n > 0.0)?;
    let load = run.spec.mean_pressure_pa * plan.block.length_m * plan.block.width_m;
    let [mass, damping] = [plan.rig.load_carriage_mass_kg, plan.rig.load_carriage_damping_n_s_m];
    if run.spec.kind == RunKind::Ringdown || normal.len() < 200 || load <= 0.0 || mass <= 0.0 {
        return None;
    }
    let step = 1.0 / plan.sampling_rate;
    let pressed: Vec<f64> = normal.iter().map(|n| load - n).collect();
    let way = moved(&pressed, mass, damping, step);
    let unit = moved(&vec![1.0; normal.len()], mass, damping, step);
    let start = approach[..3].iter().sum::<f64>() / 3.0;
    let left: Vec<f64> = approach.iter().zip(&way).map(|(z, w)| z - start - w).collect();
    let square: f64 = unit.iter().map(|u| u * u).sum();
    let missing = unit.iter().zip(&left).map(|(u, l)| u * l).sum::<f64>() / square.max(1e-300);
    let rest: Vec<f64> = left.iter().zip(&unit).map(|(l, u)| l - missing * u).collect();
    let mean = rest.iter().sum::<f64>() / rest.len() as f64;
    let spread = rest.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / rest.len() as f64;
    Some([missing / load, spread.sqrt() / noise.hypot(ALIASED)])
}

/// Way \[m\] of a body at rest under `force` \[N\], by the trapezoidal rule with the damper solved exactly.
fn moved(force: &[f64], mass: f64, damping: f64, step: f64) -> Vec<f64> {
    let decay = (damping / mass * step).max(1e-12);
    let kept = (-decay).exp();
    let gain = (1.0 - kept) / decay * step / mass;
    let (mut speed, mut way) = (0.0, 0.0);
    let mut out = vec![0.0];
    for pair in force.windows(2) {
        let next = speed * kept + 0.5 * (pair[0] + pair[1]) * gain;
        way += 0.5 * step * (speed + next);
        speed = next;
        out.push(way);
    }
    out
}

/// Friction in the first sample of all runs.
fn before_the_start(campaign: &Campaign) -> Option<Finding> {
    let noise = campaign.plan.noise[FRICTION].filter(|n| *n > 0.0)?;
    let sliding = campaign.runs.iter().filter(|r| r.spec.kind != RunKind::Ringdown);
    let first: Vec<f64> =
        sliding.filter_map(|r| r.record.channel[FRICTION].as_ref()?.first().copied()).collect();
    let mean = first.iter().sum::<f64>() / first.len().max(1) as f64;
    let value = mean.abs() / noise * (first.len() as f64).sqrt();
    (first.len() >= FEWEST).then(|| Finding {
        rule: Rule::Zero,
        value,
        broken: value > RUBBING,
        text: format!(
            "friction before the road moves: {mean:.2} N, {value:.1} of its standard deviations"
        ),
    })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_force_moves_a_damped_body_as_newton_says() {
        // Closed form: z = F/c (t − (M/c)(1 − exp(−ct/M))), 2 kg, 240 N s/m, 1 N after 24 ms: 67.2 um to the
        // trapezoid's (ct/M)²/12 per step, 2e-6.
        let way = moved(&[1.0; 601], 2.0, 240.0, 40e-6);
        let t: f64 = 24e-3;
        let expected = (t - 2.0 / 240.0 * (1.0 - (-120.0 * t).exp())) / 240.0;
        assert!((way[600] / expected - 1.0).abs() < 1e-5, "{} {expected}", way[600]);
    }
}
