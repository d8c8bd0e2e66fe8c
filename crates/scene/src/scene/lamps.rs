//! Lamps that are not surfaces, from their descriptions.

use caustica_math::{Frame, Rgb, Transform, Vec3, Wavelengths};

use super::Scene;
use crate::camera::shears;
use crate::description::{Daylight, EnvironmentRows, ImageId, LightKind, Texture};
use crate::light::{
    AreaLight, DirectionalLight, EnvironmentLight, EnvironmentMap, Falloff, Heaven, LEAST_APERTURE, Light,
    ProjectorLight, SkyLight, SpotLight, SunLight, power_through_disk,
};
use crate::surface::is_reachable;

/// A lamp and its power in W; `None` if it emits nothing. Or why it cannot be one.
type Made = Result<Option<(Light, f64)>, &'static str>;

impl Scene {
    /// The lamp and its power.
    pub(super) fn flatten_light(&self, kind: &LightKind, w: Wavelengths) -> Made {
        let luminance = |s| f64::from(w.luminance(s));
        let around = self.surroundings(w);
        let lamp = match *kind {
            LightKind::Point { position, intensity } => {
                let intensity = colour(intensity, w)?;
                let power = 4.0 * std::f64::consts::PI * luminance(intensity);
                (Light::Point { position: place(position.into())?, intensity }, power)
            }
            LightKind::Spot { position, direction, intensity, inner_angle, outer_angle } => {
                let frame = Frame::from_normal(unit(direction)?);
                let degrees = cone([inner_angle, outer_angle])?;
                let at = place(position.into())?;
                let spot = SpotLight::new((at, frame), colour(intensity, w)?, degrees, Falloff::Smooth);
                (Light::Spot(spot), spot.power(&around))
            }
            LightKind::LinearSpot { to_world, intensity, picture, inner_angle, outer_angle } => {
                let [x, y, z] = axes(&to_world)?;
                let degrees = cone([inner_angle, outer_angle])?;
                let at = place(to_world.point(Vec3::ZERO))?;
                let mut spot =
                    SpotLight::new((at, Frame { x, y, z }), colour(intensity, w)?, degrees, Falloff::Linear);
                if let Some(picture) = picture {
                    if outer_angle >= 90.0 {
                        return Err("a spot of 90 degrees or more cannot shine through a picture");
                    }
                    spot = spot.behind(picture);
                }
                (Light::Spot(spot), spot.power(&around))
            }
            LightKind::Projector { to_world, irradiance, scale, fov, aspect } => {
                return self.projector(&to_world, (irradiance, scale), [fov, aspect], w);
            }
            LightKind::Collimated { shape, exitance } => return self.collimated(shape, exitance, w),
            LightKind::Directional { direction, irradiance } => {
                let irradiance = colour(irradiance, w)?;
                let power = power_through_disk(luminance(irradiance), self.radius);
                (Light::Directional(DirectionalLight { direction: unit(direction)?, irradiance }), power)
            }
            LightKind::Constant { radiance } => {
                self.environment_lamp(EnvironmentLight::Constant(colour(radiance, w)?), w)
            }
            LightKind::Environment { image, to_world, scale, rows } => {
                return self.environment(image, &to_world, (scale, rows), w);
            }
            LightKind::Sky { daylight, albedo, scale } => return self.sky(&daylight, albedo, scale, w),
            LightKind::Sun { daylight, aperture, scale, darkened } => {
                return self.sun(&daylight, (aperture, scale, darkened), w);
            }
        };
        Ok(Some(lamp))
    }

    fn environment(
        &self,
        image: ImageId,
        to_world: &Transform,
        (scale, rows): (f32, EnvironmentRows),
        w: Wavelengths,
    ) -> Made {
        let axis = |a| to_world.vector(a).try_normalized();
        let (Some(x), Some(y), Some(z)) = (axis(Vec3::X), axis(Vec3::Y), axis(Vec3::Z)) else {
            return Err("the environment's transform cannot be inverted");
        };
        if shears([x, y, z]) {
            return Err("the environment's transform shears space: its axes must be at right angles");
        }
        if !(scale >= 0.0 && scale.is_finite()) {
            return Err("the environment's scale must be finite and not negative");
        }
        let pixels = &self.images[image.0 as usize];
        let Some(map) = EnvironmentMap::new(image.0, pixels, (scale, rows), [x, y, z]) else {
            return Ok(None);
        };
        Ok(Some(self.environment_lamp(EnvironmentLight::Map(Box::new(map)), w)))
    }

    fn environment_lamp(&self, light: EnvironmentLight, w: Wavelengths) -> (Light, f64) {
        let power = power_through_disk(light.flux(&self.surroundings(w)), self.radius);
        (Light::Environment(light), power)
    }

    fn sky(&self, daylight: &Daylight, albedo: Rgb, scale: f32, w: Wavelengths) -> Made {
        let heaven = heaven(daylight, scale)?;
        if !(albedo.is_valid() && albedo.max_channel() <= 1.0) {
            return Err("the albedo of the ground must be from 0 to 1");
        }
        if !heaven.is_day() {
            return Ok(None);
        }
        let sky = SkyLight::new(heaven, albedo, scale);
        Ok(sky.map(|sky| self.environment_lamp(EnvironmentLight::Sky(Box::new(sky)), w)))
    }

    fn sun(
        &self,
        daylight: &Daylight,
        (aperture, scale, darkened): (f32, f32, bool),
        w: Wavelengths,
    ) -> Made {
        let heaven = heaven(daylight, scale)?;
        if !(LEAST_APERTURE..180.0).contains(&aperture) {
            return Err("the sun's aperture must be from 0.01 degrees on and less than 180");
        }
        if !heaven.is_day() {
            return Ok(None);
        }
        let sun = SunLight::new(&heaven, aperture, scale, darkened);
        Ok(Some(self.environment_lamp(EnvironmentLight::Sun(Box::new(sun)), w)))
    }

    fn projector(
        &self,
        to_world: &Transform,
        (irradiance, scale): (Texture, f32),
        [fov, aspect]: [f32; 2],
        w: Wavelengths,
    ) -> Made {
        if !(scale >= 0.0 && scale.is_finite()) {
            return Err("a projector's scale must be finite and not negative");
        }
        if !(fov > 0.0 && fov < 180.0) {
            return Err("a projector's angle must lie between 0 and 180 degrees");
        }
        if !(aspect > 1e-4 && aspect < 1e4) {
            return Err("a projector's picture must have a width and a height that are not too different");
        }
        let half = caustica_math::elementary::tan(0.5 * fov.to_radians());
        let frame = (place(to_world.point(Vec3::ZERO))?, axes(to_world)?);
        let picture = (irradiance, scale);
        let lamp = ProjectorLight::new(frame, [half, half / aspect], picture, &self.surroundings(w));
        Ok(lamp.map(|lamp| {
            let power = lamp.power();
            (Light::Projector(Box::new(lamp)), power)
        }))
    }

    fn collimated(&self, shape: u32, exitance: Texture, w: Wavelengths) -> Made {
        let flat = self.surfaces.shapes[shape as usize];
        if flat.light.is_some() {
            return Err("a shape cannot both be a lamp and emit along its normals");
        }
        let lamp = AreaLight::new(&flat, exitance, &self.surroundings(w));
        // By its normals goes 1/π of what goes everywhere.
        Ok(lamp.map(|(lamp, power)| (Light::Collimated(lamp), power / std::f64::consts::PI)))
    }
}

fn heaven(daylight: &Daylight, scale: f32) -> Result<Heaven, &'static str> {
    if !(scale >= 0.0 && scale.is_finite()) {
        return Err("a factor on daylight must be finite and not negative");
    }
    Heaven::new(axes(&daylight.to_world)?, daylight)
}

fn unit(direction: [f32; 3]) -> Result<Vec3, &'static str> {
    Vec3::from(direction).try_normalized().ok_or("the lamp's direction must not be zero")
}

fn place(at: Vec3) -> Result<Vec3, &'static str> {
    if is_reachable(at) { Ok(at) } else { Err("the lamp's position must be finite, and within 1e15") }
}

fn colour(c: Rgb, w: Wavelengths) -> Result<caustica_math::Spectrum, &'static str> {
    if c.is_valid() { Ok(w.spectrum(c)) } else { Err("a lamp's colour must be finite and not negative") }
}

/// The half angles of a spot.
fn cone([inner, outer]: [f32; 2]) -> Result<[f32; 2], &'static str> {
    if 0.0 <= inner && inner <= outer && outer <= 180.0 && outer > 0.0 {
        Ok([inner, outer])
    } else {
        Err("a spot's angles must satisfy 0 ≤ inner ≤ outer ≤ 180 degrees")
    }
}

/// The unit axes of a lamp's frame.
fn axes(to_world: &Transform) -> Result<[Vec3; 3], &'static str> {
    let axis = |a| to_world.vector(a).try_normalized();
    let (Some(x), Some(y), Some(z)) = (axis(Vec3::X), axis(Vec3::Y), axis(Vec3::Z)) else {
        return Err("the lamp's transform cannot be inverted");
    };
    if shears([x, y, z]) {
        return Err("the lamp's transform shears space: its axes must be at right angles");
    }
    Ok([x, y, z])
}
