use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};

use flate2::Compression;
use flate2::write::GzEncoder;
use opendr_engine::ErrorKind;
use tar::Header;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::*;

/// An archive on disk, removed at the end of the test.
struct Archive(PathBuf);

impl Drop for Archive {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

fn archive(bytes: &[u8]) -> Archive {
    static COUNTER: AtomicU32 = AtomicU32::new(0);
    let name = format!("opendr-archive-{}-{}", std::process::id(), COUNTER.fetch_add(1, Ordering::Relaxed));
    let path = std::env::temp_dir().join(name);
    fs::write(&path, bytes).unwrap();
    Archive(path)
}

/// Gzips a tar of these names, kinds and contents; names are written unchecked.
fn tgz(entries: &[(&str, EntryType, &[u8])]) -> Archive {
    let mut tar = tar::Builder::new(GzEncoder::new(Vec::new(), Compression::fast()));
    for (name, kind, bytes) in entries {
        let mut header = Header::new_gnu();
        header.as_mut_bytes()[..name.len()].copy_from_slice(name.as_bytes());
        header.set_entry_type(*kind);
        header.set_size(bytes.len() as u64);
        if kind.is_symlink() {
            header.set_link_name("/etc/passwd").unwrap();
        }
        header.set_cksum();
        tar.append(&header, *bytes).unwrap();
    }
    archive(&tar.into_inner().unwrap().finish().unwrap())
}

fn zipped(entries: &[(&str, &[u8])]) -> Archive {
    let mut zip = ZipWriter::new(io::Cursor::new(Vec::new()));
    for (name, bytes) in entries {
        zip.start_file(*name, SimpleFileOptions::default()).unwrap();
        zip.write_all(bytes).unwrap();
    }
    archive(&zip.finish().unwrap().into_inner())
}

/// Extracts the member `a/b` of three bytes.
fn extracted(archive: &Archive) -> Result<Vec<(String, Vec<u8>)>> {
    let mut taken = Vec::new();
    extract(&archive.0, &|name| (name == "a/b").then_some(3), &mut |name, bytes| {
        taken.push((name.to_owned(), bytes));
        Ok(())
    })?;
    Ok(taken)
}

fn refused(archive: &Archive) -> String {
    let error = extracted(archive).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Integrity, "{error}");
    error.to_string()
}

#[test]
fn wanted_members_come_out_of_both_kinds() {
    let expected = vec![("a/b".to_owned(), b"abc".to_vec())];
    let file = EntryType::Regular;
    let tar = tgz(&[("a/", EntryType::Directory, b""), ("a/c", file, b"other"), ("a/b", file, b"abc")]);
    assert_eq!(extracted(&tar).unwrap(), expected);
    assert_eq!(extracted(&zipped(&[("a/c", b"other"), ("a/b", b"abc")])).unwrap(), expected);
    assert_eq!(extracted(&zipped(&[("x", b"")])).unwrap(), []);
}

#[test]
fn names_that_leave_the_folder_are_refused() {
    for name in ["../../x", "/etc/passwd", "a/../../b", "C:\\x", "a\\..\\x"] {
        assert!(refused(&tgz(&[(name, EntryType::Regular, b"abc")])).contains("could leave its folder"));
        assert!(
            refused(&zipped(&[("a/b", b"abc"), (name, b"abc")])).contains("could leave its folder"),
            "{name}"
        );
    }
}

#[test]
fn links_are_refused() {
    for kind in [EntryType::Symlink, EntryType::Link, EntryType::Char, EntryType::Fifo] {
        assert!(refused(&tgz(&[("a/b", kind, b"")])).contains("link or device"), "{kind:?}");
    }
    let mut zip = ZipWriter::new(io::Cursor::new(Vec::new()));
    zip.add_symlink("a/b", "../../x", SimpleFileOptions::default()).unwrap();
    let zip = archive(&zip.finish().unwrap().into_inner());
    assert!(refused(&zip).contains("link or device"));
}

#[test]
fn members_of_another_size_are_refused() {
    for bytes in [&b"ab"[..], b"abcd", &[0; 100_000]] {
        assert!(refused(&tgz(&[("a/b", EntryType::Regular, bytes)])).contains("instead of 3"));
        assert!(refused(&zipped(&[("a/b", bytes)])).contains("instead of 3"));
    }
}

#[test]
fn decompression_bombs_are_refused() {
    let zeros = vec![0; 64 << 20];
    let bomb = tgz(&[("big", EntryType::Regular, &zeros), ("a/b", EntryType::Regular, b"abc")]);
    assert!(fs::metadata(&bomb.0).unwrap().len() < 1 << 20);
    assert!(refused(&bomb).contains("unpacks to more than"));
    // A zip's members are found without unpacking the others.
    assert_eq!(extracted(&zipped(&[("big", &zeros), ("a/b", b"abc")])).unwrap().len(), 1);
}

#[test]
fn damaged_archives_are_refused() {
    let file = EntryType::Regular;
    for whole in [tgz(&[("a/b", file, b"abc"), ("c", file, &[7; 5000])]), zipped(&[("a/b", b"abc")])] {
        let bytes = fs::read(&whole.0).unwrap();
        for cut in [2, 20, bytes.len() / 2, bytes.len() - 10] {
            assert!(extracted(&archive(&bytes[..cut])).is_err(), "cut at {cut}");
        }
    }
    let mut bytes = fs::read(&zipped(&[("a/b", b"abc")]).0).unwrap();
    let at = bytes.windows(3).position(|window| window == b"abc");
    bytes[at.unwrap_or(35)] ^= 1;
    refused(&archive(&bytes));
    assert_eq!(extracted(&archive(b"neither")).unwrap_err().kind(), ErrorKind::Format);
    assert!(extracted(&archive(b"")).is_err());
}
