//! The paper's studies on the project's own model, side by side with the paper's numbers.

pub mod cycle_jump;
pub mod fig_2;
pub mod fig_3;
pub mod fig_4;
pub mod fig_7;
pub mod identified;
pub mod identify;
pub mod margin;
pub mod measured;
pub mod paper;
pub mod plot;
pub mod report;
pub mod rolling;
pub mod slides;
pub mod start;
pub mod table_one;
pub mod variation;
pub mod vibration;
pub mod watch;
pub mod wear_laws;

use crate::error::{Fault, Problem};
use crate::params::Params;
use identify::objective::Fineness;
use measured::Measurements;
use report::Study;

/// How a study is run: from the model alone, or beside measured data.
#[derive(Clone, Copy)]
enum Runner {
    Model(fn(&Params, &Fineness) -> Result<Study, Fault>),
    Measured(fn(&Params, &Fineness, &Measurements) -> Result<Study, Fault>),
}

/// The studies in the order of the paper.
const STUDIES: &[(&str, Runner)] = &[
    ("fig-2", Runner::Measured(fig_2::fig_2)),
    ("fig-3", Runner::Measured(fig_3::fig_3)),
    ("fig-4", Runner::Model(fig_4::fig_4)),
    ("fig-5", Runner::Model(vibration::fig_5)),
    ("fig-6", Runner::Model(vibration::fig_6)),
    ("fig-7", Runner::Model(fig_7::fig_7)),
    ("table-1", Runner::Model(table_one::table_1)),
    ("fig-8", Runner::Model(rolling::fig_8)),
    ("fig-9", Runner::Model(rolling::fig_9)),
];

/// Runs the study of that name, or `all`; `told(name, done, of)` hears of each before it starts.
///
/// # Errors
/// What stops a block; an unknown name.
pub fn run(
    name: &str,
    compound: &Params,
    fineness: &Fineness,
    measured: &Measurements,
    mut told: impl FnMut(&str, usize, usize),
) -> Result<Vec<Study>, Fault> {
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
    let one = |runner: Runner| match runner {
        Runner::Model(study) => study(compound, fineness),
        Runner::Measured(study) => study(compound, fineness, measured),
    };
    let count = wanted.len();
    let mut studies = Vec::new();
    for (at, (name, runner)) in wanted.into_iter().enumerate() {
        told(name, at, count);
        studies.push(one(*runner)?);
    }
    Ok(studies)
}
