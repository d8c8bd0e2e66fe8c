use std::f32::consts::PI;

use caustica_math::Vec3;
use caustica_math::elementary::{atan2, cos, sin, sin_cos};

/// The directions of some normals, and how far from them light goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Unit vector in the middle.
    pub axis: Vec3,
    /// Half angle around the axis that holds all normals.
    pub spread: f32,
    /// Angle from a normal beyond which there is no light.
    pub reach: f32,
}

/// By how much a cone around two is made wider than rounding asks for, in radians.
const ROUNDING: f32 = 1e-5;

impl Cone {
    /// Light in all directions.
    pub const ALL: Self = Self { axis: Vec3::Z, spread: PI, reach: 0.5 * PI };

    /// A flat lamp of that normal.
    pub fn flat(normal: Vec3) -> Self {
        Self { axis: normal, spread: 0.0, reach: 0.5 * PI }
    }

    /// A cone around two: the narrowest (Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree
    /// Splitting", 2018, algorithm 1).
    pub fn around(self, other: Self) -> Self {
        let reach = self.reach.max(other.reach);
        let (wide, narrow) = if self.spread >= other.spread { (self, other) } else { (other, self) };
        let (c, across) = (wide.axis.dot(narrow.axis), narrow.axis - wide.axis * wide.axis.dot(narrow.axis));
        let s = across.length();
        let between = atan2(s, c);
        if between + narrow.spread <= wide.spread {
            return Self { reach, ..wide };
        }
        let spread = 0.5 * (wide.spread + between + narrow.spread) + ROUNDING;
        // Opposite axes: nobody knows which way round.
        if spread >= PI || s < 1e-4 && c < 0.0 {
            return Self { reach, ..Self::ALL };
        }
        let turn = spread - wide.spread;
        let axis = if s > 0.0 { wide.axis * cos(turn) + across * (sin(turn) / s) } else { wide.axis };
        Self { axis: axis.try_normalized().unwrap_or(wide.axis), spread, reach }
    }

    /// Sine and cosine of the spread.
    pub fn sin_cos(self) -> (f32, f32) {
        if self.spread >= PI { (0.0, -1.0) } else { sin_cos(self.spread) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use caustica_math::{SampleStream, StreamId, warp};

    #[test]
    fn a_cone_around_two_holds_both() {
        let mut s = SampleStream::new(StreamId { seed: 5, pixel: 0, sample: 0, walk: 0 });
        for _ in 0..10_000 {
            let mut cone = || {
                let axis = warp::uniform_sphere(s.next_2d());
                let [a, b] = s.next_2d();
                Cone { axis, spread: PI * a * a, reach: PI * b }
            };
            let (a, b) = (cone(), cone());
            let both = a.around(b);
            assert!((both.axis.length() - 1.0).abs() < 1e-5);
            for one in [a, b] {
                let angle = atan2(one.axis.cross(both.axis).length(), one.axis.dot(both.axis));
                assert!(
                    both.spread >= PI || angle + one.spread <= both.spread + 1e-4,
                    "{a:?} {b:?} {both:?}"
                );
                assert!(both.reach >= one.reach);
            }
        }
    }

    #[test]
    fn parallel_and_opposite_normals() {
        let flat = Cone::flat(Vec3::X);
        assert_eq!(flat.around(flat).axis, Vec3::X);
        assert!(flat.around(flat).spread < 1e-4);
        assert_eq!(flat.around(Cone::flat(-Vec3::X)).spread, PI);
    }
}
