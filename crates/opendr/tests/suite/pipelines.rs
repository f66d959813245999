//! Pipelines with the models of the zoo.

use opendr::data::Image;
use opendr::learner::{AnyLearner, Entry, Outputs, Ports};
use opendr::skeleton_based_action_recognition::{SkeletonBuffer, SkeletonBufferOptions};
use opendr::target::{Name, Skeleton};
use opendr::{Device, ErrorKind, Pipeline, Value};

use crate::models::Models;

/// A loaded learner of the zoo.
fn learner(models: &Models, spec: &str) -> Option<(&'static Entry, Box<dyn AnyLearner>)> {
    let entry = opendr::registry().find(spec.split('/').next().unwrap()).unwrap();
    let mut learner = entry.make(&Default::default(), Device::Cpu).unwrap();
    learner.load(&models.get(spec)?).unwrap();
    Some((entry, learner))
}

fn picture(models: &Models, name: &str) -> Image {
    opendr::vision::open(models.data("photos").join(name)).unwrap()
}

fn black() -> Image {
    Image::from_rgb8(vec![0; 320 * 240 * 3], 320, 240).unwrap()
}

fn answers(pipeline: &mut Pipeline, image: &Image) -> Outputs {
    pipeline.infer(&Ports::one(image)).unwrap()
}

#[test]
fn poses_become_the_skeletons_that_a_network_looks_at() {
    let Some(models) = Models::find() else { return };
    let video = ["zidane.jpg", "t1.jpg", "zidane.jpg"].map(|name| picture(&models, name));
    for action in ["spatio_temporal_gcn", "co_st_gcn"] {
        let Some((pose, poses)) = learner(&models, "movenet/multipose") else { return };
        let Some((entry, actions)) = learner(&models, action) else { return };
        let mut pipeline =
            Pipeline::default().then(pose, poses.as_ref()).unwrap().then(entry, actions.as_ref()).unwrap();
        assert_eq!(pipeline.ports().iter().map(|port| port.name).collect::<Vec<_>>(), ["image"]);

        // By hand: the same network over a buffer of its own.
        let Some((_, mut poses)) = learner(&models, "movenet/multipose") else { return };
        let Some((_, mut actions)) = learner(&models, action) else { return };
        let frames = if action == "co_st_gcn" { 1 } else { 32 };
        let options =
            SkeletonBufferOptions { skeleton: Skeleton::Jhmdb15, frames, persons: 1, ..Default::default() };
        let mut buffer = SkeletonBuffer::new(options).unwrap();
        let mut first = None;
        for image in &video {
            let outputs = answers(&mut pipeline, image);
            let found = poses.infer(&Ports::one(image)).unwrap();
            let Some(Value::PoseList(list)) = found.first() else { panic!("{found}") };
            assert!(!list.poses.is_empty());
            buffer.push(list).unwrap();
            let sequence = buffer.together().unwrap().unwrap();
            let wanted = actions.infer(&Ports::one(&sequence)).unwrap();
            assert_eq!(outputs.get("category"), wanted.get("category"), "{action}");
            assert_eq!(outputs.get("poses"), found.first());
            first.get_or_insert(outputs);
        }
        pipeline.reset();
        assert_eq!(Some(answers(&mut pipeline, &video[0])), first);

        // Nobody, no action; in parallel as one after the other, and a stream that begins forgets the one before.
        pipeline.reset();
        let nobody = answers(&mut pipeline, &black());
        assert!(nobody.get("category").is_none() && nobody.get("poses").is_some());
        let mut predictions = Vec::new();
        let items = [&video[0], &video[1], &video[0]].into_iter().zip([true, false, true]);
        pipeline
            .run(
                items,
                |(_, begins)| *begins,
                |(image, _)| Ok(Ports::one(*image)),
                |_, outputs| outputs.map(|outputs| predictions.push(outputs)),
            )
            .unwrap();
        assert_eq!((Some(&predictions[0]), &predictions[2]), (first.as_ref(), &predictions[0]));
    }
}

#[test]
fn each_box_is_a_picture_of_its_own() {
    let Some(models) = Models::find() else { return };
    let Some((detector, faces)) = learner(&models, "yunet") else { return };
    let Some((entry, mut emotions)) = learner(&models, "facial_emotion") else { return };
    emotions.set("input_kind", "face".into()).unwrap();
    let pipeline = Pipeline::default().then(detector, faces.as_ref()).unwrap();
    let mut pipeline = pipeline.then_each(entry, emotions.as_ref()).unwrap();
    let astronaut = picture(&models, "astronaut.png");
    let outputs = answers(&mut pipeline, &astronaut);
    let Some(Value::BoundingBoxList(list)) = outputs.first() else { panic!("{outputs}") };
    let [face] = &list.boxes[..] else { panic!("{list:#}") };
    assert_eq!((outputs.iter().len(), &face.name), (1, &Name::from("happy")));
    let Some((_, mut alone)) = learner(&models, "yunet") else { return };
    let found = alone.infer(&Ports::one(&astronaut)).unwrap();
    let Some(Value::BoundingBoxList(found)) = found.first() else { panic!("{found}") };
    assert_eq!(face.corners(), found.boxes[0].corners());
    let group = answers(&mut pipeline, &picture(&models, "t1.jpg"));
    let Some(Value::BoundingBoxList(list)) = group.first() else { panic!("{group}") };
    assert_eq!(list.boxes.len(), 6);
    let none = answers(&mut pipeline, &black());
    let Some(Value::BoundingBoxList(list)) = none.first() else { panic!("{none}") };
    assert!(list.boxes.is_empty());

    // Poses lie in the whole picture.
    let Some((detector, persons)) = learner(&models, "centernet") else { return };
    let Some((entry, poses)) = learner(&models, "movenet") else { return };
    let mut pipeline = Pipeline::default()
        .then(detector, persons.as_ref())
        .unwrap()
        .then_each(entry, poses.as_ref())
        .unwrap();
    let outputs = answers(&mut pipeline, &picture(&models, "zidane.jpg"));
    let (Some(Value::PoseList(poses)), Some(Value::BoundingBoxList(boxes))) =
        (outputs.get("poses"), outputs.get("boxes"))
    else {
        panic!("{outputs}")
    };
    let inside = poses.poses.iter().flat_map(|pose| &pose.keypoints).filter(|point| point.is_detected());
    let in_a_box =
        |x: f32, y: f32| {
            boxes.boxes.iter().map(opendr::target::BoundingBox::corners).any(|[x0, y0, x1, y1]| {
                (x0 - 2.0..x1 + 2.0).contains(&x) && (y0 - 2.0..y1 + 2.0).contains(&y)
            })
        };
    let (mut count, mut right) = (0, 0);
    for point in inside {
        count += 1;
        right += usize::from(in_a_box(point.x, point.y));
    }
    assert!(count >= 17 && right == count, "{right} of {count}");

    let Some((alone, emotions)) = learner(&models, "facial_emotion") else { return };
    let error = Pipeline::default().then_each(alone, emotions.as_ref()).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::InvalidParam, "{error}");
}
