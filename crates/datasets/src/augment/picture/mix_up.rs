//! Mixup (Zhang et al., mixup: beyond empirical risk minimization, 2018).

use opendr_engine::data::{Image, PixelFormat};
use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::target::Category;
use opendr_engine::{Error, Random, Result, Value};

use crate::augment::picture::pixels::make_interleaved;
use crate::augment::picture::{AffineMap, Border, image_size, transform};
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Blends an image with another, which is resized to its size. Boxes and poses of both are kept; classes become the
/// shares of the images as probabilities.
#[derive(Debug, Clone, Params)]
pub struct MixUp {
    /// Both parameters of the Beta distribution of the share: large values blend half and half, small ones hardly
    /// at all.
    #[param(default = 8.0, range = 0.01..=1000.0, log)]
    pub alpha: f32,
    /// Number of classes, for targets of one class.
    #[param(default = 0, range = 0..=1_000_000)]
    pub classes: usize,
}

impl Augmentation for MixUp {
    const NAME: &'static str = "mix_up";
    const ABOUT: &'static str = "blends two images";
}

impl Augment for MixUp {
    fn apply(&self, sample: &mut Sample, random: &mut Random, others: &OtherSamples<'_>) -> Result<()> {
        let mut other = others.pick(random)?;
        let share = beta(self.alpha, random).clamp(0.0, 1.0);
        let map = AffineMap::stretch(image_size(&other)?, image_size(sample)?);
        transform(&mut other, &map, &Border::default())?;
        let ([Value::Image(image)], [Value::Image(over)]) = (&mut sample.data[..], &mut other.data[..])
        else {
            return Err(Error::unsupported("mix_up needs samples of one image; remove the augmentation"));
        };
        blend(image, over, share)?;
        sample.target = match (sample.target.take(), other.target) {
            (None, None) => None,
            (Some(Value::BoundingBoxList(mut boxes)), Some(Value::BoundingBoxList(more))) => {
                boxes.boxes.extend(more.boxes);
                Some(boxes.into())
            }
            (Some(Value::PoseList(mut poses)), Some(Value::PoseList(more))) => {
                poses.poses.extend(more.poses);
                Some(poses.into())
            }
            (Some(Value::Category(category)), Some(Value::Category(other))) => {
                Some(self.mixed_category(category, &other, share)?.into())
            }
            (target, _) => {
                let name = target.map_or("no target", |target| target.as_value_ref().value_type().name());
                return Err(Error::unsupported(format!(
                    "mix_up needs boxes, poses or classes, all of one type, not {name}; remove the augmentation"
                )));
            }
        };
        Ok(())
    }
}

impl MixUp {
    fn mixed_category(&self, mut category: Category, other: &Category, share: f32) -> Result<Category> {
        let mut mixed = vec![0.0; self.classes];
        for (part, share) in [(&category, share), (other, 1.0 - share)] {
            if part.probabilities.len() == mixed.len() && !mixed.is_empty() {
                mixed.iter_mut().zip(&part.probabilities).for_each(|(sum, one)| *sum += one * share);
                continue;
            }
            let place = usize::try_from(part.class).ok().and_then(|class| mixed.get_mut(class));
            *place.ok_or_else(|| {
                Error::invalid_param(format!(
                    "class {} of {} is out of range; set \"classes\" to the number of classes",
                    part.class, self.classes
                ))
            })? += share;
        }
        if share < 0.5 {
            (category.class, category.description) = (other.class, other.description.clone());
        }
        category.confidence = Some(share.max(1.0 - share));
        category.probabilities = mixed;
        Ok(category)
    }
}

/// Blends `share` of an image with the rest of another.
fn blend(image: &mut Image, over: &Image, share: f32) -> Result<()> {
    make_interleaved(image)?;
    let format = if image.channels() == 1 { PixelFormat::Grey } else { PixelFormat::Rgb };
    let (over, weight) = (over.hwc_u8(format), (share * 256.0).round() as u32);
    for (sample, over) in image.bytes_mut().unwrap_or_default().iter_mut().zip(over) {
        *sample = ((u32::from(*sample) * weight + u32::from(over) * (256 - weight) + 128) >> 8) as u8;
    }
    Ok(())
}

/// Draws from the distribution Beta(alpha, alpha).
fn beta(alpha: f32, random: &mut Random) -> f32 {
    let (one, other) = (gamma(alpha.into(), random), gamma(alpha.into(), random));
    if one + other > 0.0 { (one / (one + other)) as f32 } else { 0.5 }
}

/// Draws from the Gamma distribution (Marsaglia and Tsang, 2000).
fn gamma(shape: f64, random: &mut Random) -> f64 {
    if shape < 1.0 {
        let lift = (1.0 - random.unit()).powf(1.0 / shape);
        return gamma(shape + 1.0, random) * lift;
    }
    let d = shape - 1.0 / 3.0;
    let c = 1.0 / (9.0 * d).sqrt();
    loop {
        let x = random.normal();
        let v = (1.0 + c * x).powi(3);
        if v > 0.0 && (1.0 - random.unit()).ln() < 0.5 * x * x + d - d * v + d * v.ln() {
            return d * v;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_of_the_beta_distribution() {
        for alpha in [0.2, 1.0, 8.0] {
            let mut random = Random::new(9);
            let shares: Vec<f32> = (0..20_000).map(|_| beta(alpha, &mut random)).collect();
            let mean = shares.iter().sum::<f32>() / shares.len() as f32;
            let variance =
                shares.iter().map(|share| (share - mean).powi(2)).sum::<f32>() / shares.len() as f32;
            let wanted = 1.0 / (4.0 * (2.0 * alpha + 1.0));
            assert!(
                (mean - 0.5).abs() < 0.01 && (variance - wanted).abs() < 0.05 * wanted,
                "{alpha} {variance}"
            );
        }
    }

    #[test]
    fn classes_get_their_shares() {
        let mix = MixUp { classes: 4, ..MixUp::default() };
        let mixed = mix.mixed_category(Category::new(3, None), &Category::new(1, None), 0.25).unwrap();
        assert_eq!((mixed.class, mixed.probabilities), (1, vec![0.0, 0.75, 0.0, 0.25]));
        assert!(mix.mixed_category(Category::new(4, None), &Category::new(1, None), 0.25).is_err());
    }
}
