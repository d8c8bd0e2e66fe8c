//! Choices out of bytes.

use caustica_math::Rgb;

/// Light of every strength, from none to far beyond the sun.
const STRENGTHS: [f32; 8] = [1.0, 10.0, 100.0, 0.0, 1e-6, 1e4, 1e20, 1e-30];

/// Numbers and choices that bytes decide; when the bytes are over, every byte is zero.
#[derive(Clone, Debug)]
pub struct Choices<'b> {
    bytes: &'b [u8],
    at: usize,
    wild: bool,
}

impl<'b> Choices<'b> {
    /// The choices of those bytes.
    pub fn new(bytes: &'b [u8]) -> Self {
        Self { bytes, at: 0, wild: false }
    }

    fn byte(&mut self) -> u8 {
        self.at += 1;
        self.bytes.get(self.at - 1).copied().unwrap_or(0)
    }

    /// Decides whether the scene has numbers at the edges of what is valid.
    pub(super) fn set_wild(&mut self) {
        self.wild = self.byte() % 4 == 3;
    }

    /// Whether the scene has numbers at the edges of what is valid.
    pub fn is_wild(&self) -> bool {
        self.wild
    }

    /// A number less than `count`, which is at most 256.
    pub fn below(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count.max(1)
    }

    /// True once in so many times, and never when the bytes are over.
    pub fn once_in(&mut self, times: usize) -> bool {
        self.below(times) == times - 1
    }

    /// One of several.
    pub fn pick<'a, T>(&mut self, choices: &'a [T]) -> &'a T {
        &choices[self.below(choices.len())]
    }

    /// A number in [0, 1].
    pub fn unit(&mut self) -> f32 {
        let bytes = [self.byte(), self.byte()];
        f32::from(u16::from_le_bytes(bytes)) / f32::from(u16::MAX)
    }

    /// A number in [−1, 1].
    pub fn signed(&mut self) -> f32 {
        2.0 * self.unit() - 1.0
    }

    /// Three numbers in [−1, 1].
    pub fn vector(&mut self) -> [f32; 3] {
        [0; 3].map(|_| self.signed())
    }

    /// A direction of any length but zero.
    pub fn direction(&mut self) -> [f32; 3] {
        let mut direction = self.vector();
        direction[1] -= 1.5;
        direction
    }

    /// A reflectance: now and then black or white.
    pub fn albedo(&mut self) -> Rgb {
        match self.below(8) {
            0 => Rgb::splat(0.5),
            1 => Rgb::BLACK,
            2 => Rgb::WHITE,
            _ => Rgb::new(self.unit(), self.unit(), self.unit()),
        }
    }

    /// A colour of light; extreme in wild scenes.
    pub fn light(&mut self) -> Rgb {
        let strengths = if self.wild { &STRENGTHS[..] } else { &STRENGTHS[..4] };
        let strength = *self.pick(strengths);
        let colour = self.albedo();
        colour * strength
    }
}
