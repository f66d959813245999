//! Checks of a data set of any format: every sample is read once.

use opendr_engine::dataset::{DatasetIterator, Sample};
use opendr_engine::target::{BoundingBox, Name, PoseList};
use opendr_engine::{Progress, Result, Unit, Value, map_in_order};

use crate::problems::file_of;
use crate::{Problem, Problems};

/// Tolerated distance of an annotation beyond its image, in pixels: annotations of COCO itself exceed it by
/// fractions.
const MARGIN: f32 = 1.0;

/// Reads every sample on `threads` threads, with its data, and reports samples that cannot be read and invalid
/// annotations: not finite, outside of the image, of an unknown class.
///
/// # Errors
/// The first problem, unless `problems` skips them.
pub fn check(
    dataset: &dyn DatasetIterator,
    problems: &Problems,
    threads: usize,
    progress: &dyn Progress,
) -> Result<()> {
    let classes = dataset.classes().len();
    progress.begin("checking", Some(dataset.len() as u64), Unit::Items);
    let indices = (0..dataset.len()).take_while(|_| !progress.stopped());
    let mut workers = vec![(); threads.max(1)];
    let read = |(): &mut (), at: usize| {
        let faults = match dataset.get(at) {
            Ok(sample) => faults_of(&sample, classes),
            Err(error) => return vec![Problem::of(&error, dataset, at)],
        };
        let problem = |(key, message)| Problem::at_key(file_of(dataset, at), key, message);
        faults.into_iter().map(problem).collect()
    };
    let done = map_in_order(&mut workers, indices, read, |problems_of_sample: Vec<Problem>| {
        progress.advance(1);
        problems_of_sample.into_iter().try_for_each(|problem| problems.report(problem))
    });
    progress.end();
    done
}

type Faults = Vec<(String, String)>;

fn faults_of(sample: &Sample, classes: usize) -> Faults {
    let mut faults = Faults::new();
    let size = sample.data.iter().find_map(|datum| match datum {
        Value::Image(image) => Some([image.width() as f32, image.height() as f32]),
        _ => None,
    });
    let mut report = |key: String, message: Option<String>| {
        if let Some(message) = message {
            faults.push((key, message));
        }
    };
    match &sample.target {
        Some(Value::BoundingBoxList(list)) => {
            for (at, found) in list.boxes.iter().enumerate() {
                report(format!("box {at}"), wrong_box(found, size, classes));
            }
        }
        Some(Value::TrackingAnnotationList(list)) => {
            for (at, track) in list.annotations.iter().enumerate() {
                // A person who leaves the image is tracked whole.
                report(format!("track {at}"), wrong_box(&track.bounding_box, None, classes));
            }
        }
        Some(Value::PoseList(list)) => wrong_poses(list, size, &mut report),
        Some(Value::Category(category)) => {
            report("class".to_owned(), wrong_class(category.class, classes));
        }
        Some(Value::BoundingBox3DList(list)) => {
            for (at, found) in list.boxes.iter().enumerate() {
                let numbers = found.dimensions.iter().chain(&found.location).chain([&found.rotation_y]);
                let finite = numbers.copied().all(f32::is_finite);
                report(format!("box {at}"), (!finite).then(|| "a number is NaN or infinite".to_owned()));
            }
        }
        _ => {}
    }
    faults
}

fn wrong_box(found: &BoundingBox, size: Option<[f32; 2]>, classes: usize) -> Option<String> {
    let BoundingBox { left, top, width, height, .. } = found;
    let [x0, y0, x1, y1] = found.corners();
    if ![x0, y0, x1, y1].iter().all(|number| number.is_finite()) {
        return Some("a number is NaN or infinite".to_owned());
    }
    let text = format!("left {left} top {top} width {width} height {height}");
    if *width <= 0.0 || *height <= 0.0 {
        return Some(format!("the box has no size ({text})"));
    }
    if let Some([across, down]) = size
        && (x0 < -MARGIN || y0 < -MARGIN || x1 > across + MARGIN || y1 > down + MARGIN)
    {
        return Some(format!("the box exceeds its {across}x{down} image ({text})"));
    }
    match &found.name {
        Name::Index(index) => wrong_class(*index, classes),
        Name::Label(_) => None,
    }
}

fn wrong_class(class: i64, classes: usize) -> Option<String> {
    let known = classes == 0 || usize::try_from(class).is_ok_and(|class| class < classes);
    (!known).then(|| format!("class {class} is not within 0 to {}", classes - 1))
}

fn wrong_poses(list: &PoseList, size: Option<[f32; 2]>, report: &mut impl FnMut(String, Option<String>)) {
    for (at, pose) in list.poses.iter().enumerate() {
        for (joint, point) in pose.keypoints.iter().enumerate().filter(|(_, point)| point.is_detected()) {
            let outside = size.filter(|[across, down]| point.x > across + MARGIN || point.y > down + MARGIN);
            report(
                format!("person {at} joint {joint}"),
                outside.map(|[across, down]| format!("{point} exceeds the {across}x{down} image")),
            );
        }
    }
}
