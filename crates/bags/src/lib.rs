//! Reading and writing of recordings: rosbag 1, rosbag 2 (SQLite and MCAP) and MCAP files.
//!
//! [`Bag`] reads the messages of a recording in order of their log time, in bounded memory. [`BagWriter`] writes
//! recordings that the tools of ROS read. The crate does not decode messages: a message is bytes on a [`Channel`],
//! which has the type, the encoding and, if the recording contains it, the definition. `opendr-messages` decodes
//! messages, `opendr-recordings` reads them as inputs of learners and writes predictions.
//!
//! ```
//! use opendr_bags::{Bag, BagFormat, BagWriter, Channel, Encoding};
//!
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("talk.mcap");
//! let mut writer = BagWriter::create(&path, BagFormat::Mcap)?;
//! let chatter = Channel::new("/chatter", "std_msgs/msg/String", Encoding::Cdr).with_definition("string data");
//! let chatter = writer.add_channel(chatter)?;
//! writer.write(chatter, 1_000, b"\0\x01\0\0\x03\0\0\0hi\0")?;
//! writer.finish()?;
//!
//! let bag = Bag::open(&path)?;
//! for message in bag.messages()? {
//!     let message = message?;
//!     assert_eq!(bag.channels()[message.channel].topic, "/chatter");
//!     assert_eq!((message.log_time_ns, message.bytes.len()), (1_000, 11));
//! }
//! # Ok::<_, opendr_engine::Error>(())
//! ```

mod bag;
mod bag1;
mod bag2;
mod channel;
mod chunked;
mod compression;
mod fields;
mod format;
mod in_order;
mod mcap;
mod recorded;
mod selection;
mod source;
mod storage;
mod writer;

pub use bag::{Bag, Messages};
pub use channel::{Channel, Definition, Encoding, Language};
pub use compression::Compression;
pub use format::BagFormat;
pub use recorded::RecordedMessage;
pub use selection::Selection;
pub use writer::{BagWriter, WriteOptions};
