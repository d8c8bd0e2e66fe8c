//! Where the camera shows a path, and with which density.

use caustica_math::{Frame, Vec2, warp};
use caustica_scene::Scene;
use caustica_scene::camera::{CameraLink, Joins};
use caustica_transport::Contribution;

use super::{Node, distance, dot, narrow, plus, wide};

/// Film area in pixels per solid angle (or area) of the camera's rays to `seen`, from the camera's point on the
/// path. Checks that it is seen where the contribution says.
pub(super) fn film_density(scene: &Scene, c: &Contribution<'_>, seen: &Node<'_>) -> Result<f64, String> {
    let camera = &scene.camera;
    if camera.joins() == Joins::Nothing {
        return Ok(1.0);
    }
    if camera.response() != 1.0 {
        return meter_density(scene, c, seen);
    }
    let link = |u: [f32; 2]| -> Result<CameraLink, String> {
        let at = narrow(seen.at);
        let link = if seen.infinite { camera.connect_direction(at, u) } else { camera.connect(at, u) };
        link.ok_or_else(|| "the camera cannot see the path".into())
    };
    // The lens is spanned by where these samples of the unit square lie on it.
    let center = wide(link([0.5; 2])?.point.at);
    let radius = |u| link(u).map(|l| plus(wide(l.point.at), center, -1.0));
    let (x, y) = (radius([1.0, 0.5])?, radius([0.5, 1.0])?);
    let area = dot(x, x);
    let mut u = [0.5; 2];
    if area > 0.0 {
        let d = plus(wide(c.path.camera.at), center, -1.0);
        u = warp::inverse_concentric_disk(Vec2::new((dot(d, x) / area) as f32, (dot(d, y) / area) as f32));
    }
    let link = link(u)?;
    if distance(wide(link.point.at), wide(c.path.camera.at)) > 1e-3 {
        return Err("the camera's point is not on the lens".into());
    }
    // At the poles of a 360° picture, rounding of a direction moves far.
    let near = |a: &Vec2| (a.x - link.film.x).hypot(a.y - link.film.y) < 0.02 + 1e-6 * link.pdf.get();
    if !camera.aliases(c.film, 1e6).any(|a| near(&a)) {
        return Err(format!("seen at {:?} and not at {:?}", link.film, c.film));
    }
    Ok(link.pdf.get().into())
}

/// The same of an irradiance meter that is flat: cosines of directions above it, which each pixel maps to a disk by
/// the concentric map.
fn meter_density(scene: &Scene, c: &Contribution<'_>, seen: &Node<'_>) -> Result<f64, String> {
    let at = wide(c.path.camera.at);
    let camera = Node { at, infinite: false, normal: None, offset: 0.0, surface: None };
    let (direction, normal) = (camera.to(seen).0, scene.camera.forward());
    let within = [c.film.x.fract(), c.film.y.fract()];
    let shown = Frame::from_normal(normal).to_world(warp::cosine_hemisphere(within));
    if distance(wide(shown), direction) > 2e-3 {
        return Err(format!("{direction:?} is seen at {within:?}"));
    }
    Ok(dot(direction, wide(normal)).max(0.0) * std::f64::consts::FRAC_1_PI)
}
