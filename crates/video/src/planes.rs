//! Frames as the encoder takes them: Y′CbCr in three planes.

use openh264::formats::YUVSource;

/// The weights of red, green and blue in luma, in units of 10⁻⁴ (ITU-R BT.709-6, item 3.2).
const LUMA: [i64; 3] = [2126, 7152, 722];
/// The divisors of B′ − Y′ and R′ − Y′ in units of 10⁻⁴ (item 3.3): twice what is left of one.
const CB: i64 = 2 * (10_000 - LUMA[2]);
const CR: i64 = 2 * (10_000 - LUMA[0]);

/// A frame of BT.709 Y′CbCr in limited range with 8 bits (item 4.6): luma from 16 to 235, chroma from 16
/// to 240. Both sides are even. There is one pair of chroma values for each two by two pixels.
pub(crate) struct Planes {
    width: usize,
    height: usize,
    y: Vec<u8>,
    cb: Vec<u8>,
    cr: Vec<u8>,
}

impl Planes {
    /// Black, or what was there before, of the next even size from `width` × `height` on.
    pub(crate) fn new(width: u32, height: u32) -> Self {
        let (width, height) = (width.next_multiple_of(2) as usize, height.next_multiple_of(2) as usize);
        let area = width * height;
        Self { width, height, y: vec![16; area], cb: vec![128; area / 4], cr: vec![128; area / 4] }
    }

    /// Takes over a picture of `width` pixels a row. Where the frame is one pixel larger, the last
    /// column and row are repeated. Everything is worked out in whole numbers and rounded once, to nearest;
    /// chroma is that of the mean of four pixels, in their middle.
    pub(crate) fn fill(&mut self, pixels: &[[u8; 3]], width: u32) {
        let own = width as usize;
        let rows = pixels.len() / own;
        let at = |x: usize, y: usize| pixels[y.min(rows - 1) * own + x.min(own - 1)].map(i64::from);
        for y in (0..self.height).step_by(2) {
            for x in (0..self.width).step_by(2) {
                let block = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
                for (i, pixel) in block.iter().enumerate() {
                    self.y[(y + i / 2) * self.width + x + i % 2] = luma_byte(*pixel);
                }
                let sum: [i64; 3] = std::array::from_fn(|i| block.iter().map(|p| p[i]).sum());
                let place = y / 2 * (self.width / 2) + x / 2;
                self.cb[place] = chroma_byte(sum, 2, CB);
                self.cr[place] = chroma_byte(sum, 0, CR);
            }
        }
    }
}

/// 10⁴ times the luma of a pixel of bytes.
fn luma([r, g, b]: [i64; 3]) -> i64 {
    LUMA[0] * r + LUMA[1] * g + LUMA[2] * b
}

fn luma_byte(pixel: [i64; 3]) -> u8 {
    (16 + rounded(219 * luma(pixel), 255 * 10_000)) as u8
}

/// The chroma of the sum of four pixels by the difference of one channel from luma.
fn chroma_byte(sum: [i64; 3], channel: usize, divisor: i64) -> u8 {
    let difference = 10_000 * sum[channel] - luma(sum);
    (128 + rounded(224 * difference, 4 * 255 * divisor)) as u8
}

fn rounded(a: i64, b: i64) -> i64 {
    (2 * a + b).div_euclid(2 * b)
}

impl YUVSource for Planes {
    fn dimensions(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    fn strides(&self) -> (usize, usize, usize) {
        (self.width, self.width / 2, self.width / 2)
    }

    fn y(&self) -> &[u8] {
        &self.y
    }

    fn u(&self) -> &[u8] {
        &self.cb
    }

    fn v(&self) -> &[u8] {
        &self.cr
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::to_srgb;

    fn flat(colour: [u8; 3]) -> [u8; 3] {
        let mut planes = Planes::new(2, 2);
        planes.fill(&[colour; 4], 2);
        assert_eq!(planes.y, [planes.y[0]; 4]);
        [planes.y[0], planes.cb[0], planes.cr[0]]
    }

    /// The well-known values of the colour bars at full amplitude.
    #[test]
    fn colour_bars_have_their_values() {
        for (colour, expected) in [
            ([0, 0, 0], [16, 128, 128]),
            ([255, 255, 255], [235, 128, 128]),
            ([255, 0, 0], [63, 102, 240]),
            ([0, 255, 0], [173, 42, 26]),
            ([0, 0, 255], [32, 240, 118]),
            ([255, 255, 0], [219, 16, 138]),
            ([0, 255, 255], [188, 154, 16]),
            ([255, 0, 255], [78, 214, 230]),
            ([128, 128, 128], [126, 128, 128]),
        ] {
            assert_eq!(flat(colour), expected, "{colour:?}");
        }
    }

    /// What is lost to 219 steps of luma and to chroma's rounding is two at most.
    #[test]
    fn colours_come_back() {
        for step in 0..4096u32 {
            let colour = [step % 16 * 17, step / 16 % 16 * 17, step / 256 * 17].map(|c| c as u8);
            let [y, cb, cr] = flat(colour);
            let back = to_srgb(y, cb, cr);
            for i in 0..3 {
                assert!(colour[i].abs_diff(back[i]) <= 2, "{colour:?} came back as {back:?}");
            }
        }
    }

    #[test]
    fn chroma_is_the_mean_of_four() {
        let mut planes = Planes::new(2, 2);
        planes.fill(&[[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]], 2);
        assert_eq!(planes.y, [63, 173, 32, 235]);
        // Of [127.5; 3].
        assert_eq!((planes.cb[0], planes.cr[0]), (128, 128));
    }

    #[test]
    fn odd_sizes_repeat_their_last_pixels() {
        let (mut odd, mut even) = (Planes::new(3, 1), Planes::new(4, 2));
        let [a, b, c] = [[10, 20, 30], [200, 100, 50], [0, 250, 128]];
        odd.fill(&[a, b, c], 3);
        even.fill(&[a, b, c, c, a, b, c, c], 4);
        assert_eq!((odd.width, odd.height), (4, 2));
        assert_eq!((odd.y, odd.cb, odd.cr), (even.y, even.cb, even.cr));
    }
}
