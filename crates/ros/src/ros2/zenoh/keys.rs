//! Key expressions of messages, and liveliness tokens of nodes and topics (design.md of rmw_zenoh).

use opendr_messages::{MessageType, ServiceType};

use crate::{Names, Qos};

/// Type of a message or service in a key: name and hash.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct KeyType {
    name: String,
    hash: &'static str,
}

impl From<MessageType> for KeyType {
    fn from(message: MessageType) -> Self {
        let (package, name) = message.package_and_name();
        Self { name: format!("{package}::msg::dds_::{name}_"), hash: message.rihs01() }
    }
}

impl From<ServiceType> for KeyType {
    fn from(ServiceType { package, name, rihs01, .. }: ServiceType) -> Self {
        Self { name: format!("{package}::srv::dds_::{name}_"), hash: rihs01 }
    }
}

/// Returns the key of the messages of a topic or the requests of a service `name`.
pub(super) fn data_key(domain_id: u16, name: &str, of: &KeyType) -> String {
    let KeyType { name: of, hash } = of;
    format!("{domain_id}/{}/{of}/{hash}", name.trim_matches('/'))
}

/// Returns the key expression of all liveliness tokens of a domain.
pub(super) fn all_tokens(domain_id: u16) -> String {
    format!("@ros2_lv/{domain_id}/**")
}

/// Kind of an entity of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Publisher,
    Subscription,
    Server,
}

/// Node of an entity.
#[derive(Debug, Clone)]
pub(super) struct Owner<'a> {
    pub domain_id: u16,
    pub session: String,
    /// Id of the node in the session.
    pub node: u64,
    pub names: &'a Names,
}

impl Owner<'_> {
    /// Returns the token of the node itself.
    pub fn node_token(&self) -> String {
        self.token(self.node, "NN")
    }

    /// Returns the token of an entity of the node, with its id in the session.
    pub fn entity_token(&self, entity: u64, kind: Kind, name: &str, of: &KeyType, qos: Qos) -> String {
        let kind = match kind {
            Kind::Publisher => "MP",
            Kind::Subscription => "MS",
            Kind::Server => "SS",
        };
        let (KeyType { name: of, hash }, quality) = (of, quality(qos));
        format!("{}/{}/{of}/{hash}/{quality}", self.token(entity, kind), one_level(name))
    }

    fn token(&self, entity: u64, kind: &str) -> String {
        let Self { domain_id, session, node, names } = self;
        let namespace = one_level(names.namespace());
        // Nodes without security have the enclave `/`.
        format!("@ros2_lv/{domain_id}/{session}/{node}/{entity}/{kind}/%/{namespace}/{}", names.node())
    }
}

/// Encodes a name as one level of a key.
fn one_level(name: &str) -> String {
    name.replace('/', "%")
}

/// Encodes the quality of service by the numbers of `rmw/types.h`, with defaults omitted; deadline, lifespan and liveliness are
/// always the defaults.
fn quality(qos: Qos) -> String {
    let reliability = if qos.reliable { "" } else { "2" };
    format!("{reliability}::,{}:,:,:,,", qos.depth)
}

/// Returns the topic in the token of a subscription, as one level.
pub(super) fn subscribed_topic(token: &str) -> Option<&str> {
    let mut levels = token.split('/');
    (levels.nth(5)? == "MS").then(|| levels.nth(3)).flatten()
}

/// Returns the topic `name` in the form of tokens.
pub(super) fn topic_in_tokens(name: &str) -> String {
    one_level(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HASH: &str = "RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47";

    #[test]
    fn data_keys_equal_those_of_the_cpp_implementation() {
        let of = KeyType::from(MessageType::SensorMsgsImage);
        let key = data_key(3, "/camera/image_raw", &of);
        assert_eq!(key, format!("3/camera/image_raw/sensor_msgs::msg::dds_::Image_/{HASH}"));
    }

    #[test]
    fn tokens_equal_those_of_the_cpp_implementation() {
        let names = Names::new("/robot/front", "eyes", [""; 0]).unwrap();
        let owner = Owner { domain_id: 0, session: "aac3".to_owned(), node: 4, names: &names };
        assert_eq!(owner.node_token(), "@ros2_lv/0/aac3/4/4/NN/%/%robot%front/eyes");
        let of = KeyType::from(MessageType::SensorMsgsImage);
        let token = owner.entity_token(5, Kind::Subscription, "/camera/image_raw", &of, Qos::SENSOR);
        let begin = "@ros2_lv/0/aac3/4/5/MS/%/%robot%front/eyes/%camera%image_raw";
        assert_eq!(token, format!("{begin}/sensor_msgs::msg::dds_::Image_/{HASH}/2::,5:,:,:,,"));
        assert_eq!(subscribed_topic(&token), Some("%camera%image_raw"));
        let token = owner.entity_token(6, Kind::Publisher, "/a", &of, Qos::RESULT);
        assert!(token.ends_with("/::,10:,:,:,,"), "{token}");
        assert_eq!(subscribed_topic(&token), None);
        for short in ["", "a/b", "@ros2_lv/0/a/0/1/MS/%"] {
            assert_eq!(subscribed_topic(short), None);
        }
    }
}
