//! What the data say without any model: runs that must agree, and sums that must be right.
//!
//! Two runs that differ only in the rest before them agree to the noise unless contacts age; a run
//! and its reverse mirror each other unless block or road has a direction; an edge moves by the
//! integral of its velocity; the road carries the load; the carriage obeys Newton's law. No parameter of the base model can break or
//! mend any of this, and no chaos of the stick-slip hides it: the same equations give the same numbers.

use super::balance;
use super::campaign::{
    Campaign, Run, RunKind, RunSpec, APPROACH, DISPLACEMENT, FRICTION, NORMAL, VELOCITY,
};
use crate::effects::fit_specs;

/// A rule that the data keep or break.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// A rest before the start changes nothing.
    Rest,
    /// A reversed run is the mirror image.
    Mirror,
    /// A repeated run is the same.
    Repeat,
    /// Displacement is the integral of velocity over the time that the file tells.
    Kinematics,
    /// Normal force at rest is the load.
    Load,
    /// The time column runs at the sampling rate.
    Clock,
    /// Load less normal force is what moves the carriage.
    Balance,
    /// The carriage goes where the measured force sends it.
    Carriage,
    /// There is no friction before the road moves.
    Zero,
    /// Runs that differ do so in more than one force.
    Forces,
}

/// Effects that break a rule; no other of the list does, and they always do. Found by looking at what
/// each effect's equations contain: a rest ages contacts; a tilt, a worn edge and a texture have a
/// direction or a place.
const BREAKERS: [(Rule, &[&str]); 10] = [
    (Rule::Rest, &["friction_ageing"]),
    (Rule::Mirror, &["road_texture", "misalignment", "worn_edge"]),
    (Rule::Repeat, &[]),
    (Rule::Kinematics, &[]),
    (Rule::Load, &[]),
    (Rule::Clock, &[]),
    (Rule::Balance, &[]),
    (Rule::Carriage, &[]),
    (Rule::Zero, &[]),
    (Rule::Forces, &[]),
];

/// Difference of runs over the noise, less that of repeated runs, from which a rule is broken. In the
/// labelled campaigns rules that are kept stay below 1.1 and broken ones are above 5.
const BROKEN: f64 = 1.35;
/// The same for the slope of displacement over the integral of velocity, which is within 0.5 % in the labelled
/// campaigns, for the load, and for the clock.
const WRONG_BY: [f64; 3] = [0.012, 0.012, 0.005];

/// A rule with what the data say of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The rule.
    pub rule: Rule,
    /// Difference over noise, or ratio.
    pub value: f64,
    /// Broken?
    pub broken: bool,
    /// In words, with the runs.
    pub text: String,
}

/// All rules that the campaign's runs can test.
pub fn findings(campaign: &Campaign) -> Vec<Finding> {
    let mut out = Vec::new();
    let repeat = worst(campaign, |a, b| same(a, b) && a.dwell_s == b.dwell_s, 1.0);
    let chance = repeat.as_ref().map_or(1.0, |r| r.0.clamp(1.0, BROKEN));
    let mut pairs = |rule, found: Option<(f64, String)>, limit: f64, what: &str| {
        let Some((value, runs)) = found else { return };
        let text = format!("{runs} differ by {value:.2} times the noise; {what}");
        out.push(Finding { rule, value, broken: value > limit, text });
    };
    pairs(Rule::Repeat, repeat, BROKEN, "they are repetitions");
    let rest = worst(campaign, |a, b| same(a, b) && a.dwell_s != b.dwell_s, 1.0);
    pairs(Rule::Rest, rest, BROKEN * chance, "only a rest before the start tells them apart");
    let mirror = worst(campaign, reversed, -1.0);
    pairs(Rule::Mirror, mirror, BROKEN * chance, "one is the other reversed");
    let mut ratios = |rule, value: Option<f64>, limit: f64, what: &str| {
        let Some(value) = value else { return };
        let text = format!("{what}: {value:.3}, should be 1");
        out.push(Finding { rule, value, broken: (value - 1.0).abs() > limit, text });
    };
    ratios(
        Rule::Kinematics,
        kinematics(campaign),
        WRONG_BY[0],
        "displacement of the edge over the integral of its velocity",
    );
    ratios(Rule::Load, load(campaign), WRONG_BY[1], "normal force at rest over the load");
    let clocks: Vec<f64> = campaign.runs.iter().map(|r| r.record.clock).collect();
    let clock = clocks.iter().sum::<f64>() / clocks.len().max(1) as f64;
    ratios(
        Rule::Clock,
        Some(clock),
        WRONG_BY[2],
        "step of the time column times the sampling rate",
    );
    out.extend(balance::findings(campaign));
    if let Some(found) = one_force(campaign) {
        // A sensor that drifts has no direction and no place: it says nothing of the mirror.
        out.retain(|f| !found.broken || f.rule != Rule::Mirror);
        out.push(found);
    }
    out
}

/// Is a run and its reverse different in one force alone, normal force or friction, and alike in the other and in the
/// approach? The block's own forces differ together, whatever the cause.
fn one_force(campaign: &Campaign) -> Option<Finding> {
    let runs = &campaign.runs;
    let pairs = (0..runs.len()).flat_map(|i| (i + 1..runs.len()).map(move |j| (i, j)));
    let (i, j) = pairs.into_iter().find(|(i, j)| reversed(&runs[*i].spec, &runs[*j].spec))?;
    let of = |c: usize, sign: f64| channel_difference(campaign, &runs[i], &runs[j], c, sign);
    let (friction, normal, approach) = (of(FRICTION, -1.0)?, of(NORMAL, 1.0)?, of(APPROACH, 1.0)?);
    let (largest, other) = (friction.max(normal), friction.min(normal).max(approach));
    let broken = largest > 2.0 * BROKEN && other < BROKEN;
    let name = if friction > normal { "friction" } else { "normal force" };
    let text = format!(
        "{} and {}, one the other reversed, differ by {largest:.2} times the noise in {name} and {other:.2} in all else",
        runs[i].spec.file, runs[j].spec.file
    );
    Some(Finding { rule: Rule::Forces, value: largest / other.max(1.0), broken, text })
}

/// Is one run the other reversed?
fn reversed(a: &RunSpec, b: &RunSpec) -> bool {
    let back = RunSpec { road_speed_m_s: -b.road_speed_m_s, ..b.clone() };
    same(a, &back) && a.dwell_s == b.dwell_s
}

/// The same run but for its file and the rest before it?
fn same(a: &RunSpec, b: &RunSpec) -> bool {
    let plain = |s: &RunSpec| RunSpec { file: String::new(), dwell_s: 0.0, ..s.clone() };
    a.kind == RunKind::Sliding && plain(a) == plain(b)
}

/// The largest difference over noise among pairs of runs that `alike` takes; `sign` is that of the
/// friction force.
fn worst(
    campaign: &Campaign,
    alike: impl Fn(&RunSpec, &RunSpec) -> bool,
    sign: f64,
) -> Option<(f64, String)> {
    let runs = &campaign.runs;
    let pairs = (0..runs.len()).flat_map(|i| (i + 1..runs.len()).map(move |j| (i, j)));
    pairs
        .filter(|(i, j)| alike(&runs[*i].spec, &runs[*j].spec))
        .filter_map(|(i, j)| {
            let value = difference(campaign, &runs[i], &runs[j], sign)?;
            Some((value, format!("{} and {}", runs[i].spec.file, runs[j].spec.file)))
        })
        .max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Root mean square of the difference of two runs over its noise, the largest of the channels.
fn difference(campaign: &Campaign, a: &Run, b: &Run, sign: f64) -> Option<f64> {
    let channel = |c: usize, sign: f64| channel_difference(campaign, a, b, c, sign);
    let values = [channel(FRICTION, sign), channel(NORMAL, 1.0), channel(APPROACH, 1.0)];
    values.into_iter().flatten().max_by(f64::total_cmp)
}

/// The same of one channel, of which `b` has the sign `sign`.
fn channel_difference(campaign: &Campaign, a: &Run, b: &Run, c: usize, sign: f64) -> Option<f64> {
    let noise = campaign.plan.noise[c].filter(|n| *n > 0.0)?;
    let (x, y) = (a.record.channel[c].as_ref()?, b.record.channel[c].as_ref()?);
    let count = x.len().min(y.len());
    let sum: f64 = x.iter().zip(y).map(|(x, y)| (x - sign * y).powi(2)).sum();
    (count > 100).then(|| (sum / count as f64).sqrt() / (noise * std::f64::consts::SQRT_2))
}

/// Slope of displacement over the integral of velocity by Simpson's rule, where the velocity changes slowly.
fn kinematics(campaign: &Campaign) -> Option<f64> {
    let noise = campaign.plan.noise[VELOCITY].unwrap_or(0.0);
    let (mut moved, mut square, mut count) = (0.0, 0.0, 0);
    for run in campaign.runs.iter().filter(|r| r.spec.kind != RunKind::Ringdown) {
        let record = &run.record;
        let (Some(v), Some(x)) = (&record.channel[VELOCITY], &record.channel[DISPLACEMENT]) else {
            continue;
        };
        for i in 1..v.len() - 1 {
            let bend = (v[i - 1] - 2.0 * v[i] + v[i + 1]).abs();
            let change = (v[i + 1] - v[i - 1]).abs();
            if bend < 4.0 * noise && change < 20.0 * noise && v[i].abs() > 25.0 * noise {
                let step = record.time[i + 1] - record.time[i - 1];
                let way = step * (v[i - 1] + 4.0 * v[i] + v[i + 1]) / 6.0;
                moved += (x[i + 1] - x[i - 1]) * way;
                square += way * way;
                count += 1;
            }
        }
    }
    (count > 200 && square > 0.0).then(|| moved / square)
}

/// Normal force in the first two samples over the load, mean of all runs.
fn load(campaign: &Campaign) -> Option<f64> {
    let block = campaign.plan.block;
    let values: Vec<f64> = campaign
        .runs
        .iter()
        .filter(|r| r.spec.kind != RunKind::Ringdown)
        .filter_map(|run| {
            let force = run.record.channel[NORMAL].as_ref()?.get(..2)?;
            let load = run.spec.mean_pressure_pa * block.length_m * block.width_m;
            Some(0.5 * (force[0] + force[1]) / load)
        })
        .collect();
    (values.len() > 4).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Does any single effect of the list explain which rules are broken?
pub fn beyond_list(findings: &[Finding]) -> bool {
    findings.iter().any(|f| f.broken && breakers(f.rule).is_empty())
}

fn breakers(rule: Rule) -> &'static [&'static str] {
    BREAKERS.iter().find(|b| b.0 == rule).map_or(&[], |b| b.1)
}

/// How many rules are broken that effects of the list break.
pub fn known(findings: &[Finding]) -> usize {
    findings.iter().filter(|f| f.broken && !breakers(f.rule).is_empty()).count()
}

/// Which single effects nothing but a rule beyond the list speaks against, or as little as can be.
pub fn possible(findings: &[Finding]) -> Vec<bool> {
    let within: Vec<Finding> =
        findings.iter().filter(|f| !breakers(f.rule).is_empty()).cloned().collect();
    let against: Vec<usize> =
        (0..fit_specs().len()).map(|e| contradictions(&within, &[e])).collect();
    let least = against.iter().copied().min().unwrap_or(0);
    against.into_iter().map(|n| n == least).collect()
}

/// How many findings speak against `effects` (indices into `fit_specs()`) as the cause: rules that are
/// broken though none of them could, or kept though one of them must break them.
pub fn contradictions(findings: &[Finding], effects: &[usize]) -> usize {
    let names: Vec<&str> = effects.iter().map(|e| fit_specs()[*e].effect).collect();
    let against = |f: &&Finding| {
        let able = names.iter().filter(|n| breakers(f.rule).contains(n)).count();
        if f.broken {
            able == 0
        } else {
            able > 0
        }
    };
    findings.iter().filter(against).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding(rule: Rule, broken: bool) -> Finding {
        Finding { rule, value: 1.0, broken, text: String::new() }
    }

    fn effect(name: &str) -> usize {
        fit_specs().iter().position(|s| s.effect == name).unwrap()
    }

    #[test]
    fn a_rest_that_matters_speaks_for_ageing_alone() {
        let found = [finding(Rule::Rest, true), finding(Rule::Mirror, false)];
        assert_eq!(contradictions(&found, &[effect("friction_ageing")]), 0);
        assert_eq!(contradictions(&found, &[effect("adhesion")]), 1);
        assert_eq!(contradictions(&found, &[]), 1);
        // A tilt would have broken the mirror as well.
        assert_eq!(contradictions(&found, &[effect("misalignment")]), 2);
    }

    #[test]
    fn every_breaker_is_an_effect_of_the_list() {
        for (_, names) in BREAKERS {
            names.iter().for_each(|n| _ = effect(n));
        }
    }
}
