//! ROS 2 over DDS, in pure Rust (ros2-client on RustDDS).

mod qos;
mod service;

use std::net::IpAddr;
use std::pin::Pin;
use std::sync::atomic::{AtomicBool, AtomicI64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use futures::channel::oneshot;
use futures::future::{Either, select};
use futures::{Future, StreamExt};
use opendr_engine::{Error, Result};
use opendr_messages::{Message, MessageType, StdSrvsTrigger};
use ros2_client::dds::rustdds::discovery::DiscoveredReaderData;
use ros2_client::dds::rustdds::{DomainParticipant, DomainParticipantBuilder};
use ros2_client::{Context, MessageTypeName, Name, Node, NodeName, NodeOptions};

use super::error::network_error;
use super::typed_services::TypedServices as _;
use super::{Ros2Node, lifecycle, log, parameter_services};
use crate::clock::{self, NO_SIM_TIME};
use crate::graph::{Clock, Graph, Log, MessageCallback, Publisher, Qos, TriggerHandler, answer_to};
use crate::{Names, ParameterTable};

/// A DDS participant, shared by the nodes of a process.
pub(super) struct Participant {
    context: Context,
}

/// Requested size of the socket's receive buffer, for bursts of fragments of large images.
const RECEIVE_BUFFER_BYTES: usize = 8 << 20;

impl Participant {
    /// Joins the domain on the networks of these addresses, or on all.
    pub fn new(domain_id: u16, networks: &[IpAddr]) -> Result<Self> {
        let mut builder =
            DomainParticipantBuilder::new(domain_id).socket_receive_buffer_size(RECEIVE_BUFFER_BYTES);
        if !networks.is_empty() {
            builder = builder.with_only_networks(networks.iter().copied());
        }
        let participant = builder.build().map_err(|error| network_error("joining DDS", &error))?;
        let context = Context::from_domain_participant(participant);
        let context = context.map_err(|error| network_error("joining DDS", &error))?;
        Ok(Self { context })
    }

    /// Creates a node in the domain.
    pub fn node(&self, names: Names) -> Result<DdsNode> {
        let name = NodeName::new(names.namespace(), names.node())
            .map_err(|error| Error::invalid_input(format!("the node's name {}: {error}", names.full())))?;
        // Parameter services and /rosout are our own, since ros2-client has no ranges, descriptions or read-only parameters.
        let options = NodeOptions::new().start_parameter_services(false).enable_rosout(false);
        let node =
            self.context.new_node(name, options).map_err(|error| network_error("creating a node", &error))?;
        let mut node = DdsNode {
            full_name: names.full(),
            names,
            node,
            participant: self.context.domain_participant(),
            tasks: Vec::new(),
            threads: Vec::new(),
            sim_time: Arc::new(AtomicI64::new(NO_SIM_TIME)),
            over: Arc::default(),
            log: Arc::new(|_, _| {}),
        };
        node.log = log::start(&mut node)?;
        Ok(node)
    }
}

type Task = Pin<Box<dyn Future<Output = ()> + Send>>;

/// A ROS 2 node over DDS.
pub(super) struct DdsNode {
    full_name: String,
    names: Names,
    node: Node,
    participant: DomainParticipant,
    /// Tasks that share one thread: services, discovery.
    tasks: Vec<Task>,
    threads: Vec<(oneshot::Sender<()>, JoinHandle<()>)>,
    sim_time: Arc<AtomicI64>,
    /// Whether a lifecycle manager has shut the node down.
    over: Arc<AtomicBool>,
    log: Log,
}

impl DdsNode {
    fn spawn(&mut self, name: &str, task: impl Future<Output = ()> + Send + 'static) -> Result<()> {
        let (stop, stopped) = oneshot::channel();
        let run = move || {
            let task = std::pin::pin!(task);
            if let Either::Left(((), stopped)) = futures::executor::block_on(select(task, stopped)) {
                drop(stopped);
            }
        };
        let thread = std::thread::Builder::new().name(name.to_owned()).spawn(run)?;
        self.threads.push((stop, thread));
        Ok(())
    }

    fn topic(
        &self,
        topic: &str,
        message_type: MessageType,
        qos: Qos,
    ) -> Result<ros2_client::dds::rustdds::Topic> {
        let absolute = self.names.resolve(topic)?;
        let name = Name::parse(&absolute)
            .map_err(|error| Error::invalid_input(format!("the topic {absolute}: {error}")))?;
        let (package, short) = message_type.package_and_name();
        self.node
            .create_topic(&name, MessageTypeName::new(package, short), &qos::profile(qos))
            .map_err(|error| network_error(&absolute, &error))
    }
}

impl Ros2Node for DdsNode {
    fn manage(&mut self, active: Arc<AtomicBool>) -> Result<()> {
        let over = self.over.clone();
        lifecycle::start(self, active, over)
    }

    fn start(&mut self) -> Result<()> {
        let spinner = self.node.spinner().map_err(|error| network_error("spinning", &error))?;
        self.tasks.push(Box::pin(async move {
            // The spinner ends with the node.
            let _ = spinner.spin().await;
        }));
        let tasks = std::mem::take(&mut self.tasks);
        self.spawn("ros2-services", async move {
            futures::future::join_all(tasks).await;
        })
    }
}

impl Graph for DdsNode {
    fn name(&self) -> &str {
        &self.full_name
    }

    fn resolve(&self, name: &str) -> Result<String> {
        self.names.resolve(name)
    }

    fn advertise(&mut self, topic: &str, message_type: MessageType, qos: Qos) -> Result<Arc<dyn Publisher>> {
        let dds_topic = format!("rt{}", self.names.resolve(topic)?);
        let topic = self.topic(topic, message_type, qos)?;
        let publisher = self
            .node
            .create_publisher::<Message>(&topic, None)
            .map_err(|error| network_error("publishing", &error))?;
        let participant = self.participant.clone();
        Ok(Arc::new(DdsPublisher { publisher, participant, dds_topic, counted: Mutex::new(None) }))
    }

    fn subscribe(
        &mut self,
        topic: &str,
        message_type: MessageType,
        qos: Qos,
        mut deliver: MessageCallback,
    ) -> Result<()> {
        let name = self.names.resolve(topic)?;
        let topic = self.topic(topic, message_type, qos)?;
        let subscription = self
            .node
            .create_subscription::<Message>(&topic, None)
            .map_err(|error| network_error("subscribing", &error))?;
        self.spawn(&format!("sub {name}"), async move {
            let messages = subscription.async_stream_seed(message_type);
            let mut messages = std::pin::pin!(messages);
            while let Some(message) = messages.next().await {
                deliver(message.map(|(message, _)| message).map_err(|error| {
                    Error::format(format!(
                        "{name}: the message cannot be read as {}: {error}",
                        message_type.ros2_name()
                    ))
                }));
            }
        })
    }

    fn serve(&mut self, service: &str, mut trigger: TriggerHandler) -> Result<()> {
        self.serve_typed::<StdSrvsTrigger>(service, move |_| answer_to(&mut trigger))
    }

    fn declare(&mut self, parameters: Arc<ParameterTable>) -> Result<()> {
        let sim_time = self.sim_time.clone();
        parameter_services::start(self, parameters, &sim_time)
    }

    fn is_over(&self) -> bool {
        self.over.load(Ordering::Relaxed)
    }

    fn clock(&self) -> Clock {
        clock::clock(self.sim_time.clone())
    }

    fn log(&self) -> Log {
        self.log.clone()
    }
}

impl Drop for DdsNode {
    fn drop(&mut self) {
        self.node.stop_spinner();
        let threads = std::mem::take(&mut self.threads);
        let handles: Vec<_> = threads
            .into_iter()
            .map(|(stop, thread)| {
                // The thread may have ended already.
                let _ = stop.send(());
                thread
            })
            .collect();
        for thread in handles {
            let _ = thread.join();
        }
    }
}

struct DdsPublisher {
    publisher: ros2_client::Publisher<Message>,
    participant: DomainParticipant,
    dds_topic: String,
    /// Time and result of the last count of subscribers.
    counted: Mutex<Option<(Instant, usize)>>,
}

/// Minimum time between counts, since a count iterates over all discovered endpoints.
const COUNTING_PERIOD: Duration = Duration::from_millis(200);

impl Publisher for DdsPublisher {
    fn publish(&self, message: Message) -> Result<()> {
        self.publisher.publish(message).map_err(|error| network_error("sending", &error))
    }

    fn subscribers(&self) -> usize {
        let mut counted = self.counted.lock().unwrap_or_else(PoisonError::into_inner);
        match *counted {
            Some((at, count)) if at.elapsed() < COUNTING_PERIOD => count,
            _ => {
                let readers = self.participant.discovered_readers();
                let listens = |reader: &&DiscoveredReaderData| {
                    *reader.subscription_topic_data.topic_name() == self.dds_topic
                };
                let count = readers.iter().filter(listens).count();
                *counted = Some((Instant::now(), count));
                count
            }
        }
    }
}
