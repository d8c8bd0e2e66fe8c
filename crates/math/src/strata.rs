//! Stratified points of samples and pixels.
//!
//! A *slot* is one place of a walk where one or two numbers are drawn. The points of a slot are a digital net in
//! base 2, made jointly of two indices, that of the sample within its pixel and that of the pixel on a Z-order
//! curve, so that both of these hold at once:
//!
//! - of a single pixel, every aligned range of 2^k samples is a (0, k, 2)-net: the first two dimensions of Sobol',
//!   Owen-scrambled;
//! - of a square of 2^j × 2^j pixels, every such range is a (0, k + 2j, 2)-net: what one pixel errs, its neighbours
//!   make up for, at every power of two of samples (Ahmed and Wonka, "Screen-Space Blue-Noise Diffusion of Monte
//!   Carlo Sampling Error via Hierarchical Ordering of Pixels", SIGGRAPH Asia 2020, have it at one number of
//!   samples, chosen before).
//!
//! Why: write an index as a rational function over GF(2), the sample's bit i standing for xⁱ, the two bits of the
//! pixel's base-4 digit i for 1/Qⁱ and x/Qⁱ with Q = x² + x + 1 (i from 1). The point's two coordinates are its
//! power series at x = 0 and at x = 1. A function of k and 2j bits whose two series begin with a and b zeros, where
//! a + b = k + 2j, has more zeros than poles, and so is zero: the digits tell all functions apart, which is what a
//! net is. (The construction is that of Niederreiter and Xing with a second place for the index; without pixels it
//! is Sobol's.)
//!
//! Slots come in groups of [`GROUP`]. Those of one group share their order of samples up to linear maps that were
//! searched for stratification of any two of them in four dimensions. (Of all four together some coarse product of
//! digits is always left out, and is so in every pixel: put together what is smooth in most of it.) Between groups,
//! and everywhere between pixels, orders are shuffled and points scrambled by hashes, nested, so that nets stay nets:
//! Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020.

use crate::stream::{GOLDEN, SampleId, mix64};

/// Slots of a group.
pub const GROUP: u64 = 4;

/// log₂ of the edge of a tile in pixels. Each tile has scrambles of its own; within it the pixels are one net.
const TILE_BITS: u32 = 8;

/// Bits of a sample's index that are shuffled; higher ones keep their order.
const SHUFFLED: u32 = 16;

/// The indices of one sample of one pixel, and the key of its scrambles.
#[derive(Clone, Debug)]
pub(crate) struct Strata {
    key: u64,
    /// The sample's index, highest bit first in `reversed`.
    sample: u32,
    reversed: u32,
    /// The pixel's index within its tile in Z-order, reversed too.
    pixel: u32,
    /// The last group, and `reversed` as it was shuffled for that.
    group: u64,
    shuffled: u32,
}

impl Strata {
    /// Of that sample for a walk.
    #[inline]
    pub fn new(SampleId { seed, pixel: [x, y], sample }: SampleId, walk: u32) -> Self {
        let tile = u64::from(y >> TILE_BITS) << 32 | u64::from(x >> TILE_BITS);
        let of_seed = mix64(seed.wrapping_add(GOLDEN));
        let of_tile = mix64(of_seed.wrapping_add(tile.wrapping_mul(GOLDEN)));
        let z = spread(x) | spread(y) << 1;
        Self {
            key: mix64(of_tile.wrapping_add(u64::from(walk) << 16)),
            sample,
            reversed: sample.reverse_bits(),
            pixel: z.reverse_bits() >> (32 - 2 * TILE_BITS),
            group: u64::MAX,
            shuffled: 0,
        }
    }

    /// The point of a slot, as fractions of 2³².
    #[inline]
    pub fn point(&mut self, slot: u64) -> [u32; 2] {
        let of_slot = self.hash(slot << 1 | 1);
        if self.group != slot / GROUP {
            self.group = slot / GROUP;
            self.shuffled = owen(self.reversed, self.hash(self.group << 1) as u32);
        }
        let [sx, sy] = sample_part(self.sample, self.shuffled, (slot % GROUP) as usize);
        let of_pixel = of_slot.wrapping_mul(GOLDEN);
        let turned = turned(lightly(self.pixel, (of_pixel >> 32) as u32));
        let [px, py] = pixel_part(owen(turned, of_pixel as u32 ^ (of_slot >> 32) as u32));
        let x = owen(sx ^ px, of_slot as u32);
        let y = owen(sy ^ py, (of_slot >> 32) as u32);
        let reversed = (u64::from(x) << 32 | u64::from(y)).reverse_bits();
        [(reversed & 0xffff_ffff) as u32, (reversed >> 32) as u32]
    }

    #[inline]
    fn hash(&self, name: u64) -> u64 {
        mix64(self.key.wrapping_add(name.wrapping_mul(GOLDEN)))
    }
}

/// The map (y, x) → (x, x + y) of each base-4 digit. Shuffled bit by bit before and after it, the four pixels of a
/// square come in two thirds of their orders; by bits alone in one third, whose partners are always the same.
#[inline]
fn turned(pixel: u32) -> u32 {
    (pixel >> 1) & 0x5555 | (pixel ^ pixel << 1) & 0xaaaa
}

/// The series of a sample's index at 0 and at 1, highest digit in bit 0. The lowest [`SHUFFLED`] bits of the index
/// are those of `shuffled`, highest bit last, in the order of a group's member; the others are those of `sample`.
#[inline]
fn sample_part(sample: u32, shuffled: u32, member: usize) -> [u32; 2] {
    let [high, low] = &ORDERS[member];
    let both = low[(shuffled >> 24) as usize] ^ high[(shuffled >> 16 & 0xff) as usize];
    let [x, y] = [both & 0xffff, both >> 16];
    if sample >> SHUFFLED == 0 {
        return [x, y];
    }
    let kept = sample >> SHUFFLED << SHUFFLED;
    [x ^ kept, y ^ pascal(kept)]
}

/// Columns of the maps of a group's members: upper triangular with ones on the diagonal, found by random search
/// from column to column for the fewest singular minors of any two members' generators, in four dimensions.
const COLUMNS: [[u16; 16]; GROUP as usize] = [
    [1, 2, 4, 8, 0x10, 0x20, 0x40, 0x80, 0x100, 0x200, 0x400, 0x800, 0x1000, 0x2000, 0x4000, 0x8000],
    [
        0x0001, 0x0002, 0x0005, 0x000b, 0x0013, 0x0038, 0x005a, 0x00ff, 0x01f0, 0x02c9, 0x0546, 0x0c78,
        0x19a6, 0x29ac, 0x587b, 0x8431,
    ],
    [
        0x0001, 0x0003, 0x0004, 0x000c, 0x0011, 0x0032, 0x0060, 0x00bf, 0x012d, 0x0224, 0x05b4, 0x0a10,
        0x12b5, 0x26bf, 0x4f8b, 0x8779,
    ],
    [
        0x0001, 0x0002, 0x0004, 0x0009, 0x0013, 0x003b, 0x0055, 0x00b0, 0x01e3, 0x03e4, 0x044f, 0x0d94,
        0x1970, 0x2f72, 0x6954, 0xaf37,
    ],
];

/// The maps for the two bytes of an index, the bits of each reversed: the series at 0 and, shifted by 16, at 1.
static ORDERS: [[[u32; 256]; 2]; GROUP as usize] = {
    let mut tables = [[[0; 256]; 2]; GROUP as usize];
    let mut i = 0;
    while i < GROUP as usize * 512 {
        let (member, byte, value) = (i / 512, i / 256 % 2, i % 256);
        let mut index = 0;
        let mut bit = 0;
        while bit < 8 {
            if value >> bit & 1 == 1 {
                index ^= COLUMNS[member][15 - 8 * byte - bit] as u32;
            }
            bit += 1;
        }
        tables[member][byte][value] = index | pascal(index) << 16;
        i += 1;
    }
    tables
};

/// Nested uniform scrambling of a number whose highest digit is bit 0: each bit is turned by a hash of those below
/// it. Laine and Karras, "Stratified Sampling for Stochastic Transparency", EGSR 2011, with constants by Vegdahl,
/// "Building a Better LK Hash", 2021.
#[inline]
fn owen(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// The first half of [`owen`], which is enough before another shuffle.
#[inline]
fn lightly(x: u32, seed: u32) -> u32 {
    (x ^ x.wrapping_mul(0x3d20_adea)).wrapping_add(seed).wrapping_mul((seed >> 16) | 1)
}

/// Sobol's second dimension, highest digit in bit 0: f(x) → f(x + 1) over GF(2), Pascal's triangle modulo 2.
#[inline]
const fn pascal(mut x: u32) -> u32 {
    x ^= (x >> 1) & 0x5555_5555;
    x ^= (x >> 2) & 0x3333_3333;
    x ^= (x >> 4) & 0x0f0f_0f0f;
    x ^= (x >> 8) & 0x00ff_00ff;
    x ^ (x >> 16)
}

/// The series of a pixel's index (highest bit last) at 0 and at 1, highest digit in bit 0.
#[inline]
fn pixel_part(pixel: u32) -> [u32; 2] {
    let (a, b) = (&SERIES[0][(pixel & 0xff) as usize], &SERIES[1][(pixel >> 8 & 0xff) as usize]);
    [a[0] ^ b[0], a[1] ^ b[1]]
}

static SERIES: [[[u32; 2]; 256]; 2] = {
    let mut tables = [[[0; 2]; 256]; 2];
    let mut byte = 0;
    while byte < 2 {
        let mut value = 0;
        while value < 256 {
            let mut bit = 0;
            while bit < 8 {
                if value >> bit & 1 == 1 {
                    let s = series(2 * TILE_BITS - 1 - (8 * byte as u32 + bit));
                    tables[byte][value][0] ^= s[0];
                    tables[byte][value][1] ^= s[1];
                }
                bit += 1;
            }
            value += 1;
        }
        byte += 1;
    }
    tables
};

/// The series of one bit of a pixel's index: 1/Qⁱ or x/Qⁱ. At one, Q looks the same and x is 1 + y.
const fn series(bit: u32) -> [u32; 2] {
    let mut inverse = 1;
    let mut i = 0;
    while i < bit / 2 + 1 {
        inverse = over_q(inverse);
        i += 1;
    }
    if bit.is_multiple_of(2) { [inverse, inverse] } else { [inverse << 1, inverse ^ inverse << 1] }
}

/// A power series divided by 1 + x + x².
const fn over_q(series: u32) -> u32 {
    let (mut quotient, mut i) = (0u32, 0);
    while i < 32 {
        let before = quotient << 1 ^ quotient << 2;
        quotient |= (series ^ before) & 1 << i;
        i += 1;
    }
    quotient
}

/// The lowest bits of a tile's coordinate, with gaps between them.
#[inline]
fn spread(v: u32) -> u32 {
    let mut v = v & ((1 << TILE_BITS) - 1);
    v = (v | v << 4) & 0x0f0f;
    v = (v | v << 2) & 0x3333;
    (v | v << 1) & 0x5555
}

#[cfg(test)]
mod tests;
