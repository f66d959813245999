use opendr_engine::Result;

use super::checked_size;

/// A table of learned vectors, e.g. of the positions in a sequence.
///
/// Parameters: the vectors, `[count, size]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Embedding {
    count: usize,
    size: usize,
}

impl Embedding {
    /// Creates a table of `count` vectors of `size` numbers.
    ///
    /// # Errors
    /// When a size is zero or their product is too large.
    pub fn new(count: usize, size: usize) -> Result<Self> {
        checked_size("an embedding", &[count, size])?;
        Ok(Self { count, size })
    }

    /// Returns the number of vectors.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the number of values per vector.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Returns the number of parameters.
    pub fn parameters(&self) -> usize {
        self.count * self.size
    }

    /// Adds the vector of each index to the rows of `y`, `[indices, size]`.
    ///
    /// # Panics
    /// When a length does not match, or there is no such vector.
    pub fn add_forward(
        &self,
        parameters: &[f32],
        indices: impl ExactSizeIterator<Item = usize>,
        y: &mut [f32],
    ) {
        self.check(parameters, indices.len(), y);
        for (index, row) in indices.zip(y.chunks_exact_mut(self.size)) {
            let vector = &parameters[index * self.size..][..self.size];
            row.iter_mut().zip(vector).for_each(|(row, vector)| *row += vector);
        }
    }

    /// Adds the gradients of the rows, `dy`, to those of their vectors.
    ///
    /// # Panics
    /// As [`Self::add_forward`].
    pub fn backward(&self, indices: impl ExactSizeIterator<Item = usize>, dy: &[f32], gradients: &mut [f32]) {
        self.check(gradients, indices.len(), dy);
        for (index, row) in indices.zip(dy.chunks_exact(self.size)) {
            let vector = &mut gradients[index * self.size..][..self.size];
            vector.iter_mut().zip(row).for_each(|(vector, row)| *vector += row);
        }
    }

    fn check(&self, parameters: &[f32], rows: usize, y: &[f32]) {
        assert_eq!(
            [parameters.len(), y.len()],
            [self.parameters(), rows * self.size],
            "the lengths are not those of {rows} rows of {self:?}"
        );
    }
}
