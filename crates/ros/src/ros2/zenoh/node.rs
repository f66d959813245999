//! ROS 2 nodes over Zenoh.

use std::sync::atomic::{AtomicBool, AtomicI64, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use opendr_engine::{Error, Result};
use opendr_messages::{Message, MessageType, StdSrvsTrigger, WireFormat};
use twox_hash::XxHash3_128;
use zenoh::Wait;
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::Subscriber;
use zenoh::qos::CongestionControl;
use zenoh::query::Queryable;

use super::keys::{KeyType, Kind, Owner, data_key};
use super::listeners::Listeners;
use super::publisher::ZenohPublisher;
use super::session::Session;
use crate::clock::{self, NO_SIM_TIME};
use crate::graph::{Clock, Graph, Log, MessageCallback, Publisher, Qos, TriggerHandler, answer_to};
use crate::ros2::error::network_error;
use crate::ros2::typed_services::TypedServices as _;
use crate::ros2::{Ros2Node, lifecycle, log, parameter_services};
use crate::{Names, ParameterTable, Severity};

/// A ROS 2 node over Zenoh.
pub(in crate::ros2) struct ZenohNode {
    pub(super) session: zenoh::Session,
    pub(super) domain_id: u16,
    pub(super) names: Names,
    full_name: String,
    number: u64,
    entities: Arc<AtomicU64>,
    listeners: Arc<Listeners>,
    // Dropped with the node.
    subscriptions: Vec<Subscriber<()>>,
    pub(super) services: Vec<Queryable<()>>,
    tokens: Vec<LivelinessToken>,
    sim_time: Arc<AtomicI64>,
    over: Arc<AtomicBool>,
    log: Log,
}

impl ZenohNode {
    pub(super) fn new(session: &Session, number: u64, names: Names) -> Result<Self> {
        let mut node = Self {
            session: session.session.clone(),
            domain_id: session.domain_id,
            full_name: names.full(),
            names,
            number,
            entities: session.entities.clone(),
            listeners: session.listeners.clone(),
            subscriptions: Vec::new(),
            services: Vec::new(),
            tokens: Vec::new(),
            sim_time: Arc::new(AtomicI64::new(NO_SIM_TIME)),
            over: Arc::default(),
            log: Arc::new(|_, _| {}),
        };
        node.declare_token(node.owner().node_token())?;
        node.log = log::start(&mut node)?;
        Ok(node)
    }

    fn owner(&self) -> Owner<'_> {
        let session = self.session.zid().to_string();
        Owner { domain_id: self.domain_id, session, node: self.number, names: &self.names }
    }

    /// Announces an entity of the node by a liveliness token and returns its global id.
    pub(super) fn announce(&mut self, kind: Kind, name: &str, of: &KeyType, qos: Qos) -> Result<[u8; 16]> {
        let entity = self.entities.fetch_add(1, Ordering::Relaxed);
        let token = self.owner().entity_token(entity, kind, name, of, qos);
        let gid = XxHash3_128::oneshot(token.as_bytes()).to_le_bytes();
        self.declare_token(token)?;
        Ok(gid)
    }

    fn declare_token(&mut self, token: String) -> Result<()> {
        let declared = self.session.liveliness().declare_token(token).wait();
        self.tokens.push(declared.map_err(|error| network_error("announcing the node", &error))?);
        Ok(())
    }
}

impl Ros2Node for ZenohNode {
    fn manage(&mut self, active: Arc<AtomicBool>) -> Result<()> {
        let over = self.over.clone();
        lifecycle::start(self, active, over)
    }

    fn start(&mut self) -> Result<()> {
        if self.session.info().routers_zid().wait().next().is_none() {
            (self.log)(
                Severity::Warn,
                "no Zenoh router is reachable; start one: ros2 run rmw_zenoh_cpp rmw_zenohd",
            );
        }
        Ok(())
    }
}

impl Graph for ZenohNode {
    fn name(&self) -> &str {
        &self.full_name
    }

    fn resolve(&self, name: &str) -> Result<String> {
        self.names.resolve(name)
    }

    fn advertise(&mut self, topic: &str, message_type: MessageType, qos: Qos) -> Result<Arc<dyn Publisher>> {
        let topic = self.names.resolve(topic)?;
        let of = KeyType::from(message_type);
        let publisher = self
            .session
            .declare_publisher(data_key(self.domain_id, &topic, &of))
            // Slow subscribers lose messages; the publisher does not wait.
            .congestion_control(CongestionControl::Drop)
            .wait()
            .map_err(|error| network_error(&topic, &error))?;
        let gid = self.announce(Kind::Publisher, &topic, &of, qos)?;
        let listeners = self.listeners.clone();
        Ok(Arc::new(ZenohPublisher { publisher, topic, gid, sent: AtomicI64::new(0), listeners }))
    }

    fn subscribe(
        &mut self,
        topic: &str,
        message_type: MessageType,
        qos: Qos,
        deliver: MessageCallback,
    ) -> Result<()> {
        let topic = self.names.resolve(topic)?;
        let of = KeyType::from(message_type);
        let (deliver, name) = (Mutex::new(deliver), topic.clone());
        let subscription = self
            .session
            .declare_subscriber(data_key(self.domain_id, &topic, &of))
            .callback(move |sample| {
                let read = Message::from_bytes(message_type, WireFormat::Cdr, &sample.payload().to_bytes());
                let message = read.map_err(|error: Error| error.context(name.clone()));
                deliver.lock().unwrap_or_else(PoisonError::into_inner)(message);
            })
            .wait()
            .map_err(|error| network_error(&topic, &error))?;
        self.subscriptions.push(subscription);
        self.announce(Kind::Subscription, &topic, &of, qos).map(drop)
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
