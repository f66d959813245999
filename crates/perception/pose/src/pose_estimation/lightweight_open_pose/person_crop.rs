//! Augmentation: crops around persons.

use opendr_datasets::augment::{
    AffineMap, Augment, Augmentation, Border, OtherSamples, image_size, transform,
};
use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result, Value};

/// Rotates, scales and crops an image with one of its persons in the centre, by one resampling (Osokin, 2018, as Cao et
/// al.). An image without persons is cropped anywhere.
#[derive(Debug, Clone, Params)]
pub(super) struct PersonCrop {
    /// Side of the result.
    #[param(default = 368, range = 8..=4096, unit = "px")]
    pub(super) size: usize,
    /// Longer side of the person at scale 1, as a share of the result.
    #[param(default = 0.7, range = 0.01..=10.0)]
    pub(super) person: f32,
    /// Minimum scale.
    #[param(default = 0.5, range = 0.01..=16.0, log)]
    pub(super) min_scale: f32,
    /// Maximum scale.
    #[param(default = 1.3, range = 0.01..=16.0, log)]
    pub(super) max_scale: f32,
    /// Maximum rotation in either direction.
    #[param(default = 0.5, range = 0.0..=3.15, unit = "rad")]
    pub(super) max_angle: f32,
    /// Maximum shift from the centre along x and along y, as a share of the result.
    #[param(default = 0.12, range = 0.0..=1.0)]
    pub(super) max_shift: f32,
    /// Maximum magnification of images.
    #[param(default = 3.0, range = 0.1..=100.0)]
    pub(super) max_zoom: f32,
}

impl Augmentation for PersonCrop {
    const NAME: &'static str = "person_crop";
    const ABOUT: &'static str = "crops around a person";
}

impl Augment for PersonCrop {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let size = image_size(sample)?;
        let ([centre_x, centre_y], extent) = person_of(sample, random).unwrap_or_else(|| {
            let [width, height] = size.map(|side| side as f32);
            let anywhere = [random.uniform(0.25, 0.75) * width, random.uniform(0.25, 0.75) * height];
            (anywhere, width.max(height))
        });
        let side = self.size as f32;
        let fitting = side * self.person / extent.max(1.0);
        let scale = f64::from((fitting * random.uniform(self.min_scale, self.max_scale)).min(self.max_zoom));
        let (sine, cosine) = f64::from(random.uniform(-self.max_angle, self.max_angle)).sin_cos();
        let [across, down] = [scale * cosine, scale * sine];
        let mut middle = || f64::from(side * (0.5 + random.uniform(-self.max_shift, self.max_shift)));
        let [to_x, to_y] = [middle(), middle()];
        let (x, y) = (f64::from(centre_x), f64::from(centre_y));
        let matrix =
            [[across, down, to_x - across * x - down * y], [-down, across, to_y + down * x - across * y]];
        transform(sample, &AffineMap::new(matrix, size, [self.size; 2]), &Border::default())
    }
}

/// Returns the centre and the longer side of the box of a random person.
fn person_of(sample: &Sample, random: &mut Random) -> Option<([f32; 2], f32)> {
    let Some(Value::PoseList(poses)) = &sample.target else { return None };
    let boxes = poses.poses.iter().filter_map(|pose| {
        let [left, top, width, height] = pose.bounding_box()?;
        // One joint alone does not determine a person's size.
        (width.max(height) > 8.0).then_some(([left + width / 2.0, top + height / 2.0], width.max(height)))
    });
    let boxes: Vec<_> = boxes.collect();
    boxes.get(random.below(boxes.len())).copied()
}
