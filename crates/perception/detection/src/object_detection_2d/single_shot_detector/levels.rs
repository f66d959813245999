//! The feature maps of a network and their anchors.

use opendr_engine::{Error, Result};
use opendr_inference::TensorView;
use opendr_perception_common::suppression::Candidate;

use super::anchors::{AnchorLevel, Anchors};
use super::decode::LevelMaps;

/// Returns the names of the outputs of a level: logits of the scores, `[1, kinds * classes, rows, columns]`, and offsets,
/// `[1, kinds * 4, rows, columns]`.
pub(crate) fn output_names(level: usize) -> [String; 2] {
    [format!("scores_{level}"), format!("offsets_{level}")]
}

/// All levels of a network.
pub(crate) struct Levels(Vec<Level>);

/// The anchors of one feature map, and the indices of its outputs.
struct Level {
    anchors: AnchorLevel,
    columns: usize,
    rows: usize,
    scores: usize,
    offsets: usize,
}

impl Levels {
    /// Creates the levels of a network with an input of `size` pixels; `output` returns the index of an output.
    ///
    /// # Errors
    /// As `output`.
    pub fn open(anchors: Anchors, size: [usize; 2], output: impl Fn(&str) -> Result<usize>) -> Result<Self> {
        let level = |(number, anchors): (usize, AnchorLevel)| -> Result<Level> {
            let [columns, rows] = size.map(|size| anchors.cells(size));
            let [scores, offsets] = output_names(number);
            let (scores, offsets) = (output(&scores)?, output(&offsets)?);
            Ok(Level { anchors, columns, rows, scores, offsets })
        };
        anchors.levels.into_iter().enumerate().map(level).collect::<Result<_>>().map(Self)
    }

    /// Adds the boxes whose score reaches `threshold` to `candidates`, in pixels of the network's input.
    ///
    /// # Errors
    /// `Format` when the shape of an output does not fit its anchors and `classes`.
    pub fn decode(
        &self,
        outputs: &[TensorView<'_>],
        classes: usize,
        threshold: f32,
        candidates: &mut Vec<Candidate>,
    ) -> Result<()> {
        for level in &self.0 {
            level.maps(outputs, classes)?.decode(&level.anchors, classes, threshold, candidates);
        }
        Ok(())
    }
}

impl Level {
    fn maps<'a>(&self, outputs: &[TensorView<'a>], classes: usize) -> Result<LevelMaps<'a>> {
        let Self { columns, rows, .. } = *self;
        let kinds = self.anchors.sides.len();
        let values = |output: usize, maps: usize| {
            let shape = outputs[output].shape();
            if *shape != [1, maps, rows, columns] {
                return Err(Error::format(format!(
                    "an output of the model has the shape {shape:?}, but its anchors and classes need \
                     {:?}; train or download it again",
                    [1, maps, rows, columns]
                )));
            }
            outputs[output].values::<f32>()
        };
        let (scores, offsets) = (values(self.scores, kinds * classes)?, values(self.offsets, kinds * 4)?);
        Ok(LevelMaps { columns, rows, scores, offsets })
    }
}
