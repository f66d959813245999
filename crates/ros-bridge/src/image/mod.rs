//! Images: `sensor_msgs/Image` and `sensor_msgs/CompressedImage`.

mod compressed;
mod depth_compressed;
mod encoding;
mod raw;
