//! Further runs of a campaign's block: between the speeds and loads of its own.

use crate::gap::campaign::{Plan, RunKind, RunSpec};
use std::fmt::Write as _;

/// Further runs, at most.
const MOST: usize = 6;

/// The plan of further runs, and the campaign file `text` with them instead of its own.
pub(super) fn of(plan: &Plan, text: &str) -> (Plan, String) {
    let runs = between(&plan.runs);
    let head = text.split("[[runs]]").next().unwrap_or_default();
    let mut text = head.to_string();
    for run in &runs {
        let _ = write!(
            text,
            "[[runs]]\nfile = \"{}\"\nkind = \"sliding\"\nroad_speed_m_s = {}\nmean_pressure_pa = {}\n\
             duration_s = {}\n\n",
            run.file, run.road_speed_m_s, run.mean_pressure_pa, run.duration_s
        );
    }
    (Plan { runs, ..plan.clone() }, text)
}

/// Runs half way between one plain sliding run and the next in `runs` that differs from it in speed or load.
fn between(runs: &[RunSpec]) -> Vec<RunSpec> {
    let plain = |r: &&RunSpec| r.kind == RunKind::Sliding && r.dwell_s == 0.0;
    let plain: Vec<&RunSpec> = runs.iter().filter(plain).collect();
    let settings = |r: &RunSpec| (r.road_speed_m_s, r.mean_pressure_pa);
    let halves = |pair: &[&RunSpec]| {
        let [a, b] = [settings(pair[0]), settings(pair[1])];
        let half = (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1));
        (a != b && half.0.abs() > 0.0).then(|| (half, pair[0].clone()))
    };
    let found = plain.windows(2).filter_map(halves).take(MOST).enumerate();
    found
        .map(|(k, ((road_speed_m_s, mean_pressure_pa), like))| RunSpec {
            file: format!("runs/h{}.csv", k + 1),
            road_speed_m_s,
            mean_pressure_pa,
            ..like
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::campaign::parse_plan;
    use crate::gap::suite::TEMPLATE;

    #[test]
    fn further_runs_are_none_of_the_campaigns_own_and_are_read_back() {
        let plan = parse_plan(TEMPLATE, "template").unwrap();
        let (further, text) = of(&plan, TEMPLATE);
        assert_eq!(further.runs.len(), MOST);
        let settings = |r: &RunSpec| (r.road_speed_m_s, r.mean_pressure_pa);
        let own: Vec<_> = plan.runs.iter().map(settings).collect();
        assert!(further.runs.iter().all(|r| !own.contains(&settings(r))), "{text}");
        assert_eq!(parse_plan(&text, "further").unwrap().runs, further.runs);
    }
}
