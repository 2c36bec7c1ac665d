//! Speed of the step kernel: steps, iterations and time for a few sliding cases.
use std::time::Instant;
use tread_block::metrics::{self, Recorder};
use tread_block::scenario::{self, Scenario, Slide};
use tread_block::{Params, TreadBlock};
fn main() {
    let arg = |k: usize, d: f64| std::env::args().nth(k).and_then(|s| s.parse().ok()).unwrap_or(d);
    let step = arg(1, 5.0) * 1e-6;
    let reps = arg(2, 5.0) as usize;
    for (h, l, mesh) in [
        (10e-3, 15e-3, [0, 0]),
        (10e-3, 15e-3, [6, 5]),
        (10e-3, 15e-3, [7, 5]),
        (10e-3, 45e-3, [0, 0]),
        (10e-3, 45e-3, [8, 5]),
    ] {
        let mut p = Params::default();
        p.block.height = h;
        p.block.length = l;
        p.wear.coefficient = 0.0;
        p.solver.max_step = step;
        (p.solver.elements_along, p.solver.elements_up) = (mesh[0], mesh[1]);
        let load = 0.25e6 * p.block.width * l;
        let scenario = Scenario::Slide(Slide::constant(0.3, load));
        let t0 = Instant::now();
        let p = scenario.fit(&p);
        let block0 = TreadBlock::new(&p).unwrap();
        let build = t0.elapsed().as_secs_f64();
        let mut best = f64::INFINITY;
        let mut r = None;
        for _ in 0..reps {
            let mut block = block0.clone();
            let mut rec = Recorder::default();
            let t0 = Instant::now();
            scenario::simulate(&mut block, &scenario, 20e-6, 0.03, |t, o| rec.push(t, o)).unwrap();
            best = best.min(t0.elapsed().as_secs_f64());
            r = Some((metrics::stick_slip(&rec.trace(), 0.3), block.statistics()));
        }
        let (s, st) = r.unwrap();
        println!("l{:.0} mesh {:?} modes {} nodes {}: build {:.3} run {:.4} s = {:.2} x real; steps {} rej {} it {} mat {}; {:.0} ns/step {:.0} ns/it; f {:.2} mu {:.5}",
            l*1e3, mesh, block0.reduction().modes(), block0.reduction().contact_nodes(), build, best, 0.03/best, st.steps, st.rejected, st.iterations, st.matrices, best/st.steps as f64*1e9, best/st.iterations as f64*1e9, s.frequency, s.mean_friction);
    }
}
