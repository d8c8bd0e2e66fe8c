//! Light that no strategy reaches: from a lamp without extent, over mirrors or glass alone, to a surface that is seen
//! over mirrors or glass alone. Light paths and eye paths both arrive there, but cannot be joined. How much it is
//! is estimated by counting what arrives near by (Jensen, "Global Illumination using Photon Maps", 1996), crudely:
//! within a fixed distance.

use std::collections::{BTreeMap, HashMap};

use caustica_math::{Spectrum, Vec3, Wavelengths};
use caustica_render::{Control, available_threads};
use caustica_scene::Scene;
use caustica_scene::description::Crop;
use caustica_transport::{Kernel, Scratch, Settings, Subpaths};
use serde::Serialize;

use super::Question;
use super::survey::Survey;
use super::words::{lamp_words, shape_words};
use crate::class::{LampEnd, PathClass};
use crate::grid::Grid;
use crate::jobs;
use crate::verify::VerifyError;

/// Light that no strategy reaches, by one way.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Missing {
    /// Such as `LS+DS+E`.
    pub pattern: String,
    /// Its share of all light of the region, found and missing; right within a factor of two or so.
    pub share: f64,
    /// The lamp that it is from.
    pub lamp: String,
    /// The first mirror or glass that it meets.
    pub caster: String,
    /// The mirror or glass in which it is seen.
    pub seen_in: String,
}

/// Light that arrived somewhere.
struct Photon {
    at: Vec3,
    normal: Vec3,
    to_light: Vec3,
    flux: Spectrum,
    /// Surface vertices after the lamp, the place itself included, and whether they are D.
    vertices: Vec<bool>,
    lamp: u32,
    caster: u32,
}

/// Distance within which light counts as arriving at a place, relative to the scene's radius.
const NEAR: f32 = 0.012;

/// Samples per pixel whose light paths are kept.
const PASSES: u32 = 24;

/// The most pixels of a pass: of larger pictures, some take part.
const MOST_PIXELS: u64 = 1 << 14;

/// Smaller shares are not told.
const NEGLIGIBLE: f64 = 0.005;

type Cells = HashMap<[i32; 3], Vec<Photon>>;

/// Where the light of a pattern is from, by lamp, caster and what it is seen in.
type Sources = BTreeMap<(u32, u32, u32), f64>;

/// Estimates the missing light of a region.
pub fn estimate(
    scene: &Scene,
    (question, region): (&Question<'_>, Grid),
    survey: &Survey,
    control: &Control,
) -> Result<Vec<Missing>, VerifyError> {
    if !scene.lamps().iter().any(|l| l.is_delta()) {
        return Ok(Vec::new());
    }
    let (_, radius) = scene.bounding_sphere();
    let near = NEAR * radius;
    let settings = Settings { seed: question.settings.seed ^ 0xf00d, ..question.settings.clone() };
    let kernel = Kernel::new(scene, settings);
    let threads = question.threads.unwrap_or_else(available_threads);
    let limit = question.settings.max_depth.unwrap_or(u32::MAX) as usize;
    let mut cells = Cells::new();
    let each = |window: Crop, pass: usize, take: &mut dyn FnMut(&Subpaths<'_>)| -> u64 {
        let mut scratch = Scratch::default();
        let mut count = 0;
        for pixel in some_pixels(window, MOST_PIXELS) {
            take(&kernel.subpaths(pixel, pass as u32, &mut scratch));
            count += 1;
        }
        count
    };
    let shoot = |pass: usize| {
        let mut photons = Vec::new();
        let paths = each(scene.film.window(), pass, &mut |paths| arrivals(scene, paths, &mut photons));
        (photons, paths)
    };
    let mut paths = 0;
    let done = jobs::run((PASSES as usize, threads), control, shoot, |(photons, of_pass)| {
        paths += of_pass;
        for photon in photons {
            cells.entry(cell(photon.at, near)).or_default().push(photon);
        }
    })?;
    if cells.is_empty() && done {
        return Ok(Vec::new());
    }
    let scale = 1.0 / (paths as f64 * std::f64::consts::PI * f64::from(near) * f64::from(near));
    let mut sums: BTreeMap<String, Sources> = BTreeMap::new();
    let gather = |pass: usize| {
        let mut sums: BTreeMap<String, Sources> = BTreeMap::new();
        let looks =
            each(region.window, pass, &mut |paths| gather_at(paths, (&cells, near, limit), &mut sums));
        (sums, looks)
    };
    let mut looks = 0;
    let done = jobs::run((PASSES as usize, threads), control, gather, |(part, of_pass)| {
        looks += of_pass;
        for (pattern, sources) in part {
            let own = sums.entry(pattern).or_default();
            sources.into_iter().for_each(|(k, v)| *own.entry(k).or_default() += v);
        }
    })?;
    if !done {
        return Err(VerifyError::Stopped);
    }
    Ok(told(scene, question, survey, (&sums, scale / looks as f64)))
}

fn told(
    scene: &Scene,
    question: &Question<'_>,
    survey: &Survey,
    (sums, scale): (&BTreeMap<String, Sources>, f64),
) -> Vec<Missing> {
    let all: f64 = sums.values().flat_map(|s| s.values()).sum::<f64>() * scale;
    let total = all + survey.light() / survey.pixel_samples();
    let mut missing: Vec<Missing> = Vec::new();
    for (pattern, sources) in sums {
        for ((lamp, caster, seen), light) in sources {
            let share = light * scale / total;
            if share >= NEGLIGIBLE {
                missing.push(Missing {
                    pattern: pattern.clone(),
                    share,
                    lamp: lamp_words(scene, question.names, *lamp),
                    caster: shape_words(scene, question.names, *caster),
                    seen_in: shape_words(scene, question.names, *seen),
                });
            }
        }
    }
    missing.sort_by(|a, b| b.share.total_cmp(&a.share));
    missing
}

/// At most so many pixels of a window, spread evenly.
fn some_pixels(window: Crop, most: u64) -> impl Iterator<Item = [u32; 2]> {
    let count = |step: u32| u64::from(window.width.div_ceil(step)) * u64::from(window.height.div_ceil(step));
    let step = (1..).find(|step| count(*step) <= most).unwrap_or(u32::MAX) as usize;
    let columns = move || (window.x..window.x + window.width).step_by(step);
    (window.y..window.y + window.height).step_by(step).flat_map(move |y| columns().map(move |x| [x, y]))
}

fn cell(at: Vec3, near: f32) -> [i32; 3] {
    [at.x, at.y, at.z].map(|c| (c / near).floor() as i32)
}

/// Where a light path of a lamp without extent arrives over S first, and never over two D in a row.
fn arrivals(scene: &Scene, paths: &Subpaths<'_>, photons: &mut Vec<Photon>) {
    let Some(emission) = &paths.emission else { return };
    // Next-event estimation finds lamps without extent from the first D, and nothing finds what shines along normals.
    let sought = match LampEnd::of(scene, &emission.point) {
        LampEnd::Dirac => true,
        LampEnd::Collimated => false,
        LampEnd::Surface | LampEnd::Environment => return,
    };
    for (i, v) in paths.light.iter().enumerate() {
        let before = i.checked_sub(1).map(|j| !paths.light[j].delta);
        if v.is_connectible() {
            // Next-event estimation or inner connections reach whatever follows, but by a Dirac lobe.
            if before.unwrap_or(sought) {
                if v.delta {
                    continue;
                }
                return;
            }
            photons.push(Photon {
                at: v.point.position,
                normal: v.point.normal,
                to_light: v.prev,
                flux: v.throughput,
                vertices: paths.light[..i].iter().map(|v| !v.delta).chain([true]).collect(),
                lamp: emission.point.light,
                caster: paths.light[0].point.shape,
            });
        }
    }
}

/// Adds what arrives where an eye path meets its first D, if it comes there over S.
fn gather_at(
    paths: &Subpaths<'_>,
    (cells, near, limit): (&Cells, f32, usize),
    sums: &mut BTreeMap<String, Sources>,
) {
    let Some(i) = paths.eye.iter().position(|v| v.is_connectible() && !v.delta) else { return };
    if i == 0 {
        return;
    }
    let (z, seen) = (&paths.eye[i], paths.eye[0].point.shape);
    let [cx, cy, cz] = cell(z.point.position, near);
    for offset in 0..27 {
        let key = [cx + offset % 3 - 1, cy + offset / 3 % 3 - 1, cz + offset / 9 - 1];
        for p in cells.get(&key).into_iter().flatten() {
            let apart =
                p.at.distance_squared(z.point.position) > near * near || p.normal.dot(z.point.normal) < 0.7;
            if apart || p.vertices.len() + i + 1 > limit {
                continue;
            }
            let Some(scatter) = z.scatter(caustica_scene::bsdf::Walk::FromCamera, p.to_light) else {
                continue;
            };
            let value = z.throughput * scatter.value * p.flux * (1.0 / z.cos(p.to_light).max(1e-6));
            let chain = p.vertices.iter().copied().chain(std::iter::repeat_n(false, i));
            let class = PathClass::new(LampEnd::Dirac, chain);
            let light = f64::from(Wavelengths::Rgb.rgb(value).luminance());
            let source = sums.entry(class.pattern()).or_default();
            *source.entry((p.lamp, p.caster, seen)).or_default() += light;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_large_windows_some_pixels_are_taken() {
        let window = |width, height| Crop { x: 5, y: 7, width, height };
        let all: Vec<_> = some_pixels(window(3, 2), 6).collect();
        assert_eq!(all, [[5, 7], [6, 7], [7, 7], [5, 8], [6, 8], [7, 8]]);
        for (width, height) in [(96, 64), (1920, 1080), (65536, 1), (1, 65536), (65536, 4096)] {
            let count = some_pixels(window(width, height), MOST_PIXELS).count() as u64;
            assert!(
                count <= MOST_PIXELS && count * 4 >= (u64::from(width) * u64::from(height)).min(MOST_PIXELS)
            );
        }
    }
}
