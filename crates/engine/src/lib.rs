//! Data, targets, learners, parameters, model containers and errors of OpenDR.
//!
//! Every other crate of the workspace builds on this one:
//!
//! * [`data`] and [`target`]: inputs (images, point clouds, audio) and predictions or annotations (boxes, poses, masks).
//!   [`Value`] holds any of them; [`Datum`] is their common trait.
//! * [`learner`]: the trait [`learner::Learner`], which an algorithm implements, [`learner::Handle`], which a user holds,
//!   and the registry of learners.
//! * [`params`]: tables of parameters with documentation, defaults and ranges.
//! * [`model`]: containers, the form of a model on disk.
//! * [`dataset`] and [`environment`]: the traits of data sets and of reinforcement-learning environments.
//! * [`assignment`] and [`overlap`]: the linear assignment and the overlaps that trackers and metrics share.
//! * [`Error`], [`Progress`], [`Statistics`], [`Random`] and a few helpers for threads and memory.
//!
//! The crate decodes no images (`opendr-vision`), runs no networks (`opendr-inference`), reads no data sets
//! (`opendr-datasets`) and contains no algorithm (`opendr-perception-*`, `opendr-rl`). [`learner::Learner`] is the type
//! to begin with.
//!
//! ```
//! use opendr_engine::target::{BoundingBox, BoundingBoxList};
//! use opendr_engine::{Header, Value, ValueType};
//!
//! let mut boxes = BoundingBoxList::from(vec![BoundingBox::new(3, 1.0, 2.0, 3.5, 4.0, 0.9)]);
//! boxes.header = Header::new(5, "camera");
//! let value = Value::from(boxes);
//! assert_eq!(value.as_value_ref().value_type(), ValueType::BoundingBoxList);
//!
//! let text = serde_json::to_string(&value)?;
//! assert_eq!(serde_json::from_str::<Value>(&text)?, value);
//! # Ok::<_, serde_json::Error>(())
//! ```

// Derived code names this crate as `opendr_engine`, here too.
extern crate self as opendr_engine;

mod cache;
mod device;
mod error;
mod header;
mod json_format;
mod json_stream;
mod map_in_stages;
#[allow(dead_code)]
mod numpy_text;
mod parallel;
mod pool;
mod progress;
mod random;
mod statistics;
mod task;
mod value;

pub mod assignment;
pub mod atomic_file;
pub mod data;
pub mod dataset;
pub mod environment;
pub mod learner;
pub mod model;
pub mod overlap;
pub mod params;
pub mod rig;
pub mod target;

pub use cache::cache_dir;
pub use device::Device;
pub use error::{Error, ErrorKind, Result, ResultExt};
pub use header::Header;
pub use json_format::JsonFormat;
pub use json_stream::{JsonPiece, JsonStream};
pub use map_in_stages::map_in_stages;
pub use model::Model;
pub use parallel::map_in_order;
pub use pool::{Pool, Pooled};
pub use progress::{Progress, Silent, Unit};
pub use random::Random;
pub use statistics::Statistics;
pub use task::Task;
pub use value::{Datum, Value, ValueRef, ValueType};
