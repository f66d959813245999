//! A loaded network that classifies clips of skeletons.

use opendr_engine::data::SkeletonSequence;
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Pool, Result};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::frame_features::{ClipScratch, FrameFeatures};

use super::GraphType;
use super::model_checks::{check_classes, joints_of};
use super::persons::{add_to, mean_category};
use super::sizes::{Architecture, NetworkSizes};

/// Parameters common to the learners that classify clips of skeletons. The sizes apply to the network that is trained; a loaded
/// model has its own.
#[derive(Debug, Clone, Params)]
pub struct SkeletonClipParams {
    /// Number of classes. None: the number of classes in the data set.
    #[param(range = 2..=10_000)]
    pub num_class: Option<usize>,
    /// Number of joints. None: that of the graph.
    #[param(range = 2..=1000)]
    pub num_point: Option<usize>,
    /// Maximum number of persons, the first ones of a recording; the prediction is the mean over those present.
    #[param(default = 2, range = 1..=64)]
    pub num_person: usize,
    /// Number of coordinates of a joint: 2 (a third channel of the input holds scores) or 3.
    #[param(default = 3, range = 2..=3)]
    pub in_channels: usize,
    /// Skeleton: joints and bones.
    pub graph_type: GraphType,
    /// Number of frames of a clip: the last ones of a longer recording; a shorter one is preceded by its repeated first frame.
    #[param(default = 300, range = 1..=10_000)]
    pub num_frames: usize,
    /// Kernel size in time of each block; odd.
    #[param(default = 9, range = 3..=101)]
    pub temporal_kernel: usize,
}

impl SkeletonClipParams {
    /// Returns the sizes of a network.
    ///
    /// # Errors
    /// `InvalidParam` when `num_point` contradicts the graph.
    pub(super) fn sizes(&self, architecture: Architecture, channels: Vec<usize>) -> Result<NetworkSizes> {
        joints_of(self.graph_type, self.num_point)?;
        Ok(NetworkSizes {
            architecture,
            graph: self.graph_type,
            coordinates: self.in_channels,
            frames: self.num_frames,
            channels,
            kernel: self.temporal_kernel,
        })
    }
}

/// File of the network in every container: `clip` `[1, features, frames, joints]` to `logits` `[1, classes]`.
const FILE: &str = "model.onnx";

/// A loaded network that classifies clips of skeletons.
pub(super) struct ClipNetwork {
    classes: Classes,
    features: FrameFeatures,
    /// Shape of the network's input.
    shape: [usize; 4],
    session: Session,
    work: Pool<Work>,
}

#[derive(Default)]
struct Work {
    clip: ClipScratch,
    sum: Vec<f32>,
}

impl ClipNetwork {
    /// Loads the network of a container, which must have the given sizes and number of classes.
    ///
    /// # Errors
    /// `Format` when the network is no classifier of clips, `InvalidParam` when it has other sizes.
    pub fn load(
        model: &Model,
        sizes: &NetworkSizes,
        num_class: Option<usize>,
        device: Device,
    ) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([input], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} does not have exactly one input and one output")));
        };
        let shape = [1, sizes.features(), sizes.frames, sizes.graph.joints()];
        let &[_, Some(classes)] = &output.dims[..] else {
            return Err(Error::format(format!("{FILE} returns {output}; expected scores [1, classes]")));
        };
        if input.dims != shape.map(Some) {
            return Err(Error::invalid_param(format!(
                "{FILE} takes {input}, but in_channels, num_frames and graph_type specify {shape:?}; omit these parameters"
            )));
        }
        check_classes("num_class", num_class, classes)?;
        Ok(Self {
            features: FrameFeatures::new(sizes.graph.parents(), sizes.coordinates),
            classes: model.manifest().classes.clone(),
            work: Pool::default(),
            shape,
            session,
        })
    }

    /// Returns the classes of the network.
    pub fn classes(&self) -> Classes {
        self.classes.clone()
    }

    /// Writes the category of the first `persons` persons of a recording into `category`.
    ///
    /// # Errors
    /// `InvalidInput` when the recording has another skeleton or no person.
    pub fn infer_into(
        &self,
        persons: usize,
        sequence: &SkeletonSequence,
        category: &mut Category,
    ) -> Result<()> {
        self.features.check(sequence)?;
        let Work { clip, sum } = &mut *self.work.take();
        sum.clear();
        let mut present = 0;
        for person in 0..sequence.shape()[4].min(persons) {
            if !self.features.clip_into(sequence, person, self.shape[2], clip) {
                continue;
            }
            present += 1;
            self.session.run(&[TensorView::new(&self.shape, &clip.clip[..])?], |outputs| {
                add_to(sum, outputs.first().map_or(Ok(&[][..]), TensorView::values)?);
                Ok(())
            })?;
        }
        mean_category(category, sum, present, &self.classes)
    }
}
