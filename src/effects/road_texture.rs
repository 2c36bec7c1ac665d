//! Road texture: the road has a height that moves with it.

use super::fit::{log, signed, FitForm, FitSpec, Module};
use crate::params::table::{DisplayUnit, Item};
use crate::params::ParamSpec;
use crate::{bool_param, enum_param, real_param};
use std::f64::consts::TAU;

/// Shape of the texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Form {
    /// One wavelength.
    #[default]
    Sine,
    /// Eight wavelengths about a middle one, random but always the same.
    Band,
    /// Up to four waves of their own, as they are found in a measurement.
    Waves,
}

impl Form {
    /// All variants, in the order of the enumeration's values.
    pub const ALL: [Self; 3] = [Self::Sine, Self::Band, Self::Waves];
}

/// Height of the road over its own coordinate x \[m\] (theory eq. 7.10).
///
/// `sine`: a·sin(2πx/λ + φ). `band`: eight sines with wavelengths from λ/2 to 2λ, amplitudes falling
/// as the square of the wavenumber (self-affine road, H = 1: C(q) ∝ q^−4 per direction, Persson et
/// al., J. Phys.: Condens. Matter 17, 2005) with a as the root of twice the mean square, and
/// phases of a fixed random sequence. `waves`: the sine and up to three more with amplitudes, wavelengths and
/// phases of their own.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadTexture {
    /// Is the effect on?
    pub enabled: bool,
    /// Shape.
    pub form: Form,
    /// Amplitude a \[m\].
    pub amplitude: f64,
    /// Wavelength λ \[m\].
    pub wavelength: f64,
    /// Phase φ \[rad\] of the texture at x = 0.
    pub phase: f64,
    /// Second wave of the form `waves`.
    pub second: Wave,
    /// Third wave.
    pub third: Wave,
    /// Fourth wave.
    pub fourth: Wave,
}

/// One wave of the form `waves`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Amplitude \[m\].
    pub amplitude: f64,
    /// Wavelength \[m\].
    pub wavelength: f64,
    /// Phase \[rad\] at x = 0.
    pub phase: f64,
}

impl Default for Wave {
    fn default() -> Self {
        Self { amplitude: 0.0, wavelength: 2e-3, phase: 0.0 }
    }
}

impl Default for RoadTexture {
    fn default() -> Self {
        Self {
            enabled: false,
            form: Form::Sine,
            amplitude: 3e-6,
            wavelength: 2e-3,
            phase: 0.0,
            second: Wave::default(),
            third: Wave::default(),
            fourth: Wave::default(),
        }
    }
}

/// Number of sines in a band.
const HARMONICS: usize = 8;
/// Phases of the band \[turns\]: fractional parts of k² (√5 − 1)/2, which are spread without pattern.
const PHASES: [f64; HARMONICS] =
    [0.618034, 0.472136, 0.562306, 0.888544, 0.450850, 0.249224, 0.283666, 0.554176];

/// The texture as a sum of sines, ready to be evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texture {
    amplitude: [f64; HARMONICS],
    wavenumber: [f64; HARMONICS],
    phase: [f64; HARMONICS],
    count: usize,
}

impl Texture {
    /// Height \[m\] at `x` \[m\].
    pub fn height(&self, x: f64) -> f64 {
        let mut sum = 0.0;
        for k in 0..self.count {
            sum += self.amplitude[k] * (self.wavenumber[k] * x + self.phase[k]).sin();
        }
        sum
    }

    /// Slope at `x` \[m\].
    pub fn slope(&self, x: f64) -> f64 {
        let mut sum = 0.0;
        for k in 0..self.count {
            let q = self.wavenumber[k];
            sum += self.amplitude[k] * q * (q * x + self.phase[k]).cos();
        }
        sum
    }
}

impl RoadTexture {
    /// The texture in force; none where the effect is off.
    pub fn texture(&self) -> Option<Texture> {
        if !self.enabled || self.amplitude == 0.0 {
            return None;
        }
        let mut out = Texture {
            amplitude: [0.0; HARMONICS],
            wavenumber: [TAU / self.wavelength; HARMONICS],
            phase: [self.phase; HARMONICS],
            count: 1,
        };
        out.amplitude[0] = self.amplitude;
        match self.form {
            Form::Sine => {}
            Form::Band => self.band(&mut out),
            Form::Waves => {
                for wave in [self.second, self.third, self.fourth] {
                    if wave.amplitude > 0.0 {
                        out.amplitude[out.count] = wave.amplitude;
                        out.wavenumber[out.count] = TAU / wave.wavelength;
                        out.phase[out.count] = wave.phase;
                        out.count += 1;
                    }
                }
            }
        }
        Some(out)
    }

    fn band(&self, out: &mut Texture) {
        out.count = HARMONICS;
        for k in 0..HARMONICS {
            let ratio = 4.0_f64.powf(k as f64 / (HARMONICS - 1) as f64 - 0.5);
            out.wavenumber[k] = TAU / self.wavelength * ratio;
            out.amplitude[k] = 1.0 / (ratio * ratio);
            out.phase[k] = self.phase * ratio + TAU * PHASES[k];
        }
        let norm = out.amplitude.iter().map(|a| a * a).sum::<f64>().sqrt();
        out.amplitude.iter_mut().for_each(|a| *a *= self.amplitude / norm);
    }
}

const UM: Option<DisplayUnit> = Some(DisplayUnit { name: "um", factor: 1e6 });
const MM: Option<DisplayUnit> = Some(DisplayUnit { name: "mm", factor: 1e3 });
const DEG: Option<DisplayUnit> =
    Some(DisplayUnit { name: "deg", factor: 180.0 / std::f64::consts::PI });
const FORMS: &[Item] = &[
    Item { name: "sine", doc: "one wavelength" },
    Item { name: "band", doc: "eight wavelengths from half to twice the given one" },
    Item { name: "waves", doc: "up to four waves, each with its amplitude, wavelength and phase" },
];

/// Its parameters.
#[rustfmt::skip]
pub static PARAMS: &[ParamSpec] = &[
    bool_param!("effect.road_texture.enabled", effect.road_texture.enabled, Fixed, "Road texture: a height that moves with the road"),
    enum_param!("effect.road_texture.form", effect.road_texture.form, Form, "RoadTextureForm", FORMS, Fixed, "Shape of the texture"),
    real_param!("effect.road_texture.amplitude", effect.road_texture.amplitude, "m", UM, 0.0, 1e-3, 3e-6, Tunable, "Amplitude: root of twice the mean square height; 0: none"),
    real_param!("effect.road_texture.wavelength", effect.road_texture.wavelength, "m", MM, 1e-4, 1.0, 2e-3, Tunable, "Wavelength, in a band the middle one"),
    real_param!("effect.road_texture.phase", effect.road_texture.phase, "rad", DEG, -100.0, 100.0, 1.0, Tunable, "Phase of the texture at the origin of the road"),
    real_param!("effect.road_texture.second_amplitude", effect.road_texture.second.amplitude, "m", UM, 0.0, 1e-3, 1e-6, Tunable, "Second wave: amplitude; 0: none (form waves)"),
    real_param!("effect.road_texture.second_wavelength", effect.road_texture.second.wavelength, "m", MM, 1e-4, 1.0, 2e-3, Tunable, "Second wave: wavelength"),
    real_param!("effect.road_texture.second_phase", effect.road_texture.second.phase, "rad", DEG, -100.0, 100.0, 1.0, Tunable, "Second wave: phase at the origin of the road"),
    real_param!("effect.road_texture.third_amplitude", effect.road_texture.third.amplitude, "m", UM, 0.0, 1e-3, 1e-6, Tunable, "Third wave: amplitude; 0: none (form waves)"),
    real_param!("effect.road_texture.third_wavelength", effect.road_texture.third.wavelength, "m", MM, 1e-4, 1.0, 2e-3, Tunable, "Third wave: wavelength"),
    real_param!("effect.road_texture.third_phase", effect.road_texture.third.phase, "rad", DEG, -100.0, 100.0, 1.0, Tunable, "Third wave: phase at the origin of the road"),
    real_param!("effect.road_texture.fourth_amplitude", effect.road_texture.fourth.amplitude, "m", UM, 0.0, 1e-3, 1e-6, Tunable, "Fourth wave: amplitude; 0: none (form waves)"),
    real_param!("effect.road_texture.fourth_wavelength", effect.road_texture.fourth.wavelength, "m", MM, 1e-4, 1.0, 2e-3, Tunable, "Fourth wave: wavelength"),
    real_param!("effect.road_texture.fourth_phase", effect.road_texture.fourth.phase, "rad", DEG, -100.0, 100.0, 1.0, Tunable, "Fourth wave: phase at the origin of the road"),
];

/// What a fit may vary.
pub const FIT: FitSpec = FitSpec {
    effect: "road_texture",
    module: Module::Contact,
    forms: &[
        FitForm {
            name: "sine",
            params: &[
                log("effect.road_texture.amplitude", 3e-6, 1.0),
                log("effect.road_texture.wavelength", 2e-3, 0.6),
                signed("effect.road_texture.phase", 0.0, 2.0),
            ],
        },
        FitForm {
            name: "band",
            params: &[
                log("effect.road_texture.amplitude", 3e-6, 1.0),
                log("effect.road_texture.wavelength", 2e-3, 0.6),
                signed("effect.road_texture.phase", 0.0, 2.0),
            ],
        },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slope_is_the_derivative_of_height_and_the_mean_square_is_as_given() {
        // Central differences at 1e-4 of the wavelength: error of order 1e-6. Mean square over 200
        // wavelengths: the beats of the band average out to 1 %.
        // Waves of 4 and 3 um have the mean square of one of 5 um.
        let second = Wave { amplitude: 4e-6, wavelength: 3.1e-3, phase: 0.4 };
        for form in Form::ALL {
            let on = RoadTexture { enabled: true, form, second, ..RoadTexture::default() };
            let texture = on.texture().unwrap();
            let h = 1e-4 * on.wavelength;
            for x in [0.0, 3.1e-4, 1.7e-3, -8e-3] {
                let slope = (texture.height(x + h) - texture.height(x - h)) / (2.0 * h);
                assert!((slope - texture.slope(x)).abs() < 1e-5 * on.amplitude / on.wavelength);
            }
            let n = 100_000;
            let place = |i: i32| 200.0 * on.wavelength * f64::from(i) / f64::from(n);
            let square: f64 = (0..n).map(|i| texture.height(place(i)).powi(2)).sum();
            let amplitude = (2.0 * square / f64::from(n)).sqrt();
            let expected = if form == Form::Waves { 5e-6 } else { on.amplitude };
            assert!((amplitude / expected - 1.0).abs() < 0.01, "{form:?} {amplitude}");
        }
    }
}
