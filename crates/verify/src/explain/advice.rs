//! Which paths are noisy, and what helps.

use std::collections::BTreeMap;

use caustica_scene::Scene;

use super::Row;
use super::survey::{Carried, Survey, add_up};
use super::words::{lamp_words, percent, shape_words};
use crate::class::LampEnd;
use crate::outcome::lamp_name;

/// The error that samples are counted for.
const WANTED: f64 = 0.05;

/// Says where most of the noise is, how many samples would be enough, and what else would help.
pub fn told(
    scene: &Scene,
    names: &[String],
    (survey, rows): (&Survey, &[Row]),
    per_sample: f64,
    said: &mut Vec<String>,
) {
    let Some(worst) = rows.iter().max_by(|a, b| a.noise.total_cmp(&b.noise)) else { return };
    if worst.noise == 0.0 {
        said.push("There is no noise: every sample finds the same.".to_owned());
        return;
    }
    let share = if worst.noise >= 0.5 { "Most" } else { "The largest part" };
    said.push(format!(
        "{share} of bdpt's noise ({}) is of {} ({} of the light) from {}. {}",
        percent(worst.noise),
        worst.pattern,
        percent(worst.light),
        source(scene, names, (survey, worst)),
        advice(worst),
    ));
    let samples = (per_sample / WANTED).powi(2).ceil().max(1.0);
    said.push(if samples <= 64.0 {
        format!("That is little noise: {samples} samples a pixel bring the error to {}.", percent(WANTED))
    } else {
        format!("About {} samples a pixel bring the error to {}.", rounded(samples), percent(WANTED))
    });
}

/// The lamp that most of a row's light is from, the mirror or glass that casts it, and the one that it is seen in.
fn source(scene: &Scene, names: &[String], (survey, row): (&Survey, &Row)) -> String {
    let mut sum = Carried::default();
    let own =
        survey.classes.iter().filter(|(c, _)| c.pattern() == row.pattern && lamp_name(c.lamp()) == row.lamp);
    for (_, carried) in own {
        add_up(&mut sum.lamps, &carried.lamps);
        add_up(&mut sum.casters, &carried.casters);
        add_up(&mut sum.seen_in, &carried.seen_in);
    }
    let most = |m: &BTreeMap<u32, f64>| m.iter().max_by(|a, b| a.1.total_cmp(b.1)).map(|m| *m.0);
    let lamp = most(&sum.lamps).map_or_else(|| row.lamp.to_owned(), |l| lamp_words(scene, names, l));
    let over = most(&sum.casters).map(|s| format!(" over {}", shape_words(scene, names, s)));
    let seen = most(&sum.seen_in).map(|s| format!(", seen in {}", shape_words(scene, names, s)));
    lamp + &over.unwrap_or_default() + &seen.unwrap_or_default()
}

/// Who finds a row's paths, and what makes them easier to find.
fn advice(row: &Row) -> String {
    let is = |lamp| lamp_name(lamp) == row.lamp;
    let (scatters, caustic) = (row.pattern.contains('D'), row.pattern.starts_with("LS"));
    let words = match row.strategies.as_slice() {
        _ if !scatters && is(LampEnd::Environment) => {
            "It is the environment itself: samples smooth it and its images."
        }
        _ if !scatters => "It is the lamp itself: samples smooth its edges and its images.",
        ["s=0"] if is(LampEnd::Environment) => {
            "Only eye paths that leave the scene towards it by chance find it: an environment without small bright \
             spots, or a rougher surface in between, makes that likelier; else only samples help."
        }
        ["s=0"] => {
            "Only eye paths that hit the lamp by chance find it: a larger lamp of the same power, or a rougher surface \
             in between, makes that likelier; else only samples help."
        }
        ["t=1"] if is(LampEnd::Collimated) => {
            "Only light paths find what shines along its normals: give the light image samples."
        }
        ["t=1"] => {
            "Only light paths find it: keep the light image, and give it samples; `path` would not find it at all."
        }
        ["inner"] => {
            "Only the joining of both paths' middles finds it: samples help, or a lamp with a size, which eye paths \
             can hit."
        }
        ["s=1"] => "Only next-event estimation finds it: samples help.",
        _ if caustic && is(LampEnd::Surface) => {
            "It is a caustic: samples help, and so does a larger lamp of the same power, or a rougher surface."
        }
        _ if caustic => "It is a caustic: samples help, and so does a rougher surface.",
        _ if row.pattern == "LDE" && is(LampEnd::Environment) => {
            "It is light straight from the environment: samples help."
        }
        _ if row.pattern == "LDE" => "It is light straight from the lamp: samples help.",
        _ => "It is indirect light: samples help.",
    };
    words.to_owned()
}

/// Two figures are enough.
fn rounded(samples: f64) -> String {
    let two: f64 = format!("{samples:.1e}").parse().unwrap_or(samples);
    format!("{two:.0}")
}

#[cfg(test)]
mod tests {
    #[test]
    fn numbers_of_samples_have_two_figures() {
        assert_eq!(
            [65.0, 123.0, 99_949.0, 1.26e9].map(super::rounded),
            ["65", "120", "100000", "1300000000"]
        );
    }
}
