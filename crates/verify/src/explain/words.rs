//! What is known, in sentences.

use caustica_scene::Scene;
use caustica_scene::bsdf::Bsdf;
use caustica_scene::description::{Integrator, Technique};
use caustica_scene::light::{EnvironmentLight, Light};

use super::missing::Missing;
use super::survey::Survey;
use super::{Question, Row, advice};

/// What is called a lamp in a sentence.
pub fn lamp_words(scene: &Scene, names: &[String], lamp: u32) -> String {
    match scene.lamps().get(lamp) {
        Light::Area(_) => {
            let shape = scene.surfaces().shapes.iter().position(|s| s.light == Some(lamp));
            let name = shape.and_then(|i| names.get(i)).map_or("?", String::as_str);
            format!("the lamp `{name}`")
        }
        Light::Point { position: p, .. } => format!("the point light at ({}, {}, {})", p.x, p.y, p.z),
        Light::Spot(s) => format!("the spot at ({}, {}, {})", s.position.x, s.position.y, s.position.z),
        Light::Projector(p) => {
            let p = p.position();
            format!("the projector at ({}, {}, {})", p.x, p.y, p.z)
        }
        Light::Collimated(_) => "a lamp that shines along its normals".to_owned(),
        Light::Directional(_) => "the directional light".to_owned(),
        Light::Environment(EnvironmentLight::Sky(_)) => "the sky".to_owned(),
        Light::Environment(EnvironmentLight::Sun(_)) => "the sun".to_owned(),
        Light::Environment(_) => "the environment".to_owned(),
    }
}

/// What is called a shape in a sentence, with its material.
pub fn shape_words(scene: &Scene, names: &[String], shape: u32) -> String {
    let name = names.get(shape as usize).map_or("?", String::as_str);
    let point = scene.surfaces().some_point(shape);
    // Of a mixture one part, as good as any.
    let kind = match scene.placed(&point, point.normal, 0.0, caustica_math::Wavelengths::Rgb).bsdf {
        Bsdf::Dielectric(_) => "smooth glass",
        Bsdf::Mirror { .. } => "mirror",
        Bsdf::Conductor(_) => "smooth metal",
        _ => "surface",
    };
    format!("the {kind} `{name}`")
}

/// In whole percents.
pub fn percent(share: f64) -> String {
    if share < 0.005 { "less than 1 %".to_owned() } else { format!("{:.0} %", 100.0 * share) }
}

/// All that is to be said. The last figure is the standard deviation of one sample a pixel over the mean.
pub fn sentences(
    scene: &Scene,
    question: &Question<'_>,
    (survey, rows, missing): (&Survey, &[Row], &[Missing]),
    per_sample: f64,
) -> Vec<String> {
    let mut said = Vec::new();
    if scene.lamps().are_black() {
        return vec![
            "The scene has no light: give a shape an `area` emitter, or add a point or environment light."
                .into(),
        ];
    }
    let place = if question.region.is_some() { "region" } else { "picture" };
    views(scene, survey, (place, missing.is_empty()), &mut said);
    for (lamp, [began, met]) in &survey.emitted {
        let found = survey.classes.values().any(|c| c.lamps.contains_key(lamp));
        if *began >= 256 && *met == 0 && !found {
            said.push(shines_on_nothing(scene, question.names, *lamp));
        }
    }
    depth(question, survey, place, &mut said);
    missing.iter().for_each(|m| said.push(missing_sentence(m, place)));
    reach(question, rows, place, &mut said);
    advice::told(scene, question.names, (survey, rows), per_sample, &mut said);
    if rows.is_empty() && said.is_empty() {
        said.push(format!(
            "No strategy found any light in this {place}, and nothing was found that could be missing: no lamp's light \
             arrives here, or so rarely that more samples are needed to see it (`--spp`)."
        ));
    }
    said
}

fn shines_on_nothing(scene: &Scene, names: &[String], lamp: u32) -> String {
    let why = match scene.lamps().get(lamp) {
        Light::Area(_) => {
            "it faces away from everything. A lamp emits on the side of its normal: reverse its triangles, or turn it"
        }
        Light::Spot(_) | Light::Projector(_) | Light::Collimated(_) => {
            "it points away from everything: turn it"
        }
        Light::Directional(_) => "it shines past everything: check its direction",
        Light::Point { .. } | Light::Environment(_) => "there is nothing that it could shine on",
    };
    format!("No light path from {} meets any surface: {why}.", lamp_words(scene, names, lamp))
}

/// What eye rays meet. The last argument is whether no light is known to be missing.
fn views(scene: &Scene, survey: &Survey, (place, complete): (&str, bool), said: &mut Vec<String>) {
    let v = &survey.views;
    let most = |n: u64| v.rays > 0 && n as f64 >= 0.9 * v.rays as f64;
    if most(v.behind) {
        said.push(
            "Nearly all rays from the camera meet the back of a surface: the camera is inside an object, or the \
             surfaces in view have their normals turned away. Move the camera, or reverse their triangles."
                .into(),
        );
    } else if most(v.inside_glass) {
        said.push(
            "The camera is inside a transparent object: all that it sees is seen through its surface.".into(),
        );
    }
    if survey.light() > 0.0 {
        return;
    }
    if most(v.empty) {
        said.push(format!("The rays through this {place} leave the scene without meeting anything, and no environment shines \
             there."));
    } else if most(v.dark_lamp) {
        said.push(format!(
            "This {place} shows the dark side of a lamp: a lamp emits on the side of its normal."
        ));
    } else if v.mirrors > 0 && most(v.mirrors + v.empty) && complete {
        let why = if scene.lamps().iter().all(Light::is_delta) {
            "lamps without extent are not seen, neither directly nor in mirrors. Give the lamp a size"
        } else {
            "no lamp is to be seen in them"
        };
        said.push(format!("This {place} shows mirrors or glass, and no surface that scatters light: {why}."));
    } else if most(v.black) && !most(v.behind) {
        said.push(format!(
            "This {place} shows surfaces that scatter nothing towards the camera: black ones, or the back of \
             one-sided ones."
        ));
    }
}

/// What a larger depth would add.
fn depth(question: &Question<'_>, survey: &Survey, place: &str, said: &mut Vec<String>) {
    let longer: f64 = survey.longer.values().sum();
    let all = longer + survey.light();
    let (Some(limit), Some(first)) = (question.settings.max_depth, survey.longer.keys().next()) else {
        return;
    };
    if longer > 0.05 * all {
        said.push(format!(
            "At least {} of the light of this {place} comes by paths longer than the {limit} {} allowed (the \
             shortest of them have {first}): raise the depth (`--max-depth`).",
            percent(longer / all),
            if limit == 1 { "edge that is" } else { "edges that are" },
        ));
    }
}

fn missing_sentence(m: &Missing, place: &str) -> String {
    format!(
        "About {} of the light of this {place} is missing: {} from {} over {}, seen in {}. No strategy reaches it: a lamp \
         without extent is not hit by chance, and light paths and eye paths cannot be joined on mirrors or glass. Give the \
         lamp a size, or one of the surfaces some roughness.",
        percent(m.share),
        m.pattern,
        m.lamp,
        m.caster,
        m.seen_in
    )
}

/// What the integrator that was asked for cannot find.
fn reach(question: &Question<'_>, rows: &[Row], place: &str, said: &mut Vec<String>) {
    let name = match question.settings.integrator {
        Integrator::Path(Technique::Mis) => "path",
        Integrator::Path(Technique::Emitters) => "path_ems",
        Integrator::Path(Technique::Materials) => "naive",
        Integrator::Light => "light",
        _ => return,
    };
    let missed: Vec<&Row> = rows.iter().filter(|r| r.missed_by.contains(&name)).collect();
    let share: f64 = missed.iter().map(|r| r.light).sum();
    if let Some(most) = missed.first()
        && share >= 0.01
    {
        said.push(format!(
            "`{name}` cannot reach {} of the light of this {place}, most of it {} from {}: render it by `bdpt`.",
            percent(share),
            most.pattern,
            most.lamp
        ));
    }
}
