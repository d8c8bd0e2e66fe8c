//! Scenes at other scales.

use caustica_math::Transform;
use caustica_scene::Description;
use caustica_scene::description::{CameraKind, LightKind};

/// The same scene `k` times as large, lit so that its picture is the same.
#[must_use]
pub fn scaled(mut d: Description, k: f32) -> Description {
    let by_k = Transform::scale([f64::from(k); 3]);
    d.camera.to_world = d.camera.to_world.then(by_k);
    d.camera.near *= k;
    d.camera.far *= k;
    if let CameraKind::ThinLens { aperture_radius, focus_distance, .. } = &mut d.camera.kind {
        *aperture_radius *= k;
        *focus_distance *= k;
    }
    for shape in &mut d.shapes {
        shape.to_world = shape.to_world.then(by_k);
    }
    for light in &mut d.lights {
        if let LightKind::Point { position, intensity } | LightKind::Spot { position, intensity, .. } =
            &mut light.kind
        {
            position.iter_mut().for_each(|c| *c *= k);
            *intensity = *intensity * (k * k);
        }
    }
    d
}
