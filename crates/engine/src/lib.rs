//! What every OpenDR algorithm speaks: data, targets, learners, parameters, model containers, errors.

// Derived code names this crate as `opendr_engine`, here too.
extern crate self as opendr_engine;

mod assembly_line;
mod cache;
mod device;
mod error;
mod header;
mod json_stream;
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
pub mod data;
pub mod dataset;
pub mod environment;
pub mod learner;
pub mod model;
pub mod overlap;
pub mod params;
pub mod rig;
pub mod target;

pub use assembly_line::assembly_line;
pub use cache::cache_dir;
pub use device::Device;
pub use error::{Error, ErrorKind, Result, ResultExt};
pub use header::Header;
pub use json_stream::{JsonPiece, JsonStream};
pub use model::Model;
pub use parallel::map_in_order;
pub use pool::{Pool, Pooled};
pub use progress::{Progress, Silent, Unit};
pub use random::Random;
pub use statistics::Statistics;
pub use task::Task;
pub use value::{Datum, Value, ValueRef, ValueType};
