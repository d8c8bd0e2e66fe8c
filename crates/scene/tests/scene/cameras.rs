//! What a camera's rays show is what connections to the camera find: the same place of the film, direction and
//! density; and the density is the film's.
//!
//! The χ² tests together have the significance level 0.01 (Šidák); seeds are fixed.

use caustica_math::stats::sidak;
use caustica_math::{SampleStream, StreamId, Transform, Vec2, Vec3};
use caustica_scene::camera::{Camera, CameraRay, Joins};
use caustica_scene::description::{self, CameraKind, FilmSettings, Geometry, MaterialId, Mesh, Shape};
use caustica_scene::surface::Surfaces;
use caustica_testkit::chi_square::{ChiSquareConfig, chi_square_sphere};
use caustica_testkit::seed::seed;

const SIZE: [f32; 2] = [40.0, 24.0];

fn film() -> FilmSettings {
    FilmSettings { width: SIZE[0] as u32, height: SIZE[1] as u32, ..FilmSettings::default() }
}

fn camera_at(kind: CameraKind, to_world: Transform) -> Camera {
    let description = description::Camera { kind, to_world, near: 0.5, far: 80.0, ..Default::default() };
    Camera::among(&ground(), &description, &film()).unwrap()
}

/// What irradiance meters stand on: a plate that looks along (1, 2, 2)/3, of two triangles with the areas 1.5 (where
/// x > 0) and 3; and a ball.
fn ground() -> Surfaces {
    let positions = [[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-4.0, 2.0, 1.0]].map(Vec3::from);
    let mesh = Mesh { positions: positions.into(), triangles: vec![[0, 1, 2], [1, 3, 2]], ..Mesh::default() };
    let ball = Geometry::Sphere { center: Vec3::new(0.5, -1.0, 2.0), radius: 0.75 };
    let shape = |geometry| Shape {
        name: "ground".into(),
        geometry,
        to_world: Transform::IDENTITY,
        material: MaterialId(0),
        emission: None,
        origin: None,
    };
    Surfaces::new(&mut [shape(Geometry::Mesh(mesh)), shape(ball)], &mut Vec::new()).unwrap()
}

fn camera(kind: CameraKind) -> Camera {
    // The scale must not matter, except to parallel projection.
    let place = Transform::look_at([3.0, -2.0, 1.0], [-4.0, 1.0, 6.0], [0.2, 1.0, 0.1]);
    camera_at(kind, Transform::scale([2.0; 3]).then(place))
}

/// Which kind comes after a kind: a missing one does not compile.
fn next(kind: Option<CameraKind>) -> Option<CameraKind> {
    match kind {
        None => Some(CameraKind::Perspective { fov: 70.0 }),
        Some(CameraKind::Perspective { .. }) => {
            Some(CameraKind::ThinLens { fov: 35.0, aperture_radius: 0.4, focus_distance: 5.0 })
        }
        Some(CameraKind::ThinLens { .. }) => Some(CameraKind::Orthographic),
        Some(CameraKind::Orthographic) => Some(CameraKind::Environment),
        Some(CameraKind::Environment) => Some(CameraKind::RadianceMeter),
        Some(CameraKind::RadianceMeter) => Some(CameraKind::IrradianceMeter { shape: 0 }),
        Some(CameraKind::IrradianceMeter { shape: 0 }) => Some(CameraKind::IrradianceMeter { shape: 1 }),
        Some(CameraKind::IrradianceMeter { .. }) => None,
    }
}

fn all() -> impl Iterator<Item = CameraKind> {
    std::iter::successors(next(None), |k| next(Some(*k)))
}

/// Those that show pictures.
fn kinds() -> impl Iterator<Item = CameraKind> {
    all().filter(|k| !k.is_meter())
}

/// Those that light paths can be joined with.
fn joinable() -> impl Iterator<Item = CameraKind> {
    all().filter(|k| *k != CameraKind::RadianceMeter)
}

/// The distance of two film positions; all pixels of an irradiance meter are one.
fn apart(camera: &Camera, a: Vec2, b: Vec2) -> f32 {
    let distance = |a: Vec2| (a.x - b.x).abs().max((a.y - b.y).abs());
    if camera.response() == 1.0 {
        return distance(a);
    }
    camera.aliases(a, 0.0).map(distance).fold(f32::INFINITY, f32::min)
}

fn random(name: u32) -> SampleStream {
    SampleStream::new(StreamId { seed: seed(5), pixel: name, sample: 0, walk: 0 })
}

fn on_film([x, y]: [f32; 2]) -> Vec2 {
    Vec2::new(x * SIZE[0], y * SIZE[1])
}

fn near(a: f32, b: f32, tolerance: f32) -> bool {
    (a - b).abs() <= tolerance * b.abs()
}

#[test]
fn connections_reverse_rays() {
    for kind in joinable() {
        let camera = camera(kind);
        let mut s = random(1);
        for _ in 0..5000 {
            let (film, u) = (on_film(s.next_2d()), s.next_2d());
            let ray = camera.ray(film, u);
            let t = (0.01 + 0.98 * s.next_1d()) * ray.t_max.min(80.0);
            let p = ray.origin + ray.direction * t;
            let link = camera.connect(p, u).expect("a point on a ray is seen");
            let name = format!("{kind:?} at {film:?}: {link:?} for {ray:?}");
            assert_eq!(link.point, ray.point, "{name}");
            assert!(apart(&camera, link.film, film) < 2e-3, "{name}");
            // A meter's rays start off its surface, by a few millionths.
            let blur = if kind.is_meter() { 1e-5 / t } else { 0.0 };
            assert!((link.direction + ray.direction).length() < 1e-5 + blur, "{name}");
            assert!((link.pdf.0 - ray.pdf.0).abs() < 1e-3 * ray.pdf.0 + blur, "{name}");
            assert!((link.end - ray.origin).length() < 2e-5, "{name}");
            let d2 = (p - ray.point.at).length_squared();
            assert!(near(link.falloff, if ray.point.infinite { 1.0 } else { 1.0 / d2 }, 1e-4), "{name}");
            assert_eq!(link.t_max, f32::INFINITY, "{name}");
            check_infinity(&camera, &ray, film, u);
        }
    }
}

/// A point infinitely far along a ray is seen at the same place, up to the same end.
fn check_infinity(camera: &Camera, ray: &CameraRay, film: Vec2, u: [f32; 2]) {
    let link = camera.connect_direction(ray.direction, u);
    if ray.point.infinite {
        assert!(link.is_none(), "two points at infinity cannot be joined");
        return;
    }
    let link = link.unwrap();
    assert_eq!(link.point, ray.point);
    assert_eq!(link.direction, -ray.direction);
    assert!(apart(camera, link.film, film) < 2e-3, "{film:?} {link:?}");
    assert!(near(link.pdf.0, ray.pdf.0, 1e-3) && link.falloff == 1.0, "{link:?} {ray:?}");
    let same_end = link.t_max == ray.t_max || near(link.t_max, ray.t_max, 1e-5);
    assert!((link.end - ray.origin).length() < 1e-5 && same_end);
    let behind = camera.connect_direction(-ray.direction, u);
    let around = camera.wraps() && camera.response() == 1.0;
    assert_eq!(behind.is_some(), around, "only a 360° picture shows what is behind");
}

/// Uniform places on the film have directions of the density that is told.
#[test]
fn densities_are_those_of_the_film() {
    let kinds: Vec<_> = joinable().filter(|k| *k != CameraKind::Orthographic).collect();
    let alpha = sidak(0.01, 2 * kinds.len());
    for kind in kinds {
        for lens in [[0.5, 0.5], [0.9, 0.2]] {
            let camera = camera(kind);
            // All pixels of a meter are the same.
            let area = if kind.is_meter() { 1.0 } else { f64::from(SIZE[0] * SIZE[1]) };
            let mut sample = |u: [f32; 3]| Some(camera.ray(on_film([u[0], u[1]]), lens).direction);
            let pdf = |d: Vec3| {
                let Some(link) = camera.connect_direction(d, lens) else { return 0.0 };
                let inside = (0.0..=SIZE[0]).contains(&link.film.x) && (0.0..=SIZE[1]).contains(&link.film.y);
                if inside { f64::from(link.pdf.0) / area } else { 0.0 }
            };
            let name = format!("{kind:?}, lens {lens:?}");
            let p = chi_square_sphere(&name, &mut sample, &pdf, ChiSquareConfig::default());
            let p = p.unwrap_or_else(|e| panic!("{e}"));
            assert!(p > alpha, "{name}: p = {p:e}");
        }
    }
}

/// With parallel projection the density is per area: the width of the picture is twice the scale.
#[test]
fn parallel_projection_has_the_scale_of_its_transform() {
    for scale in [0.5, 3.0] {
        let camera = camera_at(CameraKind::Orthographic, Transform::scale([scale; 3]));
        let [left, right] = [0.0, SIZE[0]].map(|x| camera.ray(Vec2::new(x, 12.0), [0.5; 2]));
        assert!((left.origin - Vec3::new(scale as f32, 0.0, 0.5)).length() < 1e-6, "{left:?}");
        assert!((right.origin - Vec3::new(-scale as f32, 0.0, 0.5)).length() < 1e-6, "{right:?}");
        assert_eq!((left.direction, right.direction), (Vec3::Z, Vec3::Z));
        let pixel = 2.0 * scale as f32 / SIZE[0];
        assert!(near(left.pdf.0, 1.0 / (pixel * pixel), 1e-5));
        let up = camera.ray(Vec2::new(20.0, 0.0), [0.5; 2]).origin.y;
        assert!(near(up, 12.0 * pixel, 1e-5), "pixels are square");
    }
}

/// What is nearer than the near plane or beyond the far one is neither hit by rays nor joined.
#[test]
fn clip_planes_are_the_same_both_ways() {
    for kind in kinds() {
        let camera = camera(kind);
        let mut s = random(2);
        for _ in 0..1000 {
            let (film, u) = (on_film(s.next_2d()), s.next_2d());
            let ray = camera.ray(film, u);
            let seen = |t: f32| camera.connect(ray.origin + ray.direction * t, u).is_some();
            assert!(seen(1e-3) && seen(ray.t_max - 1e-3), "{kind:?} at {film:?}");
            assert!(!seen(-1e-3) && !seen(ray.t_max + 1e-3), "{kind:?} at {film:?}");
            let behind = camera.connect(camera.position() - (ray.origin - camera.position()) * 4.0, u);
            assert_eq!(behind.is_some(), kind == CameraKind::Environment, "{kind:?} looks forward");
        }
    }
}

/// +x is to the left, +y up, +z ahead; the horizontal field of view is the one given.
#[test]
fn pictures_are_not_mirrored() {
    for kind in kinds() {
        let camera = camera_at(kind, Transform::IDENTITY);
        let middle = on_film([0.5, 0.5]);
        let at = |x: f32, y: f32| camera.connect(Vec3::new(x, y, 5.0), [0.5; 2]).unwrap().film;
        assert!((at(0.0, 0.0).x - middle.x).abs() < 1e-3 && (at(0.0, 0.0).y - middle.y).abs() < 1e-3);
        assert!(at(0.3, 0.0).x < middle.x - 0.1 && at(0.0, 0.3).y < middle.y - 0.1, "{kind:?}");
    }
    let camera = camera_at(CameraKind::Perspective { fov: 90.0 }, Transform::IDENTITY);
    let rim = camera.connect(Vec3::new(7.0, 0.0, 7.0), [0.5; 2]).unwrap().film;
    assert!(rim.x.abs() < 1e-4, "{rim:?}");
}

/// All rays through one place of the film meet in the plane that is in focus, and nowhere else.
#[test]
fn lenses_are_sharp_in_focus() {
    let kind = CameraKind::ThinLens { fov: 35.0, aperture_radius: 0.4, focus_distance: 5.0 };
    let camera = camera_at(kind, Transform::IDENTITY);
    let mut s = random(3);
    let film = Vec2::new(7.0, 5.0);
    let at = |z: f32, u: [f32; 2]| {
        let r = camera.ray(film, u);
        r.point.at + r.direction * ((z - r.point.at.z) / r.direction.z)
    };
    let (sharp, blurred) = (at(5.0, [0.5; 2]), at(10.0, [0.5; 2]));
    let (mut widest, mut lens) = (0.0_f32, 0.0_f32);
    for _ in 0..500 {
        let u = s.next_2d();
        assert!((at(5.0, u) - sharp).length() < 1e-5);
        widest = widest.max((at(10.0, u) - blurred).length());
        lens = lens.max(camera.ray(film, u).point.at.length());
    }
    assert!((0.35..0.4001).contains(&lens), "the lens has its radius: {lens}");
    assert!((0.35..0.4001).contains(&widest), "the circle of confusion at twice the distance: {widest}");
    let pinhole = camera_at(CameraKind::Perspective { fov: 35.0 }, Transform::IDENTITY);
    let central = pinhole.ray(film, [0.5; 2]);
    assert!((central.direction - camera.ray(film, [0.5; 2]).direction).length() < 1e-6);
}

/// A 360° picture continues beyond its seams and poles: aliases show the same direction.
#[test]
fn aliases_show_the_same() {
    let camera = camera_at(CameraKind::Environment, Transform::IDENTITY);
    let margin = 2.5;
    let mut s = random(4);
    let direction = |f: Vec2| camera.ray(f, [0.5; 2]).direction;
    for _ in 0..2000 {
        let film = on_film(s.next_2d());
        let all: Vec<_> = camera.aliases(film, margin).collect();
        assert_eq!(all.iter().filter(|f| **f == film).count(), 1, "itself, once");
        for f in &all {
            assert!((direction(*f) - direction(film)).length() < 1e-5, "{f:?} and {film:?}");
            assert!(all.iter().filter(|g| (**g - *f) == Vec2::default()).count() == 1, "{all:?}");
        }
        let [x, y] = [film.x, film.y];
        let beyond = |c: f32, size: f32| usize::from(c <= margin) + usize::from(c >= size - margin);
        let (columns, rows) = (beyond(x, SIZE[0]), beyond(y, SIZE[1]));
        // Across a pole, half a turn away, and there perhaps across the seam.
        let opposite = if x < SIZE[0] / 2.0 { x + SIZE[0] / 2.0 } else { x - SIZE[0] / 2.0 };
        assert_eq!(all.len(), 1 + columns + rows * (1 + beyond(opposite, SIZE[0])), "{film:?}: {all:?}");
    }
    for kind in kinds().filter(|k| *k != CameraKind::Environment) {
        let corner = Vec2::new(0.5, 0.5);
        assert_eq!(self::camera(kind).aliases(corner, margin).collect::<Vec<_>>(), [corner]);
    }
}

/// Directions next to the poles keep their place and density.
#[test]
fn poles_are_precise() {
    let camera = camera_at(CameraKind::Environment, Transform::IDENTITY);
    for y in [1e-4_f32, 1e-3, 1e-2, 0.1] {
        let film = Vec2::new(13.0, y);
        let ray = camera.ray(film, [0.5; 2]);
        let link = camera.connect(ray.origin + ray.direction, [0.5; 2]).unwrap();
        let far = camera.connect_direction(ray.direction, [0.5; 2]).unwrap();
        assert!(near(far.film.y, y, 1e-4) && near(far.pdf.0, ray.pdf.0, 1e-4), "{y}: {far:?} {ray:?}");
        assert!(near(link.film.y, y, 1e-2) && near(link.pdf.0, ray.pdf.0, 1e-2), "{y}: {link:?} {ray:?}");
    }
}

/// The principal point is where +z is seen; nothing else moves.
#[test]
fn lenses_can_be_shifted() {
    let pinhole = CameraKind::Perspective { fov: 60.0 };
    for kind in [Some(pinhole), next(Some(pinhole))].into_iter().flatten() {
        let place = |principal_point| {
            let d = description::Camera { kind, principal_point, ..Default::default() };
            Camera::new(&d, &film()).unwrap()
        };
        let (shifted, centred) = (place([0.25, 0.6]), place([0.5, 0.5]));
        let ahead = shifted.connect(Vec3::new(0.0, 0.0, 5.0), [0.5; 2]).unwrap().film;
        assert!(apart(&shifted, ahead, Vec2::new(10.0, 0.6 * SIZE[1])) < 1e-4, "{ahead:?}");
        let mut s = random(6);
        for _ in 0..1000 {
            let (film, u) = (on_film(s.next_2d()), s.next_2d());
            let moved = Vec2::new(film.x - 10.0, film.y + 0.1 * SIZE[1]);
            let (a, b) = (shifted.ray(moved, u), centred.ray(film, u));
            assert!(
                (a.direction - b.direction).length() < 1e-5 && near(a.pdf.0, b.pdf.0, 1e-4),
                "{a:?} {b:?}"
            );
            let link = shifted.connect(a.origin + a.direction * 3.0, u).unwrap();
            assert!(apart(&shifted, link.film, moved) < 2e-3 && near(link.pdf.0, a.pdf.0, 1e-3), "{link:?}");
        }
    }
}

/// A radiance meter has one ray, whatever the film position, and cannot be joined.
#[test]
fn radiance_meters_have_one_ray() {
    let camera = camera_at(CameraKind::RadianceMeter, Transform::translate([1.0, 2.0, 3.0]));
    let mut s = random(7);
    for _ in 0..100 {
        let (film, u) = (on_film(s.next_2d()), s.next_2d());
        let ray = camera.ray(film, u);
        assert_eq!((ray.origin, ray.direction, ray.t_max), (Vec3::new(1.0, 2.0, 3.5), Vec3::Z, 79.5));
        let ahead = ray.origin + ray.direction * s.next_1d();
        assert!(camera.connect(ahead, u).is_none() && camera.connect_direction(Vec3::Z, u).is_none());
    }
    let joins: Vec<Joins> = all().map(|k| camera_at(k, Transform::IDENTITY).joins()).collect();
    let [all, near, nothing] = [Joins::All, Joins::Near, Joins::Nothing];
    assert_eq!(joins, [all, all, near, all, nothing, all, all]);
}

/// The points of an irradiance meter are spread evenly over the area, and look off its surface; each pixel shows all
/// directions.
#[test]
fn irradiance_meters_cover_their_surface() {
    let n = 40_000;
    let [plate, ball] =
        [0, 1].map(|shape| camera_at(CameraKind::IrradianceMeter { shape }, Transform::IDENTITY));
    let (mut s, mut middle, mut small) = (random(8), Vec3::ZERO, 0);
    for i in 0..n {
        let (film, u) = (on_film(s.next_2d()), s.next_2d());
        let ray = plate.ray(film, u);
        let p = ray.point.at;
        assert!((p.x + 2.0 * p.y + 2.0 * p.z - 2.0).abs() < 1e-5, "{p:?} lies on the plate");
        assert!(ray.direction.dot(plate.forward()) > 0.0);
        small += u32::from(p.x > 0.0);
        let ray = ball.ray(film, u);
        let off = ray.point.at - Vec3::new(0.5, -1.0, 2.0);
        assert!((off.length() - 0.75).abs() < 1e-5 && off.dot(ray.direction) > 0.0, "{ray:?}");
        middle += off * (1.0 / n as f32);
        if i < 20 {
            let others: Vec<Vec2> = plate.aliases(film, 0.5).collect();
            assert_eq!(others.len(), (SIZE[0] * SIZE[1]) as usize);
            let direction = |f: Vec2| plate.ray(f, u).direction;
            assert!(others.iter().all(|f| (direction(*f) - direction(film)).length() < 1e-3));
        }
    }
    let (share, expected) = (f64::from(small) / f64::from(n), 1.0 / 3.0);
    assert!((share - expected).abs() < 4.0 * (expected * (1.0 - expected) / f64::from(n)).sqrt(), "{share}");
    assert!(middle.length() < 0.02, "{middle:?}");
    assert_eq!([plate.response(), ball.response()], [std::f32::consts::PI; 2]);
    let kind = CameraKind::IrradianceMeter { shape: 0 };
    let alone = Camera::new(&description::Camera { kind, ..Default::default() }, &film());
    assert!(alone.unwrap_err().to_string().contains("a shape of the scene"));
}
