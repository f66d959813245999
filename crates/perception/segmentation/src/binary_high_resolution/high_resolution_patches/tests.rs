use opendr_engine::dataset::{Dataset, DatasetIterator, DatasetRef, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::target::{BoundingBox, BoundingBoxList, Category, HeatmapValues};
use opendr_engine::{Random, Value};
use opendr_perception_common::regions::Region;
use opendr_perception_testing::learner_checks::check_trained_learner;
use opendr_perception_testing::overfit::losses_on_one_batch;

use super::objective::{PatchBatches, Patches};
use super::*;

/// Returns noise with a bright ring of 40 pixels around each of `places`.
fn picture(seed: u64, [width, height]: [usize; 2], places: &[[usize; 2]]) -> Image {
    let mut random = Random::new(seed);
    let samples = (0..width * height).flat_map(|at| {
        let ring = places.iter().any(|[x, y]| {
            let far = ((at % width) as f32 - *x as f32).hypot((at / width) as f32 - *y as f32);
            (12.0..20.0).contains(&far)
        });
        let level = random.below(60) as u8;
        if ring { [220, 200, level] } else { [level, level, 80] }
    });
    Image::from_rgb8(samples.collect(), width, height).unwrap()
}

/// Patches; every other one has a ring.
struct Rings;

impl Dataset for Rings {}

impl DatasetIterator for Rings {
    fn len(&self) -> usize {
        16
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let class = index % 2;
        let places = [[28 + index % 8, 36 - index % 5]];
        let image = picture(index as u64, [64, 64], &places[..class]);
        Ok(Sample { data: vec![image.into()], target: Some(Category::new(class as i64, None).into()) })
    }
}

#[test]
fn overfits_one_batch() {
    let params = HighResolutionPatchesParams::default();
    let objective = Patches { params: &params, most: 4 };
    let samples = (0..Rings.len()).map(|index| Rings.get(index).unwrap()).collect();
    let network =
        |device: &burn::tensor::Device| network::PatchNetwork::new(PatchArchitecture::Vgg720p, device);
    let [before, after] = losses_on_one_batch(&objective, network, samples, 0.002);
    assert!(after < 0.1 * before, "{before} {after}");
}

#[test]
fn patches_are_cut_at_boxes_and_outside_of_them() {
    let params = HighResolutionPatchesParams::default();
    let batches: PatchBatches =
        opendr_training::Objective::collate(&Patches { params: &params, most: 4 }).unwrap();
    let image = picture(1, [400, 300], &[]);
    let boxes = [[10.0, 10.0, 40.0, 40.0], [380.0, 280.0, 60.0, 60.0], [f32::NAN, 0.0, 5.0, 5.0]];
    let boxes = boxes.map(|[left, top, width, height]| BoundingBox::new(0, left, top, width, height, 1.0));
    let places = batches.places(&image, &boxes.to_vec().into());
    let of = |class: i64| places.iter().filter(move |place| place.0 == class).map(|place| place.1);
    let region = |x, y| Region { x, y, width: 64, height: 64 };
    assert_eq!(of(1).collect::<Vec<_>>(), [region(0, 0), region(336, 236)]);
    assert_eq!(of(0).count(), 2);
    assert!(of(0).all(|patch| !patch.overlaps(&region(10, 10)) || patch.x >= 50 || patch.y >= 50));
    let small = batches.places(&picture(1, [20, 10], &[]), &BoundingBoxList::default());
    assert_eq!(small, [(0, Region { x: 0, y: 0, width: 20, height: 10 })]);
}

#[test]
fn infer_loads_the_model_of_fit_and_detects_rings_in_large_images() {
    let output = std::env::temp_dir().join(format!("opendr-patches-{}", std::process::id()));
    std::fs::remove_dir_all(&output).ok();
    let mut fit_params = HighResolutionPatchesFitParams::default();
    (fit_params.training.epochs, fit_params.training.batch_size, fit_params.training.lr) = (30, 8, 0.005);
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
    let mut handle = Handle::<HighResolutionPatches>::new(Default::default(), Device::Cpu).unwrap();
    let rings = || DatasetRef::from(&Rings as &dyn DatasetIterator);
    handle.fit(&fit_params, rings(), Some(rings()), &job).unwrap();
    for index in 0..Rings.len() {
        let Some(Value::Image(patch)) = Rings.get(index).unwrap().data.pop() else { panic!("no picture") };
        assert_eq!(handle.infer(&patch).unwrap().category.class, (index % 2) as i64);
    }
    let image = picture(77, [640, 360], &[[200, 120]]);
    let HighResolutionPatchesTargets { map, category } = handle.infer(&image).unwrap();
    assert_eq!(category.class, 1);
    // (640 - 64) / 8 + 1, except for the borders.
    let (rows, columns) = (map.shape()[0], map.shape()[1]);
    assert!((36..=38).contains(&rows) && (71..=73).contains(&columns), "{rows}x{columns}");
    let HeatmapValues::Scores(scores) = map.values() else { panic!("no scores") };
    let best = (0..scores.len()).max_by(|a, b| scores[*a].total_cmp(&scores[*b])).unwrap();
    let middle = [best % columns * 8 + 32, best / columns * 8 + 32];
    let off = [middle[0].abs_diff(200), middle[1].abs_diff(120)];
    assert!(off.iter().all(|off| *off <= 24) && scores[best] > 0.8, "{middle:?}: {}", scores[best]);
    assert!(scores.iter().filter(|score| **score > 0.5).count() < scores.len() / 10);
    let tiny = handle.infer(&picture(3, [1, 1], &[])).unwrap();
    assert_eq!(tiny.map.shape(), [1, 1]);
    let calls = (0..3).map(|index| vec![Value::from(picture(index, [80, 70], &[[40, 40]]))]).collect();
    check_trained_learner::<HighResolutionPatches>(&job.model(), &output.join("scratch"), calls);
    std::fs::remove_dir_all(&output).ok();
}
