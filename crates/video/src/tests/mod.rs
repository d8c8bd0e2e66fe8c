//! Tests of whole files: their boxes, their colours, and a real browser.

mod browser;
mod colours;
mod container;
mod file;

use caustica_canvas::Canvas;
use tempfile::TempDir;

use crate::{VideoOptions, VideoWriter};

/// The sRGB bytes of BT.709 Y′CbCr in limited range, by the standard's formulas in floating point.
pub(crate) fn to_srgb(y: u8, cb: u8, cr: u8) -> [u8; 3] {
    let luma = (f64::from(y) - 16.0) / 219.0;
    let (blue, red) = ((f64::from(cb) - 128.0) / 224.0, (f64::from(cr) - 128.0) / 224.0);
    let (r, b) = (luma + 1.5748 * red, luma + 1.8556 * blue);
    let g = (luma - 0.2126 * r - 0.0722 * b) / 0.7152;
    [r, g, b].map(|c| (c * 255.0 + 0.5).clamp(0.0, 255.0) as u8)
}

/// What every test of colours shows.
const PATCHES: [[u8; 3]; 8] = [
    [255, 0, 0],
    [0, 255, 0],
    [0, 0, 255],
    [255, 255, 255],
    [128, 128, 128],
    [0, 0, 0],
    [230, 160, 60],
    [30, 90, 140],
];

/// Each patch is so large in pixels.
const PATCH: u32 = 48;

/// A row of patches.
fn patches() -> Canvas {
    let mut canvas = Canvas::new(PATCH * PATCHES.len() as u32, PATCH, [0; 3]).unwrap();
    for (x, colour) in (0..).step_by(PATCH as usize).zip(PATCHES) {
        canvas.fill(caustica_canvas::Area::new(x, 0, PATCH, PATCH), colour, 1.0);
    }
    canvas
}

/// A picture with detail everywhere, another one for each number.
fn noise(width: u32, height: u32, number: u32) -> Canvas {
    let pixel = |i: u32| {
        let hash = (i ^ number.wrapping_mul(0x9e37_79b9)).wrapping_mul(0x85eb_ca6b);
        let hash = (hash ^ hash >> 13).wrapping_mul(0xc2b2_ae35);
        let [_, a, b, c] = hash.to_be_bytes();
        [a, b, c]
    };
    Canvas::from_pixels(width, height, (0..width * height).map(pixel).collect()).unwrap()
}

/// The bytes of a video of these frames.
fn video(options: VideoOptions, frames: &[Canvas]) -> Vec<u8> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("video.mp4");
    let mut writer = VideoWriter::create(&path, options).unwrap();
    frames.iter().for_each(|frame| writer.push(frame).unwrap());
    let summary = writer.finish().unwrap();
    let bytes = std::fs::read(&path).unwrap();
    assert_eq!(summary.bytes, bytes.len() as u64);
    bytes
}
