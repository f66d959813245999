//! The learners of active perception by what they recognise.

use opendr_engine::Task;
use opendr_engine::learner::{Entry, Spec};

/// What a learner recognises.
pub trait ActiveKind: Send + Sync + 'static {
    /// Name, task and class name of the learner.
    const SPEC: Spec;
}

/// Returns whether the learners of an entry are those of active perception, whose models have a camera policy.
pub fn has_camera_policy(entry: &Entry) -> bool {
    entry.spec.task == Task::ActivePerception
}

/// Persons by their faces.
#[derive(Debug)]
pub struct Face;

/// Objects by their labels.
#[derive(Debug)]
pub struct Object;

/// Persons' poses.
#[derive(Debug)]
pub struct BodyPose;

/// Arguments of OpenDR's learner, which trains PPO on images with settings of its own.
const WITHOUT_EFFECT: &[(&str, &str)] = &[
    ("lr", FIXED),
    ("batch_size", FIXED),
    ("n_steps", FIXED),
    ("gamma", FIXED),
    ("clip_range", FIXED),
    ("target_kl", FIXED),
    ("checkpoint_after_iter", SHORT),
    ("checkpoint_load_iter", SHORT),
];
const FIXED: &str = "the settings of PPO are fixed for active perception";
const SHORT: &str = "a training takes minutes and writes no checkpoints";

impl ActiveKind for Face {
    const SPEC: Spec = Spec::new("active_face_recognition", Task::ActivePerception)
        .class("ActiveFaceRecognitionLearner")
        .without_effect(WITHOUT_EFFECT)
        .about("Recognises a person from several views, and proposes the camera motion to the next one.");
}

impl ActiveKind for Object {
    const SPEC: Spec = Spec::new("active_object_recognition", Task::ActivePerception)
        .class("ActiveObjectRecognitionLearner")
        .about("Recognises an object from several views, and proposes the camera motion to the next one.");
}

impl ActiveKind for BodyPose {
    const SPEC: Spec = Spec::new("active_pose_recognition", Task::ActivePerception)
        .class("ActivePoseRecognitionLearner")
        .about(
            "Recognises a person's pose from several views, and proposes the camera motion to the next one.",
        );
}
