//! Which sample numbers a walk uses for what.
//!
//! What is drawn at a vertex has slots of its own, whether or not it was needed at the vertices before: samples of a
//! pixel stay comparable, and so stratified. The slots of one group are stratified jointly: the choice of a lamp (and
//! of its triangle) with the place on it, the direction of a bounce with the lobe.

use caustica_math::stream::GROUP;
use caustica_math::{SampleId, SampleStream, Sampler};

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
/// Of the place on the lens that a light path's vertex is joined with.
const JOINED: u64 = 1;

/// The numbers of one bounce.
pub(crate) struct Bounce {
    /// Of the direction and the lobe.
    pub u: [f32; 3],
    /// Of roulette.
    pub survival: f32,
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

    /// Those of the bounce at the surface vertex of that index (from 0).
    #[inline]
    fn bounce(&mut self, vertex: usize) -> Bounce {
        let [u0, u1] = self.draw(vertex + 1, BOUNCE);
        let [u2, survival] = self.draw(vertex + 1, LOBE);
        Bounce { u: [u0, u1, u2], survival }
    }
}

/// The numbers of a sample's eye path.
pub(crate) struct EyeNumbers(SampleStream);

impl EyeNumbers {
    pub fn new(sampler: Sampler, id: SampleId) -> Self {
        Self(SampleStream::of_sample(sampler, id, 0))
    }

    /// Of the place on the film.
    pub fn film(&mut self) -> [f32; 2] {
        self.draw(0, FILM)
    }

    /// Of the place on the lens.
    pub fn lens(&mut self) -> [f32; 2] {
        self.draw(0, LENS)
    }

    /// Of next-event estimation at the surface vertex of that index: the choice of the lamp, the place on it.
    #[inline]
    pub fn next_event(&mut self, vertex: usize) -> ([f32; 2], [f32; 2]) {
        (self.draw(vertex, CHOICE), self.draw(vertex, POINT))
    }
}

impl Bounces for EyeNumbers {
    #[inline]
    fn stream(&mut self) -> &mut SampleStream {
        &mut self.0
    }
}

/// The numbers of a sample's light path.
pub(crate) struct LightNumbers(SampleStream);

impl LightNumbers {
    pub fn new(sampler: Sampler, id: SampleId) -> Self {
        Self(SampleStream::of_sample(sampler, id, 1))
    }

    /// Of the emission: the choice of the lamp, the place on it, the direction.
    pub fn emission(&mut self) -> [[f32; 2]; 3] {
        [CHOICE, POINT, LAMP_DIRECTION].map(|slot| self.draw(0, slot))
    }

    /// Of the place on the lens that the lamp's point is joined with.
    pub fn lamp_lens(&mut self) -> [f32; 2] {
        self.draw(0, JOINED)
    }

    /// Of the place on the lens that the surface vertex of that index is joined with.
    #[inline]
    pub fn lens(&mut self, vertex: usize) -> [f32; 2] {
        // The slot of a light path's next events, which there are none of.
        self.draw(vertex + 1, POINT)
    }
}

impl Bounces for LightNumbers {
    #[inline]
    fn stream(&mut self) -> &mut SampleStream {
        &mut self.0
    }
}
