//! Paths of odometry: `nav_msgs/Path`.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_messages::{MessageType, geometry_msgs, nav_msgs};

use crate::{Graph, Publisher, Qos};

/// Poses of a path from which on every second one is dropped, so that a node that runs for days stays small.
const MAX_POSES: usize = 4096;

/// The path of a node's odometry, on `~/path`.
#[derive(Default)]
pub(super) struct Paths {
    publisher: Option<Arc<dyn Publisher>>,
    path: Thinned<geometry_msgs::PoseStamped>,
}

impl Paths {
    /// Advertises the topic.
    pub(super) fn add(&mut self, graph: &mut dyn Graph) -> Result<()> {
        if self.publisher.is_none() {
            self.publisher = Some(graph.advertise("~/path", MessageType::NavMsgsPath, Qos::RESULT)?);
        }
        Ok(())
    }

    /// Appends a known pose, and publishes the path if there are subscribers.
    pub(super) fn publish(&mut self, odometry: &nav_msgs::Odometry) -> Result<()> {
        let Some(publisher) = &self.publisher else { return Ok(()) };
        let geometry_msgs::Quaternion { x, y, z, w } = odometry.pose.pose.orientation;
        // An unknown pose has an orientation of zeros.
        if [x, y, z, w].iter().all(|part| *part == 0.0) {
            return Ok(());
        }
        let pose =
            geometry_msgs::PoseStamped { header: odometry.header.clone(), pose: odometry.pose.pose.clone() };
        self.path.push(pose);
        if publisher.subscribers() == 0 {
            return Ok(());
        }
        let path = nav_msgs::Path { header: odometry.header.clone(), poses: self.path.values.clone() };
        publisher.publish(path.into())
    }

    /// Begins a new path.
    pub(super) fn reset(&mut self) {
        self.path = Thinned::default();
    }
}

/// A list that keeps its first and last value, and fewer between them the longer it becomes.
struct Thinned<T> {
    values: Vec<T>,
    /// Distance between values that stay.
    step: usize,
    /// Number of values so far.
    count: usize,
}

impl<T> Default for Thinned<T> {
    fn default() -> Self {
        Self { values: Vec::new(), step: 1, count: 0 }
    }
}

impl<T> Thinned<T> {
    fn push(&mut self, value: T) {
        // The last value stays only until the next one, unless it is one of every step.
        if !self.last_stays() {
            self.values.pop();
        }
        self.values.push(value);
        self.count += 1;
        if self.values.len() < MAX_POSES {
            return;
        }
        self.step *= 2;
        let last = if self.last_stays() { None } else { self.values.pop() };
        let mut index = 0;
        self.values.retain(|_| {
            index += 1;
            index % 2 == 1
        });
        self.values.extend(last);
    }

    fn last_stays(&self) -> bool {
        self.count == 0 || (self.count - 1).is_multiple_of(self.step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_path_keeps_its_ends_and_stays_small() {
        let mut path = Thinned::default();
        for value in 0..100_000 {
            path.push(value);
            assert!(path.values.len() <= MAX_POSES, "{} values", path.values.len());
            assert_eq!((path.values[0], path.values.last()), (0, Some(&value)));
        }
        assert!(path.values.len() > MAX_POSES / 4);
        let mut steps = path.values.windows(2).rev().skip(1).map(|pair| pair[1] - pair[0]);
        assert!(steps.all(|step| step == path.step), "values are evenly spaced");
    }
}
