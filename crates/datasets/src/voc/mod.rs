//! Pascal VOC: an XML file of boxes for each image, and masks as PNG files with a palette.

pub(crate) mod annotation;
mod layout;
#[cfg(test)]
mod tests;
mod write;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{
    BoundingBox, BoundingBoxList, Classes, Heatmap, Name, Rle, Segment, Segmentation,
};
use opendr_engine::{Error, Progress, Result, ResultExt, Value, ValueType};

use crate::folder::past_end;
use crate::label_png::{IGNORED, LabelMap, open_labels};
use crate::picture_files::open_picture;
use crate::{Format, OpenOptions, Problems, Recognition, WriteOptions};
use annotation::Annotation;
use layout::Layout;

/// Classes of the challenges; in masks, the background precedes them.
pub(crate) const CLASSES: [&str; 20] = [
    "aeroplane",
    "bicycle",
    "bird",
    "boat",
    "bottle",
    "bus",
    "car",
    "cat",
    "chair",
    "cow",
    "diningtable",
    "dog",
    "horse",
    "motorbike",
    "person",
    "pottedplant",
    "sheep",
    "sofa",
    "train",
    "tvmonitor",
];

/// A Pascal VOC data set: boxes (with masks from `SegmentationObject`; difficult ones are crowds), or semantic
/// masks (255 is ignored).
#[derive(Debug)]
pub struct Voc {
    layout: Layout,
    /// Samples by name, with the file name of their image.
    samples: Vec<(String, String)>,
    classes: Classes,
    target: ValueType,
}

impl Voc {
    fn sample(&self, index: usize) -> Result<&(String, String)> {
        self.samples.get(index).ok_or_else(|| past_end(index, self.samples.len()))
    }

    fn boxes(&self, index: usize) -> Result<(BoundingBoxList, [u32; 2])> {
        let (name, _) = self.sample(index)?;
        let mut annotation = self.layout.annotation(name)?;
        let classes = self.classes.clone();
        for found in &mut annotation.objects {
            let class = classes.label(&found.name).and_then(|name| classes.index(name));
            found.name = Name::Index(class.ok_or_else(|| {
                Error::format("the annotation was modified while it was in use: it has a new class")
            })?);
        }
        let mask = self.layout.mask("SegmentationObject", name);
        if mask.is_file() {
            let outlined = open_labels(&mask).and_then(|map| outline(&mut annotation.objects, &map));
            outlined.context(|| mask.display().to_string())?;
        }
        Ok((BoundingBoxList { classes, ..BoundingBoxList::from(annotation.objects) }, annotation.size))
    }

    fn map(&self, index: usize) -> Result<Heatmap> {
        let path = self.layout.mask("SegmentationClass", &self.sample(index)?.0);
        let count = self.classes.len() as u32;
        let known = |label: u32| (label < count || label == IGNORED).then_some(label);
        let map = open_labels(&path)?.mapped(known).and_then(|map| map.into_heatmap(self.classes.clone()));
        map.context(|| path.display().to_string())
    }
}

/// Sets the mask of each object: object `n` of the file has label `n + 1` in the mask image.
fn outline(objects: &mut [BoundingBox], map: &LabelMap) -> Result<()> {
    let [width, height] = map.size;
    for (number, found) in (1..).zip(objects) {
        let mask: Vec<bool> = map.labels.iter().map(|label| *label == number).collect();
        let rle = Rle::from_mask(&mask, height, width)?;
        if rle.area() > 0 {
            let iscrowd = found.segment.as_deref().is_some_and(|segment| segment.iscrowd);
            let area = rle.area() as f32;
            found.segment = Some(Box::new(Segment { segmentation: Segmentation::Rle(rle), area, iscrowd }));
        }
    }
    Ok(())
}

impl Dataset for Voc {}

impl DatasetIterator for Voc {
    fn len(&self) -> usize {
        self.samples.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let path = self.layout.pictures.join(&self.sample(index)?.1);
        let (target, size) = match self.target {
            ValueType::Heatmap => {
                let map = self.map(index)?;
                let size =
                    if let [height, width] = map.shape() { [*width as u32, *height as u32] } else { [0, 0] };
                (map.into(), size)
            }
            _ => {
                let (boxes, size) = self.boxes(index)?;
                (boxes.into(), size)
            }
        };
        Ok(Sample { data: vec![open_picture(&path, size)?.into()], target: Some(target) })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        Ok(Some(match self.target {
            ValueType::Heatmap => self.map(index)?.into(),
            _ => self.boxes(index)?.0.into(),
        }))
    }

    fn name(&self, index: usize) -> String {
        self.sample(index).map_or_else(|_| index.to_string(), |(_, file)| file.clone())
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.sample(index).ok().map(|(_, file)| self.layout.pictures.join(file))
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }
}

impl Format for Voc {
    const NAME: &'static str = "voc";
    const ALIASES: &'static [&'static str] = &["pascal_voc", "voc2007", "voc2012"];
    const ABOUT: &'static str = "Pascal VOC: boxes in XML files, masks of classes and objects";
    const LAYOUT: &'static str = "Annotations/*.xml, JPEGImages/*.jpg, ImageSets/Main/val.txt; for masks \
                                  SegmentationClass/*.png, SegmentationObject/*.png, ImageSets/Segmentation/val.txt";
    const TARGETS: &'static [ValueType] = &[ValueType::BoundingBoxList, ValueType::Heatmap];

    fn recognise(path: &Path) -> Recognition {
        layout::recognise(path)
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let layout = Layout::new(path)?;
        let target = match options.target {
            Some(target) => target,
            None if layout.has_annotations() => ValueType::BoundingBoxList,
            None => ValueType::Heatmap,
        };
        let masks = target == ValueType::Heatmap;
        let names = layout.names(options.split.as_deref(), masks, problems)?;
        let (mut samples, mut labels) = (Vec::with_capacity(names.len()), BTreeSet::new());
        for name in names {
            let annotation = match masks {
                true => Annotation::default(),
                false => match layout.annotation(&name) {
                    Ok(annotation) => annotation,
                    Err(problem) => {
                        problems.report(problem)?;
                        continue;
                    }
                },
            };
            labels.extend(annotation.objects.iter().map(|found| found.name.to_string()));
            match layout.picture(&name, annotation.filename.as_deref()) {
                Ok(file) => samples.push((name, file)),
                Err(problem) => problems.report(problem)?,
            }
        }
        let own = labels.iter().all(|label| CLASSES.contains(&label.as_str()));
        let classes: Classes = match (masks, own) {
            (true, _) => std::iter::once("background").chain(CLASSES).collect(),
            (false, true) => CLASSES.into_iter().collect(),
            (false, false) => labels.into_iter().collect(),
        };
        Ok(Self { layout, samples, classes, target })
    }

    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        write::write(dataset, path, options, problems, progress)
    }
}
