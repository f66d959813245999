// The C API driven by bytes: each call is a byte and what it takes from those after it. Shared with the test that replays
// the corpus (`bindings/c/tests/suite/corpus.rs`). Lengths are true or impossible, since the rest is the caller's promise.

use std::ffi::{CString, c_char};
use std::ptr::{null, null_mut};
use std::sync::OnceLock;

use opendr::model::{Manifest, ModelWriter};
use opendr_c::*;

/// Variables that a program might have.
const SLOTS: usize = 8;
const TYPES: [&std::ffi::CStr; 7] =
    [c"Vector", c"Timeseries", c"PointCloud", c"Video", c"SkeletonSequence", c"Image", c"Nothing"];
const PORTS: [&std::ffi::CStr; 6] = [c"image", c"detections", c"first", c"count", c"poses", c""];

/// Makes the calls that `bytes` stand for.
pub fn run(bytes: &[u8]) {
    let mut program = Program { bytes, values: [null_mut(); SLOTS], learner: learner(), network: network() };
    // SAFETY: handles are those of the slots or null.
    unsafe {
        opendr_reset(program.learner);
        while !program.bytes.is_empty() {
            program.call();
        }
        for slot in 0..SLOTS {
            program.free(slot);
        }
    }
}

struct Program<'a> {
    bytes: &'a [u8],
    values: [*mut opendr_value; SLOTS],
    learner: *mut opendr_learner,
    network: *mut opendr_network,
}

impl Program<'_> {
    fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.bytes.split_first() else { return 0 };
        self.bytes = rest;
        *first
    }

    fn slot(&mut self) -> usize {
        usize::from(self.byte()) % SLOTS
    }

    /// Up to 255 bytes.
    fn chunk(&mut self) -> Vec<u8> {
        let length = usize::from(self.byte()).min(self.bytes.len());
        let (chunk, rest) = self.bytes.split_at(length);
        self.bytes = rest;
        chunk.to_vec()
    }

    fn text(&mut self) -> CString {
        text(&self.chunk())
    }

    fn floats(&mut self) -> Vec<f32> {
        self.chunk().as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect()
    }

    fn float(&mut self) -> f32 {
        f32::from_le_bytes([self.byte(), self.byte(), self.byte(), self.byte()])
    }

    /// Small numbers, and some that are far too large.
    fn size(&mut self) -> usize {
        match self.byte() {
            small @ 0..=247 => usize::from(small),
            large => usize::MAX >> (8 * (255 - large)),
        }
    }

    /// A variable to fill; what was in it is freed.
    unsafe fn variable(&mut self) -> *mut *mut opendr_value {
        let slot = self.slot();
        // SAFETY: the slot's own handle or null.
        unsafe { self.free(slot) };
        &mut self.values[slot]
    }

    unsafe fn free(&mut self, slot: usize) {
        // SAFETY: the slot's own handle or null.
        let freed = unsafe { opendr_value_free(&mut self.values[slot]) };
        assert_eq!((freed, self.values[slot]), (opendr_status::OPENDR_OK, null_mut()));
    }

    /// One call.
    unsafe fn call(&mut self) {
        let call = self.byte();
        // SAFETY: handles are those of the slots or null, lengths true or impossible.
        unsafe {
            match call % 16 {
                0 => self.create_image(),
                1 => {
                    let file = self.chunk();
                    opendr_image_decode(file.as_ptr(), file.len(), self.variable().cast());
                }
                2 => {
                    let json = self.text();
                    opendr_value_from_json(null(), json.as_ptr(), self.variable());
                }
                3 => self.create_array(),
                4 => self.create_list(),
                5 => self.create_other(),
                6 => self.read(),
                7 => {
                    let value = self.values[self.slot()];
                    opendr_value_copy(value, self.variable_but(value));
                }
                8 => {
                    let slot = self.slot();
                    self.free(slot);
                    self.free(slot);
                }
                9 => {
                    let (target, image) = (self.values[self.slot()], self.values[self.slot()]);
                    opendr_value_draw(target, image.cast());
                }
                10 => {
                    let (slot, frame_id) = (self.slot(), self.text());
                    opendr_value_set_frame_id(self.values[slot], frame_id.as_ptr());
                    opendr_value_set_stamp(self.values[slot], i64::from(self.float().to_bits()));
                }
                11 => self.infer(),
                12 => {
                    let (name, json) = (self.text(), self.text());
                    opendr_set_param(self.learner, name.as_ptr(), json.as_ptr());
                }
                13 => {
                    let (name, params, mut learner) = (self.text(), self.text(), null_mut());
                    let nowhere = c"/no/such/model".as_ptr();
                    opendr_load(name.as_ptr(), nowhere, null(), params.as_ptr(), &mut learner);
                    opendr_learner_free(&mut learner);
                }
                14 => {
                    let (json, key) = (self.text(), self.text());
                    opendr_json_text(json.as_ptr(), null(), key.as_ptr(), i32::from(self.byte()));
                    opendr_json_number(json.as_ptr(), key.as_ptr(), key.as_ptr(), -1);
                }
                _ => match self.byte() % 3 {
                    0 => self.run_network(),
                    1 => self.preprocess(),
                    _ => {
                        opendr_reset(self.learner);
                    }
                },
            }
        }
    }

    unsafe fn run_network(&mut self) {
        let name = [null(), c"x".as_ptr(), c"y".as_ptr(), c"".as_ptr()][usize::from(self.byte()) % 4];
        let shape: Vec<usize> = (0..self.byte() % 10).map(|_| self.size()).collect();
        let numbers = self.floats();
        let axes = if self.byte() < 250 { shape.len() } else { usize::MAX };
        let length = if self.byte() < 250 { numbers.len() } else { usize::MAX };
        let tensor = opendr_tensor { name, numbers: numbers.as_ptr(), length, shape: shape.as_ptr(), axes };
        let (given, index, file) = (usize::from(self.byte()) % 3, self.size(), self.text());
        let mut tensors = null_mut();
        let mut seen = std::mem::MaybeUninit::uninit();
        let mut other = null_mut();
        // SAFETY: as many tensors as are said, as many numbers and axes as are said or impossibly many; variables.
        unsafe {
            opendr_network_run(self.network, [tensor, tensor].as_ptr(), given, &mut tensors);
            opendr_tensors_count(tensors);
            opendr_tensors_get(tensors, index, seen.as_mut_ptr());
            opendr_tensors_free(&mut tensors);
            opendr_network_input(self.network, index, std::mem::MaybeUninit::uninit().as_mut_ptr());
            opendr_network_output(self.network, index, std::mem::MaybeUninit::uninit().as_mut_ptr());
            opendr_learner_network(self.learner, file.as_ptr(), &mut other);
            opendr_network_free(&mut other);
            opendr_set_last_error(file.as_ptr());
        }
    }

    unsafe fn preprocess(&mut self) {
        let image = self.values[self.slot()];
        let (width, height) = (self.size(), self.size());
        let (format, layout) = (self.byte().into(), self.byte().into());
        let (mean, std, pad) = ([self.float(); 3], [self.float(); 3], self.float());
        let how = opendr_preprocess { width, height, format, layout, mean, std, pad };
        let mut numbers = vec![0.0f32; usize::from(self.byte()) * 3];
        let length = if self.byte() < 250 { numbers.len() } else { usize::MAX };
        // SAFETY: as many numbers as are said, or impossibly many; a handle of the slots or null.
        unsafe { opendr_image_preprocess(image.cast(), &how, numbers.as_mut_ptr(), length) };
    }

    /// A variable whose value is not the one that is read.
    unsafe fn variable_but(&mut self, value: *mut opendr_value) -> *mut *mut opendr_value {
        let slot = self.slot();
        let slot = if self.values[slot] == value { (slot + 1) % SLOTS } else { slot };
        if self.values[slot] != value {
            // SAFETY: the slot's own handle or null.
            unsafe { self.free(slot) };
        }
        &mut self.values[slot]
    }

    unsafe fn create_image(&mut self) {
        let (width, height, row_stride) = (self.size(), self.size(), self.size());
        let (samples, format, layout) = (self.byte().into(), self.byte().into(), self.byte().into());
        let bytes = self.chunk();
        let (data, size) = (bytes.as_ptr().cast(), bytes.len());
        let pixels = opendr_pixels { data, size, width, height, row_stride, samples, format, layout };
        // SAFETY: as many bytes as are said.
        unsafe { opendr_image_create(&pixels, self.variable().cast()) };
    }

    unsafe fn create_array(&mut self) {
        let name = TYPES[usize::from(self.byte()) % TYPES.len()];
        let shape: Vec<usize> = (0..self.byte() % 7).map(|_| self.size()).collect();
        let numbers = self.floats();
        let (data, length) = (numbers.as_ptr(), numbers.len());
        // SAFETY: as many numbers and axes as are said.
        unsafe {
            opendr_array_create(name.as_ptr(), data, length, shape.as_ptr(), shape.len(), self.variable())
        };
    }

    unsafe fn create_list(&mut self) {
        let (label, numbers) = (self.text(), self.floats());
        let points: Vec<_> = numbers.iter().map(|x| opendr_point { x: *x, y: 1.0 }).collect();
        let joints: Vec<_> =
            numbers.iter().map(|x| opendr_keypoint { x: *x, y: 1.0, confidence: 0.5 }).collect();
        let [left, top, width, height, confidence] = [(); 5].map(|()| self.float());
        let bounding_box = opendr_bounding_box {
            class_index: i64::from(self.byte()) - 1,
            label: label.as_ptr(),
            left,
            top,
            width,
            height,
            confidence,
            landmarks: points.as_ptr(),
            landmark_count: points.len(),
        };
        let track = opendr_tracking_annotation { bounding_box, id: -1, frame: 3 };
        let (keypoints, keypoint_count) = (joints.as_ptr(), joints.len());
        let pose = opendr_pose { keypoints, keypoint_count, confidence, skeleton: self.byte().into(), id: 1 };
        let count = if self.byte() < 250 { 1 } else { usize::MAX };
        let kind = self.byte() % 3;
        // SAFETY: one item, or impossibly many.
        unsafe {
            let list = self.variable();
            match kind {
                0 => opendr_bounding_box_list_create(&bounding_box, count, list.cast()),
                1 => opendr_tracking_annotation_list_create(&track, count, list.cast()),
                _ => opendr_pose_list_create(&pose, count, list.cast()),
            };
        }
    }

    unsafe fn create_other(&mut self) {
        let (words, numbers, kind) = (self.text(), self.floats(), self.byte());
        let (data, length, word) = (numbers.as_ptr(), numbers.len(), words.as_ptr());
        let shape: Vec<usize> = (0..self.byte() % 4).map(|_| self.size()).collect();
        let (one, other) = (self.values[self.slot()], self.values[self.slot()]);
        // SAFETY: as many numbers and axes as are said; handles of the slots or null.
        unsafe {
            let mut made: *mut opendr_value = null_mut();
            let place = &raw mut made;
            match kind % 8 {
                0 => {
                    let (shape, axes) = (shape.as_ptr(), shape.len());
                    let fields = opendr_heatmap_fields { labels: null(), scores: data, length, shape, axes };
                    opendr_heatmap_create(&fields, place.cast())
                }
                1 => opendr_audio_create(data, length, self.size(), u32::from(self.byte()), place.cast()),
                2 => {
                    let (name, numbers) = (word, data);
                    let (shape, axes) = (shape.as_ptr(), shape.len());
                    let part = opendr_observation_part { name, numbers, length, shape, axes };
                    opendr_observation_create_parts([part].as_ptr(), 1, place.cast())
                }
                3 => {
                    let (class_index, description, probability_count) = (-5, word, length);
                    let (confidence, probabilities) = (self.float(), data);
                    let fields = opendr_category_fields {
                        class_index,
                        description,
                        confidence,
                        probabilities,
                        probability_count,
                    };
                    opendr_category_create(&fields, place.cast())
                }
                4 => opendr_vosk_transcription_create(word, true, place.cast()),
                5 => {
                    let segment = opendr_whisper_segment {
                        id: 1,
                        start_s: self.float(),
                        end_s: self.float(),
                        text: word,
                    };
                    opendr_whisper_transcription_create(word, &segment, 1, place.cast())
                }
                6 => opendr_image_with_detections_create(one.cast(), other.cast(), place.cast()),
                _ => {
                    opendr_point_cloud_with_calibration_create(one.cast(), other.cast(), null(), place.cast())
                }
            };
            self.variable().write(made);
        }
    }

    /// Everything that can be asked of a value, whatever it is.
    unsafe fn read(&mut self) {
        let (value, index) = (self.values[self.slot()], self.size());
        let (mut string, mut stamp, mut numbers, mut length) = (null_mut(), 0, null(), 0);
        let (mut shape, mut axes) = ([0; 5], usize::from(self.byte()) % 6);
        // SAFETY: a handle or null, and variables.
        unsafe {
            opendr_value_to_json(value, &mut string);
            opendr_string_free(&mut string);
            opendr_value_to_text(value, &mut string);
            opendr_string_free(&mut string);
            opendr_value_stamp(value, &mut stamp);
            opendr_value_type(value);
            opendr_value_frame_id(value);
            opendr_array_read(value, &mut numbers, &mut length, shape.as_mut_ptr(), axes);
            opendr_observation_read(value.cast(), &mut numbers, &mut length);
            opendr_audio_read(value.cast(), &mut numbers, &mut length, &mut axes, &mut 0);
            opendr_image_read(value.cast(), std::mem::MaybeUninit::uninit().as_mut_ptr());
            opendr_bounding_box_list_get(value.cast(), index, std::mem::MaybeUninit::uninit().as_mut_ptr());
            opendr_tracking_annotation_list_get(
                value.cast(),
                index,
                std::mem::MaybeUninit::uninit().as_mut_ptr(),
            );
            opendr_bounding_box_3d_list_get(
                value.cast(),
                index,
                std::mem::MaybeUninit::uninit().as_mut_ptr(),
            );
            opendr_pose_list_get(value.cast(), index, std::mem::MaybeUninit::uninit().as_mut_ptr());
            opendr_category_read(value.cast(), std::mem::MaybeUninit::uninit().as_mut_ptr());
            opendr_heatmap_read(value.cast(), std::mem::MaybeUninit::uninit().as_mut_ptr());
            opendr_speech_command_read(value.cast(), std::mem::MaybeUninit::uninit().as_mut_ptr());
            opendr_whisper_transcription_get(
                value.cast(),
                index,
                std::mem::MaybeUninit::uninit().as_mut_ptr(),
            );
            opendr_observation_get(value.cast(), index, std::mem::MaybeUninit::uninit().as_mut_ptr());
        }
    }

    unsafe fn infer(&mut self) {
        let mut name = || PORTS[usize::from(self.byte()) % PORTS.len()].as_ptr();
        let names: [*const c_char; 5] = std::array::from_fn(|_| name());
        let inputs = [0, 1, 2].map(|at| opendr_input { name: names[at], value: self.values[self.slot()] });
        let mut outputs = [3, 4].map(|at| opendr_output { name: names[at], value: null_mut() });
        let (given, wanted) = (usize::from(self.byte()) % 4, usize::from(self.byte()) % 3);
        // SAFETY: no more inputs and outputs than there are; handles of the slots or null.
        unsafe {
            opendr_infer(self.learner, inputs.as_ptr(), given, outputs.as_mut_ptr(), wanted);
            for output in &mut outputs {
                opendr_value_free(&mut output.value);
            }
        }
    }
}

fn text(bytes: &[u8]) -> CString {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    CString::new(&bytes[..end]).unwrap_or_default()
}

/// The learner that every surface is tested with, loaded once; null where it is not compiled in.
fn learner() -> *mut opendr_learner {
    static LEARNER: OnceLock<usize> = OnceLock::new();
    let load = || {
        let folder = std::env::temp_dir().join(format!("opendr-c-calls-{}", std::process::id()));
        let mut writer = ModelWriter::new(&folder, Manifest::new("counter", "")).unwrap();
        writer.add("bias.bin", &[1]).unwrap();
        writer.finish().unwrap();
        let (path, mut learner) = (text(folder.as_os_str().as_encoded_bytes()), null_mut());
        // SAFETY: texts and a variable.
        unsafe { opendr_load(c"counter".as_ptr(), path.as_ptr(), c"cpu".as_ptr(), null(), &mut learner) };
        std::fs::remove_dir_all(folder).unwrap();
        learner.expose_provenance()
    };
    std::ptr::with_exposed_provenance_mut(*LEARNER.get_or_init(load))
}

/// A network `x` to `y`, numbers below 0 made 0, of any number of rows of two; opened once.
fn network() -> *mut opendr_network {
    static NETWORK: OnceLock<usize> = OnceLock::new();
    let open = || {
        let folder = std::env::temp_dir().join(format!("opendr-c-network-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let file = folder.join("relu.onnx");
        std::fs::write(&file, relu()).unwrap();
        let (path, mut network) = (text(file.as_os_str().as_encoded_bytes()), null_mut());
        // SAFETY: texts and a variable.
        unsafe {
            let opened = opendr_network_open(path.as_ptr(), null(), c"cpu".as_ptr(), &mut network);
            assert_eq!(opened, opendr_status::OPENDR_OK);
        }
        std::fs::remove_dir_all(folder).unwrap();
        network.expose_provenance()
    };
    std::ptr::with_exposed_provenance_mut(*NETWORK.get_or_init(open))
}

/// The network as ONNX.
fn relu() -> Vec<u8> {
    let number = |field: u8, number: u8| vec![field << 3, number];
    let bytes = |field: u8, bytes: &[u8]| [&[field << 3 | 2, bytes.len() as u8], bytes].concat();
    let rows = bytes(1, &bytes(2, b"rows"));
    let shape = [rows, bytes(1, &number(1, 2))].concat();
    let float = bytes(1, &[number(1, 1), bytes(2, &shape)].concat());
    let value = |name: &[u8]| [bytes(1, name), bytes(2, &float)].concat();
    let node = [bytes(1, b"x"), bytes(2, b"y"), bytes(4, b"Relu")].concat();
    let graph = [bytes(1, &node), bytes(2, b"g"), bytes(11, &value(b"x")), bytes(12, &value(b"y"))].concat();
    [number(1, 8), bytes(7, &graph), bytes(8, &number(2, 13))].concat()
}
