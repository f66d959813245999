//! PP-OCR: lines of text in images, by a detector, a classifier of their orientation and a recogniser.
//!
//! Du et al., PP-OCR: A Practical Ultra Lightweight OCR System, 2020, and its detector of version 3, 2022; Apache-2.0. The detector
//! segments text by differentiable binarisation (Liao et al., AAAI 2020); each region is rectified, turned upright, and read by a
//! recurrent network with CTC. The arithmetic is that of PaddleOCR 2, except that regions are scaled once, from the image to the input of
//! the recogniser.

mod ctc;
mod homography;
mod order;
mod rectangle;
mod rectify;
mod regions;

use std::borrow::Cow;

use opendr_engine::data::{Image, ImageView, PixelFormat, Samples};
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{TextRegion, TextRegionList};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::image_network::ImageNetwork;
use opendr_vision::{ChannelOrder, Preprocess};
use smallvec::SmallVec;

use self::ctc::Characters;
use self::order::{SAME_LINE, sort_reading_order};
use self::rectify::{InputShape, Quadrilateral, RgbPixels, rectify};
use self::regions::{RegionParams, Regions, TextBox};

/// File names: detector, recogniser, classifier of the orientation, characters of the recogniser.
const DETECTION: &str = "detection.onnx";
const RECOGNITION: &str = "recognition.onnx";
const ORIENTATION: &str = "orientation.onnx";
const CHARACTERS: &str = "characters.txt";

/// Sides of the detector's input are multiples of this.
const STRIDE: usize = 32;
/// Minimum width of the recogniser's input relative to its height (PaddleOCR pads shorter lines to it).
const MIN_ASPECT: usize = 10;
/// Maximum width of the recogniser's input relative to its height; longer lines are condensed.
const MAX_ASPECT: usize = 100;
/// Margin around a region in its second reading, relative to its height, and factor on the width of its text.
const MARGIN: f32 = 0.2;
const CONDENSE: f64 = 0.9;
/// Height and width of the orientation classifier's input.
const ORIENTATION_SIZE: [usize; 2] = [48, 192];
/// Probability above which a line is turned by 180 degrees.
const UPSIDE_DOWN: f32 = 0.9;

/// Parameters of [`PpOcr`].
#[derive(Debug, Clone, Params)]
pub struct PpOcrParams {
    /// Score of the text below which regions are dropped.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Probability of text above which pixels belong to a region.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub map_threshold: f32,
    /// Mean probability of text below which regions are not read.
    #[param(default = 0.6, range = 0.0..=1.0, live)]
    pub region_threshold: f32,
    /// Growth of regions, which the detector learned shrunken: area / perimeter times this on each side.
    #[param(default = 1.5, range = 0.0..=5.0, live)]
    pub unclip_ratio: f32,
    /// Maximum side of the detector's input. A larger image is scaled down to it; smaller text is found with a larger one.
    #[param(default = 960, range = 32..=8192, unit = "px", live)]
    pub max_side: usize,
    /// Whether lines that are upside down are turned, if the model has a classifier of the orientation.
    #[param(default = true, live)]
    pub turn: bool,
    /// Whether each line is read a second time, with a margin: spaces between words are recognised there that the first reading misses
    /// (38 and 58 of 60 rendered lines without an error), but distant letters less well.
    #[param(default = true, live)]
    pub read_twice: bool,
    /// Maximum number of regions per image that are read.
    #[param(default = 1000, range = 1..=1000, live)]
    pub max_regions: usize,
}

/// A loaded PP-OCR.
pub struct PpOcr {
    params: PpOcrParams,
    detector: ImageNetwork,
    recogniser: Session,
    /// Height of the recogniser's input.
    height: usize,
    orientation: Option<Session>,
    characters: Characters,
    scratch: Pool<Scratch>,
}

/// Work memory.
#[derive(Default)]
struct Scratch {
    regions: Regions,
    boxes: Vec<TextBox>,
    input: Vec<f32>,
    readings: Readings,
}

/// Readings of a line: the one that counts, and work memory.
#[derive(Default)]
struct Readings {
    text: String,
    loose: String,
    merged: String,
}

impl Learner for PpOcr {
    const SPEC: Spec = Spec::new("pp_ocr", Task::TextRecognition)
        .class("PpOcrLearner")
        .about("PP-OCR detects lines of text in an image and reads them; tiny and fast.");
    type Params = PpOcrParams;
    type Input<'a> = &'a Image;
    type Target = TextRegionList;
    type State = ();

    fn load(model: &Model, params: PpOcrParams, device: Device) -> Result<Self> {
        let detector = ImageNetwork::open_file(model, DETECTION, device, |_| {
            Ok(Preprocess::new(STRIDE, STRIDE).stretch().order(ChannelOrder::Bgr).normalise(
                [0.485, 0.456, 0.406].map(|mean| 255.0 * mean),
                [0.229, 0.224, 0.225].map(|std| 255.0 * std),
            ))
        })?;
        let recogniser = Session::open(&model.file(RECOGNITION)?, device)?;
        let height = recogniser.inputs().first().and_then(|input| input.dims.get(2).copied().flatten());
        let height = height.ok_or_else(|| {
            Error::format(format!("{RECOGNITION} has no image input of a fixed height; export it with one"))
        })?;
        let has_orientation = model.manifest().files.iter().any(|file| file.name == ORIENTATION);
        let orientation =
            if has_orientation { Some(Session::open(&model.file(ORIENTATION)?, device)?) } else { None };
        let text = String::from_utf8(model.file(CHARACTERS)?)
            .map_err(|error| Error::format(format!("{CHARACTERS} is not UTF-8")).with_source(error))?;
        let characters = Characters::from_dictionary(&text, true);
        Ok(Self { params, detector, recogniser, height, orientation, characters, scratch: Pool::default() })
    }

    fn params(&self) -> &PpOcrParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut PpOcrParams {
        &mut self.params
    }

    fn infer_into(&self, _: &mut (), image: &Image, list: &mut TextRegionList) -> Result<()> {
        let Scratch { regions, boxes, input, readings } = &mut *self.scratch.take();
        let view = image.view();
        self.detect(view, regions, boxes)?;
        let data = if boxes.is_empty() { Cow::Borrowed(&[][..]) } else { rgb_bytes(view) };
        let (width, height) = (view.width(), view.height());
        let pixels = RgbPixels { data: &data, width, height, stride: 3 * width };
        let mut count = 0;
        for found in boxes.iter_mut().take(self.params.max_regions) {
            let confidence = self.read(&pixels, &mut found.corners, input, readings)?;
            if readings.text.is_empty() || confidence < self.params.threshold {
                continue;
            }
            if list.regions.len() == count {
                list.regions.push(TextRegion::default());
            }
            let region = &mut list.regions[count];
            region.text.clone_from(&readings.text);
            (region.corners, region.confidence) = (found.corners, confidence);
            count += 1;
        }
        list.regions.truncate(count);
        Ok(())
    }
}

impl PpOcr {
    /// Writes the regions of text in reading order, in pixels of the image.
    fn detect(&self, image: ImageView<'_>, regions: &mut Regions, boxes: &mut Vec<TextBox>) -> Result<()> {
        let PpOcrParams { map_threshold, region_threshold, unclip_ratio, .. } = self.params;
        let params = RegionParams {
            threshold: map_threshold,
            box_threshold: region_threshold,
            unclip_ratio,
            ..RegionParams::default()
        };
        let size = [image.width(), image.height()];
        self.detector.run_sized(image, input_size(size, self.params.max_side), |outputs, _| {
            let shape = outputs.first().map(|map| (map, map.shape()));
            let Some((map, &[1, 1, rows, columns])) = shape else {
                return Err(Error::format(format!(
                    "{DETECTION} should have a map [1, 1, height, width] as output, not {:?}; load another model",
                    outputs.first().map(|map| map.shape())
                )));
            };
            regions.find(map.values()?, columns, rows, &params, boxes);
            let scale = [size[0] as f32 / columns as f32, size[1] as f32 / rows as f32];
            for corner in boxes.iter_mut().flat_map(|found| &mut found.corners) {
                *corner = [(corner[0] + 0.5) * scale[0], (corner[1] + 0.5) * scale[1]];
            }
            Ok(())
        })?;
        sort_reading_order(boxes, SAME_LINE, |found| found.corners[0]);
        Ok(())
    }

    /// Reads the text in a quadrilateral of the image into `readings.text`, and returns its score. The corners begin at the top left of the
    /// text afterwards. A region that cannot be rectified has an empty text.
    fn read(
        &self,
        image: &RgbPixels<'_>,
        corners: &mut [[f32; 2]; 4],
        input: &mut Vec<f32>,
        readings: &mut Readings,
    ) -> Result<f32> {
        let mut region = Quadrilateral { corners: *corners, upside_down: false };
        if let Some(orientation) = self.orientation.as_ref().filter(|_| self.params.turn) {
            let [height, width] = ORIENTATION_SIZE;
            let mut turned = 0.0;
            run(
                orientation,
                image,
                &region,
                InputShape { height, width, condense: 1.0 },
                input,
                |output, _| {
                    turned = output.get(1).copied().unwrap_or_default();
                    Ok(())
                },
            )?;
            region.upside_down = turned > UPSIDE_DOWN;
        }
        *corners = region.reading_corners();
        let tight = self.recognise(image, &region, 1.0, input, &mut readings.text)?;
        if !self.params.read_twice {
            return Ok(tight);
        }
        let loose = self.recognise(image, &region.grown(MARGIN), CONDENSE, input, &mut readings.loose)?;
        Ok(readings.merge(tight, loose))
    }

    /// Reads the text in a quadrilateral whose width is changed by `condense`, and returns its score.
    fn recognise(
        &self,
        image: &RgbPixels<'_>,
        region: &Quadrilateral,
        condense: f64,
        input: &mut Vec<f32>,
        text: &mut String,
    ) -> Result<f32> {
        text.clear();
        let Some(width) = region.scaled_width(self.height, condense) else { return Ok(0.0) };
        let width = width.next_multiple_of(STRIDE).clamp(MIN_ASPECT * self.height, MAX_ASPECT * self.height);
        let mut confidence = 0.0;
        let shape = InputShape { height: self.height, width, condense };
        run(&self.recogniser, image, region, shape, input, |probabilities, classes| {
            confidence = self.characters.decode(probabilities, classes, text)?;
            Ok(())
        })?;
        Ok(confidence)
    }
}

impl Readings {
    /// Merges two readings of a line into `text`, and returns the score: readings that differ in spaces and case only have the letters of
    /// the tight one and the spaces of the one with more of them; of others the one with the higher score is kept.
    fn merge(&mut self, tight: f32, loose: f32) -> f32 {
        let Self { text, loose: other, merged } = self;
        let letters =
            |text: &str| text.chars().filter(|letter| *letter != ' ').collect::<SmallVec<[char; 64]>>();
        let [own, others] = [letters(text), letters(other)];
        let is_same = own.len() == others.len()
            && own.iter().zip(&others).all(|(a, b)| a.to_lowercase().eq(b.to_lowercase()));
        if !is_same {
            if loose > tight {
                std::mem::swap(text, other);
            }
            return tight.max(loose);
        }
        let spaces = |text: &str| text.bytes().filter(|byte| *byte == b' ').count();
        if spaces(other) > spaces(text) {
            merged.clear();
            let mut own = own.iter();
            merged.extend(
                other.chars().filter_map(
                    |letter| {
                        if letter == ' ' { Some(' ') } else { own.next().copied() }
                    },
                ),
            );
            std::mem::swap(text, merged);
        }
        tight
    }
}

/// Runs a network on a rectified region; `sink` receives the first output and the length of its last axis. Nothing is run for a region that
/// cannot be rectified.
fn run(
    session: &Session,
    image: &RgbPixels<'_>,
    region: &Quadrilateral,
    shape: InputShape,
    input: &mut Vec<f32>,
    mut sink: impl FnMut(&[f32], usize) -> Result<()>,
) -> Result<()> {
    let dims = [1, 3, shape.height, shape.width];
    input.resize(dims.iter().product(), 0.0);
    if rectify(image, region, shape, input).is_none() {
        return Ok(());
    }
    session.run(&[TensorView::new(&dims, &input[..])?], |outputs| {
        let output = outputs.first().ok_or_else(|| Error::format("a network of the model has no output"))?;
        sink(output.values()?, output.shape().last().copied().unwrap_or_default())
    })
}

/// Returns the size of the detector's input: the image's, scaled down to `max_side`, in multiples of [`STRIDE`].
fn input_size([width, height]: [usize; 2], max_side: usize) -> [usize; 2] {
    let scale = (max_side as f64 / width.max(height) as f64).min(1.0);
    [width, height].map(|side| {
        let strides = (side as f64 * scale / STRIDE as f64).round() as usize;
        STRIDE * strides.clamp(1, max_side.div_ceil(STRIDE))
    })
}

/// Returns the pixels as RGB bytes without gaps; borrowed from an image that is stored so.
fn rgb_bytes(image: ImageView<'_>) -> Cow<'_, [u8]> {
    let length = 3 * image.width() * image.height();
    match image.samples() {
        Samples::U8(samples)
            if image.format() == PixelFormat::Rgb
                && image.strides() == [3 * image.width(), 3, 1]
                && samples.len() >= length =>
        {
            Cow::Borrowed(&samples[..length])
        }
        _ => Cow::Owned(image.hwc_u8(PixelFormat::Rgb)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn merged(tight: (&str, f32), loose: (&str, f32)) -> (String, f32) {
        let mut readings =
            Readings { text: tight.0.to_owned(), loose: loose.0.to_owned(), ..Readings::default() };
        let confidence = readings.merge(tight.1, loose.1);
        (readings.text, confidence)
    }

    #[test]
    fn readings_are_merged() {
        let result = |text: &str, confidence: f32| (text.to_owned(), confidence);
        assert_eq!(merged(("NOPARKING", 0.9), ("no parking", 0.7)), result("NO PARKING", 0.9));
        assert_eq!(merged(("Lift 3", 0.9), ("Lift3", 0.95)), result("Lift 3", 0.9));
        assert_eq!(merged(("10", 1.0), ("HO", 0.6)), result("10", 1.0));
        assert_eq!(merged(("c", 0.2), ("cero", 0.6)), result("cero", 0.6));
        assert_eq!(merged(("", 0.0), ("", 0.0)), result("", 0.0));
        assert_eq!(merged(("ab", 0.5), (" a  b ", 0.5)), result(" a  b ", 0.5));
    }

    #[test]
    fn the_detector_has_inputs_of_whole_strides() {
        assert_eq!(input_size([1920, 1080], 960), [960, 544]);
        assert_eq!(input_size([640, 480], 960), [640, 480]);
        assert_eq!(input_size([1, 1], 960), [32, 32]);
        assert_eq!(input_size([100_000, 10], 960), [960, 32]);
        assert_eq!(input_size([500, 500], 100), [96, 96]);
        assert_eq!(input_size([960, 955], 959), [960, 960]);
    }
}
