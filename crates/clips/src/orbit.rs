//! A camera that swings around what it looks at.

use caustica_film::{LightImage, Window};
use caustica_math::{Transform, Vec3};
use caustica_render::{Control, RenderOptions, Session};
use caustica_scene::bvh::Ray;
use caustica_scene::camera::Camera;
use caustica_scene::description::{self, FilmSettings};
use caustica_scene::{Diagnostic, Scene};
use caustica_transport::Settings;
use caustica_video::{Summary, caption};
use libm::sin;

use crate::converge::duration;
use crate::reel::{ClipError, ClipOptions, Reel, Step, size_of};

/// How the camera moves.
#[derive(Clone, Debug)]
pub struct Orbit {
    /// The integrator, and samples per pixel of every frame.
    pub render: RenderOptions,
    /// The whole angle in degrees: 360 goes round once, less swings there and back, as a sine does. A clip of these, or
    /// of whole turns, can be played in a loop.
    pub degrees: f64,
    /// The point that the camera goes around; what its middle shows if `None`.
    pub centre: Option<Vec3>,
}

/// Renders one picture a frame, each of its own seed. The camera goes around the vertical through the centre: the axis
/// of coordinates that is nearest to the camera's own.
///
/// # Errors
/// A film that does not fit into memory, and what encoding and writing say.
pub fn orbit(
    scene: &mut Scene,
    (camera, what): (&description::Camera, &Orbit),
    options: &ClipOptions,
    control: &Control,
    progress: impl FnMut(Step),
) -> Result<Summary, ClipError> {
    let before = scene.camera.clone();
    let mut reel = Reel::new(options, control, (size_of(scene), options.frames()), progress)?;
    let swung = swing(scene, (camera, what), options, (control, &mut reel));
    scene.camera = before;
    swung.and_then(|()| reel.finish())
}

/// Adds all frames.
fn swing<P: FnMut(Step)>(
    scene: &mut Scene,
    (camera, what): (&description::Camera, &Orbit),
    options: &ClipOptions,
    (control, reel): (&Control, &mut Reel<'_, P>),
) -> Result<(), ClipError> {
    let centre = what.centre.unwrap_or_else(|| looked_at(scene));
    let axis = nearest_axis(camera.to_world.vector(Vec3::Y));
    let frames = options.frames();
    for frame in 0..frames {
        if reel.is_stopped() {
            break;
        }
        let turned = turned(camera, centre, (axis, angle(what.degrees, frame, frames)));
        scene.camera = place(&turned, &scene.film)?;
        let seed = what.render.settings.seed.wrapping_add(u64::from(frame));
        let settings = Settings { seed, ..what.render.settings.clone() };
        let session = Session::new(scene, RenderOptions { settings, ..what.render.clone() })?;
        let report = session.run(control, |_| ())?;
        let picture = session.film().develop_without_bars();
        let Window { width, height, .. } = picture.window;
        let mut canvas = options.show(&picture.combined(LightImage::On), [width, height])?;
        let samples = picture.eye_samples.max(picture.light_samples);
        caption(&mut canvas, &options.title, &format!("{samples} spp   {}", duration(report.seconds)));
        reel.push(&canvas)?;
    }
    Ok(())
}

/// What the middle of the picture shows; where nothing is, a point at the distance of the scene's middle.
fn looked_at(scene: &Scene) -> Vec3 {
    let (origin, direction) = (scene.camera.position(), scene.camera.forward());
    let ray = Ray { origin, direction, t_max: f32::INFINITY };
    let (middle, _) = scene.bounding_sphere();
    let distance = (middle - origin).dot(direction).max(0.0);
    scene.closest(&ray).map_or(origin + direction * distance, |p| p.position)
}

fn nearest_axis(up: Vec3) -> [f64; 3] {
    let size = up.abs();
    if size.y >= size.x && size.y >= size.z {
        [0.0, 1.0, 0.0]
    } else if size.z >= size.x {
        [0.0, 0.0, 1.0]
    } else {
        [1.0, 0.0, 0.0]
    }
}

/// The angle of a frame in degrees.
fn angle(degrees: f64, frame: u32, frames: u32) -> f64 {
    let phase = f64::from(frame) / f64::from(frames);
    if degrees.abs() >= 360.0 { degrees * phase } else { degrees * 0.5 * sin(std::f64::consts::TAU * phase) }
}

fn turned(
    camera: &description::Camera,
    centre: Vec3,
    (axis, degrees): ([f64; 3], f64),
) -> description::Camera {
    let c = centre.to_array().map(f64::from);
    let around = Transform::translate(c.map(|x| -x)).then(Transform::rotate(degrees, axis));
    let to_world = camera.to_world.then(around.then(Transform::translate(c)));
    description::Camera { to_world, ..camera.clone() }
}

fn place(camera: &description::Camera, film: &FilmSettings) -> Result<Camera, ClipError> {
    Camera::new(camera, film).map_err(|d: Diagnostic| ClipError::Camera(Box::new(d)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_turn_around_the_centre() {
        let camera = description::Camera {
            to_world: Transform::look_at([0.0, 1.0, -4.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            ..Default::default()
        };
        let centre = Vec3::new(0.0, 0.5, 0.0);
        let turned = turned(&camera, centre, ([0.0, 1.0, 0.0], 90.0));
        let at = turned.to_world.point(Vec3::ZERO);
        assert!((at - Vec3::new(-4.0, 1.0, 0.0)).length_squared() < 1e-9, "{at:?}");
        let forward = turned.to_world.vector(Vec3::Z);
        assert!(forward.dot(Vec3::new(4.0, -1.0, 0.0).normalized()) > 0.999, "{forward:?}");
    }

    #[test]
    fn swings_begin_and_end_in_the_middle() {
        assert_eq!(angle(40.0, 0, 100), 0.0);
        assert!((angle(40.0, 25, 100) - 20.0).abs() < 1e-9 && (angle(40.0, 75, 100) + 20.0).abs() < 1e-9);
        assert_eq!((angle(360.0, 0, 4), angle(360.0, 1, 4), angle(-720.0, 3, 4)), (0.0, 90.0, -540.0));
        assert_eq!(nearest_axis(Vec3::new(0.1, -0.9, 0.3)), [0.0, 1.0, 0.0]);
        assert_eq!(nearest_axis(Vec3::new(0.1, 0.2, 0.8)), [0.0, 0.0, 1.0]);
    }
}
