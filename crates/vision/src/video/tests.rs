use super::*;
use crate::{Source, SourceOptions};
use opendr_engine::ErrorKind;
use opendr_engine::data::{Image, PixelFormat};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A temporary folder that is removed on drop; `None` where ffmpeg is not installed.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Option<Self> {
        if Command::new("ffmpeg").arg("-version").output().is_err() {
            assert!(std::env::var_os("CI").is_none(), "the tests need ffmpeg; install it");
            println!("skipped: no ffmpeg");
            return None;
        }
        let path = std::env::temp_dir().join(format!("opendr-video-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Some(Self(path))
    }

    /// Writes a test video with a running clock.
    fn video(&self, name: &str, arguments: &[&str]) -> PathBuf {
        let path = self.0.join(name);
        let made = Command::new("ffmpeg")
            .args(["-y", "-v", "error", "-f", "lavfi", "-i", "testsrc=size=160x120:rate=10:duration=2"])
            .args(arguments)
            .arg(&path)
            .status();
        assert!(made.unwrap().success());
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn every_frame_comes_once_with_its_time() {
    let Some(folder) = Folder::new("frames") else { return };
    let path = folder.video("-y clip[1].mp4", &[]);
    let source = Source::open(&path).unwrap();
    assert_eq!((source.len_hint(), source.is_live()), (Some(20), false));
    let frames: Vec<_> = source.map(Result::unwrap).collect();
    assert_eq!(frames.len(), 20);
    for (number, frame) in frames.iter().enumerate() {
        assert_eq!((frame.image.width(), frame.image.height()), (160, 120));
        assert_eq!((frame.frame_index, frame.item_index), (number as u64, number as u64));
        assert_eq!(frame.image.header.stamp_ns, Some(number as i64 * 100_000_000));
        assert_eq!(frame.name(), format!("-y clip[1]_{number:06}"));
        let info = frame.video.as_ref().unwrap();
        assert_eq!((info.frame_rate, info.frames, info.duration_s), (10.0, Some(20), Some(2.0)));
    }
    assert_ne!(frames[0].image, frames[19].image);
}

#[test]
fn varying_rate_keeps_its_times() {
    let Some(folder) = Folder::new("varying") else { return };
    let path = folder.video("clip.mkv", &["-vf", "select=lt(n\\,3)+eq(n\\,7)+eq(n\\,15)"]);
    let stamps: Vec<_> =
        Source::open(path).unwrap().map(|frame| frame.unwrap().image.header.stamp_ns.unwrap()).collect();
    assert_eq!(stamps, [0, 100, 200, 700, 1500].map(|ms| ms * 1_000_000));
}

#[test]
fn rotated_video_is_turned_upright() {
    let Some(folder) = Folder::new("rotated") else { return };
    let path = folder.video("clip.mp4", &[]);
    let mut bytes = fs::read(&path).unwrap();
    let header = bytes.windows(4).position(|word| word == b"tkhd").unwrap();
    // The matrix of a track header, 16.16 and 2.30 fixed point: a quarter turn.
    let quarter = [0, 1 << 16, 0, -1 << 16, 0, 0, 120 << 16, 0, 1 << 30_i32];
    for (index, value) in quarter.iter().enumerate() {
        bytes[header + 44 + index * 4..][..4].copy_from_slice(&i32::to_be_bytes(*value));
    }
    fs::write(&path, bytes).unwrap();
    let frame = Source::open(path).unwrap().next().unwrap().unwrap();
    assert_eq!((frame.image.width(), frame.image.height()), (120, 160));
}

#[test]
fn video_without_extension_is_detected_by_content() {
    let Some(folder) = Folder::new("content") else { return };
    let path = folder.video("clip.mkv", &[]);
    let bare = folder.0.join("clip");
    fs::rename(path, &bare).unwrap();
    assert_eq!(Source::open(bare).unwrap().count(), 20);
}

#[test]
fn errors_of_damaged_videos_include_the_message_of_ffmpeg() {
    let Some(folder) = Folder::new("damaged") else { return };
    let whole = fs::read(folder.video("whole.mp4", &["-movflags", "+faststart"])).unwrap();
    let cases = [
        ("empty.mp4", &b""[..], "Invalid data"),
        ("text.mp4", b"just text, and more of it", "Invalid data"),
        ("header.mp4", &whole[..whole.len() / 10], "ffprobe reports"),
    ];
    for (name, bytes, wanted) in cases {
        let path = folder.0.join(name);
        fs::write(&path, bytes).unwrap();
        let items: Vec<_> = Source::open(&path).unwrap().collect();
        let [Err(error)] = &items[..] else { panic!("{name}: {} items", items.len()) };
        let text = error.to_string();
        assert!(text.contains(name) && text.contains(wanted), "{text}");
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
    }
    let path = folder.0.join("cut.mp4");
    fs::write(&path, &whole[..whole.len() * 3 / 4]).unwrap();
    let items: Vec<_> = Source::open(&path).unwrap().collect();
    let (last, before) = items.split_last().unwrap();
    assert!(before.len() > 3 && before.iter().all(Result::is_ok), "{}", before.len());
    let text = last.as_ref().unwrap_err().to_string();
    assert!(text.contains("of 20 frames") && text.contains("ffmpeg reports"), "{text}");
}

#[test]
fn audio_without_video_is_rejected() {
    let Some(folder) = Folder::new("sound") else { return };
    let path = folder.0.join("sound.mkv");
    let made = Command::new("ffmpeg")
        .args(["-y", "-v", "error", "-f", "lavfi", "-i", "sine=duration=1", "-c:a", "flac"])
        .arg(&path)
        .status();
    assert!(made.unwrap().success());
    let error = Source::open(path).unwrap().next().unwrap().unwrap_err();
    assert!(error.to_string().contains("no video stream"), "{error}");
}

#[test]
fn large_frames_are_refused() {
    let Some(folder) = Folder::new("large") else { return };
    let path = folder.video("clip.mp4", &[]);
    let mut options = SourceOptions::default();
    options.decoder.max_samples = 160 * 120 * 3 - 3;
    let items: Vec<_> = Source::open_all([path], options).unwrap().collect();
    assert!(items.len() == 1 && items[0].is_err());
}

#[test]
fn a_playlist_reads_no_other_file() {
    let Some(folder) = Folder::new("playlist") else { return };
    let clip = folder.video("clip.ts", &[]);
    let path = folder.0.join("list.mp4");
    let list = format!("#EXTM3U\n#EXT-X-TARGETDURATION:2\n#EXTINF:2,\n{}\n#EXT-X-ENDLIST\n", clip.display());
    fs::write(&path, list).unwrap();
    let items: Vec<_> = Source::open(path).unwrap().collect();
    assert!(items.len() == 1 && items[0].is_err());
    assert_eq!(Source::open(clip).unwrap().count(), 20);
}

#[test]
fn slow_consumers_of_files_lose_nothing() {
    let Some(folder) = Folder::new("slow") else { return };
    let path = folder.video("clip.mp4", &[]);
    let mut source =
        Source::open_all([path], SourceOptions { prefetch: 1, ..SourceOptions::default() }).unwrap();
    let numbers: Vec<_> = source
        .by_ref()
        .map(|frame| {
            std::thread::sleep(std::time::Duration::from_millis(2));
            frame.unwrap().frame_index
        })
        .collect();
    assert_eq!((numbers, source.dropped()), ((0..20).collect(), 0));
}

#[test]
fn videos_and_pictures_follow_each_other() {
    let Some(folder) = Folder::new("mixed") else { return };
    folder.video("2.mp4", &[]);
    fs::write(folder.0.join("3.mp4"), "broken").unwrap();
    let still = Image::from_rgb8(vec![5; 3], 1, 1).unwrap();
    crate::save(&still, folder.0.join("1.png")).unwrap();
    crate::save(&still, folder.0.join("4.png")).unwrap();
    let source = Source::open(&folder.0).unwrap();
    assert_eq!(source.len_hint(), Some(23));
    let items: Vec<_> = source.collect();
    let good: Vec<_> = items.iter().map(Result::is_ok).collect();
    assert_eq!(good, (0..23).map(|index| index != 21).collect::<Vec<_>>());
    assert_eq!(items[20].as_ref().unwrap().item_index, 20);
}

#[cfg(target_os = "linux")]
#[test]
fn dropping_early_ends_the_child() {
    let children = |path: &Path| {
        let wanted = path.to_str().unwrap().to_owned();
        fs::read_dir("/proc")
            .unwrap()
            .flatten()
            .filter(|entry| {
                let arguments = fs::read(entry.path().join("cmdline")).unwrap_or_default();
                arguments.starts_with(b"ffmpeg") && String::from_utf8_lossy(&arguments).contains(&wanted)
            })
            .count()
    };
    let Some(folder) = Folder::new("early") else { return };
    let path = folder.video("clip.mp4", &["-t", "2"]);
    let mut source =
        Source::open_all([&path], SourceOptions { prefetch: 1, ..SourceOptions::default() }).unwrap();
    source.next().unwrap().unwrap();
    assert_eq!(children(&path), 1);
    drop(source);
    assert_eq!(children(&path), 0);
}

#[test]
fn written_videos_are_read_back() {
    let Some(folder) = Folder::new("written") else { return };
    // Odd sides, and an image that is not RGB.
    let path = folder.0.join("-out.mp4");
    let mut writer = VideoWriter::create(&path, 12.5).unwrap();
    for level in [0u8, 80, 160, 240] {
        writer.write(&Image::from_rgb8(vec![level; 33 * 21 * 3], 33, 21).unwrap()).unwrap();
    }
    let layout = opendr_engine::data::Layout::Chw;
    writer.write(&Image::new(vec![120u8; 33 * 21], 33, 21, PixelFormat::Grey, layout).unwrap()).unwrap();
    assert!(!path.exists());
    writer.finish().unwrap();
    let frames: Vec<_> = Source::open(&path).unwrap().map(Result::unwrap).collect();
    assert_eq!(frames.len(), 5);
    for (frame, level) in frames.iter().zip([0u8, 80, 160, 240, 120]) {
        assert_eq!((frame.image.width(), frame.image.height()), (34, 22));
        assert!(frame.image.chw_u8()[100].abs_diff(level) < 6);
        assert_eq!(frame.image.header.stamp_ns, Some(frame.frame_index as i64 * 80_000_000));
    }
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 1);
}

#[test]
fn a_writer_that_is_dropped_leaves_nothing() {
    let Some(folder) = Folder::new("dropped") else { return };
    let path = folder.0.join("out.mkv");
    let mut writer = VideoWriter::create(&path, 25.0).unwrap();
    writer.write(&Image::from_rgb8(vec![1; 48], 4, 4).unwrap()).unwrap();
    let error = writer.write(&Image::from_rgb8(vec![1; 3], 1, 1).unwrap()).unwrap_err();
    assert!(error.to_string().contains("4x4"), "{error}");
    drop(writer);
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 0);
}

#[test]
fn writers_reject_invalid_input() {
    let kind = |path: &str, rate| VideoWriter::create(path, rate).unwrap_err().kind();
    assert_eq!(kind("out.gif", 25.0), ErrorKind::Unsupported);
    assert_eq!(kind("/no/such/folder/out.mp4", 25.0), ErrorKind::NotFound);
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(kind("out.mp4", rate), ErrorKind::InvalidParam);
    }
    let error = VideoWriter::create("out.mp4", 25.0).unwrap().finish().unwrap_err();
    assert!(error.to_string().contains("no frame"), "{error}");
}
