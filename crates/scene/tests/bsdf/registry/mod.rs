//! The one list of BSDFs that every test of BSDFs runs over.

use caustica_math::{Rgb, SampleStream, Spectrum, StreamId, Vec3, Wavelengths, warp};
use caustica_scene::bsdf::{
    Bsdf, Conductor, Dielectric, Diffuse, Facets, Microfacet, Plastic, PlasticColours, Principled,
    PrincipledThin, RoughCoat, RoughConductor, RoughDielectric, RoughPlastic, SmoothCoat, ThinDielectric,
    Walk, metals,
};
use caustica_scene::description::{Distribution, Shadowing};
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
                let bsdf = Bsdf::Dielectric(Dielectric::new(interior_ior, exterior_ior));
                named(format!("dielectric {interior_ior}/{exterior_ior}"), bsdf, (interior_ior, exterior_ior))
            })
            .collect(),
        Some(Bsdf::Dielectric(_)) => glass()
            .flat_map(|(interior, exterior)| {
                let kinds = facets().into_iter().take(if interior == INDICES[0].0 {
                    usize::MAX
                } else {
                    ALPHAS.len()
                });
                kinds.map(move |(roughness, facets)| {
                    let bsdf = RoughDielectric::new(facets, Dielectric::new(interior, exterior));
                    let name = format!("rough dielectric {roughness} {interior}/{exterior}");
                    named(name, Bsdf::RoughDielectric(bsdf), (interior, exterior))
                })
            })
            .collect(),
        Some(Bsdf::RoughDielectric(_)) => vec![opaque("gold", Bsdf::Conductor(metal("Au", colour())))],
        Some(Bsdf::Conductor(_)) => facets()
            .into_iter()
            .map(|(roughness, facets)| {
                let bsdf = RoughConductor::new(metal("Cu", colour()), facets);
                opaque(&format!("rough copper {roughness}"), Bsdf::RoughConductor(bsdf))
            })
            .collect(),
        Some(Bsdf::RoughConductor(_)) => rough()
            .map(|alpha| {
                let bsdf = Microfacet::new(Spectrum([0.1, 0.2, 0.15, 0.0]), alpha, 1.5046, 1.000_277);
                opaque(&format!("microfacet {alpha}"), Bsdf::Microfacet(bsdf))
            })
            .collect(),
        Some(Bsdf::Microfacet(_)) => [false, true].map(|nonlinear| plastic(1.49, colours(nonlinear))).into(),
        Some(Bsdf::Plastic(_)) => [
            ("Beckmann 0.02", RoughCoat::new(Distribution::Beckmann, 0.02, 1.49)),
            ("Beckmann 0.3", RoughCoat::new(Distribution::Beckmann, 0.3, 1.49)),
            ("GGX 0.3", RoughCoat::new(Distribution::Ggx, 0.3, 1.9)),
        ]
        .map(|(name, coat)| {
            let bsdf = RoughPlastic::new(&coat, colours(true));
            opaque(&format!("rough plastic {name}"), Bsdf::RoughPlastic(bsdf))
        })
        .into(),
        Some(Bsdf::RoughPlastic(_)) => principled_examples(),
        Some(Bsdf::Principled(_)) => thin_examples(),
        Some(Bsdf::PrincipledThin(_)) => glass()
            .map(|indices| {
                let bsdf = ThinDielectric::new(indices, Spectrum::ONE, Spectrum::ONE);
                opaque(&format!("thin glass {indices:?}"), Bsdf::ThinDielectric(bsdf))
            })
            .collect(),
        Some(Bsdf::ThinDielectric(_)) => vec![opaque("null", Bsdf::Null)],
        Some(Bsdf::Null) => vec![],
    }
}

/// Plastic of a smooth coat.
pub fn plastic(eta: f32, colours: PlasticColours) -> Example {
    let name = if colours.nonlinear { "nonlinear plastic" } else { "plastic" };
    opaque(name, Bsdf::Plastic(Plastic::new(SmoothCoat::new(eta), colours)))
}

fn colours(nonlinear: bool) -> PlasticColours {
    PlasticColours { diffuse: colour(), specular: Spectrum([0.6, 1.0, 0.8, 0.0]), nonlinear }
}

/// Nothing but a rough base.
pub const PRINCIPLED: Principled = Principled {
    base_color: [0.6, 0.3, 0.2, 0.0],
    roughness: 0.5,
    anisotropic: 0.0,
    metallic: 0.0,
    spec_trans: 0.0,
    eta: 1.5,
    spec_tint: 0.0,
    sheen: 0.0,
    sheen_tint: 0.0,
    flatness: 0.0,
    clearcoat: 0.0,
    clearcoat_gloss: 0.0,
};

/// The same of something thin.
pub const PRINCIPLED_THIN: PrincipledThin = PrincipledThin {
    base_color: PRINCIPLED.base_color,
    roughness: 0.5,
    anisotropic: 0.0,
    spec_trans: 0.0,
    eta: 1.5,
    spec_tint: 0.0,
    sheen: 0.0,
    sheen_tint: 0.0,
    flatness: 0.0,
    diff_trans: 0.0,
};

fn principled_examples() -> Vec<Example> {
    let cloth = Principled { sheen: 0.8, sheen_tint: 0.5, flatness: 0.7, ..PRINCIPLED };
    let metal = Principled { metallic: 0.8, anisotropic: 0.7, spec_tint: 0.5, ..PRINCIPLED };
    let lacquer = Principled { clearcoat: 0.9, metallic: 0.3, ..PRINCIPLED };
    let glass = Principled { spec_trans: 1.0, roughness: 0.6, ..PRINCIPLED };
    let milk = Principled {
        spec_trans: 0.6,
        metallic: 0.2,
        anisotropic: 0.5,
        spec_tint: 0.4,
        eta: 1.33,
        ..PRINCIPLED
    };
    let bubble = Principled { spec_trans: 0.8, clearcoat: 0.5, eta: 0.8, ..PRINCIPLED };
    [
        ("principled", PRINCIPLED),
        ("principled cloth", cloth),
        ("principled metal", metal),
        // The coat is as narrow as that.
        ("principled lacquer 0.1", lacquer),
        ("principled glass", glass),
        ("principled milk", milk),
        ("principled bubble 0.1", bubble),
    ]
    .map(|(name, p)| {
        let indices = if p.spec_trans > 0.0 { (p.eta, 1.0) } else { (1.0, 1.0) };
        named(name.to_owned(), Bsdf::Principled(Principled::new(p)), indices)
    })
    .into()
}

fn thin_examples() -> Vec<Example> {
    let leaf = PrincipledThin { diff_trans: 0.8, sheen: 0.5, flatness: 0.4, ..PRINCIPLED_THIN };
    let film = PrincipledThin {
        spec_trans: 0.7,
        diff_trans: 1.2,
        anisotropic: 0.5,
        spec_tint: 0.3,
        ..PRINCIPLED_THIN
    };
    let pane = PrincipledThin { spec_trans: 1.0, roughness: 0.6, eta: 1.3, ..PRINCIPLED_THIN };
    [("thin", PRINCIPLED_THIN), ("thin leaf", leaf), ("thin film", film), ("thin pane", pane)]
        .map(|(name, p)| opaque(name, Bsdf::PrincipledThin(PrincipledThin::new(p))))
        .into()
}

/// Microfacets of every kind, those of [`ALPHAS`] first.
fn facets() -> Vec<(String, Facets)> {
    use {Distribution::*, Shadowing::*};
    let mut all: Vec<_> = ALPHAS.iter().map(|alpha| (alpha.to_string(), Facets::ggx(*alpha))).collect();
    for (name, distribution, shadowing, alpha) in [
        ("Beckmann 0.02", Beckmann, Separable, [0.02; 2]),
        ("Beckmann 0.3", Beckmann, Correlated, [0.3; 2]),
        ("Beckmann 0.8", Beckmann, Separable, [0.8; 2]),
        ("Beckmann 0.6×0.2", Beckmann, Separable, [0.6, 0.2]),
        ("GGX 0.25×0.8", Ggx, Separable, [0.25, 0.8]),
        ("GGX 0.3×0.02", Ggx, Correlated, [0.3, 0.02]),
    ] {
        all.push((name.to_owned(), Facets::new(distribution, shadowing, alpha)));
    }
    all
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
    // Below the range of normal numbers digits are lost.
    a == b || (a - b).abs() <= relative * a.abs().max(b.abs()) + f32::MIN_POSITIVE
}
