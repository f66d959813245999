//! Logs, checkpoints and figures of runs, written so that they survive a crash.
//!
//! [`RunLog`] writes TensorBoard event files, a CSV table and an image of the curves. [`Checkpoints`] keeps the newest states of a
//! training and finds the newest intact one. [`svg_from_figure`] draws the figures of metrics and studies, [`write_atomically`]
//! writes a file. After a kill at any time, files are complete or absent, or are truncated to their last complete record.
//!
//! Figures are defined in `opendr-metrics`; the trainings that write logs are in `opendr-training`, `opendr-rl` and `opendr-tuning`.
//!
//! Begin with [`RunLog`] and [`Checkpoints`]:
//!
//! ```
//! let folder = std::env::temp_dir().join(format!("opendr-runlog-{}", std::process::id()));
//! let mut log = opendr_runlog::RunLog::open(Some(&folder), None)?;
//! let checkpoints = opendr_runlog::Checkpoints::new(&folder.join("checkpoints"), 2)?;
//! for step in 1..=3 {
//!     log.scalar("loss", step, 1.0 / step as f64)?;
//!     log.flush()?;
//!     checkpoints.save(step, &[("weights.bin", &step.to_le_bytes())])?;
//! }
//! assert_eq!(checkpoints.latest()?.map(|checkpoint| checkpoint.step), Some(3));
//! # std::fs::remove_dir_all(folder)?;
//! # Ok::<_, opendr_engine::Error>(())
//! ```

mod atomic_file;
mod checkpoint;
mod checkpoints;
mod crc32c;
mod csv;
mod curves;
mod earlier_run;
mod event;
mod event_file;
mod figure;
mod file_names;
mod run_log;
mod scalar_table;

pub use atomic_file::write_atomically;
pub use checkpoint::Checkpoint;
pub use checkpoints::Checkpoints;
pub use figure::svg_from_figure;
pub use run_log::RunLog;
pub use scalar_table::{has_scalars, read_scalars};
