//! Where contributions go.

use caustica_math::{Rgb, Spectrum, Vec2};
use caustica_scene::camera::CameraPoint;
use caustica_scene::light::{Anchor, LightPoint};

use crate::strategy::Strategy;
use crate::vertex::Vertex;

/// Receives what a sample finds. A film is one; tests, pyramids and replays are others.
pub trait Sink {
    /// Whether [`Sink::contribution`] is wanted. It is called only if so.
    const PROBES: bool = false;

    /// Whether [`Contribution::weights`] is wanted.
    const WEIGHS_ALL: bool = false;

    /// Whether contributions that are small beside the sample's sum may not be left to roulette: those who look at
    /// single contributions need them all as they are.
    const KEEPS_ALL: bool = Self::PROBES;

    /// The sample's value for its own pixel, of the eye image.
    fn eye(&mut self, value: Rgb);

    /// A splat into the light image, at a film position in pixels. The value is per light path; it is
    /// already divided by their number in one pass.
    fn splat(&mut self, film: Vec2, value: Rgb);

    /// Tells that a numerical failure ended a walk or spoilt a contribution, which is left out: something was not
    /// finite, or negative, where nothing can be. (What a surface absorbs, or what is not sampled, is no failure.) It
    /// may come at any time of a sample, more than once.
    ///
    /// If nobody else listens it goes where films count it: to [`Sink::eye`], as a value that is not a number.
    fn invalid(&mut self) {
        self.eye(Rgb::splat(f32::NAN));
    }

    /// One strategy's contribution, before it is added.
    fn contribution(&mut self, _: &Contribution<'_>) {}
}

/// The contribution of one strategy to one sample.
#[derive(Clone, Copy, Debug)]
pub struct Contribution<'a> {
    /// The strategy.
    pub strategy: Strategy,
    /// The unweighted estimate: the path's measured radiance over its density, that of aimed rays with it. (For a sink
    /// without [`Sink::KEEPS_ALL`] also over the probability with which it survived among the small ones.)
    pub unweighted: Spectrum,
    /// The MIS factor.
    pub weight: f32,
    /// Where on the film it goes, in pixels: the sample's own position for t ≥ 2.
    pub film: Vec2,
    /// By what the pixel filter multiplies it in [`Sink::eye`]; 1 for t = 1, which is filtered where it is splatted.
    /// Either way it is multiplied by [the camera's response](caustica_scene::camera::Camera::response) too.
    pub filter_weight: f32,
    /// The path.
    pub path: PathView<'a>,
    /// Which of the light paths that the eye path is joined with has the light vertices: below
    /// [`Kernel::shared_light_paths`](crate::Kernel::shared_light_paths); 0 where there are none.
    pub light_path: usize,
    /// The weight of each strategy that could have made the path, by its s, with the balance heuristic: in proportion
    /// to how often it does, roulette aside. Empty unless the sink [weighs all](Sink::WEIGHS_ALL).
    pub weights: &'a [f32],
}

impl<'a> Contribution<'a> {
    /// The surface vertices between the lamp and the camera, in that order, each with whether the path goes through it
    /// by a Dirac lobe.
    pub fn events(&self) -> impl Iterator<Item = (&'a Vertex, bool)> + use<'a> {
        let PathView { lamp, light, mut eye, .. } = self.path;
        let hits = self.strategy.s == 0;
        if hits && lamp.anchor == Anchor::Surface {
            // The last one is the lamp.
            eye = &eye[..eye.len() - 1];
        }
        // Vertices that are joined scatter by their smooth lobes, however the walk went on from there.
        let (joined_light, joined_eye) = (light.len(), if hits { 0 } else { eye.len() });
        let light = light.iter().enumerate().map(move |(i, v)| (v, v.delta && i + 1 != joined_light));
        let eye = eye.iter().enumerate().map(move |(i, v)| (v, v.delta && i + 1 != joined_eye));
        light.chain(eye.rev())
    }
}

/// A full path, in two parts that are joined by the strategy's edge.
#[derive(Clone, Copy, Debug)]
pub struct PathView<'a> {
    /// The point on the lamp.
    pub lamp: LightPoint,
    /// Surface vertices after the lamp, in the order of the light walk.
    pub light: &'a [Vertex],
    /// Surface vertices after the camera, in the order of the camera walk. For s = 0 the last of them is the
    /// lamp itself, unless that is at infinity.
    pub eye: &'a [Vertex],
    /// The point on the camera.
    pub camera: CameraPoint,
}
