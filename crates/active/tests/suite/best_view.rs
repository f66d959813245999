//! The direction to the best view: training, fusion of ambiguous views, views of each epoch.

use opendr_active::{
    BestViewBelief, BestViewEstimator, EnvironmentRig, LabelledViews, ViewSource as _, fit_best_view,
};
use opendr_engine::data::Image;
use opendr_engine::environment::EnvironmentSource as _;
use opendr_engine::rig::{ViewPose, ViewRig as _};
use opendr_engine::{ErrorKind, Random, Silent};
use opendr_kernels::Compute;

use crate::small::{source, views};

/// Views of 12 x 12 pixels whose three bright quadrants are the parts of the direction to the best one; with `ambiguous`, the
/// quadrant of the second part shows its magnitude alone.
fn painted(count: usize, ambiguous: bool) -> LabelledViews {
    let mut random = Random::new(8);
    let mut views = LabelledViews { side: 12, classes: 2, ..LabelledViews::default() };
    for _ in 0..count {
        let vector: [f32; 3] = std::array::from_fn(|_| random.normal() as f32);
        let length = vector.iter().map(|part| part * part).sum::<f32>().sqrt();
        let [x, y, z] = vector.map(|part| part / length);
        let levels =
            [x, if ambiguous { y.abs() } else { y }, z, 0.0].map(|part| (127.0 + 100.0 * part) as u8);
        let quadrant = |at: usize| levels[2 * (at / 72) + (at % 12) / 6];
        views.pixels.extend((0..144).flat_map(|at| [quadrant(at); 3]));
        views.best.push([x, y, z]);
        views.labels.push(0);
    }
    views
}

fn image(views: &LabelledViews, at: usize) -> Image {
    Image::from_rgb8(views.pixels[at * 432..(at + 1) * 432].to_vec(), 12, 12).unwrap()
}

fn trained(ambiguous: bool) -> BestViewEstimator {
    let (mut views, compute) = (painted(2000, ambiguous), Compute::single());
    fit_best_view(&mut views, (15, 1), (&compute, &Silent), &mut |_, _| ()).unwrap()
}

#[test]
fn the_direction_is_learnt() {
    let (mut estimator, held) = (trained(false), painted(2100, false));
    let camera = ViewPose { distance: 3.0, ..ViewPose::default() };
    let median_error = |estimator: &mut BestViewEstimator| {
        let mut errors: Vec<f32> = (2000..2100)
            .map(|at| {
                let mut belief = BestViewBelief::default();
                belief.add(camera, &estimator.estimate(&image(&held, at)).unwrap());
                let direction = belief.best().direction;
                let cosine: f32 = held.best[at].iter().zip(direction).map(|(a, b)| a * b).sum();
                cosine.clamp(-1.0, 1.0).acos().to_degrees()
            })
            .collect();
        errors.sort_by(f32::total_cmp);
        errors[50]
    };
    let bytes = estimator.to_bytes();
    let mut again = BestViewEstimator::from_bytes(estimator.config().clone(), &bytes).unwrap();
    let error = median_error(&mut estimator);
    assert!(error < 15.0, "{error} degrees");
    assert_eq!(median_error(&mut again), error);

    let refused = BestViewEstimator::from_bytes(estimator.config().clone(), &bytes[4..]).unwrap_err();
    assert_eq!(refused.kind(), ErrorKind::Format, "{refused}");
    let mut other = estimator.config().clone();
    other.outputs = 3;
    assert!(BestViewEstimator::from_bytes(other, &bytes).is_err());
}

#[test]
fn two_directions_that_look_alike_are_both_likely() {
    let (mut estimator, held) = (trained(true), painted(2000, true));
    let aside = (0..2000).find(|at| held.best[*at][1] > 0.95).unwrap();
    let estimate = estimator.estimate(&image(&held, aside)).unwrap();
    let even = 1.0 / (4.0 * std::f32::consts::PI);
    let density = |direction| estimate.density(direction) / even;
    let [left, right] = [density([0.0, 1.0, 0.0]), density([0.0, -1.0, 0.0])];
    assert!(left > 2.0 && right > 2.0, "{left} {right} times the even density");
    assert!([1.0, -1.0].into_iter().all(|x| density([x, 0.0, 0.0]) < 0.5), "{estimate:?}");
}

#[test]
fn every_second_epoch_has_other_views() {
    let mut source = views(10);
    let first = source.views(0, &Silent).unwrap().pixels.clone();
    assert!(
        source.views(0, &Silent).unwrap().pixels == first && source.views(0, &Silent).unwrap().has_best()
    );
    assert!(
        source.views(1, &Silent).unwrap().pixels == first
            && source.views(2, &Silent).unwrap().pixels != first
    );
    assert!(views(10).views(0, &Silent).unwrap().pixels == first, "the same seed, other views");
    let mut unknown = source.views(0, &Silent).unwrap().clone();
    unknown.best.clear();
    let error =
        fit_best_view(&mut unknown, (1, 1), (&Compute::single(), &Silent), &mut |_, _| ()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidInput, "{error}");
}

#[test]
fn before_a_view_every_direction_is_as_likely() {
    let mut belief = BestViewBelief::default();
    let before = belief.best();
    assert!(before.certainty < 0.1 && before.mean.iter().all(|part| part.abs() < 0.01), "{before:?}");
    let (mut estimator, mut rig) = (
        fit_best_view(&mut views(20), (1, 1), (&Compute::single(), &Silent), &mut |_, _| ()).unwrap(),
        EnvironmentRig::new(source().make().unwrap()).unwrap(),
    );
    rig.begin(1).unwrap();
    let estimate = estimator.estimate(rig.image()).unwrap();
    belief.add(rig.pose(), &estimate);
    let once = belief.best();
    // The same view again adds nothing.
    belief.add(rig.pose(), &estimate);
    let twice = belief.best();
    assert!((once.certainty - twice.certainty).abs() < 1e-4, "{once:?} {twice:?}");
    belief.reset();
    assert_eq!(belief.best(), before);
    belief.add(ViewPose { azimuth: 1.0, ..rig.pose() }, &estimate);
    let turned = belief.best();
    let azimuth = |direction: [f32; 3]| direction[1].atan2(direction[0]);
    let turn = azimuth(turned.mean) - azimuth(once.mean);
    assert!((turn.sin() - 1f32.sin()).abs() < 0.05, "the direction turns with the camera: {turn}");
}
