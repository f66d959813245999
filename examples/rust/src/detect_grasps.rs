//! Detects how a gripper can grasp an object, in colour and depth. The images are drawn here: a bar on a table.

use opendr::data::{Image, Layout, PixelFormat};
use opendr::grasp_detection::{GrConvNet, GrConvNetInputs, GrConvNetParams};
use opendr::learner::Handle;
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let (mut colour, mut depth) = (vec![200; 480 * 640 * 3], vec![800u16; 480 * 640]);
    for at in 0..480 * 640 {
        let (x, y) = (at as i32 % 640 - 320, at as i32 / 640 - 240);
        if (4 * x + 3 * y).abs() < 550 && (4 * y - 3 * x).abs() < 90 {
            colour[3 * at..3 * at + 3].copy_from_slice(&[180, 60, 40]);
            depth[at] = 760; // millimetres
        }
    }
    let mut image = Image::from_rgb8(colour, 640, 480)?;
    let depth = Image::new(depth, 640, 480, PixelFormat::Grey, Layout::Hwc)?;

    let mut detector = Handle::<GrConvNet>::new(GrConvNetParams::default(), Device::Auto)?;
    detector.load(opendr::download("gr_conv_net")?)?;
    let grasps = detector.infer(GrConvNetInputs { image: &image, depth: &depth })?;
    for grasp in &grasps.poses {
        let (one, two) = (grasp.keypoints[0], grasp.keypoints[1]);
        print!("fingers at {:.0}, {:.0} and {:.0}, {:.0}, ", one.x, one.y, two.x, two.y);
        println!("quality {:.2}", grasp.confidence);
    }
    draw(&mut image, &grasps, &Style::default());
    vision::save(&image, "detect_grasps.png")
}
