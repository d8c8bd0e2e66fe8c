//! Whether the numbers of materials, textures and film can be rendered with.

use caustica_math::{Filter, Rgb};

use crate::description::{
    Description, FilmSettings, Material, MaterialKind, Roughness, Scalar, Texture, Wrapper,
};
use crate::diagnostic::Diagnostic;

/// Indices of refraction and their ratios lie between one over this and this; roughnesses and the indices of metals
/// between 0 and this. Their fourth powers are still far from the ends of `f32`.
const MOST: f32 = 1e6;

/// The widest filter, in pixels: every splat is added to all pixels that it covers.
const WIDEST_FILTER: f32 = 32.0;

/// Materials and the film's filter; emission is looked at where it is referred to.
pub(crate) fn check(d: &Description) -> Result<(), Diagnostic> {
    d.materials.iter().try_for_each(material)?;
    let emissions = d.shapes.iter().filter_map(|s| Some((s, s.emission.as_ref()?)));
    for (shape, texture) in emissions {
        let placed = |e: Diagnostic| e.at(shape.origin.clone());
        placement(texture, &format!("the emission of {}", shape.name)).map_err(placed)?;
    }
    filter(&d.film)
}

fn material(m: &Material) -> Result<(), Diagnostic> {
    let numbers = match m.kind {
        MaterialKind::Wrapped(Wrapper::Bump { scale, .. }) if !scale.is_finite() => {
            Err(Diagnostic::error("the scale of a bump map is not finite"))
        }
        MaterialKind::Diffuse { .. } | MaterialKind::Null | MaterialKind::Wrapped(_) => Ok(()),
        MaterialKind::Mirror { reflectance } => colour(reflectance),
        MaterialKind::Dielectric { interior_ior, exterior_ior, .. }
        | MaterialKind::ThinDielectric { interior_ior, exterior_ior, .. } => iors(interior_ior, exterior_ior),
        MaterialKind::RoughDielectric { roughness, interior_ior, exterior_ior, .. } => {
            rough(&roughness).and_then(|()| iors(interior_ior, exterior_ior))
        }
        MaterialKind::Microfacet { alpha, interior_ior, exterior_ior, .. } => {
            alpha_fits(alpha).and_then(|()| iors(interior_ior, exterior_ior))
        }
        MaterialKind::Conductor { eta, k, .. } => metal(eta, k),
        MaterialKind::RoughConductor { roughness, eta, k, .. } => {
            rough(&roughness).and_then(|()| metal(eta, k))
        }
        MaterialKind::Plastic { interior_ior, exterior_ior, .. } => iors(interior_ior, exterior_ior),
        MaterialKind::RoughPlastic { alpha, interior_ior, exterior_ior, .. } => {
            alpha_fits(alpha).and_then(|()| iors(interior_ior, exterior_ior))
        }
        MaterialKind::Principled(p) => {
            p.scalars().into_iter().try_for_each(number).and_then(|()| iors(p.eta, 1.0))
        }
        MaterialKind::PrincipledThin(p) => {
            let eta = if let Scalar::Constant(eta) = p.eta { eta } else { 1.0 };
            p.scalars().into_iter().try_for_each(number).and_then(|()| iors(eta, 1.0))
        }
    };
    let textures = m.kind.textures().into_iter().try_for_each(|t| placement(t, "a material's texture"));
    numbers.and(textures).map_err(|e| e.at(m.origin.clone()))
}

fn colour(c: Rgb) -> Result<(), Diagnostic> {
    let error = || Diagnostic::error("a material's colour is negative or not finite");
    c.is_valid().then_some(()).ok_or_else(error)
}

fn iors(interior: f32, exterior: f32) -> Result<(), Diagnostic> {
    let fits = |ior: f32| (1.0 / MOST..=MOST).contains(&ior);
    if fits(interior) && fits(exterior) && fits(interior / exterior) {
        return Ok(());
    }
    let message =
        format!("indices of refraction of {interior} inside and {exterior} outside cannot be rendered");
    let hint =
        format!("they and their ratio must lie between {:e} and {MOST:e}; glass has about 1.5", 1.0 / MOST);
    Err(Diagnostic::error(message).hint(hint))
}

/// A parameter of a principled material.
fn number(scalar: &Scalar) -> Result<(), Diagnostic> {
    match scalar {
        Scalar::Constant(x) if !(0.0..=MOST).contains(x) => {
            let message = format!("a material's parameter of {x} cannot be rendered");
            Err(Diagnostic::error(message).hint("most of them lie between 0 and 1"))
        }
        _ => Ok(()),
    }
}

/// (What a texture holds is kept within bounds where it is looked up.)
fn rough(roughness: &Roughness) -> Result<(), Diagnostic> {
    roughness.alpha.iter().try_for_each(|alpha| match alpha {
        Scalar::Constant(alpha) => alpha_fits(*alpha),
        Scalar::Texture(_) => Ok(()),
    })
}

fn alpha_fits(alpha: f32) -> Result<(), Diagnostic> {
    if (0.0..=MOST).contains(&alpha) {
        return Ok(());
    }
    let message = format!("a roughness of {alpha} cannot be rendered");
    Err(Diagnostic::error(message)
        .hint(format!("it must lie between 0 and {MOST:e}; 0.1 is brushed, 1 is dull")))
}

fn metal(eta: Rgb, k: Rgb) -> Result<(), Diagnostic> {
    let fits = |c: Rgb| c.is_valid() && c.max_channel() <= MOST;
    if fits(eta) && fits(k) {
        return Ok(());
    }
    let message = "a metal's index of refraction is negative, not finite or too large";
    Err(Diagnostic::error(message).hint(format!("η and k must lie between 0 and {MOST:e}")))
}

/// How a texture lies on a surface. (Whether its colours are any is checked elsewhere.)
pub(crate) fn placement(texture: &Texture, what: &str) -> Result<(), Diagnostic> {
    let finite = |pair: &[f32; 2]| pair.iter().all(|x| x.is_finite());
    let message = match texture {
        Texture::Constant(_) => return Ok(()),
        Texture::Checkerboard { delta, scale, shear, .. }
            if finite(delta) && finite(scale) && finite(shear) && !scale.contains(&0.0) =>
        {
            return Ok(());
        }
        Texture::Checkerboard { .. } => {
            "has fields whose size is zero or not finite, or whose offset is not finite"
        }
        Texture::Image { transform: t, .. } if [t.scale, t.shear, t.offset].iter().all(finite) => {
            return Ok(());
        }
        Texture::Image { .. } => "has a scale or an offset that is not finite",
        Texture::Attribute { scale, .. } if scale.is_finite() && *scale >= 0.0 => return Ok(()),
        Texture::Attribute { .. } => "has a scale that is negative or not finite",
    };
    Err(Diagnostic::error(format!("{what} {message}")))
}

fn filter(film: &FilmSettings) -> Result<(), Diagnostic> {
    let radius = film.filter.radius();
    let shape = match film.filter {
        Filter::Box { .. } | Filter::Tent { .. } | Filter::Lanczos { .. } => true,
        Filter::Gaussian { stddev, .. } => stddev > 0.0 && stddev.is_finite(),
        Filter::Mitchell { b, c, .. } => b.is_finite() && c.is_finite(),
    };
    if radius > 0.0 && radius <= WIDEST_FILTER && shape {
        return Ok(());
    }
    let hint = format!("its radius lies between 0 and {WIDEST_FILTER} pixels, and its parameters are finite");
    Err(Diagnostic::error(format!("{:?} is no pixel filter", film.filter)).hint(hint))
}
