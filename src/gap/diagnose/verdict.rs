//! The answers in words.

use super::Diagnosis;
use crate::gap::decide::Kind;

/// The verdict in words.
pub fn verdict(d: &Diagnosis) -> String {
    let gap = &d.gap;
    let top = d.weighed.first().map_or(0.0, |w| w.probability);
    let opening = format!(
        "On runs that no fit has seen the datasheet model is {:.1} times the floor off, the recalibrated one {:.1}.",
        gap.nominal, gap.recalibrated
    );
    let closing =
        format!("is expected to close {} of what recalibration leaves", gap.closed_in_words());
    let names = d.decision.effects.join(" + ");
    match d.decision.kind {
        Kind::None => format!("{opening} No gap that an effect would be needed for (P = {top:.2})."),
        Kind::Named => format!("{opening} The rest is consistent with {names} (P = {top:.2}), which {closing}."),
        Kind::Class => format!(
            "{opening} The rest is consistent with one or more of: {}; the data cannot tell which. The likeliest {closing}.",
            d.decision.effects.join(", ")
        ),
        Kind::Unknown => {
            let nearest = match &d.decision.module {
                Some(module) => format!("what comes nearest is of the module {module}"),
                None => "none takes anything off it".to_string(),
            };
            format!("{opening} No candidate explains the rest (P(unknown) = {top:.2}); {nearest}.")
        }
        Kind::Undecidable => format!("{opening} Nothing can be said."),
    }
}
