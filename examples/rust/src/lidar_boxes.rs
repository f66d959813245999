//! Detects cars in a lidar scan and draws both from above. Input: scan.bin, a scan in KITTI's format.

use opendr::data::Image;
use opendr::learner::Handle;
use opendr::object_detection_3d::{VoxelObjectDetection3d, VoxelObjectDetection3dParams};
use opendr::{Device, datasets, vision};

pub fn main() -> opendr::Result<()> {
    let params = VoxelObjectDetection3dParams::default();
    let mut detector = Handle::<VoxelObjectDetection3d>::new(params, Device::Auto)?;
    detector.load(opendr::download("voxel_object_detection_3d")?)?;
    let cloud = datasets::open_velodyne("scan.bin")?;
    let cars = detector.infer((&cloud).into())?;
    // A pixel is 10 cm, ahead is up; the detector processes what is ahead of the lidar.
    let mut picture = vec![0; 600 * 600 * 3];
    let mut mark = |ahead: f64, left: f64, colour: [u8; 3]| {
        let (row, column) = (600 - (ahead * 10.0) as i64, 300 - (left * 10.0) as i64);
        if (0..600).contains(&row) && (0..600).contains(&column) {
            let at = (row * 600 + column) as usize * 3;
            picture[at..at + 3].copy_from_slice(&colour);
        }
    };
    for point in cloud.points() {
        mark(point[0].into(), point[1].into(), [150, 150, 150]);
    }
    for car in &cars.boxes {
        // Camera coordinates: x to the right, z ahead.
        let [x, _, z] = car.location.map(f64::from);
        println!("a car {z:.1} m ahead, {x:.1} m to the right, score {:.2}", car.confidence);
        for at in 0..21 * 21 {
            mark(z + f64::from(at / 21 - 10) / 10.0, -x + f64::from(at % 21 - 10) / 10.0, [255, 160, 0]);
        }
    }
    vision::save(&Image::from_rgb8(picture, 600, 600)?, "lidar_boxes.png")
}
