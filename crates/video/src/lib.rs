//! MP4 files with H.264 that browsers play, and the frames of Caustica's videos.
//!
//! A [`VideoWriter`] takes frames of display values and writes a file when it is finished: constant
//! frame rate, constant quantiser, a key frame every two seconds, its index before its data so that
//! playing starts at once. The same frames give the same bytes. Frames are made from pictures by
//! [`caption`], [`label`], [`wipe`], [`cross_fade`] and [`side_by_side`]; [`sweep`] and [`toggle`] say
//! how far such a change has gone at a time.
//!
//! Pictures are sRGB. They are stored as BT.709 Y′CbCr in limited range, 4:2:0, and both the H.264
//! stream and the MP4 file say so: primaries 1, transfer 13 (sRGB), matrix 1 of ITU-T H.273. The
//! transfer is that of the pixels as they come. Players that manage colours by it, as Apple's do, show
//! sRGB pixels too bright where they are marked as BT.709's camera curve (1); Chromium shows both alike.

mod encoder;
mod error;
mod frames;
mod mp4;
mod planes;
mod timing;
mod writer;

pub use error::VideoError;
pub use frames::{Corner, caption, cross_fade, label, side_by_side, wipe};
pub use timing::{sweep, toggle};
pub use writer::{Summary, VideoOptions, VideoWriter};

#[cfg(test)]
mod tests;
