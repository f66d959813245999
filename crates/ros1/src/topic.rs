//! Publishers and subscriptions.

mod inbox;
mod link;
mod outbox;
mod publication;
mod publisher;
mod subscribed;
mod subscription;

pub use inbox::{MessageBytes, PublisherInfo, ReceivedMessage};
pub(crate) use outbox::Outbox;
pub(crate) use publication::Publication;
pub use publisher::{Publisher, PublisherOptions};
pub(crate) use subscribed::{Subscribed, uris};
pub use subscription::{Listener, SubscriberOptions, Subscription};
