//! `<integrator>`.

use caustica_math::Rgb;
use caustica_scene::Diagnostic;
use caustica_scene::description::{Integrator, Technique};

use super::context::Context;
use super::fields::Fields;
use super::range::{Bounds, Radiometry};
use super::tree::Object;

const INTEGRATORS: &[&str] = &[
    "normals",
    "depth",
    "ao",
    "av",
    "simple",
    "directional",
    "whitted",
    "direct",
    "direct_mats",
    "direct_ems",
    "direct_mis",
    "naive",
    "path",
    "path_mats",
    "path_ems",
    "path_mis",
    "light",
    "bdpt",
    "bidirectional",
];
const UNSUPPORTED: &[&str] = &["photonmapper"];

pub(super) fn read(object: &Object, cx: &mut Context) -> Result<Integrator, Diagnostic> {
    let mut fields = Fields::new(object, cx.place);
    let integrator = match object.plugin.as_str() {
        "normals" => Integrator::Normals,
        "depth" => Integrator::Depth,
        "ao" => Integrator::Ao,
        "av" => {
            let length = fields.float_if_any(&["length"], Bounds::PositiveOrInfinite)?;
            Integrator::Av { length: length.ok_or_else(|| fields.missing("length", "the float"))? }
        }
        "simple" => {
            let position = fields.point(&["position"])?;
            let position = position.ok_or_else(|| fields.missing("position", "the point"))?;
            let energy = fields.color(&["energy"], Radiometry::Light)?;
            Integrator::Simple {
                position,
                energy: energy.ok_or_else(|| fields.missing("energy", "the color"))?,
            }
        }
        "directional" => {
            let direction = fields.direction(&["direction"])?;
            let direction = direction.ok_or_else(|| fields.missing("direction", "the vector"))?;
            let irradiance = fields.color_or_float(&["radiance", "irradiance"], Radiometry::Light)?;
            Integrator::Directional { direction, irradiance: irradiance.unwrap_or(Rgb::WHITE) }
        }
        "whitted" => Integrator::Whitted,
        "direct_mats" => Integrator::Direct(Technique::Materials),
        "direct_ems" => Integrator::Direct(Technique::Emitters),
        "direct" | "direct_mis" => Integrator::Direct(Technique::Mis),
        "naive" | "path_mats" => Integrator::Path(Technique::Materials),
        "path_ems" => Integrator::Path(Technique::Emitters),
        "path" | "path_mis" => Integrator::Path(Technique::Mis),
        "light" => Integrator::Light,
        "bdpt" | "bidirectional" => Integrator::Bdpt,
        known if UNSUPPORTED.contains(&known) => return Err(fields.unsupported()),
        _ => return Err(fields.unknown_plugin(INTEGRATORS)),
    };
    fields.finish(cx)?;
    Ok(integrator)
}
