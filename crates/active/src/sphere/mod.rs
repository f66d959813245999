//! The worlds of [`opendr_simulation::sphere_view`] with recognisers in the loop.

mod embedding;
mod embedding_fit;
mod pool;
mod scene;
mod views;

pub use embedding::Embedding;
pub use embedding_fit::{EmbeddingConfig, EmbeddingFit, fit_embedding};
pub use pool::SubjectPool;
pub use scene::SphereScene;
pub use views::ViewSet;
