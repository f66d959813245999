//! Every architecture: it trains, its exported network equals the trained one, and frame by frame it equals its clips.

use burn::module::Module;
use burn::tensor::{Tensor, TensorData};
use opendr_inference::{Builtin, Session, TensorView};
use opendr_perception_common::frame_features::{ClipScratch, FrameFeatures};

use super::*;
use crate::skeleton_based_action_recognition::frame_selection::FrameSelection;
use crate::skeleton_based_action_recognition::sizes::Architecture;

fn tagcn() -> SpatioTemporalGcnParams {
    SpatioTemporalGcnParams {
        method_name: Method::TaGcn,
        num_subframes: 9,
        channels: Some(vec![8, 8, 12]),
        ..clip_params()
    }
}

fn stbln(stbln_symmetric: bool) -> SpatioTemporalGcnParams {
    SpatioTemporalGcnParams { method_name: Method::StBln, stbln_symmetric, ..clip_params() }
}

fn coagcn() -> CoStGcnParams {
    CoStGcnParams { backbone: Backbone::CoAGcn, ..step_params() }
}

fn costr() -> CoStGcnParams {
    CoStGcnParams { backbone: Backbone::CoSTr, channels: vec![8, 8, 8, 32], ..step_params() }
}

fn all() -> Vec<NetworkSizes> {
    let pstgcn = NetworkSizes { architecture: Architecture::PstGcn, ..sizes() };
    let clip_wise = [tagcn(), stbln(false), stbln(true)].map(|params| params.sizes().unwrap());
    let continual = [coagcn(), costr()].map(|params| params.sizes());
    clip_wise.into_iter().chain(continual).chain([pstgcn, sizes()]).collect()
}

fn objective_of(sizes: &NetworkSizes) -> ActionObjective {
    ActionObjective { sizes: sizes.clone(), ..objective(Form::Clip) }
}

/// A network whose statistics of batch normalisation and weights are those after a few training steps.
fn network(sizes: &NetworkSizes) -> ActionNetwork {
    let device = Trainer::flex();
    device.seed(11);
    let network = ActionNetwork::new(sizes, 3, 0.0, &device).unwrap();
    let training = device.autodiff();
    let network = network.to_device(&training).train();
    network.forward(features(sizes, 4, &training));
    network.valid()
}

/// Features of walks, `[count, features, frames, joints]`.
fn features(sizes: &NetworkSizes, count: usize, device: &Trainer) -> Tensor<4> {
    let writer = FrameFeatures::new(sizes.graph.parents(), sizes.coordinates);
    let mut work = ClipScratch::default();
    let mut numbers = Vec::new();
    for seed in 0..count {
        assert!(writer.clip_into(&walk(seed as u64, 25, 1), 0, sizes.frames, &mut work));
        numbers.extend_from_slice(&work.clip);
    }
    let shape = [count, sizes.features(), sizes.frames, JOINTS];
    Tensor::from_data(TensorData::new(numbers, shape), device)
}

#[test]
fn every_architecture_overfits_one_batch() {
    // Other tests train the two that are left out.
    let is_other =
        |sizes: &NetworkSizes| !matches!(sizes.architecture, Architecture::StGcn | Architecture::PstGcn);
    for sizes in all().into_iter().filter(is_other) {
        let sizes = NetworkSizes { frames: 10, kernel: 3, ..sizes };
        let samples = (0..6).map(|index| Walks.get(index).unwrap()).collect();
        let network = |device: &Trainer| ActionNetwork::new(&sizes, 3, 0.0, device).unwrap();
        let [before, after] = losses_on_one_batch(&objective_of(&sizes), network, samples, 0.005);
        assert!(after < 0.05 * before, "{:?}: {before} {after}", sizes.architecture);
    }
}

#[test]
fn exported_networks_equal_the_trained_ones() {
    let device = Trainer::flex();
    for sizes in all() {
        let network = network(&sizes);
        let container = objective_of(&sizes).container(&network).unwrap();
        let (_, model) = container.files.iter().find(|(name, _)| name == "model.onnx").unwrap();
        let clip = features(&sizes, 1, &device);
        let wanted: Vec<f32> = network.forward(clip.clone()).into_data().try_to_vec().unwrap();
        assert!(wanted.iter().any(|logit| logit.abs() > 1e-3), "{wanted:?}");
        let shape = clip.dims();
        let numbers: Vec<f32> = clip.into_data().try_to_vec().unwrap();
        let session = Session::open_with(&Builtin, model, Device::Cpu).unwrap();
        let mut logits: Vec<f32> = Vec::new();
        let run = session.run(&[TensorView::new(&shape, &numbers[..]).unwrap()], |outputs| {
            logits.extend_from_slice(outputs[0].values()?);
            Ok(())
        });
        run.unwrap();
        assert_eq!(logits.len(), wanted.len());
        for (logit, wanted) in logits.iter().zip(&wanted) {
            assert!((logit - wanted).abs() < 1e-4, "{:?}: {logit} {wanted}", sizes.architecture);
        }
    }
}

#[test]
fn streams_of_every_backbone_equal_clips() {
    let (folder, device) = (Folder::new("backbones"), Trainer::flex());
    for params in [coagcn(), costr(), step_params()] {
        let sizes = params.sizes();
        let network = network(&sizes);
        let objective =
            ActionObjective { sizes: sizes.clone(), params: params.to_map(), ..objective(Form::Step) };
        let model = folder.0.join(params.backbone.name());
        objective.container(&network).unwrap().write(&model).unwrap();
        let mut continual = Handle::<CoStGcn>::new(CoStGcnParams::default(), Device::Cpu).unwrap();
        // Without the backbone of the model, its network could not be checked.
        let wrong = CoStGcnParams { backbone: Backbone::CoAGcn, ..Default::default() };
        let loaded = Handle::<CoStGcn>::new(wrong, Device::Cpu).unwrap().load(&model);
        assert_eq!(loaded.is_ok(), params.backbone == Backbone::CoAGcn);
        continual.load(&model).unwrap();
        assert_eq!(continual.params().backbone, params.backbone);
        let whole = walk(5, 31, 1);
        let writer = FrameFeatures::new(sizes.graph.parents(), sizes.coordinates);
        let mut work = ClipScratch::default();
        for end in 1..=31 {
            let step = continual.infer(&part(&whole, end - 1, end)).unwrap();
            assert!(writer.clip_into(&part(&whole, 0, end), 0, sizes.frames, &mut work));
            let shape = [1, sizes.features(), sizes.frames, JOINTS];
            let clip = Tensor::<4>::from_data(TensorData::new(work.clip.clone(), shape), &device);
            let logits = network.forward(clip);
            let wanted =
                burn::tensor::activation::softmax(logits, 1).into_data().try_to_vec::<f32>().unwrap();
            for (a, b) in step.probabilities.iter().zip(&wanted) {
                assert!((a - b).abs() < 1e-4, "{} after {end} frames: {a} {b}", params.backbone.name());
            }
        }
    }
}

#[test]
fn selected_frames_have_the_highest_attention_and_keep_their_order() {
    let device = Trainer::flex();
    let [selection, whole] = [3, 6].map(|kept| FrameSelection::new(6, kept, &device));
    let whole = whole.load_record(selection.clone().into_record());
    let number = |at: usize| 1.0 + (at / 2) as f32;
    // One channel, six frames of two joints: the frame's number in both.
    let clip = TensorData::new((0..12).map(number).collect::<Vec<f32>>(), [1, 1, 6, 2]);
    let clip = Tensor::<4>::from_data(clip, &device);
    let weights: Vec<f32> =
        (whole.forward(clip.clone()).into_data().try_to_vec::<f32>().unwrap().iter().enumerate())
            .map(|(at, weighted)| weighted / number(at))
            .collect();
    let mut order: Vec<usize> = (0..6).collect();
    order.sort_by(|a, b| weights[2 * b].total_cmp(&weights[2 * a]));
    let mut best = order[..3].to_vec();
    best.sort_unstable();
    let kept: Vec<f32> = selection.forward(clip).into_data().try_to_vec().unwrap();
    let wanted: Vec<f32> =
        best.iter().flat_map(|frame| [2 * frame, 2 * frame + 1]).map(|at| number(at) * weights[at]).collect();
    assert!(
        kept.iter().zip(&wanted).all(|(kept, wanted)| (kept - wanted).abs() < 1e-5),
        "{kept:?} {wanted:?}"
    );
}

#[test]
fn parameters_that_contradict_the_architecture_are_refused() {
    let refused = |params: SpatioTemporalGcnParams, what: &str| {
        let error = params.sizes().and_then(|sizes| sizes.pooled_frames()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidParam);
        assert!(error.to_string().contains(what), "{error}");
    };
    refused(SpatioTemporalGcnParams { stbln_symmetric: true, ..clip_params() }, "choose stbln");
    refused(SpatioTemporalGcnParams { stbln_symmetric: true, ..tagcn() }, "method_name = tagcn");
    refused(SpatioTemporalGcnParams { num_subframes: 21, ..tagcn() }, "give at most 20");
    refused(SpatioTemporalGcnParams { num_subframes: 4, ..tagcn() }, "use more num_subframes");
    refused(SpatioTemporalGcnParams { channels: Some(vec![8, 8]), ..tagcn() }, "give more than 2");
    let refused = |params: CoStGcnParams, what: &str| {
        let error = params.sizes().pooled_frames().unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidParam);
        assert!(error.to_string().contains(what), "{error}");
    };
    refused(CoStGcnParams { channels: vec![8, 8, 8], ..costr() }, "choose costgcn");
    refused(CoStGcnParams { channels: vec![8, 8, 8, 48], ..costr() }, "multiples of 32");
}

#[test]
fn default_sizes_are_those_of_opendr() {
    let of =
        |method_name: Method| SpatioTemporalGcnParams { method_name, ..Default::default() }.sizes().unwrap();
    assert_eq!(of(Method::TaGcn).channels, [64, 64, 128, 128, 256, 256]);
    assert_eq!(
        (of(Method::TaGcn).pooled_frames().unwrap(), of(Method::StGcn).pooled_frames().unwrap()),
        (68, 220)
    );
    for method in [Method::StGcn, Method::StBln] {
        assert_eq!(of(method).channels, [64, 64, 64, 64, 128, 128, 128, 256, 256, 256]);
    }
    for backbone in [Backbone::CoStGcn, Backbone::CoAGcn, Backbone::CoSTr] {
        CoStGcnParams { backbone, ..Default::default() }.sizes().pooled_frames().unwrap();
    }
}

#[test]
fn models_of_other_architectures_are_refused() {
    let folder = Folder::new("methods");
    let params = stbln(true);
    let sizes = params.sizes().unwrap();
    let objective = ActionObjective { params: params.to_map(), ..objective_of(&sizes) };
    objective.container(&network(&sizes)).unwrap().write(&folder.0).unwrap();
    let load = |method_name: Method| {
        let params = SpatioTemporalGcnParams { method_name, ..Default::default() };
        Handle::<SpatioTemporalGcn>::new(params, Device::Cpu).unwrap().load(&folder.0)
    };
    load(Method::StBln).unwrap();
    // The default is replaced by that of the model.
    load(Method::StGcn).unwrap();
    assert_eq!(load(Method::TaGcn).unwrap_err().kind(), ErrorKind::InvalidParam);
    let error = co_st_gcn_from(&Model::open(&folder.0).unwrap()).err().unwrap();
    assert!(error.to_string().contains("method_name = stbln"), "{error}");
}

#[test]
fn every_method_trains_and_is_loaded() {
    let (folder, dataset) = (Folder::new("trains"), &Walks as &dyn DatasetIterator);
    let mut fit_params = SpatioTemporalGcnFitParams::default();
    (fit_params.training.epochs, fit_params.training.batch_size, fit_params.training.lr) = (1, 4, 0.01);
    for params in [tagcn(), stbln(false), stbln(true)] {
        let name = format!("{}-{}", params.method_name.name(), params.stbln_symmetric);
        let (output, mut handle) =
            (folder.0.join(name), Handle::<SpatioTemporalGcn>::new(params.clone(), Device::Cpu).unwrap());
        let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
        handle.fit(&fit_params, dataset.into(), Some(dataset.into()), &job).unwrap();
        let mut fresh = Handle::<SpatioTemporalGcn>::new(Default::default(), Device::Cpu).unwrap();
        fresh.load(job.model()).unwrap();
        assert_eq!(fresh.params().method_name, params.method_name);
        assert_eq!(fresh.infer(&walk(0, 12, 2)).unwrap(), handle.infer(&walk(0, 12, 2)).unwrap());
        let walks = (0..3).map(|seed| Value::SkeletonSequence(walk(seed, 9, 2))).collect();
        check::<SpatioTemporalGcn>(&job.model(), &output.join("scratch"), walks);
    }
    let mut fit_params = CoStGcnFitParams::default();
    (fit_params.training.epochs, fit_params.training.batch_size, fit_params.dropout) = (1, 5, 0.2);
    for params in [coagcn(), costr()] {
        let output = folder.0.join(params.backbone.name());
        let mut handle = Handle::<CoStGcn>::new(params, Device::Cpu).unwrap();
        let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
        handle.fit(&fit_params, dataset.into(), None, &job).unwrap();
        let walks = (0..3).map(|seed| Value::SkeletonSequence(walk(seed, 9, 2))).collect();
        check::<CoStGcn>(&job.model(), &output.join("scratch"), walks);
    }
}
