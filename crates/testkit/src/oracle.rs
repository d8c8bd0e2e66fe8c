//! What a path's contribution and weight ought to be, worked out from the path integral alone.
//!
//! Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, chapters 8 and 10. Number the
//! vertices x₀ (lamp) to x_k (camera). The path's measured contribution is
//!
//! f(x) = Lₑ(x₀→x₁) · ∏ⱼ G(xⱼ, xⱼ₊₁) · ∏ⱼ f(xⱼ)·|cos_s|/|cos_g| · Wₑ(x_{k−1}→x_k)
//!
//! with scattering taken as light travels, both cosines on the light's side, and geometric normals in G. A vertex
//! at infinity is measured by direction: its edge has no 1/d² and no cosine there. Strategy s = i makes the path
//! with a density pᵢ(x), in the product of the vertices' own measures, and tries nᵢ times: once, or for i = k as
//! often as the window has pixels, or for 2 ≤ i < k with as many light paths as pixels share. Its estimate must be
//! f/(nᵢ·pᵢ), its weight (nᵢ·pᵢ)^β/Σ(nⱼ·pⱼ)^β.
//!
//! The point on the lens has the same density in every strategy and is left out of both f and pᵢ. So are
//! Dirac distributions: each smooth surface puts one δ(to_light) into f and into every density, and what stands
//! here is its coefficient.
//!
//! Everything is computed from positions in `f64`, from the evaluation functions of BSDFs, lamps and cameras.
//! No code is shared with the transport crate, nor with the smooth surfaces.

mod film;
mod scattering;

use caustica_math::{Spectrum, Vec3, Wavelengths};
use caustica_scene::Scene;
use caustica_scene::camera::{CameraPoint, Joins};
use caustica_scene::light::{Anchor, EmissionPdf, LightPoint};
use caustica_scene::surface::SurfacePoint;
use caustica_transport::vertex::Vertex;
use caustica_transport::{Contribution, Heuristic, Strategy, StrategySet};

use film::film_density;
use scattering::{Scattering, scatter};

type Vector = [f64; 3];

fn wide(v: Vec3) -> Vector {
    [v.x.into(), v.y.into(), v.z.into()]
}

fn narrow(v: Vector) -> Vec3 {
    Vec3::new(v[0] as f32, v[1] as f32, v[2] as f32)
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn plus(a: Vector, b: Vector, k: f64) -> Vector {
    [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]]
}

fn distance(a: Vector, b: Vector) -> f64 {
    let d = plus(a, b, -1.0);
    dot(d, d).sqrt()
}

/// The lanes of a spectrum that carry light.
pub fn lanes(s: Spectrum) -> Vector {
    [s[0].into(), s[1].into(), s[2].into()]
}

/// One vertex of the full path.
struct Node<'a> {
    /// Position or, at infinity, the direction towards it.
    at: Vector,
    infinite: bool,
    /// Geometric normal, on a surface.
    normal: Option<Vector>,
    /// By how much rays start off it.
    offset: f32,
    /// What scatters there, and whether by a Dirac lobe; nothing at the two ends.
    surface: Option<(&'a Vertex, bool)>,
}

impl Node<'_> {
    /// The unit direction to another vertex, and 1/d² (one where a vertex is at infinity).
    fn to(&self, other: &Self) -> (Vector, f64) {
        if other.infinite {
            return (other.at, 1.0);
        }
        if self.infinite {
            return (self.at.map(|c| -c), 1.0);
        }
        let d = plus(other.at, self.at, -1.0);
        let squared = dot(d, d);
        (d.map(|c| c / squared.sqrt()), 1.0 / squared)
    }

    /// |cos| to the geometric normal; one where there is none.
    fn cos(&self, direction: Vector) -> f64 {
        self.normal.map_or(1.0, |n| dot(n, direction).abs())
    }
}

/// The edge from xⱼ to xⱼ₊₁.
struct Edge {
    falloff: f64,
    /// |cos| at the end nearer to the lamp, and at the other.
    light_cos: f64,
    camera_cos: f64,
    /// The error of its direction, and what that costs outside of scattering.
    blur: f64,
    uncertainty: f64,
}

impl Edge {
    fn new(a: &Node<'_>, b: &Node<'_>) -> Self {
        let (direction, falloff) = a.to(b);
        let (light_cos, camera_cos) = (a.cos(direction), b.cos(direction));
        // A ray starts off one of the surfaces: what was traced is not quite the line between the vertices.
        let blur = 2e-7 + f64::from(a.offset.max(b.offset)) * falloff.sqrt();
        let uncertainty = blur * (2.0 + 1.0 / light_cos + 1.0 / camera_cos);
        Self { falloff, light_cos, camera_cos, blur, uncertainty }
    }
}

/// What the oracle says about a path.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// f(x), lane by lane.
    pub measured: [f64; 3],
    /// nᵢ·pᵢ(x) for i = 0 to k: a strategy's density times how often a pass tries it per pixel of the window.
    pub densities: Vec<f64>,
    /// Where rays may be aimed: the walk's density of the direction in which it leaves the last vertex that is not
    /// smooth, and the density of an aimed ray. `None` if the path has no such vertex, or none that such rays leave.
    pub aimed: Option<[f64; 2]>,
    /// For each strategy, whether its joining edge is one that forbids aimed rays.
    pub forbids: Vec<bool>,
    /// About how large a relative error the offsets of rays and rounding to `f32` may cause.
    pub uncertainty: f64,
}

impl Judgement {
    /// The unweighted estimate that strategy ought to make: f/(n·p).
    pub fn estimate(&self, strategy: Strategy) -> [f64; 3] {
        self.measured.map(|f| f / self.densities[strategy.s as usize])
    }

    /// The share of the walk of s = 0 in a path that `rays` aimed ones may make too: p/(p + n·q). They start only where
    /// no strategy of the set can join what comes before.
    pub fn walk_share(&self, rays: u32, set: &StrategySet) -> f64 {
        let vertices = self.densities.len() as u32;
        let forbidden =
            (0..vertices).any(|s| self.forbids[s as usize] && set.contains(Strategy { s, t: vertices - s }));
        match self.aimed {
            Some([p, q]) if !forbidden => p / (p + f64::from(rays) * q),
            _ => 1.0,
        }
    }

    /// The weight of that strategy among those of the set.
    pub fn weight(&self, strategy: Strategy, set: &StrategySet, heuristic: Heuristic) -> f64 {
        let power = |i: usize| match heuristic {
            Heuristic::Balance => self.densities[i],
            Heuristic::Power => self.densities[i] * self.densities[i],
        };
        let vertices = self.densities.len() as u32;
        let sum: f64 = (0..vertices)
            .filter(|s| set.contains(Strategy { s: *s, t: vertices - s }))
            .map(|s| power(s as usize))
            .sum();
        power(strategy.s as usize) / sum
    }
}

/// Judges a contribution found in that scene, where pixels share so many light paths.
///
/// # Errors
/// If it is no path at all: vertices are missing, a mirror does not mirror, the film position is elsewhere.
pub fn judge(scene: &Scene, c: &Contribution<'_>, shared: u32) -> Result<Judgement, String> {
    let nodes = nodes(c)?;
    let (k, lamp) = (nodes.len() - 1, &c.path.lamp);
    let lights = scene.lights(Wavelengths::Rgb);
    let emitted = nodes[0].to(&nodes[1]).0;
    let radiance = lanes(lights.radiance(lamp, narrow(emitted)));
    if nodes[0].infinite && nodes[1].infinite {
        // A camera of parallel rays looks at the sky: a density in both measures at once, and no other way.
        let (densities, forbids) = (vec![1.0, 0.0], vec![false; 2]);
        return Ok(Judgement { measured: radiance, densities, aimed: None, forbids, uncertainty: 0.0 });
    }
    let edges: Vec<Edge> = nodes.windows(2).map(|n| Edge::new(&n[0], &n[1])).collect();
    let scatterings: Vec<Option<Scattering>> = (0..=k)
        .map(|j| {
            let scatter = |v| {
                let blurs = [edges[j - 1].blur, edges[j].blur];
                scatter(v, [nodes[j].to(&nodes[j - 1]).0, nodes[j].to(&nodes[j + 1]).0], blurs)
            };
            nodes[j].surface.map(scatter).transpose()
        })
        .collect::<Result<_, _>>()?;
    let film_density = film_density(scene, c, &nodes[k - 1])?;

    let mut measured = radiance.map(|r| r * film_density);
    for e in &edges {
        measured = measured.map(|m| m * e.falloff * e.light_cos * e.camera_cos);
    }
    for s in scatterings.iter().flatten() {
        measured = [0, 1, 2].map(|lane| measured[lane] * s.value[lane]);
    }
    let starts = Starts {
        emission: lights.emission_pdf(lamp, narrow(emitted)),
        next_event: nodes[1]
            .surface
            .map_or(0.0, |(v, _)| lights.towards_pdf(v.receiver(), lamp).get().into()),
        camera: film_density,
        can_be_hit: !lights.lights.get(lamp.light).is_delta(),
    };
    let window = scene.film.window();
    let mut densities: Vec<f64> = (0..=k).map(|i| density(i, &scatterings, &edges, &starts)).collect();
    densities.iter_mut().take(k).skip(2).for_each(|density| *density *= f64::from(shared));
    let joinable = scene.camera.joins() != Joins::Nothing;
    densities[k] *= if joinable { f64::from(window.width) * f64::from(window.height) } else { 0.0 };
    // A spot alone differs by direction, by the cosine to its axis: that of a shortened vector is less.
    let dimmed = lights.radiance(lamp, narrow(emitted.map(|c| c * (1.0 - 4.0 * edges[0].blur))));
    let dimming = (1.0 - lanes(dimmed)[0] / radiance[0]).abs();
    let uncertainty = dimming
        + edges.iter().map(|e| e.uncertainty).sum::<f64>()
        + scatterings.iter().flatten().map(|s| s.uncertainty).sum::<f64>();
    let start = (1..k).find(|j| scatterings[*j].as_ref().is_some_and(|s| !s.smooth)).filter(|j| *j > 1);
    let forbids = (0..=k).map(|s| start.is_some_and(|j| s > j) && densities[s] > 0.0).collect();
    let mut uncertainty = uncertainty;
    let aimed = start.and_then(|j| {
        let (q, doubt) = aimed_density(scene, &nodes[j], [&nodes[j - 1], &nodes[j + 1]])?;
        uncertainty += doubt;
        Some([scatterings[j].as_ref()?.to_light_pdf, q])
    });
    Ok(Judgement { measured, densities, aimed, forbids, uncertainty })
}

/// The density per solid angle with which a ray is aimed from a vertex at the one before it (nearer to the lamp), and how
/// doubtful that is, near the border of a cone. Each of the balls that are seen from the vertex, on the side of the one
/// after it unless it transmits, is chosen by its solid angle.
fn aimed_density(scene: &Scene, from: &Node<'_>, [before, after]: [&Node<'_>; 2]) -> Option<(f64, f64)> {
    let (direction, normal) = (from.to(before).0, from.normal?);
    let side = dot(normal, from.to(after).0).signum();
    let transmits = from.surface?.0.bsdf.transmits();
    let (mut all, mut hit, mut doubt) = (0.0, 0.0, 0.0);
    for caster in scene.casters().iter() {
        let (d, radius) = (plus(wide(caster.center), from.at, -1.0), f64::from(caster.radius));
        let squared = dot(d, d);
        let hidden = !transmits && side * dot(normal, d) + radius <= 0.0;
        if squared <= 1.001 * radius * radius || hidden {
            continue;
        }
        let cos = (1.0 - radius * radius / squared).sqrt();
        let excess = dot(d, direction) / squared.sqrt() - cos;
        all += 2.0 * std::f64::consts::PI * (1.0 - cos);
        hit += f64::from(u8::from(excess > 0.0));
        if excess.abs() < 1e-5 {
            doubt = 1.0;
        }
    }
    (all > 0.0).then(|| (hit / all, doubt))
}

/// Densities at the two ends of a path.
struct Starts {
    emission: EmissionPdf,
    next_event: f64,
    camera: f64,
    can_be_hit: bool,
}

/// pᵢ(x): the light walk makes x₀ … xᵢ₋₁ and the camera walk x_k … xᵢ, each from the one before it.
fn density(i: usize, scatterings: &[Option<Scattering>], edges: &[Edge], starts: &Starts) -> f64 {
    let k = edges.len();
    let smooth = |j: usize| scatterings[j].as_ref().is_some_and(|s| s.smooth);
    if (i == 0 && !starts.can_be_hit) || (i > 0 && (smooth(i - 1) || smooth(i))) {
        return 0.0;
    }
    // Only where the eye path has a vertex to look for lamps from are they looked for.
    let mut p = match i {
        0 => 1.0,
        1 if k > 1 => starts.next_event,
        _ => starts.emission.point.get().into(),
    };
    for j in 1..i {
        let emitted = || starts.emission.direction.get().into();
        let direction = scatterings[j - 1].as_ref().map_or_else(emitted, |s| s.to_camera_pdf);
        p *= direction * edges[j - 1].falloff * edges[j - 1].camera_cos;
    }
    for j in i..k {
        let direction = scatterings[j + 1].as_ref().map_or(starts.camera, |s| s.to_light_pdf);
        p *= direction * edges[j].falloff * edges[j].light_cos;
    }
    p
}

/// The path as one list from the lamp to the camera.
fn nodes<'a>(c: &Contribution<'a>) -> Result<Vec<Node<'a>>, String> {
    let (s, t) = (c.strategy.s as usize, c.strategy.t as usize);
    let LightPoint { anchor, at, normal, offset, .. } = c.path.lamp;
    let infinite = anchor == Anchor::Infinite;
    let normal = (anchor == Anchor::Surface).then(|| wide(normal));
    let (light, mut eye) = (c.path.light, c.path.eye);
    if s == 0 && !infinite {
        let (last, rest) = eye.split_last().ok_or("no vertex on the lamp")?;
        if last.point.position != at || Some(wide(last.point.normal)) != normal {
            return Err("the last eye vertex is not the point on the lamp".into());
        }
        eye = rest;
    }
    if light.len() + eye.len() != s + t - 2 || light.len() != s.saturating_sub(1) {
        return Err(format!("{} light and {} eye vertices", light.len(), eye.len()));
    }
    // A walk's last vertex is joined, by a smooth lobe, whichever way the walk went on from there.
    let scattered = light.iter().rev().skip(1).chain(eye.iter().rev().skip(s.min(1)));
    if scattered.into_iter().any(|v| v.delta != v.bsdf.is_delta() && !v.bsdf.is_partly_delta()) {
        return Err("a vertex's Dirac flag is wrong".into());
    }
    let surface = |v: &'a Vertex, joined: bool| {
        let SurfacePoint { position, normal, offset, .. } = v.point;
        let surface = Some((v, v.delta && !joined));
        Node { at: wide(position), infinite: false, normal: Some(wide(normal)), offset, surface }
    };
    let CameraPoint { at: eye_at, infinite: parallel } = c.path.camera;
    let mut nodes = vec![Node { at: wide(at), infinite, normal, offset, surface: None }];
    nodes.extend(light.iter().enumerate().map(|(i, v)| surface(v, i + 1 == light.len())));
    nodes.extend(eye.iter().rev().enumerate().map(|(i, v)| surface(v, i == 0 && s > 0)));
    nodes.push(Node { at: wide(eye_at), infinite: parallel, normal: None, offset: 0.0, surface: None });
    Ok(nodes)
}
