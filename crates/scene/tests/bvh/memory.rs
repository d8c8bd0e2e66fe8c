//! How much room a tree takes.

use crate::soups::bodies::ball;
use caustica_math::Vec3;
use caustica_scene::bvh::{Bvh, TreeQuality};

/// A body of two hundred thousand triangles, by itself and with long ones across it.
#[test]
fn a_large_mesh_takes_at_most_60_bytes_a_triangle() {
    let mut mesh = ball(130);
    let most = |mesh: &caustica_scene::description::Mesh, quality, bytes: usize| {
        let tree = Bvh::with_quality(&mesh.positions, &mesh.triangles, &[], quality);
        let count = mesh.triangles.len();
        assert!(tree.memory() <= bytes * count, "{} bytes for {count} triangles", tree.memory());
    };
    most(&mesh, TreeQuality::Fast, 60);
    for i in 0..10_000 {
        let (first, t) = (mesh.positions.len() as u32, i as f32 * 1e-4);
        mesh.positions.extend([Vec3::splat(-1.0), Vec3::new(1.0, t, 1.0), Vec3::new(1.0, 0.9 * t, 0.9)]);
        mesh.triangles.push([first, first + 1, first + 2]);
    }
    most(&mesh, TreeQuality::Fast, 60);
    // Three in ten more references.
    most(&mesh, TreeQuality::Spatial, 78);
}
