//! Features of pillars from all of their points.

use opendr_engine::data::PointCloud;
use opendr_engine::model::Model;
use opendr_engine::{Device, Error, Result};
use opendr_inference::{Session, TensorView};

use crate::pillars::{PillarGrid, PillarPoint, Voxeliser};

/// File of the layer over points in every container.
pub(super) const POINT_FILE: &str = "vfe.onnx";
/// Points per call of the layer over points.
pub(super) const CHUNK: usize = 4096;

/// Runs the layer over points in chunks.
pub(super) struct PointFeatures {
    session: Session,
    learnt: usize,
}

/// Points that are not yet processed.
#[derive(Default)]
pub(super) struct Chunk {
    features: Vec<f32>,
    pillars: Vec<u32>,
}

impl PointFeatures {
    /// Opens the container's layer, which computes `learnt` features per point.
    pub fn open(model: &Model, device: Device, learnt: usize) -> Result<Self> {
        let session = Session::open(&model.file(POINT_FILE)?, device)?;
        let ([input], [_]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!(
                "{POINT_FILE} does not have exactly one input and one output; train or download it again"
            )));
        };
        if input.dims[..] != [Some(CHUNK), Some(PillarPoint::FEATURES)] {
            let expected = [CHUNK, PillarPoint::FEATURES];
            return Err(Error::format(format!(
                "{POINT_FILE} takes {input} instead of {expected:?}; train or download it again"
            )));
        }
        Ok(Self { session, learnt })
    }

    /// Writes the features of all pillars of `cloud`, pillar by pillar: those of the layer, then the voxeliser's statistics.
    pub fn run(
        &self,
        cloud: &PointCloud,
        grid: &PillarGrid,
        voxeliser: &mut Voxeliser,
        chunk: &mut Chunk,
        features: &mut Vec<f32>,
    ) -> Result<()> {
        voxeliser.begin(grid);
        features.clear();
        chunk.clear();
        for point in cloud.points() {
            let Some(point) = voxeliser.add(grid, point) else { continue };
            chunk.features.extend(point.features);
            chunk.pillars.push(point.pillar);
            if chunk.pillars.len() == CHUNK {
                self.flush(chunk, voxeliser, features)?;
            }
        }
        self.flush(chunk, voxeliser, features)?;
        let channels = self.learnt + Voxeliser::STATISTICS;
        for (pillar, statistics) in features.chunks_exact_mut(channels).zip(voxeliser.statistics()) {
            pillar[self.learnt..].copy_from_slice(&statistics);
        }
        Ok(())
    }

    fn flush(&self, chunk: &mut Chunk, voxeliser: &Voxeliser, features: &mut Vec<f32>) -> Result<()> {
        if chunk.pillars.is_empty() {
            return Ok(());
        }
        let channels = self.learnt + Voxeliser::STATISTICS;
        features.resize(voxeliser.cells().len() * channels, 0.0);
        chunk.features.resize(CHUNK * PillarPoint::FEATURES, 0.0);
        let input = TensorView::new(&[CHUNK, PillarPoint::FEATURES], &chunk.features[..])?;
        self.session.run(&[input], |outputs| {
            let given =
                outputs.first().filter(|given| *given.shape() == [CHUNK, self.learnt]).ok_or_else(|| {
                    let expected = [CHUNK, self.learnt];
                    Error::format(format!(
                        "{POINT_FILE} does not return {expected:?}; train or download it again"
                    ))
                })?;
            let given = given.values::<f32>()?;
            for (point, pillar) in given.chunks_exact(self.learnt).zip(&chunk.pillars) {
                let begin = *pillar as usize * channels;
                let Some(most) = features.get_mut(begin..begin + self.learnt) else { continue };
                // Features are at least 0, the initial value of a pillar.
                for (most, value) in most.iter_mut().zip(point) {
                    *most = if value > most { *value } else { *most };
                }
            }
            Ok(())
        })?;
        chunk.clear();
        Ok(())
    }
}

impl Chunk {
    fn clear(&mut self) {
        self.features.clear();
        self.pillars.clear();
    }
}
