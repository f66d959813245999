//! Prints every message type and service as a line of JSON: names, md5 sum, RIHS01 hash and definitions.
//!
//! ```console
//! $ cargo run -p opendr-messages --example message_types
//! ```

use opendr_messages::{MessageType, SERVICE_TYPES, WireFormat};
use serde_json::json;

fn main() -> opendr_engine::Result<()> {
    for message in MessageType::ALL {
        let ros1 = message.ros1();
        println!(
            "{}",
            json!({
                "message": message.ros2_name(),
                "rihs01": message.rihs01(),
                "definition": message.definition(WireFormat::Cdr)?,
                "ros1": ros1.map(|known| known.name),
                "md5sum": ros1.map(|known| known.md5sum),
                "ros1_definition": message.definition(WireFormat::Ros1).ok(),
            })
        );
    }
    for service in SERVICE_TYPES {
        let name = format!("{}/srv/{}", service.package, service.name);
        println!("{}", json!({"service": name, "md5sum": service.md5sum, "rihs01": service.rihs01}));
    }
    Ok(())
}
