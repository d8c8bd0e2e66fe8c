//! Scenes that do not fit are refused before anything is allocated, with the figures.

use caustica_math::{Rgb, Vec3};
use caustica_scene::bvh::TreeQuality;
use caustica_scene::description::{CameraKind, Daylight, Geometry, Image, LightKind, Mesh};
use caustica_scene::memory::needed;
use caustica_scene::{Cause, Description, MemoryLimit, Scene};
use caustica_testkit::build;

/// A row of `n` triangles.
fn row(n: u32) -> Mesh {
    let corner = |i: u32| Vec3::new(i as f32, (i % 2) as f32, 5.0);
    Mesh {
        positions: (0..n + 2).map(corner).collect(),
        triangles: (0..n).map(|i| [i, i + 1, i + 2]).collect(),
        ..Mesh::default()
    }
}

fn scene(n: u32) -> Description {
    let mut d = build::scene(4);
    let m = build::diffuse(&mut d, 0.5);
    build::add(&mut d, "row", Geometry::Mesh(row(n)), m);
    build::point_light(&mut d, [0.0; 3], 1.0);
    d
}

fn within(d: &Description, bytes: u64) -> Result<(), String> {
    let made = Scene::within(d.clone(), TreeQuality::Fast, MemoryLimit::Bytes(bytes));
    made.map(|_| ()).map_err(|e| {
        assert_eq!(e.cause, Cause::Memory);
        e.to_string()
    })
}

#[test]
fn what_is_needed_decides() {
    let d = scene(20_000);
    let bytes = needed(&d, TreeQuality::Fast);
    assert!((2_000_000..4_000_000).contains(&bytes), "{bytes}");
    within(&d, bytes).unwrap();
    let expected = format!(
        "the scene needs {} MB of memory, and {} MB are there",
        bytes.div_ceil(1_000_000),
        (bytes - 1) / 1_000_000
    );
    assert_eq!(within(&d, bytes - 1), Err(expected));
    assert!(needed(&d, TreeQuality::Spatial) > bytes);
}

/// A meter has a table of the triangles that it stands on: what it needs is what is left to it, to the byte.
#[test]
fn meters_need_more() {
    let plain = scene(20_000);
    let mut d = plain.clone();
    d.camera.kind = CameraKind::IrradianceMeter { shape: 0 };
    (d.film.width, d.film.height) = (1, 1);
    let [before, bytes] = [&plain, &d].map(|d| needed(d, TreeQuality::Fast));
    // Corners, a normal and a distance, and the choice.
    assert!((20_000 * 56..20_000 * 100).contains(&(bytes - before)), "{} more", bytes - before);
    within(&d, bytes).unwrap();
    assert!(within(&d, before).unwrap_err().contains("the scene needs"));
}

/// Glass is looked at for gaps, lamps and environments have tables.
#[test]
fn glass_lamps_and_environments_need_more() {
    let plain = scene(20_000);
    let more = |change: fn(&mut Description)| {
        let mut d = plain.clone();
        change(&mut d);
        needed(&d, TreeQuality::Fast) > needed(&plain, TreeQuality::Fast)
    };
    assert!(more(|d| {
        d.materials[0].kind = caustica_testkit::scenes::glass_kind(false);
        // Of one large mesh the tree needs more.
        d.shapes[0].emission = Some(Rgb::WHITE.into());
        build::emit(d, 0, 1.0);
        for _ in 0..20_000 {
            d.lights.push(d.lights[0].clone());
        }
    }));
    assert!(more(|d| {
        let pixels = vec![Rgb::WHITE; 1000 * 500].into();
        let image = d.add_image(Image { width: 1000, height: 500, pixels });
        let kind = LightKind::Environment {
            image,
            to_world: Default::default(),
            scale: 1.0,
            rows: Default::default(),
        };
        (0..10).for_each(|_| build::light(d, kind));
    }));
    assert!(more(|d| {
        let daylight = Daylight { to_world: Default::default(), to_sun: [0.0, 0.0, 1.0], turbidity: 3.0 };
        let sky = LightKind::Sky { daylight, albedo: Rgb::WHITE, scale: 1.0 };
        (0..1000).for_each(|_| build::light(d, sky));
    }));
}
