//! Primitives as the builder sees them: boxes with an id.

use wide::f32x4;

use super::super::Bounds;
use caustica_math::Vec3;

/// A box in registers; the fourth lanes mean nothing.
#[derive(Clone, Copy)]
pub(super) struct Extent {
    pub min: f32x4,
    pub max: f32x4,
}

impl Extent {
    pub(super) const EMPTY: Self =
        Self { min: f32x4::new([f32::INFINITY; 4]), max: f32x4::new([f32::NEG_INFINITY; 4]) };

    #[inline(always)]
    pub(super) fn union(self, min: f32x4, max: f32x4) -> Self {
        Self { min: self.min.fast_min(min), max: self.max.fast_max(max) }
    }

    #[inline(always)]
    pub(super) fn half_area(&self) -> f32 {
        let [x, y, z, _] = (self.max - self.min).to_array();
        x * y + y * z + z * x
    }

    pub(super) fn bounds(&self) -> Bounds {
        let corner = |v: f32x4| {
            let [x, y, z, _] = v.to_array();
            Vec3::new(x, y, z)
        };
        Bounds { min: corner(self.min), max: corner(self.max) }
    }
}

/// A primitive's box, with its id in the bits of the fourth lane of the upper corner: above [`ID_BASE`], as
/// arithmetic on numbers that are almost zero is slow on some CPUs.
#[derive(Clone, Copy)]
pub(super) struct Reference {
    pub min: f32x4,
    pub max: f32x4,
}

/// Ids are less than 2²⁷, so that numbers with these bits lie between 1e-19 and 1e-14.
const ID_BASE: u32 = 0x2000_0000;

impl Reference {
    #[inline]
    pub(super) fn new(bounds: Bounds, id: u32) -> Self {
        let [a, b] = [bounds.min, bounds.max];
        Self {
            min: f32x4::new([a.x, a.y, a.z, 0.0]),
            max: f32x4::new([b.x, b.y, b.z, f32::from_bits(ID_BASE + id)]),
        }
    }

    #[inline]
    pub(super) fn id(&self) -> u32 {
        self.max.as_array()[3].to_bits() - ID_BASE
    }

    /// Twice the centre.
    #[inline(always)]
    pub(super) fn center2(&self) -> f32x4 {
        self.min + self.max
    }

    /// Twice the centre, along one axis.
    #[inline(always)]
    pub(super) fn center2_along(&self, axis: usize) -> f32 {
        self.min.as_array()[axis] + self.max.as_array()[axis]
    }
}

/// The box around all references, and the one around twice their centres.
#[derive(Clone, Copy)]
pub(super) struct Extents {
    pub boxes: Extent,
    pub centers2: Extent,
}

impl Extents {
    pub(super) fn of(references: &[Reference]) -> Self {
        let (mut boxes, mut centers2) = (Extent::EMPTY, Extent::EMPTY);
        for r in references {
            let center2 = r.center2();
            boxes = boxes.union(r.min, r.max);
            centers2 = centers2.union(center2, center2);
        }
        Self { boxes, centers2 }
    }
}
