use std::f32::consts::PI;

use caustica_math::{AreaPdf, SolidAnglePdf, Spectrum, Vec3, warp};

use super::{Anchor, Emission, EmissionPdf, Light, LightPoint, Lights, Receiver, Surroundings, Towards};

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
        let (index, mass) = self.lights.choose(choice[0])?;
        let around = &self.around;
        let mut emission = match self.lights.get(index) {
            Light::Area(l) => l.sample_emission(index, choice[1], (u, v), around)?,
            Light::Collimated(l) => l.sample_collimated(index, choice[1], u, around),
            Light::Point { position, intensity } => {
                let direction = warp::uniform_sphere(v);
                from_point(index, *position, direction, (*intensity, warp::UNIFORM_SPHERE_PDF))
            }
            Light::Spot(l) => {
                let direction = l.sample_direction(v);
                let intensity = l.intensity_in(direction, around);
                from_point(index, l.position, direction, (intensity, l.direction_pdf(direction)))
            }
            Light::Projector(l) => {
                let direction = l.sample_direction(v);
                let intensity = l.intensity_in(direction, around);
                from_point(index, l.position(), direction, (intensity, l.direction_pdf(direction)))
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
        emission.pdf.point = emission.pdf.point * mass;
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
            Light::Projector(l) => (AreaPdf(1.0), l.direction_pdf(direction)),
            // The coefficient of the Dirac distribution around the normal.
            Light::Collimated(l) => (l.area_pdf(point.primitive), SolidAnglePdf(1.0)),
            Light::Directional(_) => (AreaPdf(1.0), around.disk_pdf()),
            Light::Environment(l) => (AreaPdf(l.direction_pdf(point.at).0), around.disk_pdf()),
        };
        EmissionPdf { point: at * self.lights.mass(point.light), direction: direction_pdf }
    }

    /// Looks for a lamp from `from`: next-event estimation. `None` if the lamp that was chosen sends
    /// nothing there. Visibility is not tested.
    #[inline]
    pub fn sample_towards(
        &self,
        from: impl Into<Receiver>,
        choice: [f32; 2],
        u: [f32; 2],
    ) -> Option<Towards> {
        let to: Receiver = from.into();
        let (index, part, mass) = self.lights.choose_for(&to, choice)?;
        let (from, around) = (to.at, &self.around);
        let (point, pdf) = match self.lights.get(index) {
            Light::Area(l) => l.sample_towards(index, from, (part, u), around)?,
            // Its light goes where the normal points, and nobody who looks for it is there.
            Light::Collimated(_) => return None,
            Light::Point { position, .. } => (LightPoint::point(index, *position), AreaPdf(1.0)),
            Light::Spot(l) => (LightPoint::point(index, l.position), AreaPdf(1.0)),
            Light::Projector(l) => (LightPoint::point(index, l.position()), AreaPdf(1.0)),
            Light::Directional(l) => (LightPoint::infinite(index, -l.direction), AreaPdf(1.0)),
            Light::Environment(l) => {
                let (towards, pdf) = l.sample_direction(u)?;
                (LightPoint::infinite(index, towards), AreaPdf(pdf.0))
            }
        };
        let (direction, distance) = point.direction_from(from);
        let radiance = self.radiance(&point, -direction);
        let pdf = pdf * mass;
        // A place on the lamp itself has no direction to it. What is no number goes on, to be counted.
        let none = pdf.0 <= 0.0 || distance <= 0.0;
        (!none && !radiance.is_black()).then_some(Towards { point, direction, distance, radiance, pdf })
    }

    /// The density with which [`LightQuery::sample_towards`] finds `point` from `from`.
    #[inline]
    pub fn towards_pdf(&self, from: impl Into<Receiver>, point: &LightPoint) -> AreaPdf {
        let to: Receiver = from.into();
        let pdf = match self.lights.get(point.light) {
            Light::Area(l) => l.towards_pdf(to.at, (point, self.lights.chooses_parts()), &self.around),
            Light::Collimated(_) => AreaPdf::ZERO,
            Light::Environment(l) => AreaPdf(l.direction_pdf(point.at).0),
            Light::Point { .. } | Light::Spot(_) | Light::Projector(_) | Light::Directional(_) => {
                AreaPdf(1.0)
            }
        };
        pdf * self.lights.mass_for(&to, point)
    }

    /// The radiance (intensity, irradiance) that leaves `point` in `direction`; of a lamp that shines along its normals,
    /// the coefficient of the Dirac distribution around them.
    #[inline]
    pub fn radiance(&self, point: &LightPoint, direction: Vec3) -> Spectrum {
        match self.lights.get(point.light) {
            Light::Area(l) => {
                if point.normal.dot(direction) > 0.0 {
                    l.radiance_at(point, &self.around)
                } else {
                    Spectrum::ZERO
                }
            }
            Light::Collimated(l) => l.radiance_at(point, &self.around),
            Light::Point { intensity, .. } => *intensity,
            Light::Spot(l) => l.intensity_in(direction, &self.around),
            Light::Projector(l) => l.intensity_in(direction, &self.around),
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
