//! Environments as nodes: simulation over ROS.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

use opendr_engine::data::Observation;
use opendr_engine::environment::{Environment, ResetOptions};
use opendr_engine::target::RlTarget;
use opendr_engine::{Error, Header, Result, Value, ValueType};
use opendr_messages::{Message, MessageType, std_msgs};
use opendr_ros_bridge::RosBridge;

use crate::graph::serve_reset;
use crate::{Clock, Graph, Log, Publisher, Qos, Severity};

/// Options of an environment node.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvironmentOptions {
    /// Topic of the actions.
    pub action_topic: String,
    /// Message type of the actions: an array, or a velocity.
    pub action_message: MessageType,
    /// Seed of the first episode.
    pub seed: u64,
    /// Steps per second, with the last received action; `None` for one step per action.
    pub rate: Option<f64>,
}

impl Default for EnvironmentOptions {
    /// Returns options for one step per array on `~/action`, with seed 0.
    fn default() -> Self {
        Self {
            action_topic: "~/action".to_owned(),
            action_message: MessageType::OpendrMsgsFloat32MultiArrayStamped,
            seed: 0,
            rate: None,
        }
    }
}

/// Converts the numbers of an observation into an observation with named parts.
pub type ObservationWriter = Box<dyn Fn(&[f32]) -> Result<Observation> + Send>;

/// An environment as a node: it subscribes to actions and publishes the observation (`~/observation`), the reward (`~/reward`) and
/// whether the episode is over (`~/is_over`). After an episode it begins the next; the service `~/reset` begins one at once.
pub struct EnvironmentNode {
    environment: Box<dyn Environment>,
    observe: ObservationWriter,
    options: EnvironmentOptions,
    actions: Receiver<Result<Message>>,
    reset: Arc<AtomicBool>,
    observations: Arc<dyn Publisher>,
    rewards: Arc<dyn Publisher>,
    overs: Arc<dyn Publisher>,
    pictures: Arc<dyn Publisher>,
    clock: Clock,
    log: Log,
}

/// Maximum wait of the loop for an action before it handles resets and the stop.
const PATIENCE: Duration = Duration::from_millis(50);

/// Interval at which a waiting environment publishes its observation again.
const REMINDER: Duration = Duration::from_secs(1);

impl EnvironmentNode {
    /// Declares the topics of `environment` on `graph`; `observe` names the parts of observations.
    ///
    /// # Errors
    /// `InvalidInput` for a message type without an action; `Io` when the network cannot be used.
    pub fn new(
        graph: &mut dyn Graph,
        environment: Box<dyn Environment>,
        observe: ObservationWriter,
        options: EnvironmentOptions,
    ) -> Result<Self> {
        let known = opendr_ros_bridge::message_types(ValueType::RlTarget);
        if !known.into_iter().any(|known| known == options.action_message) {
            return Err(Error::invalid_input(format!(
                "{} is not an action; use an array or a velocity",
                options.action_message.ros2_name()
            )));
        }
        // The environment uses the newest action; a queue of two is enough.
        let (sender, actions) = sync_channel(2);
        graph.subscribe(
            &options.action_topic,
            options.action_message,
            Qos::RESULT,
            Box::new(move |message| {
                // Actions that come faster than the environment steps are dropped.
                let _ = sender.try_send(message);
            }),
        )?;
        let reset = serve_reset(graph, "a new episode begins")?;
        Ok(Self {
            observations: graph.advertise(
                "~/observation",
                MessageType::OpendrMsgsObservation,
                Qos::LATCHED,
            )?,
            rewards: graph.advertise("~/reward", MessageType::StdMsgsFloat32, Qos::RESULT)?,
            overs: graph.advertise("~/is_over", MessageType::StdMsgsBool, Qos::RESULT)?,
            pictures: graph.advertise(
                "~/image/compressed",
                MessageType::SensorMsgsCompressedImage,
                Qos::RESULT,
            )?,
            clock: graph.clock(),
            log: graph.log(),
            environment,
            observe,
            options,
            actions,
            reset,
        })
    }

    /// Runs until `stop` returns true.
    ///
    /// # Errors
    /// Those of the environment. Invalid actions are logged and skipped instead.
    pub fn run(mut self, stop: &dyn Fn() -> bool) -> Result<()> {
        let spec = self.environment.spec().clone();
        let mut observation = vec![0.0; spec.observation.len()];
        let mut action = vec![0.0; spec.action.len()];
        self.begin(Some(self.options.seed), &mut observation)?;
        let period = self.options.rate.map(|rate| Duration::from_secs_f64(1.0 / rate.max(1e-3)));
        let (mut next, mut answered) = (Instant::now(), Instant::now());
        while !stop() {
            if self.reset.swap(false, Ordering::Relaxed) {
                self.begin(None, &mut observation)?;
            }
            let wait =
                period.map_or(PATIENCE, |_| next.saturating_duration_since(Instant::now()).min(PATIENCE));
            let came = match self.actions.recv_timeout(wait) {
                Ok(message) => self.take(message, &mut action),
                Err(RecvTimeoutError::Timeout) => false,
                Err(RecvTimeoutError::Disconnected) => return Ok(()),
            };
            if came {
                answered = Instant::now();
            } else if period.is_none() && answered.elapsed() > REMINDER {
                // The policy may have started late or missed the observation.
                answered = Instant::now();
                self.publish_observation(&observation)?;
            }
            let due = match period {
                None => came,
                Some(period) if Instant::now() >= next => {
                    next += period;
                    true
                }
                Some(_) => false,
            };
            if due {
                self.step(&action, &mut observation)?;
            }
        }
        Ok(())
    }

    /// Reads the action of a message; an invalid one is logged.
    fn take(&self, message: Result<Message>, action: &mut [f32]) -> bool {
        let read = message
            .and_then(|message| RosBridge::default().value_from_message(ValueType::RlTarget, message))
            .and_then(|value| {
                let Value::RlTarget(RlTarget { values, .. }) = value else {
                    return Err(Error::internal("an action of another type than its topic"));
                };
                // A velocity has six numbers, of which the environment uses the first ones.
                let values = values.get(..action.len()).ok_or_else(|| {
                    Error::invalid_input(format!(
                        "an action has {} numbers; the environment needs {}",
                        values.len(),
                        action.len()
                    ))
                })?;
                self.environment.spec().action.check(values)?;
                action.copy_from_slice(values);
                Ok(())
            });
        if let Err(error) = &read {
            (self.log)(Severity::Warn, &error.to_string());
        }
        read.is_ok()
    }

    fn begin(&mut self, seed: Option<u64>, observation: &mut [f32]) -> Result<()> {
        self.environment.reset(seed, &ResetOptions::new(), observation)?;
        self.publish_observation(observation)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<()> {
        let step = self.environment.step(action, observation)?;
        self.rewards.publish(std_msgs::Float32 { data: step.reward as f32 }.into())?;
        self.overs.publish(std_msgs::Bool { data: step.is_over() }.into())?;
        if step.is_over() {
            return self.begin(None, observation);
        }
        self.publish_observation(observation)
    }

    fn publish_observation(&mut self, observation: &[f32]) -> Result<()> {
        let bridge = RosBridge::default();
        let header = Header { stamp_ns: Some((self.clock)()), frame_id: Some("world".into()) };
        let observation = Value::from((self.observe)(observation)?.with_header(header.clone()));
        let message =
            bridge.message_from_value(observation.as_value_ref(), MessageType::OpendrMsgsObservation)?;
        self.observations.publish(message)?;
        if self.pictures.subscribers() > 0
            && let Some(picture) = self.environment.render()?
        {
            let picture = Value::from(picture.with_header(header));
            let compressed = MessageType::SensorMsgsCompressedImage;
            self.pictures.publish(bridge.message_from_value(picture.as_value_ref(), compressed)?)?;
        }
        Ok(())
    }
}
