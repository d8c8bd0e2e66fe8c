//! Eight numbers at a time.

use wide::f32x8;

/// Eight numbers as they are best stored: in one line of the cache.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub(super) struct Eight(pub [f32; 8]);

/// Eight `f32` lanes. Every operation rounds as the scalar one does and none is fused, so that all kinds of
/// lanes give the same bits.
pub(super) trait Lanes: Copy {
    fn splat(v: f32) -> Self;
    fn load(v: &[f32; 8]) -> Self;
    fn store(self) -> Eight;
    fn add(self, o: Self) -> Self;
    fn sub(self, o: Self) -> Self;
    fn mul(self, o: Self) -> Self;
    fn div(self, o: Self) -> Self;
    /// The smaller; unspecified if either is NaN.
    fn min(self, o: Self) -> Self;
    /// The larger; unspecified if either is NaN.
    fn max(self, o: Self) -> Self;
    /// One bit a lane: self ≤ o. NaN compares false.
    fn le(self, o: Self) -> u32;
    /// One bit a lane: self ≥ o. NaN compares false.
    fn ge(self, o: Self) -> u32;
    /// One bit a lane: self > o. NaN compares false.
    fn gt(self, o: Self) -> u32;
    /// The values whose bits are set, in order, and then whatever.
    fn packed(values: &[u32; 8], mask: u32) -> [u32; 8];
}

/// Lanes for every CPU: two SSE2 or NEON registers, or plain arrays where there is neither.
#[derive(Clone, Copy)]
pub(super) struct Portable(f32x8);

impl Lanes for Portable {
    #[inline(always)]
    fn splat(v: f32) -> Self {
        Self(f32x8::splat(v))
    }
    #[inline(always)]
    fn load(v: &[f32; 8]) -> Self {
        Self(f32x8::new(*v))
    }
    #[inline(always)]
    fn store(self) -> Eight {
        Eight(self.0.to_array())
    }
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self(self.0 + o.0)
    }
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self(self.0 - o.0)
    }
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self(self.0 * o.0)
    }
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        Self(self.0 / o.0)
    }
    #[inline(always)]
    fn min(self, o: Self) -> Self {
        Self(self.0.fast_min(o.0))
    }
    #[inline(always)]
    fn max(self, o: Self) -> Self {
        Self(self.0.fast_max(o.0))
    }
    #[inline(always)]
    fn le(self, o: Self) -> u32 {
        self.0.simd_le(o.0).to_bitmask()
    }
    #[inline(always)]
    fn ge(self, o: Self) -> u32 {
        self.0.simd_ge(o.0).to_bitmask()
    }
    #[inline(always)]
    fn gt(self, o: Self) -> u32 {
        self.0.simd_gt(o.0).to_bitmask()
    }
    #[inline(always)]
    fn packed(values: &[u32; 8], mut mask: u32) -> [u32; 8] {
        let (mut packed, mut count) = ([0; 8], 0);
        while mask != 0 {
            packed[count] = values[mask.trailing_zeros() as usize & 7];
            count += 1;
            mask &= mask - 1;
        }
        packed
    }
}
