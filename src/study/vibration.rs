//! Figures 5 and 6: how rubber and sliding speed change the vibrations of a sliding block.

use super::identify::objective::Fineness;
use super::plot::svg;
use super::report::{Study, Verdict};
use super::variation::{base, run_all, trend, Run, Traces, Variation};
use crate::error::Fault;
use crate::metrics::StickSlip;
use crate::params::Params;

/// Figure 5: Young's modulus and damping.
///
/// # Errors
/// What stops the block.
pub fn fig_5(compound: &Params, fineness: &Fineness) -> Result<Study, Fault> {
    let base = base(compound, fineness);
    let moduli = [15e6, 30e6, 45e6, 60e6, 75e6].map(|e: f64| {
        let mut run = base.clone();
        run.params.rubber.young_modulus = e;
        Run { label: format!("E = {:.0} N/mm2", 1e-6 * e), value: e, ..run }
    });
    let damping = FACTORS.map(|factor: f64| {
        let mut run = base.clone();
        run.params.rubber.stiffness_damping *= factor;
        let beta = run.params.rubber.stiffness_damping;
        Run { label: format!("beta = {:.0} us", 1e6 * beta), value: beta, ..run }
    });
    let modulus = Variation {
        name: "fig-5-modulus",
        header: "young_modulus_pa",
        title: "Young's modulus".to_string(),
        runs: run_all(moduli.to_vec())?,
    };
    let damping = Variation {
        name: "fig-5-damping",
        header: "stiffness_damping_s",
        title: "Damping factor".to_string(),
        runs: run_all(damping.to_vec())?,
    };
    let notes = format!("{}{}", modulus.beyond_small_strain(), of_damping(&damping));
    let mut verdicts = trend(&modulus.runs, "E", [false, true]);
    let light = &damping.runs[..swinging(&damping)];
    let to = light.last().map_or(0.0, |r| 1e6 * r.0.value);
    verdicts.extend(trend(light, &format!("beta up to {to:.0} us"), [false, true]));
    let first = damping.runs.iter().find(|r| r.2.frequency == 0.0).map(|r| r.0.value);
    verdicts.push(Verdict::new(
        "for large damping the oscillation vanishes",
        damping.runs.last().is_some_and(|r| r.2.frequency == 0.0),
        first.map_or("never".to_string(), |b| format!("from {:.0} us on", 1e6 * b)),
    ));
    Ok(Study {
        name: "fig-5",
        title: "Young's modulus and material damping",
        notes,
        tables: vec![modulus.summary(), damping.summary(), modulus.traces(), damping.traces()],
        pictures: vec![(
            "fig-5.svg".to_string(),
            svg(&[modulus.displacements(), damping.displacements()], 2)?,
        )],
        verdicts,
    })
}

/// Damping over the identified one: from a lightly damped block to one that is silent.
const FACTORS: [f64; 7] = [0.3, 0.4, 0.6, 0.75, 1.0, 1.5, 3.0];
/// First eigenfrequency of the base case's free block \[Hz\]: Table 1, h10l45.
const FREE: f64 = 2876.0;
/// Damping over the critical one at [`FREE`], pi f0 beta, up to which a free block swings rather than creeps.
const SWINGS: f64 = 0.75;

/// Damping over the critical one of the base case's first mode: pi f0 beta.
fn critical(beta: f64) -> f64 {
    std::f64::consts::PI * FREE * beta
}

/// How many of the runs, in the order of rising damping, are of blocks that swing.
fn swinging(damping: &Variation) -> usize {
    damping.runs.iter().take_while(|r| critical(r.0.value) <= SWINGS).count()
}

/// What to know of the damping's range.
fn of_damping(damping: &Variation) -> String {
    let (light, heavy) = damping.runs.split_at(swinging(damping));
    let to = light.last().map_or(0.0, |r| 1e6 * r.0.value);
    let told: Vec<String> = heavy
        .iter()
        .filter(|r| r.2.frequency > 0.0)
        .map(|(run, _, m)| format!("{:.0} Hz at {:.0} us", m.frequency, 1e6 * run.value))
        .collect();
    let beyond = if told.is_empty() { "silence".to_string() } else { told.join(", ") };
    format!(
        "The values of beta are lost in the paper. The trends are asked up to {to:.0} us, {SWINGS} of the critical \
         damping of the first mode. Beyond, the block does not swing back but creeps, the more slowly the more it is \
         damped: {beyond}."
    )
}

/// Figure 6: sliding speed.
///
/// # Errors
/// What stops the block.
pub fn fig_6(compound: &Params, fineness: &Fineness) -> Result<Study, Fault> {
    let runs = [0.05, 0.1, 0.2, 0.3, 0.4, 0.5].map(|speed: f64| Run {
        label: format!("{:.0} mm/s", 1e3 * speed),
        value: speed,
        speed,
        ..base(compound, fineness)
    });
    let speeds = Variation {
        name: "fig-6",
        header: "speed_m_s",
        title: "Sliding speed".to_string(),
        runs: run_all(runs.to_vec())?,
    };
    let time: Vec<f64> = speeds.runs.iter().map(|r| 1e2 * time_stuck(&r.1, &r.2)).collect();
    let verdicts = speed_verdicts(&speeds, &time);
    Ok(Study {
        name: "fig-6",
        title: "Sliding speed",
        notes: format!(
            "A sticking phase: more than half of the contact slides slower than 15 % of the road speed at some time \
             of the settled part. It does so for {:.0}, {:.0}, {:.0} and {:.0} % of the time at 100, 200, 300 and \
             400 mm/s. The identified damping is {:.2} of the critical one of the free block's first mode: such a \
             block does not swing through, it is let go and caught again, also near its critical speed.",
            time[1],
            time[2],
            time[3],
            time[4],
            critical(compound.rubber.stiffness_damping)
        ),
        tables: vec![speeds.summary(), speeds.traces()],
        pictures: vec![(
            "fig-6.svg".to_string(),
            svg(&[speeds.displacements(), speeds.limit_cycles()], 2)?,
        )],
        verdicts,
    })
}

/// Where the paper's block oscillates and sticks; `time` is the share of the time in which runs do \[%\].
fn speed_verdicts(speeds: &Variation, time: &[f64]) -> Vec<Verdict> {
    let hz = speeds.frequencies();
    let stick: Vec<f64> = speeds.runs.iter().map(|r| most_stuck(&r.1, &r.2)).collect();
    let told = |i: usize| match hz[i] {
        hz if hz > 0.0 => format!("{hz:.0} Hz"),
        _ => "silent".to_string(),
    };
    vec![
        Verdict::new("no oscillation at 50 mm/s", hz[0] == 0.0, told(0)),
        Verdict::new(
            "oscillation from 100 to 400 mm/s",
            hz[1..5].iter().all(|f| *f > 0.0),
            format!("{:.0} to {:.0} Hz", hz[1], hz[4]),
        ),
        Verdict::new("no oscillation at 500 mm/s", hz[5] == 0.0, told(5)),
        Verdict::new(
            "a sticking phase at 100, 200 and 300 mm/s",
            stick[1..4].iter().all(|s| *s > 0.5),
            format!(
                "up to {:.0}, {:.0}, {:.0} % stuck",
                1e2 * stick[1],
                1e2 * stick[2],
                1e2 * stick[3]
            ),
        ),
        Verdict::new(
            "no prominent sticking phase at 400 mm/s",
            stick[4] < 0.5,
            format!("up to {:.0} % stuck, {:.0} % of the time", 1e2 * stick[4], time[4]),
        ),
    ]
}

/// Largest share of the contact that sticks at one time of the settled part.
fn most_stuck(traces: &Traces, metrics: &StickSlip) -> f64 {
    traces
        .time
        .iter()
        .zip(&traces.stick)
        .filter(|(t, _)| **t >= metrics.settled_from)
        .map(|(_, s)| *s)
        .fold(0.0, f64::max)
}

/// Share of the time of the settled part in which more than half of the contact sticks.
fn time_stuck(traces: &Traces, metrics: &StickSlip) -> f64 {
    let settled =
        traces.time.iter().zip(&traces.stick).filter(|(t, _)| **t >= metrics.settled_from);
    let (mut stuck, mut all) = (0.0, 0.0_f64);
    for (_, share) in settled {
        stuck += f64::from(u8::from(*share > 0.5));
        all += 1.0;
    }
    stuck / all.max(1.0)
}
