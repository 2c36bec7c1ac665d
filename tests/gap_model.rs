//! What the fits compare: simulated runs as the rig would have measured them.

use std::path::Path;

use tread_block::effects::{fit_specs, Spread};
use tread_block::gap::campaign::Campaign;
use tread_block::gap::problem::{Bench, Choice, Look};
use tread_block::gap::simulate::{nominal, Simulator};

fn open(number: usize) -> Campaign {
    let file = format!("tests/data/campaigns/open/open-{number:02}.zip");
    Campaign::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap()
}

#[test]
fn a_simulated_start_has_as_many_samples_as_a_measured_one() {
    let campaign = open(12);
    let simulator = Simulator::new(&campaign.plan).unwrap();
    let params = nominal(&campaign.plan);
    let run = &campaign.runs[13];
    // Multiples of the sampling step of 40 us, halves of it, and what lies between.
    for until in [1.3e-3, 1.6667e-3, 2.0e-3, 2.02e-3, 2.5e-3, 3.3333e-3] {
        let simulated = simulator.run(&params, &run.spec, until).unwrap();
        assert_eq!(simulated.time.len(), run.record.until(until).time.len(), "{until}");
    }
}

#[test]
fn an_effect_of_next_to_no_severity_leaves_every_channel_of_the_rig_as_it_was() {
    let campaign = open(12);
    let bench = Bench::new(&campaign, fit_specs(), Look::Start).unwrap();
    let simulator = Simulator::new(&campaign.plan).unwrap();
    let run = &campaign.runs[3].spec;
    let base = bench.base_size();
    let plain = simulator.run(&bench.params(&[], &vec![0.0; base]), run, 1.3e-3).unwrap();
    for (effect, spec) in fit_specs().iter().enumerate() {
        for form in 0..spec.forms.len() {
            let added = [Choice { effect, form }];
            let coordinates = bench.coordinates(&added);
            let mut x = vec![0.0; coordinates.len()];
            // A millionth of the usual severity: friction, force and travel change by as little,
            // a thousandth at most where a small step of the solver is taken elsewhere.
            x[base] = match coordinates[base].spread {
                Spread::Log(s) => -(1e6_f64.ln()) / s,
                Spread::Absolute(_) => 1e-6,
            };
            let with = simulator.run(&bench.params(&added, &x), run, 1.3e-3).unwrap();
            for (channel, (a, b)) in plain.channel.iter().zip(&with.channel).enumerate() {
                let (a, b) = (a.as_ref().unwrap(), b.as_ref().unwrap());
                let size = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                let off = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(off < 1e-3 * size, "{} {form}, channel {channel}: {off}", spec.effect);
            }
        }
    }
}

#[test]
fn pressing_at_rest_does_not_soften_and_shearing_does() {
    // Kraus' factor at the mean shear: 30 um over 10 mm is 0.3 %, x = (0.3/0.8)^1.1 = 0.34, s = 1/2.
    let campaign = open(12);
    let simulator = Simulator::new(&campaign.plan).unwrap();
    let mut params = nominal(&campaign.plan);
    let run = &campaign.runs[3].spec;
    let plain = simulator.run(&params, run, 1e-4).unwrap();
    params.effect.payne_softening.enabled = true;
    let soft = simulator.run(&params, run, 1e-4).unwrap();
    let normal = |r: &tread_block::gap::campaign::Record| r.channel[1].as_ref().unwrap()[1];
    assert!((normal(&soft) / normal(&plain) - 1.0).abs() < 2e-3);
    let long = simulator.run(&params, run, 1.2e-3).unwrap();
    let force = long.channel[1].as_ref().unwrap();
    assert!(force.iter().copied().fold(f64::INFINITY, f64::min) < 0.9 * force[0]);
}
