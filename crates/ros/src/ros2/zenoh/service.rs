//! Services over Zenoh, as queryables.

use std::sync::{Mutex, PoisonError};

use opendr_engine::{Error, Result};
use opendr_messages::{RosService, cdr_from_message, message_from_cdr};
use zenoh::Wait;
use zenoh::query::Query;

use super::attachment::Attachment;
use super::keys::{KeyType, Kind, data_key};
use super::node::ZenohNode;
use crate::Qos;
use crate::clock::system_time_ns;
use crate::ros2::error::network_error;
use crate::ros2::typed_services::TypedServices;

impl TypedServices for ZenohNode {
    fn serve_typed<S: RosService>(
        &mut self,
        service: &str,
        answer: impl FnMut(S::Request) -> S::Response + Send + 'static,
    ) -> Result<()> {
        let name = self.names.resolve(service)?;
        let of = KeyType::from(S::TYPE);
        let key = data_key(self.domain_id, &name, &of);
        let answer = Mutex::new(answer);
        let serve = move |query: Query| {
            let answered =
                answer_to::<S>(&query, &mut *answer.lock().unwrap_or_else(PoisonError::into_inner));
            if let Err(error) = answered {
                // The client may have ended.
                query.reply_err(error.to_string()).wait().ok();
            }
        };
        let queryable = self.session.declare_queryable(key).complete(true).callback(serve).wait();
        self.services.push(queryable.map_err(|error| network_error(&name, &error))?);
        self.announce(Kind::Server, &name, &of, Qos::RESULT).map(drop)
    }
}

fn answer_to<S: RosService>(query: &Query, answer: &mut impl FnMut(S::Request) -> S::Response) -> Result<()> {
    let missing = || Error::format("a request needs a payload and an attachment");
    let asked = Attachment::from_bytes(&query.attachment().ok_or_else(missing)?.to_bytes())?;
    let request = message_from_cdr::<S::Request>(&query.payload().ok_or_else(missing)?.to_bytes())?;
    let response = cdr_from_message(&answer(request))?;
    // The client matches the response by sequence number and sender.
    let answered = Attachment { source_timestamp: system_time_ns(), ..asked };
    query
        .reply(query.key_expr(), response)
        .attachment(answered.to_bytes())
        .wait()
        .map_err(|error| network_error("answering", &error))
}
