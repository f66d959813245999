//! Fusion of networks to panoptic segmentation, with the interface of OpenDR's EfficientPS.
//!
//! The network is not that of EfficientPS (R. Mohan, A. Valada, IJCV 2021), whose weights may not be used: the learner fuses
//! the predictions of four small networks; [`fusion`] describes the rules.

mod fusion;

use opendr_detection::object_detection_2d::{CenterNet, CenterNetParams};
use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec, Targets};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Classes, Heatmap, HeatmapValues, Name};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_segmentation::instance_segmentation::{BodyPix, BodyPixParams};
use opendr_segmentation::semantic_segmentation::{Deeplab, DeeplabParams};

use fusion::{Fusion, Predictions, Rules, Thing};

/// Parameters of [`EfficientPs`].
#[derive(Debug, Clone, Params)]
pub struct EfficientPsParams {
    /// Minimum score of an object.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Whether objects of classes without a class map fill their whole boxes; else they are dropped.
    #[param(default = true, live)]
    pub box_masks: bool,
    /// Minimum share of a box that the class map confirms.
    #[param(default = 0.1, range = 0.0..=1.0, live)]
    pub min_overlap: f32,
    /// Minimum share of the image of a region of a thing class outside of all boxes that counts as an object.
    #[param(default = 0.1, range = 0.0..=1.0, live)]
    pub min_leftover: f32,
    /// Minimum share of the image of a stuff region.
    #[param(default = 0.02, range = 0.0..=1.0, live)]
    pub min_stuff: f32,
}

/// Prediction for an image: OpenDR's pair of maps.
#[derive(Default, Targets)]
pub struct EfficientPsTargets {
    /// 1000 times the class plus the index of the object within its class, from 1; 0 for stuff classes. 255000 for void.
    pub instance: Heatmap,
    /// Class of each pixel; 255 for void.
    pub semantic: Heatmap,
}

/// A loaded fusion of networks.
pub struct EfficientPs {
    params: EfficientPsParams,
    classes: Classes,
    detector: CenterNet,
    things: Deeplab,
    stuff: Deeplab,
    persons: BodyPix,
    /// Class of the fusion for each class of the three networks.
    of_detector: Vec<Option<u32>>,
    of_things: Vec<Option<u32>>,
    of_stuff: Vec<Option<u32>>,
    person: Option<u32>,
    work: Pool<Work>,
}

#[derive(Default)]
struct Work {
    boxes: BoundingBoxList,
    found: Vec<Thing>,
    things: Heatmap,
    stuff: Heatmap,
    fusion: Fusion,
}

/// Names of COCO's thing classes in other data sets.
const THINGS: [(&str, &str); 6] = [
    ("aeroplane", "airplane"),
    ("diningtable", "dining table"),
    ("motorbike", "motorcycle"),
    ("pottedplant", "potted plant"),
    ("sofa", "couch"),
    ("tvmonitor", "tv"),
];
/// Cityscapes' names of COCO's stuff classes. Cityscapes' things are detected better by the other networks.
const STUFF: [(&str, &str); 8] = [
    ("road", "road"),
    ("sidewalk", "pavement-merged"),
    ("building", "building-other-merged"),
    ("wall", "wall-other-merged"),
    ("fence", "fence-merged"),
    ("vegetation", "tree-merged"),
    ("terrain", "grass-merged"),
    ("sky", "sky-other-merged"),
];

impl Learner for EfficientPs {
    const SPEC: Spec = Spec::new("efficient_ps", Task::PanopticSegmentation)
        .class("EfficientPsLearner")
        .about("Predicts class and instance of every pixel by fusing DeepLab, CenterNet and BodyPix.")
        .without_effect(&[
            ("config_file", "the learner has no network of its own"),
            ("lr", Spec::TRAINING_ONLY),
            ("iters", Spec::TRAINING_ONLY),
            ("batch_size", Spec::TRAINING_ONLY),
            ("optimizer", Spec::TRAINING_ONLY),
            ("lr_schedule", Spec::TRAINING_ONLY),
            ("momentum", Spec::TRAINING_ONLY),
            ("weight_decay", Spec::TRAINING_ONLY),
            ("optimizer_config", Spec::TRAINING_ONLY),
            ("checkpoint_after_iter", Spec::TRAINING_ONLY),
            ("num_workers", Spec::TRAINING_ONLY),
            ("seed", Spec::TRAINING_ONLY),
        ]);
    type Params = EfficientPsParams;
    type Input<'a> = &'a Image;
    type Target = EfficientPsTargets;
    type State = ();

    fn load(model: &Model, params: EfficientPsParams, device: Device) -> Result<Self> {
        let detector_params = CenterNetParams { threshold: 0.0, ..CenterNetParams::default() };
        let detector = CenterNet::load(&model.part("detector")?, detector_params, device)?;
        let things = Deeplab::load(&model.part("things")?, DeeplabParams::default(), device)?;
        let stuff = Deeplab::load(&model.part("stuff")?, DeeplabParams::default(), device)?;
        let persons = BodyPix::load(&model.part("persons")?, BodyPixParams::default(), device)?;
        let classes = model.classes().clone();
        let number = |name: &str| classes.index(name).and_then(|class| u32::try_from(class).ok());
        let all = |part: &Classes, number: &dyn Fn(&str) -> Option<u32>| -> Vec<_> {
            (0..part.len()).map(|class| part.name(class as i64).and_then(|name| number(name))).collect()
        };
        Ok(Self {
            of_detector: all(&detector.classes(), &number),
            of_things: all(&things.classes(), &|name| number(renamed(&THINGS, name).unwrap_or(name))),
            of_stuff: all(&stuff.classes(), &|name| renamed(&STUFF, name).and_then(number)),
            person: number("person"),
            params,
            classes,
            detector,
            things,
            stuff,
            persons,
            work: Pool::default(),
        })
    }

    fn params(&self) -> &EfficientPsParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut EfficientPsParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, targets: &mut EfficientPsTargets) -> Result<()> {
        let Work { boxes, found, things, stuff, fusion } = &mut *self.work.take();
        self.detector.infer_into(&mut (), image, boxes)?;
        self.things.infer_into(&mut (), image, things)?;
        self.stuff.infer_into(&mut (), image, stuff)?;
        let EfficientPsParams { threshold, box_masks, min_overlap, min_leftover, min_stuff } = self.params;
        found.clear();
        found.extend(boxes.boxes.iter().filter(|one| one.confidence >= threshold).filter_map(|one| {
            let Name::Index(class) = one.name else { return None };
            let class = self.of_detector.get(usize::try_from(class).ok()?).copied()??;
            Some(Thing { class, corners: one.corners() })
        }));
        let size = [image.width(), image.height()];
        let shape = [size[1], size[0]];
        let EfficientPsTargets { instance, semantic } = targets;
        instance.classes.clone_from(&self.classes);
        semantic.classes.clone_from(&self.classes);
        let (things, stuff) = (labels(things)?, labels(stuff)?);
        self.persons.segment(image, |persons, _| {
            let predictions = Predictions {
                size,
                things,
                of_things: &self.of_things,
                stuff,
                of_stuff: &self.of_stuff,
                persons,
                person: self.person,
            };
            let rules = Rules { box_masks, min_overlap, min_leftover, min_stuff };
            fusion.run(&predictions, found, &rules, instance.labels_mut(&shape));
        })?;
        let HeatmapValues::Labels(instances) = instance.values() else { return Ok(()) };
        for (class, label) in semantic.labels_mut(&shape).iter_mut().zip(instances.iter()) {
            *class = label / fusion::LABEL_DIVISOR;
        }
        Ok(())
    }
}

/// Returns the name of a class in the fusion, where the table has one.
fn renamed(table: &[(&str, &'static str)], name: &str) -> Option<&'static str> {
    table.iter().find(|(theirs, _)| *theirs == name).map(|(_, ours)| *ours)
}

fn labels(map: &Heatmap) -> Result<&[u32]> {
    match map.values() {
        HeatmapValues::Labels(labels) => Ok(labels.as_slice()),
        HeatmapValues::Scores(_) => Err(Error::format("the part returns scores instead of classes")),
    }
}
