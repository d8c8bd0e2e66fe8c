//! The kernels for x86-64 CPUs with AVX-512VL: as wide as those for AVX2, but with twice as many registers, and with
//! comparisons that give bits.
#![allow(unsafe_code)]

use std::arch::x86_64::*;

use super::avx2::arithmetic;
use super::lanes::{Eight, Lanes};
use super::traverse::{any_hit, first_hit};
use super::{Bvh, Hit, Ray};

/// Whether this CPU can run [`closest`] and [`occluded`].
pub(super) fn is_available() -> bool {
    is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("lzcnt")
        && is_x86_feature_detected!("popcnt")
}

/// The first hit along the ray.
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl")]
pub(super) fn closest(bvh: &Bvh, ray: &Ray) -> Option<Hit> {
    first_hit::<Avx512>(bvh, ray)
}

/// Whether the ray hits anything.
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl")]
pub(super) fn occluded(bvh: &Bvh, ray: &Ray) -> bool {
    any_hit::<Avx512>(bvh, ray)
}

/// One AVX register. Only the two functions above, which need the CPU to have AVX-512, make any: that is what
/// the blocks below rely on. (A trait's methods cannot carry a target feature themselves; they are inlined into
/// functions that do.)
#[derive(Clone, Copy)]
struct Avx512(__m256);

impl Lanes for Avx512 {
    arithmetic!();

    #[inline(always)]
    fn le(self, o: Self) -> u32 {
        // SAFETY: see `Avx512`.
        unsafe { u32::from(_mm256_cmp_ps_mask::<_CMP_LE_OQ>(self.0, o.0)) }
    }
    #[inline(always)]
    fn ge(self, o: Self) -> u32 {
        // SAFETY: see `Avx512`.
        unsafe { u32::from(_mm256_cmp_ps_mask::<_CMP_GE_OQ>(self.0, o.0)) }
    }
    #[inline(always)]
    fn gt(self, o: Self) -> u32 {
        // SAFETY: see `Avx512`.
        unsafe { u32::from(_mm256_cmp_ps_mask::<_CMP_GT_OQ>(self.0, o.0)) }
    }
    #[inline(always)]
    fn packed(values: &[u32; 8], mask: u32) -> [u32; 8] {
        let mut packed = [0; 8];
        // SAFETY: see `Avx512`; both have eight elements, and need not be aligned.
        unsafe {
            let values = _mm256_loadu_si256(values.as_ptr().cast());
            _mm256_storeu_si256(packed.as_mut_ptr().cast(), _mm256_maskz_compress_epi32(mask as u8, values));
        }
        packed
    }
}
