//! The reduced model against the full one: statics, eigenfrequencies, motion.
//!
//! The full model is solved here with other means than the reduction's: a sparse factorisation of all
//! degrees of freedom, a dense eigenvalue problem, and the exponential of the first-order system.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use nalgebra_sparse::factorization::CscCholesky;
use tread_block::block::Shape;
use tread_block::drive::{Cubic, Pose, Segment};
use tread_block::fe::{assemble, FullModel};
use tread_block::mesh::Mesh;
use tread_block::params::{NormalDrive, Plane};
use tread_block::reduction::Reduction;
use tread_block::{Params, TreadBlock};

const POISSON: f64 = 0.49;

/// Full and reduced model of the block that the parameters describe.
fn both(params: &Params) -> (FullModel, Reduction) {
    let shape = Shape::of(params);
    let (along, up) = shape.elements;
    let mesh = Mesh::block(shape.length, shape.height, along, up);
    (assemble(&mesh, shape.poisson_ratio, shape.plane), shape.reduce().unwrap())
}

/// Every mode kept: the reduction is then a change of basis.
fn unreduced(mesh: Mesh) -> (FullModel, Reduction) {
    let full = assemble(&mesh, POISSON, Plane::Stress);
    let reduction = Reduction::of_block(mesh, None, POISSON, Plane::Stress, f64::INFINITY).unwrap();
    assert_eq!(reduction.modes(), full.dofs(), "no mode may be missing");
    (full, reduction)
}

/// Free degrees of freedom of the contact nodes: all x, then all z.
fn contact_dofs(reduction: &Reduction) -> Vec<usize> {
    let face = reduction.mesh.tread_face();
    (0..2).flat_map(|axis| face.iter().map(move |n| reduction.dof[2 * n + axis].unwrap())).collect()
}

/// Numbers in ±1 without a pattern (multiplicative congruence of Lehmer).
fn random(count: usize) -> Vec<f64> {
    let mut seed = 20_10_u64;
    (0..count)
        .map(|_| {
            seed = seed * 48_271 % 2_147_483_647;
            2.0 * seed as f64 / 2_147_483_647.0 - 1.0
        })
        .collect()
}

#[test]
fn static_deflection_under_any_contact_load_is_the_full_models() {
    // Few modes: statics must not need them. Tolerance of the project: 1e-9.
    for (height, length) in [(0.010, 0.015), (0.006, 0.045)] {
        let mut params = Params::default();
        (params.block.height, params.block.length) = (height, length);
        params.solver.frequency_bound = 1e3;
        let (full, reduction) = both(&params);
        let mut load = DVector::zeros(full.dofs());
        let contact = contact_dofs(&reduction);
        for (dof, f) in contact.iter().zip(random(contact.len())) {
            load[*dof] = f;
        }
        let expected = CscCholesky::factor(&full.stiffness).unwrap().solve(&load);
        let mut amplitudes = reduction.shapes.transpose() * &load;
        for (amplitude, lambda) in amplitudes.iter_mut().zip(&reduction.lambda) {
            *amplitude /= lambda;
        }
        let found = &reduction.shapes * &amplitudes;
        let error = (&found - &expected).amax() / expected.amax();
        println!(
            "h {height} l {length}: {} of {} coordinates, static error {error:.1e}",
            reduction.modes(),
            full.dofs()
        );
        assert!(error < 1e-9, "{error:e}");
        let face = &reduction.contact_modes * &amplitudes;
        for (row, dof) in contact.iter().enumerate() {
            assert!((face[row] - expected[(*dof, 0)]).abs() < 1e-9 * expected.amax());
        }
    }
}

/// Eigenvalues of the full pencil, ascending, by a dense solver.
fn dense_eigenvalues(full: &FullModel) -> Vec<f64> {
    let root = DMatrix::from(&full.mass).cholesky().unwrap().l();
    let half = root.solve_lower_triangular(&DMatrix::from(&full.stiffness)).unwrap();
    let standard = root.solve_lower_triangular(&half.transpose()).unwrap();
    let mut values: Vec<f64> = SymmetricEigen::new(0.5 * (&standard + standard.transpose()))
        .eigenvalues
        .as_slice()
        .to_vec();
    values.sort_by(f64::total_cmp);
    values
}

#[test]
fn eigenfrequencies_below_the_bound_are_the_full_models_within_a_tenth_per_cent() {
    for (height, length) in [(0.010, 0.015), (0.006, 0.015), (0.010, 0.030)] {
        let mut params = Params::default();
        (params.block.height, params.block.length) = (height, length);
        let (full, reduction) = both(&params);
        let e_over_rho = params.rubber.young_modulus / params.rubber.density;
        let hertz = |lambda: f64| (lambda * e_over_rho).sqrt() / std::f64::consts::TAU;
        let expected: Vec<f64> = dense_eigenvalues(&full)
            .into_iter()
            .map(hertz)
            .take_while(|f| *f <= params.solver.frequency_bound)
            .collect();
        let found = reduction.frequencies(e_over_rho);
        let worst =
            found.iter().zip(&expected).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        println!(
            "h {height} l {length}: {} frequencies to {:.0} Hz, worst {:.4} %",
            expected.len(),
            expected[expected.len() - 1],
            100.0 * worst
        );
        assert!(expected.len() >= 2, "something to compare");
        assert!(worst < 1e-3, "{worst:e}");
    }
}

/// Full motion M ü + βK u̇ + K u = −Γ a(t) as the first-order system of (u, u̇, a, ȧ), SI.
fn first_order_system(full: &FullModel, params: &Params) -> DMatrix<f64> {
    let n = full.dofs();
    let e_over_rho = params.rubber.young_modulus / params.rubber.density;
    let mass = DMatrix::from(&full.mass).cholesky().unwrap();
    let stiffness = mass.solve(&DMatrix::from(&full.stiffness)) * e_over_rho;
    let coupling = mass.solve(&DVector::from_column_slice(&full.rigid_coupling[0]));
    let mut system = DMatrix::zeros(2 * n + 2, 2 * n + 2);
    system.view_mut((0, n), (n, n)).fill_with_identity();
    system.view_mut((n, 0), (n, n)).copy_from(&-&stiffness);
    system.view_mut((n, n), (n, n)).copy_from(&(-params.rubber.stiffness_damping * stiffness));
    system.view_mut((n, 2 * n), (n, 1)).copy_from(&-coupling);
    system[(2 * n, 2 * n + 1)] = 1.0;
    system
}

/// Displacement of a damped mode z̈ + βω²ż + ω²z = 0 that was let go at 1: closed form.
fn let_go(omega: f64, beta: f64, t: f64) -> f64 {
    let decay = 0.5 * beta * omega * omega;
    let square = omega * omega - decay * decay;
    let root = square.abs().sqrt();
    if square > 0.0 {
        (-decay * t).exp() * ((root * t).cos() + decay / root * (root * t).sin())
    } else {
        // Two real rates; the slow one is ω²/(decay + root), free of cancellation.
        let (slow, fast) = (omega * omega / (decay + root), decay + root);
        (fast * (-slow * t).exp() - slow * (-fast * t).exp()) / (fast - slow)
    }
}

#[test]
fn with_all_modes_a_block_let_go_moves_as_the_full_model() {
    let params = Params::default();
    let (full, reduction) = unreduced(Mesh::block(0.015, 0.010, 3, 2));
    let n = full.dofs();
    let mut load = DVector::zeros(n);
    let contact = contact_dofs(&reduction);
    for (dof, f) in contact.iter().zip(random(contact.len())) {
        load[*dof] = f;
    }
    let start = CscCholesky::factor(&full.stiffness).unwrap().solve(&load);
    let step = (first_order_system(&full, &params) * 20e-6).exp();
    let mut state = DVector::zeros(2 * n + 2);
    state.rows_mut(0, n).copy_from(&start);
    let amplitudes = reduction.shapes.transpose() * &load;
    let e_over_rho = params.rubber.young_modulus / params.rubber.density;
    let mut worst: f64 = 0.0;
    for k in 1..=50 {
        state = &step * state;
        let t = 20e-6 * f64::from(k);
        let modal = DVector::from_fn(n, |m, _| {
            let lambda = reduction.lambda[m];
            let omega = (lambda * e_over_rho).sqrt();
            amplitudes[m] / lambda * let_go(omega, params.rubber.stiffness_damping, t)
        });
        let found = &reduction.shapes * modal;
        worst = worst.max((found - state.rows(0, n)).amax() / start.amax());
    }
    println!("free decay over 1 ms, all modes: error {worst:.1e} of the start");
    // Both sides are exact; the exponential of a stiff system loses some digits.
    assert!(worst < 1e-7, "{worst:e}");
}

#[test]
fn with_all_modes_a_shaken_block_moves_as_the_full_model() {
    // Free of the road; the belt gives it a jolt of 0.3 ms (x = c s³, then a straight line).
    let mut params = Params::default();
    params.drive.normal = NormalDrive::Trajectory;
    (params.solver.elements_along, params.solver.elements_up) = (3, 2);
    (params.solver.frequency_bound, params.solver.max_step) = (1e6, 2.5e-7);
    let (full, reduction) = both(&params);
    assert_eq!(reduction.modes(), full.dofs(), "no mode may be missing");
    let n = full.dofs();
    let edge = reduction.dof[2 * reduction.mesh.tread_face()[0]].unwrap();
    let (h, jolt) = (20e-6, 1e8);
    let step = (first_order_system(&full, &params) * h).exp();
    let mut state = DVector::zeros(2 * n + 2);
    state[2 * n + 1] = jolt;
    let mut block = TreadBlock::new(&params).unwrap();
    let z = params.block.height + 0.005;
    block.initialize(0.0, Pose { z, ..Pose::default() }).unwrap();
    let (mut worst, mut peak): (f64, f64) = (0.0, 0.0);
    for k in 0..50 {
        let t = h * f64::from(k);
        if k == 15 {
            // The jolt ends: from here on the belt runs on evenly.
            (state[2 * n], state[2 * n + 1]) = (0.0, 0.0);
        }
        let x = match k {
            0..15 => {
                Cubic([jolt * t.powi(3) / 6.0, 0.5 * jolt * t * t, 0.5 * jolt * t, jolt / 6.0])
            }
            _ => Cubic::line(0.0, 0.5 * jolt * (15.0 * h).powi(2)),
        };
        let segment = Segment { x, ..Segment::still(Pose { z, ..Pose::default() }) };
        block.advance(h, &segment).unwrap();
        state = &step * state;
        let found = block.outputs().run_in_displacement[0];
        worst = worst.max((found - state[edge]).abs());
        peak = peak.max(state[edge].abs());
    }
    println!("shaken block: error {:.1e} of the peak of {peak:.2e} m", worst / peak);
    // Error of the integrator at steps of 0.25 µs, ω = 2π · 2.5 kHz: (ωh)²/12 per radian, some 1e-5.
    assert!(worst < 1e-4 * peak, "{:e}", worst / peak);
}

#[test]
fn a_face_held_to_polynomials_is_stiffer_by_less_than_half_a_per_cent() {
    // Rayleigh: a constraint lowers no eigenfrequency. 0.5 % is what the project allows in a frequency.
    let mut params = Params::default();
    let nodes = both(&params).1.frequencies(1.0);
    params.solver.contact_points = 8;
    let points = both(&params).1.frequencies(1.0);
    for (mode, (free, held)) in nodes.iter().zip(&points).enumerate().take(3) {
        let error = held / free - 1.0;
        assert!((-1e-9..5e-3).contains(&error), "mode {mode}: {error}");
    }
}
