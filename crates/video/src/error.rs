//! What can go wrong with a video.

use caustica_canvas::CanvasError;
use caustica_film::FilmError;

/// An error of a video or of the pictures it is made from.
#[derive(Debug, thiserror::Error)]
pub enum VideoError {
    /// A size that the encoder does not know.
    #[error(
        "a video of {width} × {height} pixels cannot be made: sides are at least 16, \
         the longer at most 3840 and the shorter at most 2160"
    )]
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// A number of frames per second out of range.
    #[error("{0} frames a second: choose 1 to 60")]
    FrameRate(u32),
    /// A quality out of range.
    #[error("a quality of {0}: choose 0 (smallest file) to 100 (best picture)")]
    Quality(u8),
    /// A frame that is not as large as the video.
    #[error("a frame of {width} × {height} in a video of {video_width} × {video_height}")]
    FrameSize {
        /// Width of the frame.
        width: u32,
        /// Height of the frame.
        height: u32,
        /// Width of the video.
        video_width: u32,
        /// Height of the video.
        video_height: u32,
    },
    /// A frame with too few or too many pixels.
    #[error("a frame of {count} pixels in a video of {width} × {height}")]
    PixelCount {
        /// How many there are.
        count: usize,
        /// Width of the video.
        width: u32,
        /// Height of the video.
        height: u32,
    },
    /// Two pictures that should be joined differ in size.
    #[error("pictures of {0} × {1} and {2} × {3} cannot be joined: they must be of the same size")]
    Mismatch(u32, u32, u32, u32),
    /// Nothing to repeat or to finish.
    #[error("the video has no frame yet")]
    NoFrame,
    /// More than an MP4 file with addresses of 32 bits holds.
    #[error("the video is longer than its file can be: 4 GiB")]
    TooLong,
    /// The encoder failed.
    #[error("the H.264 encoder failed: {0}")]
    Encoder(String),
    /// A picture could not be made.
    #[error(transparent)]
    Canvas(#[from] CanvasError),
    /// The file could not be written.
    #[error(transparent)]
    File(#[from] FilmError),
}

impl From<openh264::Error> for VideoError {
    fn from(error: openh264::Error) -> Self {
        Self::Encoder(error.to_string())
    }
}
