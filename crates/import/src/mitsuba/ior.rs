//! Indices of refraction by name, as Mitsuba's documentation lists them, and metals.

use caustica_math::Rgb;
use caustica_scene::Diagnostic;
use caustica_scene::bsdf::metals::{METAL_NAMES, metal};

use super::context::Context;
use super::fields::Fields;
use super::spectrum::Role;
use super::texture;
use super::tree::{Value, error};
use crate::nori::range::Bounds;
use crate::suggest::{self, shorten};

const NAMES: [(&str, f32); 23] = [
    ("vacuum", 1.0),
    ("helium", 1.000_036),
    ("hydrogen", 1.000_132),
    ("air", 1.000_277),
    ("carbon dioxide", 1.000_45),
    ("water", 1.333),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.520_45),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.47),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.575),
    ("diamond", 2.419),
];

/// Metals that Mitsuba has measured data for and this renderer has not.
const OTHER_METALS: &[&str] = &[
    "a-C", "AlAs", "AlSb", "CsI", "Cu2O", "CuO", "d-C", "HgTe", "MgO", "Rh", "Se", "SiC", "SnTe", "Ta", "Te",
    "ThF4", "TiC", "TiO2", "VC", "VN",
];

/// An index of refraction, by number or name.
pub(super) fn index(fields: &mut Fields, name: &'static str, default: &str) -> Result<f32, Diagnostic> {
    let known = |text: &str| {
        let text = text.to_ascii_lowercase();
        NAMES.iter().find(|(name, _)| *name == text).map(|(_, ior)| *ior)
    };
    let Some(property) = fields.find(name) else { return Ok(known(default).unwrap_or(1.0)) };
    let Value::String(text) = &property.value else {
        return fields.float(name, 1.0, Bounds::Positive);
    };
    known(text).ok_or_else(|| {
        let names: Vec<&str> = NAMES.iter().map(|(name, _)| *name).collect();
        let message = format!("unknown material `{}`", shorten(text));
        error(message, &property.value_origin).hint(suggest::hint(text, &names))
    })
}

/// The complex index of a metal relative to the outside: by name, or as colours.
pub(super) fn metal_index(fields: &mut Fields, cx: &mut Context) -> Result<(Rgb, Rgb), Diagnostic> {
    let outside = index(fields, "ext_eta", "vacuum")?;
    let name = fields.string("material")?;
    let eta = texture::constant(fields, "eta", Role::Index, cx)?;
    let k = texture::constant(fields, "k", Role::Index, cx)?;
    let (eta, k) = match (name, eta, k) {
        (None, Some(eta), Some(k)) => (eta, k),
        (Some((name, property)), None, None) => {
            let short = name.strip_suffix("_palik").unwrap_or(name);
            match metal(short) {
                Some(metal) => metal,
                None if OTHER_METALS.contains(&short) => {
                    let message = format!("there is no data of `{name}` yet; shown as chromium");
                    fields.warn_at(message, &property.value_origin);
                    metal("Cr").ok_or_else(|| fields.missing("eta", "the color"))?
                }
                None => {
                    let message = format!("unknown metal `{}`", shorten(name));
                    return Err(error(message, &property.value_origin).hint(suggest::hint(name, METAL_NAMES)));
                }
            }
        }
        (None, None, None) => metal("none").ok_or_else(|| fields.missing("material", "the string"))?,
        _ => return Err(fields.error("a metal is given by `material`, or by both `eta` and `k`")),
    };
    Ok((eta * (1.0 / outside), k * (1.0 / outside)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_names_of_the_defaults_are_known() {
        for name in ["bk7", "air", "vacuum"] {
            assert!(NAMES.iter().any(|(known, _)| *known == name));
        }
        assert!(OTHER_METALS.iter().all(|name| metal(name).is_none()));
    }
}
