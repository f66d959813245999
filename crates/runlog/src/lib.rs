//! What a run leaves behind, be it a training, a tuning or a search of parameters: [`RunLog`] writes TensorBoard
//! event files, a CSV table and a picture of the curves; [`Checkpoints`] keeps states to go on from; [`svg_from_figure`]
//! draws.
//!
//! Everything here survives a kill at any moment: files appear whole or not at all, or are cut back to their last whole
//! record.

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
mod run_log;
mod scalar_table;

pub use atomic_file::write_atomically;
pub use checkpoint::Checkpoint;
pub use checkpoints::Checkpoints;
pub use figure::svg_from_figure;
pub use run_log::RunLog;
