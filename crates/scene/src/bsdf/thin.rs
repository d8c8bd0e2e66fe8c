//! Thin sheets of glass.

use caustica_math::{SolidAnglePdf, Spectrum, Vec3};

use super::Scattered;
use super::fresnel::fresnel_dielectric;
use super::specular::mirrored;

/// Two smooth interfaces so near to each other that light seems to pass straight through. The same on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinDielectric {
    // Plain lanes: the alignment of spectra would cost every BSDF 16 bytes.
    reflectance: [f32; 4],
    transmittance: [f32; 4],
    /// Index of the sheet.
    pub interior_ior: f32,
    /// Index of what is around it.
    pub exterior_ior: f32,
}

impl ThinDielectric {
    /// A sheet of those indices, with factors on what it reflects and on what it lets through.
    pub fn new(
        (interior_ior, exterior_ior): (f32, f32),
        reflectance: Spectrum,
        transmittance: Spectrum,
    ) -> Self {
        Self { reflectance: reflectance.0, transmittance: transmittance.0, interior_ior, exterior_ior }
    }

    /// The factors on what is reflected and on what is let through.
    pub fn factors(&self) -> [Spectrum; 2] {
        [Spectrum(self.reflectance), Spectrum(self.transmittance)]
    }

    /// `u[2]` chooses reflection with the sheet's reflectance. Neither lobe changes solid angles, so that the
    /// coefficients are the same for both walks.
    #[inline]
    pub(super) fn sample(&self, given: Vec3, u: [f32; 3]) -> Option<Scattered> {
        if given.z == 0.0 {
            return None;
        }
        // All orders of reflection within the sheet: R + T²R + T²R³ + … = 2R/(1 + R), if nothing is absorbed.
        let once = fresnel_dielectric(given.z.abs(), self.exterior_ior, self.interior_ior).reflectance;
        let reflected = 2.0 * once / (1.0 + once);
        let [reflectance, transmittance] = self.factors();
        let (direction, factor, share) = if u[2] < reflected {
            (mirrored(given), reflectance, reflected)
        } else {
            (-given, transmittance, 1.0 - reflected)
        };
        let pdf = SolidAnglePdf(share);
        Some(Scattered { direction, value: factor * share, pdf, reverse_pdf: pdf, delta: true })
    }
}

/// Nothing at all: light passes straight through, but along the horizon.
#[inline]
pub(super) fn sample_null(given: Vec3) -> Option<Scattered> {
    let one = SolidAnglePdf(1.0);
    let passed =
        Scattered { direction: -given, value: Spectrum::ONE, pdf: one, reverse_pdf: one, delta: true };
    (given.z != 0.0).then_some(passed)
}
