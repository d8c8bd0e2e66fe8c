use std::f32::consts::PI;

use caustica_math::elementary::safe_sqrt;
use caustica_math::{AreaPdf, Distribution1d, Frame, Spectrum, Vec2, Vec3, warp};

use super::{Anchor, Emission, EmissionPdf, LightPoint, Surroundings};
use crate::bvh::SphereData;
use crate::description::Texture;
use crate::surface::{FlatShape, SurfacePoint};

/// A surface that emits from the side of its normal.
#[derive(Debug)]
pub struct AreaLight {
    radiance: Texture,
    surface: Surface,
}

#[derive(Debug)]
enum Surface {
    Mesh {
        first_primitive: u32,
        choice: Distribution1d,
        /// Probability of each triangle over its area.
        density: Vec<f32>,
    },
    Sphere {
        primitive: u32,
        data: SphereData,
    },
}

/// The part of a lamp's sampling that goes by area alone, so that a texture's dark spots are still found.
const UNIFORM_PART: f32 = 0.05;

/// Where a triangle's emission is looked up to estimate its power: centroids of a 4 × 4 subdivision.
const PROBES: u32 = 4;

impl AreaLight {
    /// From a shape of the scene; returns it with its power in W. `None` if it emits nothing.
    pub fn new(shape: &FlatShape, radiance: Texture, around: &Surroundings<'_>) -> Option<(Self, f32)> {
        let first = shape.first_primitive;
        let luminance = |p: &SurfacePoint| around.textures.rgb(&radiance, p.uv).luminance();
        // The probes may all miss a texture's bright spots, but no lamp may be lost that emits anywhere.
        let least = UNIFORM_PART * around.textures.mean_luminance(&radiance);
        if let Some(data) = around.surfaces.sphere(first) {
            let mean = sphere_mean(first, around, &luminance).max(least);
            let power = PI * 4.0 * PI * data.radius * data.radius * mean;
            let surface = Surface::Sphere { primitive: first, data: *data };
            return (power > 0.0).then_some((Self { radiance, surface }, power));
        }
        let triangles = first..first + shape.primitive_count;
        let areas: Vec<f32> = triangles.clone().map(|t| area(around.surfaces.corners(t))).collect();
        let means: Vec<f32> = triangles.map(|t| triangle_mean(t, around, &luminance)).collect();
        // Sums of a million triangles need the precision.
        let total_area: f64 = areas.iter().map(|a| f64::from(*a)).sum();
        let power: f64 = areas.iter().zip(&means).map(|(a, m)| f64::from(*a) * f64::from(*m)).sum();
        let mean = (power / total_area) as f32;
        let floor = (UNIFORM_PART * mean).max(least);
        let weights: Vec<f32> = areas.iter().zip(&means).map(|(a, m)| a * (m + floor)).collect();
        let choice = Distribution1d::new(&weights)?;
        let density = areas
            .iter()
            .enumerate()
            .map(|(i, a)| if *a > 0.0 { choice.mass(i).0 / a } else { 0.0 })
            .collect();
        let surface = Surface::Mesh { first_primitive: first, choice, density };
        Some((Self { radiance, surface }, PI * mean.max(least) * total_area as f32))
    }

    /// The radiance at texture coordinates `uv`.
    #[inline]
    pub fn radiance_at(&self, uv: Vec2, around: &Surroundings<'_>) -> Spectrum {
        around.textures.spectrum(&self.radiance, uv, around.wavelengths)
    }

    /// The density of points by area and emission on that primitive.
    #[inline]
    pub fn area_pdf(&self, primitive: u32) -> AreaPdf {
        match &self.surface {
            Surface::Mesh { first_primitive, density, .. } => {
                AreaPdf(density[(primitive - first_primitive) as usize])
            }
            Surface::Sphere { data, .. } => AreaPdf(1.0 / (4.0 * PI * data.radius * data.radius)),
        }
    }

    /// A point by area and emission; `choice` picks the triangle.
    fn sample_point(&self, choice: f32, u: [f32; 2], around: &Surroundings<'_>) -> SurfacePoint {
        match &self.surface {
            Surface::Mesh { first_primitive, choice: table, .. } => {
                let [b1, b2] = warp::uniform_triangle(u);
                let triangle = first_primitive + table.sample(choice).index as u32;
                around.surfaces.triangle_point(triangle, b1, b2)
            }
            Surface::Sphere { primitive, .. } => {
                around.surfaces.sphere_point(*primitive, warp::uniform_sphere(u))
            }
        }
    }

    pub(super) fn sample_emission(
        &self,
        light: u32,
        choice: f32,
        (u, v): ([f32; 2], [f32; 2]),
        around: &Surroundings<'_>,
    ) -> Option<Emission> {
        let p = self.sample_point(choice, u, around);
        let local = warp::cosine_hemisphere(v);
        let direction = Frame::from_normal(p.normal).to_world(local);
        let point = LightPoint::on_surface(light, &p);
        let cos = p.normal.dot(direction);
        let pdf =
            EmissionPdf { point: self.area_pdf(p.primitive), direction: warp::cosine_hemisphere_pdf(cos) };
        let origin = point.off_surface(direction);
        (cos > 0.0).then(|| Emission {
            point,
            origin,
            direction,
            radiance: self.radiance_at(p.uv, around),
            cos,
            pdf,
        })
    }

    pub(super) fn sample_towards(
        &self,
        light: u32,
        from: Vec3,
        (choice, u): (f32, [f32; 2]),
        around: &Surroundings<'_>,
    ) -> Option<(LightPoint, AreaPdf)> {
        if let Surface::Sphere { primitive, data } = &self.surface
            && let Some(cone) = Cone::new(data, from)
        {
            let p = around.surfaces.sphere_point(*primitive, cone.sample(u));
            let point = LightPoint::on_surface(light, &p);
            return cone.area_pdf(from, &point).map(|pdf| (point, pdf));
        }
        let p = self.sample_point(choice, u, around);
        Some((LightPoint::on_surface(light, &p), self.area_pdf(p.primitive)))
    }

    pub(super) fn towards_pdf(&self, from: Vec3, point: &LightPoint, _: &Surroundings<'_>) -> AreaPdf {
        if let Surface::Sphere { data, .. } = &self.surface
            && let Some(cone) = Cone::new(data, from)
        {
            return cone.area_pdf(from, point).unwrap_or(AreaPdf::ZERO);
        }
        self.area_pdf(point.primitive)
    }
}

/// A sphere as seen from outside: a cone of directions.
struct Cone {
    axis: Frame,
    /// Distance of the centre in radii.
    distance: f32,
    /// sin² of the half angle, and what it lacks of one.
    sin2: f32,
    cos2: f32,
    one_minus_cos: f32,
}

impl Cone {
    /// `None` from inside, or so close that rounding of the positions hides where the sphere is.
    fn new(sphere: &SphereData, from: Vec3) -> Option<Self> {
        let to_center = sphere.center - from;
        let exact = [0, 1, 2].map(|axis| f64::from(sphere.center[axis]) - f64::from(from[axis]));
        let distance2: f64 = exact.iter().map(|c| c * c).sum();
        let radius2 = f64::from(sphere.radius) * f64::from(sphere.radius);
        // From near by, almost half of all directions meet the sphere: what lacks decides where.
        let cos2 = ((distance2 - radius2) / distance2) as f32;
        if cos2.is_nan() || cos2 <= 1e-5 {
            return None;
        }
        let sin2 = (radius2 / distance2) as f32;
        Some(Self {
            axis: Frame::from_normal(to_center.normalized()),
            distance: 1.0 / sin2.sqrt(),
            sin2,
            cos2,
            one_minus_cos: sin2 / (1.0 + cos2.sqrt()),
        })
    }

    /// The normal of a visible point, uniform in solid angle.
    fn sample(&self, u: [f32; 2]) -> Vec3 {
        let d = warp::uniform_cone(u, self.one_minus_cos);
        // Where the ray enters, in units of the distance of the centre: the near root of its quadratic
        // equation, without cancellation. (The cosine of the angle at the centre, which is the usual way,
        // has lost most of its digits where the sphere is near.)
        let t = self.cos2 / (d.z + safe_sqrt(self.sin2 - (d.x * d.x + d.y * d.y)));
        self.axis.to_world(Vec3::new(t * d.x, t * d.y, t * d.z - 1.0) * self.distance).normalized()
    }

    /// The density at a point of the near side, per area.
    fn area_pdf(&self, from: Vec3, point: &LightPoint) -> Option<AreaPdf> {
        debug_assert!(point.anchor == Anchor::Surface);
        let (direction, distance) = point.direction_from(from);
        let cos = -point.normal.dot(direction);
        (cos > 0.0)
            .then(|| AreaPdf(warp::uniform_cone_pdf(self.one_minus_cos).0 * cos / (distance * distance)))
    }
}

fn area([a, b, c]: [Vec3; 3]) -> f32 {
    0.5 * (b - a).cross(c - a).length()
}

fn triangle_mean(triangle: u32, around: &Surroundings<'_>, luminance: &dyn Fn(&SurfacePoint) -> f32) -> f32 {
    let n = PROBES;
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..n {
            let u = [(i as f32 + 0.5) / n as f32, (j as f32 + 0.5) / n as f32];
            let [b1, b2] = warp::uniform_triangle(u);
            sum += luminance(&around.surfaces.triangle_point(triangle, b1, b2));
        }
    }
    sum / (n * n) as f32
}

fn sphere_mean(primitive: u32, around: &Surroundings<'_>, luminance: &dyn Fn(&SurfacePoint) -> f32) -> f32 {
    let n = 16;
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..n {
            let normal = warp::uniform_sphere([(i as f32 + 0.5) / n as f32, (j as f32 + 0.5) / n as f32]);
            sum += luminance(&around.surfaces.sphere_point(primitive, normal));
        }
    }
    sum / (n * n) as f32
}
