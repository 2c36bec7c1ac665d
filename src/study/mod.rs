//! The paper's studies on the project's own model, side by side with the paper's numbers.

pub mod cycle_jump;
pub mod fig_2;
pub mod fig_3;
pub mod fig_4;
pub mod identify;
pub mod paper;
pub mod plot;
pub mod report;
pub mod rolling;
pub mod slides;
pub mod table_one;
pub mod variation;
pub mod vibration;
pub mod wear_laws;

use crate::error::{Fault, Problem};
use crate::params::Params;
use identify::objective::Fineness;
use report::Study;

type Runner = fn(&Params, &Fineness) -> Result<Study, Fault>;

/// The studies in the order of the paper.
const STUDIES: &[(&str, Runner)] = &[
    ("fig-2", fig_2::fig_2),
    ("fig-3", fig_3::fig_3),
    ("fig-4", fig_4::fig_4),
    ("fig-5", vibration::fig_5),
    ("fig-6", vibration::fig_6),
    ("fig-7", vibration::fig_7),
    ("table-1", table_one::table_1),
    ("fig-8", rolling::fig_8),
    ("fig-9", rolling::fig_9),
];

/// Runs the study of that name, or `all`.
///
/// # Errors
/// What stops a block; an unknown name.
pub fn run(name: &str, compound: &Params, fineness: &Fineness) -> Result<Vec<Study>, Fault> {
    let wanted: Vec<_> =
        STUDIES.iter().filter(|(study, _)| name == "all" || *study == name).collect();
    if wanted.is_empty() {
        let names: Vec<&str> = STUDIES.iter().map(|s| s.0).collect();
        return Err(Fault::one(Problem::new(
            "study",
            name,
            format!("{}, all", names.join(", ")),
            "name one of them",
        )));
    }
    wanted.into_iter().map(|(_, study)| study(compound, fineness)).collect()
}
