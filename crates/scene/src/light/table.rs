use std::f32::consts::PI;

use caustica_math::{AreaPdf, Distribution1d, Mass, SolidAnglePdf, Spectrum, Vec3, warp};

use super::{Anchor, Emission, EmissionPdf, Light, LightPoint, Surroundings, Towards};

/// The part of the choice among lamps that is uniform.
const UNIFORM_PART: f64 = 0.1;

/// No lamp, and no triangle of one, gets a smaller share of a choice: of eight million at most, each can then be told
/// from its neighbours by the 24 bits of a number in [0, 1), and none is lost.
pub(super) const LEAST_SHARE: f32 = 1.0 / (1 << 23) as f32;

/// All lamps of a scene, chosen by power.
#[derive(Debug)]
pub struct Lights {
    lights: Vec<Light>,
    choice: Option<Distribution1d>,
    power: f64,
    environments: Vec<u32>,
}

impl Lights {
    /// From lamps and the power of each.
    ///
    /// A small part of the choice is uniform: a lamp that is weak in all may be all the light of a place, and a
    /// probability must not vanish beside a sun's.
    pub fn new(lights: Vec<Light>, powers: &[f64]) -> Self {
        let environments = (0..lights.len() as u32)
            .filter(|i| matches!(lights[*i as usize], Light::Environment(_)))
            .collect();
        let power: f64 = powers.iter().sum();
        let weight = |p: &f64| {
            let uniform = UNIFORM_PART / powers.len() as f64;
            ((1.0 - UNIFORM_PART) * p / power + uniform).max(f64::from(LEAST_SHARE)) as f32
        };
        let weights: Vec<f32> = if power > 0.0 { powers.iter().map(weight).collect() } else { Vec::new() };
        Self { choice: Distribution1d::new(&weights), lights, power, environments }
    }

    /// How many lamps there are.
    pub fn len(&self) -> usize {
        self.lights.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.lights.is_empty()
    }

    /// Whether no light comes from any of them.
    pub fn are_black(&self) -> bool {
        self.choice.is_none()
    }

    /// Whether [`LightQuery`]'s samples depend on `choice`: there are several lamps, or one of several parts.
    pub fn offer_a_choice(&self) -> bool {
        match &self.lights[..] {
            [Light::Area(lamp)] => lamp.offers_a_choice(),
            lamps => lamps.len() > 1,
        }
    }

    /// The sum of all powers, in W.
    pub fn power(&self) -> f64 {
        self.power
    }

    /// The lamp of that index.
    #[inline]
    pub fn get(&self, index: u32) -> &Light {
        &self.lights[index as usize]
    }

    /// All lamps.
    pub fn iter(&self) -> impl Iterator<Item = &Light> {
        self.lights.iter()
    }

    /// Those that a path meets when it leaves the scene.
    #[inline]
    pub fn environments(&self) -> &[u32] {
        &self.environments
    }

    fn mass(&self, light: u32) -> Mass {
        self.choice.as_ref().map_or(Mass(0.0), |c| c.mass(light as usize))
    }
}

/// Samples and densities of all lamps of a scene.
#[derive(Clone, Copy, Debug)]
pub struct LightQuery<'a> {
    /// The lamps.
    pub lights: &'a Lights,
    /// What they refer to.
    pub around: Surroundings<'a>,
}

impl LightQuery<'_> {
    /// Begins a light path: a lamp by power and a triangle of it from `choice`, a point on it from `u`, a
    /// direction from `v`.
    pub fn sample_emission(&self, choice: [f32; 2], u: [f32; 2], v: [f32; 2]) -> Option<Emission> {
        let chosen = self.lights.choice.as_ref()?.sample(choice[0]);
        let index = chosen.index as u32;
        let around = &self.around;
        let mut emission = match self.lights.get(index) {
            Light::Area(l) => l.sample_emission(index, choice[1], (u, v), around)?,
            Light::Point { position, intensity } => {
                let direction = warp::uniform_sphere(v);
                from_point(index, *position, direction, (*intensity, warp::UNIFORM_SPHERE_PDF))
            }
            Light::Spot(l) => {
                let direction = l.sample_direction(v);
                from_point(
                    index,
                    l.position,
                    direction,
                    (l.intensity_in(direction), l.direction_pdf(direction)),
                )
            }
            Light::Directional(l) => {
                let pdf = EmissionPdf { point: AreaPdf(1.0), direction: around.disk_pdf() };
                from_infinity(LightPoint::infinite(index, -l.direction), (l.irradiance, pdf), v, around)
            }
            Light::Environment(l) => {
                let (towards, pdf) = l.sample_direction(u)?;
                let pdf = EmissionPdf { point: AreaPdf(pdf.0), direction: around.disk_pdf() };
                let radiance = l.radiance_from(towards, around);
                from_infinity(LightPoint::infinite(index, towards), (radiance, pdf), v, around)
            }
        };
        emission.pdf.point = emission.pdf.point * chosen.mass;
        // What is no number goes on, and is found and counted where it would have been added.
        let none = emission.pdf.point.0 <= 0.0 || emission.pdf.direction.0 <= 0.0;
        (!none && !emission.radiance.is_black()).then_some(emission)
    }

    /// The densities with which [`LightQuery::sample_emission`] begins at `point` in `direction`.
    #[inline]
    pub fn emission_pdf(&self, point: &LightPoint, direction: Vec3) -> EmissionPdf {
        let around = &self.around;
        let (at, direction_pdf) = match self.lights.get(point.light) {
            Light::Area(l) => (l.area_pdf(point.primitive), cosine_pdf(point, direction)),
            Light::Point { .. } => (AreaPdf(1.0), warp::UNIFORM_SPHERE_PDF),
            Light::Spot(l) => (AreaPdf(1.0), l.direction_pdf(direction)),
            Light::Directional(_) => (AreaPdf(1.0), around.disk_pdf()),
            Light::Environment(l) => (AreaPdf(l.direction_pdf(point.at).0), around.disk_pdf()),
        };
        EmissionPdf { point: at * self.lights.mass(point.light), direction: direction_pdf }
    }

    /// Looks for a lamp from `from`: next-event estimation. `None` if the lamp that was chosen sends
    /// nothing there. Visibility is not tested.
    #[inline]
    pub fn sample_towards(&self, from: Vec3, choice: [f32; 2], u: [f32; 2]) -> Option<Towards> {
        let chosen = self.lights.choice.as_ref()?.sample(choice[0]);
        let index = chosen.index as u32;
        let around = &self.around;
        let (point, pdf) = match self.lights.get(index) {
            Light::Area(l) => l.sample_towards(index, from, (choice[1], u), around)?,
            Light::Point { position, .. } => (LightPoint::point(index, *position), AreaPdf(1.0)),
            Light::Spot(l) => (LightPoint::point(index, l.position), AreaPdf(1.0)),
            Light::Directional(l) => (LightPoint::infinite(index, -l.direction), AreaPdf(1.0)),
            Light::Environment(l) => {
                let (towards, pdf) = l.sample_direction(u)?;
                (LightPoint::infinite(index, towards), AreaPdf(pdf.0))
            }
        };
        let (direction, distance) = point.direction_from(from);
        let radiance = self.radiance(&point, -direction);
        let pdf = pdf * chosen.mass;
        // A place on the lamp itself has no direction to it. What is no number goes on, to be counted.
        let none = pdf.0 <= 0.0 || distance <= 0.0;
        (!none && !radiance.is_black()).then_some(Towards { point, direction, distance, radiance, pdf })
    }

    /// The density with which [`LightQuery::sample_towards`] finds `point` from `from`.
    #[inline]
    pub fn towards_pdf(&self, from: Vec3, point: &LightPoint) -> AreaPdf {
        let pdf = match self.lights.get(point.light) {
            Light::Area(l) => l.towards_pdf(from, point, &self.around),
            Light::Environment(l) => AreaPdf(l.direction_pdf(point.at).0),
            Light::Point { .. } | Light::Spot(_) | Light::Directional(_) => AreaPdf(1.0),
        };
        pdf * self.lights.mass(point.light)
    }

    /// The radiance (intensity, irradiance) that leaves `point` in `direction`.
    #[inline]
    pub fn radiance(&self, point: &LightPoint, direction: Vec3) -> Spectrum {
        match self.lights.get(point.light) {
            Light::Area(l) => {
                if point.normal.dot(direction) > 0.0 {
                    l.radiance_at(point.uv, &self.around)
                } else {
                    Spectrum::ZERO
                }
            }
            Light::Point { intensity, .. } => *intensity,
            Light::Spot(l) => l.intensity_in(direction),
            Light::Directional(l) => l.irradiance,
            Light::Environment(l) => l.radiance_from(point.at, &self.around),
        }
    }
}

fn cosine_pdf(point: &LightPoint, direction: Vec3) -> SolidAnglePdf {
    debug_assert!(point.anchor == Anchor::Surface);
    warp::cosine_hemisphere_pdf(point.normal.dot(direction))
}

fn from_point(
    light: u32,
    position: Vec3,
    direction: Vec3,
    (intensity, pdf): (Spectrum, SolidAnglePdf),
) -> Emission {
    Emission {
        point: LightPoint::point(light, position),
        origin: position,
        direction,
        radiance: intensity,
        cos: 1.0,
        pdf: EmissionPdf { point: AreaPdf(1.0), direction: pdf },
    }
}

fn from_infinity(
    point: LightPoint,
    (radiance, pdf): (Spectrum, EmissionPdf),
    v: [f32; 2],
    around: &Surroundings<'_>,
) -> Emission {
    let direction = -point.at;
    Emission { point, origin: around.disk_point(direction, v), direction, radiance, cos: 1.0, pdf }
}

/// The power in W of a lamp at infinity that sends the irradiance-like quantity `e` through the disk around
/// the scene.
pub(crate) fn power_through_disk(e: f64, radius: f32) -> f64 {
    f64::from(PI) * f64::from(radius) * f64::from(radius) * e
}
