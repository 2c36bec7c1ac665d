//! What a friction record says, for people and as JSON.

use super::law::Law;
use super::record::FrictionRecord;
use super::verdict::Verdict;

/// A record's verdict for people.
pub fn table(record: &FrictionRecord, verdict: &Verdict) -> String {
    let unit = if record.piston { "N" } else { "1" };
    let mut out = format!(
        "{}: {} samples, {} strokes or steps, noise {:.3e} {unit}\n",
        record.file,
        record.samples.len(),
        record.last_stroke(),
        verdict.noise
    );
    for law in &verdict.laws {
        let memory = law.memory.map_or(String::new(), |m| match law.law {
            Law::ThermalFriction => format!(", over {m:.3e} s"),
            _ => format!(", over {m:.3e} m"),
        });
        let stretch = if law.stretch > 0.0 {
            format!(", speed arrives over {:.2e} m", law.stretch)
        } else {
            String::new()
        };
        let told: Vec<String> = law
            .coefficients
            .iter()
            .map(|(name, value, deviation)| format!("{name} {value:.4e} ± {deviation:.1e}"))
            .collect();
        out.push_str(&format!(
            "  {:<24} P {:.2}  held-out error {:.3e} {unit}  closes {:>4.0} %  {}{memory}{stretch}\n",
            law.law.name(),
            law.probability,
            law.held_out,
            100.0 * law.closed,
            told.join(", ")
        ));
    }
    let [a, b, c, d] = verdict.quarters;
    out.push_str(&format!(
        "  left by the best, by quarter of slip since a change: {a:.2e} {b:.2e} {c:.2e} {d:.2e} {unit}\n"
    ));
    if verdict.remainder {
        out.push_str("  the best law leaves more than the noise: partly explained, the remainder is unknown\n");
    }
    out
}

/// A record's verdict as JSON.
pub fn document(record: &FrictionRecord, verdict: &Verdict) -> serde_json::Value {
    serde_json::json!({
        "record": record.file,
        "samples": record.samples.len(),
        "noise": verdict.noise,
        "remainder_unknown": verdict.remainder,
        "error_by_quarter": verdict.quarters,
        "laws": verdict.laws.iter().map(|l| serde_json::json!({
            "law": l.law.name(),
            "probability": l.probability,
            "held_out_error": l.held_out,
            "closed_fraction": l.closed,
            "memory": l.memory,
            "stretch": l.stretch,
            "coefficients": l.coefficients.iter().map(|(name, value, deviation)| {
                serde_json::json!({"name": name, "value": value, "std": deviation})
            }).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
    })
}
