//! The one list of BSDFs that every test of BSDFs runs over.

// Each test binary uses its own part of this.
#![allow(dead_code)]

use caustica_math::{Rgb, SampleStream, Spectrum, StreamId, Vec3, Wavelengths, warp};
use caustica_scene::bsdf::{
    Bsdf, Conductor, Dielectric, Diffuse, Microfacet, RoughConductor, RoughDielectric, ThinDielectric, Walk,
    metals,
};
use caustica_testkit::seed::seed;

/// The roughnesses that rough surfaces are tested at.
pub const ALPHAS: [f32; 4] = [0.02, 0.1, 0.3, 0.8];

/// Interior and exterior indices that dielectrics are tested with.
pub const INDICES: [(f32, f32); 2] = [(1.5, 1.0), (1.33, 1.7)];

/// Both walks.
pub const WALKS: [Walk; 2] = [Walk::FromCamera, Walk::FromLight];

/// A BSDF and what to call it.
pub struct Example {
    pub name: String,
    pub bsdf: Bsdf,
    /// Interior and exterior index; equal for surfaces that nothing passes.
    pub indices: (f32, f32),
}

impl Example {
    /// The index of refraction on the side to which `v` points.
    pub fn ior(&self, v: Vec3) -> f32 {
        if v.z > 0.0 { self.indices.1 } else { self.indices.0 }
    }
}

/// Examples of every kind of BSDF.
pub fn examples() -> Vec<Example> {
    let mut all = examples_after(None);
    let mut newest = 0;
    while newest < all.len() {
        let next = examples_after(Some(&all[newest].bsdf));
        newest = all.len();
        all.extend(next);
    }
    all
}

/// The examples of the kind that follows the kind of `previous`. The match is exhaustive: a kind that is not
/// in the chain does not compile.
fn examples_after(previous: Option<&Bsdf>) -> Vec<Example> {
    let glass = || INDICES.into_iter();
    let rough = || ALPHAS.into_iter();
    match previous {
        None => vec![opaque("diffuse", Bsdf::Diffuse(Diffuse { albedo: colour() }))],
        Some(Bsdf::Diffuse(_)) => vec![opaque("mirror", Bsdf::Mirror { reflectance: colour() })],
        Some(Bsdf::Mirror { .. }) => glass()
            .map(|(interior_ior, exterior_ior)| {
                let bsdf = Bsdf::Dielectric(Dielectric { interior_ior, exterior_ior });
                named(format!("dielectric {interior_ior}/{exterior_ior}"), bsdf, (interior_ior, exterior_ior))
            })
            .collect(),
        Some(Bsdf::Dielectric(_)) => glass()
            .flat_map(|(interior, exterior)| {
                rough().map(move |alpha| {
                    let bsdf = Bsdf::RoughDielectric(RoughDielectric::new(alpha, interior, exterior));
                    named(
                        format!("rough dielectric {alpha} {interior}/{exterior}"),
                        bsdf,
                        (interior, exterior),
                    )
                })
            })
            .collect(),
        Some(Bsdf::RoughDielectric(_)) => vec![opaque("gold", Bsdf::Conductor(metal("Au", colour())))],
        Some(Bsdf::Conductor(_)) => rough()
            .map(|alpha| {
                let bsdf = RoughConductor::new(metal("Cu", colour()), alpha);
                opaque(&format!("rough copper {alpha}"), Bsdf::RoughConductor(bsdf))
            })
            .collect(),
        Some(Bsdf::RoughConductor(_)) => rough()
            .map(|alpha| {
                let bsdf = Microfacet::new(Spectrum([0.1, 0.2, 0.15, 0.0]), alpha, 1.5046, 1.000_277);
                opaque(&format!("microfacet {alpha}"), Bsdf::Microfacet(bsdf))
            })
            .collect(),
        Some(Bsdf::Microfacet(_)) => glass()
            .map(|indices| {
                let bsdf = ThinDielectric::new(indices, Spectrum::ONE, Spectrum::ONE);
                opaque(&format!("thin glass {indices:?}"), Bsdf::ThinDielectric(bsdf))
            })
            .collect(),
        Some(Bsdf::ThinDielectric(_)) => vec![opaque("null", Bsdf::Null)],
        Some(Bsdf::Null) => vec![],
    }
}

fn named(name: String, bsdf: Bsdf, indices: (f32, f32)) -> Example {
    Example { name, bsdf, indices }
}

fn opaque(name: &str, bsdf: Bsdf) -> Example {
    named(name.to_owned(), bsdf, (1.0, 1.0))
}

fn colour() -> Spectrum {
    Spectrum([0.9, 0.5, 0.2, 0.0])
}

/// A metal of the table.
pub fn metal(name: &str, reflectance: Spectrum) -> Conductor {
    let (eta, k): (Rgb, Rgb) = metals::metal(name).expect("a known metal");
    let spectrum = |c| Wavelengths::Rgb.spectrum(c);
    Conductor { eta: spectrum(eta), k: spectrum(k), reflectance }
}

/// The unit vector at `degrees` from +z, turned by an angle of no significance.
pub fn at_angle(degrees: f64) -> Vec3 {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    Vec3::new((0.8 * sin) as f32, (-0.6 * sin) as f32, cos as f32)
}

/// The directions on which tests with a given direction run: from +z to grazing, and as many below for
/// surfaces that are not black there.
pub fn given_directions(bsdf: &Bsdf) -> Vec<Vec3> {
    let above = [0.0, 35.0, 62.0, 88.0];
    let below = above.map(|a| 180.0 - a);
    let all = above.into_iter().chain(below.into_iter().filter(|_| bsdf.transmits()));
    all.map(at_angle).collect()
}

/// Random numbers of a test: `stream` tells its parts from one another.
pub fn random(stream: u32) -> SampleStream {
    SampleStream::new(StreamId { seed: seed(20_240), pixel: stream, sample: 0, walk: 0 })
}

/// Three random numbers.
pub fn next_3d(s: &mut SampleStream) -> [f32; 3] {
    let [a, b] = s.next_2d();
    [a, b, s.next_1d()]
}

/// A random direction; one of four is close to grazing.
pub fn random_direction(s: &mut SampleStream) -> Vec3 {
    let v = warp::uniform_sphere(s.next_2d());
    if s.next_1d() < 0.25 {
        let z = v.z * 1e-2;
        let scale = ((1.0 - z * z) / (v.x * v.x + v.y * v.y)).sqrt();
        Vec3::new(v.x * scale, v.y * scale, z)
    } else {
        v
    }
}

/// Whether two numbers agree to a share `relative` of the larger.
pub fn close(a: f32, b: f32, relative: f32) -> bool {
    a == b || (a - b).abs() <= relative * a.abs().max(b.abs())
}
