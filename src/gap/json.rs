//! `diagnosis.json`, schema `tread-block-diagnosis/1` (docs/diagnosis.schema.json).

use super::decide::{self, Cause};
use super::diagnose::{self, Diagnosis};
use super::hypotheses;
use super::problem::Look;
use super::simulate::nominal;
use crate::error::{Fault, Problem};
use crate::params::{table, Kind, Params, Value};
use serde_json::{json, Map, Value as Json};
use std::path::Path;

/// Name and version of the schema.
pub const SCHEMA: &str = "tread-block-diagnosis/1";

/// The document.
pub fn document(d: &Diagnosis) -> Json {
    json!({
        "schema": SCHEMA,
        "campaign": d.campaign.plan.id,
        "decision": decision(d),
        "hypotheses": hypotheses_json(d),
        "where": where_json(d),
        "modules": d.modules.iter().map(|(name, share)| json!({"name": name, "share": share}))
            .collect::<Vec<_>>(),
        "gap": gap_json(d),
        "indistinguishable": d.indistinguishable,
        "detectable": d.detectable.iter()
            .map(|(effect, a)| json!({"effect": effect, "min_severity": a})).collect::<Vec<_>>(),
        "next_experiment": experiments_json(d),
        "models": models_json(d),
        "recalibration": parameters(d, &Cause::None),
        "rules": rules_json(d),
        "flags": diagnose::flags(d).iter().map(Problem::to_string).collect::<Vec<_>>(),
        "provenance": provenance_json(d),
    })
}

/// Gap by run, channel, phase and band before any effect is added.
fn where_json(d: &Diagnosis) -> Vec<Json> {
    let rounded = |x: f64| (x * 1e6).round() / 1e6;
    d.cells
        .iter()
        .map(|c| {
            json!({
                "run": c.run, "channel": c.channel, "phase": c.phase, "band_hz": c.band,
                "gap": rounded(c.gap), "significant": c.significant,
            })
        })
        .collect()
}

/// How far the gap shrinks on the held-out runs.
fn gap_json(d: &Diagnosis) -> Json {
    let [value, lo, hi] = d.gap.closed;
    let file = |run: &usize| d.bench.runs[*run].file.clone();
    json!({
        "floor": 1,
        "nominal": d.gap.nominal,
        "recalibrated": d.gap.recalibrated,
        "with_effect": d.gap.with_effect,
        "sham_closed_fraction": d.gap.sham,
        "closed_fraction": {
            "value": value, "lo": lo, "hi": hi, "on_held_out_runs": d.gap.closed_unseen,
        },
        "held_out": d.gap.held_out.iter().map(file).collect::<Vec<_>>(),
    })
}

/// What to measure next.
fn experiments_json(d: &Diagnosis) -> Vec<Json> {
    d.experiments
        .iter()
        .map(|e| {
            json!({
                "name": e.run.file,
                "kind": "sliding",
                "road_speed_m_s": e.run.road_speed_m_s,
                "mean_pressure_pa": e.run.mean_pressure_pa,
                "dwell_s": e.run.dwell_s,
                "duration_s": e.run.duration_s,
                "between": e.between,
                "expected_gain_nats": e.gain,
            })
        })
        .collect()
}

/// The models that [`read_model`] reads, by what differs from the default parameters.
fn models_json(d: &Diagnosis) -> Json {
    let from_defaults = |params: &Params| changes(params, &Params::default());
    let best = diagnose::best_cause(&d.weighed);
    json!({
        "nominal": from_defaults(&nominal(&d.bench.plan)),
        "recalibrated": from_defaults(&d.bench.params(&[], &d.fits.base.fit.x)),
        "with-effect": from_defaults(&params_of(d, &best)),
        "with-effect_effects": decide::names(&d.bench, &d.fits, &best),
    })
}

/// Rules that need no model.
fn rules_json(d: &Diagnosis) -> Vec<Json> {
    d.fits
        .findings
        .iter()
        .map(|f| {
            json!({
                "rule": format!("{:?}", f.rule).to_lowercase(), "value": f.value,
                "broken": f.broken, "text": f.text,
            })
        })
        .collect()
}

/// From which data, with what chance and by which program the answers came.
fn provenance_json(d: &Diagnosis) -> Json {
    let hex = |hash: u64| format!("{hash:016x}");
    let runs = d.campaign.runs.iter();
    json!({
        "data_hash": hex(d.campaign.hash()),
        "runs": runs.map(|r| json!({"file": r.spec.file, "hash": hex(r.hash)}))
            .collect::<Vec<_>>(),
        "seed": d.settings.seed,
        "version": env!("CARGO_PKG_VERSION"),
        "simulations": d.simulations(),
        "seconds": (d.seconds * 10.0).round() / 10.0,
    })
}

/// What was decided, and the verdict in words.
pub fn decision(d: &Diagnosis) -> Json {
    json!({
        "kind": d.decision.kind.name(),
        "effects": d.decision.effects,
        "module": d.decision.module,
        "text": diagnose::verdict(d),
    })
}

/// Parameters of the model of a cause.
pub fn params_of(d: &Diagnosis, cause: &Cause) -> Params {
    let hypothesis = decide::fit_of(&d.fits, cause);
    d.bench.params(&hypothesis.fit.added, &hypothesis.fit.x)
}

fn hypotheses_json(d: &Diagnosis) -> Vec<Json> {
    d.weighed
        .iter()
        .zip(&d.closed)
        .map(|(w, closed)| {
            let mut out = Map::new();
            let effects = decide::names(&d.bench, &d.fits, &w.cause);
            out.insert("effects".into(), json!(effects));
            out.insert("probability".into(), json!(w.probability));
            out.insert("closed_fraction".into(), json!(closed));
            if w.cause != Cause::Unknown {
                out.insert("level".into(), json!(decide::fit_of(&d.fits, &w.cause).level));
            }
            let own = w.cause.is_fitted();
            let list = if own { parameters(d, &w.cause) } else { Vec::new() };
            let base = if own { d.bench.base_size() } else { 0 };
            out.insert("parameters".into(), json!(list.into_iter().skip(base).collect::<Vec<_>>()));
            Json::Object(out)
        })
        .collect()
}

/// Fitted parameters of a cause with standard deviations and priors.
pub fn parameters(d: &Diagnosis, cause: &Cause) -> Vec<Json> {
    let hypothesis = decide::fit_of(&d.fits, cause);
    let bench = if hypothesis.look == Look::Whole { &d.whole } else { &d.bench };
    let deviations = hypotheses::deviations(bench, hypothesis);
    d.bench
        .coordinates(&hypothesis.fit.added)
        .iter()
        .zip(hypothesis.fit.x.iter().zip(deviations))
        .map(|(c, (x, sd))| {
            json!({
                "name": c.name,
                "value": c.value(*x),
                "std": c.deviation(*x, sd),
                "unit": unit(c.name),
                "prior": c.centre,
                "sigmas_from_prior": (x * 1e3).round() / 1e3,
            })
        })
        .collect()
}

/// SI unit of a parameter.
pub(super) fn unit(name: &str) -> &'static str {
    match table::find(name).map(|spec| spec.kind) {
        Some(Kind::Real { unit, .. }) => unit,
        _ => "1",
    }
}

/// Parameters that differ from those of `plain`, by dotted name.
pub(super) fn changes(params: &Params, plain: &Params) -> Json {
    let mut out = Map::new();
    for spec in table::specs() {
        let value = (spec.get)(params);
        if value != (spec.get)(plain) {
            let value = match value {
                Value::Real(x) => json!(x),
                Value::Integer(_) if matches!(spec.kind, Kind::Enumeration { .. }) => {
                    json!(table::show(spec, &value))
                }
                Value::Integer(i) => json!(i),
                Value::Boolean(b) => json!(b),
                Value::Text(t) => json!(t),
            };
            out.insert(spec.name.to_string(), value);
        }
    }
    Json::Object(out)
}

/// The same as lines of TOML.
pub fn to_toml(model: &Map<String, Json>) -> String {
    model.iter().map(|(name, value)| format!("{name} = {value}\n")).collect()
}

/// Reads the parameters of `model` (nominal, recalibrated, with-effect) from a `diagnosis.json`.
///
/// # Errors
/// A file that cannot be read or is no diagnosis.
pub fn read_model(path: &Path, model: &str) -> Result<Params, Fault> {
    let fault = |reason: String| Fault::unusable(path, reason);
    let text = std::fs::read_to_string(path).map_err(|e| Fault::file(path, &e))?;
    let document: Json = serde_json::from_str(&text).map_err(|e| fault(e.to_string()))?;
    if document["schema"] != SCHEMA {
        return Err(fault(format!("schema is {}, not {SCHEMA}", document["schema"])));
    }
    let Some(values) = document["models"][model].as_object() else {
        return Err(fault(format!("has no model {model:?}; nominal, recalibrated, with-effect")));
    };
    // One way into the parameters for all: the names and checks of the TOML files.
    crate::params::load::from_toml(&to_toml(values))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every kind of parameter away from its default: what a diagnosis writes is what `predict` reads.
    #[test]
    fn a_model_comes_back_from_its_json_as_it_was() {
        let mut params = Params::default();
        params.solver.elements_along = 6;
        params.solver.elements_up = 4;
        params.rubber.young_modulus = 41.3e6;
        params.friction.form = crate::params::FrictionForm::Rational;
        params.effect.friction_ageing.enabled = true;
        params.effect.friction_ageing.form = crate::effects::friction_ageing::Form::Saturating;
        let written = changes(&params, &Params::default());
        let lines = to_toml(written.as_object().expect("a table"));
        assert_eq!(crate::params::load::from_toml(&lines).expect("readable"), params);
    }
}
