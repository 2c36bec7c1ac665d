//! The unreduced finite elements, explicit: what the reduction and the implicit friction save.
//!
//! Central differences with half-step velocities, row-summed mass by Hinton's rule (Earthquake Eng. Struct.
//! Dyn. 4, 1976), damping βK at the last half step. The stable step is found from the largest eigenvalue
//! by power iteration: with damping βω² the limit is h < 2(√(1 + ζ²) − ζ)/ω, ζ = βω/2 (Belytschko et al.,
//! Nonlinear Finite Elements, eq. 6.2.27).

use std::error::Error;

use nalgebra_sparse::{CscMatrix, CsrMatrix};
use tread_block::block::Shape;
use tread_block::contact::friction::{FrictionLaw, Law};
use tread_block::contact::normal;
use tread_block::fe;
use tread_block::mesh::Mesh;

/// Share of the stable step that is used.
const SAFETY: f64 = 0.9;

/// Runs `duration` [s] and prints seconds, steps and mean friction as JSON.
pub fn run(length: f64, duration: f64) -> Result<(), Box<dyn Error>> {
    let (params, _) = super::case(length);
    let (along, up) = Shape::of(&params).elements;
    let mesh = Mesh::block(params.block.length, params.block.height, along, up);
    let full = fe::assemble(&mesh, params.rubber.poisson_ratio, params.rubber.plane);
    let (width, rubber) = (params.block.width, &params.rubber);
    let stiffness = CsrMatrix::from(&full.stiffness);
    let inertia: Vec<f64> = lumped(&full.mass).iter().map(|m| m * rubber.density * width).collect();
    let scale = rubber.young_modulus * width;
    let omega2 = largest_eigenvalue(&stiffness, &inertia, scale);
    let omega = omega2.sqrt();
    let zeta = 0.5 * rubber.stiffness_damping * omega;
    let h = SAFETY * 2.0 * ((1.0 + zeta * zeta).sqrt() - zeta) / omega;

    let face: Vec<[usize; 2]> = mesh
        .tread_face()
        .iter()
        .filter_map(|node| Some([full.dof[2 * node]?, full.dof[2 * node + 1]?]))
        .collect();
    let area: Vec<f64> = mesh.tread_face_weights().iter().map(|w| w * width).collect();
    let law = Law::new(&params.friction, None);
    let load = super::PRESSURE * params.block.length * width;
    let carriage = &params.carriage;
    let mut height = params.block.height - normal::compression(&params.contact, super::PRESSURE);
    let mut lift = 0.0;
    let (mut u, mut v) = (vec![0.0; inertia.len()], vec![0.0; inertia.len()]);
    // Elastic and damping forces are one product: K (u + β v).
    let mut mixed = vec![0.0; u.len()];
    let (mut time, mut steps) = (0.0, 0_u64);
    let (mut friction, mut samples) = (0.0, 0_u64);
    let start = super::busy();
    while time < duration {
        for ((m, u), v) in mixed.iter_mut().zip(&u).zip(&v) {
            *m = u + rubber.stiffness_damping * v;
        }
        let mut force = product(&stiffness, &mixed, -scale);
        let road = super::SPEED * (time / 0.5e-3).min(1.0);
        // The clamped face carries the block: its nodes move with the carriage.
        let (mut lifting, mut dragging) = (0.0, 0.0);
        for (i, [x, z]) in face.iter().enumerate() {
            let compression = -(height - params.block.height + u[*z]);
            let (pressure, _) = normal::pressure(&params.contact, compression);
            let [mu, ..] = law.at(pressure, v[*x] - road);
            force[*z] += pressure * area[i];
            force[*x] -= mu * pressure * area[i];
            lifting += pressure * area[i];
            dragging += mu * pressure * area[i];
        }
        // Coordinates relative to the clamped face; the block's share of the carriage's inertia is
        // below 0.2 % and left out of this peer.
        lift += h * (lifting - load - carriage.damping * lift) / carriage.mass;
        height += h * lift;
        for (((u, v), f), m) in u.iter_mut().zip(&mut v).zip(&force).zip(&inertia) {
            *v += h * f / m;
            *u += h * *v;
        }
        time += h;
        steps += 1;
        if time > 0.5 * duration && lifting > 0.0 {
            friction -= dragging / lifting;
            samples += 1;
        }
    }
    let seconds = super::busy() - start;
    println!(
        "{{\"seconds\": [{seconds}], \"duration\": {time}, \"dofs\": {}, \"step\": {h}, \"steps\": {steps}, \
         \"friction\": {}}}",
        u.len(),
        friction / samples.max(1) as f64
    );
    Ok(())
}

/// Diagonal mass: each diagonal term, scaled so that their sum is the whole mass.
fn lumped(mass: &CscMatrix<f64>) -> Vec<f64> {
    let mut diagonal = vec![0.0; mass.nrows()];
    let mut total = 0.0;
    for (row, column, value) in mass.triplet_iter() {
        total += value;
        if row == column {
            diagonal[row] = *value;
        }
    }
    let sum: f64 = diagonal.iter().sum();
    diagonal.iter().map(|d| d * total / sum).collect()
}

fn largest_eigenvalue(stiffness: &CsrMatrix<f64>, inertia: &[f64], scale: f64) -> f64 {
    let mut x: Vec<f64> = (0..inertia.len()).map(|i| ((i * 7919) % 101) as f64 - 50.0).collect();
    let mut value = 0.0;
    for _ in 0..300 {
        let y = product(stiffness, &x, scale);
        let y: Vec<f64> = y.iter().zip(inertia).map(|(y, m)| y / m).collect();
        value = y.iter().fold(0.0, |most: f64, y| most.max(y.abs()));
        x = y.iter().map(|y| y / value).collect();
    }
    value
}

/// `scale · matrix · x`.
fn product(matrix: &CsrMatrix<f64>, x: &[f64], scale: f64) -> Vec<f64> {
    let (offsets, columns, values) = matrix.csr_data();
    (0..matrix.nrows())
        .map(|row| {
            let range = offsets[row]..offsets[row + 1];
            let sum: f64 =
                columns[range.clone()].iter().zip(&values[range]).map(|(c, a)| a * x[*c]).sum();
            scale * sum
        })
        .collect()
}
