//! Scatters features of pillars to the grid.

/// Writes the features of pillars, `channels` each, into a canvas `[channels, cells]` that is 0 elsewhere.
///
/// `cells` contains the cell of every pillar. Features beyond the last pillar, and pillars beyond the canvas, are skipped.
pub fn scatter(features: &[f32], channels: usize, cells: &[u32], canvas: &mut [f32]) {
    canvas.fill(0.0);
    let plane = canvas.len() / channels.max(1);
    if plane == 0 {
        return;
    }
    for (channel, plane) in canvas.chunks_exact_mut(plane).take(channels).enumerate() {
        for (pillar, cell) in features.chunks_exact(channels).zip(cells) {
            if let Some(place) = plane.get_mut(*cell as usize) {
                *place = pillar[channel];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pillars_are_scattered_to_their_cells() {
        let mut canvas = [9.0; 8];
        scatter(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], 2, &[3, 0, 77], &mut canvas);
        assert_eq!(canvas, [3.0, 0.0, 0.0, 1.0, 4.0, 0.0, 0.0, 2.0]);
        scatter(&[], 2, &[], &mut canvas);
        assert_eq!(canvas, [0.0; 8]);
        scatter(&[1.0], 0, &[0], &mut []);
    }
}
