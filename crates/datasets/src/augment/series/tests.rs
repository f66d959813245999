use opendr_engine::data::Timeseries;
use opendr_engine::dataset::Sample;
use opendr_engine::{ErrorKind, Random, Value};

use super::*;
use crate::augment::{Augment, OtherSamples};

fn changed(augment: &dyn Augment, numbers: Vec<f32>, shape: [usize; 2], seed: u64) -> Vec<f32> {
    let series = Timeseries::new(numbers, shape).unwrap();
    let mut sample = Sample { data: vec![series.into()], target: None };
    augment.apply(&mut sample, &mut Random::new(seed), &OtherSamples::none()).unwrap();
    let Value::Timeseries(series) = &sample.data[0] else { panic!() };
    assert_eq!(series.shape(), shape);
    series.as_slice().to_vec()
}

#[test]
fn jitter_is_proportional_to_the_deviation() {
    // The first feature varies a hundred times as much as the second; the third does not.
    let numbers = (0..3000).flat_map(|time| {
        let wave = (time as f32 * 0.1).sin();
        [100.0 * wave, wave, 5.0]
    });
    let numbers: Vec<f32> = numbers.collect();
    let after = changed(&SeriesJitter { deviation: 0.1 }, numbers.clone(), [3000, 3], 1);
    let deviation = |feature: usize| {
        let away =
            after.iter().zip(&numbers).skip(feature).step_by(3).map(|(now, then)| (now - then).powi(2));
        (away.sum::<f32>() / 3000.0).sqrt()
    };
    let wave = 0.1 * 0.5f32.sqrt();
    assert!((deviation(0) / (100.0 * wave) - 1.0).abs() < 0.1 && (deviation(1) / wave - 1.0).abs() < 0.1);
    assert_eq!(deviation(2), 0.0);
}

#[test]
fn features_are_scaled_as_a_whole() {
    let numbers: Vec<f32> = (1..=40).map(|number| number as f32).collect();
    let after = changed(&SeriesScale { deviation: 0.3 }, numbers.clone(), [20, 2], 4);
    for feature in 0..2 {
        let factors: Vec<f32> =
            after.iter().zip(&numbers).skip(feature).step_by(2).map(|(now, then)| now / then).collect();
        assert!(factors.iter().all(|factor| (factor - factors[0]).abs() < 1e-5) && factors[0] != 1.0);
    }
}

#[test]
fn masks_are_whole_spans_and_bands() {
    let augment =
        SpecAugment { time_masks: 1, max_time: 10, frequency_masks: 1, level: -9.0, ..Default::default() };
    let mut covered = 0;
    for seed in 0..50 {
        let after = changed(&augment, vec![1.0; 100 * 30], [100, 30], seed);
        let rows: Vec<bool> = after.chunks(30).map(|row| row.iter().all(|number| *number == -9.0)).collect();
        let bands: Vec<bool> = (0..30).map(|band| after.chunks(30).all(|row| row[band] == -9.0)).collect();
        let count = |marks: &[bool]| marks.iter().filter(|mark| **mark).count();
        let runs = |marks: &[bool]| marks.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert!(count(&rows) <= 10 && count(&bands) <= 15 && runs(&rows) <= 2 && runs(&bands) <= 2);
        for (at, number) in after.iter().enumerate() {
            assert_eq!(*number == -9.0, rows[at / 30] || bands[at % 30]);
        }
        covered += count(&rows) + count(&bands);
    }
    assert!(covered > 200, "{covered}");
    let mut sample = Sample { data: vec![], target: None };
    let refused = augment.apply(&mut sample, &mut Random::new(0), &OtherSamples::none());
    assert_eq!(refused.unwrap_err().kind(), ErrorKind::InvalidInput);
}
