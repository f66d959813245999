use opendr_engine::data::PointCloud;
use opendr_engine::dataset::{Dataset, DatasetIterator, DatasetRef, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::target::HeatmapValues;
use opendr_engine::{ErrorKind, Random, Value};
use opendr_perception_testing::learner_checks::check_trained_learner;
use opendr_perception_testing::overfit::losses_on_one_batch;
use opendr_simulation::street::StreetSegments;

use super::network::RangeNetwork;
use super::objective::LabelledScans;
use super::*;

const ROWS: usize = 16;
const COLUMNS: usize = 32;

fn streets() -> StreetSegments {
    StreetSegments::new(5, 2)
}

fn labels(map: &Heatmap) -> &[u32] {
    match map.values() {
        HeatmapValues::Labels(labels) => labels,
        HeatmapValues::Scores(_) => panic!("no labels"),
    }
}

/// Boards of two reflectances in front of the lidar.
struct Boards;

impl Dataset for Boards {}

impl DatasetIterator for Boards {
    fn len(&self) -> usize {
        6
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let mut random = Random::new(index as u64);
        let (mut points, mut ground_truth) = (Vec::new(), Vec::new());
        for row in 0..ROWS {
            for column in 0..COLUMNS {
                let (elevation, azimuth) = (0.1 - row as f32 * 0.0125, 0.38 - column as f32 * 0.025);
                let is_board = (column + 2 * index) % 16 < 6;
                let distance = if is_board { 6.0 } else { 14.0 } + 0.1 * random.normal() as f32;
                let level = if is_board { 0.8 } else { 0.2 };
                points.extend([
                    distance * azimuth.cos(),
                    distance * azimuth.sin(),
                    distance * elevation,
                    level,
                ]);
                ground_truth.push(if is_board { 1001 + ((column + 2 * index) / 16) as u32 } else { 0 });
            }
        }
        let cloud = PointCloud::new(points, [ground_truth.len(), 4])?;
        let count = ground_truth.len();
        Ok(Sample {
            data: vec![cloud.into()],
            target: Some(Heatmap::from_labels(ground_truth, &[count])?.into()),
        })
    }

    fn classes(&self) -> Classes {
        ["wall", "board"].into_iter().collect()
    }
}

fn fit_params() -> EfficientLpsFitParams {
    let mut params = EfficientLpsFitParams {
        rows: ROWS,
        columns: COLUMNS,
        fov_up: 6.5,
        fov_down: -6.0,
        half_view: 23.0,
        width: 4,
        ..EfficientLpsFitParams::default()
    };
    (params.training.epochs, params.training.batch_size, params.training.lr) = (40, 6, 0.01);
    params
}

#[test]
fn overfits_one_batch() {
    let streets = streets();
    let view = RangeView { rows: 32, columns: 64, top: 0.05, bottom: -0.44, half_view: 0.76 };
    let objective = LabelledScans { classes: streets.classes(), things: vec![0], view };
    let samples = (0..2).map(|index| streets.get(index).unwrap()).collect();
    let network = |device: &_| RangeNetwork::new(streets.classes().len(), 8, device);
    let [before, after] = losses_on_one_batch(&objective, network, samples, 0.01);
    assert!(after < 0.1 * before, "{before} {after}");
}

#[test]
fn infer_loads_the_model_of_fit_and_boards_are_objects() {
    let output = std::env::temp_dir().join(format!("opendr-lps-{}", std::process::id()));
    std::fs::remove_dir_all(&output).ok();
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
    let boards = || DatasetRef::from(&Boards as &dyn DatasetIterator);
    let params = EfficientLpsParams { things: vec![1], ..EfficientLpsParams::default() };
    let mut handle = Handle::<EfficientLps>::new(params.clone(), Device::Cpu).unwrap();
    handle.fit(&fit_params(), boards(), Some(boards()), &job).unwrap();
    // The container contains the thing classes.
    let mut handle = Handle::<EfficientLps>::new(EfficientLpsParams::default(), Device::Cpu).unwrap();
    handle.load(job.model()).unwrap();
    let Sample { data, target } = Boards.get(2).unwrap();
    let (Some(Value::PointCloud(cloud)), Some(Value::Heatmap(ground_truth))) = (data.first(), &target) else {
        panic!()
    };
    let found = handle.infer(Scan::from(cloud)).unwrap();
    let (instances, classes) = (labels(&found.instance), labels(&found.semantic));
    let right = labels(ground_truth)
        .iter()
        .zip(classes)
        .filter(|(ground_truth, class)| *ground_truth / 1000 == **class)
        .count();
    assert!(right * 100 > 93 * cloud.len(), "{right} of {}", cloud.len());
    let mut boards: Vec<u32> =
        instances.iter().copied().filter(|label| (1001..2000).contains(label)).collect();
    boards.sort_unstable();
    boards.dedup();
    assert!((2..=4).contains(&boards.len()), "{boards:?}");
    assert!(found.depth.shape() == [0, 0] && found.instance.shape() == [cloud.len()]);
    let strange = PointCloud::new(vec![f32::NAN, 1.0, 1.0, f32::INFINITY, 0.0, 0.0], [2, 3]).unwrap();
    assert_eq!(labels(&handle.infer(Scan::from(&strange)).unwrap().instance), [255_000; 2]);
    let calls = (0..3).map(|index| Boards.get(index).unwrap().data).collect();
    check_trained_learner::<EfficientLps>(&job.model(), &output.join("scratch"), calls);
    handle.set("projected", true.into()).unwrap();
    let found = handle.infer(Scan::from(cloud)).unwrap();
    assert_eq!((found.instance.shape(), found.depth.shape()), (&[ROWS, COLUMNS][..], &[ROWS, COLUMNS][..]));
    std::fs::remove_dir_all(&output).ok();
}

#[test]
fn invalid_parameters_are_refused() {
    let job = FitJob::new(std::path::Path::new("/nowhere"));
    let boards = || DatasetRef::from(&Boards as &dyn DatasetIterator);
    let fit = |params: EfficientLpsParams, fit_params: EfficientLpsFitParams| {
        <EfficientLps as opendr_engine::learner::Fit>::fit(None, &params, &fit_params, boards(), None, &job)
            .unwrap_err()
    };
    let odd = EfficientLpsFitParams { rows: 20, ..fit_params() };
    assert_eq!(fit(EfficientLpsParams::default(), odd).kind(), ErrorKind::InvalidParam);
    let upside_down = EfficientLpsFitParams { fov_down: 7.0, ..fit_params() };
    assert_eq!(fit(EfficientLpsParams::default(), upside_down).kind(), ErrorKind::InvalidParam);
    let far = EfficientLpsParams { things: vec![2], ..EfficientLpsParams::default() };
    assert!(fit(far, fit_params()).to_string().contains("things has class 2"));
}
