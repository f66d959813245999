//! Point clouds in bird's eye view, as an image.

use opendr_engine::data::{Image, PointCloud};
use opendr_engine::target::BoundingBox3D;
use opendr_engine::{Result, Value};
use opendr_vision::draw::{Canvas, Colour, colour_of_name};

use crate::augment::cloud::{Frame, corners};

/// Side of the image in pixels.
const SIDE: usize = 480;
/// Distance from the centre to the edge of the image in metres.
const REACH: f32 = 48.0;
const BACKGROUND: u8 = 24;
const POINT: Colour = [150, 200, 230];

/// Draws the cloud of `datum` with the outlines of the boxes of `target`. The lidar is in the centre and ahead is
/// up; `None` without a cloud.
///
/// # Errors
/// `InvalidInput` for a calibration that is not invertible.
pub(crate) fn from_above(datum: &Value, target: Option<&Value>) -> Result<Option<Image>> {
    let cloud = match datum {
        Value::PointCloud(cloud) => cloud,
        Value::PointCloudWithCalibration(both) => &both.cloud,
        _ => return Ok(None),
    };
    let mut image = Image::from_rgb8(vec![BACKGROUND; SIDE * SIDE * 3], SIDE, SIDE)?;
    let mut canvas = Canvas::over(&mut image);
    draw_points(&mut canvas, cloud);
    let frame = Frame::of(datum)?;
    match target {
        Some(Value::BoundingBox3DList(list)) => {
            list.boxes.iter().for_each(|found| draw_floor(&mut canvas, found, &frame));
        }
        Some(Value::TrackingAnnotation3DList(list)) => {
            let boxes = list.annotations.iter().map(|track| &track.bounding_box_3d);
            boxes.for_each(|found| draw_floor(&mut canvas, found, &frame));
        }
        _ => {}
    }
    Ok(Some(image))
}

/// Returns the pixel of a point of the lidar frame (x ahead, y left).
fn pixel([x, y]: [f32; 2]) -> [f32; 2] {
    [y, x].map(|part| SIDE as f32 / 2.0 * (1.0 - part / REACH))
}

fn draw_points(canvas: &mut Canvas<'_>, cloud: &PointCloud) {
    for point in cloud.points() {
        let [column, row] = pixel([point[0], point[1]]);
        if column >= 0.0 && row >= 0.0 {
            canvas.blend(column as usize, row as usize, POINT, 0.5);
        }
    }
}

fn draw_floor(canvas: &mut Canvas<'_>, found: &BoundingBox3D, frame: &Frame) {
    let colour = colour_of_name(&found.name);
    let corners = corners(found).map(|corner| {
        let [x, y, _] = frame.lidar_from_camera(corner);
        pixel([x as f32, y as f32])
    });
    for [from, to] in [[0, 1], [1, 3], [3, 2], [2, 0]] {
        canvas.line(corners[from], corners[to], 2.0, colour, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::target::BoundingBox3DList;

    use super::*;

    #[test]
    fn ahead_is_up_and_left_is_left() {
        let cloud = PointCloud::new(vec![24.0, 12.0, 0.0, f32::NAN, 0.0, 0.0], [2, 3]).unwrap();
        let found = BoundingBox3D {
            dimensions: [10.0, 2.0, 10.0],
            location: [20.0, 1.0, -20.0],
            ..BoundingBox3D::default()
        };
        let target = BoundingBox3DList::from(vec![found]).into();
        let image = from_above(&cloud.into(), Some(&target)).unwrap().unwrap();
        let lit = |x: usize, y: usize| image.view().sample_u8(x, y, 1) > BACKGROUND;
        assert!(lit(180, 120) && !lit(120, 180));
        // The box is behind and to the right: 15 to 25 metres each.
        assert!(lit(340, 315) && lit(315, 340) && lit(365, 340) && !lit(340, 340) && !lit(140, 140));
    }
}
