//! Properties of every camera policy on every rig: a motion has the axes of the rig, each in [-1, 1], or the policy refuses.

use std::cell::RefCell;
use std::path::Path;

use half::f16;
use opendr_active::rig::{PanTiltZoom, RecordedViews};
use opendr_active::{
    Active, ActiveModel, Belief, BestViewEstimator, CameraContext, CameraPolicy, EnvironmentRig, Fusion,
    GainNetwork, GainSamples, GreedyPolicy, Observer, OracleBaseline, OrbitBaseline, RandomBaseline,
    StaticBaseline, StopRule, TrainedPolicy, ViewNetworkConfig, ViewRecogniser,
};
use opendr_engine::data::Image;
use opendr_engine::environment::{EnvironmentSource as _, EnvironmentSpec, Space};
use opendr_engine::params::ParamMap;
use opendr_engine::rig::{Achieved, ViewAxis, ViewPose, ViewRig, ViewSphere};
use opendr_engine::target::{Action, ActionBase as _};
use opendr_engine::{ErrorKind, Random, Result};
use opendr_kernels::Compute;
use opendr_rl::{Bounds, Head, NetworkConfig, ParameterInit, Policy};
use opendr_simulation::RegisteredSource;
use opendr_simulation::sphere_view::SphereWorld;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

const WORLDS: [&str; 3] = ["SphereView-Face-v1", "SphereView-Object-v1", "SphereView-Pose-v1"];
const CLASSES: usize = 4;
const BUDGET: usize = 6;

/// A rig whose images are of one colour.
struct Plain(ViewSphere);

impl ViewRig for Plain {
    fn axes(&self) -> &[ViewAxis] {
        self.0.axes()
    }

    fn pose(&self) -> ViewPose {
        self.0.pose()
    }

    fn apply(&mut self, action: &Action) -> Result<Achieved> {
        self.0.apply(action)
    }

    fn capture(&mut self) -> Result<Image> {
        Image::from_rgb8(vec![90; 3 * 5 * 4], 5, 4)
    }
}

/// A rig of the list, and how an episode of it begins.
enum Rig {
    World(Box<EnvironmentRig>),
    Other(Box<dyn ViewRig>),
}

impl Rig {
    fn begin(&mut self, seed: u64) -> &mut dyn ViewRig {
        match self {
            Self::World(rig) => {
                rig.begin(seed).unwrap();
                rig.as_mut()
            }
            Self::Other(rig) => rig.as_mut(),
        }
    }
}

/// Every world, and every kind of rig with 1 to 4 axes.
fn rigs(folder: &Path) -> Vec<Rig> {
    let world = |id: &&str| {
        let source = RegisteredSource::new(id, &ParamMap::new()).unwrap();
        Rig::World(Box::new(EnvironmentRig::new(source.make().unwrap()).unwrap()))
    };
    let near = ViewPose { distance: 1.0, ..ViewPose::default() };
    let far = ViewPose { distance: 3.0, ..ViewPose::default() };
    let large = Image::from_rgb8((0..3 * 60 * 40).map(|at| (at % 251) as u8).collect(), 60, 40).unwrap();
    let spheres = [
        ViewSphere::camera(far),
        ViewSphere::drone([1.0, 4.0], far),
        ViewSphere::wrist_camera(1.2, [0.2, 0.8], near),
        ViewSphere::new(all_axes(), near),
    ];
    let others = spheres.into_iter().map(|sphere| Box::new(Plain(sphere.unwrap())) as Box<dyn ViewRig>);
    let recorded = (1..=4).map(|axes| Box::new(recorded_views(folder, axes)) as Box<dyn ViewRig>);
    let further: [Box<dyn ViewRig>; 2] =
        [Box::new(SphereWorld::new(16).unwrap()), Box::new(PanTiltZoom::new(large, 1.0, [20, 16]).unwrap())];
    let others = others.chain(recorded).chain(further).map(Rig::Other);
    WORLDS.iter().map(world).chain(others).collect()
}

fn all_axes() -> Vec<ViewAxis> {
    vec![
        ViewAxis::turning("azimuth", 0.6),
        ViewAxis::limited("elevation", 0.3, -0.9, 0.9),
        ViewAxis::limited("distance", -0.2, 0.5, 2.0),
        ViewAxis::limited("roll", 0.4, -1.5, 1.5),
    ]
}

fn recorded_views(folder: &Path, axes: usize) -> RecordedViews {
    let image = Image::from_rgb8(vec![60; 27], 3, 3).unwrap();
    opendr_vision::save(&image, folder.join("view.png")).unwrap();
    let pose = |azimuth: f64| ViewPose { azimuth, distance: 1.0, ..ViewPose::default() };
    let views: Vec<_> = [0.0, 1.0, -2.0]
        .map(|azimuth| serde_json::json!({"image": "view.png", "pose": pose(azimuth)}))
        .into_iter()
        .collect();
    let index = folder.join(format!("{axes}.json"));
    let text = serde_json::json!({"axes": all_axes()[..axes], "views": views}).to_string();
    std::fs::write(&index, text).unwrap();
    RecordedViews::open(&index).unwrap()
}

/// Weights that a network may have.
#[derive(Debug, Clone, Copy)]
struct Weights {
    seed: u64,
    /// Factor of the initial weights: far above 1, outputs leave the axes and overflow.
    scale: f32,
    /// Written into the bias of the last output.
    bias: Option<f32>,
    head: usize,
}

fn weights() -> impl Strategy<Value = Weights> {
    let bias = prop_oneof![
        4 => Just(None),
        1 => Just(Some(f32::NAN)),
        1 => Just(Some(f32::INFINITY)),
        1 => Just(Some(f32::NEG_INFINITY)),
        1 => Just(Some(1e30)),
    ];
    (any::<u64>(), prop_oneof![Just(1.0f32), Just(1e3), Just(1e15), Just(1e30)], bias, 0..3usize)
        .prop_map(|(seed, scale, bias, head)| Weights { seed, scale, bias, head })
}

/// Returns the bytes of the nearest finite number of half precision.
fn half(value: f32) -> [u8; 2] {
    f16::from_f32(value).clamp(f16::MIN, f16::MAX).to_le_bytes()
}

impl Weights {
    /// Returns whether the network certainly has no finite output.
    fn is_damaged(&self) -> bool {
        self.bias.is_some_and(|bias| !bias.is_finite())
    }

    fn policy(&self, axes: usize) -> Policy {
        let (seen, action) =
            (Space::symmetric(&[f32::INFINITY; Observer::LEN]), Space::symmetric(&vec![1.0; axes]));
        let bounds = Bounds { low: vec![-1.0; axes], high: vec![1.0; axes] };
        let head =
            [Head::Gaussian(bounds.clone()), Head::Squashed(bounds.clone()), Head::SquashedGaussian(bounds)];
        let spec = EnvironmentSpec::new("Camera-v0", seen, action);
        let config = NetworkConfig { net_arch: vec![16], ..NetworkConfig::default() };
        let mut policy = Policy::new(&spec, head[self.head].clone(), &config, None).unwrap();
        policy.initialise(ParameterInit::Orthogonal(1.0), 0.0, &mut Random::new(self.seed));
        policy.parameters_mut().iter_mut().for_each(|parameter| *parameter *= self.scale);
        let last = policy.parameters().len() - policy.log_std().len() - 1;
        if let Some(bias) = self.bias {
            policy.parameters_mut()[last] = bias;
        }
        policy
    }

    /// An estimator of the best view with finite weights, as every file has.
    fn best_view(&self) -> BestViewEstimator {
        let config = ViewNetworkConfig { side: 12, kernels: vec![4], hidden: 8, outputs: 12 };
        let mut random = Random::new(self.seed);
        let count = (27 + 1) * 4 + (144 + 1) * 8 + (8 + 1) * 12;
        let values = (0..count).map(|_| half(0.3 * random.normal() as f32 * self.scale));
        BestViewEstimator::from_bytes(config, values.collect::<Vec<_>>().as_flattened()).unwrap()
    }

    /// A network of gains with finite weights, as every file has: only overflows give other outputs.
    fn gain(&self, axes: usize) -> GainNetwork {
        let mut random = Random::new(self.seed);
        let mut samples = GainSamples::default();
        let motion = vec![0.5; axes];
        (0..128).for_each(|_| samples.add(&[random.uniform(-1.0, 1.0); Observer::LEN], &motion, 0.1));
        let bytes = GainNetwork::fit(&samples, axes, 1, self.seed, &Compute::single()).unwrap().to_bytes();
        let scaled = bytes
            .as_chunks::<2>()
            .0
            .iter()
            .map(|value| half(f16::from_le_bytes(*value).to_f32() * self.scale));
        GainNetwork::from_bytes(axes, scaled.collect::<Vec<_>>().as_flattened()).unwrap()
    }
}

/// The camera policies, by their place.
fn camera_policy(place: usize, weights: Weights, axes: usize) -> Box<dyn CameraPolicy> {
    match place {
        0 => Box::new(StaticBaseline),
        1 => Box::<RandomBaseline>::default(),
        2 => Box::new(OrbitBaseline),
        3 => Box::new(OracleBaseline),
        4 => Box::new(GreedyPolicy::new(weights.gain(axes))),
        _ => Box::new(TrainedPolicy::new(weights.policy(axes))),
    }
}

const TRAINED: usize = 5;

/// An episode: world and subject, camera policy, the best pose for the oracle, evidence of the views.
#[derive(Debug, Clone)]
struct Case {
    rig: usize,
    seed: u64,
    camera_policy: usize,
    weights: Weights,
    best: Option<[f64; 3]>,
    evidence: Vec<[f32; CLASSES]>,
}

fn cases(rigs: usize) -> impl Strategy<Value = Case> {
    let best = prop::option::of([-1e6f64..1e6, -3.0f64..3.0, 0.0f64..1e3]);
    let evidence = prop::collection::vec(prop::array::uniform4(-30.0f32..0.0), 1..5);
    // Trained policies more often than one of the others: they have the weights.
    let camera_policy = prop_oneof![1 => 0..TRAINED, 1 => Just(TRAINED)];
    (0..rigs, any::<u32>(), camera_policy, weights(), best, evidence).prop_map(
        |(rig, seed, camera_policy, weights, best, evidence)| Case {
            rig,
            seed: seed.into(),
            camera_policy,
            weights,
            best,
            evidence,
        },
    )
}

fn property(rig: &mut dyn ViewRig, case: &Case) -> std::result::Result<(), TestCaseError> {
    let axes = rig.axes().to_vec();
    let mut camera_policy = camera_policy(case.camera_policy, case.weights, axes.len());
    let mut belief = Belief::new(CLASSES, Fusion::default()).unwrap();
    let best_view =
        case.seed.is_multiple_of(2).then(|| Weights { bias: None, scale: 1.0, ..case.weights }.best_view());
    let mut observer = Observer::new(&axes, BUDGET, best_view);
    observer.reset(rig.pose());
    camera_policy.begin(case.seed);
    let (mut observation, mut deflections) = (vec![0.0; Observer::LEN], vec![f32::NAN; axes.len()]);
    let best = case.best.map(|[azimuth, elevation, distance]| ViewPose {
        azimuth,
        elevation,
        distance,
        fourth: 0.0,
    });
    for evidence in &case.evidence {
        observer.add(&rig.capture().unwrap(), rig.pose()).unwrap();
        belief.add(rig.pose(), evidence).unwrap();
        observer.observe(&rig.pose(), &belief, &mut observation);
        let context = CameraContext { observation: &observation, pose: rig.pose(), axes: &axes, best };
        match camera_policy.choose(&context, &mut deflections) {
            Ok(()) => {
                prop_assert!(
                    !(case.camera_policy == TRAINED && case.weights.is_damaged()),
                    "{deflections:?}"
                );
                prop_assert!(deflections.iter().all(|axis| (-1.0..=1.0).contains(axis)), "{deflections:?}");
                let action = Action::new(&deflections).unwrap();
                prop_assert_eq!(action.axes().len(), axes.len());
                observer.set_motion(rig.apply(&action).unwrap());
            }
            Err(error) => {
                prop_assert!(case.camera_policy >= 4, "a baseline: {}", error);
                prop_assert_eq!(error.kind(), ErrorKind::Internal, "{}", error);
                return Ok(());
            }
        }
    }
    Ok(())
}

#[test]
fn every_policy_moves_every_rig_by_its_axes() {
    let folder = std::env::temp_dir().join(format!("opendr-camera-policies-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let rigs = RefCell::new(rigs(&folder));
    let count = rigs.borrow().len();
    let run = |case: Case| {
        let mut rigs = rigs.borrow_mut();
        property(rigs[case.rig].begin(case.seed), &case)
    };
    TestRunner::default().run(&cases(count), run).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Evidence that depends on the image alone.
struct ByBrightness;

impl ViewRecogniser for ByBrightness {
    fn classes(&self) -> usize {
        CLASSES
    }

    fn recognise(&mut self, image: &Image, evidence: &mut [f32]) -> Result<()> {
        let opendr_engine::data::Pixels::U8(pixels) = image.pixels() else { return Ok(()) };
        let sum: usize = pixels.iter().map(|level| usize::from(*level)).sum();
        evidence.fill(-1.0);
        evidence[sum % CLASSES] = 0.0;
        Ok(())
    }
}

/// The same of whole runs: a model with any weights proposes motions of the rig's axes, or the run is an error.
#[test]
fn every_run_moves_the_rig_by_its_axes() {
    let folder = std::env::temp_dir().join(format!("opendr-camera-runs-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let rigs = RefCell::new(rigs(&folder));
    let count = rigs.borrow().len();
    let run = |(rig, seed, weights, gain): (usize, u32, Weights, Weights)| {
        let mut rigs = rigs.borrow_mut();
        let rig = rigs[rig].begin(seed.into());
        let axes = rig.axes().to_vec();
        let stop = StopRule { moves: 4, ..StopRule::default() };
        let model = ActiveModel {
            policy: weights.policy(axes.len()),
            best_view: seed.is_multiple_of(2).then(|| gain.best_view()),
            gain: gain.gain(axes.len()),
            fusion: Fusion::default(),
            stop,
            axes: axes.clone(),
        };
        match Active::new(ByBrightness, &model).unwrap().run(rig) {
            Ok(outcome) => {
                prop_assert!(!weights.is_damaged());
                let (last, moved) = outcome.views.split_last().unwrap();
                prop_assert!(last.action.is_none() && moved.len() <= stop.moves);
                for view in moved {
                    let action = view.action.unwrap();
                    prop_assert_eq!(action.axes().len(), axes.len());
                    prop_assert!(action.axes().iter().all(|axis| (-1.0..=1.0).contains(axis)));
                    prop_assert!(view.expected_gain.unwrap().is_finite());
                }
            }
            Err(error) => prop_assert_eq!(error.kind(), ErrorKind::Internal, "{}", error),
        }
        Ok(())
    };
    TestRunner::default().run(&(0..count, any::<u32>(), weights(), weights()), run).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_policy_of_other_axes_refuses() {
    let weights = Weights { seed: 1, scale: 1.0, bias: None, head: 0 };
    let axes = all_axes();
    let observation = vec![0.1; Observer::LEN];
    let context =
        CameraContext { observation: &observation, pose: ViewPose::default(), axes: &axes, best: None };
    for place in [4, TRAINED] {
        for other in [1, 3] {
            let mut camera_policy = camera_policy(place, weights, other);
            let error = camera_policy.choose(&context, &mut [0.0; 4]).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::InvalidInput, "{error}");
        }
    }
}
