//! What is in the file besides the pictures.

use std::fs;

use caustica_canvas::Canvas;
use tempfile::TempDir;

use super::file::{Bits, File, words};
use super::{noise, patches, video};
use crate::{Summary, VideoError, VideoOptions, VideoWriter};

fn options(width: u32, height: u32) -> VideoOptions {
    VideoOptions { frames_per_second: 5, ..VideoOptions::new(width, height) }
}

#[test]
fn the_index_comes_first_and_tells_all() {
    let frames: Vec<_> = (0..12).map(|i| noise(64, 48, i)).collect();
    let bytes = video(options(64, 48), &frames);
    let file = File(&bytes);
    let order: Vec<_> = file.boxes().into_iter().map(|(kind, _)| kind).collect();
    assert_eq!(order, ["ftyp", "moov", "mdat"]);
    // 12 frames of 1000 ticks, 5000 ticks a second.
    assert_eq!(words(file.find("moov/mvhd"))[3..5], [5000, 12_000]);
    assert_eq!(words(file.find("moov/trak/mdia/mdhd"))[3..5], [5000, 12_000]);
    assert_eq!(file.table("stts"), [0, 1, 12, 1000]);
    assert_eq!(file.table("stsc"), [0, 1, 1, 12, 1]);
    // A key frame every two seconds.
    assert_eq!(file.table("stss"), [0, 2, 1, 11]);
    assert_eq!(file.table("stsz")[3..].iter().sum::<u32>() as usize, file.find("mdat").len());
    let track = words(file.find("moov/trak/tkhd"));
    assert_eq!(track[track.len() - 2..], [64 << 16, 48 << 16]);
    let kinds: Vec<u8> = file.frames().iter().map(|f| f[f.len() - last_unit(f)] & 31).collect();
    assert_eq!((kinds[0], kinds[1], kinds[10]), (5, 1, 5));
}

/// The length of the last unit of a stream.
fn last_unit(stream: &[u8]) -> usize {
    let start = stream.windows(4).rposition(|window| window == [0, 0, 0, 1]).unwrap();
    stream.len() - start - 4
}

#[test]
fn colours_are_declared_in_file_and_stream() {
    let bytes = video(options(384, 48), &[patches()]);
    let file = File(&bytes);
    let colr = file.find("moov/trak/mdia/minf/stbl/stsd/avc1/colr");
    assert_eq!(colr, b"nclx\x00\x01\x00\x0d\x00\x01\x00");

    // ITU-T H.264, 7.3.2.1.1 for the constrained baseline profile, and E.1.1.
    let mut bits = Bits::new(file.parameters()[0]);
    assert_eq!((bits.take(8) & 31, bits.take(8)), (7, 66));
    bits.take(16);
    assert_eq!(bits.golomb(), 0);
    bits.golomb();
    match bits.golomb() {
        0 => drop(bits.golomb()),
        order => assert_eq!(order, 2),
    }
    bits.golomb();
    bits.take(1);
    assert_eq!((bits.golomb() + 1, bits.golomb() + 1), (24, 3));
    assert_eq!(bits.take(1), 1, "whole frames only");
    bits.take(1);
    if bits.take(1) == 1 {
        (0..4).for_each(|_| assert_eq!(bits.golomb(), 0, "nothing is cropped"));
    }
    assert_eq!(bits.take(1), 1, "usability information");
    if bits.take(1) == 1 && bits.take(8) == 255 {
        bits.take(32);
    }
    if bits.take(1) == 1 {
        bits.take(1);
    }
    assert_eq!((bits.take(1), bits.take(3)), (1, 5), "a signal type, of no named format");
    assert_eq!((bits.take(1), bits.take(1)), (0, 1), "limited range, and a description");
    assert_eq!([bits.take(8), bits.take(8), bits.take(8)], [1, 13, 1]);
}

#[test]
fn the_same_frames_give_the_same_bytes() {
    let frames: Vec<_> = (0..4).map(|i| noise(100, 60, i / 2)).collect();
    let options = options(100, 60);
    let bytes = video(options, &frames);
    assert!(bytes == video(options, &frames));
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("other.mp4");
    let mut writer = VideoWriter::create(&path, options).unwrap();
    for frame in frames.iter().step_by(2) {
        writer.push_pixels(frame.pixels()).unwrap();
        writer.repeat(1).unwrap();
    }
    assert_eq!((writer.frames(), writer.path()), (4, path.as_path()));
    let summary = writer.finish().unwrap();
    let expected = Summary { width: 100, height: 60, frames: 4, seconds: 0.8, bytes: bytes.len() as u64 };
    assert_eq!(summary, expected);
    assert!(fs::read(&path).unwrap() == bytes);
}

#[test]
fn quality_costs_bytes_and_stills_do_not() {
    let size = |quality, frames: &[Canvas]| video(VideoOptions { quality, ..options(96, 96) }, frames).len();
    let picture = noise(96, 96, 1);
    let sizes = [0, 50, 100].map(|quality| size(quality, std::slice::from_ref(&picture)));
    assert!(sizes[0] * 5 < sizes[1] * 4 && sizes[1] * 5 < sizes[2] * 4, "{sizes:?}");
    let still = vec![picture.clone(); 9];
    assert!(size(70, &still) < size(70, &[picture]) * 3 / 2);
}

#[test]
fn odd_sizes_become_even() {
    let folder = TempDir::new().unwrap();
    let mut writer = VideoWriter::create(folder.path().join("odd.mp4"), options(33, 17)).unwrap();
    writer.push(&noise(33, 17, 0)).unwrap();
    let summary = writer.finish().unwrap();
    assert_eq!((summary.width, summary.height), (34, 18));
}

#[test]
fn nothing_is_left_of_unfinished_videos() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("video.mp4");
    let mut writer = VideoWriter::create(&path, options(32, 32)).unwrap();
    writer.push(&noise(32, 32, 0)).unwrap();
    drop(writer);
    let empty = VideoWriter::create(&path, options(32, 32)).unwrap();
    assert!(matches!(empty.finish(), Err(VideoError::NoFrame)));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn bad_input_is_an_error() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("video.mp4");
    let message = |options| VideoWriter::create(&path, options).map(drop).unwrap_err().to_string();
    for (width, height) in [(0, 0), (15, 400), (400, 15), (3841, 16), (2161, 2161), (u32::MAX, u32::MAX)] {
        assert!(message(options(width, height)).contains("at least 16"));
    }
    assert!(message(VideoOptions { quality: 101, ..options(64, 64) }).contains("101"));
    for frames_per_second in [0, 61, u32::MAX] {
        let text = message(VideoOptions { frames_per_second, ..options(64, 64) });
        assert!(text.contains("1 to 60"), "{text}");
    }
    let missing = VideoWriter::create(folder.path().join("none").join("a.mp4"), options(64, 64));
    assert!(matches!(missing, Err(VideoError::File(_))));

    let mut writer = VideoWriter::create(&path, options(64, 64)).unwrap();
    assert!(matches!(writer.repeat(1), Err(VideoError::NoFrame)));
    let error = writer.push(&noise(64, 63, 0)).unwrap_err();
    assert_eq!(error.to_string(), "a frame of 64 × 63 in a video of 64 × 64");
    assert!(matches!(writer.push_pixels(&[[0; 3]; 7]), Err(VideoError::PixelCount { count: 7, .. })));
    assert_eq!(writer.frames(), 0);
}

/// The largest pictures that the encoder takes, upright and lying.
#[test]
fn sizes_up_to_the_limit_work() {
    for (width, height) in [(16, 16), (3840, 2160), (2160, 3840), (1920, 1080)] {
        let bytes = video(options(width, height), &[Canvas::new(width, height, [9; 3]).unwrap()]);
        assert_eq!(File(&bytes).frames().len(), 1);
    }
}
