use proptest::prelude::*;

use super::*;

fn sound() -> Audio {
    Audio::new(vec![0.0, -1.0, 0.5, 0.25, -0.125, 0.75], 2, 16_000).unwrap()
}

#[test]
fn every_encoding_both_ways() {
    for encoding in [
        WavEncoding::Pcm8,
        WavEncoding::Pcm16,
        WavEncoding::Pcm24,
        WavEncoding::Pcm32,
        WavEncoding::Float32,
        WavEncoding::Float64,
    ] {
        let bytes = wav_from_audio(&sound(), encoding).unwrap();
        assert_eq!(audio_from_wav(&bytes).unwrap(), sound(), "{encoding:?}");
    }
    assert!(wav_from_audio(&sound(), WavEncoding::MuLaw).is_err());
}

#[test]
fn loud_samples_are_clipped() {
    let loud = Audio::new(vec![2.0, -2.0], 1, 8000).unwrap();
    let read = |encoding| audio_from_wav(&wav_from_audio(&loud, encoding).unwrap()).unwrap();
    assert_eq!(read(WavEncoding::Pcm16).array().as_slice(), [32767.0 / 32768.0, -1.0]);
    assert_eq!(read(WavEncoding::Pcm24).array().as_slice(), [8_388_607.0 / 8_388_608.0, -1.0]);
    assert_eq!(read(WavEncoding::Pcm8).array().as_slice(), [127.0 / 128.0, -1.0]);
}

/// Values of the tables of ITU-T G.711.
#[test]
fn companded_samples_expand() {
    assert_eq!([0x00, 0x80, 0x7f, 0xff].map(pcm_from_mu_law), [-32124, 32124, 0, 0]);
    assert_eq!([0x2a, 0xaa, 0x55, 0xd5].map(pcm_from_a_law), [-32256, 32256, -8, 8]);
}

#[test]
fn longer_headers_and_odd_chunks_are_read() {
    let plain = wav_from_audio(&sound(), WavEncoding::Pcm16).unwrap();
    let mut longer = plain[..16].to_vec();
    longer.extend(40u32.to_le_bytes());
    longer.extend(EXTENSIBLE.to_le_bytes());
    longer.extend(&plain[22..36]);
    longer.extend([22, 0, 16, 0, 3, 0, 0, 0, 1, 0]);
    longer.extend([0; 14]);
    longer.extend(*b"LIST\x03\0\0\0abc\0");
    longer.extend(&plain[36..]);
    assert_eq!(audio_from_wav(&longer).unwrap(), sound());
    let mut piped = plain;
    piped[40..44].copy_from_slice(&UNKNOWN_LENGTH.to_le_bytes());
    assert_eq!(audio_from_wav(&piped).unwrap(), sound());
}

#[test]
fn broken_files_are_refused() {
    let whole = wav_from_audio(&sound(), WavEncoding::Float32).unwrap();
    let changed = |at: usize, byte: u8| {
        let mut bytes = whole.clone();
        bytes[at] = byte;
        bytes
    };
    let mut not_a_number = whole.clone();
    not_a_number[48..52].copy_from_slice(&f32::NAN.to_le_bytes());
    for (bytes, wanted) in [
        (whole[..50].to_vec(), "byte 36: chunk \"data\" of 24 bytes has 6"),
        (whole[..30].to_vec(), "byte 12: chunk \"fmt \" of 16 bytes has 10"),
        (whole[..36].to_vec(), "ends at byte 36 without a chunk \"data\""),
        (changed(0, b'X'), "the file does not start with RIFF"),
        (changed(22, 0), "byte 12: 0 channels"),
        (changed(40, 20), "byte 44: 20 bytes are not a multiple of 8"),
        (changed(20, 85), "byte 12: format 85"),
        (not_a_number, "byte 48: sample 1 is not a finite number"),
    ] {
        let error = audio_from_wav(&bytes).unwrap_err();
        assert!(error.to_string().starts_with(wanted), "{error}");
    }
}

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(
        cut in 0usize..70, changes in prop::collection::vec((0usize..68, any::<u8>()), 0..6)
    ) {
        let mut bytes = wav_from_audio(&sound(), WavEncoding::Float32).unwrap();
        for (at, byte) in changes {
            bytes[at] = byte;
        }
        bytes.truncate(cut);
        audio_from_wav(&bytes).ok();
    }
}
