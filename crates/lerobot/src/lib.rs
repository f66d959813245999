//! Data sets of LeRobot: episodes of robots as Parquet, JSON and video.
//!
//! [`LeRobotSet::open`] reads the formats v2.1 and v3.0, [`LeRobotWriter`] writes v3.0, which LeRobot's own `LeRobotDataset` loads, and
//! [`convert`] makes the second from the first. A set has features by name, such as `observation.state` and `action`, with one row per
//! frame; frames of cameras are video files, to be opened with `opendr-vision` from the place that [`EpisodeRecord::videos`] states.
//!
//! Files of a data set come from anywhere: damaged ones are errors, and no path leaves the folder.

mod column;
mod convert;
mod info;
mod json_lines;
mod member;
mod metadata;
mod record;
mod set;
mod statistics;
mod table;
mod table_writer;
mod writer;

pub use column::{Column, Values};
pub use convert::convert;
pub use info::{Feature, Info};
pub use record::{EpisodeRecord, VideoSegment};
pub use set::LeRobotSet;
pub use statistics::FeatureStatistics;
#[doc(hidden)]
pub use table::columns_of_bytes;
pub use writer::{LeRobotWriter, SetOptions};
