use std::f32::consts::PI;

use caustica_math::elementary::{asin, cos, sin, tan};
use caustica_math::{Frame, SolidAnglePdf, Spectrum, Vec2, Vec3, warp};

use super::Surroundings;
use super::tree::Cone;
use crate::description::Texture;

/// How the intensity falls from the inner to the outer angle of a spot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Falloff {
    /// By the smoothstep of the cosine.
    Smooth,
    /// In proportion to the angle.
    Linear,
}

/// A point that lights a cone, as [`crate::description::LightKind::Spot`] and
/// [`crate::description::LightKind::LinearSpot`] describe it.
#[derive(Clone, Copy, Debug)]
pub struct SpotLight {
    /// Where it is.
    pub position: Vec3,
    intensity: Spectrum,
    frame: Frame,
    /// 1 − cos of the half angles: cosines of narrow cones all round to one.
    inner: f32,
    outer: f32,
    /// The half angles in radians.
    angles: [f32; 2],
    falloff: Falloff,
    /// What is in front of it, over a square that holds the cone.
    picture: Option<Texture>,
}

impl SpotLight {
    /// From its frame, whose +z is the axis, and half angles in degrees.
    pub fn new(
        (position, frame): (Vec3, Frame),
        intensity: Spectrum,
        degrees: [f32; 2],
        falloff: Falloff,
    ) -> Self {
        let [inner, outer] = degrees.map(|degrees| {
            let s = sin(0.5 * degrees.to_radians());
            2.0 * s * s
        });
        let angles = degrees.map(f32::to_radians);
        Self { position, intensity, frame, inner, outer, angles, falloff, picture: None }
    }

    /// The same, behind a picture.
    pub fn behind(self, picture: Texture) -> Self {
        Self { picture: Some(picture), ..self }
    }

    /// 1 − cos between the axis and a direction, without the cancellation of that difference.
    #[inline]
    fn one_minus_cos(&self, direction: Vec3) -> f32 {
        0.5 * (direction - self.frame.z).length_squared()
    }

    /// The intensity in a direction of travel.
    #[inline]
    pub fn intensity_in(&self, direction: Vec3, around: &Surroundings<'_>) -> Spectrum {
        let h = self.one_minus_cos(direction);
        if h >= self.outer {
            return Spectrum::ZERO;
        }
        let seen = match &self.picture {
            None => self.intensity,
            Some(picture) => {
                self.intensity * around.textures.spectrum(picture, self.place(direction), around.wavelengths)
            }
        };
        if h <= self.inner {
            return seen;
        }
        seen * match self.falloff {
            Falloff::Smooth => {
                let t = (self.outer - h) / (self.outer - self.inner);
                t * t * (3.0 - 2.0 * t)
            }
            Falloff::Linear => {
                let [inner, outer] = self.angles;
                let angle = 2.0 * asin((0.5 * h).min(1.0).sqrt());
                ((outer - angle) / (outer - inner)).clamp(0.0, 1.0)
            }
        }
    }

    /// Where a direction passes the picture.
    fn place(&self, direction: Vec3) -> Vec2 {
        let d = self.frame.to_local(direction);
        let scale = 0.5 / (d.z * tan(self.angles[1]));
        Vec2::new(0.5 + d.x * scale, 0.5 - d.y * scale)
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

    /// The directions of its light.
    pub(super) fn cone(&self) -> Cone {
        Cone { axis: self.frame.z, spread: 0.0, reach: self.angles[1] }
    }

    /// ∫ of the falloff over the sphere, in sr. The smoothstep averages to one half between the cones. With b and c for
    /// the half angles, the linear one is 2π(1 − (sin c − sin b)/(c − b)), written here without cancellation.
    pub fn solid_angle(&self) -> f32 {
        match self.falloff {
            Falloff::Smooth => PI * (self.inner + self.outer),
            Falloff::Linear => {
                let [middle, half] = {
                    let [b, c] = self.angles;
                    [0.5 * (b + c), 0.5 * (c - b)]
                };
                let s = sin(0.5 * middle);
                2.0 * PI * (2.0 * s * s + cos(middle) * one_minus_sinc(half))
            }
        }
    }

    /// Its power in W, as luminance. Behind a picture it is estimated by so many look-ups along each side of the cone.
    pub fn power(&self, around: &Surroundings<'_>) -> f64 {
        let luminance = |s| f64::from(around.wavelengths.luminance(s));
        let bare = f64::from(self.solid_angle()) * luminance(self.intensity);
        let Some(picture) = &self.picture else { return bare };
        let n = 64;
        let one = |i: u32| {
            let u = [i % n, i / n].map(|k| (k as f32 + 0.5) / n as f32);
            luminance(self.intensity_in(self.sample_direction(u), around))
        };
        let cone = 2.0 * f64::from(PI) * f64::from(self.outer);
        let mean: f64 = (0..n * n).map(one).sum::<f64>() / f64::from(n * n);
        // They may all miss what is bright.
        (cone * mean).max(bare * 1e-3 * f64::from(around.textures.mean_luminance(picture)))
    }
}

/// 1 − sin(x)/x.
fn one_minus_sinc(x: f32) -> f32 {
    let x2 = x * x;
    if x2 < 0.5 {
        x2 / 6.0 * (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0 * (1.0 - x2 / 72.0)))
    } else {
        1.0 - sin(x) / x
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
