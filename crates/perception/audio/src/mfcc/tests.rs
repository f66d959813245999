use opendr_engine::ErrorKind;

use super::*;

/// A tone with falling and rising pitch and increasing volume.
fn tone(samples: usize) -> Vec<f32> {
    let sample = |at: usize| {
        let time = at as f64 / 16_000.0;
        (0.8 * time * (2.0 * std::f64::consts::PI * (300.0 * time + 900.0 * time * time)).sin()) as f32
    };
    (0..samples).map(sample).collect()
}

fn cepstra(options: MfccOptions, samples: &[f32]) -> (usize, Vec<f32>) {
    let mut cepstra = Vec::new();
    let frames = Mfcc::new(options).unwrap().run_into(samples, &mut cepstra);
    (frames, cepstra)
}

#[test]
fn frame_counts_follow_the_options() {
    let frames = |options: MfccOptions, samples| Mfcc::new(options).unwrap().frames(samples);
    let counts = [0, 479, 480, 799, 800, 16_000].map(|samples| frames(MfccOptions::keywords(), samples));
    assert_eq!(counts, [0, 0, 1, 1, 2, 49]);
    let librosa = MfccOptions::librosa(16_000, 640, 480, 64);
    assert_eq!([0, 1, 480, 16_000].map(|samples| frames(librosa.clone(), samples)), [0, 1, 2, 34]);
    for samples in [1, 3, 320, 641] {
        let (count, values) = cepstra(librosa.clone(), &tone(samples));
        assert!(values.len() == count * 64 && values.iter().all(|value| value.is_finite()));
    }
}

#[test]
fn pieces_yield_the_cepstra_of_the_whole() {
    let long_hop = MfccOptions { hop: 700, ..MfccOptions::keywords() };
    for options in [MfccOptions::keywords(), long_hop] {
        let samples = tone(9_000);
        let (frames, whole) = cepstra(options.clone(), &samples);
        let mfcc = Mfcc::new(options).unwrap();
        let mut stream = MfccStream::default();
        for size in [1, 77, 480, 2000, 9_000] {
            let mut pieces = Vec::new();
            for piece in samples.chunks(size) {
                mfcc.push(&mut stream, piece, |frame| pieces.extend_from_slice(frame)).unwrap();
            }
            assert!(frames > 10 && pieces == whole, "pieces of {size}");
            stream.reset();
        }
    }
}

#[test]
fn options_that_need_the_whole_recording_refuse_pieces() {
    let mfcc = Mfcc::new(MfccOptions::librosa(16_000, 640, 480, 64)).unwrap();
    let refused = mfcc.push(&mut MfccStream::default(), &[0.0; 9], |_| {});
    assert_eq!(refused.unwrap_err().kind(), ErrorKind::Unsupported);
}

#[test]
fn silence_is_finite_and_loudness_moves_the_first_coefficient_only() {
    let (_, silence) = cepstra(MfccOptions::keywords(), &[0.0; 16_000]);
    let floor = (80f64.sqrt() * 1e-6f64.ln()) as f32;
    assert!((silence[0] - floor).abs() < 1e-3 && silence[1..10].iter().all(|value| value.abs() < 1e-4));
    let options = MfccOptions::librosa(16_000, 400, 160, 13);
    let ((_, soft), (_, loud)) = (
        cepstra(options.clone(), &tone(4000)),
        cepstra(options, &tone(4000).map_each(|sample| 10.0 * sample)),
    );
    // 20 dB in each of 128 orthonormal bands.
    let step = 20.0 * 128f32.sqrt();
    for (soft, loud) in soft.chunks(13).zip(loud.chunks(13)) {
        assert!((loud[0] - soft[0] - step).abs() < 0.05, "{} {}", loud[0], soft[0]);
        assert!(soft[1..].iter().zip(&loud[1..]).all(|(soft, loud)| (soft - loud).abs() < 0.05));
    }
}

trait MapEach {
    fn map_each(self, change: impl Fn(f32) -> f32) -> Self;
}

impl MapEach for Vec<f32> {
    fn map_each(self, change: impl Fn(f32) -> f32) -> Self {
        self.into_iter().map(change).collect()
    }
}

#[test]
fn the_peak_is_normalised_to_one() {
    let loud: Vec<f32> = (0..16_000).map(|at| 0.25 * (at as f32 * 0.05).sin()).collect();
    let factor = peak_factor(&loud);
    assert!((factor - 4.0).abs() < 1e-3, "{factor}");
    let whole: Vec<f32> = loud.iter().map(|sample| sample * factor).collect();
    for options in [MfccOptions::keywords(), MfccOptions::librosa(16_000, 640, 480, 64)] {
        let mfcc = Mfcc::new(options).unwrap();
        let (mut scaled, mut expected) = (Vec::new(), Vec::new());
        mfcc.run_scaled_into(&loud, factor, &mut scaled);
        mfcc.run_into(&whole, &mut expected);
        assert!(scaled.iter().zip(&expected).all(|(one, other)| (one - other).abs() < 2e-3));
    }
}

#[test]
fn cepstra_of_near_silence_are_finite() {
    assert_eq!(peak_factor(&[0.0, -1.0]), 1.0);
    let mut cepstra = Vec::new();
    for level in [0.0, f32::from_bits(1), f32::MIN_POSITIVE] {
        let sound = vec![level; 16_000];
        Mfcc::new(MfccOptions::keywords()).unwrap().run_scaled_into(
            &sound,
            peak_factor(&sound),
            &mut cepstra,
        );
        assert!(cepstra.iter().all(|number| number.is_finite()), "{level}");
    }
}

#[test]
fn invalid_options_are_refused() {
    let good = MfccOptions::keywords();
    let bands = |low_hz, high_hz| MelBands { low_hz, high_hz, ..good.bands };
    for wrong in [
        MfccOptions { hop: 0, ..good.clone() },
        MfccOptions { window: 1 << 40, ..good.clone() },
        MfccOptions { fft: 400, ..good.clone() },
        MfccOptions { fft: 513, ..good.clone() },
        MfccOptions { coefficients: 41, ..good.clone() },
        MfccOptions { sample_rate: 0, ..good.clone() },
        MfccOptions { bands: bands(20.0, 9000.0), ..good.clone() },
        MfccOptions { bands: bands(f64::NAN, 4000.0), ..good.clone() },
    ] {
        assert_eq!(Mfcc::new(wrong).err().unwrap().kind(), ErrorKind::InvalidParam);
    }
}
