//! Which points of a class are one object.

use opendr_clouds::range_image::{NOWHERE, RangeImage};
use opendr_engine::data::PointCloud;
use opendr_vision::components::{Components, Touching};

use super::{LABEL_DIVISOR, UNKNOWN};

/// What makes an object.
pub(super) struct ObjectRule<'a> {
    /// Countable classes.
    pub things: &'a [u32],
    /// Metres between points that belong together at most.
    pub gap: f32,
    /// Fewest pixels.
    pub least: u32,
}

/// Finds objects; memory is used again.
#[derive(Debug, Default)]
pub(super) struct Objects {
    components: Components,
    /// The point that stands for each pixel: one that lost its ray lets its neighbour's through.
    stands: Vec<u32>,
    /// The label of each component.
    numbers: Vec<u32>,
    /// Objects of each countable class so far.
    counts: Vec<u32>,
    labels: Vec<u32>,
}

impl Objects {
    /// Labels the pixels of a range image of `size`, `[columns, rows]`, whose classes are known.
    pub(super) fn find(
        &mut self,
        image: &RangeImage,
        cloud: &PointCloud,
        size @ [columns, _]: [usize; 2],
        classes: &[u32],
        rule: &ObjectRule<'_>,
    ) {
        let Self { components, stands, numbers, counts, labels } = self;
        let points = image.points();
        stands.clear();
        stands.extend((0..points.len()).map(|at| match points[at] {
            NOWHERE if at % columns > 0 => points[at - 1],
            own => own,
        }));
        // What stands for a pixel is of its own pixel's class.
        let class = |at: usize| match points[at] {
            NOWHERE => classes[at.saturating_sub(1)],
            _ => classes[at],
        };
        let (values, channels) = (cloud.as_slice(), cloud.channels());
        let place = |at: usize| &values[stands[at] as usize * channels..][..3];
        let count = components.label(
            size,
            Touching::Corners,
            |at| stands[at] != NOWHERE && rule.things.contains(&class(at)),
            |one, other| {
                let apart = place(one).iter().zip(place(other)).map(|(a, b)| (a - b).powi(2)).sum::<f32>();
                class(one) == class(other) && apart <= rule.gap * rule.gap
            },
        );
        numbers.clear();
        numbers.resize(count + 1, 0);
        counts.clear();
        counts.resize(rule.things.len(), 0);
        labels.clear();
        for (at, component) in components.labels().iter().enumerate() {
            let class = classes[at];
            if *component == 0 || points[at] == NOWHERE {
                labels.push(class * LABEL_DIVISOR);
                continue;
            }
            let number = &mut numbers[*component as usize];
            if *number == 0 {
                let thing = rule.things.iter().position(|thing| *thing == class);
                let is_large = components.areas()[*component as usize] >= rule.least;
                *number = match thing.filter(|thing| is_large && counts[*thing] + 1 < LABEL_DIVISOR) {
                    Some(thing) => {
                        counts[thing] += 1;
                        class * LABEL_DIVISOR + counts[thing]
                    }
                    None => UNKNOWN * LABEL_DIVISOR,
                };
            }
            labels.push(*number);
        }
    }

    /// 1000 times the class and the number of the object, of each pixel.
    pub(super) fn labels(&self) -> &[u32] {
        &self.labels
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_clouds::range_image::RangeView;

    /// Two walls of points a metre and a half apart, one ray lost in the first, and a lonely point.
    #[test]
    fn what_is_close_is_one_object() {
        let view = RangeView { rows: 2, columns: 16, top: 0.1, bottom: -0.1, half_view: 0.4 };
        let mut numbers = Vec::new();
        for column in 0..16 {
            let azimuth = 0.4 - (column as f32 + 0.5) * 0.05;
            let distance = if column < 8 { 8.0 } else { 9.5 };
            for elevation in [0.05_f32, -0.05] {
                if column != 3 && (column != 12 || elevation > 0.0) {
                    numbers.extend([
                        distance * azimuth.cos(),
                        distance * azimuth.sin(),
                        distance * elevation,
                    ]);
                }
            }
        }
        let cloud = PointCloud::new(numbers.clone(), [numbers.len() / 3, 3]).unwrap();
        let mut image = RangeImage::default();
        image.project(&view, cloud.points().map(|point| [point[0], point[1], point[2]]));
        let mut classes: Vec<u32> =
            image.ranges().iter().map(|range| if *range > 0.0 { 2 } else { UNKNOWN }).collect();
        classes[15] = 1;
        let mut objects = Objects::default();
        for _ in 0..2 {
            let rule = ObjectRule { things: &[1, 2], gap: 1.2, least: 2 };
            objects.find(&image, &cloud, [16, 2], &classes, &rule);
            let labels = objects.labels();
            assert_eq!((labels[0], labels[7], labels[8], labels[14]), (2001, 2001, 2002, 2002));
            assert_eq!((labels[3], labels[15], labels[16 + 15]), (255_000, 255_000, 2002));
        }
        objects.find(&image, &cloud, [16, 2], &classes, &ObjectRule { things: &[], gap: 1.2, least: 2 });
        assert_eq!((objects.labels()[0], objects.labels()[15]), (2000, 1000));
    }
}
