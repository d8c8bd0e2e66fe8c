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

/// What else Mitsuba has measured indices of, η and k for the three primaries: data of the SOPRA and luxpop collections and
/// of Palik's "Handbook of Optical Constants of Solids", Academic Press 1985, averaged as Mitsuba does. (Some tables
/// do not reach all wavelengths; what is beyond their ends counts as zero there.)
#[rustfmt::skip]
const MORE: [(&str, [f32; 3], [f32; 3]); 22] = [
    ("AlAs", [3.6053, 3.2329, 2.2163], [0.00067944, 0.0, 0.0075127]),
    ("CsI", [2.1449, 1.7023, 1.6624], [0.0, 0.0, 0.0]),
    ("Cu2O", [3.5518, 2.9499, 2.7519], [0.11421, 0.1939, 0.60613]),
    ("CuO", [3.2475, 2.4478, 2.2102], [0.52109, 0.57003, 0.72218]),
    ("HgTe", [4.779, 3.2312, 2.6599], [1.6316, 1.5808, 1.7293]),
    ("MgO", [2.0896, 1.6507, 1.5949], [0.0, 0.0, 0.0]),
    ("Rh", [2.5858, 1.8602, 1.5543], [6.7823, 4.703, 3.9761]),
    ("Se", [4.0583, 2.8429, 2.8209], [0.75405, 0.63844, 0.52181]),
    ("Se-e", [5.7228, 4.1657, 4.0813], [0.87114, 1.1052, 1.5653]),
    ("SiC", [3.1723, 2.526, 2.4794], [7.5377e-7, 0.0, 1.0193e-5]),
    ("SnTe", [4.5242, 1.9816, 1.2816], [0.0, 0.0, 0.0]),
    ("Ta", [2.0627, 2.3929, 2.6279], [2.4084, 1.7415, 1.947]),
    ("Te", [7.3902, 4.4821, 2.6371], [3.256, 3.5271, 3.2921]),
    ("Te-e", [7.5089, 4.2964, 2.37], [5.5839, 4.9472, 3.9976]),
    ("ThF4", [1.8307, 1.4422, 1.3876], [0.0, 0.0, 0.0]),
    ("TiC", [3.7005, 2.8374, 2.5823], [3.2656, 2.3516, 2.1728]),
    ("TiO2", [3.4566, 2.8017, 2.9052], [0.00010526, 0.0, 0.00065289]),
    ("TiO2-e", [3.1066, 2.5132, 2.5824], [2.9752e-5, 0.0, 0.0001827]),
    ("VC", [3.6576, 2.7527, 2.5327], [3.0683, 2.1987, 1.9632]),
    ("VN", [2.8656, 2.1192, 1.9401], [3.0322, 2.0561, 1.6163]),
    ("a-C", [2.944, 2.2271, 1.9682], [0.88746, 0.7993, 0.81529]),
    ("d-C", [2.7087, 2.3188, 2.2289], [0.0, 0.0, 0.0]),
];

/// What Mitsuba has a table of that ends within the visible light, and from which it makes no red at all.
const OTHER_METALS: &[&str] = &["AlSb"];

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

fn more(name: &str) -> Option<(Rgb, Rgb)> {
    let (_, eta, k) = MORE.iter().find(|m| m.0 == name)?;
    Some((Rgb(*eta), Rgb(*k)))
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
            match metal(short).or_else(|| more(short)) {
                Some(metal) => metal,
                None if OTHER_METALS.contains(&short) => {
                    let message = format!("there is no data of `{name}`; shown as chromium");
                    fields.warn_at(message, &property.value_origin);
                    metal("Cr").ok_or_else(|| fields.missing("eta", "the color"))?
                }
                None => {
                    let message = format!("unknown metal `{}`", shorten(name));
                    let more = MORE.iter().map(|(name, ..)| *name);
                    let names: Vec<&str> = METAL_NAMES.iter().copied().chain(more).collect();
                    return Err(error(message, &property.value_origin).hint(suggest::hint(name, &names)));
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
        assert!(OTHER_METALS.iter().all(|name| metal(name).or(more(name)).is_none()));
        assert!(
            MORE.iter()
                .all(|(name, eta, k)| metal(name).is_none() && Rgb(*eta).is_valid() && Rgb(*k).is_valid())
        );
        assert!(more("TiO2").is_some());
    }
}
