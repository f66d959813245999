use std::collections::HashSet;

use opendr_engine::data::{Image, Layout, PixelFormat};
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::params::ParamMap;
use opendr_engine::target::{
    BoundingBox, BoundingBoxList, Heatmap, HeatmapValues, Keypoint, Pose, PoseList, Rle, Segment,
    Segmentation, Skeleton,
};
use opendr_engine::{ErrorKind, Random, Result, Value};
use proptest::prelude::*;

use super::*;
use crate::augment::{Augment, OtherSamples, Pipeline, augmentations};

/// Brightness above which a pixel belongs to the object; background and padding are darker.
const BRIGHT: u8 = 180;
const OBJECT: u32 = 7;

/// Returns all augmentations that move pixels, with parameters drawn by a seed.
fn geometric() -> Vec<Box<dyn Augment>> {
    vec![
        Box::new(Flip::default()),
        Box::new(Flip { direction: FlipDirection::Vertical }),
        Box::new(CentreCrop { width: 60, height: 130, ..Default::default() }),
        Box::new(RandomCrop { width: 90, height: 50, ..Default::default() }),
        Box::new(RandomCrop { width: 300, height: 40, ..Default::default() }),
        Box::new(RandomResizedCrop { width: 80, height: 120, ..Default::default() }),
        Box::new(Resize { width: 333, height: 77 }),
        Box::new(RandomScale::default()),
        Box::new(Letterbox { width: 128, height: 200, ..Default::default() }),
        Box::new(Rotate { max_angle: 3.1, ..Default::default() }),
        Box::new(Affine { max_angle: 0.7, max_shear: 0.3, ..Default::default() }),
    ]
}

/// Returns a bright rectangle on dark ground with two boxes around it, with masks as runs and as a polygon.
fn painted(size: [usize; 2], [left, top, right, bottom]: [usize; 4]) -> Sample {
    let [width, height] = size;
    let inside = |at: usize| (left..right).contains(&(at % width)) && (top..bottom).contains(&(at / width));
    let pixels = (0..width * height).flat_map(|at| if inside(at) { [250; 3] } else { [20; 3] }).collect();
    let mask: Vec<bool> = (0..width * height).map(inside).collect();
    let runs = Segmentation::Rle(Rle::from_mask(&mask, height as u32, width as u32).unwrap());
    let [x0, y0, x1, y1] = [left, top, right, bottom].map(|edge| edge as f32);
    let outline = Segmentation::Polygons(vec![vec![x0, y0, x1, y0, x1, y1, x0, y1]]);
    let area = (x1 - x0) * (y1 - y0);
    let boxes = [runs, outline].map(|segmentation| BoundingBox {
        segment: Some(Box::new(Segment { segmentation, area, iscrowd: false })),
        ..BoundingBox::from_corners(3, [x0, y0, x1, y1], 1.0)
    });
    let image = Image::from_rgb8(pixels, width, height).unwrap();
    Sample { data: vec![image.into()], target: Some(BoundingBoxList::from(boxes.to_vec()).into()) }
}

fn image(sample: &Sample) -> &Image {
    let Value::Image(image) = &sample.data[0] else { panic!("{:?}", sample.data) };
    image
}

fn boxes(sample: &Sample) -> &[BoundingBox] {
    let Some(Value::BoundingBoxList(list)) = &sample.target else { panic!("{:?}", sample.target) };
    &list.boxes
}

/// Returns which pixels are bright.
fn bright(image: &Image) -> Vec<bool> {
    image.hwc_u8(PixelFormat::Grey).iter().map(|level| *level > BRIGHT).collect()
}

fn count(mask: &[bool]) -> usize {
    mask.iter().filter(|inside| **inside).count()
}

/// Returns the tolerated number of wrong pixels for a box: a rim of one pixel.
fn rim(object: &BoundingBox) -> usize {
    (2.0 * (object.width + object.height)) as usize + 8
}

fn check_painted(sample: &Sample, whole_area: f32) {
    let image = image(sample);
    let (width, height) = (image.width() as f32, image.height() as f32);
    let shown = bright(image);
    for object in boxes(sample) {
        let [x0, y0, x1, y1] = object.corners();
        assert!(x0 >= 0.0 && y0 >= 0.0 && x1 <= width + 1e-3 && y1 <= height + 1e-3, "{object:?}");
        for at in (0..shown.len()).filter(|at| shown[*at]) {
            let (x, y) = ((at % image.width()) as f32 + 0.5, (at / image.width()) as f32 + 0.5);
            let around = x0 - 1.0 <= x && x <= x1 + 1.0 && y0 - 1.0 <= y && y <= y1 + 1.0;
            assert!(around, "bright at {x} {y}, box {:?}", object.corners());
        }
        let segment = object.segment.as_ref().unwrap();
        let wrong = match &segment.segmentation {
            Segmentation::Rle(runs) => {
                assert_eq!(runs.size().map(|side| side as usize), [image.height(), image.width()]);
                assert_eq!(segment.area, runs.area() as f32);
                let mask = runs.mask().unwrap();
                mask.iter().zip(&shown).filter(|(one, other)| one != other).count()
            }
            Segmentation::Polygons(outlines) => {
                assert!(outlines.iter().flatten().all(|part| part.is_finite()));
                count(&shown).abs_diff(segment.area as usize)
            }
        };
        assert!(wrong <= rim(object), "{wrong} pixels of {:?}", object);
    }
    if boxes(sample).is_empty() {
        // Less than a tenth of the box is inside; of a diagonal bar with a corner inside, less than a third.
        let share = count(&shown) as f32 / whole_area;
        assert!(share < 0.4, "no box, but {share} of the object is there");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn boxes_and_masks_match_painted_pixels(
        seed in 0u64..1 << 40,
        (left, top) in (0usize..100, 0usize..60),
        (width, height) in (12usize..60, 12usize..60),
    ) {
        let rectangle = [left, top, (left + width).min(160), (top + height).min(120)];
        for augment in geometric() {
            let mut sample = painted([160, 120], rectangle);
            augment.apply(&mut sample, &mut Random::new(seed), &OtherSamples::none()).unwrap();
            let scale = (image(&sample).width() * image(&sample).height()) as f32 / (160.0 * 120.0);
            let area = ((rectangle[2] - rectangle[0]) * (rectangle[3] - rectangle[1])) as f32;
            // Affine enlarges up to one and a half times, for any size of the image.
            check_painted(&sample, area * scale.max(1.5 * 1.5));
        }
        // A window may exclude the object's centre and then drops the box; kept boxes must be right.
        let mut sample = painted([160, 120], rectangle);
        IouCrop::default().apply(&mut sample, &mut Random::new(seed), &OtherSamples::none()).unwrap();
        prop_assert!(!boxes(&sample).is_empty());
        check_painted(&sample, 1.0);
    }

    #[test]
    fn label_maps_match_pixels(seed in 0u64..1 << 40) {
        for augment in geometric() {
            let mut sample = painted([160, 120], [40, 30, 100, 80]);
            let labels = bright(image(&sample)).iter().map(|inside| if *inside { OBJECT } else { 1 }).collect();
            sample.target = Some(Heatmap::from_labels(labels, &[120, 160]).unwrap().into());
            augment.apply(&mut sample, &mut Random::new(seed), &OtherSamples::none()).unwrap();
            let Some(Value::Heatmap(map)) = &sample.target else { panic!() };
            let HeatmapValues::Labels(labels) = map.values() else { panic!() };
            prop_assert_eq!(map.shape(), &[image(&sample).height(), image(&sample).width()][..]);
            prop_assert!(labels.iter().all(|label| [OBJECT, 1, Border::IGNORED].contains(label)));
            let shown = bright(image(&sample));
            let wrong = labels.iter().zip(&shown).filter(|(label, shown)| (**label == OBJECT) != **shown).count();
            prop_assert!(wrong <= 2 * (image(&sample).width() + image(&sample).height()), "{}", wrong);
        }
    }

    #[test]
    fn keypoints_match_painted_dots(seed in 0u64..1 << 40) {
        for (index, augment) in geometric().into_iter().enumerate() {
            let mut sample = person();
            augment.apply(&mut sample, &mut Random::new(seed), &OtherSamples::none()).unwrap();
            let Some(Value::PoseList(list)) = &sample.target else { panic!() };
            // The first two are mirror images: the left wrist is the dot of the former right one.
            let colours = if index < 2 { [1, 2, 0] } else { [1, 0, 2] };
            for pose in &list.poses {
                for (name, colour) in ["nose", "l_wri", "r_wri"].into_iter().zip(colours) {
                    let joint = pose.keypoint(name).unwrap();
                    if joint.is_detected() {
                        check_dot(image(&sample), joint, colour);
                    }
                }
            }
        }
    }
}

/// Returns an image with dots of 9 pixels: red at the left wrist, green at the nose, blue at the right wrist.
fn person() -> Sample {
    let dots = [(40, 60, "l_wri"), (80, 30, "nose"), (110, 80, "r_wri")];
    let mut pixels = vec![[20u8; 3]; 160 * 120];
    let mut pose = Pose { skeleton: Skeleton::Coco17, ..Pose::default() };
    pose.keypoints = [Keypoint::MISSING; 17].into_iter().collect();
    for (channel, (x, y, name)) in dots.into_iter().enumerate() {
        for (dx, dy) in (0..9).flat_map(|dy| (0..9).map(move |dx| (dx, dy))) {
            pixels[(y - 4 + dy) * 160 + x - 4 + dx][channel] = 250;
        }
        let joint = Skeleton::Coco17.joint(name).unwrap();
        pose.keypoints[joint] = Keypoint { x: x as f32 + 0.5, y: y as f32 + 0.5, confidence: 1.0 };
    }
    let image = Image::from_rgb8(pixels.into_flattened(), 160, 120).unwrap();
    Sample { data: vec![image.into()], target: Some(PoseList::from(vec![pose]).into()) }
}

fn check_dot(image: &Image, joint: &Keypoint, channel: usize) {
    let at = |place: f32, side: usize| (place as usize).min(side - 1);
    let (x, y) = (at(joint.x, image.width()), at(joint.y, image.height()));
    let pixel: [u8; 3] = std::array::from_fn(|channel| image.view().sample_u8(x, y, channel));
    let others = (0..3).filter(|other| *other != channel);
    assert!(
        pixel[channel] > 100 && others.into_iter().all(|other| pixel[other] < 100),
        "{joint:?} {pixel:?}"
    );
}

#[test]
fn flipped_twice_is_as_before() {
    for direction in [FlipDirection::Horizontal, FlipDirection::Vertical] {
        for before in [painted([161, 119], [3, 5, 77, 60]), person()] {
            let mut sample = before.clone();
            let flip = Flip { direction };
            flip.apply(&mut sample, &mut Random::new(0), &OtherSamples::none()).unwrap();
            assert_ne!(sample.data, before.data);
            flip.apply(&mut sample, &mut Random::new(0), &OtherSamples::none()).unwrap();
            assert_eq!(sample, before);
        }
    }
}

#[test]
fn every_pixel_format_is_mirrored() {
    let flip = |image: Image| {
        let mut sample = Sample { data: vec![image.into()], target: None };
        Flip::default().apply(&mut sample, &mut Random::new(0), &OtherSamples::none()).unwrap();
        self::image(&sample).clone()
    };
    let depth = Image::new(vec![1u16, 2, 3, 4, 5, 6], 3, 2, PixelFormat::Grey, Layout::Hwc).unwrap();
    assert_eq!(flip(depth).pixels(), &vec![3u16, 2, 1, 6, 5, 4].into());
    let planes =
        Image::new(vec![1.0f32, 2.0, 3.0, 4.0, 5.0, 6.0], 2, 1, PixelFormat::Rgb, Layout::Chw).unwrap();
    assert_eq!(flip(planes).pixels(), &vec![2.0f32, 1.0, 4.0, 3.0, 6.0, 5.0].into());
    let rgba = Image::new((0..8).collect::<Vec<u8>>(), 2, 1, PixelFormat::Bgra, Layout::Hwc).unwrap();
    let mirrored = flip(rgba);
    assert_eq!(
        (mirrored.format(), mirrored.pixels()),
        (PixelFormat::Bgra, &vec![4u8, 5, 6, 7, 0, 1, 2, 3].into())
    );
    let depth = Image::new(vec![1.0f32; 64 * 48], 64, 48, PixelFormat::Grey, Layout::Hwc).unwrap();
    let mut sample = Sample { data: vec![depth.into()], target: None };
    Rotate { max_angle: 1.0, ..Default::default() }
        .apply(&mut sample, &mut Random::new(4), &OtherSamples::none())
        .unwrap();
    let opendr_engine::data::Pixels::F32(values) = image(&sample).pixels() else { panic!() };
    assert!(values.contains(&0.0) && values.iter().all(|value| *value == 0.0 || *value == 1.0));
}

#[test]
fn mirrored_faces_have_swapped_landmarks() {
    let mut sample = painted([100, 50], [10, 10, 40, 40]);
    let Some(Value::BoundingBoxList(list)) = &mut sample.target else { panic!() };
    list.boxes[0].landmarks =
        [[12.0, 20.0], [30.0, 20.0], [20.0, 25.0], [-1.0, -1.0], [29.0, 33.0]].into_iter().collect();
    Flip::default().apply(&mut sample, &mut Random::new(0), &OtherSamples::none()).unwrap();
    let wanted = [[70.0, 20.0], [88.0, 20.0], [80.0, 25.0], [71.0, 33.0], [-1.0, -1.0]];
    assert_eq!(boxes(&sample)[0].landmarks[..], wanted);
}

/// Images with one object each.
struct Shelf(usize);

impl Dataset for Shelf {}

impl DatasetIterator for Shelf {
    fn len(&self) -> usize {
        self.0
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (width, height) = (90 + 31 * index, 140 - 17 * index);
        Ok(painted([width, height], [width / 4, height / 4, 3 * width / 4, 3 * height / 4]))
    }
}

#[test]
fn mosaics_keep_boxes_around_objects() {
    let mut kept = 0;
    let (shelf, mosaic) =
        (Shelf(5), Mosaic { width: 200, height: 160, min_visible: 0.0, ..Default::default() });
    for seed in 0..40 {
        let mut sample = shelf.get(0).unwrap();
        mosaic.apply(&mut sample, &mut Random::new(seed), &OtherSamples::of(&shelf)).unwrap();
        let image = image(&sample);
        assert_eq!((image.width(), image.height()), (200, 160));
        let shown = bright(image);
        let mut covered = vec![false; shown.len()];
        for object in boxes(&sample) {
            let [x0, y0, x1, y1] = object.corners();
            assert!(x0 >= 0.0 && y0 >= 0.0 && x1 <= 200.0 && y1 <= 160.0);
            let Segmentation::Rle(runs) = &object.segment.as_ref().unwrap().segmentation else { continue };
            let mask = runs.mask().unwrap();
            covered.iter_mut().zip(mask).for_each(|(covered, inside)| *covered |= inside);
        }
        let wrong = covered.iter().zip(&shown).filter(|(one, other)| one != other).count();
        assert!(wrong <= 2 * (200 + 160), "{wrong}");
        kept += boxes(&sample).len();
    }
    // Of eight boxes in four images, more than half remain.
    assert!(kept > 40 * 4, "{kept}");
}

#[test]
fn mixed_pictures_have_the_boxes_of_both() {
    let (shelf, mut sample) = (Shelf(3), Shelf(3).get(2).unwrap());
    MixUp::default().apply(&mut sample, &mut Random::new(3), &OtherSamples::of(&shelf)).unwrap();
    assert_eq!(boxes(&sample).len(), 4);
    let size = [image(&sample).width(), image(&sample).height()];
    assert_eq!(size, [152, 106]);
    let alone =
        MixUp::default().apply(&mut shelf.get(0).unwrap(), &mut Random::new(3), &OtherSamples::none());
    assert_eq!(alone.unwrap_err().kind(), ErrorKind::InvalidInput);
}

#[test]
fn cut_out_drops_covered_boxes() {
    let cut = CutOut { min_side: 1.0, max_side: 1.0, ..Default::default() };
    let mut sample = painted([50, 40], [5, 5, 20, 20]);
    cut.apply(&mut sample, &mut Random::new(0), &OtherSamples::none()).unwrap();
    assert!(boxes(&sample).is_empty() && image(&sample).chw_u8().iter().all(|level| *level == 114));
    let mut sample = painted([50, 40], [5, 5, 20, 20]);
    CutOut { min_side: 0.1, max_side: 0.1, ..cut }
        .apply(&mut sample, &mut Random::new(0), &OtherSamples::none())
        .unwrap();
    assert_eq!(boxes(&sample).len(), 2);
    let grey = image(&sample).hwc_u8(PixelFormat::Rgb).chunks(3).filter(|pixel| *pixel == [114; 3]).count();
    assert_eq!(grey, 5 * 4);
}

#[test]
fn shared_pixels_are_not_changed() {
    let before = painted([40, 30], [5, 5, 20, 20]);
    for entry in augmentations() {
        let mut sample = before.clone();
        let kept = image(&before).chw_u8();
        let augment = (entry.make)(&ParamMap::new()).unwrap();
        let _ = augment.apply(&mut sample, &mut Random::new(1), &OtherSamples::of(&Shelf(4)));
        assert_eq!(image(&before).chw_u8(), kept, "{}", entry.name);
    }
}

#[test]
fn one_seed_gives_one_sample() {
    for entry in augmentations() {
        let augment = (entry.make)(&ParamMap::new()).unwrap();
        let [first, second] = [(), ()].map(|()| {
            let mut sample = painted([64, 48], [10, 12, 40, 30]);
            augment
                .apply(&mut sample, &mut Random::from_key([1, 2]), &OtherSamples::of(&Shelf(4)))
                .map(|()| sample)
                .ok()
        });
        assert_eq!(first, second, "{}", entry.name);
    }
}

#[test]
fn names_are_unique_and_fields_documented() {
    let mut names = HashSet::new();
    for entry in augmentations() {
        assert!(names.insert(entry.name) && !entry.about.is_empty());
        assert!(entry.fields.iter().all(|field| !field.doc.is_empty()), "{}", entry.name);
    }
    assert_eq!(crate::augment::find_augmentation("flipp").err().unwrap().kind(), ErrorKind::NotFound);
}

#[test]
fn invalid_targets_cause_no_panic() {
    let wild = [f32::NAN, f32::INFINITY, f32::MAX, -f32::MAX, -5.0, 0.0, 3.5];
    for entry in augmentations() {
        let augment = (entry.make)(&ParamMap::new()).unwrap();
        for (a, b) in wild.iter().flat_map(|a| wild.iter().map(move |b| (*a, *b))) {
            let mut list = vec![BoundingBox::new(0, a, b, b, a, 1.0)];
            list[0].landmarks = [[a, b]; 5].into_iter().collect();
            let segmentation = Segmentation::Polygons(vec![vec![a, b, b, a, 1.0, 2.0, a], vec![], vec![a]]);
            list[0].segment = Some(Box::new(Segment { segmentation, area: a, iscrowd: false }));
            let joints = [Keypoint { x: a, y: b, confidence: 1.0 }; 3].into_iter().collect();
            let pose = Pose { keypoints: joints, region: Some(Box::new(list[0].clone())), ..Pose::default() };
            for target in
                [Value::from(BoundingBoxList::from(list.clone())), PoseList::from(vec![pose.clone()]).into()]
            {
                let image = Image::from_rgb8(vec![9; 3], 1, 1).unwrap();
                let mut sample = Sample { data: vec![image.into()], target: Some(target) };
                // The result is an error or finite, but there is no panic.
                let done = augment.apply(&mut sample, &mut Random::new(7), &OtherSamples::none());
                if let (Ok(()), Some(Value::BoundingBoxList(list)), "flip" | "affine") =
                    (done, &sample.target, entry.name)
                {
                    assert!(
                        list.boxes.iter().all(|object| object.corners().iter().all(|edge| edge.is_finite()))
                    );
                }
            }
        }
    }
}

#[test]
fn targets_that_cannot_be_transformed_are_errors() {
    let mut sample = painted([40, 30], [5, 5, 20, 20]);
    sample.target = Some(opendr_engine::target::BoundingBox3DList::default().into());
    let refused = Flip::default().apply(&mut sample, &mut Random::new(0), &OtherSamples::none());
    assert_eq!(refused.unwrap_err().kind(), ErrorKind::Unsupported);
    let mut empty = Sample { data: vec![], target: None };
    let refused = Flip::default().apply(&mut empty, &mut Random::new(0), &OtherSamples::none());
    assert_eq!(refused.unwrap_err().kind(), ErrorKind::InvalidInput);
    let mut sample = painted([40, 30], [5, 5, 20, 20]);
    let huge: [&dyn Augment; 2] = [
        &Resize { width: 65535, height: 65535 },
        &Mosaic { width: 65535, height: 65535, ..Default::default() },
    ];
    for augment in huge {
        let refused = augment.apply(&mut sample, &mut Random::new(0), &OtherSamples::of(&Shelf(2)));
        assert_eq!(refused.unwrap_err().kind(), ErrorKind::InvalidParam);
    }
    // A label map of another resolution is scaled with the image, here to a size far too large.
    let mut sample = painted([1, 1], [0, 0, 1, 1]);
    sample.target = Some(Heatmap::from_labels(vec![0; 1 << 16], &[1 << 8, 1 << 8]).unwrap().into());
    let refused =
        Resize { width: 2048, height: 2048 }.apply(&mut sample, &mut Random::new(0), &OtherSamples::none());
    assert_eq!(refused.unwrap_err().kind(), ErrorKind::InvalidParam);
}

#[test]
fn parameters_are_checked() {
    let turned = Blur { min_deviation: 2.0, max_deviation: 1.0 };
    let error = Pipeline::default().then(turned).err().unwrap();
    assert_eq!(error.to_string(), "blur: min_deviation = 2 exceeds 1, the upper limit; set it lower");
    assert!(Pipeline::default().sometimes(1.5, Flip::default()).is_err());
    let params = ParamMap::from([("width".to_owned(), 0i64.into())]);
    let error = Pipeline::default().by_name("resize", 1.0, &params).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::InvalidParam);
    assert_eq!(Pipeline::default().by_name("blur", 1.0, &ParamMap::new()).unwrap().names(), ["blur"]);
}
