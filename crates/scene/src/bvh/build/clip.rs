//! Cutting a triangle's box in two by a plane across an axis.

use caustica_math::Vec3;
use wide::f32x4;

use super::super::Bounds;
use super::reference::{Extent, Reference};

/// How much wider the parts' boxes are than the parts: relative to the triangle's longest side, because the
/// triangle test rounds what it sees of the whole triangle; and relative to the coordinates, for the rounding
/// of the cut itself. What grows with the distance of a ray's origin is covered by the box test.
const WIDER_BY_SIZE: f32 = 1.0 / 65_536.0;
const WIDER_BY_PLACE: f32 = 1.0 / 2_097_152.0;
/// Triangles of less than this height relative to their longest edge are not cut: where a ray crosses them
/// is too uncertain to look for it in one part only.
const LEAST_HEIGHT: f32 = 1.0 / 4096.0;

/// Whether a triangle is wide enough to be cut.
pub(super) fn is_divisible([a, b, c]: &[Vec3; 3]) -> bool {
    let (p, q) = (*b - *a, *c - *a);
    let longest = p.length_squared().max(q.length_squared()).max((q - p).length_squared());
    p.cross(q).length_squared() > longest * longest * (LEAST_HEIGHT * LEAST_HEIGHT)
}

/// The boxes around the parts of a triangle below the plane and above it, as far as they lie in the
/// reference's box (Stich, Friedrich and Dietrich, "Spatial Splits in Bounding Volume Hierarchies", HPG 2009).
pub(super) fn cut(
    reference: &Reference,
    corners: &[Vec3; 3],
    axis: usize,
    plane: f32,
) -> [Option<Reference>; 2] {
    let points = corners.map(|p| f32x4::new([p.x, p.y, p.z, 0.0]));
    let mut parts = [Extent::EMPTY; 2];
    for i in 0..3 {
        let (a, b) = (points[i], points[(i + 1) % 3]);
        let (from, to) = (corners[i][axis], corners[(i + 1) % 3][axis]);
        if from <= plane {
            parts[0] = parts[0].union(a, a);
        }
        if from >= plane {
            parts[1] = parts[1].union(a, a);
        }
        if (from < plane && to > plane) || (from > plane && to < plane) {
            let crossing = a + (b - a) * f32x4::splat((plane - from) / (to - from));
            parts = parts.map(|part| part.union(crossing, crossing));
        }
    }
    let whole = points.iter().fold(Extent::EMPTY, |e, p| e.union(*p, *p));
    let [x, y, z, _] = (whole.max - whole.min).to_array();
    let size = f32x4::splat(x.max(y).max(z) * WIDER_BY_SIZE);
    let margin = size + whole.min.abs().fast_max(whole.max.abs()) * f32x4::splat(WIDER_BY_PLACE);
    parts.map(|part| within(reference, part.min - margin, part.max + margin))
}

/// The reference with its box cut down; `None` if nothing is left.
fn within(reference: &Reference, min: f32x4, max: f32x4) -> Option<Reference> {
    let extent = Extent { min: reference.min.fast_max(min), max: reference.max.fast_min(max) };
    let Bounds { min, max } = extent.bounds();
    let is_empty = min.x > max.x || min.y > max.y || min.z > max.z;
    (!is_empty).then(|| Reference::new(extent.bounds(), reference.id()))
}
