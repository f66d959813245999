//! Depth from one image by an ONNX file that another tool exported: MiDaS, DPT, Depth Anything, ZoeDepth, GLPN, YOLO26-depth.
//!
//! A network returns metres, or depth or inverse depth up to an unknown scale and shift ([`DepthKind`]). Its map is interpolated to the
//! size of the image as `post_process_depth_estimation` of transformers does. Quantity and input are recognised from metadata, modules
//! and operators of the network. A parameter overrides them; what is neither recognised nor given is an error that names the parameter.

mod convention;
mod depth_map;
mod input_size;
mod interpolation;
mod params;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::ParamMap;
use opendr_engine::target::{Classes, Heatmap};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_perception_common::exported_network::{ExportedNetwork, Facts, ImageInput, NetworkKind};
use opendr_vision::InputGeometry;

use self::depth_map::{DepthMap, find_output};
use self::input_size::DynamicSize;
use self::interpolation::{Interpolation, Taps};
pub use self::params::{DepthKind, ImportedDepthEstimatorParams, MapInterpolation};

/// A loaded depth estimator of another tool.
pub struct ImportedDepthEstimator {
    params: ImportedDepthEstimatorParams,
    network: ExportedNetwork,
    output: usize,
    /// Width and height of an input of fixed size, in pixels.
    size: [usize; 2],
    dynamic: Option<DynamicSize>,
    interpolation: Pool<Interpolation>,
}

impl Learner for ImportedDepthEstimator {
    const SPEC: Spec = Spec::new("depth_estimator", Task::DepthEstimation)
        .class("ImportedDepthEstimatorLearner")
        .about(
            "Runs your own depth estimator, exported to ONNX by another tool; recognises input and quantity.",
        )
        .recognises_network(|onnx| NetworkKind::DepthEstimator.recognises(onnx));
    type Params = ImportedDepthEstimatorParams;
    type Input<'a> = &'a Image;
    type Target = Heatmap;
    type State = ();

    fn load(model: &Model, mut params: ImportedDepthEstimatorParams, device: Device) -> Result<Self> {
        let (session, facts) = Facts::open(model, device)?;
        let output = find_output(&facts, params.depth_output.as_deref())?;
        let known = convention::recognise(&facts, output);
        let input = params.input.settle(known.input);
        if params.kind == DepthKind::Auto {
            params.kind = known.kind;
        }
        if params.interpolation == MapInterpolation::Auto {
            params.interpolation = known.interpolation;
        }
        let kind = (params.kind == DepthKind::Auto).then_some("kind");
        let missing: Vec<_> = kind.into_iter().chain(input.missing()).collect();
        if !missing.is_empty() {
            return Err(facts.unsettled(&missing));
        }
        if params.kind != DepthKind::Metric && params.scale != 1.0 {
            return Err(Error::invalid_param(format!(
                "scale = {} converts depths to metres, and the network's are {}: known up to scale and shift; leave scale out",
                params.scale,
                params.kind.name()
            )));
        }
        let image = ImageInput::find(&facts, input.size)?;
        let dynamic = (image.is_dynamic && facts.inputs.len() == 1).then(|| DynamicSize {
            side: input.size,
            multiple: *params.multiple.get_or_insert_with(|| convention::multiple(&facts)),
            keep_aspect: params.keep_aspect,
        });
        params.depth_output = Some(facts.outputs[output].name.clone());
        let network = ExportedNetwork::new(session, image, &input)?;
        let interpolation = Pool::default();
        Ok(Self { params, network, output, size: image.size, dynamic, interpolation })
    }

    fn params(&self) -> &ImportedDepthEstimatorParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut ImportedDepthEstimatorParams {
        &mut self.params
    }

    fn metric_params(&self) -> ParamMap {
        let alignment = match self.params.kind {
            DepthKind::InverseRelative => "inverse_scale_shift",
            DepthKind::Relative => "scale_shift",
            DepthKind::Metric | DepthKind::Auto => return ParamMap::new(),
        };
        ParamMap::from([("alignment".to_owned(), alignment.into())])
    }

    fn infer_into(&self, _: &mut (), image: &Image, map: &mut Heatmap) -> Result<()> {
        map.classes = Classes::default();
        let image_size = [image.width(), image.height()];
        let input_size = self.dynamic.map_or(self.size, |dynamic| dynamic.of(image_size));
        self.network.run_sized(image.view(), input_size, |outputs, geometry| {
            let found = DepthMap::of(&outputs[self.output])?;
            if self.params.full_size {
                let [width, height] = image_size;
                let pixels = map.scores_mut(&[height, width]);
                self.resize(&found, &Places { geometry, input: input_size }, image_size, pixels);
            } else {
                let [columns, rows] = found.size;
                let pixels = map.scores_mut(&[rows, columns]).iter_mut();
                pixels.zip(found.values).for_each(|(pixel, value)| *pixel = value * self.params.scale);
            }
            Ok(())
        })
    }
}

impl ImportedDepthEstimator {
    /// Writes the depth of every pixel of an image of `size`.
    fn resize(&self, map: &DepthMap<'_>, places: &Places<'_>, size: [usize; 2], pixels: &mut [f32]) {
        let interpolation = &mut *self.interpolation.take();
        let Interpolation { columns, rows, .. } = interpolation;
        for (axis, taps) in [columns, rows].into_iter().enumerate() {
            let count = map.size[axis];
            taps.clear();
            taps.extend((0..size[axis]).map(|pixel| match self.params.interpolation {
                MapInterpolation::BilinearCorners => {
                    Taps::linear(places.by_corners(axis, pixel, size[axis], count), count)
                }
                MapInterpolation::Auto | MapInterpolation::Bicubic => {
                    Taps::cubic(places.by_edges(axis, pixel as f32 + 0.5, count), count)
                }
            }));
        }
        interpolation.run(map.values, map.size[0], self.params.scale, pixels);
    }
}

/// Where the pixels of an image lie in a map of its network's input.
struct Places<'a> {
    geometry: &'a InputGeometry,
    /// Width and height of the network's input.
    input: [usize; 2],
}

impl Places<'_> {
    /// Returns the position in a map with `count` pixels along the axis, whose first centre is 0, of a position in the image.
    fn by_edges(&self, axis: usize, position: f32, count: usize) -> f32 {
        let in_input = self.geometry.input_from_image([position, position])[axis];
        in_input * (count as f32 / self.input[axis] as f32) - 0.5
    }

    /// Returns the same of a pixel of `pixels`, with the centres of the first and the last on those of the map's part with the image.
    fn by_corners(&self, axis: usize, pixel: usize, pixels: usize, count: usize) -> f32 {
        let first = self.by_edges(axis, 0.0, count) + 0.5;
        let last = self.by_edges(axis, pixels as f32, count) - 0.5;
        first + pixel as f32 * ((last - first) / (pixels.saturating_sub(1)).max(1) as f32)
    }
}
