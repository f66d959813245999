//! The training loop of every `fit`: it learns, resumes bit for bit after a kill, and reports errors.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use crate::small::{ClassifyPoints, Network, Spirals};
use crate::turn;
use opendr_engine::learner::{FitJob, TrainingGroup};
use opendr_engine::model::Model;
use opendr_engine::{Device, ErrorKind, Progress, Random, Result, Statistics, Unit};
use opendr_training::{OptimizerKind, ScheduleKind, Score, TrainingParams, fit_network, seeded_device};

/// Environment variable with the output folder of the process that is killed.
const CHILD: &str = "OPENDR_TEST_TRAINS_INTO";

fn scratch(name: &str) -> PathBuf {
    let folder = env::temp_dir().join(format!("opendr-fit-{}-{name}", std::process::id()));
    fs::remove_dir_all(&folder).ok();
    folder
}

fn params() -> TrainingParams {
    TrainingParams {
        epochs: 30,
        batch_size: 32,
        lr: 0.01,
        lr_schedule: ScheduleKind::Cosine,
        ema: 0.9,
        grad_clip: 5.0,
        accumulate: 2,
        checkpoint_after_iter: 7,
        seed: 3,
        ..TrainingParams::default()
    }
}

fn train(params: &TrainingParams, dataset: &Spirals, job: &FitJob<'_>) -> Result<Statistics> {
    let _turn = turn();
    let network = Network::new(&seeded_device(job, params)?);
    fit_network(&ClassifyPoints::default(), network, params, dataset, None, job)
}

fn job(output: &Path) -> FitJob<'_> {
    FitJob { device: Device::Cpu, ..FitJob::new(output) }
}

fn weights(output: &Path) -> Vec<u8> {
    Model::open(output.join("model")).unwrap().file("weights.bin").unwrap()
}

#[test]
fn every_optimiser_learns() {
    for optimizer in [OptimizerKind::Adamw, OptimizerKind::Adam, OptimizerKind::Sgd, OptimizerKind::Rmsprop] {
        let output = scratch(optimizer.name());
        let lr = if optimizer == OptimizerKind::Sgd { 0.1 } else { 0.005 };
        let params = TrainingParams { optimizer, lr, epochs: 60, accumulate: 1, ..params() };
        let statistics = train(&params, &Spirals { count: 256, broken: None }, &job(&output)).unwrap();
        let losses = &statistics.curves["loss"];
        assert_eq!((losses.len(), statistics.get("steps")), (60, Some(480.0)));
        assert!(losses[59] < 0.35 * losses[0], "{}: {losses:?}", optimizer.name());
        fs::remove_dir_all(output).unwrap();
    }
}

/// The child's part of the next test; no effect outside of the child.
#[test]
fn child_trains() {
    let Some(output) = env::var_os(CHILD).map(PathBuf::from) else { return };
    let job = FitJob { resume: true, ..job(&output) };
    train(&params(), &Spirals { count: 320, broken: None }, &job).unwrap();
}

#[test]
fn killed_and_resumed_is_the_same() {
    let (whole, killed) = (scratch("whole"), scratch("killed"));
    let whole_statistics = train(&params(), &Spirals { count: 320, broken: None }, &job(&whole)).unwrap();
    let mut random = Random::new(u64::from(std::process::id()));
    let mut kills = 0;
    loop {
        let mut child = Command::new(env::current_exe().unwrap())
            .args(["fit::child_trains", "--exact", "--test-threads=1"])
            .env(CHILD, &killed)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        if kills < 5 {
            std::thread::sleep(Duration::from_secs_f32(random.uniform(0.05, 0.6)));
        }
        if kills < 5 && child.try_wait().unwrap().is_none() {
            child.kill().unwrap();
            child.wait().unwrap();
            kills += 1;
            continue;
        }
        assert!(child.wait().unwrap().success());
        break;
    }
    assert!(weights(&whole) == weights(&killed), "after {kills} kills the weights are others");
    assert!(whole_statistics.get("steps") == Some(150.0));
    for folder in [whole, killed] {
        fs::remove_dir_all(folder).unwrap();
    }
}

/// Stops after a number of steps.
struct StopAfter(AtomicU64);

impl Progress for StopAfter {
    fn begin(&self, _: &str, _: Option<u64>, _: Unit) {}

    fn advance(&self, amount: u64) {
        self.0
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| Some(left.saturating_sub(amount)))
            .ok();
    }

    fn end(&self) {}

    fn stopped(&self) -> bool {
        self.0.load(Ordering::Relaxed) == 0
    }
}

#[test]
fn stopped_and_resumed_is_the_same_with_its_log() {
    let (whole, stopped) = (scratch("unstopped"), scratch("stopped"));
    let logs = [whole.join("log"), stopped.join("log")];
    let dataset = Spirals { count: 320, broken: None };
    let statistics =
        train(&params(), &dataset, &FitJob { logging_path: Some(&logs[0]), ..job(&whole) }).unwrap();
    let stop = StopAfter(AtomicU64::new(33));
    let first = FitJob { progress: &stop, logging_path: Some(&logs[1]), ..job(&stopped) };
    assert_eq!(train(&params(), &dataset, &first).unwrap().get("steps"), Some(33.0));
    assert!(stopped.join("model/weights.bin").exists(), "the container of a stopped training is written");
    let again = FitJob { resume: true, logging_path: Some(&logs[1]), ..job(&stopped) };
    let resumed = train(&params(), &dataset, &again).unwrap();
    assert!(weights(&whole) == weights(&stopped));
    assert_eq!(resumed.curves, statistics.curves);
    let table = |folder: &Path| fs::read_to_string(folder.join("log.csv")).unwrap();
    assert_eq!(table(&logs[0]), table(&logs[1]));
    for folder in [whole, stopped] {
        fs::remove_dir_all(folder).unwrap();
    }
}

#[test]
fn an_earlier_training_is_never_overwritten() {
    let output = scratch("earlier");
    let dataset = Spirals { count: 64, broken: None };
    let params = TrainingParams { epochs: 2, accumulate: 1, ..params() };
    train(&params, &dataset, &job(&output)).unwrap();
    let error = train(&params, &dataset, &job(&output)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidInput);
    assert!(error.to_string().contains("resume it, or use another folder"), "{error}");
    let resumed = FitJob { resume: true, ..job(&output) };
    let other = TrainingParams { batch_size: 16, ..params.clone() };
    let error = train(&other, &dataset, &resumed).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidParam);
    assert!(error.to_string().contains("batch_size = 32, not 16"), "{error}");
    let error = train(&params, &Spirals { count: 65, broken: None }, &resumed).unwrap_err();
    assert!(error.to_string().contains("64 samples, this one has 65"), "{error}");
    let longer = TrainingParams { epochs: 3, ..params };
    assert_eq!(train(&longer, &dataset, &resumed).unwrap().get("epochs"), Some(3.0));
    fs::remove_dir_all(output).unwrap();
}

#[test]
fn a_nan_loss_names_step_samples_and_checkpoint() {
    let output = scratch("nan");
    let params = TrainingParams { checkpoint_after_iter: 1, accumulate: 1, epochs: 1, ..params() };
    let error = train(&params, &Spirals { count: 320, broken: Some(77) }, &job(&output)).unwrap_err();
    let text = error.to_string();
    assert_eq!(error.kind(), ErrorKind::Internal);
    assert!(text.contains("loss of step") && text.contains("point ") && text.contains("lower lr"), "{text}");
    let kept = text.contains("checkpoints/step-") || text.contains("no checkpoint yet");
    assert!(kept, "{text}");
    fs::remove_dir_all(output).unwrap();
}

#[test]
fn the_best_by_metric_is_kept_and_early_stopping_stops() {
    let output = scratch("best");
    let dataset = Spirals { count: 64, broken: None };
    let params = TrainingParams { epochs: 50, early_stop: 3, accumulate: 1, ..params() };
    let values = [0.1, 0.5, 0.3, 0.2, 0.4, 0.9];
    let mut seen = Vec::new();
    let mut validate = |candidate: &Path| -> Result<Score> {
        seen.push(Model::open(candidate)?.file("weights.bin")?);
        let value = values[seen.len() - 1];
        let numbers = [("score".to_owned(), value)].into();
        Ok(Score { name: "score".to_owned(), value, is_error: false, numbers, image: None })
    };
    let _turn = turn();
    let job = job(&output);
    let network = Network::new(&seeded_device(&job, &params).unwrap());
    let statistics =
        fit_network(&ClassifyPoints::default(), network, &params, &dataset, Some(&mut validate), &job)
            .unwrap();
    assert_eq!(statistics.curves["val_score"], values[..5]);
    assert_eq!((statistics.get("best"), statistics.get("best_step")), (Some(0.5), Some(4.0)));
    assert!(weights(&output) == seen[1]);
    assert!(!output.join("candidate").exists());
    fs::remove_dir_all(output).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn a_batch_too_large_for_memory_is_refused() {
    let output = scratch("memory");
    let params = TrainingParams { batch_size: 65_536, accumulate: 1, ..params() };
    let _turn = turn();
    let job = job(&output);
    let network = Network::new(&seeded_device(&job, &params).unwrap());
    let objective = ClassifyPoints { ballast: 8 << 20 };
    let dataset = Spirals { count: 65_536, broken: None };
    let error = fit_network(&objective, network, &params, &dataset, None, &job).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidParam);
    let text = error.to_string();
    assert!(text.contains("batch_size = 65536 needs about") && text.contains("accumulate"), "{text}");
}

#[test]
fn invalid_trainings_are_refused() {
    let output = scratch("refused");
    let error = train(&params(), &Spirals { count: 0, broken: None }, &job(&output)).unwrap_err();
    assert!(error.kind() == ErrorKind::InvalidInput && error.to_string().contains("empty"));
    let wrong = TrainingParams { lr: -1.0, ..params() };
    let error = train(&wrong, &Spirals { count: 8, broken: None }, &job(&output)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidParam);
    let device = FitJob { device: Device::Cuda(0), ..job(&output) };
    if !cfg!(feature = "cuda") && env::var_os("OPENDR_DEVICE").is_none() {
        let error = train(&params(), &Spirals { count: 8, broken: None }, &device).unwrap_err();
        assert!(error.kind() == ErrorKind::Device && error.to_string().contains("trains on cpu"), "{error}");
    }
    let file = env::temp_dir().join(format!("opendr-fit-{}-file", std::process::id()));
    fs::write(&file, "in the way").unwrap();
    let error = train(&params(), &Spirals { count: 8, broken: None }, &job(&file)).unwrap_err();
    assert!(error.to_string().contains(&*file.display().to_string()), "{error}");
    fs::remove_file(file).unwrap();
}

/// Environment variable with rank, size and accumulated batches of a process of a group.
const MEMBER: &str = "OPENDR_TEST_TRAINS_AS";

/// Processes that exchange payloads as files of a folder.
struct FolderGroup {
    folder: PathBuf,
    rank: usize,
    size: usize,
    round: AtomicU64,
}

impl TrainingGroup for FolderGroup {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn all_gather(&self, payload: Vec<u8>) -> Result<Vec<Vec<u8>>> {
        let round = self.round.fetch_add(1, Ordering::Relaxed);
        let path = |rank| self.folder.join(format!("{round}-{rank}"));
        let partial = self.folder.join(format!("partial-{}", self.rank));
        fs::write(&partial, payload)?;
        fs::rename(partial, path(self.rank))?;
        (0..self.size)
            .map(|rank| {
                while !path(rank).exists() {
                    std::thread::sleep(Duration::from_micros(200));
                }
                Ok(fs::read(path(rank))?)
            })
            .collect()
    }
}

fn group_params() -> TrainingParams {
    TrainingParams { epochs: 6, accumulate: 4, ..params() }
}

/// 22 batches of 32: the last step of an epoch has two batches.
const GROUP_POINTS: Spirals = Spirals { count: 720, broken: None };

/// A process of the next tests; no effect outside of it.
#[test]
fn member_trains() {
    let (Some(output), Ok(member)) = (env::var_os(CHILD).map(PathBuf::from), env::var(MEMBER)) else {
        return;
    };
    let numbers: Vec<usize> = member.split('/').map(|number| number.parse().unwrap()).collect();
    let [rank, size, accumulate] = numbers[..] else { panic!("{member}") };
    let folder = output.join("exchange");
    fs::create_dir_all(&folder).unwrap();
    let group = FolderGroup { folder, rank, size, round: AtomicU64::new(0) };
    let own = output.join(format!("{rank}"));
    let job = FitJob { group: Some(&group), resume: true, ..job(&own) };
    let done = train(&TrainingParams { accumulate, ..group_params() }, &GROUP_POINTS, &job);
    match done {
        Ok(statistics) => {
            fs::write(output.join(format!("loss-{rank}")), format!("{:?}", statistics.curves)).unwrap();
        }
        Err(error) => fs::write(output.join(format!("error-{rank}")), error.to_string()).unwrap(),
    }
}

/// Runs a group with a number of accumulated batches for each process.
fn members(output: &Path, accumulate: &[usize]) {
    fs::remove_dir_all(output.join("exchange")).ok();
    let start = |rank| {
        Command::new(env::current_exe().unwrap())
            .args(["fit::member_trains", "--exact", "--test-threads=1"])
            .env(CHILD, output)
            .env(MEMBER, format!("{rank}/{}/{}", accumulate.len(), accumulate[rank]))
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    };
    let members: Vec<_> = (0..accumulate.len()).map(start).collect();
    for mut member in members {
        assert!(member.wait().unwrap().success());
    }
}

#[test]
fn a_group_of_processes_trains_the_weights_of_one() {
    let whole = scratch("one");
    let statistics = train(&group_params(), &GROUP_POINTS, &job(&whole)).unwrap();
    assert_eq!(statistics.get("steps"), Some(36.0));
    for size in [1, 2, 4] {
        let output = scratch(&format!("group-{size}"));
        members(&output, &vec![4; size]);
        for rank in 0..size {
            let own = output.join(format!("{rank}"));
            assert!(weights(&whole) == weights(&own), "process {rank} of {size} has other weights");
            let curves = fs::read_to_string(output.join(format!("loss-{rank}"))).unwrap();
            assert_eq!(curves, format!("{:?}", statistics.curves), "process {rank} of {size}");
        }
        fs::remove_dir_all(output).unwrap();
    }
    fs::remove_dir_all(whole).unwrap();
}

#[test]
fn a_group_resumes_from_the_checkpoint_of_its_first_process() {
    let (whole, output) = (scratch("one-resumed"), scratch("group-resumed"));
    train(&group_params(), &GROUP_POINTS, &job(&whole)).unwrap();
    // The first process has been stopped by itself, after which two go on.
    let stop = StopAfter(AtomicU64::new(15));
    let own = output.join("0");
    let first = FitJob { progress: &stop, ..job(&own) };
    assert_eq!(train(&group_params(), &GROUP_POINTS, &first).unwrap().get("steps"), Some(15.0));
    members(&output, &[4, 4]);
    assert!(weights(&whole) == weights(&own));
    assert!(weights(&whole) == weights(&output.join("1")));
    for folder in [whole, output] {
        fs::remove_dir_all(folder).unwrap();
    }
}

#[test]
fn a_group_with_other_parameters_or_an_undivided_step_is_refused() {
    let output = scratch("group-refused");
    members(&output, &[2, 4]);
    let errors = [0, 1].map(|rank| fs::read_to_string(output.join(format!("error-{rank}"))).unwrap());
    assert!(errors[0].contains("process 1 of the training has other data, parameters"), "{}", errors[0]);
    assert!(errors[1].contains("process 0 of the training has other data, parameters"), "{}", errors[1]);
    let group = FolderGroup { folder: output.clone(), rank: 0, size: 3, round: AtomicU64::new(0) };
    let job = FitJob { group: Some(&group), ..job(&output) };
    let error = train(&group_params(), &GROUP_POINTS, &job).unwrap_err();
    assert!(
        error.to_string().contains("accumulate = 4 batches of a step cannot be divided among 3"),
        "{error}"
    );
    fs::remove_dir_all(output).unwrap();
}
