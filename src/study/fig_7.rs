//! Figure 7: how pressure and the block's geometry change its vibrations.

use super::identify::objective::Fineness;
use super::plot::svg;
use super::report::{change, Study, Verdict};
use super::variation::{base, run_all, trend, Run, Variation};
use crate::error::Fault;
use crate::params::Params;

/// Figure 7: pressure and geometry.
///
/// # Errors
/// What stops the block.
pub fn fig_7(compound: &Params, fineness: &Fineness) -> Result<Study, Fault> {
    let pressures = [0.08e6, 0.16e6, 0.25e6, 0.40e6, 0.63e6].map(|pressure: f64| Run {
        label: format!("{:.2} N/mm2", 1e-6 * pressure),
        value: pressure,
        pressure,
        ..base(compound, fineness)
    });
    let geometries = [(10, 15), (6, 15), (10, 45), (6, 45)].map(|(h, l): (u32, u32)| {
        let mut run = base(compound, fineness);
        run.params.block.height = 1e-3 * f64::from(h);
        run.params.block.length = 1e-3 * f64::from(l);
        fineness.apply(&mut run.params);
        Run { label: format!("h {h} mm, l {l} mm"), value: 1e-3 * f64::from(h), ..run }
    });
    let pressure = Variation {
        name: "fig-7-pressure",
        header: "pressure_pa",
        title: "Mean pressure".to_string(),
        runs: run_all(pressures.to_vec())?,
    };
    let geometry = Variation {
        name: "fig-7-geometry",
        header: "height_m",
        title: "Block geometry".to_string(),
        runs: run_all(geometries.to_vec())?,
    };
    let mut verdicts = trend(&pressure.runs, "pressure", [true, false]);
    verdicts.truncate(1);
    let low = pressure.frequencies()[0];
    verdicts.push(Verdict::new(
        "the oscillation vanishes at small pressure (0.08 N/mm2)",
        low == 0.0,
        if low == 0.0 { "silent".to_string() } else { format!("{low:.0} Hz") },
    ));
    verdicts.extend(geometry_verdicts(&geometry));
    Ok(Study {
        name: "fig-7",
        title: "Mean pressure and block geometry",
        notes: pressure.beyond_small_strain(),
        tables: vec![pressure.summary(), geometry.summary(), pressure.traces()],
        pictures: vec![(
            "fig-7.svg".to_string(),
            svg(&[pressure.displacements(), geometry.displacements()], 2)?,
        )],
        verdicts,
    })
}

/// How amplitude and frequency go with height and length: h 10 l 15, h 6 l 15, h 10 l 45, h 6 l 45.
fn geometry_verdicts(geometry: &Variation) -> [Verdict; 3] {
    let (x, f) = (geometry.amplitudes(), geometry.frequencies());
    let height = Verdict::new(
        "amplitude rises with height",
        x[0] > x[1] && x[2] > x[3],
        format!("{} (l 15), {} (l 45) from 6 to 10 mm", change(x[1], x[0]), change(x[3], x[2])),
    );
    let length = Verdict::new(
        "amplitude falls with length",
        x[0] > x[2] && x[1] > x[3],
        format!("{} (h 10), {} (h 6) from 15 to 45 mm", change(x[0], x[2]), change(x[1], x[3])),
    );
    let mut order: Vec<usize> = (0..4).collect();
    order.sort_by(|a, b| x[*a].total_cmp(&x[*b]));
    let inverse = Verdict::new(
        "the frequency falls where the amplitude rises",
        order.windows(2).all(|w| f[w[0]] > f[w[1]]),
        order
            .iter()
            .map(|i| format!("{:.0} um {:.0} Hz", 1e6 * x[*i], f[*i]))
            .collect::<Vec<_>>()
            .join(", "),
    );
    [height, length, inverse]
}
