//! Typed services over DDS.

use futures::StreamExt;
use opendr_engine::{Error, Result};
use opendr_messages::RosService;
use ros2_client::qos::{History, WhenFull};
use ros2_client::{Message, Name, QosProfile, ServiceMapping, ServiceTypeName};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::DdsNode;
use crate::ros2::error::network_error;
use crate::ros2::typed_services::TypedServices;

/// A message with the marker trait of ros2-client.
#[derive(Clone, Serialize, Deserialize)]
#[serde(transparent)]
struct Marked<T>(T);

impl<T: Serialize + DeserializeOwned> Message for Marked<T> {}

/// Handlers run on the thread of the node's services.
impl TypedServices for DdsNode {
    fn serve_typed<S: RosService>(
        &mut self,
        service: &str,
        mut answer: impl FnMut(S::Request) -> S::Response + Send + 'static,
    ) -> Result<()> {
        let absolute = self.names.resolve(service)?;
        let name = Name::parse(&absolute)
            .map_err(|error| Error::invalid_input(format!("the service {absolute}: {error}")))?;
        // Equals rmw_qos_profile_services_default.
        let qos = QosProfile::subscription_default()
            .reliability_reliable(WhenFull::DEFAULT)
            .history(History::KeepLast { depth: 10 });
        let server = self
            .node
            .create_server::<Marked<S::Request>, Marked<S::Response>>(
                ServiceMapping::Enhanced,
                &name,
                &ServiceTypeName::new(S::TYPE.package, S::TYPE.name),
                qos.clone(),
                qos,
            )
            .map_err(|error| network_error(&absolute, &error))?;
        self.tasks.push(Box::pin(async move {
            let mut requests = server.receive_request_stream();
            while let Some(request) = requests.next().await {
                // An unreadable request has no client to respond to.
                let Ok((id, Marked(request))) = request else { continue };
                // The client may have ended.
                let _ = server.async_send_response(id, Marked(answer(request))).await;
            }
        }));
        Ok(())
    }
}
