//! The flat scene: what rays run on.

mod lamps;

use caustica_math::{Frame, MemoryLimit, SampleStream, Spectrum, StreamId, Vec3, Wavelengths, warp};

use crate::bsdf::Bsdf;
use crate::bvh::{Bvh, Hit, Ray, TreeQuality};
use crate::camera::{Camera, film_settings};
use crate::casters::Casters;
use crate::description::{Description, FilmSettings, Image, ImageId, LightKind, MaterialId, Texture};
use crate::diagnostic::Diagnostic;
use crate::light::{AreaLight, Light, LightPoint, LightQuery, Lights, Surroundings};
use crate::material::{FlatMaterial, bsdf_at, flatten};
use crate::references;
use crate::surface::{FARTHEST, FlatShape, Site, SurfacePoint, Surfaces};
use crate::texture::TextureTable;
use crate::traits::{self, Traits, varies};
use crate::{attributes, figures, memory};

/// A scene ready to be rendered. Immutable, and shared between threads.
#[derive(Debug)]
pub struct Scene {
    /// The eye.
    pub camera: Camera,
    /// The picture's size, crop and filter.
    pub film: FilmSettings,
    surfaces: Surfaces,
    bvh: Bvh,
    materials: Vec<FlatMaterial>,
    traits: Vec<Traits>,
    images: Vec<Image>,
    lights: Lights,
    casters: Casters,
    center: Vec3,
    radius: f32,
    brightest: f32,
}

impl Scene {
    /// Flattens a description; returns the scene and warnings.
    ///
    /// # Errors
    /// Geometry, camera, materials or lights that cannot be rendered: see [`Surfaces::new`] and
    /// [`Camera::new`].
    pub fn new(description: Description) -> Result<(Self, Vec<Diagnostic>), Diagnostic> {
        Self::with_tree(description, TreeQuality::default())
    }

    /// The same, with a choice of how the tree is built.
    ///
    /// # Errors
    /// As [`Scene::new`].
    pub fn with_tree(
        description: Description,
        tree: TreeQuality,
    ) -> Result<(Self, Vec<Diagnostic>), Diagnostic> {
        Self::within(description, tree, MemoryLimit::Machine)
    }

    /// The same in so much memory.
    ///
    /// # Errors
    /// As [`Scene::new`]; and, before anything is allocated, a scene that does not fit: see [`memory::needed`].
    pub fn within(
        mut description: Description,
        tree: TreeQuality,
        memory: MemoryLimit,
    ) -> Result<(Self, Vec<Diagnostic>), Diagnostic> {
        let mut warnings = Vec::new();
        let film = film_settings(&description, &mut warnings);
        memory::check(&description, tree, memory)?;
        references::check(&description)?;
        figures::check(&description)?;
        let traits = traits::of_all(&description.materials)?;
        attributes::resolve(&mut description)?;
        let mut surfaces = Surfaces::new(&mut description.shapes, &mut warnings)?;
        let camera = Camera::among(&surfaces, &description.camera, &film)?;
        surfaces.add_groups(&mut description, &mut warnings)?;
        surfaces.number_attributes(&description.attributes);
        surfaces.mark(description.all_shapes().map(|shape| {
            let material = traits[shape.material.0 as usize];
            let uses_uv = material.uses_uv || shape.emission.as_ref().is_some_and(varies);
            Traits { uses_uv, ..material }
        }));
        for light in &description.lights {
            if let LightKind::Collimated { shape, exitance } = &light.kind {
                surfaces.shapes[*shape as usize].needs_uv |= varies(exitance);
            }
        }
        let bvh = surfaces.tree(tree).map_err(|i| {
            let beyond = &description.instances[i as usize];
            let name = &description.groups[beyond.group.0 as usize].name;
            let message = format!("an instance of {name} reaches farther than {FARTHEST:e} from the origin");
            Diagnostic::error(message).at(beyond.origin.clone())
        })?;
        let bounds = bvh.bounds();
        let (center, radius) = if bounds.is_empty() {
            (camera.position(), 1.0)
        } else {
            (bounds.center(), ((bounds.max - bounds.center()).length() * 1.0001).max(f32::MIN_POSITIVE))
        };
        let materials = flatten(&description.materials);
        let is_caster = |shape: &FlatShape| traits[shape.material as usize].is_caster;
        let casters = Casters::new(&surfaces, &bvh, is_caster);
        let images = std::mem::take(&mut description.images);
        let mut scene = Self {
            camera,
            film,
            surfaces,
            bvh,
            materials,
            traits,
            images,
            lights: Lights::new(Vec::new(), &[]),
            casters,
            center,
            radius,
            brightest: 0.0,
        };
        scene.lights = scene.flatten_lights(&description, &mut warnings)?;
        scene.brightest = scene.brightest_of(&description);
        crate::warnings::check(&scene, &description, &mut warnings);
        Ok((scene, warnings))
    }

    fn flatten_lights(
        &mut self,
        description: &Description,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Lights, Diagnostic> {
        let w = Wavelengths::Rgb;
        let (mut lights, mut powers) = (Vec::new(), Vec::new());
        for (index, shape) in description.shapes.iter().enumerate() {
            let Some(radiance) = shape.emission else { continue };
            let flat = self.surfaces.shapes[index];
            match AreaLight::new(&flat, radiance, &self.surroundings(w)) {
                Some((light, power)) => {
                    self.surfaces.shapes[index].light = Some(lights.len() as u32);
                    lights.push(Light::Area(light));
                    powers.push(power);
                }
                None => warnings.push(
                    Diagnostic::warning(format!("{} is a lamp that emits nothing", shape.name))
                        .at(shape.origin.clone()),
                ),
            }
        }
        for light in &description.lights {
            if let LightKind::Collimated { shape, .. } = light.kind {
                self.surfaces.shapes[shape as usize].is_collimated = true;
            }
            let made = self.flatten_light(&light.kind, w);
            match made.map_err(|m| Diagnostic::error(m).at(light.origin.clone()))? {
                Some((flat, power)) if power > 0.0 && power.is_finite() => {
                    lights.push(flat);
                    powers.push(power);
                }
                _ => warnings.push(Diagnostic::warning("this lamp emits nothing").at(light.origin.clone())),
            }
        }
        Ok(Lights::new(lights, &powers).with_hierarchy(&powers, &self.surroundings(w)))
    }

    fn surroundings(&self, wavelengths: Wavelengths) -> Surroundings<'_> {
        Surroundings {
            surfaces: &self.surfaces,
            textures: self.textures(),
            center: self.center,
            radius: self.radius,
            wavelengths,
        }
    }

    /// Samples and densities of the lamps.
    #[inline]
    pub fn lights(&self, wavelengths: Wavelengths) -> LightQuery<'_> {
        LightQuery { lights: &self.lights, around: self.surroundings(wavelengths) }
    }

    /// The first surface along a ray.
    #[inline(always)]
    pub fn closest(&self, ray: &Ray) -> Option<SurfacePoint> {
        let hit: Hit = self.bvh.closest(ray)?;
        Some(self.surfaces.point(&hit, ray.origin, ray.direction))
    }

    /// Whether anything is hit along the ray.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.bvh.occluded(ray)
    }

    /// Whether nothing stands between two points, both already moved off their surfaces.
    #[inline]
    pub fn visible(&self, from: Vec3, to: Vec3) -> bool {
        !self.bvh.occluded(&Ray::between(from, to))
    }

    /// The BSDF at a point; where [`Scene::is_wrapped`] says so, [`Scene::placed`] knows it.
    #[inline(always)]
    pub fn bsdf(&self, point: &SurfacePoint, wavelengths: Wavelengths) -> Bsdf {
        let material = self.surfaces.shapes[point.shape as usize].material;
        bsdf_at(self.material(material), &self.textures_at(point), point.uv, wavelengths)
    }

    /// Whether the material of a point is more than one BSDF in its place.
    #[inline(always)]
    pub fn is_wrapped(&self, point: &SurfacePoint) -> bool {
        self.surfaces.shapes[point.shape as usize].is_wrapped
    }

    /// Whether chance decides what the material of a point is.
    #[inline(always)]
    pub fn is_mixed(&self, point: &SurfacePoint) -> bool {
        self.surfaces.shapes[point.shape as usize].is_mixed
    }

    /// The material of that index.
    #[inline(always)]
    pub(crate) fn material(&self, index: u32) -> &FlatMaterial {
        &self.materials[index as usize]
    }

    /// What is known of a shape's material.
    pub(crate) fn traits(&self, shape: u32) -> Traits {
        self.traits[self.surfaces.shapes[shape as usize].material as usize]
    }

    /// What is known of a material.
    pub(crate) fn traits_of(&self, material: MaterialId) -> Traits {
        self.traits[material.0 as usize]
    }

    /// The textures.
    #[inline(always)]
    pub(crate) fn textures(&self) -> TextureTable<'_> {
        TextureTable::new(&self.images)
    }

    /// The textures, at a point.
    #[inline(always)]
    pub(crate) fn textures_at<'a>(&'a self, point: &'a SurfacePoint) -> TextureTable<'a> {
        self.textures().at(Site::of(point, &self.surfaces))
    }

    /// The point as part of a lamp, if its shape is one.
    #[inline]
    pub fn lamp_at(&self, point: &SurfacePoint) -> Option<LightPoint> {
        let light = self.surfaces.shapes[point.shape as usize].light?;
        Some(LightPoint::on_surface(light, point))
    }

    /// Whether the point belongs to a lamp, one that emits along its normals alone included.
    #[inline]
    pub fn is_on_lamp(&self, point: &SurfacePoint) -> bool {
        let shape = &self.surfaces.shapes[point.shape as usize];
        shape.light.is_some() || shape.is_collimated
    }

    /// The radiance that a surface emits in a direction; black if it is no lamp.
    pub fn emitted(&self, point: &SurfacePoint, direction: Vec3, w: Wavelengths) -> Spectrum {
        self.lamp_at(point).map_or(Spectrum::ZERO, |p| self.lights(w).radiance(&p, direction))
    }

    /// Whether no ray that leaves the front of the shape meets the front of a surface, or a transparent one:
    /// looked at from a few dozen places.
    pub(crate) fn faces_nothing(&self, shape: usize) -> bool {
        self.probes(shape).is_some_and(|mut probes| {
            probes.all(|(p, u)| {
                let d = Frame::from_normal(p.normal).to_world(warp::cosine_hemisphere(u));
                let ray = Ray { origin: p.off_surface(d), direction: d, t_max: f32::INFINITY };
                self.closest(&ray).is_none_or(|q| q.normal.dot(d) > 0.0 && !self.traits(q.shape).has_a_back)
            })
        })
    }

    /// Whether another surface is hit in the place of the shape, from in front of it: looked at from a few dozen
    /// places.
    pub(crate) fn lies_in_another(&self, shape: usize) -> bool {
        self.probes(shape).is_some_and(|mut probes| {
            probes.any(|(p, _)| {
                let ray =
                    Ray { origin: p.off_surface(p.normal), direction: -p.normal, t_max: 3.0 * p.offset };
                self.closest(&ray).is_some_and(|q| q.shape as usize != shape)
            })
        })
    }

    /// Points of a mesh, each with two numbers to choose a direction by; `None` for spheres.
    fn probes(&self, shape: usize) -> Option<impl Iterator<Item = (SurfacePoint, [f32; 2])>> {
        let flat = self.surfaces.shapes[shape];
        if self.surfaces.sphere(flat.first_primitive).is_some() {
            return None;
        }
        let probes = 64_u32;
        let mut stream = SampleStream::new(StreamId { seed: 0, pixel: shape as u32, sample: 0, walk: 0 });
        Some((0..probes).map(move |i| {
            // In 64 bits, because a shape may have 2²⁷ triangles.
            let share = u64::from(i) * u64::from(flat.primitive_count) / u64::from(probes);
            let triangle = flat.first_primitive + (share as u32).min(flat.primitive_count - 1);
            let [b1, b2] = warp::uniform_triangle(stream.next_2d());
            (self.surfaces.triangle_point(triangle, b1, b2), stream.next_2d())
        }))
    }

    /// The surface tables.
    pub fn surfaces(&self) -> &Surfaces {
        &self.surfaces
    }

    /// The tree.
    pub fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// The images.
    pub fn images(&self) -> &[Image] {
        &self.images
    }

    /// The lamps.
    pub fn lamps(&self) -> &Lights {
        &self.lights
    }

    /// Where mirrors and glass are.
    pub fn casters(&self) -> &Casters {
        &self.casters
    }

    /// The largest radiance that can be seen directly, of any lamp and channel; zero if lamps have no extent.
    pub fn brightest(&self) -> f32 {
        self.brightest
    }

    fn brightest_of(&self, description: &Description) -> f32 {
        let of_image =
            |i: ImageId| self.images[i.0 as usize].pixels.iter().fold(0.0_f32, |m, p| m.max(p.max_channel()));
        let of_texture = |(shape, t): (usize, &Texture)| match t {
            Texture::Constant(c) => c.max_channel(),
            Texture::Checkerboard { value1, value2, .. } => value1.max_channel().max(value2.max_channel()),
            Texture::Image { image, .. } => of_image(*image),
            Texture::Attribute { attribute, scale } => {
                let values = self.surfaces.attribute_values(*attribute, shape as u32);
                values.iter().fold(0.0_f32, |m, v| m.max(v.max_channel())) * scale
            }
        };
        let emissions = description.shapes.iter().enumerate();
        let surfaces = emissions.filter_map(|(i, s)| Some((i, s.emission.as_ref()?))).map(of_texture);
        let environments = description.lights.iter().map(|l| match l.kind {
            LightKind::Constant { radiance } => radiance.max_channel(),
            LightKind::Environment { image, scale, .. } => of_image(image) * scale,
            _ => 0.0,
        });
        let daylight = self.lights.iter().map(|l| match l {
            Light::Environment(l) => l.brightest(),
            _ => 0.0,
        });
        surfaces.chain(environments).chain(daylight).fold(0.0, f32::max)
    }

    /// Centre and radius of a sphere around all surfaces.
    pub fn bounding_sphere(&self) -> (Vec3, f32) {
        (self.center, self.radius)
    }
}
