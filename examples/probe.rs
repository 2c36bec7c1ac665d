use tread_block::drive::{Cubic, Pose, Segment};
use tread_block::{Params, TreadBlock};
// probe: nx nz tol maxstep H bound
fn main() {
    let a: Vec<f64> = std::env::args().skip(1).map(|s| s.parse().unwrap()).collect();
    let cases = [(1, 0.010, 0.015, 250e3, 0.30), (2, 0.010, 0.015, 400e3, 0.15), (3, 0.006, 0.015, 250e3, 0.20), (4, 0.010, 0.045, 250e3, 0.30)];
    for (n, h, l, p, v) in cases {
        let mut params = Params::default();
        params.block.height = h; params.block.length = l;
        params.solver.elements_along = a[0] as usize; params.solver.elements_up = a[1] as usize;
        params.solver.tolerance = a[2]; params.solver.max_step = a[3]; params.solver.frequency_bound = a[5];
        params.solver.min_step = 2e-8;
        params.wear.coefficient = 0.0;
        let t0 = std::time::Instant::now();
        let mut b = TreadBlock::new(&params).unwrap();
        let build = t0.elapsed();
        let load = p * l * 0.015;
        b.initialize(0.0, Pose { x: 0.0, z: 0.0, angle: 0.0, load }).unwrap();
        b.open_ledger();
        let file = std::fs::read_to_string(format!("/work/shared/verification/slide-{n}.csv")).unwrap();
        let rows: Vec<Vec<f64>> = file.lines().skip(1).map(|l| l.split(',').map(|x| x.parse().unwrap()).collect()).collect();
        let end = rows.last().unwrap()[0];
        let hh = a[4];
        let (mut t, mut x) = (0.0, 0.0);
        let mut mine = vec![];
        let start = std::time::Instant::now();
        let steps = (end / hh).round() as usize;
        let ramp = 5e-4;
        let vel = |t: f64| -v * (t / ramp).min(1.0);
        for _ in 0..steps {
            let seg = Segment { x: Cubic([x, vel(t), 0.5 * (vel(t + hh) - vel(t)) / hh, 0.0]), z: Cubic::constant(0.0), angle: Cubic::constant(0.0), load: Cubic::constant(load) };
            b.advance(hh, &seg).unwrap();
            x = seg.x.at(hh);
            t += hh;
            let o = b.outputs();
            mine.push([t, o.contact_force[0], o.contact_force[1], o.run_in_displacement[0], o.run_in_velocity[0]]);
        }
        let wall = start.elapsed().as_secs_f64();
        let ana = |d: &Vec<[f64; 5]>| {
            let d: Vec<_> = d.iter().filter(|r| r[0] > 0.4 * end).collect();
            let mean = d.iter().map(|r| r[3]).sum::<f64>() / d.len() as f64;
            let mut up = vec![];
            for k in 1..d.len() { if d[k-1][3] < mean && d[k][3] >= mean { up.push(d[k-1][0] + (mean - d[k-1][3]) / (d[k][3] - d[k-1][3]) * (d[k][0] - d[k-1][0])); } }
            let f = (up.len() - 1) as f64 / (up[up.len()-1] - up[0]);
            let (t0, t1) = (up[0], up[up.len()-1]);
            let c: Vec<_> = d.iter().filter(|r| r[0] >= t0 && r[0] < t1).collect();
            let mu = c.iter().map(|r| r[1]).sum::<f64>() / c.iter().map(|r| r[2]).sum::<f64>();
            let max = c.iter().map(|r| r[3]).fold(-1.0, f64::max); let min = c.iter().map(|r| r[3]).fold(1.0, f64::min);
            (f, max - min, mu)
        };
        let theirs: Vec<[f64; 5]> = rows.iter().map(|r| [r[0], r[4], r[5], r[6], r[7]]).collect();
        let (m, r) = (ana(&mine), ana(&theirs));
        let s = b.statistics(); let lg = b.ledger().unwrap();
        println!("slide-{n}: f {:.2} ({:+.2}%) pp {:.3e} ({:+.2}%) mu {:.4} ({:+.2}%) | modes {} nodes {} rt {:.2} steps {} rej {} it/st {:.2} mat {} ledger {:.1e} of {:.2e} build {:.0}ms", m.0, 100.0*(m.0/r.0-1.0), m.1, 100.0*(m.1/r.1-1.0), m.2, 100.0*(m.2/r.2-1.0), b.reduction().modes(), b.reduction().contact_nodes(), end / wall, s.steps, s.rejected, s.iterations as f64 / (2*s.steps) as f64, s.matrices, lg.remainder()/lg.belt, lg.belt, build.as_secs_f64()*1e3);
    }
}
