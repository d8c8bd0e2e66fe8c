//! What all clips share.

use std::path::PathBuf;

use caustica_canvas::{Canvas, CanvasError};
use caustica_film::Develop;
use caustica_math::Rgb;
use caustica_render::{Control, RenderError};
use caustica_scene::{Diagnostic, Scene};
use caustica_video::{Summary, VideoError, VideoOptions, VideoWriter};

/// How a clip is made.
#[derive(Clone, Debug)]
pub struct ClipOptions {
    /// The file.
    pub path: PathBuf,
    /// What the scene is called in captions.
    pub title: String,
    /// From 1 to 60.
    pub frames_per_second: u32,
    /// How long the clip is; what is held at the end comes on top.
    pub seconds: f32,
    /// From 0 to 100.
    pub quality: u8,
    /// How linear light is shown.
    pub develop: Develop,
}

impl ClipOptions {
    /// Frames of the clip, without what is held at the end: one at least.
    pub(crate) fn frames(&self) -> u32 {
        ((self.seconds * self.frames_per_second as f32) as u32).max(1)
    }

    /// Frames of a time in seconds.
    pub(crate) fn frames_of(&self, seconds: f32) -> u32 {
        (seconds * self.frames_per_second as f32) as u32
    }

    /// The time of a frame in seconds.
    pub(crate) fn time_of(&self, frame: u32) -> f32 {
        frame as f32 / self.frames_per_second as f32
    }

    /// Linear pixels as a display shows them.
    pub(crate) fn show(&self, pixels: &[Rgb], size: [u32; 2]) -> Result<Canvas, CanvasError> {
        Canvas::developed(pixels, size, self.develop)
    }
}

/// How far a clip is: frames written, and frames in all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// Frames written.
    pub done: u32,
    /// Frames in all.
    pub total: u32,
}

/// Why a clip could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ClipError {
    /// Rendering.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A camera that cannot stand where the clip puts it.
    #[error(transparent)]
    Camera(#[from] Box<Diagnostic>),
    /// Drawing.
    #[error(transparent)]
    Canvas(#[from] CanvasError),
    /// Encoding or writing.
    #[error(transparent)]
    Video(#[from] VideoError),
    /// It was stopped before the first frame; nothing was written.
    #[error("the video was stopped before its first frame, and nothing is written")]
    Stopped,
}

/// A video that is being made.
pub(crate) struct Reel<'a, P> {
    control: &'a Control,
    progress: P,
    step: Step,
    writer: VideoWriter,
}

impl<'a, P: FnMut(Step)> Reel<'a, P> {
    /// Of that many frames of that size. Says at once if it could not be written.
    pub fn new(
        options: &ClipOptions,
        control: &'a Control,
        ([width, height], total): ([u32; 2], u32),
        progress: P,
    ) -> Result<Self, ClipError> {
        let (frames_per_second, quality) = (options.frames_per_second, options.quality);
        let video = VideoOptions { width, height, frames_per_second, quality };
        let writer = VideoWriter::create(&options.path, video)?;
        Ok(Self { control, progress, step: Step { done: 0, total }, writer })
    }

    /// Whether somebody asked to stop: then the video ends with the frames that it has.
    pub fn is_stopped(&self) -> bool {
        self.control.is_stopped()
    }

    /// Adds a frame.
    pub fn push(&mut self, frame: &Canvas) -> Result<(), ClipError> {
        self.writer.push(frame)?;
        self.step.done += 1;
        (self.progress)(self.step);
        Ok(())
    }

    /// Writes the file.
    pub fn finish(self) -> Result<Summary, ClipError> {
        if self.step.done == 0 {
            return Err(ClipError::Stopped);
        }
        Ok(self.writer.finish()?)
    }
}

/// The size of a scene's picture.
pub(crate) fn size_of(scene: &Scene) -> [u32; 2] {
    let window = scene.film.window();
    [window.width, window.height]
}
