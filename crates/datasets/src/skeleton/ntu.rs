//! NTU RGB+D: a text file for each recording.
//!
//! Source: A. Shahroudy et al., NTU RGB+D, CVPR 2016; J. Liu et al., NTU RGB+D 120, TPAMI 2019.

use std::path::{Path, PathBuf};

use opendr_engine::data::SkeletonSequence;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result};

use crate::fields::{Fields, lines};
use crate::folder::{files_in, has_extension, read_text};
use crate::{Problem, Problems};

const JOINTS: usize = 25;
/// Number of persons that are kept: those that move most, of all bodies that the sensor detected.
const PERSONS: usize = 2;
const MAX_FRAMES: usize = 100_000;
const MAX_BODIES: usize = 16;
/// Subjects of the training part; the next constant has its cameras.
const TRAINING_SUBJECTS: [u32; 53] = [
    1, 2, 4, 5, 8, 9, 13, 14, 15, 16, 17, 18, 19, 25, 27, 28, 31, 34, 35, 38, 45, 46, 47, 49, 50, 52, 53, 54,
    55, 56, 57, 58, 59, 70, 74, 78, 80, 81, 82, 83, 84, 85, 86, 89, 91, 92, 93, 94, 95, 97, 98, 100, 103,
];
const TRAINING_CAMERAS: [u32; 2] = [2, 3];
const CLASSES: u32 = 120;

/// A file of NTU RGB+D with the fields of its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NtuFile {
    path: PathBuf,
    camera: u32,
    subject: u32,
    action: u32,
}

impl NtuFile {
    /// Parses a name such as `S001C002P003R002A013.skeleton`.
    fn of(path: PathBuf, name: &str) -> Result<Self, String> {
        let number = |letter: char| {
            let digits = name.get(name.find(letter)? + 1..)?.get(..3)?;
            digits.parse().ok().filter(|_| digits.bytes().all(|byte| byte.is_ascii_digit()))
        };
        let numbers = || Some((number('C')?, number('P')?, number('A')?));
        let (camera, subject, action) =
            numbers().ok_or("its name is not of the form S001C001P001R001A001.skeleton; rename it")?;
        if action == 0 || action > CLASSES {
            return Err(format!("its name has action {action}; the actions are 1 to {CLASSES}"));
        }
        Ok(Self { path, camera, subject, action })
    }

    /// Returns the path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the class index, from 0.
    pub fn class(&self) -> i64 {
        i64::from(self.action) - 1
    }

    /// Returns the number of the acting person.
    pub fn subject(&self) -> u32 {
        self.subject
    }

    /// Returns the number of the camera.
    pub fn camera(&self) -> u32 {
        self.camera
    }
}

/// Returns the names of the files at `path`.
pub(super) fn files(path: &Path) -> Vec<String> {
    if path.is_dir() {
        return files_in(path, &["skeleton"]);
    }
    let name =
        path.file_name().and_then(|name| name.to_str()).filter(|name| has_extension(name, &["skeleton"]));
    name.filter(|_| path.is_file()).map(str::to_owned).into_iter().collect()
}

/// Returns the files of a part; files with invalid names are reported.
pub(super) fn part(
    path: &Path,
    names: Vec<String>,
    part: Option<&str>,
    problems: &Problems,
) -> Result<Vec<NtuFile>> {
    let (by_subject, training) = match part {
        None => (None, false),
        Some("xsub_train" | "train") => (Some(true), true),
        Some("xsub_val" | "val" | "test") => (Some(true), false),
        Some("xview_train") => (Some(false), true),
        Some("xview_val") => (Some(false), false),
        Some(other) => {
            let message =
                format!("no part {other:.40?}; there are xsub_train, xsub_val, xview_train, xview_val");
            return Err(Error::not_found(message));
        }
    };
    let mut files = Vec::with_capacity(names.len());
    for name in names {
        let at = if path.is_dir() { path.join(&name) } else { path.to_owned() };
        match NtuFile::of(at.clone(), &name) {
            Ok(file) => files.push(file),
            Err(message) => problems.report(Problem::new(at, message))?,
        }
    }
    files.retain(|file| match by_subject {
        None => true,
        Some(true) => TRAINING_SUBJECTS.contains(&file.subject) == training,
        Some(false) => TRAINING_CAMERAS.contains(&file.camera) == training,
    });
    Ok(files)
}

/// Returns the class names `A001` to `A120`, which are used if the data have none.
pub(super) fn classes() -> Classes {
    (1..=CLASSES).map(|action| format!("A{action:03}")).collect()
}

/// Reads the recording at `path`.
///
/// # Errors
/// `NotFound` or `Io` if it cannot be read; otherwise as [`skeleton_from_ntu`].
pub fn open_ntu(path: impl AsRef<Path>) -> Result<SkeletonSequence> {
    let path = path.as_ref();
    let wrong = |(line, message): (u64, String)| Problem::at_line(path, line, message).into();
    skeleton_from_ntu(&read_text(path)?).map_err(wrong)
}

/// A body: its id, and its joints in the frames in which it is detected.
struct Body {
    id: String,
    joints: Vec<(usize, [[f32; 3]; JOINTS])>,
}

impl Body {
    /// Returns the amount of motion: the variance of the joints, in square metres.
    fn motion(&self) -> f64 {
        let count = self.joints.len() as f64;
        let variance = |joint: usize, axis: usize| {
            let values = || self.joints.iter().map(|(_, joints)| f64::from(joints[joint][axis]));
            let mean = values().sum::<f64>() / count;
            values().map(|value| (value - mean).powi(2)).sum::<f64>() / count
        };
        (0..JOINTS)
            .flat_map(|joint| (0..3).map(move |axis| (joint, axis)))
            .map(|(joint, axis)| variance(joint, axis))
            .sum()
    }
}

/// Parses the text of a `.skeleton` file: `[1, 3, frames, 25, 2]` in metres. Of more than two bodies, those that
/// move most are kept; missing ones are 0.
///
/// # Errors
/// The line number and a message.
pub fn skeleton_from_ntu(text: &str) -> Result<SkeletonSequence, (u64, String)> {
    let mut lines = lines(text);
    let mut last = 0;
    let mut next = |fields: std::ops::RangeInclusive<usize>| {
        let (number, line) =
            lines.next().ok_or((last + 1, "the file is truncated here; download it again".to_owned()))?;
        last = number;
        let parsed = Fields::of(line);
        parsed.expect(fields).map_err(|message| (number, message))?;
        Ok::<_, (u64, String)>((number, parsed))
    };
    let count = |(number, fields): (u64, Fields<'_>), most: usize, what: &str| {
        let count = fields.whole(0).map_err(|message| (number, message))?;
        let count = usize::try_from(count).ok().filter(|count| *count <= most);
        count.map(|count| (number, count)).ok_or((number, format!("has an invalid number of {what}")))
    };
    let (number, frames) = count(next(1..=1)?, MAX_FRAMES, "frames")?;
    let mut bodies: Vec<Body> = Vec::new();
    for frame in 0..frames {
        let (_, body_count) = count(next(1..=1)?, MAX_BODIES, "bodies")?;
        for _ in 0..body_count {
            let (_, info) = next(1..=10)?;
            let id = info.text(0).unwrap_or_default().to_owned();
            let (at, joints) = count(next(1..=1)?, JOINTS, "joints")?;
            if joints != JOINTS {
                return Err((at, format!("has {joints} joints instead of {JOINTS}")));
            }
            let mut places = [[0.0; 3]; JOINTS];
            for place in &mut places {
                let (at, joint) = next(3..=12)?;
                *place = joint.numbers(0).map_err(|message| (at, message))?;
            }
            let known = bodies.iter().position(|body| body.id == id);
            let place = known.unwrap_or(bodies.len());
            if place == bodies.len() && place < MAX_BODIES {
                bodies.push(Body { id, joints: Vec::new() });
            }
            bodies.get_mut(place).into_iter().for_each(|body| body.joints.push((frame, places)));
        }
    }
    if bodies.is_empty() {
        return Err((number, "no frame has a body; remove the file".to_owned()));
    }
    bodies.sort_by(|a, b| b.motion().total_cmp(&a.motion()));
    let mut numbers = vec![0.0; 3 * frames * JOINTS * PERSONS];
    for (person, body) in bodies.iter().take(PERSONS).enumerate() {
        for (frame, joints) in &body.joints {
            for (joint, place) in joints.iter().enumerate() {
                for (axis, value) in place.iter().enumerate() {
                    numbers[((axis * frames + frame) * JOINTS + joint) * PERSONS + person] = *value;
                }
            }
        }
    }
    SkeletonSequence::new(numbers, [1, 3, frames, JOINTS, PERSONS])
        .map_err(|error| (number, error.to_string()))
}
