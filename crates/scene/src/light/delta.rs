use std::f32::consts::PI;

use caustica_math::elementary::cos;
use caustica_math::{Frame, SolidAnglePdf, Spectrum, Vec3, warp};

/// A point that lights a cone, as [`crate::description::LightKind::Spot`] describes it.
#[derive(Clone, Copy, Debug)]
pub struct SpotLight {
    /// Where it is.
    pub position: Vec3,
    intensity: Spectrum,
    frame: Frame,
    cos_inner: f32,
    cos_outer: f32,
}

impl SpotLight {
    /// From its axis and half angles in degrees.
    pub fn new(position: Vec3, axis: Vec3, intensity: Spectrum, inner: f32, outer: f32) -> Self {
        Self {
            position,
            intensity,
            frame: Frame::from_normal(axis),
            cos_inner: cos(inner.to_radians()),
            cos_outer: cos(outer.to_radians()),
        }
    }

    /// The intensity in a direction of travel.
    #[inline]
    pub fn intensity_in(&self, direction: Vec3) -> Spectrum {
        let c = self.frame.z.dot(direction);
        if c <= self.cos_outer {
            return Spectrum::ZERO;
        }
        if c >= self.cos_inner {
            return self.intensity;
        }
        let t = (c - self.cos_outer) / (self.cos_inner - self.cos_outer);
        self.intensity * (t * t * (3.0 - 2.0 * t))
    }

    /// A uniform direction in the outer cone.
    pub fn sample_direction(&self, u: [f32; 2]) -> Vec3 {
        self.frame.to_world(warp::uniform_cone(u, 1.0 - self.cos_outer))
    }

    /// Its density.
    #[inline]
    pub fn direction_pdf(&self, direction: Vec3) -> SolidAnglePdf {
        // The samples' own rounding must not put them outside of the cone.
        if self.frame.z.dot(direction) < self.cos_outer - 1e-6 {
            return SolidAnglePdf::ZERO;
        }
        warp::uniform_cone_pdf(1.0 - self.cos_outer)
    }

    /// ∫ of the falloff over the sphere, in sr: the smoothstep averages to one half between the cones.
    pub fn solid_angle(&self) -> f32 {
        2.0 * PI * (1.0 - 0.5 * (self.cos_inner + self.cos_outer))
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
