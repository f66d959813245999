//! The class and the object of every point of a lidar's scan: panoptic segmentation behind the interface of OpenDR's EfficientLPS.
//!
//! It is not EfficientLPS's network (K. Sirohi, R. Mohan, D. Büscher, W. Burgard, A. Valada, IEEE T-RO 2021): a small one tells the
//! class of each pixel of a range image ([`opendr_clouds::range_image`]), and points of a countable class that lie close together are an
//! object (I. Bogoslavskyi, C. Stachniss, "Fast range image-based segmentation of sparse 3D laser scans", IROS 2016, by
//! distance instead of angle).

#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;
mod objects;
#[cfg(test)]
#[cfg(feature = "training")]
mod tests;

use opendr_clouds::object_detection_3d::Scan;
use opendr_clouds::range_image::{RangeImage, RangeView};
use opendr_engine::data::PointCloud;
use opendr_engine::learner::{Learner, Spec, Targets};
use opendr_engine::model::{Manifest, Model};
use opendr_engine::params::Params;
use opendr_engine::target::{Classes, Heatmap};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};
use serde::{Deserialize, Serialize};

#[cfg(feature = "training")]
pub use fit::EfficientLpsFitParams;
use objects::{ObjectRule, Objects};

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct EfficientLpsParams {
    /// The classes whose objects are told apart; a model brings those that it was trained with.
    #[param(default = Vec::new())]
    pub things: Vec<u32>,
    /// Whether the answers are maps of the range image's size instead of a number for each point.
    #[param(default = false, live)]
    pub projected: bool,
    /// Points of neighbouring pixels farther apart than this are of two objects.
    #[param(default = 0.8, range = 0.01..=10.0, unit = "m", live)]
    pub max_gap: f32,
    /// Objects of fewer pixels are not told.
    #[param(default = 5, range = 1..=100_000, live)]
    pub min_points: u32,
}

/// What is told of a scan: OpenDR's pair, and its picture of distances.
#[derive(Default, Targets)]
pub struct EfficientLpsTargets {
    /// Of each point (`[points]`) or pixel (`[rows, columns]`): 1000 times the class and the number of the object in its
    /// class, from 1; 0 where the class is not countable. 255000 where nothing is known.
    pub instance: Heatmap,
    /// The class; 255 where nothing is known.
    pub semantic: Heatmap,
    /// Metres, `[rows, columns]`, 0 where there is nothing; empty unless `projected`.
    pub depth: Heatmap,
}

/// A loaded network.
pub struct EfficientLps {
    params: EfficientLpsParams,
    classes: Classes,
    view: RangeView,
    network: Session,
    work: Pool<Work>,
}

#[derive(Default)]
struct Work {
    image: RangeImage,
    canvas: Vec<f32>,
    /// Of each pixel.
    classes: Vec<u32>,
    scores: Vec<f32>,
    objects: Objects,
}

/// The network in every container.
const FILE: &str = "model.onnx";
/// What the network sees of a pixel: distance, x, y, z, reflectance.
const CHANNELS: usize = 5;
/// What these are divided by.
const SCALES: [f32; CHANNELS] = [50.0, 50.0, 50.0, 5.0, 1.0];
/// A label is this times its class, plus the number of the object: Cityscapes' way.
const LABEL_DIVISOR: u32 = 1000;
/// The class of what is not known.
const UNKNOWN: u32 = 255;

/// What stands in a container's `inputs`.
#[derive(Debug, Serialize, Deserialize)]
struct Described {
    /// How its range image looks.
    view: RangeView,
}

fn view_of(manifest: &Manifest) -> Result<RangeView> {
    let Described { view } = manifest.read_inputs("the view of its range image")?;
    view.check()?;
    Ok(view)
}

/// Writes what the network sees of a scan, `[channels, rows, columns]`.
fn paint(image: &RangeImage, cloud: &PointCloud, canvas: &mut Vec<f32>) {
    let (points, channels) = (cloud.as_slice(), cloud.channels());
    let pixels = image.points().len();
    canvas.clear();
    canvas.resize(CHANNELS * pixels, 0.0);
    for (pixel, (point, range)) in image.points().iter().zip(image.ranges()).enumerate() {
        // No point is as far on as that.
        let Some(point) = points.get((*point as usize).saturating_mul(channels)..) else { continue };
        let [x, y, z] = [point[0], point[1], point[2]];
        let reflectance = if channels > 3 && point[3].is_finite() { point[3].clamp(0.0, 1.0) } else { 0.0 };
        for (channel, (value, scale)) in [*range, x, y, z, reflectance].into_iter().zip(SCALES).enumerate() {
            canvas[channel * pixels + pixel] = value / scale;
        }
    }
}

/// Takes the picture of a scan.
fn project(image: &mut RangeImage, view: &RangeView, cloud: &PointCloud) {
    image.project(view, cloud.points().map(|point| [point[0], point[1], point[2]]));
}

impl Learner for EfficientLps {
    const SPEC: Spec = Spec::new("efficient_lps", Task::PanopticSegmentation)
        .class("EfficientLpsLearner")
        .about("Tells class and object of every point of a lidar's scan; it trains on labelled scans.")
        .without_effect(&[("config_file", "what it needs to know stands in the model")]);
    type Params = EfficientLpsParams;
    type Input<'a> = Scan<'a>;
    type Target = EfficientLpsTargets;
    type State = ();

    fn load(model: &Model, params: EfficientLpsParams, device: Device) -> Result<Self> {
        let view = view_of(model.manifest())?;
        let classes = model.classes().clone();
        let network = Session::open(&model.file(FILE)?, device)?;
        let (input, output) = (
            [1, CHANNELS, view.rows, view.columns].map(Some),
            [1, classes.len(), view.rows, view.columns].map(Some),
        );
        match (network.inputs(), network.outputs()) {
            ([found], [scores]) if found.dims[..] == input && scores.dims[..] == output => {}
            _ => {
                return Err(Error::format(format!(
                    "{FILE} does not make {output:?} of {input:?} as the model's view and classes ask for; train or get it anew"
                )));
            }
        }
        Ok(Self { params, classes, view, network, work: Pool::default() })
    }

    fn params(&self) -> &EfficientLpsParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut EfficientLpsParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    /// Points that are not finite, or outside of the view, are not known.
    fn infer_into(&self, _: &mut (), scan: Scan<'_>, targets: &mut EfficientLpsTargets) -> Result<()> {
        let work = &mut *self.work.take();
        let cloud = scan.cloud();
        project(&mut work.image, &self.view, cloud);
        paint(&work.image, cloud, &mut work.canvas);
        let shape = [1, CHANNELS, self.view.rows, self.view.columns];
        self.network.run(&[TensorView::new(&shape, &work.canvas[..])?], |outputs| {
            let found = outputs.first().map_or(Ok(&[][..]), TensorView::values::<f32>)?;
            best_classes(found, work.image.ranges(), &mut work.classes, &mut work.scores);
            Ok(())
        })?;
        let EfficientLpsParams { ref things, projected, max_gap, min_points } = self.params;
        let Work { image, classes, objects, .. } = work;
        let rule = ObjectRule { things, gap: max_gap, least: min_points };
        objects.find(image, cloud, [self.view.columns, self.view.rows], classes, &rule);
        let EfficientLpsTargets { instance, semantic, depth } = targets;
        instance.classes.clone_from(&self.classes);
        semantic.classes.clone_from(&self.classes);
        let pixels = [self.view.rows, self.view.columns];
        if projected {
            instance.labels_mut(&pixels).copy_from_slice(objects.labels());
            semantic.labels_mut(&pixels).copy_from_slice(classes);
            depth.scores_mut(&pixels).copy_from_slice(image.ranges());
            return Ok(());
        }
        depth.scores_mut(&[0, 0]);
        let points = instance.labels_mut(&[cloud.len()]).iter_mut().zip(semantic.labels_mut(&[cloud.len()]));
        for (point, (instance, semantic)) in points.enumerate() {
            (*instance, *semantic) = match image.speaker(point) {
                Some(pixel) => (objects.labels()[pixel], classes[pixel]),
                None => (UNKNOWN * LABEL_DIVISOR, UNKNOWN),
            };
        }
        Ok(())
    }
}

/// The class with the highest score of each pixel that sees something, of maps one after the other.
fn best_classes(found: &[f32], ranges: &[f32], classes: &mut Vec<u32>, scores: &mut Vec<f32>) {
    classes.clear();
    classes.resize(ranges.len(), UNKNOWN);
    scores.clear();
    scores.resize(ranges.len(), f32::NEG_INFINITY);
    for (class, plane) in (0..).zip(found.chunks_exact(ranges.len())) {
        for (((best, score), here), range) in classes.iter_mut().zip(&mut *scores).zip(plane).zip(ranges) {
            if here > score && *range > 0.0 {
                (*best, *score) = (class, *here);
            }
        }
    }
}
