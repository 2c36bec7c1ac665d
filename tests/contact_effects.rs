//! Contact laws of the effects on the tread face: derivatives, signs, closed forms.

use tread_block::contact::friction::Law;
use tread_block::contact::{Face, Placed, Traction};
use tread_block::pack::Aligned;
use tread_block::params::{Contact, Friction};

/// One node of 1 mm² with the default laws; full contact from 5 kPa.
fn face() -> Face {
    let law = Law::new(&Friction::default(), None);
    Face { adhesion_pressure: 5e3, ..Face::new(&[1e-6], &[0.0], law, &Contact::default(), 0.01) }
}

/// The base face and one per contact effect.
fn faces() -> Vec<Face> {
    vec![
        face(),
        Face { shear_strength: 5e4, ..face() },
        Face { pull_off: 2e4, adhesion_pressure: 8e4, ..face() },
        Face { damping: 3.0, ..face() },
        Face { viscosity: 5e5, ..face() },
    ]
}

/// Coefficient of the stage [s]: compression falls by A times the speed away from the road.
const A: f64 = 3e-6;

fn evaluate(face: &Face, rest: f64, slip: f64, lift: f64) -> Traction {
    let mut out = Traction::new(1);
    let node = |value: f64, padding: f64| Aligned::padded(&[value], face.area.len(), padding);
    let placed = Placed {
        compression: node(rest - A * lift, -1.0),
        slip: node(slip, 0.0),
        lift: node(lift, 0.0),
    };
    face.evaluate(A, &placed, &node(0.9, 1.0), &mut out);
    out
}

#[test]
fn slopes_are_the_derivatives_that_finite_differences_find() {
    // Central differences of 1e-6 m/s; the laws bend over 1e-2 m/s and more, so that truncation is
    // below 1e-8 and rounding below 1e-6 of the slopes' scale.
    let h = 1e-6;
    for face in faces() {
        for (rest, slip, lift) in [(6e-5, 0.02, 0.01), (2e-5, -0.3, -0.05), (4e-6, 0.005, 0.02)] {
            let here = evaluate(&face, rest, slip, lift);
            let by_slip = |get: fn(&Traction) -> f64| {
                let ahead = get(&evaluate(&face, rest, slip + h, lift));
                (ahead - get(&evaluate(&face, rest, slip - h, lift))) / (2.0 * h)
            };
            let by_lift = |get: fn(&Traction) -> f64| {
                let ahead = get(&evaluate(&face, rest, slip, lift + h));
                (ahead - get(&evaluate(&face, rest, slip, lift - h))) / (2.0 * h)
            };
            let pairs = [
                (-by_slip(|t| t.tangential[0]), here.slip_slope[0]),
                (-by_lift(|t| t.tangential[0]), here.coupling[0]),
                (-by_lift(|t| t.normal[0]), here.approach_slope[0]),
            ];
            for (found, told) in pairs {
                let scale = told.abs() + 1e-3;
                assert!((found - told).abs() < 1e-5 * scale, "{face:?}: {found} {told}");
            }
        }
    }
}

#[test]
fn adhesion_opposes_sliding_and_leaves_an_open_gap_alone() {
    let sticky = Face { shear_strength: 5e4, ..face() };
    // Full contact far above the smoothing speed: τ_a A (2/π) atan(30) = 0.0489 N beside friction.
    let added = evaluate(&sticky, 6e-5, 0.3, 0.0).tangential[0]
        - evaluate(&face(), 6e-5, 0.3, 0.0).tangential[0];
    assert!((added + 5e-2 * std::f64::consts::FRAC_2_PI * 30.0_f64.atan()).abs() < 1e-8, "{added}");
    assert_eq!(evaluate(&sticky, -1e-6, 0.3, 0.0).tangential[0], 0.0);
}

#[test]
fn contact_damping_resists_approach_and_never_pulls() {
    for face in faces().iter().skip(3) {
        let normal = |lift: f64| evaluate(face, 6e-5, 0.0, lift).normal[0];
        assert!(normal(-0.02) > normal(0.0) && normal(0.0) > normal(0.02));
        assert_eq!(normal(100.0), 0.0);
    }
}

#[test]
fn stress_at_rest_is_the_stress_of_a_slow_contact() {
    for face in faces() {
        let normal = evaluate(&face, 5e-5, 0.0, 0.0).normal[0];
        assert!((face.stress_at_rest(5e-5).0 * 1e-6 / normal - 1.0).abs() < 1e-12, "{face:?}");
    }
}
