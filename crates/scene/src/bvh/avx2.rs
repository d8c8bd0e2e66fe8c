//! The kernels for x86-64 CPUs with AVX2.
#![allow(unsafe_code)]

use std::arch::x86_64::*;

use super::lanes::{Eight, Lanes};
use super::traverse::{any_hit, first_hit};
use super::{Bvh, Hit, Ray};

/// Whether this CPU can run [`closest`] and [`occluded`].
pub(super) fn is_available() -> bool {
    is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("lzcnt")
        && is_x86_feature_detected!("popcnt")
}

/// The first hit along the ray.
#[target_feature(enable = "avx2,bmi1,lzcnt,popcnt")]
pub(super) fn closest(bvh: &Bvh, ray: &Ray) -> Option<Hit> {
    first_hit::<Avx>(bvh, ray)
}

/// Whether the ray hits anything.
#[target_feature(enable = "avx2,bmi1,lzcnt,popcnt")]
pub(super) fn occluded(bvh: &Bvh, ray: &Ray) -> bool {
    any_hit::<Avx>(bvh, ray)
}

/// One AVX register. Only the two functions above, which need the CPU to have AVX2, make any: that is what
/// the blocks below rely on. (A trait's methods cannot carry a target feature themselves; they are inlined into
/// functions that do.)
#[derive(Clone, Copy)]
struct Avx(__m256);

/// What lanes in one AVX register have in common, whatever else the CPU has.
macro_rules! arithmetic {
    () => {
        #[inline(always)]
        fn splat(v: f32) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm256_set1_ps(v) })
        }
        #[inline(always)]
        fn load(v: &[f32; 8]) -> Self {
            // SAFETY: see the type; the array has eight elements, and need not be aligned.
            Self(unsafe { _mm256_loadu_ps(v.as_ptr()) })
        }
        #[inline(always)]
        fn store(self) -> Eight {
            let mut v = Eight([0.0; 8]);
            // SAFETY: see the type; the array has eight elements and is aligned.
            unsafe { _mm256_store_ps(v.0.as_mut_ptr(), self.0) };
            v
        }
        #[inline(always)]
        fn add(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm256_add_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn sub(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm256_sub_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn mul(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm256_mul_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn div(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm256_div_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn min(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm256_min_ps(self.0, o.0) })
        }
        #[inline(always)]
        fn max(self, o: Self) -> Self {
            // SAFETY: see the type.
            Self(unsafe { _mm256_max_ps(self.0, o.0) })
        }
    };
}
pub(super) use arithmetic;

impl Lanes for Avx {
    arithmetic!();

    #[inline(always)]
    fn le(self, o: Self) -> u32 {
        // SAFETY: see `Avx`.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, o.0)) as u32 }
    }
    #[inline(always)]
    fn ge(self, o: Self) -> u32 {
        // SAFETY: see `Avx`.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GE_OQ>(self.0, o.0)) as u32 }
    }
    #[inline(always)]
    fn gt(self, o: Self) -> u32 {
        // SAFETY: see `Avx`.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(self.0, o.0)) as u32 }
    }
    #[inline(always)]
    fn packed(values: &[u32; 8], mask: u32) -> [u32; 8] {
        let mut packed = [0; 8];
        // SAFETY: see `Avx`; all three have eight elements, and need not be aligned.
        unsafe {
            let values = _mm256_loadu_si256(values.as_ptr().cast());
            let order = _mm256_cvtepu8_epi32(_mm_loadl_epi64(ORDERS[mask as usize & 255].as_ptr().cast()));
            _mm256_storeu_si256(packed.as_mut_ptr().cast(), _mm256_permutevar8x32_epi32(values, order));
        }
        packed
    }
}

/// For each mask the lanes whose bits are set.
static ORDERS: [[u8; 8]; 256] = {
    let mut orders = [[0; 8]; 256];
    let mut i = 0;
    while i < 256 * 8 {
        let (mask, lane) = (i / 8, i % 8);
        if mask >> lane & 1 == 1 {
            orders[mask][(mask & ((1 << lane) - 1)).count_ones() as usize] = lane as u8;
        }
        i += 1;
    }
    orders
};
