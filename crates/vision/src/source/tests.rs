use super::*;
use opendr_engine::ErrorKind;
use opendr_engine::data::Image;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

/// A temporary folder that is removed on drop.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("opendr-source-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// Writes a grey image with the level `level`, which identifies it.
    fn picture(&self, name: impl AsRef<Path>, level: u8) -> PathBuf {
        let path = self.0.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        let bytes = self.0.join(".written.png");
        crate::save(&Image::from_rgb8(vec![level; 4 * 3 * 3], 4, 3).unwrap(), &bytes).unwrap();
        fs::rename(bytes, &path).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn level(frame: &Frame) -> u8 {
    frame.image.chw_u8()[0]
}

fn still(level: u8) -> Frame {
    Frame {
        image: Image::from_rgb8(vec![level; 3], 1, 1).unwrap(),
        path: Arc::from(Path::new("camera")),
        item_index: 0,
        frame_index: u64::from(level),
        video: None,
    }
}

#[test]
fn one_picture() {
    let folder = Folder::new("one");
    let path = folder.picture("a b.png", 7);
    let mut source = Source::open(&path).unwrap();
    assert_eq!((source.len_hint(), source.is_live()), (Some(1), false));
    let frame = source.next().unwrap().unwrap();
    assert_eq!((level(&frame), frame.name().as_str(), &*frame.path), (7, "a b", &*path));
    assert!(source.next().is_none() && source.next().is_none());
}

#[test]
fn folder_in_order_with_many_threads_and_a_slow_consumer() {
    let folder = Folder::new("order");
    for number in 0..40 {
        folder.picture(format!("frame_{number}.png"), number);
    }
    fs::write(folder.0.join("notes.txt"), "no picture").unwrap();
    folder.picture("deeper/frame_99.png", 99);
    let options = SourceOptions { threads: 4, prefetch: 3, ..SourceOptions::default() };
    let source = Source::open_all([&folder.0], options).unwrap();
    assert_eq!(source.len_hint(), Some(40));
    let mut seen = 0;
    for (index, frame) in source.enumerate() {
        if index % 10 == 0 {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        let frame = frame.unwrap();
        assert_eq!((frame.item_index, usize::from(level(&frame))), (index as u64, index));
        seen += 1;
    }
    assert_eq!(seen, 40);
}

#[test]
fn broken_files_are_named_and_passed() {
    let folder = Folder::new("broken");
    folder.picture("1.png", 1);
    fs::write(folder.0.join("2.png"), "").unwrap();
    fs::write(folder.0.join("3.jpg"), "just text").unwrap();
    fs::create_dir(folder.0.join("4.jpg")).unwrap();
    let whole = fs::read(folder.0.join("1.png")).unwrap();
    fs::write(folder.0.join("5.png"), &whole[..whole.len() / 2]).unwrap();
    folder.picture("6.png", 6);
    for input in [folder.0.clone(), folder.0.join("*")] {
        let mut source = Source::open(&input).unwrap();
        assert_eq!(source.current_path(), None);
        let mut items = Vec::new();
        while let Some(item) = source.next() {
            items.push((item, source.current_path().unwrap().to_owned()));
        }
        let found: Vec<_> = items.iter().map(|(item, _)| item.as_ref().ok().map(level)).collect();
        let wanted = [Some(1), None, None, None, None, Some(6)];
        // A pattern matches files only, as in a shell.
        let wanted: Vec<_> =
            wanted.into_iter().enumerate().filter(|(index, _)| *index != 3 || input == folder.0).collect();
        assert_eq!(found, wanted.iter().map(|(_, level)| *level).collect::<Vec<_>>());
        for ((item, path), (index, _)) in items.iter().zip(&wanted) {
            assert!(path.file_stem().unwrap().to_str() == Some(&format!("{}", index + 1)), "{path:?}");
            if let Err(error) = item {
                let text = error.to_string();
                assert!(text.contains(&format!("{}.", index + 1)), "{text}");
            }
        }
    }
}

#[test]
fn patterns_go_down_folders() {
    let folder = Folder::new("glob");
    folder.picture("a/1.png", 1);
    folder.picture("a/b/2.png", 2);
    folder.picture("c/3.jpg", 3);
    folder.picture("a/.hidden.png", 4);
    let levels = |pattern: &str| -> Vec<u8> {
        Source::open(folder.0.join(pattern)).unwrap().map(|frame| level(&frame.unwrap())).collect()
    };
    assert_eq!(levels("**/*.png"), [1, 2]);
    assert_eq!(levels("**"), [1, 2, 3]);
    assert_eq!(levels("*/[13].*"), [1, 3]);
    assert_eq!(levels("a/../c/?.jpg"), [3]);
}

#[test]
fn a_file_whose_name_looks_like_a_pattern_is_that_file() {
    let folder = Folder::new("literal");
    let path = folder.picture("a[1].png", 5);
    folder.picture("a1.png", 6);
    assert_eq!(level(&Source::open(path).unwrap().next().unwrap().unwrap()), 5);
}

#[test]
fn inputs_without_images_are_errors() {
    let folder = Folder::new("empty");
    fs::write(folder.0.join("notes.txt"), "").unwrap();
    let kind_and_text = |input: &Path| {
        let error = Source::open(input).unwrap_err();
        (error.kind(), error.to_string())
    };
    for input in [folder.0.clone(), folder.0.join("*.png"), folder.0.join("none.png")] {
        let (kind, text) = kind_and_text(&input);
        assert_eq!(kind, ErrorKind::NotFound, "{text}");
        assert!(text.contains(folder.0.to_str().unwrap()), "{text}");
    }
    assert!(Source::open_all(Vec::<PathBuf>::new(), SourceOptions::default()).is_err());
}

#[test]
fn several_inputs_follow_each_other() {
    let folder = Folder::new("several");
    let (b, a) = (folder.picture("b.png", 2), folder.picture("a.png", 1));
    let source = Source::open_all([b, a, folder.0.clone()], SourceOptions::default()).unwrap();
    assert_eq!(source.len_hint(), Some(4));
    assert_eq!(source.map(|frame| level(&frame.unwrap())).collect::<Vec<_>>(), [2, 1, 1, 2]);
}

#[test]
fn image_without_extension_is_detected_by_content() {
    let folder = Folder::new("content");
    let path = folder.picture("picture", 9);
    assert_eq!(level(&Source::open(path).unwrap().next().unwrap().unwrap()), 9);
}

#[test]
fn dropping_early_stops_the_threads() {
    let folder = Folder::new("early");
    for number in 0..20 {
        folder.picture(format!("{number}.png"), number);
    }
    let mut source = Source::open(&folder.0).unwrap();
    source.next().unwrap().unwrap();
    let Some(Reading::Pictures(pictures)) = &source.reading else { panic!("pictures are read") };
    let shared = pictures.watch();
    drop(source);
    assert_eq!(shared.strong_count(), 0);
}

#[test]
fn live_frames_are_the_newest() {
    let (sender, receiver) = mpsc::channel::<Frame>();
    let taken = Arc::new(AtomicUsize::new(0));
    let counter = Arc::clone(&taken);
    let frames = receiver.into_iter().map(Ok).inspect(move |_| {
        counter.fetch_add(1, Ordering::SeqCst);
    });
    let mut source = Source::from_frames(frames, true);
    assert!(source.is_live() && source.len_hint().is_none());
    for number in 0..10 {
        sender.send(still(number)).unwrap();
    }
    drop(sender);
    // Wait until the thread has ended: the queue is closed and contains only the newest frame.
    let Some(Reading::Threaded(threaded)) = &mut source.reading else { panic!("a thread reads") };
    threaded.wait();
    assert_eq!(taken.load(Ordering::SeqCst), 10);
    assert_eq!((source.dropped(), source.next().unwrap().unwrap().frame_index), (9, 9));
    assert!(source.next().is_none());
}

#[test]
fn other_frames_are_never_dropped() {
    let mut source = Source::from_frames((0..50).map(|number| Ok(still(number))), false);
    assert_eq!(source.len_hint(), Some(50));
    std::thread::sleep(std::time::Duration::from_millis(20));
    let levels: Vec<u8> = source.by_ref().map(|frame| level(&frame.unwrap())).collect();
    assert_eq!((levels, source.dropped()), ((0..50).collect(), 0));
}

#[test]
fn a_panic_of_a_foreign_iterator_is_an_error() {
    let frames = (0..3).map(|number| if number == 1 { panic!("on purpose") } else { Ok(still(number)) });
    let items: Vec<_> = Source::from_frames(frames, false).collect();
    assert_eq!(items.len(), 2);
    assert_eq!(items[1].as_ref().unwrap_err().kind(), ErrorKind::Internal);
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    use std::os::unix::fs::symlink;

    #[test]
    fn links_that_loop_end() {
        let folder = Folder::new("loops");
        folder.picture("a/1.png", 1);
        symlink(&folder.0, folder.0.join("a/up")).unwrap();
        symlink("2.png", folder.0.join("a/2.png")).unwrap();
        symlink("1.png", folder.0.join("a/3.png")).unwrap();
        let items: Vec<_> = Source::open(folder.0.join("**/*.png")).unwrap().collect();
        let levels: Vec<_> = items.iter().map(|item| item.as_ref().ok().map(level)).collect();
        assert_eq!(levels, [Some(1), None, Some(1)]);
        assert_eq!(Source::open(folder.0.join("a")).unwrap().count(), 3);
        assert!(Source::open(folder.0.join("a/2.png")).unwrap().next().unwrap().is_err());
    }

    #[test]
    fn names_need_not_be_utf8() {
        let folder = Folder::new("bytes");
        let path = folder.picture(OsStr::from_bytes(b"\xff\xfe.png"), 8);
        for input in [&path, &folder.0, &folder.0.join("*.png")] {
            let frame = Source::open(input).unwrap().next().unwrap().unwrap();
            assert_eq!((level(&frame), &*frame.path), (8, &*path));
        }
    }

    #[test]
    fn pipes_are_refused_without_waiting() {
        let folder = Folder::new("pipe");
        for name in ["pipe.jpg", "pipe.mp4", "pipe"] {
            let path = folder.0.join(name);
            assert!(std::process::Command::new("mkfifo").arg(&path).status().unwrap().success());
            let error = Source::open(&path).unwrap().next().unwrap().unwrap_err();
            assert_eq!(error.kind(), ErrorKind::InvalidInput, "{error}");
            assert!(error.to_string().contains(name), "{error}");
        }
    }

    #[test]
    fn unreadable_folder_is_named() {
        use std::os::unix::fs::PermissionsExt;
        let folder = Folder::new("closed");
        fs::set_permissions(&folder.0, fs::Permissions::from_mode(0o000)).unwrap();
        let opened = Source::open(&folder.0);
        fs::set_permissions(&folder.0, fs::Permissions::from_mode(0o755)).unwrap();
        let error = opened.unwrap_err();
        // Root reads everything and finds an empty folder.
        assert!(matches!(error.kind(), ErrorKind::Io | ErrorKind::NotFound), "{error}");
        assert!(error.to_string().contains(folder.0.to_str().unwrap()), "{error}");
    }
}
