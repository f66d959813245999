//! Networks run through C return the same outputs as sessions.

use std::ffi::{CStr, CString};
use std::fs;
use std::path::{Path, PathBuf};
use std::ptr::{null, null_mut};

use opendr::Device;
use opendr::inference::{Session, TensorView};
use opendr::model::{Manifest, ModelWriter};
use opendr_c::opendr_status::*;
use opendr_c::*;

use crate::{last_error, refused};

/// Network that classifies 8 frames into 14 actions, `clip` `[8, 3, 48, 48]` to `logits` `[1, 14]`.
fn stick_figures() -> PathBuf {
    Path::new(&std::env::var("CARGO_MANIFEST_DIR").unwrap())
        .join("../../models/weights/x3d/stick_figures.onnx")
}

/// Container with that network, removed on drop.
struct Container(PathBuf);

impl Container {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("opendr-c-{name}-{}", std::process::id()));
        let mut manifest = Manifest::new("x3d", "stick_figures");
        manifest.params =
            serde_json::from_str(r#"{"num_frames": 8, "side": 48, "width": 0.67, "depth": 0.5}"#).unwrap();
        let mut writer = ModelWriter::new(&folder, manifest).unwrap();
        writer.add("model.onnx", &fs::read(stick_figures()).unwrap()).unwrap();
        writer.add("words.txt", b"no network").unwrap();
        writer.finish().unwrap();
        Self(folder)
    }
}

impl Drop for Container {
    fn drop(&mut self) {
        fs::remove_dir_all(&self.0).unwrap();
    }
}

fn text(path: &Path) -> CString {
    CString::new(path.as_os_str().as_encoded_bytes()).unwrap()
}

#[track_caller]
fn open(path: &Path) -> *mut opendr_network {
    let mut network = null_mut();
    // SAFETY: texts and a variable.
    let status = unsafe { opendr_network_open(text(path).as_ptr(), null(), c"cpu".as_ptr(), &mut network) };
    assert_eq!(status, OPENDR_OK, "{}", last_error());
    network
}

/// Clip with varying values.
fn clip() -> Vec<f32> {
    (0..8 * 3 * 48 * 48).map(|at| (at % 17) as f32 / 8.0 - 1.0).collect()
}

fn tensor(name: Option<&CStr>, numbers: &[f32], shape: &[usize]) -> opendr_tensor {
    opendr_tensor {
        name: name.map_or(null(), CStr::as_ptr),
        numbers: numbers.as_ptr(),
        length: numbers.len(),
        shape: shape.as_ptr(),
        axes: shape.len(),
    }
}

/// Runs a network and returns its only output.
#[track_caller]
fn run(network: *const opendr_network, name: Option<&CStr>) -> Vec<f32> {
    let (numbers, shape, mut tensors) = (clip(), [8, 3, 48, 48], null_mut());
    let mut output = tensor(None, &[], &[]);
    // SAFETY: a network, a tensor, variables.
    unsafe {
        let status = opendr_network_run(network, &tensor(name, &numbers, &shape), 1, &mut tensors);
        assert_eq!(status, OPENDR_OK, "{}", last_error());
        assert_eq!(opendr_tensors_count(tensors), 1);
        assert_eq!(opendr_tensors_get(tensors, 0, &mut output), OPENDR_OK);
        assert_eq!(CStr::from_ptr(output.name), c"logits");
        assert_eq!(std::slice::from_raw_parts(output.shape, output.axes), [1, 14]);
        let numbers = std::slice::from_raw_parts(output.numbers, output.length).to_vec();
        refused(opendr_tensors_get(tensors, 1, &mut output), OPENDR_INVALID_INPUT, "there are 1 tensors");
        assert_eq!(opendr_tensors_free(&mut tensors), OPENDR_OK);
        assert!(tensors.is_null());
        numbers
    }
}

#[test]
fn outputs_are_those_of_a_session() {
    let session = Session::open(&fs::read(stick_figures()).unwrap(), Device::Cpu).unwrap();
    let (numbers, mut wanted) = (clip(), Vec::new());
    let input = TensorView::new(&[8, 3, 48, 48], &numbers).unwrap();
    let keep = |outputs: &[TensorView<'_>]| {
        wanted = outputs[0].values::<f32>()?.to_vec();
        Ok(())
    };
    session.run(&[input], keep).unwrap();

    let container = Container::new("session");
    let mut learner = null_mut();
    let mut network = open(&stick_figures());
    assert_eq!(run(network, None), wanted);
    assert_eq!(run(network, Some(c"clip")), wanted);
    let mut of_container = open(&container.0);
    assert_eq!(run(of_container, None), wanted);
    // SAFETY: texts, handles, variables.
    unsafe {
        let path = text(&container.0);
        let status = opendr_load(c"x3d".as_ptr(), path.as_ptr(), c"cpu".as_ptr(), null(), &mut learner);
        assert_eq!(status, OPENDR_OK, "{}", last_error());
        let mut of_learner = null_mut();
        let file = c"model.onnx".as_ptr();
        assert_eq!(opendr_learner_network(learner, file, &mut of_learner), OPENDR_OK, "{}", last_error());
        assert_eq!(opendr_learner_free(&mut learner), OPENDR_OK);
        assert_eq!(run(of_learner, None), wanted);
        for network in [&mut network, &mut of_container, &mut of_learner] {
            assert_eq!(opendr_network_free(network), OPENDR_OK);
            assert!(network.is_null());
            assert_eq!(opendr_network_free(network), OPENDR_OK);
        }
    }
}

#[test]
fn a_network_tells_what_it_takes() {
    let container = Container::new("declared");
    let (mut network, mut of_container) = (open(&stick_figures()), open(&container.0));
    let mut info = opendr_tensor_info { name: null(), shape: null(), axes: 0 };
    let mut json = null_mut();
    // SAFETY: handles and variables.
    unsafe {
        assert_eq!((opendr_network_input_count(network), opendr_network_output_count(network)), (1, 1));
        assert_eq!(opendr_network_input(network, 0, &mut info), OPENDR_OK);
        assert_eq!(CStr::from_ptr(info.name), c"clip");
        assert_eq!(std::slice::from_raw_parts(info.shape, info.axes), [8, 3, 48, 48]);
        assert_eq!(opendr_network_output(network, 0, &mut info), OPENDR_OK);
        assert_eq!(std::slice::from_raw_parts(info.shape, info.axes), [1, 14]);
        refused(opendr_network_output(network, 1, &mut info), OPENDR_INVALID_INPUT, "there are 1 tensors");
        refused(
            opendr_network_input(network, usize::MAX, &mut info),
            OPENDR_INVALID_INPUT,
            "there are 1 tensors",
        );
        assert_eq!(opendr_network_manifest(network, &mut json), OPENDR_OK);
        assert_eq!(CStr::from_ptr(opendr_string_text(json)), c"{}");
        assert_eq!(opendr_string_free(&mut json), OPENDR_OK);
        assert_eq!(opendr_network_manifest(of_container, &mut json), OPENDR_OK);
        let learner = opendr_json_text(opendr_string_text(json), null(), c"learner".as_ptr(), 0);
        assert_eq!(CStr::from_ptr(learner), c"x3d");
        let params = c"params".as_ptr();
        assert_eq!(opendr_json_number(opendr_string_text(json), params, c"side".as_ptr(), 0), 48.0);
        opendr_string_free(&mut json);
        opendr_network_free(&mut network);
        opendr_network_free(&mut of_container);
    }
}

#[test]
fn wrong_inputs_are_refused() {
    let mut network = open(&stick_figures());
    let (numbers, shape) = (clip(), [8, 3, 48, 48]);
    let good = tensor(None, &numbers, &shape);
    let call = |inputs: &[opendr_tensor]| {
        let mut tensors = std::ptr::NonNull::dangling().as_ptr();
        // SAFETY: tensors that are there, or impossible ones.
        let status = unsafe { opendr_network_run(network, inputs.as_ptr(), inputs.len(), &mut tensors) };
        assert!(tensors.is_null(), "a call that fails leaves null");
        status
    };
    refused(call(&[]), OPENDR_INVALID_INPUT, "clip: f32[8, 3, 48, 48] is missing");
    refused(call(&[good, good]), OPENDR_INVALID_INPUT, "no input number 1");
    let named = opendr_tensor { name: c"clip".as_ptr(), ..good };
    refused(call(&[named, named]), OPENDR_INVALID_INPUT, "given twice");
    let unknown = opendr_tensor { name: c"image".as_ptr(), ..good };
    refused(call(&[unknown]), OPENDR_INVALID_INPUT, "no input \"image\"; it takes clip");
    refused(call(&[opendr_tensor { name: c"\xff".as_ptr(), ..good }]), OPENDR_INVALID_INPUT, "not UTF-8");
    refused(
        call(&[opendr_tensor { axes: 3, ..good }]),
        OPENDR_INVALID_INPUT,
        "elements do not match a tensor",
    );
    refused(call(&[opendr_tensor { length: 5, ..good }]), OPENDR_INVALID_INPUT, "5 elements");
    refused(call(&[opendr_tensor { numbers: null(), ..good }]), OPENDR_INVALID_INPUT, "numbers of a tensor");
    refused(call(&[opendr_tensor { shape: null(), ..good }]), OPENDR_INVALID_INPUT, "shape of a tensor");
    for huge in [usize::MAX, usize::MAX / 4 + 1, 1 << 62] {
        refused(
            call(&[opendr_tensor { length: huge, ..good }]),
            OPENDR_INVALID_INPUT,
            "exceeds the address space",
        );
        refused(
            call(&[opendr_tensor { axes: huge, ..good }]),
            OPENDR_INVALID_INPUT,
            "exceeds the address space",
        );
        let shape = [huge, huge, huge, huge];
        let status = call(&[tensor(None, &numbers, &shape)]);
        refused(status, OPENDR_INVALID_INPUT, "elements do not match a tensor");
    }
    let (few, other) = ([0.0; 6], [1, 2, 3]);
    refused(call(&[tensor(None, &few, &other)]), OPENDR_INVALID_INPUT, "received f32[1, 2, 3]");
    let many = [1; 9];
    refused(call(&[tensor(None, &few[..1], &many)]), OPENDR_INVALID_INPUT, "at most 8");
    // SAFETY: a network and a variable.
    unsafe {
        let mut tensors = null_mut();
        let status = opendr_network_run(network, &good, usize::MAX, &mut tensors);
        refused(status, OPENDR_INVALID_INPUT, "exceeds the address space");
        opendr_network_free(&mut network);
    }
}

#[test]
fn what_is_no_network_is_refused() {
    let container = Container::new("no-network");
    let broken = container.0.join("broken.onnx");
    fs::write(&broken, b"no network").unwrap();
    let folder = text(&container.0);
    let open = |path: &CStr, file: *const std::ffi::c_char, device: &CStr| {
        let mut network = std::ptr::NonNull::dangling().as_ptr();
        // SAFETY: texts and a variable.
        let status = unsafe { opendr_network_open(path.as_ptr(), file, device.as_ptr(), &mut network) };
        assert!(network.is_null(), "a call that fails leaves null");
        status
    };
    refused(open(c"/no/such.onnx", null(), c"cpu"), OPENDR_NOT_FOUND, "/no/such.onnx");
    refused(open(c"/no/such", null(), c"cpu"), OPENDR_NOT_FOUND, "no model at /no/such");
    refused(open(c"", null(), c"cpu"), OPENDR_NOT_FOUND, "no model");
    refused(open(&text(&broken), null(), c"cpu"), OPENDR_FORMAT, "broken.onnx");
    refused(open(&folder, c"words.txt".as_ptr(), c"cpu"), OPENDR_FORMAT, "");
    refused(open(&folder, c"../x.onnx".as_ptr(), c"cpu"), OPENDR_NOT_FOUND, "no file \"../x.onnx\"");
    refused(open(&text(&stick_figures()), c"model.onnx".as_ptr(), c"cpu"), OPENDR_INVALID_INPUT, "give NULL");
    refused(open(&folder, null(), c"gpu"), OPENDR_INVALID_PARAM, "cuda");
    let mut learner = null_mut();
    // SAFETY: texts and variables.
    unsafe {
        assert_eq!(opendr_create(c"x3d".as_ptr(), null(), null(), &mut learner), OPENDR_OK);
        refused(opendr_learner_network(learner, null(), &mut null_mut()), OPENDR_NOT_FOUND, "has no model");
        opendr_learner_free(&mut learner);
    }
}

#[test]
fn threads_share_a_network() {
    let mut network = open(&stick_figures());
    let (shared, wanted) = (network as usize, run(network, None));
    std::thread::scope(|scope| {
        for _ in 0..2 {
            let wanted = &wanted;
            scope.spawn(move || {
                for _ in 0..5 {
                    assert_eq!(&run(shared as *const opendr_network, None), wanted);
                }
            });
        }
    });
    // SAFETY: a network that nobody runs any more.
    unsafe { assert_eq!(opendr_network_free(&mut network), OPENDR_OK) };
}

#[track_caller]
fn assert_close(found: &[f32], wanted: &[f32]) {
    let is_close = found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-5);
    assert!(is_close && found.len() == wanted.len(), "{found:?}, not {wanted:?}");
}

#[test]
fn a_picture_becomes_an_input() {
    let bytes = [0u8, 51, 255, 255, 0, 0];
    let mut image = null_mut();
    let how = opendr_preprocess {
        width: 2,
        height: 2,
        format: opendr_pixel_format::OPENDR_BGR as i32,
        layout: opendr_layout::OPENDR_CHW as i32,
        mean: [0.0, 0.0, 51.0],
        std: [255.0, 51.0, 51.0],
        pad: f32::NAN,
    };
    let mut numbers = [f32::NAN; 12];
    let pixels = crate::misuse::pixels(&bytes, 2, 1);
    // SAFETY: as many bytes and numbers as are said.
    unsafe {
        assert_eq!(opendr_image_create(&pixels, &mut image), OPENDR_OK);
        let mut call = |how: &opendr_preprocess, length: usize| {
            opendr_image_preprocess(image, how, numbers.as_mut_ptr(), length)
        };
        refused(
            call(&how, 11),
            OPENDR_INVALID_INPUT,
            "room for 11 numbers, and the input has the shape [1, 3, 2, 2]",
        );
        refused(call(&how, usize::MAX), OPENDR_INVALID_INPUT, "exceeds the address space");
        for (wrong, words) in [
            (opendr_preprocess { format: 3, ..how }, "alpha"),
            (opendr_preprocess { format: -1, ..how }, "opendr_format"),
            (opendr_preprocess { layout: 2, ..how }, "opendr_layout"),
            (opendr_preprocess { std: [1.0, 0.0, 1.0], ..how }, "no std of 0"),
            (opendr_preprocess { mean: [f32::NAN; 3], ..how }, "finite"),
            (opendr_preprocess { pad: f32::INFINITY, ..how }, "pad is inf"),
            (opendr_preprocess { width: usize::MAX, ..how }, "12 numbers"),
        ] {
            refused(call(&wrong, 12), OPENDR_INVALID_INPUT, words);
        }
        let empty = opendr_preprocess { width: 0, ..how };
        refused(call(&empty, 0), OPENDR_INVALID_PARAM, "no pixel");
        assert_eq!(call(&how, 12), OPENDR_OK, "{}", last_error());
        assert_close(&numbers, &[1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 4.0, -1.0, 4.0]);
        // The whole picture in the middle, beside it the padding.
        let boxed = opendr_preprocess { height: 3, pad: 51.0, ..how };
        let mut numbers = [f32::NAN; 18];
        assert_eq!(opendr_image_preprocess(image, &boxed, numbers.as_mut_ptr(), 18), OPENDR_OK);
        assert_close(&numbers[12..], &[0.0, 0.0, -1.0, 4.0, 0.0, 0.0]);
        assert_eq!(opendr_value_free((&raw mut image).cast()), OPENDR_OK);
    }
}

#[test]
fn a_program_sets_the_last_error() {
    // SAFETY: texts, one of them the last error itself.
    unsafe {
        opendr_set_last_error(c"no window here".as_ptr());
        assert_eq!(last_error(), "no window here");
        opendr_set_last_error(opendr_last_error());
        assert_eq!(last_error(), "no window here");
        opendr_set_last_error(null());
        assert!(last_error().contains("message is null"), "{}", last_error());
    }
}
