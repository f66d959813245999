//! Data set formats, one file each, lazy and readable from several threads; augmentation and the parallel loader.
//!
//! [`open`] recognises a data set; [`formats`] lists what there is. Nothing on disk is trusted: what is broken is told
//! with its file and line or key, through [`Problems`].

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
mod fields;
mod folder;
mod format;
mod from_above;
#[doc(hidden)]
pub mod fuzzing;
mod hands;
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

pub use any::{FormatEntry, Recognition};
pub use camvid::CamVid;
pub use check::check;
pub use cityscapes::Cityscapes;
pub use coco::{Coco, CocoInfrared, CocoPanoptic, coco_results};
pub use contact_sheet::{contact_sheet, picture_with_target};
pub use format::{Format, OpenOptions, WriteOptions};
pub use hands::Hands;
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
pub use npy::{NpyFile, NpyHeader, NpyType, array_from_npy, npy_from_f32, npy_from_i64};
pub use pictures::Pictures;
pub use problems::{Place, Problem, Problems};
#[cfg(feature = "recordings")]
pub use recording::AnnotatedRecording;
pub use registry::{find, format_of, formats, open, recognise};
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
