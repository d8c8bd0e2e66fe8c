//! Which sample numbers a walk uses for what.
//!
//! What is drawn at a vertex has slots of its own, whether or not it was needed at the vertices before: samples of a
//! pixel stay comparable, and so stratified. The slots of one group are stratified jointly: the choice of a lamp (and
//! of its triangle) with the place on it, the direction of a bounce with the lobe.

use caustica_math::stream::GROUP;
use caustica_math::{SampleId, SampleStream, Sampler};
use caustica_scene::Scene;
use caustica_scene::bsdf::Bsdf;

// The slots of a walk's start, and then of each of its bounces: two groups of two.
const SLOTS: u64 = 2 * GROUP;
const FILM: u64 = 0;
const LENS: u64 = 1;
const LAMP_DIRECTION: u64 = 0;
const BOUNCE: u64 = 0;
/// Of the lobe and of roulette.
const LOBE: u64 = 1;
/// Of the choice of a lamp: for the next event after a bounce of an eye path, or of emission.
const CHOICE: u64 = 2;
/// Of the place on a lamp that goes with the choice.
const POINT: u64 = 3;
/// Of the place on the lens that a lamp's point is joined with.
const JOINED: u64 = 1;

/// In place of a bounce's number, beyond all of them.
const CANDIDATES: usize = 1 << 16;

/// The numbers of one bounce.
pub(crate) struct Bounce {
    /// Of the direction and the lobe.
    pub u: [f32; 3],
    /// Of roulette.
    pub survival: f32,
}

/// What a scene draws numbers for at all. Those that nothing depends on are not made, and are zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Needs {
    /// Whether lamps, or parts of one, are to be chosen from.
    choice: bool,
    /// Whether the camera has a lens.
    lens: bool,
}

impl Needs {
    pub fn of(scene: &Scene) -> Self {
        Self { choice: scene.lamps().offer_a_choice(), lens: scene.camera.has_lens() }
    }
}

/// A walk's numbers.
pub(crate) trait Bounces {
    /// The stream of all.
    fn stream(&mut self) -> &mut SampleStream;

    /// The numbers of a slot of the walk's start (0), or of the bounce at the surface vertex of that index (from 1).
    #[inline]
    fn draw(&mut self, bounce: usize, slot: u64) -> [f32; 2] {
        self.stream().seek(bounce as u64 * SLOTS + slot).next_2d()
    }

    #[inline]
    fn draw_if(&mut self, needed: bool, bounce: usize, slot: u64) -> [f32; 2] {
        if needed { self.draw(bounce, slot) } else { [0.0; 2] }
    }

    /// Those of the bounce at the surface vertex of that index (from 0), as far as the BSDF there and roulette need
    /// them.
    #[inline]
    fn bounce(&mut self, vertex: usize, bsdf: &Bsdf, roulette: bool) -> Bounce {
        let [u0, u1] = self.draw_if(!bsdf.is_delta(), vertex + 1, BOUNCE);
        let [u2, survival] = self.draw_if(roulette || bsdf.has_lobes(), vertex + 1, LOBE);
        Bounce { u: [u0, u1, u2], survival }
    }
}

/// The numbers of a sample's eye path.
pub(crate) struct EyeNumbers {
    stream: SampleStream,
    needs: Needs,
}

impl EyeNumbers {
    pub fn new(sampler: Sampler, id: SampleId, needs: Needs) -> Self {
        Self { stream: SampleStream::of_sample(sampler, id, 0), needs }
    }

    /// Of the place on the film.
    pub fn film(&mut self) -> [f32; 2] {
        self.draw(0, FILM)
    }

    /// Of the place on the lens.
    pub fn lens(&mut self) -> [f32; 2] {
        self.draw_if(self.needs.lens, 0, LENS)
    }

    /// Of a direction at the first surface vertex.
    pub fn direction(&mut self) -> [f32; 2] {
        self.draw(1, BOUNCE)
    }

    /// Of next-event estimation at the surface vertex of that index: the choice of the lamp, the place on it.
    #[inline]
    pub fn next_event(&mut self, vertex: usize) -> ([f32; 2], [f32; 2]) {
        (self.draw_if(self.needs.choice, vertex, CHOICE), self.draw(vertex, POINT))
    }

    /// Of roulette among what the path can be joined with.
    pub fn candidates(&mut self) -> f32 {
        self.draw(CANDIDATES, LOBE)[0]
    }
}

impl Bounces for EyeNumbers {
    #[inline]
    fn stream(&mut self) -> &mut SampleStream {
        &mut self.stream
    }
}

/// The numbers of a sample's light path.
pub(crate) struct LightNumbers {
    stream: SampleStream,
    needs: Needs,
}

impl LightNumbers {
    pub fn new(sampler: Sampler, id: SampleId, needs: Needs) -> Self {
        Self { stream: SampleStream::of_sample(sampler, id, 1), needs }
    }

    /// Of the emission: the choice of the lamp, the place on it, the direction.
    pub fn emission(&mut self) -> [[f32; 2]; 3] {
        [self.draw_if(self.needs.choice, 0, CHOICE), self.draw(0, POINT), self.draw(0, LAMP_DIRECTION)]
    }

    /// Of the place on the lens that the lamp's point is joined with.
    pub fn lamp_lens(&mut self) -> [f32; 2] {
        self.draw_if(self.needs.lens, 0, JOINED)
    }

    /// Of the place on the lens that the surface vertex of that index is joined with.
    #[inline]
    pub fn lens(&mut self, vertex: usize) -> [f32; 2] {
        // The slot of a light path's next events, which there are none of.
        self.draw_if(self.needs.lens, vertex + 1, POINT)
    }
}

impl Bounces for LightNumbers {
    #[inline]
    fn stream(&mut self) -> &mut SampleStream {
        &mut self.stream
    }
}
