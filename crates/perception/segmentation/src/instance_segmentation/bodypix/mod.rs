//! BodyPix: instance segmentation of persons.
//!
//! Papandreou et al., PersonLab, ECCV 2018; MobileNetV1 with half the channels, Google, Apache-2.0. One map separates persons
//! from the background; poses, decoded as those of PoseNet, distinguish the persons, and each pixel is assigned to the person
//! whose joints its long offsets point at.

mod long_offsets;

use opendr_engine::data::{Image, Layout};
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Classes, Name};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::TensorView;
use opendr_perception_common::image_network::ImageNetwork;
use opendr_perception_common::part_tree::{PartMaps, PartTree, Peak, Person};
use opendr_vision::{InputGeometry, Preprocess};

use super::OwnerMap;
use long_offsets::LongOffsets;

/// Parameters of [`BodyPix`].
#[derive(Debug, Clone, Params)]
pub struct BodyPixParams {
    /// Minimum score of a person.
    #[param(default = 0.2, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Minimum score of a pixel of a person.
    #[param(default = 0.5, range = 0.01..=0.99, live)]
    pub mask_threshold: f32,
    /// Minimum score of a joint from which a person is decoded.
    #[param(default = 0.4, range = 0.01..=0.99, live)]
    pub peak_threshold: f32,
    /// Radius within which joints of one kind belong to one person, in pixels of the network's input.
    #[param(default = 30.0, range = 0.0..=200.0, unit = "px", live)]
    pub nms_radius: f32,
    /// Maximum number of persons per image.
    #[param(default = 20, range = 1..=100, live)]
    pub max_detections: usize,
    /// Longer side of the network's input. A larger one detects smaller persons.
    #[param(default = 513, range = 65..=1537, unit = "px", live)]
    pub resolution: usize,
}

/// A loaded BodyPix.
pub struct BodyPix {
    params: BodyPixParams,
    classes: Classes,
    network: ImageNetwork,
    /// Indices of the outputs: segments, heatmaps, short offsets, both displacements, long offsets.
    outputs: [usize; 6],
    work: Pool<Work>,
}

#[derive(Default)]
struct Work {
    /// Maps with the channel as first axis, the layout of the pose decoder.
    planes: [Vec<f32>; 4],
    peaks: Vec<Peak>,
    persons: Vec<Person>,
    /// Owner of each square of [`GRAIN`] pixels of the input; 0 for none.
    squares: Vec<u8>,
    across: Vec<Across>,
    owners: OwnerMap,
}

/// Position of an image column on the network's cells.
#[derive(Debug, Clone, Copy)]
struct Across {
    cell: usize,
    next: usize,
    /// Distance to the next cell, as a share.
    share: f32,
    square: usize,
}

/// Distance of the network's cells in pixels of its input.
const STRIDE: usize = 16;
/// Side of the squares of input pixels that are assigned to one person.
const GRAIN: usize = 4;
/// Outputs of the network, and their number of channels.
const OUTPUTS: [(&str, usize); 6] = [
    ("segments", 1),
    ("heatmaps", 17),
    ("short_offsets", 34),
    ("displacement_fwd", 32),
    ("displacement_bwd", 32),
    ("long_offsets", 34),
];

impl Learner for BodyPix {
    const SPEC: Spec = Spec::new("bodypix", Task::InstanceSegmentation)
        .class("BodyPixLearner")
        .about("BodyPix detects persons with a mask each.");
    type Params = BodyPixParams;
    type Input<'a> = &'a Image;
    type Target = BoundingBoxList;
    type State = ();

    fn load(model: &Model, params: BodyPixParams, device: Device) -> Result<Self> {
        let network = ImageNetwork::open(model, device, |_| {
            Preprocess::new(STRIDE + 1, STRIDE + 1).layout(Layout::Hwc).normalise([127.5; 3], [127.5; 3])
        })?;
        let mut outputs = [0; 6];
        for (output, (name, _)) in outputs.iter_mut().zip(OUTPUTS) {
            *output = network.output(name)?;
        }
        Ok(Self { params, classes: model.classes().clone(), network, outputs, work: Pool::default() })
    }

    fn params(&self) -> &BodyPixParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut BodyPixParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, found: &mut BoundingBoxList) -> Result<()> {
        found.classes.clone_from(&self.classes);
        found.boxes.clear();
        self.segment(image, |owners, persons| {
            for (number, person) in (1..).zip(persons) {
                let score = person.score.min(1.0);
                found.boxes.extend(owners.bounding_box(number, Name::Index(0), score)?);
            }
            found.boxes.sort_by(|one, other| other.confidence.total_cmp(&one.confidence));
            Ok(())
        })?
    }
}

impl BodyPix {
    /// Detects the persons in an image and passes them to `each`, with the map from pixels to persons, where the first person
    /// has the number 1. Returns the value of `each`.
    ///
    /// # Errors
    /// `Format` when the network returns maps of other sizes; the errors of the runtime.
    pub fn segment<T>(&self, image: &Image, each: impl FnOnce(&OwnerMap, &[Person]) -> T) -> Result<T> {
        let Work { planes, peaks, persons, squares, across, owners } = &mut *self.work.take();
        let params = &self.params;
        let size = [image.width(), image.height()];
        let tree = PartTree {
            peak_threshold: params.peak_threshold,
            radius: params.nms_radius,
            max_persons: params.max_detections,
        };
        self.network.run_sized(image.view(), input_size(size, params.resolution), |outputs, geometry| {
            let ([rows, columns], maps) = self.maps(outputs)?;
            let [segments, heatmaps, short_offsets, forward, backward, long_offsets] = maps;
            let by_cell = [(heatmaps, 17), (short_offsets, 34), (forward, 32), (backward, 32)];
            for (plane, (values, channels)) in planes.iter_mut().zip(by_cell) {
                split_channels(values, channels, plane);
            }
            let [heatmap, offsets, forward, backward] = &*planes;
            let stride = STRIDE as f32;
            tree.decode(
                &PartMaps { rows, columns, stride, heatmap, offsets, forward, backward },
                peaks,
                persons,
            );
            persons.retain(|person| person.score >= params.threshold);
            let grid = [rows, columns];
            let segments = Segments { grid, values: segments, bound: logit(params.mask_threshold) };
            let long_offsets = LongOffsets { grid, stride, values: long_offsets };
            segments.fill_squares(&long_offsets, persons, squares);
            segments.fill_owners(squares, size, geometry, across, owners);
            Ok(())
        })?;
        Ok(each(owners, persons))
    }

    /// Returns rows and columns of the network's cells, and its outputs.
    fn maps<'a>(&self, outputs: &[TensorView<'a>]) -> Result<([usize; 2], [&'a [f32]; 6])> {
        let [1, rows, columns, 1] = *outputs[self.outputs[0]].shape() else {
            let shape = outputs[self.outputs[0]].shape();
            return Err(Error::format(format!(
                "the output segments of BodyPix must be [1, rows, columns, 1], not {shape:?}"
            )));
        };
        let mut maps = [&[][..]; 6];
        for ((map, output), (name, channels)) in maps.iter_mut().zip(self.outputs).zip(OUTPUTS) {
            *map = outputs[output].values::<f32>()?;
            if rows * columns == 0 || map.len() != rows * columns * channels {
                return Err(Error::format(format!(
                    "the output {name} of BodyPix has {} values instead of {channels} for each of {rows}x{columns} cells",
                    map.len()
                )));
            }
        }
        Ok(([rows, columns], maps))
    }
}

/// Returns the size of the network's input: the image scaled to the given longer side, in whole cells plus a pixel.
fn input_size(size: [usize; 2], resolution: usize) -> [usize; 2] {
    let scale = resolution as f64 / size[0].max(size[1]) as f64;
    size.map(|side| {
        let cells = ((side as f64 * scale - 1.0) / STRIDE as f64).round().max(1.0);
        cells as usize * STRIDE + 1
    })
}

fn logit(score: f32) -> f32 {
    (score / (1.0 - score)).ln()
}

/// Transposes `[cells, channels]` to `[channels, cells]`.
fn split_channels(values: &[f32], channels: usize, out: &mut Vec<f32>) {
    out.clear();
    for channel in 0..channels {
        out.extend(values.iter().skip(channel).step_by(channels));
    }
}

/// Scores of the pixels of all persons.
struct Segments<'a> {
    /// Rows and columns of cells.
    grid: [usize; 2],
    /// Logits, row by row.
    values: &'a [f32],
    bound: f32,
}

impl Segments<'_> {
    /// Returns the number of squares in a row of cells.
    fn squares(cells: usize) -> usize {
        (cells - 1) * STRIDE / GRAIN + 1
    }

    /// Assigns an owner to each square near the pixels of a person.
    fn fill_squares(&self, offsets: &LongOffsets<'_>, persons: &[Person], squares: &mut Vec<u8>) {
        let [rows, columns] = self.grid.map(Self::squares);
        squares.clear();
        for row in 0..rows {
            for column in 0..columns {
                let place = [column * GRAIN, row * GRAIN];
                let owner = match self.is_near_person(place) {
                    true => offsets.owner(place.map(|at| at as f32), persons),
                    false => None,
                };
                squares.push(owner.map_or(0, |owner| owner as u8 + 1));
            }
        }
    }

    /// Whether a cell around the place belongs to a person; pixels between cells can only then.
    fn is_near_person(&self, [x, y]: [usize; 2]) -> bool {
        let near = |at: usize, count: usize| {
            (at.saturating_sub(GRAIN) / STRIDE).min(count - 1)
                ..=((at + GRAIN).div_ceil(STRIDE)).min(count - 1)
        };
        near(y, self.grid[0])
            .any(|row| near(x, self.grid[1]).any(|column| self.at([row, column]) >= self.bound))
    }

    fn fill_owners(
        &self,
        squares: &[u8],
        size: [usize; 2],
        geometry: &InputGeometry,
        columns_of: &mut Vec<Across>,
        owners: &mut OwnerMap,
    ) {
        let [rows, columns] = self.grid;
        let across = Self::squares(columns);
        // Cells and squares are at the pixel centres of the input.
        let middle = |x: usize, y: usize| {
            geometry.input_from_image([x as f32 + 0.5, y as f32 + 0.5]).map(|at| (at - 0.5).max(0.0))
        };
        let square =
            |at: f32, cells: usize| ((at / GRAIN as f32).round() as usize).min(Self::squares(cells) - 1);
        columns_of.clear();
        columns_of.extend((0..size[0]).map(|x| {
            let [input_x, _] = middle(x, 0);
            let (cell, share) = cell_of(input_x, columns);
            Across { cell, next: (cell + 1).min(columns - 1), share, square: square(input_x, columns) }
        }));
        owners.fill(size, |y, row| {
            let [_, input_y] = middle(0, y);
            let (upper, down) = cell_of(input_y, rows);
            let [upper, lower] =
                [upper, (upper + 1).min(rows - 1)].map(|row| &self.values[row * columns..][..columns]);
            if upper.iter().chain(lower).all(|value| *value < self.bound) {
                return;
            }
            let squares = &squares[square(input_y, rows) * across..][..across];
            for (owner, at) in row.iter_mut().zip(&*columns_of) {
                let along = |values: &[f32]| {
                    let (from, to) = (values[at.cell], values[at.next]);
                    from + at.share * (to - from)
                };
                let (upper, lower) = (along(upper), along(lower));
                if upper + down * (lower - upper) >= self.bound {
                    *owner = squares[at.square];
                }
            }
        });
    }

    fn at(&self, [row, column]: [usize; 2]) -> f32 {
        self.values[row * self.grid[1] + column]
    }
}

/// Returns the cell before a position, and the share of the distance to the next.
fn cell_of(at: f32, count: usize) -> (usize, f32) {
    let at = at / STRIDE as f32;
    let cell = (at as usize).min(count - 1);
    (cell, (at - cell as f32).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_are_whole_cells() {
        assert_eq!(input_size([810, 1080], 513), [385, 513]);
        assert_eq!(input_size([1, 5000], 513), [17, 513]);
        assert_eq!(input_size([1, 1], 65), [65, 65]);
    }

    #[test]
    fn channels_are_split() {
        let mut out = vec![9.0];
        split_channels(&[1.0, 10.0, 2.0, 20.0, 3.0, 30.0], 2, &mut out);
        assert_eq!(out, [1.0, 2.0, 3.0, 10.0, 20.0, 30.0]);
    }

    #[test]
    fn masks_are_interpolated_between_cells() {
        let values = [4.0, -4.0, -4.0, 4.0, -4.0, -4.0];
        let segments = Segments { grid: [2, 3], values: &values, bound: 0.0 };
        let geometry = InputGeometry { image_size: [33.0, 17.0], scale: [1.0; 2], offset: [0.0; 2] };
        let squares = vec![1; 5 * 9];
        let mut owners = OwnerMap::default();
        segments.fill_owners(&squares, [33, 17], &geometry, &mut Vec::new(), &mut owners);
        let row: Vec<_> = owners.owners()[..33].to_vec();
        assert!(
            row[..9].iter().all(|owner| *owner == 1) && row[9..].iter().all(|owner| *owner == 0),
            "{row:?}"
        );
        assert!(segments.is_near_person([12, 0]) && !segments.is_near_person([24, 8]));
    }
}
