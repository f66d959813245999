//! Recording of rendered images to a file.

use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use gif::{Encoder, Frame, Repeat};
use opendr_engine::data::{Image, PixelFormat};
use opendr_engine::{Error, Result, ResultExt as _};
use opendr_vision::VideoWriter;

/// Writes images to an animated GIF, a video (with an installed `ffmpeg`) or numbered PNG files.
///
/// GIFs and videos appear atomically when [`Recording::finish`] is called.
pub struct Recording {
    path: PathBuf,
    target: Target,
}

enum Target {
    Gif(Box<Gif>),
    Video(Box<VideoWriter>),
    /// PNG files, with the number written so far.
    Images(usize),
}

impl Recording {
    /// Creates a recording of `rate` images per second at `path`, which ends in `.gif`, `.mp4`, `.mov`, `.mkv` or `.png`; image 7 of
    /// `flight.png` is `flight-00007.png`.
    ///
    /// # Errors
    /// `Unsupported` for another extension, `InvalidParam` for a rate that is not from 0.01 to 1000, `NotFound` when
    /// the folder does not exist.
    pub fn create(path: impl AsRef<Path>, rate: f64) -> Result<Self> {
        let path = path.as_ref();
        if !(0.01..=1000.0).contains(&rate) {
            return Err(Error::invalid_param(format!(
                "the rate is {rate} images per second; give 0.01 to 1000"
            )));
        }
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        let target = match extension.to_ascii_lowercase().as_str() {
            "gif" => Target::Gif(Box::new(Gif::new(path, rate))),
            "png" => Target::Images(0),
            "mp4" | "mov" | "mkv" => Target::Video(Box::new(VideoWriter::create(path, rate)?)),
            _ => {
                return Err(Error::unsupported(format!(
                    "{} has no supported extension; use .gif, .mp4, .mov, .mkv or .png",
                    path.display()
                )));
            }
        };
        Ok(Self { path: path.to_owned(), target })
    }

    /// Adds an image.
    ///
    /// # Errors
    /// `InvalidInput` when its size differs from the first image's, `Unsupported` when `ffmpeg` is not installed, `Io` when
    /// the file cannot be written.
    pub fn write(&mut self, image: &Image) -> Result<()> {
        let written = match &mut self.target {
            Target::Gif(gif) => gif.write(image),
            Target::Video(video) => return video.write(image),
            Target::Images(count) => {
                *count += 1;
                let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
                let file = self.path.with_file_name(format!("{stem}-{count:05}.png"));
                return opendr_vision::save(image, file);
            }
        };
        written.context(|| format!("writing {}", self.path.display()))
    }

    /// Finishes the file.
    ///
    /// # Errors
    /// `InvalidInput` when there is no image, `Io` when the file cannot be written.
    pub fn finish(self) -> Result<()> {
        let finished = match self.target {
            Target::Gif(gif) => gif.finish(&self.path),
            Target::Video(video) => return video.finish(),
            Target::Images(0) => Err(no_image()),
            Target::Images(_) => Ok(()),
        };
        finished.context(|| format!("writing {}", self.path.display()))
    }
}

fn no_image() -> Error {
    Error::invalid_input("the recording has no images; write at least one")
}

struct Gif {
    encoder: Option<Encoder<BufWriter<File>>>,
    size: (u16, u16),
    /// Delay per image in hundredths of a second; `owed` carries its rounding error over to the next image.
    pause: f64,
    owed: f64,
    partial: PathBuf,
}

impl Gif {
    fn new(path: &Path, rate: f64) -> Self {
        let mut name = path.file_stem().unwrap_or_default().to_owned();
        name.push(format!(".{}.partial.gif", std::process::id()));
        let partial = path.with_file_name(name);
        Self { encoder: None, size: (0, 0), pause: 100.0 / rate, owed: 0.0, partial }
    }

    fn write(&mut self, image: &Image) -> Result<()> {
        let size = |side: usize| {
            u16::try_from(side).map_err(|_| {
                Error::invalid_input(format!(
                    "an image side of {side} pixels; a GIF allows at most 65535, use another format"
                ))
            })
        };
        let size = (size(image.width())?, size(image.height())?);
        let encoder = match &mut self.encoder {
            Some(encoder) => encoder,
            None => {
                let file = BufWriter::new(File::create(&self.partial)?);
                let mut encoder = Encoder::new(file, size.0, size.1, &[]).map_err(failed)?;
                encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
                self.size = size;
                self.encoder.insert(encoder)
            }
        };
        if self.size != size {
            return Err(Error::invalid_input(format!(
                "the image has {size:?} pixels, the recording {:?}; resize it, or write another file",
                self.size
            )));
        }
        // Lossless for up to 256 colours; plain drawings have few.
        let mut frame = Frame::from_rgb_speed(size.0, size.1, &image.hwc_u8(PixelFormat::Rgb), 10);
        self.owed += self.pause;
        frame.delay = self.owed.round().clamp(1.0, 65_535.0) as u16;
        self.owed -= f64::from(frame.delay);
        encoder.write_frame(&frame).map_err(failed)
    }

    fn finish(mut self, path: &Path) -> Result<()> {
        let encoder = self.encoder.take().ok_or_else(no_image)?;
        encoder.into_inner().map_err(failed)?.flush()?;
        Ok(fs::rename(&self.partial, path)?)
    }
}

impl Drop for Gif {
    fn drop(&mut self) {
        // After the rename the file no longer exists.
        let _ = fs::remove_file(&self.partial);
    }
}

fn failed(error: gif::EncodingError) -> Error {
    Error::io("the image cannot be encoded").with_source(error)
}

#[cfg(test)]
mod tests {
    use opendr_engine::Random;
    use opendr_engine::environment::ResetOptions;

    use super::*;
    use crate::{Registry, make};

    /// Every environment renders images, which depend on the state.
    #[test]
    fn every_environment_renders_images() {
        let mut random = Random::new(0);
        for id in Registry::builtin().ids() {
            let mut environment = make(id).unwrap();
            assert!(environment.render().is_err(), "{id}");
            let mut seen = vec![0.0; environment.spec().observation.len()];
            environment.reset(Some(1), &ResetOptions::new(), &mut seen).unwrap();
            let before = environment.render().unwrap().unwrap();
            let mut action = vec![0.0; environment.spec().action.len()];
            for _ in 0..3 {
                environment.spec().action.sample_into(&mut random, &mut action);
                if environment.step(&action, &mut seen).unwrap().is_over() {
                    break;
                }
            }
            let after = environment.render().unwrap().unwrap();
            assert_eq!((before.width(), before.height()), (after.width(), after.height()), "{id}");
            assert_ne!(before, after, "{id}");
        }
    }

    #[test]
    fn recordings_appear_atomically() {
        let folder = std::env::temp_dir().join(format!("opendr-film-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let picture = |grey: u8| Image::from_rgb8(vec![grey; 3 * 6 * 4], 6, 4).unwrap();
        let path = folder.join("a.gif");
        let mut film = Recording::create(&path, 30.0).unwrap();
        (0..3).for_each(|grey| film.write(&picture(grey)).unwrap());
        assert!(!path.exists());
        assert!(film.write(&Image::from_rgb8(vec![0; 3], 1, 1).unwrap()).is_err());
        film.finish().unwrap();
        let bytes = fs::read(&path).unwrap();
        assert!(bytes.starts_with(b"GIF89a\x06\x00\x04\x00") && bytes.ends_with(b";"));
        // The delays of 30 images per second are 3.33 hundredths each.
        let delays: Vec<_> = bytes.windows(6).filter(|w| w[..3] == [0x21, 0xf9, 4]).map(|w| w[4]).collect();
        assert_eq!(delays, [3, 4, 3]);

        let mut film = Recording::create(folder.join("b.png"), 1.0).unwrap();
        film.write(&picture(7)).unwrap();
        film.finish().unwrap();
        assert_eq!(opendr_vision::open(folder.join("b-00001.png")).unwrap().chw_u8(), [7; 72]);
        assert!(Recording::create(folder.join("c.gif"), 5.0).unwrap().finish().is_err());
        assert!(Recording::create(folder.join("c.txt"), 5.0).is_err());
        assert!(Recording::create(folder.join("c.gif"), f64::NAN).is_err());
        drop(Recording::create(&path, 30.0).map(|mut film| film.write(&picture(1))).unwrap());
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
        fs::remove_dir_all(&folder).unwrap();
    }
}
