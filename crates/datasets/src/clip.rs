//! Clips for learners of image sequences, from a video file, a folder of images or an array.

use std::path::Path;

use opendr_engine::data::{Image, Layout, PixelFormat, Video};
use opendr_engine::{Error, Result, ResultExt};
use opendr_vision::{Source, SourceOptions, resize};

use crate::array_from_npy;
use crate::folder::{has_extension, read_bytes};

/// File extensions of clips.
pub(crate) const CLIPS: &[&str] =
    &["npy", "mp4", "m4v", "mov", "mkv", "webm", "avi", "mpg", "mpeg", "ts", "flv", "wmv", "ogv", "gif"];

/// Longer side of frames in pixels; larger frames are resized. Networks for clips use far smaller inputs.
const MAX_SIDE: usize = 640;
/// Largest size of a clip in bytes; of longer clips every second frame is kept, or every fourth, and so on.
const MAX_BYTES: usize = 256 << 20;

/// Reads the clip at `path`: a `.npy` of `[channels, frames, height, width]`, a video file, or a folder of images
/// as frames, in the order of their names. Levels of videos and images are within 0 and 1. Frames of more than 640
/// pixels a side are resized, and a clip of more than 256 MB is subsampled evenly.
///
/// # Errors
/// `NotFound`, `Io` or `Unsupported` if it cannot be read, `Format` if it is not a clip or its frames differ in
/// size; all with the path.
pub(crate) fn open_clip(path: &Path) -> Result<Video> {
    let opening = || format!("opening {}", path.display());
    if has_extension(&path.to_string_lossy(), &["npy"]) {
        let (shape, numbers) = array_from_npy(&read_bytes(path, 2 * MAX_BYTES as u64)?).context(opening)?;
        let shape = <[usize; 4]>::try_from(&shape[..]).map_err(|_| {
            Error::format(format!(
                "the array has {} axes; a clip needs channels, frames, height and width",
                shape.len()
            ))
            .context(opening())
        })?;
        let numbers: Vec<_> = numbers.into_iter().map(|number| number as f32).collect();
        return Video::new(numbers, shape).context(opening);
    }
    Source::open_all([path], SourceOptions::default())
        .and_then(|source| thinned(source.map(|frame| frame.map(|frame| frame.image)), MAX_BYTES))
        .context(opening)
}

/// Collects all frames, subsampled evenly if they would take more than `limit` bytes.
fn thinned(pictures: impl Iterator<Item = Result<Image>>, limit: usize) -> Result<Video> {
    let (mut frames, mut size): (Vec<Vec<u8>>, _) = (Vec::new(), None);
    // Every `step`th frame is kept.
    let mut step = 1;
    for (number, picture) in pictures.enumerate() {
        let picture = picture?;
        let given = [picture.width(), picture.height()];
        let [width, height] = *size.get_or_insert(given);
        if given != [width, height] {
            let [wide, high] = given;
            return Err(Error::format(format!(
                "frame {number} is of {wide}x{high} pixels, the first is of {width}x{height}; all frames must have one size"
            )));
        }
        if number % step != 0 {
            continue;
        }
        let pixels = match small([width, height]) {
            [wide, high] if [wide, high] != given => resize(&picture, wide, high)?.hwc_u8(PixelFormat::Rgb),
            _ => picture.hwc_u8(PixelFormat::Rgb),
        };
        if frames.len() > 1 && (frames.len() + 1) * pixels.len() * size_of::<f32>() > limit {
            let mut keep = [true, false].into_iter().cycle();
            frames.retain(|_| keep.next().unwrap_or(true));
            step *= 2;
            if number % step != 0 {
                continue;
            }
        }
        frames.push(pixels);
    }
    let [width, height] = small(size.ok_or_else(|| Error::format("the clip has no frames"))?);
    let levels = (0..3).flat_map(|channel| {
        let planes = frames.iter().map(move |frame| frame.iter().skip(channel).step_by(3));
        planes.flatten().map(|level| f32::from(*level) / 255.0)
    });
    let mut numbers = Vec::with_capacity(3 * frames.len() * width * height);
    numbers.extend(levels);
    Video::new(numbers, [3, frames.len(), height, width])
}

/// Returns a frame of a clip with levels within 0 and 1, as an image.
///
/// # Errors
/// `Unsupported` if it does not have three channels.
pub(crate) fn frame_of(clip: &Video, number: usize) -> Result<Image> {
    let [channels, frames, height, width] = clip.shape();
    if channels != 3 {
        return Err(Error::unsupported(format!("the clip has {channels} channels; images need three")));
    }
    let planes = clip.as_slice().chunks_exact(height * width).skip(number).step_by(frames);
    let levels = planes.flatten().map(|level| (level * 255.0).round() as u8).collect::<Vec<_>>();
    Image::new(levels, width, height, PixelFormat::Rgb, Layout::Chw)
}

/// Returns the size to which frames are resized.
fn small([width, height]: [usize; 2]) -> [usize; 2] {
    let longer = width.max(height);
    let shrunk = |side: usize| if longer > MAX_SIDE { (side * MAX_SIDE / longer).max(1) } else { side };
    [shrunk(width), shrunk(height)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::folder::TemporaryFolder;
    use crate::npy_from_values;

    /// Returns frames; frame `at` has the constant level `at`.
    fn frames(count: usize, width: usize, height: usize) -> impl Iterator<Item = Result<Image>> {
        (0..count).map(move |at| {
            let data = vec![at as u8; width * height];
            Image::new(data, width, height, PixelFormat::Grey, Layout::Hwc)
        })
    }

    /// Returns the level of each frame of a clip.
    fn levels(clip: &Video) -> Vec<u8> {
        let [_, frames, height, width] = clip.shape();
        let of_frame = clip.as_slice().chunks(height * width).take(frames);
        of_frame.map(|plane| (plane[0] * 255.0).round() as u8).collect()
    }

    #[test]
    fn long_clips_are_subsampled_evenly() {
        let clip = |count| thinned(frames(count, 4, 2), 10 * 3 * 8 * 4).unwrap();
        assert_eq!(levels(&clip(10)), [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]);
        assert_eq!(levels(&clip(11)), [0, 2, 4, 6, 8, 10]);
        assert_eq!(levels(&clip(21)), [0, 4, 8, 12, 16, 20]);
        assert_eq!(levels(&clip(250)).len(), 8);
        assert_eq!(clip(3).shape(), [3, 3, 2, 4]);
    }

    #[test]
    fn large_frames_are_resized() {
        let clip = thinned(frames(2, 1280, 300), MAX_BYTES).unwrap();
        assert_eq!((clip.shape(), levels(&clip)), ([3, 2, 150, 640], vec![0, 1]));
        // Two frames are kept for any frame size.
        assert_eq!(thinned(frames(9, 4, 2), 1).unwrap().shape()[1], 2);
    }

    #[test]
    fn what_is_no_clip_is_an_error() {
        let other = Image::new(vec![0u8; 6], 3, 2, PixelFormat::Grey, Layout::Hwc);
        let error = thinned(frames(2, 4, 2).chain([other]), MAX_BYTES).unwrap_err().to_string();
        assert!(error.contains("frame 2 is of 3x2"), "{error}");
        assert!(thinned(frames(0, 4, 2), MAX_BYTES).is_err());
        let folder = TemporaryFolder::new();
        folder.write("flat.npy", npy_from_values(&[0.0; 4], &[2, 2]).unwrap());
        folder.write("broken.mp4", "no video");
        for (name, wanted) in [("flat.npy", "2 axes"), ("broken.mp4", "broken.mp4"), ("none.avi", "none.avi")]
        {
            let error = open_clip(&folder.path().join(name)).unwrap_err().to_string();
            assert!(error.contains(wanted), "{error}");
        }
    }

    #[test]
    fn pictures_of_a_folder_and_numbers_are_clips() {
        let folder = TemporaryFolder::new();
        for name in ["dance/2.png", "dance/10.png", "dance/1.png"] {
            folder.picture(name, 5, 4);
        }
        let clip = open_clip(&folder.path().join("dance")).unwrap();
        assert_eq!(clip.shape(), [3, 3, 4, 5]);
        folder.write("dance.npy", npy_from_values(clip.as_slice(), &clip.shape()).unwrap());
        assert_eq!(open_clip(&folder.path().join("dance.npy")).unwrap(), clip);
    }

    #[test]
    fn videos_are_clips() {
        let folder = TemporaryFolder::new();
        let path = folder.path().join("dusk.mkv");
        let mut video = opendr_vision::VideoWriter::create(&path, 10.0).unwrap();
        for frame in frames(6, 32, 24) {
            video.write(&frame.unwrap()).unwrap();
        }
        video.finish().unwrap();
        assert_eq!(open_clip(&path).unwrap().shape(), [3, 6, 24, 32]);
    }
}
