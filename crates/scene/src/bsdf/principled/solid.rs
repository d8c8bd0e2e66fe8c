//! The surface of something solid.

use std::f32::consts::FRAC_1_PI;

use caustica_math::{SolidAnglePdf, Spectrum, Vec3, warp};

use super::lobes::{Base, ClearCoat, facets, normal_reflectance, schlick, tint};
use crate::bsdf::Evaluated;
use crate::bsdf::facets::{Facets, half_vector, reflected};
use crate::bsdf::fresnel::fresnel_dielectric;
use crate::bsdf::rough_dielectric::{deflected, transmission, upper};

/// Mitsuba's `principled`. Opaque parts are black on the side away from the normal; from there only what is
/// transmitted is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principled {
    // Plain lanes: the alignment of spectra would cost every BSDF 16 bytes.
    /// Colour of the base, and of what is transmitted and reflected by metal.
    pub base_color: [f32; 4],
    /// Roughness; its square is the α of GGX.
    pub roughness: f32,
    /// How much longer highlights are along the tangent.
    pub anisotropic: f32,
    /// The share of metal.
    pub metallic: f32,
    /// The share of what is not metal that transmits.
    pub spec_trans: f32,
    /// Index of refraction, relative to the outside.
    pub eta: f32,
    /// How much the reflection of what is not metal is coloured.
    pub spec_tint: f32,
    /// Strength of the sheen.
    pub sheen: f32,
    /// How much the sheen is coloured.
    pub sheen_tint: f32,
    /// From diffuse to subsurface scattering.
    pub flatness: f32,
    /// Strength of the clear coat.
    pub clearcoat: f32,
    /// From a dull to a glossy coat.
    pub clearcoat_gloss: f32,
}

impl Principled {
    /// With numbers that are shares kept within [0, 1], and an index that transmission can do with.
    pub fn new(p: Self) -> Self {
        let share = |x: f32| x.clamp(0.0, 1.0);
        let spec_trans = share(p.spec_trans);
        let matched = (p.eta - 1.0).abs() < 1e-3 && spec_trans > 0.0;
        Self {
            base_color: p.base_color,
            roughness: share(p.roughness),
            anisotropic: share(p.anisotropic),
            metallic: share(p.metallic),
            spec_trans,
            eta: if matched { 1.001 } else { p.eta },
            spec_tint: share(p.spec_tint),
            sheen: p.sheen.max(0.0),
            sheen_tint: share(p.sheen_tint),
            flatness: share(p.flatness),
            clearcoat: p.clearcoat.max(0.0),
            clearcoat_gloss: share(p.clearcoat_gloss),
        }
    }

    /// The weights of what is opaque and of what transmits.
    #[inline]
    fn weights(&self) -> (f32, f32) {
        let dielectric = 1.0 - self.metallic;
        (dielectric * (1.0 - self.spec_trans), dielectric * self.spec_trans)
    }

    #[inline]
    fn facets(&self) -> Facets {
        facets(self.roughness, self.anisotropic)
    }

    /// Whether light passes.
    #[inline]
    pub(in crate::bsdf) fn transmits(&self) -> bool {
        self.weights().1 > 0.0
    }

    pub(in crate::bsdf) fn eval(&self, to_light: Vec3, to_camera: Vec3) -> Evaluated {
        if to_light.z == 0.0 || to_camera.z == 0.0 {
            return Evaluated::default();
        }
        let evaluated = match (to_light.z > 0.0, to_camera.z > 0.0) {
            (true, true) => self.eval_front(to_light, to_camera),
            (false, false) => self.eval_back(upper(to_light), upper(to_camera)),
            _ => self.eval_transmission(to_light, to_camera),
        };
        evaluated.unwrap_or_default()
    }

    /// What the front reflects.
    fn eval_front(&self, l: Vec3, c: Vec3) -> Option<Evaluated> {
        let (h, cos) = half_vector(l, c)?;
        let cos = cos.min(1.0);
        let (opaque, glass) = self.weights();
        let facets = self.facets();
        let half_density = 0.5 * facets.density(h);
        let fresnel = fresnel_dielectric(cos, 1.0, self.eta).reflectance;
        let shadowing = facets.shadowing_over_twice_cos(l, c);
        let mut value = self.front_fresnel(fresnel, cos) * (half_density * shadowing);
        // Densities: the lobes' weights add up to `all`.
        let all = 1.0 / self.front_weight();
        let specular = all * (1.0 - glass * (1.0 - fresnel)) * half_density;
        let mut coat = 0.0;
        if self.clearcoat > 0.0 {
            let clear = ClearCoat::new(self.clearcoat_gloss);
            value += Spectrum::splat(0.25 * self.clearcoat * clear.eval(h, cos, [l.z, c.z]) * l.z);
            coat = all * 0.25 * self.clearcoat * clear.density(h) * h.z / (4.0 * cos);
        }
        if opaque > 0.0 {
            let base = Base {
                color: Spectrum(self.base_color),
                weight: opaque,
                roughness: self.roughness,
                // What transmits has its sheen too.
                sheen: self.sheen * (1.0 - self.metallic),
                sheen_tint: self.sheen_tint,
                flatness: self.flatness,
            };
            value += base.eval(l.z, c.z, cos) * l.z;
        }
        let pdf = |given: Vec3, sampled: Vec3| {
            let diffuse = all * opaque * sampled.z * FRAC_1_PI;
            SolidAnglePdf(specular * facets.masking_over_twice_cos(given) + coat + diffuse)
        };
        Some(Evaluated { value, to_light_pdf: pdf(c, l), to_camera_pdf: pdf(l, c) })
    }

    /// Fresnel's reflectance mixed with Schlick's of metal and of tinted glass.
    fn front_fresnel(&self, fresnel: f32, cos: f32) -> Spectrum {
        let color = Spectrum(self.base_color);
        let dielectric = 1.0 - self.metallic;
        let mut value = Spectrum::splat(dielectric * (1.0 - self.spec_tint) * fresnel);
        if self.metallic > 0.0 {
            value += schlick(color, cos, self.eta) * self.metallic;
        }
        if self.spec_tint > 0.0 {
            let normal = tint(color) * normal_reflectance(self.eta);
            value += schlick(normal, cos, self.eta) * (dielectric * self.spec_tint);
        }
        value
    }

    /// What the back reflects of the light that was transmitted.
    fn eval_back(&self, l: Vec3, c: Vec3) -> Option<Evaluated> {
        let (_, glass) = self.weights();
        if glass <= 0.0 {
            return None;
        }
        let (h, cos) = half_vector(l, c)?;
        let facets = self.facets();
        let fresnel = fresnel_dielectric(cos.min(1.0), self.eta, 1.0).reflectance;
        let common = 0.5 * fresnel * facets.density(h);
        Some(Evaluated {
            value: Spectrum::splat(glass * common * facets.shadowing_over_twice_cos(l, c)),
            to_light_pdf: SolidAnglePdf(common * facets.masking_over_twice_cos(c)),
            to_camera_pdf: SolidAnglePdf(common * facets.masking_over_twice_cos(l)),
        })
    }

    fn eval_transmission(&self, l: Vec3, c: Vec3) -> Option<Evaluated> {
        let (_, glass) = self.weights();
        if glass <= 0.0 {
            return None;
        }
        let e = transmission(&self.facets(), (self.eta, 1.0), l, c)?;
        // From the front it is one lobe of several; from the back, all but Fresnel's reflection.
        let front = glass / self.front_weight();
        let (from_light, from_camera) = if l.z > 0.0 { (front, 1.0) } else { (1.0, front) };
        Some(Evaluated {
            value: Spectrum(self.base_color.map(f32::sqrt)) * (glass * e.value[0]),
            to_light_pdf: SolidAnglePdf(from_camera * e.to_light_pdf.get()),
            to_camera_pdf: SolidAnglePdf(from_light * e.to_camera_pdf.get()),
        })
    }

    /// What the weights of the lobes add up to on the front: of the microfacets, the coat and the base.
    #[inline]
    fn front_weight(&self) -> f32 {
        1.0 + 0.25 * self.clearcoat + self.weights().0
    }

    /// `u[2]` chooses the lobe.
    pub(in crate::bsdf) fn sample_direction(&self, given: Vec3, u: [f32; 3]) -> Option<Vec3> {
        let (opaque, glass) = self.weights();
        let front = given.z > 0.0;
        if given.z == 0.0 || !front && glass <= 0.0 {
            return None;
        }
        let mut choice = u[2];
        if front {
            choice *= self.front_weight();
            if choice < opaque {
                return Some(warp::cosine_hemisphere([u[0], u[1]]));
            }
            choice -= opaque;
            if choice < 0.25 * self.clearcoat {
                let h = ClearCoat::new(self.clearcoat_gloss).sample([u[0], u[1]]);
                let v = reflected(given, h);
                // What would go below is no part of the lobe.
                return (given.dot(h) > 0.0 && v.z > 0.0).then_some(v);
            }
            choice -= 0.25 * self.clearcoat;
        }
        let g = upper(given);
        let h = self.facets().sample_visible(g, [u[0], u[1]]);
        let cos = g.dot(h);
        if cos <= 0.0 {
            return None;
        }
        let (ior, ior_beyond) = if front { (1.0, self.eta) } else { (self.eta, 1.0) };
        let interface = fresnel_dielectric(cos.min(1.0), ior, ior_beyond);
        let through = if front { glass } else { 1.0 } * (1.0 - interface.reflectance);
        deflected(given, h, (interface, ior / ior_beyond), choice >= through)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_kept_within_bounds() {
        let wild = Principled {
            base_color: [0.5; 4],
            roughness: -1e30,
            anisotropic: 2.0,
            metallic: -1.0,
            spec_trans: 0.5,
            eta: 1.0,
            spec_tint: 0.5,
            sheen: -1.0,
            sheen_tint: 0.0,
            flatness: 0.0,
            clearcoat: 3.0,
            clearcoat_gloss: 7.0,
        };
        let p = Principled::new(wild);
        assert_eq!((p.roughness, p.anisotropic, p.metallic, p.eta), (0.0, 1.0, 0.0, 1.001));
        assert_eq!((p.sheen, p.clearcoat, p.clearcoat_gloss), (0.0, 3.0, 1.0));
    }
}
