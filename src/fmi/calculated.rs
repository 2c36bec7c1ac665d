//! Calculated parameters: what follows from the parameters and is worth knowing before a run.

use crate::params::Params;

/// A number that follows from the parameters.
#[derive(Clone, Copy, Debug)]
pub struct Calculated {
    /// Dotted name.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Typical size \[unit\].
    pub nominal: f64,
    /// What it is, with its equation.
    pub doc: &'static str,
    /// The parameters it depends on.
    pub depends: &'static [&'static str],
    /// The number.
    pub get: fn(&Params) -> f64,
}

/// All calculated parameters.
pub const CALCULATED: &[Calculated] = &[
    Calculated {
        name: "block.mass",
        unit: "kg",
        nominal: 1e-3,
        doc: "Mass of the block: density times length, height and width",
        depends: &["block.length", "block.height", "block.width", "rubber.density"],
        get: |p| p.rubber.density * p.block.length * p.block.height * p.block.width,
    },
    Calculated {
        name: "block.contact_area",
        unit: "m2",
        nominal: 1e-4,
        doc: "Area of the tread face: length times width",
        depends: &["block.length", "block.width"],
        get: |p| p.block.length * p.block.width,
    },
    Calculated {
        name: "rubber.shear_modulus",
        unit: "Pa",
        nominal: 1e7,
        doc: "Shear modulus E / (2 (1 + nu)) of the rubber",
        depends: &["rubber.young_modulus", "rubber.poisson_ratio"],
        get: |p| p.rubber.young_modulus / (2.0 * (1.0 + p.rubber.poisson_ratio)),
    },
];
