//! Appearance embeddings of boxes.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_perception_common::embedding_network::EmbeddingNetwork;

/// A re-identification network: crops of persons to embeddings, compared by their cosine.
pub(super) struct Appearance(pub EmbeddingNetwork);

impl Appearance {
    /// Returns the length of an embedding.
    pub fn length(&self) -> usize {
        self.0.length()
    }

    /// Appends the embedding of a box, scaled to length 1, to `embeddings`; zeros for a box outside the image.
    pub fn embed(&self, image: &Image, corners: [f64; 4], embeddings: &mut Vec<f32>) -> Result<()> {
        let begin = embeddings.len();
        let limit = |edge: f64, side: usize| edge.round().clamp(0.0, side as f64) as usize;
        let [x0, x1] = [corners[0], corners[2]].map(|edge| limit(edge, image.width()));
        let [y0, y1] = [corners[1], corners[3]].map(|edge| limit(edge, image.height()));
        if let Some(crop) = image.view().crop(x0, y0, x1 - x0, y1 - y0).filter(|_| x1 > x0 && y1 > y0) {
            self.0.embed(crop, embeddings)?;
        }
        embeddings.resize(begin + self.length(), 0.0);
        Ok(())
    }
}
