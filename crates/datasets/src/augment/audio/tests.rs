use opendr_engine::data::Audio;
use opendr_engine::dataset::Sample;
use opendr_engine::{Header, Random, Value};

use super::*;
use crate::augment::{Augment, OtherSamples};

fn changed(augment: &dyn Augment, samples: Vec<f32>, channels: usize, seed: u64) -> Vec<f32> {
    let audio = Audio::new(samples, channels, 1000).unwrap().with_header(Header::new(5, "ear"));
    let mut sample = Sample { data: vec![audio.into()], target: None };
    augment.apply(&mut sample, &mut Random::new(seed), &OtherSamples::none()).unwrap();
    let Value::Audio(audio) = &sample.data[0] else { panic!() };
    assert_eq!((audio.header.stamp_ns, audio.channels(), audio.sample_rate()), (Some(5), channels, 1000));
    audio.as_slice().to_vec()
}

#[test]
fn shifted_sound_keeps_its_length_and_its_channels() {
    let before: Vec<f32> = (1..=100).map(|index| index as f32 / 200.0).collect();
    let mut seen = [false; 2];
    for seed in 0..20 {
        let after = changed(&AudioShift { max_shift: 0.01 }, before.clone(), 2, seed);
        let later = after.iter().take_while(|sample| **sample == 0.0).count();
        let earlier = after.iter().rev().take_while(|sample| **sample == 0.0).count();
        assert!(after.len() == 100 && later.min(earlier) == 0 && later.max(earlier) <= 20);
        assert!(later % 2 == 0 && earlier % 2 == 0);
        assert_eq!(after[later..100 - earlier], before[earlier..100 - later]);
        seen = [seen[0] || later > 0, seen[1] || earlier > 0];
    }
    assert_eq!(seen, [true; 2]);
}

#[test]
fn noise_has_the_requested_ratio() {
    let before: Vec<f32> = (0..50_000).map(|index| 0.3 * (index as f32 * 0.1).sin()).collect();
    for ratio in [0.0, 20.0] {
        let after = changed(&AudioNoise { min_snr: ratio, max_snr: ratio }, before.clone(), 1, 3);
        let power =
            |samples: &mut dyn Iterator<Item = f32>| samples.map(|x| f64::from(x).powi(2)).sum::<f64>();
        let noise = power(&mut after.iter().zip(&before).map(|(now, then)| now - then));
        let got = 10.0 * (power(&mut before.iter().copied()) / noise).log10();
        assert!((got - f64::from(ratio)).abs() < 0.3, "{got}");
    }
    assert_eq!(changed(&AudioNoise::default(), vec![0.0; 10], 1, 3), [0.0; 10]);
}

#[test]
fn gain_is_clipped_at_full_scale() {
    let gain = AudioGain { min_gain: 20.0, max_gain: 20.0 };
    let after = changed(&gain, vec![0.05, -0.01, 0.5, -0.5], 1, 0);
    let wanted = [0.5, -0.1, 1.0, -1.0];
    assert!(after.iter().zip(wanted).all(|(got, wanted)| (got - wanted).abs() < 1e-6), "{after:?}");
}
