//! VPIT: one object in the scans of a lidar, from a box around it in the first.
//!
//! I. Oleksiienko, P. Nousi, N. Passalis, A. Tefas, A. Iosifidis, "VPIT: Real-time Embedded Single Object 3D Tracking Using Voxel
//! Pseudo Images", 2022; written from the paper, with a network small enough for a processor. A network makes features of the
//! pillars around a place, and every place of a view is compared with what the object looked like in the first, from a few
//! directions. Unlike the paper, views are drawn of the points in the object's own frame, not cut out of one picture of all
//! pillars, so that nothing is interpolated; and only cells that the object covers are compared.

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
mod template;
#[cfg(test)]
#[cfg(feature = "training")]
mod tests;
mod view;

use opendr_clouds::object_detection_3d::Scan;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
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
use template::{Comparison, Template};
use view::{VIEW_LEN, ViewPainter};

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct VpitParams {
    /// How much a place far from where the object is expected is marked down.
    #[param(default = 0.4, range = 0.0..=1.0, live)]
    pub window_influence: f32,
    /// What the score of another direction than the expected one is multiplied by.
    #[param(default = 0.98, range = 0.0..=1.0, live)]
    pub rotation_penalty: f32,
    /// How far the directions are apart that are looked at.
    #[param(default = 0.15, range = 0.01..=1.0, unit = "rad", live)]
    pub rotation_step: f32,
    /// How many directions are looked at, the expected one in their middle; an even number is one more.
    #[param(default = 3, range = 1..=9, live)]
    pub rotations_count: usize,
    /// What is seen around an object with it, in its mean sides.
    #[param(default = 0.25, range = 0.0..=2.0)]
    pub context_amount: f32,
    /// How much of every later view goes into what the object looks like; OpenDR's default is 0, too.
    #[param(default = 0.0, range = 0.0..=1.0, live)]
    pub target_feature_merge_scale: f32,
    /// What is known of the object's way.
    #[param(live)]
    pub extrapolation_mode: Extrapolation,
    /// How much of the way to where it is seen the box moves.
    #[param(default = 1.0, range = 0.0..=1.0, live)]
    pub offset_interpolation: f32,
    /// The same for its height.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub vertical_offset_interpolation: f32,
    /// Below this score the object is out of sight: the box goes where it is expected.
    #[param(default = 0.0, range = 0.0..=1.0, live)]
    pub min_top_score: f32,
}

opendr_engine::choices! {
    /// Where an object is expected.
    pub enum Extrapolation {
        /// As far on as it came in the mean of the last moments.
        LinearPlus = "linear+",
        /// As far on as it came in the last moment.
        Linear = "linear",
        /// Where it was.
        None = "none",
    }
}

/// A loaded VPIT.
pub struct Vpit {
    params: VpitParams,
    layout: VpitLayout,
    features: Session,
    scratch: Pool<Scratch>,
}

/// What is followed in one stream.
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

/// The file of the container.
const FILE: &str = "features.onnx";

impl Learner for Vpit {
    const SPEC: Spec = Spec::new("vpit", Task::ObjectTracking3d)
        .class("ObjectTracking3DVpitLearner")
        .about("VPIT follows one object in the scans of a lidar from a box in the first; it trains on recordings.")
        .without_effect(&[
            ("model_config_path", "what it needs to know stands in the model"),
            ("tanet_config_path", "there is one network"),
            ("backbone", "there is one network"),
            ("feature_blocks", "there is one network"),
            ("bof_mode", "there is one network"),
            ("bof_training_steps", "there is one network"),
            ("score_upscale", "the place is found between cells by a parabola"),
            ("upscaling_mode", "the place is found between cells by a parabola"),
            ("rotation_interpolation", "the turn is found between directions by a parabola"),
            ("target_size", "the model knows the size of its views"),
            ("search_size", "the model knows the size of its views"),
            ("search_type", "the model knows the size of its views"),
            ("target_type", "the cells that the object covers are compared"),
            ("target_features_mode", "target_feature_merge_scale tells it"),
            ("overwrite_strides", "there is one network"),
            ("regress_vertical_position", "the height follows the points of the object"),
            ("regression_training_isolation", "the height follows the points of the object"),
            ("vertical_regressor_type", "the height follows the points of the object"),
            ("vertical_regressor_kwargs", "the height follows the points of the object"),
            ("threshold", "min_top_score tells it"),
            ("scale", "the model knows the range of its views"),
            ("temp_path", "what fit writes lies in its output folder"),
            ("checkpoint_load_iter", "fit goes on from the last checkpoint of its output folder"),
            ("loss_function", "binary cross-entropy, as OpenDR's default"),
            ("train_pseudo_image", "there is one network, which trains as a whole"),
            ("augment_rotation", "augment tells it"),
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
                "{FILE} does not make features of views [any, {CHANNELS}, {VIEW}, {VIEW}]; train or get it anew"
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

    /// Points that are not finite are left out; without points near it the object stays where it is expected, with score 0.
    fn infer_into(
        &self,
        state: &mut VpitState,
        input: VpitInputs<'_>,
        answer: &mut TrackingAnnotation3DList,
    ) -> Result<()> {
        let VpitInputs { scan, init_box } = input;
        let confidence = match init_box {
            Some(boxes) => {
                answer.classes.clone_from(&boxes.classes);
                self.begin(state, scan, boxes)?;
                1.0
            }
            None => self.follow(state, scan)?,
        };
        let Some(object) = &state.object else { return Ok(()) };
        let mut found = object.place.to_camera(scan.calibration(), scan.image_shape());
        found.name.clone_from(&object.name);
        found.confidence = confidence;
        answer.action = None;
        answer.annotations.clear();
        answer.annotations.push(TrackingAnnotation3D {
            bounding_box_3d: found,
            id: 0,
            frame: Some(object.frame),
        });
        Ok(())
    }
}

impl Vpit {
    /// Looks at what is to be followed.
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
        self.see(views, |features| {
            template.take(&self.layout, [length, width], context, features);
            Ok(())
        })?;
        state.object = Some(object);
        Ok(())
    }

    /// Where it is now, and how sure that is.
    fn follow(&self, state: &mut VpitState, scan: Scan<'_>) -> Result<f32> {
        let VpitState { object, template } = state;
        let Some(object) = object else {
            return Err(Error::invalid_input(
                "nothing is followed yet: give init_box, a box around the object, with the first scan of a stream",
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
        self.see(views, |features| {
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
            self.see(view, |features| {
                template.merge(features, self.params.target_feature_merge_scale);
                Ok(())
            })?;
        }
        Ok(found.score)
    }

    /// Hands the features of views to `sink`.
    fn see(&self, views: &[f32], mut sink: impl FnMut(&[f32]) -> Result<()>) -> Result<()> {
        let count = views.len() / VIEW_LEN;
        let input = TensorView::new(&[count, CHANNELS, VIEW, VIEW], views)?;
        self.features.run(&[input], |outputs| {
            let wanted = [count, FEATURES, CELLS, CELLS];
            match outputs {
                [features] if *features.shape() == wanted => sink(features.values()?),
                _ => Err(Error::format(format!("{FILE} does not give {wanted:?}; train or get it anew"))),
            }
        })
    }
}
