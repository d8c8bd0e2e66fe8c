//! `<emitter type="sunsky">`: two lamps, a sky and the sun in it.
//!
//! Up is +z of the emitter's frame. The direction of the sun is given in the world, or follows from time and place by the
//! algorithm of Blanco-Muriel et al. ("Computing the Solar Vector", 2001). At noon, north of the tropics, the sun stands
//! over +x, and in the evening over +y.

use caustica_math::{Rgb, Vec3};
use caustica_scene::Diagnostic;
use caustica_scene::description::{Daylight, Light, LightKind};
use caustica_scene::light::{LEAST_APERTURE, SUN_DIAMETER};

use super::context::Context;
use super::fields::Fields;
use super::spectrum::Role;
use super::texture;
use super::tree::error;
use crate::nori::range::Bounds;

const WHEN_AND_WHERE: [&str; 9] =
    ["latitude", "longitude", "timezone", "year", "month", "day", "hour", "minute", "second"];

/// Puts both into the scene; neither at night, and none that is turned off.
pub(super) fn read(mut fields: Fields, cx: &mut Context) -> Result<(), Diagnostic> {
    let to_world = fields.transform("to_world")?;
    let to_sun = direction(&mut fields, |local| to_world.vector(local))?;
    let turbidity = fields.float("turbidity", 3.0, Bounds::Within(1.0, 10.0))?;
    let albedo = albedo(&mut fields, cx)?;
    let sun_scale = fields.float("sun_scale", 1.0, Bounds::NotNegative)?;
    let sky_scale = fields.float("sky_scale", 1.0, Bounds::NotNegative)?;
    let aperture = aperture(&mut fields)?;
    let darkened = fields.boolean("complex_sun", false)?;
    let is_day = to_sun.dot(to_world.vector(Vec3::Z)) >= 0.0;
    if !is_day {
        fields.warn("the sun is below the horizon: the emitter `sunsky` gives no light");
    } else if sun_scale == 0.0 && sky_scale == 0.0 {
        fields.warn("both the sun and the sky are turned off: the emitter `sunsky` gives no light");
    }
    let daylight = Daylight { to_world, to_sun: [to_sun.x, to_sun.y, to_sun.z], turbidity };
    let origin = Some(fields.object.origin.clone());
    let mut add = |kind, scale: f32| {
        if is_day && scale > 0.0 {
            cx.description.lights.push(Light { kind, origin: origin.clone() });
        }
    };
    add(LightKind::Sky { daylight, albedo, scale: sky_scale }, sky_scale);
    add(LightKind::Sun { daylight, aperture, scale: sun_scale, darkened }, sun_scale);
    fields.finish(cx);
    Ok(())
}

/// The direction to the sun in the world.
fn direction(fields: &mut Fields, to_world: impl Fn(Vec3) -> Vec3) -> Result<Vec3, Diagnostic> {
    let Some(given) = fields.direction("sun_direction")? else {
        return Ok(to_world(when_and_where(fields)?));
    };
    let is_second = |name: &str| WHEN_AND_WHERE.contains(&name);
    if let Some(second) = fields.object.properties.iter().find(|p| is_second(&p.name)) {
        let message = format!("`sun_direction` and `{}` cannot both be given", second.name);
        return Err(error(message, &second.origin)
            .hint("give the direction of the sun, or the time and the place that it follows from"));
    }
    Ok(Vec3::from(given))
}

fn albedo(fields: &mut Fields, cx: &mut Context) -> Result<Rgb, Diagnostic> {
    let albedo = texture::constant(fields, "albedo", Role::Reflectance, cx)?.unwrap_or(Rgb::splat(0.3));
    if albedo.max_channel() <= 1.0 {
        return Ok(albedo);
    }
    Err(error("`albedo` of the ground must be from 0 to 1", fields.place_of("albedo")))
}

/// In degrees. Suns that are too narrow are made wider, with the same light.
fn aperture(fields: &mut Fields) -> Result<f32, Diagnostic> {
    let aperture = fields.float("sun_aperture", SUN_DIAMETER, Bounds::Between(0.0, 180.0))?;
    if aperture < LEAST_APERTURE {
        let message = format!("`sun_aperture` is less than {LEAST_APERTURE}°, which is taken in its place");
        fields.warn_at(message, fields.place_of("sun_aperture"));
    }
    Ok(aperture.max(LEAST_APERTURE))
}

/// A time and a place on the earth.
struct Moment {
    /// Days since noon of 1 January 2000, Universal Time.
    days: f64,
    /// The hour of the day, Universal Time.
    hours: f64,
    latitude: f64,
    longitude: f64,
}

/// The unit direction to the sun in the emitter's frame.
fn when_and_where(fields: &mut Fields) -> Result<Vec3, Diagnostic> {
    let mut number = |name, default, bounds| fields.float(name, default, bounds).map(f64::from);
    let latitude = number("latitude", 35.6894, Bounds::Within(-90.0, 90.0))?;
    let longitude = number("longitude", 139.6917, Bounds::Within(-360.0, 360.0))?;
    let timezone = number("timezone", 9.0, Bounds::Within(-24.0, 24.0))?;
    let hour = number("hour", 15.0, Bounds::Within(-24.0, 48.0))?;
    let minute = number("minute", 0.0, Bounds::Within(-60.0, 120.0))?;
    let second = number("second", 0.0, Bounds::Within(-60.0, 120.0))?;
    let mut whole = |name, default, range| Ok(fields.integer(name, range)?.unwrap_or(default));
    let date = [whole("year", 2010, -4000..=4000)?, whole("month", 7, 1..=12)?, whole("day", 10, 1..=31)?];
    let hours = hour - timezone + (minute + second / 60.0) / 60.0;
    let days = julian_day(date) as f64 - 0.5 + hours / 24.0 - 2_451_545.0;
    Ok(sun(&Moment { days, hours, latitude, longitude }))
}

/// The number of the Julian day that begins at noon of a date of the Gregorian calendar (Fliegel and van Flandern, 1968).
fn julian_day([year, month, day]: [i64; 3]) -> i64 {
    let before_march = (month - 14) / 12;
    (1461 * (year + 4800 + before_march)) / 4 + (367 * (month - 2 - 12 * before_march)) / 12
        - (3 * ((year + 4900 + before_march) / 100)) / 4
        + day
        - 32075
}

/// The unit direction to the sun, +z up, +x and +y where the sun stands at noon and in the evening in the north.
fn sun(at: &Moment) -> Vec3 {
    use libm::{asin, atan2, cos, sin, tan};
    let days = at.days;
    let node = 2.1429 - 0.001_039_459_4 * days;
    let anomaly = 6.240_060_0 + 0.017_201_969_9 * days;
    let longitude = 4.895_063_0
        + 0.017_202_791_698 * days
        + 0.033_416_07 * sin(anomaly)
        + 0.000_348_94 * sin(2.0 * anomaly)
        - 0.000_113_4
        - 0.000_020_3 * sin(node);
    let obliquity = 0.409_092_8 - 6.214_0e-9 * days + 0.000_039_6 * cos(node);
    let right_ascension = atan2(cos(obliquity) * sin(longitude), cos(longitude));
    let declination = asin(sin(obliquity) * sin(longitude));
    let sidereal = (6.697_424_324_2 + 0.065_709_828_3 * days + at.hours) * 15.0;
    let hour_angle = (sidereal + at.longitude).to_radians() - right_ascension;
    let (sin_latitude, cos_latitude) = libm::sincos(at.latitude.to_radians());
    let height = cos_latitude * cos(hour_angle) * cos(declination) + sin(declination) * sin_latitude;
    let seen_from_centre = libm::acos(height.clamp(-1.0, 1.0));
    // The earth's radius over the distance of the sun.
    let parallax = 6_371.01 / 149_597_890.0 * sin(seen_from_centre);
    let (sin_zenith, cos_zenith) = libm::sincos(seen_from_centre + parallax);
    let azimuth = atan2(-sin(hour_angle), tan(declination) * cos_latitude - sin_latitude * cos(hour_angle));
    let (s, c) = libm::sincos(azimuth);
    Vec3::new((-sin_zenith * c) as f32, (-sin_zenith * s) as f32, cos_zenith as f32)
}
