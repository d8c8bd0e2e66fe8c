//! One sample again, strategy by strategy.

use caustica_math::{Rgb, Vec2};
use caustica_scene::Scene;
use caustica_scene::light::Anchor;
use caustica_transport::{Contribution, Kernel, Scratch, Settings, Sink};
use serde::Serialize;

use crate::names::integrator_name;

/// Everything that one sample found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Replay {
    /// The integrator's name.
    pub integrator: &'static str,
    /// The pixel.
    pub pixel: [u32; 2],
    /// The sample's index.
    pub sample: u32,
    /// What it adds to the eye image at its pixel.
    pub eye: [f32; 3],
    /// What it adds to the light image, and where.
    pub splats: Vec<Splat>,
    /// Each strategy's contribution, a strategy that joins light paths once for each of them; only `bdpt` tells them.
    pub contributions: Vec<StrategyRecord>,
}

/// A splat into the light image.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Splat {
    /// Film position in pixels.
    pub film: [f32; 2],
    /// The value, for one light path of a pass.
    pub value: [f32; 3],
}

/// One strategy's contribution.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StrategyRecord {
    /// Light vertices.
    pub s: u32,
    /// Camera vertices.
    pub t: u32,
    /// The unweighted estimate.
    pub contribution: [f32; 3],
    /// Its MIS weight.
    pub weight: f32,
    /// Film position in pixels.
    pub film: [f32; 2],
    /// The path from the lamp to the camera.
    pub path: Vec<VertexRecord>,
}

/// One vertex of a path.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VertexRecord {
    /// What it is: `lamp`, `light` or `eye` (a surface vertex of that walk), or `camera`.
    pub kind: &'static str,
    /// Its position or, at infinity, the direction towards it.
    pub at: [f32; 3],
    /// Whether it is at infinity.
    pub infinite: bool,
    /// Whether it scattered by a Dirac lobe.
    pub delta: bool,
    /// Density by the walk that made it, in m⁻² (for the lamp and the camera, which are drawn first: none).
    pub pdf_forward: Option<f32>,
    /// Density by the opposite walk along its own subpath, in m⁻²; zero at a subpath's last vertex, where it
    /// depends on the connection.
    pub pdf_reverse: Option<f32>,
}

struct Recorder(Replay);

impl Sink for Recorder {
    const PROBES: bool = true;
    // The sample as the film gets it.
    const KEEPS_ALL: bool = false;

    fn eye(&mut self, value: Rgb) {
        self.0.eye = value.0;
    }

    fn splat(&mut self, film: Vec2, value: Rgb) {
        self.0.splats.push(Splat { film: [film.x, film.y], value: value.0 });
    }

    fn contribution(&mut self, c: &Contribution<'_>) {
        let surface = |kind, v: &caustica_transport::vertex::Vertex| VertexRecord {
            kind,
            at: v.point.position.to_array(),
            infinite: false,
            delta: v.delta,
            pdf_forward: Some(v.forward),
            pdf_reverse: Some(v.reverse),
        };
        let end = |kind, at: [f32; 3], infinite| VertexRecord {
            kind,
            at,
            infinite,
            delta: false,
            pdf_forward: None,
            pdf_reverse: None,
        };
        let lamp = &c.path.lamp;
        let mut path = Vec::new();
        // For s = 0 a lamp on a surface is the last eye vertex.
        if c.strategy.s > 0 || lamp.anchor == Anchor::Infinite {
            path.push(end("lamp", lamp.at.to_array(), lamp.anchor == Anchor::Infinite));
        }
        path.extend(c.path.light.iter().map(|v| surface("light", v)));
        path.extend(c.path.eye.iter().rev().map(|v| surface("eye", v)));
        path.push(end("camera", c.path.camera.at.to_array(), c.path.camera.infinite));
        self.0.contributions.push(StrategyRecord {
            s: c.strategy.s,
            t: c.strategy.t,
            contribution: [c.unweighted[0], c.unweighted[1], c.unweighted[2]],
            weight: c.weight,
            film: [c.film.x, c.film.y],
            path,
        });
    }
}

/// Renders one sample of one pixel and notes all that it finds. The same sample of a render with the same
/// settings is this one.
pub fn replay(scene: &Scene, settings: Settings, pixel: [u32; 2], sample: u32) -> Replay {
    let mut recorder = Recorder(Replay {
        integrator: integrator_name(&settings.integrator),
        pixel,
        sample,
        eye: [0.0; 3],
        splats: Vec::new(),
        contributions: Vec::new(),
    });
    Kernel::new(scene, settings).sample(pixel, sample, &mut Scratch::default(), &mut recorder);
    recorder.0
}
