//! What is known, in sentences.

use caustica_scene::Scene;
use caustica_scene::bsdf::Bsdf;
use caustica_scene::description::{Integrator, Technique};
use caustica_scene::light::Light;

use super::missing::Missing;
use super::survey::Survey;
use super::{Question, Row};
use crate::class::LampEnd;
use crate::outcome::lamp_name;

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
        Light::Directional(_) => "the directional light".to_owned(),
        Light::Environment(_) => "the environment".to_owned(),
    }
}

/// What is called a shape in a sentence, with its material.
pub fn shape_words(scene: &Scene, names: &[String], shape: u32) -> String {
    let name = names.get(shape as usize).map_or("?", String::as_str);
    let flat = &scene.surfaces().shapes[shape as usize];
    let primitive = flat.first_primitive;
    let point = match scene.surfaces().sphere(primitive) {
        Some(_) => scene.surfaces().sphere_point(primitive, caustica_math::Vec3::X),
        None => scene.surfaces().triangle_point(primitive, 0.3, 0.3),
    };
    // Of a mixture one part, as good as any.
    let kind = match scene.placed(&point, point.normal, 0.0, caustica_math::Wavelengths::Rgb).bsdf {
        Bsdf::Dielectric(_) => "smooth glass",
        Bsdf::Mirror { .. } => "mirror",
        Bsdf::Conductor(_) => "smooth metal",
        _ => "surface",
    };
    format!("the {kind} `{name}`")
}

fn percent(share: f64) -> String {
    format!("{:.0} %", (100.0 * share).max(1.0))
}

/// All that is to be said.
pub fn sentences(
    scene: &Scene,
    question: &Question<'_>,
    (survey, rows, missing): (&Survey, &[Row], &[Missing]),
) -> Vec<String> {
    let mut said = Vec::new();
    if scene.lamps().are_black() {
        return vec![
            "The scene has no light: give a shape an `area` emitter, or add a point or environment light."
                .into(),
        ];
    }
    let place = if question.region.is_some() { "region" } else { "picture" };
    views(survey, place, &mut said);
    for (lamp, [began, met]) in &survey.emitted {
        if *began >= 32 && *met == 0 {
            let lamp = lamp_words(scene, question.names, *lamp);
            said.push(format!(
                "No light path from {lamp} meets any surface: it faces away from everything. A lamp emits on the side \
                 of its normal: reverse its triangles, or turn it."
            ));
        }
    }
    depth(question, survey, place, &mut said);
    missing.iter().for_each(|m| said.push(missing_sentence(m, place)));
    reach(question, rows, place, &mut said);
    noise(scene, question, (survey, rows), &mut said);
    if rows.is_empty() && said.is_empty() {
        said.push(format!(
            "No strategy found any light in this {place}, and nothing was found that could be missing: no lamp's light \
             arrives here, or so rarely that more samples are needed to see it (`--spp`)."
        ));
    }
    said
}

/// What eye rays meet.
fn views(survey: &Survey, place: &str, said: &mut Vec<String>) {
    let v = &survey.views;
    let most = |n: u64| v.rays > 0 && n as f64 >= 0.9 * v.rays as f64;
    let dark = survey.light() == 0.0;
    if most(v.behind) {
        said.push(
            "Nearly all rays from the camera meet the back of a surface: the camera is inside an object, or the \
             surfaces in view have their normals turned away. Move the camera, or reverse their triangles."
                .into(),
        );
    } else if most(v.inside_glass) {
        said.push("The camera is inside a transparent object: all that it sees is refracted.".into());
    }
    if !dark {
        return;
    }
    if most(v.empty) {
        said.push(format!("The rays through this {place} leave the scene without meeting anything, and no environment shines \
             there."));
    } else if most(v.dark_lamp) {
        said.push(format!(
            "This {place} shows the dark side of a lamp: a lamp emits on the side of its normal."
        ));
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
            "At least {} of the light of this {place} comes by paths longer than the {limit} edges that are allowed \
             (the shortest of them have {first}): raise the depth (`--max-depth`).",
            percent(longer / all)
        ));
    }
}

fn missing_sentence(m: &Missing, place: &str) -> String {
    format!(
        "About {} of the light of this {place} is missing: {} from {} over {}, seen in {}. No strategy reaches it, because \
         light paths and eye paths can only be joined at surfaces that are no mirrors. Give the lamp a size, or one of the \
         surfaces some roughness.",
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

/// Which paths are noisy, and what helps.
fn noise(scene: &Scene, question: &Question<'_>, (survey, rows): (&Survey, &[Row]), said: &mut Vec<String>) {
    let Some(worst) = rows.iter().max_by(|a, b| a.noise.total_cmp(&b.noise)) else { return };
    let of = |r: &Row| {
        let mut lamps = std::collections::BTreeMap::<u32, f64>::new();
        let mut casters = std::collections::BTreeMap::<u32, f64>::new();
        let own =
            survey.classes.iter().filter(|(c, _)| c.pattern() == r.pattern && lamp_name(c.lamp()) == r.lamp);
        for (_, carried) in own {
            carried.lamps.iter().for_each(|(k, v)| *lamps.entry(*k).or_default() += v);
            carried.casters.iter().for_each(|(k, v)| *casters.entry(*k).or_default() += v);
        }
        let most = |m: std::collections::BTreeMap<u32, f64>| {
            m.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).map(|m| m.0)
        };
        let lamp = most(lamps).map_or_else(|| r.lamp.to_owned(), |l| lamp_words(scene, question.names, l));
        let over = most(casters).map(|s| format!(" over {}", shape_words(scene, question.names, s)));
        format!("{}{}", lamp, over.unwrap_or_default())
    };
    let strategies = worst.strategies.join(", ");
    said.push(format!(
        "Most of bdpt's noise ({}) is of {} from {}, which carries {} of the light. It is found by {strategies}.",
        percent(worst.noise),
        worst.pattern,
        of(worst),
        percent(worst.light),
    ));
    let advice = match worst.strategies.as_slice() {
        ["s=0"] => {
            "Only eye paths that hit the lamp by chance find it: a larger lamp of the same power, or a rougher surface in \
             between, makes that likelier; else only samples help."
        }
        ["t=1"] => {
            "Only light paths find it: keep the light image, and give it samples; `path` would not find it at all."
        }
        ["inner"] => "Only the joining of both paths' middles finds it: samples help, or a lamp with a size.",
        ["s=1"] if lamp_name(LampEnd::Dirac) == worst.lamp => {
            "Only next-event estimation finds it: a lamp with a size gives the other strategies a way."
        }
        _ if worst.per_sample < 3.0 => "That is little noise: a few hundred samples make it clean.",
        _ => "Several strategies share it: samples help, and so does a larger lamp.",
    };
    said.push(advice.to_owned());
}
