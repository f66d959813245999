//! ROS 1, through the native client of `opendr-ros1`.

use std::sync::atomic::AtomicI64;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use opendr_engine::params::ParamValue;
use opendr_engine::{Error, ErrorKind, Result};
use opendr_messages::{Message, MessageType, RosService as _, StdSrvsTrigger, WireFormat, ros1_from_message};
use opendr_ros1::{
    Listener, Node, NodeOptions, ParameterValue, ParameterWatch, PublisherOptions, ServiceServer,
    ServiceType, SubscriberOptions, TopicType,
};

use crate::clock::{self, NO_SIM_TIME};
use crate::graph::{Clock, Graph, Log, MessageCallback, Publisher, Qos, Severity, TriggerHandler, answer_to};
use crate::{Names, ParameterTable};

/// Maximum wait for a master that is being started.
const PATIENCE_WITH_MASTER: Duration = Duration::from_secs(10);

/// A ROS 1 node.
pub struct Ros1Node {
    names: Names,
    full_name: String,
    log: Log,
    sim_time: Arc<AtomicI64>,
    // Dropped in this order: the node last.
    listeners: Vec<Listener>,
    services: Vec<ServiceServer>,
    watches: Vec<ParameterWatch>,
    node: Arc<Node>,
}

impl Ros1Node {
    /// Creates a node at the master of `ROS_MASTER_URI`.
    ///
    /// # Errors
    /// `Network` when the master does not respond within ten seconds; `InvalidParam` for invalid names.
    pub fn new(names: Names) -> Result<Self> {
        let full_name = names.full();
        let log = terminal_log(&full_name);
        let logger = log.clone();
        let mut options =
            NodeOptions::new(names.node()).on_error(move |error| logger(Severity::Warn, &error.to_string()));
        options.namespace = Some(names.namespace().to_owned());
        options.wait_for_master = PATIENCE_WITH_MASTER;
        let node = Arc::new(Node::new(options)?);
        let sim_time = Arc::new(AtomicI64::new(NO_SIM_TIME));
        let (listeners, services, watches) = (Vec::new(), Vec::new(), Vec::new());
        Ok(Self { names, full_name, log, sim_time, listeners, services, watches, node })
    }

    /// Returns the node's private parameters on the parameter server (set by a launch file), as text.
    ///
    /// # Errors
    /// `Network` when the master does not respond.
    pub fn private_parameters(&self) -> Result<Vec<(String, String)>> {
        let Some(ParameterValue::Struct(parameters)) = self.node.parameter_if_set(&self.full_name)? else {
            return Ok(Vec::new());
        };
        let text = |(name, value)| param_value(&value).map(|value| (name, value.to_string()));
        Ok(parameters.into_iter().filter_map(text).collect())
    }
}

impl Graph for Ros1Node {
    fn name(&self) -> &str {
        &self.full_name
    }

    fn resolve(&self, name: &str) -> Result<String> {
        self.names.resolve(name)
    }

    fn advertise(&mut self, topic: &str, message_type: MessageType, qos: Qos) -> Result<Arc<dyn Publisher>> {
        let options = PublisherOptions { latched: qos.latched, queue_size: qos.depth.max(1) };
        let publisher =
            self.node.advertise(&self.names.resolve(topic)?, topic_type(message_type)?, options)?;
        Ok(Arc::new(Ros1Publisher(publisher)))
    }

    fn subscribe(
        &mut self,
        topic: &str,
        message_type: MessageType,
        qos: Qos,
        mut deliver: MessageCallback,
    ) -> Result<()> {
        let name = self.names.resolve(topic)?;
        let options = SubscriberOptions { queue_size: qos.depth.max(1), ..SubscriberOptions::default() };
        let subscription = self.node.subscribe(&name, topic_type(message_type)?, options)?;
        self.listeners.push(subscription.on_message(move |message| {
            let read = Message::from_bytes(message_type, WireFormat::Ros1, &message.bytes);
            deliver(read.map_err(|error| error.context(name.clone())));
        })?);
        Ok(())
    }

    fn serve(&mut self, service: &str, trigger: TriggerHandler) -> Result<()> {
        let trigger = Mutex::new(trigger);
        let kind = StdSrvsTrigger::TYPE;
        let kind = ServiceType::new(format!("{}/{}", kind.package, kind.name), kind.md5sum);
        let answer = move |_: &[u8]| {
            let response = answer_to(&mut trigger.lock().unwrap_or_else(PoisonError::into_inner));
            ros1_from_message(&response).map_err(|error| error.to_string())
        };
        self.services.push(self.node.serve(&self.names.resolve(service)?, kind, answer)?);
        Ok(())
    }

    /// Writes the parameters to the parameter server, below the node's name. Changes there are applied; invalid ones are reverted.
    fn declare(&mut self, parameters: Arc<ParameterTable>) -> Result<()> {
        let sim_time = self.node.parameter_if_set("/use_sim_time")?;
        let own = parameters.get("use_sim_time").map(|(_, value)| value);
        if sim_time == Some(ParameterValue::Bool(true)) || own == Some(ParamValue::Bool(true)) {
            let sim_time = self.sim_time.clone();
            clock::follow(self, &sim_time)?;
        }
        for (field, value) in parameters.rows() {
            let key = format!("{}/{}", self.full_name, field.name);
            // Absent optional values are not written.
            let Some(shown) = parameter_value(&value) else { continue };
            self.node.set_parameter(&key, shown)?;
            let (table, node, log) = (parameters.clone(), Arc::downgrade(&self.node), self.log.clone());
            let changed = move |key: &str, value: &ParameterValue| {
                let Some((field, holds)) = table.get(field.name) else { return };
                let Some(wanted) = param_value(value).filter(|wanted| *wanted != holds) else { return };
                if let Err(error) = table.set(field.name, wanted) {
                    log(Severity::Warn, &error.to_string());
                    if let (Some(node), Some(holds)) = (node.upgrade(), parameter_value(&holds))
                        && let Err(error) = node.set_parameter(key, holds)
                    {
                        log(Severity::Warn, &error.to_string());
                    }
                }
            };
            self.watches.push(self.node.watch_parameter(&key, changed)?.0);
        }
        Ok(())
    }

    /// True after `rosnode kill` or when a second node has taken the name.
    fn is_over(&self) -> bool {
        self.node.is_shut_down()
    }

    fn clock(&self) -> Clock {
        clock::clock(self.sim_time.clone())
    }

    fn log(&self) -> Log {
        self.log.clone()
    }
}

struct Ros1Publisher(opendr_ros1::Publisher);

impl Publisher for Ros1Publisher {
    fn publish(&self, message: Message) -> Result<()> {
        self.0.publish_owned(message.to_bytes(WireFormat::Ros1)?)
    }

    fn subscribers(&self) -> usize {
        self.0.subscriber_count()
    }
}

fn topic_type(message_type: MessageType) -> Result<TopicType> {
    let known = message_type.ros1().ok_or_else(|| {
        Error::new(ErrorKind::Unsupported, format!("ROS 1 has no message {}", message_type.ros2_name()))
    })?;
    Ok(TopicType::new(known.name, known.md5sum, message_type.definition(WireFormat::Ros1)?))
}

fn param_value(value: &ParameterValue) -> Option<ParamValue> {
    Some(match value {
        ParameterValue::Bool(value) => ParamValue::Bool(*value),
        ParameterValue::Int(value) => ParamValue::Int(i64::from(*value)),
        ParameterValue::Double(value) => ParamValue::Float(*value),
        ParameterValue::String(value) => ParamValue::Text(value.clone()),
        ParameterValue::List(values) => {
            ParamValue::List(values.iter().map(param_value).collect::<Option<_>>()?)
        }
        _ => return None,
    })
}

fn parameter_value(value: &ParamValue) -> Option<ParameterValue> {
    Some(match value {
        ParamValue::None => return None,
        ParamValue::Bool(value) => ParameterValue::Bool(*value),
        ParamValue::Int(value) => match i32::try_from(*value) {
            Ok(value) => ParameterValue::Int(value),
            // XML-RPC has no wider integer.
            Err(_) => ParameterValue::Double(*value as f64),
        },
        ParamValue::Float(value) => ParameterValue::Double(*value),
        ParamValue::Text(value) => ParameterValue::String(value.clone()),
        ParamValue::List(values) => {
            ParameterValue::List(values.iter().map(parameter_value).collect::<Option<_>>()?)
        }
    })
}

fn terminal_log(name: &str) -> Log {
    let name = name.to_owned();
    Arc::new(move |severity, text| eprintln!("[{}] [{name}]: {text}", severity.name()))
}
