//! WIDER FACE: a text file with each image's name and faces.

use std::fmt::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes, Segment};
use opendr_engine::{Error, Progress, Result, Value, ValueType};

use crate::fields::Fields;
use crate::folder::{part_folder, past_end, path_inside, read_text, write_file};
use crate::picture_files::{PictureWriter, split_name, write_each};
use crate::{Format, OpenOptions, Problem, Problems, Recognition, WriteOptions};

const SPLITS: [&str; 3] = ["val", "test", "train"];

/// A WIDER FACE data set. Faces that are marked as invalid, or have no size, are crowds, which metrics ignore.
#[derive(Debug)]
pub struct WiderFace {
    pictures: PathBuf,
    /// Path of each image and the range of its faces.
    samples: Vec<(String, Range<usize>)>,
    faces: Vec<Face>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Face {
    /// Left, top, width and height in pixels.
    place: [f32; 4],
    ignored: bool,
}

fn list_of(path: &Path, split: &str) -> PathBuf {
    path.join("wider_face_split").join(format!("wider_face_{split}_bbx_gt.txt"))
}

/// Parses `left top width height [blur expression illumination invalid occlusion pose]`.
fn face_from_line(line: &str) -> Result<Face, String> {
    let fields = Fields::of(line);
    fields.expect(4..=10)?;
    let place: [f32; 4] = fields.numbers(0)?;
    if place[2] < 0.0 || place[3] < 0.0 {
        return Err(format!("has a face of {} x {} pixels; sizes must be positive", place[2], place[3]));
    }
    let invalid = fields.len() > 7 && fields.whole(7)? != 0;
    Ok(Face { place, ignored: invalid || place[2] == 0.0 || place[3] == 0.0 })
}

impl WiderFace {
    fn read(pictures: PathBuf, list: &Path, problems: &Problems) -> Result<Self> {
        let text = read_text(list)?;
        let mut lines = (1..).zip(text.lines().map(str::trim)).filter(|(_, line)| !line.is_empty());
        let (mut samples, mut faces) = (Vec::new(), Vec::new());
        while let Some((number, name)) = lines.next() {
            let report = |line, message: String| problems.report(Problem::at_line(list, line, message));
            let counted = lines.next().and_then(|(line, text)| Some((line, text.parse::<usize>().ok()?)));
            let Some((line, count)) = counted else {
                // The start of the next image is unknown.
                let message =
                    format!("no number of faces after {name:.80?}; the rest of the file is skipped");
                report(number + 1, message)?;
                break;
            };
            let (start, mut broken) = (faces.len(), None);
            // An image without faces has a line of zeros.
            for at in 0..count.max(1) {
                let Some((line, text)) = lines.next() else {
                    broken = Some((line, format!("the file ends after {at} of {count} faces")));
                    break;
                };
                match face_from_line(text) {
                    Ok(face) if count > 0 => faces.push(face),
                    Ok(_) => {}
                    Err(message) => broken = broken.or(Some((line, message))),
                }
            }
            let broken =
                broken.or_else(|| path_inside(&pictures, name).err().map(|message| (number, message)));
            if let Some((line, message)) = broken {
                faces.truncate(start);
                report(line, message)?;
                continue;
            }
            samples.push((name.to_owned(), start..faces.len()));
        }
        Ok(Self { pictures, samples, faces })
    }

    fn sample(&self, index: usize) -> Result<&(String, Range<usize>)> {
        self.samples.get(index).ok_or_else(|| past_end(index, self.samples.len()))
    }
}

impl Dataset for WiderFace {}

impl DatasetIterator for WiderFace {
    fn len(&self) -> usize {
        self.samples.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let image = opendr_vision::open(self.pictures.join(&self.sample(index)?.0))?;
        Ok(Sample { data: vec![image.into()], target: self.target(index)? })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        let (_, faces) = self.sample(index)?;
        let boxes =
            self.faces[faces.clone()].iter().map(|Face { place: [left, top, width, height], ignored }| {
                let crowd =
                    || Box::new(Segment { area: width * height, iscrowd: true, ..Segment::default() });
                BoundingBox {
                    segment: ignored.then(crowd),
                    ..BoundingBox::new(0, *left, *top, *width, *height, 1.0)
                }
            });
        let boxes = BoundingBoxList::from(boxes.collect::<Vec<_>>());
        Ok(Some(BoundingBoxList { classes: self.classes(), ..boxes }.into()))
    }

    fn name(&self, index: usize) -> String {
        self.sample(index).map_or_else(|_| index.to_string(), |(name, _)| name.clone())
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.sample(index).ok().map(|(name, _)| self.pictures.join(name))
    }

    fn classes(&self) -> Classes {
        ["face"].into_iter().collect()
    }
}

impl Format for WiderFace {
    const NAME: &'static str = "wider_face";
    const ALIASES: &'static [&'static str] = &["wider", "widerface"];
    const ABOUT: &'static str = "WIDER FACE: boxes of faces, invalid ones as crowds";
    const LAYOUT: &'static str = "wider_face_split/wider_face_val_bbx_gt.txt, WIDER_val/images/*/*.jpg";
    const TARGETS: &'static [ValueType] = &[ValueType::BoundingBoxList];

    fn recognise(path: &Path) -> Recognition {
        match SPLITS.iter().any(|split| list_of(path, split).is_file()) {
            true => Recognition::Certain,
            false => Recognition::No("wider_face_split/wider_face_val_bbx_gt.txt (or train)".into()),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let there = SPLITS.iter().copied().find(|split| list_of(path, split).is_file());
        let split = options.split.as_deref().or(there).unwrap_or("val");
        let list = list_of(path, split);
        if path_inside(path, split).is_err() || !list.is_file() {
            return Err(Error::not_found(format!(
                "the list of faces {} is missing; download wider_face_split.zip",
                list.display()
            )));
        }
        let folder = part_folder(path, None, &[&format!("WIDER_{split}/images"), "images"])?;
        Self::read(folder.unwrap_or_else(|| path.join(format!("WIDER_{split}/images"))), &list, problems)
    }

    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        let split = split_name(options)?;
        let folder = path.join(format!("WIDER_{split}/images"));
        let (pictures, mut text) = (PictureWriter::new(dataset, folder, options)?, String::new());
        write_each(dataset, problems, progress, |index| {
            let Some(Value::BoundingBoxList(list)) = dataset.target(index)? else {
                return Err(Error::invalid_input("WIDER FACE supports boxes, no other targets"));
            };
            let placed = pictures.place(index)?;
            let _ = writeln!(text, "{}\n{}", placed.name, list.boxes.len());
            for found in &list.boxes {
                let BoundingBox { left, top, width, height, .. } = found;
                let invalid = u8::from(found.segment.as_deref().is_some_and(|segment| segment.iscrowd));
                let _ = writeln!(text, "{left} {top} {width} {height} 0 0 0 {invalid} 0 0");
            }
            if list.boxes.is_empty() {
                text.push_str("0 0 0 0 0 0 0 0 0 0\n");
            }
            Ok(())
        })?;
        write_file(&list_of(path, split), text.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::Silent;
    use proptest::prelude::*;

    use super::*;
    use crate::folder::TemporaryFolder;

    const TEXT: &str = "0--Parade/a.png\n3\n1 2 3 4 2 0 0 0 2 0 \n5 6 7 8 0 0 0 1 0 0 \n5 6 0 8 0 0 0 0 0 0 \n\
                        0--Parade/b.png\n0\n0 0 0 0 0 0 0 0 0 0 \n1--Dance/c.png\n1\n0 0 9 9 0 0 0 0 0 0 \n";

    fn small(text: &str) -> TemporaryFolder {
        let folder = TemporaryFolder::new();
        folder.write("wider_face_split/wider_face_val_bbx_gt.txt", text);
        for name in ["0--Parade/a.png", "0--Parade/b.png", "1--Dance/c.png"] {
            folder.picture(&format!("WIDER_val/images/{name}"), 20, 20);
        }
        folder
    }

    fn open(path: &Path, problems: &Problems) -> Result<WiderFace> {
        WiderFace::open(path, &OpenOptions::default(), problems)
    }

    fn boxes(dataset: &WiderFace, at: usize) -> Vec<BoundingBox> {
        match dataset.target(at).unwrap() {
            Some(Value::BoundingBoxList(list)) => list.boxes,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn images_have_their_faces() {
        let (folder, other) = (small(TEXT), TemporaryFolder::new());
        let dataset = open(folder.path(), &Problems::strict()).unwrap();
        assert_eq!((dataset.len(), dataset.name(2)), (3, "1--Dance/c.png".into()));
        let counts: Vec<_> = (0..3).map(|at| boxes(&dataset, at).len()).collect();
        assert_eq!(counts, [3, 0, 1]);
        let ignored: Vec<_> = boxes(&dataset, 0).iter().map(|found| found.segment.is_some()).collect();
        assert_eq!(ignored, [false, true, true]);
        assert_eq!(boxes(&dataset, 0)[0], BoundingBox::new(0, 1.0, 2.0, 3.0, 4.0, 1.0));
        let options = WriteOptions { split: Some("val".into()), link: false };
        WiderFace::write(&dataset, other.path(), &options, &Problems::strict(), &Silent).unwrap();
        let again = open(other.path(), &Problems::strict()).unwrap();
        (0..3).for_each(|at| assert_eq!(again.get(at).unwrap(), dataset.get(at).unwrap()));
    }

    #[test]
    fn broken_lines_are_reported_and_skipped() {
        let text = TEXT.replace("5 6 7 8", "5 6 NaN 8").replace("1--Dance/c", "../../c");
        let folder = small(&text);
        assert!(
            open(folder.path(), &Problems::strict())
                .unwrap_err()
                .to_string()
                .contains("gt.txt:4: has \"NaN\"")
        );
        let problems = Problems::skipping();
        let dataset = open(folder.path(), &problems).unwrap();
        assert_eq!((dataset.len(), problems.count()), (1, 2));
        let error = |text: &str| open(small(text).path(), &Problems::strict()).unwrap_err().to_string();
        assert!(error("a.png\nb.png\n").contains(":2: no number of faces"));
        assert!(error("a.png\n2\n1 2 3 4\n").contains("ends after 1 of 2 faces"));
        assert!(error("a.png\n18446744073709551615\n1 2 3 4\n").contains("ends after 1"));
        assert!(error("a.png\n1\n1 2 -3 4\n").contains("-3 x 4 pixels"));
    }

    proptest! {
        #[test]
        fn mutated_lists_are_refused_or_read(at in 0usize..200, bytes in "[ -9\n]{0,4}", cut in 0usize..4) {
            let start = at % TEXT.len();
            let text = format!("{}{bytes}{}", &TEXT[..start], &TEXT[(start + cut).min(TEXT.len())..]);
            let folder = TemporaryFolder::new();
            let list = folder.write("list.txt", &text);
            let _ = WiderFace::read(folder.path().to_owned(), &list, &Problems::strict());
            let dataset = WiderFace::read(folder.path().to_owned(), &list, &Problems::skipping()).unwrap();
            (0..dataset.len()).for_each(|at| drop(boxes(&dataset, at)));
        }
    }
}
