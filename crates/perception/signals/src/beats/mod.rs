//! Where the heart beats in a signal: one sample for each beat, found while the signal comes in.
//!
//! Pan and Tompkins, A Real-Time QRS Detection Algorithm, IEEE Transactions on Biomedical Engineering, 1985: what lies
//! between 5 and 15 Hz, its slope squared and summed over 150 ms; peaks of that above a threshold that follows the heights of
//! beats and of noise, and a lower one where a beat is missing.
//!
//! A beat is told at the latest when the next peak after it was seen, mostly 200 ms after it; the first two seconds
//! are learnt from and answered together.
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
