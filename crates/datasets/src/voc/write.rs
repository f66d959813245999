//! Writer of boxes, or semantic masks, as Pascal VOC.

use std::fmt::Write;
use std::fs::OpenOptions;
use std::io::Write as _;
use std::path::Path;

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::target::{BoundingBoxList, Rle, Segmentation};
use opendr_engine::{Error, Progress, Result, ResultExt, Value};

use crate::class_table::ClassTable;
use crate::folder::write_file;
use crate::label_png::{LabelMap, save_labels};
use crate::picture_files::{PictureWriter, Placed, split_name, write_each};
use crate::{Problems, WriteOptions};

/// Writes `JPEGImages`, and `Annotations` with `ImageSets/Main`, or `SegmentationClass` with `ImageSets/Segmentation`.
///
/// Only RLE masks are written (to `SegmentationObject`), polygons are not. Crowds are written as difficult objects.
pub(super) fn write(
    dataset: &dyn DatasetIterator,
    path: &Path,
    options: &WriteOptions,
    problems: &Problems,
    progress: &dyn Progress,
) -> Result<()> {
    let split = split_name(options)?;
    let pictures = PictureWriter::new(dataset, path.join("JPEGImages"), options)?;
    let mut classes = ClassTable::new(&dataset.classes());
    let (mut boxes, mut masks) = (String::new(), String::new());
    write_each(dataset, problems, progress, |index| {
        let target = dataset.target(index)?;
        match target.as_ref() {
            Some(Value::Heatmap(_)) => {
                let map = LabelMap::from_target(target.as_ref())?;
                let Placed { name, size } = pictures.place(index)?;
                let stem = stem_of(&name);
                save_labels(&map.of_size(size)?, &path.join(format!("SegmentationClass/{stem}.png")), true)?;
                let _ = writeln!(masks, "{stem}");
            }
            Some(Value::BoundingBoxList(list)) => {
                let labels = list.boxes.iter().map(|found| {
                    let number = classes.number(&found.name, &list.classes)?;
                    Ok(classes.names()[number].clone())
                });
                let labels = labels.collect::<Result<Vec<_>>>()?;
                let placed = pictures.place(index)?;
                let stem = stem_of(&placed.name);
                let xml = xml_from_boxes(list, &labels, &placed, path);
                write_file(&path.join(format!("Annotations/{stem}.xml")), xml.as_bytes())?;
                if let Some(map) = object_map(list, placed.size)? {
                    save_labels(&map, &path.join(format!("SegmentationObject/{stem}.png")), true)?;
                }
                let _ = writeln!(boxes, "{stem}");
            }
            other => {
                let found = other.map_or("nothing", |target| target.as_value_ref().value_type().name());
                return Err(Error::invalid_input(format!(
                    "VOC supports boxes or semantic masks, not {found}"
                )));
            }
        }
        Ok(())
    })?;
    for (kind, list) in [("Main", boxes), ("Segmentation", masks)] {
        if !list.is_empty() {
            append(&path.join("ImageSets").join(kind).join(format!("{split}.txt")), &list)?;
        }
    }
    Ok(())
}

fn append(path: &Path, text: &str) -> Result<()> {
    let write = || {
        std::fs::create_dir_all(path.parent().unwrap_or(Path::new("")))?;
        OpenOptions::new().create(true).append(true).open(path)?.write_all(text.as_bytes())
    };
    write().context(|| format!("writing {}", path.display()))
}

fn stem_of(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

fn xml_from_boxes(
    list: &BoundingBoxList,
    labels: &[String],
    Placed { name, size }: &Placed,
    path: &Path,
) -> String {
    let folder = path.file_name().unwrap_or_default().to_string_lossy();
    let [width, height] = size;
    let mut xml = format!(
        "<annotation>\n  <folder>{}</folder>\n  <filename>{}</filename>\n  <size><width>{width}</width><height>{height}\
         </height><depth>3</depth></size>\n  <segmented>0</segmented>\n",
        escaped(&folder),
        escaped(name)
    );
    for (found, label) in list.boxes.iter().zip(labels) {
        let difficult = u8::from(found.segment.as_deref().is_some_and(|segment| segment.iscrowd));
        // Corners are pixel indices from 1, and both are inside the box.
        let [x0, y0, x1, y1] = found.corners();
        let _ = writeln!(
            xml,
            "  <object>\n    <name>{}</name>\n    <pose>Unspecified</pose>\n    <truncated>0</truncated>\n    \
             <difficult>{difficult}</difficult>\n    <bndbox><xmin>{}</xmin><ymin>{}</ymin><xmax>{x1}</xmax><ymax>{y1}\
             </ymax></bndbox>\n  </object>",
            escaped(label),
            x0 + 1.0,
            y0 + 1.0
        );
    }
    xml.push_str("</annotation>\n");
    xml
}

fn escaped(text: &str) -> String {
    let text = text.replace(|c: char| c.is_control(), " ");
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Returns the map of object masks, if all objects have RLE masks.
fn object_map(list: &BoundingBoxList, [width, height]: [u32; 2]) -> Result<Option<LabelMap>> {
    let rle = |at: usize| match list.boxes[at].segment.as_deref().map(|segment| &segment.segmentation) {
        Some(Segmentation::Rle(rle)) if rle.size() == [height, width] => Some(rle),
        _ => None,
    };
    let rles: Option<Vec<&Rle>> = (0..list.boxes.len()).map(rle).collect();
    let Some(rles) = rles.filter(|rles| (1..255).contains(&rles.len())) else { return Ok(None) };
    let mut labels = vec![0; width as usize * height as usize];
    for (number, rle) in (1..).zip(rles) {
        for (label, inside) in labels.iter_mut().zip(rle.mask()?) {
            *label = if inside { number } else { *label };
        }
    }
    Ok(Some(LabelMap { size: [width, height], labels }))
}
