//! `<scene>`.

use caustica_scene::{Description, Diagnostic};

use crate::files::Folder;

use super::class::Class;
use super::context::{Context, Warnings};
use super::fields::Fields;
use super::test::{self, SceneTest};
use super::tree::{Object, Place};
use super::{camera, emitter, integrator, shape};
use crate::suggest;

/// Samplers of Nori and its forks other than the independent one.
const OTHER_SAMPLERS: &[&str] = &[
    "stratified",
    "halton",
    "hammersley",
    "sobol",
    "adaptive",
    "ldsampler",
    "lowdiscrepancy",
    "multijitter",
    "multijittered",
    "correlated",
    "orthogonal",
    "prime_sampler",
];

/// The root of a file: a scene, tests, or both.
pub(super) fn read_file(
    object: &Object,
    place: Place,
    folder: Folder<'_>,
    warnings: &mut Warnings,
) -> Result<(Option<Description>, Vec<SceneTest>), Diagnostic> {
    let mut tests = Vec::new();
    for child in object.children.iter().filter(|c| c.class == Class::Test) {
        tests.push(test::read(child, place, folder, warnings)?);
    }
    // A scene that holds nothing but tests is only their wrapping.
    let only_tests = !tests.is_empty() && tests.len() == object.children.len();
    let mut context = Context::new(place, folder, warnings);
    let mut fields = Fields::new(object, place);
    fields.children(Class::Test);
    if only_tests {
        fields.finish(&mut context)?;
        return Ok((None, tests));
    }
    read_fields(fields, &mut context)?;
    Ok((Some(context.description), tests))
}

/// A scene inside of a test.
pub(super) fn read(
    object: &Object,
    place: Place,
    folder: Folder<'_>,
    warnings: &mut Warnings,
) -> Result<Description, Diagnostic> {
    let mut context = Context::new(place, folder, warnings);
    read_fields(Fields::new(object, place), &mut context)?;
    Ok(context.description)
}

fn read_fields(mut fields: Fields, cx: &mut Context) -> Result<(), Diagnostic> {
    let camera = fields.child(Class::Camera)?.ok_or_else(|| fields.error("the scene has no camera"))?;
    let integrator =
        fields.child(Class::Integrator)?.ok_or_else(|| fields.error("the scene has no integrator"))?;
    let sampler = fields.child(Class::Sampler)?;
    camera::read(camera, cx)?;
    cx.description.integrator = integrator::read(integrator, cx)?;
    if let Some(sampler) = sampler {
        read_sampler(sampler, cx)?;
    }
    for mesh in fields.children(Class::Mesh) {
        shape::read(mesh, cx)?;
    }
    for light in fields.children(Class::Emitter) {
        emitter::read_light(light, cx)?;
    }
    fields.finish(cx)
}

fn read_sampler(object: &Object, cx: &mut Context) -> Result<(), Diagnostic> {
    let mut fields = Fields::new(object, cx.place);
    match object.plugin.as_str() {
        "independent" => {}
        known if OTHER_SAMPLERS.contains(&known) => {
            let message = format!("the sampler `{known}` is not supported; `independent` is used instead");
            cx.warn(message, &object.plugin_range);
        }
        unknown => {
            let error = fields.unknown_plugin(&["independent"]);
            return Err(match suggest::nearest(unknown, OTHER_SAMPLERS.iter().copied()) {
                Some(near) => error.hint(format!("did you mean `{near}`?")),
                None => error,
            });
        }
    }
    if let Some(samples) = fields.integer(&["sampleCount"], 1..=i64::from(u32::MAX))? {
        cx.description.samples = samples as u32;
    }
    fields.finish(cx)
}
