//! The colours of materials, for layers beside a picture.

use caustica_math::{Spectrum, Vec3, Wavelengths};

use crate::bsdf::fresnel::{fresnel_conductor, fresnel_dielectric};
use crate::description::{MaterialKind, Texture, Wrapper};
use crate::scene::Scene;
use crate::surface::SurfacePoint;
use crate::texture::{TextureTable, grey};

/// So many blends inside of each other are mixed; of more, the heavier part stands for both.
const MOST_MIXED: u32 = 8;

/// A point that is looked at.
struct Look<'a> {
    scene: &'a Scene,
    point: &'a SurfacePoint,
    textures: TextureTable<'a>,
    prev: Vec3,
    wavelengths: Wavelengths,
}

impl Scene {
    /// The colour of the material of a point, seen from the direction `prev`, in [0, 1] but for reflectances above: of
    /// what has a diffuse base, that base's reflectance; of metals and mirrors, the reflectance straight on; of glass, all
    /// that it sends on, and of nothing at all, white. A mask is what it is made of, and a blend the mean of its parts.
    ///
    /// This is what denoisers ask for. Where a material has a diffuse base it is Mitsuba's albedo, too.
    pub fn albedo(&self, point: &SurfacePoint, prev: Vec3, wavelengths: Wavelengths) -> Spectrum {
        let look = Look { scene: self, point, textures: self.textures_at(point), prev, wavelengths };
        look.albedo(self.surfaces().shapes[point.shape as usize].material, false, 0)
    }
}

impl Look<'_> {
    /// Of a material by its index; `turned` is whether wrappers around it turned the surface.
    fn albedo(&self, material: u32, turned: bool, mixed: u32) -> Spectrum {
        let MaterialKind::Wrapped(wrapper) = &self.scene.material(material).kind else {
            return self.base(&self.scene.material(material).kind);
        };
        match wrapper {
            Wrapper::Mask { inner, .. } | Wrapper::Bump { inner, .. } | Wrapper::NormalMap { inner, .. } => {
                self.albedo(inner.0, turned, mixed)
            }
            Wrapper::TwoSided { front, back } => {
                let in_front = (self.point.normal.dot(self.prev) >= 0.0) ^ turned;
                let side = if in_front { front } else { back };
                self.albedo(side.0, turned ^ !in_front, mixed)
            }
            Wrapper::Blend { weight, inner: [first, second] } => {
                let share = grey(self.textures.rgb(weight, self.point.uv)).clamp(0.0, 1.0);
                let part = |inner: u32, share: f32| match share {
                    0.0 => Spectrum::ZERO,
                    _ => self.albedo(inner, turned, mixed + 1) * share,
                };
                match mixed < MOST_MIXED {
                    true => part(first.0, 1.0 - share) + part(second.0, share),
                    false => part(if share > 0.5 { second.0 } else { first.0 }, 1.0),
                }
            }
        }
    }

    fn spectrum(&self, texture: &Texture) -> Spectrum {
        self.textures.spectrum(texture, self.point.uv, self.wavelengths)
    }

    fn base(&self, kind: &MaterialKind) -> Spectrum {
        let interface = |ior: f32, [reflectance, transmittance]: [&Texture; 2], faces: f32| {
            let once = fresnel_dielectric(1.0, 1.0, ior).reflectance;
            // Both faces of a sheet: r + (1 − r)²·r·(1 + r² + …).
            let r = if faces > 1.0 { 2.0 * once / (1.0 + once) } else { once };
            self.spectrum(reflectance) * r + self.spectrum(transmittance) * (1.0 - r)
        };
        match kind {
            MaterialKind::Diffuse { albedo: base }
            | MaterialKind::Microfacet { kd: base, .. }
            | MaterialKind::Plastic { diffuse: base, .. }
            | MaterialKind::RoughPlastic { diffuse: base, .. } => self.spectrum(base),
            MaterialKind::Principled(p) => self.spectrum(&p.base_color),
            MaterialKind::PrincipledThin(p) => self.spectrum(&p.base_color),
            MaterialKind::Mirror { reflectance } => self.wavelengths.spectrum(*reflectance),
            MaterialKind::Conductor { eta, k, reflectance }
            | MaterialKind::RoughConductor { eta, k, reflectance, .. } => {
                let [eta, k] = [eta, k].map(|c| self.wavelengths.spectrum(*c));
                fresnel_conductor(1.0, eta, k) * self.spectrum(reflectance)
            }
            MaterialKind::Dielectric { interior_ior, exterior_ior, reflectance, transmittance }
            | MaterialKind::RoughDielectric {
                interior_ior, exterior_ior, reflectance, transmittance, ..
            } => interface(interior_ior / exterior_ior, [reflectance, transmittance], 1.0),
            MaterialKind::ThinDielectric { interior_ior, exterior_ior, reflectance, transmittance } => {
                interface(interior_ior / exterior_ior, [reflectance, transmittance], 2.0)
            }
            MaterialKind::Null | MaterialKind::Wrapped(_) => Spectrum::ONE,
        }
    }
}
