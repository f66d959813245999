//! VPIT: tracking of one object in the scans of a lidar, from a box around it in the first one.
//!
//! I. Oleksiienko, P. Nousi, N. Passalis, A. Tefas, A. Iosifidis, "VPIT: Real-time Embedded Single Object 3D Tracking Using
//! Voxel Pseudo Images", 2022; written from the paper, with a network small enough for a CPU. A network computes features
//! of the pillars around a position, and the features at every position of a view are compared with the object's in the
//! first scan, for a few rotations. Unlike in the paper, views are voxelised from the points in the object's own frame, not
//! cropped from one pseudo image, so nothing is interpolated; and only cells that the object covers are compared.

mod choice;
#[cfg(feature = "training")]
mod fit;
mod inputs;
mod layout;
#[cfg(feature = "training")]
mod network;
mod object;
#[cfg(feature = "training")]
mod objective;
#[cfg(feature = "training")]
mod pairs;
mod params;
mod template;
#[cfg(test)]
#[cfg(feature = "training")]
mod tests;
mod view;

use opendr_clouds::object_detection_3d::Scan;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::target::{BoundingBox3DList, LidarBox, TrackingAnnotation3D, TrackingAnnotation3DList};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};

#[cfg(feature = "training")]
pub use fit::VpitFitParams;
pub use inputs::VpitInputs;
pub use layout::VpitLayout;
use layout::{CELLS, CHANNELS, FEATURES, PLACES, VIEW};
use object::Object;
#[cfg(feature = "training")]
pub use objective::VpitObjective;
pub use params::{Extrapolation, VpitParams};
use template::{Comparison, Template};
use view::{VIEW_LEN, ViewPainter};

/// A loaded VPIT.
pub struct Vpit {
    params: VpitParams,
    layout: VpitLayout,
    features: Session,
    scratch: Pool<Scratch>,
}

/// The object of one stream.
#[derive(Default)]
pub struct VpitState {
    object: Option<Object>,
    template: Template,
}

#[derive(Default)]
struct Scratch {
    painter: ViewPainter,
    views: Vec<f32>,
    comparisons: Vec<Comparison>,
}

/// File name of the network in a container.
const FILE: &str = "features.onnx";

impl Learner for Vpit {
    const SPEC: Spec = Spec::new("vpit", Task::ObjectTracking3d)
        .class("ObjectTracking3DVpitLearner")
        .about("VPIT tracks one object in the scans of a lidar from a box in the first one; trainable on recordings.")
        .without_effect(&[
            ("model_config_path", "the model contains its configuration"),
            ("tanet_config_path", "there is one network"),
            ("backbone", "there is one network"),
            ("feature_blocks", "there is one network"),
            ("bof_mode", "there is one network"),
            ("bof_training_steps", "there is one network"),
            ("score_upscale", "the position is interpolated by a parabola"),
            ("upscaling_mode", "the position is interpolated by a parabola"),
            ("rotation_interpolation", "the rotation is interpolated by a parabola"),
            ("target_size", "the model defines the size of its views"),
            ("search_size", "the model defines the size of its views"),
            ("search_type", "the model defines the size of its views"),
            ("target_type", "the cells that the object covers are compared"),
            ("target_features_mode", "target_feature_merge_scale sets it"),
            ("overwrite_strides", "there is one network"),
            ("regress_vertical_position", "the height follows the points of the object"),
            ("regression_training_isolation", "the height follows the points of the object"),
            ("vertical_regressor_type", "the height follows the points of the object"),
            ("vertical_regressor_kwargs", "the height follows the points of the object"),
            ("threshold", "min_top_score sets it"),
            ("scale", "the model defines the range of its views"),
            ("temp_path", "fit writes to its output folder"),
            ("checkpoint_load_iter", "fit resumes from the last checkpoint of its output folder"),
            ("loss_function", "binary cross-entropy, as OpenDR's default"),
            ("train_pseudo_image", "there is one network, which trains as a whole"),
            ("augment_rotation", "augment sets it"),
        ]);
    type Params = VpitParams;
    type Input<'a> = VpitInputs<'a>;
    type Target = TrackingAnnotation3DList;
    type State = VpitState;

    fn load(model: &Model, params: VpitParams, device: Device) -> Result<Self> {
        let layout = VpitLayout::from_manifest(model.manifest())?;
        let features = Session::open(&model.file(FILE)?, device)?;
        let takes_views = matches!(features.inputs(), [input] if input.dims[..] == [None, Some(CHANNELS), Some(VIEW), Some(VIEW)]);
        if !takes_views || features.outputs().len() != 1 {
            return Err(Error::format(format!(
                "{FILE} does not have views [any, {CHANNELS}, {VIEW}, {VIEW}] as input and features as output; train or download it again"
            )));
        }
        Ok(Self { params, layout, features, scratch: Pool::default() })
    }

    fn params(&self) -> &VpitParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut VpitParams {
        &mut self.params
    }

    /// Points that are not finite are ignored; without points near it the object moves to the expected position, with score
    /// 0.
    fn infer_into(
        &self,
        state: &mut VpitState,
        input: VpitInputs<'_>,
        target: &mut TrackingAnnotation3DList,
    ) -> Result<()> {
        let VpitInputs { scan, init_box } = input;
        let confidence = match init_box {
            Some(boxes) => {
                target.classes.clone_from(&boxes.classes);
                self.begin(state, scan, boxes)?;
                1.0
            }
            None => self.follow(state, scan)?,
        };
        let Some(object) = &state.object else { return Ok(()) };
        let mut found = object.place.to_camera(scan.calibration(), scan.image_shape());
        found.name.clone_from(&object.name);
        found.confidence = confidence;
        target.action = None;
        target.annotations.clear();
        target.annotations.push(TrackingAnnotation3D {
            bounding_box_3d: found,
            id: 0,
            frame: Some(object.frame),
        });
        Ok(())
    }
}

impl Vpit {
    /// Starts to track the first of `boxes`.
    fn begin(&self, state: &mut VpitState, scan: Scan<'_>, boxes: &BoundingBox3DList) -> Result<()> {
        let mut object = Object::of(scan, boxes)?;
        state.object = None;
        let Scratch { painter, views, .. } = &mut *self.scratch.take();
        let LidarBox { center, size: [length, width, _], yaw } = object.place;
        painter.gather(&self.layout, scan.cloud(), center);
        object.top = painter.top([length, width], [0.0; 2], yaw);
        views.resize(VIEW_LEN, 0.0);
        painter.paint(&self.layout, yaw, views);
        let (template, context) = (&mut state.template, f64::from(self.params.context_amount));
        self.extract_features(views, |features| {
            template.take(&self.layout, [length, width], context, features);
            Ok(())
        })?;
        state.object = Some(object);
        Ok(())
    }

    /// Updates the position of the object and returns its score.
    fn follow(&self, state: &mut VpitState, scan: Scan<'_>) -> Result<f32> {
        let VpitState { object, template } = state;
        let Some(object) = object else {
            return Err(Error::invalid_input(
                "no object is tracked yet; give init_box, a box around the object, with the first scan of a stream",
            ));
        };
        let Scratch { painter, views, comparisons } = &mut *self.scratch.take();
        let before = object.place.center;
        object.expect(self.params.extrapolation_mode);
        painter.gather(&self.layout, scan.cloud(), object.place.center);
        let count = self.params.rotations_count | 1;
        let step = f64::from(self.params.rotation_step);
        let turn = |view: usize| (view as f64 - (count / 2) as f64) * step;
        views.resize(count * VIEW_LEN, 0.0);
        for (view, canvas) in views.chunks_exact_mut(VIEW_LEN).enumerate() {
            painter.paint(&self.layout, object.place.yaw + turn(view), canvas);
        }
        comparisons.resize(count, [0.0; PLACES * PLACES]);
        self.extract_features(views, |features| {
            let each = features.chunks_exact(FEATURES * CELLS * CELLS);
            for (features, comparison) in each.zip(comparisons.iter_mut()) {
                template.compare(features, comparison);
            }
            Ok(())
        })?;
        let found = choice::best(comparisons, &self.layout, &self.params);
        let Some(found) = found.filter(|_| painter.has_points()) else { return Ok(0.0) };
        if found.score < self.params.min_top_score {
            return Ok(found.score);
        }
        let way = object.go(&found, turn(found.view), step, &self.params);
        let LidarBox { size: [length, width, _], yaw, .. } = object.place;
        object.settle(painter.top([length, width], way, yaw), self.params.vertical_offset_interpolation);
        object.learn(before, self.params.extrapolation_mode);
        if self.params.target_feature_merge_scale > 0.0 {
            painter.gather(&self.layout, scan.cloud(), object.place.center);
            let (view, _) = views.split_at_mut(VIEW_LEN);
            painter.paint(&self.layout, yaw, view);
            self.extract_features(view, |features| {
                template.merge(features, self.params.target_feature_merge_scale);
                Ok(())
            })?;
        }
        Ok(found.score)
    }

    /// Computes the features of views and passes them to `sink`.
    fn extract_features(&self, views: &[f32], mut sink: impl FnMut(&[f32]) -> Result<()>) -> Result<()> {
        let count = views.len() / VIEW_LEN;
        let input = TensorView::new(&[count, CHANNELS, VIEW, VIEW], views)?;
        self.features.run(&[input], |outputs| {
            let expected = [count, FEATURES, CELLS, CELLS];
            match outputs {
                [features] if *features.shape() == expected => sink(features.values()?),
                _ => Err(Error::format(format!(
                    "{FILE} does not have the output {expected:?}; train or download it again"
                ))),
            }
        })
    }
}
