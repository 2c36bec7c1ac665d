//! The reduced equations as numbers, so that other solvers can solve the very same problem.
//!
//! Per mode z̈ + βω²ż + ω²z = Φᵀf − Γ Z̈ and (m + m_c) Z̈ + Γ·z̈ + d Ż = Σ f_z − load (theory eq. 3.1, 3.2);
//! forces per contact node by (2.1) and (2.3) with (2.4). It starts in frictionless equilibrium.

use std::error::Error;
use std::fmt::Write;

use nalgebra::{DMatrix, DVector};
use tread_block::block::Shape;
use tread_block::params::{ContactForm, FrictionForm};
use tread_block::reduction::Reduction;
use tread_block::Params;

/// Everything that benches/peers/rhs.c reads, one section per line: name, then numbers.
pub fn export(length: f64) -> Result<String, Box<dyn Error>> {
    let (params, _) = super::case(length);
    let (friction, contact) = (&params.friction, &params.contact);
    if friction.form != FrictionForm::Exponential || contact.form != ContactForm::Exponential {
        return Err("the peers know the exponential laws only".into());
    }
    let reduction = Shape::of(&params).reduce()?;
    let scaled = Scaled::new(&reduction, &params);
    let load = super::PRESSURE * params.block.length * params.block.width;
    let (z, height) = scaled.at_rest(&params, load)?;
    let rubber = &params.rubber;
    let mut text = String::new();
    let mut line = |name: &str, values: &[f64]| {
        let _ = write!(text, "{name} {}", values.len());
        for x in values {
            let _ = write!(text, " {x:e}");
        }
        text.push('\n');
    };
    line("omega2", &scaled.omega2);
    line("area", &scaled.area);
    line("phi_x", scaled.phi_x.transpose().as_slice());
    line("phi_z", scaled.phi_z.transpose().as_slice());
    line("gamma", &scaled.gamma);
    let mass = rubber.density * params.block.width * params.block.length * params.block.height;
    let carriage = &params.carriage;
    line(
        "body",
        &[
            rubber.stiffness_damping,
            mass + carriage.mass,
            carriage.damping,
            load,
            params.block.height,
        ],
    );
    line("contact", &[contact.reference_pressure, contact.depth]);
    line(
        "friction",
        &[
            friction.mu_inf,
            friction.mu_drop,
            friction.decay_speed,
            friction.decay_exponent,
            friction.smoothing_speed,
            friction.pressure_exponent,
            friction.reference_pressure,
        ],
    );
    line("road", &[super::SPEED, 0.5e-3]);
    line("z", z.as_slice());
    line("height", &[height]);
    Ok(text)
}

/// The reduction in SI units.
struct Scaled {
    omega2: Vec<f64>,
    area: Vec<f64>,
    gamma: Vec<f64>,
    /// Contact displacement per mode: nodes × modes.
    phi_x: DMatrix<f64>,
    phi_z: DMatrix<f64>,
}

impl Scaled {
    fn new(reduction: &Reduction, params: &Params) -> Self {
        let (nodes, modes) = (reduction.contact_nodes(), reduction.modes());
        let scale = (params.rubber.density * params.block.width).sqrt();
        let e_over_rho = params.rubber.young_modulus / params.rubber.density;
        let phi = &reduction.contact_modes;
        Self {
            omega2: reduction.lambda.iter().map(|l| l * e_over_rho).collect(),
            area: reduction.interface.weights.iter().map(|w| w * params.block.width).collect(),
            gamma: reduction.coupling[1].iter().map(|g| g * scale).collect(),
            phi_x: DMatrix::from_fn(nodes, modes, |i, m| phi[(i, m)] / scale),
            phi_z: DMatrix::from_fn(nodes, modes, |i, m| phi[(nodes + i, m)] / scale),
        }
    }

    /// Modal amplitudes and height of the clamped face under `load` without friction, by Newton's
    /// method on the compressions c = −(Z − h) − G f(c), Σ f = load.
    fn at_rest(&self, params: &Params, load: f64) -> Result<(DVector<f64>, f64), Box<dyn Error>> {
        let (nodes, modes) = self.phi_z.shape();
        let soft = DMatrix::from_fn(modes, nodes, |m, i| self.phi_z[(i, m)] / self.omega2[m]);
        let flexibility = &self.phi_z * &soft;
        let law = &params.contact;
        let mean = load / self.area.iter().sum::<f64>();
        let mut c =
            DVector::from_element(nodes, law.depth * (mean / law.reference_pressure).ln_1p());
        let mut height = params.block.height - c[0];
        for _ in 0..200 {
            let force =
                |c: f64, area: f64| law.reference_pressure * (c / law.depth).exp_m1() * area;
            let f = DVector::from_fn(nodes, |i, _| force(c[i], self.area[i]));
            let slope = |i: usize| (f[i] + law.reference_pressure * self.area[i]) / law.depth;
            let gap = params.block.height - height;
            let mut residual = DVector::from_element(nodes + 1, load - f.sum());
            let touch = -c.add_scalar(-gap) - &flexibility * &f;
            residual.rows_mut(0, nodes).copy_from(&touch);
            let jacobian =
                DMatrix::from_fn(nodes + 1, nodes + 1, |r, k| match (r < nodes, k < nodes) {
                    (true, true) => f64::from(u8::from(r == k)) + flexibility[(r, k)] * slope(k),
                    (true, false) => 1.0,
                    (false, true) => slope(k),
                    (false, false) => 0.0,
                });
            let change = jacobian.lu().solve(&residual).ok_or("the equilibrium is singular")?;
            // A step of more than half a depth would overshoot the exponential.
            let damping = (0.5 * law.depth / change.rows(0, nodes).amax()).min(1.0);
            c += damping * change.rows(0, nodes);
            height += damping * change[nodes];
            if damping == 1.0 && change.amax() < 1e-15 {
                return Ok((soft * f, height));
            }
        }
        Err("the equilibrium was not found".into())
    }
}
