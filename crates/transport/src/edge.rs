//! Edges, and the one jacobian.

/// What of an edge enters the change of measure along it.
///
/// A density per solid angle at one end becomes a density in the other end's own measure by the factor
/// `falloff · cos`, where `cos` belongs to the far end (one if that has no surface):
///
/// | from | to | measure at `to` | factor |
/// |---|---|---|---|
/// | finite | surface | area | cos/d² |
/// | finite | point without surface | its Dirac distribution | 1/d² |
/// | finite | infinity | solid angle | 1 |
/// | infinity (density per area across the edge) | surface | area | cos |
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// 1/d², or one if an end is at infinity.
    pub falloff: f32,
}

impl Edge {
    /// An edge of that squared length.
    #[inline]
    pub fn finite(length_squared: f32) -> Self {
        Self { falloff: 1.0 / length_squared }
    }

    /// An edge to or from infinity.
    pub const INFINITE: Self = Self { falloff: 1.0 };

    /// An edge of that length, which may be infinite.
    #[inline]
    pub fn of_length(length: f32) -> Self {
        if length.is_finite() { Self::finite(length * length) } else { Self::INFINITE }
    }

    /// The factor for a far end of that |cos|.
    #[inline]
    pub fn jacobian(self, cos: f32) -> f32 {
        self.falloff * cos
    }
}
