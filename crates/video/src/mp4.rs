//! MP4 files of one video track (ISO/IEC 14496-12 and -15), the index before the data.

use std::io::{self, Write};

use crate::VideoError;

/// Ticks of a frame, so that any whole number of frames a second has a time scale.
const FRAME_TICKS: u32 = 1000;
/// The identity of a display matrix: 16.16 numbers, in the last column 2.30.
const IDENTITY: [u32; 9] = [0x1_0000, 0, 0, 0, 0x1_0000, 0, 0, 0, 0x4000_0000];
/// ITU-T H.273: BT.709 primaries, sRGB transfer, BT.709 matrix; limited range.
const COLOURS: [u8; 7] = [0, 1, 0, 13, 0, 1, 0];

/// The frames of a video as H.264 access units with lengths of four bytes, and what describes them.
pub(crate) struct Track {
    size: (u32, u32),
    frames_per_second: u32,
    pub(crate) sequence_parameters: Vec<u8>,
    pub(crate) picture_parameters: Vec<u8>,
    data: Vec<u8>,
    lengths: Vec<u32>,
    /// Numbers of frames, from one, at which a player can begin.
    keys: Vec<u32>,
}

impl Track {
    pub(crate) fn new(size: (u32, u32), frames_per_second: u32) -> Self {
        let (sequence_parameters, picture_parameters) = (Vec::new(), Vec::new());
        let (data, lengths, keys) = (Vec::new(), Vec::new(), Vec::new());
        Self { size, frames_per_second, sequence_parameters, picture_parameters, data, lengths, keys }
    }

    /// Adds a frame. An error if the file would outgrow addresses of 32 bits.
    pub(crate) fn push(&mut self, frame: &[u8], is_key: bool) -> Result<(), VideoError> {
        // The index takes less than 16 bytes a frame and a kilobyte.
        let index = 16 * (self.lengths.len() as u64 + 64);
        let end = (self.data.len() + frame.len()) as u64 + index;
        let ticks = (self.lengths.len() as u64 + 1) * u64::from(FRAME_TICKS);
        if end > u64::from(u32::MAX) || ticks > u64::from(u32::MAX) {
            return Err(VideoError::TooLong);
        }
        self.data.extend(frame);
        self.lengths.push(frame.len() as u32);
        if is_key {
            self.keys.push(self.lengths.len() as u32);
        }
        Ok(())
    }

    /// How many frames there are.
    pub(crate) fn frames(&self) -> u32 {
        self.lengths.len() as u32
    }

    /// Writes the whole file and returns its length in bytes.
    pub(crate) fn write(&self, to: &mut impl Write) -> io::Result<u64> {
        let brands = [*b"isom", [0, 0, 2, 0], *b"isom", *b"iso2", *b"avc1", *b"mp41"];
        let file_type = atom(b"ftyp", brands.as_flattened());
        // The index has the same length whatever the address in it.
        let start = file_type.len() + self.index(0).len() + 8;
        let index = self.index(start as u32);
        to.write_all(&file_type)?;
        to.write_all(&index)?;
        to.write_all(&(self.data.len() as u32 + 8).to_be_bytes())?;
        to.write_all(b"mdat")?;
        to.write_all(&self.data)?;
        Ok((start + self.data.len()) as u64)
    }

    fn index(&self, data_start: u32) -> Vec<u8> {
        let (time_scale, duration) = (self.frames_per_second * FRAME_TICKS, self.frames() * FRAME_TICKS);
        let movie =
            words(&[&[0, 0, 0, time_scale, duration, 0x1_0000, 0x100_0000, 0, 0], &IDENTITY, &[0; 6], &[2]]);
        let (width, height) = (self.size.0 << 16, self.size.1 << 16);
        // Flags: enabled, in the movie, in its preview.
        let track = words(&[&[7, 0, 0, 1, 0, duration, 0, 0, 0, 0], &IDENTITY, &[width, height]]);
        // The packed language is "und".
        let media = words(&[&[0, 0, 0, time_scale, duration, 0x55c4_0000]]);
        let handler = [words(&[&[0, 0]]), b"vide".to_vec(), vec![0; 12], b"Caustica\0".to_vec()].concat();
        let information = [
            atom(b"vmhd", &words(&[&[1, 0, 0]])),
            atom(b"dinf", &atom(b"dref", &[words(&[&[0, 1]]), atom(b"url ", &[0, 0, 0, 1])].concat())),
            atom(b"stbl", &self.sample_table(data_start)),
        ];
        let media = [atom(b"mdhd", &media), atom(b"hdlr", &handler), atom(b"minf", &information.concat())];
        let track = [atom(b"tkhd", &track), atom(b"mdia", &media.concat())];
        atom(b"moov", &[atom(b"mvhd", &movie), atom(b"trak", &track.concat())].concat())
    }

    fn sample_table(&self, data_start: u32) -> Vec<u8> {
        let frames = self.frames();
        [
            atom(b"stsd", &[words(&[&[0, 1]]), self.sample_entry()].concat()),
            atom(b"stts", &words(&[&[0, 1, frames, FRAME_TICKS]])),
            atom(b"stss", &words(&[&[0, self.keys.len() as u32], &self.keys])),
            // All frames are one chunk.
            atom(b"stsc", &words(&[&[0, 1, 1, frames, 1]])),
            atom(b"stsz", &words(&[&[0, 0, frames], &self.lengths])),
            atom(b"stco", &words(&[&[0, 1, data_start]])),
        ]
        .concat()
    }

    /// What the frames are: size, parameter sets, colours.
    fn sample_entry(&self) -> Vec<u8> {
        let mut name = [0; 32];
        name[..9].copy_from_slice(b"\x08Caustica");
        let body = [
            // The first of the data references.
            words(&[&[0, 1, 0, 0, 0, 0, self.size.0 << 16 | self.size.1]]),
            // 72 dots an inch; one frame a sample.
            words(&[&[0x48_0000, 0x48_0000, 0]]),
            vec![0, 1],
            name.to_vec(),
            // 24 bits without alpha; no colour table.
            vec![0, 24, 255, 255],
            atom(b"avcC", &self.decoder_configuration()),
            atom(b"colr", &[b"nclx".as_slice(), &COLOURS].concat()),
        ];
        atom(b"avc1", &body.concat())
    }

    fn decoder_configuration(&self) -> Vec<u8> {
        // Profile, compatibility and level are repeated from the sequence's parameters.
        let profile = self.sequence_parameters.get(1..4).unwrap_or(&[0; 3]);
        let set = |unit: &[u8]| [&(unit.len() as u16).to_be_bytes(), unit].concat();
        // Lengths of four bytes; one set of each kind; the other bits are reserved as ones.
        [&[1], profile, &[0xff, 0xe1], &set(&self.sequence_parameters), &[1], &set(&self.picture_parameters)]
            .concat()
    }
}

/// A box: its length, its kind, what is in it.
fn atom(kind: &[u8; 4], body: &[u8]) -> Vec<u8> {
    [&(body.len() as u32 + 8).to_be_bytes(), kind.as_slice(), body].concat()
}

/// Numbers of four bytes, the highest first.
fn words(parts: &[&[u32]]) -> Vec<u8> {
    parts.iter().flat_map(|part| part.iter()).flat_map(|word| word.to_be_bytes()).collect()
}
