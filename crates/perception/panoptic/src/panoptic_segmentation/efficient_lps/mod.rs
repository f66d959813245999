//! Panoptic segmentation of lidar scans, with the interface of OpenDR's EfficientLPS.
//!
//! The network is not that of EfficientLPS (K. Sirohi, R. Mohan, D. Büscher, W. Burgard, A. Valada, IEEE T-RO 2021): a small
//! one predicts the class of each pixel of a range image ([`opendr_clouds::range_image`]), and points of a thing class that are
//! close together are one object (I. Bogoslavskyi, C. Stachniss, "Fast range image-based segmentation of sparse 3D laser
//! scans", IROS 2016, by distance instead of angle).

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
use objects::{LABEL_DIVISOR, ObjectRule, Objects, UNKNOWN};

/// Parameters of [`EfficientLps`].
#[derive(Debug, Clone, Params)]
pub struct EfficientLpsParams {
    /// Thing classes, whose objects are distinguished; a loaded model has its own.
    #[param(default = Vec::new())]
    pub things: Vec<u32>,
    /// Whether the maps have the size of the range image instead of one value per point.
    #[param(default = false, live)]
    pub projected: bool,
    /// Maximum distance between points of neighbouring pixels of one object.
    #[param(default = 0.8, range = 0.01..=10.0, unit = "m", live)]
    pub max_gap: f32,
    /// Minimum number of pixels of an object.
    #[param(default = 5, range = 1..=100_000, live)]
    pub min_points: u32,
}

/// Prediction for a scan: OpenDR's pair of maps, and the range image.
#[derive(Default, Targets)]
pub struct EfficientLpsTargets {
    /// Instance of each point (`[points]`) or pixel (`[rows, columns]`): 1000 times the class plus the index of the object
    /// within its class, from 1; 0 for stuff classes. 255000 for void.
    pub instance: Heatmap,
    /// Class of each point or pixel; 255 for void.
    pub semantic: Heatmap,
    /// Range in metres, `[rows, columns]`, 0 where there is no point; empty unless `projected`.
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
    /// Class and score of each pixel.
    classes: Vec<u32>,
    scores: Vec<f32>,
    objects: Objects,
}

/// File of the network in every container.
const FILE: &str = "model.onnx";
/// Channels of the network's input: range, x, y, z, reflectance.
const CHANNELS: usize = 5;
/// Divisors of these channels.
const SCALES: [f32; CHANNELS] = [50.0, 50.0, 50.0, 5.0, 1.0];

/// Description of the network's input in a container.
#[derive(Debug, Serialize, Deserialize)]
struct Described {
    /// Field of view of the range image.
    view: RangeView,
}

fn view_of(manifest: &Manifest) -> Result<RangeView> {
    let Described { view } = manifest.read_inputs("the view of its range image")?;
    view.check()?;
    Ok(view)
}

/// Writes the network's input of a scan, `[channels, rows, columns]`.
fn fill_canvas(image: &RangeImage, cloud: &PointCloud, canvas: &mut Vec<f32>) {
    let (points, channels) = (cloud.as_slice(), cloud.channels());
    let pixels = image.points().len();
    canvas.clear();
    canvas.resize(CHANNELS * pixels, 0.0);
    for (pixel, (point, range)) in image.points().iter().zip(image.ranges()).enumerate() {
        // No point is at this distance.
        let Some(point) = points.get((*point as usize).saturating_mul(channels)..) else { continue };
        let [x, y, z] = [point[0], point[1], point[2]];
        let reflectance = if channels > 3 && point[3].is_finite() { point[3].clamp(0.0, 1.0) } else { 0.0 };
        for (channel, (value, scale)) in [*range, x, y, z, reflectance].into_iter().zip(SCALES).enumerate() {
            canvas[channel * pixels + pixel] = value / scale;
        }
    }
}

/// Projects a scan to a range image.
fn project(image: &mut RangeImage, view: &RangeView, cloud: &PointCloud) {
    image.project(view, cloud.points().map(|point| [point[0], point[1], point[2]]));
}

impl Learner for EfficientLps {
    const SPEC: Spec = Spec::new("efficient_lps", Task::PanopticSegmentation)
        .class("EfficientLpsLearner")
        .about("Predicts class and instance of every point of a lidar scan; trainable on labelled scans.")
        .without_effect(&[("config_file", "the model contains its configuration")]);
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
                    "{FILE} does not map {input:?} to {output:?}, as the model's view and classes require; train or download it again"
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

    /// Points that are not finite or outside of the view are void.
    fn infer_into(&self, _: &mut (), scan: Scan<'_>, targets: &mut EfficientLpsTargets) -> Result<()> {
        let work = &mut *self.work.take();
        let cloud = scan.cloud();
        project(&mut work.image, &self.view, cloud);
        fill_canvas(&work.image, cloud, &mut work.canvas);
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
            (*instance, *semantic) = match image.pixel_for(point) {
                Some(pixel) => (objects.labels()[pixel], classes[pixel]),
                None => (UNKNOWN * LABEL_DIVISOR, UNKNOWN),
            };
        }
        Ok(())
    }
}

/// Writes the class with the highest score, and the score, of each pixel with a point; `found` contains one map per class.
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
