//! What is to be known of a material, with all that is inside of it, before anything is rendered.

use crate::description::{Material, MaterialId, MaterialKind, Scalar, Texture, Wrapper};
use crate::diagnostic::Diagnostic;

/// Materials are not nested deeper.
const DEEPEST: u32 = 64;

/// What a material asks for, and what it may do.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Traits {
    /// Whether it looks at texture coordinates.
    pub uses_uv: bool,
    /// Whether it scatters differently when the surface is turned about its normal.
    pub is_oriented: bool,
    /// Whether it is more than one BSDF in its place: see [`crate::wrapped`].
    pub is_wrapped: bool,
    /// Whether chance decides what it is.
    pub is_mixed: bool,
    /// Whether light can pass from one side to the other.
    pub transmits: bool,
    /// Whether it may have an inside, which is another medium than what is around.
    pub bounds_a_medium: bool,
    /// Whether light that arrives from behind may go on.
    pub has_a_back: bool,
    /// Whether it mirrors or refracts by a Dirac lobe.
    pub is_caster: bool,
}

/// The traits of all materials.
///
/// # Errors
/// Wrappers of materials that do not exist, of themselves, or nested too deep; two-sided materials that transmit.
pub(crate) fn of_all(materials: &[Material]) -> Result<Vec<Traits>, Diagnostic> {
    let mut known = vec![None; materials.len()];
    for i in 0..materials.len() {
        find(i, materials, &mut known, 0)?;
    }
    Ok(known.into_iter().map(Option::unwrap_or_default).collect())
}

fn find(
    index: usize,
    materials: &[Material],
    known: &mut [Option<Traits>],
    depth: u32,
) -> Result<Traits, Diagnostic> {
    if let Some(traits) = known[index] {
        return Ok(traits);
    }
    let material = &materials[index];
    let error = |message: &str| Err(Diagnostic::error(message).at(material.origin.clone()));
    let mut all = of(&material.kind);
    if let MaterialKind::Wrapped(wrapper) = &material.kind {
        if depth == DEEPEST {
            return error("materials are nested more than 64 deep, or one is inside of itself");
        }
        for MaterialId(inner) in wrapper.inner() {
            if inner as usize >= materials.len() {
                return error("a material is made of one that does not exist");
            }
            let inner = find(inner as usize, materials, known, depth + 1)?;
            if matches!(wrapper, Wrapper::TwoSided { .. }) && inner.transmits {
                return error("a two-sided material is made of one that light passes through");
            }
            all = Traits {
                uses_uv: all.uses_uv || inner.uses_uv,
                is_oriented: all.is_oriented || inner.is_oriented,
                is_wrapped: true,
                is_mixed: all.is_mixed || inner.is_mixed,
                transmits: all.transmits || inner.transmits,
                bounds_a_medium: all.bounds_a_medium || inner.bounds_a_medium,
                has_a_back: all.has_a_back || inner.has_a_back,
                is_caster: all.is_caster || inner.is_caster,
            };
        }
    }
    known[index] = Some(all);
    Ok(all)
}

/// Of a material without what is inside of it.
fn of(kind: &MaterialKind) -> Traits {
    let uses_uv = kind.textures().into_iter().any(varies);
    let own = Traits { uses_uv, is_oriented: kind.is_oriented(), ..Traits::default() };
    match kind {
        MaterialKind::Diffuse { .. }
        | MaterialKind::RoughConductor { .. }
        | MaterialKind::Microfacet { .. }
        | MaterialKind::Plastic { .. }
        | MaterialKind::RoughPlastic { .. } => own,
        MaterialKind::Mirror { .. } | MaterialKind::Conductor { .. } => Traits { is_caster: true, ..own },
        MaterialKind::RoughDielectric { .. } | MaterialKind::Principled(_) => {
            let refracts = kind.refracts();
            Traits { transmits: refracts, bounds_a_medium: refracts, has_a_back: refracts, ..own }
        }
        MaterialKind::PrincipledThin(p) => {
            let nothing = Scalar::Constant(0.0);
            Traits { transmits: p.spec_trans != nothing || p.diff_trans != nothing, has_a_back: true, ..own }
        }
        MaterialKind::Dielectric { .. } => {
            Traits { transmits: true, bounds_a_medium: true, has_a_back: true, is_caster: true, ..own }
        }
        MaterialKind::ThinDielectric { .. } => {
            Traits { transmits: true, has_a_back: true, is_caster: true, ..own }
        }
        MaterialKind::Null => Traits { is_wrapped: true, transmits: true, has_a_back: true, ..own },
        MaterialKind::Wrapped(wrapper) => match wrapper {
            Wrapper::Mask { .. } => Traits { is_mixed: true, transmits: true, has_a_back: true, ..own },
            Wrapper::Blend { .. } => Traits { is_mixed: true, ..own },
            Wrapper::TwoSided { .. } => Traits { has_a_back: true, ..own },
            Wrapper::Bump { .. } | Wrapper::NormalMap { .. } => Traits { is_oriented: true, ..own },
        },
    }
}

/// Whether a texture depends on the texture coordinates.
pub(crate) fn varies(texture: &Texture) -> bool {
    !matches!(texture, Texture::Constant(_) | Texture::Attribute { .. })
}
