//! Invalid arguments from a C program return a status: one test per case.

use std::ffi::{CStr, CString, c_char};
use std::ptr::{NonNull, null, null_mut};

use opendr_c::opendr_status::*;
use opendr_c::*;

use crate::{last_error, refused};

fn image() -> *mut opendr_image {
    let bytes = [1u8, 2, 3, 4, 5, 6];
    let mut image = null_mut();
    // SAFETY: six bytes.
    unsafe { assert_eq!(opendr_image_create(&pixels(&bytes, 2, 1), &mut image), OPENDR_OK) };
    image
}

pub fn pixels(bytes: &[u8], width: usize, height: usize) -> opendr_pixels {
    let (samples, format) = (opendr_sample_type::OPENDR_U8 as i32, opendr_pixel_format::OPENDR_RGB as i32);
    let (data, size) = (bytes.as_ptr().cast(), bytes.len());
    opendr_pixels { data, size, width, height, row_stride: 0, samples, format, layout: 0 }
}

fn found() -> opendr_bounding_box {
    let (left, top, width, height, confidence) = (1.0, 2.0, 3.0, 4.0, 0.5);
    let (label, landmarks, landmark_count) = (null(), null(), 0);
    opendr_bounding_box {
        class_index: 0,
        label,
        left,
        top,
        width,
        height,
        confidence,
        landmarks,
        landmark_count,
    }
}

#[test]
fn null_is_refused_everywhere() {
    // SAFETY: null only.
    unsafe {
        let mut refusals = vec![
            opendr_string_free(null_mut()),
            opendr_value_to_json(null(), null_mut()),
            opendr_value_from_json(null(), null(), null_mut()),
            opendr_value_to_text(null(), null_mut()),
            opendr_value_stamp(null(), null_mut()),
            opendr_value_set_stamp(null_mut(), 0),
            opendr_value_set_frame_id(null_mut(), null()),
            opendr_value_copy(null(), null_mut()),
            opendr_value_free(null_mut()),
            opendr_value_draw(null(), null_mut()),
            opendr_source_open(null(), null_mut()),
            opendr_source_next(null_mut(), null_mut()),
            opendr_source_free(null_mut()),
            opendr_load(null(), null(), null(), null(), null_mut()),
            opendr_infer(null(), null(), 0, null_mut(), 0),
            opendr_set_param(null(), null(), null()),
            opendr_params(null(), null_mut()),
            opendr_reset(null()),
            opendr_classes(null(), null_mut()),
            opendr_class_count(null(), null_mut()),
            opendr_save(null(), null()),
            opendr_learner_free(null_mut()),
            opendr_learners(null_mut()),
            opendr_network_open(null(), null(), null(), null_mut()),
            opendr_learner_network(null(), null(), null_mut()),
            opendr_network_run(null(), null(), 0, null_mut()),
            opendr_network_input(null(), 0, null_mut()),
            opendr_network_output(null(), 0, null_mut()),
            opendr_network_manifest(null(), null_mut()),
            opendr_network_free(null_mut()),
            opendr_tensors_get(null(), 0, null_mut()),
            opendr_tensors_free(null_mut()),
        ];
        refusals.extend([
            opendr_image_open(null(), null_mut()),
            opendr_image_decode(null(), 0, null_mut()),
            opendr_image_create(null(), null_mut()),
            opendr_image_read(null(), null_mut()),
            opendr_image_save(null(), null()),
            opendr_image_preprocess(null(), null(), null_mut(), 0),
            opendr_array_create(null(), null(), 0, null(), 0, null_mut()),
            opendr_array_read(null(), null_mut(), null_mut(), null_mut(), 0),
            opendr_audio_create(null(), 0, 0, 0, null_mut()),
            opendr_audio_read(null(), null_mut(), null_mut(), null_mut(), null_mut()),
            opendr_calibration_create(null(), null_mut()),
            opendr_calibration_open(null(), null_mut()),
            opendr_calibration_read(null(), null_mut()),
            opendr_image_with_detections_create(null(), null(), null_mut()),
            opendr_image_with_detections_read(null(), null_mut(), null_mut()),
            opendr_point_cloud_with_calibration_create(null(), null(), null(), null_mut()),
            opendr_point_cloud_with_calibration_read(null(), null_mut(), null_mut(), null_mut(), null_mut()),
            opendr_observation_create(null(), 0, null_mut()),
            opendr_observation_create_parts(null(), 0, null_mut()),
            opendr_observation_read(null(), null_mut(), null_mut()),
            opendr_observation_get(null(), 0, null_mut()),
        ]);
        refusals.extend([
            opendr_bounding_box_list_create(null(), 0, null_mut()),
            opendr_bounding_box_list_get(null(), 0, null_mut()),
            opendr_tracking_annotation_list_create(null(), 0, null_mut()),
            opendr_tracking_annotation_list_get(null(), 0, null_mut()),
            opendr_bounding_box_3d_list_create(null(), 0, null_mut()),
            opendr_bounding_box_3d_list_get(null(), 0, null_mut()),
            opendr_tracking_annotation_3d_list_create(null(), 0, null_mut()),
            opendr_tracking_annotation_3d_list_get(null(), 0, null_mut()),
            opendr_pose_list_create(null(), 0, null_mut()),
            opendr_pose_list_get(null(), 0, null_mut()),
            opendr_category_create(null(), null_mut()),
            opendr_category_read(null(), null_mut()),
            opendr_heatmap_create(null(), null_mut()),
            opendr_heatmap_read(null(), null_mut()),
            opendr_rl_target_create(null(), 0, null_mut()),
            opendr_rl_target_read(null(), null_mut(), null_mut()),
            opendr_env_make(null(), null(), null_mut()),
            opendr_env_describe(null(), null_mut()),
            opendr_env_reset(null_mut(), null(), null_mut()),
            opendr_env_step(null_mut(), null(), 0, null_mut(), null_mut()),
            opendr_env_info(null(), null(), null_mut()),
            opendr_speech_command_create(null(), null_mut()),
            opendr_speech_command_read(null(), null_mut()),
            opendr_base_transcription_create(null(), null_mut()),
            opendr_vosk_transcription_create(null(), false, null_mut()),
            opendr_whisper_transcription_create(null(), null(), 0, null_mut()),
            opendr_whisper_transcription_get(null(), 0, null_mut()),
        ]);
        assert!(refusals.iter().all(|status| *status == OPENDR_INVALID_INPUT), "{refusals:?}");
        assert!(last_error().contains("null"), "{}", last_error());
        let texts = [
            opendr_string_text(null()),
            opendr_value_type(null()),
            opendr_value_frame_id(null()),
            opendr_source_path(null()),
            opendr_input_name(null(), 0),
            opendr_output_name(null(), 0),
            opendr_class_name(null(), 0),
            opendr_base_transcription_text(null()),
            opendr_vosk_transcription_text(null()),
            opendr_whisper_transcription_text(null()),
        ];
        assert!(texts.iter().all(|text| text.is_null()));
        assert_eq!(opendr_bounding_box_list_count(null()), 0);
        assert_eq!(opendr_network_input_count(null()), 0);
        assert_eq!(opendr_network_output_count(null()), 0);
        assert_eq!(opendr_tensors_count(null()), 0);
        assert_eq!(*opendr_json_text(null(), null(), null(), 0), 0);
        assert_eq!(opendr_json_number(null(), null(), null(), 0), 0.0);
    }
}

#[test]
fn handles_of_another_kind_are_refused() {
    let mut image = image();
    // SAFETY: handles that live, cast as a careless C program would.
    unsafe {
        let learner = image.cast::<opendr_learner>();
        refused(opendr_reset(learner), OPENDR_INVALID_INPUT, "opendr_learner");
        let mut variable = image.cast::<opendr_source>();
        refused(opendr_source_free(&mut variable), OPENDR_INVALID_INPUT, "opendr_source");
        assert!(!variable.is_null());
        let mut variable = image.cast::<opendr_network>();
        refused(opendr_network_free(&mut variable), OPENDR_INVALID_INPUT, "opendr_network");
        assert_eq!(opendr_network_input_count(variable), 0);
        let mut variable = image.cast::<opendr_tensors>();
        refused(opendr_tensors_free(&mut variable), OPENDR_INVALID_INPUT, "opendr_tensors");
        assert_eq!(opendr_tensors_count(variable), 0);
        let boxes = image.cast::<opendr_bounding_box_list>();
        assert_eq!(opendr_bounding_box_list_count(boxes), 0);
        assert!(last_error().contains("takes a BoundingBoxList, not a Image"), "{}", last_error());
        let mut json = null_mut();
        refused(
            opendr_value_to_json(image.cast(), &mut json),
            OPENDR_UNSUPPORTED,
            "Image cannot be written as JSON",
        );
        refused(opendr_value_draw(image.cast(), image), OPENDR_INVALID_INPUT, "on itself");
        // Invalid handles: misaligned pointers and pointers to other data.
        let bytes = [0u64; 4];
        let other = bytes.as_ptr().cast::<opendr_value>();
        refused(opendr_value_copy(other, &mut null_mut()), OPENDR_INVALID_INPUT, "another type, or freed");
        refused(
            opendr_value_copy(other.byte_add(1), &mut null_mut()),
            OPENDR_INVALID_INPUT,
            "another type, or freed",
        );
        assert_eq!(opendr_value_free((&raw mut image).cast()), OPENDR_OK);
    }
}

#[test]
fn a_freed_variable_is_null_and_may_be_freed_again() {
    let mut image = image();
    // SAFETY: a variable with a handle, then with null.
    unsafe {
        assert_eq!(opendr_value_free((&raw mut image).cast()), OPENDR_OK);
        assert!(image.is_null());
        assert_eq!(opendr_value_free((&raw mut image).cast()), OPENDR_OK);
        refused(opendr_image_save(image, c"never.png".as_ptr()), OPENDR_INVALID_INPUT, "image is null");
    }
}

#[test]
fn what_is_empty_is_refused() {
    // SAFETY: nothing is pointed to.
    unsafe {
        let mut image = null_mut();
        refused(opendr_image_create(&pixels(&[], 0, 0), &mut image), OPENDR_INVALID_INPUT, "pixels");
        refused(opendr_image_create(&pixels(&[], 1, 1), &mut image), OPENDR_INVALID_INPUT, "0 bytes");
        assert_ne!(opendr_image_decode(null(), 0, &mut image), OPENDR_OK);
        assert_ne!(opendr_image_open(c"".as_ptr(), &mut image), OPENDR_OK);
        let mut value = null_mut();
        let vector = opendr_array_create(c"Vector".as_ptr(), null(), 0, [0].as_ptr(), 1, &mut value);
        refused(vector, OPENDR_INVALID_INPUT, "Vector is empty");
        let status = opendr_observation_create(null(), 0, (&raw mut value).cast());
        refused(status, OPENDR_INVALID_INPUT, "Observation is empty");
        let status = opendr_audio_create(null(), 0, 1, 16_000, (&raw mut value).cast());
        refused(status, OPENDR_INVALID_INPUT, "Audio is empty");
        refused(opendr_value_from_json(null(), c"".as_ptr(), &mut value), OPENDR_FORMAT, "not a target");
        let mut list = null_mut();
        assert_eq!(opendr_bounding_box_list_create(null(), 0, &mut list), OPENDR_OK);
        let mut item = found();
        refused(opendr_bounding_box_list_get(list, 0, &mut item), OPENDR_INVALID_INPUT, "has 0 items");
        assert_eq!(opendr_value_free((&raw mut list).cast()), OPENDR_OK);
    }
}

#[test]
fn boxes_with_nan_are_refused() {
    for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut list = NonNull::dangling().as_ptr();
        let items = [found(), opendr_bounding_box { width: wrong, ..found() }];
        // SAFETY: two boxes.
        let status = unsafe { opendr_bounding_box_list_create(items.as_ptr(), 2, &mut list) };
        refused(status, OPENDR_INVALID_INPUT, "give finite numbers");
        assert!(list.is_null(), "a call that fails leaves null");
        let points = [opendr_keypoint { x: wrong, y: 0.0, confidence: 0.0 }; 17];
        let (keypoints, keypoint_count) = (points.as_ptr(), points.len());
        let pose = opendr_pose { keypoints, keypoint_count, confidence: 0.5, skeleton: 1, id: -1 };
        let mut poses = null_mut();
        // SAFETY: one pose.
        refused(unsafe { opendr_pose_list_create(&pose, 1, &mut poses) }, OPENDR_INVALID_INPUT, "keypoint");
    }
}

#[test]
fn huge_sizes_are_refused_before_anything_is_read() {
    const HUGE: [usize; 4] = [usize::MAX, usize::MAX / 2, usize::MAX / 4 + 1, 1 << 62];
    let bytes = [0u8; 12];
    for huge in HUGE {
        // SAFETY: no size that could be read is claimed.
        unsafe {
            let mut image = null_mut();
            for (width, height) in [(huge, 1), (1, huge), (huge, huge)] {
                let status = opendr_image_create(&pixels(&bytes, width, height), &mut image);
                refused(status, OPENDR_INVALID_INPUT, "12 bytes cannot hold");
                let wide = opendr_pixels { row_stride: huge, layout: 1, ..pixels(&bytes, width, height) };
                assert_eq!(opendr_image_create(&wide, &mut image), OPENDR_INVALID_INPUT);
            }
            let wide = opendr_pixels { row_stride: huge, ..pixels(&bytes, 1, 2) };
            assert_eq!(opendr_image_create(&wide, &mut image), OPENDR_INVALID_INPUT);
            let status = opendr_image_decode(bytes.as_ptr(), huge | 1 << 63, &mut image);
            refused(status, OPENDR_INVALID_INPUT, "exceeds the address space");
            let mut list = null_mut();
            let status = opendr_bounding_box_list_create(&found(), huge, &mut list);
            refused(status, OPENDR_INVALID_INPUT, "too long");
            let (mut value, shape) = (null_mut(), [huge, huge]);
            let name = c"Timeseries".as_ptr();
            let status = opendr_array_create(name, [0.0].as_ptr(), 1, shape.as_ptr(), 2, &mut value);
            refused(status, OPENDR_INVALID_INPUT, "cannot have 1 numbers");
            let status = opendr_array_create(name, [0.0].as_ptr(), 1, shape.as_ptr(), usize::MAX, &mut value);
            refused(status, OPENDR_INVALID_INPUT, "exceeds the address space");
            let mut map = null_mut();
            let (labels, scores) = ([0u32].as_ptr(), null());
            let fields = opendr_heatmap_fields { labels, scores, length: 1, shape: shape.as_ptr(), axes: 2 };
            refused(opendr_heatmap_create(&fields, &mut map), OPENDR_INVALID_INPUT, "cannot have 1");
            let mut audio = null_mut();
            let status = opendr_audio_create([0.0].as_ptr(), 1, huge, 1, &mut audio);
            refused(status, OPENDR_INVALID_INPUT, "not audio of");
        }
    }
}

#[test]
fn crooked_pixels_are_refused() {
    let bytes = [0u8; 64];
    let good = pixels(&bytes, 2, 2);
    for wrong in [
        opendr_pixels { samples: 3, ..good },
        opendr_pixels { samples: -1, ..good },
        opendr_pixels { format: 5, ..good },
        opendr_pixels { layout: 2, ..good },
        opendr_pixels { row_stride: 5, ..good },
        opendr_pixels { row_stride: 100, ..good },
        opendr_pixels { data: null(), ..good },
    ] {
        let mut image = null_mut();
        // SAFETY: 64 bytes.
        assert_eq!(unsafe { opendr_image_create(&wrong, &mut image) }, OPENDR_INVALID_INPUT, "{wrong:?}");
    }
}

#[test]
fn unknown_names_are_told_with_those_that_there_are() {
    // SAFETY: texts and variables.
    unsafe {
        let (mut learner, mut value) = (null_mut(), null_mut());
        let load = |name: &CStr, device: *const c_char, params: *const c_char, learner: *mut _| {
            opendr_load(name.as_ptr(), c"/no/such/model".as_ptr(), device, params, learner)
        };
        refused(load(c"nanodett", null(), null(), &mut learner), OPENDR_NOT_FOUND, "there are centernet");
        refused(load(c"nanodet", null(), null(), &mut learner), OPENDR_NOT_FOUND, "/no/such/model");
        refused(load(c"nanodet", c"gpu".as_ptr(), null(), &mut learner), OPENDR_INVALID_PARAM, "cuda");
        for (params, words) in [
            (c"{\"no_such\": 1}", "no parameter"),
            (c"{\"threshold\": 2}", "out of range"),
            (c"{\"threshold\": \"high\"}", "should be a float"),
            (c"[1]", "params_json"),
            (c"", "params_json"),
        ] {
            refused(load(c"nanodet", null(), params.as_ptr(), &mut learner), OPENDR_INVALID_PARAM, words);
        }
        let json = c"{\"type\":\"PoseList\",\"poses\":[]}".as_ptr();
        let status = opendr_value_from_json(c"BoundingBoxList".as_ptr(), json, &mut value);
        refused(status, OPENDR_INVALID_INPUT, "of a PoseList, not of a BoundingBoxList");
        refused(opendr_value_from_json(c"Boxes".as_ptr(), json, &mut value), OPENDR_NOT_FOUND, "no type");
        let status = opendr_array_create(c"Image".as_ptr(), null(), 0, [0].as_ptr(), 1, &mut value);
        refused(status, OPENDR_INVALID_INPUT, "arrays are Video");
    }
}

#[test]
fn texts_that_are_no_utf8() {
    let odd = c"caf\xe9";
    // SAFETY: texts and variables.
    unsafe {
        let mut learner = null_mut();
        let status = opendr_load(odd.as_ptr(), null(), null(), null(), &mut learner);
        refused(status, OPENDR_INVALID_INPUT, "not UTF-8");
        let mut image = image();
        refused(opendr_value_set_frame_id(image.cast(), odd.as_ptr()), OPENDR_INVALID_INPUT, "not UTF-8");
        let folder = std::env::temp_dir().join(format!("opendr-c-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = [folder.to_str().unwrap().as_bytes(), b"/caf\xe9.png"].concat();
        let path = CString::new(path).unwrap();
        if cfg!(target_os = "linux") {
            // Linux has such names: written, and read again.
            assert_eq!(opendr_image_save(image, path.as_ptr()), OPENDR_OK, "{}", last_error());
            let mut again = null_mut();
            assert_eq!(opendr_image_open(path.as_ptr(), &mut again), OPENDR_OK, "{}", last_error());
            assert_eq!(opendr_value_free((&raw mut again).cast()), OPENDR_OK);
        }
        let missing = CString::new([path.as_bytes(), b".jpg"].concat()).unwrap();
        let mut source = null_mut();
        refused(opendr_source_open(missing.as_ptr(), &mut source), OPENDR_NOT_FOUND, "caf");
        assert_eq!(opendr_value_free((&raw mut image).cast()), OPENDR_OK);
        std::fs::remove_dir_all(folder).unwrap();
    }
}

#[test]
fn errors_belong_to_their_thread() {
    // SAFETY: null only.
    unsafe {
        assert_eq!(opendr_reset(null()), OPENDR_INVALID_INPUT);
        let other = std::thread::spawn(last_error).join().unwrap();
        assert_eq!((other.as_str(), last_error().contains("learner is null")), ("", true));
    }
}
