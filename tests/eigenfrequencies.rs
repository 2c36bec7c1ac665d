//! Free eigenfrequencies of the clamped block against the first column of the paper's Table 1.
//!
//! Plane stress, ν = 0.49, and one E/ρ = 50 N/mm² over 1100 kg/m³ for all blocks: the compound of
//! tests/data/verification. Modulus and density are not separable, so this ratio is the one thing fitted.

use tread_block::block::Shape;
use tread_block::Params;

/// E/ρ [m²/s²].
const E_OVER_RHO: f64 = 50e6 / 1100.0;
/// Height, length [m] and first eigenfrequency [Hz] of the three legible cells.
const CELLS: [(f64, f64, f64); 3] =
    [(0.006, 0.015, 4590.0), (0.010, 0.045, 2876.0), (0.006, 0.045, 4919.0)];

fn params(height: f64, length: f64) -> Params {
    let mut params = Params::default();
    (params.block.height, params.block.length) = (height, length);
    params
}

/// First eigenfrequency [Hz] on the mesh that the parameters choose, times `refinement`.
fn first_frequency(height: f64, length: f64, refinement: usize) -> f64 {
    let mut params = params(height, length);
    let (along, up) = Shape::of(&params).elements;
    params.solver.elements_along = along * refinement;
    params.solver.elements_up = up * refinement;
    Shape::of(&params).reduce().unwrap().frequencies(E_OVER_RHO)[0]
}

fn cells_are_met(refinement: usize) {
    let mut wrong = Vec::new();
    for (height, length, expected) in CELLS {
        let found = first_frequency(height, length, refinement);
        let error = found / expected - 1.0;
        println!(
            "h {} l {} mm, mesh × {refinement}: {found:.1} Hz for {expected} Hz, {:+.3} %",
            1e3 * height,
            1e3 * length,
            100.0 * error
        );
        if error.abs() > 0.005 {
            wrong.push(format!("h {height} l {length}: {found} Hz for {expected} Hz"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_default_compound_has_this_ratio_of_modulus_to_density() {
    let rubber = Params::default().rubber;
    assert_eq!(rubber.young_modulus / rubber.density, E_OVER_RHO);
    assert_eq!(rubber.poisson_ratio, 0.49);
}

#[test]
fn the_default_mesh_gives_the_three_legible_cells_within_half_a_per_cent() {
    cells_are_met(1);
}

#[test]
fn a_mesh_twice_as_fine_gives_them_too() {
    cells_are_met(2);
}

#[test]
fn the_lost_cell_is_predicted_near_2500_hertz() {
    // Height 10, length 15 mm: the digits are lost. The design notes expect 2541 Hz from the scaling of
    // the other cells; the project asks for "near 2.5 kHz", taken as 2450 to 2610 Hz.
    let found = first_frequency(0.010, 0.015, 1);
    println!("h 10 l 15 mm: {found:.1} Hz");
    assert!((2450.0..2610.0).contains(&found), "{found} Hz");
}

#[test]
fn the_default_mesh_is_within_a_quarter_per_cent_of_one_three_times_as_fine() {
    // Displacement elements are too stiff: the frequency falls as the mesh is refined.
    for (height, length) in [(0.006, 0.015), (0.010, 0.045), (0.006, 0.045), (0.010, 0.015)] {
        let (coarse, fine) =
            (first_frequency(height, length, 1), first_frequency(height, length, 3));
        println!("h {height} l {length}: {coarse:.2} Hz, fine {fine:.2} Hz");
        assert!(coarse >= fine && coarse < 1.0025 * fine, "h {height} l {length}");
    }
}
