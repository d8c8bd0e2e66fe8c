//! Which sample numbers a walk uses for what.
//!
//! What is drawn at a vertex has slots of its own, whether or not it was needed at the vertices before: samples of a
//! pixel stay comparable, and so stratified. The slots of one group are stratified jointly; so a group holds a bounce
//! together with what is drawn where it arrives.

use caustica_math::stream::GROUP;
use caustica_math::{SampleId, SampleStream, Sampler};

// The slots of a group; those of the first group belong to the walk's start, those of each next one to a bounce.
const FILM: u64 = 0;
const LENS: u64 = 1;
const LAMP_POINT: u64 = 0;
const LAMP_DIRECTION: u64 = 1;
const BOUNCE: u64 = 0;
const LOBE: u64 = 1;
/// Of the lamp: for the next event after a bounce of an eye path; of emission.
const CHOICE: u64 = 2;
/// Of what the surface after a start or bounce is joined with: a point on a lamp, or on the lens.
const JOINED: u64 = 3;

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

    /// The numbers of a slot of the walk's start (group 0) or of the bounce at the surface vertex of index group − 1.
    #[inline]
    fn draw(&mut self, group: usize, slot: u64) -> [f32; 2] {
        self.stream().seek(group as u64 * GROUP + slot).next_2d()
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
        (self.draw(vertex, CHOICE), self.draw(vertex, JOINED))
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
        [CHOICE, LAMP_POINT, LAMP_DIRECTION].map(|slot| self.draw(0, slot))
    }

    /// Of the place on the lens that the lamp's point is joined with.
    pub fn lamp_lens(&mut self) -> [f32; 2] {
        self.draw(0, JOINED)
    }

    /// Of the place on the lens that the surface vertex of that index is joined with.
    #[inline]
    pub fn lens(&mut self, vertex: usize) -> [f32; 2] {
        // That of the group before would be joined better, but it is the lamp's.
        self.draw(vertex + 1, JOINED)
    }
}

impl Bounces for LightNumbers {
    #[inline]
    fn stream(&mut self) -> &mut SampleStream {
        &mut self.0
    }
}
