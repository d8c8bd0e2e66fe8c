//! A reader of the files that we write, apart from the writer.

/// An MP4 file.
pub(super) struct File<'a>(pub &'a [u8]);

impl<'a> File<'a> {
    /// The boxes of the file, kind and body, in order.
    pub(super) fn boxes(&self) -> Vec<(String, &'a [u8])> {
        split(self.0)
    }

    /// The body of the box at a path such as `moov/trak`.
    pub(super) fn find(&self, path: &str) -> &'a [u8] {
        path.split('/').fold(self.0, |body, kind| {
            let found = split(body).into_iter().find(|(name, _)| name == kind);
            let body = found.unwrap_or_else(|| panic!("no {kind} of {path}")).1;
            match kind {
                // Version, flags, count; a sample entry's fixed part.
                "stsd" | "dref" => &body[8..],
                "avc1" => &body[78..],
                _ => body,
            }
        })
    }

    /// The body of a box of the sample table.
    pub(super) fn table(&self, path: &str) -> Vec<u32> {
        words(self.find(&format!("moov/trak/mdia/minf/stbl/{path}")))
    }

    /// The sequence's and the picture's parameters.
    pub(super) fn parameters(&self) -> [&'a [u8]; 2] {
        let avcc = self.find("moov/trak/mdia/minf/stbl/stsd/avc1/avcC");
        assert_eq!((avcc[0], avcc[4], avcc[5]), (1, 0xff, 0xe1));
        let length = |at: usize| usize::from(u16::from_be_bytes([avcc[at], avcc[at + 1]]));
        let sequence = &avcc[8..][..length(6)];
        let next = 8 + sequence.len();
        assert_eq!(avcc[next], 1);
        let picture = &avcc[next + 3..];
        assert_eq!(picture.len(), length(next + 1));
        assert_eq!(avcc[1..4], sequence[1..4]);
        [sequence, picture]
    }

    /// The frames as a stream with start codes, with all parameters before each.
    pub(super) fn frames(&self) -> Vec<Vec<u8>> {
        let mut place = self.table("stco")[2] as usize;
        let parameters = self.parameters().map(|unit| [&[0, 0, 0, 1], unit].concat()).concat();
        let lengths = self.table("stsz");
        let frames = lengths[3..].iter().map(|length| {
            let frame = &self.0[place..][..*length as usize];
            place += *length as usize;
            [parameters.clone(), with_start_codes(frame)].concat()
        });
        frames.collect()
    }

    /// The `idr_pic_id` of each frame that is a key frame (ITU-T H.264, 7.3.3).
    pub(super) fn key_identities(&self) -> Vec<Option<u32>> {
        let mut sequence = Bits::new(&self.parameters()[0][4..]);
        sequence.golomb();
        let number_length = sequence.golomb() as usize + 4;
        let identity = |frame: &Vec<u8>| {
            let start = frame.windows(4).rposition(|window| window == [0, 0, 0, 1]).unwrap() + 4;
            let mut slice = Bits::new(&frame[start + 1..]);
            // The first macroblock, the type, the picture's parameters.
            let _ = [slice.golomb(), slice.golomb(), slice.golomb()];
            slice.take(number_length);
            (frame[start] & 31 == 5).then(|| slice.golomb())
        };
        self.frames().iter().map(identity).collect()
    }
}

fn with_start_codes(mut frame: &[u8]) -> Vec<u8> {
    let mut stream = Vec::new();
    while let Some((length, rest)) = frame.split_first_chunk::<4>() {
        let (unit, rest) = rest.split_at(u32::from_be_bytes(*length) as usize);
        stream.extend([0, 0, 0, 1]);
        stream.extend(unit);
        frame = rest;
    }
    assert!(frame.is_empty());
    stream
}

fn split(mut bytes: &[u8]) -> Vec<(String, &[u8])> {
    let mut boxes = Vec::new();
    while let Some((head, _)) = bytes.split_first_chunk::<8>() {
        let length = u32::from_be_bytes(head[..4].try_into().unwrap()) as usize;
        let (this, rest) = bytes.split_at(length);
        boxes.push((String::from_utf8(head[4..].to_vec()).unwrap(), &this[8..]));
        bytes = rest;
    }
    assert!(bytes.is_empty(), "{} bytes are in no box", bytes.len());
    boxes
}

pub(super) fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|word| u32::from_be_bytes(word.try_into().unwrap())).collect()
}

/// Reads the bits of a unit (ITU-T H.264, 7.2 and 9.1), without the bytes that only prevent start codes.
pub(super) struct Bits {
    bytes: Vec<u8>,
    place: usize,
}

impl Bits {
    pub(super) fn new(unit: &[u8]) -> Self {
        let mut bytes: Vec<u8> = Vec::new();
        for byte in unit {
            if !(*byte == 3 && bytes.ends_with(&[0, 0])) {
                bytes.push(*byte);
            }
        }
        Self { bytes, place: 0 }
    }

    pub(super) fn take(&mut self, count: usize) -> u32 {
        (0..count).fold(0, |value, _| {
            let bit = self.bytes[self.place / 8] >> (7 - self.place % 8) & 1;
            self.place += 1;
            value << 1 | u32::from(bit)
        })
    }

    /// An Exp-Golomb code without sign.
    pub(super) fn golomb(&mut self) -> u32 {
        let mut zeros = 0;
        while self.take(1) == 0 {
            zeros += 1;
        }
        (1 << zeros) - 1 + self.take(zeros)
    }
}
