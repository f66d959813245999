//! Loop of a node: takes the newest inputs, runs inference, publishes the outputs.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use opendr_engine::learner::{AnyStream, Entry, Outputs, Ports};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, ValueRef};
use opendr_messages::{MessageType, std_msgs};

use super::annotated::Annotated;
use super::diagnostics::Diagnostics;
use super::inbox::{Inbox, Set, is_streamed};
use super::labels::Labels;
use super::outputs::OutputTopics;
use super::{NodeOptions, NodeParams};
use crate::{Clock, Graph, Log, Publisher, Qos, Severity};

/// Maximum wait of the loop for inputs before it handles resets, diagnostics and the stop.
const PATIENCE: Duration = Duration::from_millis(50);

pub(super) struct Worker {
    entry: &'static Entry,
    stream: Box<dyn AnyStream>,
    inbox: Arc<Inbox>,
    params: Arc<Mutex<NodeParams>>,
    reset: Arc<AtomicBool>,
    active: Arc<AtomicBool>,
    outputs: OutputTopics,
    labels: Option<Labels>,
    annotated: Option<Annotated>,
    diagnostics: Diagnostics,
    processing_time: Arc<dyn Publisher>,
    latency: Arc<dyn Publisher>,
    clock: Clock,
    log: Log,
    /// Time of the last processed input; `None` before the first and after velocities were set to zero.
    moving_since: Option<Instant>,
    observer: Option<NodeObserver>,
}

/// Receives the first input, the outputs and the processing time in milliseconds of each inference of a node.
pub type NodeObserver = Box<dyn FnMut(ValueRef<'_>, &Outputs, f64) + Send>;

impl Worker {
    #[allow(clippy::too_many_arguments)]
    pub(super) fn new(
        graph: &mut dyn Graph,
        entry: &'static Entry,
        stream: Box<dyn AnyStream>,
        classes: &Classes,
        inbox: Arc<Inbox>,
        params: Arc<Mutex<NodeParams>>,
        reset: Arc<AtomicBool>,
        options: &NodeOptions,
    ) -> Result<Self> {
        Ok(Self {
            entry,
            stream,
            inbox,
            params,
            reset,
            active: Arc::new(AtomicBool::new(true)),
            outputs: OutputTopics::new(graph, &options.outputs)?,
            labels: Labels::new(graph, classes)?,
            annotated: Annotated::new(graph, entry)?,
            diagnostics: Diagnostics::new(graph, entry.spec.name)?,
            processing_time: graph.advertise(
                "~/processing_time_ms",
                MessageType::StdMsgsFloat32,
                Qos::RESULT,
            )?,
            latency: graph.advertise("~/latency_ms", MessageType::StdMsgsFloat32, Qos::RESULT)?,
            clock: graph.clock(),
            log: graph.log(),
            moving_since: None,
            observer: None,
        })
    }

    pub(super) fn observe(&mut self, observer: NodeObserver) {
        self.observer = Some(observer);
    }

    pub(super) fn active(&self) -> Arc<AtomicBool> {
        self.active.clone()
    }

    pub(super) fn run(mut self, stop: &dyn Fn() -> bool) {
        while !stop() {
            let params = self.params.lock().unwrap_or_else(PoisonError::into_inner).clone();
            let slop_ns = (params.sync_slop_ms * 1e6) as i64;
            let set = self.inbox.take(slop_ns, PATIENCE);
            if self.reset.swap(false, Ordering::Relaxed) {
                self.stream.reset();
                self.outputs.reset();
            }
            let done = match set {
                Some(_) if !self.active.load(Ordering::Relaxed) => self.rest(),
                Some(set) => self.answer(&set, &params),
                None => self.idle(&params),
            };
            let labelled = self.labels.as_mut().map_or(Ok(()), Labels::tick);
            for result in [done, labelled, self.diagnostics.tick(self.inbox.counts())] {
                if let Err(error) = result {
                    self.report(&error);
                }
            }
        }
        // Velocities are set to zero when the node stops.
        if self.moving_since.is_some()
            && let Err(error) = self.outputs.stop((self.clock)())
        {
            self.report(&error);
        }
    }

    fn answer(&mut self, set: &Set, params: &NodeParams) -> Result<()> {
        let begin = Instant::now();
        let mut ports = Ports::default();
        for (port, frame) in self.entry.ports.iter().zip(set) {
            if let Some(frame) = frame {
                ports = ports.with(port.name, frame.value()?);
                if port.init {
                    self.stream.reset();
                }
            }
        }
        let mut answers: Vec<Outputs> = Vec::new();
        let streamed = self.entry.ports.iter().any(|port| is_streamed(port.value_type));
        if streamed && self.entry.capabilities.streaming {
            self.stream.push(Some(&ports), &mut |outputs| answers.push(outputs))?;
        } else {
            answers.push(self.stream.infer(&ports)?);
        }
        let bridge = params.bridge();
        for outputs in &answers {
            self.outputs.publish(outputs, &bridge)?;
            self.moving_since = self.outputs.command_velocity().then(Instant::now);
        }
        let processing_ms = begin.elapsed().as_secs_f64() * 1e3;
        let stamp = set.iter().flatten().next().map(|frame| frame.stamp_ns);
        let latency_ms = ((self.clock)() - stamp.unwrap_or_default()) as f64 * 1e-6;
        self.processing_time.publish(std_msgs::Float32 { data: processing_ms as f32 }.into())?;
        self.latency.publish(std_msgs::Float32 { data: latency_ms as f32 }.into())?;
        self.diagnostics.add(processing_ms, latency_ms);
        if params.deadline_ms > 0.0 && processing_ms > params.deadline_ms {
            self.diagnostics.add_late();
            let deadline = params.deadline_ms;
            self.report(&Error::new(
                opendr_engine::ErrorKind::Device,
                format!("an inference took {processing_ms:.1} ms, longer than the deadline of {deadline} ms"),
            ));
        }
        if let (Some(observer), Some(frame)) = (&mut self.observer, set.iter().flatten().next()) {
            let input = frame.value()?;
            answers.iter().for_each(|outputs| observer(input.as_value_ref(), outputs, processing_ms));
        }
        if let (Some(annotated), true) = (&self.annotated, params.annotate) {
            for outputs in &answers {
                annotated.publish(set, outputs, &bridge)?;
            }
        }
        Ok(())
    }

    /// Handles the inactive state: sets velocities to zero; the next input begins a new stream.
    fn rest(&mut self) -> Result<()> {
        self.stream.reset();
        if self.moving_since.take().is_some() {
            self.outputs.stop((self.clock)())?;
        }
        Ok(())
    }

    /// Handles a time without input: sets velocities to zero after the timeout.
    fn idle(&mut self, params: &NodeParams) -> Result<()> {
        let timeout = Duration::from_secs_f64(params.timeout_ms * 1e-3);
        if params.timeout_ms > 0.0 && self.moving_since.is_some_and(|since| since.elapsed() > timeout) {
            self.outputs.stop((self.clock)())?;
            self.moving_since = None;
            (self.log)(
                Severity::Warn,
                &format!("no input for {} ms: the velocity is commanded to be 0", params.timeout_ms),
            );
        }
        Ok(())
    }

    /// Logs an error, once per second for each text.
    fn report(&mut self, error: &Error) {
        let text = error.to_string();
        if self.diagnostics.add_error(&text) {
            (self.log)(Severity::Warn, &text);
        }
    }
}
