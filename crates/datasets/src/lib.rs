//! Data set formats, augmentation and the parallel loader.
//!
//! [`open`] opens a data set, whose format it can recognise, and [`formats`] lists the formats (COCO, YOLO, Pascal
//! VOC, KITTI, MOT and more). Samples are read when they are needed, from any thread. Nothing on disk is trusted:
//! problems are reported with file and line or key, through [`Problems`]. Module [`augment`] has augmentations of
//! images, point clouds, audio and time series; module [`loader`] reads, augments and batches samples on several
//! threads. The types of samples and targets are in `opendr-engine`, metrics in `opendr-metrics`, and evaluation in
//! `opendr-evaluation`.
//!
//! ```
//! use opendr_datasets::augment::{Augment, Flip, OtherSamples};
//! use opendr_engine::data::Image;
//! use opendr_engine::dataset::Sample;
//! use opendr_engine::target::{BoundingBox, BoundingBoxList};
//! use opendr_engine::{Random, Value};
//!
//! let image = Image::from_rgb8(vec![0; 100 * 80 * 3], 100, 80)?;
//! let boxes = BoundingBoxList::from(vec![BoundingBox::new(0_i64, 10.0, 20.0, 30.0, 40.0, 1.0)]);
//! let mut sample = Sample { data: vec![image.into()], target: Some(boxes.into()) };
//! Flip::default().apply(&mut sample, &mut Random::new(0), &OtherSamples::none())?;
//! let Some(Value::BoundingBoxList(boxes)) = sample.target else { unreachable!() };
//! assert_eq!(boxes.boxes[0].left, 60.0);
//! # Ok::<_, opendr_engine::Error>(())
//! ```

mod any;
pub mod augment;
mod camvid;
mod check;
mod cityscapes;
mod class_folders;
mod class_table;
mod clip;
mod coco;
mod contact_sheet;
mod curve;
mod depth_maps;
mod fields;
mod folder;
mod format;
mod from_above;
#[doc(hidden)]
pub mod fuzzing;
mod hands;
mod icdar;
mod image_pairs;
mod imagenet;
mod kinetics;
mod kitti;
mod label_png;
mod lfw;
pub mod loader;
mod market1501;
mod mnist;
mod mot;
mod npy;
mod pickle;
mod picture_box;
mod picture_files;
mod pictures;
mod problems;
mod recognition;
#[cfg(feature = "recordings")]
mod recording;
mod registry;
mod skeleton;
mod speech_commands;
mod stats;
mod ucr;
mod value_file;
mod voc;
mod wav;
mod wfdb;
mod wider_face;
mod yolo;

pub use any::FormatEntry;
pub use camvid::CamVid;
pub use check::check;
pub use cityscapes::Cityscapes;
pub use coco::{Coco, CocoInfrared, CocoPanoptic, coco_results};
pub use contact_sheet::{contact_sheet, draw_sample};
pub use depth_maps::DepthMaps;
pub use format::{Format, OpenOptions, WriteOptions};
pub use hands::Hands;
pub use icdar::Icdar;
pub use imagenet::ImageNet;
pub use kinetics::Kinetics;
pub use kitti::{
    Kitti, KittiTracking, calibration_from_kitti, kitti_from_calibration, open_kitti_calibration,
    open_velodyne, velodyne_from_cloud,
};
pub use lfw::Lfw;
pub use market1501::{Market1501, MarketPerson};
pub use mnist::Mnist;
pub use mot::{Mot, MotRow, MotSequence, open_mot_results, write_mot_results};
pub use npy::{NpyElement, NpyFile, NpyHeader, NpyType, array_from_npy, npy_from_values};
pub use pictures::UnlabelledImages;
pub use problems::{Location, Problem, Problems};
pub use recognition::Recognition;
#[cfg(feature = "recordings")]
pub use recording::AnnotatedRecording;
pub use registry::{find_format, format_of, formats, open, open_for, recognise};
pub use skeleton::{NtuFile, Skeletons, open_ntu, skeleton_from_ntu};
pub use speech_commands::{SpeechCommands, SpeechSplit, speaker_of_clip, split_of_clip};
pub use stats::{ClassCount, DatasetStats, Spread};
pub use ucr::{TsHeader, Ucr, series_from_line, series_from_ts_line};
pub use value_file::{open_value, timeseries_from_table, value_extensions, value_files};
pub use voc::Voc;
pub use wav::{WavEncoding, audio_from_wav, open_wav, wav_from_audio};
pub use wfdb::{
    Wfdb, WfdbAnnotation, WfdbHeader, WfdbRecord, WfdbSignal, annotations_from_atr, atr_from_annotations,
    open_wfdb_header, open_wfdb_record, wfdb_from_timeseries, wfdb_samples,
};
pub use wider_face::WiderFace;
pub use yolo::Yolo;
