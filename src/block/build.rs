//! Parameters → mesh → reduction → linear part, contact face and solver settings.

use std::path::Path;

use crate::contact::friction::Law;
use crate::contact::friction_table::Table;
use crate::contact::Face;
use crate::dynamics::{Integrator, Linear, Settings};
use crate::error::{Fault, Problem};
use crate::mesh::Mesh;
use crate::params::check::elements_for;
use crate::params::{FrictionForm, Params, Plane};
use crate::reduction::Reduction;

/// Elements along the face of a block of [`REFERENCE_LENGTH`], unless given; of others as the cube
/// root of their length, since the edges need the resolution. Measured against the independent
/// solutions: see the convergence table in the book.
const ELEMENTS_ALONG: f64 = 10.0;
/// Length that [`ELEMENTS_ALONG`] holds for \[m\].
const REFERENCE_LENGTH: f64 = 15e-3;
/// Height of an element \[m\], unless given.
const ELEMENT_HEIGHT: f64 = 1.5e-3;

/// What the reduction depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Length of the block \[m\].
    pub length: f64,
    /// Height of the block \[m\].
    pub height: f64,
    /// Elements along the face and up.
    pub elements: (usize, usize),
    /// Contact points, `None` for the nodes of the mesh.
    pub points: Option<usize>,
    /// Poisson's ratio \[-\].
    pub poisson_ratio: f64,
    /// Plane stress or strain.
    pub plane: Plane,
    /// Fixed-interface modes up to this ω²ρ/E \[1/m²\].
    pub bound: f64,
}

impl Shape {
    /// The shape that the parameters describe.
    pub fn of(params: &Params) -> Self {
        let (block, rubber, solver) = (&params.block, &params.rubber, &params.solver);
        let count = |given: usize, wanted: f64, least: usize| match given {
            0 => (wanted.round() as usize).max(least),
            given => given,
        };
        let points = Some(solver.contact_points).filter(|points| *points > 0);
        let along = (ELEMENTS_ALONG * (block.length / REFERENCE_LENGTH).cbrt())
            .max(elements_for(solver.contact_points) as f64);
        let omega = std::f64::consts::TAU * solver.frequency_bound;
        Self {
            length: block.length,
            height: block.height,
            elements: (
                count(solver.elements_along, along, 4),
                count(solver.elements_up, block.height / ELEMENT_HEIGHT, 3),
            ),
            points,
            poisson_ratio: rubber.poisson_ratio,
            plane: rubber.plane,
            bound: omega * omega * rubber.density / rubber.young_modulus,
        }
    }

    /// Meshes and reduces.
    ///
    /// # Errors
    /// [`Fault::NotFinite`] if the mesh is degenerate.
    pub fn reduce(&self) -> Result<Reduction, Fault> {
        let (along, up) = self.elements;
        let mesh = Mesh::block(self.length, self.height, along, up);
        Reduction::of_block(mesh, self.points, self.poisson_ratio, self.plane, self.bound)
    }
}

/// The linear part.
pub(super) fn linear(reduction: &Reduction, params: &Params) -> Linear {
    Linear::new(reduction, params)
}

/// The tread face and its laws.
///
/// # Errors
/// [`Fault::File`] and [`Fault::Invalid`] for a friction table that cannot be read.
pub(super) fn face(reduction: &Reduction, params: &Params) -> Result<Face, Fault> {
    let table = match params.friction.form {
        FrictionForm::Table => Some(read_table(&params.friction.table_file)?),
        _ => None,
    };
    let area: Vec<f64> =
        reduction.interface.weights.iter().map(|w| w * params.block.width).collect();
    let law = Law::new(&params.friction, table.as_ref());
    let (adhesion, effect) = (&params.effect.adhesion, &params.effect);
    let (damping, viscosity) = effect.contact_damping.coefficients();
    let smoothing_speed = params.friction.smoothing_speed;
    Ok(Face {
        shear_strength: if adhesion.enabled { adhesion.shear_strength } else { 0.0 },
        pull_off: if adhesion.enabled { adhesion.pull_off } else { 0.0 },
        adhesion_pressure: adhesion.saturation(),
        damping,
        viscosity,
        road: effect.road_texture.texture(),
        ..Face::new(&area, &profile(reduction, params), law, &params.contact, smoothing_speed)
    })
}

/// How far each contact node lies behind the plane of the road when the face just touches \[m\].
fn profile(reduction: &Reduction, params: &Params) -> Vec<f64> {
    let x = &reduction.interface.x;
    let (tilt, edge) = (&params.effect.misalignment, &params.effect.worn_edge);
    x.iter().map(|at| tilt.gap(*at) + edge.depth(at - x[0])).collect()
}

/// The integrator.
pub(super) fn integrator(linear: &Linear, params: &Params) -> Integrator {
    let solver = &params.solver;
    let settings = Settings {
        tolerance: solver.tolerance,
        max_step: solver.max_step,
        min_step: solver.min_step,
    };
    Integrator::new(linear, settings, params.friction.reference_pressure)
}

/// Reads a measured characteristic: CSV with the columns pressure_pa, speed_m_s, mu.
fn read_table(path: &str) -> Result<Table, Fault> {
    let named = format!("friction.table_file {path:?}");
    let text = std::fs::read_to_string(path).map_err(|e| Fault::file(Path::new(&named), &e))?;
    let mut points = Vec::new();
    let mut problems = Vec::new();
    for (number, line) in text.lines().enumerate().skip(1) {
        let numbers: Vec<f64> = line.split(',').filter_map(|n| n.trim().parse().ok()).collect();
        match numbers[..] {
            [p, v, mu] => points.push((p, v, mu)),
            [] if line.trim().is_empty() => {}
            _ => problems.push(Problem::new(
                format!("{path} line {}", number + 1),
                line,
                "three numbers: pressure_pa, speed_m_s, mu",
                "mend or delete the line",
            )),
        }
    }
    if !problems.is_empty() {
        return Err(Fault::Invalid(problems));
    }
    Table::from_points(&points)
}
