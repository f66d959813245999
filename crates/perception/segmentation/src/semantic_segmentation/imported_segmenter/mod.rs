//! Semantic segmentation by an ONNX file that another tool exported: SegFormer of transformers, DeepLabV3, FCN and LR-ASPP of torchvision,
//! DeepLab of TensorFlow, networks of OpenVINO's model zoo.
//!
//! Class scores of any resolution are interpolated bilinearly to the image before the best class is chosen, as transformers'
//! `post_process_semantic_segmentation` does. The map is recognised from shapes and names, the input of transformers and torchvision from
//! the names of their outputs. A parameter overrides both; what is neither recognised nor given is an error that names the parameter.

mod layout;
mod params;
mod upsample;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::target::{Classes, Heatmap};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_perception_common::exported_network::{
    ExportedNetwork, Facts, ImageInput, InputColour, InputConvention, InputLevels, InputResize, NetworkKind,
};
use opendr_vision::InputGeometry;

use self::layout::{Map, map_output, recognised};
pub use self::params::{ImportedSegmenterParams, MapFormat};
use self::upsample::{Between, Scores, Upsampling};

/// A loaded segmenter of another tool.
pub struct ImportedSegmenter {
    params: ImportedSegmenterParams,
    classes: Classes,
    network: ExportedNetwork,
    output: usize,
    /// Width and height of the network's input, in pixels.
    size: [usize; 2],
    scratch: Pool<Scratch>,
}

/// Work memory.
#[derive(Default)]
struct Scratch {
    columns: Vec<Between>,
    upsampling: Upsampling,
}

impl Learner for ImportedSegmenter {
    const SPEC: Spec = Spec::new("segmenter", Task::SemanticSegmentation)
        .class("ImportedSegmenterLearner")
        .about("Runs your own semantic segmentation, exported to ONNX by another tool; recognises input and map of classes.")
        .recognises_network(|onnx| NetworkKind::Segmenter.recognises(onnx));
    type Params = ImportedSegmenterParams;
    type Input<'a> = &'a Image;
    type Target = Heatmap;
    type State = ();

    fn load(model: &Model, mut params: ImportedSegmenterParams, device: Device) -> Result<Self> {
        let (session, facts) = Facts::open(model, device)?;
        let image = ImageInput::find(&facts, params.input.side())?;
        let output = map_output(&facts, params.map_output.as_deref())?;
        let input = params.input.settle(known_input(&facts, &image));
        let missing: Vec<_> = input.missing().collect();
        if !missing.is_empty() {
            return Err(facts.unsettled(&missing));
        }
        if params.map == MapFormat::Auto {
            params.map = recognised(&facts.outputs[output], image.layout());
        }
        let classes = facts.classes(model);
        let dims = &facts.outputs[output].dims;
        let count = match params.map {
            MapFormat::ChannelsFirst => dims.get(1).copied().flatten(),
            MapFormat::ChannelsLast => dims.get(3).copied().flatten(),
            MapFormat::Auto | MapFormat::Labels => None,
        };
        if let Some(count) = count.filter(|count| !classes.is_empty() && *count != classes.len()) {
            return Err(Error::format(format!(
                "the network has scores of {count} classes, and the model names {}; name one per score, the background too",
                classes.len()
            )));
        }
        params.map_output = Some(facts.outputs[output].name.clone());
        let network = ExportedNetwork::new(session, image, &input)?;
        Ok(Self { params, classes, network, output, size: image.size, scratch: Pool::default() })
    }

    fn params(&self) -> &ImportedSegmenterParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut ImportedSegmenterParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, map: &mut Heatmap) -> Result<()> {
        map.classes.clone_from(&self.classes);
        let image_size = [image.width(), image.height()];
        self.network.run(image.view(), |outputs, geometry| {
            let (found, [classes, rows, columns]) = Map::of(&outputs[self.output], self.params.map)?;
            let size = if self.params.full_size { image_size } else { [columns, rows] };
            let places =
                Places { geometry, input: self.size, map: [columns, rows], is_image: self.params.full_size };
            self.write(found, [classes, rows, columns], &places, map.labels_mut(&[size[1], size[0]]), size)
        })
    }
}

impl ImportedSegmenter {
    /// Writes the class of every pixel of a map of `size`.
    fn write(
        &self,
        map: Map<'_>,
        counts: [usize; 3],
        places: &Places<'_>,
        labels: &mut [u32],
        [width, height]: [usize; 2],
    ) -> Result<()> {
        let Scratch { columns, upsampling } = &mut *self.scratch.take();
        columns.clear();
        columns.extend((0..width).map(|x| places.between(0, x)));
        if let Map::Scores { values, strides } = map {
            upsampling.begin(Scores { values, counts, strides });
        }
        for (y, line) in (0..height).zip(labels.chunks_exact_mut(width.max(1))) {
            let row = places.between(1, y);
            match map {
                Map::Scores { values, strides } => {
                    let scores = Scores { values, counts, strides };
                    upsampling.classes_of_row(scores, row, columns, line);
                }
                Map::Labels(found) => {
                    let nearest =
                        |place: &Between| if place.share < 0.5 { place.first } else { place.second };
                    let begin = nearest(&row) * counts[2];
                    for (label, column) in line.iter_mut().zip(columns.iter()) {
                        *label = found.at(begin + nearest(column))?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Where the pixels of the prediction lie in the network's map.
struct Places<'a> {
    geometry: &'a InputGeometry,
    /// Sizes of the network's input and of its map.
    input: [usize; 2],
    map: [usize; 2],
    /// Whether the prediction has the size of the image, else that of the map.
    is_image: bool,
}

impl Places<'_> {
    /// Returns the neighbours in the map of a pixel's centre, along the horizontal axis 0 or the vertical one.
    fn between(&self, axis: usize, pixel: usize) -> Between {
        if !self.is_image {
            return Between { first: pixel, second: pixel, share: 0.0 };
        }
        let centre = pixel as f32 + 0.5;
        let in_input = self.geometry.input_from_image([centre, centre])[axis];
        let scale = self.map[axis] as f32 / self.input[axis] as f32;
        Between::at(in_input * scale - 0.5, self.map[axis])
    }
}

/// Returns what is known of the input: SegFormer and other segmenters of transformers (`pixel_values`, `logits`) and of torchvision
/// (`out`) were trained on ImageNet's mean and variance; a network that takes bytes has their levels.
fn known_input(facts: &Facts, image: &ImageInput) -> InputConvention {
    let is_named = |name: &str| facts.outputs.iter().any(|output| output.name == name);
    let is_of_transformers =
        is_named("logits") && facts.inputs.iter().any(|input| input.name == "pixel_values");
    if is_of_transformers || is_named("out") {
        return InputConvention {
            resize: InputResize::Stretch,
            padding: 0,
            colour: InputColour::Rgb,
            levels: InputLevels::ImageNet,
            ..InputConvention::UNKNOWN
        };
    }
    let levels = if image.is_bytes() { InputLevels::Bytes } else { InputLevels::Auto };
    InputConvention { levels, ..InputConvention::UNKNOWN }
}
