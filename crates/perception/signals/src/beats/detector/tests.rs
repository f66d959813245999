use opendr_datasets::open_wfdb_record;
use opendr_engine::Random;
use opendr_perception_testing::test_models::test_data;

use super::*;

/// Returns an ECG with a beat every 0.8 s, T waves, baseline wander and noise, and its beats.
fn heart(seconds: usize, noise: f64) -> (Vec<f32>, Vec<u64>) {
    let mut random = Random::new(3);
    let beats: Vec<u64> =
        (0..).map(|beat| 100 + beat * 288).take_while(|at| *at < seconds as u64 * 360).collect();
    let wave = |at: f64, middle: f64, width: f64| (-((at - middle) / width).powi(2)).exp();
    let sample = |at: usize| {
        let at = at as f64;
        let parts = beats.iter().map(|beat| *beat as f64).filter(|beat| (at - beat).abs() < 300.0);
        let parts = parts.map(|beat| wave(at, beat, 6.0) + 0.25 * wave(at, beat + 100.0, 25.0));
        parts.sum::<f64>() + 0.5 * (at / 700.0).sin()
    };
    let signal = (0..seconds * 360).map(|at| (sample(at) + noise * random.normal()) as f32).collect();
    (signal, beats)
}

fn found(signal: &[f32], size: usize) -> Vec<u64> {
    let (detector, mut state, mut beats) =
        (BeatDetector::new(360.0).unwrap(), BeatSignal::default(), Vec::new());
    for piece in signal.chunks(size) {
        detector.push(&mut state, piece, |at| beats.push(at));
    }
    detector.flush(&mut state, |at| beats.push(at));
    beats
}

#[test]
fn every_beat_is_detected_at_its_sample() {
    for noise in [0.0, 0.03] {
        let (signal, beats) = heart(60, noise);
        let found = found(&signal, signal.len());
        assert_eq!(found.len(), beats.len(), "{noise}");
        assert!(found.iter().zip(&beats).all(|(found, beat)| found.abs_diff(*beat) <= 4), "{found:?}");
    }
}

#[test]
fn pieces_units_and_gaps_change_nothing() {
    let (signal, _) = heart(20, 0.02);
    let whole = found(&signal, signal.len());
    for size in [1, 7, 360, 5000] {
        assert_eq!(found(&signal, size), whole);
    }
    let millivolts: Vec<f32> = signal.iter().map(|sample| 1000.0 * sample + 5000.0).collect();
    assert_eq!(found(&millivolts, 100), whole);
    let mut broken = signal.clone();
    (400..420).for_each(|at| broken[at] = f32::NAN);
    assert_eq!(found(&broken, 100).len(), whole.len());
}

#[test]
fn a_flat_signal_has_no_beats_and_bounded_memory() {
    let (detector, mut state) = (BeatDetector::new(360.0).unwrap(), BeatSignal::default());
    for _ in 0..600 {
        detector.push(&mut state, &[0.0; 2160], |_| panic!("a beat"));
    }
    assert!(state.samples.capacity() < 1000 && state.slopes.capacity() < 1000);
    assert!([0.0, f64::NAN, 1e9].iter().all(|rate| BeatDetector::new(*rate).is_err()));
}

#[test]
fn beats_are_detected_after_the_signal_weakens() {
    let (signal, beats) = heart(60, 0.002);
    let weak: Vec<f32> =
        signal.iter().zip(0..).map(|(sample, at)| if at < 7200 { 20.0 * sample } else { *sample }).collect();
    let late = found(&weak, 500).iter().filter(|at| **at > 7200 + 10 * 360).count();
    let expected = beats.iter().filter(|at| **at > 7200 + 10 * 360).count();
    assert!(late.abs_diff(expected) <= 1, "{late} of {expected}");
}

/// Record 100 of the MIT-BIH arrhythmia database, compared with the annotations of its cardiologists within 150 ms, as in AAMI
/// EC57.
#[test]
fn the_beats_of_record_100() {
    let Some(path) = test_data("data/ecg/wfdb/100") else { return };
    let record = open_wfdb_record(path).unwrap();
    let [length, features] = record.signals.shape();
    let lead: Vec<f32> = record.signals.as_slice().iter().copied().step_by(features).collect();
    assert_eq!(lead.len(), length);
    let is_beat = |symbol: Option<char>| symbol.is_some_and(|symbol| "NLRBAaJSVrFejnE/fQ?".contains(symbol));
    let labelled = record.annotations.iter().filter(|annotation| is_beat(annotation.symbol()));
    let labelled: Vec<u64> = labelled.map(|annotation| annotation.sample as u64).collect();
    let found = found(&lead, 777);
    let near = |at: u64, others: &[u64]| others.iter().any(|other| other.abs_diff(at) <= 54);
    let hits = labelled.iter().filter(|at| near(**at, &found)).count();
    let right = found.iter().filter(|at| near(**at, &labelled)).count();
    let (sensitivity, precision) = (hits as f64 / labelled.len() as f64, right as f64 / found.len() as f64);
    println!(
        "{} labelled, {} detected: sensitivity {sensitivity:.4}, precision {precision:.4}",
        labelled.len(),
        found.len()
    );
    assert!(labelled.len() > 2000 && sensitivity > 0.995 && precision > 0.995);
}
