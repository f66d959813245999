//! A ROS 2 node with a learner of configurable duration, for tests of slow learners.
//!
//! ```console
//! $ cargo run -p opendr-ros --example slow_node
//! ```

use std::thread::sleep;
use std::time::Duration;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::{Manifest, Model, ModelWriter};
use opendr_engine::params::{ParamMap, Params};
use opendr_engine::target::Category;
use opendr_engine::{Device, Result, Task, learners};
use opendr_ros::{LearnerNode, Names, Ros2, Ros2Options, Severity, SharedSubscriptions, default_topics};

/// Parameters of the learner.
#[derive(Debug, Clone, Params)]
struct SlowParams {
    /// Duration of an inference.
    #[param(default = 100.0, range = 0.0..=60_000.0, unit = "ms", live)]
    delay_ms: f64,
}

/// Returns a constant prediction after a delay.
struct Slow {
    params: SlowParams,
}

impl Learner for Slow {
    const SPEC: Spec =
        Spec::new("slow", Task::ImageClassification).class("SlowLearner").about("Takes its time.");
    type Params = SlowParams;
    type Input<'a> = &'a Image;
    type Target = Category;
    type State = ();

    fn load(_: &Model, params: SlowParams, _: Device) -> Result<Self> {
        Ok(Self { params })
    }

    fn params(&self) -> &SlowParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut SlowParams {
        &mut self.params
    }

    fn infer_into(&self, (): &mut (), _: &Image, target: &mut Category) -> Result<()> {
        sleep(Duration::from_secs_f64(self.params.delay_ms * 1e-3));
        (target.class, target.confidence) = (0, Some(1.0));
        Ok(())
    }
}

fn main() -> Result<()> {
    let registry = learners![Slow];
    let entry = registry.find("slow")?;
    let folder = std::env::temp_dir().join(format!("opendr-slow-{}", std::process::id()));
    ModelWriter::new(&folder, Manifest::new("slow", ""))?.finish()?;
    let mut learner = entry.make(&ParamMap::default(), Device::default())?;
    learner.load(&folder)?;
    std::fs::remove_dir_all(&folder)?;
    let mut graph = Ros2::new(&Ros2Options::default())?.node(Names::new("/", "slow", [""; 0])?)?;
    let node = LearnerNode::new(
        &mut *graph,
        entry,
        learner,
        default_topics(entry),
        &mut SharedSubscriptions::default(),
    )?;
    graph.start()?;
    graph.log()(Severity::Info, "SlowLearner is ready as /slow");
    node.run(&|| false);
    Ok(())
}
