use std::f32::consts::PI;

use caustica_math::elementary::sin;
use caustica_math::{Frame, SolidAnglePdf, Spectrum, Vec3, warp};

/// A point that lights a cone, as [`crate::description::LightKind::Spot`] describes it.
#[derive(Clone, Copy, Debug)]
pub struct SpotLight {
    /// Where it is.
    pub position: Vec3,
    intensity: Spectrum,
    frame: Frame,
    /// 1 − cos of the half angles: cosines of narrow cones all round to one.
    inner: f32,
    outer: f32,
}

impl SpotLight {
    /// From its axis and half angles in degrees.
    pub fn new(position: Vec3, axis: Vec3, intensity: Spectrum, inner: f32, outer: f32) -> Self {
        let one_minus_cos = |degrees: f32| {
            let s = sin(0.5 * degrees.to_radians());
            2.0 * s * s
        };
        Self {
            position,
            intensity,
            frame: Frame::from_normal(axis),
            inner: one_minus_cos(inner),
            outer: one_minus_cos(outer),
        }
    }

    /// 1 − cos between the axis and a direction, without the cancellation of that difference.
    #[inline]
    fn one_minus_cos(&self, direction: Vec3) -> f32 {
        0.5 * (direction - self.frame.z).length_squared()
    }

    /// The intensity in a direction of travel.
    #[inline]
    pub fn intensity_in(&self, direction: Vec3) -> Spectrum {
        let h = self.one_minus_cos(direction);
        if h >= self.outer {
            return Spectrum::ZERO;
        }
        if h <= self.inner {
            return self.intensity;
        }
        let t = (self.outer - h) / (self.outer - self.inner);
        self.intensity * (t * t * (3.0 - 2.0 * t))
    }

    /// A uniform direction in the outer cone.
    pub fn sample_direction(&self, u: [f32; 2]) -> Vec3 {
        self.frame.to_world(warp::uniform_cone(u, self.outer))
    }

    /// Its density; zero where there is no light.
    #[inline]
    pub fn direction_pdf(&self, direction: Vec3) -> SolidAnglePdf {
        if self.one_minus_cos(direction) >= self.outer {
            return SolidAnglePdf::ZERO;
        }
        warp::uniform_cone_pdf(self.outer)
    }

    /// ∫ of the falloff over the sphere, in sr: the smoothstep averages to one half between the cones.
    pub fn solid_angle(&self) -> f32 {
        PI * (self.inner + self.outer)
    }
}

/// Parallel light.
#[derive(Clone, Copy, Debug)]
pub struct DirectionalLight {
    /// The unit direction of travel.
    pub direction: Vec3,
    /// On a surface that faces it.
    pub irradiance: Spectrum,
}
