//! Pictures that went through the encoder and a decoder.

use openh264::decoder::Decoder;
use openh264::formats::YUVSource;

use super::file::File;
use super::{PATCH, PATCHES, noise, patches, to_srgb, video};
use crate::{VideoOptions, cross_fade};

/// A decoded frame: width, height, and pixels by the standard's formulas, chroma of the nearest block.
fn decoded(bytes: &[u8]) -> Vec<(usize, usize, Vec<[u8; 3]>)> {
    let mut decoder = Decoder::new().unwrap();
    let mut pictures = Vec::new();
    for frame in File(bytes).frames() {
        let picture = decoder.decode(&frame).unwrap().expect("a picture for each frame");
        let ((width, height), (wide, narrow, _)) = (picture.dimensions(), picture.strides());
        let pixel = |i: usize| {
            let (x, y) = (i % width, i / width);
            let chroma = y / 2 * narrow + x / 2;
            to_srgb(picture.y()[y * wide + x], picture.u()[chroma], picture.v()[chroma])
        };
        pictures.push((width, height, (0..width * height).map(pixel).collect()));
    }
    pictures
}

/// Two for the bytes of Y′CbCr and one for the quantiser.
const TOLERANCE: u8 = 3;

#[test]
fn decoded_patches_have_their_colours() {
    let canvas = patches();
    let options = VideoOptions::new(canvas.width(), canvas.height());
    let pictures = decoded(&video(options, &[canvas.clone(), canvas]));
    assert_eq!(pictures.len(), 2);
    for (width, height, pixels) in pictures {
        assert_eq!((width, height), (PATCH as usize * PATCHES.len(), PATCH as usize));
        for (i, colour) in PATCHES.into_iter().enumerate() {
            let middle = pixels[height / 2 * width + i * PATCH as usize + PATCH as usize / 2];
            for channel in 0..3 {
                assert!(middle[channel].abs_diff(colour[channel]) <= TOLERANCE, "{colour:?}: {middle:?}");
            }
        }
    }
}

/// The error of a picture as smooth as rendered ones, through key frames and others.
#[test]
fn good_quality_is_close_to_the_picture() {
    let (a, b) = (noise(16, 12, 1), noise(16, 12, 2));
    let large = |small: &caustica_canvas::Canvas| {
        let pixels = (0..480 * 360).map(|i| {
            let (x, y) = (i % 480, i / 480);
            let at = |x: u32, y: u32| small.get(x.min(15), y.min(11)).unwrap();
            let mix = |p: u8, q: u8, t: u32| (u32::from(p) * (30 - t) + u32::from(q) * t) / 30;
            let (left, top) = (x / 30, y / 30);
            std::array::from_fn(|c| {
                let upper = mix(at(left, top)[c], at(left + 1, top)[c], x % 30);
                let lower = mix(at(left, top + 1)[c], at(left + 1, top + 1)[c], x % 30);
                ((upper * (30 - y % 30) + lower * (y % 30)) / 30) as u8
            })
        });
        caustica_canvas::Canvas::from_pixels(480, 360, pixels.collect()).unwrap()
    };
    let (a, b) = (large(&a), large(&b));
    let frames: Vec<_> = (0..6).map(|i| cross_fade(&a, &b, i as f32 / 5.0).unwrap()).collect();
    let pictures = decoded(&video(VideoOptions::new(480, 360), &frames));
    for (frame, (_, _, pixels)) in frames.iter().zip(pictures) {
        let square = |(p, q): (&[u8; 3], &[u8; 3])| {
            (0..3).map(|c| f64::from(p[c].abs_diff(q[c])).powi(2)).sum::<f64>() / 3.0
        };
        let mean = frame.pixels().iter().zip(&pixels).map(square).sum::<f64>() / pixels.len() as f64;
        // 38 decibels.
        assert!(mean < 10.0, "a mean square of {mean}");
    }
}

/// Black and white at random takes more bits than the encoder has room for at this quality.
#[test]
fn pure_noise_is_encoded_more_coarsely() {
    let board = |number| {
        let mut canvas = noise(128, 96, number);
        canvas.pixels_mut().iter_mut().for_each(|p| *p = p.map(|c| if c < 128 { 0 } else { 255 }));
        canvas
    };
    let calm = caustica_canvas::Canvas::new(128, 96, [90, 120, 40]).unwrap();
    // Noise at the first frame, at a frame after a key frame, at a key frame; then peace.
    let mut frames: Vec<_> =
        (0..9).map(|i| if [0, 1, 5, 8].contains(&i) { board(i) } else { calm.clone() }).collect();
    frames.extend(vec![calm; 8]);
    let options = VideoOptions { quality: 100, frames_per_second: 2, ..VideoOptions::new(128, 96) };
    let bytes = video(options, &frames);
    let pictures = decoded(&bytes);
    assert_eq!(pictures.len(), frames.len());
    for (i, (frame, (_, _, pixels))) in frames.iter().zip(&pictures).enumerate() {
        let luma =
            |p: &[u8; 3]| 0.2126 * f64::from(p[0]) + 0.7152 * f64::from(p[1]) + 0.0722 * f64::from(p[2]);
        let errors = frame.pixels().iter().zip(pixels).map(|(a, b)| (luma(a) - luma(b)).abs());
        let mean = errors.sum::<f64>() / pixels.len() as f64;
        assert!(mean < 16.0, "frame {i} is off by {mean}");
    }
    assert!(video(options, &frames) == bytes);
    let identities = File(&bytes).key_identities();
    assert!(identities.windows(2).all(|pair| pair[0].is_none() || pair[0] != pair[1]), "{identities:?}");
    // Among them are two key frames in a row, each from a new encoder.
    assert!(identities.windows(2).any(|pair| pair[0].is_some() && pair[1].is_some()), "{identities:?}");
}
