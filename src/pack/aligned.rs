//! Rows of packs that look like plain slices of numbers to who does not count instructions.

use super::{Pack, LANES};
use std::ops::{Deref, DerefMut};

/// Numbers in packs; the last pack is filled up with zeros.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Aligned {
    packs: Vec<Pack>,
    len: usize,
}

impl Aligned {
    /// `len` zeros.
    pub fn zeros(len: usize) -> Self {
        Self { packs: vec![Pack::default(); len.div_ceil(LANES)], len }
    }

    /// `values`, then `rest` up to `len` numbers.
    pub fn padded(values: &[f64], len: usize, rest: f64) -> Self {
        let mut numbers = Self::zeros(len);
        let (head, tail) = numbers.split_at_mut(values.len());
        head.copy_from_slice(values);
        tail.fill(rest);
        numbers
    }

    /// The packs.
    #[inline(always)]
    pub fn packs(&self) -> &[Pack] {
        &self.packs
    }

    /// The packs, to be changed.
    #[inline(always)]
    pub fn packs_mut(&mut self) -> &mut [Pack] {
        &mut self.packs
    }
}

impl<'a> IntoIterator for &'a Aligned {
    type Item = &'a f64;
    type IntoIter = std::slice::Iter<'a, f64>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<'a> IntoIterator for &'a mut Aligned {
    type Item = &'a mut f64;
    type IntoIter = std::slice::IterMut<'a, f64>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter_mut()
    }
}

impl Deref for Aligned {
    type Target = [f64];
    #[inline(always)]
    fn deref(&self) -> &[f64] {
        &bytemuck::cast_slice(&self.packs)[..self.len]
    }
}

impl DerefMut for Aligned {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut bytemuck::cast_slice_mut(&mut self.packs)[..self.len]
    }
}
