use std::f32::consts::PI;

use caustica_math::elementary::safe_sqrt;
use caustica_math::spherical::{between, cross, dot};
use caustica_math::{AreaPdf, Distribution1d, Frame, Mass, SolidAnglePdf, Spectrum, Vec3, warp};

use super::lights::{LEAST_SHARE, Part};
use super::quad::Quad;
use super::seen::{Reach, Seen};
use super::tree::{Cone as Normals, Item, Leaf};
use super::{Anchor, Emission, EmissionPdf, LightPoint, Surroundings};
use crate::bvh::SphereData;
use crate::description::Texture;
use crate::surface::{FlatShape, Site, SurfacePoint};

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
        reach: Reach,
    },
    Quad(Box<Quad>),
    Sphere {
        primitive: u32,
        data: SphereData,
    },
}

/// The part of a lamp's sampling that goes by area alone, so that a texture's dark spots are still found.
const UNIFORM_PART: f32 = 0.05;

/// By how much of it the two densities of a parallelogram's halves may differ where it is sampled evenly.
const EVEN: f32 = 0.01;

/// Where a triangle's emission is looked up to estimate its power: centroids of a 4 × 4 subdivision.
const PROBES: u32 = 4;

impl AreaLight {
    /// From a shape of the scene; returns it with its power in W. `None` if it emits nothing.
    pub fn new(shape: &FlatShape, radiance: Texture, around: &Surroundings<'_>) -> Option<(Self, f64)> {
        let first = shape.first_primitive;
        let luminance = |p: &SurfacePoint| {
            around.textures.at(Site::of(p, around.surfaces)).rgb(&radiance, p.uv).luminance()
        };
        // The probes may all miss a texture's bright spots, but no lamp may be lost that emits anywhere.
        let here = around.textures.at(around.surfaces.site_on(around.surfaces.shape_of(first)));
        let least = UNIFORM_PART * here.mean_luminance(&radiance);
        if let Some(data) = around.surfaces.sphere(first) {
            let mean = sphere_mean(first, around, &luminance).max(least);
            let (pi, radius) = (f64::from(PI), f64::from(data.radius));
            let power = pi * 4.0 * pi * radius * radius * f64::from(mean);
            let surface = Surface::Sphere { primitive: first, data: *data };
            return (power > 0.0).then_some((Self { radiance, surface }, power));
        }
        let triangles = first..first + shape.primitive_count;
        let areas: Vec<f64> = triangles.clone().map(|t| area(around.surfaces.corners(t))).collect();
        let means: Vec<f32> = match radiance {
            Texture::Constant(c) => vec![c.luminance(); areas.len()],
            _ => triangles.map(|t| triangle_mean(t, around, &luminance)).collect(),
        };
        // Sums of a million triangles, and of light brighter than f32 can count over an area, need the precision.
        let total_area: f64 = areas.iter().sum();
        let power: f64 = areas.iter().zip(&means).map(|(a, m)| a * f64::from(*m)).sum();
        let mean = (power / total_area) as f32;
        let floor = (UNIFORM_PART * mean).max(least);
        let all = total_area * f64::from(mean + floor);
        if all <= 0.0 {
            return None;
        }
        let weight = |(a, m): (&f64, &f32)| ((a * f64::from(m + floor) / all) as f32).max(LEAST_SHARE);
        let weights: Vec<f32> = areas.iter().zip(&means).map(weight).collect();
        let choice = Distribution1d::new(&weights)?;
        let density: Vec<f32> =
            areas.iter().enumerate().map(|(i, a)| (f64::from(choice.mass(i).0) / a) as f32).collect();
        let quad = match density[..] {
            [a, b] if (a - b).abs() <= EVEN * a => Quad::new([first, first + 1], around.surfaces),
            _ => None,
        };
        let surface = quad.map_or_else(
            || {
                let reach = Reach::new(first..first + shape.primitive_count, around.surfaces);
                Surface::Mesh { first_primitive: first, choice, density, reach }
            },
            |quad| Surface::Quad(Box::new(quad)),
        );
        Some((Self { radiance, surface }, f64::from(PI) * f64::from(mean.max(least)) * total_area))
    }

    /// The radiance at a point of it.
    #[inline]
    pub fn radiance_at(&self, point: &LightPoint, around: &Surroundings<'_>) -> Spectrum {
        let textures = around.textures.at(around.surfaces.site_of(point));
        textures.spectrum(&self.radiance, point.uv, around.wavelengths)
    }

    /// Its parts for the hierarchy, given its index among the lamps and its power.
    pub(super) fn parts(
        &self,
        light: u32,
        power: f64,
        around: &Surroundings<'_>,
        tell: &mut dyn FnMut(Item),
    ) {
        // A flat lamp of the power π·L·A has the intensity L·A; a sphere of 4π²·r²·L has π·r²·L.
        let intensity = power / f64::from(PI);
        let triangle = |t: u32| {
            let [a, b, c] = around.surfaces.corners(t);
            let normal = around.surfaces.triangle_point(t, 0.25, 0.25).normal;
            (a.min(b).min(c), a.max(b).max(c), Normals::flat(normal))
        };
        let item = |part, (min, max, cone), intensity| Item {
            leaf: Leaf { light, part },
            min,
            max,
            cone,
            intensity,
        };
        match &self.surface {
            Surface::Mesh { first_primitive, choice, .. } => (0..choice.len() as u32).for_each(|i| {
                let share = f64::from(choice.mass(i as usize).0.max(LEAST_SHARE));
                tell(item(i, triangle(first_primitive + i), intensity * share));
            }),
            Surface::Quad(quad) => {
                let [a, b] = quad.primitives().map(triangle);
                tell(item(0, (a.0.min(b.0), a.1.max(b.1), a.2.around(b.2)), intensity));
            }
            Surface::Sphere { data, .. } => {
                let radius = Vec3::splat(data.radius);
                let bounds = (data.center - radius, data.center + radius, Normals::ALL);
                tell(item(0, bounds, 0.25 * intensity));
            }
        }
    }

    /// Which part a primitive is.
    pub(super) fn part_of(&self, primitive: u32) -> u32 {
        match &self.surface {
            Surface::Mesh { first_primitive, .. } => primitive - first_primitive,
            Surface::Quad(_) | Surface::Sphere { .. } => 0,
        }
    }

    /// How many parts it has.
    pub(super) fn part_count(&self) -> usize {
        match &self.surface {
            Surface::Mesh { choice, .. } => choice.len(),
            Surface::Quad(_) | Surface::Sphere { .. } => 1,
        }
    }

    /// Whether a part of it is to be chosen.
    pub(super) fn offers_a_choice(&self) -> bool {
        matches!(self.surface, Surface::Mesh { .. })
    }

    /// The density of points by area and emission on that primitive.
    #[inline]
    pub fn area_pdf(&self, primitive: u32) -> AreaPdf {
        match &self.surface {
            Surface::Mesh { first_primitive, density, .. } => {
                AreaPdf(density[(primitive - first_primitive) as usize])
            }
            Surface::Quad(quad) => quad.area_pdf(primitive),
            Surface::Sphere { data, .. } => AreaPdf(1.0 / (4.0 * PI * data.radius * data.radius)),
        }
    }

    /// A point by area and emission; `choice` picks the triangle.
    fn sample_point(
        &self,
        light: u32,
        choice: f32,
        u: [f32; 2],
        around: &Surroundings<'_>,
    ) -> (LightPoint, AreaPdf) {
        match &self.surface {
            Surface::Mesh { first_primitive, choice: table, density, .. } => {
                let [b1, b2] = warp::uniform_triangle(u);
                let index = table.sample(choice).index;
                let p = around.surfaces.triangle_point(first_primitive + index as u32, b1, b2);
                (LightPoint::on_surface(light, &p), AreaPdf(density[index]))
            }
            Surface::Quad(quad) => {
                let point = quad.point(light, u);
                (point, quad.area_pdf(point.primitive))
            }
            Surface::Sphere { primitive, .. } => {
                let p = around.surfaces.sphere_point(*primitive, warp::uniform_sphere(u));
                (LightPoint::on_surface(light, &p), self.area_pdf(*primitive))
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
        let (point, pdf) = self.sample_point(light, choice, u, around);
        let local = warp::cosine_hemisphere(v);
        let direction = Frame::from_normal(point.normal).to_world(local);
        let cos = point.normal.dot(direction);
        let pdf = EmissionPdf { point: pdf, direction: warp::cosine_hemisphere_pdf(cos) };
        let origin = point.off_surface(direction);
        (cos > 0.0).then(|| Emission {
            point,
            origin,
            direction,
            radiance: self.radiance_at(&point, around),
            cos,
            pdf,
        })
    }

    /// Emission along the normal.
    pub(super) fn sample_collimated(
        &self,
        light: u32,
        choice: f32,
        u: [f32; 2],
        around: &Surroundings<'_>,
    ) -> Emission {
        let (point, pdf) = self.sample_point(light, choice, u, around);
        let direction = point.normal;
        Emission {
            point,
            origin: point.off_surface(direction),
            direction,
            radiance: self.radiance_at(&point, around),
            cos: 1.0,
            pdf: EmissionPdf { point: pdf, direction: SolidAnglePdf(1.0) },
        }
    }

    pub(super) fn sample_towards(
        &self,
        light: u32,
        from: Vec3,
        (part, u): (Part, [f32; 2]),
        around: &Surroundings<'_>,
    ) -> Option<(LightPoint, AreaPdf)> {
        match &self.surface {
            Surface::Quad(quad) => match quad.seen(from) {
                Seen::Behind => return None,
                Seen::ByArea => {}
                Seen::Near(near) => {
                    let point = quad.point(light, near.shape.sample(u));
                    return Some((point, near.area_pdf(from, &point)));
                }
            },
            Surface::Mesh { first_primitive, choice: table, density, reach } => {
                let (index, mass) = match part {
                    Part::Of(index) => (index as usize, None),
                    Part::By(choice) => {
                        let chosen = table.sample(choice);
                        (chosen.index, Some(chosen.mass))
                    }
                };
                let triangle = first_primitive + index as u32;
                let corners = || around.surfaces.corners(triangle);
                let on = |[b1, b2]: [f32; 2]| {
                    LightPoint::on_surface(light, &around.surfaces.triangle_point(triangle, b1, b2))
                };
                return match reach.triangle(corners, from) {
                    Seen::Behind => None,
                    Seen::ByArea => {
                        let pdf = mass.map_or_else(|| uniform_pdf(corners()), |_| AreaPdf(density[index]));
                        Some((on(warp::uniform_triangle(u)), pdf))
                    }
                    Seen::Near(near) => {
                        let point = on(near.shape.sample(u));
                        Some((point, near.area_pdf(from, &point) * mass.unwrap_or(Mass::ONE)))
                    }
                };
            }
            Surface::Sphere { primitive, data } => {
                if let Some(cone) = Cone::new(data, from) {
                    let p = around.surfaces.sphere_point(*primitive, cone.sample(u));
                    let point = LightPoint::on_surface(light, &p);
                    return cone.area_pdf(from, &point).map(|pdf| (point, pdf));
                }
            }
        }
        Some(self.sample_point(light, 0.0, u, around))
    }

    /// The density of finding a point: among all, or (in a hierarchy, which chooses the part) on its part alone.
    pub(super) fn towards_pdf(
        &self,
        from: Vec3,
        (point, in_parts): (&LightPoint, bool),
        around: &Surroundings<'_>,
    ) -> AreaPdf {
        match &self.surface {
            Surface::Quad(quad) => match quad.seen(from) {
                Seen::Behind => AreaPdf::ZERO,
                Seen::ByArea => quad.area_pdf(point.primitive),
                Seen::Near(near) => near.area_pdf(from, point),
            },
            Surface::Mesh { first_primitive, choice, reach, .. } => {
                let corners = || around.surfaces.corners(point.primitive);
                match reach.triangle(corners, from) {
                    Seen::Behind => AreaPdf::ZERO,
                    Seen::ByArea if in_parts => uniform_pdf(corners()),
                    Seen::ByArea => self.area_pdf(point.primitive),
                    Seen::Near(near) if in_parts => near.area_pdf(from, point),
                    Seen::Near(near) => {
                        let mass = choice.mass((point.primitive - first_primitive) as usize);
                        near.area_pdf(from, point) * mass
                    }
                }
            }
            Surface::Sphere { data, .. } => match Cone::new(data, from) {
                Some(cone) => cone.area_pdf(from, point).unwrap_or(AreaPdf::ZERO),
                None => self.area_pdf(point.primitive),
            },
        }
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

/// The density of even points on a triangle.
fn uniform_pdf(corners: [Vec3; 3]) -> AreaPdf {
    AreaPdf((1.0 / area(corners)) as f32)
}

fn area([a, b, c]: [Vec3; 3]) -> f64 {
    let normal = cross(between(a, b), between(a, c));
    0.5 * dot(normal, normal).sqrt()
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
