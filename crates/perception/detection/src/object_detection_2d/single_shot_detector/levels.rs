//! The feature maps of a network and the anchors on them.

use opendr_engine::{Error, Result};
use opendr_inference::TensorView;
use opendr_perception_common::suppression::Candidate;

use super::anchors::{AnchorLevel, Anchors};
use super::decode::LevelMaps;

/// The names of the outputs of a level: logits of the scores, `[1, kinds * classes, rows, columns]`, and offsets,
/// `[1, kinds * 4, rows, columns]`.
pub(crate) fn output_names(level: usize) -> [String; 2] {
    [format!("scores_{level}"), format!("offsets_{level}")]
}

/// All levels of a network.
pub(crate) struct Levels(Vec<Level>);

/// The anchors of one feature map, and where its outputs stand.
struct Level {
    anchors: AnchorLevel,
    columns: usize,
    rows: usize,
    scores: usize,
    offsets: usize,
}

impl Levels {
    /// The levels of a network for pictures of `size` pixels; `output` says where an output stands.
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
    /// `Format` when an output is not what its anchors and `classes` ask for.
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
                    "an output of the model is {shape:?}, but its anchors and classes ask for \
                     {:?}; train or get it anew",
                    [1, maps, rows, columns]
                )));
            }
            outputs[output].values::<f32>()
        };
        let (scores, offsets) = (values(self.scores, kinds * classes)?, values(self.offsets, kinds * 4)?);
        Ok(LevelMaps { columns, rows, scores, offsets })
    }
}
