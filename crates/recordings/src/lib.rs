//! Recordings of robots as what learners take and answer.
//!
//! `opendr-bags` reads and writes bytes, and knows no message; here they become values. [`Recording`] tells the topics of a
//! recording and which of them stand for a type, [`Sets`] reads what belongs together in order of time, [`Answers`] writes
//! values as messages, [`Conversion`] copies recordings between formats, ROS 1 and ROS 2.
//!
//! ```
//! use opendr_engine::data::Timeseries;
//! use opendr_engine::{ValueRef, ValueType};
//! use opendr_recordings::{Answers, BagFormat, PortTopic, Recording, Sets};
//!
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("beats.bag");
//! let mut answers = Answers::create(&path, BagFormat::Bag1)?;
//! let series = Timeseries::new(vec![0.5; 140], [140, 1])?;
//! answers.write("/beats", ValueRef::Timeseries(&series), 1_000)?;
//! answers.finish()?;
//!
//! let recording = Recording::open(&path)?;
//! let topic = recording.topic_for(ValueType::Timeseries, None)?;
//! let port = PortTopic::new(topic.name, ValueType::Timeseries);
//! let sets: Vec<_> = Sets::open(&recording, vec![port])?.collect::<Result<_, _>>()?;
//! assert_eq!((sets.len(), sets[0].log_time_ns), (1, 1_000));
//! # Ok::<_, opendr_engine::Error>(())
//! ```

mod answers;
mod channels;
mod conversion;
mod recording;
mod sets;
mod stamp;
mod topic;

pub use answers::Answers;
pub use conversion::Conversion;
pub use opendr_bags::*;
pub use recording::{Recording, is_recording};
pub use sets::{Need, PortTopic, Set, Sets};
pub use stamp::{stamp_of, value_of};
pub use topic::Topic;
