//! ROS message definitions: read once, and made into everything that is derived from them: Rust structs, ROS 1's md5
//! sums, ROS 2's RIHS01 hashes, the texts that recordings carry.

mod definition;
mod library;
mod md5sum;
mod parse;
mod rihs01;
mod rust;
mod text;

pub use definition::{Array, BaseType, Constant, Definition, Field, FieldType, Primitive, Service, TypeName};
pub use library::Library;
pub use md5sum::{md5sum, service_md5sum};
pub use rihs01::{rihs01, service_rihs01};
pub use rust::{Ros1Names, rust_files};
pub use text::definition_text;
