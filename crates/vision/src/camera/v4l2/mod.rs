//! Cameras through Video4Linux 2, with buffers shared between kernel and process.
//!
//! Not tested with a camera: the test machines have none. The tests cover the layout of the kernel's structures, the
//! pixel conversion and the errors without a camera.

mod kernel;

use std::fs::{File, OpenOptions};
use std::io;
use std::os::fd::{AsRawFd, RawFd};
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use opendr_engine::data::Image;
use opendr_engine::{Error, ErrorKind, Result, ResultExt};

use crate::camera::mjpeg::jpeg_from_mjpeg;
use crate::camera::v4l2::kernel::{
    BUFFER_DAMAGED, Buffer, BufferRequest, CAN_CAPTURE, CAN_STREAM, CAPTURE, Capability, DEQUEUE, ENQUEUE,
    ENUMERATE_FORMATS, Format, FormatDescription, GET_FORMAT, GET_PARAMETERS, HAS_DEVICE_CAPABILITIES,
    Kernel as _, MEMORY_MAPPED, Mapping, PictureFormat, QUERY_BUFFER, QUERY_CAPABILITY, REQUEST_BUFFERS,
    SET_FORMAT, STAMP_KIND, STAMP_MONOTONIC, STREAM_OFF, STREAM_ON, StreamParameters, ioctl,
};
use crate::codec::Decoder;
use crate::source::{Frame, FrameReader, SourceOptions, VideoInfo};
use crate::yuv422::{Yuv422, rgb_from_yuv422};

const YUYV: u32 = u32::from_le_bytes(*b"YUYV");
const MJPEG: u32 = u32::from_le_bytes(*b"MJPG");

/// Buffers that the driver may fill while a frame is read.
const BUFFERS: u32 = 4;

/// Longest wait for a frame; after it the camera counts as failed.
const FRAME_TIMEOUT: Duration = Duration::from_secs(5);

/// Longest delay until an interruption takes effect, in milliseconds.
const POLL_MS: libc::c_int = 100;

/// Damaged frames in a row that are skipped; the first frames of a stream are often damaged.
const MAX_DAMAGED: u32 = 30;

/// A streaming camera; dropping it stops the stream.
#[derive(Debug)]
pub(crate) struct Camera {
    file: File,
    mappings: Vec<Mapping>,
    width: usize,
    height: usize,
    stride: usize,
    pixel_format: u32,
    decoder: Decoder,
    path: Arc<Path>,
    info: Arc<VideoInfo>,
    given: u64,
    ended: bool,
    interrupted: Arc<AtomicBool>,
}

impl Camera {
    /// Opens the camera at `path` and starts its stream.
    ///
    /// # Errors
    /// `NotFound` when there is no such device (the message lists the devices that exist), `Io` when access is
    /// denied, `Device` when it is not a camera or fails, `Unsupported` when it offers neither YUYV nor MJPEG.
    pub(crate) fn open(path: &Path, options: &SourceOptions) -> Result<Self> {
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .custom_flags(libc::O_NONBLOCK)
            .open(path)
            .map_err(|error| cannot_open(path, &error))?;
        Self::start(file, path, options).context(|| format!("opening the camera {}", path.display()))
    }

    fn start(file: File, path: &Path, options: &SourceOptions) -> Result<Self> {
        check_capabilities(&file)?;
        let picture = choose_format(&file, options.camera_size)?;
        let [width, height, stride] =
            [picture.width, picture.height, picture.bytes_a_row].map(|length| length as usize);
        let samples = picture.width as u64 * picture.height as u64 * 3;
        if samples == 0 || samples > options.decoder.max_samples {
            return Err(Error::device(format!(
                "frames of {width}x{height} pixels exceed the limit of {} samples; set a smaller camera size",
                options.decoder.max_samples
            )));
        }
        let mut camera = Self {
            info: Arc::new(VideoInfo { frame_rate: rate_of(&file), frames: None, duration_s: None }),
            mappings: Vec::new(),
            pixel_format: picture.pixel_format,
            decoder: options.decoder,
            path: Arc::from(path),
            given: 0,
            ended: false,
            interrupted: Arc::default(),
            file,
            width,
            height,
            stride,
        };
        camera.start_stream().map_err(|error| failed("cannot start the stream", error))?;
        Ok(camera)
    }

    fn start_stream(&mut self) -> io::Result<()> {
        let mut wanted = BufferRequest::zeroed();
        (wanted.count, wanted.kind, wanted.memory) = (BUFFERS, CAPTURE, MEMORY_MAPPED);
        ioctl(&self.file, REQUEST_BUFFERS, &mut wanted)?;
        for index in 0..wanted.count.min(32) {
            let mut buffer = capture_buffer(index);
            ioctl(&self.file, QUERY_BUFFER, &mut buffer)?;
            self.mappings.push(Mapping::new(&self.file, &buffer)?);
            ioctl(&self.file, ENQUEUE, &mut capture_buffer(index))?;
        }
        ioctl(&self.file, STREAM_ON, &mut { CAPTURE })
    }

    /// Returns the next complete frame; `None` after an interruption.
    fn read(&mut self) -> Result<Option<Frame>> {
        let mut damaged = 0;
        loop {
            let Some(buffer) = self.dequeue()? else { return Ok(None) };
            let number = self.given;
            self.given += 1;
            let image = self.picture(&buffer);
            ioctl(&self.file, ENQUEUE, &mut capture_buffer(buffer.index))
                .map_err(|error| failed("the stream failed", error))?;
            match image {
                Ok(mut image) => {
                    image.header.stamp_ns = Some(stamp_ns(&buffer));
                    let path = Arc::clone(&self.path);
                    let video = Some(Arc::clone(&self.info));
                    return Ok(Some(Frame { image, path, item_index: 0, frame_index: number, video }));
                }
                Err(error) => {
                    damaged += 1;
                    if damaged > MAX_DAMAGED {
                        return Err(Error::device(format!(
                            "received {damaged} damaged frames in a row; check the cable and the driver"
                        ))
                        .with_source(error));
                    }
                }
            }
        }
    }

    fn dequeue(&self) -> Result<Option<Buffer>> {
        let start = Instant::now();
        while !self.interrupted.load(Ordering::SeqCst) {
            wait_for_frame(self.file.as_raw_fd()).map_err(|error| failed("the stream failed", error))?;
            let mut buffer = capture_buffer(0);
            match ioctl(&self.file, DEQUEUE, &mut buffer) {
                Ok(()) => return Ok(Some(buffer)),
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
                Err(error) => {
                    return Err(failed("the stream failed; check that the camera is still connected", error));
                }
            }
            if start.elapsed() > FRAME_TIMEOUT {
                return Err(Error::device(format!(
                    "no frame for {} seconds; close other programs that use the camera, or reconnect it",
                    FRAME_TIMEOUT.as_secs()
                )));
            }
        }
        Ok(None)
    }

    fn picture(&self, buffer: &Buffer) -> Result<Image> {
        let mapping = self.mappings.get(buffer.index as usize).filter(|_| buffer.flags & BUFFER_DAMAGED == 0);
        let mapping = mapping.ok_or_else(|| Error::device("the driver returned an invalid buffer"))?;
        let bytes = mapping.bytes(buffer.bytes_used as usize);
        if self.pixel_format == MJPEG {
            return self.decoder.decode(&jpeg_from_mjpeg(bytes));
        }
        let rgb = rgb_from_yuv422(bytes, self.stride, self.width, self.height, Yuv422::Yuyv)?;
        Image::from_rgb8(rgb, self.width, self.height)
    }
}

impl Iterator for Camera {
    type Item = Result<Frame>;

    fn next(&mut self) -> Option<Result<Frame>> {
        if self.ended {
            return None;
        }
        let frame = self.read().context(|| format!("reading the camera {}", self.path.display()));
        self.ended = frame.is_err();
        frame.transpose()
    }
}

impl FrameReader for Camera {
    fn interrupt(&self) -> Box<dyn FnOnce() + Send> {
        let interrupted = Arc::clone(&self.interrupted);
        Box::new(move || interrupted.store(true, Ordering::SeqCst))
    }
}

impl Drop for Camera {
    fn drop(&mut self) {
        // This fails only when the camera is disconnected.
        let _ = ioctl(&self.file, STREAM_OFF, &mut { CAPTURE });
    }
}

fn check_capabilities(file: &File) -> Result<()> {
    let mut found = Capability::zeroed();
    ioctl(file, QUERY_CAPABILITY, &mut found).map_err(|error| failed("the device is not a camera", error))?;
    let all = found.capabilities;
    let able = if all & HAS_DEVICE_CAPABILITIES != 0 { found.device_capabilities } else { all };
    if able & CAN_CAPTURE == 0 || able & CAN_STREAM == 0 {
        return Err(Error::device(format!(
            "the device captures no images (many cameras have a second device for metadata); {}",
            list_cameras()
        )));
    }
    Ok(())
}

/// Sets size and pixel format: uncompressed up to 640x480 pixels, MJPEG above, because of the bandwidth of USB.
fn choose_format(file: &File, size: Option<[u32; 2]>) -> Result<PictureFormat> {
    let mut format = Format::zeroed();
    format.kind = CAPTURE;
    ioctl(file, GET_FORMAT, &mut format).map_err(|error| failed("cannot read its image format", error))?;
    if let Some([width, height]) = size {
        (format.picture.width, format.picture.height) = (width, height);
    }
    let offered: Vec<u32> = (0..64).map_while(|index| pixel_format(file, index)).collect();
    let large = format.picture.width as u64 * format.picture.height as u64 > 640 * 480;
    let wanted = if large { [MJPEG, YUYV] } else { [YUYV, MJPEG] };
    let Some(chosen) = wanted.into_iter().find(|wanted| offered.contains(wanted)) else {
        let names: Vec<String> =
            offered.iter().map(|code| String::from_utf8_lossy(&code.to_le_bytes()).into_owned()).collect();
        return Err(Error::unsupported(format!(
            "it offers the formats {}; supported are YUYV and MJPG: convert its stream or use another camera",
            names.join(", ")
        )));
    };
    format.picture.pixel_format = chosen;
    format.picture.field = 0;
    ioctl(file, SET_FORMAT, &mut format)
        .map_err(|error| failed("the camera is busy or rejects the format", error))?;
    if format.picture.pixel_format != chosen {
        return Err(Error::device("the camera rejects a format that it offers"));
    }
    Ok(format.picture)
}

fn pixel_format(file: &File, index: u32) -> Option<u32> {
    let mut description = FormatDescription::zeroed();
    (description.index, description.kind) = (index, CAPTURE);
    ioctl(file, ENUMERATE_FORMATS, &mut description).ok()?;
    Some(description.pixel_format)
}

/// Returns the camera's frame rate in frames per second; 30 where the camera does not report it.
fn rate_of(file: &File) -> f64 {
    let mut parameters = StreamParameters::zeroed();
    parameters.kind = CAPTURE;
    let is_known = ioctl(file, GET_PARAMETERS, &mut parameters).is_ok();
    let [over, under] = parameters.frame_time;
    if is_known && over > 0 && under > 0 { f64::from(under) / f64::from(over) } else { 30.0 }
}

fn capture_buffer(index: u32) -> Buffer {
    let mut buffer = Buffer::zeroed();
    (buffer.index, buffer.kind, buffer.memory) = (index, CAPTURE, MEMORY_MAPPED);
    buffer
}

fn wait_for_frame(descriptor: RawFd) -> io::Result<()> {
    let mut waited = libc::pollfd { fd: descriptor, events: libc::POLLIN, revents: 0 };
    // SAFETY: one valid structure, and a count of one.
    let status = unsafe { libc::poll(&raw mut waited, 1, POLL_MS) };
    let error = io::Error::last_os_error();
    if status < 0 && error.kind() != io::ErrorKind::Interrupted { Err(error) } else { Ok(()) }
}

/// Returns the capture time in nanoseconds since the Unix epoch.
fn stamp_ns(buffer: &Buffer) -> i64 {
    let now_ns = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as i64);
    if buffer.flags & STAMP_KIND != STAMP_MONOTONIC {
        return now_ns;
    }
    let mut monotonic = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is valid for writes.
    if unsafe { libc::clock_gettime(libc::CLOCK_MONOTONIC, &raw mut monotonic) } != 0 {
        return now_ns;
    }
    let taken_ns =
        buffer.seconds.saturating_mul(1_000_000_000).saturating_add(buffer.microseconds.saturating_mul(1000));
    let age_ns = (monotonic.tv_sec * 1_000_000_000 + monotonic.tv_nsec).saturating_sub(taken_ns);
    now_ns - age_ns.clamp(0, FRAME_TIMEOUT.as_nanos() as i64)
}

fn failed(what: &str, error: io::Error) -> Error {
    Error::device(what).with_source(error)
}

fn cannot_open(path: &Path, error: &io::Error) -> Error {
    match error.kind() {
        io::ErrorKind::NotFound => {
            Error::not_found(format!("no camera {}; {}", path.display(), list_cameras()))
        }
        io::ErrorKind::PermissionDenied => Error::io(format!(
            "no permission to open the camera {}; add your user to its group (usermod -aG video USER) and log in again",
            path.display()
        )),
        _ => {
            Error::new(ErrorKind::Device, format!("the camera {} cannot be opened: {error}", path.display()))
        }
    }
}

/// Lists the cameras: `cameras on this machine: /dev/video0, /dev/video2`.
fn list_cameras() -> String {
    let mut found: Vec<String> = std::fs::read_dir("/dev")
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter(|name| name.starts_with("video"))
        .map(|name| format!("/dev/{name}"))
        .collect();
    found.sort();
    match found.is_empty() {
        true => {
            "there is no camera on this machine; connect one, or pass the device to the container".to_owned()
        }
        false => format!("cameras on this machine: {}", found.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_camera_lists_existing_ones() {
        let error = Camera::open(Path::new("/dev/video9999"), &SourceOptions::default()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::NotFound);
        let text = error.to_string();
        assert!(text.contains("/dev/video9999") && text.contains("on this machine"), "{text}");
    }

    #[test]
    fn non_cameras_are_rejected() {
        let error = Camera::open(Path::new("/dev/null"), &SourceOptions::default()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Device, "{error}");
    }
}
