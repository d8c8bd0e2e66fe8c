//! `<integrator>`.

use caustica_scene::Diagnostic;
use caustica_scene::description::{Integrator, Layer, LayerKind, Technique};

use super::class::Class;
use super::context::Context;
use super::fields::Fields;
use crate::suggest::shorten;

/// What a scene that names none is rendered by.
pub(super) const USUAL: Integrator = Integrator::Path(Technique::Mis);

const INTEGRATORS: &[&str] =
    &["path", "direct", "ptracer", "bdpt", "volpath", "volpathmis", "moment", "aov", "depth"];

/// What has no counterpart, and is close enough to path tracing.
const SHOWN_PATH: &[&str] = &[
    "volpath",
    "volpathmis",
    "volpath_simple",
    "prb",
    "prb_basic",
    "prb_projective",
    "prbvolpath",
    "direct_projective",
    "direct_reparam",
    "prb_reparam",
    "stokes",
    "photonmapper",
    "ppm",
    "sppm",
    "vpl",
    "pssmlt",
    "mlt",
    "erpt",
    "adaptive",
    "irrcache",
    "multichannel",
];

/// What wraps another integrator and shows more than its picture.
const WRAPPERS: &[&str] = &["moment", "aov", "stokes", "adaptive", "irrcache", "multichannel"];

pub(super) fn read(index: usize, cx: &mut Context) -> Result<(), Diagnostic> {
    let mut fields = Fields::new(cx.tree, index);
    let plugin = fields.plugin();
    if WRAPPERS.contains(&plugin) {
        let inner = fields.children(Class::Integrator);
        let is_aov = plugin == "aov";
        if is_aov {
            layers(&mut fields, cx)?;
        }
        if let Some((_, first)) = inner.first() {
            for (other, _) in &inner[1..] {
                fields.warn_at("only the first of the integrators is rendered", &other.origin);
            }
            if !is_aov {
                let title = fields.title();
                fields.warn(format!("the {title} is not supported; what is inside of it is rendered"));
            }
            fields.ignore(&["img"]);
            fields.finish(cx);
            return read(*first, cx);
        }
        if is_aov {
            return layers_alone(fields, cx);
        }
    }
    cx.description.integrator = match plugin {
        "path" => USUAL,
        "direct" => {
            cx.max_depth = Some(2);
            direct(&mut fields)?
        }
        "ptracer" => Integrator::Light,
        "bdpt" => Integrator::Bdpt,
        "depth" => Integrator::Depth,
        known if SHOWN_PATH.contains(&known) => {
            fields.warn(format!("the {} is not supported; `path` is used instead", fields.title()));
            USUAL
        }
        _ => return Err(fields.unknown_plugin(INTEGRATORS)),
    };
    depths(&mut fields, cx)?;
    cx.hides_lamps = fields.boolean("hide_emitters", false)?;
    // How much is done at a time, by which strategies of their own.
    fields.ignore(&[
        "samples_per_pass",
        "block_size",
        "timeout",
        "light_image",
        "sample_direct",
        "strict_normals",
    ]);
    if plugin != "direct" && SHOWN_PATH.contains(&plugin) {
        fields.take_rest();
    }
    fields.finish(cx);
    Ok(())
}

/// The list of `aov`: `NAME:TYPE`, between commas.
fn layers(fields: &mut Fields, cx: &mut Context) -> Result<(), Diagnostic> {
    let Some((list, property)) = fields.string("aovs")? else { return Ok(()) };
    for (i, entry) in list.split(',').map(str::trim).filter(|e| !e.is_empty()).enumerate() {
        if i == Layer::MOST {
            let message = format!("only the first {i} layers are looked at");
            fields.warn_at(message, &property.value_origin);
            break;
        }
        let read = match entry.contains(':') {
            true => entry.parse::<Layer>(),
            false => Err(format!("`{}` is not NAME:TYPE", shorten(entry))),
        };
        match read {
            Ok(layer) if cx.layers.iter().any(|other| other.collides(&layer)) => {
                let message = format!("two layers are called `{}`; the first is written", layer.name);
                fields.warn_at(message, &property.value_origin);
            }
            // As in Mitsuba's images, whose upper edge is at v = 0.
            Ok(layer) => cx.layers.push(Layer { v_down: true, ..layer }),
            Err(why) => fields.warn_at(format!("{why}; it is left out"), &property.value_origin),
        }
    }
    Ok(())
}

/// `aov` with no integrator inside: the picture shows one of its layers.
fn layers_alone(mut fields: Fields, cx: &mut Context) -> Result<(), Diagnostic> {
    let shown = |layer: &Layer| match layer.kind {
        LayerKind::Depth => Some((Integrator::Depth, "the depth")),
        LayerKind::ShadingNormal => Some((Integrator::Normals, "the magnitude of the shading normal")),
        _ => None,
    };
    if cx.layers.is_empty() {
        let error = fields.error("the integrator `aov` has no integrator inside and no layer that is known");
        return Err(error.hint("put an integrator inside, such as `path`, or name layers by `aovs`"));
    }
    let (integrator, what) = cx.layers.iter().find_map(shown).unwrap_or((Integrator::Depth, "the depth"));
    fields.warn(format!("there is no integrator inside of `aov`: the picture shows {what}"));
    cx.description.integrator = integrator;
    fields.finish(cx);
    Ok(())
}

/// The most edges of a path: as here, 1 is lamps seen directly, 2 adds direct light; −1 is no limit.
fn depths(fields: &mut Fields, cx: &mut Context) -> Result<(), Diagnostic> {
    let most = i64::from(u32::MAX);
    match fields.integer("max_depth", -1..=most)? {
        None | Some(-1) => {}
        Some(0) => {
            fields.warn("`max_depth` 0 is a black picture; it is rendered with 1");
            cx.max_depth = Some(1);
        }
        Some(depth) => cx.max_depth = Some(depth as u32),
    }
    cx.roulette_start = fields.integer("rr_depth", 0..=most)?.map(|depth| depth as u32);
    Ok(())
}

/// Numbers of samples of lamps and of materials matter here only where they are zero.
fn direct(fields: &mut Fields) -> Result<Integrator, Diagnostic> {
    let both = fields.integer("shading_samples", 0..=i64::from(u32::MAX))?.unwrap_or(1);
    let mut count = |name| Ok(fields.integer(name, 0..=i64::from(u32::MAX))?.unwrap_or(both));
    let (lamps, materials) = (count("emitter_samples")?, count("bsdf_samples")?);
    match (lamps, materials) {
        (0, 0) => Err(fields.error("the integrator has neither samples of lamps nor of materials")),
        (0, _) => Ok(Integrator::Direct(Technique::Materials)),
        (_, 0) => Ok(Integrator::Direct(Technique::Emitters)),
        _ => Ok(Integrator::Direct(Technique::Mis)),
    }
}
