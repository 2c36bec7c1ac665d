//! Linear elasticity in the plane.

use crate::params::Plane;
use nalgebra::Matrix3;

/// Elasticity matrix \[-\] for unit Young's modulus; strains ε_xx, ε_zz, γ_xz.
///
/// Plane strain is plane stress with E/(1 − ν²) and ν/(1 − ν) (theory eq. 1.2).
pub fn elasticity(poisson_ratio: f64, plane: Plane) -> Matrix3<f64> {
    let nu = poisson_ratio;
    let (e, nu) = match plane {
        Plane::Stress => (1.0, nu),
        Plane::Strain => (1.0 / (1.0 - nu * nu), nu / (1.0 - nu)),
    };
    let c = e / (1.0 - nu * nu);
    Matrix3::new(c, c * nu, 0.0, c * nu, c, 0.0, 0.0, 0.0, c * (1.0 - nu) / 2.0)
}
