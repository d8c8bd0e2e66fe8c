//! Which sample numbers a walk uses for what.
//!
//! What is drawn at a vertex has slots of its own, whether or not it was needed at the vertices before: samples of a
//! pixel stay comparable, and so stratified. The slots of one group are stratified jointly. In an eye path a bounce
//! stands with the lamp that is looked for where it arrives. In a light path, where all that the emission draws acts
//! together, such large groups were worse than independent samples now and then: it has smaller ones.

use caustica_math::stream::GROUP;
use caustica_math::{SampleId, SampleStream, Sampler};
use caustica_scene::Scene;

use crate::vertex::Vertex;

// The slots of a group.
const FILM: u64 = 0;
const LENS: u64 = 1;
/// Of the direction of a bounce.
const BOUNCE: u64 = 0;
/// Of the lobe and of roulette.
const LOBE: u64 = 1;
/// Of the choice of a lamp.
const CHOICE: u64 = 2;
/// Of the place on a lamp.
const POINT: u64 = 3;

// Groups beyond those of all bounces.
const CANDIDATES: u64 = 1 << 16;
/// The first of those of directions to aim at.
const AIMED: u64 = 1 << 20;
/// The first of those of the places on the lens that the points of a light path are joined with.
const JOINED: u64 = 1 << 16;
/// The first of those that decide what the vertices are.
const LABELS: u64 = 1 << 40;

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
    /// The group of the first bounce.
    const FIRST: u64;

    /// The stream of all.
    fn stream(&mut self) -> &mut SampleStream;

    #[inline]
    fn draw(&mut self, group: u64, slot: u64) -> [f32; 2] {
        self.stream().seek(group * GROUP + slot).next_2d()
    }

    #[inline]
    fn draw_if(&mut self, needed: bool, group: u64, slot: u64) -> [f32; 2] {
        if needed { self.draw(group, slot) } else { [0.0; 2] }
    }

    /// What the surface vertex of that index (from 0) is, where its material is a mixture. Both dimensions make one
    /// number, so that enough of it is left for mixtures of mixtures.
    fn label(&mut self, vertex: usize) -> f64 {
        let [high, low] = self.draw(LABELS + vertex as u64, LOBE).map(f64::from);
        high + low / f64::from(1 << 24)
    }

    /// Those of the bounce at the surface vertex of that index, as far as the BSDF there and roulette need them.
    #[inline]
    fn bounce(&mut self, index: usize, vertex: &Vertex, roulette: bool) -> Bounce {
        let group = Self::FIRST + index as u64;
        let [u0, u1] = self.draw_if(!vertex.bsdf.is_delta(), group, BOUNCE);
        let [u2, survival] = self.draw_if(roulette || vertex.has_lobes(), group, LOBE);
        Bounce { u: [u0, u1, u2], survival }
    }
}

/// The numbers of a sample's eye path: a group for the start, and one for each bounce.
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
        self.draw(Self::FIRST, BOUNCE)
    }

    /// Of next-event estimation at the surface vertex of that index: the choice of the lamp, the place on it.
    #[inline]
    pub fn next_event(&mut self, vertex: usize) -> ([f32; 2], [f32; 2]) {
        let group = vertex as u64;
        (self.draw_if(self.needs.choice, group, CHOICE), self.draw(group, POINT))
    }

    /// The first of the numbers of vertices that aimed rays find.
    pub const AIMED_VERTICES: usize = 1 << 21;

    /// Of the directions in which rays are aimed from the surface vertex of that index.
    pub fn aimed(&mut self, vertex: usize) -> [f32; 2] {
        self.draw(AIMED + vertex as u64, BOUNCE)
    }

    /// Of roulette among what the path can be joined with.
    pub fn candidates(&mut self) -> f32 {
        self.draw(CANDIDATES, LOBE)[0]
    }
}

impl Bounces for EyeNumbers {
    const FIRST: u64 = 1;

    #[inline]
    fn stream(&mut self) -> &mut SampleStream {
        &mut self.stream
    }
}

/// The numbers of a sample's light path: a group for the lamp's point, one for the direction, one for each bounce.
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
        [self.draw_if(self.needs.choice, 0, CHOICE), self.draw(0, POINT), self.draw(1, BOUNCE)]
    }

    /// Of the place on the lens that the lamp's point is joined with.
    pub fn lamp_lens(&mut self) -> [f32; 2] {
        self.draw_if(self.needs.lens, JOINED, LENS)
    }

    /// Of the place on the lens that the surface vertex of that index is joined with.
    #[inline]
    pub fn lens(&mut self, vertex: usize) -> [f32; 2] {
        self.draw_if(self.needs.lens, JOINED + 1 + vertex as u64, LENS)
    }
}

impl Bounces for LightNumbers {
    const FIRST: u64 = 2;

    #[inline]
    fn stream(&mut self) -> &mut SampleStream {
        &mut self.stream
    }
}
