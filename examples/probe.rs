use tread_block::{mesh::Mesh, params::Plane, reduction::Reduction};
fn main() {
    for (nx, nz) in [(5, 4), (7, 5), (10, 7), (16, 10)] {
        for (h, l) in [(0.010, 0.015), (0.006, 0.015), (0.010, 0.045), (0.006, 0.045)] {
            let t = std::time::Instant::now();
            let mesh = Mesh::block(l, h, nx, nz);
            let bound = (2.0 * std::f64::consts::PI * 40e3f64).powi(2) * 1100.0 / 50e6;
            let r = Reduction::of_block(mesh, 0.49, Plane::Stress, bound).unwrap();
            let f = r.frequencies(45471.0);
            println!("{nx} {nz} h{h} l{l}: modes {} f {:?} {:?}", r.modes() , &f[..4], t.elapsed());
        }
    }
}
