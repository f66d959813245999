//! Drawing of score masks: the probability per pixel of an object.

use opendr_engine::data::Image;

use crate::draw::canvas::{Canvas, Corners};
use crate::draw::coverage::Coverage;
use crate::draw::grid::Grid;
use crate::draw::palette::Colour;
use crate::draw::style::Style;

/// Draws the area where `scores` (`[height, width]` of `size` `[width, height]`, 0..=1) exceed 0.5: translucent, with
/// an opaque border.
///
/// The scores are stretched over `corners` of the image, which may lie partly outside it; a mask of the whole image
/// has `[0, 0, width, height]`. Borders are smooth at any resolution of the mask. Nothing is drawn when there are not
/// `width * height` scores. `image` is converted to RGB `u8` where needed.
pub fn draw_score_mask(
    image: &mut Image,
    scores: &[f32],
    size: [usize; 2],
    corners: Corners,
    colour: Colour,
    style: &Style,
) {
    let mut canvas = Canvas::over(image);
    let Some(grid) = Grid::new(scores, size) else { return };
    let Some(mut coverage) = Coverage::within(&canvas, corners) else { return };
    cover(&mut coverage, &grid, corners);
    let thickness = style.thickness(&canvas);
    coverage.paint(&mut canvas, style.colour.unwrap_or(colour), style.opacity, thickness / 2.0);
}

fn cover(coverage: &mut Coverage, grid: &Grid<'_>, [x0, y0, x1, y1]: Corners) {
    let (left, top) = (coverage.left, coverage.top);
    let (across, down) = (grid.width() / (x1 - x0), grid.height() / (y1 - y0));
    for (row, values) in coverage.values.chunks_exact_mut(coverage.width.max(1)).enumerate() {
        let y = ((top + row) as f32 + 0.5 - y0) * down;
        for (column, value) in values.iter_mut().enumerate() {
            let x = ((left + column) as f32 + 0.5 - x0) * across;
            let [score, along_x, along_y] = grid.sample(x, y);
            // Distance to the 0.5 contour in pixels, estimated from the slope.
            let slope = (along_x * across).hypot(along_y * down).max(1e-6);
            let inside = (score - 0.5) / slope + 0.5;
            *value = (inside * 255.0).round() as u8;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: Colour = [255, 0, 0];

    fn red(image: &Image) -> Vec<u8> {
        image.hwc_u8(opendr_engine::data::PixelFormat::Rgb).into_iter().step_by(3).collect()
    }

    #[test]
    fn a_coarse_mask_has_a_solid_border_where_the_score_is_half() {
        let mut image = Image::from_rgb8(vec![0; 80 * 40 * 3], 80, 40).unwrap();
        // The scores fall from 1 to 0 across the box from 20 to 60: 0.5 lies at 40.
        draw_score_mask(&mut image, &[1.0, 0.0], [2, 1], [20.0, 10.0, 60.0, 30.0], RED, &Style::default());
        let row = red(&image)[20 * 80..21 * 80].to_vec();
        assert_eq!((row[19], row[20], row[30], row[39], row[40]), (0, 255, 128, 255, 0), "{row:?}");
        assert!(red(&image)[..10 * 80].iter().all(|sample| *sample == 0));
    }

    #[test]
    fn a_mask_that_fills_the_picture_has_no_border() {
        let mut image = Image::from_rgb8(vec![0; 20 * 10 * 3], 20, 10).unwrap();
        draw_score_mask(&mut image, &[1.0], [1, 1], [-5.0, 0.0, 20.0, 10.0], RED, &Style::default());
        assert!(red(&image).iter().all(|sample| *sample == 128));
    }

    #[test]
    fn hostile_masks_are_cut() {
        let wild = [f32::NAN, f32::INFINITY, f32::MIN, -4.0, 0.0, 3.5, 1e9];
        let mut image = Image::from_rgb8(vec![9; 8 * 6 * 3], 8, 6).unwrap();
        for a in wild {
            for b in wild {
                let style = Style { opacity: a, scale: b, ..Style::default() };
                draw_score_mask(&mut image, &[a, b, 1.0, 0.0], [2, 2], [a, b, 4.0, 5.0], RED, &style);
                draw_score_mask(&mut image, &[a, b], [2, 1], [0.0, a, b, 5.0], RED, &style);
            }
        }
        let before = image.clone();
        draw_score_mask(&mut image, &[1.0; 3], [2, 2], [0.0, 0.0, 8.0, 6.0], RED, &Style::default());
        assert_eq!(image, before);
    }
}
