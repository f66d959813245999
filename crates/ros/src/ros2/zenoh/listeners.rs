//! Subscribers of topics, from the liveliness tokens of the domain.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use opendr_engine::Result;
use zenoh::Wait;
use zenoh::sample::SampleKind;

use super::keys::{all_tokens, subscribed_topic, topic_in_tokens};
use crate::ros2::error::network_error;

/// Maximum number of counted tokens, which bounds the memory.
const MAX_TOKENS: usize = 100_000;

/// Subscriptions of a domain.
#[derive(Debug, Default)]
pub(super) struct Listeners(Mutex<HashMap<String, String>>);

impl Listeners {
    /// Follows the tokens of a domain until the session ends, including the existing ones.
    pub fn follow(session: &zenoh::Session, domain_id: u16) -> Result<Arc<Self>> {
        let listeners = Arc::<Self>::default();
        let follows = listeners.clone();
        session
            .liveliness()
            .declare_subscriber(all_tokens(domain_id))
            .history(true)
            .callback(move |sample| {
                let alive = sample.kind() == SampleKind::Put;
                follows.changed(sample.key_expr().as_str(), alive);
            })
            .background()
            .wait()
            .map_err(|error| network_error("subscribing to Zenoh's liveliness tokens", &error))?;
        Ok(listeners)
    }

    /// Returns the number of subscriptions of the topic `name`.
    pub fn count(&self, name: &str) -> usize {
        let topic = topic_in_tokens(name);
        let tokens = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        tokens.values().filter(|subscribed| **subscribed == topic).count()
    }

    fn changed(&self, token: &str, alive: bool) {
        let Some(topic) = subscribed_topic(token) else { return };
        let mut tokens = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !alive {
            tokens.remove(token);
        } else if tokens.len() < MAX_TOKENS {
            tokens.insert(token.to_owned(), topic.to_owned());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subscriptions_are_counted_while_they_live() {
        let listeners = Listeners::default();
        let token = |entity: usize, kind: &str, topic: &str| {
            format!("@ros2_lv/0/a/0/{entity}/{kind}/%/%/node/{topic}/type/hash/::,10:,:,:,,")
        };
        for (entity, kind, topic) in [(1, "MS", "%a"), (2, "MS", "%a"), (3, "MP", "%a"), (4, "MS", "%a%b")] {
            listeners.changed(&token(entity, kind, topic), true);
        }
        listeners.changed(&token(1, "MS", "%a"), true);
        assert_eq!((listeners.count("/a"), listeners.count("/a/b"), listeners.count("/c")), (2, 1, 0));
        listeners.changed(&token(1, "MS", "%a"), false);
        assert_eq!(listeners.count("/a"), 1);
    }
}
