//! Generator of Rust structs and hashes from ROS message definitions.
//!
//! [`Library`] reads folders of `.msg` and `.srv` files; [`rust_files`] generates the source of `opendr-messages` from them, with
//! ROS 1's md5 sums, ROS 2's RIHS01 hashes and the definitions for recordings. `cargo xtask generate` runs it; no other crate uses it
//! at run time. Begin with [`Definition::parse`]:
//!
//! ```
//! use opendr_message_generator::{Definition, Library, TypeName, md5sum};
//!
//! let definition = Definition::parse(TypeName::new("std_msgs", "Int32"), "int32 data\n")?;
//! assert_eq!(definition.fields[0].name, "data");
//! assert_eq!(md5sum(&Library::default(), &definition)?, "da5909fbe378aeaf85e547e830cc1bb7");
//! # Ok::<_, opendr_engine::Error>(())
//! ```

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
