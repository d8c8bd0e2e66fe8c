//! Materials made of others.

use caustica_math::Rgb;
use caustica_scene::Diagnostic;
use caustica_scene::description::{BumpRule, MaterialId, Texture, Wrapper};

use super::class::Class;
use super::context::Context;
use super::fields::Fields;
use super::spectrum::Role;
use super::{bsdf, texture};
use crate::nori::range::Bounds;

/// The wrapper, if the plugin is one.
pub(super) fn read(fields: &mut Fields, cx: &mut Context) -> Result<Option<Wrapper>, Diagnostic> {
    Ok(Some(match fields.plugin() {
        "mask" => {
            let opacity = texture::slot(fields, "opacity", Role::Reflectance, cx)?;
            let [inner] = inner(fields, cx)?;
            Wrapper::Mask { opacity: opacity.unwrap_or(Rgb::splat(0.5).into()), inner }
        }
        "blendbsdf" => {
            let weight = texture::slot(fields, "weight", Role::Reflectance, cx)?;
            let weight = weight.ok_or_else(|| fields.missing("weight", "a number or a texture"))?;
            Wrapper::Blend { weight, inner: inner(fields, cx)? }
        }
        "twosided" => {
            let children = fields.children(Class::Bsdf);
            match children[..] {
                [(_, both)] => {
                    let both = bsdf::read(both, cx)?;
                    Wrapper::TwoSided { front: both, back: both }
                }
                [(_, front), (_, back)] => {
                    Wrapper::TwoSided { front: bsdf::read(front, cx)?, back: bsdf::read(back, cx)? }
                }
                _ => return Err(wrong_number(fields, "one or two bsdfs", children.len())),
            }
        }
        "bumpmap" => {
            let height = fields.any_texture().map(|index| texture::read(index, Role::Index, cx));
            let height = height.ok_or_else(|| fields.error("the bsdf `bumpmap` needs a texture"))??;
            if !matches!(height, Texture::Image { .. }) {
                fields.warn("only bitmaps have a slope; this is none, and it is flat");
            }
            let scale = fields.float("scale", 1.0, Bounds::Finite)?;
            let rule = rule(fields)?;
            let [inner] = inner(fields, cx)?;
            Wrapper::Bump { height, scale, rule, inner }
        }
        "normalmap" => {
            let normals = texture::slot(fields, "normalmap", Role::Index, cx)?;
            let normals = normals.ok_or_else(|| fields.missing("normalmap", "a texture"))?;
            let rule = rule(fields)?;
            let [inner] = inner(fields, cx)?;
            Wrapper::NormalMap { normals, rule, inner }
        }
        _ => return Ok(None),
    }))
}

fn rule(fields: &mut Fields) -> Result<BumpRule, Diagnostic> {
    let usual = BumpRule::default();
    Ok(BumpRule {
        flips: fields.boolean("flip_invalid_normals", usual.flips)?,
        shadows: fields.boolean("use_shadowing_function", usual.shadows)?,
    })
}

/// The materials inside, of which there must be that many.
fn inner<const N: usize>(fields: &mut Fields, cx: &mut Context) -> Result<[MaterialId; N], Diagnostic> {
    let children = fields.children(Class::Bsdf);
    if children.len() != N {
        let wanted = if N == 1 { "one bsdf" } else { "two bsdfs" };
        return Err(wrong_number(fields, wanted, children.len()));
    }
    let mut ids = [MaterialId(0); N];
    for (id, (_, index)) in ids.iter_mut().zip(children) {
        *id = bsdf::read(index, cx)?;
    }
    Ok(ids)
}

fn wrong_number(fields: &Fields, wanted: &str, found: usize) -> Diagnostic {
    fields.error(format!("the {} needs {wanted} inside of it, and has {found}", fields.title()))
}
