//! Smooth surfaces: Dirac lobes.

use caustica_math::{SolidAnglePdf, Spectrum, Vec3};

use super::fresnel::fresnel_dielectric;
use super::{Scattered, Walk};

/// Mirrors a direction at the shading normal.
#[inline]
pub(super) fn mirrored(v: Vec3) -> Vec3 {
    Vec3::new(-v.x, -v.y, v.z)
}

/// A lobe that only mirrors, on the side of the normal. Mirroring keeps solid angles, so that the
/// coefficients are the same for both walks.
#[inline]
pub(super) fn sample_mirror(reflectance: Spectrum, given: Vec3) -> Option<Scattered> {
    (given.z > 0.0).then(|| Scattered {
        direction: mirrored(given),
        value: reflectance,
        pdf: SolidAnglePdf(1.0),
        reverse_pdf: SolidAnglePdf(1.0),
        delta: true,
    })
}

/// A smooth interface between two dielectrics. It mirrors and refracts, on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    /// Index of refraction on the side away from the normal.
    pub interior_ior: f32,
    /// Index of refraction on the side of the normal. If the two are equal, light goes straight through.
    pub exterior_ior: f32,
    /// Factor on Fresnel's reflectance.
    pub reflectance: Spectrum,
    /// Factor on Fresnel's transmittance.
    pub transmittance: Spectrum,
}

impl Dielectric {
    /// An interface that neither dims nor tints.
    #[inline]
    pub fn new(interior_ior: f32, exterior_ior: f32) -> Self {
        Self { interior_ior, exterior_ior, reflectance: Spectrum::ONE, transmittance: Spectrum::ONE }
    }

    /// `u[2]` chooses reflection with Fresnel's probability.
    #[inline]
    pub(super) fn sample(&self, walk: Walk, given: Vec3, u: [f32; 3]) -> Option<Scattered> {
        let (ior, ior_beyond) = sides(given.z, self.interior_ior, self.exterior_ior)?;
        let cos = given.z.abs();
        let interface = fresnel_dielectric(cos, ior, ior_beyond);
        if u[2] < interface.reflectance {
            return Some(Scattered {
                direction: mirrored(given),
                value: self.reflectance * interface.reflectance,
                pdf: SolidAnglePdf(interface.reflectance),
                reverse_pdf: SolidAnglePdf(interface.reflectance),
                delta: true,
            });
        }
        let eta = ior / ior_beyond;
        let share = 1.0 - interface.reflectance;
        // n²·|cos θ|·dω is conserved through the interface (étendue): this is dω_sampled/dω_given.
        let spread = eta * eta * cos / interface.cos_refracted;
        Some(Scattered {
            direction: Vec3::new(
                -eta * given.x,
                -eta * given.y,
                (-interface.cos_refracted).copysign(-given.z),
            ),
            value: self.transmittance
                * match walk {
                    // (n_camera/n_light)²: radiance shrinks as its beam widens.
                    Walk::FromCamera => share * eta * eta,
                    // The same Dirac lobe by the solid angle of the other direction: the squares cancel.
                    Walk::FromLight => share * cos / interface.cos_refracted,
                },
            pdf: SolidAnglePdf(share),
            reverse_pdf: SolidAnglePdf(share * spread),
            delta: true,
        })
    }
}

/// The indices on the side to which a direction of the cosine `cos` points and on the other side; `None` if
/// it points to neither.
#[inline]
pub(super) fn sides(cos: f32, interior_ior: f32, exterior_ior: f32) -> Option<(f32, f32)> {
    if cos > 0.0 {
        Some((exterior_ior, interior_ior))
    } else if cos < 0.0 {
        Some((interior_ior, exterior_ior))
    } else {
        None
    }
}
