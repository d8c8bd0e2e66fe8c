use caustica_math::Vec3;

/// A place that looks for lamps.
#[derive(Clone, Copy, Debug)]
pub struct Receiver {
    /// Where it is.
    pub at: Vec3,
    /// The shading normal on the side from which light is scattered; zero if light may come from both sides, or if
    /// there is no surface.
    pub normal: Vec3,
}

impl From<Vec3> for Receiver {
    #[inline]
    fn from(at: Vec3) -> Self {
        Self { at, normal: Vec3::ZERO }
    }
}
