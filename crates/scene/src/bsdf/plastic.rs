//! Plastic: a diffuse base under a dielectric coat, smooth or rough.
//!
//! The base's light meets the coat from below, and what is reflected there meets the base again: ρ/(1 − ρ·r) of what
//! has come in leaves the base, with r the coat's reflectance for diffuse light from below. In `nonlinear` plastic
//! colours are saturated by that; otherwise ρ/(1 − r) stands in its place. Mitsuba's `plastic` and `roughplastic`.

use std::f32::consts::FRAC_1_PI;

use caustica_math::{SolidAnglePdf, Spectrum, Vec3, warp};

use super::coat::{NODES, RoughCoat, SmoothCoat, transmittance};
use super::facets::{Facets, half_vector, reflected};
use super::fresnel::fresnel_dielectric;
use super::specular::mirrored;
use super::{Evaluated, Scattered};
use crate::description::{Distribution, Shadowing};

/// The colours of a plastic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlasticColours {
    /// Reflectance of the base.
    pub diffuse: Spectrum,
    /// Factor on what the coat reflects.
    pub specular: Spectrum,
    /// Whether light that the coat sends back to the base is coloured again.
    pub nonlinear: bool,
}

impl PlasticColours {
    /// What the base gives back of the light that comes through a coat, per solid angle in the coat: divided by n².
    #[inline]
    fn base(&self, internal: f32, eta: f32) -> [f32; 4] {
        let lane = |rho: f32| {
            let again = if self.nonlinear { rho * internal } else { internal };
            // A coat of a huge index lets nothing out.
            rho / ((1.0 - again).max(1e-6) * eta * eta)
        };
        self.diffuse.0.map(lane)
    }

    /// How probable the coat is where it reflects half of the light: by the mean reflectances.
    #[inline]
    fn coat_share(&self) -> f32 {
        let sum = |s: Spectrum| s[0] + s[1] + s[2] + s[3];
        let (specular, diffuse) = (sum(self.specular), sum(self.diffuse));
        if specular > 0.0 { specular / (specular + diffuse) } else { 0.0 }
    }
}

/// The probability that the coat is chosen, if it reflects that share of the light.
#[inline]
fn coat_probability(reflectance: f32, share: f32) -> f32 {
    let (coat, base) = (reflectance * share, (1.0 - reflectance) * (1.0 - share));
    if coat > 0.0 { coat / (coat + base) } else { 0.0 }
}

/// A diffuse base under a smooth coat: a Dirac lobe and a smooth one. Black on the side away from the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plastic {
    // Plain lanes: the alignment of spectra would cost every BSDF 16 bytes.
    base: [f32; 4],
    specular: [f32; 4],
    eta: f32,
    coat_share: f32,
}

impl Plastic {
    /// Plastic of that coat and those colours.
    #[inline]
    pub fn new(coat: SmoothCoat, colours: PlasticColours) -> Self {
        Self {
            base: colours.base(coat.internal, coat.eta),
            specular: colours.specular.0,
            eta: coat.eta,
            coat_share: colours.coat_share(),
        }
    }

    /// Index of refraction of the coat, relative to the outside.
    pub fn eta(&self) -> f32 {
        self.eta
    }

    /// Factor on what the coat reflects.
    pub fn specular(&self) -> Spectrum {
        Spectrum(self.specular)
    }

    /// The probability with which a coat that reflects half of the light is chosen.
    pub fn coat_share(&self) -> f32 {
        self.coat_share
    }

    #[inline]
    fn reflectance(&self, cos: f32) -> f32 {
        fresnel_dielectric(cos, 1.0, self.eta).reflectance
    }

    #[inline]
    pub(super) fn eval(&self, to_light: Vec3, to_camera: Vec3) -> Evaluated {
        if to_light.z <= 0.0 || to_camera.z <= 0.0 {
            return Evaluated::default();
        }
        let (light, camera) = (self.reflectance(to_light.z), self.reflectance(to_camera.z));
        let pdf = |given: f32, cos: f32| {
            SolidAnglePdf((1.0 - coat_probability(given, self.coat_share)) * cos * FRAC_1_PI)
        };
        Evaluated {
            value: Spectrum(self.base) * ((1.0 - light) * (1.0 - camera) * to_light.z * FRAC_1_PI),
            to_light_pdf: pdf(camera, to_light.z),
            to_camera_pdf: pdf(light, to_camera.z),
        }
    }

    /// The Dirac lobe, if `u` chooses it.
    #[inline]
    pub(super) fn sample_coat(&self, given: Vec3, u: f32) -> Option<Scattered> {
        if given.z <= 0.0 {
            return None;
        }
        let reflectance = self.reflectance(given.z);
        let probability = coat_probability(reflectance, self.coat_share);
        // Mirroring keeps cosines, and so the probability, and solid angles.
        (u < probability).then(|| Scattered {
            direction: mirrored(given),
            value: Spectrum(self.specular) * reflectance,
            pdf: SolidAnglePdf(probability),
            reverse_pdf: SolidAnglePdf(probability),
            delta: true,
        })
    }

    /// A direction by the smooth lobe.
    #[inline]
    pub(super) fn sample_base(&self, given: Vec3, u: [f32; 3]) -> Option<Vec3> {
        (given.z > 0.0).then(|| warp::cosine_hemisphere([u[0], u[1]]))
    }
}

/// A diffuse base under a rough coat; black on the side away from the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughPlastic {
    base: [f32; 4],
    specular: [f32; 4],
    alpha: f32,
    eta: f32,
    transmittance: [u16; NODES],
    /// Of 65535.
    coat_share: u16,
    distribution: Distribution,
}

impl RoughPlastic {
    /// Plastic of that coat and those colours.
    #[inline]
    pub fn new(coat: &RoughCoat, colours: PlasticColours) -> Self {
        Self {
            base: colours.base(coat.internal, coat.eta),
            specular: colours.specular.0,
            alpha: coat.alpha,
            eta: coat.eta,
            transmittance: coat.transmittance,
            coat_share: (colours.coat_share() * 65_535.0).round() as u16,
            distribution: coat.distribution,
        }
    }

    #[inline]
    fn facets(&self) -> Facets {
        Facets::new(self.distribution, Shadowing::Separable, [self.alpha; 2])
    }

    /// What passes the coat at an angle, and the probability with which the coat is chosen there.
    #[inline]
    fn coat(&self, cos: f32) -> (f32, f32) {
        let passed = transmittance(&self.transmittance, cos);
        (passed, coat_probability(1.0 - passed, f32::from(self.coat_share) * (1.0 / 65_535.0)))
    }

    pub(super) fn eval(&self, to_light: Vec3, to_camera: Vec3) -> Evaluated {
        if to_light.z <= 0.0 || to_camera.z <= 0.0 {
            return Evaluated::default();
        }
        let ((light, coat_by_light), (camera, coat_by_camera)) =
            (self.coat(to_light.z), self.coat(to_camera.z));
        let mut value = Spectrum(self.base) * (light * camera * to_light.z * FRAC_1_PI);
        let mut to_light_pdf = (1.0 - coat_by_camera) * to_light.z * FRAC_1_PI;
        let mut to_camera_pdf = (1.0 - coat_by_light) * to_camera.z * FRAC_1_PI;
        if let Some((h, cos)) = half_vector(to_light, to_camera) {
            let facets = self.facets();
            let half_density = 0.5 * facets.density(h);
            let fresnel = fresnel_dielectric(cos.min(1.0), 1.0, self.eta).reflectance;
            let shadowing = facets.shadowing_over_twice_cos(to_light, to_camera);
            value += Spectrum(self.specular) * (fresnel * half_density * shadowing);
            to_light_pdf += coat_by_camera * half_density * facets.masking_over_twice_cos(to_camera);
            to_camera_pdf += coat_by_light * half_density * facets.masking_over_twice_cos(to_light);
        }
        Evaluated {
            value,
            to_light_pdf: SolidAnglePdf(to_light_pdf),
            to_camera_pdf: SolidAnglePdf(to_camera_pdf),
        }
    }

    /// `u[2]` chooses the coat.
    pub(super) fn sample_direction(&self, given: Vec3, u: [f32; 3]) -> Option<Vec3> {
        if given.z <= 0.0 {
            return None;
        }
        if u[2] < self.coat(given.z).1 {
            return Some(reflected(given, self.facets().sample_visible(given, [u[0], u[1]])));
        }
        Some(warp::cosine_hemisphere([u[0], u[1]]))
    }
}
