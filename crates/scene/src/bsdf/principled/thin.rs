//! The surface of something thin: a sheet with two equal sides, which bends no light.

use std::f32::consts::FRAC_1_PI;

use caustica_math::{SolidAnglePdf, Spectrum, Vec3, warp};

use super::lobes::{Base, facets, normal_reflectance, schlick, tint};
use crate::bsdf::Evaluated;
use crate::bsdf::facets::{Facets, half_vector, reflected};
use crate::bsdf::fresnel::fresnel_dielectric;
use crate::bsdf::rough_dielectric::upper;

/// Mitsuba's `principledthin`, the same from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipledThin {
    // Plain lanes: the alignment of spectra would cost every BSDF 16 bytes.
    /// Colour of the base and of what is transmitted.
    pub base_color: [f32; 4],
    /// Roughness; its square is the α of GGX.
    pub roughness: f32,
    /// How much longer highlights are along the tangent.
    pub anisotropic: f32,
    /// The share of what mirrors and transmits.
    pub spec_trans: f32,
    /// Index of refraction of the sheet, relative to what is around.
    pub eta: f32,
    /// How much the reflection is coloured.
    pub spec_tint: f32,
    /// Strength of the sheen.
    pub sheen: f32,
    /// How much the sheen is coloured.
    pub sheen_tint: f32,
    /// From diffuse to subsurface scattering.
    pub flatness: f32,
    /// From diffuse reflection (0) to diffuse transmission (2).
    pub diff_trans: f32,
}

impl PrincipledThin {
    /// With numbers that are shares kept within their bounds.
    pub fn new(p: Self) -> Self {
        let share = |x: f32| x.clamp(0.0, 1.0);
        Self {
            base_color: p.base_color,
            roughness: share(p.roughness),
            anisotropic: share(p.anisotropic),
            spec_trans: share(p.spec_trans),
            eta: p.eta.clamp(1e-6, 1e6),
            spec_tint: share(p.spec_tint),
            sheen: p.sheen.max(0.0),
            sheen_tint: share(p.sheen_tint),
            flatness: share(p.flatness),
            diff_trans: 2.0 * share(0.5 * p.diff_trans),
        }
    }

    /// Whether light passes.
    #[inline]
    pub(in crate::bsdf) fn transmits(&self) -> bool {
        self.spec_trans > 0.0 || self.diff_trans > 0.0
    }

    /// The weights, and probabilities, of diffuse reflection and transmission. The rest is half reflected and half
    /// transmitted by microfacets.
    #[inline]
    fn diffuse_weights(&self) -> (f32, f32) {
        let (diffuse, through) = (1.0 - self.spec_trans, 0.5 * self.diff_trans);
        (diffuse * (1.0 - through), diffuse * through)
    }

    #[inline]
    fn facets(&self) -> Facets {
        facets(self.roughness, self.anisotropic)
    }

    /// Those by which light passes twice: less rough, the less it is bent (Burley 2015, figure 15).
    #[inline]
    fn facets_through(&self) -> Facets {
        facets((0.65 * self.eta - 0.35) * self.roughness, self.anisotropic)
    }

    pub(in crate::bsdf) fn eval(&self, to_light: Vec3, to_camera: Vec3) -> Evaluated {
        if to_light.z == 0.0 || to_camera.z == 0.0 {
            return Evaluated::default();
        }
        let passes = (to_light.z > 0.0) != (to_camera.z > 0.0);
        let (l, c) = (upper(to_light), upper(to_camera));
        let Some((h, cos)) = half_vector(l, c) else { return Evaluated::default() };
        let cos = cos.min(1.0);
        let fresnel = fresnel_dielectric(cos, 1.0, self.eta).reflectance;
        let (reflects, through) = self.diffuse_weights();
        let color = Spectrum(self.base_color);
        let (facets, specular, diffuse, share) = if passes {
            let specular = color * (self.spec_trans * (1.0 - fresnel));
            (self.facets_through(), specular, color * (through * FRAC_1_PI), through)
        } else {
            let base = Base {
                color,
                weight: reflects,
                roughness: self.roughness,
                sheen: self.sheen * reflects,
                sheen_tint: self.sheen_tint,
                flatness: self.flatness,
            };
            let specular = self.reflectance(fresnel, cos) * self.spec_trans;
            (self.facets(), specular, base.eval(l.z, c.z, cos), reflects)
        };
        let half_density = 0.5 * facets.density(h);
        let pdf = |given: Vec3, sampled: Vec3| {
            let specular = 0.5 * self.spec_trans * half_density * facets.masking_over_twice_cos(given);
            SolidAnglePdf(specular + share * sampled.z * FRAC_1_PI)
        };
        let shadowing = facets.shadowing_over_twice_cos(l, c);
        Evaluated {
            value: specular * (half_density * shadowing) + diffuse * l.z,
            to_light_pdf: pdf(c, l),
            to_camera_pdf: pdf(l, c),
        }
    }

    /// Fresnel's reflectance mixed with Schlick's, tinted.
    #[inline]
    fn reflectance(&self, fresnel: f32, cos: f32) -> Spectrum {
        let plain = Spectrum::splat(fresnel * (1.0 - self.spec_tint));
        if self.spec_tint == 0.0 {
            return plain;
        }
        let normal = tint(Spectrum(self.base_color)) * normal_reflectance(self.eta);
        plain + schlick(normal, cos, self.eta) * self.spec_tint
    }

    /// `u[2]` chooses the lobe.
    pub(in crate::bsdf) fn sample_direction(&self, given: Vec3, u: [f32; 3]) -> Option<Vec3> {
        if given.z == 0.0 {
            return None;
        }
        let g = upper(given);
        let half = 0.5 * self.spec_trans;
        let (reflects, _) = self.diffuse_weights();
        let by_facets = |facets: Facets| {
            let v = reflected(g, facets.sample_visible(g, [u[0], u[1]]));
            (v.z > 0.0).then_some(v)
        };
        let (v, passes) = if u[2] < half {
            (by_facets(self.facets())?, false)
        } else if u[2] < self.spec_trans {
            (by_facets(self.facets_through())?, true)
        } else {
            (warp::cosine_hemisphere([u[0], u[1]]), u[2] >= self.spec_trans + reflects)
        };
        let below = passes != (given.z < 0.0);
        Some(if below { Vec3::new(v.x, v.y, -v.z) } else { v })
    }
}
