//! Measures the time of voxelisation and of non-maximum suppression of rotated boxes; `benches/space.py` compares it with
//! Python.
//!
//! ```console
//! $ cargo run --release -p opendr-clouds --example space_speed -- points.bin boxes.bin
//! ```
//!
//! `points.bin` contains x, y, z and reflectance of points, `boxes.bin` x, y, length, width, yaw and score of boxes, both as
//! 32-bit floats. The example prints the median of 15 rounds in seconds, and the sizes of the results, as JSON.

use std::time::Instant;

use opendr_clouds::pillars::{PillarGrid, PillarPoint, Voxeliser, scatter};
use opendr_engine::overlap::RotatedRectangle;
use opendr_engine::{Error, Result};
use opendr_perception_common::suppression::{BevCandidate, suppress_bev};

/// Grid of the PointPillars paper for cars.
const GRID: PillarGrid = PillarGrid { x: [0.0, 69.12], y: [-39.68, 39.68], z: [-3.0, 1.0], side: 0.16 };
const ROUNDS: usize = 15;
const OVERLAP: f32 = 0.1;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [points, boxes] = &arguments[..] else {
        return Err(Error::invalid_param("usage: space_speed POINTS_FILE BOXES_FILE"));
    };
    let (points, boxes) = (floats(points)?, floats(boxes)?);
    let mut voxeliser = Voxeliser::default();
    let mut canvas = vec![0.0; Voxeliser::STATISTICS * GRID.cells()];
    let (mut statistics, mut features) = (Vec::new(), Vec::new());
    let voxelise = median(|| {
        voxeliser.begin(&GRID);
        features.clear();
        for point in points.chunks_exact(4) {
            features.extend(voxeliser.add(&GRID, point).map(|point: PillarPoint| point.features));
        }
        statistics.clear();
        statistics.extend(voxeliser.statistics().flatten());
        scatter(&statistics, Voxeliser::STATISTICS, voxeliser.cells(), &mut canvas);
    });
    let candidates: Vec<_> =
        (0..).zip(boxes.chunks_exact(6)).map(|(index, numbers)| candidate(index, numbers)).collect();
    let (mut kept, mut dropped) = (Vec::new(), Vec::new());
    let suppress = median(|| {
        kept.clone_from(&candidates);
        suppress_bev(&mut kept, &mut dropped, OVERLAP, usize::MAX);
    });
    println!(
        "{{\"voxelise\": {voxelise}, \"points\": {}, \"pillars\": {}, \"suppress\": {suppress}, \"kept\": {}}}",
        features.len(),
        voxeliser.cells().len(),
        kept.len()
    );
    Ok(())
}

fn candidate(index: u32, numbers: &[f32]) -> BevCandidate {
    let number = |at: usize| numbers.get(at).copied().map_or(f64::NAN, f64::from);
    let floor =
        RotatedRectangle { center: [number(0), number(1)], size: [number(2), number(3)], angle: number(4) };
    BevCandidate { footprint: floor, score: number(5) as f32, class: 0, index }
}

fn floats(path: &str) -> Result<Vec<f32>> {
    let bytes = std::fs::read(path)?;
    let (numbers, _) = bytes.as_chunks::<4>();
    Ok(numbers.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect())
}

fn median(mut run: impl FnMut()) -> f64 {
    let mut rounds: Vec<_> = (0..ROUNDS)
        .map(|_| {
            let begin = Instant::now();
            run();
            begin.elapsed().as_secs_f64()
        })
        .collect();
    rounds.sort_by(f64::total_cmp);
    rounds.get(ROUNDS / 2).copied().unwrap_or_default()
}
