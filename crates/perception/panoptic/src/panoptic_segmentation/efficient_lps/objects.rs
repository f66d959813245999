//! Grouping of points of a class into objects.

use opendr_clouds::range_image::{NONE, RangeImage};
use opendr_engine::data::PointCloud;
use opendr_vision::components::{Components, Connectivity};

/// A label is this times its class plus the index of the object, as in Cityscapes.
pub(super) const LABEL_DIVISOR: u32 = 1000;
/// Class of void.
pub(super) const UNKNOWN: u32 = 255;

/// Criteria of an object.
pub(super) struct ObjectRule<'a> {
    /// Thing classes.
    pub things: &'a [u32],
    /// Maximum distance in metres between neighbouring points of an object.
    pub gap: f32,
    /// Minimum number of pixels.
    pub least: u32,
}

/// Groups points into objects; buffers are reused.
#[derive(Debug, Default)]
pub(super) struct Objects {
    components: Components,
    /// Point that represents each pixel: for a pixel without a point, that of a neighbour.
    representatives: Vec<u32>,
    /// Label of each component.
    numbers: Vec<u32>,
    /// Number of objects of each thing class so far.
    counts: Vec<u32>,
    labels: Vec<u32>,
}

impl Objects {
    /// Labels the pixels of a range image of `size`, `[columns, rows]`, from their classes.
    pub(super) fn find(
        &mut self,
        image: &RangeImage,
        cloud: &PointCloud,
        size @ [columns, _]: [usize; 2],
        classes: &[u32],
        rule: &ObjectRule<'_>,
    ) {
        let Self { components, representatives, numbers, counts, labels } = self;
        let points = image.points();
        representatives.clear();
        representatives.extend((0..points.len()).map(|at| match points[at] {
            NONE if at % columns > 0 => points[at - 1],
            own => own,
        }));
        // The class is that of the representing point's own pixel.
        let class = |at: usize| match points[at] {
            NONE => classes[at.saturating_sub(1)],
            _ => classes[at],
        };
        let (values, channels) = (cloud.as_slice(), cloud.channels());
        let place = |at: usize| &values[representatives[at] as usize * channels..][..3];
        let count = components.label(
            size,
            Connectivity::Eight,
            |at| representatives[at] != NONE && rule.things.contains(&class(at)),
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
            if *component == 0 || points[at] == NONE {
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

    /// Returns 1000 times the class plus the index of the object, for each pixel.
    pub(super) fn labels(&self) -> &[u32] {
        &self.labels
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_clouds::range_image::RangeView;

    /// Two walls of points 1.5 metres apart, one missing point in the first, and a single point.
    #[test]
    fn close_points_are_one_object() {
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
