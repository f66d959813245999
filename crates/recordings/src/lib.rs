//! Recordings as inputs of learners, and predictions written as recordings.
//!
//! `opendr-bags` reads and writes messages as bytes; this crate converts them to values and back. [`Recording`]
//! lists the topics of a recording and the types of their messages. [`SyncedSets`] reads messages of several topics,
//! synchronised by stamp. [`RecordingWriter`] writes values as messages. [`Conversion`] copies recordings between formats,
//! and between ROS 1 and ROS 2. The conversion of a single message is in `opendr-ros-bridge`.
//!
//! ```
//! use opendr_engine::data::Timeseries;
//! use opendr_engine::{ValueRef, ValueType};
//! use opendr_recordings::{RecordingWriter, BagFormat, PortTopic, Recording, SyncedSets};
//!
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("beats.bag");
//! let mut writer = RecordingWriter::create(&path, BagFormat::Bag1)?;
//! let series = Timeseries::new(vec![0.5; 140], [140, 1])?;
//! writer.write("/beats", ValueRef::Timeseries(&series), 1_000)?;
//! writer.finish()?;
//!
//! let recording = Recording::open(&path)?;
//! let topic = recording.topic_for(ValueType::Timeseries, None)?;
//! let port = PortTopic::new(topic.name, ValueType::Timeseries);
//! let sets: Vec<_> = SyncedSets::open(&recording, vec![port])?.collect::<Result<_, _>>()?;
//! assert_eq!((sets.len(), sets[0].log_time_ns), (1, 1_000));
//! # Ok::<_, opendr_engine::Error>(())
//! ```

mod channels;
mod conversion;
mod recording;
mod recording_writer;
mod sets;
mod stamp;
mod topic;

pub use conversion::Conversion;
pub use opendr_bags::*;
pub use recording::{Recording, is_recording};
pub use recording_writer::RecordingWriter;
pub use sets::{Need, PortTopic, SyncedSet, SyncedSets};
pub use stamp::{stamp_of, value_of};
pub use topic::Topic;
