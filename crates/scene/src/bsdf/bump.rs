//! Normals that are not the surface's own.
//!
//! A bump map gives a BSDF another frame. It is the physical orientation that decides what becomes of the normal, as for
//! all scattering: it is mirrored by where the light goes, and dimmed by where it comes from. A walk from the light does
//! not know yet where it goes; it takes one of the two frames by chance, and its density counts both.

use caustica_math::{Frame, SolidAnglePdf, Vec3};

use super::{Bsdf, Evaluated, Scattered, Walk};
use crate::description::BumpRule;

/// The probability with which a walk from the light takes the mirrored normal.
pub const MIRRORED: f32 = 0.125;

/// A normal, and what is done about it. All directions of its functions are in the surface's own shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bump {
    /// Of length one in the surface's shading frame, with z > 0.
    pub normal: Vec3,
    /// What is done about it.
    pub rule: BumpRule,
}

impl Bump {
    /// Whether the normal is mirrored for light that goes to `to_camera`.
    #[inline]
    pub fn is_mirrored(&self, to_camera: Vec3) -> bool {
        self.rule.flips && to_camera.z * to_camera.dot(self.normal) <= 0.0
    }

    /// The BSDF's frame with the normal as it is, or mirrored.
    pub fn frame(&self, mirrored: bool) -> Frame {
        let n = self.normal;
        let normal = if mirrored { Vec3::new(-n.x, -n.y, n.z) } else { n };
        Frame::with_tangent(normal, Vec3::X).unwrap_or_else(|| Frame::from_normal(normal))
    }

    /// The probability with which a walk from the light takes that frame.
    pub fn share(&self, mirrored: bool) -> f32 {
        match (self.rule.flips, mirrored) {
            (false, true) => 0.0,
            (false, false) => 1.0,
            (true, true) => MIRRORED,
            (true, false) => 1.0 - MIRRORED,
        }
    }

    /// The factor on light from `to_light`.
    pub fn shadowing(&self, to_light: Vec3) -> f32 {
        if !self.rule.shadows {
            return 1.0;
        }
        let tan2 = |v: Vec3| (v.x * v.x + v.y * v.y) / (v.z * v.z);
        let alpha2 = (0.125 * tan2(self.normal)).min(1.0);
        2.0 / (1.0 + (1.0 + alpha2 * tan2(to_light)).sqrt())
    }

    /// [`Bsdf::eval`].
    pub fn eval(&self, bsdf: &Bsdf, to_light: Vec3, to_camera: Vec3) -> Evaluated {
        let mirrored = self.is_mirrored(to_camera);
        let frame = self.frame(mirrored);
        let [light, camera] = [to_light, to_camera].map(|d| frame.to_local(d));
        if !(agree(to_light, light) && agree(to_camera, camera)) {
            return Evaluated::default();
        }
        let mut e = bsdf.eval(light, camera);
        if e.value.is_black() {
            // Where a walk finds nothing it ends, and counts as not having gone there.
            return Evaluated::default();
        }
        e.value *= self.shadowing(to_light);
        if self.rule.flips {
            let other = self.frame(!mirrored);
            let [light, camera] = [to_light, to_camera].map(|d| other.to_local(d));
            let by_other = bsdf.eval(light, camera).to_camera_pdf.0 * self.share(!mirrored);
            e.to_camera_pdf = SolidAnglePdf(e.to_camera_pdf.0 * self.share(mirrored) + by_other);
        }
        e
    }

    /// [`Bsdf::sample`]; `u[2]` is always asked for.
    pub fn sample(&self, bsdf: &Bsdf, walk: Walk, given: Vec3, mut u: [f32; 3]) -> Option<Scattered> {
        let mirrored = match walk {
            Walk::FromCamera => self.is_mirrored(given),
            Walk::FromLight => {
                let share = self.share(true);
                let mirrored = u[2] < share;
                u[2] = if mirrored { u[2] / share } else { (u[2] - share) / (1.0 - share) };
                u[2] = u[2].min(caustica_math::ONE_BELOW);
                mirrored
            }
        };
        let frame = self.frame(mirrored);
        let mut s = bsdf.sample(walk, frame.to_local(given), u)?;
        let (inner, direction) = (s.direction, frame.to_world(s.direction));
        s.direction = direction;
        let (to_light, to_camera) = match walk {
            Walk::FromCamera => (direction, given),
            Walk::FromLight => (given, direction),
        };
        if !s.delta {
            let e = self.eval(bsdf, to_light, to_camera);
            (s.value, s.pdf, s.reverse_pdf) = match walk {
                Walk::FromCamera => (e.value, e.to_light_pdf, e.to_camera_pdf),
                Walk::FromLight => (e.value, e.to_camera_pdf, e.to_light_pdf),
            };
            return (s.pdf.0 >= f32::MIN_POSITIVE && !s.value.is_black()).then_some(s);
        }
        let given_agrees = agree(given, frame.to_local(given));
        if !(given_agrees && agree(direction, inner) && self.is_mirrored(to_camera) == mirrored) {
            return None;
        }
        s.value *= self.shadowing(to_light);
        let by_light = if walk == Walk::FromLight { &mut s.pdf } else { &mut s.reverse_pdf };
        by_light.0 *= self.share(mirrored);
        Some(s)
    }
}

/// Whether a direction is on the same side of the surface's own normal and of the other one.
#[inline]
fn agree(own: Vec3, other: Vec3) -> bool {
    own.z * other.z > 0.0
}
