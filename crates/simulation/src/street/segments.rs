//! Scans of streets as a data set for segmentation.

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{Classes, Heatmap};
use opendr_engine::{Error, Result};

use super::{StreetKind, StreetScans};

/// The scans of [`StreetScans`] with a label for each point: 1000 times its class, plus for cars, pedestrians and trucks the instance
/// number within the class, from 1.
#[derive(Debug, Clone)]
pub struct StreetSegments {
    scans: StreetScans,
}

/// Classes, and whether each is a thing class.
const CLASSES: [(&str, bool); 6] = [
    ("car", true),
    ("pedestrian", true),
    ("truck", true),
    ("solid", false),
    ("leaves", false),
    ("ground", false),
];

impl StreetSegments {
    /// Indices of the thing classes.
    pub const THINGS: [u32; 3] = [0, 1, 2];

    /// Creates `count` scans of the streets of `seed`.
    pub fn new(seed: u64, count: usize) -> Self {
        Self { scans: StreetScans::new(seed, count) }
    }
}

fn class_of(kind: StreetKind) -> usize {
    match kind {
        StreetKind::Car => 0,
        StreetKind::Pedestrian => 1,
        StreetKind::Truck => 2,
        StreetKind::Structure => 3,
        StreetKind::Vegetation => 4,
        StreetKind::Ground => 5,
    }
}

impl Dataset for StreetSegments {}

impl DatasetIterator for StreetSegments {
    fn len(&self) -> usize {
        self.scans.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (street, returns, cloud) = self.scans.scan(index)?;
        let mut counts = [0; CLASSES.len()];
        let labels: Vec<u32> = street
            .objects
            .iter()
            .map(|object| {
                let class = class_of(object.kind);
                counts[class] += 1;
                1000 * class as u32 + if CLASSES[class].1 { counts[class] } else { 0 }
            })
            .collect();
        let label = |label: u16| {
            let object_label = labels.get(usize::from(label)).copied();
            object_label.ok_or_else(|| Error::internal("a return without an object"))
        };
        let labels = returns.iter().map(|hit| label(hit.label)).collect::<Result<Vec<_>>>()?;
        let mut map = Heatmap::from_labels(labels, &[returns.len()])?;
        map.classes = self.classes();
        map.header = cloud.cloud.header.clone();
        Ok(Sample { data: vec![cloud.into()], target: Some(map.into()) })
    }

    fn classes(&self) -> Classes {
        CLASSES.iter().map(|(name, _)| *name).collect()
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::Value;
    use opendr_engine::target::HeatmapValues;

    use super::*;

    #[test]
    fn every_point_has_a_label_and_cars_have_numbers() {
        let segments = StreetSegments::new(3, 2);
        let Sample { data, target } = segments.get(1).unwrap();
        let Some(Value::PointCloudWithCalibration(scan)) = data.first() else { panic!() };
        let Some(Value::Heatmap(map)) = target else { panic!() };
        let HeatmapValues::Labels(labels) = map.values() else { panic!() };
        assert_eq!(labels.len(), scan.cloud.len());
        assert!(labels.iter().all(|label| *label < 6000 && (label / 1000 < 3) == (label % 1000 > 0)));
        let share = |class: u32| {
            labels.iter().filter(|label| **label / 1000 == class).count() as f64 / labels.len() as f64
        };
        assert!(share(5) > 0.2 && share(0) > 0.0, "{} {}", share(5), share(0));
        // Low points belong to the ground.
        let low =
            scan.cloud.points().zip(labels.iter()).filter(|(point, _)| point[2] < -1.6 && point[0] < 8.0);
        let [ground, others] = low.fold([0, 0], |[ground, others], (_, label)| match label {
            5000 => [ground + 1, others],
            _ => [ground, others + 1],
        });
        assert!(ground > 100 && ground > 5 * others, "{ground} {others}");
        assert!(segments.get(2).is_err());
    }
}
