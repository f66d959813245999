//! Detection of heart beats in a signal: one sample index per beat, during the recording.
//!
//! Pan and Tompkins, A Real-Time QRS Detection Algorithm, IEEE Transactions on Biomedical Engineering, 1985: the band from 5 to
//! 15 Hz, its slope squared and summed over 150 ms; peaks above a threshold that follows the heights of beats and of noise, and
//! a lower one where a beat is missing.
//!
//! A beat is reported at the latest with the next peak, mostly 200 ms after it; the beats of the first two seconds, in which
//! the threshold is initialised, are reported together.
//!
//! ```
//! use opendr_signals::beats::{BeatDetector, BeatSignal};
//!
//! let detector = BeatDetector::new(360.0)?;
//! let mut signal = BeatSignal::default();
//! let mut beats = Vec::new();
//! let ecg = |at: usize| if at % 300 == 150 { 1.0 } else { 0.0 };
//! let samples: Vec<f32> = (0..3600).map(ecg).collect();
//! detector.push(&mut signal, &samples, |at| beats.push(at));
//! detector.flush(&mut signal, |at| beats.push(at));
//! assert_eq!(beats.len(), 12);
//! assert!(beats.iter().all(|at| at % 300 == 150));
//! # Ok::<(), opendr_engine::Error>(())
//! ```

mod detector;
mod filter;
mod threshold;

pub use detector::{BeatDetector, BeatSignal};
