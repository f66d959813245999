//! Cameras, range finders and lidars.

use std::fs::File;
use std::io::Read;
use std::path::PathBuf;

use opendr_engine::{Error, Result};

use super::opcodes::{CONFIGURE, write_period};
use crate::incoming::receive;
use crate::kind::DeviceKind;
use crate::reader::Reader;
use crate::request::Request;

const RECONFIGURE: u8 = 7;
const MEMORY_MAPPED_FILE: u8 = 8;
/// Bytes of a pixel (BGRA) and of a range (f32).
const ELEMENT: usize = 4;
/// Bytes of a point of a lidar's cloud, which follows the ranges.
const POINT: usize = 20;
/// Largest image that is accepted: 16 million pixels.
const MAX_ELEMENTS: usize = 1 << 24;

/// A device that sends images.
#[derive(Debug, Clone)]
pub(crate) struct Imager {
    pub kind: DeviceKind,
    pub width: usize,
    pub height: usize,
    /// Horizontal field of view, in rad.
    pub field_of_view: f64,
    pub near: f64,
    /// Largest range in m; infinite for cameras.
    pub max_range: f64,
    image: Vec<u8>,
    /// Where Webots writes the images, on one machine.
    file: Option<PathBuf>,
    new_period: Option<u16>,
}

impl Imager {
    pub(super) fn new(kind: DeviceKind) -> Self {
        Self {
            kind,
            width: 0,
            height: 0,
            field_of_view: f64::NAN,
            near: f64::NAN,
            max_range: f64::INFINITY,
            image: Vec::new(),
            file: None,
            new_period: None,
        }
    }

    /// Returns the last image: BGRA for cameras, f32 ranges otherwise; empty before the first.
    pub fn image(&self) -> &[u8] {
        let length = self.elements() * ELEMENT;
        self.image.get(..length).unwrap_or_default()
    }

    /// Returns the bytes that the image occupies.
    #[cfg(test)]
    pub fn held(&self) -> usize {
        self.image.capacity()
    }

    fn elements(&self) -> usize {
        self.width * self.height
    }

    /// Reads an image of `size` bytes.
    pub fn receive(&mut self, stream: &mut impl Read, size: usize) -> Result<()> {
        let plain = self.elements() * ELEMENT;
        let with_points = plain + self.elements() * POINT;
        if plain == 0 || !(size == plain || self.kind == DeviceKind::Lidar && size == with_points) {
            return Err(Error::format(format!(
                "an image of {size} bytes does not fit {} by {} elements",
                self.width, self.height
            )));
        }
        self.image.truncate(size);
        receive(stream, &mut self.image, size)
    }

    /// Reads the image from the file in which Webots places it, if there is one.
    pub fn refresh(&mut self) -> Result<()> {
        let Some(path) = &self.file else { return Ok(()) };
        let size = self.elements() * ELEMENT;
        self.image.resize(size, 0);
        let read = File::open(path).and_then(|mut file| file.read_exact(&mut self.image));
        read.map_err(|error| {
            Error::io(format!("cannot read the image {}", path.display())).with_source(error)
        })
    }

    pub(super) fn enable(&mut self, period_ms: u16) {
        self.new_period = Some(period_ms);
    }

    pub(super) fn write(&mut self, request: &mut Request) {
        write_period(&mut self.new_period, request);
    }

    pub(super) fn apply_message(&mut self, command: u8, reader: &mut Reader<'_>) -> Result<bool> {
        match command {
            CONFIGURE => {
                let _id = reader.u32()?;
                (self.width, self.height) = (reader.u16()?.into(), reader.u16()?.into());
                self.optics(reader)?;
            }
            RECONFIGURE => self.optics(reader)?,
            MEMORY_MAPPED_FILE => {
                let size = reader.i32()?;
                self.file = if size > 0 { Some(reader.text()?.into()) } else { None };
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Reads what follows the size in a configuration.
    fn optics(&mut self, reader: &mut Reader<'_>) -> Result<()> {
        (self.field_of_view, self.near) = (reader.f64()?, reader.f64()?);
        let _planar = reader.u8()?;
        match self.kind {
            DeviceKind::Camera => {
                let (_min_view, _max_view) = (reader.f64()?, reader.f64()?);
                let (_recognition, _segmentation) = (reader.u8()?, reader.u8()?);
                // Exposure, focal length, focal distance and its limits.
                reader.fill(&mut [0.0; 5])?;
            }
            DeviceKind::Lidar => {
                self.max_range = reader.f64()?;
                self.height = reader.u16()?.into();
                // Frequency, its limits, vertical field of view.
                reader.fill(&mut [0.0; 4])?;
                let resolution = reader.f64()?;
                if !(0.0..=f64::from(u16::MAX)).contains(&resolution) {
                    return Err(Error::format(format!("a lidar of {resolution} columns is not possible")));
                }
                self.width = resolution as usize;
            }
            _ => self.max_range = reader.f64()?,
        }
        if self.elements() > MAX_ELEMENTS {
            let (width, height) = (self.width, self.height);
            (self.width, self.height) = (0, 0);
            return Err(Error::format(format!("an image of {width} by {height} is too large")));
        }
        Ok(())
    }
}
