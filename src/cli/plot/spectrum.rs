//! Amplitude spectrum and third octaves of a record.

/// Single-sided amplitude spectrum with a Hann window: frequency [Hz], amplitude [unit of signal].
///
/// A plain Fourier sum over the lines up to `highest` [Hz]: records are short, no FFT is needed.
pub fn amplitudes(step: f64, signal: &[f64], highest: f64) -> Vec<(f64, f64)> {
    let n = signal.len();
    let mean = signal.iter().sum::<f64>() / n as f64;
    let windowed: Vec<f64> = signal
        .iter()
        .enumerate()
        .map(|(i, x)| {
            let hann = 0.5 - 0.5 * (std::f64::consts::TAU * i as f64 / n as f64).cos();
            (x - mean) * hann
        })
        .collect();
    let spacing = 1.0 / (n as f64 * step);
    let lines = ((highest / spacing) as usize).min(n / 2);
    (1..=lines)
        .map(|k| {
            let (re, im) = fourier(&windowed, k);
            // 2/n for the single side, and 2 for the mean 1/2 of the Hann window.
            (k as f64 * spacing, 4.0 / n as f64 * (re * re + im * im).sqrt())
        })
        .collect()
}

/// Fourier sum of line `k`, by the rotation e^(−2πik/n) from sample to sample.
fn fourier(signal: &[f64], k: usize) -> (f64, f64) {
    let (sin, cos) = (std::f64::consts::TAU * k as f64 / signal.len() as f64).sin_cos();
    let (mut c, mut s, mut re, mut im) = (1.0, 0.0, 0.0, 0.0);
    for x in signal {
        re += x * c;
        im -= x * s;
        (c, s) = (c * cos - s * sin, s * cos + c * sin);
    }
    (re, im)
}

/// Effective value in third octaves (base 10: centres 10^(k/10)) from an amplitude spectrum.
pub fn third_octaves(spectrum: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let (Some(first), Some(last)) = (spectrum.first(), spectrum.last()) else { return Vec::new() };
    let band = |f: f64| (10.0 * f.log10()).round() as i32;
    (band(first.0) + 1..band(last.0))
        .map(|k| {
            // The Hann window spreads power over 1.5 lines.
            let power: f64 = spectrum
                .iter()
                .filter(|(f, _)| band(*f) == k)
                .map(|(_, a)| 0.5 * a * a / 1.5)
                .sum();
            (10f64.powf(f64::from(k) / 10.0), power.sqrt())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_on_a_line_has_its_amplitude_and_its_third_octave_the_effective_value() {
        // Closed form: 3 sin has amplitude 3 and effective value 3/√2.
        let (n, step) = (2000, 1e-5);
        let signal: Vec<f64> = (0..n)
            .map(|i| 3.0 * (std::f64::consts::TAU * 1000.0 * f64::from(i) * step).sin())
            .collect();
        let spectrum = amplitudes(step, &signal, 10e3);
        let top = spectrum.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        assert!((top.0 - 1000.0).abs() < 1e-6 && (top.1 - 3.0).abs() < 1e-6, "{top:?}");
        let bands = third_octaves(&spectrum);
        let loudest = bands.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        assert!((loudest.0 - 1000.0).abs() < 1e-6, "{loudest:?}");
        assert!((loudest.1 - 3.0 / 2f64.sqrt()).abs() < 1e-3, "{loudest:?}");
    }
}
