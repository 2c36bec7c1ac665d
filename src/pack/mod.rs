//! Eight numbers at a time: plain arrays whose loops the compiler turns into vector instructions.
//!
//! Plain loops and no closures: what is not inlined into a kernel is compiled without the kernel's
//! instruction set, and a fused product then becomes a call of the system's library.

/// A pack from an expression of the lane. Spelled out eight times: a loop would be unrolled and made into vectors
/// again, in thousands of places, which takes minutes of compiling.
macro_rules! lanes {
    ($i:ident => $value:expr) => {{
        macro_rules! at {
            ($lane:literal) => {{
                #[allow(non_upper_case_globals)]
                const $i: usize = $lane;
                $value
            }};
        }
        $crate::pack::Pack([at!(0), at!(1), at!(2), at!(3), at!(4), at!(5), at!(6), at!(7)])
    }};
}

mod aligned;
mod functions;

pub use aligned::Aligned;

use bytemuck::{Pod, Zeroable};
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// Numbers in a pack.
pub const LANES: usize = 8;

/// Eight numbers, on a cache line of their own: reading a pack that was just written across two lines
/// waits for the cache.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(64))]
pub struct Pack(pub [f64; LANES]);

impl Pack {
    /// The same number eight times.
    #[inline(always)]
    pub fn splat(x: f64) -> Self {
        Self([x; LANES])
    }

    /// Sum of the numbers, in a fixed order.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.0;
        ((a + b) + (c + d)) + ((e + f) + (g + h))
    }

    /// The largest of the numbers.
    #[inline(always)]
    pub fn largest(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.0;
        larger(larger(larger(a, b), larger(c, d)), larger(larger(e, f), larger(g, h)))
    }

    /// `self` · `b` + `c`, rounded once.
    #[inline(always)]
    pub fn mul_add(self, b: Self, c: Self) -> Self {
        lanes!(i => self.0[i].mul_add(b.0[i], c.0[i]))
    }

    /// Absolute values.
    #[inline(always)]
    pub fn abs(self) -> Self {
        lanes!(i => self.0[i].abs())
    }

    /// The larger of each two numbers.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        lanes!(i => if self.0[i] > other.0[i] { self.0[i] } else { other.0[i] })
    }

    /// The smaller of each two numbers.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        lanes!(i => if self.0[i] < other.0[i] { self.0[i] } else { other.0[i] })
    }

    /// Where `self` > `limit` the numbers of `then`, else those of `otherwise`.
    #[inline(always)]
    pub fn if_above(self, limit: Self, then: Self, otherwise: Self) -> Self {
        lanes!(i => if self.0[i] > limit.0[i] { then.0[i] } else { otherwise.0[i] })
    }

    /// Magnitudes of `self` with the signs of `sign`.
    #[inline(always)]
    pub fn copysign(self, sign: Self) -> Self {
        lanes!(i => self.0[i].copysign(sign.0[i]))
    }
}

macro_rules! lanewise {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Pack {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                lanes!(i => self.0[i] $op other.0[i])
            }
        }
    };
}
lanewise!(Add, add, +);
lanewise!(Sub, sub, -);
lanewise!(Mul, mul, *);
lanewise!(Div, div, /);

impl Neg for Pack {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        lanes!(i => -self.0[i])
    }
}

impl AddAssign for Pack {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

/// The larger of two numbers, where neither is NaN.
#[inline(always)]
pub fn larger(a: f64, b: f64) -> f64 {
    if a > b {
        a
    } else {
        b
    }
}
