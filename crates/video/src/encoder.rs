//! H.264 by OpenH264, one access unit a frame.

use openh264::OpenH264API;
use openh264::encoder::{
    BitRate, Encoder, EncoderConfig, FrameRate, FrameType, IntraFramePeriod, QpRange, RateControlMode,
    TransferCharacteristics, VuiConfig,
};

use crate::VideoError;
use crate::mp4::Track;
use crate::planes::Planes;

/// The finest and the coarsest quantiser that qualities stand for. OpenH264 has none finer.
const FINEST: u8 = 12;
const COARSEST: u8 = 40;
/// The coarsest of H.264.
const LAST_RESORT: u8 = 51;
/// Six more double the quantiser's step: about one bit less a sample.
const COARSER: u8 = 6;
/// Seconds between frames at which a player can begin.
const KEY_FRAME_SECONDS: u32 = 2;

const SEQUENCE_PARAMETERS: u8 = 7;
const PICTURE_PARAMETERS: u8 = 8;

/// An encoder and what it has made so far.
///
/// OpenH264 gives up, for good, on a frame that takes more than 8 to 12 bits a pixel, as pure noise does at
/// high quality. The frame is then made by a new encoder with a coarser quantiser, up to the next key
/// frame.
pub(crate) struct FrameEncoder {
    encoder: Encoder,
    config: EncoderConfig,
    /// The quantiser that the quality stands for, and the one in use.
    wished: u8,
    quantiser: u8,
    key_interval: u32,
    /// How many key frames the encoder has made before its last one, which its `idr_pic_id` follows. Two
    /// key frames in a row must not share that.
    identity: u32,
    last_was_key: bool,
    pub(crate) track: Track,
}

impl FrameEncoder {
    /// An encoder for even sizes. `quality` is from 0 to 100.
    pub(crate) fn new(size: (u32, u32), frames_per_second: u32, quality: u8) -> Result<Self, VideoError> {
        let range = u32::from(COARSEST - FINEST);
        let wished = COARSEST - ((range * u32::from(quality.min(100)) + 50) / 100) as u8;
        let config = config(size, frames_per_second);
        Ok(Self {
            encoder: start(config, wished)?,
            config,
            wished,
            quantiser: wished,
            key_interval: KEY_FRAME_SECONDS * frames_per_second,
            identity: 0,
            last_was_key: false,
            track: Track::new(size, frames_per_second),
        })
    }

    /// Encodes a frame and adds it to the track.
    pub(crate) fn push(&mut self, frame: &Planes) -> Result<(), VideoError> {
        let frames = self.track.frames();
        let mut result = Ok(());
        if frames > 0 && frames.is_multiple_of(self.key_interval) {
            if self.quantiser == self.wished {
                self.force_key();
            } else {
                result = self.restart(self.wished, frame);
            }
        }
        loop {
            match result.and_then(|()| self.encode(frame)) {
                Ok(Unit { data, is_key }) => {
                    self.last_was_key = is_key;
                    return self.track.push(&data, is_key);
                }
                Err(error) if self.quantiser == LAST_RESORT => return Err(error),
                Err(_) => result = self.restart((self.quantiser + COARSER).min(LAST_RESORT), frame),
            }
        }
    }

    fn force_key(&mut self) {
        self.encoder.force_intra_frame();
        self.identity += 1;
    }

    /// Begins anew, so that the next frame is a key frame.
    fn restart(&mut self, quantiser: u8, frame: &Planes) -> Result<(), VideoError> {
        self.quantiser = quantiser;
        self.encoder = start(self.config, quantiser)?;
        let taken = self.last_was_key && self.identity == 0;
        self.identity = 0;
        if taken {
            // The first key frame of every encoder has the same identity: this one is not used.
            self.encoder.encode(frame)?;
            self.force_key();
        }
        Ok(())
    }

    fn encode(&mut self, frame: &Planes) -> Result<Unit, VideoError> {
        let stream = self.encoder.encode(frame)?;
        let is_key = matches!(stream.frame_type(), FrameType::IDR);
        let mut data = Vec::new();
        for layer in (0..stream.num_layers()).filter_map(|i| stream.layer(i)) {
            for unit in (0..layer.nal_count()).filter_map(|i| layer.nal_unit(i)) {
                let unit = without_start_code(unit);
                match unit.first().map(|header| header & 31) {
                    None => {}
                    Some(SEQUENCE_PARAMETERS) => set_once(&mut self.track.sequence_parameters, unit)?,
                    Some(PICTURE_PARAMETERS) => set_once(&mut self.track.picture_parameters, unit)?,
                    Some(_) => {
                        data.extend((unit.len() as u32).to_be_bytes());
                        data.extend(unit);
                    }
                }
            }
        }
        if data.is_empty() {
            return Err(VideoError::Encoder("it left a frame out".to_owned()));
        }
        Ok(Unit { data, is_key })
    }
}

/// An encoded frame.
struct Unit {
    data: Vec<u8>,
    is_key: bool,
}

fn config(size: (u32, u32), frames_per_second: u32) -> EncoderConfig {
    // Only the level that the stream declares depends on the bit rate.
    let bits_per_second = u64::from(size.0) * u64::from(size.1) * u64::from(frames_per_second) / 10;
    EncoderConfig::new()
        // The one mode that keeps to one quantiser.
        .rate_control_mode(RateControlMode::Bufferbased)
        .bitrate(BitRate::from_bps(bits_per_second.clamp(1000, 40_000_000) as u32))
        .max_frame_rate(FrameRate::from_hz(frames_per_second as f32))
        .intra_frame_period(IntraFramePeriod::auto())
        .skip_frames(false)
        .adaptive_quantization(false)
        .background_detection(false)
        .scene_change_detect(false)
        // More threads would mean more slices, and other bytes on other machines.
        .num_threads(1)
        .vui(VuiConfig::bt709().transfer_characteristics(TransferCharacteristics::Srgb))
}

fn start(config: EncoderConfig, quantiser: u8) -> Result<Encoder, VideoError> {
    let config = config.qp(QpRange::new(quantiser, quantiser));
    Ok(Encoder::with_api_config(OpenH264API::from_source(), config)?)
}

/// The file names each parameter set once, for all frames.
fn set_once(parameters: &mut Vec<u8>, unit: &[u8]) -> Result<(), VideoError> {
    if parameters.is_empty() {
        unit.clone_into(parameters);
    }
    if parameters == unit {
        Ok(())
    } else {
        Err(VideoError::Encoder("its parameters changed within the video".to_owned()))
    }
}

/// A unit of the byte stream format (ITU-T H.264, annex B) without the zeros and the one before it.
fn without_start_code(unit: &[u8]) -> &[u8] {
    match unit.iter().position(|byte| *byte != 0) {
        Some(i) if i >= 2 && unit[i] == 1 => &unit[i + 1..],
        _ => unit,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wished_quality_returns_at_key_frames() {
        let (mut noise, mut calm) = (Planes::new(64, 48), Planes::new(64, 48));
        let bit =
            |i: u32| (i.wrapping_mul(0x85eb_ca6b) ^ i.wrapping_mul(0xc2b2_ae35) >> 7).count_ones() % 2 * 255;
        let pixels: Vec<_> = (0..64 * 48u32).map(|i| [0, 7, 11].map(|k| bit(i * 13 + k) as u8)).collect();
        noise.fill(&pixels, 64);
        calm.fill(&[[128; 3]; 64 * 48], 64);
        let mut encoder = FrameEncoder::new((64, 48), 2, 100).unwrap();
        let mut quantisers = Vec::new();
        for frame in [&calm, &noise, &calm, &calm, &calm, &calm] {
            encoder.push(frame).unwrap();
            quantisers.push(encoder.quantiser > encoder.wished);
        }
        assert_eq!(quantisers, [false, true, true, true, false, false]);
        assert_eq!(encoder.track.frames(), 6);
    }
}
