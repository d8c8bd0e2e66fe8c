//! Caustica: a bidirectional path tracer for scenes whose light is hard to find.
//!
//! Describe a scene, render it, keep the picture:
//!
//! ```
//! use caustica::{Description, RenderOptions, Rgb, render};
//! use caustica::description::{Geometry, Light, LightKind, MaterialKind, Shape};
//!
//! let mut scene = Description::default();
//! (scene.film.width, scene.film.height) = (32, 24);
//! let white = scene.add_material(MaterialKind::Diffuse { albedo: Rgb::splat(0.8).into() });
//! scene.shapes.push(Shape {
//!     name: "ball".into(),
//!     geometry: Geometry::Sphere { center: [0.0, 0.0, 5.0].into(), radius: 1.0 },
//!     to_world: Default::default(),
//!     material: white,
//!     emission: None,
//!     origin: None,
//! });
//! let sky = LightKind::Constant { radiance: Rgb::WHITE };
//! scene.lights.push(Light { kind: sky, origin: None });
//!
//! let rendered = render(scene, RenderOptions { samples: 4, ..RenderOptions::default() })?;
//! assert_eq!(rendered.picture.eye.len(), 32 * 24);
//! # Ok::<(), caustica::Error>(())
//! ```
//!
//! The parts: [`description`] is what scenes are made of, [`import`] reads scene files, [`Session`] renders
//! with progress and cancellation, [`film`] holds, develops and writes pictures. The crates behind them
//! (`caustica-scene`, `caustica-transport` and the others) are documented on their own.

pub mod default_scene;

pub use caustica_film as film;
pub use caustica_import as import;
pub use caustica_math as math;
pub use caustica_render as session;
pub use caustica_scene as scene;
pub use caustica_scene::description;
pub use caustica_transport as transport;

pub use caustica_film::{Film, LightImage, Picture};
pub use caustica_math::{Rgb, Transform, Vec3};
pub use caustica_render::{Control, Progress, RenderError, RenderOptions, Report, Session};
pub use caustica_scene::{Description, Diagnostic, Scene};
pub use caustica_transport::Settings;

/// A finished picture.
#[derive(Debug)]
pub struct Rendered {
    /// The eye and the light image.
    pub picture: Picture,
    /// How it was made.
    pub report: Report,
    /// What is suspicious about the scene.
    pub warnings: Vec<Diagnostic>,
}

/// Why a picture could not be made.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The scene.
    #[error(transparent)]
    Scene(#[from] Diagnostic),
    /// The session.
    #[error(transparent)]
    Render(#[from] RenderError),
}

/// Renders a description from start to end.
///
/// # Errors
/// A scene that cannot be rendered, or a film that does not fit into memory.
pub fn render(description: Description, options: RenderOptions) -> Result<Rendered, Error> {
    let (scene, warnings) = Scene::new(description)?;
    let session = Session::new(&scene, options)?;
    let report = session.run(&Control::default(), |_| ())?;
    Ok(Rendered { picture: session.film().develop(), report, warnings })
}
