//! A glass ball and its caustic: `cargo run --release -p caustica --example glass_ball -- ball` writes
//! `ball.exr` and `ball.png`.

use caustica::description::{CameraKind, Geometry, MaterialId, MaterialKind, Mesh, Shape};
use caustica::film::{Develop, ToneMap, write_exr, write_png};
use caustica::{Control, Description, LightImage, RenderOptions, Rgb, Scene, Session, Transform, Vec3};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    render(glass_ball([480, 360]), 128, &std::env::args().nth(1).unwrap_or("glass_ball".into()))
}

/// A ball of glass on a floor, between a small warm lamp and a large cool one.
pub fn glass_ball(size: [u32; 2]) -> Description {
    let mut scene = Description::default();
    [scene.film.width, scene.film.height] = size;
    scene.camera.kind = CameraKind::Perspective { fov: 34.0 };
    scene.camera.to_world = Transform::look_at([0.0, 2.6, -5.2], [-0.45, 0.45, 0.15], [0.0, 1.0, 0.0]);
    let glass = scene.add_material(MaterialKind::dielectric(1.52, 1.0));
    let clay = scene.add_material(MaterialKind::Diffuse { albedo: Rgb::new(0.56, 0.44, 0.36).into() });
    let black = scene.add_material(MaterialKind::Diffuse { albedo: Rgb::BLACK.into() });
    let ball = |x, y, z, radius| Geometry::Sphere { center: Vec3::new(x, y, z), radius };
    let corners = [[-40.0, -40.0], [-40.0, 40.0], [40.0, 40.0], [40.0, -40.0]];
    let floor = Mesh {
        positions: corners.map(|[x, z]| Vec3::new(x, 0.0, z)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    add(&mut scene, "floor", Geometry::Mesh(floor), clay, None);
    add(&mut scene, "ball", ball(0.0, 0.8, 0.0, 0.8), glass, None);
    add(&mut scene, "lamp", ball(2.6, 3.4, 0.9, 0.2), black, Some(Rgb::new(230.0, 195.0, 150.0)));
    add(&mut scene, "window", ball(-5.0, 6.0, -3.0, 1.0), black, Some(Rgb::new(4.0, 6.0, 9.0)));
    scene
}

fn add(scene: &mut Description, name: &str, geometry: Geometry, material: MaterialId, light: Option<Rgb>) {
    let (name, emission) = (name.to_owned(), light.map(Into::into));
    scene.shapes.push(Shape {
        name,
        geometry,
        to_world: Transform::IDENTITY,
        material,
        emission,
        origin: None,
    });
}

/// Renders with progress, and writes all layers as OpenEXR and the picture as PNG.
pub fn render(scene: Description, samples: u32, output: &str) -> Result<(), Box<dyn std::error::Error>> {
    let (scene, warnings) = Scene::new(scene)?;
    warnings.iter().for_each(|w| eprintln!("{w}"));
    let session = Session::new(&scene, RenderOptions { samples, ..RenderOptions::default() })?;
    let report = session.run(&Control::default(), |p| eprint!("\r{:3.0} %", p.fraction * 100.0))?;
    eprintln!("\r{:.1} million samples per second", report.samples_per_second * 1e-6);
    let (picture, on) = (session.film().develop(), LightImage::On);
    write_exr(format!("{output}.exr").as_ref(), &picture, on, &session.metadata(&report))?;
    let look = Develop { exposure: 0.0, tone_map: ToneMap::Filmic };
    let path = format!("{output}.png");
    Ok(write_png(path.as_ref(), picture.width, picture.height, &picture.combined(on), look)?)
}
