//! Label file of a subject of HANDS.

use std::path::{Path, PathBuf};

use opendr_engine::Result;

use crate::fields::lines;
use crate::folder::{path_inside, read_text};
use crate::{Problem, Problems};

/// Text of a gesture that is not in the image.
const ABSENT: &str = "[0 0 0 0]";

/// Files of a sample, and its class.
#[derive(Debug, Clone)]
pub(super) struct Gesture {
    pub(super) colour: PathBuf,
    pub(super) depth: PathBuf,
    pub(super) class: String,
}

/// Reads the rows of `SubjectN.txt`: colour, depth, and for every gesture of the first line its box, or `[0 0 0
/// 0]`. Only the file name of a path is used, since HANDS has the folders of its authors. Missing files are
/// reported if `checked`.
pub(super) fn read(path: &Path, subject: &str, checked: bool, problems: &Problems) -> Result<Vec<Gesture>> {
    let folder = path.join(subject);
    let list = folder.join(format!("{subject}.txt"));
    let text = read_text(&list)?;
    let mut rows = lines(&text);
    let names: Vec<&str> =
        rows.next().map(|(_, line)| line.split(',').skip(2).map(str::trim).collect()).unwrap_or_default();
    let mut gestures = Vec::new();
    for (number, line) in rows {
        let gesture = row(&folder, subject, &names, line).and_then(|gesture| {
            let missing =
                [&gesture.colour, &gesture.depth].into_iter().find(|file| checked && !file.is_file());
            missing.map_or(Ok(()), |file| Err(format!("refers to {}, which is missing", file.display())))?;
            Ok(gesture)
        });
        match gesture {
            Ok(gesture) => gestures.push(gesture),
            Err(message) => problems.report(Problem::at_line(&list, number, message))?,
        }
    }
    Ok(gestures)
}

fn row(folder: &Path, subject: &str, names: &[&str], line: &str) -> Result<Gesture, String> {
    let fields: Vec<&str> = line.split(',').map(str::trim).collect();
    let [colour, depth, boxes @ ..] = fields.as_slice() else {
        return Err(format!("has {} fields instead of {}", fields.len(), names.len() + 2));
    };
    if boxes.len() != names.len() {
        return Err(format!("has {} boxes, but the first line has {} gestures", boxes.len(), names.len()));
    }
    let mut present = Vec::new();
    for (name, place) in names.iter().zip(boxes).filter(|(_, place)| **place != ABSENT) {
        let numbers = place.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
        let numbers: Option<Vec<f32>> = numbers.map(|numbers| {
            numbers
                .split_whitespace()
                .filter_map(|number| number.parse().ok())
                .filter(|n: &f32| n.is_finite())
                .collect()
        });
        if numbers.is_none_or(|numbers| numbers.len() != 4) {
            return Err(format!("has {place:.40?} as the box of {name}; write [left top width height]"));
        }
        present.push(*name);
    }
    if present.is_empty() {
        return Err("has no gesture; remove the line".to_owned());
    }
    let last = |name: &str| name.rsplit(['\\', '/']).next().unwrap_or_default().to_owned();
    Ok(Gesture {
        colour: path_inside(&folder.join(subject), &last(colour))?,
        depth: path_inside(&folder.join(format!("{subject}_Depth")), &last(depth).replace("color", "depth"))?,
        class: present.join("_AND_"),
    })
}
