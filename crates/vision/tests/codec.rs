//! Image files of every supported kind, and files that are not images.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::PathBuf;

use opendr_engine::ErrorKind;
use opendr_engine::data::{Image, Layout, PixelFormat};
use opendr_vision::{Decoder, Encoder, decode, open, save};

/// Colours of the quarters of a 16x12 image: left top, right top, left bottom, right bottom.
const QUARTERS: [[u8; 3]; 4] = [[200, 30, 40], [20, 180, 60], [30, 50, 190], [220, 210, 20]];

fn quarters() -> Image {
    let pixel = |index: usize| QUARTERS[(index / 16 / 6) * 2 + index % 16 / 8];
    Image::from_rgb8((0..16 * 12).flat_map(pixel).collect(), 16, 12).unwrap()
}

/// Returns the colours in the middle of the quarters.
fn colours(image: &Image) -> [[u8; 3]; 4] {
    let (width, height) = (image.width(), image.height());
    let rgb = image.hwc_u8(PixelFormat::Rgb);
    [(1, 1), (3, 1), (1, 3), (3, 3)].map(|(x, y)| {
        let at = ((height * y / 4) * width + width * x / 4) * 3;
        [rgb[at], rgb[at + 1], rgb[at + 2]]
    })
}

#[track_caller]
fn assert_near(found: [[u8; 3]; 4], wanted: [[u8; 3]; 4], most: u8) {
    let off = found.as_flattened().iter().zip(wanted.as_flattened()).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(off.unwrap() <= most, "{found:?} is not {wanted:?}");
}

fn picture(name: &str) -> PathBuf {
    PathBuf::from(std::env::var("CARGO_MANIFEST_DIR").unwrap()).join("tests/pictures").join(name)
}

/// A temporary folder that is removed on drop.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("opendr-vision-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn colours_come_out_of_every_variant() {
    let grey = QUARTERS.map(|[red, ..]| [red; 3]);
    for (name, format, wanted, most) in [
        ("progressive.jpg", PixelFormat::Rgb, QUARTERS, 8),
        ("cmyk.jpg", PixelFormat::Rgb, QUARTERS, 8),
        ("ycck.jpg", PixelFormat::Rgb, QUARTERS, 8),
        ("lossy.webp", PixelFormat::Rgb, QUARTERS, 8),
        ("palette.png", PixelFormat::Rgb, QUARTERS, 0),
        ("palette.bmp", PixelFormat::Rgb, QUARTERS, 0),
        ("interlaced.png", PixelFormat::Rgb, QUARTERS, 0),
        ("deep.png", PixelFormat::Rgb, QUARTERS, 0),
        ("deep_grey.png", PixelFormat::Grey, grey, 0),
        ("grey_alpha.png", PixelFormat::Rgba, grey, 0),
    ] {
        let image = open(picture(name)).unwrap();
        assert_eq!((image.width(), image.height(), image.format()), (16, 12, format), "{name}");
        assert_near(colours(&image), wanted, most);
    }
}

#[test]
fn saved_pictures_come_back() {
    let folder = Folder::new("saved");
    let bgr = Image::new(quarters().hwc_u8(PixelFormat::Bgr), 16, 12, PixelFormat::Bgr, Layout::Hwc).unwrap();
    let planes = Image::new(quarters().chw_u8(), 16, 12, PixelFormat::Rgb, Layout::Chw).unwrap();
    for (name, most) in [("a.png", 0), ("a.bmp", 0), ("a.webp", 0), ("a.jpg", 16), ("a.JPEG", 16)] {
        for image in [&quarters(), &bgr, &planes] {
            let path = folder.0.join(name);
            save(image, &path).unwrap();
            assert_near(colours(&open(&path).unwrap()), QUARTERS, most);
        }
    }
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 5, "no temporary file stays");
}

#[test]
fn grey_and_opacity_are_kept() {
    let folder = Folder::new("kept");
    let grey =
        Image::new(quarters().hwc_u8(PixelFormat::Grey), 16, 12, PixelFormat::Grey, Layout::Hwc).unwrap();
    let mut samples = quarters().hwc_u8(PixelFormat::Bgra);
    samples[3] = 77;
    let faint = Image::new(samples, 16, 12, PixelFormat::Bgra, Layout::Hwc).unwrap();
    for name in ["a.png", "a.bmp", "a.webp"] {
        let path = folder.0.join(name);
        save(&faint, &path).unwrap();
        assert_eq!(open(&path).unwrap().hwc_u8(PixelFormat::Rgba), faint.hwc_u8(PixelFormat::Rgba), "{name}");
        save(&grey, &path).unwrap();
        assert_eq!(open(&path).unwrap().hwc_u8(PixelFormat::Grey), grey.hwc_u8(PixelFormat::Grey), "{name}");
    }
    save(&grey, folder.0.join("a.jpg")).unwrap();
    assert_eq!(open(folder.0.join("a.jpg")).unwrap().format(), PixelFormat::Grey);
    save(&faint, folder.0.join("a.jpg")).unwrap();
    assert_eq!(open(folder.0.join("a.jpg")).unwrap().format(), PixelFormat::Rgb);
}

/// Returns `quarters` as a JPEG file with an EXIF orientation.
fn turned_jpeg(orientation: u8) -> Vec<u8> {
    let folder = Folder::new(&format!("turned-{orientation}"));
    let path = folder.0.join("a.jpg");
    save(&quarters(), &path).unwrap();
    let mut exif = b"\xff\xe1\x00\x22Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0".to_vec();
    exif.extend([orientation, 0, 0, 0, 0, 0, 0, 0]);
    let mut bytes = fs::read(path).unwrap();
    bytes.splice(2..2, exif);
    bytes
}

#[test]
fn all_eight_orientations_are_honoured() {
    // The stored quarter that is displayed left top, right top, left bottom, right bottom (EXIF 2.32, 4.6.4).
    let seen = [
        [0, 1, 2, 3],
        [1, 0, 3, 2],
        [3, 2, 1, 0],
        [2, 3, 0, 1],
        [0, 2, 1, 3],
        [2, 0, 3, 1],
        [3, 1, 2, 0],
        [1, 3, 0, 2],
    ];
    for (orientation, wanted) in (1..).zip(seen) {
        let image = decode(&turned_jpeg(orientation)).unwrap();
        let size = if orientation < 5 { (16, 12) } else { (12, 16) };
        assert_eq!((image.width(), image.height()), size, "orientation {orientation}");
        assert_near(colours(&image), wanted.map(|quarter| QUARTERS[quarter]), 16);
    }
}

#[test]
fn truncated_and_damaged_files_are_refused() {
    for name in ["progressive.jpg", "cmyk.jpg", "interlaced.png", "deep.png", "lossy.webp", "palette.bmp"] {
        let bytes = fs::read(picture(name)).unwrap();
        for length in [bytes.len() / 4, bytes.len() / 2, bytes.len() - bytes.len() / 8] {
            let error = decode(&bytes[..length]).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::InvalidInput, "{name} cut to {length}: {error}");
        }
    }
    // The end marker of an embedded preview is not the image's.
    let mut previewed = turned_jpeg(1);
    previewed.splice(2..2, *b"\xff\xe2\0\x0a\xff\xd8\xff\xda\0\0\xff\xd9");
    assert!(decode(&previewed).is_ok());
    let error = decode(&previewed[..previewed.len() - 30]).unwrap_err();
    assert!(error.to_string().contains("truncated"), "{error}");
}

#[test]
fn a_flipped_byte_never_panics() {
    for name in ["progressive.jpg", "ycck.jpg", "palette.png", "lossy.webp", "palette.bmp"] {
        let bytes = fs::read(picture(name)).unwrap();
        for at in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x55;
            let _ = Decoder { max_samples: 1 << 16 }.decode(&damaged);
        }
    }
}

#[test]
fn headers_that_claim_too_much_are_refused() {
    let mut jpeg = turned_jpeg(1);
    let frame = jpeg.windows(2).position(|pair| pair == [0xff, 0xc0]).unwrap();
    jpeg[frame + 5..frame + 9].fill(0xff);
    let mut png = fs::read(picture("deep.png")).unwrap();
    png[16..24].copy_from_slice(&[0, 0, 0xff, 0xff, 0, 0, 0xff, 0xff]);
    png.splice(29..33, 0x69f7_9244_u32.to_be_bytes());
    let mut bmp = fs::read(picture("palette.bmp")).unwrap();
    bmp[18..26].copy_from_slice(&[0xff, 0xff, 0, 0, 0xff, 0xff, 0, 0]);
    // One lossless chunk whose header says 16383x16383.
    let webp = b"RIFF\x16\0\0\0WEBPVP8L\x0a\0\0\0\x2f\xfe\xbf\xff\x0f\0\0\0\0\0".to_vec();
    for (name, bytes) in [("jpeg", jpeg), ("png", png), ("bmp", bmp), ("webp", webp)] {
        let error = decode(&bytes).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidInput, "{name}: {error}");
        assert!(error.to_string().contains("over the limit"), "{name}: {error}");
    }
    let small = Decoder { max_samples: 16 * 12 * 3 - 1 };
    let error = small.open(picture("palette.png")).unwrap_err();
    assert!(error.to_string().contains("16x12") && error.to_string().contains("limit of 575"), "{error}");
}

#[test]
fn errors_of_files_that_are_not_images_state_the_content() {
    let folder = Folder::new("others");
    for (name, content, kind, wanted) in [
        ("text.jpg", &b"Dear reader, this is no picture"[..], ErrorKind::InvalidInput, "text (\"Dear reader"),
        ("empty.png", b"", ErrorKind::InvalidInput, "an empty file"),
        ("noise.png", b"\x01\x02\xfe\x00\x99", ErrorKind::InvalidInput, "01 02 fe 00 99"),
        ("movie.gif", b"GIF89a\x01\0\x01\0", ErrorKind::Unsupported, "a gif file"),
    ] {
        let path = folder.0.join(name);
        fs::write(&path, content).unwrap();
        let error = open(&path).unwrap_err();
        assert_eq!(error.kind(), kind, "{error}");
        assert!(error.to_string().contains(wanted) && error.to_string().contains(name), "{error}");
    }
    assert_eq!(open(folder.0.join("none.jpg")).unwrap_err().kind(), ErrorKind::NotFound);
    assert_eq!(open(&folder.0).unwrap_err().kind(), ErrorKind::InvalidInput);
}

#[test]
fn failed_saves_leave_no_files() {
    let folder = Folder::new("refused");
    let name = |name: &str| folder.0.join(name);
    assert_eq!(save(&quarters(), name("a.gif")).unwrap_err().kind(), ErrorKind::Unsupported);
    assert_eq!(save(&quarters(), name("a")).unwrap_err().kind(), ErrorKind::Unsupported);
    assert_eq!(save(&quarters(), name("none/a.png")).unwrap_err().kind(), ErrorKind::NotFound);
    let wrong = Encoder { jpeg_quality: 0 };
    assert_eq!(wrong.save(&quarters(), name("a.jpg")).unwrap_err().kind(), ErrorKind::InvalidParam);
    let wide = Image::from_rgb8(vec![0; 70_000 * 3], 70_000, 1).unwrap();
    assert_eq!(save(&wide, name("a.jpg")).unwrap_err().kind(), ErrorKind::InvalidInput);
    fs::create_dir(name("folder.png")).unwrap();
    assert!(save(&quarters(), name("folder.png")).is_err());
    let left: Vec<_> = fs::read_dir(&folder.0).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["folder.png"]);
}
