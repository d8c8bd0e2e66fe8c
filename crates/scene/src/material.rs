//! Materials of the flat scene: BSDFs whose textures are still to be looked up.

use std::collections::BTreeMap;

use caustica_math::{Rgb, Spectrum, Vec2, Wavelengths};

use crate::bsdf::{
    Bsdf, Conductor, Dielectric, Diffuse, Facets, Microfacet, Plastic, PlasticColours, Principled,
    PrincipledThin, RoughCoat, RoughConductor, RoughDielectric, RoughPlastic, SmoothCoat, ThinDielectric,
};
use crate::description::{self, Distribution, Material, MaterialKind, Roughness, Scalar, Texture};
use crate::texture::TextureTable;

/// A material with what is worked out of it beforehand.
#[derive(Clone, Copy, Debug)]
pub struct FlatMaterial {
    /// As it is described.
    pub kind: MaterialKind,
    coat: Coat,
}

/// What the coat of a plastic does.
#[derive(Clone, Copy, Debug)]
enum Coat {
    None,
    Smooth(SmoothCoat),
    Rough(RoughCoat),
}

/// Works out what can be beforehand. Rough coats take some milliseconds each, equal ones but once.
pub fn flatten(materials: &[Material]) -> Vec<FlatMaterial> {
    let mut known: BTreeMap<(bool, u32, u32), RoughCoat> = BTreeMap::new();
    let mut coat = |kind: &MaterialKind| match *kind {
        MaterialKind::Plastic { interior_ior, exterior_ior, .. } => {
            Coat::Smooth(SmoothCoat::new(interior_ior / exterior_ior))
        }
        MaterialKind::RoughPlastic { distribution, alpha, interior_ior, exterior_ior, .. } => {
            let eta = interior_ior / exterior_ior;
            let key = (distribution == Distribution::Ggx, alpha.to_bits(), eta.to_bits());
            let made = known.entry(key).or_insert_with(|| RoughCoat::new(distribution, alpha, eta));
            Coat::Rough(*made)
        }
        _ => Coat::None,
    };
    materials.iter().map(|m| FlatMaterial { kind: m.kind, coat: coat(&m.kind) }).collect()
}

/// A point of a surface where materials are looked up.
#[derive(Clone, Copy)]
struct Place<'a> {
    textures: &'a TextureTable<'a>,
    uv: Vec2,
    wavelengths: Wavelengths,
}

impl Place<'_> {
    #[inline]
    fn spectrum(&self, texture: &Texture) -> Spectrum {
        self.textures.spectrum(texture, self.uv, self.wavelengths)
    }

    #[inline]
    fn facets(&self, roughness: &Roughness) -> Facets {
        let alpha = [0, 1].map(|axis| self.textures.number(&roughness.alpha[axis], self.uv));
        Facets::new(roughness.distribution, roughness.shadowing, alpha)
    }

    #[inline]
    fn metal(&self, (eta, k): (Rgb, Rgb), reflectance: &Texture) -> Conductor {
        let w = self.wavelengths;
        Conductor { eta: w.spectrum(eta), k: w.spectrum(k), reflectance: self.spectrum(reflectance) }
    }

    #[inline]
    fn number(&self, scalar: &Scalar) -> f32 {
        self.textures.number(scalar, self.uv)
    }

    #[inline(never)]
    fn principled(&self, p: &description::Principled) -> Principled {
        Principled::new(Principled {
            base_color: self.spectrum(&p.base_color).0,
            roughness: self.number(&p.roughness),
            anisotropic: self.number(&p.anisotropic),
            metallic: self.number(&p.metallic),
            spec_trans: self.number(&p.spec_trans),
            eta: p.eta,
            spec_tint: self.number(&p.spec_tint),
            sheen: self.number(&p.sheen),
            sheen_tint: self.number(&p.sheen_tint),
            flatness: self.number(&p.flatness),
            clearcoat: self.number(&p.clearcoat),
            clearcoat_gloss: self.number(&p.clearcoat_gloss),
        })
    }

    #[inline(never)]
    fn principled_thin(&self, p: &description::PrincipledThin) -> PrincipledThin {
        PrincipledThin::new(PrincipledThin {
            base_color: self.spectrum(&p.base_color).0,
            roughness: self.number(&p.roughness),
            anisotropic: self.number(&p.anisotropic),
            spec_trans: self.number(&p.spec_trans),
            eta: self.number(&p.eta),
            spec_tint: self.number(&p.spec_tint),
            sheen: self.number(&p.sheen),
            sheen_tint: self.number(&p.sheen_tint),
            flatness: self.number(&p.flatness),
            diff_trans: self.number(&p.diff_trans),
        })
    }

    #[inline]
    fn glass(&self, (interior_ior, exterior_ior): (f32, f32), factors: [&Texture; 2]) -> Dielectric {
        let [reflectance, transmittance] = factors.map(|t| self.spectrum(t));
        Dielectric { interior_ior, exterior_ior, reflectance, transmittance }
    }
}

/// The BSDF of a material that is no wrapper, at texture coordinates `uv`.
#[inline(always)]
pub fn bsdf_at(material: &FlatMaterial, textures: &TextureTable<'_>, uv: Vec2, w: Wavelengths) -> Bsdf {
    let at = Place { textures, uv, wavelengths: w };
    match &material.kind {
        MaterialKind::Diffuse { albedo } => Bsdf::Diffuse(Diffuse { albedo: at.spectrum(albedo) }),
        MaterialKind::Mirror { reflectance } => Bsdf::Mirror { reflectance: w.spectrum(*reflectance) },
        MaterialKind::Dielectric { interior_ior, exterior_ior, reflectance, transmittance } => {
            Bsdf::Dielectric(at.glass((*interior_ior, *exterior_ior), [reflectance, transmittance]))
        }
        MaterialKind::RoughDielectric {
            roughness,
            interior_ior,
            exterior_ior,
            reflectance,
            transmittance,
        } => {
            let smooth = at.glass((*interior_ior, *exterior_ior), [reflectance, transmittance]);
            Bsdf::RoughDielectric(RoughDielectric::new(at.facets(roughness), smooth))
        }
        MaterialKind::Conductor { eta, k, reflectance } => Bsdf::Conductor(at.metal((*eta, *k), reflectance)),
        MaterialKind::RoughConductor { roughness, eta, k, reflectance } => {
            let smooth = at.metal((*eta, *k), reflectance);
            Bsdf::RoughConductor(RoughConductor::new(smooth, at.facets(roughness)))
        }
        MaterialKind::Microfacet { alpha, interior_ior, exterior_ior, kd } => {
            Bsdf::Microfacet(Microfacet::new(at.spectrum(kd), *alpha, *interior_ior, *exterior_ior))
        }
        MaterialKind::Plastic { diffuse, reflectance, nonlinear, .. }
        | MaterialKind::RoughPlastic { diffuse, reflectance, nonlinear, .. } => {
            let (diffuse, specular) = (at.spectrum(diffuse), at.spectrum(reflectance));
            let colours = PlasticColours { diffuse, specular, nonlinear: *nonlinear };
            match &material.coat {
                Coat::Smooth(coat) => Bsdf::Plastic(Plastic::new(*coat, colours)),
                Coat::Rough(coat) => Bsdf::RoughPlastic(RoughPlastic::new(coat, colours)),
                Coat::None => Bsdf::Diffuse(Diffuse { albedo: colours.diffuse }),
            }
        }
        MaterialKind::Principled(p) => Bsdf::Principled(at.principled(p)),
        MaterialKind::PrincipledThin(p) => Bsdf::PrincipledThin(at.principled_thin(p)),
        MaterialKind::ThinDielectric { interior_ior, exterior_ior, reflectance, transmittance } => {
            let [r, t] = [reflectance, transmittance].map(|texture| at.spectrum(texture));
            Bsdf::ThinDielectric(ThinDielectric::new((*interior_ior, *exterior_ior), r, t))
        }
        MaterialKind::Null | MaterialKind::Wrapped(_) => Bsdf::Null,
    }
}
