//! Third-octave bands: Butterworth filters of the third order on the frequencies of IEC 61260-1.

use crate::radiation::Section;
use std::f64::consts::PI;

/// Bands from 100 Hz to 10 kHz.
pub const BANDS: usize = 21;

/// Reference pressure of sound levels [Pa].
pub const P0: f64 = 20e-6;

/// Exact mid-band frequency [Hz] of band `i`: 1000 G^(x/3), G = 10^0.3 (IEC 61260-1, eq. 2).
pub fn middle(i: usize) -> f64 {
    1000.0 * 10f64.powf(0.1 * (i as f64 - 10.0))
}

/// Level [dB] of a mean square pressure [Pa²]; silence is −100 dB.
pub fn level(mean_square: f64) -> f64 {
    (10.0 * (mean_square / (P0 * P0)).log10()).max(-100.0)
}

/// A band's filter with the energy that has passed.
#[derive(Clone, Copy, Debug)]
pub struct Band {
    sections: [Section; 3],
    energy: f64,
}

impl Band {
    /// Band `i` for samples at `sampling` [Hz].
    ///
    /// Each pole p of the low-pass of the third order gives the two roots of s² − pBs + ω₀² = 0; edges
    /// are warped so that the bilinear transform leaves them where they belong.
    pub fn new(i: usize, sampling: f64) -> Self {
        let half = 10f64.powf(0.05);
        let warp = |f: f64| 2.0 * sampling * (PI * f / sampling).tan();
        let (low, high) = (warp(middle(i) / half), warp(middle(i) * half));
        let (width, square) = (high - low, low * high);
        let section = |denominator| Section::bilinear([0.0, width, 0.0], denominator, sampling);
        // p = −1: both roots in one section. p = −1/2 ± i√3/2: a root and its conjugate in each.
        let (re, im) = (-0.5 * width, 0.75f64.sqrt() * width);
        let (root_re, root_im) = square_root(re * re - im * im - 4.0 * square, 2.0 * re * im);
        let pair = |sign: f64| {
            let (x, y) = (0.5 * (re + sign * root_re), 0.5 * (im + sign * root_im));
            section([-2.0 * x, x * x + y * y])
        };
        Self { sections: [section([width, square]), pair(1.0), pair(-1.0)], energy: 0.0 }
    }

    /// Takes the next sample of the pressure.
    pub fn take(&mut self, pressure: f64) {
        let passed = self.sections.iter_mut().fold(pressure, |x, section| section.pass(x));
        self.energy += passed * passed;
    }

    /// Sum of the squares so far [Pa²].
    pub fn energy(&self) -> f64 {
        self.energy
    }
}

fn square_root(re: f64, im: f64) -> (f64, f64) {
    let (size, angle) = (re.hypot(im).sqrt(), 0.5 * im.atan2(re));
    (size * angle.cos(), size * angle.sin())
}
