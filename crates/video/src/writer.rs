//! From frames to a file.

use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use caustica_canvas::Canvas;
use caustica_film::{FilmError, check_writable, write_atomically};

use crate::VideoError;
use crate::encoder::FrameEncoder;
use crate::planes::Planes;

/// How a video is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VideoOptions {
    /// Width of the frames in pixels. An odd one gets one column more, which repeats the last.
    pub width: u32,
    /// Height of the frames in pixels. An odd one gets one row more, which repeats the last.
    pub height: u32,
    /// From 1 to 60.
    pub frames_per_second: u32,
    /// From 0, the smallest file, to 100, the best picture: H.264 quantisers from 40 to 12, evenly.
    pub quality: u8,
}

impl VideoOptions {
    /// The default quality: its loss is hard to see, a quantiser of 20.
    pub const GOOD: u8 = 70;

    /// 30 frames a second of good quality.
    pub const fn new(width: u32, height: u32) -> Self {
        Self { width, height, frames_per_second: 30, quality: Self::GOOD }
    }

    fn check(&self) -> Result<(), VideoError> {
        let Self { width, height, frames_per_second, quality } = *self;
        let (shorter, longer) = (width.min(height), width.max(height));
        if !(16..=2160).contains(&shorter) || longer > 3840 {
            return Err(VideoError::Size { width, height });
        }
        if !(1..=60).contains(&frames_per_second) {
            return Err(VideoError::FrameRate(frames_per_second));
        }
        if quality > 100 {
            return Err(VideoError::Quality(quality));
        }
        Ok(())
    }
}

/// What was written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Width of the frames in the file, which is even.
    pub width: u32,
    /// Height of the frames in the file, which is even.
    pub height: u32,
    /// How many frames there are.
    pub frames: u32,
    /// How long they last.
    pub seconds: f64,
    /// Length of the file.
    pub bytes: u64,
}

/// Makes an MP4 file from frames. Encoded frames stay in memory until [`finish`](Self::finish) writes the
/// file under a temporary name and renames it; a writer that is dropped before leaves nothing behind.
pub struct VideoWriter {
    path: PathBuf,
    options: VideoOptions,
    size: (u32, u32),
    encoder: FrameEncoder,
    frame: Planes,
}

impl VideoWriter {
    /// A video without frames. An error if the options are out of range or the file could not be written.
    pub fn create(path: impl Into<PathBuf>, options: VideoOptions) -> Result<Self, VideoError> {
        options.check()?;
        let path = path.into();
        check_writable(&path)?;
        let size = (options.width.next_multiple_of(2), options.height.next_multiple_of(2));
        let encoder = FrameEncoder::new(size, options.frames_per_second, options.quality)?;
        Ok(Self { path, options, size, encoder, frame: Planes::new(size.0, size.1) })
    }

    /// Adds a frame, which must have the size that the options say.
    pub fn push(&mut self, frame: &Canvas) -> Result<(), VideoError> {
        let VideoOptions { width, height, .. } = self.options;
        if (frame.width(), frame.height()) != (width, height) {
            let (video_width, video_height) = (width, height);
            let (width, height) = (frame.width(), frame.height());
            return Err(VideoError::FrameSize { width, height, video_width, video_height });
        }
        self.push_pixels(frame.pixels())
    }

    /// Adds a frame of sRGB pixels, row by row from the top.
    pub fn push_pixels(&mut self, pixels: &[[u8; 3]]) -> Result<(), VideoError> {
        let VideoOptions { width, height, .. } = self.options;
        if pixels.len() as u64 != u64::from(width) * u64::from(height) {
            return Err(VideoError::PixelCount { count: pixels.len(), width, height });
        }
        self.frame.fill(pixels, width);
        self.encoder.push(&self.frame)
    }

    /// Adds the last frame another `times`, which takes few bytes.
    pub fn repeat(&mut self, times: u32) -> Result<(), VideoError> {
        if self.encoder.track.frames() == 0 {
            return Err(VideoError::NoFrame);
        }
        (0..times).try_for_each(|_| self.encoder.push(&self.frame))
    }

    /// How many frames there are so far.
    pub fn frames(&self) -> u32 {
        self.encoder.track.frames()
    }

    /// Where the video will be written.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the file. An error if there is no frame.
    pub fn finish(self) -> Result<Summary, VideoError> {
        let track = self.encoder.track;
        if track.frames() == 0 {
            return Err(VideoError::NoFrame);
        }
        let mut bytes = 0;
        write_atomically(&self.path, |file| {
            let mut buffered = BufWriter::new(file);
            let written = track.write(&mut buffered).and_then(|n| buffered.flush().map(|()| n));
            bytes = written.map_err(|source| FilmError::Io { path: self.path.clone(), source })?;
            Ok(())
        })?;
        let seconds = f64::from(track.frames()) / f64::from(self.options.frames_per_second);
        Ok(Summary { width: self.size.0, height: self.size.1, frames: track.frames(), seconds, bytes })
    }
}
