//! A step compiled for the instruction sets that machines have, and for the usual numbers of packs.

use super::TrBdf2;
use crate::contact::Face;
use crate::dynamics::kinematics::Kinematics;
use crate::dynamics::linear::Linear;
use crate::dynamics::matrices::StageMatrices;
use crate::dynamics::state::State;
use crate::dynamics::{dense, energy};
use crate::error::Fault;
use crate::pack::{Aligned, LANES};
use multiversion::multiversion;

/// Contact displacements Φ·`modal` without padding effects, for the instruction set at hand.
#[multiversion(targets(
    "x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub fn contact_motion(linear: &Linear, modal: &Aligned, out: &mut Aligned) {
    dense::multiply(out.packs_mut(), linear.by_mode.packs(), modal.packs());
}

/// [`TrBdf2::go_on`] for the instruction set at hand.
#[multiversion(targets(
    "x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub(super) fn go_on(step: &mut TrBdf2) {
    step.go_on();
}

/// The work of a step with `N` packs of nodes (0: as many as there are), compiled for several instruction sets
/// of which the machine's best is taken; all give the same bits, because sums have a fixed order and fused
/// operations are spelled out.
#[multiversion(targets(
    "x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub(super) fn both_stages<const N: usize>(
    step: &mut TrBdf2,
    linear: &Linear,
    face: &Face,
    state: &State,
    matrices: &StageMatrices,
    ends: &[Kinematics; 3],
    h: f64,
) -> Result<(), Fault> {
    // Without vectors to speak of, one version for all sizes: eight calls for a fused product are slow to compile,
    // and nothing is won by unrolling them.
    if !multiversion::target::target_cfg_f!(target_feature = "fma") {
        return on_any_machine(step, linear, face, state, matrices, ends, h);
    }
    let n = if N == 0 { linear.stride / LANES } else { N };
    stages_of(step, n, linear, face, state, matrices, ends, h)
}

/// [`both_stages`] for processors without fused products.
#[inline(never)]
fn on_any_machine(
    step: &mut TrBdf2,
    linear: &Linear,
    face: &Face,
    state: &State,
    matrices: &StageMatrices,
    ends: &[Kinematics; 3],
    h: f64,
) -> Result<(), Fault> {
    stages_of(step, linear.stride / LANES, linear, face, state, matrices, ends, h)
}

/// Both stages with `n` packs of nodes, compiled for the instruction set of the caller.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
fn stages_of(
    step: &mut TrBdf2,
    n: usize,
    linear: &Linear,
    face: &Face,
    state: &State,
    matrices: &StageMatrices,
    ends: &[Kinematics; 3],
    h: f64,
) -> Result<(), Fault> {
    let (profile, worn) = (&face.profile.packs()[..n], &state.worn.packs()[..n]);
    let gap = &mut step.gap.packs_mut()[..n];
    for k in 0..n {
        gap[k] = profile[k] + worn[k];
    }
    step.raise_road(linear, face, state, &ends[2], h);
    // One place where a stage is solved: the solver is large, and inlined once.
    for (k, end) in ends[1..].iter().enumerate() {
        match k {
            0 => step.begin_first_stage(n, linear, state, matrices, ends),
            _ => step.begin_second_stage(n, linear, state, h),
        }
        let factor = &state.friction_factor;
        let solved = step.stage.solve(n, linear, face, matrices, end, &step.gap, factor);
        step.count(solved, state.time, matrices.a)?;
        if k == 0 {
            step.end_first_stage(n, linear, matrices, ends);
        }
    }
    if step.keep_power {
        step.powers[2] = energy::power(linear, &step.stage, &ends[2]);
    }
    step.write_trial(linear, &ends[2]);
    step.judge(linear, state, matrices, h);
    Ok(())
}
