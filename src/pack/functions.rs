//! The elementary functions of the contact laws on packs.
//!
//! They use no system library, so that a block moves alike on every platform; errors are below 4e-15
//! relative in the ranges that the laws use (see the tests).

use super::Pack;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, LOG2_E};

impl Pack {
    /// Polynomial with the coefficients of the highest power first (Horner's scheme).
    #[inline(always)]
    fn horner<const N: usize>(self, coefficients: [f64; N]) -> Self {
        let mut sum = Self::splat(coefficients[0]);
        for c in &coefficients[1..] {
            sum = sum.mul_add(self, Self::splat(*c));
        }
        sum
    }

    /// Exponential; arguments are kept within ±700.
    #[inline(always)]
    pub fn exp(self) -> Self {
        let x = self.max(Self::splat(-700.0)).min(Self::splat(700.0));
        let shifted = x.mul_add(Self::splat(LOG2_E), Self::splat(ROUNDING));
        let n = shifted - Self::splat(ROUNDING);
        let r = n.mul_add(Self::splat(-LN_2_HIGH), x);
        let r = n.mul_add(Self::splat(-LN_2_LOW), r);
        let sum = r.horner(EXP_TAYLOR);
        // The low bits of `shifted` hold n: put it into the exponent.
        lanes!(i => f64::from_bits(sum.0[i].to_bits().wrapping_add(shifted.0[i].to_bits() << 52)))
    }

    /// Natural logarithm of positive normal numbers.
    #[inline(always)]
    pub fn ln(self) -> Self {
        // Mantissa in [√½, √2), exponent as a float by the usual trick with 2⁵².
        let above = |i: usize| self.0[i].to_bits().wrapping_sub(SQRT_HALF_BITS);
        let bits = [above(0), above(1), above(2), above(3), above(4), above(5), above(6), above(7)];
        let m = lanes!(i => f64::from_bits((bits[i] & MANTISSA).wrapping_add(SQRT_HALF_BITS)));
        let e = lanes!(i => f64::from_bits(TWO_52_BITS | ((bits[i] >> 52).wrapping_add(1024) & 0x7ff))
            - (TWO_52 + 1024.0));
        let s = (m - Self::splat(1.0)) / (m + Self::splat(1.0));
        let z = s * s;
        let series = z.horner(LN_ATANH);
        let twice = s + s;
        let log_m = (twice * z).mul_add(series, twice);
        e.mul_add(Self::splat(LN_2_HIGH), e.mul_add(Self::splat(LN_2_LOW), log_m))
    }

    /// `self` to the power `exponent`, for positive numbers.
    #[inline(always)]
    pub fn powf(self, exponent: f64) -> Self {
        (self.ln() * Self::splat(exponent)).exp()
    }

    /// Arc tangent (Cephes' ranges and rational approximation).
    #[inline(always)]
    pub fn atan(self) -> Self {
        let x = self.abs();
        let one = Self::splat(1.0);
        let (large, middle) = (Self::splat(TAN_3PI_8), Self::splat(0.66));
        // One division for all ranges: −1/x, (x − 1)/(x + 1) or x/1.
        let numerator = x.if_above(large, -one, x.if_above(middle, x - one, x));
        let denominator = x.if_above(large, x, x.if_above(middle, x + one, one));
        let zero = Self::splat(0.0);
        let offset = x.if_above(
            large,
            Self::splat(FRAC_PI_2),
            x.if_above(middle, Self::splat(FRAC_PI_4), zero),
        );
        let r = numerator / denominator;
        let z = r * r;
        let p = z * z.horner(ATAN_P) / z.horner(ATAN_Q);
        (offset + r.mul_add(p, r)).copysign(self)
    }
}

/// 1.5 · 2⁵²: adding it rounds to an integer that then stands in the low bits.
const ROUNDING: f64 = 6_755_399_441_055_744.0;
const TWO_52: f64 = 4_503_599_627_370_496.0;
const TWO_52_BITS: u64 = 0x4330_0000_0000_0000;
const MANTISSA: u64 = 0x000f_ffff_ffff_ffff;
/// Bits of √½.
const SQRT_HALF_BITS: u64 = 0x3fe6_a09e_667f_3bcd;
/// ln 2 in two parts, the first with trailing zeros.
const LN_2_HIGH: f64 = 0.693_147_180_369_123_8;
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
const TAN_3PI_8: f64 = 2.414_213_562_373_095;

/// 1/12! … 1/0!: on |r| ≤ ln 2 / 2 the remainder is below 2e-16.
const EXP_TAYLOR: [f64; 13] = [
    2.087_675_698_786_81e-9,
    2.505_210_838_544_172e-8,
    2.755_731_922_398_589_3e-7,
    2.755_731_922_398_589e-6,
    2.480_158_730_158_73e-5,
    1.984_126_984_126_984e-4,
    1.388_888_888_888_889e-3,
    8.333_333_333_333_333e-3,
    4.166_666_666_666_666_4e-2,
    1.666_666_666_666_666_6e-1,
    0.5,
    1.0,
    1.0,
];

/// 1/19 … 1/3: ln m = 2 s (1 + z/3 + z²/5 + …), z = s² ≤ 0.0295; the remainder is below 3e-17.
const LN_ATANH: [f64; 9] = [
    1.0 / 19.0,
    1.0 / 17.0,
    1.0 / 15.0,
    1.0 / 13.0,
    1.0 / 11.0,
    1.0 / 9.0,
    1.0 / 7.0,
    1.0 / 5.0,
    1.0 / 3.0,
];

const ATAN_P: [f64; 5] = [
    -8.750_608_600_031_904e-1,
    -1.615_753_718_733_365e1,
    -7.500_855_792_314_705e1,
    -1.228_866_684_490_136_1e2,
    -6.485_021_904_942_025e1,
];
const ATAN_Q: [f64; 6] = [
    1.0,
    2.485_846_490_142_306_3e1,
    1.650_270_098_316_988_5e2,
    4.328_810_604_912_902_7e2,
    4.853_903_996_359_137e2,
    1.945_506_571_482_614e2,
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest relative error of `ours` against `theirs` over a range, logarithmic in |x|.
    fn worst(range: (f64, f64), ours: fn(Pack) -> Pack, theirs: fn(f64) -> f64) -> f64 {
        let mut worst: f64 = 0.0;
        for k in 0..20_000 {
            let x = range.0 * (range.1 / range.0).powf(k as f64 / 19_999.0);
            for x in [x, -x] {
                let (a, b) = (ours(Pack::splat(x)).0[3], theirs(x));
                if b.is_finite() && b != 0.0 {
                    worst = worst.max(((a - b) / b).abs());
                }
            }
        }
        worst
    }

    #[test]
    fn the_elementary_functions_agree_with_the_standard_library() {
        // Reference: the platform's libm, correct to about 1e-16.
        let exp = worst((1e-8, 600.0), Pack::exp, f64::exp);
        let atan = worst((1e-8, 1e8), Pack::atan, f64::atan);
        let ln = worst((1e-12, 1e12), Pack::ln, f64::ln);
        assert!(exp < 1e-15, "{exp}");
        assert!(atan < 1e-15, "{atan}");
        assert!(ln < 4e-15, "{ln}");
    }
}
