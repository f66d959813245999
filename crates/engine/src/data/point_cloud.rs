//! Point clouds.

use std::fmt;
use std::sync::Arc;

use crate::data::{Array, Data, write_shape};
use crate::{Error, Header, Result};

/// Points `[points, channels]`: x, y, z in metres, then reflectance and colours if present.
///
/// An empty cloud is valid: a lidar may receive no returns.
#[derive(Debug, Clone, PartialEq)]
pub struct PointCloud {
    /// Time stamp and coordinate frame.
    pub header: Header,
    array: Array<2>,
}

impl PointCloud {
    /// Creates a cloud over `data`, point by point.
    ///
    /// # Errors
    /// Returns `InvalidInput` if a point has fewer than 3 channels, or the length of `data` is not the product of `shape`.
    pub fn new(data: impl Into<Arc<Vec<f32>>>, shape: [usize; 2]) -> Result<Self> {
        if shape[1] < 3 {
            return Err(Error::invalid_input(format!(
                "points of {} channels have no position; give x, y and z first",
                shape[1]
            )));
        }
        Ok(Self { header: Header::default(), array: Array::new(data, shape)? })
    }

    /// Sets the header.
    #[must_use]
    pub fn with_header(mut self, header: Header) -> Self {
        self.header = header;
        self
    }

    /// Returns the array.
    pub fn array(&self) -> &Array<2> {
        &self.array
    }

    /// Returns the number of points.
    pub fn len(&self) -> usize {
        self.array.shape()[0]
    }

    /// Returns whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the number of channels per point.
    pub fn channels(&self) -> usize {
        self.array.shape()[1]
    }

    /// Returns `[points, channels]`.
    pub fn shape(&self) -> [usize; 2] {
        self.array.shape()
    }

    /// Returns the numbers, point by point.
    pub fn as_slice(&self) -> &[f32] {
        self.array.as_slice()
    }

    /// Returns each point with all its channels.
    pub fn points(&self) -> impl ExactSizeIterator<Item = &[f32]> {
        self.as_slice().chunks_exact(self.channels())
    }

    /// Returns the array without the header.
    pub fn into_array(self) -> Array<2> {
        self.array
    }
}

impl Data for PointCloud {}

/// Writes OpenDR's text; with `{:#}`, type and shape.
impl fmt::Display for PointCloud {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            return write_shape("PointCloud", &self.shape(), f);
        }
        write!(f, "Points: {}", self.array)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_one_by_one() {
        let cloud = PointCloud::new(vec![1.0, 2.0, 3.0, 0.5, 4.0, 5.0, 6.0, 0.25], [2, 4]).unwrap();
        assert_eq!(cloud.points().map(|point| point[3]).collect::<Vec<_>>(), [0.5, 0.25]);
        assert_eq!(cloud.to_string(), "Points: [[1.   2.   3.   0.5 ]\n [4.   5.   6.   0.25]]");
        assert!(PointCloud::new(vec![], [0, 4]).unwrap().points().next().is_none());
        assert!(PointCloud::new(vec![1.0, 2.0], [1, 2]).is_err());
        assert!(PointCloud::new(vec![1.0; 5], [1, 4]).is_err());
    }
}
