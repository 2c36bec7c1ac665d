//! The candidate effects in the whole block: off is off, states are complete, and each effect does
//! what its physics says.

use std::sync::{Arc, OnceLock};
use tread_block::block::{Outputs, Shape};
use tread_block::effects::{fit_specs, FitSpec};
use tread_block::reduction::Reduction;
use tread_block::scenario::{self, Inputs, Plan, Scenario, Slide};
use tread_block::{Params, TreadBlock};

/// Load of 250 kPa on the default block's 15 mm × 15 mm [N].
const LOAD: f64 = 56.25;
/// Sampling of the test runs [s].
const STEP: f64 = 40e-6;

/// The default block's reduction, made once.
fn reduction() -> Arc<Reduction> {
    static ONCE: OnceLock<Arc<Reduction>> = OnceLock::new();
    ONCE.get_or_init(|| Arc::new(Shape::of(&Params::default()).reduce().unwrap())).clone()
}

fn block(params: &Params) -> TreadBlock {
    TreadBlock::with_reduction(params, reduction()).unwrap()
}

fn spec(effect: &str) -> &'static FitSpec {
    fit_specs().iter().find(|s| s.effect == effect).unwrap()
}

/// Parameters with `effect` in its form number `form` at its prior, but for the `first` parameter.
fn with(effect: &str, form: usize, first: Option<f64>) -> Params {
    let mut params = Params::default();
    let mut values: Vec<f64> = spec(effect).forms[form].params.iter().map(|p| p.centre).collect();
    if let Some(first) = first {
        values[0] = first;
    }
    assert!(spec(effect).apply(form, &values, &mut params));
    params
}

fn run(block: &mut TreadBlock, slide: &Slide, duration: f64) -> Vec<Outputs> {
    let scenario = Scenario::Slide(slide.clone());
    let mut rows = Vec::new();
    tread_block::scenario::simulate(block, &scenario, STEP, duration, |_, o| rows.push(o.clone()))
        .unwrap();
    rows
}

fn slid(params: &Params, speed: f64, load: f64, duration: f64) -> Vec<Outputs> {
    run(&mut block(params), &Slide::constant(speed, load), duration)
}

/// Mean of what `get` says over the second half of the rows.
fn mean(rows: &[Outputs], get: fn(&Outputs) -> f64) -> f64 {
    let settled = &rows[rows.len() / 2..];
    settled.iter().map(get).sum::<f64>() / settled.len() as f64
}

/// Standard deviation of the same.
fn deviation(rows: &[Outputs], get: fn(&Outputs) -> f64) -> f64 {
    let settled = &rows[rows.len() / 2..];
    let middle = mean(rows, get);
    let square = settled.iter().map(|o| (get(o) - middle).powi(2)).sum::<f64>();
    (square / settled.len() as f64).sqrt()
}

fn friction(rows: &[Outputs]) -> f64 {
    mean(rows, |o| o.contact_force[0]) / mean(rows, |o| o.contact_force[1])
}

fn bits(rows: &[Outputs]) -> Vec<u64> {
    let numbers = |o: &Outputs| {
        tread_block::block::OUTPUTS
            .iter()
            .flat_map(|spec| (0..spec.size).map(|i| (spec.get)(o, i).to_bits()).collect::<Vec<_>>())
            .collect::<Vec<_>>()
    };
    rows.iter().flat_map(numbers).collect()
}

#[test]
fn severity_zero_is_the_base_model_bit_for_bit() {
    let base = bits(&slid(&Params::default(), 0.3, LOAD, 2e-3));
    for spec in fit_specs() {
        for form in 0..spec.forms.len() {
            let off = slid(&with(spec.effect, form, Some(0.0)), 0.3, LOAD, 2e-3);
            assert!(bits(&off) == base, "{} {}", spec.effect, spec.forms[form].name);
        }
    }
}

#[test]
fn every_effect_at_its_prior_changes_the_motion() {
    // The prior of the signed angle is centred at 0; 4 mrad is within its spread.
    let base = bits(&slid(&Params::default(), 0.3, LOAD, 2e-3));
    for spec in fit_specs() {
        for form in 0..spec.forms.len() {
            let first = (spec.effect == "misalignment").then_some(4e-3);
            let on = slid(&with(spec.effect, form, first), 0.3, LOAD, 2e-3);
            assert!(bits(&on) != base, "{} {}", spec.effect, spec.forms[form].name);
            assert!(on.iter().all(|o| o.contact_force[0].is_finite()));
        }
    }
}

#[test]
fn a_restored_block_goes_on_with_the_same_bits() {
    use tread_block::drive::{Cubic, Segment};
    for spec in fit_specs() {
        for form in 0..spec.forms.len() {
            let mut block = block(&with(spec.effect, form, None));
            run(&mut block, &Slide::constant(0.3, LOAD), 1e-3);
            let mut saved = Vec::new();
            block.save(&mut saved);
            let mut on = || {
                let mut rows = Vec::new();
                for k in 0..10 {
                    let x = -0.225e-3 - 0.3 * STEP * f64::from(k);
                    let segment = Segment {
                        x: Cubic::line(x, -0.3),
                        load: Cubic::constant(LOAD),
                        ..Segment::default()
                    };
                    block.advance(STEP, &segment).unwrap();
                    rows.push(block.outputs().clone());
                }
                let first = bits(&rows);
                assert!(block.restore(&saved));
                first
            };
            assert!(on() == on(), "{} {}", spec.effect, spec.forms[form].name);
        }
    }
}

#[test]
fn heat_lowers_friction_the_more_the_faster() {
    // μ falls with temperature and friction power grows with speed, so the loss of mean friction
    // over the base model is larger at 600 than at 300 mm/s.
    for form in 0..2 {
        let loss = |v: f64| {
            let warm = friction(&slid(&with("thermal_friction", form, None), v, LOAD, 8e-3));
            1.0 - warm / friction(&slid(&Params::default(), v, LOAD, 8e-3))
        };
        let (slow, fast) = (loss(0.3), loss(0.6));
        assert!(slow > 0.02 && fast > slow, "form {form}: {slow} {fast}");
    }
}

#[test]
fn rest_raises_the_breakaway_peak() {
    // ln(20 ms/0.1 ms) = 5.3 e-folds more of age at b = 0.08: up to 0.4 of friction before slip.
    let params = with("friction_ageing", 0, Some(0.08));
    let peak = |rest: f64| {
        let mut block = block(&Params {
            effect: {
                let mut effect = params.effect.clone();
                effect.friction_ageing.initial_age = rest;
                effect
            },
            ..params.clone()
        });
        let rows = run(&mut block, &Slide::constant(0.15, LOAD), 3e-3);
        rows.iter().map(|o| o.contact_force[0].abs()).fold(0.0, f64::max)
    };
    let (fresh, old) = (peak(0.0), peak(20e-3));
    assert!(old > 1.03 * fresh && old < 1.6 * fresh, "{fresh} {old}");
}

#[test]
fn adhesion_adds_its_strength_times_the_area() {
    // Full contact: τ_a A beside friction. 50 kPa × 225 mm² = 11.25 N, whatever the load; sticking
    // and lift-off leave some of it out.
    let added = |load: f64| {
        let force = |p: &Params| mean(&slid(p, 0.6, load, 8e-3), |o| o.contact_force[0]);
        force(&with("adhesion", 0, None)).abs() - force(&Params::default()).abs()
    };
    for load in [LOAD, 2.0 * LOAD] {
        let share = added(load) / 11.25;
        assert!((0.7..1.1).contains(&share), "{load} N: {share}");
    }
}

#[test]
fn maxwell_branches_stiffen_vibration_and_not_rest() {
    // At rest E holds: same height. In vibration (1 + g)E at most: frequency up to √1.5 higher.
    let stiff = with("viscoelastic_modulus", 0, None);
    let (base, on) = (block(&Params::default()), block(&stiff));
    assert_eq!(base.outputs().carriage_z.to_bits(), on.outputs().carriage_z.to_bits());
    let edge = |p: &Params| mean(&slid(p, 0.3, LOAD, 8e-3), |o| o.run_in_displacement[0].abs());
    let ratio = edge(&stiff) / edge(&Params::default());
    assert!((1.0 / 1.5..1.1).contains(&ratio), "mean deflection {ratio}");
}

#[test]
fn softening_deflects_the_block_further() {
    // G₀/G_∞ = 2: the mean deflection per mean force grows by up to 2; inertia has no mean.
    let compliance = |p: &Params| {
        let slid = slid(p, 0.3, LOAD, 8e-3);
        mean(&slid, |o| o.run_in_displacement[0]) / mean(&slid, |o| o.contact_force[0])
    };
    for form in 0..2 {
        let ratio =
            compliance(&with("payne_softening", form, None)) / compliance(&Params::default());
        assert!((1.05..2.0).contains(&ratio), "form {form}: {ratio}");
    }
}

#[test]
fn a_compliant_rig_gives_way_by_force_times_compliance() {
    // Mean of m ξ̈ + c ξ̇ + k ξ = F over many periods: ξ = C F. The rest of the start dies out slowly;
    // 10 % covers it.
    let params = with("rig_compliance", 0, None);
    let rows = slid(&params, 0.6, LOAD, 16e-3);
    let expected = params.effect.rig_compliance.compliance * mean(&rows, |o| o.contact_force[0]);
    let deflection = mean(&rows, |o| o.deflection);
    assert!((deflection / expected - 1.0).abs() < 0.1, "{deflection} {expected}");
}

#[test]
fn a_stiff_rig_is_the_base_model() {
    // C → 0: at 1e-12 m/N and 100 kHz the deflection is 1e-12 × 40 N, beside 100 um of the block.
    let mut params = with("rig_compliance", 0, Some(1e-12));
    params.effect.rig_compliance.frequency = 1e5;
    let (base, stiff) = (slid(&Params::default(), 0.3, LOAD, 3e-3), slid(&params, 0.3, LOAD, 3e-3));
    let scale = base.iter().map(|o| o.contact_force[0].abs()).fold(0.0, f64::max);
    for (a, b) in base.iter().zip(&stiff) {
        // Step control differs a little: 1 % of the largest force.
        assert!((a.contact_force[0] - b.contact_force[0]).abs() < 0.01 * scale);
    }
}

#[test]
fn a_tilt_moves_the_pressure_to_the_closed_edge() {
    // Positive angle opens the run-in edge: at rest the run-out pressure is the larger, and turning
    // the angle mirrors the block (symmetry: to the solver's 1e-9).
    let pressure = |angle: f64| block_at_rest(&with("misalignment", 0, Some(angle))).pressure;
    let (plus, minus) = (pressure(2e-3), pressure(-2e-3));
    assert!(plus[20] > 1.2 * plus[0], "{plus:?}");
    for k in 0..21 {
        assert!((plus[k] - minus[20 - k]).abs() < 1e-6 * plus[20], "station {k}");
    }
}

#[test]
fn a_worn_edge_unloads_the_run_in_edge() {
    // 100 um behind the face against about 60 um of contact compression and some of the rubber: the
    // edge carries less than half of the mean pressure.
    for form in 0..2 {
        let pressure = block_at_rest(&with("worn_edge", form, None)).pressure;
        assert!(pressure[0] < 125e3 && pressure[20] > 200e3, "form {form}: {pressure:?}");
    }
}

#[test]
fn texture_modulates_the_normal_force_at_speed_over_wavelength() {
    // v/λ = 0.6/2 mm = 300 Hz: the normal force correlates with that frequency more than the base
    // model's does. Frictionless, so that nothing else vibrates.
    let smooth = |mut params: Params| {
        params.friction.mu_inf = 0.0;
        params.friction.mu_drop = 0.0;
        params
    };
    let level = |params: Params| {
        let rows = slid(&smooth(params), 0.6, LOAD, 20e-3);
        let (mut c, mut s) = (0.0, 0.0);
        for (k, row) in rows.iter().enumerate().skip(251) {
            let phase = std::f64::consts::TAU * 300.0 * k as f64 * STEP;
            c += row.contact_force[1] * phase.cos();
            s += row.contact_force[1] * phase.sin();
        }
        2.0 * c.hypot(s) / 250.0
    };
    let (base, rough) = (level(Params::default()), level(with("road_texture", 0, None)));
    assert!(base < 0.05 && rough > 0.2, "{base} {rough}");
}

#[test]
fn a_slow_sensor_keeps_the_mean_and_loses_the_vibration() {
    // DC gain 1; at 1 kHz and more a 60 um low-pass (2.7 kHz) loses at least 6 %.
    let (base, on) = (
        slid(&Params::default(), 0.3, LOAD, 12e-3),
        slid(&with("sensor_dynamics", 0, None), 0.3, LOAD, 12e-3),
    );
    let force = |o: &Outputs| o.contact_force[0];
    assert!((mean(&on, force) / mean(&base, force) - 1.0).abs() < 0.01);
    assert!(deviation(&on, force) < 0.94 * deviation(&base, force));
}

fn block_at_rest(params: &Params) -> Outputs {
    let mut block = block(params);
    block.initialize(0.0, tread_block::drive::Pose { load: LOAD, ..Default::default() }).unwrap();
    block.outputs().clone()
}

#[test]
fn a_road_that_starts_under_the_block_gives_it_no_inertia() {
    // Independent full simulation (verification case slide-1: 0.3 m/s after a start of 0.5 ms, the
    // road moves): 4.137 N and 13.997 N at 0.2 and 0.4 ms. An accelerated block would be at 13.2 N.
    let rows = slid(&Params::default(), 0.3, LOAD, 0.4e-3);
    for (row, expected) in [(5, 4.137), (10, 13.997)] {
        let force = rows[row].contact_force[0];
        assert!((force / expected - 1.0).abs() < 0.01, "{force} {expected}");
    }
}

#[test]
fn a_corner_that_falls_into_slip_faster_than_any_step_is_passed() {
    // An aged corner of a coarse mesh under ten times the mean pressure falls into slip at 2e7/s, where the
    // smallest step, 0.1 us, has no tangent. Two grids of steps, which pass it at different places, have to tell the
    // same impulse of friction up to their error of 1 %.
    let mut params = with("friction_ageing", 2, Some(0.128));
    params.block.height = 8e-3;
    (params.solver.elements_along, params.solver.elements_up) = (6, 4);
    params.solver.tolerance = 3e-3;
    (params.contact.depth, params.contact.reference_pressure) = (3.73e-5, 69.7e3);
    (params.friction.mu_drop, params.friction.decay_speed) = (0.68, 0.3135);
    (params.friction.mu_inf, params.friction.pressure_exponent) = (0.49, -0.076);
    (params.carriage.mass, params.carriage.damping) = (2.0, 240.0);
    params.effect.friction_ageing.distance = 1.3e-5;
    params.effect.friction_ageing.initial_age = 0.2;
    let impulse = |step: f64| {
        let mut block = TreadBlock::new(&params).unwrap();
        let scenario = Scenario::Slide(Slide::constant(0.3, 600e3 * 0.015 * 0.015));
        let plan = Plan { step, duration: 4e-3, inputs: Inputs::Exact };
        let mut sum = 0.0;
        scenario::run(&mut block, &scenario, &plan, |_, block| {
            sum += step * block.outputs().contact_force[0];
            Ok(())
        })
        .unwrap();
        sum
    };
    let (coarse, fine) = (impulse(40e-6), impulse(10e-6));
    assert!((coarse / fine - 1.0).abs() < 0.01, "{coarse} N s, {fine} N s");
}
