//! A set of recorded views as a rig.

use std::path::{Path, PathBuf};

use opendr_engine::data::Image;
use opendr_engine::rig::{Achieved, ViewAxis, ViewPose, ViewRig, ViewSphere};
use opendr_engine::target::Action;
use opendr_engine::{Error, Result, ResultExt as _};
use serde::{Deserialize, Serialize};

/// A view of a set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordedView {
    /// Path of the image, relative to the index.
    pub image: PathBuf,
    /// Where it was taken from.
    pub pose: ViewPose,
}

/// What the index says.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Index {
    axes: Vec<ViewAxis>,
    views: Vec<RecordedView>,
}

/// Images that were captured at known poses around a subject: the image is the recorded view nearest to the pose of the
/// camera. The reported pose is that of the recorded view, so that a belief contains only views that exist.
///
/// The index is JSON: `{"axes": [{"name": "azimuth", "step": 0.6, "low": -3.14, "high": 3.14, "wraps": true}], "views":
/// [{"image": "0001.png", "pose": {"azimuth": 0.0, "elevation": 0.1, "distance": 1.5}}]}`.
pub struct RecordedViews {
    folder: PathBuf,
    views: Vec<RecordedView>,
    sphere: ViewSphere,
}

impl RecordedViews {
    /// Opens an index; the camera begins at the first view.
    ///
    /// # Errors
    /// `Io` when it cannot be read, `Format` when it is no index or has no view.
    pub fn open(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path)
            .map_err(|error| Error::from(error).context(path.display().to_string()))?;
        let index: Index = serde_json::from_str(&text).map_err(|error| {
            Error::format(format!("{} is no index of recorded views", path.display())).with_source(error)
        })?;
        let Some(first) = index.views.first() else {
            return Err(Error::format(format!("{} lists no views; record at least one", path.display())));
        };
        let sphere = ViewSphere::new(index.axes, first.pose).context(|| path.display().to_string())?;
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Ok(Self { folder, views: index.views, sphere })
    }

    /// Returns the recorded view nearest to where the camera was moved: by the angle between the directions, and the logarithm of
    /// the ratio of distances.
    pub fn nearest(&self) -> &RecordedView {
        let here = self.sphere.pose();
        let way = |view: &RecordedView| {
            let depth = (view.pose.distance.max(1e-9) / here.distance.max(1e-9)).ln();
            view.pose.angle_to(&here).powi(2) + depth * depth
        };
        let nearer =
            |best: usize, at: usize| if way(&self.views[at]) < way(&self.views[best]) { at } else { best };
        &self.views[(1..self.views.len()).fold(0, nearer)]
    }
}

impl ViewRig for RecordedViews {
    fn axes(&self) -> &[ViewAxis] {
        self.sphere.axes()
    }

    fn pose(&self) -> ViewPose {
        self.nearest().pose
    }

    fn apply(&mut self, action: &Action) -> Result<Achieved> {
        let achieved = self.sphere.apply(action)?;
        Ok(Achieved { pose: self.pose(), ..achieved })
    }

    fn capture(&mut self) -> Result<Image> {
        opendr_vision::open(self.folder.join(&self.nearest().image))
    }
}
