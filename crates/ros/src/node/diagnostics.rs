//! Diagnostics of the node, once per second on `/diagnostics`.

use std::sync::Arc;
use std::time::{Duration, Instant};

use opendr_engine::Result;
use opendr_messages::MessageType;
use opendr_messages::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus, KeyValue};
use opendr_messages::std_msgs::Header;
use opendr_ros_bridge::time;

use super::inbox::Counts;
use crate::{Clock, Graph, Publisher, Qos};

const PERIOD: Duration = Duration::from_secs(1);

pub(super) struct Diagnostics {
    publisher: Arc<dyn Publisher>,
    clock: Clock,
    node: String,
    hardware: String,
    since: Instant,
    /// Processing times of the current period, in milliseconds.
    processing_ms: Vec<f64>,
    latency_ms: Vec<f64>,
    late: u64,
    errors: u64,
    last_error: Option<String>,
    /// Number of inferences of all periods.
    processed: u64,
    failed: u64,
}

impl Diagnostics {
    pub(super) fn new(graph: &mut dyn Graph, learner: &str) -> Result<Self> {
        let publisher =
            graph.advertise("/diagnostics", MessageType::DiagnosticMsgsDiagnosticArray, Qos::RESULT)?;
        Ok(Self {
            publisher,
            clock: graph.clock(),
            node: graph.name().to_owned(),
            hardware: learner.to_owned(),
            since: Instant::now(),
            processing_ms: Vec::new(),
            latency_ms: Vec::new(),
            late: 0,
            errors: 0,
            last_error: None,
            processed: 0,
            failed: 0,
        })
    }

    pub(super) fn add(&mut self, processing_ms: f64, latency_ms: f64) {
        self.processing_ms.push(processing_ms);
        self.latency_ms.push(latency_ms);
        self.processed += 1;
    }

    pub(super) fn add_late(&mut self) {
        self.late += 1;
    }

    /// Adds an error and returns whether its text is new in this period, so that it should be logged.
    pub(super) fn add_error(&mut self, error: &str) -> bool {
        self.errors += 1;
        self.failed += 1;
        let new = self.last_error.as_deref() != Some(error);
        if new {
            self.last_error = Some(error.to_owned());
        }
        new
    }

    /// Publishes the diagnostics when a second is over.
    pub(super) fn tick(&mut self, counts: Counts) -> Result<()> {
        if self.since.elapsed() < PERIOD {
            return Ok(());
        }
        let seconds = self.since.elapsed().as_secs_f64();
        let (level, message) = match (&self.last_error, self.late, self.processing_ms.len()) {
            (Some(error), ..) if self.processing_ms.is_empty() => (DiagnosticStatus::ERROR, error.clone()),
            (Some(error), ..) => (DiagnosticStatus::WARN, error.clone()),
            (None, 1.., _) => (DiagnosticStatus::WARN, format!("{} inferences took too long", self.late)),
            (None, 0, 0) => (DiagnosticStatus::STALE, "no input".to_owned()),
            (None, 0, _) => (DiagnosticStatus::OK, "running".to_owned()),
        };
        let values = [
            ("frames per second", format!("{:.1}", self.processing_ms.len() as f64 / seconds)),
            ("processing p50 (ms)", percentile(&mut self.processing_ms, 0.5)),
            ("processing p99 (ms)", percentile(&mut self.processing_ms, 0.99)),
            ("latency p50 (ms)", percentile(&mut self.latency_ms, 0.5)),
            ("errors in this second", self.errors.to_string()),
            ("received", counts.received.to_string()),
            ("processed", self.processed.to_string()),
            ("left out for newer ones", counts.dropped.to_string()),
            ("errors", self.failed.to_string()),
        ];
        let values = values.map(|(key, value)| KeyValue { key: key.to_owned(), value });
        let status = DiagnosticStatus {
            level,
            name: format!("{}: inference", self.node.trim_start_matches('/')),
            message,
            hardware_id: self.hardware.clone(),
            values: values.into(),
        };
        let header = Header { stamp: time((self.clock)()).unwrap_or_default(), ..Default::default() };
        self.since = Instant::now();
        self.processing_ms.clear();
        self.latency_ms.clear();
        (self.late, self.errors, self.last_error) = (0, 0, None);
        self.publisher.publish(DiagnosticArray { header, status: vec![status] }.into())
    }
}

fn percentile(values: &mut [f64], share: f64) -> String {
    values.sort_by(f64::total_cmp);
    let at = ((values.len() as f64 * share) as usize).min(values.len().saturating_sub(1));
    values.get(at).map_or_else(|| "-".to_owned(), |value| format!("{value:.2}"))
}
