//! Headers of the frames of MP3 and of AAC in ADTS.

/// What a header says of its frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Header {
    /// What has to be the same in all frames of a recording.
    pub format: Format,
    /// Bytes of the frame, its header included.
    pub bytes: usize,
    /// Bytes of the header.
    pub header_bytes: usize,
}

/// What has to be the same in all frames of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Format {
    pub sample_rate_hz: u32,
    pub channels: u8,
    /// Samples that a frame gives of each channel.
    pub samples: u16,
    /// The version of MPEG, or the kind of AAC, as the header has it.
    pub version: u8,
}

/// Bytes that it takes to read a header of either kind.
pub(super) const HEADER_BYTES: usize = 7;
/// The longest frame: ADTS has 13 bits for it, MP3 stays below 1,500.
pub(super) const MOST_BYTES: usize = 1 << 13;

/// Reads the header of a frame.
pub(super) type Parse = fn(&[u8; HEADER_BYTES]) -> Option<Header>;

/// A frame of MP3: ISO/IEC 11172-3, with the low rates of 13818-3 and those below them (2.5).
pub(super) fn mp3(bytes: &[u8; HEADER_BYTES]) -> Option<Header> {
    /// kbit/s of MPEG 1, and of 2 and 2.5.
    const RATES: [[u32; 16]; 2] = [
        [
            0, 32, 40, 48, 56, 64, 80, 96, 112, 128, 160, 192, 224, 256, 320, 0,
        ],
        [
            0, 8, 16, 24, 32, 40, 48, 56, 64, 80, 96, 112, 128, 144, 160, 0,
        ],
    ];
    let [first, second, third, fourth, ..] = *bytes;
    let version = (second >> 3) & 3;
    let base_hz = match third >> 2 & 3 {
        0 => 44_100,
        1 => 48_000,
        2 => 32_000,
        _ => return None,
    };
    let (sample_rate_hz, samples) = match version {
        3 => (base_hz, 1_152),
        2 => (base_hz / 2, 576),
        0 => (base_hz / 4, 576),
        _ => return None,
    };
    let kbit_per_s = RATES[usize::from(version != 3)][usize::from(third >> 4)];
    // Without a rate of bits a frame would have any length.
    if first != 0xFF || second & 0xE6 != 0xE2 || kbit_per_s == 0 {
        return None;
    }
    let padding = u32::from(third >> 1 & 1);
    let bytes = u32::from(samples) / 8 * kbit_per_s * 1_000 / sample_rate_hz + padding;
    Some(Header {
        format: Format {
            sample_rate_hz,
            channels: if fourth >> 6 == 3 { 1 } else { 2 },
            samples,
            version,
        },
        bytes: usize::try_from(bytes).ok()?,
        header_bytes: 0,
    })
}

/// A frame of AAC: ISO/IEC 14496-3, 1.A.2.2, with one block of 1024 samples in it.
pub(super) fn adts(bytes: &[u8; HEADER_BYTES]) -> Option<Header> {
    const RATES_HZ: [u32; 13] = [
        96_000, 88_200, 64_000, 48_000, 44_100, 32_000, 24_000, 22_050, 16_000, 12_000, 11_025,
        8_000, 7_350,
    ];
    let [first, second, third, fourth, fifth, sixth, seventh] = *bytes;
    if first != 0xFF || second & 0xF6 != 0xF0 || seventh & 3 != 0 {
        return None;
    }
    let length = usize::from(fourth & 3) << 11 | usize::from(fifth) << 3 | usize::from(sixth >> 5);
    let header_bytes = if second & 1 == 1 { 7 } else { 9 };
    (length > header_bytes).then_some(Header {
        format: Format {
            sample_rate_hz: *RATES_HZ.get(usize::from(third >> 2 & 15))?,
            channels: (third & 1) << 2 | fourth >> 6,
            samples: 1_024,
            version: third >> 6,
        },
        bytes: length,
        header_bytes,
    })
}

/// What an encoder put before the first sample, if this frame of MP3 is none but a note of the encoder (Xing, Info, VBRI);
/// zero where the note does not say.
pub(super) fn note(frame: &[u8], format: Format) -> Option<u32> {
    /// The decoder's own delay, in samples.
    const DECODER: u32 = 529;
    let side_bytes = match (format.version == 3, format.channels) {
        (true, 2) => 32,
        (true, _) | (false, 2) => 17,
        (false, _) => 9,
    };
    if frame.get(36..40) == Some(b"VBRI") {
        return Some(0);
    }
    let note = frame.get(4 + side_bytes..)?;
    if !matches!(note.get(..4)?, b"Xing" | b"Info") {
        return None;
    }
    // Fields that are there are told by the bits of the eighth byte.
    let flags = note.get(7)?;
    let fields = [4, 4, 100, 4].into_iter().enumerate();
    let skipped: usize = fields
        .filter(|(bit, _)| flags >> bit & 1 == 1)
        .map(|(_, bytes)| bytes)
        .sum();
    let encoder = note.get(8 + skipped..).unwrap_or_default();
    let Some([high, low, _]) = encoder.get(21..24) else {
        return Some(0);
    };
    let delay = u32::from(*high) << 4 | u32::from(low >> 4);
    // A note that names no encoder says nothing of its delay.
    Some(if encoder[0] == 0 { 0 } else { delay + DECODER })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_are_those_of_the_standards() {
        // 128 kbit/s, 44.1 kHz, joint stereo, without and with padding.
        let of = mp3(&[0xFF, 0xFB, 0x90, 0x64, 0, 0, 0]).unwrap();
        assert_eq!(
            (of.bytes, of.format.sample_rate_hz, of.format.channels),
            (417, 44_100, 2)
        );
        assert_eq!(mp3(&[0xFF, 0xFB, 0x92, 0x64, 0, 0, 0]).unwrap().bytes, 418);
        // MPEG 2, 64 kbit/s, 22.05 kHz, mono.
        let of = mp3(&[0xFF, 0xF3, 0x80, 0xC0, 0, 0, 0]).unwrap();
        assert_eq!(
            (of.bytes, of.format.sample_rate_hz, of.format.channels),
            (208, 22_050, 1)
        );
        for bad in [
            [0xFF, 0xFB, 0xF0],
            [0xFF, 0xFB, 0x9C],
            [0xFF, 0xFD, 0x90],
            [0xFF, 0xEB, 0x90],
            [0xFF, 0xFB, 0x00],
        ] {
            assert_eq!(mp3(&[bad[0], bad[1], bad[2], 0, 0, 0, 0]), None, "{bad:?}");
        }
        // LC, 44.1 kHz, mono, 371 bytes.
        let of = adts(&[0xFF, 0xF1, 0x50, 0x40, 0x2E, 0x7F, 0xFC]).unwrap();
        assert_eq!((of.bytes, of.header_bytes, of.format.channels), (371, 7, 1));
        assert_eq!((of.format.sample_rate_hz, of.format.version), (44_100, 1));
        assert_eq!(adts(&[0xFF, 0xF1, 0x7C, 0x40, 0x2E, 0x7F, 0xFC]), None);
    }
}
