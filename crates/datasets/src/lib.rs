//! Data set formats, one file each, lazy and readable from several threads; augmentation and the parallel loader.
//!
//! [`open`] recognises a data set; [`formats`] lists what there is. Nothing on disk is trusted: what is broken is told
//! with its file and line or key, through [`Problems`].

mod any;
mod check;
mod contact_sheet;
mod format;
mod problems;
mod registry;
mod stats;

pub use any::{FormatEntry, Recognition};
pub use check::check;
pub use contact_sheet::{contact_sheet, picture_with_target};
pub use format::{Format, OpenOptions, WriteOptions};
pub use problems::{Place, Problem, Problems};
pub use registry::{find, formats, open, recognise};
pub use stats::{ClassCount, DatasetStats, Spread};
