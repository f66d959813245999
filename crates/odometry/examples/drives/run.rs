//! Runs odometries along a drive.

use std::time::Instant;

use opendr_engine::Result;
use opendr_odometry::{
    Alignment, CameraFrame, CameraKind, DriftErrors, OdometryParams, PinholeCamera, Pose, Stamped, Tracking,
    Trajectory, VisualOdometry, absolute_errors, kitti_drift,
};
use opendr_simulation::drive::{Drive, DriveFrame};

/// What one kind of camera measured.
pub struct Outcome {
    pub kind: CameraKind,
    /// Whether the height of a single camera was given.
    pub has_height: bool,
    /// Whether the scale is observed; the estimate is scaled to the truth otherwise.
    pub is_metric: bool,
    pub truth: Trajectory,
    /// Aligned with the truth, before and after loops were closed.
    pub before: Trajectory,
    pub after: Trajectory,
    pub drift: DriftErrors,
    /// Absolute trajectory errors before and after, in metres.
    pub errors: [f64; 2],
    pub loops: usize,
    pub lost: usize,
    /// Frames per second with one thread and with two.
    pub rates: [f64; 2],
    /// CPU time of a frame with one thread, in milliseconds.
    pub cpu: f64,
}

struct Runner {
    odometry: VisualOdometry,
    kind: CameraKind,
    has_height: bool,
    seconds: f64,
    cpu: f64,
    lost: usize,
}

/// Tracks the drive with one camera, without and with its height, a stereo pair and a depth camera, each with one thread and with two.
pub fn run(drive: &Drive, lengths: &[f64]) -> Result<Vec<Outcome>> {
    let cameras = [
        (CameraKind::Mono, false),
        (CameraKind::Mono, true),
        (CameraKind::Stereo, false),
        (CameraKind::Depth, false),
    ];
    let mut runners = Vec::new();
    for (kind, has_height) in cameras {
        for threads in [1, 2] {
            runners.push(Runner::new(drive, kind, has_height, threads)?);
        }
    }
    let mut truth = Vec::new();
    for number in 0..drive.frames() {
        let frame = drive.render(number)?;
        truth.push(Stamped { time: drive.time(number), pose: Pose::from_rows(drive.pose(number)) });
        runners.iter_mut().try_for_each(|runner| runner.track(&frame))?;
    }
    let truth = Trajectory::new(truth)?;
    let frames = drive.frames() as f64;
    runners
        .chunks_mut(2)
        .map(|pair| {
            let rates = [0, 1].map(|at| frames / pair[at].seconds);
            pair[0].outcome(&truth, lengths, rates, frames)
        })
        .collect()
}

impl Runner {
    fn new(drive: &Drive, kind: CameraKind, has_height: bool, threads: usize) -> Result<Self> {
        let (focal_length, principal_point) = drive.intrinsics();
        let options = drive.options();
        let camera = PinholeCamera {
            size: options.size,
            focal_length: [focal_length; 2],
            principal_point,
            baseline: f64::from(options.baseline),
        };
        let camera_height = if has_height { options.camera_height } else { 0.0 };
        let params = OdometryParams { tracking_threads: threads, camera_height, ..OdometryParams::default() };
        let odometry = VisualOdometry::new(camera, kind, params)?;
        Ok(Self { odometry, kind, has_height, seconds: 0.0, cpu: 0.0, lost: 0 })
    }

    fn track(&mut self, frame: &DriveFrame) -> Result<()> {
        let frame = match self.kind {
            CameraKind::Mono => CameraFrame::Mono(&frame.left),
            CameraKind::Stereo => CameraFrame::Stereo { left: &frame.left, right: &frame.right },
            CameraKind::Depth => CameraFrame::Depth { image: &frame.left, depth: &frame.depth },
        };
        let (start, cpu) = (Instant::now(), cpu_time());
        let outcome = self.odometry.track(&frame)?;
        self.seconds += start.elapsed().as_secs_f64();
        self.cpu += cpu_time() - cpu;
        self.lost += usize::from(matches!(outcome, Tracking::Lost { .. }));
        Ok(())
    }

    fn outcome(
        &mut self,
        truth: &Trajectory,
        lengths: &[f64],
        rates: [f64; 2],
        frames: f64,
    ) -> Result<Outcome> {
        let is_metric = self.odometry.is_metric();
        let alignment = if is_metric { Alignment::Rigid } else { Alignment::Scaled };
        let compare = |odometry: &VisualOdometry| -> Result<(Trajectory, Trajectory)> {
            let (truth, estimate) = truth.associated(&odometry.trajectory(), 1e-3)?;
            let aligned = estimate.aligned_with(&truth, alignment)?;
            Ok((truth, aligned))
        };
        let (associated, before) = compare(&self.odometry)?;
        let drift = kitti_drift(&associated, &before, lengths)?;
        let loops = self.odometry.close_loops()?.loops;
        let (_, after) = compare(&self.odometry)?;
        let error =
            |aligned| absolute_errors(&associated, aligned, Alignment::None).map(|errors| errors.rmse);
        let errors = [error(&before)?, error(&after)?];
        Ok(Outcome {
            kind: self.kind,
            has_height: self.has_height,
            is_metric,
            truth: associated,
            before,
            after,
            drift,
            errors,
            loops,
            lost: self.lost,
            rates,
            cpu: 1e3 * self.cpu / frames,
        })
    }
}

/// Returns the CPU time of this thread in seconds; 0 where the system does not tell.
fn cpu_time() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split(' ').next().and_then(|number| number.parse::<f64>().ok()).map_or(0.0, |time| time * 1e-9)
}
