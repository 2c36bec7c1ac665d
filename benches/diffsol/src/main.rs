//! diffsol on the reduced equations, with the compiled right-hand side of benches/peers/rhs.c.
//!
//!     diffsol-peer METHOD MODEL RTOL ATOL DURATION STEP TRACE       METHOD: bdf, tr_bdf2, esdirk34
//!
//! Output as of benches/peers/cvode.c.

use std::error::Error;
use std::ffi::{c_char, c_double, c_int, c_long, CString};
use std::fmt::Write;

use diffsol::{NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder, OdeEquations, OdeSolverMethod};

#[repr(C)]
struct Problem {
    _opaque: [u8; 0],
}

extern "C" {
    fn problem_read(path: *const c_char) -> *mut Problem;
    fn problem_size(p: *const Problem) -> c_int;
    fn problem_start(p: *const Problem, y: *mut c_double);
    fn problem_rhs(p: *mut Problem, t: c_double, y: *const c_double, dy: *mut c_double);
    fn problem_jvp(p: *mut Problem, t: c_double, y: *const c_double, v: *const c_double, jv: *mut c_double);
    fn problem_observe(p: *mut Problem, t: c_double, y: *const c_double, out: *mut c_double);
    fn problem_calls(p: *const Problem) -> c_long;
}

/// Seconds that the processor has spent on this thread, by the kernel's count.
fn busy() -> f64 {
    let text = std::fs::read_to_string("/proc/self/schedstat").unwrap_or_default();
    text.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()).map_or(0.0, |ns| 1e-9 * ns)
}

/// Steps to the end and returns the seconds spent and the rows of the trace.
fn solve<'a, E>(
    mut solver: impl OdeSolverMethod<'a, E>,
    (p, size): (*mut Problem, usize),
    duration: f64,
    step: f64,
) -> Result<(f64, String, u64), Box<dyn Error>>
where
    E: OdeEquations<T = f64, V = NalgebraVec<f64>, M = NalgebraMat<f64>> + 'a,
{
    let mut rows = String::new();
    let mut y = solver.state().y.clone();
    let (mut spent, mut steps) = (0.0, 0);
    for k in 0..=(duration / step).round() as usize {
        let t = k as f64 * step;
        let start = busy();
        while solver.state().t < t {
            solver.step()?;
            steps += 1;
        }
        solver.interpolate_inplace(t, &mut y)?;
        spent += busy() - start;
        let mut out = [0.0; 3];
        let state: Vec<f64> = (0..size).map(|i| y[i]).collect();
        // SAFETY: the state has the size of the problem, `out` three numbers.
        unsafe { problem_observe(p, t, state.as_ptr(), out.as_mut_ptr()) };
        writeln!(rows, "{t:e},{:e},{:e},{:e},0", out[0], out[1], out[2])?;
    }
    Ok((spent, rows, steps))
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [method, model, rtol, atol, duration, step, trace] = words.as_slice() else {
        return Err("METHOD MODEL RTOL ATOL DURATION STEP TRACE".into());
    };
    let (rtol, atol): (f64, f64) = (rtol.parse()?, atol.parse()?);
    let (duration, step): (f64, f64) = (duration.parse()?, step.parse()?);
    let path = CString::new(model.as_str())?;
    // SAFETY: the problem lives to the end of the program; slices below have its size.
    let p = unsafe { problem_read(path.as_ptr()) };
    let size = unsafe { problem_size(p) } as usize;
    let modes = size / 2 - 1;
    let fast = |i: usize| (modes..2 * modes).contains(&i) || i == size - 1;
    let mut problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(rtol)
        .atol((0..size).map(|i| if fast(i) { 2e4 * atol } else { atol }))
        .rhs_implicit(
            move |y, _, t, dy| unsafe { problem_rhs(p, t, y.as_ptr(), dy.as_mut_ptr()) },
            move |y, _, t, v, jv| unsafe { problem_jvp(p, t, y.as_ptr(), v.as_ptr(), jv.as_mut_ptr()) },
        )
        .init(move |_, _, y| unsafe { problem_start(p, y.as_mut_ptr()) }, size)
        .build()?;
    // Stick-slip has a corner per catch and release: the limit of 50 failures is over within 2 ms.
    problem.ode_options.max_nonlinear_solver_failures = usize::MAX;
    problem.ode_options.max_error_test_failures = usize::MAX;
    problem.ode_options.min_timestep = 1e-16;
    type Lu = NalgebraLU<f64>;
    let (spent, rows, steps) = match method.as_str() {
        "bdf" => solve(problem.bdf::<Lu>()?, (p, size), duration, step)?,
        "tr_bdf2" => solve(problem.tr_bdf2::<Lu>()?, (p, size), duration, step)?,
        _ => solve(problem.esdirk34::<Lu>()?, (p, size), duration, step)?,
    };
    let header = "time,run_in.displacement.x,run_in.velocity.x,contact.friction_coefficient,\
                  contact.stick_fraction\n";
    std::fs::write(trace, header.to_string() + &rows)?;
    let calls = unsafe { problem_calls(p) };
    println!("{{\"seconds\": [{spent}], \"duration\": {duration}, \"steps\": {steps}, \"calls\": {calls}}}");
    Ok(())
}
