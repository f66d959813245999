//! Integrity of logs and checkpoints after a kill, with a full disk, and in a folder that is not writable.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::fs;
use std::io::{BufRead, BufReader};
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use opendr_engine::{ErrorKind, Random};
use opendr_runlog::{Checkpoints, RunLog, write_atomically};

/// Environment variables of the process that a test starts from its own program: the task, and its folder.
const TASK: &str = "OPENDR_RUNLOG_TASK";
const FOLDER: &str = "OPENDR_RUNLOG_FOLDER";

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("opendr-runlog-{name}-{}", std::process::id()));
        fs::remove_dir_all(&path).ok();
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        fs::remove_dir_all(&self.0).ok();
    }
}

/// Returns a command that runs this program for a task.
fn again(program: &Path, task: &str, folder: &Path) -> Command {
    let mut command = Command::new(program);
    command.args(["--exact", "task_of_another_process", "--nocapture"]);
    command.env(TASK, task).env(FOLDER, folder).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

#[test]
fn task_of_another_process() {
    let (Ok(task), Ok(folder)) = (std::env::var(TASK), std::env::var(FOLDER)) else { return };
    let folder = Path::new(&folder);
    match task.as_str() {
        "save" => save_forever(folder),
        "fill" => fill(folder),
        "be refused" => be_refused(folder),
        other => panic!("{other}"),
    }
}

fn save_forever(folder: &Path) {
    let checkpoints = Checkpoints::new(folder, 2).unwrap();
    let begin = checkpoints.latest().unwrap().map_or(1, |checkpoint| checkpoint.step + 1);
    for step in begin.. {
        // Twice, since a resumed run saves steps again.
        for _ in 0..2 {
            let weights = vec![step as u8; 200_000];
            checkpoints
                .save(step, &[("weights.bin", &weights), ("optimiser/moments.bin", &weights)])
                .unwrap();
            println!("\nsaved {step}");
        }
    }
}

#[test]
fn a_kill_never_loses_a_checkpoint() {
    let folder = Folder::new("kill");
    let mut random = Random::new(5);
    let mut saved = 0;
    // Disks differ in speed: if nothing new was saved, the next writer runs longer.
    let mut longest = 60_000;
    let mut kills = 0;
    while kills < 40 || saved <= 3 {
        kills += 1;
        assert!(kills < 400, "only {saved} were saved");
        let mut writer = again(&std::env::current_exe().unwrap(), "save", &folder.0).spawn().unwrap();
        sleep(Duration::from_micros(10_000 + random.below(longest) as u64));
        writer.kill().unwrap();
        writer.wait().unwrap();
        let printed = BufReader::new(writer.stdout.take().unwrap()).lines().map_while(Result::ok);
        let steps = printed.filter_map(|line| line.strip_prefix("saved ")?.parse::<u64>().ok());
        let before = saved;
        saved = steps.last().unwrap_or(saved);
        if saved == before {
            longest += longest / 10;
        }
        let latest = Checkpoints::new(&folder.0, 2).unwrap().latest().unwrap();
        let found = latest.as_ref().map_or(0, |checkpoint| checkpoint.step);
        assert!(found >= saved, "{found} after {saved} was saved");
        if let Some(checkpoint) = latest {
            assert!(checkpoint.skipped.is_empty(), "{:?}", checkpoint.skipped);
            let weights = checkpoint.file("optimiser/moments.bin").unwrap();
            assert!(weights.len() == 200_000 && weights.iter().all(|byte| *byte == checkpoint.step as u8));
        }
    }
    let checkpoints = Checkpoints::new(&folder.0, 2).unwrap();
    // A kill between the rename of a new checkpoint and the removal of the one that it replaced.
    let latest = checkpoints.latest().unwrap().unwrap();
    fs::create_dir_all(latest.path().with_extension("replaced").join("optimiser")).unwrap();
    checkpoints.save(latest.step + 10, &[("weights.bin", b"")]).unwrap();
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 2, "no incomplete checkpoint is left");
}

/// Files are limited to 64 KiB here.
fn fill(folder: &Path) {
    let checkpoints = Checkpoints::new(&folder.join("checkpoints"), 3).unwrap();
    checkpoints.save(1, &[("weights.bin", &[1; 1000])]).unwrap();
    let error = checkpoints.save(2, &[("weights.bin", &[2; 100_000])]).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Io);
    assert!(error.to_string().contains("step-0000000002") && error.to_string().contains("full"), "{error}");
    assert_eq!(checkpoints.latest().unwrap().unwrap().step, 1);
    assert_eq!(fs::read_dir(folder.join("checkpoints")).unwrap().count(), 1);

    let file = folder.join("state.json");
    write_atomically(&file, b"old").unwrap();
    assert_eq!(write_atomically(&file, &[0; 100_000]).unwrap_err().kind(), ErrorKind::Io);
    assert_eq!(fs::read(&file).unwrap(), b"old");

    let mut log = RunLog::open(Some(&folder.join("log")), None).unwrap();
    let error = (0..5000).find_map(|step| {
        log.scalar("loss", step, step as f64).unwrap();
        if step % 100 == 0 { log.flush().err() } else { None }
    });
    let error = error.expect("the limit is reached");
    assert_eq!(error.kind(), ErrorKind::Io);
    assert!(
        error.to_string().contains("events.out.tfevents") && error.to_string().contains("full"),
        "{error}"
    );
    println!("\ndone");
}

#[test]
fn a_full_disk_is_reported_and_nothing_is_lost() {
    let folder = Folder::new("full");
    let program = again(&std::env::current_exe().unwrap(), "fill", &folder.0);
    // A limit on the size of files simulates a full disk; its signal would end the process.
    let mut shell = Command::new("bash");
    shell.args(["-c", "trap '' XFSZ; ulimit -f 64; exec \"$0\" \"$@\""]).arg(program.get_program());
    shell.args(program.get_args()).env(TASK, "fill").env(FOLDER, &folder.0);
    let done = shell.output().unwrap();
    let printed = String::from_utf8_lossy(&done.stdout);
    assert!(
        done.status.success() && printed.contains("\ndone"),
        "{printed}{}",
        String::from_utf8_lossy(&done.stderr)
    );
    for entry in fs::read_dir(folder.0.join("log")).unwrap().flatten() {
        let bytes = fs::read(entry.path()).unwrap();
        let name = entry.file_name().into_string().unwrap();
        if name.starts_with("events") {
            assert_eq!(whole_records(&bytes), Some(bytes.len()), "{name}");
            assert!(bytes.len() > 40_000, "{}", bytes.len());
        } else if name == "log.csv" {
            assert!(bytes.ends_with(b"\n"), "{name}");
        }
    }
}

/// Returns the bytes of complete records, by their lengths alone; `None` when the last one is incomplete.
fn whole_records(bytes: &[u8]) -> Option<usize> {
    let mut at = 0;
    while at < bytes.len() {
        let length = u64::from_le_bytes(bytes.get(at..at + 8)?.try_into().ok()?);
        at += 16 + length as usize;
    }
    (at == bytes.len()).then_some(at)
}

fn be_refused(folder: &Path) {
    let name = folder.display().to_string();
    let errors = [
        write_atomically(&folder.join("state.json"), b"x").unwrap_err(),
        RunLog::open(Some(folder), None).unwrap_err(),
        RunLog::open(Some(&folder.join("log")), Some(3)).unwrap_err(),
        Checkpoints::new(folder, 1).unwrap().save(1, &[("a", b"b")]).unwrap_err(),
        Checkpoints::new(&folder.join("checkpoints"), 1).unwrap_err(),
    ];
    for error in errors {
        assert_eq!(error.kind(), ErrorKind::Io, "{error}");
        assert!(error.to_string().contains(&name) && error.to_string().contains("may be written"), "{error}");
    }
    println!("\ndone");
}

#[test]
fn a_folder_that_is_not_writable_is_reported() {
    let folder = Folder::new("unwritable");
    let (program, closed) = (folder.0.join("program"), folder.0.join("closed"));
    fs::create_dir(&closed).unwrap();
    fs::set_permissions(&closed, fs::Permissions::from_mode(0o555)).unwrap();
    // The superuser can write everywhere, and other users may be unable to read this program's folder.
    fs::copy(std::env::current_exe().unwrap(), &program).unwrap();
    let mut refused = again(&program, "be refused", &closed);
    if fs::write(closed.join("probe"), b"").is_ok() {
        fs::remove_file(closed.join("probe")).unwrap();
        refused.uid(65_534).gid(65_534);
    }
    let done = refused.current_dir("/").output().unwrap();
    let printed = String::from_utf8_lossy(&done.stdout);
    assert!(
        done.status.success() && printed.contains("\ndone"),
        "{printed}{}",
        String::from_utf8_lossy(&done.stderr)
    );
}

#[test]
fn a_damaged_checkpoint_is_skipped_and_listed() {
    let folder = Folder::new("broken");
    let checkpoints = Checkpoints::new(&folder.0, 3).unwrap();
    assert!(checkpoints.latest().unwrap().is_none());
    for step in 1..=5 {
        checkpoints.save(step, &[("weights.bin", &[step as u8; 100])]).unwrap();
        if step == 1 {
            checkpoints.mark_best(1).unwrap();
        }
    }
    assert_eq!(checkpoints.steps().unwrap(), [1, 3, 4, 5]);
    fs::write(folder.0.join("step-0000000005/weights.bin"), [6; 100]).unwrap();
    fs::remove_file(folder.0.join("step-0000000004/checkpoint.json")).unwrap();
    let latest = checkpoints.latest().unwrap().unwrap();
    assert_eq!((latest.step, latest.skipped.len()), (3, 2));
    assert!(
        latest.skipped[0].contains("step-0000000005") && latest.skipped[0].contains("sha256"),
        "{latest:?}"
    );
    assert_eq!(latest.file("weights.bin").unwrap(), [3; 100]);
    assert_eq!(latest.file("other.bin").unwrap_err().kind(), ErrorKind::NotFound);
    assert_eq!(checkpoints.best().unwrap().unwrap().step, 1);
    assert_eq!(checkpoints.mark_best(2).unwrap_err().kind(), ErrorKind::NotFound);
    for step in [1, 3] {
        fs::write(folder.0.join(format!("step-000000000{step}/weights.bin")), b"cut").unwrap();
    }
    assert_eq!(checkpoints.latest().unwrap_err().kind(), ErrorKind::Integrity);
    assert_eq!(checkpoints.save(6, &[("../x", b"")]).unwrap_err().kind(), ErrorKind::Integrity);
    assert_eq!(checkpoints.save(6, &[("a", b""), ("A", b"")]).unwrap_err().kind(), ErrorKind::InvalidParam);
    checkpoints.save(2, &[("weights.bin", b"anew")]).unwrap();
    assert_eq!(checkpoints.latest().unwrap().unwrap().step, 2);
}

#[test]
fn a_new_run_and_a_resumed_one() {
    let folder = Folder::new("resumed");
    let run = |resume_from, steps: std::ops::Range<u64>| {
        let mut log = RunLog::open(Some(&folder.0), resume_from).unwrap();
        steps.for_each(|step| log.scalar("loss", step, step as f64).unwrap());
    };
    let rows = |name: &str| fs::read_to_string(folder.0.join(name)).unwrap().lines().count() - 1;
    run(None, 0..10);
    run(Some(4), 5..7);
    assert_eq!(rows("log.csv"), 7);
    run(None, 0..3);
    assert_eq!((rows("log.csv"), rows("earlier-1/log.csv")), (3, 7));
    assert_eq!(fs::read_dir(folder.0.join("earlier-1")).unwrap().count(), 4);
    assert!(folder.0.join("curves.svg").is_file());
    let mut none = RunLog::open(None, None).unwrap();
    none.scalar("loss", 1, 1.0).unwrap();
    assert_eq!(none.scalar("a\nb", 1, 1.0).unwrap_err().kind(), ErrorKind::InvalidParam);
}
