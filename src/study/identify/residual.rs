//! What the fit leaves, and whether an effect that the paper does not model explains it: every effect is fitted to
//! Table 1 beside all unknowns, from the same start and with the same effort.

use std::fmt::Write;

use serde_json::{json, Map, Value};

use super::gauss_newton::improve;
use super::objective::{Fineness, Problem};
use super::space::{get, places, Unknown};
use crate::block::Reductions;
use crate::effects::{fit_specs, FitParam, FitSpec, Spread};
use crate::params::Params;
use crate::study::paper::Column;
use crate::study::table_one::TableOne;

/// An effect begins at this share of its usual severity, and once more at the whole of it.
const BEGINNINGS: [f64; 2] = [0.1, 1.0];
/// Standard deviations of its prior that a parameter may go either way.
const REACH: f64 = 2.0;

/// What is asked of the residual.
pub struct Question<'a> {
    /// The fit, no effect on.
    pub fit: &'a Params,
    /// Its unknowns.
    pub unknowns: &'a [Unknown],
    /// Columns of Table 1.
    pub columns: &'a [Column],
    /// How finely.
    pub fineness: Fineness,
    /// Rounds of each local search.
    pub rounds: usize,
}

/// How far one effect gets; the first of a list is the base model after the same effort.
#[derive(Clone, Debug)]
pub struct Explained {
    /// Name of the effect with its form, or `none`.
    pub name: String,
    /// Cost left.
    pub cost: f64,
    /// Table 1 as it then is.
    pub table: TableOne,
    /// Parameters of the effect: name and value, SI.
    pub values: Vec<(&'static str, f64)>,
}

impl Question<'_> {
    /// Asks the base model and every effect in its first form; `told(name, done, of)` hears of each before it starts.
    pub fn ask(
        &self,
        reductions: &Reductions,
        mut told: impl FnMut(&str, usize, usize),
    ) -> Vec<Explained> {
        let specs = fit_specs();
        let of = specs.len() + 1;
        told("none", 0, of);
        let mut out = vec![self.best(None, reductions)];
        for (k, spec) in specs.iter().enumerate() {
            told(spec.effect, k + 1, of);
            out.push(self.best(Some(spec), reductions));
        }
        out
    }

    /// The better end of the searches from all beginnings.
    fn best(&self, spec: Option<&FitSpec>, reductions: &Reductions) -> Explained {
        let [a, b] = BEGINNINGS.map(|share| self.search(spec, share, reductions));
        if b.cost < a.cost {
            b
        } else {
            a
        }
    }

    fn search(&self, spec: Option<&FitSpec>, share: f64, reductions: &Reductions) -> Explained {
        let mut base = self.fit.clone();
        let mut unknowns = self.unknowns.to_vec();
        let mut name = "none".to_string();
        let form = spec.map(|s| (s, &s.forms[0]));
        if let Some((spec, form)) = form {
            let mut values: Vec<f64> = form.params.iter().map(|p| p.centre).collect();
            unknowns.extend(form.params.iter().enumerate().map(|(k, p)| unknown(p, k == 0)));
            // A signed severity is asked at its spread; its prior's centre is none at all.
            if let Spread::Absolute(std) = form.params[0].spread {
                values[0] += std;
            }
            values[0] *= share;
            spec.apply(0, &values, &mut base);
            name = format!("{} ({})", spec.effect, form.name);
        }
        let Self { columns, fineness, .. } = *self;
        let problem = Problem { base: &base, unknowns: &unknowns, columns, fineness, reductions };
        // The base model tries twice, too: once as it is, once from a step to the side.
        let mut start = places(&unknowns, &base);
        if spec.is_none() && share > 0.5 {
            start.iter_mut().for_each(|x| *x = (*x + 0.01).min(1.0));
        }
        let local = improve(&problem, start, self.rounds, |_, _| {});
        let params = problem.params(&local.x);
        let added = form.map_or(&[][..], |(_, f)| f.params);
        Explained {
            name,
            cost: Problem::cost(&local.residuals, &local.x),
            table: TableOne { cells: problem.compare(&local.x) },
            values: added.iter().map(|p| (p.name, get(&params, p.name))).collect(),
        }
    }
}

/// An effect's parameter as an unknown; a logarithmic severity may come near to none.
fn unknown(p: &FitParam, severity: bool) -> Unknown {
    match p.spread {
        Spread::Log(std) => {
            let least = if severity { 0.01 } else { (-REACH * std).exp() };
            let (low, high) = (p.centre * least, p.centre * (REACH * std).exp());
            Unknown { name: p.name, low, high, logarithmic: true }
        }
        Spread::Absolute(std) => Unknown {
            name: p.name,
            low: p.centre - REACH * std,
            high: p.centre + REACH * std,
            logarithmic: false,
        },
    }
}

/// The answers as a Markdown table, the best first.
pub fn markdown(answers: &[Explained]) -> String {
    let mut out = String::from("# What an effect would explain of the residual of Table 1\n\n");
    let mut sorted: Vec<&Explained> = answers.iter().collect();
    sorted.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    out.push_str("| effect | cost | median | largest | wrong cells | its parameters |\n");
    out.push_str("|---|---|---|---|---|---|\n");
    for e in sorted {
        let values: Vec<String> =
            e.values.iter().map(|(name, value)| format!("`{name}` {value:.3e}")).collect();
        let wrong: Vec<String> = e.table.disagreements().iter().map(|c| c.place()).collect();
        let wrong = if wrong.is_empty() { "none".to_string() } else { wrong.join(", ") };
        let [median, largest] = [e.table.median_error(), e.table.max_error()].map(|x| 100.0 * x);
        let _ = writeln!(
            out,
            "| {} | {:.3} | {median:.1} % | {largest:.1} % | {wrong} | {} |",
            e.name,
            e.cost,
            values.join(", ")
        );
    }
    out
}

/// The same as JSON, an object per effect.
pub fn json(answers: &[Explained]) -> Value {
    let of = |e: &Explained| {
        let values: Map<String, Value> =
            e.values.iter().map(|(name, value)| (name.to_string(), json!(value))).collect();
        json!({ "effect": e.name, "cost": e.cost, "table": e.table.figures(), "parameters": values })
    };
    answers.iter().map(of).collect()
}
